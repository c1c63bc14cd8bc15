//! Shocks: travelling waves, their tails, what happens without viscosity.

use crate::sample::{even, evolution, odd};
use peridyne_transport::exact::{riemann, viscous_shock};
use peridyne_transport::{
    Boundary, Bump, Direction, Evaluation, Evolution, Flux, Grid, Law, Method, Operator, StepSize,
    measure, wave,
};
use std::sync::Arc;

/// From 1 down to 0 at `start`.
fn shock(delta: f64, ratio: f64, start: f64, half: f64, points: usize) -> Evolution {
    let (a, s) = (
        odd(Bump::Polynomial(2), delta, 1),
        even(Bump::Polynomial(2), delta, 1),
    );
    let grid = Grid::line(-half, half, points).unwrap();
    let boundary = Boundary::Collars(Arc::new(|x, _| if x[0] < 0.0 { 1.0 } else { 0.0 }));
    let flux = (Flux::burgers(), Direction::Constant([1.0, 0.0]), &a);
    let law = Law::new(grid, boundary, Some(flux), Some((ratio * delta, &s))).unwrap();
    evolution(
        &law,
        Evaluation::Direct,
        |x| viscous_shock(1.0, 0.0, ratio * delta, x - start),
        Method::Rk4,
        StepSize::Part(0.8),
    )
}

#[test]
fn a_viscous_shock_travels_at_one_half() {
    let mut e = shock(0.025, 0.8, -2.0, 3.0, 1920);
    // what is left of the start decays as exp(−t/16ε)
    e.run_to(6.0).unwrap();
    let x = e.operator.law().grid.sample(|x| x[0]);
    let place = |e: &Evolution| measure::front(&x, &e.u, 1.0, 0.0).unwrap();
    let first = place(&e);
    // whole cells, so that the profile stands the same on the grid
    let time = e.time + 2.0 * 160.0 * e.operator.law().grid.spacing;
    let before = e.time;
    e.run_to(time).unwrap();
    let last = place(&e);
    let speed = (last.position - first.position) / (e.time - before);
    assert!((speed - 0.5).abs() < 1e-6, "{speed}");
    assert!(last.overshoot < 1e-9 && last.undershoot < 1e-9, "{last:?}");
    assert!((wave::speed(&Flux::burgers(), 1.0, 0.0) - 0.5).abs() < 1e-16);
}

/// The tail behind the wave oscillates below the threshold of ε/δ that its exponents give, and not above it; δ alone does not matter.
#[test]
fn tails_are_monotone_above_a_threshold() {
    let threshold = |delta: f64| {
        let (a, s) = (
            odd(Bump::Polynomial(2), delta, 1),
            even(Bump::Polynomial(2), delta, 1),
        );
        wave::monotone_threshold(&Flux::burgers(), 1.0, 0.0, &a, &s).0 / delta
    };
    let t = threshold(0.1);
    assert!((threshold(0.7) - t).abs() < 1e-9 * t);
    assert!(t > 0.05 && t < 1.0, "{t}");
    for (part, overshoots) in [(0.5, true), (1.3, false)] {
        let mut e = shock(0.1, part * t, -1.3, 3.0, 600);
        e.run_to(4.0).unwrap();
        let x = e.operator.law().grid.sample(|x| x[0]);
        let front = measure::front(&x, &e.u, 1.0, 0.0).unwrap();
        assert_eq!(front.overshoot > 1e-6, overshoots, "{part}: {front:?}");
    }
}

/// Past the shock and without ε the solution oscillates, and does not come nearer to the entropy solution as δ shrinks.
#[test]
fn without_viscosity_there_is_no_limit_past_the_shock() {
    let off = |delta: f64, viscosity: f64| {
        let (a, s) = (odd(Bump::Cosine, delta, 1), even(Bump::Cosine, delta, 1));
        let n = (20.0 / delta) as usize;
        let grid = Grid::line(-1.0, 1.0, n).unwrap();
        let boundary = Boundary::Collars(Arc::new(|x, _| if x[0] < 0.0 { 1.0 } else { 0.0 }));
        let flux = (
            Flux::energy_conserving(),
            Direction::Constant([1.0, 0.0]),
            &a,
        );
        let law = Law::new(
            grid,
            boundary,
            Some(flux),
            (viscosity > 0.0).then_some((viscosity, &s)),
        )
        .unwrap();
        let start = grid.sample(|x| if x[0] < -0.3 { 1.0 } else { 0.0 });
        let operator = Operator::new(law, Evaluation::Direct).unwrap();
        let mut e = Evolution::new(operator, start, Method::Rk4, StepSize::Part(0.5));
        e.run_to(0.6).unwrap();
        let exact = grid.sample(|x| riemann(&Flux::burgers(), 1.0, 0.0, (x[0] + 0.3) / 0.6));
        (
            measure::mean_distance(&e.u, &exact, grid.cell()),
            measure::extremes(&e.u)[1] - 1.0,
        )
    };
    let bare = [0.08, 0.04, 0.02].map(|d| off(d, 0.0));
    assert!(bare.iter().all(|b| b.1 > 0.2), "{bare:?}");
    assert!(bare[2].0 > 0.8 * bare[0].0, "{bare:?}");
    // with ε in proportion to δ it tends to it at first order
    let deltas = [0.08, 0.04, 0.02];
    let viscous = deltas.map(|d| off(d, 0.5 * d).0);
    let orders = measure::orders(&deltas, &viscous);
    assert!(
        orders.iter().all(|o| (o - 1.0).abs() < 0.15),
        "{viscous:?} {orders:?}"
    );
}
