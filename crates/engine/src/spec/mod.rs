//! The specification of a run: plain data, no behaviour, in one consistent unit system.
//!
//! A front end (deck, LAMMPS script, another program) fills a [`Spec`]; `run::build` makes a model of it. What laws and
//! linear bodies do stands in [`law`](crate::law) and [`statics`](crate::statics); nothing here reads them.

mod atoms;
mod body;
mod bonded;
mod bonds;
mod carriers;
mod cohesion;
mod condition;
mod family;
mod indenter;
mod interface;
mod law;
mod linear_body;
mod mass_matrix;
mod parameters;
mod potential;
mod preload;
mod probe;
mod rows;
mod schedule;
mod smooth;
mod surface;
mod table;
mod transfer;

use crate::expression::Expression;
pub use atoms::{Acting, ActingSpec, Mixing};
pub use body::{BodySpec, Cloud, Members, Perturbation, PieceSpec, SetSpec};
pub use bonded::{BondedSpec, BondedTerm, Form};
pub use bonds::{
    AtRest, BondFactorSpec, ContactSpec, ContactStiffness, CrackKind, CrackShape, FrictionSpec,
    HealingSpec, PrecrackSpec, ToughnessFactor, ToughnessSpec,
};
pub use carriers::Carriers;
pub use cohesion::CohesionSpec;
pub use condition::{ConditionKind, ConditionSpec, ForceSpec, InitialSpec, ThermalSpec};
pub use family::{Calibration, FamilyChoice, Formula, Horizon, Influence};
pub use indenter::{FreeSpec, IndenterMotion, IndenterSpec, TurnSpec};
pub use interface::InterfaceSpec;
pub use law::{
    Criterion, FatigueSpec, FractureSpec, InterfaceRule, LawSpec, MaterialSpec, Moduli, NamedLaw,
    PairSpec, PmbStiffness, RateSpec, Release,
};
pub use linear_body::{AnyLinearBody, LinearBody};
pub use mass_matrix::MassMatrix;
pub use parameters::{Parameter, Parameters};
pub use potential::{End, PotentialSpec};
pub use preload::PreloadSpec;
pub use probe::{ContourSpec, Fold, Measure, Part, ProbeSpec, RigidQuantity};
pub(crate) use rows::add_alike;
pub use schedule::{
    Control, Cycles, Integrator, Method, Newmark, Schedule, Solver, Statics, Stepper, TimeStep,
};
pub use smooth::{SmoothSpec, Window};
use std::sync::Arc;
pub use surface::{SurfaceFactor, SurfaceFactors, SurfaceMethod};
pub use table::{PartnerTable, TableSpec};
pub use transfer::{
    Area, Exchange, Quantity, TransferCondition, TransferKind, TransferMaterial, TransferMethod,
    TransferSpec,
};

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
    /// How bonds between unlike materials get their stiffness.
    pub interface: InterfaceRule,
    /// Bonds between bodies, where there are several; the others meet by contact alone.
    pub interfaces: Vec<InterfaceSpec>,
    /// What pairs of materials have instead of what follows from the two, `[of][with]`; empty: nothing. Their bonds
    /// are in lists.
    pub pairs: Vec<PairSpec>,
    /// Potentials of atoms besides those that are the laws of materials.
    pub potentials: Vec<ActingSpec>,
    /// How constants of pairs of unlike atoms follow, where no potential is given for them; `None`: they must be given.
    pub mixing: Option<Mixing>,
    /// Factors of the toughness of points.
    pub toughness: Vec<ToughnessSpec>,
    /// Which broken bonds become whole again; `None`: none.
    pub healing: Option<HealingSpec>,
    /// When a bond past its critical stretch lets go.
    pub release: Release,
    pub horizon: Horizon,
    /// Horizon of each point of a cloud (length), an expression of x, y, z, at most `horizon`; `None`: all have that.
    pub own_horizon: Option<Expression>,
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
    /// What points say that are bonded to each other whatever moves, beside their potential.
    pub bonded: Option<std::sync::Arc<BondedSpec>>,
    /// Boltzmann's constant in these units (energy / temperature); 1 where temperatures are energies.
    pub boltzmann: f64,
    /// Maxwellian velocities, given before those of `initial`.
    pub thermal: Option<ThermalSpec>,
    pub conditions: Vec<ConditionSpec>,
    pub indenters: Vec<IndenterSpec>,
    /// What spreads through the bonds of the reference, each quantity once.
    pub transfers: Vec<TransferSpec>,
    /// Which family enumerates the bonds; `Auto` takes the stencil for lattice bodies, the list otherwise.
    pub family: FamilyChoice,
    /// Nodes that carry the atoms of a reference family along; `None`: the atoms move.
    pub smooth: Option<SmoothSpec>,
    /// Statics that the motion of the schedule begins from.
    pub preload: Option<PreloadSpec>,
    pub schedule: Schedule,
    /// Columns of points that the caller will ask for, by name; a name that does not exist is an error. `None`: what is usual.
    pub fields: Option<Vec<String>>,
    /// What is measured over time.
    pub probes: Vec<ProbeSpec>,
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
            interface: InterfaceRule::Series,
            interfaces: vec![],
            pairs: vec![],
            potentials: vec![],
            mixing: None,
            toughness: vec![],
            healing: None,
            release: Release::AtOnce,
            horizon: Horizon::Ratio(1),
            own_horizon: None,
            volume_scaling: false,
            calibration: Calibration::Discrete,
            influence: Influence::Constant,
            periodic: [None; 3],
            surface: None,
            bonds: vec![],
            precracks: vec![],
            contact: None,
            initial: vec![],
            bonded: None,
            boltzmann: 1.0,
            thermal: None,
            conditions: vec![],
            indenters: vec![],
            transfers: vec![],
            family: FamilyChoice::Auto,
            smooth: None,
            preload: None,
            schedule: Schedule {
                steps: 0,
                time_step: TimeStep::Auto,
                force_unstable: false,
                stepper: Stepper::Verlet,
            },
            fields: None,
            probes: vec![],
        }
    }
}
impl Spec {
    /// A linear body that can be run.
    ///
    /// # Panics
    /// If D is not 1, 2 or 3, or its lists do not belong to each other ([`LinearBody::check`]).
    pub fn of_linear<const D: usize>(body: &LinearBody<D>) -> Spec {
        let pad = |x: &[f64; D]| std::array::from_fn(|a| if a < D { x[a] } else { 0.0 });
        let cloud = Cloud {
            position: body.position.iter().map(pad).collect(),
            volume: body.volume.clone(),
            density: body.density.clone(),
            ..Cloud::default()
        };
        let linear = AnyLinearBody::new(body.clone()).expect("bodies have 1, 2 or 3 dimensions");
        let law = LawSpec::Micromoduli(Arc::new(linear));
        let mut spec = Spec::new(D, BodySpec::Cloud(cloud), 1.0, law);
        spec.horizon = Horizon::Length(body.range() * (1.0 + 1e-9));
        for a in 0..D {
            spec.periodic[a] = body.period[a];
        }
        spec
    }

    /// The interatomic potential, where the materials are atoms; of several kinds that of the first.
    pub fn potential(&self) -> Option<&PotentialSpec> {
        self.materials.iter().find_map(|m| m.law.potential())
    }

    /// The given micromoduli, where the materials have them.
    pub fn micromoduli(&self) -> Option<&Arc<AnyLinearBody>> {
        self.materials.iter().find_map(|m| m.law.micromoduli())
    }
}

/// What a two-dimensional body is a section of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plane {
    Stress,
    Strain,
}
