//! Frames for ParaView, the dump, pictures and films.

use std::time::Instant;

use peridyne::state::{Archive, Owner};

use super::writer::{Made, Now, Writer};
use crate::drive::plan::DriveError;
use crate::write::Series;
use crate::write::picture::film::HURRY;

#[derive(Default)]
pub struct Frames {
    open: Option<Series>,
}

impl Owner for Frames {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.given("series", &mut self.open, |series, a| series.archive(a));
    }
}

impl Writer for Frames {
    fn open(&mut self, now: &mut Now<'_>, goes_on: bool) -> Result<(), DriveError> {
        let (dir, options) = (&now.plan.dir, now.plan.series.clone());
        let series = match goes_on {
            true => Series::reopen(dir, options)?,
            false => Series::new(dir, options)?,
        };
        if let Some(text) = series.strange() {
            now.warn(text);
        }
        self.open = Some(series);
        Ok(())
    }

    fn rewind(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        let snapshot = now.snapshot();
        Ok(self
            .open
            .as_mut()
            .map_or(Ok(()), |series| series.rewind(&snapshot))?)
    }

    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        if let Some(series) = &mut self.open
            && now.due.frame
            && !now.due.last
            && series.wants_frames()
        {
            let (snapshot, placed) = (now.snapshot(), now.placed());
            series.write(&snapshot, &placed)?;
        }
        Ok(())
    }

    fn end(self: Box<Self>, now: &mut Now<'_>, made: &mut Made) -> Result<(), DriveError> {
        let Some(mut series) = self.open else {
            return Ok(());
        };
        let (snapshot, placed) = (now.snapshot(), now.placed());
        series.write(&snapshot, &placed)?;
        now.progress.phase("pictures");
        if now.hurried && series.hurry() {
            now.warn(format!(
                "the run was ended: films have no more frames than are drawn in {} s",
                HURRY.as_secs()
            ));
        }
        let drawing = Instant::now();
        let pictures = series.finish(&snapshot, &placed, now.about())?;
        let names = pictures.iter().filter_map(|p| p.file_name());
        made.pictures
            .extend(names.map(|n| n.to_string_lossy().into_owned()));
        now.spent.pictures += drawing.elapsed().as_secs_f64();
        Ok(())
    }
}
