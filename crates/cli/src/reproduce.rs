//! `peridyne reproduce`: the papers' experiments.

use crate::failure::{Failure, say};
use crate::run::with_threads;
use peridyne_papers::{Options, Outcome, reproduce as run};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct ReproduceArguments {
    /// A paper (`seleson2009`) or one of its figures (`seleson2009/figure-4-3`); all if not given.
    pub selection: Option<String>,
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

pub fn reproduce(arguments: &ReproduceArguments) -> Result<(), Failure> {
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
