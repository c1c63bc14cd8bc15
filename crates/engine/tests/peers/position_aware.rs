//! The position-aware solid: a cube in simple shear, and a body of sixteen points that is torn in two.

use super::{Off, cells, grid, hold, model, nearest, off, set, stored, worst};
use peridyne::run::{Options, build};
use peridyne::space::Point;
use peridyne::spec::*;

fn law(numbers: &[(&str, f64)]) -> LawSpec {
    LawSpec::named("pals", Parameters::numbers(numbers))
}

/// The peer's trial functions are 1, not what is right in a full family.
pub fn simple_shear() -> Vec<Off> {
    let h = 1.0 / 7.0;
    let at: Vec<Point> = grid([7, 7, 7], h)
        .iter()
        .map(|x| [x[0] + 0.5, x[1] + 0.5, x[2] - 0.5])
        .collect();
    let solid = law(&[("bulk", 67.55e9), ("shear", 25.9e9), ("trial", 1.0)]);
    let spec = cells(&at, h * h * h, 2700.0, 0.43071428, solid);
    let mut sim = model(&spec);
    let u: Vec<Point> = at.iter().map(|x| [-1e-6 * x[1], 0.0, 0.0]).collect();
    let f = sim.forces_under(&u);
    sim.set_displacements(&u);
    sim.start(true);
    let energy = sim.scalars("energy_density");
    let rows = stored("Pals_Simple_Shear");
    let most = rows
        .iter()
        .flat_map(|r| &r[3..6])
        .fold(0.0f64, |m, f| m.max(f.abs()));
    let point = |r: &Vec<f64>| nearest(&at, [r[0], r[1], r[2]]);
    let forces = rows.iter().flat_map(|r| {
        let f = f[point(r)].map(|f| f * h * h * h);
        (0..3)
            .map(move |a| (f[a] / most, r[3 + a] / most))
            .collect::<Vec<_>>()
    });
    vec![
        off("force over the greatest", worst(forces), 1e-5),
        off(
            "energy density over that of a solid",
            worst(
                rows.iter()
                    .map(|r| (energy[point(r)] / 0.01295, r[6] / 0.01295)),
            ),
            1e-6,
        ),
    ]
}

/// The peer compares damage alone. Every point is led; half of them go away along x.
pub fn torn_in_two() -> Vec<Off> {
    let mut at = grid([4, 2, 2], 0.2);
    at.iter_mut().flatten().for_each(|x| *x += 0.3);
    let solid = law(&[("young", 200e9), ("poisson", 0.3)]);
    let mut spec = cells(&at, 0.008, 7000.0, 0.28285, solid);
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.1)));
    set(&mut spec, "still", &at, |x| x[0] < 0.3);
    set(&mut spec, "gone", &at, |x| x[0] > 0.3);
    hold(&mut spec, "still", ["0", "0", "0"]);
    hold(&mut spec, "gone", ["0.03*t", "0", "0"]);
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    let mut sim = build(&spec, options).unwrap();
    sim.start(true);
    let mut all = vec![];
    for lost in [1.0, 3.0] {
        sim.step().unwrap();
        let near = |x: &Point| (x[0] - 0.3).abs() < 0.15;
        let each = at.iter().map(|x| if near(x) { lost / 9.0 } else { 0.0 });
        let found = sim.scalars("damage");
        all.extend(found.into_iter().zip(each).collect::<Vec<_>>());
        // what is left of the families answers with finite forces
        let forces = sim.vectors("force_density");
        assert!(forces.iter().flatten().all(|f| f.is_finite()));
    }
    vec![off("damage", worst(all), 1e-12)]
}
