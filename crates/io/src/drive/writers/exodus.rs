//! What an Exodus file says of a model: blocks by material and body, the deck's sets, rows of the history.

use crate::drive::options::ExodusPlan;
use std::path::PathBuf;

use peridyne::observe::Values;
use peridyne::run::Simulation;
use peridyne::state::{Archive, Owner};

use super::writer::{Made, Now, Writer};
use crate::drive::plan::{DriveError, Plan};
use crate::write::exodus::{Exodus, Layout};
use crate::write::history::Column;

/// Frames of a run.
pub struct ExodusFrames {
    columns: Vec<Column>,
    asked: Option<(PathBuf, Layout)>,
    open: Option<Exodus>,
}

impl ExodusFrames {
    pub fn new(columns: &[Column]) -> ExodusFrames {
        ExodusFrames {
            columns: columns.to_vec(),
            asked: None,
            open: None,
        }
    }

    /// Adds a frame with its row of the history; of a run that stopped, what can be said of the last good state.
    fn push(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        let Some((path, layout)) = &self.asked else {
            return Ok(());
        };
        let snapshot = now.snapshot();
        let row = match now.row() {
            Some(row) => row,
            None if now.due.last => vec![f64::NAN; self.columns.len()],
            None => return Ok(()),
        };
        let file = match &mut self.open {
            Some(file) => file,
            none => none.insert(Exodus::create(path, layout, &snapshot)?),
        };
        let mut globals = vec![snapshot.step as f64];
        globals.extend(&row[1..]);
        Ok(file.push(&snapshot, &globals)?)
    }
}

impl Owner for ExodusFrames {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.given("file", &mut self.open, |file, a| file.archive(a));
    }
}

impl Writer for ExodusFrames {
    fn open(&mut self, now: &mut Now<'_>, goes_on: bool) -> Result<(), DriveError> {
        let Some(plan) = &now.plan.exodus else {
            return Ok(());
        };
        let layout = layout(now.plan, plan, now.sim, &self.columns);
        let path = now.plan.dir.join(&plan.path);
        if goes_on {
            // the first frame is that of the start
            self.open = Some(Exodus::reopen(&path, &layout, &now.snapshot())?);
        }
        self.asked = Some((path, layout));
        Ok(())
    }

    fn rewind(&mut self, _: &mut Now<'_>) -> Result<(), DriveError> {
        Ok(self.open.as_mut().map_or(Ok(()), Exodus::rewind)?)
    }

    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        match now.due.frame && !now.due.last {
            true => self.push(now),
            false => Ok(()),
        }
    }

    fn end(mut self: Box<Self>, now: &mut Now<'_>, _: &mut Made) -> Result<(), DriveError> {
        self.push(now)?;
        Ok(self.open.map_or(Ok(()), Exodus::finish)?)
    }
}

/// Blocks by material and body, the deck's sets, and the names of the history's columns.
fn layout(all: &Plan, plan: &ExodusPlan, sim: &mut dyn Simulation, columns: &[Column]) -> Layout {
    let count = sim.info().points as usize;
    let mut of = |name: &str, several: bool| match sim.column(name).map(|c| c.values) {
        Some(Values::Counts(of)) if several => of,
        _ => vec![0; count],
    };
    let material = of("material", plan.materials.len() > 1);
    let body = of("body", plan.bodies.len() > 1);
    let name = |body: u32, material: u32| {
        let body = plan.bodies.get(body as usize);
        let material = plan.materials.get(material as usize);
        match (body, material) {
            (Some(body), Some(material)) if plan.materials.len() > 1 => {
                format!("{body}_{material}")
            }
            (Some(name), _) | (None, Some(name)) => name.clone(),
            (None, None) => "points".to_string(),
        }
    };
    let mut blocks = std::collections::BTreeMap::<[u32; 2], Vec<u32>>::new();
    for (i, key) in body.into_iter().zip(material).enumerate() {
        blocks.entry(key.into()).or_default().push(i as u32);
    }
    let sets = plan.sets.iter().filter_map(|name| {
        let points = sim.members(name)?;
        (!points.is_empty()).then(|| (name.clone(), points))
    });
    let mut globals = vec![Column::new("step", "")];
    // time has a place of its own
    let rest = columns.iter().skip(1);
    globals.extend(rest.map(|c| Column::new(c.name.replace(' ', "_"), &*c.unit)));
    Layout {
        title: all.title.clone(),
        blocks: { blocks.into_iter() }
            .map(|([body, material], points)| (name(body, material), points))
            .collect(),
        sets: sets.collect(),
        volume: sim.scalars("volume"),
        globals,
        units: all.units,
        time_unit: all.time_unit.clone(),
    }
}
