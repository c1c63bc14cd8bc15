//! What an Exodus file says of a model: blocks by material and body, the deck's sets, rows of the history.

use std::path::{Path, PathBuf};

use peridyne::observe::{Snapshot, Values};
use peridyne::run::Simulation;

use crate::write::WriteError;
use crate::write::exodus::{Exodus, Layout};
use crate::write::history::Column;

/// An Exodus file of all frames.
#[derive(Debug, Clone, Default)]
pub struct ExodusPlan {
    /// In the folder of the results.
    pub path: PathBuf,
    pub materials: Vec<String>,
    /// Names of several bodies; none of one.
    pub bodies: Vec<String>,
    /// Sets that become node sets.
    pub sets: Vec<String>,
}

/// Frames of a run.
pub(super) struct Frames {
    path: PathBuf,
    layout: Layout,
    open: Option<Exodus>,
}

impl Frames {
    pub(super) fn new(
        plan: &ExodusPlan,
        (dir, title): (&Path, &str),
        sim: &mut dyn Simulation,
        columns: &[Column],
    ) -> Self {
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
        let mut globals = vec!["step".to_string()];
        // time has a place of its own
        globals.extend(columns.iter().skip(1).map(|c| c.name.replace(' ', "_")));
        let layout = Layout {
            title: title.to_string(),
            blocks: { blocks.into_iter() }
                .map(|([body, material], points)| (name(body, material), points))
                .collect(),
            sets: sets.collect(),
            volume: sim.scalars("volume"),
            globals,
        };
        Frames {
            path: dir.join(&plan.path),
            layout,
            open: None,
        }
    }

    /// Adds a frame with its row of the history.
    pub(super) fn push(&mut self, s: &Snapshot, row: &[f64]) -> Result<(), WriteError> {
        let mut file = match self.open.take() {
            Some(file) => file,
            None => Exodus::create(&self.path, &self.layout, s)?,
        };
        let mut globals = vec![s.step as f64];
        globals.extend(&row[1..]);
        let done = file.push(s, &globals);
        self.open = Some(file);
        done
    }

    pub(super) fn finish(self) -> Result<(), WriteError> {
        self.open.map_or(Ok(()), Exodus::finish)
    }
}
