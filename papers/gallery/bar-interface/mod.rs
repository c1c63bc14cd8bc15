//! A pulse at the interface of two bars: what goes on, what comes back.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, peak};
use crate::{Context, Failure, Findings};

experiment!(
    BarInterface,
    "bar-interface",
    "A pulse at the interface of two bars",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Height of the pulse that comes.
const HEIGHT: f64 = 1e-6;

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let h = if context.small { "1 mm" } else { "0.5 mm" };
    let mut bench = Bench::new(DECK, &[("constants.h", h)])?;
    let x = bench.places();
    let along: Vec<f64> = x.iter().map(|x| x[0]).collect();
    let steps = bench.steps();
    let mut plot = Plot::new("A pulse meets aluminium (right of 0)")
        .x("x", "m")
        .y("displacement", "µm");
    let mut table = Table::new().column("x", "m", along.clone());
    for n in 0..=steps {
        if n > 0 {
            bench.step()?;
        }
        if n % (steps / 2) == 0 {
            let u = bench.values("displacement", 0)?;
            let micro: Vec<f64> = u.iter().map(|u| 1e6 * u).collect();
            let label = format!("t = {:.0} µs", 1e6 * bench.sim.time());
            plot = plot.line(&label, &along, &micro);
            table = table.column(&label, "m", u);
        }
    }
    found.picture(plot.save(&context.out, "pulse")?);
    let path = context.out.join("pulse.csv");
    table.save(&path)?;
    found.file(path);
    let u = bench.values("displacement", 0)?;
    let [there, on] = peak(&x, &u, |x| x > 0.01);
    let [back, reflected] = peak(&x, &u, |x| x < -0.01);
    found.number("transmitted", on / HEIGHT);
    found.number("reflected", reflected / HEIGHT);
    found.measured("place of the pulse in aluminium", there, "m");
    found.measured("place of the pulse that came back", back, "m");
    Ok(found)
}
