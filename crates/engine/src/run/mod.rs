//! From a specification to a running model.

mod accounts;
mod agreed;
mod archive;
mod atoms;
mod bind;
mod bonded;
mod bonds;
mod build;
mod calibration;
mod changes;
mod clock;
mod clouds;
mod co_simulation;
mod conditions;
mod contact;
mod diffusions;
mod equilibrium;
mod examined;
mod faces;
mod fault;
mod gaps;
mod healing;
mod implicit;
mod inertia;
pub mod initial;
mod interfaces;
mod lints;
mod model;
mod names;
mod near;
mod observation;
mod overloaded;
mod parts;
mod precracks;
mod preload;
mod probe;
mod probes;
pub mod ranks;
mod record;
mod reference;
mod rigid_bodies;
mod sanity;
mod sets;
mod stages;
mod state_hash;
mod stepper;
mod surface;
mod system;
mod time_step;
mod toughness;
mod traits;
mod variable_horizons;
mod virial;

pub use crate::constitutive::{Registry, Sweeps};
pub use build::{Options, build, build_with};
pub use diffusions::DiffusionInfo;
pub use model::Model;
pub use sets::{materials_of, materials_of_bodies};

use crate::boundary_condition::constraint::Kind;
use crate::boundary_condition::driven::Drive;
use crate::boundary_condition::external::ExternalValues;
use crate::boundary_condition::kinematic::Motion;
use crate::boundary_condition::point_force::PointForce as Push;
use crate::boundary_condition::reaction::Reaction;
use crate::columns::Declaration;
use crate::diffusion::DiffusionAccount;
use crate::error::{BuildError, RunError, SolveError};
use crate::observe::{
    Column, Ledger, Observed, PointForce, ProbeColumn, Snapshot, StateHash, Values,
};
use crate::quantity::Warnings;
use crate::space::Point;
use crate::spec::{AnyLinearBody, Influence, Quantity, Stepper};
use crate::state::Owner;
use crate::statics::Solved;
use peridyne_comm::Work;
use std::sync::Arc;

/// What a model is, for headers and reports.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Info {
    pub dimension: usize,
    pub points: u64,
    pub directed_bonds: u64,
    /// Smallest, mean and largest family.
    pub family: (usize, f64, usize),
    /// `"stencil"`, `"list"`, `"neighbours"` or `"reference"`.
    pub family_kind: &'static str,
    /// What finds the forces of bonds, of each body in their order; `None`: it is loose, of springs, micromoduli or atoms.
    pub sweeps: Vec<Option<Sweeps>>,
    /// Directed bonds whose length is within round-off of the horizon.
    pub near_horizon: u64,
    /// The longest of all bodies that have bonds.
    pub horizon: f64,
    pub spacing: f64,
    /// Thickness in 2-D, cross-section in 1-D, 1 in 3-D.
    pub section: f64,
    pub mass: f64,
    pub volume: f64,
    /// Micromodulus per material of bond-based bodies (force / volume²).
    pub micromodulus: Vec<f64>,
    /// Critical stretch s00 per material; ∞: never breaks.
    pub critical_stretch: Vec<f64>,
    /// Horizon (length) and influence function per material; those of the first body that is made of it.
    pub families: Vec<(f64, Influence)>,
    pub time_step: f64,
    pub stepper: Stepper,
    /// Stability limit of explicit steps: that of bonds, and of contact if that is lower.
    pub stable_step: f64,
    /// Of points in contact alone; ∞ without contact.
    pub contact_step: f64,
    /// Of contact between points of a material, per material (force / volume² / length); empty: none touch.
    pub contact_stiffness: Vec<f64>,
    /// Most parts in which a step was done so far, as bonds became shorter and stiffer.
    pub parts: u32,
    /// Has it an energy that is kept, as action is reaction? (Where a step that is too long was asked for, nobody says so.)
    pub conserves: bool,
    /// Names and numbers of points of several bodies; empty: there is one.
    pub bodies: Vec<(String, u64)>,
    /// The shortest distances between bodies that are nearer to each other than the horizon or the range of contact.
    pub gaps: Vec<Gap>,
    /// What spreads through the bonds.
    pub diffusions: Vec<DiffusionInfo>,
    /// What acts on sets: tractions, body forces, fluxes, exchanges; of statics before motion first.
    pub loads: Vec<LoadInfo>,
    /// Bonds cut by pre-cracks, directed.
    pub cut: u64,
    /// Ranks that have no points, as there are more of them than blocks of the body.
    pub idle_ranks: u64,
    /// Bytes held by the model.
    pub bytes: usize,
    pub simd: &'static str,
    pub warnings: Warnings,
}

/// A load as a whole.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadInfo {
    /// `"traction"`, `"body force"`, `"heat flux"`, …
    pub what: &'static str,
    pub set: String,
    /// Of the face that it acts on (length^(D−1) times the section).
    pub area: Option<f64>,
    /// At the time when it is largest (force).
    pub force: Option<[f64; 3]>,
    /// What a flux or a source brings at the start (quantity / time).
    pub power: Option<f64>,
    /// Does it change with time?
    pub varies: bool,
}

/// The shortest distance between two bodies in the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Their places in [`Info::bodies`].
    pub bodies: [usize; 2],
    /// Between their nearest points (length).
    pub distance: f64,
    /// Below which points of the two repel, if they were further apart before (length); 0 without contact.
    pub contact: f64,
}

/// What surrounds every point in the reference, in order of point id.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Families {
    /// `[N]` sizes.
    pub size: Vec<u32>,
    /// `[N]` volumes of the partners whose bonds are whole (length^D times the section).
    pub volume: Vec<f64>,
    /// `[N]` indices of materials.
    pub material: Vec<u8>,
    /// `[N]` is there a partner of another material?
    pub foreign: Vec<bool>,
}

/// A directed bond between atoms about the state of now, with `V = φ + (F′ + F′) f`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtomBond {
    /// Ids.
    pub from: u32,
    pub to: u32,
    /// Vector (length); 0 on axes beyond the dimension.
    pub xi: Point,
    /// `V′(r)/r` (force / length).
    pub tension: f64,
    /// `V″(r)` (force / length).
    pub stiffness: f64,
    /// `f′(r)`: what the extension adds to the density at `from`.
    pub share: f64,
}

/// A mode of vibration.
#[derive(Debug, Clone, PartialEq)]
pub struct ModeShape {
    /// `ω²` (1 / time²): round-off of 0 for rigid motions; negative: the state is unstable.
    pub square: f64,
    /// Cycles per time.
    pub frequency: f64,
    /// `[N]` displacement, scaled so that `Σ mass φ² = 1`.
    pub shape: Vec<Point>,
}

/// How points go whose motion is prescribed from outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prescription {
    /// No step moves them; they keep their velocity.
    Still,
    /// Where [`CoSimulation::depart`] is told.
    KinematicPoints,
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Now {
    /// Steps done.
    pub step: u64,
    /// What t is: counted from the start of a stage.
    pub time: f64,
    /// Time as records show it: motion begins at 0, statics before it lies at times below.
    pub clock: f64,
}

/// What is kept of an evaluation of forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Watched {
    /// Energies and dilatations.
    Energies,
    Virial,
    /// The virial of each point.
    Virials,
}

/// What an evaluation of forces saw.
#[derive(Debug, Clone, PartialEq)]
pub enum Seen {
    /// Energies and dilatations.
    Energies(Observed),
    /// Σ over pairs of distance times force, xx yy zz xy xz yz (energy), of bonds and repulsion, positive where pairs repel.
    Virial([f64; 6]),
    /// Half of the virial of its pairs for each point (energy); their sum is that.
    Virials(Vec<[f64; 6]>),
}

/// A wall that points bounce off without loss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    pub axis: usize,
    /// Is the body below it?
    pub above: bool,
    /// Position along the axis (length).
    pub position: f64,
}

/// What a run has come to.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Summary {
    /// Directed bonds broken since the start, as often as they broke.
    pub broken: u64,
    /// Centres of the rigid_bodies of the specification, as they are now (length).
    pub rigid_bodies: Vec<Point>,
    /// What came in of every quantity that spreads since the start, and what is there.
    pub diffusions: Vec<(Quantity, DiffusionAccount)>,
    /// Cycles of load since the start; `None`: increments are no cycles.
    pub cycles: Option<f64>,
    /// What the solver did in the last increment; `None`: steps are steps in time.
    pub solved: Option<Solved>,
    /// What ranks that share the model have had to do in a step since it was made, in their order; nothing of one process.
    pub work: Vec<Work>,
}

/// A running model of any dimension, law and family. All arrays are in order of point id.
///
/// It [owns](Owner) its state: a model of the same specification that reads what this one wrote goes on as this one, bit for bit, and is not
/// [started](Simulation::start).
pub trait Simulation: CoSimulation + Examined + Owner + Send {
    fn info(&self) -> &Info;
    /// Forces at the current state. Call once before the first step, and after changing the state from outside.
    /// `bonds = false` leaves the bonds out, as LAMMPS does in the first set-up of a run.
    fn start(&mut self, bonds: bool);
    /// One step. On an error the state is that of the step before (up to round-off).
    fn step(&mut self) -> Result<(), RunError>;
    /// A question that a long search for an equilibrium asks in every iteration: has somebody had enough? It then ends with
    /// [`SolveError::Stopped`], and the state is that of the increment before.
    fn stop_when(&mut self, stop: fn() -> bool);
    /// How far it is.
    fn now(&self) -> Now;
    /// Energies now; an error if the balance shows that the run has gone unstable.
    fn ledger(&mut self) -> Result<Ledger, RunError>;
    /// Everything that points and bonds have a value of: observables, and what laws declare.
    fn columns(&mut self) -> Vec<Declaration>;
    /// The values of a column, by point id; of one over bonds in the order of [`Interaction::read_column`](crate::interaction::Interaction::read_column). `None`: there is none of this name.
    fn column(&mut self, name: &str) -> Option<Column>;
    /// Displacements and these columns, of what exists; unbroken bonds if asked for. Nothing else is computed.
    fn snapshot(&mut self, fields: &[&str], bonds: bool) -> Snapshot;
    /// Has a frame of displacements and these columns written by ranks, each the points of its [`Share`](ranks::Share) as `asked` says (one line), and
    /// answers what they say of it, in order of ids. `None`: one process has all points, and a [`Snapshot`] of them.
    fn shares(&mut self, fields: &[&str], asked: &str) -> Option<Vec<Vec<u8>>> {
        let _ = (fields, asked);
        None
    }
    /// What the model is now, in two numbers: for a look whether two runs went the same way.
    fn state_hash(&mut self) -> StateHash;
    /// Sets a persistent column of the law, or of what spreads, to numbers as [`Simulation::column`] gives them, those of the dimension's components
    /// only. False: there is no such column of the law, it follows from others, or the number of values is another.
    fn set_column(&mut self, name: &str, values: &[f64]) -> bool;
    /// Values of points `first..first + out.len()` of a component of `reference`, `displacement`, `velocity` or `force_density`, or of `volume` or `density`, without a copy
    /// of the others; 0 on axes beyond the dimension. False: no such column can be read so.
    fn read(&mut self, name: &str, component: usize, first: usize, out: &mut [f64]) -> bool;
    /// Sets a component of `displacement` or `velocity` of points `first..first + values.len()`; axes beyond the dimension do not
    /// exist and are left alone. Call [`Simulation::start`] afterwards. False: the column cannot be set.
    fn write(&mut self, name: &str, component: usize, first: usize, values: &[f64]) -> bool;
    /// Columns of all probes of the specification.
    fn probe_columns(&self) -> Vec<ProbeColumn>;
    /// What the probes measure now, in the order of their columns.
    fn measure(&mut self) -> Vec<f64>;
    /// What the run has come to.
    fn summary(&self) -> Summary;
    /// Number of fragments (connected by whole bonds) now.
    fn fragments(&self) -> u64;
    /// Ids of the points of a named set; `"all"` always exists.
    fn members(&self, set: &str) -> Option<Vec<u32>>;
}

/// What a program gives a model, for points that it knows in the order of their list.
#[derive(Debug, Clone)]
pub enum Given {
    /// Displacements or velocities on these axes.
    Motion(Kind, [bool; 3], Arc<dyn ExternalValues>),
    /// A force among those of conditions.
    Force(Arc<dyn Push>),
}

/// What somebody asks who leads a model step by step: halves of steps, values from outside, blocks of numbers, and what a force
/// evaluation saw.
pub trait CoSimulation {
    /// Where the next step is the first of a motion that follows statics the motion begins, and values of driven conditions may be set for its first forces.
    /// Did it?
    ///
    /// # Errors
    /// As for [`Simulation::step`].
    fn begin_motion(&mut self) -> Result<bool, RunError>;
    /// The first half of a step of a model in time: displacements of its end. Until [`CoSimulation::arrive`] the
    /// velocities are those of the step's middle, forces those of its start; values of driven conditions may be set.
    /// Answers a bound on the path of any point (length). `kinematic`: where the carried points are at the end of the step, in their order.
    ///
    /// # Errors
    /// As for [`Simulation::step`], whose state is left behind then; implicit steps have no halves.
    fn depart(&mut self, kinematic: &[Motion]) -> Result<f64, RunError>;
    /// The second half of a step: the forces at its end.
    ///
    /// # Errors
    /// As for [`Simulation::step`].
    fn arrive(&mut self) -> Result<(), RunError>;
    /// Instead of [`CoSimulation::arrive`]: the state is that before [`CoSimulation::depart`], to rounding.
    fn turn_back(&mut self);
    /// Mirrors points (`None`: all) that are behind the wall, with their velocity across it; between
    /// [`CoSimulation::depart`] and [`CoSimulation::arrive`].
    fn reflect(&mut self, wall: &Wall, ids: Option<&[u32]>);
    /// Points that no force moves. Replaces those of the last call for the same way.
    fn prescribe(&mut self, way: Prescription, ids: &[u32]);
    /// Takes points away for ever, these ids in order: their bonds break without a force, all ids above theirs move down. Driven values must
    /// be set anew before the next forces.
    fn remove(&mut self, ids: &[u32]);
    /// The number of steps and the time, and the length of a step, are these; `None`: stay as they are.
    fn set_clock(&mut self, now: Option<(u64, f64)>, time_step: Option<f64>);
    /// Replace loads, constraints and rigid_bodies; driven conditions go.
    fn set_conditions(
        &mut self,
        conditions: &[crate::spec::ConditionSpec],
        sets: &[(String, Vec<u32>)],
        rigid_bodies: &[crate::spec::RigidBodySpec],
    ) -> Result<(), BuildError>;
    /// One more condition, on these points. It stays, with its account of work; before a motion that follows statics it is one of the motion.
    /// [Start](Simulation::start) afterwards.
    ///
    /// # Errors
    /// Steps cannot take it, or a component is held already; nothing is changed.
    fn give(&mut self, ids: &[u32], what: Given) -> Result<(), BuildError>;
    /// Keep something of the next force evaluation ([`Simulation::start`] or [`Simulation::step`]) as its forces see it: with the bonds that
    /// break in it. LAMMPS prints these.
    fn watch(&mut self, what: Watched);
    /// What the last force evaluation saw. One that was not watched left no energies; virials are then those of the current state with the
    /// bonds that are whole.
    fn watched(&mut self, what: Watched) -> Option<Seen>;
    /// Conditions whose values come from outside, with the ids of the points they act on (`None`: all), in the
    /// order in which they act, after all other forces. Replaces those of the last call. Before a motion that follows statics they are of the motion.
    fn set_driven(&mut self, driven: &[(Drive, Option<Vec<u32>>)]);
    /// Hands driven condition `index` a value for the next force evaluation ([`Simulation::start`] or [`Simulation::step`]); false: there is no such
    /// condition, or it is of another kind.
    fn drive(&mut self, index: usize, value: &Drive) -> bool;
    /// What driven condition `index` had at the last; `None`: there is none.
    fn reaction(&mut self, index: usize) -> Option<Reaction>;
}

/// What somebody asks who examines a model: its families, its answers to strains and displacements, equilibria and vibrations.
pub trait Examined {
    /// Sizes, volumes and materials of all families now.
    fn families(&self) -> Families;
    /// Strain energy density of every point under the homogeneous strain ε (`[3][3]`, no contact, whole bonds).
    fn energy_under_strain(&self, strain: [[f64; 3]; 3]) -> Vec<f64>;
    /// Every directed bond between atoms about the displacements of now; returns F″ of every atom, `None` if the law is
    /// no potential (nothing is visited then).
    fn bonds_of_atoms(&mut self, visit: &mut dyn FnMut(AtomBond)) -> Option<Vec<f64>>;
    /// Force densities under a given displacement (bonds and repulsion in the family, no breaking).
    fn forces_under(&mut self, u: &[Point]) -> Vec<Point>;
    /// The same of the current state.
    fn observed(&mut self) -> Observed;
    /// Every force of a pair now, seen from each of its points: bonds, repulsion inside families, contact; loads and friction are not
    /// among them. False: a law has no forces of single bonds.
    fn each_force(&mut self, visit: &mut dyn FnMut(PointForce)) -> bool;
    /// Brings the bodies into equilibrium without loads and constraints, from the displacements of now: residual forces fall to
    /// `tolerance` of those at the lattice sites. Velocities stay. Afterwards displacements are those of the relaxed state.
    ///
    /// # Errors
    /// The state is unstable, or there is contact; displacements are those of before.
    fn relax(&mut self, tolerance: f64) -> Result<Solved, RunError>;
    /// The linear body about the displacements of now: stiffness block by block, without contact and loads.
    fn linear_body(&mut self) -> AnyLinearBody;
    /// The lowest modes of vibration about the state of now, held where displacements are prescribed, lowest first.
    ///
    /// # Errors
    /// Those of the factorisation.
    fn modes(&mut self, count: usize) -> Result<Vec<ModeShape>, SolveError>;
}

impl dyn Simulation + '_ {
    /// [`Now::step`].
    pub fn step_number(&self) -> u64 {
        self.now().step
    }

    /// [`Now::time`].
    pub fn time(&self) -> f64 {
        self.now().time
    }

    /// [`Now::clock`].
    pub fn clock(&self) -> f64 {
        self.now().clock
    }

    /// As [`CoSimulation::set_clock`].
    pub fn set_time(&mut self, step: u64, time: f64) {
        self.set_clock(Some((step, time)), None);
    }

    /// The same of the length of a step.
    pub fn set_time_step(&mut self, dt: f64) {
        self.set_clock(None, Some(dt));
    }

    /// Values of a column of vectors by point id; none if there is no such column.
    pub fn vectors(&mut self, name: &str) -> Vec<Point> {
        match self.column(name).map(|c| c.values) {
            Some(Values::Vectors(v)) => v,
            _ => vec![],
        }
    }

    /// Values of a column of numbers by point id; none if there is no such column.
    pub fn scalars(&mut self, name: &str) -> Vec<f64> {
        match self.column(name).map(|c| c.values) {
            Some(Values::Scalars(v)) => v,
            _ => vec![],
        }
    }

    /// [`Seen::Virial`]: of the last force evaluation if that was watched, else of the current state.
    pub fn virial(&mut self) -> [f64; 6] {
        match self.watched(Watched::Virial) {
            Some(Seen::Virial(virial)) => virial,
            Some(Seen::Energies(_) | Seen::Virials(_)) | None => [0.0; 6],
        }
    }

    /// [`Summary::broken`].
    pub fn broken(&self) -> u64 {
        self.summary().broken
    }

    /// [`Summary::rigid_bodies`].
    pub fn rigid_bodies(&self) -> Vec<Point> {
        self.summary().rigid_bodies
    }

    /// [`Summary::diffusions`].
    pub fn diffusions(&self) -> Vec<(Quantity, DiffusionAccount)> {
        self.summary().diffusions
    }

    /// [`Summary::cycles`].
    pub fn cycles(&self) -> Option<f64> {
        self.summary().cycles
    }

    /// [`Summary::solved`].
    pub fn solved(&self) -> Option<Solved> {
        self.summary().solved
    }

    /// [`Summary::work`].
    pub fn work_of_ranks(&self) -> Vec<Work> {
        self.summary().work
    }

    pub fn displacements(&mut self) -> Vec<Point> {
        self.vectors("displacement")
    }

    pub fn velocities(&mut self) -> Vec<Point> {
        self.vectors("velocity")
    }

    /// In order of point id.
    pub fn set_displacements(&mut self, u: &[Point]) {
        self.set_vectors("displacement", u);
    }

    /// In order of point id.
    pub fn set_velocities(&mut self, v: &[Point]) {
        self.set_vectors("velocity", v);
    }

    fn set_vectors(&mut self, name: &str, values: &[Point]) {
        for a in 0..3 {
            let component: Vec<f64> = values.iter().map(|x| x[a]).collect();
            self.write(name, a, 0, &component);
        }
    }
}
