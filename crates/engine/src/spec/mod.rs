//! The specification of a run: plain data, no behaviour, in one consistent unit system.
//!
//! A front end (deck, LAMMPS script, another program) fills a [`Spec`]; `run::build` makes a model of it.

mod surface;

use crate::expression::Expression;
pub use crate::law::potential::PotentialSpec;
use crate::space::lattice::LatticeKind;
use crate::space::region::Region;
use crate::statics::{AnyLinearBody, LinearBody};
use std::sync::Arc;
pub use surface::{SurfaceFactors, SurfaceMethod};

/// Everything a run is.
#[derive(Debug, Clone)]
pub struct Spec {
    /// One line for headers and pictures.
    pub title: String,
    /// Space dimensions: 1, 2 or 3.
    pub dimension: usize,
    /// Plane stress or plane strain (2-D only; ignored elsewhere).
    pub plane: Plane,
    /// Thickness of a 2-D body or cross-section of a 1-D body (length, length²); 1 in 3-D.
    pub section: f64,
    pub body: BodySpec,
    /// Named sets of points, in order; `"all"` always exists. Sets may overlap.
    pub sets: Vec<SetSpec>,
    /// Materials; point sets that name them must cover the body without overlap.
    pub materials: Vec<MaterialSpec>,
    /// Interatomic potential of materials whose law is [`LawSpec::Atoms`].
    pub potential: Option<PotentialSpec>,
    /// Micromoduli of materials whose law is [`LawSpec::Micromoduli`], in order of the points of a cloud.
    pub micromoduli: Option<Arc<AnyLinearBody>>,
    /// How bonds between unlike materials get their stiffness.
    pub interface: InterfaceRule,
    /// What pairs of materials have instead of what follows from the two, `[of][with]`; empty: nothing. Their bonds
    /// are in lists.
    pub pairs: Vec<PairSpec>,
    /// When a bond past its critical stretch lets go.
    pub release: Release,
    pub horizon: Horizon,
    /// Scale the partner's volume linearly where its cell straddles the horizon (`lammps-peri` item 3).
    pub volume_scaling: bool,
    /// Calibrate stiffness constants to the discrete bulk family, or use the continuum integrals.
    pub calibration: Calibration,
    /// Influence function ω.
    pub influence: Influence,
    /// Periodic axes; the period is the box of the lattice body or `period`.
    pub periodic: [Option<f64>; 3],
    /// Factors of bonds near the surface; `None`: all 1.
    pub surface: Option<SurfaceFactors>,
    /// Factors of bonds anywhere; all that concern a bond are multiplied.
    pub bonds: Vec<BondFactorSpec>,
    pub precracks: Vec<PrecrackSpec>,
    pub contact: Option<ContactSpec>,
    pub initial: Vec<InitialSpec>,
    /// Maxwellian velocities, given before those of `initial`.
    pub thermal: Option<ThermalSpec>,
    pub conditions: Vec<ConditionSpec>,
    pub indenters: Vec<IndenterSpec>,
    /// Which family enumerates the bonds; `Auto` takes the stencil for lattice bodies, the list otherwise.
    pub family: FamilyChoice,
    pub schedule: Schedule,
}

impl Spec {
    /// One material on a body, everything else as plain as it can be: no influence function or volume scaling, free
    /// surfaces, a horizon of one spacing, 0.8 of the stable step. Change what you need.
    pub fn new(dimension: usize, body: BodySpec, density: f64, law: LawSpec) -> Spec {
        Spec {
            title: String::new(),
            dimension,
            plane: Plane::Stress,
            section: 1.0,
            body,
            sets: vec![],
            materials: vec![MaterialSpec {
                name: "all".into(),
                set: "all".into(),
                density,
                law,
                fracture: None,
            }],
            potential: None,
            micromoduli: None,
            interface: InterfaceRule::Series,
            pairs: vec![],
            release: Release::AtOnce,
            horizon: Horizon::Ratio(1),
            volume_scaling: false,
            calibration: Calibration::Discrete,
            influence: Influence::Constant,
            periodic: [None; 3],
            surface: None,
            bonds: vec![],
            precracks: vec![],
            contact: None,
            initial: vec![],
            thermal: None,
            conditions: vec![],
            indenters: vec![],
            family: FamilyChoice::Auto,
            schedule: Schedule {
                steps: 0,
                time_step: TimeStep::Auto,
                force_unstable: false,
                statics: None,
            },
        }
    }
}

impl Spec {
    /// A linear body that can be run.
    pub fn of_linear<const D: usize>(body: &LinearBody<D>) -> Spec {
        let pad = |x: &[f64; D]| std::array::from_fn(|a| if a < D { x[a] } else { 0.0 });
        let cloud = Cloud {
            position: body.position.iter().map(pad).collect(),
            volume: body.volume.clone(),
            density: body.density.clone(),
            ..Cloud::default()
        };
        let mut spec = Spec::new(D, BodySpec::Cloud(cloud), 1.0, LawSpec::Micromoduli);
        spec.horizon = Horizon::Length(body.range() * (1.0 + 1e-9));
        for a in 0..D {
            spec.periodic[a] = body.period[a];
        }
        spec.micromoduli = AnyLinearBody::new(body.clone()).map(Arc::new);
        spec
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plane {
    Stress,
    Strain,
}

/// Where the points come from.
#[derive(Debug, Clone)]
pub enum BodySpec {
    /// Sites of a lattice inside a region (boundary included, decided by integers where the region allows it).
    Lattice {
        kind: LatticeKind,
        /// Cell edge (length).
        spacing: f64,
        /// Position of the first basis site (length).
        origin: [f64; 3],
        region: Region,
        /// Random displacement of every site, uniform in ±`amplitude` per axis (length), and its seed;
        /// the body is then a cloud with the lattice's cell volumes.
        perturb: Option<Perturbation>,
    },
    /// Given lattice sites, in quarters of the cell's edges (see [`crate::space::lattice::Lattice::position`]).
    Sites {
        kind: LatticeKind,
        spacing: f64,
        origin: [f64; 3],
        quarters: Vec<[i32; 3]>,
        volume: Option<f64>,
    },
    /// Points with volumes and marks.
    Cloud(Cloud),
    /// Bodies side by side: bonds inside each, contact between them. Their points come one after another.
    Several(Vec<PieceSpec>),
}

/// A body among several.
#[derive(Debug, Clone)]
pub struct PieceSpec {
    /// For messages, and for [`Members::Within`].
    pub name: String,
    /// One lattice or cloud.
    pub body: BodySpec,
    /// `false`: loose points (powder), which have contact only.
    pub bonded: bool,
}

impl BodySpec {
    /// Cell edge or typical distance of points, where the spec says it.
    pub fn spacing(&self) -> Option<f64> {
        match self {
            BodySpec::Lattice { spacing, .. } | BodySpec::Sites { spacing, .. } => Some(*spacing),
            BodySpec::Cloud(c) => c.spacing,
            // of all, if it is the same
            BodySpec::Several(pieces) => {
                let first = pieces.first()?.body.spacing()?;
                let same = |p: &PieceSpec| p.body.spacing() == Some(first);
                pieces.iter().all(same).then_some(first)
            }
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Perturbation {
    pub amplitude: f64,
    pub seed: u64,
}

/// A free cloud of points.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cloud {
    /// `[N]` positions (length).
    pub position: Vec<[f64; 3]>,
    /// `[N]` volumes (length^D times the section).
    pub volume: Vec<f64>,
    /// `[N]` mass densities, or empty: those of the materials.
    pub density: Vec<f64>,
    /// `[N]` marks, or empty: all 0.
    pub mark: Vec<i32>,
    /// `[N]` velocities at the start, or empty: 0. Given after thermal ones, before `initial`.
    pub velocity: Vec<[f64; 3]>,
    /// Names of marks (physical groups, element sets): `(mark, name)`.
    pub names: Vec<(i32, String)>,
    /// Named sets that marks cannot say: points by their place, rising.
    pub sets: Vec<(String, std::sync::Arc<[u32]>)>,
    /// Typical distance of nearest neighbours (length): volume scaling and contact use it. `None`: the cube root
    /// (D-th root) of the mean volume over the section.
    pub spacing: Option<f64>,
}

/// A named set of points.
#[derive(Debug, Clone)]
pub struct SetSpec {
    pub name: String,
    pub members: Members,
}

#[derive(Debug, Clone)]
pub enum Members {
    All,
    Region(Region),
    /// Points whose mark is this number.
    Mark(i32),
    /// Points at whose reference position this is not 0 (x, y, z; t = 0).
    Where(Expression),
    /// Points of a cloud by their place in it, rising.
    Points(std::sync::Arc<[u32]>),
    /// Those of one of several bodies, by its name.
    Within {
        body: String,
        members: Box<Members>,
    },
}

/// A material on a set of points.
#[derive(Debug, Clone)]
pub struct MaterialSpec {
    pub name: String,
    /// Set that is made of it; `"all"` when there is one material.
    pub set: String,
    /// Mass density (mass / length³).
    pub density: f64,
    pub law: LawSpec,
    /// `None`: bonds never break.
    pub fracture: Option<FractureSpec>,
}

/// The constitutive law of a material. All materials of a body use the same kind of law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LawSpec {
    /// Prototype microelastic brittle (bond-based).
    Pmb(PmbStiffness),
    /// Linear peridynamic solid (state-based).
    Lps(Moduli),
    /// Linear peridynamic solid with the three-dimensional formulas and the moduli as typed, in any dimension
    /// (what LAMMPS's `peri/lps` does): bulk and shear modulus.
    LpsAsTyped { bulk: f64, shear: f64 },
    /// `W = E(ϑ) + ½Σ κ-bonds` with the quadratic `E` of seleson2014 (A.16) and `κ` of (A.14): `κ = k ω e / m`,
    /// `P = −(p/m) θ` with the two stiffnesses given directly (seleson2014 (A.24): `k = k̄`, `p = c̄/3`).
    EamLike { pair: f64, volume: f64 },
    /// Linear springs: the bond-based solid linearised about the reference (lattice bodies).
    Springs(PmbStiffness),
    /// The potential of [`Spec::potential`]: on the lattice's fixed neighbours (family `Stencil`), or between atoms that
    /// are near now (`Neighbours`, or `Auto`).
    Atoms,
    /// The blocks of [`Spec::micromoduli`].
    Micromoduli,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PmbStiffness {
    /// Micromodulus c as typed (force / volume² ).
    Micromodulus(f64),
    /// Bulk modulus K (2-D: of the plane).
    Bulk(f64),
    /// Young's modulus E; Poisson's ratio is fixed by dimension (¼; plane stress ⅓).
    Young(f64),
}

/// Isotropic moduli, any two of which may be given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moduli {
    pub young: f64,
    pub poisson: f64,
}

impl Moduli {
    /// From bulk and shear modulus of the three-dimensional solid.
    pub fn from_bulk_shear(bulk: f64, shear: f64) -> Self {
        Moduli {
            young: 9.0 * bulk * shear / (3.0 * bulk + shear),
            poisson: (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)),
        }
    }
    pub fn bulk(&self) -> f64 {
        self.young / (3.0 * (1.0 - 2.0 * self.poisson))
    }
    pub fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }
    /// First Lamé constant λ of the three-dimensional solid.
    pub fn lame(&self) -> f64 {
        self.bulk() - 2.0 / 3.0 * self.shear()
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FractureSpec {
    pub criterion: Criterion,
    /// Dependence of the critical stretch on compression: `s0 = s00 − α s_min`.
    pub alpha: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Criterion {
    /// Critical stretch s00 (–).
    Stretch(f64),
    /// Fracture energy (energy / area).
    Energy(f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InterfaceRule {
    /// Harmonic mean: the two half bonds in series.
    Series,
    /// Arithmetic mean: in parallel.
    Parallel,
    Minimum,
}

/// When a bond past its critical stretch lets go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Release {
    /// In the force evaluation that finds it there (CabanaPD). The dilatation of that evaluation still has it.
    #[default]
    AtOnce,
    /// After the force of that evaluation: it pulls once more (LAMMPS).
    AfterForce,
}

/// What points of one material have in their bonds with points of another (LAMMPS's `pair_coeff I J`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairSpec {
    /// At most the horizon of the spec (length); 0: no bonds.
    pub horizon: f64,
    /// `Pmb` with a micromodulus; `LpsAsTyped`: moduli with which both scalars act on the point, whatever its partner
    /// is made of. With unlike moduli forces are then not opposite, and no energy is conserved.
    pub law: LawSpec,
    /// Critical stretch s00 of those bonds, and how it depends on compression: a point's s0 is the greatest
    /// `s00 − α s` of its whole bonds.
    pub critical_stretch: f64,
    pub alpha: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Horizon {
    /// Whole number of lattice spacings, inclusive, by integers.
    Ratio(u32),
    /// A length, inclusive.
    Length(f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Calibration {
    /// Constants from the integrals over the full ball (disk, segment) of radius δ.
    Continuum,
    /// Constants from the sums over a full family in the bulk of this very body.
    Discrete,
}

/// Influence functions ω(ξ) of the bond length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Influence {
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

impl Influence {
    pub const ALL: [Influence; 5] = [
        Influence::Constant,
        Influence::Inverse,
        Influence::Conical,
        Influence::Gaussian,
        Influence::CubicSpline,
    ];
}

/// A factor of the stiffness of bonds: heterogeneous bodies, weak planes.
#[derive(Debug, Clone)]
pub enum BondFactorSpec {
    /// Every bond gets the mean, by [`Spec::interface`], of the factors at its ends' reference positions.
    Field(Expression),
    /// Bonds that cross this shape.
    Crossing { shape: CrackShape, factor: f64 },
}

/// Bonds that a pre-crack cuts.
#[derive(Debug, Clone)]
pub struct PrecrackSpec {
    pub shape: CrackShape,
    pub kind: CrackKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrackKind {
    /// The bonds were never there: not counted in damage.
    Absent,
    /// The bonds are broken at the start: counted as damage.
    Broken,
}

/// Flat shapes that cut bonds crossing them.
#[derive(Debug, Clone)]
pub enum CrackShape {
    /// Segment between two points (2-D; in 3-D extruded along z without end).
    Segment { from: [f64; 3], to: [f64; 3] },
    /// Disk with centre, unit normal and radius (3-D).
    Disk {
        center: [f64; 3],
        normal: [f64; 3],
        radius: f64,
    },
    /// Flat polygon with three or more corners (3-D).
    Polygon { corners: Vec<[f64; 3]> },
    /// Point on a chain (1-D).
    Point { x: f64 },
}

/// Short-range repulsion (`lammps-peri` item 10): force density `stiffness V_j (r − d)`,
/// `d = min(bonded r0, free h)` with `h` the spacing.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSpec {
    /// Fraction of the reference distance below which any pair repels; 0.9 in LAMMPS.
    pub bonded: f64,
    /// Range in spacings for pairs far apart in the reference; 1.35 in LAMMPS.
    pub free: f64,
    pub stiffness: ContactStiffness,
}

/// Stiffness of repulsion (force / volume² / length).
#[derive(Debug, Clone, PartialEq)]
pub enum ContactStiffness {
    /// `15 c/δ` (PMB), `15·18K/(πδ⁵)` (LPS) of a material; between unlike ones the harmonic mean, which is that of the
    /// two in series: each gives way by its own stiffness, and it is never above twice the softer one's.
    Laws,
    /// The same for all pairs.
    Same(f64),
    /// `[materials][materials]`, symmetric: of every pair of materials.
    Pairs(Vec<Vec<f64>>),
}

/// Initial values on a set; components are expressions of x, y, z (t = 0); `None` leaves a component.
#[derive(Debug, Clone)]
pub struct InitialSpec {
    pub set: String,
    pub displacement: [Option<Expression>; 3],
    pub velocity: [Option<Expression>; 3],
}

/// Velocities of a given temperature: normally distributed, without total momentum, scaled to the temperature exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThermalSpec {
    /// k_B T (energy).
    pub energy: f64,
    pub seed: u64,
}

/// What is done to a set during the run; expressions of reference x, y, z and t; `None` leaves a component free.
#[derive(Debug, Clone)]
pub struct ConditionSpec {
    pub set: String,
    pub kind: ConditionKind,
}

#[derive(Debug, Clone)]
pub enum ConditionKind {
    /// Prescribed displacement (length).
    Displacement([Option<Expression>; 3]),
    /// Prescribed velocity (length / time).
    Velocity([Option<Expression>; 3]),
    /// Body force density (force / volume).
    BodyForce([Option<Expression>; 3]),
    /// Traction (force / area) on the set, spread over its points by volume; the area defaults to one lattice
    /// face (`spacing^(D−1)` times the section) per point.
    Traction {
        value: [Option<Expression>; 3],
        area: Option<f64>,
    },
    /// The force density on these components becomes this, whatever else acts (LAMMPS `fix setforce`).
    SetForce([Option<Expression>; 3]),
    /// Viscous force density −c v (mass / volume / time).
    Damping(Expression),
}

/// A rigid sphere that pushes points out with force density `K (r − R)²` (`lammps-peri` item 13).
#[derive(Debug, Clone)]
pub struct IndenterSpec {
    /// Stiffness K (force density / length²).
    pub stiffness: f64,
    pub radius: f64,
    pub motion: IndenterMotion,
}

#[derive(Debug, Clone)]
pub enum IndenterMotion {
    /// Centre as a function of t (x, y, z in the expressions are 0).
    Kinematic([Expression; 3]),
    /// A body with mass, start and initial velocity.
    Free {
        mass: f64,
        center: [f64; 3],
        velocity: [f64; 3],
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FamilyChoice {
    Auto,
    Stencil,
    List,
    /// Current neighbours within the cut-off of a potential.
    Neighbours,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    pub steps: u64,
    pub time_step: TimeStep,
    /// Run even if the step is above the stability limit.
    pub force_unstable: bool,
    /// Every step is an increment of load that ends in equilibrium; `time_step` is what t grows by.
    pub statics: Option<Statics>,
}

/// How equilibrium is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statics {
    pub method: Method,
    pub solver: Solver,
    /// Residual force over loads and reactions.
    pub tolerance: f64,
    /// Of conjugate gradients or relaxation, per solution.
    pub most_iterations: usize,
}

impl Default for Statics {
    /// The linear solution to 1e-10.
    fn default() -> Self {
        Statics {
            method: Method::Linear,
            solver: Solver::Auto,
            tolerance: 1e-10,
            most_iterations: 100_000,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The equations linear about the reference.
    Linear,
    /// Newton's method: large deformation.
    Newton,
    /// Adaptive dynamic relaxation: contact, and what Newton's method does not find.
    Relaxation,
}

/// How linear equations are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// Factors where they are small, else conjugate gradients.
    Auto,
    Direct,
    ConjugateGradients,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeStep {
    Fixed(f64),
    /// Fraction of the estimated stability limit.
    Fraction(f64),
    /// The engine chooses: 80 % of the limit for peridynamic points; for atoms a tenth of it (a thirtieth of the shortest
    /// period), and less where they are fast.
    Auto,
}
