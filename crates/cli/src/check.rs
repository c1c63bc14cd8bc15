//! `peridyne check`: what would run, what the body really is, and what it costs.

mod advice;
mod atoms;
mod continuum;
mod directions;
mod json;
mod report;
mod ties;

use crate::Input;
use crate::deck;
use crate::enough::enough;
use crate::failure::{Failure, note, printed, say};
use crate::law;
use crate::run::{pictures, space_time, until, with_threads};
use crate::script;
use peridyne::law::micromodulus::Moments;
use peridyne::run::{Families, Info, Options, Simulation, build};
use peridyne::space::Point;
use peridyne::spec::{BodySpec, Criterion, Moduli, Spec};
use peridyne_io::continuum::run::FieldsPlan;
use peridyne_io::deck::{Deck, UnitSystem};
use peridyne_theory::fracture::{Body, energy_per_stretch_squared};
use peridyne_theory::nominal::nominal_moduli;
use peridyne_theory::patch_test::{PatchTest, patch_test};
use peridyne_theory::upscale::lattice;
use peridyne_theory::voigt::{Stiffness, components};
use std::time::{Duration, Instant};

/// Time spent on trial steps.
const TRIAL: Duration = Duration::from_millis(500);
/// Time after which a trial step that has not ended is left alone, and what is known is told.
const LONGEST_TRIAL: Duration = Duration::from_secs(4);
/// The same of the patch test.
const LONGEST_PATCH: Duration = Duration::from_secs(20);
/// Visits of bonds by the patch test above which it takes minutes.
const PATIENCE: u64 = 50_000_000_000;
/// Above which it takes more than some seconds.
const QUICK: u64 = 5_000_000_000;

#[derive(clap::Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub input: Input,
    /// Print JSON instead of a table; numbers are in the units of the run.
    #[arg(long)]
    pub json: bool,
    /// As for `run`: the deck or script may name files outside the folder of the results. `check` itself writes none.
    #[arg(long)]
    pub allow_outside: bool,
    /// Threads for the trial steps; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
}

/// Everything that `check` finds, in the units of the run.
#[derive(Clone)]
struct Findings<'a> {
    spec: &'a Spec,
    units: UnitSystem,
    /// Is it a LAMMPS script? Fixes are then not told: they are keys of decks.
    script: bool,
    /// Of the deck.
    warnings: &'a [String],
    info: Info,
    families: Families,
    /// Smallest and largest coordinate of the points.
    low: [f64; 3],
    high: [f64; 3],
    /// How far the cell of a point reaches beyond it along each axis.
    half: [f64; 3],
    /// `None`: the body is too large for one.
    patch: Option<PatchTest>,
    /// What there was no time for.
    untried: Option<String>,
    materials: Vec<Material>,
    /// Of motion, or increments of statics alone.
    steps: u64,
    /// Of statics before motion.
    increments: u64,
    trial: Trial,
    threads: usize,
    /// Continuum fields that the deck asks for.
    fields: Vec<continuum::Found>,
    /// Points of each rigid_body that two of its sides push alike.
    ties: Vec<usize>,
}

impl Findings<'_> {
    /// Along which axes is the body thinner than the horizon?
    fn thin(&self) -> [bool; 3] {
        std::array::from_fn(|a| {
            self.spec.space.periodic[a].is_none() && self.long(a) < self.info.horizon * (1.0 - 1e-9)
        })
    }

    /// Ends of the body with its cells, no round-off where one is at 0.
    fn extent(&self, a: usize) -> [f64; 2] {
        let whole = 1e-9 * self.long(a);
        [self.low[a] - self.half[a], self.high[a] + self.half[a]]
            .map(|x| if x.abs() < whole { 0.0 } else { x })
    }

    /// Length of the body with its cells.
    fn long(&self, a: usize) -> f64 {
        self.high[a] - self.low[a] + 2.0 * self.half[a]
    }

    /// By the patch test.
    fn examine(&mut self, subject: &Subject, sim: &mut dyn Simulation) {
        self.patch = Some(patch_test(sim, lattice(&subject.spec).ok()));
        self.materials = materials(&subject.spec, &self.info, self.patch.as_ref(), self.thin());
    }

    /// Seconds of statics before motion.
    fn load(&self) -> f64 {
        { self.trial.seconds_per_increment }.map_or(0.0, |s| s * self.increments as f64)
    }
}

/// One material beside what the deck asked for.
#[derive(Clone)]
struct Material {
    name: String,
    density: f64,
    nominal: Option<Moduli>,
    /// Speeds of long pressure and shear waves (length / time); no shear waves in 1-D.
    pressure_wave: f64,
    shear_wave: Option<f64>,
    /// Critical stretch and fracture energy (energy / area), if it breaks; the energy if a formula is known.
    fracture: Option<(f64, Option<f64>)>,
}

/// Steps taken to see how long one takes.
#[derive(Clone, Default)]
struct Trial {
    steps: u64,
    seconds_per_step: Option<f64>,
    /// Of statics before motion.
    seconds_per_increment: Option<f64>,
    /// Why the trial ended early.
    failed: Option<String>,
}

/// What is checked, whatever file it comes from.
struct Subject {
    spec: Spec,
    units: UnitSystem,
    script: bool,
    /// Of the deck, said already.
    warnings: Vec<String>,
    steps: u64,
    increments: u64,
    fields: Option<FieldsPlan>,
}

impl Subject {
    fn of_deck(deck: &Deck, warnings: Vec<String>, info: &Info) -> Subject {
        Subject {
            steps: deck.steps(info.time_step) - deck.increments(),
            increments: deck.increments(),
            fields: crate::run::continuum(deck),
            units: deck.units,
            spec: deck.spec.clone(),
            script: false,
            warnings,
        }
    }
}

pub fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let input = &arguments.input;
    if !deck::is_deck(input) {
        return with_threads(arguments.threads, |threads| {
            let (mut prepared, setup) = script::prepare(input)?;
            let subject = Subject {
                spec: prepared.spec,
                units: setup.units.system(),
                script: true,
                warnings: vec![],
                steps: setup.steps,
                increments: 0,
                fields: None,
            };
            report(arguments, &subject, prepared.simulation.as_mut(), threads)
        });
    }
    if let Some(deck) = law::read(input)? {
        return law::check(deck, arguments.json, arguments.allow_outside);
    }
    let deck = deck::read(input)?;
    if !arguments.allow_outside {
        deck.stays_inside(false)
            .map_err(|e| Failure::Input(e.into()))?;
    }
    let threads = arguments.threads.or(deck.threads);
    with_threads(threads, |threads| {
        let mut sim = deck::model(&deck, input)?;
        pictures(&deck, sim.as_mut())?;
        space_time(&deck, sim.as_mut())?;
        let warnings = deck::warnings(&deck, sim.info());
        let remarks = deck::remarks(&deck.notes, &warnings);
        if !remarks.is_empty() {
            note(remarks.trim_start());
        }
        let dir = deck.output.dir.clone();
        let dir = dir.unwrap_or_else(|| input.default_dir());
        enough(&deck, sim.as_mut(), &dir)?;
        let subject = Subject::of_deck(&deck, warnings, sim.info());
        report(arguments, &subject, sim.as_mut(), threads)
    })
}

/// What `peridyne check --json` says of a deck, but for the patch test where it takes long. Called on as many threads.
///
/// # Errors
/// The deck is wrong, or the machine has not enough memory.
pub fn checked(deck: &Deck, threads: usize) -> Result<serde_json::Value, Failure> {
    let made = build(&deck.spec, Options::default());
    let mut sim = made.map_err(|e| Failure::Input(deck.explain(&e).into()))?;
    pictures(deck, sim.as_mut())?;
    space_time(deck, sim.as_mut())?;
    let dir = deck.output.dir.clone().unwrap_or_default();
    enough(deck, sim.as_mut(), &dir)?;
    let subject = Subject::of_deck(deck, deck::warnings(deck, sim.info()), sim.info());
    let reference = sim.vectors("reference");
    let (info, families) = (sim.info().clone(), sim.families());
    let mut found = find(&subject, info, families, &reference, threads);
    if let Some(plan) = &subject.fields {
        found.fields = continuum::find(sim.as_mut(), plan, subject.steps, deck.file())?;
    }
    if visits(sim.as_ref(), &subject.spec) < QUICK {
        found.examine(&subject, sim.as_mut());
    }
    found.trial = trial(sim.as_mut(), subject.steps, subject.increments);
    Ok(json::of(&found))
}

fn report(
    arguments: &CheckArguments,
    subject: &Subject,
    sim: &mut dyn Simulation,
    threads: usize,
) -> Result<(), Failure> {
    let reference = sim.vectors("reference");
    let mut found = find(
        subject,
        sim.info().clone(),
        sim.families(),
        &reference,
        threads,
    );
    if !arguments.json {
        say(&report::first(&found));
    }
    if let Some(plan) = &subject.fields {
        found.fields = continuum::find(sim, plan, subject.steps, &arguments.input.name())?;
    }
    let ends = |found: &Findings, why: String| {
        let told = Findings {
            untried: Some(why),
            ..found.clone()
        };
        say(&rest(arguments, &told));
        // nothing is held that anybody waits for
        std::process::exit(match printed() {
            Ok(()) => 0,
            Err(_) => 1,
        })
    };
    let late = |limit: Duration, what: &str| {
        format!(
            "{what} was not done in {} s, and is left out",
            limit.as_secs()
        )
    };
    if visits(sim, &subject.spec) < PATIENCE {
        let late = late(
            LONGEST_PATCH,
            "the patch test (stiffness by place), and so a trial step,",
        );
        let mut examined = found.clone();
        let work = || examined.examine(subject, sim);
        within(LONGEST_PATCH, || ends(&found, late), work);
        found = examined;
    }
    let what = match (subject.increments > 0, subject.spec.run.schedule.statics()) {
        (false, None) => "a trial step",
        _ => "a trial increment of load",
    };
    let late = late(LONGEST_TRIAL, what);
    let work = || trial(sim, subject.steps, subject.increments);
    found.trial = within(LONGEST_TRIAL, || ends(&found, late), work);
    say(&rest(arguments, &found));
    Ok(())
}

/// What is still to be said.
fn rest(arguments: &CheckArguments, found: &Findings) -> String {
    match arguments.json {
        true => json::write(found),
        false => report::rest(found),
    }
}

/// Does `work`, beside a watch that is told when it takes longer than it may.
fn within<T>(limit: Duration, late: impl FnOnce() + Send, work: impl FnOnce() -> T) -> T {
    let (done, wait) = std::sync::mpsc::channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            if wait.recv_timeout(limit) == Err(std::sync::mpsc::RecvTimeoutError::Timeout) {
                late();
            }
        });
        let out = work();
        drop(done);
        out
    })
}

/// Visits of bonds by the patch test: strains and rotations, and of linear bodies all gradients.
fn visits(sim: &dyn Simulation, spec: &Spec) -> u64 {
    let axis = sim.info().dimension.clamp(1, 3) - 1;
    let more = match spec.micromoduli() {
        Some(_) => [0, 10, 45][axis],
        None => 0,
    };
    let passes = [3, 9, 26][axis] + more;
    sim.info().directed_bonds.saturating_mul(passes)
}

fn find<'a>(
    subject: &'a Subject,
    info: Info,
    families: Families,
    reference: &[Point],
    threads: usize,
) -> Findings<'a> {
    let bound = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
        std::array::from_fn(|a| reference.iter().map(|x| x[a]).fold(start, pick))
    };
    let mut found = Findings {
        low: bound(f64::min, f64::INFINITY),
        high: bound(f64::max, f64::NEG_INFINITY),
        half: half(&subject.spec, info.spacing),
        materials: vec![],
        steps: subject.steps,
        increments: subject.increments,
        spec: &subject.spec,
        units: subject.units,
        script: subject.script,
        warnings: &subject.warnings,
        info,
        families,
        patch: None,
        untried: None,
        trial: Trial::default(),
        threads,
        fields: vec![],
        ties: vec![],
    };
    let until = until(found.spec, found.steps, found.info.time_step);
    found.ties = ties::ties(found.spec, reference, found.info.spacing, until);
    found.materials = materials(&subject.spec, &found.info, None, found.thin());
    found
}

/// How far cells reach beyond their points along each axis: half the distance of the planes of a lattice; atoms have no cells, and a body
/// whose surface is exact ends at its points.
fn half(spec: &Spec, spacing: f64) -> [f64; 3] {
    let exact = spec
        .bonds
        .surface
        .as_ref()
        .is_some_and(|f| f.part.iter().any(|p| *p != 1.0));
    if spec.potential().is_some() || exact {
        return [0.0; 3];
    }
    match &spec.body {
        BodySpec::Lattice {
            kind,
            spacing,
            perturb: None,
            ..
        }
        | BodySpec::Sites { kind, spacing, .. } => {
            std::array::from_fn(|a| 0.5 * spacing * kind.edges()[a] / f64::from(kind.planes(a)))
        }
        BodySpec::Lattice { .. } | BodySpec::Cloud(_) | BodySpec::Several(_) => [0.5 * spacing; 3],
    }
}

/// The isotropic mean of a stiffness as the solid's moduli; not numbers where bars along the axes differ so much that a mean of
/// all directions says nothing.
fn mean(found: &Findings, stiffness: &Stiffness) -> Moduli {
    let d = stiffness.dimension;
    match d == 1 || stiffness.is_even() {
        true => stiffness.hill().solid(d, found.spec.space.plane),
        false => Moduli {
            young: f64::NAN,
            poisson: f64::NAN,
        },
    }
}

/// Moduli of long pressure and shear waves (pressure): of an even solid `K + 2G(D − 1)/D`, in 1-D the bar's E, and G; else the
/// largest along the axes and planes of the body, sides free across the thin ones.
fn waves(stiffness: &Stiffness, thin: [bool; 3]) -> (f64, f64) {
    let d = stiffness.dimension;
    if d == 1 || stiffness.is_even() {
        let m = stiffness.hill();
        let pressure = m.bulk + 2.0 * m.shear * (d as f64 - 1.0) / d as f64;
        return (pressure, m.shear);
    }
    let freed = stiffness.freed(&thin[..d]);
    let most = |range: std::ops::Range<usize>| range.map(|i| freed.c[i][i]).fold(0.0, f64::max);
    (most(0..d), most(d..components(d)))
}

fn materials(
    spec: &Spec,
    info: &Info,
    patch: Option<&PatchTest>,
    thin: [bool; 3],
) -> Vec<Material> {
    let d = info.dimension;
    let each = spec.materials.iter().enumerate().map(|(n, m)| {
        let of_all = (info.horizon, spec.bonds.influence);
        let (horizon, influence) = info.families.get(n).copied().unwrap_or(of_all);
        let moments = Moments::continuum(d, horizon, spec.space.section, influence);
        let body = Body {
            dimension: d,
            plane: spec.space.plane,
            horizon,
            influence,
            moments,
        };
        let nominal = nominal_moduli(&m.law, d, spec.space.plane, moments);
        let s00 = info.critical_stretch.get(n).copied();
        let (pressure, shear) = match patch.and_then(|p| p.best(n)) {
            Some((_, stiffness)) => waves(stiffness, thin),
            None => (f64::NAN, f64::NAN),
        };
        Material {
            name: m.name.clone(),
            density: m.density,
            nominal,
            pressure_wave: (pressure / m.density).sqrt(),
            shear_wave: (d > 1).then(|| (shear / m.density).sqrt()),
            fracture: s00.filter(|s| s.is_finite()).map(|s| {
                let energy = match m.fracture.map(|f| f.criterion) {
                    Some(Criterion::Energy(energy)) => Some(energy),
                    _ => {
                        energy_per_stretch_squared(&m.law, info.micromodulus.get(n).copied(), body)
                            .map(|e| e * s * s)
                    }
                };
                (s, energy)
            }),
        }
    });
    each.collect()
}

/// No further than the run goes: what would happen after its end is nobody's business.
fn trial(sim: &mut dyn Simulation, most: u64, increments: u64) -> Trial {
    sim.start(true);
    let (loads, failed) = tried(sim, increments);
    let all = loads.map_or(0, |(n, _)| n) == increments;
    let (steps, failed) = match failed {
        None if all => tried(sim, most.max(1)),
        failed => (None, failed),
    };
    let each = |(n, seconds): (u64, f64)| seconds / n as f64;
    Trial {
        steps: steps.map_or(0, |(n, _)| n),
        seconds_per_step: steps.map(each),
        seconds_per_increment: loads.map(each),
        failed,
    }
}

/// At most so many steps, no longer than a trial lasts: how many, in how many seconds, and what ended them early.
fn tried(sim: &mut dyn Simulation, most: u64) -> (Option<(u64, f64)>, Option<String>) {
    let begin = Instant::now();
    let (mut steps, mut failed) = (0, None);
    while steps < most && begin.elapsed() < TRIAL {
        if let Err(error) = sim.step() {
            failed = Some(error.to_string());
            break;
        }
        steps += 1;
    }
    let seconds = begin.elapsed().as_secs_f64();
    ((steps > 0).then_some((steps, seconds)), failed)
}
