//! From a set-up to a model.

use std::cell::RefCell;

use peridyne::error::BuildError;
use peridyne::execute::simd::Simd;
use peridyne::run::{Options, Simulation, build, ranks};
use peridyne::spec::Spec;
use peridyne_io::deck::{UnitSystem, describe, sources};
use peridyne_io::write::shares::write_share;

use super::engine::{ModelEngine, in_plane};
use super::sharing::Sharing;
use super::spec;
use super::types::Types;
use crate::atoms::{Atoms, Column};
use crate::host::{BLOCK, Engine, Host, HostError, Particles, Quantity, Setup, Style};

/// Makes peridyne models of scripts.
#[derive(Debug, Clone, Default)]
pub struct ModelHost {
    /// Instruction set; `None` takes the widest there is.
    pub simd: Option<Simd>,
    /// Who shares the model; `None`: nobody.
    pub ranks: Option<Sharing>,
}

/// A script's model as it stands at the first `run`, before any force.
pub struct Prepared {
    pub spec: Spec,
    pub simulation: Box<dyn Simulation>,
    /// What the user should know.
    pub notes: Vec<String>,
    /// As [`ModelEngine`] has them.
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
            spec,
        } = { self.prepare(&setup)? }
            .ok_or_else(|| HostError::new("this rank has followed the first one"))?;
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
            understood: describe(&spec, units.system()),
            sources: sources(&spec),
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
            style: pair.style(),
            undefined: pair.style() != Style::Pmb,
            notes,
        }))
    }
}

impl ModelHost {
    /// Specification and model of a set-up; of ranks that share it the first one has it, and the others have followed it to its end.
    ///
    /// # Errors
    /// Something that the engine has not, or that ranks do not share.
    pub fn prepare(&self, setup: &Setup) -> Result<Option<Prepared>, HostError> {
        let style = setup.pair.style();
        let types = Types::new(&setup.pair, &setup.atoms)?;
        let registered = matches!(style, Style::Ves | Style::Eps);
        if registered && setup.dimension == 2 {
            let name = style.name();
            return Err(HostError::new(format!(
                "`{name}` in two dimensions: LAMMPS has the moduli and yield surface of space there, which are those of no plane"
            ))
            .help("use `dimension 3`, or `peri/lps`, or a deck with plane = \"strain\""));
        }
        let spec = spec::spec(setup, &types)?;
        let options = Options {
            simd: self.simd,
            ..Options::default()
        };
        let units = setup.units.system();
        let built = match &self.ranks {
            None => build(&spec, options).map(Some),
            Some(ranks) => {
                ranks.meet(&spec)?;
                ranks::build(&spec, options, &ranks.comm, write_share)
            }
        };
        let Some(mut simulation) = built.map_err(|e| explain(&e, units))? else {
            return Ok(None);
        };
        write_velocities(simulation.as_mut(), setup.dimension, &setup.atoms)?;
        let highest = setup.pair.types();
        let moduli = types.moduli();
        let of = |kind: usize| moduli.get(types.material_of(kind)).copied();
        Ok(Some(Prepared {
            notes: notes(setup, &types, simulation.as_ref()),
            moduli: (1..=highest).filter_map(of).collect(),
            unbonded: types.unbonded(),
            spec,
            simulation,
        }))
    }
}

/// What LAMMPS's `peri/ves` and `peri/eps` do to bonds (observed: with nothing that relaxes or yields they are not its `peri/lps`).
const OWN_ENDS: &str = "here the two ends of a bond answer with the dilatation of their own each (Mitchell 2011); LAMMPS's `peri/ves` and `peri/eps` compute the force on an atom with its own dilatation for both ends, so that forces between two atoms whose dilatations differ are not opposite, momentum is not conserved, and without relaxation or yield they are not its `peri/lps`; results are LAMMPS's as long as the dilatations of all partners are equal and no bond is broken (in damaged families deviators are those of what is left here, of the whole family there)";

/// And `peri/ves` in time.
const SET_UPS: &str = "LAMMPS's `peri/ves` lets bonds relax for one more time step in the set-up of each `run`; here time stands still there";

/// And `peri/eps` to what flows.
const FLOW: &str = "the yield stress is that of the material, ½ Σ t²/ω = 15 σ_y²/(6m) (Mitchell 2011 for ω = 1/r); LAMMPS's `peri/eps` yields elsewhere (its norm of t is multiplied by dilatations, its bound 25 σ_y²/(8πδ⁵) is that of ω = 1), its plastic extensions grow by t instead of t/ω, too large by 1/length, and are forgotten in every step without yield, and positions soon are no numbers: plastic flow is not LAMMPS's here";

/// Where the run is not LAMMPS's, or LAMMPS's is not what one might think.
fn notes(setup: &Setup, types: &Types, sim: &dyn Simulation) -> Vec<String> {
    let mut notes = vec![];
    let mut note = |text: &str| notes.push(text.to_string());
    let style = setup.pair.style();
    let name = style.name();
    match style {
        Style::Pmb | Style::Lps => {}
        Style::Ves => {
            note(OWN_ENDS);
            note(SET_UPS);
        }
        Style::Eps => {
            note(OWN_ENDS);
            note(FLOW);
        }
    }
    if style != Style::Pmb {
        note(&format!(
            "pe, E_pair, E_vdwl, etotal and pe/atom are LAMMPS's: its `{name}` counts half of the energy of changes of shape, so that their sum with ke is not conserved; the energies in run.json are whole",
        ));
    }
    let across = (0..setup.dimension).any(|a| setup.domain.periodic(a));
    if style != Style::Pmb && across {
        note(&format!(
            "`{name}` through periodic faces: LAMMPS computes the weighted volumes of points near such a face without the nearest images, so that they are far too large there; here they are those of the nearest images",
        ));
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

fn explain(e: &BuildError, units: UnitSystem) -> HostError {
    let message = units.tell(&e.message);
    let help = match e.path.as_str() {
        "horizon" => "the horizon is the number before s00 in `pair_coeff`",
        "periodic" => "use a larger box, or a smaller horizon in `pair_coeff`",
        path if path.ends_with("fracture") => "s00 and alpha are the last numbers of `pair_coeff`",
        path if path.ends_with("law") => "check the moduli in `pair_coeff`",
        path if path.ends_with("density") => "write `set group all density VALUE` before `run`",
        "run.time_step" => "write `timestep VALUE` with a positive number",
        _ => return HostError::new(message),
    };
    HostError::new(message).help(help)
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
