//! Coarse bodies in motion: masses that couple points, against closed forms of a periodic chain and against dense arithmetic.

use super::super::lattice::LatticeBlock;
use super::super::waves::{Frequencies, frequencies, stable_step};
use super::super::{Mass, Options, Radius, Scheme, Selection, coarsen};
use super::bodies::{random, state_based};
use peridyne::expression::Expression;
use peridyne::run::{Options as Build, Simulation, build};
use peridyne::spec::{
    ConditionKind, ConditionSpec, LinearBody, MassMatrix, Members, Newmark, SetSpec, Spec, Stepper,
    ThermalSpec, TimeStep,
};
use peridyne::statics::{Support, modes};
use peridyne_algebra::eigenvalues;
use std::f64::consts::TAU;

const HORIZON: usize = 10;

/// Stiffness of a bond j long, half at the horizon, so that Young's modulus is 1: `Σ_j k_j j² h² = 1`, h = 1.
fn spring(j: usize) -> f64 {
    let weight = |j: usize| if j == HORIZON { 0.5 } else { 1.0 };
    let sum: f64 = (1..=HORIZON).map(|j| weight(j) * j as f64).sum();
    weight(j) / (j as f64 * sum)
}

fn chain(points: usize, periodic: bool) -> LinearBody<1> {
    let block = LatticeBlock::new([points], 1.0, HORIZON as f64);
    let block = if periodic { block.periodic() } else { block };
    block.body(|_| true, |_, [n]| spring(n.unsigned_abs() as usize))
}

fn every<const D: usize>(body: &LinearBody<D>, k: u32) -> Vec<u32> {
    Selection::every(k).choose(body).unwrap()
}

fn with(scheme: Scheme, mass: Mass) -> Options {
    Options {
        scheme,
        mass,
        ..Options::default()
    }
}

/// Stiffness of waves of level 0 and of every fourth point, and the mass of the shapes, by aliases: the compliance of the retained points
/// is that of all at their places, `1/K¹(k) = ¼ Σ_m 1/K(k + 2πm/4)`, and a wave of them is `c_m = K¹/(4 K(k + 2πm/4))` of each alias.
fn symbols(k: f64) -> [f64; 3] {
    let stiff = |k: f64| -> f64 {
        let each = (1..=HORIZON).map(|j| 2.0 * spring(j) * (1.0 - (k * j as f64).cos()));
        each.sum()
    };
    let aliases: Vec<f64> = (0..4)
        .map(|m| stiff(k + TAU * f64::from(m) / 4.0))
        .collect();
    let coarse = 4.0 / aliases.iter().map(|k| 1.0 / k).sum::<f64>();
    let square: f64 = aliases.iter().map(|k| (coarse / (4.0 * k)).powi(2)).sum();
    [aliases[0], coarse, 4.0 * square]
}

#[test]
fn waves_of_a_chain_are_those_of_the_closed_form() {
    let fine = chain(200, true);
    // a wave of 50 coarse spacings is right
    let [k0, k1, shapes] = symbols(TAU / 200.0);
    let blend = (4.0 - k1 / k0) / (4.0 - shapes);
    assert!((blend - 0.5).abs() < 0.02, "{blend}");
    // and half of each has what an independent program printed
    for (length, printed) in [(100.0, -0.23), (40.0, -5.2)] {
        let [k0, k1, shapes] = symbols(TAU / length);
        let error = 100.0 * ((k1 / (0.5 * shapes + 2.0) / k0).sqrt() - 1.0);
        assert!((error - printed).abs() < 0.05, "{length}: {error}");
    }
    for (mass, part, printed) in [
        (Mass::Lumped, 0.0, [-4.1, -18.4]),
        (Mass::Consistent, 1.0, [4.2, 17.7]),
        (Mass::Blend, blend, [0.0, 0.0]),
    ] {
        let (coarse, _) = coarsen(&fine, &every(&fine, 4), &with(Scheme::Schur, mass)).unwrap();
        let Frequencies::Waves(waves) = frequencies(&fine, &coarse) else {
            panic!("a chain has waves");
        };
        for (spacings, printed) in [25.0, 10.0].into_iter().zip(printed) {
            let wave = waves.iter().find(|w| w.spacings == spacings).unwrap();
            let [k0, k1, shapes] = symbols(TAU / wave.length);
            let exact = [
                k0.sqrt(),
                (k1 / (part * shapes + (1.0 - part) * 4.0)).sqrt(),
            ];
            for (found, exact) in [wave.fine, wave.coarse].into_iter().zip(exact) {
                assert!(
                    (TAU * found / exact - 1.0).abs() < 1e-10,
                    "{mass:?} {spacings}"
                );
            }
            // an independent program printed two or three digits, some of them rounded twice
            let digits = match mass {
                Mass::Blend if spacings == 25.0 => 0.3,
                Mass::Blend => 5.5,
                Mass::Lumped | Mass::Consistent => 0.06,
            };
            let error = 100.0 * wave.error();
            assert!(
                (error - printed).abs() <= digits,
                "{mass:?} {spacings}: {error}"
            );
        }
        // and the modes of the whole ring: two waves of each length
        let ring = modes::lowest(&coarse, &Support::none(coarse.points()), 5).unwrap();
        for (n, mode) in ring.iter().enumerate().skip(1) {
            let k = TAU * n.div_ceil(2) as f64 / 200.0;
            let [_, k1, shapes] = symbols(k);
            let square = k1 / (part * shapes + (1.0 - part) * 4.0);
            assert!(
                (mode.square / square - 1.0).abs() < 1e-8,
                "{mass:?} mode {n}"
            );
        }
    }
}

#[test]
fn masses_change_nothing_at_rest_and_keep_the_whole() {
    let bar = |scheme| {
        let fine = random([60], false, 10.0);
        (
            fine,
            Options {
                radius: Radius::Fixed(12.0),
                ..with(scheme, Mass::Blend)
            },
        )
    };
    let all = [Scheme::Energy, Scheme::Rows, Scheme::Schur];
    for (fine, options) in all.map(bar) {
        looked_at(&fine, &options);
    }
    looked_at(
        &state_based([13, 10], 0.3),
        &with(Scheme::Energy, Mass::Blend),
    );
    looked_at(
        &random([12, 9], false, 10.0),
        &with(Scheme::Energy, Mass::Consistent),
    );
}

fn looked_at<const D: usize>(fine: &LinearBody<D>, options: &Options) {
    let retained = every(fine, 3);
    let made = |mass| {
        coarsen(fine, &retained, &Options { mass, ..*options })
            .unwrap()
            .0
    };
    let (lumped, coupled) = (made(Mass::Lumped), made(options.mass));
    assert_eq!(
        LinearBody {
            mass: None,
            ..coupled.clone()
        },
        lumped
    );
    coupled.check().unwrap();
    // a level of the level has the mass of the level, in shapes of its own
    let next = Options {
        radius: Radius::Tolerance(0.05),
        ..*options
    };
    let again = coarsen(&coupled, &every(&coupled, 2), &next).unwrap().0;
    again.check().unwrap();
    for body in [&coupled, &again] {
        let matrix = body.mass.as_ref().unwrap();
        let whole: f64 = fine.masses().iter().sum();
        let sum: f64 = matrix.block.iter().map(|m| m[0][0]).sum();
        assert!(
            (sum / whole - 1.0).abs() < 1e-12,
            "{:?}: {sum}",
            options.scheme
        );
    }
}

/// A coarse chain of 20 points whose masses couple.
fn small() -> LinearBody<1> {
    let fine = chain(80, false);
    coarsen(&fine, &every(&fine, 4), &with(Scheme::Energy, Mass::Blend))
        .unwrap()
        .0
}

fn bump(x: f64) -> f64 {
    1e-3 * (-((x - 40.0) / 12.0).powi(2)).exp()
}

fn started(spec: &Spec, body: &LinearBody<1>, velocity: f64) -> Box<dyn Simulation> {
    let mut sim = build(spec, Build::default()).unwrap();
    let u: Vec<_> = body
        .position
        .iter()
        .map(|x| [bump(x[0]), 0.0, 0.0])
        .collect();
    sim.set_displacements(&u);
    sim.set_velocities(&vec![[velocity, 0.0, 0.0]; u.len()]);
    sim.start(true);
    sim
}

fn stepped(body: &LinearBody<1>, dt: f64, change: impl Fn(&mut Spec)) -> Spec {
    let mut spec = Spec::of_linear(body);
    spec.run.schedule.time_step = TimeStep::Fixed(dt);
    change(&mut spec);
    spec
}

#[test]
fn momentum_is_kept_and_energy_to_second_order() {
    let body = small();
    let mass = body.mass.clone().unwrap();
    let momentum = |sim: &mut dyn Simulation| -> f64 {
        let v = sim.vectors("velocity");
        let row = |i: usize| -> f64 {
            let (partners, blocks) = mass.row(i);
            partners
                .iter()
                .zip(blocks)
                .map(|(j, m)| m[0][0] * v[*j as usize][0])
                .sum()
        };
        (0..body.points()).map(row).sum()
    };
    let stray = |dt: f64| -> f64 {
        let mut sim = started(&stepped(&body, dt, |_| ()), &body, 1e-4);
        let begin = momentum(sim.as_mut());
        assert!((begin / (80.0 * 1e-4) - 1.0).abs() < 1e-12);
        let mut most = 0.0f64;
        for _ in 0..(80.0 / dt).round() as usize {
            sim.step().unwrap();
            assert!((momentum(sim.as_mut()) / begin - 1.0).abs() < 1e-11);
            let ledger = sim.ledger().unwrap();
            most = most.max((ledger.residual() / ledger.initial).abs());
            // what fields show adds up to it
            let shown = sim.scalars("kinetic_energy_density");
            let sum: f64 = shown.iter().zip(&body.volume).map(|(e, v)| e * v).sum();
            assert!((sum / ledger.kinetic - 1.0).abs() < 1e-10);
        }
        most
    };
    let ratio = stray(2.0) / stray(1.0);
    assert!((ratio - 4.0).abs() < 0.3, "{ratio}");
}

/// The left end moves as told, the rest is damped: `M a = F`, by elimination of a full matrix in the test.
#[test]
fn prescribed_ends_pull_what_is_coupled_to_them() {
    let body = small();
    let n = body.points();
    let told = |text: &str| [Some(Expression::parse(text, &[]).unwrap()), None, None];
    let held = |spec: &mut Spec| {
        let members = Members::Points(vec![0u32, 1].into());
        spec.sets.push(SetSpec {
            name: "left".into(),
            members,
        });
        let kind = ConditionKind::Displacement(told("1e-3*t*t/100"));
        spec.loading.conditions.push(ConditionSpec {
            set: "left".into(),
            kind,
        });
    };
    let dt = 0.5;
    let mut sim = started(&stepped(&body, dt, held), &body, 0.0);
    let mass = body.mass.as_ref().unwrap();
    let place = |t: f64| 1e-3 * t * t / 100.0;
    let mut u: Vec<[f64; 1]> = body.position.iter().map(|x| [bump(x[0])]).collect();
    (0..2).for_each(|i| u[i][0] = 0.0);
    let mut v = vec![0.0; n];
    let accelerations = |u: &[[f64; 1]]| -> Vec<f64> {
        // twice the coefficient of t², at the held points
        let a = 2.0 * 1e-3 / 100.0;
        let m = |i: usize, j: usize| mass.between(i, j).map_or(0.0, |m| m[0][0]);
        let right = (2..n).map(|i| body.volume[i] * body.force(u, i)[0] - a * (m(i, 0) + m(i, 1)));
        let free = solved(
            (2..n).map(|i| (2..n).map(|j| m(i, j)).collect()).collect(),
            right.collect(),
        );
        [vec![a; 2], free].concat()
    };
    let mut a = accelerations(&u);
    for step in 1..=80 {
        sim.step().unwrap();
        for i in 2..n {
            v[i] += 0.5 * dt * a[i];
            u[i][0] += dt * v[i];
        }
        (0..2).for_each(|i| u[i][0] = place(f64::from(step) * dt));
        a = accelerations(&u);
        (2..n).for_each(|i| v[i] += 0.5 * dt * a[i]);
    }
    for (found, u) in sim.displacements().iter().zip(&u) {
        assert!((found[0] - u[0]).abs() < 1e-12 * 1e-3, "{found:?} {u:?}");
    }
    // what the ends are given is in the balance: less is missing with a shorter step
    let missing = |dt: f64| {
        let mut sim = started(&stepped(&body, dt, held), &body, 0.0);
        (0..(40.0 / dt) as usize).for_each(|_| sim.step().unwrap());
        let ledger = sim.ledger().unwrap();
        (ledger.residual() / ledger.work_boundary_conditions).abs()
    };
    let [coarse, half] = [missing(1.0), missing(0.5)];
    assert!(coarse < 0.02 && half < 0.3 * coarse, "{coarse} {half}");
}

fn solved(mut m: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        for i in k + 1..n {
            let factor = m[i][k] / m[k][k];
            for j in k..n {
                m[i][j] -= factor * m[k][j];
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..n).rev() {
        b[k] = (b[k] - (k + 1..n).map(|j| m[k][j] * b[j]).sum::<f64>()) / m[k][k];
    }
    b
}

#[test]
fn damped_chains_move_explicitly_as_implicitly() {
    let body = small();
    let damped = |spec: &mut Spec| {
        let kind = ConditionKind::Damping(Expression::constant(0.02));
        spec.loading.conditions.push(ConditionSpec {
            set: "all".into(),
            kind,
        });
    };
    let implicit = |spec: &mut Spec| {
        damped(spec);
        spec.run.schedule.stepper = Stepper::Newmark(Newmark::default());
    };
    let end = |dt: f64, change: &dyn Fn(&mut Spec)| {
        let mut sim = started(&stepped(&body, dt, change), &body, 0.0);
        (0..(40.0 / dt) as usize).for_each(|_| sim.step().unwrap());
        let missing = sim.ledger().unwrap();
        (sim.displacements(), missing.residual() / missing.initial)
    };
    let off = |a: &[[f64; 3]], b: &[[f64; 3]]| -> f64 {
        let both = a.iter().zip(b);
        both.fold(0.0, |m: f64, (a, b)| m.max((a[0] - b[0]).abs()))
    };
    let (exact, lost) = end(0.0625, &implicit);
    assert!(lost.abs() < 1e-4, "{lost}");
    let apart: Vec<f64> = [1.0, 0.5]
        .iter()
        .map(|dt| off(&end(*dt, &damped).0, &exact))
        .collect();
    assert!(apart[0] < 2e-5 && apart[1] < 0.3 * apart[0], "{apart:?}");
    let apart: Vec<f64> = [1.0, 0.5]
        .iter()
        .map(|dt| off(&end(*dt, &implicit).0, &exact))
        .collect();
    assert!(apart[0] < 2e-5 && apart[1] < 0.3 * apart[0], "{apart:?}");
}

#[test]
fn stable_steps_are_those_of_the_greatest_frequency() {
    let symmetric = small();
    let fine = random([60], false, 10.0);
    let options = Options {
        radius: Radius::Fixed(4.0),
        ..with(Scheme::Rows, Mass::Blend)
    };
    let rows = coarsen(&fine, &every(&fine, 3), &options).unwrap().0;
    assert!(rows.soundness().asymmetry > 1e-6, "{:?}", rows.soundness());
    for (body, close) in [(symmetric, 1.03), (rows, 4.0)] {
        let n = body.points();
        let mass = body.mass.as_ref().unwrap();
        let m = |i: usize, j: usize| mass.between(i, j).map_or(0.0, |m| m[0][0]);
        let column = |j: usize| {
            let k = (0..n).map(|i| {
                let mut u = vec![[0.0]; n];
                u[j] = [1.0];
                -body.volume[i] * body.force(&u, i)[0]
            });
            solved(
                (0..n).map(|i| (0..n).map(|j| m(i, j)).collect()).collect(),
                k.collect(),
            )
        };
        let columns: Vec<Vec<f64>> = (0..n).map(column).collect();
        let values = eigenvalues(n, |i, j| columns[j][i]).unwrap();
        let most = values.iter().fold(0.0f64, |m, z| m.max(z[0].hypot(z[1])));
        let longest = 2.0 / most.sqrt();
        let found = stable_step(&body).unwrap();
        assert!(
            found <= longest && longest < close * found,
            "{found} {longest}"
        );
    }
}

#[test]
fn what_coupled_masses_cannot_do_is_refused() {
    let body = small();
    let refused = |spec: &Spec| match build(spec, Build::default()) {
        Ok(_) => panic!("it was built"),
        Err(e) => e.to_string(),
    };
    let hot = |spec: &mut Spec| {
        let energy = Expression::constant(1e-3);
        spec.loading.thermal = Some(ThermalSpec { energy, seed: 1 });
    };
    let said = refused(&stepped(&body, 1.0, hot));
    assert!(said.contains("independent of each other"), "{said}");
    // symmetric and of the right sum, but a motion of the first two points has less than no kinetic energy
    let mut body = body;
    let masses = body.masses();
    let n = body.points();
    let far = 3.0 * masses[0];
    body.mass = Some(MassMatrix {
        start: (0..=n).map(|i| i + i.min(2)).collect(),
        partner: [0, 1, 0, 1].into_iter().chain(2..n as u32).collect(),
        block: [masses[0] - far, far, far, masses[1] - far]
            .into_iter()
            .chain(masses[2..].iter().copied())
            .map(|m| [[m]])
            .collect(),
    });
    let said = refused(&stepped(&body, 1.0, |_| ()));
    assert!(said.contains("have no inverse"), "{said}");
}

/// A bar of 200 points whose first ten are held: the first four modes are those of all points.
#[test]
fn modes_of_a_held_bar_are_those_of_the_fine_one() {
    let fine = chain(200, false);
    let mut retained = every(&fine, 4);
    retained.extend(0..10);
    retained.sort_unstable();
    retained.dedup();
    let modes = |body: &LinearBody<1>| -> Vec<f64> {
        let mut support = Support::none(body.points());
        for (free, x) in support.free.iter_mut().zip(&body.position) {
            free[0] = x[0] > 9.5;
        }
        let found = modes::lowest(body, &support, 4).unwrap();
        found.iter().map(|m| m.frequency()).collect()
    };
    let exact = modes(&fine);
    for (mass, least, most) in [(Mass::Blend, 0.0, 1e-3), (Mass::Lumped, 0.02, 0.05)] {
        let (coarse, _) = coarsen(&fine, &retained, &with(Scheme::Energy, mass)).unwrap();
        let found = modes(&coarse);
        let off = (0..4).map(|n| (found[n] / exact[n] - 1.0).abs());
        let off = off.fold(0.0, f64::max);
        assert!(off >= least && off < most, "{mass:?}: {found:?} {exact:?}");
    }
}
