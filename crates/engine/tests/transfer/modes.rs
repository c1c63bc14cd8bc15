//! A wave of temperature on a periodic body is a vector of its own: it decays at the rate of the dispersion relation, and steps
//! change it by numbers that are known.

use crate::sample::*;
use peridyne::spec::*;
use std::f64::consts::PI;

const H: f64 = 0.25;
const CELLS: usize = 12;

/// `2 Σ_j D ω (1/m + 1/m) V (1 − cos k·ξ)/2` of a wave along x over the ball of three spacings.
fn rate(d: usize, wave: f64) -> f64 {
    let side = |a: usize| if a < d { -3i32..=3 } else { 0..=0 };
    let (mut moment, mut sum) = (0.0, 0.0);
    for z in side(2) {
        for y in side(1) {
            for x in side(0) {
                let square = x * x + y * y + z * z;
                if square > 0 && square <= 9 {
                    moment += f64::from(square) * H * H;
                    sum += 1.0 - (wave * f64::from(x) * H).cos();
                }
            }
        }
    }
    2.0 * d as f64 * sum / moment
}

fn wave(d: usize, method: DiffusionMethod, dt: f64) -> Spec {
    let long = CELLS as f64 * H;
    let mut heat = heat(method);
    heat.initial = vec![("all".into(), text(&format!("3 + cos(2*pi*x/{long})")))];
    let mut spec = still(d, cells(d, H, [0.0; 3], [long; 3]), 3, dt, heat);
    spec.bonds.partial_volume_correction = false;
    for a in 0..d {
        spec.space.periodic[a] = Some(long);
    }
    spec
}

#[test]
fn a_wave_decays_by_the_dispersion_relation() {
    for d in 1..=3 {
        let wave_number = 2.0 * PI / (CELLS as f64 * H);
        let rate = rate(d, wave_number);
        // far from the limit, where a step is one part
        let dt = 0.05 / rate;
        let steps = [
            (EXPLICIT, 1.0 - dt * rate),
            (EULER, 1.0 / (1.0 + dt * rate)),
            (
                CRANK_NICOLSON,
                (1.0 - 0.5 * dt * rate) / (1.0 + 0.5 * dt * rate),
            ),
        ];
        for (method, factor) in steps {
            let mut sim = built(&wave(d, method, dt));
            if method == EXPLICIT {
                assert!(dt < 0.9 * sim.info().diffusions[0].stable_step, "{d}-D");
            }
            run(&mut *sim, 7);
            let exact = |x: f64| 3.0 + factor.powi(7) * (wave_number * x).cos();
            let off = off(&mut *sim, [f64::NEG_INFINITY, f64::INFINITY], exact);
            assert!(off < 1e-12, "{d}-D, {method:?}: {off:e}");
        }
    }
}

/// The local limit: `rate → k²`, with an error of second order in the horizon.
#[test]
fn long_waves_decay_as_in_a_continuum() {
    for d in 1..=3 {
        let of = |wave: f64| rate(d, wave) / (wave * wave) - 1.0;
        let order = (of(0.2) / of(0.1)).log2();
        assert!((order - 2.0).abs() < 0.01, "{d}-D: {order}");
        assert!(of(0.01).abs() < 1e-4);
    }
}

/// A step longer than the stable one is divided, and then makes no new extremes.
#[test]
fn explicit_steps_are_divided() {
    let mut long = built(&wave(1, EXPLICIT, 1.0));
    let stable = long.info().diffusions[0].stable_step;
    let parts = (1.0 / (0.9 * stable)).ceil();
    assert!(parts > 3.0, "{parts}");
    run(&mut *long, 1);
    let mut short = built(&wave(1, EXPLICIT, 1.0 / parts));
    run(&mut *short, parts as u64);
    let [a, b] = [temperature(&mut *long), temperature(&mut *short)];
    let off = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-14);
    // what jumps most stays between what it was
    let mut heat = heat(DiffusionMethod::Explicit { safety: 1.0 });
    heat.initial = vec![("all".into(), text("cos(4*pi*x)"))];
    let mut sim = built(&still(2, cells(2, H, [0.0; 3], [3.0; 3]), 3, 1e-2, heat));
    let mut most = temperature(&mut *sim)
        .iter()
        .fold(0.0f64, |m, t| m.max(t.abs()));
    for _ in 0..20 {
        run(&mut *sim, 1);
        let now = temperature(&mut *sim)
            .iter()
            .fold(0.0f64, |m, t| m.max(t.abs()));
        assert!(now <= most * (1.0 + 1e-15), "{now} after {most}");
        most = now;
    }
    assert!(most < 0.5);
}
