//! Is there enough disk and memory for what a deck asks to write? Judged before the first step.

use crate::deck::fields;
use crate::failure::Failure;
use peridyne::error::{BuildError, size};
use peridyne::run::Simulation;
use peridyne::spec::FamilyChoice;
use peridyne_io::deck::Deck;
use peridyne_io::write::linear::room;
use peridyne_io::write::space::{Amount, free};
use std::path::Path;

/// Keys that say how often something is written, what that is, and how to write less of it.
const WHAT: [(&str, &str, &str); 5] = [
    ("output.every", "frames", LESS),
    ("output.dump", "frames of the dump", LESS),
    ("output.pictures", "frames of films", LESS),
    (
        "output.history",
        "rows of history.csv",
        "write a larger output.history, or fewer steps; or --out on another disk",
    ),
    (
        "fields",
        "continuum fields",
        "fewer points (`grid`), no file for each frame (`each = false`), a larger `every`; or --out on another disk",
    ),
];
const LESS: &str = "write a larger output.every, or fewer steps; or --out on another disk";

/// About how much a run writes of each of these (bytes).
fn amounts(deck: &Deck, sim: &mut dyn Simulation) -> [f64; 5] {
    let written = fields(deck);
    let columns = sim.columns();
    let columns = columns
        .iter()
        .filter(|c| written.iter().any(|f| c.name == **f));
    let numbers = columns.map(|c| c.shape.components().len().max(1) as u64);
    // number, type and place of a point, too
    let numbers = 5 + numbers.sum::<u64>();
    let (info, output) = (sim.info(), &deck.output);
    let steps = deck.steps(info.time_step);
    let films = || output.pictures.iter().filter(|p| p.film.is_some());
    let cells = output.vtu && !deck.cells.is_empty();
    let amount = Amount {
        steps,
        every: output.every(steps),
        history: output.history.unwrap_or((steps / 100).max(1)),
        points: info.points,
        files: [
            output.vtu,
            cells,
            output.exodus.is_some(),
            output.vtkhdf.is_some(),
        ]
        .map(u64::from)
        .iter()
        .sum(),
        corners: if cells { deck.cells.corners() } else { 0 },
        bonds: if output.bonds {
            info.directed_bonds / 2
        } else {
            0
        },
        atoms: info.points * output.trajectories.len() as u64,
        dump: if output.dump.is_some() { numbers } else { 0 },
        films: films().count() as u64,
        arrows: films().filter(|p| p.arrows.is_some()).count() as u64,
        probes: sim.probe_columns().len() as u64,
    };
    let [frames, dump, film, rows] = amount.bytes();
    let made = deck.fields.iter().map(|f| f.bytes(steps)).sum();
    [frames, dump, film, rows, made]
}

/// Does the disk of a folder have room for what the deck asks to write, and memory for what it asks to make at the end?
pub fn enough(deck: &Deck, sim: &mut dyn Simulation, dir: &Path) -> Result<(), Failure> {
    let wrong = |error: BuildError| Failure::Input(deck.explain(&error).into());
    if deck.output.linear_body {
        room(sim.info())
            .map_err(|e| wrong(BuildError::invalid("output.linear_body", e.to_string())))?;
    }
    let of_now =
        deck.spec.potential().is_some() && deck.spec.bonds.family != FamilyChoice::Reference;
    if deck.output.fragments && of_now {
        let message = "fragments hang together by bonds of the reference, and these atoms are near each other now";
        let error = BuildError::unsupported("output.fragments", message);
        return Err(wrong(error.help("leave it out")));
    }
    let Some(free) = free(dir) else {
        return Ok(());
    };
    let each = amounts(deck, sim);
    let all: f64 = each.iter().sum();
    if all <= free {
        return Ok(());
    }
    let steps = deck.steps(sim.info().time_step);
    let largest = each.iter().zip(WHAT).max_by(|a, b| a.0.total_cmp(b.0));
    let Some((bytes, (key, what, help))) = largest else {
        return Ok(());
    };
    Err(wrong(
        BuildError::too_large(
            key,
            (all, Some(free)),
            format!(
                "{steps} steps would write about {}, {} of {what}; the disk has {} left",
                size(all),
                size(*bytes),
                size(free)
            ),
        )
        .help(help.to_string()),
    ))
}
