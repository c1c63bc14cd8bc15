//! Table 2: what the wave of Fig. 1 costs.

use peridyne_io::write::table::Table;

use super::chain::{Family, parsed, seconds};
use super::model;
use crate::{Context, Failure, Findings};

experiment!(
    Table2,
    "table-2",
    "Cost of the embedded-atom wave",
    ["../chain.rs", "../figure-1/chain.toml"]
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let runs = if context.small { 1 } else { 15 };
    let mut found = Findings::new();
    let mut rows = vec![];
    for (h, family) in [
        (1.0, Family::Now),
        (2.0, Family::Chain),
        (4.0, Family::Chain),
    ] {
        let deck = parsed(h, family)?;
        let points = model(&deck, false)?.info().points as f64;
        let steps = deck.spec.run.schedule.steps as f64;
        rows.push([h, points, steps, seconds(h, family, runs)?]);
    }
    let stencil = seconds(1.0, Family::Chain, runs)?;
    let column = |k: usize| rows.iter().map(move |r| r[k]);
    let work = |r: &[f64; 4]| r[1] * r[2];
    let path = context.out.join("costs.csv");
    Table::new()
        .text("model", ["MD", "NCM (h = 2a)", "NCM (h = 4a)"])
        .column("points", "", column(1))
        .column("steps", "", column(2))
        .column("total time", "s", column(3))
        .column("speedup", "", rows.iter().map(|r| rows[0][3] / r[3]))
        .column(
            "speedup by points and steps",
            "",
            rows.iter().map(|r| work(&rows[0]) / work(r)),
        )
        .save(&path)?;
    found.file(path);
    for (row, name) in rows.iter().zip(["md", "2", "4"]) {
        found.number(&format!("points-{name}"), row[1]);
        found.number(&format!("steps-{name}"), row[2]);
    }
    let work: Vec<f64> = rows.iter().map(|r| work(&rows[0]) / work(r)).collect();
    for (h, work, printed) in [(2, work[1], 3.95), (4, work[2], 15.5)] {
        let key = format!("speedup by points and steps, h = {h}a; printed, by times: {printed}");
        found.measured(&key, work, "");
    }
    if !context.small {
        let speedup: Vec<f64> = rows.iter().map(|r| rows[0][3] / r[3]).collect();
        found.holds(
            "speedup",
            format!(
                "{:.1} and {:.1} against MD on current neighbours, {:.1} and {:.1} against MD on the chain's neighbours (of {:.3} s and {:.3} s)",
                speedup[1], speedup[2], stencil / rows[1][3], stencil / rows[2][3], rows[0][3], stencil
            ),
            speedup[1] > 2.0 && speedup[2] > 6.0,
        );
    }
    Ok(found)
}
