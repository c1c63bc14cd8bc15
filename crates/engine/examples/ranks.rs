//! A block that is torn, shared among ranks: one hash of where its points are and how fast, and the energy of its bonds, on any number of them.
//! `mpiexec -n 4 target/debug/examples/ranks`, `cargo run --release --example ranks -- --on-threads 4`, or alone. A second number is the size of the block.

use peridyne::expression::Expression;
use peridyne::observe::{StateHash, Values};
use peridyne::run::ranks::RankModel;
use peridyne::run::{Options, Shelf};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;
use peridyne_comm::{Comm, Failure, on_threads};
use std::sync::Arc;
use std::time::Instant;

const STEPS: usize = 20;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |n: usize| words.get(n).and_then(|word| word.parse::<u16>().ok());
    let said = match words.first().map(String::as_str) {
        Some("--on-threads") => {
            let spec = block(number(2).unwrap_or(24).into());
            let all = on_threads(number(1).unwrap_or(2).into(), |comm| run(comm, &spec));
            all.into_iter().next().expect("there is a rank")
        }
        _ => Comm::of_launcher().and_then(|comm| run(comm, &block(number(0).unwrap_or(24).into()))),
    };
    match said {
        Ok(Some(line)) => println!("{line}"),
        Ok(None) => {}
        Err(failure) => {
            eprintln!("error: {failure}");
            std::process::exit(2);
        }
    }
}

/// A block of linear peridynamic solid that flies apart.
fn block(edge: i32) -> Spec {
    let mut quarters = vec![];
    for z in 0..edge {
        for y in 0..edge {
            quarters.extend((0..edge).map(|x| [4 * x, 4 * y, 4 * z]));
        }
    }
    let body = BodySpec::Sites {
        kind: LatticeKind::Cubic,
        spacing: 0.5,
        origin: [0.0; 3],
        quarters,
        volume: None,
    };
    let law = LawSpec::Lps(Moduli {
        young: 3.0,
        poisson: 0.2,
    });
    let mut spec = Spec::new(3, body, 2.0, law);
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.materials[0].fracture = Some(FractureSpec {
        criterion: Criterion::Stretch(0.02),
        alpha: 0.25,
        rate: None,
        fatigue: None,
    });
    let e = |text| Some(Expression::parse(text, &[]).expect("an expression"));
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [const { None }; 3],
        velocity: [
            e("0.2*sin(1.1*x)*cos(0.9*y + 1.3*z)"),
            e("0.1*cos(1.2*x + 1.7*y)"),
            e("0.1*sin(0.7*z)"),
        ],
    }];
    spec.run.schedule.time_step = TimeStep::Fixed(0.02);
    spec
}

/// What rank 0 says of it.
fn run(comm: Comm, spec: &Spec) -> Result<Option<String>, Failure> {
    let comm = Arc::new(comm);
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    let made = RankModel::<3>::new(spec, options, &Shelf::standard(), &comm);
    let mut model = made.unwrap_or_else(|error| {
        eprintln!("error: {}", error.message);
        comm.abort(2)
    });
    model.start();
    comm.barrier()?;
    let begun = Instant::now();
    for _ in 0..STEPS {
        if let Err(error) = model.step() {
            eprintln!("error: {error}");
            comm.abort(1);
        }
    }
    comm.barrier()?;
    let seconds = begun.elapsed().as_secs_f64();
    let [strain, _] = model.energy();
    // id, displacement and velocity of each point
    let columns = ["displacement", "velocity"].map(|name| match model.column(name) {
        Some(column) => match column.values {
            Values::Vectors(all) => all,
            _ => vec![],
        },
        None => vec![],
    });
    let own = model.ids().iter().enumerate().flat_map(|(n, id)| {
        let both = columns.iter().flat_map(move |of| of[n]);
        std::iter::once(f64::from(*id)).chain(both)
    });
    let all = comm.all_numbers(&own.collect::<Vec<f64>>())?;
    let mut points: Vec<&[f64]> = all.chunks_exact(7).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert_eq!(points.len(), model.points());
    let state = StateHash::of(points.into_iter().flatten().copied());
    let (sent, copies) = model.halo();
    Ok((comm.rank() == 0).then(|| {
        format!("{state} energy {strain:e}, {} ranks: {seconds:.3} s, rank 0 sent {sent} bytes and has {copies} copies", comm.ranks())
    }))
}
