//! `peridyne reproduce`: the papers' experiments.

use crate::failure::{Failure, say};
use crate::run::with_threads;
use peridyne_papers::reproduce::{EVERYTHING, list, papers};
use peridyne_papers::{Options, Outcome, reproduce as run};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct ReproduceArguments {
    /// A paper (`seleson2009`), one of its figures (`seleson2009/figure-4-3`), or `all`; none: says what there is, and runs nothing.
    pub selection: Option<String>,
    /// List papers, figures and what each takes; run nothing.
    #[arg(long)]
    pub list: bool,
    /// Small variants: seconds instead of minutes.
    #[arg(long)]
    pub small: bool,
    /// Run again what is finished already.
    #[arg(long)]
    pub force: bool,
    /// Folder for the results.
    #[arg(long, default_value = "out/papers")]
    pub out: PathBuf,
    /// Threads; all cores if not given.
    #[arg(long)]
    pub threads: Option<usize>,
}

/// What there is, and how it is run.
fn told() -> String {
    format!(
        "{}\nThe figures of papers, made again and compared with what was published:\n  \
         peridyne reproduce --list [PAPER]     every figure, and what it takes\n  \
         peridyne reproduce PAPER[/FIGURE]     runs them (--small: in seconds)\n  \
         peridyne reproduce {EVERYTHING}                runs all but those of hours, which run by their whole name",
        papers()
    )
}

pub fn reproduce(arguments: &ReproduceArguments) -> Result<(), Failure> {
    if arguments.list {
        let text =
            list(arguments.selection.as_deref()).map_err(|e| Failure::input(e.to_string()))?;
        say(text.trim_end());
        return Ok(());
    }
    if arguments.selection.is_none() {
        say(&told());
        return Ok(());
    }
    with_threads(arguments.threads, |threads| {
        let options = Options {
            out: arguments.out.clone(),
            small: arguments.small,
            force: arguments.force,
            threads,
            progress: &|line: &str| say(line),
        };
        let outcomes = run(arguments.selection.as_deref(), &options)
            .map_err(|e| Failure::input(e.to_string()))?;
        let failed = outcomes.iter().filter(|o| !Outcome::pass(o)).count();
        say(&format!(
            "{} of {} figures pass; {}",
            outcomes.len() - failed,
            outcomes.len(),
            arguments.out.join("index.md").display()
        ));
        if failed > 0 {
            return Err(Failure::Run(format!("{failed} figures do not pass")));
        }
        Ok(())
    })
}
