//! Bodies that are given by the stiffness of another: with masses of their own, with masses that couple points, and with loads of a finer body.

use super::{place, same};
use crate::sample::*;
use peridyne::run::Options;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

/// The stiffness of a state-based solid, in which forces reach two horizons.
fn solid() -> LinearBody<2> {
    let lps = Case::of("lps", place(LatticeKind::Square));
    let mut sim = build(&lps.spec(), Options::default()).unwrap();
    sim.linear_body().of::<2>().unwrap()
}

const UNIT: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];

fn times(s: f64) -> [[f64; 2]; 2] {
    UNIT.map(|row| row.map(|x| s * x))
}

/// Gives every pair of nearest neighbours a part of the masses of both.
fn couple(linear: &mut LinearBody<2>) {
    let mass = linear.masses();
    let part = 0.1 * mass[0];
    let mut made = MassMatrix {
        start: vec![0],
        partner: vec![],
        block: vec![],
    };
    for (i, mass) in mass.iter().enumerate() {
        let x = linear.position[i];
        let near = linear.row(i).0.iter().filter(|j| {
            let y = linear.position[**j as usize];
            (0..2).map(|a| (x[a] - y[a]).powi(2)).sum::<f64>() < (1.1 * H).powi(2)
        });
        let mut row: Vec<(u32, f64)> = near.map(|j| (*j, part)).collect();
        row.push((i as u32, mass - part * row.len() as f64));
        row.sort_by_key(|(j, _)| *j);
        made.partner.extend(row.iter().map(|(j, _)| *j));
        made.block.extend(row.iter().map(|(_, m)| times(*m)));
        made.start.push(made.partner.len());
    }
    linear.mass = Some(made);
}

/// Each point carries loads, and passes half of them on to the next two.
fn carry(linear: &mut LinearBody<2>) {
    let n = linear.points() as u32;
    let (position, volume) = (linear.position.clone(), linear.volume.clone());
    let all = vec![true; n as usize];
    let pass = |p: u32| [(p, 0.5), ((p + 1) % n, 0.3), ((p + 60) % n, 0.2)];
    let pass = (0..n).map(|p| pass(p).map(|(q, s)| (q, times(s))).to_vec());
    let map = LoadMap::of(position, volume, H, &all);
    linear.load_map = Some(map.passed(&pass.collect::<Vec<_>>()));
}

/// Held at one end, moved at another, and loaded.
fn held(linear: &LinearBody<2>, title: String) -> Spec {
    let mut spec = Spec::of_linear(linear);
    spec.title = title;
    let end = linear.position.iter().fold(0.0f64, |x, y| x.max(y[1]));
    let set = |name: &str, text: String| SetSpec {
        name: name.into(),
        members: Members::Where(e(&text)),
    };
    let low = linear.position.iter().fold(f64::MAX, |x, y| x.min(y[1]));
    spec.sets = vec![
        set("held", format!("y < {}", low + 1.5 * H)),
        set("end", format!("y > {}", end - 0.5 * H)),
    ];
    let kinds = [
        (
            "held",
            ConditionKind::Displacement([Some(e("0.01*t*t")), Some(e("0")), None]),
        ),
        (
            "all",
            ConditionKind::BodyForce([Some(e("0.01*sin(x)")), None, None]),
        ),
        (
            "end",
            ConditionKind::Traction {
                value: [None, Some(e("0.02*t")), None],
                area: Some(45.0 * H),
            },
        ),
    ];
    spec.loading.conditions = { kinds.into_iter() }
        .map(|(set, kind)| ConditionSpec {
            set: set.into(),
            kind,
        })
        .collect();
    spec.run.probes = [("all", Measure::Energy), ("held", Measure::Reaction)]
        .map(|(set, measure)| ProbeSpec {
            name: set.into(),
            set: set.into(),
            measure,
        })
        .into();
    spec
}

#[test]
fn linear_bodies_have_the_same_bits_on_any_number_of_ranks() {
    let mut steppers = [Stepper::Verlet, Stepper::Newmark(Newmark::hht(-0.1))]
        .into_iter()
        .cycle();
    for (coupled, carries, asymmetric) in [
        (false, false, false),
        (false, true, false),
        (true, false, false),
        (true, true, false),
        (true, false, true),
    ] {
        let mut linear = solid();
        if asymmetric {
            let third = linear.block.len() / 3;
            { linear.block[..third].iter_mut() }.for_each(|c| c[0][1] += 1e-3 * c[0][0]);
        }
        if coupled {
            couple(&mut linear);
        }
        if carries {
            carry(&mut linear);
        }
        linear.check().unwrap();
        let title = format!("coupled {coupled}, carries {carries}, asymmetric {asymmetric}");
        let mut spec = held(&linear, title);
        for stepper in steppers.by_ref().take(if asymmetric { 1 } else { 2 }) {
            spec.run.schedule.stepper = stepper;
            spec.run.schedule.time_step = match stepper {
                Stepper::Verlet => TimeStep::Auto,
                _ => TimeStep::Fixed(0.1 * H),
            };
            same(&spec, &[2]);
        }
        if carries && !coupled {
            spec.run.schedule.steps = 2;
            spec.run.schedule.time_step = TimeStep::Fixed(0.5);
            spec.run.schedule.stepper = Stepper::Statics(Statics::default());
            same(&spec, &[3]);
        }
    }
}
