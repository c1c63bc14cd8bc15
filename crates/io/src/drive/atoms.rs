//! What a run writes of atoms.

use std::path::PathBuf;

use peridyne::observe::{Values, temperature_of};
use peridyne::run::Simulation;

use crate::read::{Atoms, Species};
use crate::write::trajectory::Format;

/// Temperature, pressure, trajectory and last state of atoms.
#[derive(Debug, Clone)]
pub struct AtomsPlan {
    /// k_B (energy / temperature).
    pub boltzmann: f64,
    pub temperature_unit: String,
    /// How many of it a computed pressure of 1 is.
    pub pressure_scale: f64,
    pub pressure_unit: String,
    pub trajectories: Vec<(PathBuf, Format)>,
    /// LAMMPS data file of the last state.
    pub data: Option<PathBuf>,
    /// Of each material: name of its atoms, and mass density (mass / length³).
    pub species: Vec<(String, f64)>,
    /// How much computed velocity one of ASE is.
    pub ase_velocity: f64,
    /// How many units of mass of a data file a computed mass of 1 is.
    pub mass_scale: f64,
    /// Lower corner of the periods.
    pub corner: [f64; 3],
    /// Periods, where there are any (length).
    pub periodic: [Option<f64>; 3],
}

impl AtomsPlan {
    /// Temperature and pressure: `(2 E_kin + Σ r·f) / (D V)`.
    pub(super) fn thermo(&self, sim: &mut dyn Simulation, kinetic: f64) -> [f64; 2] {
        let (d, n, mut volume) = {
            let info = sim.info();
            (info.dimension, info.points, info.volume)
        };
        let periods: Vec<f64> = self.periodic[..d].iter().filter_map(|p| *p).collect();
        if periods.len() == d {
            volume = periods.iter().product::<f64>() * sim.info().section;
        }
        let virial: f64 = sim.virial()[..d].iter().sum();
        [
            temperature_of(kinetic, d, n, self.boltzmann),
            (2.0 * kinetic + virial) / (d as f64 * volume) * self.pressure_scale,
        ]
    }

    pub(super) fn frame(&self, sim: &mut dyn Simulation) -> Atoms {
        let n = sim.info().points as usize;
        let position = sim.vectors("position");
        let volume = sim.scalars("volume");
        let mass = |density: f64| {
            let volume = volume.first();
            volume.map(|v| rounded(density * v * self.mass_scale))
        };
        let species = { self.species.iter() }.map(|(name, density)| Species {
            name: name.clone(),
            mass: mass(*density),
        });
        let kind = match sim.column("material").map(|c| c.values) {
            Some(Values::Counts(of)) if self.species.len() > 1 => of,
            _ => vec![0; n],
        };
        let force = sim.vectors("force_density");
        let force = force.iter().zip(&volume).map(|(f, v)| f.map(|f| f * v));
        let [mut low, mut high] = Atoms::bounds(&position);
        for a in 0..3 {
            if let Some(p) = self.periodic[a] {
                (low[a], high[a]) = (self.corner[a], self.corner[a] + p);
            }
        }
        Atoms {
            bonded: false,
            mass: None,
            units: None,
            species: species.collect(),
            kind,
            velocity: Some(sim.velocities()),
            force: Some(force.collect()),
            columns: vec![],
            energy: Some(
                sim.scalars("energy_density")
                    .iter()
                    .zip(&volume)
                    .map(|(e, v)| e * v)
                    .collect(),
            ),
            position,
            low,
            high,
            periodic: self.periodic.map(|p| p.is_some()),
            edges: None,
            step: Some(sim.step_number()),
            time: Some(sim.clock()),
            from_momenta: false,
        }
    }

    /// The state as a data file holds it: in its box, with masses. A box without length along an axis gets length 1,
    /// as 2-D boxes of LAMMPS have.
    pub(super) fn last(&self, sim: &mut dyn Simulation) -> Atoms {
        let mut atoms = self.frame(sim);
        atoms.wrap();
        for a in 0..3 {
            if atoms.low[a] == atoms.high[a] {
                atoms.low[a] -= 0.5;
                atoms.high[a] += 0.5;
            }
        }
        atoms
    }
}

/// 14 digits of a number: what it was before products and quotients of units.
fn rounded(value: f64) -> f64 {
    format!("{value:.13e}").parse().unwrap_or(value)
}
