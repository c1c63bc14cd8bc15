//! How forces of bonds are found: by fused kernels that a law has of its own, or by the general sweeps of `law/material`, which know what bonds
//! remember, bodies that expand, points with horizons of their own, and influence functions that know directions. The law is the same, and so is
//! its name.

use crate::law::material::{Thermoelastic, ThermoelasticSolid};
use crate::law::solid::linear::{EamLike, Linear, Lps, Lps3d, Pmb};
use crate::spec::{Criterion, DiffusionSpec, FractureSpec, LawSpec, Spec};
use std::fmt::{Display, Formatter};

/// What finds the forces of the bonds of a body.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sweeps {
    /// The laws of its materials, as the spec names them.
    pub laws: Vec<String>,
    /// Is it kernels of their own?
    pub fused: bool,
    /// What they are asked for that such kernels do not know; empty: nothing, or one of the laws has no such kernels.
    pub needs: Vec<&'static str>,
}

impl Display for Sweeps {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let laws = self.laws.join(", ");
        match (self.fused, self.needs.is_empty()) {
            (true, _) => write!(f, "fused kernels of {laws}"),
            (false, true) => write!(f, "general sweeps of {laws}"),
            (false, false) => write!(f, "general sweeps of {laws} ({})", self.needs.join(", ")),
        }
    }
}

impl Sweeps {
    /// Of the only body of a spec, all materials alike; `None`: springs, micromoduli and atoms have others.
    pub(super) fn of(spec: &Spec) -> Option<Sweeps> {
        let all = spec.materials.iter().map(|m| names(&m.law));
        let all: Vec<[&str; 2]> = all.collect::<Option<_>>()?;
        let mut laws: Vec<String> = all.iter().map(|[own, _]| (*own).to_string()).collect();
        laws.dedup();
        let fusible = |[own, general]: &[&str; 2]| own != general;
        let needs = match all.iter().any(fusible) {
            true => needs(spec),
            false => vec![],
        };
        Some(Sweeps {
            laws,
            fused: all.iter().all(fusible) && needs.is_empty(),
            needs,
        })
    }
}

/// The name of the law of `law/material` that sweeps in general for this one; `None`: there is none.
pub(super) fn general(law: &LawSpec) -> Option<&str> {
    names(law).map(|[_, general]| general)
}

/// The name of a law, and of the one that sweeps for it in general: itself, or one of the same mechanics.
fn names(law: &LawSpec) -> Option<[&str; 2]> {
    match law {
        LawSpec::Pmb(_) => Some([Pmb::NAME, Thermoelastic::NAME]),
        LawSpec::Lps(_) => Some([Lps::NAME, ThermoelasticSolid::NAME]),
        LawSpec::Lps3d { .. } => Some([Lps3d::NAME, ThermoelasticSolid::NAME]),
        LawSpec::EamLike { .. } => Some([EamLike::NAME, ThermoelasticSolid::NAME]),
        LawSpec::Named(law) => Some([&law.name; 2]),
        LawSpec::Springs(_) | LawSpec::Micromoduli(_) | LawSpec::Atoms(_) => None,
    }
}

/// What is asked for that fused kernels do not know.
fn needs(spec: &Spec) -> Vec<&'static str> {
    let mut all: Vec<&'static str> = vec![];
    // a table of pairs has kernels of its own, and no others
    if !spec.interactions.pairs.is_empty() {
        return all;
    }
    let fractures = spec.materials.iter().filter_map(|m| m.fracture);
    for need in fractures.flat_map(of_fracture) {
        if !all.contains(&need) {
            all.push(need);
        }
    }
    let mut diffusions = spec.interactions.diffusions.iter();
    if diffusions.any(DiffusionSpec::expands) {
        all.push("expands");
    }
    let bond_based = |law: &LawSpec| matches!(law, LawSpec::Pmb(_));
    let solid = spec.materials.iter().any(|m| !bond_based(&m.law));
    // a kernel of `pmb` knows horizons of points of one material
    if spec.bonds.variable_horizon.is_some() && (solid || spec.materials.len() > 1) {
        all.push("has a variable horizon");
    }
    // those of solids weigh a bond alike at both ends
    if spec.bonds.influence.is_directed() && solid {
        all.push("has an influence function that knows directions");
    }
    all
}

/// What bonds break by beside the stretch that they have now.
fn of_fracture(fracture: FractureSpec) -> impl Iterator<Item = &'static str> {
    let measure = match fracture.criterion {
        Criterion::Stretch(_) | Criterion::Energy(_) => None,
        Criterion::BondEnergy(_) => Some("breaks by work of bonds"),
        Criterion::VonMises(_) => Some("breaks by von Mises stress"),
        Criterion::PlasticStrain(_) => Some("breaks by plastic strain"),
    };
    let rate = (fracture.rate).map(|_| "has a critical stretch that grows with the rate");
    let fatigue = (fracture.fatigue).map(|_| "has fatigue");
    [measure, rate, fatigue].into_iter().flatten()
}
