//! Where a crystal rests: the lattice spacing without pressure.

use super::atoms::{Atoms, has_basis_or_many_body};
use super::reference::{lattice, reach};
use crate::crystal::potential::rest;
use crate::crystal::{Crystal, Reach};
use peridyne::law::potential::{Potential, Visitor};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::Spec;

/// The spacing at which the spec's lattice of atoms has no pressure and resists compression, of several that of the least
/// energy, or that which an embedded-atom model in closed form is made for; `None` if there is none, or no potential. The spec's own spacing does not matter, unless its horizon is a length.
pub fn equilibrium_spacing(spec: &Spec) -> Option<f64> {
    if has_basis_or_many_body(spec) {
        return match spec.space.dimension {
            1 => of_kinds::<1>(spec),
            2 => of_kinds::<2>(spec),
            _ => of_kinds::<3>(spec),
        };
    }
    struct At {
        kind: LatticeKind,
        reach: Reach,
    }
    impl Visitor for At {
        type Out = Option<f64>;
        fn visit<P: Potential>(self, potential: P) -> Option<f64> {
            let At { kind, reach } = self;
            let range = [FROM, TO].map(|x| x * potential.length() / kind.nearest());
            let made_for = potential.made_for().map(|d| d / kind.nearest());
            match kind.dimension() {
                1 => best(range, made_for, at::<1, P>(&potential, kind, reach)),
                2 => best(range, made_for, at::<2, P>(&potential, kind, reach)),
                _ => best(range, made_for, at::<3, P>(&potential, kind, reach)),
            }
        }
    }
    let (kind, _) = lattice(spec).ok()?;
    let potential = spec.potential().filter(|_| spec.materials.len() == 1)?;
    let reach = reach(spec);
    // a potential that is not known has no crystal
    potential.apply(At { kind, reach }).ok().flatten()
}

/// Energy per atom and pressure of a lattice of a potential at a spacing.
fn at<const D: usize, P: Potential>(
    potential: &P,
    kind: LatticeKind,
    reach: Reach,
) -> impl Fn(f64) -> Option<[f64; 2]> {
    move |a| {
        let crystal = Crystal::<D>::of_potential(potential, kind, a, 1.0, reach);
        crystal.ok().map(|(_, r)| [r.energy, r.pressure])
    }
}

/// The same of several kinds of atoms, and of many-body potentials.
fn of_kinds<const D: usize>(spec: &Spec) -> Option<f64> {
    let (kind, spacing) = lattice(spec).ok()?;
    let atoms = Atoms::<D>::of(spec).ok()?;
    let all = spec.materials.iter().filter_map(|m| m.law.potential());
    let reach = all.map(|p| p.cut_off()).fold(0.0, f64::max);
    let range = [FROM, INNER].map(|x| x * 0.5 * reach / kind.nearest());
    best(range, None, |a| atoms.grown(a / spacing).state().ok())
}

/// Steps inwards, each by this factor, from the first factor times the length to the last.
const STEP: f64 = 0.98;
const FROM: f64 = 2.5;
const TO: f64 = 0.3;
/// Of many-body potentials, and of kinds: cut-offs are short there, and nearer than a third of them nothing rests.
const INNER: f64 = 0.6;

fn best(
    [from, to]: [f64; 2],
    made_for: Option<f64>,
    state: impl Fn(f64) -> Option<[f64; 2]>,
) -> Option<f64> {
    let mut a = from;
    let mut attracts = false;
    let mut best: Option<(f64, f64)> = None;
    while a > to {
        // too far apart there are no neighbours, too near the embedding energy may have no value
        let pressure = state(a).map(|[_, pressure]| pressure);
        if attracts && pressure.is_some_and(|p| p >= 0.0) {
            let found = rest([a, a / STEP], |a| Some(state(a)?[1]));
            let there = found.and_then(|rest| Some((rest, state(rest)?)));
            // not where the pressure jumps at a cut-off
            if let Some((rest, [energy, left])) = there
                && left.abs() <= 1e-6 * pressure.unwrap_or(0.0)
            {
                let cost = made_for.map_or(energy, |aim| (rest - aim).abs());
                if best.is_none_or(|(_, least)| cost < least) {
                    best = Some((rest, cost));
                }
            }
        }
        attracts = pressure.is_some_and(|p| p < 0.0);
        a *= STEP;
    }
    best.map(|(rest, _)| rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::law::potential::buckingham::Buckingham;
    use peridyne::law::potential::lennard_jones::LennardJones;
    use peridyne::spec::{BodySpec, End, FamilyChoice, Horizon, LawSpec, PotentialSpec};

    fn spec(kind: LatticeKind, potential: PotentialSpec, cutoff: f64) -> Spec {
        let body = BodySpec::Sites {
            kind,
            spacing: 1.0,
            origin: [0.0; 3],
            quarters: vec![[0; 3]],
            volume: None,
        };
        let law = LawSpec::Atoms(potential.ended(cutoff, End::Truncated));
        Spec::new(kind.dimension(), body, 1.0, law)
    }

    #[test]
    fn lennard_jones_crystals_rest_where_tables_say() {
        let lj = PotentialSpec::of(LennardJones {
            epsilon: 0.3,
            sigma: 2.0,
        });
        // lattice sums of the endless fcc crystal: nearest distance 1.0902 σ (2 Z12/Z6)^(1/6)
        let a = equilibrium_spacing(&spec(LatticeKind::Fcc, lj.clone(), 16.0)).unwrap();
        assert!((a / (2.0 * 1.0902 * 2f64.sqrt()) - 1.0).abs() < 2e-3, "{a}");
        let mut chain = spec(LatticeKind::Chain, lj, f64::INFINITY);
        chain.bonds.family = FamilyChoice::Stencil;
        chain.bonds.horizon = Horizon::Ratio(1);
        let a = equilibrium_spacing(&chain).unwrap();
        assert!(
            (a / (2.0 * 2f64.powf(1.0 / 6.0)) - 1.0).abs() < 1e-12,
            "{a}"
        );
    }

    #[test]
    fn the_inner_collapse_of_buckingham_is_no_rest() {
        let form = |dispersion| {
            PotentialSpec::of(Buckingham {
                strength: 1000.0,
                range: 0.3,
                dispersion,
            })
        };
        let a = equilibrium_spacing(&spec(LatticeKind::Fcc, form(50.0), 9.0)).unwrap();
        assert!((2.0..6.0).contains(&a), "{a}");
        // repulsion alone
        assert_eq!(
            equilibrium_spacing(&spec(LatticeKind::Fcc, form(0.0), 9.0)),
            None
        );
    }
}
