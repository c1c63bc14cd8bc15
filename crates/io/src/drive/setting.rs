//! What reports tell of a run.

use super::plan::Plan;
use crate::deck::Dim;
use crate::write::run_json::{FieldNote, RigidNote, Setting, UnitNames};
use peridyne::run::Simulation;

impl Plan {
    /// What reports tell of this run.
    pub(super) fn setting(
        &self,
        sim: &mut dyn Simulation,
        pictures: &[String],
        rigid_bodies: Vec<RigidNote>,
    ) -> Setting {
        let series = &self.series;
        let mut files = vec!["history.csv".to_string()];
        let mut file = |there: bool, name: &str| files.extend(there.then(|| name.to_string()));
        file(series.points, "points.pvd");
        file(series.writes_cells(), "cells.pvd");
        file(series.bonds, "bonds.pvd");
        pictures.iter().for_each(|name| file(true, name));
        let modes = self.modes > 0 && self.dir.join("modes.csv").is_file();
        file(modes, "modes.csv");
        file(modes, "modes/points.pvd");
        file(self.output.linear_body, "linear_body.npz");
        file(self.output.fragments, "fragments.csv");
        let dump = series.dump.iter().map(|(name, _)| name);
        let dump = dump.chain(self.exodus.iter().map(|e| &e.path));
        let dump = dump.chain(&self.output.vtkhdf);
        let atoms = self.atoms.iter();
        let named = atoms.flat_map(|a| a.trajectories.iter().map(|(n, _)| n).chain(&a.data));
        files.extend(dump.chain(named).map(|n| n.display().to_string()));
        let declared = sim.columns();
        let frame = self.frame_fields(sim).into_iter();
        let frame = std::iter::once("displacement".to_string())
            .chain(frame.filter(|f| f != "displacement"));
        let fields = frame.filter_map(|name| {
            let c = declared.iter().find(|c| c.name == name)?;
            Some(FieldNote {
                unit: self.units.unit(c.dimension),
                says: c.doc.to_string(),
                name,
            })
        });
        Setting {
            command: self.command.clone(),
            deck_text: self.deck_text.clone(),
            understood: self.understood.clone(),
            sources: self.sources.clone(),
            dimension: sim.info().dimension,
            spacing: sim.info().spacing,
            statics: sim.info().stepper.statics().is_some(),
            atoms: self.atoms.is_some(),
            units: UnitNames {
                length: self.units.unit(Dim::LENGTH),
                time: self.time_unit.clone(),
                energy: self.energy_unit.clone(),
            },
            fields: fields.collect(),
            rigid_bodies,
            marks: self.marks.clone(),
            slices: vec![],
            dumps: vec![],
            columns: vec![],
            files,
        }
    }
}
