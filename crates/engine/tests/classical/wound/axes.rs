//! Axes of places: the same as numbers where they are the same, turned with a body, refused where they are none.

use super::*;
use peridyne::space::lattice::LatticeKind;

/// A block of points of side 1, a little out of order, and displacements of some size.
fn block(d: usize, n: usize) -> (Vec<Point>, Vec<Point>) {
    let (mut x, mut u) = (vec![], vec![]);
    let depth = if d == 3 { n } else { 1 };
    for i in 0..n * n * depth {
        let cell = [i % n, i / n % n, i / (n * n)];
        let off = |a: usize, seed: f64| {
            ((i as f64 + 0.37) * (seed + a as f64) * 12.9898).sin() * 43758.5453 % 1.0
        };
        let on = |a: usize| if a < d { 1.0 } else { 0.0 };
        x.push(std::array::from_fn(|a| {
            on(a) * (cell[a] as f64 + 0.5 + 0.1 * off(a, 1.7)) / n as f64
        }));
        u.push(std::array::from_fn(|a| {
            on(a) * 0.02 * off(a, 4.1) / n as f64
        }));
    }
    (x, u)
}

/// An expression that is the same everywhere gives the answers of numbers to the last bit: on lattices and clouds, with either gradient,
/// alone and beside a material of another kind of direction.
#[test]
fn a_constant_expression_is_a_constant() {
    let (fibre, normal) = ([1.0, 2.0, -0.5], [0.3, 0.0, 1.0]);
    for (d, bonds, on_lattice) in [
        (2, false, false),
        (2, true, true),
        (2, true, false),
        (3, false, true),
        (3, true, false),
        (3, false, false),
    ] {
        let n = if d == 2 { 9 } else { 6 };
        let (fibre, normal) = match d {
            2 => ([1.0, 2.0, 0.0], UP),
            _ => (fibre, normal),
        };
        let (x, u) = block(d, n);
        let written = |v: Point| {
            let text = v.map(|c| format!("{c} + 0*x"));
            of_place([&text[0], &text[1], &text[2]])
        };
        let answers = |law: LawSpec, two: bool| {
            let volume = vec![(n as f64).powi(-(d as i32)); x.len()];
            let horizon = 2.01 / n as f64;
            let mut spec = cloud(d, x.clone(), volume, horizon, law);
            if on_lattice {
                let mut quarters = vec![];
                for i in 0..x.len() as i32 {
                    let n = n as i32;
                    quarters.push([4 * (i % n), 4 * (i / n % n), 4 * (i / (n * n))]);
                }
                spec.body = BodySpec::Sites {
                    kind: match d {
                        2 => LatticeKind::Square,
                        _ => LatticeKind::Cubic,
                    },
                    spacing: 1.0 / n as f64,
                    origin: [0.0; 3],
                    quarters,
                    volume: None,
                };
                spec.bonds.horizon = Horizon::Ratio(2);
            }
            if two {
                spec.sets = vec![
                    set("low", 0..x.len() / 2),
                    set("high", x.len() / 2..x.len()),
                ];
                let mut other = spec.materials[0].clone();
                spec.materials[0].set = "low".into();
                other.set = "high".into();
                other.name = "other".into();
                other.law = ply(given(fibre), given(normal), bonds);
                spec.materials.push(other);
            }
            let mut sim = made(&spec);
            let f = sim.forces_under(&u);
            sim.set_displacements(&u);
            let mut columns = sim.vectors("fibre");
            columns.extend(sim.vectors("normal"));
            (f, sim.scalars("energy_density"), columns)
        };
        let plain = answers(ply(given(fibre), given(normal), bonds), false);
        assert!(plain.0.iter().flatten().any(|f| f.abs() > 1e-6));
        let size = fibre.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert_eq!(plain.2[0], fibre.map(|x| x / size));
        assert_eq!(plain.2.len(), x.len() * (d - 1));
        for (law, two) in [
            (ply(written(fibre), given(normal), bonds), false),
            (ply(given(fibre), written(normal), bonds), false),
            (ply(written(fibre), written(normal), bonds), true),
            (ply(given(fibre), given(normal), bonds), true),
        ] {
            let found = answers(law, two);
            assert!(
                found == plain,
                "{d}-D, bonds {bonds}, lattice {on_lattice}, {two}"
            );
        }
    }
}

/// A body that is turned with its fibres and displacements answers with the turned forces.
#[test]
fn a_turned_body_answers_with_turned_forces() {
    for d in [2, 3] {
        for bonds in [false, true] {
            let (x, u) = block(d, if d == 2 { 10 } else { 6 });
            let n = if d == 2 { 10.0f64 } else { 6.0 };
            let (s, c) = 0.7f64.sin_cos();
            let turn = |v: &Point| [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]];
            // the fibre at the place that was here before: fibre(Rᵀx), turned
            let back = [
                format!("({c}*x + {s}*y)"),
                format!("({c}*y - {s}*x)"),
                "z".to_string(),
            ];
            let of = |[x, y, z]: [&str; 3]| match d {
                2 => [format!("1 + {y}"), format!("2*{x}*{y} - 0.3"), "0".into()],
                _ => [
                    format!("1 + {y}*{z}"),
                    format!("2*{x}*{y} - 0.3"),
                    format!("{z} - {x}"),
                ],
            };
            let fibre = of(["x", "y", "z"]);
            let [p, q, w] = of([&back[0], &back[1], &back[2]]);
            let turned = [
                format!("{c}*({p}) - {s}*({q})"),
                format!("{s}*({p}) + {c}*({q})"),
                w,
            ];
            let direction = |text: [String; 3]| of_place([&text[0], &text[1], &text[2]]);
            let answers = |x: Vec<Point>, u: &[Point], fibre: [String; 3]| {
                let volume = vec![n.powi(-(d as i32)); x.len()];
                let law = ply(direction(fibre), given(UP), bonds);
                let mut sim = made(&cloud(d, x, volume, 2.2 / n, law));
                (sim.forces_under(u), sim.vectors("fibre"))
            };
            let (f, along) = answers(x.clone(), &u, fibre);
            let all: Vec<Point> = x.iter().map(turn).collect();
            let moved: Vec<Point> = u.iter().map(turn).collect();
            let (g, along_turned) = answers(all, &moved, turned);
            let most = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
            for i in 0..x.len() {
                let [f, along] = [turn(&f[i]), turn(&along[i])];
                for a in 0..3 {
                    assert!((g[i][a] - f[a]).abs() < 1e-11 * most, "{d} {bonds} {i}");
                    assert!((along_turned[i][a] - along[a]).abs() < 1e-13);
                }
            }
        }
    }
}

/// And it comes to rest in the turned place under turned loads.
#[test]
fn a_turned_body_rests_turned() {
    let (x, _) = block(2, 10);
    let (s, c) = 0.7f64.sin_cos();
    let turn = |v: &Point| [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]];
    let held: Vec<usize> = (0..x.len()).filter(|i| x[*i][0] < 0.2).collect();
    let pulled: Vec<usize> = (0..x.len()).filter(|i| x[*i][0] > 0.9).collect();
    let rest = |x: Vec<Point>, fibre: Parameter, load: Point| {
        let volume = vec![0.01; x.len()];
        let mut spec = cloud(2, x, volume, 0.22, ply(fibre, given(UP), true));
        spec.sets = vec![
            set("held", held.iter().copied()),
            set("pulled", pulled.iter().copied()),
        ];
        let on = |set: &str, kind| ConditionSpec {
            set: set.into(),
            kind,
        };
        let [fx, fy, _] = load.map(|c| Some(e(&format!("{c:e}*t"))));
        spec.loading.conditions = vec![
            on(
                "held",
                ConditionKind::Displacement([Some(e("0")), Some(e("0")), None]),
            ),
            on("pulled", ConditionKind::BodyForce([fx, fy, None])),
        ];
        solved(&mut spec).displacements()
    };
    let load = [0.3, 0.1, 0.0];
    let plain = rest(x.clone(), of_place(["1", "2*x - y", "0"]), load);
    let (p, q) = (
        "1".to_string(),
        format!("(2*({c}*x + {s}*y) - ({c}*y - {s}*x))"),
    );
    let turned = [format!("{c}*{p} - {s}*{q}"), format!("{s}*{p} + {c}*{q}")];
    let turned = of_place([&turned[0], &turned[1], "0"]);
    let found = rest(x.iter().map(turn).collect(), turned, turn(&load));
    let most = plain.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    assert!(most > 0.01, "{most}");
    for (u, v) in plain.iter().zip(&found) {
        let u = turn(u);
        assert!(
            (0..2).all(|a| (u[a] - v[a]).abs() < 1e-8 * most),
            "{u:?} {v:?}"
        );
    }
}

/// Where a direction is none the body is refused, with the place.
#[test]
fn a_direction_that_is_none_is_refused_with_its_place() {
    let refused = |d: usize, fibre: [&str; 3], normal: Parameter| {
        let x = vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        let volume = vec![1.0; 3];
        let spec = cloud(d, x, volume, 1.5, ply(of_place(fibre), normal, false));
        let error = build(&spec, Options::default()).err().unwrap();
        assert_eq!(error.path, "materials[0].law");
        error.message.to_string()
    };
    for (d, fibre, normal, expected) in [
        (2, ["-y", "x", "0"], given(UP), "at (0, 0): `fibre` is 0"),
        (
            2,
            ["1/(x - 1)", "1", "0"],
            given(UP),
            "at (1, 0): `fibre` is no number",
        ),
        (
            2,
            ["sqrt(1 - x)", "1", "0"],
            given(UP),
            "at (2, 0): `fibre` is no number",
        ),
        (
            2,
            ["1", "0", "x"],
            given(UP),
            "at (1, 0): in the plane the third axis",
        ),
        (
            3,
            ["x - 1", "0", "1"],
            given(UP),
            "at (1, 0, 0): `fibre` and `normal` are parallel",
        ),
        (
            3,
            ["0", "1", "0"],
            of_place(["0", "0", "2 - x"]),
            "at (2, 0, 0): `normal` is 0",
        ),
    ] {
        let found = refused(d, fibre, normal);
        assert!(found.starts_with(expected), "{found}");
    }
    let mut timely = Parameters::default().with("fibre", of_place(["1", "t", "0"]));
    let registry = peridyne::run::Registry::standard();
    let law = registry.descriptor("anisotropic").unwrap();
    let (key, why) = law.check(&mut timely).unwrap_err();
    assert!(
        key == "fibre" && why.contains("does not depend on t"),
        "{why}"
    );
}

/// The stable step of a large lattice is looked for on the body, not on a block of it at other places.
#[test]
fn a_large_lattice_has_the_stable_step_of_its_own_places() {
    let step = |n: i32, fibre: Parameter| {
        let mut quarters = vec![];
        for i in 0..n * n {
            quarters.push([4 * (i % n), 4 * (i / n), 0]);
        }
        let body = BodySpec::Sites {
            kind: LatticeKind::Square,
            spacing: 1.0,
            origin: [0.0; 3],
            quarters,
            volume: None,
        };
        let mut spec = Spec::new(2, body, 2.0, ply(fibre, given(UP), false));
        spec.space.plane = Plane::Stress;
        spec.bonds.horizon = Horizon::Ratio(2);
        build(&spec, Options::default()).unwrap().info().stable_step
    };
    // as a block at the origin sees it fibres lie along x; most of the body has them along the diagonal
    let bent = of_place(["1", "x > 40 ? 1 : 0", "0"]);
    let [along, diagonal] = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]].map(|f| step(150, given(f)));
    assert!((along / diagonal - 1.0).abs() > 2e-3, "{along} {diagonal}");
    let found = step(150, bent);
    assert!(
        (found / along.min(diagonal) - 1.0).abs() < 2e-4,
        "{found} {along} {diagonal}"
    );
}
