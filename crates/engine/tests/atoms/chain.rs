//! Chains: springs against their closed form, Lennard-Jones chains of seleson2009, crossings, densities without meaning.

use crate::sample::*;
use peridyne::error::RunError;
use peridyne::expression::Expression;
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

fn springs(points: usize, neighbours: u32) -> Spec {
    let mut spec = Spec::new(
        1,
        block(LatticeKind::Chain, 1.0, points),
        1.0,
        LawSpec::Springs(PmbStiffness::Young(1.0)),
    );
    spec.bonds.horizon = Horizon::Ratio(neighbours);
    spec
}

/// (A.2): `ρ ü = Σ 2 K1 / (j M (M+1) Δx²) (u_j − u)`, frequency of the wave with angle θ per spacing.
fn omega(m: u32, theta: f64) -> f64 {
    let sum: f64 = (1..=m)
        .map(|j| (1.0 - (theta * f64::from(j)).cos()) / f64::from(j))
        .sum();
    (4.0 * sum / f64::from(m * (m + 1))).sqrt()
}

#[test]
fn a_wave_on_a_ring_of_springs_is_its_closed_form() {
    let n = 96;
    for m in [1u32, 2, 5, 20] {
        for k in [1, 7, 30] {
            let theta = std::f64::consts::TAU * f64::from(k) / n as f64;
            let mut spec = springs(n, m);
            spec.space.periodic[0] = Some(n as f64);
            let dt = 0.5;
            spec.run.schedule.time_step = TimeStep::Fixed(dt);
            let mut sim = build(&spec, Options::default()).unwrap();
            let wave = |i: usize| (theta * i as f64).cos();
            sim.set_displacements(&(0..n).map(|i| [wave(i), 0.0, 0.0]).collect::<Vec<_>>());
            sim.start(true);
            let steps = 400;
            for _ in 0..steps {
                sim.step().unwrap();
            }
            // cos θ_k = 1 − ½ (ωΔt)²
            let phase = 2.0 * (0.5 * dt * omega(m, theta)).asin();
            let exact = (phase * f64::from(steps)).cos();
            for (i, u) in sim.displacements().iter().enumerate() {
                assert!(
                    (u[0] - exact * wave(i)).abs() < 1e-12,
                    "M = {m}, k = {k}: {} {}",
                    u[0],
                    exact * wave(i)
                );
            }
        }
    }
}

/// KE + PE − (Δt²/8) ρ Δx Σ a² is what the linear scheme conserves; KE + PE alone wobbles.
#[test]
fn springs_conserve_the_energy_of_the_scheme() {
    let n = 201;
    let mut spec = springs(n, 5);
    let dt = 0.9;
    spec.run.schedule.time_step = TimeStep::Fixed(dt);
    let mut sim = build(&spec, Options::default()).unwrap();
    let u: Vec<_> = (0..n)
        .map(|i| [if (90..=110).contains(&i) { 1.0 } else { 0.0 }, 0.0, 0.0])
        .collect();
    sim.set_displacements(&u);
    sim.start(true);
    let (mut first, mut wobble) = (None, 0.0f64);
    for _ in 0..300 {
        let ledger = sim.ledger().unwrap();
        let a2: f64 = sim
            .vectors("force_density")
            .iter()
            .map(|f| f[0] * f[0])
            .sum();
        let exact = ledger.kinetic + ledger.strain - dt * dt / 8.0 * a2;
        let first = *first.get_or_insert(exact);
        assert!((exact / first - 1.0).abs() < 1e-12, "{exact} {first}");
        wobble = wobble.max((ledger.residual() / ledger.initial).abs());
        sim.step().unwrap();
    }
    assert!(wobble > 1e-3, "{wobble}: the test says nothing");
}

/// A square pulse on a fine chain: in one step points go further than the spacing, through their neighbours.
#[test]
fn springs_go_further_than_their_spacing() {
    let n = 401;
    let mut spec = springs(n, 20);
    spec.run.schedule.time_step = TimeStep::Fixed(6.0);
    let mut sim = build(&spec, Options::default()).unwrap();
    let u: Vec<_> = (0..n)
        .map(|i| [if (150..=250).contains(&i) { 50.0 } else { 0.0 }, 0.0, 0.0])
        .collect();
    sim.set_displacements(&u);
    sim.start(true);
    for _ in 0..50 {
        sim.step().unwrap();
    }
    let moved = sim.displacements().iter().map(|u| u[0]).sum::<f64>();
    assert!((moved / (50.0 * 101.0) - 1.0).abs() < 1e-12, "{moved}");
    sim.set_time_step(60.0);
    let error = (0..400).find_map(|_| sim.step().err());
    assert!(
        matches!(error, Some(RunError::NotFinite { .. })),
        "{error:?}"
    );
}

/// The stability limit of a long chain is measured on a part of it, which must hold whole families.
#[test]
fn the_limit_of_a_long_chain_of_large_families_is_measured() {
    for m in [1u32, 20, 100] {
        let spec = springs(20_001, m);
        let limit = build(&spec, Options::default()).unwrap().info().stable_step;
        let top = (1..=4000)
            .map(|k| omega(m, std::f64::consts::PI * f64::from(k) / 4000.0))
            .fold(0.0, f64::max);
        assert!(
            (limit * top / 2.0 - 1.0).abs() < 0.02,
            "{m}: {limit} {}",
            2.0 / top
        );
    }
}

/// Linear springs in one dimension are the bond-based solid while no bond turns over.
#[test]
fn springs_are_pmb_where_nothing_turns_over() {
    let run = |law| {
        let mut spec = springs(64, 3);
        spec.materials[0].law = law;
        spec.run.schedule.time_step = TimeStep::Fixed(0.5);
        spec.loading.initial = vec![InitialSpec {
            set: "all".into(),
            displacement: [
                Some(Expression::parse("0.3*exp(-((x-30)/4)^2)", &[]).unwrap()),
                None,
                None,
            ],
            velocity: [None, None, None],
        }];
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        for _ in 0..100 {
            sim.step().unwrap();
        }
        (sim.displacements(), sim.ledger().unwrap().strain)
    };
    let (a, b) = (
        run(LawSpec::Springs(PmbStiffness::Young(1.0))),
        run(LawSpec::Pmb(PmbStiffness::Young(1.0))),
    );
    assert!((a.1 - b.1).abs() < 1e-13 * a.1);
    for (x, y) in a.0.iter().zip(&b.0) {
        assert!((x[0] - y[0]).abs() < 1e-13);
    }
}

/// In two dimensions springs are the bond-based solid for small displacements.
#[test]
fn springs_are_pmb_at_small_strains_in_the_plane() {
    let run = |law, scale: f64| {
        let mut spec = Spec::new(2, block(LatticeKind::Square, 1.0, 12), 1.0, law);
        spec.bonds.horizon = Horizon::Ratio(3);
        let mut sim = build(&spec, Options::default()).unwrap();
        let mut noise = Noise(3);
        let u: Vec<_> = (0..144)
            .map(|_| [scale * noise.next(), scale * noise.next(), 0.0])
            .collect();
        sim.forces_under(&u)
    };
    let difference = |scale| {
        let a = run(LawSpec::Springs(PmbStiffness::Young(1.0)), scale);
        let b = run(LawSpec::Pmb(PmbStiffness::Young(1.0)), scale);
        let d = a.iter().flatten().zip(b.iter().flatten());
        d.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max) / scale
    };
    let (coarse, fine) = (difference(1e-3), difference(1e-4));
    assert!(
        fine < 1e-3 && (coarse / fine - 10.0).abs() < 0.5,
        "{coarse} {fine}"
    );
}

fn zeta(m: u32, n: i32) -> f64 {
    (1..=m).map(|j| f64::from(j).powi(-n)).sum()
}

/// seleson2009 (5.3): σ̄ and ε̄ stay, Δx = n a and M = N/n.
fn lennard_jones(spacing: f64, m: u32, reduced_sigma: f64, reduced_epsilon: f64) -> PotentialSpec {
    PotentialSpec::of(LennardJones {
        epsilon: reduced_epsilon * spacing * zeta(m, 12) / zeta(m, 6).powi(2),
        sigma: reduced_sigma * spacing * (zeta(m, 6) / zeta(m, 12)).powf(1.0 / 6.0),
    })
}

fn lj_chain(points: usize, spacing: f64, m: u32) -> Spec {
    let mut spec = Spec::new(
        1,
        block(LatticeKind::Chain, spacing, points),
        1.0,
        LawSpec::Atoms(lennard_jones(
            spacing,
            m,
            0.5f64.powf(1.0 / 6.0),
            1.0 / 72.0,
        )),
    );
    spec.bonds.horizon = Horizon::Ratio(m);
    spec.bonds.family = FamilyChoice::Stencil;
    spec.run.schedule.time_step = TimeStep::Fixed(0.1);
    spec
}

/// A chain of LJ atoms: forces of (5.1) by its own formula, wave speed 1 for ε̄ = 1/72.
#[test]
fn forces_of_a_chain_are_those_of_the_paper() {
    let (n, m) = (40, 4);
    let spec = lj_chain(n, 1.0, m);
    let lj = &spec.potential().unwrap().parameters;
    let [eps, sigma] = lj.all(["epsilon", "sigma"]).unwrap();
    let mut sim = build(&spec, Options::default()).unwrap();
    let mut noise = Noise(9);
    let u: Vec<[f64; 3]> = (0..n).map(|_| [0.2 * noise.next(), 0.0, 0.0]).collect();
    let f = sim.forces_under(&u);
    for i in 0..n {
        let mut exact = 0.0;
        for j in 0..n {
            if i != j && i.abs_diff(j) <= m as usize {
                let r = (j as f64 + u[j][0]) - (i as f64 + u[i][0]);
                exact -=
                    24.0 * eps * (2.0 * sigma.powi(12) / r.powi(13) - sigma.powi(6) / r.powi(7));
            }
        }
        assert!((f[i][0] - exact).abs() < 1e-12, "{i}: {} {exact}", f[i][0]);
    }
}

/// Without warnings in equilibrium, with one under pressure.
#[test]
fn pressure_is_reported() {
    let spec = lj_chain(40, 1.0, 4);
    assert!(
        build(&spec, Options::default())
            .unwrap()
            .info()
            .warnings
            .is_empty()
    );
}

#[test]
fn atoms_that_cross_stop_the_run_and_the_state_before_stays() {
    let mut spec = lj_chain(100, 1.0, 4);
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [None, None, None],
        velocity: [
            Some(Expression::parse("-8*(x-50)/(1+abs(x-50))^3", &[]).unwrap()),
            None,
            None,
        ],
    }];
    spec.run.schedule.force_unstable = true;
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let error = (0..200)
        .find_map(|_| sim.step().err())
        .expect("nothing happened");
    assert!(
        matches!(error, RunError::Crossing { .. } | RunError::TooFast { .. }),
        "{error}"
    );
    let u = sim.displacements();
    let ordered = (1..100).all(|i| 1.0 + u[i][0] - u[i - 1][0] > 0.0);
    assert!(ordered && u.iter().all(|u| u[0].is_finite()));
    assert!(sim.velocities().iter().all(|v| v[0].is_finite()));
}

/// A point that would jump is noticed wherever it is: all others are in blocks of their own and stand still.
#[test]
fn one_jump_in_a_long_chain_stops_the_run() {
    for at in [5, 700, 1500, 2990] {
        let mut sim = build(&lj_chain(3000, 1.0, 4), Options::default()).unwrap();
        let mut u = vec![[0.0; 3]; 3000];
        u[at][0] = 0.8;
        sim.set_displacements(&u);
        sim.start(true);
        let error = sim.step().expect_err("the jump was not noticed");
        assert!(
            matches!(error, RunError::TooFast { step: 1, .. }),
            "{at}: {error}"
        );
        assert_eq!(sim.displacements()[at][0], 0.8);
    }
}

/// An initial state that is crossed already is named before a step, wherever it is, and the first of several.
#[test]
fn a_crossed_beginning_is_named() {
    for (points, at) in [
        (20, 7usize),
        (3000, 7),
        (3000, 1534),
        (3000, 1535),
        (3000, 2998),
    ] {
        let mut sim = build(&lj_chain(points, 1.0, 2), Options::default()).unwrap();
        let mut u = vec![[0.0; 3]; points];
        for u in u[at..].iter_mut().step_by(2) {
            u[0] = 1.5;
        }
        sim.set_displacements(&u);
        sim.start(true);
        assert_eq!(
            sim.ledger().unwrap_err(),
            RunError::Crossing {
                step: 0,
                i: at as u64 + 1,
                j: at as u64 + 2
            }
        );
    }
}

fn eam_chain(h: f64, points: usize, density_length: f64) -> Spec {
    let shells = (1..=8).map(|m| (2.0, f64::from(m))).collect();
    let mut constants = mei(h, shells);
    (constants.near, constants.cutoff) = (3.5, 3.9);
    (constants.pair_length, constants.density_length) = (2.0, density_length);
    // energies are densities times the length of an atom
    (constants.cohesive, constants.pair) = (3.54 * h, 0.1217 * h);
    let mut spec = Spec::new(
        1,
        block(LatticeKind::Chain, h, points),
        63.546,
        LawSpec::Atoms(PotentialSpec::of(constants)),
    );
    spec.bonds.horizon = Horizon::Ratio(5);
    spec.bonds.family = FamilyChoice::Stencil;
    spec.run.schedule.time_step = TimeStep::Fixed(0.2 * h);
    spec
}

/// seleson2014: the model at spacing h is the one at 1 with lengths and times scaled, exactly.
#[test]
fn the_upscaled_chain_is_the_chain_scaled() {
    let run = |h: f64| {
        let mut sim = build(&eam_chain(h, 61, 1.0), Options::default()).unwrap();
        let u: Vec<_> = (0..61)
            .map(|i| {
                [
                    0.05 * h * (-((i as f64 - 30.0) / 6.0).powi(2)).exp(),
                    0.0,
                    0.0,
                ]
            })
            .collect();
        sim.set_displacements(&u);
        sim.start(true);
        for _ in 0..60 {
            sim.step().unwrap();
        }
        let ledger = sim.ledger().unwrap();
        (sim.displacements(), ledger.kinetic / h, ledger.strain / h)
    };
    let (one, four) = (run(1.0), run(4.0));
    // powers of two: the same bits
    for (x, y) in one.0.iter().zip(&four.0) {
        assert_eq!(4.0 * x[0], y[0]);
    }
    assert!((one.1 - four.1).abs() < 1e-13 * one.1 && (one.2 - four.2).abs() < 1e-13 * one.2.abs());
}

/// The single length scale of the paper makes the density of the chain negative where it is compressed.
#[test]
fn a_density_without_meaning_is_explained() {
    let compressed = |density_length: f64| {
        let options = Options {
            trust_time_step: true,
            ..Options::default()
        };
        let mut sim = build(&eam_chain(1.0, 30, density_length), options).unwrap();
        sim.set_displacements(
            &(0..30)
                .map(|i| [-0.13 * i as f64, 0.0, 0.0])
                .collect::<Vec<_>>(),
        );
        sim.start(true);
        sim.ledger()
    };
    compressed(1.0).unwrap();
    let error = compressed(2.0).unwrap_err();
    assert!(
        matches!(error, RunError::Density { step: 0, density, .. } if density < 0.0),
        "{error}"
    );
}

/// The same said of a perfect lattice before anything is built.
#[test]
fn a_lattice_without_density_is_refused() {
    let mut spec = eam_chain(1.0, 30, 2.3);
    spec.body = BodySpec::Lattice {
        kind: LatticeKind::Chain,
        spacing: 1.0,
        origin: [0.0; 3],
        region: peridyne::space::region::Region::Block {
            low: [0.0; 3],
            high: [30.0, 0.0, 0.0],
        },
        perturb: None,
    };
    let error = build(&spec, Options::default()).err().unwrap();
    assert!(error.message.contains("electron density"), "{error}");
}
