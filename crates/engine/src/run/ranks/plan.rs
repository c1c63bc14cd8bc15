//! What a step costs, and how it is shared: measured where there is one machine, to foresee many.

use super::model::RankModel;
use crate::error::BuildError;
use crate::run::build::made_among;
use crate::run::interfaces;
use crate::run::reference::current_neighbours;
use crate::run::{Info, Options, Registry, Simulation};
use crate::spec::{Spec, Stepper};
use peridyne_comm::on_threads;
use std::sync::Arc;
use std::time::Instant;

/// What a step costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepCost {
    /// Of one process on the threads that are there (time of the clock).
    pub seconds: f64,
    /// Of two ranks on one thread each.
    pub seconds_of_two: f64,
    /// What a rank tells a neighbour: messages, and bytes for each of its points that the neighbour has a copy of.
    pub messages: f64,
    pub bytes_per_copy: f64,
    /// How often all ranks hear what each says.
    pub rounds: f64,
    pub meanwhile: Meanwhile,
}

/// What is done while messages are on their way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meanwhile {
    /// Of the messages to a neighbour, and of the bytes for each copy, those that nobody waits for while there is work.
    pub messages: f64,
    pub bytes_per_copy: f64,
    /// Part of the time of a step of a point whose partners are all here.
    pub part: f64,
}

/// How so many ranks share a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shares {
    pub ranks: usize,
    /// Ranks that have points.
    pub working: usize,
    /// The most points that one has, and the most copies of others' that one of those that were looked at has: the first, the middle and the last.
    pub points: usize,
    pub copies: usize,
}

impl Shares {
    /// To how many others a rank tells what its points have: those whose points lie within reach on either side of a slab.
    pub fn neighbours(&self) -> usize {
        let beside = (self.copies / 2).div_ceil(self.points.max(1)).max(1);
        (2 * beside).min(self.working - 1)
    }
}

/// What a step of a spec costs, by so many steps of one process and of two ranks, and how these numbers of ranks share its body.
///
/// # Errors
/// Equations may be solved by a matrix, which one rank has, and atoms be near to any others; as of [`build`](crate::run::build); steps end with an error.
pub fn plan(
    spec: &Spec,
    options: Options,
    steps: usize,
    ranks: &[usize],
) -> Result<(Info, StepCost, Vec<Shares>), BuildError> {
    let by_matrix = match spec.run.schedule.stepper {
        Stepper::Verlet | Stepper::Still => false,
        Stepper::Newmark(_) => true,
        Stepper::Statics(statics) => !statics.method.minimizes(),
    };
    if by_matrix {
        let message = "equations are solved on the first rank where they have a matrix, and what that takes does not shrink with the number of machines";
        return Err(BuildError::unsupported("run", message)
            .help("plan explicit steps, or statics with method = \"relaxation\""));
    }
    if current_neighbours(spec) {
        let message =
            "atoms may come near to any others in time: what ranks exchange cannot be predicted";
        return Err(BuildError::unsupported("bonds.family", message).help(
            "measure it by some steps on few ranks, or take family = \"stencil\" or \"reference\" where atoms stay",
        ));
    }
    match spec.space.dimension {
        1 => planned::<1>(spec, options, steps, ranks),
        2 => planned::<2>(spec, options, steps, ranks),
        _ => planned::<3>(spec, options, steps, ranks),
    }
}

fn went_wrong(error: &impl ToString) -> BuildError {
    BuildError::ill_posed("run", error.to_string()).help(
        "a plan does the first steps of the run: correct them first, `peridyne run` says more",
    )
}

fn planned<const D: usize>(
    spec: &Spec,
    options: Options,
    steps: usize,
    ranks: &[usize],
) -> Result<(Info, StepCost, Vec<Shares>), BuildError> {
    let mut model = made_among::<D>(spec, options, &Registry::standard(), None)?;
    model.start(true);
    let begun = Instant::now();
    for _ in 0..steps {
        model.step().map_err(|e| went_wrong(&e))?;
    }
    let seconds = begun.elapsed().as_secs_f64() / steps as f64;
    let (body, info) = (&model.system.body, model.info().clone());
    let reach = info.horizon + body.spacing();
    let joined = interfaces::ends(spec, body)?.len();
    let shares = ranks.iter().map(|n| {
        let [points, copies, working] = body.shares(*n, reach);
        Shares {
            ranks: *n,
            working,
            points,
            // of interfaces all ranks have all
            copies: copies + joined,
        }
    });
    let shares = shares.collect();
    drop(model);
    let ends = on_threads(2, |comm| {
        // each rank a machine of its own
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let pool = pool.map_err(|e| went_wrong(&e))?;
        pool.install(|| {
            let comm = Arc::new(comm);
            let mut own = RankModel::<D>::new(spec, options, &Registry::standard(), &comm)?;
            own.start();
            let (before, copies) = own.halo();
            let begun = Instant::now();
            for _ in 0..steps {
                own.step().map_err(|e| went_wrong(&e))?;
            }
            let seconds = begun.elapsed().as_secs_f64();
            let after = own.halo().0;
            let worked = 1e-9 * (after.worked - before.worked) as f64 / seconds;
            // copies are as many as the points that others have copies of
            let inside = own.ids().len().saturating_sub(copies) as f64;
            let part = (worked * own.ids().len() as f64 / inside.max(1.0)).min(1.0);
            Ok((seconds, before, after, copies, (part, own.meanwhile())))
        })
    });
    let ends = ends.into_iter().collect::<Result<Vec<_>, BuildError>>()?;
    let (_, before, after, _, (part, [messages, bytes])) = ends[0];
    // what one sends is for the other's copies
    let copies = ends[1].3;
    let per_step = |of: [u64; 2]| (of[1] - of[0]) as f64 / steps as f64;
    let slowest = ends.iter().map(|end| end.0).fold(0.0, f64::max);
    let cost = StepCost {
        seconds,
        seconds_of_two: slowest / steps as f64,
        messages: per_step([before.messages, after.messages]),
        bytes_per_copy: per_step([before.bytes, after.bytes]) / copies.max(1) as f64,
        rounds: per_step([before.rounds, after.rounds]),
        meanwhile: Meanwhile {
            messages: messages as f64,
            bytes_per_copy: bytes as f64,
            part,
        },
    };
    Ok((info, cost, shares))
}
