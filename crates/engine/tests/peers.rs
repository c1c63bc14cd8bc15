//! Peers' own verification results: points, parameters and a few stored numbers.
//!
//! Peridigm (Sandia National Laboratories, BSD 3-clause, Copyright 2011-2020), commit 82c6ad8f, test/verification.

use peridyne::run::{Options, Simulation, build};
use peridyne::spec::*;

/// A cloud of cubic cells, nothing calibrated, ω = 1, whole volumes.
fn cells(at: &[[f64; 3]], volume: f64, density: f64, horizon: f64, law: LawSpec) -> Spec {
    let cloud = Cloud {
        position: at.to_vec(),
        volume: vec![volume; at.len()],
        ..Cloud::default()
    };
    let mut spec = Spec::new(3, BodySpec::Cloud(cloud), density, law);
    spec.horizon = Horizon::Length(horizon);
    spec.calibration = Calibration::Continuum;
    spec
}

fn model(spec: &Spec) -> Box<dyn Simulation> {
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    build(spec, options).unwrap()
}

/// `ep_cube`: eight points are pulled apart and flow. Stored z of point 5 at two times of the run, tolerance 1e-9.
#[test]
fn an_elastic_plastic_cube_is_peridigms() {
    let mut at = vec![];
    for z in [0.25, 0.75] {
        for y in [0.25, 0.75] {
            for x in [0.25, 0.75] {
                at.push([x, y, z]);
            }
        }
    }
    let law = LawSpec::named(
        "elastic_plastic",
        Parameters::numbers(&[
            ("bulk", 67549.0),
            ("shear", 25902.2),
            ("yield_stress", 351.79),
        ]),
    );
    let mut spec = cells(&at, 0.125, 0.0027, 1.75, law);
    spec.schedule.time_step = TimeStep::Fixed(1e-6);
    let mut sim = model(&spec);
    let v: Vec<[f64; 3]> = at
        .iter()
        .map(|x| [0.0, 0.0, if x[2] > 0.5 { 200.0 } else { -200.0 }])
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
    for (found, stored) in found
        .iter()
        .zip([0.221_156_656_074_491_14, 0.224_021_735_783_144_55])
    {
        assert!((found - stored).abs() < 1e-9, "{found} is not {stored}");
    }
}
