//! `cargo run --release -p peridyne-papers --example reproduce -- [PAPER[/FIGURE]] [--small] [--force] --out DIR`

use peridyne_papers::reproduce::{Options, Outcome, reproduce};
use std::process::ExitCode;

fn main() -> ExitCode {
    let (mut selection, mut out, mut small, mut force) = (None, None, false, false);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--small" => small = true,
            "--force" => force = true,
            "--out" => out = arguments.next(),
            name if !name.starts_with('-') && selection.is_none() => {
                selection = Some(name.to_string())
            }
            other => {
                eprintln!("what is `{other}`? [PAPER[/FIGURE]] [--small] [--force] --out DIR");
                return ExitCode::from(2);
            }
        }
    }
    let Some(out) = out else {
        eprintln!("say where the results go: --out DIR");
        return ExitCode::from(2);
    };
    let options = Options {
        out: out.into(),
        small,
        force,
        threads: std::thread::available_parallelism().map_or(1, Into::into),
        progress: &|line| println!("{line}"),
    };
    let outcomes = match reproduce(selection.as_deref(), &options) {
        Ok(outcomes) => outcomes,
        Err(e) => {
            eprintln!("{e}");
            return ExitCode::from(2);
        }
    };
    for outcome in &outcomes {
        match outcome {
            Outcome::Ran(r) | Outcome::Kept(r) => {
                for c in &r.claims {
                    let held = if c.pass { "  ok  " } else { "WRONG " };
                    println!("{held}{}/{} {}: {}", r.paper, r.figure, c.key, c.computed);
                }
            }
            Outcome::Failed {
                paper,
                figure,
                failure,
            } => println!("FAILED {paper}/{figure}: {failure}"),
        }
    }
    if outcomes.iter().all(Outcome::pass) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
