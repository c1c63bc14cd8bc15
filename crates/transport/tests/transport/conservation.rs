//! What is kept, and how ∫u² changes.

use crate::sample::{evolution, fixed, line, operator};
use peridyne_transport::{Boundary, Bump, Evaluation, Flux, Grid, Law, Method, StepSize, measure};
use std::f64::consts::PI;
use std::sync::Arc;

fn start(x: f64) -> f64 {
    0.3 + x.sin() + 0.2 * (2.0 * x).sin()
}

/// `d/dt ∫u²/2` pair by pair, each bond from both ends and counted half: `w F(u, v)(v − u)` and `−ε w (v − u)²`. A partner in a collar keeps its value: of such a bond
/// the point's part alone counts.
fn pairs(law: &Law, u: &[f64], t: f64) -> f64 {
    let [n, rows] = law.grid.cells.map(|c| c as isize);
    let mut sum = 0.0;
    let mut over = |stencil: &peridyne_transport::weights::Stencil,
                    of: &dyn Fn(f64, f64, [f64; 2], f64) -> f64| {
        for (m, w) in stencil.steps.iter().zip(&stencil.weights) {
            for (sign, (j, i)) in [1, -1]
                .into_iter()
                .flat_map(|s| (0..rows).flat_map(move |j| (0..n).map(move |i| (s, (j, i)))))
            {
                let (k, l) = (i + sign * m[0], j + sign * m[1]);
                let own = u[(j * n + i) as usize];
                let (partner, part) = match &law.boundary {
                    Boundary::Periodic => {
                        (u[(l.rem_euclid(rows) * n + k.rem_euclid(n)) as usize], 0.5)
                    }
                    Boundary::Collars(_) if (0..n).contains(&k) && (0..rows).contains(&l) => {
                        (u[(l * n + k) as usize], 0.5)
                    }
                    Boundary::Collars(given) => (given(&law.grid.middle(k, l), t), f64::NAN),
                };
                sum += of(own, partner, w.map(|w| w * sign as f64), part);
            }
        }
    };
    if let Some(a) = &law.advection {
        let peridyne_transport::Direction::Constant(d) = a.direction else {
            panic!("a constant direction")
        };
        over(a.stencil(), &|u, v, w, part| {
            let flow = (w[0] * d[0] + w[1] * d[1]) * a.flux.value(u, v);
            if part.is_nan() {
                -flow * u
            } else {
                part * flow * (v - u)
            }
        });
    }
    if let Some(d) = &law.diffusion {
        over(d.stencil(), &|u, v, w, part| {
            let flow = d.viscosity * w[0].abs() * (v - u);
            if part.is_nan() {
                flow * u
            } else {
                -part * flow * (v - u)
            }
        });
    }
    sum * law.grid.cell()
}

/// The rate of energy of the operator is that of its pairs, which know nothing of sums: periodic and in collars, on a line and in a plane, both fluxes, summed either way.
#[test]
fn the_rate_of_energy_is_that_of_pairs() {
    let line_grid = Grid::line(0.0, 2.0, 90).unwrap();
    let plane = Grid::plane([0.0; 2], [1.0, 0.8], 20).unwrap();
    let collars = || Boundary::Collars(Arc::new(|x: &[f64; 3], t| (3.0 * x[0] + x[1] + t).cos()));
    for grid in [line_grid, plane] {
        let (a, s) = (
            crate::sample::odd(Bump::Cosine, 4.3 * grid.spacing, grid.dimension),
            crate::sample::even(Bump::Smooth, 3.4 * grid.spacing, grid.dimension),
        );
        let u = grid.sample(|x| 0.3 + (7.0 * x[0]).sin() + 0.4 * (5.0 * x[1] + x[0]).cos());
        for flux in [
            Flux::burgers(),
            Flux::energy_conserving(),
            Flux::of_mean(&[0.3, 1.0, 0.0, 0.7]),
        ] {
            for boundary in [Boundary::Periodic, collars()] {
                let direction = peridyne_transport::Direction::Constant(match grid.dimension {
                    1 => [1.0, 0.0],
                    _ => [0.6, -0.8],
                });
                let law = Law::new(
                    grid,
                    boundary,
                    Some((flux.clone(), direction, &a)),
                    Some((0.02, &s)),
                )
                .unwrap();
                let expected = pairs(&law, &u, 0.4);
                for evaluation in [Evaluation::Direct, Evaluation::Fourier] {
                    if evaluation == Evaluation::Fourier && !law.is_convolution() {
                        continue;
                    }
                    let found = operator(&law, evaluation).energy_rate(&u, 0.4);
                    assert!(
                        (found - expected).abs() < 1e-12 * expected.abs().max(1.0),
                        "{flux:?} {evaluation:?}: {found} {expected}"
                    );
                }
            }
        }
    }
}

/// A long horizon costs the rate of energy no more than an evaluation and a sum.
#[test]
fn the_rate_of_energy_costs_an_evaluation() {
    let law = line(16_384, Some(Flux::burgers()), Bump::Polynomial(3), 6.0, 0.0);
    let u = law.grid.sample(|x| x[0].sin());
    let mut o = operator(&law, Evaluation::choose(&law));
    let mut rate = vec![0.0; u.len()];
    let least = |work: &mut dyn FnMut()| {
        let times = (0..5).map(|_| {
            let begin = std::time::Instant::now();
            work();
            begin.elapsed().as_secs_f64()
        });
        times.fold(f64::INFINITY, f64::min)
    };
    let evaluation = least(&mut || o.rate(&u, 0.0, &mut rate));
    let energy = least(&mut || assert!(o.energy_rate(&u, 0.0).abs() < 1e-3));
    // bond by bond it is thousands
    assert!(energy < 20.0 * evaluation, "{energy} {evaluation}");
}

#[test]
fn the_integral_is_kept_to_round_off() {
    let methods = [Method::Ssprk3, Method::Rk4, Method::Imex];
    for evaluation in [Evaluation::Direct, Evaluation::Fourier] {
        for method in methods {
            let law = line(128, Some(Flux::burgers()), Bump::Polynomial(2), 0.5, 0.05);
            let mut e = evolution(&law, evaluation, start, method, StepSize::Part(0.5));
            let before = measure::mass(&e.u, law.grid.cell());
            e.run_to(1.5).unwrap();
            let after = measure::mass(&e.u, law.grid.cell());
            assert!(e.steps > 5);
            assert!(
                (after - before).abs() < 1e-13,
                "{evaluation:?} {method:?}: {:e}",
                after - before
            );
        }
    }
}

/// `d/dt ∫u²/2 = −(1/24) ∫∫_{z>0} φ(z) (u(x + z) − u(x))³ dz dx` for Burgers' ψ((u+v)/2): it grows in compression. The flux (u² + uv + v²)/6 keeps it.
#[test]
fn energy_grows_in_compression_unless_the_flux_conserves_it() {
    let law = line(256, Some(Flux::burgers()), Bump::Cosine, 0.4, 0.0);
    let mut operator_ = operator(&law, Evaluation::Direct);
    let u = law.grid.sample(|x| start(x[0]));
    let rate = operator_.energy_rate(&u, 0.0);
    // the same from the operator itself
    let mut slope = vec![0.0; u.len()];
    operator(&law, Evaluation::Fourier).rate(&u, 0.0, &mut slope);
    let own: f64 = law.grid.cell() * u.iter().zip(&slope).map(|(u, r)| u * r).sum::<f64>();
    assert!((rate - own).abs() < 1e-13, "{rate} {own}");
    // and from the law of cubes, written out here
    let kernel = crate::sample::odd(Bump::Cosine, 0.4, 1);
    let gauss = peridyne_transport::quadrature::Gauss::new(8);
    let cubes = gauss.integral(0.0, 2.0 * PI, |x| {
        gauss.integral(0.0, 0.4, |z| {
            kernel.value(z) * (start(x + z) - start(x)).powi(3)
        })
    });
    assert!(
        (rate + cubes / 24.0).abs() < 1e-5 * cubes.abs(),
        "{rate} {cubes}"
    );
    let down = line(256, Some(Flux::burgers()), Bump::Cosine, 0.4, 0.0);
    // rises slowly and falls steeply
    let saw = |x: f64| {
        -(1..=5)
            .map(|k| (f64::from(k) * x).sin() / f64::from(k))
            .sum::<f64>()
    };
    let u = down.grid.sample(|x| saw(x[0]));
    assert!(operator(&down, Evaluation::Direct).energy_rate(&u, 0.0) > 1e-3);
    let law = line(256, Some(Flux::energy_conserving()), Bump::Cosine, 0.4, 0.0);
    let u = law.grid.sample(|x| start(x[0]));
    assert!(
        operator(&law, Evaluation::Direct)
            .energy_rate(&u, 0.0)
            .abs()
            < 1e-13
    );
}

/// The energy of a run against the integral of the exact law over time, to the order of the method.
#[test]
fn the_energy_law_holds_to_the_order_of_the_step() {
    for (method, order) in [
        (Method::Ssprk3, 3.0),
        (Method::Rk4, 4.0),
        (Method::Imex, 2.0),
    ] {
        let law = line(64, Some(Flux::burgers()), Bump::Cosine, 0.6, 0.05);
        // the large negative coefficient of the last delays its order
        let finer = if method == Method::Imex { 8 } else { 1 };
        let steps = [40, 80, 160].map(|n| n * finer);
        let errors = steps.map(|n| {
            let dt = 0.8 / f64::from(n);
            let mut e = evolution(&law, Evaluation::Direct, start, method, fixed(dt));
            let begin = measure::energy(&e.u, law.grid.cell());
            // Simpson over pairs of steps
            let mut integral = e.operator.energy_rate(&e.u, 0.0);
            for k in 1..=n {
                e.step(dt).unwrap();
                let weight = if k == n {
                    1.0
                } else if k % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                integral += weight * e.operator.energy_rate(&e.u, e.time);
            }
            (measure::energy(&e.u, law.grid.cell()) - begin - integral * dt / 3.0).abs()
        });
        let found = measure::orders(&steps.map(|n| 1.0 / f64::from(n)), &errors);
        assert!(
            found.iter().all(|o| *o > order - 0.25),
            "{method:?}: {errors:?} {found:?}"
        );
    }
}

/// Two trial steps give the same rate, and leave the state alone.
#[test]
fn trial_steps_measure_the_rate() {
    let law = line(64, Some(Flux::burgers()), Bump::Cosine, 0.6, 0.05);
    let mut e = evolution(
        &law,
        Evaluation::Fourier,
        start,
        Method::Rk4,
        StepSize::Part(0.5),
    );
    let before = e.u.clone();
    let exact = e.operator.energy_rate(&e.u, 0.0);
    let off = [2e-3, 1e-3].map(|dt| (e.energy_slope(dt).unwrap() - exact).abs());
    assert_eq!(before, e.u);
    assert!(off[1] < 0.26 * off[0] && off[1] < 1e-5, "{off:?}");
}

/// In collars u is given; a state that they continue stays.
#[test]
fn collars_hold_what_they_are_given() {
    let (a, s) = (
        crate::sample::odd(Bump::Smooth, 0.2, 1),
        crate::sample::even(Bump::Smooth, 0.2, 1),
    );
    let grid = Grid::line(-1.0, 1.0, 80).unwrap();
    // linear in x is steady for diffusion alone, whatever the horizon
    let boundary = Boundary::Collars(Arc::new(|x, _| 1.0 + 0.5 * x[0]));
    let law = Law::new(grid, boundary, None, Some((0.3, &s))).unwrap();
    let mut e = evolution(
        &law,
        Evaluation::Direct,
        |x| if x < 0.0 { 0.0 } else { 2.0 },
        Method::Imex,
        fixed(0.2),
    );
    for _ in 0..400 {
        e.step(0.2).unwrap();
    }
    let line = grid.sample(|x| 1.0 + 0.5 * x[0]);
    assert!(
        measure::distance(&e.u, &line) < 1e-9,
        "{:e}",
        measure::distance(&e.u, &line)
    );
    // a law of energy with collars: what goes in at the ends counts
    let boundary = Boundary::Collars(Arc::new(|x, _| if x[0] < 0.0 { 1.0 } else { 0.0 }));
    let flux = (
        Flux::burgers(),
        peridyne_transport::Direction::Constant([1.0, 0.0]),
        &a,
    );
    let law = Law::new(grid, boundary, Some(flux), Some((0.1, &s))).unwrap();
    let u = grid.sample(|x| 0.5 - 0.5 * (3.0 * x[0]).tanh());
    let mut o = operator(&law, Evaluation::Direct);
    let mut rate = vec![0.0; u.len()];
    o.rate(&u, 0.0, &mut rate);
    let own: f64 = grid.cell() * u.iter().zip(&rate).map(|(u, r)| u * r).sum::<f64>();
    assert!((o.energy_rate(&u, 0.0) - own).abs() < 1e-13);
}
