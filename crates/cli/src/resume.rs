//! `peridyne resume`.

use crate::Input;
use crate::deck;
use crate::early::{Early, same_files};
use crate::failure::{Failure, note};
use crate::law;
use crate::ranks::{agreed, by_the_first, share_as_before, shared, threads_here};
use crate::run::{Begin, RunArguments, run_deck, with_threads};
use crate::script;
use peridyne_comm::Comm;
use peridyne_io::read::source;
use peridyne_io::write::checkpoint::{Asked, Checkpoint};
use std::path::PathBuf;
use std::sync::Arc;
use toml::{Table, Value};

#[derive(clap::Args)]
pub struct ResumeArguments {
    /// Folder of the results of a run that was ended before its last step.
    pub dir: PathBuf,
    /// Threads; those of the deck, else all cores, if not given. Results do not depend on it.
    #[arg(long)]
    pub threads: Option<usize>,
    /// So many threads of one process as ranks, without a launcher.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub on_threads: Option<u16>,
    /// Let the deck write outside the folder of the results.
    #[arg(long)]
    pub allow_outside: bool,
    /// Instruction set: portable, avx2 or avx512; the widest of this machine if not given. Results do not depend on it.
    #[arg(long)]
    pub simd: Option<String>,
    /// Begin anew with this deck, at time 0 and with accounts of its own, from the displacements, velocities and bonds of the state.
    #[arg(long, value_name = "DECK", requires = "out")]
    pub as_initial: Option<PathBuf>,
    /// Folder for the results of a run that begins anew.
    #[arg(long, requires = "as_initial")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub early: Early,
}

/// Keys that may be others than when the run began: how long it goes on, and how often states are written.
const MAY_CHANGE: [&str; 3] = ["run.steps", "run.duration", "output.checkpoint"];
/// Differences that are told.
const TOLD: usize = 4;

pub fn resume(arguments: &ResumeArguments) -> Result<(), Failure> {
    shared(arguments.on_threads, |comm| resume_among(arguments, comm))
}

fn resume_among(arguments: &ResumeArguments, comm: &Arc<Comm>) -> Result<(), Failure> {
    let newest = Checkpoint::newest(&arguments.dir).map_err(|e| Failure::input(e.to_string()));
    let from = agreed(comm, newest)?;
    share_as_before(comm, &arguments.dir)?;
    let asked = from.asked.clone();
    let anew = arguments.as_initial.as_ref();
    if anew.is_none() && deck::is_piped(&asked.deck) {
        // it is nowhere else
        deck::pipe(Some(&asked.text));
    }
    let run = RunArguments {
        input: Input {
            file: anew.unwrap_or(&asked.deck).clone(),
            set: match anew {
                Some(_) => vec![],
                None => asked.set.clone(),
            },
            var: vec![],
            simd: arguments.simd.clone(),
        },
        out: Some(arguments.out.as_ref().unwrap_or(&arguments.dir).clone()),
        allow_outside: arguments.allow_outside,
        threads: arguments.threads,
        on_threads: None,
        early: arguments.early.clone(),
    };
    if anew.is_none() && !deck::is_deck(&run.input) {
        return resume_script(run, comm, asked, from);
    }
    if anew.is_none()
        && let Some(law) = agreed(comm, law::read(&run.input))?
    {
        return by_the_first(comm, "conservation laws", || {
            same_deck(&asked, law.text())?;
            going_on(&asked);
            with_threads(run.threads, |_| law::run(&run.place(), law, Some(from)))
        });
    }
    let read = || {
        let deck = deck::read(&run.input)?;
        if !run.allow_outside {
            deck.stays_inside(true)
                .map_err(|e| Failure::Input(e.into()))?;
        }
        if anew.is_none() {
            same_deck(&asked, deck.text())?;
        }
        Ok(deck)
    };
    let deck = agreed(comm, read())?;
    let threads = threads_here(comm, arguments.threads.or(deck.threads))?;
    let begin = match anew {
        Some(_) => Begin::Anew(Box::new(from)),
        None => {
            if comm.rank() == 0 {
                going_on(&asked);
            }
            Begin::Ended(Box::new(from))
        }
    };
    with_threads(threads, |threads| {
        run_deck(&run, &deck, (comm, threads), begin)
    })
}

/// Is it the deck that the run began with?
fn same_deck(asked: &Asked, text: &str) -> Result<(), Failure> {
    let others = differences(&asked.text, text);
    if !others.is_empty() {
        return Err(Failure::input(format!(
            "{}: this is not the deck that the run began with: {}; put it back, or begin anew with peridyne run ({} may change)",
            asked.deck.display(),
            others.join(", "),
            MAY_CHANGE.join(", ")
        )));
    }
    Ok(())
}

/// A script of LAMMPS.
fn resume_script(
    mut run: RunArguments,
    comm: &Arc<Comm>,
    asked: Asked,
    mut from: Checkpoint,
) -> Result<(), Failure> {
    // of a script these are its variables
    (run.input.set, run.input.var) = (vec![], asked.set.clone());
    let same = || {
        if deck::text(&run.input)? != asked.text {
            return Err(Failure::input(format!(
                "{}: this is not the script that the run began with; put it back, or begin anew with peridyne run",
                asked.deck.display()
            )));
        }
        for (path, _) in &asked.files {
            // one that cannot be read is not the same
            let _ = source::open(path);
        }
        same_files(&asked.files, &source::sums())
    };
    agreed(comm, same())?;
    let mut place = run.place_of_script();
    let shared = from.load(|archive| archive.one("shared", &mut place.shared));
    agreed(comm, shared.map_err(|e| Failure::input(e.to_string())))?;
    if comm.rank() == 0 {
        going_on(&asked);
    }
    with_threads(threads_here(comm, run.threads)?, |threads| {
        script::run_among(&place, (comm, threads), Some((asked, from)))
    })
}

/// Says where a run goes on.
fn going_on(asked: &Asked) {
    let of = match asked.steps {
        0 => String::new(),
        steps => format!(" of {steps}"),
    };
    note(&format!(
        "going on from step {}{of}, as `{}` began",
        asked.step, asked.command
    ));
}

/// Keys that differ between two decks, with both values.
fn differences(then: &str, now: &str) -> Vec<String> {
    if then == now {
        return vec![];
    }
    let [Ok(then), Ok(now)] = [then, now].map(str::parse::<Table>) else {
        return vec!["it cannot be read".into()];
    };
    let mut all = vec![];
    compare(
        "",
        Some(&Value::Table(then)),
        Some(&Value::Table(now)),
        &mut all,
    );
    let more = all.len().saturating_sub(TOLD);
    all.truncate(TOLD);
    if more > 0 {
        all.push(format!("and {more} more"));
    }
    all
}

fn compare(path: &str, then: Option<&Value>, now: Option<&Value>, all: &mut Vec<String>) {
    if then == now || MAY_CHANGE.contains(&path) {
        return;
    }
    if let (Some(Value::Table(a)), Some(Value::Table(b))) = (then, now) {
        let mut keys: Vec<&String> = a.keys().chain(b.keys()).collect();
        keys.sort();
        keys.dedup();
        for key in keys {
            let inner = match path {
                "" => key.clone(),
                _ => format!("{path}.{key}"),
            };
            compare(&inner, a.get(key), b.get(key), all);
        }
        return;
    }
    let told = |value: Option<&Value>| match value {
        None => "left out".to_string(),
        Some(value) => value.to_string(),
    };
    all.push(format!("{path} was {}, is {}", told(then), told(now)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deck_is_the_same_but_for_how_long_it_runs() {
        let then = "[run]\nsteps = 10\n[material]\ndensity = \"1 kg/m3\"\n";
        assert!(
            differences(
                then,
                "[material]\ndensity = \"1 kg/m3\" # same\n[run]\nsteps = 20\n"
            )
            .is_empty()
        );
        let other = differences(
            then,
            "[run]\nsteps = 10\nthreads = 2\n[material]\ndensity = \"2 kg/m3\"\n",
        );
        assert_eq!(
            other,
            [
                "material.density was \"1 kg/m3\", is \"2 kg/m3\"",
                "run.threads was left out, is 2"
            ]
        );
    }
}
