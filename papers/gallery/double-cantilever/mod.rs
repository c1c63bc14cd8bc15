//! A double cantilever beam: load and energy release against corrected beam theory, and the load at which it begins to break.

use peridyne_io::write::picture::shown::About;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, limit, slope};
use crate::{Context, Failure, Findings};

experiment!(
    DoubleCantilever,
    "double-cantilever",
    "A double cantilever beam",
    ["../bench.rs", "deck.toml", "glued.toml"]
);

const DECK: &str = include_str!("deck.toml");
const GLUED: &str = include_str!("glued.toml");
/// Equilibria of the glued arms before the crack moves as it will go on.
const FIRST: usize = 25;
/// Of the deck (SI): modulus, thickness, height of an arm, opening.
const E: f64 = 3e9;
const B: f64 = 0.01;
const H: f64 = 0.01;
const OPENING: f64 = 1e-4;
/// Length that the root of an arm adds to the crack, over the height of the arm (Gross and Srawley 1966).
const ROOT: f64 = 0.687;
/// Energy of fracture where it may break (J/m²).
const G: f64 = 50.0;
/// Lengths of the crack (m).
const CRACKS: [f64; 3] = [0.06, 0.08, 0.1];

/// Load over opening: E B H³/8(a + χH)³.
fn stiffness(a: f64) -> f64 {
    E * B * H.powi(3) / (8.0 * (a + ROOT * H).powi(3))
}

/// Energy release over the square of the load: 12(a + χH)²/E B² H³.
fn breakage(a: f64) -> f64 {
    12.0 * (a + ROOT * H).powi(2) / (E * B * B * H.powi(3))
}

/// Load and J of a spacing and a length of the crack, over those of the beams.
fn opened(a: f64, h: &str, drawn: Option<(&Context, &mut Findings)>) -> Result<[f64; 2], Failure> {
    let mut bench = Bench::finished(
        DECK,
        &[("constants.h", h), ("constants.a", &format!("{a} m"))],
    )?;
    if let Some((context, found)) = drawn {
        bench.drawn(
            context,
            "stress",
            ["stress", "xx"],
            About::Equilibrium,
            found,
        )?;
    }
    let (load, j) = (bench.probe("load_y")?, bench.probe("tip_J")?);
    Ok([
        load / (stiffness(a) * OPENING),
        j / (breakage(a) * load * load),
    ])
}

/// Energy release by the contour in the increment before the first bonds break, and the increment after it over it, over G.
fn breaks(h: &str) -> Result<[f64; 2], Failure> {
    let set = [
        ("constants.h", h),
        ("constants.opening", "3 mm"),
        ("material.fracture.energy", "50 J/m^2"),
        ("statics.method", "relaxation"),
        ("statics.tolerance", "1e-3"),
        ("statics.increments", "30"),
    ];
    let mut bench = Bench::new(DECK, &set)?;
    let mut last = f64::NAN;
    for n in 1..=bench.steps() {
        bench.step()?;
        if bench.sim.broken() > 0 {
            // J of linear bodies grows with the square of the opening
            let grown = (n as f64 / (n as f64 - 1.0)).powi(2);
            return Ok([last / G, last * grown / G]);
        }
        last = bench.probe("tip_J")?;
    }
    Err(Failure::new("nothing breaks"))
}

/// Of arms that are peeled apart, whose load for an opening is `soft` times that of the beams: energy released over G per length that the
/// crack grows, which the opening over the load tells; least and most of P√Δ over that of a crack that grows at G, which is a constant.
fn peeled(soft: f64) -> Result<[f64; 3], Failure> {
    let mut bench = Bench::new(GLUED, &[])?;
    // P = B √(G E H³/12)/(a + χH), Δ = 8 P (a + χH)³/E B H³
    let griffith = (G * E * H.powi(3) / 12.0).sqrt() * B;
    let griffith = griffith * (8.0 * griffith / (E * B * H.powi(3))).sqrt();
    let (mut cracks, mut released) = (vec![], vec![]);
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for n in 0..bench.steps() as usize {
        bench.step()?;
        let (load, opening) = (bench.probe("load_y")?, OPENING * bench.sim.time());
        let energy = bench
            .sim
            .ledger()
            .map_err(|e| Failure::new(e.to_string()))?;
        if n < FIRST {
            continue;
        }
        let curve = load * opening.sqrt() / griffith;
        (least, most) = (least.min(curve), most.max(curve));
        let stiff = soft * E * B * H.powi(3) / 8.0;
        cracks.push((stiff * opening / load).cbrt() - ROOT * H);
        released.push(energy.released / (G * B));
    }
    Ok([slope(&cracks, &released), least, most])
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let spacings: &[&str] = if context.small {
        &["1 mm", "0.5 mm"]
    } else {
        &["1 mm", "0.5 mm", "0.25 mm"]
    };
    let mut plot = Plot::new("Load over that of the beams, for the same opening")
        .x("spacing/height of an arm", "")
        .y("load/load of the beams", "")
        .x_range(0.0, 0.11);
    let mut table = Table::new().column("crack", "m", CRACKS.to_vec());
    let mut all = vec![];
    for (k, h) in spacings.iter().enumerate() {
        context.say(&format!("spacing {h}"));
        let mut row = vec![];
        for a in CRACKS {
            let drawn = (k + 1 == spacings.len() && a == 0.08).then_some((context, &mut found));
            row.push(opened(a, h, drawn)?);
        }
        for (c, what) in ["load", "J"].iter().enumerate() {
            let label = format!("{what} over that of the beams, h = {h}");
            let column: Vec<f64> = row.iter().map(|r| r[c]).collect();
            found.measured(
                &format!("{label}, a = 60, 80, 100 mm"),
                format!("{column:.4?}"),
                "",
            );
            table = table.column(&label, "", column);
        }
        all.push(row);
    }
    let steps: Vec<f64> = (0..all.len()).map(|k| 0.1 / f64::from(1 << k)).collect();
    for (c, a) in CRACKS.iter().enumerate() {
        let loads: Vec<f64> = all.iter().map(|row| row[c][0]).collect();
        plot = plot.points(&format!("a = {:.0} mm", 1e3 * a), &steps, &loads);
    }
    found.picture(plot.save(&context.out, "load")?);
    let path = context.out.join("beams.csv");
    table.save(&path)?;
    found.file(path);
    let [coarse, fine] = [&all[all.len() - 2], &all[all.len() - 1]];
    let near = |c: usize, what: usize| limit(coarse[c][what], fine[c][what]);
    found.number("load", near(1, 0));
    // (opening/load)^(1/3) = (8/EBH³)^(1/3) (a + χH): the line through three cracks
    let cubes: Vec<f64> = (0..3)
        .map(|c| (1.0 / (near(c, 0) * stiffness(CRACKS[c]))).cbrt())
        .collect();
    let steep = slope(&CRACKS, &cubes);
    let mean = cubes.iter().sum::<f64>() / 3.0;
    let root = mean / steep - CRACKS[1];
    found.number("slope", steep / (8.0 / (E * B * H.powi(3))).cbrt());
    found.number("root", root / H);
    if !context.small {
        found.number("release", near(1, 1));
        let [before, now] = breaks("1 mm")?;
        found.measured("J over G before the first bonds break", before, "");
        found.number("first", now);
        let [grown, least, most] = peeled(all[0][0][0])?;
        found.number("peeled", grown);
        found.measured(
            "load times the root of the opening over that of a crack that grows at G, least and most",
            format!("{least:.3}, {most:.3}"),
            "",
        );
    }
    Ok(found)
}
