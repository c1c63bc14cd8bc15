//! Fatigue by Silling and Askari's bonds that wear: the line of lives of a bar, and the exponent of Paris's law of a growing crack.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, level, slope};
use crate::{Context, Failure, Findings};

experiment!(
    Fatigue,
    "fatigue",
    "Fatigue of a bar and of a double cantilever beam",
    ["../bench.rs", "bar.toml", "deck.toml"]
);

const BAR: &str = include_str!("bar.toml");
const DECK: &str = include_str!("deck.toml");
/// Of the decks: A and m of nucleation and its limit; load ratio of the bar.
const LINE: [f64; 3] = [1e5, 3.0, 0.001];
const TURNED: f64 = -1.0;
/// Height of an arm, first length of the crack, spacing (m).
const H: f64 = 0.01;
const A: f64 = 0.02;
const SPACING: f64 = 0.001;
/// Length that the root of an arm adds to the crack, over its height (Gross and Srawley 1966).
const ROOT: f64 = 0.687;
/// Damage of a point beside a straight crack between two rows, m = 3: 11 of 28 bonds.
const BESIDE: f64 = 11.0 / 28.0;

/// Cycles until a bar breaks over 1/A(ε − ε∞)^m, at this greatest strain.
fn life(strain: f64) -> Result<[f64; 2], Failure> {
    let bench = Bench::finished(BAR, &[("constants.strain", &strain.to_string())])?;
    let cycles = bench.sim.cycles().unwrap_or(f64::NAN);
    if bench.sim.broken() == 0 {
        return Err(Failure::new("nothing breaks"));
    }
    let [a, m, limit] = LINE;
    let range = (1.0 - TURNED) * strain;
    Ok([cycles, cycles * a * (range - limit).powf(m)])
}

/// Cycles and lengths of a crack that grows.
struct Grown {
    cycles: Vec<f64>,
    length: Vec<f64>,
}

impl Grown {
    /// How long the crack is: by what the points beside its line have lost.
    fn length(bench: &mut Bench) -> Result<f64, Failure> {
        let damage = bench.values("damage", 0)?;
        let row = bench.places().into_iter().zip(damage);
        let beside = row.filter(|(x, _)| x[0] > A && (x[1] - 0.5 * SPACING).abs() < 0.1 * SPACING);
        Ok(A + SPACING * beside.map(|(_, d)| (d / BESIDE).min(1.0)).sum::<f64>())
    }

    /// With bonds that wear with this exponent, until the crack is so long.
    fn to(
        context: &Context,
        exponent: &str,
        opening: &str,
        end: f64,
    ) -> Result<(Grown, Bench), Failure> {
        context.say(&format!("exponent {exponent}, opening {opening}"));
        let law = format!("[1e8, {exponent}]");
        let set = [
            ("material.fracture.fatigue.growth", law.as_str()),
            ("constants.opening", opening),
        ];
        let mut bench = Bench::new(DECK, &set)?;
        let mut grown = Grown {
            cycles: vec![],
            length: vec![],
        };
        for _ in 0..10 * bench.steps() {
            bench.step()?;
            let length = Self::length(&mut bench)?;
            // as the crack passes a length for the first time
            if grown.length.last().is_none_or(|last| length > *last) {
                grown.cycles.push(bench.sim.cycles().unwrap_or(f64::NAN));
                grown.length.push(length);
            }
            if length > end {
                return Ok((grown, bench));
            }
        }
        Err(Failure::new("the crack stops"))
    }

    /// ln K and ln da/dN, of one spacing of growth each, after the first two.
    fn rates(&self) -> Result<[Vec<f64>; 2], Failure> {
        let last = self.length.last().copied().unwrap_or(A);
        let count = ((last - A) / SPACING) as i32;
        let at = |k: i32| {
            let place = A + SPACING * f64::from(k);
            level(&self.length, &self.cycles, place)
                .ok_or_else(|| Failure::new(format!("the crack is never {place} long")))
        };
        let [mut k, mut rate] = [vec![], vec![]];
        for n in 2..count {
            let middle = A + SPACING * (f64::from(n) + 0.5);
            // under an opening K goes with 1/(a + χH)²
            k.push(-2.0 * (middle + ROOT * H).ln());
            rate.push((SPACING / (at(n + 1)? - at(n)?)).ln());
        }
        Ok([k, rate])
    }
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let strains = [0.001, 0.002, 0.004, 0.008];
    let lives: Vec<[f64; 2]> = strains.iter().map(|s| life(*s)).collect::<Result<_, _>>()?;
    let worst = lives.iter().map(|l| (l[1] - 1.0).abs()).fold(0.0, f64::max);
    found.number("line", 1.0 + worst);
    for (s, l) in strains.iter().zip(&lives) {
        found.measured(&format!("life at the strain {s}, cycles"), l[0], "");
    }
    let end = if context.small { 0.028 } else { 0.04 };
    let exponents: &[&str] = if context.small { &["4"] } else { &["4", "2.5"] };
    let mut plot = Plot::new("Growth of a crack in a cycle over the stress intensity factor")
        .x("ln K/K at the start", "")
        .y("ln da/dN (m)", "");
    let mut table = Table::new();
    for (n, exponent) in exponents.iter().enumerate() {
        let (grown, mut bench) = Grown::to(context, exponent, "0.1 mm", end)?;
        let [k, rate] = grown.rates()?;
        let measured = slope(&k, &rate);
        found.number(&format!("paris-{}", ["steep", "flat"][n]), measured);
        let cycles = grown.cycles.last().copied().unwrap_or(f64::NAN);
        found.measured(
            &format!("cycles to the end, exponent {exponent}"),
            cycles,
            "",
        );
        let start = -2.0 * (A + ROOT * H).ln();
        let over: Vec<f64> = k.iter().map(|k| k - start).collect();
        plot = plot.points(&format!("m = {exponent}"), &over, &rate);
        if n == 0 {
            bench.damage(context, "damage", &mut found)?;
            table = table.column("cycles", "", grown.cycles.clone()).column(
                "length",
                "m",
                grown.length.clone(),
            );
            // half of the load
            let (half, _) = Grown::to(context, exponent, "0.05 mm", A + 3.5 * SPACING)?;
            let place = A + 3.0 * SPACING;
            let at = |g: &Grown| level(&g.length, &g.cycles, place).unwrap_or(f64::NAN);
            found.number("half", at(&half) / at(&grown));
        }
    }
    found.picture(plot.save(&context.out, "paris")?);
    let path = context.out.join("crack.csv");
    table.save(&path)?;
    found.file(path);
    Ok(found)
}
