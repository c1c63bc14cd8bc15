//! Chapter 3, "A Numerical Example": Algorithm 7 to its last step against LAMMPS, and the three views of Fig. 3.2.

use std::f64::consts::PI;

use crate::gallery::bench::Bench;
use crate::gallery::sphere_on_plate::{SMALL, SMALL_DISK};
use crate::impact::{EQUAL, Top, VOLUME, against_lammps, cut, rows};
use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    Algorithm7,
    "algorithm-7",
    "A rigid sphere hits a brittle disk, 2,000 steps, and Fig. 3.2",
    [
        "../../gallery/bench.rs",
        "../../impact.rs",
        "deck.toml",
        "../../../decks/in.impact_disk",
        "lammps.csv"
    ],
    Minutes
);

const DECK: &str = include_str!("deck.toml");
const SCRIPT: &str = include_str!("../../../decks/in.impact_disk");
const LAMMPS: &str = include_str!("lammps.csv");
/// K (Pa) and ε, the round-off of 1.
const BULK: f64 = 14.9e9;
const EPSILON: f64 = 2.220446049250313e-16;
/// When the cut is drawn: the sphere has gone 1.9 mm into 2.5 mm.
const CUT: u64 = 200;

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    printed(&mut found)?;
    let (mut bench, theirs) = if context.small {
        let rows = vec![[300.0, SMALL[0], SMALL[1] * VOLUME]];
        (Bench::new(DECK, &SMALL_DISK)?, rows)
    } else {
        (Bench::new(DECK, &[])?, rows(LAMMPS, 2000))
    };
    let last = bench.steps();
    let mut unlike = None;
    against_lammps(
        context,
        &mut bench,
        &theirs,
        &mut found,
        |n, bench, found| {
            if n == CUT {
                cut(context, bench, found)?;
            }
            if n == last.min(EQUAL) {
                unlike = Some(Top::of(bench)?.unlike());
            }
            Ok(())
        },
    )?;
    let top = Top::of(&mut bench)?;
    top.draw(context, &mut found)?;
    found.holds(
        "fragments",
        format!(
            "{} pieces in the top layer of {} particles",
            top.pieces(),
            top.at.len()
        ),
        top.pieces() > 1,
    );
    found.holds(
        "symmetric",
        format!(
            "damage of {} of {} particles is not that of their mirror images",
            unlike.unwrap_or(top.at.len()),
            top.at.len()
        ),
        unlike == Some(0),
    );
    found.measured(
        "particles of the top layer unlike their mirror images at the end",
        top.unlike() as f64,
        "",
    );
    found.measured(
        "largest damage of the top layer",
        100.0 * largest(top.damage.iter().copied()),
        "%",
    );
    Ok(found)
}

/// What the chapter prints of the example, from the whole disk.
fn printed(found: &mut Findings) -> Result<(), Failure> {
    let mut bench = Bench::new(DECK, &[])?;
    let info = bench.sim.info().clone();
    let volume = bench.values("volume", 0)?[0];
    let horizon = 3.0 * info.spacing;
    let c = 18.0 * BULK / (PI * horizon.powi(4));
    found.number("particles", info.points as f64);
    found.number("volume", volume);
    found.number("c", c);
    found.number("round-off", c * EPSILON * volume);
    found.number("bonds", info.directed_bonds as f64);
    found.holds(
        "step",
        format!(
            "{:.3} of the longest stable step",
            info.time_step / info.stable_step
        ),
        info.time_step < info.stable_step,
    );
    // fix ID group indent K sphere x y z R
    let radius = SCRIPT.lines().find_map(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let at = words.iter().position(|w| *w == "sphere")?;
        words.get(at + 4)?.parse::<f64>().ok()
    });
    found.number("radius", radius.unwrap_or(f64::NAN));
    Ok(())
}
