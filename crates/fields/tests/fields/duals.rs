//! Generalized forces of fans and of bonded terms are slopes of the energy to twelve digits: dual numbers through the coordinates, and the
//! energy as its definition has it, beside terms that differentiate by distances.

use crate::sample::*;
use peridyne::law::many_body::sites::ManyBodySites;
use peridyne::law::many_body::stillinger_weber::StillingerWeber;
use peridyne::law::many_body::tersoff::Tersoff;
use peridyne::law::many_body::{Described, ManyBody};
use peridyne::law::number::{Dual, Number};
use peridyne::law::terms::{Near, Sites};
use peridyne::spec::{Form, Parameters};

type Place = [Dual<f64>; 3];

/// Places, of which a coordinate is the variable.
fn places(at: &[[f64; 3]], n: usize, c: usize) -> Vec<Place> {
    let slope = |m: usize, d: usize| if m == n && d == c { 1.0 } else { 0.0 };
    let of = |(m, x): (usize, &[f64; 3])| {
        std::array::from_fn(|d| Dual {
            value: x[d],
            slope: slope(m, d),
        })
    };
    at.iter().enumerate().map(of).collect()
}

/// ξ = d²/2.
fn xi(a: &Place, b: &Place) -> Dual<f64> {
    let mut sum = Dual::constant(0.0);
    for c in 0..3 {
        let d = a[c] - b[c];
        sum = sum + d * d;
    }
    sum.times(0.5)
}

/// `Σ_j h(ξ_ij, Σ_k z(ξ_ij, ξ_ik, ξ_jk))` about the first.
fn energy<F: ManyBody>(many_body: &F, at: &[Place]) -> Dual<f64> {
    let row = many_body.table().at([0, 0, 0]);
    let limit = 0.5 * many_body.cutoff() * many_body.cutoff();
    let near: Vec<&Place> = at[1..]
        .iter()
        .filter(|x| xi(&at[0], x).value < limit)
        .collect();
    let arms: Vec<_> = near
        .iter()
        .map(|x| many_body.arm::<f64, _>(xi(&at[0], x), row))
        .collect();
    let mut sum = Dual::constant(0.0);
    for (j, arm) in arms.iter().enumerate() {
        let mut zeta = Dual::constant(0.0);
        for k in (0..arms.len()).filter(|k| *k != j) {
            zeta = zeta + many_body.share::<f64, _>(arm, &arms[k], xi(near[j], near[k]), row);
        }
        sum = sum + many_body.bond::<f64, _>(arm, zeta, row);
    }
    sum
}

fn check<F: Described>(constants: &[(&str, f64)]) {
    let mut parameters = Parameters::numbers(constants);
    F::descriptor().check(&mut parameters).unwrap();
    let many_body = F::read(&parameters).unwrap();
    let sites = ManyBodySites(many_body.clone());
    let mut random = Random(3);
    let mut at = vec![[0.0; 3]];
    for y in [
        [1.0, 1.0, 1.1],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, -1.1],
        [-1.2, 1.3, -1.2],
        [0.1, 2.3, 0.2],
    ] {
        let r = random.vector();
        at.push(std::array::from_fn(|c| 1.3 * (y[c] + 0.1 * r[c])));
    }
    let near: Vec<Near> = at[1..].iter().map(|y| Near { kind: 0, y: *y }).collect();
    let mut force = vec![[0.0; 3]; at.len()];
    let mut whole = 0.0;
    sites.terms(0, &near, &mut |t| {
        whole += t.energy;
        for &(a, b, g) in &t.pulls {
            for c in 0..3 {
                let f = -g * (at[a as usize][c] - at[b as usize][c]);
                force[a as usize][c] += f;
                force[b as usize][c] -= f;
            }
        }
    });
    for n in 0..at.len() {
        for c in 0..3 {
            let exact = energy(&many_body, &places(&at, n, c));
            assert!(
                (exact.value - whole).abs() < 1e-12 * (1.0 + whole.abs()),
                "{}",
                F::NAME
            );
            let error = (exact.slope + force[n][c]).abs();
            assert!(
                error < 1e-12 * (1.0 + exact.slope.abs()),
                "{} {n} {c}: {error:e}",
                F::NAME
            );
        }
    }
}

#[test]
fn forces_of_fans_are_slopes_to_twelve_digits() {
    check::<StillingerWeber>(&[
        ("epsilon", 2.1683),
        ("sigma", 2.0951),
        ("a", 1.80),
        ("lambda", 21.0),
        ("gamma", 1.20),
        ("cos_theta0", -0.333333333333),
        ("A", 7.049556277),
        ("B", 0.6022245584),
        ("p", 4.0),
        ("q", 0.0),
    ]);
    check::<Tersoff>(&[
        ("m", 3.0),
        ("gamma", 1.0),
        ("lambda3", 1.3258),
        ("c", 4.8381),
        ("d", 2.0417),
        ("cos_theta0", 0.0),
        ("n", 22.956),
        ("beta", 0.33675),
        ("lambda2", 1.3258),
        ("B", 95.373),
        ("R", 3.0),
        ("D", 0.2),
        ("lambda1", 3.2394),
        ("A", 3264.7),
    ]);
}

/// Bonds, angles and dihedrals.
#[test]
fn forces_of_bonded_terms_are_slopes_to_twelve_digits() {
    let mut random = Random(8);
    let mut seen = [false; 5];
    let more = [
        Form::HarmonicAngle {
            stiffness: 5.0,
            angle: 1.9,
        },
        Form::CosineAngle { stiffness: 4.0 },
    ];
    for form in bonded(16).forms.iter().chain(&more) {
        let count = form.particles();
        seen[count] = true;
        for _ in 0..5 {
            let at: Vec<[f64; 3]> = (0..count)
                .map(|k| {
                    let r = random.vector();
                    // a zigzag, so that no angle is straight
                    let zigzag = [1.1 * k as f64, 0.8 * (k % 2) as f64, 0.0];
                    std::array::from_fn(|c| zigzag[c] + 0.3 * r[c])
                })
                .collect();
            let still: Vec<f64> = {
                let at = places(&at, count, 0);
                form.pairs()
                    .iter()
                    .map(|(a, b)| xi(&at[*a], &at[*b]).value)
                    .collect()
            };
            let pulls = form.pulls(&still).pulls;
            for n in 0..count {
                for c in 0..3 {
                    let moved = places(&at, n, c);
                    let all: Vec<_> = form
                        .pairs()
                        .iter()
                        .map(|(a, b)| xi(&moved[*a], &moved[*b]))
                        .collect();
                    let exact = form.energy(&all).slope;
                    let mut force = 0.0;
                    for ((a, b), g) in form.pairs().iter().zip(&pulls) {
                        let f = -g * (at[*a][c] - at[*b][c]);
                        force += if *a == n {
                            f
                        } else if *b == n {
                            -f
                        } else {
                            0.0
                        };
                    }
                    let error = (exact + force).abs();
                    assert!(
                        error < 1e-12 * (1.0 + exact.abs()),
                        "{form:?} {n} {c}: {error:e}"
                    );
                }
            }
        }
    }
    assert_eq!(seen, [false, false, true, true, true]);
}
