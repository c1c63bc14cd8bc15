//! Time per directed bond and step of heat through the bonds of a cube, on one thread or as many as asked for:
//! `cargo run --release --example diffusion [threads] [cells]`.
use peridyne::expression::Expression;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;
use std::time::Instant;

fn main() {
    let number = |n: usize| std::env::args().nth(n).and_then(|a| a.parse().ok());
    let (threads, cells) = (number(1).unwrap_or(1), number(2).unwrap_or(60) as i32);
    let mut quarters = vec![];
    for z in 0..cells {
        for y in 0..cells {
            for x in 0..cells {
                quarters.push([4 * x, 4 * y, 4 * z]);
            }
        }
    }
    let body = BodySpec::Sites {
        kind: LatticeKind::Cubic,
        spacing: 1.0,
        origin: [0.0; 3],
        quarters,
        volume: None,
    };
    let pmb = LawSpec::Pmb(PmbStiffness::Young(1.0));
    let mut spec = Spec::new(3, body, 1.0, pmb);
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.run.schedule.stepper = Stepper::Still;
    let wave = Expression::parse("sin(x) * cos(2*y + z)", &[]).expect("an expression");
    spec.interactions.diffusions = vec![DiffusionSpec {
        quantity: Quantity::Heat,
        method: DiffusionMethod::Explicit { safety: 0.9 },
        reference: 0.0,
        across_broken: false,
        deformation: false,
        materials: vec![DiffusionMaterial {
            conductivity: 1.0,
            capacity: 1.0,
            expansion: 0.0,
        }],
        initial: vec![("all".into(), wave)],
        conditions: vec![],
    }];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads").install(|| {
        let mut sim = build(&spec, Options::default()).expect("a cube");
        sim.start(true);
        let bonds = sim.info().directed_bonds as f64;
        let time = |sim: &mut dyn peridyne::run::Simulation, steps: u32| {
            let began = Instant::now();
            for _ in 0..steps {
                sim.step().expect("a step");
            }
            began.elapsed().as_secs_f64() * 1e9 / f64::from(steps)
        };
        time(&mut *sim, 3);
        let best = (0..5).map(|_| time(&mut *sim, 4)).fold(f64::INFINITY, f64::min);
        println!(
            "heat, cube of {cells}³ points, {bonds:.3e} directed bonds, {threads} threads: {:.3} ns per bond and step, {:.0} bytes per point",
            best / bonds,
            sim.info().bytes as f64 / sim.info().points as f64
        );
    });
}
