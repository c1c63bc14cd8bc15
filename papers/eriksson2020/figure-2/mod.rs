//! Fig. 2: a short bar with full-weight ends.

use peridyne_theory::homogenize::bar::Ends;

use super::STRAIN;
use super::pulled::{Pulled, caption};
use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    Figure2,
    "figure-2",
    "Displacement of a bar with full-weight ends",
    ["../pulled.rs", "../../gallery/bench.rs", "deck.toml"]
);

/// The bar that is not homogenized, lengths in spacings, σ = 0.001 E.
const DECK: &str = include_str!("deck.toml");

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let pulled = Pulled::new(context, Ends::Full, &mut found)?;
    found.number("homogenized", pulled.off(0.0));
    found.text("end", pulled.bars[0].f().to_string());
    // its elongation by the engine: the first point is held
    let u = Bench::finished(DECK, &[])?.values("displacement", 0)?;
    let points = u.len();
    found.number("deck", u[points - 1] / (STRAIN * (points - 1) as f64));
    let errors = pulled.errors(0);
    let end = errors[errors.len() - 1];
    found.number("end-error", end);
    let e = pulled.strains();
    let mirrored = e
        .iter()
        .zip(e.iter().rev())
        .all(|(a, b)| (a - b).abs() < 1e-13);
    let largest = e.iter().copied().fold(0.0, f64::max);
    found.holds(
        "strains",
        format!(
            "strains over σ/E from end to middle: {:.4}, {:.4}, {:.4}",
            e[0], e[1], e[2]
        ),
        mirrored && largest - e[0] < 1e-13 && e[1] < e[0] && e[2] < e[0],
    );
    caption(&mut found, Ends::Full, [1.5, 2.5])?;
    Ok(found)
}
