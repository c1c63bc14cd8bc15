//! The seam between a LAMMPS script and whatever moves the points.
//!
//! The interpreter collects a [`Setup`]; at the first `run` a [`Host`] makes an [`Engine`] of it. From then on
//! the engine owns all per-atom data and the interpreter reads and writes it through [`Particles`].
//! All arrays are in order of atom id. Forces and masses are *densities*, as in LAMMPS's `peri` styles.

use std::any::Any;
use std::sync::Arc;

use super::atoms::{Atoms, Members};
use super::domain::SimBox;
pub use super::pair::{
    EpsCoefficients, LpsCoefficients, Pair, PairTable, PmbCoefficients, Style, VesCoefficients,
};
pub use super::quantity::{BLOCK, HostError, Particles, Quantity};
use super::units::Units;
pub use peridyne::boundary_condition::kinematic::{Kinematics, Motion};
pub use peridyne::boundary_condition::rigid_body::{Form, Push};
pub use peridyne::run::Wall;
use peridyne::state::Archive;

/// What is asked for at the first `run`.
#[derive(Debug)]
pub struct Setup {
    /// The script's file name.
    pub title: String,
    /// 2 or 3.
    pub dimension: usize,
    pub units: Units,
    /// Box and boundaries; periodic axes have the length `high − low`.
    pub domain: SimBox,
    /// Edge of the cubic (square) cell of the script's `lattice`: volume scaling and contact use it.
    pub lattice_constant: f64,
    /// Time step as it is at the first `run`.
    pub time_step: f64,
    /// Number of steps of that `run`.
    pub steps: u64,
    pub atoms: Atoms,
    pub pair: Pair,
}

/// What acts on the atoms besides the bonds, in the order of the script's fixes: each works on the force left
/// by the ones before it.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// Adds the force density `K g²` along the surface's normal where the gap g between atom and surface is negative;
    /// minimum image on periodic axes.
    Indent {
        members: Arc<Members>,
        stiffness: f64,
        form: Form,
        push: Push,
        center: [f64; 3],
        radius: f64,
    },
    /// Overwrites the given components of the force density.
    SetForce {
        members: Arc<Members>,
        force: [Option<f64>; 3],
    },
    /// The same, with values for each member.
    SetForceEach {
        members: Arc<Members>,
        force: Vec<[Option<f64>; 3]>,
    },
    /// Adds a force density.
    AddForce {
        members: Arc<Members>,
        force: [f64; 3],
    },
    /// The same, with values for each member.
    AddForceEach {
        members: Arc<Members>,
        force: Vec<[Option<f64>; 3]>,
    },
    /// Adds the force density −γ v with the γ of each member, v as it is at that moment (in a step: of its middle).
    Drag {
        members: Arc<Members>,
        gamma: Vec<f64>,
    },
    /// Zeroes the z components of force density and velocity.
    Enforce2d { members: Arc<Members> },
}

/// What a `run` starts with.
#[derive(Debug, Clone, PartialEq)]
pub struct RunStart {
    /// Step counter of the state as it is.
    pub step: u64,
    /// Number of steps of this run.
    pub steps: u64,
    pub time_step: f64,
    /// Atoms that forces move; `None`: none.
    pub moving: Option<Arc<Members>>,
    /// Atoms (from 0) that are carried.
    pub kinematic: Vec<u32>,
    /// The box as it is now.
    pub domain: SimBox,
}

/// Sums over all atoms as LAMMPS prints them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Energies {
    /// Σ W (sum of energy densities, not weighted with volumes).
    pub potential: f64,
}

/// What a [`Condition`] had at the last force evaluation.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reaction {
    /// Σ K g³ / 3 of an rigid_body.
    pub energy: f64,
    /// Of an rigid_body minus the sum of the force densities on the atoms; of other conditions the sum of the force
    /// densities on their atoms before they acted.
    pub force: [f64; 3],
}

/// A model that can be stepped.
pub trait Engine: Particles {
    /// Start of a `run`: takes up written positions and velocities and evaluates the forces with `conditions`.
    /// The first call builds the bonds from the positions of that moment.
    ///
    /// # Errors
    /// The model cannot be run like this.
    fn setup(&mut self, run: &RunStart, conditions: &[Condition]) -> Result<(), HostError>;

    /// The first half of a velocity-Verlet step: positions of its end. `kinematic` says where the atoms of
    /// [`RunStart::kinematic`] are then, in displacements from their reference. Answers a bound on the path of any atom
    /// (length).
    ///
    /// # Errors
    /// The state went bad.
    fn depart(&mut self, kinematic: &[Motion]) -> Result<f64, HostError>;

    /// Mirrors atoms behind a wall, with their velocity across it.
    fn reflect(&mut self, wall: &Wall, members: &Members);

    /// The second half of a step: forces at its end. `conditions` hold their values there, in the order (and number) of
    /// `setup`.
    ///
    /// # Errors
    /// The state went bad.
    fn arrive(&mut self, conditions: &[Condition]) -> Result<(), HostError>;

    /// Takes atoms (from 0) away for ever; their bonds break, those above move down.
    fn remove(&mut self, atoms: &[u32]);

    /// Values will be asked for after the next step: LAMMPS's energies and dilatations still have the bonds that
    /// break in that step. [`Engine::setup`] expects it always.
    fn expect_output(&mut self) {}

    /// Energies of the current state.
    ///
    /// # Errors
    /// They cannot be computed.
    fn energies(&mut self) -> Result<Energies, HostError>;

    /// The virial will be asked for after the next step or [`Engine::setup`].
    fn expect_virial(&mut self) {}

    /// The same for [`Quantity::Virial`].
    fn expect_virials(&mut self) {}

    /// Σ of distance times force over bonds and contacts, xx yy zz xy xz yz (energy; weighted with volumes, unlike
    /// [`Energies`]).
    ///
    /// # Errors
    /// It cannot be computed.
    fn virial(&mut self) -> Result<[f64; 6], HostError>;

    /// Of condition number `index`.
    fn reaction(&self, index: usize) -> Reaction;

    /// Everything about the model now, for a picture.
    fn snapshot(&mut self) -> Option<peridyne::observe::Snapshot> {
        None
    }

    /// Directed bonds of the reference family (each bond counts twice).
    fn directed_bonds(&self) -> u64;

    /// Bytes that the model holds.
    fn memory_bytes(&self) -> u64;

    /// What the user should know since the last call: printed as notes after each set-up.
    fn notes(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// Takes up a run like [`Engine::setup`], but evaluates nothing: a state is read next.
    ///
    /// # Errors
    /// The model cannot be run like this, or has no states.
    fn await_state(&mut self, _: &RunStart, _: &[Condition]) -> Result<(), HostError> {
        Err(HostError::new("this model has no states to go on from"))
    }

    /// Passes its state through an archive; of one that was not read, [`Engine::await_state`] comes before.
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.refuse("model");
    }

    /// For the caller of the interpreter, who knows the type.
    fn as_any(&mut self) -> &mut dyn Any;
}

/// Makes engines.
pub trait Host {
    /// Called once, at the first `run`. Bonds may be built here or in the first [`Engine::setup`].
    ///
    /// # Errors
    /// The set-up cannot be built.
    fn build(&mut self, setup: Setup) -> Result<Box<dyn Engine>, HostError>;
}

/// What is wanted of the state of a script, where it can be kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wish {
    Nothing,
    /// It is written down, and the script goes on.
    State,
    /// The same, and the script ends there.
    End,
}

/// Where text goes.
pub trait Console {
    /// A line of LAMMPS's screen output.
    fn print(&mut self, line: &str);
    /// Something worth knowing that is no error.
    fn note(&mut self, line: &str);
    /// After each step of a run.
    fn progress(&mut self, _done: u64, _of: u64) {}
    /// Asked after each step: shall the script end here, with the state that it has?
    fn ended(&mut self) -> bool {
        false
    }
    /// Asked after steps and commands from which a script can go on.
    fn wish(&mut self, _steps: u64) -> Wish {
        Wish::Nothing
    }
    /// Writes the state after so many steps down; what it is, `pass` passes through an archive.
    fn keep(&mut self, _steps: u64, _pass: &mut dyn FnMut(&mut Archive<'_>)) {}
}
