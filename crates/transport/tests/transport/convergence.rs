//! To the local laws as the horizon shrinks, and in h and ε.

use crate::sample::{evolution, fixed, line};
use peridyne_transport::exact::{ColeHopf, characteristics, shock_time, viscous_shock};
use peridyne_transport::{Bump, Evaluation, Flux, Method, StepSize, measure};

/// Do orders found at halved sizes tend to one, as they do where the next term of the error is `factor` times smaller for half the size? Their distance from it falls by
/// that factor, here within a quarter, and is below 0.1 at the start.
fn tends(orders: &[f64], order: f64, factor: f64) -> bool {
    let off: Vec<f64> = orders.iter().map(|o| (o - order).abs()).collect();
    off[0] < 0.1 && off.windows(2).all(|w| w[1] < 1.25 * w[0] / factor + 1e-3)
}

/// Before the shock: second order in δ, for each bump and for both fluxes of Burgers.
#[test]
fn second_order_in_the_horizon_before_the_shock() {
    let g = |x: f64| 0.2 + x.sin();
    let t = 0.5;
    for bump in [Bump::Hat, Bump::Polynomial(2), Bump::Smooth] {
        for flux in [Flux::burgers(), Flux::energy_conserving()] {
            let deltas = [0.2, 0.1, 0.05];
            let errors = deltas.map(|delta| {
                let law = line(1024, Some(flux.clone()), bump, delta, 0.0);
                let u0 = law.grid.sample(|x| g(x[0]));
                let shock = shock_time(&flux, &u0, law.grid.spacing, true).unwrap();
                assert!((shock - 1.0).abs() < 1e-4, "{shock}");
                let mut e = evolution(
                    &law,
                    Evaluation::Fourier,
                    g,
                    Method::Rk4,
                    StepSize::Part(0.5),
                );
                e.run_to(t).unwrap();
                let exact = law.grid.sample(|x| characteristics(&flux, g, 1.3, x[0], t));
                measure::distance(&e.u, &exact)
            });
            let orders = measure::orders(&deltas, &errors);
            assert!(
                tends(&orders, 2.0, 4.0),
                "{bump:?} {flux:?}: {errors:?} {orders:?}"
            );
        }
    }
}

/// A state without slope has no shock, whatever round-off its speeds have; on a ring a front may stand where the ends meet.
#[test]
fn shocks_are_found_at_seams_and_not_in_round_off() {
    let flat: Vec<f64> = (0..100)
        .map(|k| 1.0 + f64::EPSILON * f64::from(k % 2))
        .collect();
    let flux = Flux::burgers();
    assert_eq!(shock_time(&flux, &flat, 0.01, true), None);
    let root = Flux::Function(std::sync::Arc::new(|u: f64| u.abs()));
    let rises: Vec<f64> = (1..100).map(f64::from).collect();
    assert_eq!(shock_time(&root, &rises, 0.01, false), None);
    // from 0 up to 1, and down where the ring closes: over a cell
    let saw: Vec<f64> = (0..101).map(|k| f64::from(k) / 100.0).collect();
    assert_eq!(shock_time(&flux, &saw, 0.01, false), None);
    assert!((shock_time(&flux, &saw, 0.01, true).unwrap() - 0.01).abs() < 1e-15);
}

/// With viscosity second order for all times, also where the inviscid law has a shock.
#[test]
fn second_order_in_the_horizon_with_viscosity() {
    let epsilon = 0.1;
    let exact = ColeHopf::new(|y: f64| -y.cos(), 1.0, epsilon).unwrap();
    let t = 2.0;
    let deltas = [0.2, 0.1, 0.05];
    let errors = deltas.map(|delta| {
        let law = line(1024, Some(Flux::burgers()), Bump::Smooth, delta, epsilon);
        let mut e = evolution(
            &law,
            Evaluation::Fourier,
            f64::sin,
            Method::Imex,
            StepSize::Part(0.1),
        );
        e.run_to(t).unwrap();
        let places: Vec<usize> = (0..1024).step_by(16).collect();
        let off = |n: &usize| (e.u[*n] - exact.value(law.grid.place(*n)[0], t)).abs();
        places.iter().map(off).fold(0.0, f64::max)
    });
    let orders = measure::orders(&deltas, &errors);
    assert!(tends(&orders, 2.0, 4.0), "{errors:?} {orders:?}");
}

/// Cole and Hopf's integral solves the equation: by differences of it.
#[test]
fn cole_and_hopf_solve_burgers() {
    let exact = ColeHopf::new(|y: f64| -y.cos(), 1.0, 0.1).unwrap();
    let (x, t, d) = (2.2, 0.8, 1e-3);
    let u = exact.value(x, t);
    let slope = (exact.value(x + d, t) - exact.value(x - d, t)) / (2.0 * d);
    let bend = (exact.value(x + d, t) - 2.0 * u + exact.value(x - d, t)) / (d * d);
    let rate = (exact.value(x, t + d) - exact.value(x, t - d)) / (2.0 * d);
    assert!(
        (rate + u * slope - 0.1 * bend).abs() < 1e-5,
        "{}",
        rate + u * slope - 0.1 * bend
    );
    assert!((exact.value(x, 1e-4) - x.sin()).abs() < 2e-4);
}

/// Where e^{−Φ/2ε} under- and overflows: against the viscous shock, which is exact for every ε, and against the characteristics, which a smooth solution leaves by O(ε).
#[test]
fn cole_and_hopf_for_tiny_viscosities() {
    let t = 0.7;
    for epsilon in [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10] {
        // from (1 − tanh(x/4ε))/2, with ln cosh z = |z| + ln(1 + e^{−2|z|}) − ln 2
        let primitive = |y: f64| {
            let z = (y / (4.0 * epsilon)).abs();
            0.5 * y - 2.0 * epsilon * (z + (-2.0 * z).exp().ln_1p() - 2f64.ln())
        };
        let exact = ColeHopf::new(primitive, 1.0, epsilon).unwrap();
        for s in [-30.0, -3.0, -1.0, -0.2, 0.0, 0.4, 2.0, 10.0] {
            let x = 0.5 * t + s * epsilon;
            let off = (exact.value(x, t) - viscous_shock(1.0, 0.0, epsilon, x - 0.5 * t)).abs();
            // Φ of size 1 is known to its round-off, of which the weights see the ratio to 2ε
            assert!(
                off < 1e-11 + 4.0 * f64::EPSILON / epsilon,
                "{epsilon:e} {s}: {off:e}"
            );
        }
    }
    let flux = Flux::burgers();
    for epsilon in [1e-3, 1e-5, 1e-7, 1e-10, 1e-14, 1e-20, 1e-100, 1e-300] {
        let exact = ColeHopf::new(|y: f64| -y.cos(), 1.0, epsilon).unwrap();
        for x in [0.3, 1.0, 2.0, 3.0, 4.5] {
            let u = exact.value(x, t);
            let local = characteristics(&flux, f64::sin, 1.0, x, t);
            // |u_xx| t is below 40 there
            let bound = 40.0 * epsilon + 2.0 * (f64::EPSILON).sqrt();
            assert!((u - local).abs() < bound, "{epsilon:e} {x}: {u} {local}");
        }
        // past the shock both branches, by the deeper well: outside of [−1, 1] u never is
        let past = |x: f64| exact.value(x, 2.0);
        assert!(
            past(3.0) > 0.9 && past(3.0) <= 1.0 && past(3.3) < -0.9,
            "{epsilon:e}: {} {}",
            past(3.0),
            past(3.3)
        );
    }
}

/// At a fixed horizon that is no whole number of spacings: second order for a kernel that jumps there, third for one whose second derivative does.
#[test]
fn orders_in_the_spacing() {
    for (bump, order) in [(Bump::Hat, 1.9), (Bump::Polynomial(3), 2.8)] {
        let state = |n: usize| {
            let law = line(n, Some(Flux::burgers()), bump, 0.8, 0.02);
            let mut e = evolution(
                &law,
                Evaluation::Fourier,
                f64::sin,
                Method::Rk4,
                StepSize::Part(0.1),
            );
            e.run_to(0.4).unwrap();
            // at places that all grids share: middles of three cells' middle one
            let shared = n / 16;
            (0..16)
                .map(|k| e.u[k * shared + shared / 2])
                .collect::<Vec<f64>>()
        };
        let sizes = [48, 144, 432, 1296];
        let states = sizes.map(state);
        let errors: Vec<f64> = (0..2)
            .map(|k| measure::distance(&states[k], &states[3]))
            .collect();
        let orders = measure::orders(&[1.0, 1.0 / 3.0], &errors);
        assert!(orders[0] > order, "{bump:?}: {errors:?} {orders:?}");
    }
}

/// In ε: the viscous nonlocal solution tends to the inviscid nonlocal one linearly before the shock.
#[test]
fn first_order_in_the_viscosity_before_the_shock() {
    let run = |epsilon: f64| {
        let law = line(
            256,
            Some(Flux::energy_conserving()),
            Bump::Cosine,
            0.2,
            epsilon,
        );
        let mut e = evolution(
            &law,
            Evaluation::Fourier,
            f64::sin,
            Method::Rk4,
            // the same time steps: those of the largest ε
            fixed(2e-3),
        );
        e.run_to(0.5).unwrap();
        e.u
    };
    let inviscid = run(0.0);
    let values = [4e-3, 2e-3, 1e-3];
    let errors = values.map(|e| measure::distance(&run(e), &inviscid));
    let orders = measure::orders(&values, &errors);
    assert!(tends(&orders, 1.0, 2.0), "{errors:?} {orders:?}");
}
