//! A rigid sphere hits a brittle disk: broken bonds and energy against LAMMPS, step by step.

use crate::gallery::bench::Bench;
use crate::impact::{VOLUME, against_lammps, rows};
use crate::{Context, Failure, Findings};

experiment!(
    SphereOnPlate,
    "sphere-on-plate",
    "A rigid sphere hits a brittle disk (LAMMPS)",
    [
        "../bench.rs",
        "../../impact.rs",
        "deck.toml",
        "../../../verify/lammps/impact_pmb.csv"
    ]
);

const DECK: &str = include_str!("deck.toml");
const LAMMPS: &str = include_str!("../../../verify/lammps/impact_pmb.csv");
/// Of a disk of 10.1 mm after 300 steps, by the same script: broken directed bonds, and ke.
pub const SMALL: [f64; 2] = [404_586.0, 26_368_222_685.753_754];
pub const SMALL_DISK: [(&str, &str); 2] = [("constants.r", "10.1 mm"), ("run.steps", "300")];

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let (set, theirs): (&[(&str, &str)], _) = if context.small {
        (&SMALL_DISK, vec![[300.0, SMALL[0], SMALL[1] * VOLUME]])
    } else {
        (&[], rows(LAMMPS, 1000))
    };
    let mut bench = Bench::new(DECK, set)?;
    against_lammps(context, &mut bench, &theirs, &mut found, |_, _, _| Ok(()))?;
    bench.damage(context, "damage", &mut found)?;
    Ok(found)
}
