//! The specification of a run: plain data, no behaviour, in one consistent unit system.
//!
//! A front end (deck, LAMMPS script, another program) fills a [`Spec`]; `run::build` makes a model of it. What laws and
//! linear bodies do stands in [`law`](crate::law) and in the `statics` of `peridyne`; nothing here reads them.

mod atoms;
mod body;
mod bonded;
mod bonds;
mod cohesion;
mod condition;
mod contact;
mod damage;
mod diffusion;
mod family;
mod interactions;
mod interface;
mod law;
mod linear_body;
mod load_map;
mod loading;
mod mass_matrix;
mod parameters;
mod potential;
mod preload;
mod probe;
mod rigid_body;
mod rows;
mod run;
mod schedule;
mod smooth;
mod space;
mod surface;
mod table;

pub use atoms::{Acting, ActingSpec, Mixing};
pub use body::{BodySpec, Cloud, Members, Perturbation, PieceSpec, SetSpec};
pub use bonded::{BondedSpec, BondedTerm, Form};
pub use bonds::{BondFactorSpec, BondsSpec};
pub use cohesion::CohesionSpec;
pub use condition::{ConditionKind, ConditionSpec, ForceSpec, InitialSpec, ThermalSpec};
pub use contact::{AtRest, ContactSpec, ContactStiffness, FrictionSpec};
pub use damage::{
    CrackKind, CrackShape, DamageSpec, HealingSpec, PrecrackSpec, ToughnessFactor, ToughnessSpec,
};
pub use diffusion::{
    Area, DiffusionCondition, DiffusionKind, DiffusionMaterial, DiffusionMethod, DiffusionSpec,
    Exchange, Quantity,
};
pub use family::{Calibration, FamilyChoice, Formula, Horizon, Influence};
pub use interactions::InteractionsSpec;
pub use interface::InterfaceSpec;
pub use law::{
    BondMixing, Breakage, Criterion, FatigueSpec, FractureSpec, LawSpec, MaterialSpec, Moduli,
    NamedLaw, PairSpec, PmbStiffness, RateSpec,
};
pub use linear_body::{AnyLinearBody, LinearBody};
pub use load_map::LoadMap;
pub use loading::LoadingSpec;
pub use mass_matrix::MassMatrix;
pub use parameters::{Parameter, Parameters};
pub use potential::{End, PotentialSpec};
pub use preload::PreloadSpec;
pub use probe::{CrackTipSpec, Fold, JIntegralSpec, Measure, Part, ProbeSpec, RigidQuantity};
pub use rigid_body::{FreeSpec, RigidBodyMotion, RigidBodySpec, TurnSpec};
pub use rows::add_alike;
pub use run::RunSpec;
pub use schedule::{
    Control, Cycles, Integrator, Method, Newmark, Schedule, Solver, Statics, Stepper, TimeStep,
};
pub use smooth::{SmoothSpec, Window};
pub use space::{Plane, SpaceSpec};
use std::sync::Arc;
pub use surface::{SurfaceFactor, SurfaceFactors, SurfaceMethod};
pub use table::{PartnerTable, TableSpec};

/// Everything a run is: a body of materials, and sections that have a default.
#[derive(Debug, Clone)]
pub struct Spec {
    /// One line for headers and pictures.
    pub title: String,
    pub space: SpaceSpec,
    pub body: BodySpec,
    /// Named sets of points, in order; `"all"` always exists. Sets may overlap.
    pub sets: Vec<SetSpec>,
    /// Materials; point sets that name them must cover the body without overlap.
    pub materials: Vec<MaterialSpec>,
    pub bonds: BondsSpec,
    pub interactions: InteractionsSpec,
    pub damage: DamageSpec,
    pub loading: LoadingSpec,
    pub run: RunSpec,
}

impl Spec {
    /// One material on a body, everything else as plain as it can be: no influence function or volume scaling, free
    /// surfaces, a horizon of one spacing, 0.8 of the stable step. Change what you need.
    pub fn new(dimension: usize, body: BodySpec, density: f64, law: LawSpec) -> Spec {
        Spec {
            title: String::new(),
            space: SpaceSpec {
                dimension,
                ..SpaceSpec::default()
            },
            body,
            sets: vec![],
            materials: vec![MaterialSpec {
                name: "all".into(),
                set: "all".into(),
                density,
                law,
                fracture: None,
            }],
            bonds: BondsSpec::default(),
            interactions: InteractionsSpec::default(),
            damage: DamageSpec::default(),
            loading: LoadingSpec::default(),
            run: RunSpec::default(),
        }
    }

    /// A linear body that can be run.
    ///
    /// # Panics
    /// If D is not 1, 2 or 3, or its lists do not belong to each other ([`LinearBody::check`]).
    pub fn of_linear<const D: usize>(body: &LinearBody<D>) -> Spec {
        let pad = |x: &[f64; D]| crate::array::from_fn(|a| if a < D { x[a] } else { 0.0 });
        let cloud = Cloud {
            position: body.position.iter().map(pad).collect(),
            volume: body.volume.clone(),
            density: body.density.clone(),
            ..Cloud::default()
        };
        let linear = AnyLinearBody::new(body.clone()).expect("bodies have 1, 2 or 3 dimensions");
        let law = LawSpec::Micromoduli(Arc::new(linear));
        let mut spec = Spec::new(D, BodySpec::Cloud(cloud), 1.0, law);
        spec.bonds.horizon = Horizon::Length(body.range() * (1.0 + 1e-9));
        for a in 0..D {
            spec.space.periodic[a] = body.period[a];
        }
        spec
    }

    /// What it says of one of its bodies alone, whose materials are among all of them.
    pub fn alone(&self, piece: &PieceSpec) -> Spec {
        let mut own = Spec {
            body: piece.body.clone(),
            ..self.clone()
        };
        let bonds = &mut own.bonds;
        bonds.horizon = piece.horizon.unwrap_or(bonds.horizon);
        bonds.influence = piece.influence.unwrap_or(bonds.influence);
        bonds.family = piece.family.unwrap_or(bonds.family);
        bonds.surface.clone_from(&piece.surface);
        if let Some(own) = &piece.variable_horizon {
            bonds.variable_horizon = Some(own.clone());
        }
        own
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
