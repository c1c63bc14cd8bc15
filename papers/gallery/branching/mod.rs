//! Branching of a crack in glass: where, when, and how fast the crack is.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, CRACKED, fastest, rayleigh};
use crate::{Context, Failure, Findings};

experiment!(
    Branching,
    "branching",
    "A crack in soda-lime glass branches",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Tip of the pre-crack (m).
const TIP: f64 = 0.05;
/// Cracked points of a column this far apart (m) are of two branches: twice what a straight crack damages.
const APART: f64 = 3e-3;
/// Width over which the tip's speed is taken (s).
const WINDOW: f64 = 4e-6;

struct Run {
    load: &'static str,
    time: Vec<f64>,
    tip: Vec<f64>,
    /// Where and when there are two branches.
    place: f64,
    when: f64,
    /// When the crack has run 1 mm.
    start: f64,
    speed: f64,
    /// Most branches side by side.
    branches: usize,
}

fn glass(context: &Context, load: &'static str, found: &mut Findings) -> Result<Run, Failure> {
    context.say(load);
    let h = if context.small { "0.5 mm" } else { "0.25 mm" };
    let mut bench = Bench::new(DECK, &[("constants.h", h), ("constants.sigma", load)])?;
    let x = bench.places();
    let steps = bench.steps();
    let every = (steps / 90).max(1);
    let [mut time, mut tip] = [vec![], vec![]];
    let names = bench.sim.probe_columns();
    let shown = |bench: &mut Bench, name: &str| {
        let place = names.iter().position(|c| c.name == name);
        place.map_or(f64::NAN, |n| bench.sim.measure()[n])
    };
    for n in 1..=steps {
        bench.step()?;
        if n % every == 0 {
            time.push(bench.sim.time());
            tip.push(shown(&mut bench, "tip_x"));
        }
    }
    let damage = bench.values("damage", 0)?;
    let cracked: Vec<usize> = (0..x.len()).filter(|k| damage[*k] > CRACKED).collect();
    // heights of cracked points, by columns from left to right
    let mut columns: std::collections::BTreeMap<i64, Vec<f64>> = Default::default();
    for k in cracked {
        let column = (x[k][0] * 1e6).round() as i64;
        columns.entry(column).or_default().push(x[k][1]);
    }
    let split = columns.iter().find_map(|(column, heights)| {
        let high = heights.iter().copied().fold(f64::MIN, f64::max);
        let low = heights.iter().copied().fold(f64::MAX, f64::min);
        let place = *column as f64 * 1e-6;
        (place > TIP && high - low > APART).then_some(place)
    });
    let place = split.unwrap_or(f64::NAN);
    let passed = |at: f64| {
        let first = time.iter().zip(&tip).find(|(_, tip)| **tip >= at);
        first.map_or(f64::NAN, |(t, _)| *t)
    };
    let run = Run {
        load,
        place,
        when: passed(place),
        start: passed(TIP + 1e-3),
        speed: fastest(&time, &tip, WINDOW),
        branches: shown(&mut bench, "tip_branches") as usize,
        time,
        tip,
    };
    let name = format!("damage-{}", &load[..2]);
    bench.damage(context, &name, found)?;
    Ok(run)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let runs = [
        glass(context, "12 MPa", &mut found)?,
        glass(context, "14 MPa", &mut found)?,
        glass(context, "28 MPa", &mut found)?,
    ];
    let mut plot = Plot::new("Tip of the crack").x("t", "µs").y("x", "mm");
    let c_r = rayleigh(72e9, 1.0 / 3.0, 2440.0);
    for r in &runs {
        let time: Vec<f64> = r.time.iter().map(|t| 1e6 * t).collect();
        let tip: Vec<f64> = r.tip.iter().map(|t| 1e3 * t).collect();
        plot = plot.line(r.load, &time, &tip);
        let path = context.out.join(format!("tip-{}.csv", &r.load[..2]));
        Table::new()
            .column("time", "s", r.time.clone())
            .column("x", "m", r.tip.clone())
            .save(&path)?;
        found.file(path);
        let said = |what: &str| format!("{what}, {}", r.load);
        found.measured(&said("the crack has run 1 mm"), 1e6 * r.start, "µs");
        found.measured(
            &said("two branches are 3 mm apart at x"),
            1e3 * r.place,
            "mm",
        );
        found.measured(&said("the tip is there"), 1e6 * r.when, "µs");
        found.measured(&said("fastest over 4 µs"), r.speed, "m/s");
        found.measured(&said("the same over c_R"), r.speed / c_r, "");
        found.measured(&said("most branches side by side"), r.branches as f64, "");
    }
    found.picture(plot.save(&context.out, "tip")?);
    let [twelve, fourteen, more] = &runs;
    found.holds(
        "branches",
        format!(
            "two branches 3 mm apart at {:.1} mm and {:.1} mm",
            1e3 * twelve.place,
            1e3 * fourteen.place
        ),
        [twelve, fourteen]
            .iter()
            .all(|r| r.branches == 2 && r.place > TIP + 5e-3 && r.place < 0.095),
    );
    found.holds(
        "levels",
        format!(
            "{} branches side by side under {}",
            more.branches, more.load
        ),
        more.branches > 2,
    );
    // under 28 MPa damage ahead of the tip joins it, and it jumps
    let speeds = [twelve.speed, fourteen.speed];
    found.holds(
        "speed",
        format!("{:.2?} c_R", speeds.map(|s| s / c_r)),
        speeds.iter().all(|s| *s > 0.0 && *s < c_r),
    );
    if !context.small {
        found.number("terminal", twelve.speed);
    }
    Ok(found)
}
