//! `peridyne bar`: the peristatic bar of eriksson2020.

use crate::failure::{Failure, json_text, note, say};
use clap::ValueEnum;
use peridyne_io::read::source::room;
use peridyne_theory::exact::{Field, Q};
use peridyne_theory::homogenize::bar::equations::Corner;
use peridyne_theory::homogenize::bar::limit::decimals;
use peridyne_theory::homogenize::bar::{Bar, BarError, Ends, micromodulus};
use serde_json::{Value, json};

/// Decimals of the limit.
const DIGITS: u32 = 30;
/// Longest horizon in spacings: corners have its square of numbers.
const LARGEST_M: i64 = 100;
/// Most points: each needs some hundred bytes.
const MOST_POINTS: i64 = 10_000_000;
/// Points times m beyond which the fraction, that has about as many digits, is left out.
const LONGEST_FRACTION: usize = 60_000;

#[derive(clap::Args)]
pub struct BarArguments {
    /// Horizon in spacings: δ/Δ.
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    pub m: i64,
    /// Points N of the bar, at least 2M + 1.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub points: i64,
    /// Volume of an end point: that of the others, or half of it.
    #[arg(long, value_enum)]
    pub ends: Weight,
    /// With the factors on the bonds of the end points that make uniform strain exact.
    #[arg(long)]
    pub homogenize: bool,
    /// Print JSON instead of a report.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Weight {
    Full,
    Half,
}

/// What is said about a bar.
struct Found {
    bar: Bar,
    /// `None` if it has too many digits.
    f: Option<Q>,
    decimal: f64,
    limit: Q,
    factors: Vec<Q>,
    corner: Corner,
    /// Points 1…m+1 in uniform strain.
    energy: Vec<Q>,
}

pub fn bar(arguments: &BarArguments) -> Result<(), Failure> {
    let bar = parse(arguments).map_err(Failure::input)?;
    let short = bar.points() * bar.m() <= LONGEST_FRACTION;
    let f = (short || bar.homogenized()).then(|| bar.f());
    if f.is_none() {
        weighed(&bar)?;
    }
    let found = Found {
        decimal: f.as_ref().map_or_else(|| bar.f_by_strains(), Field::value),
        limit: bar.f_limit().value,
        factors: bar.factors(),
        corner: bar.corner(),
        energy: bar.end_energy(),
        f,
        bar,
    };
    if arguments.json {
        say(&json_text(&json(&found)));
    } else {
        say(&report(&found));
    }
    Ok(())
}

/// Arithmetic of a bond of the band on one thread, about (s).
const OPERATION: f64 = 5e-10;
/// Time that is told before it is taken (s).
const LONG: f64 = 10.0;

/// What solving for all strains takes, before it is taken: a band of m numbers for each, O(N m²).
fn weighed(bar: &Bar) -> Result<(), Failure> {
    let (points, m) = (bar.points() as f64, bar.m() as f64);
    let what = format!("the equations of {points} points with --m {m}");
    room(&what, 8.0 * points * (m + 4.0)).map_err(|e| {
        Failure::input(format!(
            "{e}; the elongation of long bars is the limit: take fewer --points"
        ))
    })?;
    let seconds = OPERATION * points * m * m;
    if seconds > LONG {
        note(&format!("{what}: about {seconds:.0} s"));
    }
    Ok(())
}

/// The bar, or what to write instead.
fn parse(arguments: &BarArguments) -> Result<Bar, String> {
    let BarArguments { m, points, .. } = *arguments;
    if m < 1 {
        return Err(format!(
            "--m {m} is no horizon: it is the number of spacings within the horizon, at least 1; write for example --m 3"
        ));
    }
    if m > LARGEST_M {
        return Err(format!(
            "--m {m} is more than this verb prints: at most {LARGEST_M}"
        ));
    }
    if points < 0 {
        return Err(format!(
            "--points {points} is no number of points: for --m {m} at least 2·{m} + 1 = {}",
            2 * m + 1
        ));
    }
    if points > MOST_POINTS {
        return Err(format!(
            "--points {points} is more than is solved for: at most {MOST_POINTS}; the elongation of longer bars is the limit"
        ));
    }
    let ends = match arguments.ends {
        Weight::Full => Ends::Full,
        Weight::Half => Ends::Half,
    };
    // both fit: they were compared above
    Bar::new(m as usize, points as usize, ends, arguments.homogenize).map_err(|e| match e {
        BarError::TooFew { points, least, .. } => format!(
            "--points {points} is too few for --m {m}: no point would see its whole family; write --points {least} or more, \
             or a smaller --m"
        ),
        other => other.to_string(),
    })
}

fn texts(fractions: &[Q]) -> Vec<String> {
    fractions.iter().map(Q::to_string).collect()
}

/// A whole number as one, another as a fraction.
fn number(x: &Q) -> Value {
    let value = x.value();
    // whole numbers below 2^53 are exact
    if x.is_integer() && value.abs() < 9e15 {
        json!(value as i64)
    } else {
        json!(x.to_string())
    }
}

/// The rows in units of cA over their scale.
fn corner(corner: &Corner) -> (Value, Value) {
    let row = |row: &Vec<Q>| row.iter().map(number).collect::<Vec<Value>>();
    let rows: Vec<Vec<Value>> = corner.rows.iter().map(row).collect();
    (number(&Q::from_integer(corner.scale.clone())), json!(rows))
}

fn json(found: &Found) -> Value {
    let Found { bar, .. } = found;
    let (scale, rows) = corner(&found.corner);
    json!({
        "m": bar.m(),
        "points": bar.points(),
        "ends": ends(bar),
        "homogenized": bar.homogenized(),
        "f": found.f.as_ref().map(Q::to_string),
        "f_decimal": found.decimal,
        "f_limit": decimals(&found.limit, DIGITS),
        "alpha": texts(&found.factors),
        "stiffness_scale": scale,
        "stiffness_corner": rows,
        "energy_density": texts(&found.energy),
        "micromodulus_factor": micromodulus::half_way::<Q>(bar.m()).to_string(),
    })
}

fn ends(bar: &Bar) -> &'static str {
    match bar.ends() {
        Ends::Full => "full",
        Ends::Half => "half",
    }
}

fn report(found: &Found) -> String {
    let Found { bar, .. } = found;
    let (m, points) = (bar.m(), bar.points());
    let kind = if bar.homogenized() {
        "homogenized"
    } else {
        "not homogenized"
    };
    let f = match &found.f {
        None => format!(
            "{}; the fraction is printed where points times m is at most {LONGEST_FRACTION}",
            found.decimal
        ),
        Some(f) => match f.to_string() {
            long if long.len() > 80 => format!(
                "{}; a fraction of {} digits: --json prints it",
                found.decimal,
                long.len() - 1
            ),
            short => format!("{short} = {}", found.decimal),
        },
    };
    let mut lines = vec![
        format!(
            "bar       m = {m}, {points} points, {}-weight ends, {kind}",
            ends(bar)
        ),
        format!("f({points})  {f}"),
        format!("f(∞)      {}", decimals(&found.limit, DIGITS)),
        "          elongation over (N−1)Δ σ/E, that of the classical bar".to_string(),
    ];
    if m > 1 {
        lines.push(format!("alpha     {}", texts(&found.factors).join("  ")));
        lines.push(
            "          factors of the bonds between an end and its neighbours, nearest first"
                .to_string(),
        );
    }
    lines.push(format!("energy    {}", texts(&found.energy).join("  ")));
    lines.push(format!(
        "          Σ cξV of points 1 to m+1 in uniform strain; {} inside",
        m * m
    ));
    let rows: Vec<Vec<String>> = found.corner.rows.iter().map(|r| texts(r)).collect();
    let width = rows.iter().flatten().map(String::len).max().unwrap_or(0);
    if m <= 10 {
        lines.push(format!(
            "stiffness first {} rows and columns, in units of cA/{}",
            m + 1,
            found.corner.scale
        ));
        for row in rows {
            let cells: Vec<String> = row.iter().map(|t| format!("{t:>width$}")).collect();
            lines.push(format!("          {}", cells.join("  ")));
        }
    }
    lines.join("\n")
}
