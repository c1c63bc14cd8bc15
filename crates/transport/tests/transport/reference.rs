//! Solutions of the local law that runs compare themselves with, against closed forms.

use crate::sample::{even, odd};
use peridyne_transport::exact::{Reference, Solution, characteristics, viscous_shock};
use peridyne_transport::grid::Values;
use peridyne_transport::{Boundary, Bump, Direction, Flux, Grid, Law};
use std::sync::Arc;

fn values(f: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) -> Values {
    Arc::new(move |x, t| f(x[0], t))
}

fn law(ends: [f64; 2], boundary: Boundary, flux: Flux, along: f64, viscosity: f64) -> Law {
    let (a, s) = (odd(Bump::Smooth, 0.1, 1), even(Bump::Smooth, 0.1, 1));
    Law::new(
        Grid::line(ends[0], ends[1], 200).unwrap(),
        boundary,
        Some((flux, Direction::Constant([along, 0.0]), &a)),
        (viscosity > 0.0).then_some((viscosity, &s)),
    )
    .unwrap()
}

fn reference(solution: Solution, law: &Law, g: &Values, t: f64) -> Result<Reference, String> {
    Reference::new(solution, law, g, t, "compare").map_err(|e| e.message.to_string())
}

/// A linear law carries what it is given, jumps too, over the ends of a ring; with c t of collars that move with it.
#[test]
fn a_linear_law_moves_its_state() {
    let ring = law([0.0, 1.0], Boundary::Periodic, Flux::linear(3.0), -0.5, 0.0);
    let saw = values(|x, _| x);
    let found = reference(Solution::Characteristics, &ring, &saw, 5.0).unwrap();
    for (n, u) in found.values(1.3).iter().enumerate() {
        let x = ring.grid.place(n)[0] + 1.5 * 1.3;
        assert!((u - x.rem_euclid(1.0)).abs() < 1e-12, "{u} {x}");
    }
    let carried = |x: f64, t: f64| (x - 2.0 * t).sin();
    let collars = Boundary::Collars(values(carried));
    let line = law([0.0, 1.0], collars, Flux::linear(2.0), 1.0, 0.0);
    let found = reference(Solution::Characteristics, &line, &values(carried), 3.0).unwrap();
    for (n, u) in found.values(2.1).iter().enumerate() {
        let x = line.grid.place(n)[0];
        assert!((u - carried(x, 2.1)).abs() < 1e-12);
    }
    // collars that stand still hold another solution
    let still = Boundary::Collars(values(move |x, _| carried(x, 0.0)));
    let line = law([0.0, 1.0], still, Flux::linear(2.0), 1.0, 0.0);
    let told = reference(Solution::Characteristics, &line, &values(carried), 3.0).unwrap_err();
    assert!(told.contains("the solution of another problem"), "{told}");
}

/// Along characteristics until just before they cross, and not until after that; ψ = u³ has its own speeds.
#[test]
fn characteristics_end_where_they_cross() {
    let tau = std::f64::consts::TAU;
    let g = values(|x, _| 0.3 + x.sin());
    let ring = |flux, along| law([0.0, tau], Boundary::Periodic, flux, along, 0.0);
    let burgers = ring(Flux::burgers(), -1.0);
    let found = reference(Solution::Characteristics, &burgers, &g, 0.99).unwrap();
    let t = 0.8;
    for (n, u) in found.values(t).iter().enumerate() {
        let x = burgers.grid.place(n)[0];
        // against the direction: mirrored in x
        let mirrored = characteristics(&Flux::burgers(), |x| 0.3 - x.sin(), 1.4, -x, t);
        assert!((u - mirrored).abs() < 1e-12);
        assert!((u - (0.3 + (x + t * u).sin())).abs() < 1e-12);
    }
    let late = reference(Solution::Characteristics, &burgers, &g, 1.01).unwrap_err();
    assert!(late.contains("characteristics cross at t = 1"), "{late}");
    // f′ = 3u² of ψ = u³ carries √x to √(x/(1 + 3t))
    let root = values(|x, t| (x / (1.0 + 3.0 * t)).max(0.0).sqrt());
    let line = law(
        [1.0, 2.0],
        Boundary::Collars(root.clone()),
        Flux::of_mean(&[0.0, 0.0, 0.0, 1.0]),
        1.0,
        0.0,
    );
    // characteristics come from beyond the collar, where u at t = 0 is what the collar says
    let found = reference(Solution::Characteristics, &line, &root, 4.0).unwrap();
    for (n, u) in found.values(4.0).iter().enumerate() {
        let x = line.grid.place(n)[0];
        assert!((u - (x / 13.0).sqrt()).abs() < 1e-10, "{u}");
    }
}

/// A step anywhere: a shock by Rankine and Hugoniot, a fan, none of a ramp.
#[test]
fn steps_are_riemanns_problem() {
    let at = 0.123;
    let step = |left: f64, right: f64| values(move |x, _| if x < at { left } else { right });
    let line = |left: f64, right: f64| {
        let boundary = Boundary::Collars(step(left, right));
        law([-2.0, 2.0], boundary, Flux::burgers(), 1.0, 0.0)
    };
    let t = 0.7;
    let shock = reference(Solution::Riemann, &line(1.0, -0.2), &step(1.0, -0.2), t).unwrap();
    let fan = reference(Solution::Riemann, &line(-0.4, 0.8), &step(-0.4, 0.8), t).unwrap();
    let grid = line(1.0, -0.2).grid;
    let (shock, fan) = (shock.values(t), fan.values(t));
    for n in 0..grid.points() {
        let x = grid.place(n)[0] - at;
        let state = if x < 0.4 * t { 1.0 } else { -0.2 };
        assert!((shock[n] - state).abs() < 1e-15, "{x} {}", shock[n]);
        assert!((fan[n] - (x / t).clamp(-0.4, 0.8)).abs() < 1e-7);
    }
    // until the shock comes to the collar
    let late = reference(Solution::Riemann, &line(1.0, 0.0), &step(1.0, 0.0), 4.0).unwrap_err();
    assert!(late.contains("the collar at x = 2"), "{late}");
    let ramp = values(|x, _| x.clamp(0.0, 1.0));
    let boundary = Boundary::Collars(ramp.clone());
    let line = law([-2.0, 2.0], boundary, Flux::burgers(), 1.0, 0.0);
    let told = reference(Solution::Riemann, &line, &ramp, 0.5).unwrap_err();
    assert!(told.contains("one step between two constants"), "{told}");
}

/// The viscous shock of any quadratic flux, carried on: of `f = a + bu + cu²` w = b + 2cu solves Burgers' equation.
#[test]
fn cole_and_hopf_solve_quadratic_fluxes() {
    let epsilon = 0.05;
    for [b, c, along] in [[0.0, 0.5, 1.0], [0.4, -0.8, 1.0], [0.0, 0.5, -1.0]] {
        let [b, c] = [along * b, along * c];
        // a shock of w from 0.9 down to 0.1
        let moved = move |x: f64, t: f64| {
            let w = viscous_shock(0.9, 0.1, epsilon, x - 0.5 * t);
            (w - b) / (2.0 * c)
        };
        let flux = Flux::of_mean(&[0.7, along * b, along * c]);
        let collars = Boundary::Collars(values(moved));
        let line = law([-1.0, 2.0], collars, flux, along, epsilon);
        let found = reference(Solution::ColeHopf, &line, &values(moved), 1.5).unwrap();
        for (n, u) in found.values(1.5).iter().enumerate() {
            let x = line.grid.place(n)[0];
            assert!((u - moved(x, 1.5)).abs() < 1e-9, "{b} {c}: {x} {u}");
        }
    }
}

/// On a ring the linear equation behind it has Fourier's series (Cole 1951): from sin x, with θ = e^{cos y/2ε} = Σ a_n cos ny, `u = −2ε θ_x/θ` of the heat that spreads.
#[test]
fn cole_and_hopf_on_a_ring_are_a_series() {
    let tau = std::f64::consts::TAU;
    let (epsilon, t) = (0.1, 1.7);
    let g = values(|x, _| x.sin());
    let ring = law(
        [0.0, tau],
        Boundary::Periodic,
        Flux::energy_conserving(),
        1.0,
        epsilon,
    );
    let found = reference(Solution::ColeHopf, &ring, &g, t).unwrap();
    // coefficients by the trapezoidal rule, exact to round-off
    let a = |n: i32| {
        let each = (0..128).map(|k| {
            let y = tau * f64::from(k) / 128.0;
            ((y.cos() - 1.0) / (2.0 * epsilon)).exp() * (f64::from(n) * y).cos()
        });
        each.sum::<f64>() * if n == 0 { 1.0 } else { 2.0 }
    };
    let heat: Vec<f64> = { 0..40 }
        .map(|n| a(n) * (-epsilon * f64::from(n * n) * t).exp())
        .collect();
    for (k, u) in found.values(t).iter().enumerate() {
        let x = ring.grid.place(k)[0];
        let (mut theta, mut slope) = (0.0, 0.0);
        for (n, h) in heat.iter().enumerate() {
            theta += h * (n as f64 * x).cos();
            slope -= n as f64 * h * (n as f64 * x).sin();
        }
        assert!((u + 2.0 * epsilon * slope / theta).abs() < 1e-10, "{x} {u}");
    }
}
