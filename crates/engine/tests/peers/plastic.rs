//! Ordinary plastic solids.

use super::elastic::pairs_that_part;
use super::{Off, cells, grid, model, off, stored, worst};
use peridyne::spec::*;

/// `ep_cube`: eight points are pulled apart and flow. z of point 5 at two times of the run.
pub fn cube() -> Vec<Off> {
    let at = grid([2, 2, 2], 0.5);
    let law = LawSpec::named(
        "elastic_plastic",
        Parameters::numbers(&[
            ("bulk", 67549.0),
            ("shear", 25902.2),
            ("yield_stress", 351.79),
        ]),
    );
    let mut spec = cells(&at, 0.125, 0.0027, 1.75, law);
    spec.run.schedule.time_step = TimeStep::Fixed(1e-6);
    let mut sim = model(&spec);
    let v: Vec<[f64; 3]> = at
        .iter()
        .map(|x| [0.0, 0.0, if x[2] > 0.0 { 200.0 } else { -200.0 }])
        .collect();
    sim.set_velocities(&v);
    sim.start(true);
    let mut found = vec![];
    for n in 1..=10_000 {
        sim.step().unwrap();
        if n % 5000 == 0 {
            let mut u = [0.0];
            assert!(sim.read("displacement", 2, 4, &mut u));
            found.push(u[0]);
        }
    }
    let rows = stored("ep_cube");
    let pairs = found.into_iter().zip(rows[0].iter().copied());
    vec![off("displacement", worst(pairs), 1e-9)]
}

/// Two pairs part, one breaks; nothing yields.
pub fn bond_breaking() -> Vec<Off> {
    let numbers = [("bulk", 130e9), ("shear", 60e9), ("yield_stress", 1e30)];
    let law = LawSpec::named("elastic_plastic", Parameters::numbers(&numbers));
    pairs_that_part(law)
}
