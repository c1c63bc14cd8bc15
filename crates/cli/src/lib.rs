//! The peridyne program, as a library: each verb is a function of its arguments. The program and the Python module call it.

// the same bits on every machine: libm, not that of C (clippy.toml)
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod bar;
mod calibrate;
mod check;
mod coarsen;
mod converge;
mod convert;
mod deck;
mod doc;
mod early;
mod enough;
mod failure;
mod fields;
mod keys;
mod law;
mod laws;
mod new;
mod numbers;
mod pager;
mod plan;
mod progress;
mod ranks;
mod report;
mod reproduce;
mod resume;
mod run;
pub mod runs;
mod script;
mod shell;
mod side_by_side;
mod signals;
mod study;
mod sweep;
mod upscale;
mod verbs;
mod waves;

use clap::{FromArgMatches, Parser, Subcommand};
pub use failure::Failure;
use peridyne_io::excerpt::steers;
use std::ffi::OsString;
use std::path::PathBuf;

/// Peridynamics and molecular dynamics: points that interact with those within a horizon.
#[derive(Parser)]
#[command(name = "peridyne", version = env!("PERIDYNE_VERSION"), max_term_width = 100, subcommand_value_name = "VERB")]
struct Arguments {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Write a commented deck to begin with: a crack, a wave, an impact, statics, atoms, …
    New(new::NewArguments),
    /// Run a deck (TOML) or a LAMMPS input script.
    Run(run::RunArguments),
    /// Go on with a run that ended before its last step, bit for bit.
    Resume(resume::ResumeArguments),
    /// Say what a deck would run: points, bonds, effective moduli, stable step, memory, warnings.
    Check(check::CheckArguments),
    /// From atoms (or fine points) to coarse peridynamic points: decks of both, and an error card.
    Upscale(upscale::UpscaleArguments),
    /// From a linear body to coarser ones, level by level, alike in equilibrium and (`--mass`) in long waves.
    Coarsen(coarsen::CoarsenArguments),
    /// Waves of a lattice deck: dispersion, stability, elastic constants, gradient coefficients.
    Waves(waves::WavesArguments),
    /// Refine a lattice deck level by level, and fit the order with which its error falls.
    Converge(converge::ConvergeArguments),
    /// Run a deck with many values of its keys: each with each, in lists, or a Latin hypercube; one table of results.
    Sweep(Box<sweep::SweepArguments>),
    /// Fit keys of a deck to a measured curve, between bounds, with uncertainties.
    Calibrate(Box<calibrate::CalibrateArguments>),
    /// Convert a deck of Peridigm (YAML, XML) or PeriLab (YAML); what has no counterpart is named line by line.
    Convert(convert::ConvertArguments),
    /// Continuum fields from the particles of a trajectory: stress, heat flux and their balance laws.
    Fields(Box<fields::FieldsArguments>),
    /// A peristatic bar pulled at its ends: stiffness, homogenization factors, elongation as a fraction and its limit.
    Bar(bar::BarArguments),
    /// Make report.html of a folder of results: the run in one file for browsers, without network.
    Report(report::ReportArguments),
    /// Run the experiments of the papers and compare with what was published.
    Reproduce(reproduce::ReproduceArguments),
    /// Check MPI under a launcher: which library is found, whether messages between ranks are right, and how fast.
    Ranks(ranks::RanksArguments),
    /// Estimate the time and memory of a deck on many machines from a few steps here.
    Plan(plan::PlanArguments),
    /// List the laws, lattices and influence functions, or explain a law by its name: keys, units, bounds, a deck.
    Laws(laws::LawsArguments),
    /// Explain a key, a table, a law or a field of decks.
    Doc(doc::DocArguments),
    /// Print the JSON schema of decks, for editors.
    Schema(SchemaArguments),
    /// Print completions for a shell: `peridyne completions bash > ~/.local/share/bash-completion/completions/peridyne`.
    Completions(shell::CompletionsArguments),
    /// Print a manual page, `peridyne man run | man -l -`, or write all: `peridyne man --out DIR`.
    Man(shell::ManArguments),
}

#[derive(clap::Args)]
struct SchemaArguments {
    /// Of decks of this kind; of bodies if not given.
    #[arg(long)]
    kind: Option<DeckKind>,
}

/// What a deck says of itself by `kind`.
#[derive(Clone, Copy, clap::ValueEnum)]
#[value(rename_all = "snake_case")]
enum DeckKind {
    ConservationLaw,
    /// A file of `peridyne fields`: it has no key `kind`.
    Fields,
}

/// What `run` and `check` both take.
#[derive(clap::Args, Clone)]
pub struct Input {
    /// Deck (`.toml`; `-`: from standard input) or LAMMPS input script (any other name).
    pub file: PathBuf,
    /// Override a key of the deck, e.g. `--set run.steps=100`; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = pair)]
    pub set: Vec<(String, String)>,
    /// Set a variable of the LAMMPS script, e.g. `--var steps=100`; may be repeated.
    #[arg(long = "var", value_name = "NAME=VALUE", value_parser = pair)]
    pub var: Vec<(String, String)>,
    /// Instruction set: portable, avx2 or avx512; the widest of this machine if not given. Results do not depend on it.
    #[arg(long)]
    pub simd: Option<String>,
}

fn pair(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() => {
            Ok((key.trim().to_string(), value.trim().to_string()))
        }
        _ => Err(format!("`{text}` is not of the form key=value")),
    }
}

/// The program with these words, the first of which is its name; its exit code.
pub fn program(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<OsString> = words.into_iter().collect();
    let matches = verbs::command().try_get_matches_from(&words);
    let arguments = match matches.and_then(|m| Arguments::from_arg_matches(&m)) {
        Ok(arguments) => arguments,
        Err(answer) => return answered(&answer, &words),
    };
    if let Err(e) = signals::listen() {
        return Failure::Run(format!("signals cannot be listened to: {e}")).report();
    }
    // a program in Python gives several commands
    deck::pipe(None);
    let outcome = match arguments.verb {
        Verb::New(arguments) => new::new(&arguments),
        Verb::Run(arguments) => run::run(&arguments),
        Verb::Resume(arguments) => resume::resume(&arguments),
        Verb::Check(arguments) => check::check(&arguments),
        Verb::Upscale(arguments) => upscale::upscale(&arguments),
        Verb::Coarsen(arguments) => coarsen::coarsen(&arguments),
        Verb::Waves(arguments) => waves::waves(&arguments),
        Verb::Converge(arguments) => converge::converge(&arguments),
        Verb::Sweep(arguments) => sweep::sweep(&arguments),
        Verb::Calibrate(arguments) => calibrate::calibrate(&arguments),
        Verb::Convert(arguments) => convert::convert(&arguments),
        Verb::Fields(arguments) => fields::fields(&arguments),
        Verb::Bar(arguments) => bar::bar(&arguments),
        Verb::Report(arguments) => report::report(&arguments),
        Verb::Reproduce(arguments) => reproduce::reproduce(&arguments),
        Verb::Ranks(arguments) => ranks::ranks(&arguments),
        Verb::Plan(arguments) => plan::plan(&arguments),
        Verb::Laws(arguments) => laws::laws(&arguments),
        Verb::Doc(arguments) => doc::doc(&arguments),
        Verb::Schema(arguments) => print_schema(arguments.kind),
        Verb::Completions(arguments) => {
            shell::completions(&arguments, verbs::command());
            Ok(())
        }
        Verb::Man(arguments) => shell::man(&arguments, &verbs::command()),
    };
    match outcome.and_then(|()| failure::printed()) {
        Ok(()) => 0,
        Err(failure) => failure.report(),
    }
}

/// Help or the version were asked for, or the command line is wrong.
fn answered(answer: &clap::Error, words: &[OsString]) -> u8 {
    if let Some(why) = verbs::mistaken(answer, words) {
        return Failure::input(why).report();
    }
    if answer.use_stderr() {
        let odd = |word: &OsString| word.to_string_lossy().chars().any(steers);
        match words.iter().any(odd) {
            true => failure::note(answer.render().to_string().trim_end()),
            // clap knows how to colour it; nobody can be told if standard error is closed
            false => drop(answer.print()),
        }
        return 2;
    }
    // not clap's own printing, which forgets that the disk is full
    failure::say(answer.render().to_string().trim_end());
    match failure::printed() {
        Ok(()) => 0,
        Err(failure) => failure.report(),
    }
}

fn print_schema(kind: Option<DeckKind>) -> Result<(), Failure> {
    let schema = match kind {
        None => peridyne_io::deck::schema(),
        Some(DeckKind::ConservationLaw) => peridyne_io::deck::law_schema(),
        Some(DeckKind::Fields) => fields::schema(),
    };
    failure::say(&failure::json_text(&schema));
    Ok(())
}
