//! From a set-up to a model.

use std::cell::RefCell;
use std::collections::HashSet;

use peridyne::error::BuildError;
use peridyne::execute::simd::Simd;
use peridyne::run::{Options, PointField, Simulation, SnapshotOptions, build};
use peridyne::spec::{InterfaceRule, Spec};

use super::types::Types;
use super::{ModelEngine, in_plane, spec};
use crate::lammps::atoms::{Atoms, Column};
use crate::lammps::host::{BLOCK, Engine, Host, HostError, Particles, Quantity, Setup};

/// Makes peridyne models of scripts.
#[derive(Debug, Clone, Copy, Default)]
pub struct ModelHost {
    /// Instruction set; `None` takes the widest there is.
    pub simd: Option<Simd>,
}

/// A script's model as it stands at the first `run`, before any force.
pub struct Prepared {
    pub spec: Spec,
    pub simulation: Box<dyn Simulation>,
    /// What the user should know.
    pub notes: Vec<String>,
    /// Must nothing repel?
    guarded: bool,
}

impl Host for ModelHost {
    fn build(&mut self, setup: Setup) -> Result<Box<dyn Engine>, HostError> {
        let Prepared {
            simulation,
            notes,
            guarded,
            ..
        } = self.prepare(&setup)?;
        let Setup {
            dimension,
            domain,
            atoms,
            ..
        } = setup;
        let height = if dimension == 2 {
            atoms.position(0)[2]
        } else {
            0.0
        };
        Ok(Box::new(ModelEngine {
            sim: RefCell::new(simulation),
            dimension,
            domain,
            height,
            types: atoms.types,
            derived: RefCell::default(),
            bonded: false,
            driven: Vec::new(),
            guarded,
            notes,
        }))
    }
}

impl ModelHost {
    /// Specification and model of a set-up.
    ///
    /// # Errors
    /// Something that the engine has not.
    pub fn prepare(&self, setup: &Setup) -> Result<Prepared, HostError> {
        let types = Types::new(&setup.pair, &setup.atoms)?;
        let (spec, mut simulation) = self.simulation(setup, &types)?;
        write_velocities(simulation.as_mut(), setup.dimension, &setup.atoms)?;
        let guarded = !types.repel_alike();
        let mut notes = vec![];
        if guarded {
            notes.push("the atom types differ in stiffness: this run stops if points come so close that they repel, because only one stiffness of repulsion is supported".to_string());
        }
        if setup.atoms.moved.is_some() {
            notes.push("atoms were moved before the first run: their positions now are the reference of the bonds, as in LAMMPS, and of the repulsion, for which LAMMPS keeps the positions at creation (write `run 0` before moving them if those are meant)".to_string());
        }
        Ok(Prepared {
            spec,
            simulation,
            notes,
            guarded,
        })
    }

    fn simulation(
        &self,
        setup: &Setup,
        types: &Types,
    ) -> Result<(Spec, Box<dyn Simulation>), HostError> {
        let options = Options {
            simd: self.simd,
            ..Options::default()
        };
        let make = |rule| {
            let spec = spec::spec(setup, types, rule)?;
            let simulation = build(&spec, options).map_err(explain)?;
            Ok((spec, simulation))
        };
        let first = match types.rule(|_, _| true) {
            Ok(rule) => return make(rule),
            Err(_) => InterfaceRule::Series,
        };
        // pairs that no bond joins may have any coefficients
        let (spec, mut sim) = make(first)?;
        let mut bonded = HashSet::new();
        if sim.families().foreign.contains(&true) {
            let kind = |i: u32| setup.atoms.types.get(i as usize) as usize;
            let snapshot = sim.snapshot(SnapshotOptions {
                bonds: true,
                ..SnapshotOptions::default()
            });
            for (i, j) in snapshot.bonds.iter().flatten() {
                let (a, b) = (kind(*i), kind(*j));
                bonded.insert((a.min(b), a.max(b)));
            }
        }
        let rule = types.rule(|i, j| bonded.contains(&(i, j)))?;
        if rule == first {
            Ok((spec, sim))
        } else {
            make(rule)
        }
    }
}

fn explain(e: BuildError) -> HostError {
    let help = match e.path.as_str() {
        "horizon" => "the horizon is the number before s00 in `pair_coeff`",
        "periodic" => "use a larger box, or a smaller horizon in `pair_coeff`",
        path if path.ends_with("fracture") => "s00 and alpha are the last numbers of `pair_coeff`",
        path if path.ends_with("law") => "check the moduli in `pair_coeff`",
        path if path.ends_with("density") => "write `set group all density VALUE` before `run`",
        "run.time_step" => "write `timestep VALUE` with a positive number",
        _ => return HostError::new(e.message),
    };
    HostError::new(e.message).help(help)
}

fn write_velocities(
    sim: &mut dyn Simulation,
    dimension: usize,
    atoms: &Atoms,
) -> Result<(), HostError> {
    if atoms.velocity == Column::Uniform([0.0; 3]) {
        return Ok(());
    }
    let mut block = [0.0; BLOCK];
    for first in (0..atoms.len()).step_by(BLOCK) {
        let block = &mut block[..BLOCK.min(atoms.len() - first)];
        for a in 0..3 {
            atoms.read(Quantity::Velocity(a), first, block)?;
            if a < dimension {
                sim.write(PointField::Velocity(a), first, block);
            } else {
                in_plane("velocity", block, 0.0)?;
            }
        }
    }
    Ok(())
}
