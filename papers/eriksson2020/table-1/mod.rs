//! Table 1: f(N) at the shortest bars and in the limit.

use peridyne_io::write::table::Table;
use peridyne_theory::exact::{Field, Q};
use peridyne_theory::homogenize::bar::Ends;
use peridyne_theory::homogenize::bar::limit::decimals;

use super::bar;
use crate::{Context, Failure, Findings};

experiment!(Table1, "table-1", "f(N) of bars", []);

/// An approximation of f by N.
type Formula = fn(f64) -> f64;

/// Largest relative difference of a formula from f(N), 2m+1 ≤ N ≤ `most`, where, and the part of all N with less than 1 %.
fn worst(
    m: usize,
    ends: Ends,
    most: usize,
    formula: Formula,
) -> Result<(f64, usize, f64), Failure> {
    let mut worst = (0.0, 0);
    let mut good = 0;
    for points in 2 * m + 1..=most {
        let off = (formula(points as f64) / bar(m, points, ends, false)?.f().value() - 1.0).abs();
        good += usize::from(off < 0.01);
        if off > worst.0 {
            worst = (off, points);
        }
    }
    Ok((worst.0, worst.1, good as f64 / (most - 2 * m) as f64))
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let (mut names, mut short, mut limits) = (vec![], vec![], vec![]);
    for m in [2, 3, 4] {
        let n = 2 * m + 1;
        for (ends, weight) in [(Ends::Half, "half"), (Ends::Full, "full")] {
            for homogenized in [false, true] {
                let bar = bar(m, n, ends, homogenized)?;
                let (f, limit) = (bar.f(), decimals(&bar.f_limit().value, 30));
                let name = format!(
                    "δ = {m}Δ, {weight}-weight ends, {}",
                    super::kind(homogenized)
                );
                let key = format!(
                    "{weight}-{m}{}",
                    if homogenized { "-homogenized" } else { "" }
                );
                // printed as a decimal where m = 4, but for the 1 of full ends
                if m == 4 && !(homogenized && ends == Ends::Full) {
                    found.number(&key, f.value());
                } else {
                    found.text(&key, f.to_string());
                }
                if !homogenized {
                    found.text(&format!("{key}-limit"), limit.clone());
                }
                names.push(name);
                short.push(f.to_string());
                limits.push(limit);
            }
        }
    }
    let path = context.out.join("table.csv");
    Table::new()
        .text("bar", names)
        .text("f(2m+1)", short)
        .text("limit", limits)
        .save(&path)?;
    found.file(path);

    let most = if context.small { 60 } else { 400 };
    let fits: [(&str, usize, Ends, Formula); 4] = [
        ("fit-half-2", 2, Ends::Half, |n| {
            (7.0 + 5.0 * n) / (4.0 * (n - 1.0))
        }),
        ("fit-half-3", 3, Ends::Half, |n| {
            (2583.0 + 495.0 * n) / (440.0 * (n - 1.0))
        }),
        ("fit-full-2", 2, Ends::Full, |n| (15.0 / 17.0 + n) / n),
        ("fit-full-3", 3, Ends::Full, |n| (1841.0 / 718.0 + n) / n),
    ];
    for (key, m, ends, formula) in fits {
        let (off, points, good) = worst(m, ends, most, formula)?;
        let text = format!(
            "up to N = {most} below 1 % for {:.0} % of all N, at most {:.2} % off, at N = {points}",
            100.0 * good,
            100.0 * off
        );
        found.holds(key, text, good > 0.5);
    }
    let digits = |f: &Q| f.numer().to_string().len().max(f.denom().to_string().len());
    let mut longest = 0;
    for ends in [Ends::Half, Ends::Full] {
        longest = longest.max(digits(&bar(4, 9, ends, false)?.f()));
    }
    found.number("digits", longest as f64);
    Ok(found)
}
