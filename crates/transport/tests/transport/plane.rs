//! Kernels and weights in a plane: moments, closed forms beside quadrature; periods shorter than the horizon.

use crate::sample::{BUMPS, even, odd, operator};
use peridyne_transport::quadrature::Gauss;
use peridyne_transport::weights::Stencil;
use peridyne_transport::{
    Boundary, Bump, Direction, Evaluation, Flux, Grid, Kernel, Law, Parity, Profile, measure,
};
use std::f64::consts::PI;

/// `Σ w_a m_b h` of odd and `Σ w m_a m_b h²` of even kernels: 2 on the diagonal and 0 beside it, to round-off, for horizons that cut the lattice anywhere.
#[test]
fn all_moments_of_the_weights_are_exact() {
    let grid = Grid::plane([0.0; 2], [1.0; 2], 50).unwrap();
    let h = grid.spacing;
    for ratio in [3.0, 3.4, 4.0, 5.0, 5.1, 7.07, 10.3, 20.0] {
        for bump in BUMPS {
            for kernel in [odd(bump, ratio * h, 2), even(bump, ratio * h, 2)] {
                let s = Stencil::new(&kernel, &grid, "k").unwrap();
                let mut tensor = [[0.0; 2]; 2];
                for (m, w) in s.steps.iter().zip(&s.weights) {
                    let z = m.map(|m| m as f64 * h);
                    for (a, row) in tensor.iter_mut().enumerate() {
                        for (b, sum) in row.iter_mut().enumerate() {
                            *sum += 2.0
                                * match s.parity {
                                    Parity::Odd => w[a] * z[b],
                                    Parity::Even => w[0] * z[a] * z[b],
                                };
                        }
                    }
                }
                let bound = s.steps.len() as f64 * f64::EPSILON;
                for (a, row) in tensor.iter().enumerate() {
                    for (b, sum) in row.iter().enumerate() {
                        let exact = if a == b { 2.0 } else { 0.0 };
                        assert!(
                            (sum - exact).abs() <= bound,
                            "{ratio} {bump:?} {:?} {a}{b}: {:e} of {bound:e}",
                            s.parity,
                            sum - exact
                        );
                    }
                }
            }
        }
    }
}

/// Factors of bumps are made by quadrature, 64 panels of 16 points: in a plane `π ∫ r² a dr = 2` and `π ∫ r³ s dr = 2` have closed forms for three of them.
#[test]
fn factors_in_a_plane_are_those_of_closed_forms() {
    let d = 0.3f64;
    let pi2 = PI * PI;
    let p = 3.0;
    // ∫ s² B′ and ∫ s³ B of the unnormalised bumps
    let cases = [
        (Bump::Hat, 1.0 / 3.0, 1.0 / 20.0),
        (
            Bump::Cosine,
            0.5 * (pi2 - 4.0) / pi2,
            0.125 - 1.5 * (pi2 - 4.0) / (pi2 * pi2),
        ),
        (
            Bump::Polynomial(3),
            2.0 * p / (2.0 * p * (p + 1.0)),
            1.0 / (2.0 * (p + 1.0) * (p + 2.0)),
        ),
    ];
    for (bump, first, second) in cases {
        for s in [0.1, 0.37, 0.9] {
            let carries = 2.0 * -bump.slope(s) / (PI * first * d.powi(3));
            let spreads = 2.0 * bump.value(s) / (PI * second * d.powi(4));
            let off = [
                odd(bump, d, 2).value(s * d) / carries - 1.0,
                even(bump, d, 2).value(s * d) / spreads - 1.0,
            ];
            assert!(off.iter().all(|o| o.abs() < 1e-14), "{bump:?}: {off:?}");
        }
    }
    // exp(−1/(1 − s²)) has none: against 64 times the panels
    for dimension in [1, 2] {
        for kernel in [
            odd(Bump::Smooth, d, dimension),
            even(Bump::Smooth, d, dimension),
        ] {
            let power = if kernel.parity() == Parity::Odd { 1 } else { 2 };
            let (factor, more) = if dimension == 1 { (2.0, 0) } else { (PI, 1) };
            let fine =
                Gauss::new(4096).integral(0.0, d, |r| r.powi(power + more) * kernel.value(r));
            assert!(
                (factor * fine - 2.0).abs() < 2e-14,
                "{:e}",
                factor * fine - 2.0
            );
        }
    }
}

/// A kernel that jumps where no panel ends has its moment, and is neither refused nor scaled.
#[test]
fn kernels_by_expression_may_jump() {
    let (d, edge) = (0.5f64, 0.5 / 3.0);
    // ∫ z φ = 2·c·edge²/2
    let f = move |z: f64| {
        if z.abs() < edge {
            z.signum() * 2.0 / (edge * edge)
        } else {
            0.0
        }
    };
    let profile = Profile::Function(std::sync::Arc::new(f));
    let kernel = Kernel::new(Parity::Odd, profile, d, 1, false, "k").unwrap();
    assert!((kernel.moment() - 2.0).abs() < 1e-12);
    let k = 3.0;
    let exact = 2.0 / (edge * edge) * (1.0 - (k * edge).cos()) / k;
    assert!((kernel.symbol(k) - exact).abs() < 1e-12 * exact);
}

/// A horizon longer than half a period, and than several: partners are images, each as often as it lies within the horizon. A wave then has the symbol of the
/// weights on the endless grid.
#[test]
fn horizons_may_be_longer_than_the_period() {
    let n = 24;
    for periods in [0.4, 0.7, 1.6, 3.2] {
        for dimension in [1, 2] {
            let grid = match dimension {
                1 => Grid::line(0.0, 2.0 * PI, n).unwrap(),
                _ => Grid::plane([0.0; 2], [2.0 * PI, PI], n).unwrap(),
            };
            let delta = periods * 2.0 * PI;
            let (a, s) = (
                odd(Bump::Cosine, delta, dimension),
                even(Bump::Cosine, delta, dimension),
            );
            let k = [2.0, if dimension == 1 { 0.0 } else { 4.0 }];
            let phase = |x: &[f64; 3]| k[0] * x[0] + k[1] * x[1];
            let u = grid.sample(|x| phase(x).cos());
            let linear = Some((Flux::linear(1.0), Direction::Constant([1.0, 0.0]), &a));
            let law = Law::new(grid, Boundary::Periodic, linear, Some((1.0, &s))).unwrap();
            let turn = k.map(|k| k * grid.spacing);
            let stencils = [&a, &s].map(|k| Stencil::new(k, &grid, "k").unwrap());
            let [carried, spread] = [&stencils[0], &stencils[1]].map(|s| s.symbol(turn)[0]);
            // −iα of e^{ikx} is α sin kx of cos kx
            let exact = grid.sample(|x| carried * phase(x).sin() + spread * phase(x).cos());
            let bonds = 2.0 * (stencils[0].steps.len() + stencils[1].steps.len()) as f64;
            let sizes = { stencils.iter() }.flat_map(|s| s.weights.iter().map(|w| w[0].abs()));
            let bound = bonds * f64::EPSILON * 2.0 * sizes.sum::<f64>();
            for way in [Evaluation::Direct, Evaluation::Fourier] {
                let mut rate = vec![0.0; u.len()];
                operator(&law, way).rate(&u, 0.0, &mut rate);
                let off = measure::distance(&rate, &exact);
                assert!(
                    off <= bound,
                    "{periods} {dimension} {way:?}: {off:e} of {bound:e}"
                );
            }
        }
    }
}
