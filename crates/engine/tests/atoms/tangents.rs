//! The linear body of every potential is the derivative of its forces.

use super::sample::{Noise, atoms, potentials};
use peridyne::run::{Options, build};
use peridyne::space::Point;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{FamilyChoice, Spec};

pub fn check<const D: usize>(name: &str, spec: &Spec) {
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    let mut model = build(spec, options).unwrap();
    let n = model.info().points as usize;
    let mut noise = Noise(3);
    let mut field = |size: f64| -> Vec<Point> {
        let mut at = |a: usize| if a < D { size * noise.next() } else { 0.0 };
        (0..n).map(|_| std::array::from_fn(&mut at)).collect()
    };
    let (u, change) = (field(0.02), field(1.0));
    model.set_displacements(&u);
    let body = model.linear_body().of::<D>().unwrap();
    assert!(
        body.soundness().asymmetry < 1e-11,
        "{name}: {:?}",
        body.soundness()
    );
    let linear: Vec<[f64; D]> = change
        .iter()
        .map(|c| std::array::from_fn(|a| c[a]))
        .collect();
    let step = 1e-5;
    let mut at = |s: f64| {
        let moved: Vec<Point> = u
            .iter()
            .zip(&change)
            .map(|(u, c)| std::array::from_fn(|a| u[a] + s * step * c[a]))
            .collect();
        model.forces_under(&moved)
    };
    let (plus, minus) = (at(1.0), at(-1.0));
    let (mut worst, mut most) = (0.0f64, 0.0f64);
    for i in 0..n {
        let exact = body.force(&linear, i);
        for a in 0..D {
            let slope = (plus[i][a] - minus[i][a]) / (2.0 * step);
            worst = worst.max((slope - exact[a]).abs());
            most = most.max(exact[a].abs());
        }
    }
    assert!(worst < 3e-6 * most, "{name}: {worst:e} of {most:e}");
}

#[test]
fn linear_bodies_are_derivatives_of_forces() {
    use LatticeKind::*;
    for (name, potential) in potentials() {
        // a cut-off without smooth end jumps where a neighbour comes in: none of these bodies has one there
        for family in [FamilyChoice::Stencil, FamilyChoice::Neighbours] {
            let name = format!("{name}, {family:?}");
            check::<1>(&name, &atoms(Chain, 12, &potential, family, false));
            check::<2>(&name, &atoms(Triangular, 4, &potential, family, true));
            check::<3>(&name, &atoms(Fcc, 3, &potential, family, true));
        }
    }
}
