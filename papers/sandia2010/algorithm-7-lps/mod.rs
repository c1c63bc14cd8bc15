//! Algorithm 7 with `peri/lps` (its footnote 4) against LAMMPS.

use crate::gallery::bench::Bench;
use crate::impact::{Top, VOLUME, against_lammps, rows};
use crate::{Context, Failure, Findings};

experiment!(
    Algorithm7Lps,
    "algorithm-7-lps",
    "A rigid sphere hits a brittle disk of the state-based solid",
    [
        "../../gallery/bench.rs",
        "../../impact.rs",
        "deck.toml",
        "lammps.csv"
    ],
    Minutes
);

const DECK: &str = include_str!("deck.toml");
const LAMMPS: &str = include_str!("lammps.csv");
/// Of a disk of 10.1 mm after 300 steps, by the same script: broken directed bonds, and ke.
const SMALL: [f64; 2] = [477_464.0, 26_312_669_769.031_654];

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let theirs = match context.small {
        true => vec![[300.0, SMALL[0], SMALL[1] * VOLUME]],
        false => rows(LAMMPS, 2000),
    };
    let last = theirs.last().map_or(0.0, |row| row[0]).to_string();
    let disk = if context.small { "10.1 mm" } else { "37 mm" };
    let set = [("constants.r", disk), ("run.steps", &last)];
    let mut bench = Bench::new(DECK, &set)?;
    against_lammps(context, &mut bench, &theirs, &mut found, |_, _, _| Ok(()))?;
    Top::of(&mut bench)?.draw(context, &mut found)?;
    Ok(found)
}
