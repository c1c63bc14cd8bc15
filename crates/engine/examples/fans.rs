//! Microseconds per atom and step of potentials of fans on 32,768 atoms of warm silicon: `cargo run --release --example many_body [threads]`.

use peridyne::expression::Expression;
use peridyne::law::many_body::stillinger_weber::StillingerWeber;
use peridyne::law::many_body::tersoff::Tersoff;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;
use std::time::Instant;

/// Stillinger & Weber 1985.
const WEBER: [(&str, f64); 10] = [
    ("epsilon", 2.1683),
    ("sigma", 2.0951),
    ("a", 1.80),
    ("lambda", 21.0),
    ("gamma", 1.20),
    ("cos_theta0", -0.333333333333),
    ("A", 7.049556277),
    ("B", 0.6022245584),
    ("p", 4.0),
    ("q", 0.0),
];
/// Kinds, m, γ, λ₃, c, d, cos θ₀, n, β, λ₂, B, R, D, λ₁, A: Tersoff 1988, and silicon of Tersoff 1989.
const SECOND: [f64; 17] = [
    0.0, 0.0, 0.0, 3.0, 1.0, 1.3258, 4.8381, 2.0417, 0.0, 22.956, 0.33675, 1.3258, 95.373, 3.0,
    0.2, 3.2394, 3264.7,
];
const THIRD: [f64; 17] = [
    0.0, 0.0, 0.0, 3.0, 1.0, 0.0, 100390.0, 16.217, -0.59825, 0.78734, 1.1e-6, 1.73222, 471.18,
    2.85, 0.15, 2.4799, 1830.8,
];
const CELLS: i32 = 16;
const STEPS: usize = 100;
/// eV and Å: 28.0855 g/mol.
const MASS: f64 = 28.0855 * 1.036427e-4;
const KELVIN: f64 = 8.617333e-5;

fn main() {
    let threads = std::env::args().nth(1).and_then(|n| n.parse().ok());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(1))
        .build();
    pool.unwrap().install(|| {
        let tersoff = |row: [f64; 17]| PotentialSpec::of_entries::<Tersoff>(vec![row.to_vec()]);
        for (name, potential, edge) in [
            (
                "stillinger_weber",
                PotentialSpec::of_many_body::<StillingerWeber>(&WEBER),
                5.431,
            ),
            ("tersoff 1988", tersoff(SECOND), 5.432),
            ("tersoff 1989", tersoff(THIRD), 5.432),
        ] {
            match potential {
                Ok(potential) => println!("{name}: {:.3} µs", time(potential, edge)),
                Err((key, message)) => println!("{name}: {key}: {message}"),
            }
        }
    });
}

/// Microseconds per atom and step, lists included, the best of three.
fn time(potential: PotentialSpec, edge: f64) -> f64 {
    let mut position = vec![];
    for n in 0..CELLS.pow(3) {
        let cell = [n % CELLS, n / CELLS % CELLS, n / CELLS / CELLS];
        for site in LatticeKind::Diamond.basis() {
            let at = |a: usize| edge * (f64::from(cell[a]) + 0.25 * f64::from(site[a]));
            position.push(std::array::from_fn(at));
        }
    }
    let volume = edge.powi(3) / 8.0;
    let cloud = Cloud {
        volume: vec![volume; position.len()],
        position,
        ..Cloud::default()
    };
    let law = LawSpec::Atoms(potential);
    let mut spec = Spec::new(3, BodySpec::Cloud(cloud), MASS / volume, law);
    spec.space.periodic = [Some(edge * f64::from(CELLS)); 3];
    spec.loading.thermal = Some(ThermalSpec {
        energy: Expression::constant(1000.0 * KELVIN),
        seed: 376847,
    });
    spec.run.schedule.time_step = TimeStep::Fixed(0.001);
    spec.run.schedule.force_unstable = true;
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let mut sim = build(&spec, Options::default()).unwrap_or_else(|e| panic!("{e}"));
        sim.start(true);
        let begin = Instant::now();
        for _ in 0..STEPS {
            sim.step().unwrap_or_else(|e| panic!("{e}"));
        }
        let seconds = begin.elapsed().as_secs_f64();
        best = best.min(seconds / (STEPS as f64 * f64::from(8 * CELLS.pow(3))));
    }
    1e6 * best
}
