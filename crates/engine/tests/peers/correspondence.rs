//! Elastic correspondence in rate form: a bar of cells of 0.25, 1 × 6 × 1.

use super::{Off, cells, grid, hold, internal_forces, model, nearest, off, set, stored, worst};
use peridyne::observe::Values;
use peridyne::run::Simulation;
use peridyne::space::Point;
use peridyne::spec::*;

/// The peer takes the rate of deformation at the end of a step.
fn bar(poisson: f64) -> (Vec<Point>, Spec) {
    let at = grid([4, 24, 4], 0.25);
    let numbers = [("young", 200e9), ("poisson", poisson), ("control", 0.04)];
    let parameters = Parameters::numbers(&numbers).with("increment", Parameter::Word("end".into()));
    let law = LawSpec::named("hypoelastic", parameters);
    let spec = cells(&at, 0.015625, 7800.0, 0.751, law);
    (at, spec)
}

/// Stress along the bar and forces at some points after the last step.
fn compared(sim: &mut dyn Simulation, at: &[Point], stress: f64, case: &str) -> Vec<Off> {
    let column = sim.column("unrotated_stress").unwrap();
    let Values::Tensors(found) = column.values else {
        panic!("a stress is a tensor");
    };
    let expected = |k: usize| if k == 4 { stress } else { 0.0 };
    let stresses = found
        .iter()
        .flat_map(|s| (0..9).map(|k| (s[k], expected(k))));
    let f = internal_forces(sim);
    let rows = stored(case);
    let force = |r: &Vec<f64>| f[nearest(at, [r[0], r[1], r[2]])][1];
    vec![
        off("stress", worst(stresses), 1e-2),
        off("force", worst(rows.iter().map(|r| (force(r), r[3]))), 1e-3),
    ]
}

/// `ElasticCorrespondenceFullyPrescribedTension`: five steps in time, every point carried.
pub fn prescribed_tension() -> Vec<Off> {
    let (at, mut spec) = bar(0.0);
    hold(&mut spec, "all", ["0", "0.001*y*t/1.0e-8", "0"]);
    spec.schedule.time_step = TimeStep::Fixed(2e-9);
    let mut sim = model(&spec);
    sim.start(true);
    for _ in 0..5 {
        sim.step().unwrap();
    }
    compared(
        sim.as_mut(),
        &at,
        199880087.92806253,
        "ElasticCorrespondenceFullyPrescribedTension",
    )
}

/// `ElasticCorrespondenceQSTension`: two increments of load; the ends are pulled, the rest finds its place.
pub fn tension_at_rest() -> Vec<Off> {
    let (at, mut spec) = bar(0.3);
    set(&mut spec, "foot", &at, |x| x[1] < -1.5);
    set(&mut spec, "head", &at, |x| x[1] > 1.5);
    let corner = |x: &Point, axis: usize, sign: f64| x[1].abs() > 2.75 && sign * x[axis] > 0.25;
    set(&mut spec, "x", &at, |x| corner(x, 0, -1.0));
    set(&mut spec, "z", &at, |x| corner(x, 2, -1.0));
    for end in ["foot", "head"] {
        hold(&mut spec, end, ["", "0.001*y*t", ""]);
    }
    hold(&mut spec, "x", ["0", "", ""]);
    hold(&mut spec, "z", ["", "", "0"]);
    spec.schedule.time_step = TimeStep::Fixed(0.5);
    spec.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Newton,
        tolerance: 1e-12,
        ..Statics::default()
    });
    let mut sim = model(&spec);
    sim.start(true);
    for _ in 0..2 {
        sim.step().unwrap();
    }
    let mut all = compared(
        sim.as_mut(),
        &at,
        199850124.88766977,
        "ElasticCorrespondenceQSTension",
    );
    let u = sim.displacements();
    // every cell is narrower by this
    let step = 7.492695048159509e-05;
    let places = at.iter().map(|x| {
        [
            -step * (x[0] + 0.375) / 0.25,
            0.001 * x[1],
            -step * (x[2] + 0.375) / 0.25,
        ]
    });
    let off_by = worst(u.into_iter().flatten().zip(places.flatten()));
    all.push(off("displacement", off_by, 1e-9));
    all
}
