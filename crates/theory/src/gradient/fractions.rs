//! Gradient coefficients of a chain as fractions: bonds whose stiffness relative to each other is a fraction.

use super::linear::LinearChain;
use crate::exact::{Field, Q};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{BodySpec, Horizon, Influence, LawSpec, Spec};

/// `c_{2p+2}/(c_2 a^{2p})`, p = 0, 1, …, of `ρ ü = Σ c_{2p+2} ∂^{2p+2} u`; `None` where they are no fractions: several
/// dimensions, laws other than bond-based ones, influence functions that are not rational, a horizon that is no whole number of spacings.
///
/// `K_j ∝ ω(j) ν(j)/j`, with ν = ½ for the neighbour on the horizon where its volume is scaled.
pub fn fractions(spec: &Spec, terms: usize) -> Option<Vec<Q>> {
    let BodySpec::Lattice {
        kind: LatticeKind::Chain,
        ..
    } = &spec.body
    else {
        return None;
    };
    let Horizon::Ratio(m) = spec.bonds.horizon else {
        return None;
    };
    let [material] = spec.materials.as_slice() else {
        return None;
    };
    let m = i64::from(m);
    let weight = |j: i64| match (&material.law, spec.bonds.influence) {
        (LawSpec::Pmb(_) | LawSpec::Springs(_), Influence::Constant) => Some(Q::ratio(1, 1)),
        (LawSpec::Pmb(_) | LawSpec::Springs(_), Influence::Inverse) => Some(Q::ratio(1, j)),
        (LawSpec::Pmb(_) | LawSpec::Springs(_), Influence::Linear) => Some(Q::ratio(m - j, m)),
        (
            LawSpec::Pmb(_) | LawSpec::Springs(_),
            Influence::Gaussian | Influence::CubicSpline | Influence::Formula(_),
        )
        | (
            LawSpec::Lps(_)
            | LawSpec::Lps3d { .. }
            | LawSpec::EamLike { .. }
            | LawSpec::Atoms(_)
            | LawSpec::Micromoduli(_)
            | LawSpec::Named(_),
            _,
        ) => None,
    };
    let part = |j: i64| {
        Q::ratio(
            1,
            if spec.bonds.partial_volume_correction && j == m {
                2
            } else {
                1
            },
        )
    };
    let stiffness: Option<Vec<Q>> = (1..=m)
        .map(|j| Some(weight(j)? * part(j) / Q::whole(j)))
        .collect();
    let chain = LinearChain {
        spacing: Q::whole(1),
        stiffness: stiffness?,
        share: vec![],
        curvature: Q::whole(0),
    };
    let all = chain.coefficients(terms);
    let first = all.first()?.clone();
    Some(all.into_iter().map(|c| c / first.clone()).collect())
}
