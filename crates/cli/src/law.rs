//! `peridyne run` and `peridyne check` of conservation laws.

use crate::Input;
use crate::deck;
use crate::early::{Early, asked, same_files};
use crate::failure::{Failure, json_text, note, say};
use crate::report;
use crate::signals;
use peridyne_io::conservation::{
    self, LawError, Listener, RunInputs, evaluation_name, method_name,
};
use peridyne_io::deck::conservation::LawDeck;
use peridyne_io::deck::{Dim, counted, rounded};
use peridyne_io::excerpt::one_line;
use peridyne_io::write::checkpoint::Checkpoint;
use peridyne_transport::{RunError, StepSize, Stop, exact, measure};
use serde_json::json;
use std::path::Path;
use std::time::{Duration, Instant};

/// Between lines about progress.
const INTERVAL: Duration = Duration::from_secs(5);
/// Time spent on trial steps.
const TRIAL: Duration = Duration::from_millis(300);
/// Of an addition or a product in long sums on one thread, where numbers wait for nothing (s).
const OPERATION: f64 = 3e-11;
/// Longest that `check` waits for a trial step.
const LONGEST: Duration = Duration::from_secs(5);

/// The law, if the deck is one of a law.
pub fn read(input: &Input) -> Result<Option<LawDeck>, Failure> {
    let text = deck::text(input)?;
    if !LawDeck::is_one(&text, &input.set) {
        return Ok(None);
    }
    deck::no_variables(input)?;
    if input.simd.is_some() {
        return Err(Failure::input(
            "--simd belongs to bodies: a conservation law takes the widest instruction set, and gives bitwise the same results on all",
        ));
    }
    let name = input.name();
    let read = LawDeck::parse(&text, &name, &input.set);
    Ok(Some(read.map_err(|e| Failure::Input(e.into()))?))
}

struct Terminal {
    begun: Instant,
    spoken: Instant,
    steps: u64,
    early: Early,
}

impl Listener for Terminal {
    fn step(&mut self, part: f64, steps: u64) {
        self.steps = steps;
        if self.spoken.elapsed() >= INTERVAL {
            self.spoken = Instant::now();
            note(&format!("{:.1} % of the time, step {steps}", 100.0 * part));
        }
    }

    fn ended(&mut self) -> Option<String> {
        let signal = signals::received().map(|s| s.to_string());
        signal.or_else(|| self.early.reached(self.steps, self.begun))
    }

    fn wants_checkpoint(&mut self) -> bool {
        signals::asked_for_checkpoint()
    }

    fn warning(&mut self, text: &str) {
        note(&format!("warning: {text}"));
    }
}

/// What is run, where its results go, and when it ends.
pub struct Place<'a> {
    pub input: &'a Input,
    pub out: Option<&'a Path>,
    pub allow_outside: bool,
    pub early: &'a Early,
}

/// Runs the law of a deck, or goes on with it; results go to where the arguments say, else to where the deck does.
pub fn run(place: &Place<'_>, mut deck: LawDeck, from: Option<Checkpoint>) -> Result<(), Failure> {
    let (input, out) = (place.input, place.out);
    if !place.allow_outside && out.is_none() {
        deck.stays_inside().map_err(|e| Failure::Input(e.into()))?;
    }
    let dir = out.map(Path::to_path_buf).or(deck.dir.clone());
    let dir = dir.unwrap_or_else(|| input.default_dir());
    let name = deck.file().to_string();
    let (command, text) = (deck::command(input), deck.text().to_string());
    let mut told = RunInputs {
        asked: asked(input, [command.clone(), name, text]),
        command,
        understood: headline(&deck),
    };
    if let Some(from) = &from {
        same_files(&from.asked.files, &told.asked.files)?;
        // records are those of the run that began
        told.command.clone_from(&from.asked.command);
        told.asked.command.clone_from(&from.asked.command);
        told.asked.name.clone_from(&from.asked.name);
    }
    say(&(told.understood.clone() + &deck::remarks(&[], &deck.warnings)));
    say(&format!("results in {}", dir.display()));
    let mut terminal = Terminal {
        begun: Instant::now(),
        spoken: Instant::now(),
        steps: from.as_ref().map_or(0, |f| f.asked.step),
        early: place.early.clone(),
    };
    let asked = Stop::new(|| signals::received().is_some());
    deck.evolution.operator.stop_when(asked);
    let done = conservation::run(&mut deck, &dir, told, &mut terminal, from);
    let done = done.map_err(|e| match e {
        LawError::Resume(e) => Failure::input(e.to_string()),
        LawError::Write(_) | LawError::Report(_) | LawError::Run { .. } => {
            Failure::Run(e.to_string())
        }
    })?;
    say(&format!(
        "{}: {} in {:.2} s{}",
        done.outcome(),
        counted(done.steps, "step"),
        done.seconds_stepping,
        done.ns_per_point_step.map_or(String::new(), |ns| format!(
            ", {ns:.1} ns per point and step"
        )),
    ));
    if let Some(error) = done.time_error {
        let show = |e: f64| deck.units.show(e, deck.dimension);
        let allowed = match done.time_error_allowed {
            Some(allowed) => format!("; {} are allowed", show(allowed)),
            None => String::new(),
        };
        say(&format!(
            "error     of u by steps, estimated: {} at most{allowed}",
            show(error)
        ));
    }
    if let Some(compared) = done.compared {
        let [mean, square, most] = compared.errors().map(|e| rounded(e, 3));
        say(&format!(
            "compared  with the local law ({}) at t = {}: u is off by {mean} of it in the mean (L1), {square} in the mean square (L2), {most} at most",
            compared.with,
            deck.units.show(compared.time, Dim::TIME)
        ));
    }
    for warning in &done.warnings[deck.warnings.len()..] {
        note(&format!("warning: {warning}"));
    }
    if deck.report {
        say(&report::line(&dir));
    }
    say(&report::state(done.hash));
    if done.ended_by.is_some() {
        say(&format!("go on:    peridyne resume {}", dir.display()));
    }
    match signals::received() {
        Some(signal) if done.ended_by.is_some() => Err(Failure::Ended(signal)),
        _ => Ok(()),
    }
}

/// What the deck makes, in a few lines.
fn headline(deck: &LawDeck) -> String {
    let e = &deck.evolution;
    let (law, grid) = (e.operator.law(), deck.grid());
    let length = |x: f64| deck.units.show(x, Dim::LENGTH);
    let time = |t: f64| deck.units.show(t, Dim::TIME);
    let mut text = match deck.title.as_str() {
        "" => String::new(),
        title => format!("{}\n", one_line(title)),
    };
    text += &format!(
        "points    {} in {}-D, spacing {}, {}\n",
        grid.points(),
        grid.dimension,
        length(grid.spacing),
        if law.periodic() {
            "periodic"
        } else {
            "collars"
        },
    );
    let names = ["transport", "diffusion"];
    for ((name, horizon), bonds) in names.iter().zip(deck.horizons).zip(law.bonds()) {
        if let Some(horizon) = horizon {
            let ratio = horizon / grid.spacing;
            text += &format!(
                "{name} horizon {} = {} spacings, {bonds} bonds of a point\n",
                length(horizon),
                rounded(ratio, 4)
            );
        }
    }
    text += &format!(
        "sums      {}, step by {}, stable up to {} at the start{}",
        evaluation_name(e.operator.evaluation()),
        method_name(e.method()),
        time(e.stable_step()),
        match e.size() {
            StepSize::Within { tolerance, .. } => format!(
                "; they may add {} of the largest |u|",
                rounded(tolerance, 3)
            ),
            StepSize::Part(_) | StepSize::Fixed { .. } => String::new(),
        }
    );
    // what is wrong with a step the run says
    if let Ok([steps, operations]) = e.work(deck.duration) {
        text += &format!(
            "\nwork      at least {steps:.0} steps until {}, {} s of one thread",
            time(deck.duration),
            rounded(operations * OPERATION, 2),
        );
    }
    if let Some(t) = shock_time(deck) {
        text += &format!(
            "\nshock     of the local law without diffusion at t = {}",
            time(t)
        );
    }
    if let Some(reference) = &deck.reference {
        text += &format!(
            "\ncompares  with the solution of the local law ({})",
            reference.solution().name()
        );
    }
    text
}

/// When characteristics of the local law cross; on a line only.
fn shock_time(deck: &LawDeck) -> Option<f64> {
    let e = &deck.evolution;
    let law = e.operator.law();
    exact::shock_time(
        &law.local_flux()?,
        &e.u,
        deck.grid().spacing,
        law.periodic(),
    )
}

pub fn check(mut deck: LawDeck, json: bool, outside: bool) -> Result<(), Failure> {
    if !outside {
        deck.stays_inside().map_err(|e| Failure::Input(e.into()))?;
    }
    let remarks = deck::remarks(&[], &deck.warnings);
    if !remarks.is_empty() {
        note(remarks.trim_start());
    }
    let grid = *deck.grid();
    let begin = Instant::now();
    let late = Stop::new(move || begin.elapsed() >= LONGEST);
    let e = &mut deck.evolution;
    e.operator.stop_when(late);
    let [low, high] = measure::extremes(&e.u);
    let (mass, energy) = (
        measure::mass(&e.u, grid.cell()),
        measure::energy(&e.u, grid.cell()),
    );
    let energy_rate = e.operator.energy_rate(&e.u, 0.0);
    let energy_rate = (!e.operator.stopped()).then_some(energy_rate);
    let stable = e.stable_step();
    let [waves, decay] = e.operator.spectrum();
    let step = e.next_step(deck.duration);
    let step = step.map_err(|e| Failure::input(format!("{}: {e}", deck.file())))?;
    let head = headline(&deck);
    let shock = shock_time(&deck);
    let e = &mut deck.evolution;
    e.estimate();
    let begin = Instant::now();
    let late = Stop::new(move || begin.elapsed() >= LONGEST);
    e.operator.stop_when(late);
    let mut failed = None;
    while begin.elapsed() < TRIAL && failed.is_none() && e.time < deck.duration * (1.0 - 1e-12) {
        failed = match e.step_to(deck.duration) {
            Err(RunError::Ended { .. }) => {
                Some(format!("a step takes longer than {} s", LONGEST.as_secs()))
            }
            done => done.err().map(|e| e.to_string()),
        };
    }
    let steps = e.steps;
    // of none it is known that one takes longer
    let per_step = begin.elapsed().as_secs_f64() / steps.max(1) as f64;
    let least = if steps == 0 { "more than " } else { "" };
    let all = match steps {
        0 => (deck.duration / step).ceil(),
        _ => (steps as f64 * deck.duration / e.time).ceil(),
    };
    if json {
        let warnings = deck
            .warnings
            .iter()
            .map(|w| json!({"what": w, "fix": null}));
        let text = json!({
            "kind": "conservation_law", "title": deck.title, "points": grid.points(), "dimension": grid.dimension, "spacing": grid.spacing,
            "horizons": deck.horizons, "bonds_of_a_point": deck.evolution.operator.law().bonds(),
            "evaluation": evaluation_name(deck.evolution.operator.evaluation()), "method": method_name(deck.evolution.method()),
            "wave_frequency_at_unit_speed": waves, "decay_rate": decay, "stable_step": stable, "first_step": step, "steps": all,
            "shock_time": shock, "min": low, "max": high, "mass": mass, "energy": energy, "energy_rate_exact": energy_rate,
            "seconds_per_step": (steps > 0).then_some(per_step), "trial_failed": failed,
            "warnings": warnings.collect::<Vec<_>>(),
        });
        say(&json_text(&text));
        return Ok(());
    }
    say(&head);
    let show = |x: f64, dim: Dim| deck.units.show(x, dim);
    let u = deck.dimension;
    let cell = [Dim::LENGTH, Dim::AREA][grid.dimension - 1];
    say(&format!(
        "state     u from {} to {}, mass {}, energy {}, its rate {}\n\
         spectrum  waves {} at unit speed, decay {}\n\
         steps     about {all:.0} of {}; {least}{:.1} ns per point and step, {least}{:.1} s in all",
        show(low, u),
        show(high, u),
        show(mass, u * cell),
        show(energy, u * u * cell),
        energy_rate.map_or("not known".into(), |rate| show(
            rate,
            u * u * cell / Dim::TIME
        )),
        show(waves, Dim::INVERSE_LENGTH),
        show(decay, Dim::FREQUENCY),
        deck.units.show(step, Dim::TIME),
        per_step * 1e9 / grid.points() as f64,
        per_step * all,
    ));
    if let Some(failed) = failed {
        note(&format!(
            "warning: a trial of {steps} steps ended: {failed}"
        ));
    }
    Ok(())
}
