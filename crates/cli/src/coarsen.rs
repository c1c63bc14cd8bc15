//! `peridyne coarsen`: linear bodies level by level.

mod levels;
mod report;
mod way;

use crate::Input;
use crate::deck;
use crate::failure::{Failure, say};
use crate::run::with_threads;
use levels::levels;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::Point;
use peridyne::spec::{AnyLinearBody, ConditionKind, ConditionSpec, LinearBody, Stepper, TimeStep};
use peridyne_io::deck::upscaled::Rewritten;
use peridyne_io::deck::{Deck, rounded};
use peridyne_io::write::linear::room;
use peridyne_theory::coarsen::Report;
use peridyne_theory::coarsen::waves::Frequencies;
use std::path::{Path, PathBuf};
use std::time::Instant;
use way::Way;

#[derive(clap::Args)]
pub struct CoarsenArguments {
    /// Deck of any law; what is coarsened is its linear body about the reference. Atoms, whose lattice pulls at surfaces and
    /// vacancies, are relaxed first, and displacements are counted from there.
    #[command(flatten)]
    pub input: Input,
    /// Retain every k-th point of the lattice along each axis; of a triangular or centred lattice the one with k times its spacing.
    #[arg(long, value_name = "K", conflicts_with_all = ["spacing", "keep"])]
    pub every: Option<u32>,
    /// Retain points no two of which are nearer than this (in units of the deck), evenly spread; for clouds.
    #[arg(long, value_name = "LENGTH", conflicts_with = "keep")]
    pub spacing: Option<f64>,
    /// Retain the points of this set of the deck.
    #[arg(long, value_name = "SET")]
    pub keep: Option<String>,
    /// So many times, each level from the one before.
    #[arg(long, default_value_t = 1)]
    pub levels: usize,
    /// Accepted error of the effective modulus, by which the radius of balls is chosen.
    #[arg(long, default_value_t = 0.01, conflicts_with = "radius")]
    pub tolerance: f64,
    /// Radius of the balls of the first level (in units of the deck); it grows with the spacing of points from level to level.
    #[arg(long, value_name = "LENGTH")]
    pub radius: Option<f64>,
    /// energy (shapes cut off by balls, symmetric), rows (as published), or schur (exact and full).
    #[arg(long, default_value = "energy")]
    pub scheme: String,
    /// Makes action reaction where rows do not (`K_ij ← ½ (K_ij + K_jiᵀ)`): yes or no. As published they are not symmetric; where they
    /// are made so, rotations of plates and blocks may meet forces.
    #[arg(long, default_value = "no", value_name = "YES|NO")]
    pub symmetrise: String,
    /// condensed: body forces and tractions on removed points go where the condensation leads them, none is lost. silling: a body force
    /// density acts on retained points alone, which keep their own volumes, so that it is the same force on them at every level.
    #[arg(long, default_value = "condensed", value_name = "CONVENTION")]
    pub loads: String,
    /// What moves with a retained point. blend: half lumped mass, half that of the shapes that the removed points have in equilibrium, or,
    /// in lattices, so much of it that long waves are right; waves of 25 coarse spacings are then a few tenths of a percent slow, of 10 some
    /// percent. lumped: 4 and 18 % slow. consistent: the shapes alone, up to 4 and 18 % fast, with the shorter stable step. Shorter waves than some ten coarse spacings have no remedy but more points:
    /// the removed points are taken to be in equilibrium at every moment, and in such waves they are not. Of statics it changes nothing.
    #[arg(long, default_value = "blend", value_name = "MASS")]
    pub mass: String,
    /// kept: points whose displacement or velocity is prescribed are retained besides the others, so that the body is held as it was.
    /// thinned: only those of them that are retained anyway.
    #[arg(long, default_value = "kept", value_name = "KEPT|THINNED")]
    pub supports: String,
    /// Largest force under a rigid rotation, relative to the stiffness, that is accepted.
    #[arg(long, default_value_t = 1e-3, value_name = "FRACTION")]
    pub rotation: f64,
    /// Run the deck and all levels, and measure error and cost. A body that moves and is more than 5 % off is warned of.
    #[arg(long)]
    pub run: bool,
    /// Folder for the results; `out/<name of the deck>-coarsened` if not given.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Threads; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
}

pub fn coarsen(arguments: &CoarsenArguments) -> Result<(), Failure> {
    if !deck::is_deck(&arguments.input) {
        return Err(Failure::input("coarsen takes a deck (.toml)"));
    }
    let deck = deck::read(&arguments.input)?;
    deck::is_plain(&deck, "coarsen")?;
    with_threads(arguments.threads, |_| all(arguments, &deck))
}

fn all(arguments: &CoarsenArguments, deck: &Deck) -> Result<(), Failure> {
    let mut spec = deck.spec.clone();
    // motion, conditions and steps play no part in the linear body
    spec.initial.clear();
    spec.thermal = None;
    spec.conditions.clear();
    spec.schedule.stepper = Stepper::Verlet;
    spec.schedule.time_step = TimeStep::Fixed(1.0);
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
    let kept = match &arguments.keep {
        None => None,
        Some(name) => Some(sim.members(name).ok_or_else(|| {
            Failure::input(format!("--keep {name}: {} has no such set", deck.file()))
        })?),
    };
    let way = Way::of(arguments)?;
    let traction = |c: &&ConditionSpec| matches!(c.kind, ConditionKind::Traction { .. });
    if let (false, Some(c)) = (way.condensed, deck.spec.conditions.iter().find(traction)) {
        return Err(Failure::input(format!(
            "--loads silling: a body force density acts on retained points, and the traction on `{}` acts on a face, whose points are removed: write body_force in its place, or leave --loads out",
            c.set
        )));
    }
    let ids = |act: fn(&ConditionKind) -> bool| -> Result<Vec<bool>, Failure> {
        let mut marked = vec![false; sim.info().points as usize];
        for c in deck.spec.conditions.iter().filter(|c| act(&c.kind)) {
            let members = sim
                .members(&c.set)
                .ok_or_else(|| Failure::input(format!("{} has no set `{}`", deck.file(), c.set)))?;
            members.iter().for_each(|i| marked[*i as usize] = true);
        }
        Ok(marked)
    };
    let acting = Acting {
        loaded: ids(adds_force)?,
        held: ids(prescribes)?,
        spacing: sim.info().spacing,
        way,
    };
    let out = arguments.out.clone().unwrap_or_else(|| {
        let name = arguments.input.file.file_stem();
        let name = name.map_or("deck".into(), |n| n.to_string_lossy());
        Path::new("out").join(format!("{name}-coarsened"))
    });
    let relaxed = match spec.potential() {
        None => None,
        Some(_) => Some(relaxed(sim.as_mut(), deck)?),
    };
    let began = Instant::now();
    let body = sim.linear_body();
    say(&format!(
        "linear body of {} points: {:.2} s",
        sim.info().points,
        began.elapsed().as_secs_f64()
    ));
    drop(sim);
    match body {
        AnyLinearBody::One(body) => levels(arguments, deck, &out, body, relaxed, kept, acting),
        AnyLinearBody::Two(body) => levels(arguments, deck, &out, body, relaxed, kept, acting),
        AnyLinearBody::Three(body) => levels(arguments, deck, &out, body, relaxed, kept, acting),
    }
}

/// What the conditions of a deck do, point by point.
struct Acting {
    /// `[N]`
    loaded: Vec<bool>,
    held: Vec<bool>,
    spacing: f64,
    way: Way,
}

/// A level that was made.
struct Level<const D: usize> {
    name: String,
    body: LinearBody<D>,
    report: Report,
    frequencies: Frequencies,
    /// Longest stable steps of level 0 and of this one (time).
    steps: [Option<f64>; 2],
    text: Rewritten,
    seconds: f64,
    /// Points that are retained only because they are held.
    supports: usize,
}

/// Does a condition add force densities, which are condensed?
fn adds_force(kind: &ConditionKind) -> bool {
    match kind {
        ConditionKind::BodyForce(_) | ConditionKind::Traction { .. } => true,
        ConditionKind::Displacement(_)
        | ConditionKind::Velocity(_)
        | ConditionKind::SetForce(_)
        | ConditionKind::Damping(_)
        | ConditionKind::Own(_) => false,
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
        | ConditionKind::Own(_) => false,
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
