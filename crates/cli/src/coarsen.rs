//! `peridyne coarsen`: linear bodies level by level.

mod average;
mod increments;
mod levels;
mod report;
mod way;

use crate::Input;
use crate::deck;
use crate::failure::{Failure, say};
use crate::run::with_threads;
use average::averaged;
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
    /// Nonlinear bodies, in so many equal increments of the load of a deck of [statics]: the linear body is taken about the state of each, is
    /// coarsened, and bears what is missing there at the load of the increment's end. Law, supports and loads are those of the deck; bonds may
    /// break, and laws may remember. Writes increments.csv, the displacements of all points after every increment (points.pvd), and the
    /// levels about the last state. Into `out/<name of the deck>-increments` if --out is not given.
    #[arg(long, value_name = "N")]
    pub increments: Option<usize>,
    /// With --increments: solutions after the first at most, until what is missing on retained points is `statics.tolerance` of loads and
    /// reactions. Without, an increment leaves what the next one takes up.
    #[arg(long, default_value_t = 0, value_name = "M", requires = "increments")]
    pub corrections: usize,
    /// With --increments, what removed points do. carried: they move with the shapes of each increment, of first order in it. relaxed: after
    /// every solution they come to rest between retained ones; with corrections the answer is that of Newton's method on all points.
    #[arg(
        long,
        default_value = "carried",
        value_name = "CARRIED|RELAXED",
        requires = "increments"
    )]
    pub removed: String,
    /// Largest force under a rigid rotation, relative to the stiffness, that is accepted.
    #[arg(long, default_value_t = 1e-3, value_name = "FRACTION")]
    pub rotation: f64,
    /// Atoms at a temperature: level 0 is not the Hessian about the sites, but what forces in the frames of a run of this deck say of the bonds, with the
    /// least-squares fit of forces to displacements from the mean places. Extended XYZ or a LAMMPS dump, of the deck's box; the deck's potential evaluates the forces. Bonds between atoms of the same surroundings
    /// are alike. Prints temperature, unexplained forces, and of perfect crystals the isothermal elastic constants with their errors; `thermal.json` has them.
    #[arg(long, value_name = "FRAMES")]
    pub average: Option<PathBuf>,
    /// So many frames at the beginning are left out: a run that is not yet in equilibrium.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "average")]
    pub average_skip: usize,
    /// Longest bonds of the fit (in units of the deck), less than half of every period. If not given a quarter longer than those of the Hessian, as motion
    /// couples atoms that the potential does not, where the box holds them and the frames are enough. Elastic constants are told of bonds that are longer by another quarter, too.
    #[arg(long, value_name = "LENGTH", requires = "average")]
    pub average_radius: Option<f64>,
    /// lattice: where all atoms are alike, bonds are alike that a symmetry of the lattice maps on each other. none: they are not taken to be.
    #[arg(
        long,
        value_name = "SYMMETRY",
        default_value = "lattice",
        requires = "average"
    )]
    pub average_symmetry: String,
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
    with_threads(arguments.threads, |_| match arguments.increments {
        Some(increments) => increments::followed(arguments, &deck, increments),
        None => all(arguments, &deck),
    })
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
        let name = arguments.input.file.file_stem();
        let name = name.map_or("deck".into(), |n| n.to_string_lossy());
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
    match deck.spec.conditions.iter().find(traction) {
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
    for c in deck.spec.conditions.iter().filter(|c| act(&c.kind)) {
        let members = sim
            .members(&c.set)
            .ok_or_else(|| Failure::input(format!("{} has no set `{}`", deck.file(), c.set)))?;
        members.iter().for_each(|i| marked[*i as usize] = true);
    }
    Ok(marked)
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
