//! Microseconds per atom and step of a Lennard-Jones melt of 32,000 atoms of one, two, three and five kinds: what kinds cost.
//! `cargo run --release --example mixture [threads]`.

use peridyne::expression::Expression;
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;
use std::time::Instant;

const CELLS: i32 = 20;
const EDGE: f64 = 1.6795961913825074;
const STEPS: usize = 200;

fn main() {
    let threads = std::env::args().nth(1).and_then(|n| n.parse().ok());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(1))
        .build();
    pool.unwrap().install(|| {
        let mut best = [f64::INFINITY; 4];
        // in turns, so that what else the machine does meets all alike
        for _ in 0..3 {
            for (best, kinds) in best.iter_mut().zip([1, 2, 3, 5]) {
                *best = best.min(time(kinds));
            }
        }
        for (best, kinds) in best.iter().zip([1, 2, 3, 5]) {
            println!("kinds {kinds}: {best:.4} µs");
        }
    });
}

/// Atoms of kinds by turns, which differ a little in all constants.
fn melt(kinds: usize) -> Spec {
    let mut position = vec![];
    for n in 0..CELLS.pow(3) {
        let cell = [n % CELLS, n / CELLS % CELLS, n / CELLS / CELLS];
        for site in LatticeKind::Fcc.basis() {
            let at = |a: usize| EDGE * (f64::from(cell[a]) + 0.25 * f64::from(site[a]));
            position.push(std::array::from_fn(at));
        }
    }
    // drawn without order
    let drawn = |n: usize| (n.wrapping_mul(2_654_435_761) >> 7) % kinds;
    let volume = EDGE.powi(3) / 4.0;
    let cloud = Cloud {
        volume: vec![volume; position.len()],
        mark: (0..position.len()).map(|n| drawn(n) as i32).collect(),
        position,
        ..Cloud::default()
    };
    let law = |kind: usize| {
        let part = kind as f64 / kinds as f64;
        let lj = LennardJones {
            epsilon: 1.0 - 0.2 * part,
            sigma: 1.0 - 0.03 * part,
        };
        LawSpec::Atoms(PotentialSpec::of(lj).ended(2.5, End::Truncated))
    };
    let mut spec = Spec::new(3, BodySpec::Cloud(cloud), 1.0 / volume, law(0));
    if kinds > 1 {
        spec.materials.clear();
        for kind in 0..kinds {
            let name = format!("k{kind}");
            spec.sets.push(SetSpec {
                name: name.clone(),
                members: Members::Mark(kind as i32),
            });
            spec.materials.push(MaterialSpec {
                set: name.clone(),
                name,
                density: 1.0 / volume,
                law: law(kind),
                fracture: None,
            });
        }
        spec.interactions.mixing = Some(Mixing::Arithmetic);
    }
    spec.space.periodic = [Some(EDGE * f64::from(CELLS)); 3];
    spec.loading.thermal = Some(ThermalSpec {
        energy: Expression::constant(1.44),
        seed: 87287,
    });
    spec.run.schedule.time_step = TimeStep::Fixed(0.005);
    spec.run.schedule.force_unstable = true;
    spec
}

/// Microseconds per atom and step, lists included.
fn time(kinds: usize) -> f64 {
    let mut sim = build(&melt(kinds), Options::default()).unwrap_or_else(|e| panic!("{e}"));
    sim.start(true);
    let begin = Instant::now();
    for _ in 0..STEPS {
        sim.step().unwrap_or_else(|e| panic!("{e}"));
    }
    let seconds = begin.elapsed().as_secs_f64();
    1e6 * seconds / (STEPS as f64 * f64::from(4 * CELLS.pow(3)))
}
