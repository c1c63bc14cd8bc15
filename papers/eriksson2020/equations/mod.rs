//! (9), (12), the printed matrices, (58) and (59), in fractions.

use peridyne_io::write::table::Table;
use peridyne_theory::exact::{Q, q};
use peridyne_theory::homogenize::bar::micromodulus::{half_way, moment};
use peridyne_theory::homogenize::bar::{Bar, Ends};

use super::bar;
use crate::{Context, Failure, Findings};

experiment!(
    Equations,
    "equations",
    "Micromodulus, stiffness matrices and factors",
    []
);

/// Printed matrices: number, m, ends, homogenized, rows and columns that are printed.
const MATRICES: [(&str, usize, Ends, bool, usize); 12] = [
    ("16", 2, Ends::Full, false, 3),
    ("24", 2, Ends::Full, true, 2),
    ("39", 3, Ends::Full, false, 4),
    ("41", 3, Ends::Full, true, 3),
    ("55", 4, Ends::Full, false, 5),
    ("57", 4, Ends::Full, true, 4),
    ("76", 2, Ends::Half, false, 3),
    ("78", 2, Ends::Half, true, 2),
    ("79", 3, Ends::Half, false, 4),
    ("81", 3, Ends::Half, true, 3),
    ("82", 4, Ends::Half, false, 5),
    ("84", 4, Ends::Half, true, 4),
];

/// Rows as text. Of full ends the upper triangle is printed: what is below is its mirror image.
fn rows(bar: &Bar, size: usize) -> String {
    let corner = bar.corner().rows;
    let from = |i: usize| if bar.ends() == Ends::Full { i } else { 0 };
    let row = |i: usize| {
        let cells: Vec<String> = corner[i][from(i)..size].iter().map(Q::to_string).collect();
        cells.join(" ")
    };
    (0..size).map(row).collect::<Vec<_>>().join("; ")
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    // (9): Σ ξ V over Aδ²/2
    let most = 20;
    let on_axis = (1..=most).all(|m| moment::<Q>(m, q(0, 1), q(0, 1)) == q(1, 1));
    let mut curve = true;
    for m in 1..=most {
        for beta in [q(-1, 2), q(-1, 5), q(1, 3), q(2, 5)] {
            let alpha = beta.clone() + beta.clone() * beta.clone() / q(2 * m as i64, 1);
            curve &= moment::<Q>(m, alpha, beta) == q(1, 1);
        }
    }
    found.holds(
        "9",
        format!("1 at α = β = 0: {on_axis}; also on α = β + β²/2m, at four β for m = 1 to {most}: {curve}"),
        on_axis && curve,
    );
    for m in [3, 5] {
        found.number(&format!("12-{m}"), half_way::<f64>(m));
    }
    let formula = (1..=most).all(|m| {
        let k = m as i64;
        half_way::<Q>(m) == q(2 * k + 1, 2 * k).pow(2) / q(k + 1, k)
    });
    found.holds(
        "12",
        format!("as printed for m = 1 to {most}: {formula}"),
        formula,
    );
    let (mut names, mut matrices) = (vec![], vec![]);
    for (number, m, ends, homogenized, size) in MATRICES {
        let text = rows(&bar(m, 2 * m + 1, ends, homogenized)?, size);
        found.text(number, text.clone());
        names.push(format!("({number})"));
        matrices.push(text);
    }
    // factors that were solved for, against the formulas
    let factors = |m: usize, ends| -> Result<Vec<Q>, Failure> {
        Ok(bar(m, 2 * m + 1, ends, true)?.factors())
    };
    let (mut full, mut half, mut printed) = (true, true, true);
    for m in 2..=12usize {
        let k = m as i64;
        let i = 1..k;
        full &=
            factors(m, Ends::Full)? == i.clone().map(|i| q(2 * (k - i) + 1, 2)).collect::<Vec<_>>();
        let solved = factors(m, Ends::Half)?;
        half &= solved == i.clone().map(|i| q(2 * (k - i) + 1, 1)).collect::<Vec<_>>();
        // as printed, the same for all i
        printed &= (m == 2) == (solved == vec![q(2 * (k - 1) + 1, 1); m - 1]);
    }
    found.holds("58", format!("solved for m = 2 to 12, equal: {full}"), full);
    found.holds(
        "59",
        format!("2(m − i) + 1 for m = 2 to 12: {half}; 2(m − 1) + 1 for m = 2 alone: {printed}"),
        half && printed,
    );
    let path = context.out.join("matrices.csv");
    Table::new()
        .text("equation", names)
        .text("rows", matrices)
        .save(&path)?;
    found.file(path);
    Ok(found)
}
