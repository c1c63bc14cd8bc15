//! From a set-up to a model.

use std::cell::RefCell;

use peridyne::error::BuildError;
use peridyne::execute::simd::Simd;
use peridyne::run::{Options, Simulation, build};
use peridyne::spec::Spec;

use super::types::Types;
use super::{ModelEngine, in_plane, spec};
use crate::atoms::{Atoms, Column};
use crate::host::{BLOCK, Engine, Host, HostError, Pair, Particles, Quantity, Setup};

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
    /// Bulk and shear modulus for each atom type, from 1; nothing of PMB.
    moduli: Vec<[f64; 2]>,
    /// Pairs of atom types that repel without bounds.
    unbonded: Vec<(usize, usize)>,
}

impl Host for ModelHost {
    fn build(&mut self, setup: Setup) -> Result<Box<dyn Engine>, HostError> {
        let Prepared {
            simulation,
            notes,
            moduli,
            unbonded,
            ..
        } = self.prepare(&setup)?;
        let Setup {
            dimension,
            domain,
            units,
            atoms,
            pair,
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
            units,
            height,
            types: atoms.types,
            density: atoms.density,
            derived: RefCell::default(),
            bonded: false,
            driven: Vec::new(),
            moduli,
            unbonded,
            undefined: matches!(pair, Pair::Lps(_)),
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
        let spec = spec::spec(setup, &types)?;
        let options = Options {
            simd: self.simd,
            ..Options::default()
        };
        let mut simulation = build(&spec, options).map_err(explain)?;
        write_velocities(simulation.as_mut(), setup.dimension, &setup.atoms)?;
        let highest = setup.pair.types();
        let moduli = types.moduli();
        let of = |kind: usize| moduli.get(types.material_of(kind)).copied();
        Ok(Prepared {
            notes: notes(setup, &types, simulation.as_ref()),
            moduli: (1..=highest).filter_map(of).collect(),
            unbonded: types.unbonded(),
            spec,
            simulation,
        })
    }
}

/// Where the run is not LAMMPS's, or LAMMPS's is not what one might think.
fn notes(setup: &Setup, types: &Types, sim: &dyn Simulation) -> Vec<String> {
    let mut notes = vec![];
    let mut note = |text: &str| notes.push(text.to_string());
    if let Pair::Lps(_) = setup.pair {
        note(
            "pe, E_pair, E_vdwl, etotal and pe/atom are LAMMPS's: its `peri/lps` counts half of the energy of changes of shape, so that their sum with ke is not conserved; the energies in run.json are whole",
        );
    }
    let across = (0..setup.dimension).any(|a| setup.domain.periodic(a));
    if matches!(setup.pair, Pair::Lps(_)) && across {
        note(
            "LPS through periodic faces: LAMMPS's `peri/lps` computes the weighted volumes of points near such a face without the nearest images, so that they are far too large there; here they are those of the nearest images",
        );
    }
    if types.unlike_moduli() {
        note(
            "atom types differ in K or G: as in LAMMPS the force on an atom has the moduli of its own type for both ends of a bond, so that forces between unlike types are not opposite and no energy is conserved; where such atoms repel, LAMMPS takes the K of whichever comes first in its neighbour list, the mean of both is taken here",
        );
    }
    if let Column::Each(v) = &setup.atoms.volume
        && v.iter().any(|x| *x != v[0])
    {
        note(
            "atoms differ in volume: where such atoms repel each other, LAMMPS gives both the volume of whichever comes second in its neighbour list; here each is pushed by the volume of the other, and momentum is conserved",
        );
    }
    if setup.atoms.moved.is_some() {
        note(
            "atoms were moved before the first run: their positions now are the reference of the bonds, as in LAMMPS, and of the repulsion, for which LAMMPS keeps the positions at creation (write `run 0` before moving them if those are meant)",
        );
    }
    let near = sim.info().near_horizon;
    if near > 0 {
        note(&format!(
            "{near} directed pairs are within round-off of their horizon: as in LAMMPS, the positions as they are stored decide about each of them; a horizon between two distances, such as 3.01 lattice constants, leaves nothing to round-off"
        ));
    }
    notes
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
                sim.write("velocity", a, first, block);
            } else {
                in_plane("velocity", block, 0.0)?;
            }
        }
    }
    Ok(())
}
