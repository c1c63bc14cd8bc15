//! Bodies that are heated.

use super::{Off, cells, grid, hold, model, off, set, stored, worst};
use peridyne::expression::Expression;
use peridyne::space::Point;
use peridyne::spec::*;

/// Temperatures as told, an expansion of 1e-5 per degree from the first one on.
fn heated(reference: f64, value: &str) -> DiffusionSpec {
    let text = Expression::parse(value, &[]).unwrap();
    DiffusionSpec {
        quantity: Quantity::Heat,
        method: DiffusionMethod::Explicit { safety: 0.9 },
        reference,
        across_broken: false,
        deformation: false,
        materials: vec![DiffusionMaterial {
            conductivity: 1e-9,
            capacity: 1.0,
            expansion: 1e-5,
        }],
        initial: vec![("all".into(), text.clone())],
        conditions: vec![DiffusionCondition {
            set: "all".into(),
            kind: DiffusionKind::Value(text),
        }],
    }
}

/// A cube of 125 points that glides on its edges and grows by a hundredth.
pub fn cube() -> Vec<Off> {
    let at = grid([5, 5, 5], 1.0);
    let solid = LawSpec::Lps(Moduli::from_bulk_shear(130e9, 78e9));
    let mut spec = cells(&at, 1.0, 7800.0, 1.75, solid);
    let low = |x: &Point, axes: [usize; 2]| axes.iter().all(|a| x[*a] < -1.5);
    set(&mut spec, "along x", &at, |x| low(x, [1, 2]));
    set(&mut spec, "along y", &at, |x| low(x, [0, 2]));
    set(&mut spec, "along z", &at, |x| low(x, [0, 1]));
    hold(&mut spec, "along x", ["", "0", "0"]);
    hold(&mut spec, "along y", ["0", "", "0"]);
    hold(&mut spec, "along z", ["0", "0", ""]);
    spec.interactions.diffusions = vec![heated(273.0, "273 + 1000*t")];
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Newton,
        tolerance: 1e-12,
        ..Statics::default()
    });
    spec.run.schedule.time_step = TimeStep::Fixed(0.1);
    let mut sim = model(&spec);
    sim.start(true);
    for _ in 0..10 {
        sim.step().unwrap();
    }
    // what the peer has stored is this to 8e-16
    let places = at.iter().map(|x| x.map(|x| 0.01 * (x + 2.0)));
    let u = sim.displacements();
    let dilatation = sim.scalars("dilatation");
    vec![
        off(
            "displacement",
            worst(u.into_iter().flatten().zip(places.flatten())),
            1e-9,
        ),
        off(
            "dilatation",
            worst(dilatation.into_iter().map(|d| (d, 0.0))),
            1e-12,
        ),
    ]
}

/// Two pairs of points are cooled: one is held and breaks, one is free and shrinks.
pub fn bonds_that_fail() -> Vec<Off> {
    let at = [
        [0.525, 0.5, 0.5],
        [1.575, 0.5, 0.5],
        [0.525, 1.5, 0.5],
        [1.575, 1.5, 0.5],
    ];
    let solid = LawSpec::Lps(Moduli::from_bulk_shear(130e9, 60e9));
    let mut spec = cells(&at, 1.05, 7800.0, 1.02, solid);
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.05)));
    set(&mut spec, "held", &at, |x| x[0] < 1.0 || x[1] < 1.0);
    set(&mut spec, "gliding", &at, |x| x[0] > 1.0 && x[1] > 1.0);
    hold(&mut spec, "held", ["0", "0", "0"]);
    hold(&mut spec, "gliding", ["0", "", "0"]);
    let value = "10000 - 10000*0.5*(cos(3.14159265359 + t*3.14159265359/0.1) + 1)";
    spec.interactions.diffusions = vec![heated(10_000.0, value)];
    spec.run.schedule.time_step = TimeStep::Fixed(1e-5);
    let mut sim = model(&spec);
    sim.start(true);
    let (mut places, mut damages) = (vec![], vec![]);
    for row in stored("ThermalExpansionBondFailure") {
        for _ in 0..1000 {
            sim.step().unwrap();
        }
        places.push((sim.displacements()[3][1], row[0]));
        let damage = sim.scalars("damage");
        damages.extend([
            (damage[0], row[2]),
            (damage[1], row[3]),
            (damage[2], row[2]),
            (damage[3], row[3]),
        ]);
    }
    vec![
        off("damage", worst(damages), 1e-12),
        off("displacement of what is free", worst(places), 1e-6),
    ]
}
