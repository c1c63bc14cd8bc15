//! Kirsch's plate with a hole: strain along the ligament, and how the hole changes its shape.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, level};
use crate::{Context, Failure, Findings};

experiment!(
    PlateWithHole,
    "plate-with-hole",
    "A plate with a hole (Kirsch)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck: radius (m), Young's modulus and load (Pa), Poisson's ratio of the law in plane stress.
const A: f64 = 5e-3;
const E: f64 = 70e9;
const LOAD: f64 = 1e6;
const NU: f64 = 1.0 / 3.0;
/// Howland's (1930) concentration for this width.
#[expect(clippy::approx_constant, reason = "it is not pi")]
const HOWLAND: f64 = 3.14;

/// E ε_yy/σ on the ligament of an infinite plate at x = r A.
fn kirsch(r: f64) -> f64 {
    let q = r.powi(-2);
    let hoop = 0.5 * (2.0 + q + 3.0 * q * q);
    let radial = 1.5 * (q - q * q);
    hoop - NU * radial
}

/// One spacing.
struct Plate {
    spacing: f64,
    /// Places on the ligament over A, and E ε_yy/σ there.
    r: Vec<f64>,
    strain: Vec<f64>,
    /// How much longer the hole is along the load, and across, over σ 2A/E.
    along: f64,
    across: f64,
}

fn plate(context: &Context, h: &str, drawn: bool, found: &mut Findings) -> Result<Plate, Failure> {
    context.say(&format!("spacing {h}"));
    let mut bench = Bench::finished(DECK, &[("constants.h", h)])?;
    let x = bench.places();
    let strain = bench.values("strain", 1)?;
    let [ux, uy] = [
        bench.values("displacement", 0)?,
        bench.values("displacement", 1)?,
    ];
    let spacing = bench.sim.info().spacing;
    if drawn {
        let values: Vec<f64> = strain.iter().map(|e| e * E / LOAD).collect();
        bench.map(
            context,
            ["E strain_yy/load", ""],
            &values,
            [0.0, 3.0],
            found,
        )?;
    }
    let mut line: Vec<(f64, f64)> = (0..x.len())
        .filter(|k| x[*k][1].abs() < 0.1 * spacing && x[*k][0] > 0.0)
        .map(|k| (x[k][0] / A, strain[k] * E / LOAD))
        .collect();
    line.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (r, strain) = line.into_iter().unzip();
    let at = |p: [f64; 2]| {
        let near = |k: &usize| (x[*k][0] - p[0]).hypot(x[*k][1] - p[1]) < 0.1 * spacing;
        (0..x.len())
            .find(near)
            .ok_or_else(|| Failure::new(format!("no point at {p:?}")))
    };
    let [pole, side] = [at([0.0, A])?, at([A, 0.0])?];
    Ok(Plate {
        spacing,
        r,
        strain,
        along: uy[pole] * E / (LOAD * A),
        across: ux[side] * E / (LOAD * A),
    })
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let spacings: &[&str] = if context.small {
        &["1 mm", "0.5 mm"]
    } else {
        &["1 mm", "0.5 mm", "0.25 mm", "0.125 mm"]
    };
    let mut plates = vec![];
    for (k, h) in spacings.iter().enumerate() {
        plates.push(plate(context, h, k + 1 == spacings.len(), &mut found)?);
    }
    let mut plot = Plot::new("Strain on the ligament beside the hole")
        .x("x/a", "")
        .y("E strain_yy/load", "")
        .x_range(1.0, 3.0);
    for p in &plates {
        plot = plot.points(&format!("h = a/{:.0}", A / p.spacing), &p.r, &p.strain);
        let label = format!(
            "E ε_yy/σ at the edge of the hole, h = a/{:.0}",
            A / p.spacing
        );
        found.measured(&label, p.strain[0], "");
        let path = context
            .out
            .join(format!("ligament-{:.0}.csv", A / p.spacing));
        Table::new()
            .column("x/a", "", p.r.clone())
            .column("E strain/load", "", p.strain.clone())
            .save(&path)?;
        found.file(path);
    }
    let r: Vec<f64> = (0..=200).map(|k| 1.0 + 0.01 * f64::from(k)).collect();
    let exact: Vec<f64> = r.iter().map(|r| kirsch(*r)).collect();
    plot = plot.line("Kirsch", &r, &exact);
    found.picture(plot.save(&context.out, "ligament")?);
    let edge: Vec<f64> = plates.iter().map(|p| p.strain[0]).collect();
    let short: Vec<f64> = edge.iter().map(|e| HOWLAND - e).collect();
    found.holds(
        "edge",
        format!("{edge:.3?}, short of {HOWLAND} by {short:.2?}"),
        short.iter().all(|s| *s > 0.0) && short.windows(2).all(|s| s[1] < 0.85 * s[0]),
    );
    let fine = &plates[plates.len() - 1];
    // at twice the radius the hole still adds an eighth
    let mut two = f64::NAN;
    for p in &plates {
        two = level(&p.r, &p.strain, 2.0).unwrap_or(f64::NAN);
        let label = format!("E ε_yy/σ at two radii, h = a/{:.0}", A / p.spacing);
        found.measured(&label, two, "");
    }
    if !context.small {
        found.number("twice", two);
    }
    found.number("along", fine.along);
    found.number("across", fine.across);
    Ok(found)
}
