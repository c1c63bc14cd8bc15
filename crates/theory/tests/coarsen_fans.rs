//! Coarse bodies of fans: the linear body of silicon, with atoms taken out, moves as the atoms do.

use peridyne::law::many_body::stillinger_weber::StillingerWeber;
use peridyne::law::many_body::tersoff::Tersoff;
use peridyne::run::{Options, build};
use peridyne::space::Point;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;
use peridyne::statics::{Direct, Support};
use peridyne_theory::coarsen::schur;

/// A row of constants of one element of a file of LAMMPS.
fn row(text: &str, element: &str, width: usize) -> Vec<f64> {
    let lines = text.lines().map(|l| l.split('#').next().unwrap_or(""));
    let words: Vec<&str> = lines.flat_map(str::split_whitespace).collect();
    let at = words.iter().position(|w| *w == element).unwrap();
    let numbers = words[at + 3..at + 3 + width].iter();
    let kinds = [0.0; 3].into_iter();
    kinds
        .chain(numbers.map(|w| w.parse::<f64>().unwrap()))
        .collect()
}

/// Five cells between two free faces, periodic along them.
fn layer(potential: PotentialSpec, spacing: f64) -> Spec {
    let cells = [5.0, 2.0, 2.0];
    let lattice = BodySpec::Lattice {
        kind: LatticeKind::Diamond,
        spacing,
        origin: [0.0; 3],
        region: Region::Block {
            low: [-0.1 * spacing; 3],
            high: cells.map(|c| spacing * (c - 0.125)),
        },
        perturb: None,
    };
    let mut spec = Spec::new(3, lattice, 1.0, LawSpec::Atoms(potential));
    spec.space.periodic = [None, Some(2.0 * spacing), Some(2.0 * spacing)];
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    spec
}

/// Displacements in equilibrium with some points held.
fn equilibrium(body: &LinearBody<3>, held: &[(usize, Point)]) -> Vec<Point> {
    let mut support = Support::none(body.points());
    let mut given = vec![[0.0; 3]; body.points()];
    for (i, u) in held {
        support.free[*i] = [false; 3];
        given[*i] = *u;
    }
    let force: Vec<Point> = (0..body.points())
        .map(|i| body.force(&given, i).map(|f| body.volume[i] * f))
        .collect();
    let mut u = Direct::new(body, &support, 0.0).unwrap().solve(&force);
    for (i, given) in held {
        u[*i] = *given;
    }
    u
}

fn largest<'a>(all: impl Iterator<Item = &'a Point>) -> f64 {
    all.flatten().fold(0.0, |m, x| m.max(x.abs()))
}

fn check(potential: PotentialSpec, spacing: f64) {
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    let mut sim = build(&layer(potential, spacing), options).unwrap();
    sim.relax(1e-11).unwrap();
    let rest = sim.displacements();
    let AnyLinearBody::Three(body) = sim.linear_body() else {
        panic!()
    };
    assert_eq!(body.points(), 160);
    assert!(body.soundness().asymmetry < 1e-9);
    let quarter = |x: f64| (4.0 * x / spacing).round() as i64;
    // the layers at both faces are held, one of them moved
    let held = |x: &Point| match quarter(x[0]) {
        0 | 1 => Some([0.0; 3]),
        18 | 19 => Some([1e-3 * spacing, 4e-4 * spacing, -2e-4 * spacing]),
        _ => None,
    };
    let all = 0..body.points();
    let kept: Vec<u32> = all
        .clone()
        .filter(|i| {
            let x = &body.position[*i];
            held(x).is_some() || x.iter().all(|c| quarter(*c) % 2 == 0)
        })
        .map(|i| i as u32)
        .collect();
    assert_eq!(kept.len(), 80 + 16);
    let (coarse, report) = schur(&body, &kept).unwrap();
    assert!(report.definite && report.soundness.asymmetry < 1e-9);
    let holds = |body: &LinearBody<3>| -> Vec<(usize, Point)> {
        let each = body.position.iter().enumerate();
        each.filter_map(|(n, x)| held(x).map(|u| (n, u))).collect()
    };
    let found = equilibrium(&coarse, &holds(&coarse));
    let full = equilibrium(&body, &holds(&body));
    let size = largest(full.iter());
    for (u, k) in found.iter().zip(&kept) {
        for (u, exact) in u.iter().zip(full[*k as usize]) {
            assert!((u - exact).abs() < 1e-10 * size, "{k}: {u} {exact}");
        }
    }
    // the atoms themselves: where their linear body is in equilibrium, forces on the free ones are of second order
    let mut left = |s: f64| {
        let u: Vec<Point> = rest
            .iter()
            .zip(&full)
            .map(|(r, u)| std::array::from_fn(|a| r[a] + s * u[a]))
            .collect();
        let f = sim.forces_under(&u);
        let free = { all.clone() }.filter(|i| held(&body.position[*i]).is_none());
        let free: Vec<Point> = free.map(|i| f[i]).collect();
        [largest(free.iter()), largest(f.iter())]
    };
    let ([first, pull], [half, _]) = (left(1.0), left(0.5));
    assert!(first < 0.1 * pull, "{first} {pull}");
    let order = (first / half).log2();
    assert!((order - 2.0).abs() < 0.1, "{order}: {first} {half}");
}

#[test]
fn silicon_of_stillinger_and_weber_moves_as_before() {
    let text = include_str!("../../../verify/lammps/fans/Si.sw");
    let rows = vec![row(text, "Si", 11)];
    let potential = PotentialSpec::of_entries::<StillingerWeber>(rows).unwrap();
    check(potential, 5.43094978);
}

#[test]
fn silicon_of_tersoff_moves_as_before() {
    let text = include_str!("../../../verify/lammps/fans/Si.tersoff");
    let rows = vec![row(text, "Si", 14)];
    let potential = PotentialSpec::of_entries::<Tersoff>(rows).unwrap();
    check(potential, 5.432);
}
