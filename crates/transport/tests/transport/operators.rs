//! Operators: both evaluations alike, symbols, Noll's flux, moments.

use crate::sample::{BUMPS, even, line, odd, operator};
use peridyne_transport::grid::Values;
use peridyne_transport::noll::{Noll, through_faces};
use peridyne_transport::quadrature::Gauss;
use peridyne_transport::weights::Stencil;
use peridyne_transport::{Boundary, Bump, Direction, Evaluation, Flux, Grid, Law, measure};
use std::f64::consts::PI;
use std::sync::Arc;

fn rough(n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| ((i * i) as f64 * 0.37).sin() + 0.3)
        .collect()
}

/// Round-off of a sum over bonds: 16 times that of the largest terms times all weights. Errors of many bonds are not of one sign.
fn round_off(law: &Law, u: &[f64]) -> f64 {
    let far = u.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    let reach =
        |s: &Stencil| -> f64 { s.weights.iter().map(|w| 2.0 * f64::hypot(w[0], w[1])).sum() };
    let mut size = 0.0;
    if let Some(a) = &law.advection {
        let terms: f64 = match &a.flux {
            Flux::Polynomial(c) => { c.iter().enumerate() }
                .flat_map(|(p, row)| {
                    row.iter()
                        .enumerate()
                        .map(move |(q, c)| c.abs() * far.powi((p + q) as i32))
                })
                .sum(),
            Flux::Function(_) => f64::NAN,
        };
        size += terms * reach(a.stencil());
    }
    if let Some(d) = &law.diffusion {
        size += d.viscosity * 2.0 * far * reach(d.stencil());
    }
    16.0 * f64::EPSILON * size
}

/// Fluxes of each kind.
fn fluxes() -> [Flux; 4] {
    [
        Flux::linear(1.3),
        Flux::burgers(),
        Flux::energy_conserving(),
        Flux::of_mean(&[0.2, -1.0, 0.0, 0.4, 0.1]),
    ]
}

#[test]
fn direct_sums_and_fourier_transforms_are_equal_to_round_off() {
    for n in [96, 257] {
        for flux in fluxes() {
            for bump in BUMPS {
                let law = line(n, Some(flux.clone()), bump, 0.9, 0.2);
                let u = rough(n);
                let [a, b] = [Evaluation::Direct, Evaluation::Fourier].map(|e| {
                    let mut rate = vec![0.0; n];
                    operator(&law, e).rate(&u, 0.0, &mut rate);
                    rate
                });
                let off = measure::distance(&a, &b);
                let bound = round_off(&law, &u);
                assert!(off < bound, "{flux:?} {bump:?}: {off:e} of {bound:e}");
            }
        }
    }
}

#[test]
fn in_a_plane_too_with_a_field_of_directions() {
    let (a, s) = (odd(Bump::Polynomial(3), 0.7, 2), even(Bump::Smooth, 0.7, 2));
    let grid = Grid::plane([0.0, 0.0], [2.0 * PI, PI], 48).unwrap();
    let field = Direction::Field([
        Arc::new(|x, _| x[1].sin()),
        Arc::new(|x, _| (2.0 * x[0]).cos()),
    ]);
    for direction in [Direction::Constant([0.6, -0.8]), field] {
        for flux in fluxes() {
            let law = Law::new(
                grid,
                Boundary::Periodic,
                Some((flux, direction.clone(), &a)),
                Some((0.1, &s)),
            )
            .unwrap();
            let u = rough(grid.points());
            let [a, b] = [Evaluation::Direct, Evaluation::Fourier].map(|e| {
                let mut rate = vec![0.0; u.len()];
                operator(&law, e).rate(&u, 0.0, &mut rate);
                rate
            });
            let bound = round_off(&law, &u);
            let off = measure::distance(&a, &b);
            assert!(off < bound, "{off:e} of {bound:e}");
            // nothing is made: what leaves a point comes to another
            assert!(measure::mass(&a, 1.0).abs() < bound * grid.points() as f64);
        }
    }
}

/// The same flux as a function: bond by bond, and by convolutions.
#[test]
fn a_flux_that_is_a_function_carries_like_its_polynomial() {
    let psi = |u: f64| 0.2 - u + 0.4 * u.powi(3);
    for collars in [false, true] {
        let a = odd(Bump::Cosine, 0.5, 1);
        let grid = Grid::line(0.0, 2.0 * PI, 80).unwrap();
        let boundary = || match collars {
            true => Boundary::Collars(Arc::new(|x, t| x[0].cos() + t)),
            false => Boundary::Periodic,
        };
        let rates = [
            Flux::Function(Arc::new(psi)),
            Flux::of_mean(&[0.2, -1.0, 0.0, 0.4]),
        ]
        .map(|flux| {
            let flux = Some((flux, Direction::Constant([1.0, 0.0]), &a));
            let law = Law::new(grid, boundary(), flux, None).unwrap();
            let mut rate = vec![0.0; 80];
            operator(&law, Evaluation::Direct).rate(&rough(80), 0.4, &mut rate);
            rate
        });
        assert!(measure::distance(&rates[0], &rates[1]) < 1e-12);
    }
}

/// `∫ φ_a (u(y) + u(x))/2 dy` of a wave is iα(k), α the symbol; of bumps `k b̂(kδ)`. The operator on a wave of the grid gives that of the weights.
#[test]
fn waves_follow_the_symbol() {
    // a whole number of spacings of all grids
    let delta = PI / 4.0;
    for bump in BUMPS {
        let (a, s) = (odd(bump, delta, 1), even(bump, delta, 1));
        for k in [1.0, 3.0, 7.0] {
            if let Some(b) = bump.transform(k * delta) {
                assert!(
                    (a.symbol(k) - k * b).abs() < 1e-12 * k,
                    "{bump:?} {k}: {} {}",
                    a.symbol(k),
                    k * b
                );
            }
            let mut off = vec![];
            let sizes = [64, 128, 256];
            for n in sizes {
                let grid = Grid::line(0.0, 2.0 * PI, n).unwrap();
                let u = grid.sample(|x| (k * x[0]).cos());
                let linear = (Flux::linear(1.0), Direction::Constant([1.0, 0.0]), &a);
                let law =
                    Law::new(grid, Boundary::Periodic, Some(linear), Some((1.0, &s))).unwrap();
                let mut operator = operator(&law, Evaluation::Fourier);
                let (mut carried, mut spread) = (vec![0.0; n], vec![0.0; n]);
                operator.carry(&u, 0.0, &mut carried);
                operator.spread(&u, 0.0, &mut spread);
                // projected on sin kx and cos kx: a pure wave stays one
                let part = |f: fn(f64) -> f64, v: &[f64]| {
                    grid.sample(|x| f(k * x[0]))
                        .iter()
                        .zip(v)
                        .map(|(a, b)| a * b)
                        .sum::<f64>()
                        * 2.0
                        / n as f64
                };
                let (omega, decay) = (part(f64::sin, &carried), part(f64::cos, &spread));
                let [sum_a, sum_s] = [&a, &s].map(|kernel| {
                    let stencil = Stencil::new(kernel, &grid, "k").unwrap();
                    stencil
                        .weights
                        .iter()
                        .map(|w| 4.0 * w[0].abs())
                        .sum::<f64>()
                });
                let round = 16.0 * f64::EPSILON;
                assert!(part(f64::cos, &carried).abs() < round * sum_a);
                assert!(part(f64::sin, &spread).abs() < round * sum_s);
                let found = [(omega - a.symbol(k)).abs(), (decay - s.symbol(k)).abs()];
                // ∫zφ, ∫z³φ and ∫z²φ, ∫z⁴φ are exact: the first of the series of the sine and of the cosine that are not are
                // k⁵/120 ∫z⁵φ and k⁶/360 ∫z⁶φ, moments of 2δ⁴ at most, by a trapezoidal rule that errs by (h/δ)²,
                // of which the two exact moments leave less than half
                let rest = 0.5 * (delta * grid.spacing).powi(2);
                let bound = [
                    2.0 * k.powi(5) / 120.0 * rest,
                    2.0 * k.powi(6) / 360.0 * rest,
                ];
                for p in 0..2 {
                    assert!(
                        found[p] < bound[p] + round * [sum_a, sum_s][p],
                        "{bump:?} {k} {n}: {found:?} {bound:?}"
                    );
                }
                off.push(found[0] + found[1]);
            }
            // smooth kernels beyond any order, those with kinks at second order or better
            let orders = measure::orders(&[4.0, 2.0, 1.0], &off);
            assert!(
                off[2] < 1e-11 || orders[1] > 1.95,
                "{bump:?} {k}: {off:?} {orders:?}"
            );
        }
    }
}

#[test]
fn closed_transforms_are_those_of_the_bumps() {
    let x = 2.3f64;
    let parabola = 3.0 * (x.sin() - x * x.cos()) / x.powi(3);
    assert!((Bump::Polynomial(1).transform(x).unwrap() - parabola).abs() < 1e-14);
    assert!((Bump::Cosine.transform(PI).unwrap() - 0.5).abs() < 1e-12);
    for bump in BUMPS {
        // slopes are slopes
        for s in [0.2, 0.5, 0.81] {
            let d = 1e-5;
            assert!(
                ((bump.value(s + d) - bump.value(s - d)) / (2.0 * d) - bump.slope(s)).abs() < 1e-8,
                "{bump:?}"
            );
            assert!(
                ((bump.slope(s + d) - bump.slope(s - d)) / (2.0 * d) - bump.curvature(s)).abs()
                    < 1e-7,
                "{bump:?}"
            );
        }
    }
}

/// (2.0.9a) and (2.0.9b), to the round-off of the quadrature.
#[test]
fn the_divergence_of_nolls_flux_is_the_operator() {
    for flux in fluxes()
        .into_iter()
        .chain([Flux::Function(Arc::new(|u: f64| (1.5 * u).sin()))])
    {
        for bump in BUMPS {
            let kernel = odd(bump, 0.6, 1);
            let noll = Noll {
                flux: &flux,
                kernel: &kernel,
                u: |x: f64| (2.0 * x).sin() + 0.4 * (x - 0.3).cos(),
                gauss: Gauss::new(4),
            };
            let [flow, integral] = noll.identity(0.2, 1.5);
            assert!(
                (flow - integral).abs() < 1e-13,
                "{flux:?} {bump:?}: {flow} {integral}"
            );
            assert!(flow.abs() > 1e-3);
        }
    }
}

/// On a grid too, of any state: in collars and on a ring, along a field of directions, with what spreads, of fluxes that are functions.
#[test]
fn what_flows_through_faces_is_what_changes_between_them() {
    let n = 40;
    let field: Values = Arc::new(|x, _| 1.0 + 0.5 * (3.0 * x[0]).sin());
    let directions = [
        Direction::Constant([-0.7, 0.0]),
        Direction::Field([field.clone(), field.clone()]),
    ];
    let around: Values = Arc::new(|x, t| (2.0 * x[0] - t).cos());
    let root = Flux::Function(Arc::new(|u: f64| (1.5 * u).sin()));
    let grid = Grid::line(-1.0, 1.0, n).unwrap();
    for flux in fluxes().into_iter().chain([root]) {
        for direction in &directions {
            for boundary in [Boundary::Periodic, Boundary::Collars(around.clone())] {
                let (a, s) = (odd(Bump::Hat, 0.37, 1), even(Bump::Cosine, 0.5, 1));
                let carried = (flux.clone(), direction.clone(), &a);
                let law = Law::new(grid, boundary, Some(carried), Some((0.3, &s))).unwrap();
                let u = grid.sample(|x| (17.0 * x[0]).sin() + x[0]);
                let faces = through_faces(&law, &u, 0.4);
                let mut rate = vec![0.0; n];
                operator(&law, Evaluation::Direct).rate(&u, 0.4, &mut rate);
                for (rate, f) in rate.iter().zip(faces.windows(2)) {
                    assert!((rate + (f[1] - f[0]) / grid.spacing).abs() < 1e-11);
                }
                if law.periodic() {
                    assert!((faces[n] - faces[0]).abs() < 1e-12);
                }
            }
        }
    }
}

/// The sum over bonds that cross a face tends to the integral (2.0.9a).
#[test]
fn flux_through_faces_tends_to_nolls() {
    let u = |x: f64| (2.0 * x).sin() + 0.4 * (x - 0.3).cos();
    let flux = Flux::burgers();
    let kernel = odd(Bump::Smooth, 0.6, 1);
    let noll = Noll {
        flux: &flux,
        kernel: &kernel,
        u,
        gauss: Gauss::new(4),
    };
    let off = |n: usize| {
        let law = line(n, Some(flux.clone()), Bump::Smooth, 0.6, 0.0);
        let own = law.grid.sample(|x| u(x[0]));
        let faces = through_faces(&law, &own, 0.0);
        let h = law.grid.spacing;
        let each = faces.iter().enumerate();
        each.map(|(k, f)| (f - noll.flux(h * k as f64)).abs())
            .fold(0.0, f64::max)
    };
    let [coarse, fine] = [off(256), off(512)];
    // the mean of midpoints between the ends of a bond errs as h²
    assert!(
        ((coarse / fine).log2() - 2.0).abs() < 0.1,
        "{coarse} {fine}"
    );
    assert!(coarse < 1e-2);
}

/// A constant state has the local flux: the speed of shocks is that of Rankine and Hugoniot.
#[test]
fn nolls_flux_of_a_constant_is_the_local_flux() {
    for flux in fluxes() {
        let kernel = odd(Bump::Smooth, 0.6, 1);
        let noll = Noll {
            flux: &flux,
            kernel: &kernel,
            u: |_| 0.7,
            gauss: Gauss::new(16),
        };
        assert!((noll.flux(0.0) - flux.local(0.7)).abs() < 1e-12);
    }
}

/// F(u + c, v + c) = F(u, v) + c(u + v)/2 + c²/2 of both fluxes of Burgers, so that the operator on u + c is that on u and c times the linear one, which is not ∂_x: the equation
/// is not Galilean invariant, and what a moving frame leaves is known.
#[test]
fn a_moving_frame_leaves_the_linear_operator() {
    let (n, c) = (120, 2.7);
    for flux in [Flux::burgers(), Flux::energy_conserving()] {
        let rate = |flux: Flux, u: &[f64]| {
            let law = line(n, Some(flux), Bump::Cosine, 0.8, 0.0);
            let mut rate = vec![0.0; n];
            operator(&law, Evaluation::Direct).rate(u, 0.0, &mut rate);
            (rate, round_off(&law, u))
        };
        let u = rough(n);
        let moved: Vec<f64> = u.iter().map(|u| u + c).collect();
        let ((own, _), (whole, bound), (linear, _)) = (
            rate(flux.clone(), &u),
            rate(flux, &moved),
            rate(Flux::linear(c), &u),
        );
        let sum: Vec<f64> = own.iter().zip(&linear).map(|(a, b)| a + b).collect();
        let off = measure::distance(&whole, &sum);
        assert!(off < bound, "{off:e} of {bound:e}");
        // c ∂_x of a wave is not it: the operator has b̂(kδ) of that
        let law = line(n, None, Bump::Cosine, 0.8, 1.0);
        let wave = law.grid.sample(|x| (3.0 * x[0]).sin());
        let slope =
            rate(Flux::linear(1.0), &wave).0[0] / -(3.0 * (3.0 * law.grid.place(0)[0]).cos());
        let b = Bump::Cosine.transform(3.0 * 0.8).unwrap();
        assert!((slope - b).abs() < 1e-3 && b < 0.8, "{slope} {b}");
    }
}

/// Fourier transforms from 80 bonds of a point on, however many convolutions a law has; functions and collars never.
#[test]
fn the_faster_evaluation_is_chosen() {
    let choose = |flux: Flux, spacings: f64, viscosity: f64| {
        let h = 2.0 * PI / 1000.0;
        Evaluation::choose(&line(
            1000,
            Some(flux),
            Bump::Cosine,
            spacings * h,
            viscosity,
        ))
    };
    for viscosity in [0.0, 1.0] {
        for flux in fluxes() {
            assert_eq!(choose(flux.clone(), 39.5, viscosity), Evaluation::Direct);
            assert_eq!(choose(flux, 40.5, viscosity), Evaluation::Fourier);
        }
    }
    let function = Flux::Function(Arc::new(f64::sin));
    assert_eq!(choose(function, 100.0, 0.0), Evaluation::Direct);
}
