//! `peridyne run`.

use crate::Input;
use crate::deck;
use crate::early::{Early, asked, same_files};
use crate::enough::enough;
use crate::failure::{Failure, note, say};
use crate::law;
use crate::progress::Terminal;
use crate::ranks::{agreed, by_the_first, shared, some_threads, threads_here};
use crate::report;
use crate::script;
use crate::signals;
use peridyne::columns::Shape;
use peridyne::error::BuildError;
use peridyne::run::Simulation;
use peridyne::spec::{BodySpec, Schedule, Spec, Stepper, TimeStep};
use peridyne_comm::Comm;
use peridyne_io::continuum::Units;
use peridyne_io::continuum::run::{FieldsPlan, efforts};
use peridyne_io::deck::{Deck, Dim, SpaceTimeSpec, UnitSystem, counted};
use peridyne_io::drive::{
    AtomsPlan, DriveError, ExodusPlan, Plan, RigidBodies, SpaceTimeOptions, drive, too_many_threads,
};
use peridyne_io::write::SeriesOptions;
use peridyne_io::write::checkpoint::{Asked, Checkpoint};
use peridyne_io::write::dump::DumpBox;
use peridyne_io::write::picture::PictureOptions;
use peridyne_io::write::picture::marks::Marks;
use peridyne_io::write::picture::shown::{About, component_of};
use peridyne_io::write::run_json::{MarkNotes, RunReport, Status};
use peridyne_io::write::space_time::DENSITY;
use std::path::PathBuf;
use std::sync::Arc;

#[derive(clap::Args)]
pub struct RunArguments {
    #[command(flatten)]
    pub input: Input,
    /// Folder for the results; `out/<name of the file>` if neither this nor the deck says otherwise. Files that a
    /// LAMMPS script names go there too; without it, to the current folder.
    #[arg(long)]
    pub out: Option<PathBuf>,
    /// Let the deck or script write outside the folder of the results.
    #[arg(long)]
    pub allow_outside: bool,
    /// Threads of each rank; all cores, shared by the ranks of a machine, if not given. Results do not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
    /// So many threads of one process as ranks, without a launcher.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub on_threads: Option<u16>,
    #[command(flatten)]
    pub early: Early,
}

impl RunArguments {
    /// Of a conservation law.
    pub fn place(&self) -> law::Place<'_> {
        law::Place {
            input: &self.input,
            out: self.out.as_deref(),
            allow_outside: self.allow_outside,
            early: &self.early,
        }
    }

    /// Of a script of LAMMPS.
    pub fn place_of_script(&self) -> script::Place<'_> {
        let (out, outside) = (self.out.as_deref(), self.allow_outside);
        script::Place::new(&self.input, out, outside, &self.early)
    }
}

pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    shared(arguments.on_threads, |comm| {
        if !deck::is_deck(&arguments.input) {
            let place = arguments.place_of_script();
            return with_threads(threads_here(comm, arguments.threads)?, |threads| {
                script::run_among(&place, (comm, threads), None)
            });
        }
        if let Some(deck) = agreed(comm, law::read(&arguments.input))? {
            return by_the_first(comm, "conservation laws", || {
                with_threads(arguments.threads, |_| {
                    law::run(&arguments.place(), deck, None)
                })
            });
        }
        let read = || {
            let deck = deck::read(&arguments.input)?;
            if !arguments.allow_outside {
                deck.stays_inside(arguments.out.is_some())
                    .map_err(|e| Failure::Input(e.into()))?;
            }
            Ok(deck)
        };
        let deck = agreed(comm, read())?;
        let threads = arguments.threads.or(deck.threads);
        with_threads(threads_here(comm, threads)?, |threads| {
            run_deck(arguments, &deck, (comm, threads), Begin::Unloaded)
        })
    })
}

/// Everything runs inside a pool of its own, so that sweeps never cross into another.
pub fn with_threads(
    threads: Option<usize>,
    work: impl FnOnce(usize) -> Result<(), Failure> + Send,
) -> Result<(), Failure> {
    some_threads(threads)?;
    if let Some(text) = threads.and_then(too_many_threads) {
        note(&format!("warning: {text}"));
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build()
        .map_err(|e| Failure::Run(format!("no threads: {e}")))?;
    pool.install(|| work(rayon::current_num_threads()))
}

/// Where a run begins.
pub enum Begin {
    /// As its deck says.
    Unloaded,
    /// Where an earlier run of this deck was ended, in its folder.
    Ended(Box<Checkpoint>),
    /// At time 0 from a state of an earlier run, of this or another deck.
    Anew(Box<Checkpoint>),
}

/// Runs a deck.
pub fn run_deck(
    arguments: &RunArguments,
    deck: &Deck,
    (comm, threads): (&Arc<Comm>, usize),
    begin: Begin,
) -> Result<(), Failure> {
    let (rigid, spec) = RigidBodies::watched(&deck.spec);
    let (from, anew) = match begin {
        Begin::Unloaded => (None, None),
        Begin::Ended(state) => (Some(*state), None),
        Begin::Anew(state) => (None, Some(*state)),
    };
    let made = deck::model_among((deck, anew), &spec, &arguments.input, comm)?;
    // it has followed the first rank to the end
    let Some(mut sim) = made else { return Ok(()) };
    drop(spec);
    let dir = arguments
        .out
        .clone()
        .or(deck.output.dir.clone())
        .unwrap_or_else(|| arguments.input.default_dir());
    let mut plan = planned(deck, sim.as_mut(), dir, arguments.allow_outside)?;
    say(&deck.describe());
    let remarks = deck::remarks(&deck.notes, &plan.warnings);
    say(&(deck::headline(sim.as_ref(), deck.units) + &remarks));
    let steps = plan.steps;
    (plan.ranks, plan.threads) = (comm.ranks(), threads);
    plan.command = deck::command(&arguments.input);
    let records = [&plan.command, &plan.deck, &plan.deck_text].map(String::clone);
    plan.asked = asked(&arguments.input, records);
    let done = from.as_ref().map_or(0, |f| f.asked.step);
    if let Some(from) = &from {
        go_on(&mut plan, &from.asked)?;
    }
    plan.rigid = rigid;
    let whole = match plan.increments {
        0 => counted(steps, "step"),
        n => format!(
            "{} of load, then {}",
            counted(n, "increment"),
            counted(steps - n, "step")
        ),
    };
    let left = match done {
        0 => whole,
        done => format!("the last {} of {whole}", steps - done),
    };
    if comm.ranks() > 1 {
        let idle = match sim.info().idle_ranks {
            0 => String::new(),
            idle => format!("\nidle      {idle} of them: the body has no more blocks of 256 cells"),
        };
        say(&format!(
            "ranks     {}: {}{idle}",
            comm.ranks(),
            comm.carrier()
        ));
    }
    say(&format!(
        "threads   {threads}\nrunning {left}, results in {}",
        plan.dir.display()
    ));
    let statics = counts_load(&deck.spec.run.schedule);
    let times = (!statics).then_some(deck.units);
    let bonds = sim.info().directed_bonds;
    let mut progress = Terminal::new(steps, bonds, times).ending(arguments.early.clone(), done);
    sim.stop_when(|| signals::received().is_some());
    let result = drive(sim.as_mut(), &plan, &mut progress, from);
    progress.end();
    match result {
        Ok(done) => ended(&done, &plan),
        Err(DriveError::Resume(e)) => Err(Failure::input(e.to_string())),
        Err(e) => Err(Failure::Run(e.to_string())),
    }
}

/// What a deck asks for of a run of its model, with results in a folder.
///
/// # Errors
/// The machine has not enough memory or room, a picture or field is asked for that there is not, or the deck lies among its results.
pub fn planned(
    deck: &Deck,
    sim: &mut dyn Simulation,
    dir: PathBuf,
    allow_outside: bool,
) -> Result<Plan, Failure> {
    enough(deck, sim, &dir)?;
    let pictures = pictures(deck, sim)?;
    let space_time = space_time(deck, sim)?;
    let step = sim.info().time_step;
    let mut plan = plan(deck, pictures, deck.steps(step), dir, allow_outside);
    plan.space_time = space_time;
    plan.replaces_nothing()
        .map_err(|e| Failure::input(e.to_string()))?;
    if let Some(asked) = &mut plan.continuum {
        efforts(sim, asked).map_err(|e| {
            let error = BuildError::invalid("fields", format!("[[fields]] {e}"));
            Failure::Input(deck.explain(&error).into())
        })?;
        asked.stop = || signals::received().is_some();
    }
    plan.warnings = deck::warnings(deck, sim.info());
    let until = until(&deck.spec, plan.steps - plan.increments, step);
    plan.marks = MarkNotes::of(&Marks::of(&deck.spec, sim, until), deck.units);
    Ok(plan)
}

/// Says what a run has done and where its results are.
///
/// # Errors
/// A signal has ended it.
fn ended(done: &RunReport, plan: &Plan) -> Result<(), Failure> {
    say(&format!(
        "{}: {} in {:.2} s{}{}",
        done.outcome(),
        counted(done.steps, "step"),
        done.seconds_stepping,
        done.ns_per_bond_step.map_or(String::new(), |ns| format!(
            ", {ns:.2} ns per bond and step"
        )),
        match done.fragments {
            Some(fragments) => format!(
                ", {} broken, {}",
                counted(done.broken_bonds, "bond"),
                counted(fragments, "fragment")
            ),
            None => String::new(),
        },
    ));
    say(&done.seconds.told(done.seconds_stepping));
    for picture in &done.pictures {
        say(&format!("picture: {}", plan.dir.join(picture).display()));
    }
    if plan.output.report {
        say(&report::told(&plan.dir));
    }
    say(&report::state(done.hash));
    // a warning has said why where none could be written
    if done.status == Status::Ended && Checkpoint::any(&plan.dir) {
        say(&format!("go on:    peridyne resume {}", plan.dir.display()));
    }
    match signals::received() {
        Some(signal) if done.status == Status::Ended => Err(Failure::Ended(signal)),
        _ => Ok(()),
    }
}

/// Plans what is left of a run that was ended.
///
/// # Errors
/// A file is another one than when the run began, the deck asks for fewer steps than were done, or a program gave other things than at the beginning.
pub fn go_on(plan: &mut Plan, asked: &Asked) -> Result<(), Failure> {
    same_files(&asked.files, &plan.asked.files)?;
    same_given(&asked.given, &plan.asked.given)?;
    // records are those of the run that began
    (plan.command, plan.deck) = (asked.command.clone(), asked.name.clone());
    plan.asked = asked.clone();
    plan.asked.text.clone_from(&plan.deck_text);
    match asked.step > plan.steps {
        true => Err(Failure::input(format!(
            "the run has done {} steps, and the deck asks for {} now; ask for as many or more",
            asked.step, plan.steps
        ))),
        false => Ok(()),
    }
}

/// Is what a program gave beside the deck what the run began with?
fn same_given(then: &[String], now: &[String]) -> Result<(), Failure> {
    let told = |given: &[String]| match given {
        [] => "nothing".to_string(),
        given => given.join(", "),
    };
    match then == now {
        true => Ok(()),
        false => Err(Failure::input(format!(
            "beside its deck the run was given {} by the program that began it, and now {}: functions are in no state, so go on from that program and give them again, \
             in the same order (in Python: peridyne.resume(folder, prepare=…))",
            told(then),
            told(now)
        ))),
    }
}

/// The pictures that a deck asks for.
///
/// # Errors
/// There is no such field, or it has no such component.
pub fn pictures(deck: &Deck, sim: &mut dyn Simulation) -> Result<Vec<PictureOptions>, Failure> {
    let still = deck.spec.run.schedule.statics().is_some();
    let step = sim.info().time_step;
    let end = until(&deck.spec, deck.steps(step) - deck.increments(), step);
    let marks = Marks::of(&deck.spec, sim, end);
    let columns = sim.columns();
    let [length_unit, time_unit, _] = units(deck);
    let breaks = deck.spec.materials.iter().any(|m| m.fracture.is_some());
    let mut all = vec![];
    for (n, asked) in deck.output.pictures.iter().enumerate() {
        let wrong = |key: &str, why: String, help: String| {
            let error = BuildError::invalid(format!("output.pictures[{n}].{key}"), why).help(help);
            Failure::Input(deck.explain(&error).into())
        };
        // a film is begun before it is known what the run was about
        let about = match (breaks, still) {
            _ if deck.spec.run.schedule.stepper == Stepper::Still
                && let Some(t) = deck.spec.interactions.diffusions.first() =>
            {
                About::Spread(t.quantity.column())
            }
            (true, _) => About::Fracture,
            (false, true) => About::Equilibrium,
            (false, false) => About::Motion,
        };
        let field = match (
            &asked.field,
            asked.film.is_some() || asked.component.is_some() || asked.range.is_some(),
        ) {
            (None, true) => Some(about.field().to_string()),
            (field, _) => field.clone(),
        };
        let mut range = asked.range;
        if let Some(name) = &field {
            let column = columns.iter().find(|c| c.name == *name);
            let Some(column) = column else {
                let names: Vec<&str> = columns.iter().map(|c| &*c.name).collect();
                let help = format!("this model has {}", names.join(", "));
                return Err(wrong("field", format!("there is no field `{name}`"), help));
            };
            if let Err(why) = component_of(column.shape, asked.component.as_deref()) {
                let help = format!("leave it out, or see `peridyne doc {name}`");
                return Err(wrong("component", format!("{name}: {why}"), help));
            }
            let factor = deck.units.plain_factor(column.dimension);
            range = range.map(|r| r.map(|x| x * factor));
        }
        if let Some(name) = &asked.arrows {
            let vectors = || { columns.iter() }.filter(|c| c.shape == Shape::Vector);
            if !vectors().any(|c| c.name == *name) {
                let names: Vec<&str> = vectors().map(|c| &*c.name).collect();
                let why = match columns.iter().any(|c| c.name == *name) {
                    true => format!("{name} has no direction: it is no vector"),
                    false => format!("there is no field `{name}`"),
                };
                let help = format!("vectors of this model: {}", names.join(", "));
                return Err(wrong("arrows", why, help));
            }
            if sim.info().dimension == 1 {
                let why = "arrows are drawn in 2-D and 3-D".to_string();
                let help = "leave them out: curves show displacements along a line".to_string();
                return Err(wrong("arrows", why, help));
            }
        }
        all.push(PictureOptions {
            title: deck.spec.title.clone(),
            length_unit: length_unit.to_string(),
            time_unit: time_unit.to_string(),
            units: deck.units,
            field,
            component: asked.component.clone(),
            scale: asked.scale,
            range,
            arrows: asked.arrows.clone(),
            film: asked.film,
            still,
            marks: marks.clone(),
            ..PictureOptions::default()
        });
    }
    Ok(all)
}

/// The fields over place and time that a deck asks for.
///
/// # Errors
/// There is no such field, or it has no such component.
pub fn space_time(deck: &Deck, sim: &mut dyn Simulation) -> Result<Vec<SpaceTimeOptions>, Failure> {
    let columns = sim.columns();
    let wrong = |why: String, help: String| {
        let error = BuildError::invalid("output.space_time", why).help(help);
        Failure::Input(deck.explain(&error).into())
    };
    let one = |asked: &SpaceTimeSpec| {
        let column = columns.iter().find(|c| c.name == asked.field);
        let factor = match column {
            // a ratio of lengths
            _ if asked.field == DENSITY => 1.0,
            Some(column) => {
                if let Err(why) = component_of(column.shape, asked.component.as_deref()) {
                    let help = format!("leave it out, or see `peridyne doc {}`", asked.field);
                    return Err(wrong(format!("{}: {why}", asked.field), help));
                }
                deck.units.plain_factor(column.dimension)
            }
            None => {
                let names: Vec<&str> = columns.iter().map(|c| &*c.name).collect();
                let help = format!(
                    "write {DENSITY:?}, or a field of this model: {}",
                    names.join(", ")
                );
                return Err(wrong(format!("there is no field `{}`", asked.field), help));
            }
        };
        Ok(SpaceTimeOptions {
            field: asked.field.clone(),
            component: asked.component.clone(),
            range: asked.range.map(|r| r.map(|x| x * factor)),
            window: asked.window,
            period: deck.spec.space.periodic[0],
        })
    };
    deck.output.space_time.iter().map(one).collect()
}

/// Units of length, time and energy.
fn units(deck: &Deck) -> [&'static str; 3] {
    match deck.units {
        UnitSystem::Si => ["m", "s", "J"],
        UnitSystem::Metal(_) => ["Å", "ps", "eV"],
        UnitSystem::Lj | UnitSystem::None => [""; 3],
    }
}

/// The last t of so many steps.
pub fn until(spec: &Spec, steps: u64, step: f64) -> f64 {
    match counts_load(&spec.run.schedule) {
        true => 1.0,
        false => steps as f64 * step,
    }
}

/// Is t a part of the load, which goes to 1? In statics without a duration it is.
fn counts_load(schedule: &Schedule) -> bool {
    let end = match schedule.time_step {
        TimeStep::Fixed(step) => step * schedule.steps.max(1) as f64,
        TimeStep::Fraction(_) | TimeStep::Auto => 1.0,
    };
    schedule.statics().is_some() && (end - 1.0).abs() < 1e-9
}

/// The Exodus file that a deck asks for.
fn exodus(deck: &Deck) -> Option<ExodusPlan> {
    let path = deck.output.exodus.clone()?;
    let bodies = match &deck.spec.body {
        BodySpec::Several(pieces) => pieces.iter().map(|p| p.name.clone()).collect(),
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => vec![],
    };
    Some(ExodusPlan {
        path,
        materials: deck.spec.materials.iter().map(|m| m.name.clone()).collect(),
        bodies,
        sets: deck.spec.sets.iter().map(|s| s.name.clone()).collect(),
    })
}

fn plan(
    deck: &Deck,
    pictures: Vec<PictureOptions>,
    steps: u64,
    dir: PathBuf,
    allow_outside: bool,
) -> Plan {
    let output = &deck.output;
    let [_, time_unit, energy_unit] = units(deck);
    let title = deck.spec.title.clone();
    Plan {
        deck: deck.file().to_string(),
        deck_text: deck.text().to_string(),
        dir,
        command: String::new(),
        warnings: vec![],
        understood: deck.describe(),
        sources: deck.sources(),
        rigid: RigidBodies::default(),
        marks: MarkNotes::default(),
        allow_outside,
        output: output.clone(),
        steps,
        increments: deck.increments(),
        every: output.every(steps),
        modes: deck.modes,
        history: output.history.unwrap_or((steps / 100).max(1)),
        series: SeriesOptions {
            points: output.vtu,
            cells: deck.cells.clone(),
            bonds: output.bonds,
            units: deck.units,
            dump: output.dump.as_ref().map(|name| {
                let cell = DumpBox::periodic(deck.corner, deck.spec.space.periodic);
                (name.clone(), cell)
            }),
            pictures,
        },
        space_time: vec![],
        exodus: exodus(deck),
        fields: deck::fields(deck),
        continuum: continuum(deck),
        asked: Asked::default(),
        units: deck.units,
        time_unit: time_unit.to_string(),
        energy_unit: energy_unit.to_string(),
        atoms: deck.spec.potential().map(|_| {
            let (temperature_unit, pressure_unit) = match deck.units {
                UnitSystem::Si => ("K", "Pa"),
                UnitSystem::Metal(_) => ("K", "bar"),
                UnitSystem::Lj | UnitSystem::None => ("", ""),
            };
            AtomsPlan {
                boltzmann: deck.boltzmann(),
                temperature_unit: temperature_unit.to_string(),
                pressure_scale: 1.0 / deck.units.plain_factor(Dim::PRESSURE),
                pressure_unit: pressure_unit.to_string(),
                trajectories: output.trajectories.clone(),
                data: output.data.clone(),
                species: deck.species(),
                ase_velocity: deck.units.ase_velocity(),
                mass_scale: 1.0 / deck.units.plain_factor(Dim::MASS),
                corner: deck.corner,
                periodic: deck.spec.space.periodic,
            }
        }),
        title,
        ranks: 1,
        threads: 1,
    }
}

/// The fields that a deck asks for.
pub fn continuum(deck: &Deck) -> Option<FieldsPlan> {
    (!deck.fields.is_empty()).then(|| FieldsPlan {
        asked: deck.fields.clone(),
        spec: deck.spec.clone(),
        corner: deck.corner,
        units: Units::Deck(deck.units),
        // a signal ends what only looks at once
        stop: || false,
    })
}
