//! Fig. 1: the mass density over space and time, by atoms and by upscaled models.

use peridyne_io::write::plot::Map;
use peridyne_io::write::space_time::{DENSITY, Line, SpaceTime};
use peridyne_io::write::table::Table;

use super::chain::{DECK, Family, Wave, parsed};
use super::{deck, model};
use crate::measure::{apart, largest};
use crate::{Context, Failure, Findings};

experiment!(
    Figure1,
    "figure-1",
    "Mass density of the embedded-atom wave",
    ["../chain.rs", "chain.toml"]
);

/// The density of a wave, as the deck's picture of this number shows it.
fn image(wave: &Wave, number: usize, title: &str) -> Result<Map, Failure> {
    let deck = parsed(wave.h, Family::Chain)?;
    let asked = deck.output.space_time.get(number);
    let none = || {
        Failure::new(format!(
            "the deck has no picture {number} over space and time"
        ))
    };
    let asked = asked.ok_or_else(none)?;
    let reference: Vec<[f64; 3]> = wave.x.iter().map(|x| [*x, 0.0, 0.0]).collect();
    let line = Line::new(&reference, None, None);
    let mut image = SpaceTime::new(&line, &asked.window, false).ok_or_else(none)?;
    let steps = wave.steps() as u64;
    let dt = wave.time[1] - wave.time[0];
    for (k, (time, u)) in wave.time.iter().zip(&wave.u).enumerate() {
        if asked.window.is_row(k as u64, steps, dt) {
            image.record(*time, &line.density(u));
        }
    }
    let range = asked.range.unwrap_or_else(|| image.range(DENSITY));
    Ok(image.map(title, DENSITY, [""; 3], range))
}

/// What stops the run with the single length scale as printed, σ = 2 in f, too.
fn literal() -> Result<String, Failure> {
    let set = [("material.law.eam_form.density_length", "2".to_string())];
    let mut sim = model(&deck(DECK, "chain.toml", &set)?, false)?;
    sim.start(true);
    Ok(match sim.ledger() {
        Err(error) => error.to_string(),
        Ok(_) => "nothing".into(),
    })
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let md = Wave::run(1.0, Family::Now)?;
    let fine = Wave::run(1.0, Family::Chain)?;
    let ncm = [
        Wave::run(2.0, Family::Chain)?,
        Wave::run(4.0, Family::Chain)?,
    ];
    let mut found = Findings::new();
    let out = &context.out;
    let all = [
        ("b-md", "MD, 1001 atoms", &md),
        ("c-ncm-1", "NCM, h = a, 1001 points", &fine),
        ("d-ncm-2", "NCM, h = 2a, 501 points", &ncm[0]),
        ("e-ncm-4", "NCM, h = 4a, 251 points", &ncm[1]),
    ];
    found.picture(image(&md, 0, "MD, 1001 atoms")?.save(out, "a-md")?);
    for (name, title, wave) in all {
        found.picture(image(wave, 1, title)?.save(out, name)?);
        let path = out.join(format!("{name}.csv"));
        let density = wave.density(wave.steps());
        Table::new()
            .column("x", "", wave.x[1..wave.x.len() - 1].to_vec())
            .column("density at T", "", density)
            .save(&path)?;
        found.file(path);
    }

    let worst = largest(md.u.iter().zip(&fine.u).map(|(a, b)| apart(a, b)));
    found.holds(
        "same-resolution",
        format!("displacements of all times differ by {worst:.1e} at most, of 7"),
        worst < 1e-9,
    );
    let said = literal()?;
    found.holds(
        "literal",
        said.clone(),
        said.contains("electron density at atom"),
    );
    let front = [&md, &ncm[0], &ncm[1]].map(|wave| {
        let density = wave.density(wave.steps());
        let peak = |j: &usize| density[*j] > density[j - 1] && density[*j] > density[j + 1];
        let high = |j: &usize| density[*j] > 1.02;
        let peaks: Vec<f64> = (1..density.len() - 1)
            .filter(peak)
            .filter(high)
            .map(|j| wave.x[j + 1])
            .collect();
        let place = peaks.last().copied().unwrap_or(f64::NAN);
        let before = peaks.iter().rev().nth(1).copied().unwrap_or(f64::NAN);
        [place, place - before]
    });
    let [a, b, c] = front;
    found.holds(
        "preserved",
        format!(
            "the right front is at x = {}, {}, {} at T",
            a[0], b[0], c[0]
        ),
        (b[0] - a[0]).abs() < 10.0 && (c[0] - a[0]).abs() < 10.0,
    );
    found.holds(
        "oscillations",
        format!(
            "distance of the last two maxima behind the right front: {}, {}, {} for h = a, 2a, 4a",
            a[1], b[1], c[1]
        ),
        b[1] > 1.3 * a[1] && c[1] > 1.3 * b[1],
    );
    Ok(found)
}
