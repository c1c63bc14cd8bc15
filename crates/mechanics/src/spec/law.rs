//! Materials: constitutive laws and their constants, fracture, and what bonds between them have.

use super::parameters::Parameters;
use super::{AnyLinearBody, PotentialSpec};
use std::sync::Arc;

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
#[derive(Debug, Clone, PartialEq)]
pub enum LawSpec {
    /// Prototype microelastic brittle (bond-based).
    Pmb(PmbStiffness),
    /// Linear peridynamic solid (state-based).
    Lps(Moduli),
    /// Linear peridynamic solid with the three-dimensional formulas and the moduli as typed, in any dimension
    /// (what LAMMPS's `peri/lps` does): bulk and shear modulus.
    Lps3d { bulk: f64, shear: f64 },
    /// `W = E(ϑ) + ½Σ κ-bonds` with the quadratic `E` of seleson2014 (A.16) and `κ` of (A.14): `κ = k ω e / m`,
    /// `P = −(p/m) θ` with the two stiffnesses given directly (seleson2014 (A.24): `k = k̄`, `p = c̄/3`).
    EamLike { pair: f64, volume: f64 },
    /// Linear springs: the bond-based solid linearised about the reference (lattice bodies).
    Springs(PmbStiffness),
    /// An interatomic potential: on the lattice's fixed neighbours (family `Stencil`), or between atoms that are near now
    /// (`Neighbours`, or `Auto`).
    Atoms(PotentialSpec),
    /// Given micromoduli, in order of the points of a cloud.
    Micromoduli(Arc<AnyLinearBody>),
    /// A law of the registry.
    Named(NamedLaw),
}

impl LawSpec {
    /// A law of the registry.
    pub fn named(name: &str, parameters: Parameters) -> LawSpec {
        LawSpec::Named(NamedLaw {
            name: name.into(),
            parameters,
            linear: None,
            isotropic: true,
        })
    }

    /// The linear law of the same elasticity about the reference: of a named law what the registry says, of all others themselves.
    pub fn linear(&self) -> &LawSpec {
        match self {
            LawSpec::Named(NamedLaw {
                linear: Some(linear),
                ..
            }) => linear,
            law => law,
        }
    }

    /// Of atoms.
    pub fn potential(&self) -> Option<&PotentialSpec> {
        match self {
            LawSpec::Atoms(potential) => Some(potential),
            _ => None,
        }
    }

    /// Of a body whose micromoduli are given.
    pub fn micromoduli(&self) -> Option<&Arc<AnyLinearBody>> {
        match self {
            LawSpec::Micromoduli(body) => Some(body),
            _ => None,
        }
    }
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

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FractureSpec {
    pub criterion: Criterion,
    /// Dependence of the critical stretch on compression: `s0 = s00 − α s_min`.
    pub alpha: f64,
    /// How the critical stretch grows with the rate of the stretch; `None`: it does not.
    pub rate: Option<RateSpec>,
    /// Fatigue damage of bonds in cycles of load; `None`: they do not.
    pub fatigue: Option<FatigueSpec>,
}

impl FractureSpec {
    /// Of a criterion alone.
    pub fn new(criterion: Criterion) -> FractureSpec {
        FractureSpec {
            criterion,
            alpha: 0.0,
            rate: None,
            fatigue: None,
        }
    }

    /// Is it decided by more than the stretch that a bond has now? Fused kernels look at no more.
    pub fn remembers(&self) -> bool {
        let stretch = matches!(self.criterion, Criterion::Stretch(_) | Criterion::Energy(_));
        !stretch || self.rate.is_some() || self.fatigue.is_some()
    }
}

/// `s0 (1 + C ln(ṡ/ṡ0))` where a bond is stretched faster than ṡ0, as the flow stress of Johnson & Cook 1983 grows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateSpec {
    /// C (–).
    pub coefficient: f64,
    /// ṡ0 (1 / time).
    pub reference: f64,
}

/// What a cycle of load takes of the life of a bond, 1 at first: `dλ/dN = −A ε^m` of the range ε of its stretch (Silling & Askari 2014).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FatigueSpec {
    /// A1 and m1 far from any crack, of ε − ε_∞; `None`: no cracks begin there.
    pub nucleation: Option<[f64; 2]>,
    /// ε_∞, up to which bonds far from any crack live for ever.
    pub limit: f64,
    /// A2 and m2 near a crack; `None`: no crack grows.
    pub growth: Option<[f64; 2]>,
    /// Damage that is a crack: near it are bonds of points in whose family there is one that has it.
    pub crack: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Criterion {
    /// Critical stretch s00 (–).
    Stretch(f64),
    /// Fracture energy (energy / area).
    Energy(f64),
    /// The work that is done on a bond, by the fracture energy (energy / area; Foster, Silling & Chen 2011).
    BondEnergy(f64),
    /// Von Mises stress of the points, the mean of both ends (pressure).
    VonMises(f64),
    /// Equivalent plastic strain of the points, the mean of both ends (–).
    PlasticStrain(f64),
}

impl Criterion {
    /// Its number.
    pub fn limit(self) -> f64 {
        match self {
            Criterion::Stretch(x)
            | Criterion::Energy(x)
            | Criterion::BondEnergy(x)
            | Criterion::VonMises(x)
            | Criterion::PlasticStrain(x) => x,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BondMixing {
    /// Harmonic mean: the two half bonds in series.
    #[default]
    Harmonic,
    /// Arithmetic mean: in parallel.
    Arithmetic,
    Minimum,
}

/// When a bond past its critical stretch lets go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Breakage {
    /// In the force evaluation that finds it there (CabanaPD). The dilatation of that evaluation still has it; sums of laws of the
    /// registry do not.
    #[default]
    BeforeForce,
    /// After the force of that evaluation: it pulls once more (LAMMPS).
    AfterForce,
}

/// What points of one material have in their bonds with points of another (LAMMPS's `pair_coeff I J`).
#[derive(Debug, Clone, PartialEq)]
pub struct PairSpec {
    /// At most the horizon of the spec (length); 0: no bonds.
    pub horizon: f64,
    /// `Pmb` with a micromodulus; `Lps3d`: moduli with which both scalars act on the point, whatever its partner
    /// is made of. With unlike moduli forces are then not opposite, and no energy is conserved.
    pub law: LawSpec,
    /// Critical stretch s00 of those bonds, and how it depends on compression: a point's s0 is the greatest
    /// `s00 − α s` of its whole bonds.
    pub critical_stretch: f64,
    pub alpha: f64,
}

/// A law of the registry by its name ([`crate::law::descriptor`]).
#[derive(Debug, Clone, PartialEq)]
pub struct NamedLaw {
    pub name: String,
    pub parameters: Parameters,
    /// The linear law of the same elasticity, once the name was looked up.
    pub linear: Option<Box<LawSpec>>,
    /// Is that its own elasticity, not a mean over directions?
    pub isotropic: bool,
}
