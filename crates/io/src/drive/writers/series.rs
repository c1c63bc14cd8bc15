//! Frames for ParaView, the dump, pictures and films.

use std::sync::Arc;
use std::time::Instant;

use peridyne::observe::Snapshot;
use peridyne::state::{Archive, Owner};

use super::writer::{Made, Now, Writer};
use crate::drive::frame_time;
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
        let Some(series) = &mut self.open else {
            return Ok(());
        };
        Ok(series.rewind(&seen(series, now))?)
    }

    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        if let Some(series) = &mut self.open
            && now.due.frame
            && !now.due.last
        {
            write(series, now, false)?;
        }
        Ok(())
    }

    fn end(self: Box<Self>, now: &mut Now<'_>, made: &mut Made) -> Result<(), DriveError> {
        let Some(mut series) = self.open else {
            return Ok(());
        };
        let draws = series.draws();
        write(&mut series, now, draws)?;
        let (snapshot, placed) = (seen(&series, now), now.placed());
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

/// What pictures show of this state; nothing where none are drawn.
fn seen(series: &Series, now: &mut Now<'_>) -> Arc<Snapshot> {
    match series.draws() {
        true => now.snapshot(),
        false => Arc::default(),
    }
}

/// Writes a frame; ranks do it together, if nothing needs all points in one place.
fn write(series: &mut Series, now: &mut Now<'_>, is_drawn: bool) -> Result<(), DriveError> {
    if !series.wants_frames() {
        return Ok(());
    }
    if now.plan.ranks > 1 && series.is_of_points() && !is_drawn {
        let when = (now.sim.step_number(), frame_time(now.sim));
        let (sim, plan) = (&mut *now.sim, now.plan);
        let ask = |name: &str| {
            let fields = plan.written_fields(sim);
            let fields: Vec<&str> = fields.iter().map(String::as_str).collect();
            sim.shares(&fields, name)
        };
        if series.write_shares(when, ask)? {
            return Ok(());
        }
    }
    let (snapshot, placed) = (now.snapshot(), now.placed());
    Ok(series.write(&snapshot, &placed)?)
}
