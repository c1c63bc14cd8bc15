//! Plane waves: the discrete dispersion relation with the error of the time step, and the speed of long waves.

use crate::sample::*;
use peridyne::family::volume_fraction;
use peridyne::law::influence::influence;
use peridyne::run::Simulation;
use peridyne::space::Point;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

pub fn chain(name: &str, n: usize) -> Spec {
    let place = Place {
        kind: LatticeKind::Chain,
        plane: Plane::Stress,
        ratio: 3,
        cells: [n, 1, 1],
    };
    Case::of(name, place).periodic()
}

/// Ω² of a chain at phase θ per spacing, from the sums over the family.
///
/// Bond-based: `ρ Ω² = 4 Σ_{j>0} k_j sin²(θ j/2)`, `k_j = c ω ν V / r_j`. State-based (n, κ, β):
/// `ρ Ω² = (8 β/m) Σ_{j>0} ω ν V sin²(θ j/2) + (4 n² κ/m²) (Σ_{j>0} ω ν V r_j sin θ j)²`.
pub fn chain_omega2(spec: &Spec, sim: &mut dyn Simulation, theta: f64) -> f64 {
    let horizon = 3.0 * H;
    let v = sim.scalars("volume")[0];
    let bonds: Vec<(f64, f64, f64)> = (1..=3)
        .map(|j| {
            let r = j as f64 * H;
            let w = influence(spec.bonds.influence, &[r], r, horizon)
                * volume_fraction(r, horizon, H)
                * v;
            (j as f64, r, w)
        })
        .collect();
    let pairs = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        bonds
            .iter()
            .map(|(j, r, w)| of(*r, *w) * (0.5 * theta * j).sin().powi(2))
            .sum()
    };
    match spec.materials[0].law {
        LawSpec::Pmb(_) => {
            let c = sim.info().micromodulus[0];
            4.0 / RHO * pairs(&|r, w| c * w / r)
        }
        LawSpec::Lps(moduli) => {
            // on a line: n = 1, κ = λ − G with λ = E − 2G, β = 3G
            let g = moduli.shear();
            let (kappa, beta) = (moduli.young - 3.0 * g, 3.0 * g);
            let m: f64 = bonds.iter().map(|(_, r, w)| 2.0 * w * r * r).sum();
            let s: f64 = bonds
                .iter()
                .map(|(j, r, w)| w * r * (theta * j).sin())
                .sum();
            (8.0 * beta / m * pairs(&|_, w| w) + 4.0 * kappa * s * s / (m * m)) / RHO
        }
        _ => panic!("no closed form here"),
    }
}

/// Runs the mode `amplitude · cos(k·x)` from rest and returns the largest error against `cos(n ω Δt)`, relative to
/// the amplitude, where `sin(ωΔt/2) = ΩΔt/2`.
fn mode_error(sim: &mut dyn Simulation, k: f64, way: Point, omega2: f64, n: usize) -> f64 {
    let amplitude = 1e-11 * H;
    let u0: Vec<Point> = sim
        .vectors("reference")
        .iter()
        .map(|x| way.map(|w| amplitude * w * (k * x[0]).cos()))
        .collect();
    sim.set_displacements(&u0);
    sim.start(true);
    let dt = sim.info().time_step;
    let angle = 2.0 * (0.5 * omega2.sqrt() * dt).asin();
    let mut worst: f64 = 0.0;
    for step in 1..=n {
        sim.step().unwrap();
        if step % 50 == 0 || step < 4 {
            let c = (step as f64 * angle).cos();
            let expected: Vec<Point> = u0.iter().map(|u| u.map(|x| c * x)).collect();
            worst = worst.max(distance(&sim.displacements(), &expected) / amplitude);
        }
    }
    worst
}

#[test]
fn a_chain_disperses_as_it_must_in_space_and_time() {
    for name in ["pmb", "pmb conical", "lps", "lps auxetic"] {
        for mode in [1, 5, 13, 24, 32] {
            for fraction in [0.2, 0.95] {
                let mut spec = chain(name, 64);
                spec.run.schedule.time_step = TimeStep::Fraction(fraction);
                let mut sim = made(&spec);
                let theta = 2.0 * std::f64::consts::PI * mode as f64 / 64.0;
                let omega2 = chain_omega2(&spec, sim.as_mut(), theta);
                let off = mode_error(sim.as_mut(), theta / H, [1.0, 0.0, 0.0], omega2, 1000);
                assert!(off < 1e-9, "{name}, mode {mode}, {fraction}: {off:e}");
                // the test sees a frequency that is off by 1e-7
                if mode == 13 {
                    sim.set_velocities(&vec![[0.0; 3]; 64]);
                    let off = mode_error(
                        sim.as_mut(),
                        theta / H,
                        [1.0, 0.0, 0.0],
                        omega2 * (1.0 + 2e-7),
                        1000,
                    );
                    assert!(off > 1e-9, "{name}: {off:e}");
                }
            }
        }
    }
}

/// Longitudinal and transverse waves along x of a bond-based cube:
/// `ρ Ω² = Σ_bonds (c ω ν V / r) (ξ·w)²/r² (1 − cos k ξ_x)`.
#[test]
fn a_cube_disperses_as_it_must() {
    let place = Place {
        kind: LatticeKind::Cubic,
        plane: Plane::Stress,
        ratio: 3,
        cells: [16, 3, 3],
    };
    let spec = Case::of("pmb", place).periodic();
    let theta = 2.0 * std::f64::consts::PI * 3.0 / 16.0;
    for (a, way) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].into_iter().enumerate() {
        let mut sim = made(&spec);
        let (c, v) = (sim.info().micromodulus[0], sim.scalars("volume")[0]);
        let mut sum = 0.0;
        for z in -3..=3i32 {
            for y in -3..=3i32 {
                for x in -3..=3i32 {
                    let squared = x * x + y * y + z * z;
                    if squared == 0 || squared > 9 {
                        continue;
                    }
                    let r = (squared as f64).sqrt();
                    let n = [x, y][a] as f64 / r;
                    let nu = volume_fraction(r * H, 3.0 * H, H);
                    sum += c * nu * v / (r * H) * n * n * (1.0 - (theta * x as f64).cos());
                }
            }
        }
        let off = mode_error(sim.as_mut(), theta / H, way, sum / RHO, 300);
        assert!(off < 1e-9, "axis {a}: {off:e}");
    }
}

/// Quarter periods of a standing wave, by the zeros of the mode's amplitude.
fn frequency(sim: &mut dyn Simulation, k: f64, way: Point, periods: usize) -> f64 {
    let x = sim.vectors("reference");
    let shape: Vec<f64> = x.iter().map(|x| (k * x[0]).cos()).collect();
    let u0: Vec<Point> = shape
        .iter()
        .map(|c| way.map(|w| 1e-9 * H * w * c))
        .collect();
    sim.set_displacements(&u0);
    sim.start(true);
    let project = |sim: &mut dyn Simulation| -> f64 {
        sim.displacements()
            .iter()
            .zip(&shape)
            .map(|(u, c)| c * dot(u, &way))
            .sum()
    };
    let (mut last, mut zeros) = (project(sim), vec![]);
    while zeros.len() < 2 * periods {
        sim.step().unwrap();
        let now = project(sim);
        if now * last < 0.0 {
            let t = sim.time();
            zeros.push(t - now / (now - last) * sim.info().time_step);
        }
        last = now;
    }
    let span = zeros[zeros.len() - 1] - zeros[0];
    std::f64::consts::PI * (zeros.len() - 1) as f64 / span
}

#[test]
fn long_waves_travel_at_the_speed_of_sound() {
    let tau = 2.0 * std::f64::consts::PI;
    for name in ["pmb", "lps"] {
        let speed = (3.0f64 / RHO).sqrt();
        let off = |n: usize| {
            let mut spec = chain(name, n);
            spec.run.schedule.time_step = TimeStep::Fraction(0.8);
            let mut sim = made(&spec);
            let k = tau / (n as f64 * H);
            let c = frequency(sim.as_mut(), k, [1.0, 0.0, 0.0], 1) / k;
            c / speed - 1.0
        };
        let (short, long) = (off(40), off(160));
        println!(
            "{name} chain: wave speed off √(E/ρ) by {short:.2e} at 40 points a wave, {long:.2e} at 160"
        );
        assert!(long.abs() < 1e-3, "{name}: {long}");
        assert!(
            (short / long - 16.0).abs() < 2.0,
            "second order in the wavelength: {}",
            short / long
        );
    }
    // in the cube the moduli of the lattice itself, from its energy
    for name in ["pmb", "lps"] {
        let place = Place {
            kind: LatticeKind::Cubic,
            plane: Plane::Stress,
            ratio: 2,
            cells: [64, 2, 2],
        };
        let mut spec = Case::of(name, place).periodic();
        spec.run.schedule.time_step = TimeStep::Fraction(0.8);
        let s = 1e-6;
        for (way, strain) in [
            ([1.0, 0.0, 0.0], [[s, 0.0, 0.0], [0.0; 3], [0.0; 3]]),
            (
                [0.0, 1.0, 0.0],
                [[0.0, 0.5 * s, 0.0], [0.5 * s, 0.0, 0.0], [0.0; 3]],
            ),
        ] {
            let mut sim = made(&spec);
            let modulus = 2.0 * sim.energy_under_strain(strain)[0] / (s * s);
            let k = tau / (64.0 * H);
            let c = frequency(sim.as_mut(), k, way, 1) / k;
            let off = c / (modulus / RHO).sqrt() - 1.0;
            println!("{name} cube along {way:?}: wave speed off √(modulus/ρ) by {off:.2e}");
            assert!(off.abs() < 2e-3, "{name}: {off}");
        }
    }
}

/// The measured limit against the closed form.
#[test]
fn the_stable_step_is_that_of_the_chain() {
    for name in ["pmb", "pmb conical", "lps", "lps auxetic"] {
        let spec = chain(name, 60);
        let mut sim = made(&spec);
        let largest = (0..=30)
            .map(|k| chain_omega2(&spec, sim.as_mut(), k as f64 / 30.0 * std::f64::consts::PI))
            .fold(0.0, f64::max);
        let limit = 2.0 / largest.sqrt();
        let ratio = sim.info().stable_step / limit;
        println!("{name} chain: measured limit of the step / 2/Ω_max = {ratio:.4}");
        assert!((0.97..=1.0).contains(&ratio), "{name}: {ratio}");
    }
}
