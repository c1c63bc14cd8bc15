//! The linear body of every law is the derivative of its forces, about any state, and what it must be mechanically.

use super::sample::{Case, H, build, cases};
use peridyne::run::{Options, Simulation};
use peridyne::space::Point;
use peridyne::spec::{CrackKind, CrackShape, FamilyChoice, PrecrackSpec, Spec, TimeStep};

/// A fixed sequence of numbers in ±1.
fn noise(k: usize) -> f64 {
    2.0 * ((k as f64 + 1.0) * 0.618_033_988_749_894_9).fract() - 1.0
}

fn field(n: usize, d: usize, size: f64, seed: usize) -> Vec<Point> {
    let at = |i: usize, a: usize| {
        if a < d {
            size * noise(seed + 3 * i + a)
        } else {
            0.0
        }
    };
    (0..n).map(|i| std::array::from_fn(|a| at(i, a))).collect()
}

fn model(spec: &Spec) -> Box<dyn Simulation> {
    let mut spec = spec.clone();
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    build(&spec, options).unwrap()
}

/// Largest difference of linear and differenced forces, over the largest; about the state `u`. `None` where forces have a corner so near
/// (a point that begins to yield) that there is nothing to difference.
fn apart<const D: usize>(model: &mut dyn Simulation, u: &[Point]) -> Option<f64> {
    model.set_displacements(u);
    let body = model.linear_body().of::<D>().unwrap();
    let n = u.len();
    let change = field(n, D, H, 17);
    let linear: Vec<[f64; D]> = change
        .iter()
        .map(|c| std::array::from_fn(|a| c[a]))
        .collect();
    let step = 2e-5;
    let at = |s: f64| {
        let moved: Vec<Point> = u
            .iter()
            .zip(&change)
            .map(|(u, c)| std::array::from_fn(|a| u[a] + s * step * c[a]))
            .collect();
        model.forces_under(&moved)
    };
    // Richardson: fourth order
    let f = [-2.0, -1.0, 1.0, 2.0].map(at);
    let (mut worst, mut most, mut corner) = (0.0f64, 0.0f64, 0.0f64);
    (0..n).for_each(|i| {
        let exact = body.force(&linear, i);
        for a in 0..D {
            let slope =
                (8.0 * (f[2][i][a] - f[1][i][a]) - (f[3][i][a] - f[0][i][a])) / (12.0 * step);
            worst = worst.max((slope - exact[a]).abs());
            most = most.max(exact[a].abs());
            // of smooth forces it is of the third order in the step
            let third = (f[3][i][a] - f[0][i][a]) - 2.0 * (f[2][i][a] - f[1][i][a]);
            corner = corner.max(third.abs() / step);
        }
    });
    (corner < 1e-5 * most).then_some(worst / most)
}

fn check<const D: usize>(name: &str, spec: &Spec) {
    let mut m = model(spec);
    let n = m.info().points as usize;
    let rest = apart::<D>(m.as_mut(), &field(n, D, 0.0, 0));
    let bent = (0..20).find_map(|t| apart::<D>(m.as_mut(), &field(n, D, 0.05 * H, 5 + 1000 * t)));
    for error in [rest, bent] {
        let error = error.unwrap_or_else(|| panic!("{name}: only states with corners"));
        assert!(error < 2e-9, "{name}: {error:e}");
    }
    m.set_displacements(&field(n, D, 0.0, 0));
    let body = m.linear_body().of::<D>().unwrap();
    let sound = body.soundness();
    assert!(sound.asymmetry < 1e-12, "{name}: {sound:?}");
    if spec.space.periodic[0].is_none() {
        assert!(sound.rotation < 1e-12, "{name}: {sound:?}");
    }
    // a state-based law reaches two families, others one
    assert!(body.range() <= 2.0 * m.info().horizon * (1.0 + 1e-12));
}

fn both(case: &Case, spec: &Spec) {
    let name = case.name();
    match case.d() {
        1 => check::<1>(&name, spec),
        2 => check::<2>(&name, spec),
        _ => check::<3>(&name, spec),
    }
}

#[test]
fn linear_bodies_are_derivatives_of_forces() {
    for case in cases() {
        both(&case, &case.spec());
    }
}

/// The operator of conjugate gradients and of energies of linear statics is a sweep at 1e-60 spacings ([`peridyne::statics::Swept`]): of any
/// law, torn askew, as a stencil and as a list, it is the tangent at rest to the last digits, or a linear solution would be another one.
#[test]
fn sweeps_at_tiny_displacements_are_the_tangent_at_rest_of_torn_bodies() {
    fn swept<const D: usize>(name: &str, spec: &Spec) {
        let mut m = model(spec);
        let n = m.info().points as usize;
        m.start(true);
        m.set_displacements(&field(n, D, 0.0, 0));
        let body = m.linear_body().of::<D>().unwrap();
        let size = 1e-60 * H;
        let u = field(n, D, size, 29);
        let found = m.forces_under(&u);
        let linear: Vec<[f64; D]> = { u.iter() }
            .map(|u| std::array::from_fn(|a| u[a] / size))
            .collect();
        let (mut worst, mut most) = (0.0f64, 0.0f64);
        for (i, found) in found.iter().enumerate() {
            let exact = body.force(&linear, i);
            for a in 0..D {
                worst = worst.max((found[a] / size - exact[a]).abs());
                most = most.max(exact[a].abs());
            }
        }
        assert!(worst < 1e-11 * most, "{name}: {:e}", worst / most);
    }
    // functions of lengths that a deck writes may pull at rest: their statics takes assembled tangents
    let at_peace = |c: &&Case| c.d() > 1 && c.material.name != "embedded";
    for case in cases().iter().filter(at_peace) {
        for family in [FamilyChoice::Stencil, FamilyChoice::List] {
            let mut spec = case.spec();
            spec.bonds.family = family;
            spec.damage.precracks = vec![PrecrackSpec {
                kind: CrackKind::Broken,
                shape: CrackShape::Segment {
                    from: [-H, 0.3 * H, 0.0],
                    to: [2.2 * H, 1.9 * H, 0.0],
                },
            }];
            let name = format!("{} as {family:?}", case.name());
            match case.d() {
                2 => swept::<2>(&name, &spec),
                _ => swept::<3>(&name, &spec),
            }
        }
    }
}

#[test]
fn linear_bodies_of_periodic_ones_and_of_lists() {
    // of ten thousand bonds that yield each for itself some are always at the corner
    let smooth = |c: &&Case| c.material.name != "bonds of metal";
    for case in cases().iter().filter(smooth).step_by(5) {
        both(case, &case.periodic());
        let mut list = case.spec();
        list.bonds.family = FamilyChoice::List;
        both(case, &list);
    }
}
