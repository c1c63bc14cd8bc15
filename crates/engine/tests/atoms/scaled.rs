//! Constants scale as their dimensions say: with lengths times l and energies times e a potential is `e φ(r/l)`, its densities stay.

use crate::sample::potentials;
use peridyne::law::potential::{Potential, Visitor};
use peridyne::spec::PotentialSpec;

/// φ, f and F at a distance and a density.
struct At {
    distance: f64,
    density: f64,
}

impl Visitor for At {
    type Out = [f64; 3];
    fn visit<P: Potential>(self, p: P) -> [f64; 3] {
        let q = self.distance * self.distance;
        [p.pair(q), p.density(q), p.embedding(self.density)]
    }
}

#[test]
fn potentials_scale_by_the_dimensions_of_their_constants() {
    let (length, energy) = (3.0, 7.0);
    for (name, fine) in potentials() {
        let coarse = fine.scaled(length, energy).unwrap();
        assert!((coarse.cut_off() / (length * fine.cut_off()) - 1.0).abs() < 1e-14);
        for n in 0..40 {
            let distance = 0.85 + 0.027 * f64::from(n);
            let density = 0.4 + 0.03 * f64::from(n);
            let at = |p: &PotentialSpec, distance| p.apply(At { distance, density }).unwrap();
            let [a, b] = [at(&fine, distance), at(&coarse, length * distance)];
            let expected = [energy * a[0], a[1], energy * a[2]];
            for (found, expected) in b.iter().zip(expected) {
                let error = (found - expected).abs();
                assert!(
                    error <= 1e-11 * expected.abs().max(1.0),
                    "{name}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn parameters_that_do_not_fit_are_refused() {
    let (_, mut potential) = potentials().swap_remove(0);
    potential.parameters.0.retain(|(key, _)| key != "range");
    let at = At {
        distance: 1.0,
        density: 1.0,
    };
    let error = potential.apply(at).unwrap_err();
    assert!(error.contains("needs `range`"), "{error}");
}
