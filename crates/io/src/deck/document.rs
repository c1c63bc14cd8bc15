//! The deck as written: one struct per table, nothing interpreted yet.

mod atoms;
mod named;

use super::units::{Constants, UnitSystem};
use super::value::{At, Components, Named, Number, Or, Vector, Written};
pub use atoms::{Buckingham, Eam, EamForm, EndName, LennardJones, Morse, Thermal};
pub use named::{AnyLaw, Given, NamedLaw};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A peridyne deck.
///
/// Numbers are plain (in the deck's units), carry a unit ("0.5 mm"), or are expressions of the constants.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// One line for headers and pictures.
    pub title: Option<String>,
    /// What plain numbers mean: "si" when left out, or { system = "metal", constants = "lammps" }.
    pub units: Option<At<Or<UnitName, Units>>>,
    /// Space dimensions, 1 to 3; follows from the lattice or the mesh when left out.
    pub dimension: Option<At<usize>>,
    /// 2-D only; stress when left out.
    pub plane: Option<At<PlaneName>>,
    /// Thickness of a 2-D body; 1 when left out.
    pub thickness: Option<Number>,
    /// Cross-section of a 1-D body; 1 when left out.
    pub area: Option<Number>,
    /// Named numbers for use in any number.
    #[serde(default)]
    pub constants: BTreeMap<String, Number>,
    /// `[body]`, or `[[body]]` several times: bonds inside each, contact between them.
    #[schemars(with = "Or<Vec<Body>, Body>")]
    pub body: At<Body>,
    /// Those after the first, under the name that [`locate`](super::locate) gives them.
    #[serde(default, rename = "[[body]]")]
    #[schemars(skip)]
    pub more_bodies: Vec<At<Body>>,
    /// Named sets of points; "all" always exists.
    #[serde(default)]
    pub sets: BTreeMap<String, At<Set>>,
    /// `[material]`, or `[material.NAME]` for each of several.
    #[schemars(with = "Or<Material, Named<Material>>")]
    pub material: BTreeMap<String, At<Material>>,
    /// Bonds between unlike materials of one body; series when left out. Or `[[interface]]`, bonds between two of several bodies.
    #[schemars(with = "Option<Or<Vec<Interface>, InterfaceName>>")]
    pub interface: Option<InterfaceName>,
    /// `[[interface]]`, under the name that [`locate`](super::locate) gives them.
    #[serde(default, rename = "[[interface]]")]
    #[schemars(skip)]
    pub interfaces: Vec<At<Interface>>,
    /// { m_ratio = 3 } in lattice spacings, or a length.
    /// Not needed by atoms that talk to their current neighbours.
    pub horizon: Option<At<Or<Written, HorizonRatio>>>,
    /// constant for pmb and inverse for lps when left out.
    pub influence: Option<InfluenceName>,
    /// Scale the partner's volume where its cell straddles the horizon; true when left out.
    pub volume_scaling: Option<bool>,
    /// discrete (the body really has the modulus asked for) when left out.
    pub calibration: Option<CalibrationName>,
    /// auto when left out: a stencil on lattices, a list of a cloud, current neighbours of atoms. Atoms on a "stencil" keep
    /// the neighbours they have in the lattice.
    pub family: Option<FamilyName>,
    /// ["x"]: the body's region spans one period; or { x = "50 mm" }.
    pub periodic: Option<At<Periodic>>,
    /// Factors of bonds near the surface of a lattice body with a bond-based law; none when left out. exact: every uniform
    /// strain is in equilibrium under its uniform traction, and the surface runs through the outermost points.
    pub surface: Option<At<SurfaceName>>,
    /// Factors of the stiffness of bonds (bond-based laws on lattices); all that concern a bond are multiplied.
    #[serde(default)]
    pub bond_factor: Vec<At<BondFactor>>,
    #[serde(default)]
    pub precrack: Vec<At<Precrack>>,
    /// On when a material can fracture or there are several bodies; false turns it off.
    pub contact: Option<Or<bool, Contact>>,
    /// Maxwellian velocities.
    pub thermal: Option<Thermal>,
    #[serde(default)]
    pub initial: Vec<At<Initial>>,
    #[serde(default)]
    pub condition: Vec<At<Condition>>,
    #[serde(default)]
    pub indenter: Vec<At<Indenter>>,
    /// Measurements over time: columns of history.csv.
    #[serde(default)]
    pub probe: Vec<At<Probe>>,
    /// Motion in time; instead of statics.
    pub run: Option<At<Run>>,
    /// Equilibrium under conditions that grow with t; instead of run.
    pub statics: Option<At<Statics>>,
    #[serde(default)]
    pub output: Output,
}

/// Where the points come from: a lattice in a region, or a file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// For messages, and as a set of its points; of several bodies only.
    pub name: Option<At<String>>,
    /// The [material.NAME] that the whole body is made of; of several bodies only.
    pub material: Option<At<String>>,
    /// false: points without bonds, which meet by contact only (powder, a single point); true when left out.
    pub bonded: Option<bool>,
    /// Its own, instead of that of the deck, which counts spacings of each body; of several bodies only.
    pub horizon: Option<At<Or<Written, HorizonRatio>>>,
    /// Its own, instead of that of the deck; of several bodies only.
    pub influence: Option<At<InfluenceName>>,
    /// Its own, stencil or list, instead of that of the deck; of several bodies only.
    pub family: Option<At<FamilyName>>,
    pub lattice: Option<At<LatticeName>>,
    /// Edge of the lattice cell; with a file, the typical distance of points.
    pub spacing: Option<Number>,
    /// Position of one lattice site; 0 when left out.
    pub origin: Option<Vector>,
    pub region: Option<At<Shape>>,
    /// Whole cells along each axis from the origin on, instead of a region.
    pub cells: Option<At<Vec<At<u32>>>>,
    /// Points `x y z volume [mark]` (.txt), a mesh (Abaqus .inp, gmsh .msh as text or binary; its groups are sets), a linear body with its micromoduli (.npz), LAMMPS data of `atom_style peri` (.data, .lmp: volume
    /// and density of each point, the atom type as mark), or atoms: LAMMPS data of `atom_style atomic`, a LAMMPS dump
    /// (.lammpstrj, .dump), extended XYZ (.extxyz). Relative to the deck.
    pub file: Option<At<String>>,
    /// Time step of the frame to take from a dump or extended XYZ; the last frame when left out.
    pub file_step: Option<At<u64>>,
    /// What one unit of the file's coordinates is; the deck's unit of length when left out. Densities of a file are in
    /// the deck's units.
    pub file_unit: Option<Number>,
    pub perturb: Option<Perturb>,
}

/// Random displacement of every site.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Perturb {
    pub amplitude: Number,
    pub seed: u64,
}

/// Bonds between the points of two bodies that are within a horizon of each other in the reference. Without them bodies meet by
/// contact alone.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Interface {
    /// For messages.
    pub name: Option<At<String>>,
    /// Names of the two bodies.
    pub bodies: At<Vec<At<String>>>,
    /// pmb; moduli are those of a full family of the first body at this horizon.
    pub law: At<AnyLaw>,
    /// { m_ratio = 3 } in spacings of the first body, or a length; that of the first body when left out.
    pub horizon: Option<At<Or<Written, HorizonRatio>>>,
    /// constant when left out.
    pub influence: Option<InfluenceName>,
    pub fracture: Option<At<Fracture>>,
}

/// A region of space; its boundary belongs to it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
    Everything,
    Block {
        low: Vector,
        high: Vector,
    },
    Cylinder {
        axis: AxisName,
        center: Option<Vector>,
        radius: Number,
        low: Option<Number>,
        high: Option<Number>,
    },
    /// In 2-D a disk.
    Sphere {
        center: Option<Vector>,
        radius: Number,
    },
    /// Where normal · (x − point) ≤ 0.
    HalfSpace {
        point: Vector,
        normal: Vector,
    },
    Union(Vec<At<Shape>>),
    Difference {
        from: Box<At<Shape>>,
        minus: Vec<At<Shape>>,
    },
    Intersection(Vec<At<Shape>>),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Set {
    /// Only points of this one of several bodies; marks are those of its file.
    pub body: Option<At<String>>,
    pub region: Option<At<Shape>>,
    /// Number or name of a mark in the file.
    pub mark: Option<At<Mark>>,
    /// Points where this expression of x, y, z is not 0, such as "noise(x/l, y/l, 0) > 0.2".
    pub r#where: Option<Number>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Mark {
    Number(i32),
    Name(String),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Set that is made of it; all when left out.
    pub set: Option<At<String>>,
    /// Left out, the densities in the LAMMPS data file are taken; given, it takes their place.
    pub density: Option<Number>,
    /// Mass of a point, instead of the density; of atoms taken from an eam file when left out.
    pub mass: Option<Number>,
    pub law: At<AnyLaw>,
    pub fracture: Option<At<Fracture>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// Bond-based, prototype microelastic brittle: f = c ω ν V s. One of young, bulk, micromodulus; Poisson ratio 1/4, plane
    /// stress 1/3.
    Pmb(Elastic),
    /// Linear peridynamic solid, state-based: W = ½ κ θ² + β/(2m) Σ ω ν V e². Two of young, poisson, bulk, shear.
    Lps(Elastic),
    /// The linear peridynamic solid with the three-dimensional formulas in any dimension: bulk and shear.
    LpsAsTyped(Elastic),
    /// W = E(θ) + bonds, with the two stiffnesses.
    EamLike(EamLike),
    /// Linear springs, the bond-based law linearised about the reference: one of young, bulk, micromodulus.
    Springs(Elastic),
    /// The blocks of a linear body, which is the body's file (.npz).
    Micromoduli,
    /// Atoms: 4ε [(σ/r)¹² − (σ/r)⁶]. Neighbours of atoms are the current ones, or with family = "stencil" those of the lattice.
    LennardJones(LennardJones),
    /// Atoms: D [e^(−2α(r−r0)) − 2 e^(−α(r−r0))].
    Morse(Morse),
    /// Atoms: A e^(−r/ρ) − C/r⁶.
    Buckingham(Buckingham),
    /// Atoms: embedded-atom model from a table, eam/alloy (setfl) or .eam (funcfl).
    Eam(Eam),
    /// Atoms: embedded-atom model in closed form (Mei, Davenport & Fernando 1991).
    EamForm(Box<EamForm>),
    /// A law of the shelf.
    #[serde(skip)]
    Named(NamedLaw),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Elastic {
    pub young: Option<Number>,
    pub poisson: Option<Number>,
    pub bulk: Option<Number>,
    pub shear: Option<Number>,
    /// pmb only, force / volume².
    pub micromodulus: Option<Number>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EamLike {
    pub pair: Number,
    pub volume: Number,
}

/// What plain numbers of a deck mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum UnitName {
    /// m, kg, s
    Si,
    /// Å, ps, eV; masses in g/mol, densities in g/cm³, pressures in bar. Computed in Å, ps, eV throughout.
    Metal,
    /// Reduced units; numbers carry none.
    Lj,
    /// Any consistent units; numbers carry none.
    None,
}

/// A system of units, and the physical constants of metal.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Units {
    pub system: UnitName,
    /// Of metal: codata2018 when left out; lammps gives LAMMPS's kinetic energies, temperatures and pressures.
    pub constants: Option<At<Constants>>,
}

impl UnitName {
    pub fn system(self, constants: Constants) -> UnitSystem {
        match self {
            UnitName::Si => UnitSystem::Si,
            UnitName::Metal => UnitSystem::Metal(constants),
            UnitName::Lj => UnitSystem::Lj,
            UnitName::None => UnitSystem::None,
        }
    }
}

/// When a bond past its critical stretch lets go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReleaseName {
    /// In the force evaluation that finds it there, as in CabanaPD.
    AtOnce,
    /// After the force of that evaluation, as in LAMMPS: it pulls once more.
    AfterForce,
}

/// One of critical_stretch and energy.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fracture {
    pub critical_stretch: Option<Number>,
    /// Fracture energy per area.
    pub energy: Option<Number>,
    /// Strengthening under compression, s0 = s00 − α s_min; 0 when left out.
    pub alpha: Option<Number>,
    /// at_once when left out; the same for all materials.
    pub release: Option<At<ReleaseName>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HorizonRatio {
    pub m_ratio: Number,
}

/// Axes whose period is the region, or the period of each.
pub type Periodic = Or<Vec<At<AxisName>>, Periods>;

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Periods {
    pub x: Option<Number>,
    pub y: Option<Number>,
    pub z: Option<Number>,
}

/// A heterogeneous body, or a weak plane.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BondFactor {
    /// Expression of x, y, z; a bond gets the mean of both ends by the rule of `interface`. With crossing: a number.
    pub value: Number,
    /// Only bonds that cross this shape.
    pub crossing: Option<At<FlatShape>>,
}

/// One of segment, disk, polygon, point.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlatShape {
    /// 2-D, or endless along z.
    pub segment: Option<Segment>,
    pub disk: Option<Disk>,
    /// Three or more corners.
    pub polygon: Option<At<Vec<Vector>>>,
    /// 1-D.
    pub point: Option<Number>,
}

/// One of segment, disk, polygon, point.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Precrack {
    /// 2-D, or endless along z.
    pub segment: Option<Segment>,
    pub disk: Option<Disk>,
    /// Three or more corners.
    pub polygon: Option<At<Vec<Vector>>>,
    /// 1-D.
    pub point: Option<Number>,
    /// absent (never there; when left out) or broken (counted as damage).
    pub kind: Option<CrackName>,
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    pub from: Vector,
    pub to: Vector,
}

#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disk {
    pub center: Vector,
    pub normal: Vector,
    pub radius: Number,
}

/// Short-range repulsion.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Fraction of the reference distance below which any pair repels; 0.9 when left out.
    pub bonded: Option<Number>,
    /// Range in spacings; 1.35 when left out.
    pub free: Option<Number>,
    /// Force / volume² / length; from the law when left out.
    pub stiffness: Option<Number>,
    /// Coulomb friction between points that were never bonded; 0 when left out.
    pub friction: Option<Number>,
}

/// Values at t = 0, expressions of x, y, z.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// A set, or a region; everything when both are left out.
    pub set: Option<At<String>>,
    pub region: Option<At<Shape>>,
    pub displacement: Option<Components>,
    pub velocity: Option<Components>,
}

/// What is done to a set during the run, expressions of reference x, y, z and t.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condition {
    /// A set, or a region; everything when both are left out.
    pub set: Option<At<String>>,
    pub region: Option<At<Shape>>,
    pub displacement: Option<Components>,
    pub velocity: Option<Components>,
    /// Force / volume.
    pub body_force: Option<Components>,
    /// Force / area.
    pub traction: Option<Components>,
    /// Area over which the traction is spread; one lattice face per point when left out.
    pub area: Option<Number>,
    /// Viscous force density / velocity.
    pub damping: Option<Number>,
}

/// A rigid sphere; moved as its centre (an expression of t) says, or free when it has a mass.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Indenter {
    /// Force density / length².
    pub stiffness: Number,
    pub radius: Number,
    pub center: Vector,
    pub velocity: Option<Vector>,
    pub mass: Option<Number>,
}

/// A measurement of a set of points; its columns of history.csv begin with its name.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    pub name: At<String>,
    /// All points when left out.
    pub set: Option<At<String>>,
    pub measure: At<MeasureName>,
    /// Field that is measured (`peridyne laws` lists them); of mean, min, max, sum and value.
    pub of: Option<At<String>>,
    /// x, xy, … or magnitude; all components when left out.
    pub component: Option<At<String>>,
    /// Fixed point of a moment.
    pub about: Option<Vector>,
    /// Place in the reference; of value.
    pub at: Option<Vector>,
    /// Two opposite corners of a rectangle around the tip of a crack, three horizons to every side at least; of contour.
    pub corners: Option<At<Vec<Vector>>>,
    /// Where the crack grows to; of contour, [1, 0] when left out.
    pub direction: Option<Vector>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    pub steps: Option<At<u64>>,
    /// Instead of steps.
    pub duration: Option<Number>,
    /// A time, or { safety = 0.8 } of the estimated limit (when left out).
    pub time_step: Option<At<Or<Written, Safety>>>,
    /// Run even if the step is above the stability limit.
    #[serde(default)]
    pub force_unstable: bool,
    /// verlet when left out. newmark is implicit: stable at any step, which must be given, and without fracture and contact.
    pub integrator: Option<At<IntegratorName>>,
    /// newmark: 1/4 when left out.
    pub beta: Option<Number>,
    /// newmark: 1/2 when left out; more damps what is fast beside the step.
    pub gamma: Option<Number>,
    /// newmark: auto when left out, factors of small systems, conjugate gradients of large ones.
    pub solver: Option<At<SolverName>>,
    /// newmark: residual force over loads, reactions and inertia; 1e-10 when left out.
    pub tolerance: Option<Number>,
    /// newmark: iterations of conjugate gradients; 100,000 when left out.
    pub iterations: Option<At<usize>>,
    pub threads: Option<At<usize>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Statics {
    /// linear (about the reference) when left out; newton for large deformation, relaxation for contact.
    pub method: Option<MethodName>,
    /// auto when left out: factors of small systems, conjugate gradients of large ones.
    pub solver: Option<SolverName>,
    /// Increments of load while t goes from 0 to 1; 1 when left out, and 0 looks at modes only.
    pub increments: Option<At<u64>>,
    /// Residual force over loads and reactions; 1e-10 when left out, 1e-8 with newton, 1e-6 with relaxation.
    pub tolerance: Option<Number>,
    /// Iterations of conjugate gradients or of relaxation; 100,000 when left out.
    pub iterations: Option<At<usize>>,
    /// So many lowest modes of vibration about the last state; modes.csv and modes.pvd.
    pub modes: Option<At<usize>>,
    pub threads: Option<At<usize>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MethodName {
    Linear,
    Newton,
    Relaxation,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolverName {
    Auto,
    Direct,
    Cg,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Safety {
    pub safety: Number,
}

#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Folder of the results, relative to the deck; when left out, out/NAME in the working folder for the deck NAME.toml.
    pub dir: Option<String>,
    /// Steps between frames; only the first and the last state when left out.
    pub every: Option<At<u64>>,
    /// Point fields of a frame, by name (`peridyne laws` lists them), displacements always; displacement, velocity, damage,
    /// energy_density, dilatation, mark when left out.
    pub fields: Option<Vec<At<String>>>,
    /// VTU series for ParaView; true when left out.
    pub vtu: Option<bool>,
    /// Unbroken bonds as lines, too.
    #[serde(default)]
    pub bonds: bool,
    /// The linear body about the last state as linear_body.npz (NumPy): points and micromoduli.
    #[serde(default)]
    pub linear_body: bool,
    /// LAMMPS dump of this name, in the folder of the results: frames of points with their fields, of atoms with velocities,
    /// forces and energies.
    pub dump: Option<At<String>>,
    /// Steps between rows of history.csv; a hundredth of the run when left out.
    pub history: Option<At<u64>>,
    /// PNG of the damage at the end; when left out, true, and false for atoms.
    pub picture: Option<bool>,
    /// Atoms only: one file with all frames, positions, velocities, forces and energies; .extxyz, or .lammpstrj for a
    /// LAMMPS dump.
    pub trajectory: Option<At<String>>,
    /// Atoms only: LAMMPS data file (`atom_style atomic`, with velocities) of the last state.
    pub data: Option<At<String>>,
}

macro_rules! names {
    ($($(#[$doc:meta])* $name:ident { $($(#[$each:meta])* $variant:ident),+ $(,)? })+) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
        #[serde(rename_all = "snake_case")]
        pub enum $name { $($(#[$each])* $variant),+ }
    )+};
}

names! {
    PlaneName { Stress, Strain }
    LatticeName { Chain, Square, Triangular, Cubic, Bcc, Fcc, Diamond }
    AxisName { X, Y, Z }
    InterfaceName {
        /// Harmonic mean: the two half bonds in series.
        Series,
        /// Arithmetic mean: side by side.
        Parallel,
        /// The weaker of both, as LAMMPS does.
        Minimum,
    }
    InfluenceName {
        /// 1
        Constant,
        /// 1/ξ
        Inverse,
        /// 1 − ξ/δ
        Conical,
        /// exp(−(2ξ/δ)²)
        Gaussian,
        /// Cubic B-spline with support δ, 1 at ξ = 0.
        CubicSpline,
    }
    CalibrationName {
        /// Constants from the integrals over the full ball.
        Continuum,
        /// Constants from the sums over a full family of this body.
        Discrete,
    }
    SurfaceName {
        None,
        /// Every uniform strain is an equilibrium under its uniform traction.
        Exact,
        /// By the volume of the families.
        Volume,
        /// By the strain energy under uniaxial stretch.
        Energy,
        /// By the stiffness that a point feels when the rest stands still.
        Force,
    }
    FamilyName {
        /// Stencil on lattices, list of a cloud, current neighbours of atoms.
        Auto,
        /// Offsets of a lattice, nothing stored per bond.
        Stencil,
        /// Stored bonds of the reference.
        List,
        /// Atoms within the cut-off now.
        Neighbours,
    }
    /// How a motion goes on in time.
    IntegratorName {
        /// Velocity Verlet: explicit, stable below a limit of the step.
        Verlet,
        /// Newmark's method: implicit, stable at any step.
        Newmark,
    }
    MeasureName {
        /// Force that constraints exert on the set, per axis.
        Reaction,
        /// Moment of that force about a fixed point.
        Moment,
        /// Kinetic, strain and repulsion energy of the set.
        Energy,
        /// Mean of a field over the points of the set.
        Mean,
        /// Smallest value.
        Min,
        /// Largest value.
        Max,
        /// Sum over the points.
        Sum,
        /// A field at the point of the set that is nearest to a place.
        Value,
        /// J-integral and stress intensity K of a crack tip (2-D statics), by a rectangle around it.
        Contour,
    }
    CrackName {
        /// Bonds that never were.
        Absent,
        /// Bonds that count as damage.
        Broken,
    }
}

impl MeasureName {
    /// As it is written.
    pub fn title(self) -> &'static str {
        match self {
            MeasureName::Reaction => "reaction",
            MeasureName::Moment => "moment",
            MeasureName::Energy => "energy",
            MeasureName::Mean => "mean",
            MeasureName::Min => "min",
            MeasureName::Max => "max",
            MeasureName::Sum => "sum",
            MeasureName::Value => "value",
            MeasureName::Contour => "contour",
        }
    }
}
