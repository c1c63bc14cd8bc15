//! `peridyne coarsen`: linear bodies level by level.

mod arguments;
mod average;
mod increments;
mod level;
mod levels;
mod report;
mod way;

use crate::deck;
use crate::failure::{Failure, say};
use crate::run::with_threads;
pub use arguments::CoarsenArguments;
use average::averaged;
use level::Acting;
use levels::levels;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::Point;
use peridyne::spec::{AnyLinearBody, ConditionKind, ConditionSpec, LinearBody, Stepper, TimeStep};
use peridyne_io::deck::{Deck, rounded};
use peridyne_io::write::linear::room;
use std::path::Path;
use std::time::Instant;
use way::Way;

pub fn coarsen(arguments: &CoarsenArguments) -> Result<(), Failure> {
    if !deck::is_deck(&arguments.input) {
        return Err(Failure::input("coarsen takes a deck (.toml)"));
    }
    let deck = deck::read(&arguments.input)?;
    deck::is_plain(&deck, "coarsen")?;
    with_threads(arguments.threads, |_| match arguments.increments {
        Some(increments) => increments::followed(arguments, &deck, increments),
        None => all(arguments, &deck),
    })
}

fn all(arguments: &CoarsenArguments, deck: &Deck) -> Result<(), Failure> {
    let mut spec = deck.spec.clone();
    // motion, conditions and steps play no part in the linear body
    spec.loading.initial.clear();
    spec.loading.thermal = None;
    spec.loading.conditions.clear();
    spec.run.schedule.stepper = Stepper::Verlet;
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    let options = Options {
        trust_time_step: true,
        simd: deck::simd(&arguments.input)?,
    };
    let mut sim = build(&spec, options).map_err(|e| Failure::Input(deck.explain(&e).into()))?;
    room(sim.info()).map_err(|e| {
        Failure::input(format!(
            "{}: {e}; take fewer points or a shorter horizon",
            deck.file()
        ))
    })?;
    let kept = kept(arguments, deck, sim.as_ref())?;
    let way = Way::of(arguments)?;
    no_faces(deck, way)?;
    let acting = Acting {
        loaded: marked(deck, sim.as_ref(), adds_force)?,
        held: marked(deck, sim.as_ref(), prescribes)?,
        spacing: sim.info().spacing,
        way,
    };
    let out = arguments.out.clone().unwrap_or_else(|| {
        let name = arguments.input.stem();
        Path::new("out").join(format!("{name}-coarsened"))
    });
    let relaxed = match (spec.potential(), &arguments.average) {
        (None, Some(frames)) => {
            return Err(Failure::input(format!(
                "--average {}: frames are of atoms, and {} has no potential: leave it out",
                frames.display(),
                deck.file()
            )));
        }
        (None, None) | (Some(_), Some(_)) => None,
        (Some(_), None) => Some(relaxed(sim.as_mut(), deck)?),
    };
    let began = Instant::now();
    let body = sim.linear_body();
    say(&format!(
        "linear body of {} points: {:.2} s",
        sim.info().points,
        began.elapsed().as_secs_f64()
    ));
    let made = Made {
        arguments,
        deck,
        out: &out,
        sim,
        relaxed,
    };
    match body {
        AnyLinearBody::One(body) => made.coarsened(body, kept, acting),
        AnyLinearBody::Two(body) => made.coarsened(body, kept, acting),
        AnyLinearBody::Three(body) => made.coarsened(body, kept, acting),
    }
}

/// What level 0 is made from, whatever its dimension.
struct Made<'a> {
    arguments: &'a CoarsenArguments,
    deck: &'a Deck,
    out: &'a Path,
    sim: Box<dyn Simulation>,
    relaxed: Option<Vec<Point>>,
}

impl Made<'_> {
    /// Level 0 of frames, if there are any, and all levels above it.
    fn coarsened<const D: usize>(
        mut self,
        mut body: LinearBody<D>,
        kept: Option<Vec<u32>>,
        acting: Acting,
    ) -> Result<(), Failure> {
        let (arguments, deck, out) = (self.arguments, self.deck, self.out);
        if let Some(frames) = &arguments.average {
            let (made, moved) = averaged(arguments, deck, self.sim.as_mut(), &body, frames, out)?;
            (body, self.relaxed) = (made, Some(moved));
        }
        drop(self.sim);
        levels(arguments, deck, out, body, self.relaxed, kept, acting)
    }
}

/// The set that --keep names.
fn kept(
    arguments: &CoarsenArguments,
    deck: &Deck,
    sim: &dyn Simulation,
) -> Result<Option<Vec<u32>>, Failure> {
    let Some(name) = &arguments.keep else {
        return Ok(None);
    };
    match sim.members(name) {
        Some(members) => Ok(Some(members)),
        None => Err(Failure::input(format!(
            "--keep {name}: {} has no such set",
            deck.file()
        ))),
    }
}

/// Loads as in the paper are forces per volume.
fn no_faces(deck: &Deck, way: Way) -> Result<(), Failure> {
    let traction = |c: &&ConditionSpec| matches!(c.kind, ConditionKind::Traction { .. });
    match deck.spec.loading.conditions.iter().find(traction) {
        Some(c) if !way.condensed => Err(Failure::input(format!(
            "--loads silling: a body force density acts on retained points, and the traction on `{}` acts on a face, whose points are removed: write body_force in its place, or leave --loads out",
            c.set
        ))),
        _ => Ok(()),
    }
}

/// `[N]`: does a condition that does this act on the point?
fn marked(
    deck: &Deck,
    sim: &dyn Simulation,
    act: fn(&ConditionKind) -> bool,
) -> Result<Vec<bool>, Failure> {
    let mut marked = vec![false; sim.info().points as usize];
    for c in deck.spec.loading.conditions.iter().filter(|c| act(&c.kind)) {
        let members = sim
            .members(&c.set)
            .ok_or_else(|| Failure::input(format!("{} has no set `{}`", deck.file(), c.set)))?;
        members.iter().for_each(|i| marked[*i as usize] = true);
    }
    Ok(marked)
}

/// Does a condition add force densities, which are condensed?
fn adds_force(kind: &ConditionKind) -> bool {
    match kind {
        ConditionKind::BodyForce(_) | ConditionKind::Traction { .. } => true,
        ConditionKind::Displacement(_)
        | ConditionKind::Velocity(_)
        | ConditionKind::SetForce(_)
        | ConditionKind::Damping(_)
        | ConditionKind::Force(_) => false,
    }
}

/// Does it prescribe motion?
fn prescribes(kind: &ConditionKind) -> bool {
    match kind {
        ConditionKind::Displacement(_) | ConditionKind::Velocity(_) => true,
        ConditionKind::BodyForce(_)
        | ConditionKind::Traction { .. }
        | ConditionKind::SetForce(_)
        | ConditionKind::Damping(_)
        | ConditionKind::Force(_) => false,
    }
}

/// Residual forces over those at the lattice sites.
const RELAXED: f64 = 1e-10;

/// Displacements of a crystal that is left to itself.
fn relaxed(sim: &mut dyn Simulation, deck: &Deck) -> Result<Vec<Point>, Failure> {
    let began = Instant::now();
    sim.relax(RELAXED).map_err(|e| {
        Failure::input(format!(
            "{}: the crystal does not come to rest by itself, so that there is no linear body ({e}): take the lattice spacing at which it has no pressure, and a potential that ends smoothly",
            deck.file()
        ))
    })?;
    let u = sim.displacements();
    let far = u.iter().map(|u| u.iter().map(|c| c * c).sum::<f64>());
    say(&format!(
        "relaxed without load: atoms move by at most {} spacings, {:.2} s",
        rounded(
            far.fold(0.0, f64::max).sqrt() / deck.spec.body.spacing().unwrap_or(sim.info().spacing),
            3
        ),
        began.elapsed().as_secs_f64()
    ));
    Ok(u)
}
