use super::*;
use crate::samples::Random;

fn forms() -> Vec<Form> {
    let wave = |strength, times, opposite| Wave {
        strength,
        times,
        opposite,
    };
    // OPLS: ½K₁(1 + cos φ) + ½K₂(1 − cos 2φ) + ½K₃(1 + cos 3φ) + ½K₄(1 − cos 4φ)
    let opls = [
        wave(0.8, 1, false),
        wave(-0.2, 2, true),
        wave(1.5, 3, false),
        wave(0.1, 4, true),
    ];
    vec![
        Form::HarmonicBond {
            stiffness: 260.0,
            length: 1.53,
        },
        Form::HarmonicAngle {
            stiffness: 58.0,
            angle: 1.96,
        },
        Form::CosineAngle { stiffness: 3.0 },
        Form::CosineSquaredAngle {
            stiffness: 3.0,
            cosine: -0.4,
        },
        Form::Dihedral {
            powers: cosine_powers(&opls),
        },
        Form::Dihedral {
            powers: vec![0.3, -1.2, 0.4, 2.0, 0.0, -0.7],
        },
        Form::HarmonicImproper {
            stiffness: 7.0,
            angle: 0.3,
        },
    ]
}

/// Four particles of a chain, away from planes and lines.
fn places(random: &mut Random) -> [[f64; 3]; 4] {
    let at: [[f64; 3]; 4] = [
        [0.0, 0.0, 0.0],
        [1.5, 0.0, 0.0],
        [2.0, 1.4, 0.0],
        [3.2, 1.6, 0.9],
    ];
    at.map(|x| x.map(|x| x + 0.2 * random.next()))
}

fn distances(form: &Form, x: &[[f64; 3]; 4]) -> Vec<f64> {
    let half = |(a, b): &(usize, usize)| -> f64 {
        0.5 * (0..3).map(|c| (x[*a][c] - x[*b][c]).powi(2)).sum::<f64>()
    };
    form.pairs().iter().map(half).collect()
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    crate::array::from_fn(|c| a[c] - b[c])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    crate::array::from_fn(|c| {
        let (m, n) = ((c + 1) % 3, (c + 2) % 3);
        a[m] * b[n] - a[n] * b[m]
    })
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|c| a[c] * b[c]).sum()
}

/// The same energies by vectors.
fn by_vectors(form: &Form, x: &[[f64; 3]; 4]) -> f64 {
    let (a, b) = (minus(x[0], x[1]), minus(x[2], x[1]));
    let cosine = dot(a, b) / (dot(a, a) * dot(b, b)).sqrt();
    match form {
        Form::HarmonicBond { stiffness, length } => stiffness * (dot(a, a).sqrt() - length).powi(2),
        Form::HarmonicAngle { stiffness, angle } => stiffness * (cosine.acos() - angle).powi(2),
        Form::CosineAngle { stiffness } => stiffness * (1.0 + cosine),
        Form::CosineSquaredAngle {
            stiffness,
            cosine: best,
        } => stiffness * (cosine - best).powi(2),
        Form::Dihedral { powers } => {
            let c = between_planes(x);
            (0..).zip(powers).map(|(n, p)| p * c.powi(n)).sum()
        }
        Form::HarmonicImproper { stiffness, angle } => {
            stiffness * (between_planes(x).acos() - angle).powi(2)
        }
    }
}

/// Cosine of the angle between the planes of the first and of the last three.
fn between_planes(x: &[[f64; 3]; 4]) -> f64 {
    let m = cross(minus(x[1], x[0]), minus(x[2], x[1]));
    let n = cross(minus(x[2], x[1]), minus(x[3], x[2]));
    dot(m, n) / (dot(m, m) * dot(n, n)).sqrt()
}

/// A flat improper with χ₀ = 0 is at rest and stiff: `K χ²` of the height of the first over the plane of the others.
#[test]
fn an_improper_is_smooth_where_it_is_flat() {
    let form = Form::HarmonicImproper {
        stiffness: 7.0,
        angle: 0.0,
    };
    let flat = [[0.2, 1.0, 0.0], [0.0; 3], [1.5, 0.0, 0.0], [1.1, 1.3, 0.0]];
    for height in [1e-2f64, 1e-3, 1e-4] {
        let mut x = flat;
        x[0][2] = height;
        let chi = height.atan();
        let xi = distances(&form, &x);
        let found = form.pulls(&xi);
        assert!((found.energy - 7.0 * chi * chi).abs() < 1e-13);
        let mut pulled = 0.0;
        for ((a, b), g) in form.pairs().iter().zip(found.pulls) {
            let y = x[*a][2] - x[*b][2];
            pulled += g * y * (f64::from(u8::from(*a == 0)) - f64::from(u8::from(*b == 0)));
        }
        let slope = 14.0 * chi / (1.0 + height * height);
        assert!(
            (pulled / slope - 1.0).abs() < 1e-7,
            "{height}: {pulled} {slope}"
        );
    }
}

#[test]
fn energies_are_those_of_vectors_and_pulls_their_slopes() {
    let mut random = Random(4);
    for form in forms() {
        for _ in 0..20 {
            let x = places(&mut random);
            let xi = distances(&form, &x);
            let found = form.pulls(&xi);
            let exact = by_vectors(&form, &x);
            assert!(
                (found.energy - exact).abs() < 1e-12 * (1.0 + exact.abs()),
                "{form:?}: {} {exact}",
                found.energy
            );
            for n in 0..form.particles() {
                for c in 0..3 {
                    let at = |h: f64| {
                        let mut x = x;
                        x[n][c] += h;
                        by_vectors(&form, &x)
                    };
                    let slope = (8.0 * (at(1e-4) - at(-1e-4)) - (at(2e-4) - at(-2e-4))) / 12e-4;
                    let mut pulled = 0.0;
                    for ((a, b), g) in form.pairs().iter().zip(found.pulls) {
                        let y = x[*a][c] - x[*b][c];
                        pulled +=
                            g * y * (f64::from(u8::from(*a == n)) - f64::from(u8::from(*b == n)));
                    }
                    assert!(
                        (slope - pulled).abs() < 1e-8 * (1.0 + slope.abs()),
                        "{form:?}: {slope} {pulled}"
                    );
                }
            }
        }
    }
}

#[test]
fn tangents_are_slopes_of_pulls() {
    let mut random = Random(5);
    for form in forms() {
        let xi = distances(&form, &places(&mut random));
        let found = form.tangents(&xi);
        let first = form.pulls(&xi);
        for m in 0..xi.len() {
            assert!(
                (found.first.pulls[m] - first.pulls[m]).abs()
                    < 1e-12 * (1.0 + first.pulls[m].abs())
            );
            for n in 0..xi.len() {
                let at = |h: f64| {
                    let mut xi = xi.clone();
                    xi[n] += h;
                    form.pulls(&xi).pulls[m]
                };
                let slope = (8.0 * (at(1e-4) - at(-1e-4)) - (at(2e-4) - at(-2e-4))) / 12e-4;
                assert!(
                    (slope - found.second[m][n]).abs() < 1e-7 * (1.0 + slope.abs()),
                    "{form:?} {m} {n}: {slope} {}",
                    found.second[m][n]
                );
            }
        }
    }
}

/// Sums of waves against their cosines.
#[test]
fn waves_are_powers_of_the_cosine() {
    for times in 0..7 {
        for opposite in [false, true] {
            let wave = Wave {
                strength: 1.3,
                times,
                opposite,
            };
            let powers = cosine_powers(&[wave]);
            for n in 0..40 {
                let phi = 0.17 * f64::from(n);
                let sign = if opposite { -1.0 } else { 1.0 };
                let exact = 1.3 * (1.0 + sign * (f64::from(times) * phi).cos());
                let found = dihedral::polynomial(&powers, phi.cos());
                assert!((found - exact).abs() < 1e-13, "{times} {phi}");
            }
        }
    }
}
