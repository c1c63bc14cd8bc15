//! The runs that the figures share: the four models of section 4, what is recorded of them, and what is said of all.

use super::chain::Chain;
use super::motion::{Motion, Wanted, run};
use crate::measure::largest;
use crate::{Context, Failure, Findings};

/// A run: its name in the deck, and what it is called.
pub type Name = (&'static str, &'static str);

/// Atoms, the classical continuum, fine and coarse peridynamics.
pub const MODELS: [Name; 4] = [
    ("md", "MD"),
    ("ccm", "CCM"),
    ("pd-fine", "fine PD"),
    ("pd-coarse", "coarse PD"),
];
pub const MD: usize = 0;
pub const CCM: usize = 1;
pub const FINE: usize = 2;
pub const COARSE: usize = 3;
/// Safety factor of (4.13).
pub const SAFETY: f64 = 0.85;
/// When the two pulses have separated.
pub const APART: f64 = 50.0;
/// Distance of the points that all four models have.
pub const SHARED_SPACING: f64 = 0.5;

/// Does all runs, each as a part of the work; `smaller` replaces a chain in the small variant.
///
/// # Errors
/// Those of [`run`].
pub fn all(
    context: &Context,
    text: &str,
    names: &[Name],
    smaller: impl Fn(&str) -> Vec<(&'static str, String)>,
    wanted: impl Fn(u64, f64) -> Wanted,
) -> Result<Vec<Motion>, Failure> {
    let changes = |name| if context.small { smaller(name) } else { vec![] };
    let one = |(name, _): &Name| run(context, text, name, name, &changes(name), &wanted);
    names.iter().map(one).collect()
}

/// Smaller chains for the two models of 100,001 points.
pub fn fewer(name: &str, ccm: Chain, fine: Chain) -> Option<Chain> {
    match name {
        "ccm" => Some(ccm),
        "pd-fine" => Some(fine),
        _ => None,
    }
}

/// Those of Figs. 4.3 and 4.4.
pub fn fewer_points(name: &str) -> Option<Chain> {
    let [ccm, fine] = [(40_001, 8), (8001, 40)].map(|(points, n)| Chain::thousand(points, n));
    fewer(name, ccm, fine)
}

/// Pictures `density-NAME`, the first that the deck asks for.
///
/// # Errors
/// They cannot be written.
pub fn densities(
    context: &Context,
    runs: &[Motion],
    names: &[Name],
    found: &mut Findings,
) -> Result<(), Failure> {
    for (motion, (name, label)) in runs.iter().zip(names) {
        if let Some(density) = motion.images.first() {
            let map = density.map(&motion.titled(label));
            found.picture(map.save(&context.out, &format!("density-{name}"))?);
        }
    }
    Ok(())
}

/// The claim `closed-form`: all runs at the steps that are asked for.
///
/// # Errors
/// A step was not recorded.
pub fn closed_form<'m>(
    runs: impl IntoIterator<Item = &'m Motion>,
    steps: impl Fn(&Motion) -> Vec<u64>,
    found: &mut Findings,
) -> Result<(), Failure> {
    let mut off = vec![];
    for motion in runs {
        for step in steps(motion) {
            off.push(motion.off_closed_form(step)?);
        }
    }
    found.number("closed-form", largest(off));
    Ok(())
}

/// The claim `invariant`.
pub fn invariant(runs: &[Motion], found: &mut Findings) {
    let drift = runs.iter().map(|m| m.drift(|e| e.invariant()));
    found.number("invariant", largest(drift));
}

/// How far the steps of the runs are from (4.13), relative.
pub fn off_the_rule(runs: &[Motion]) -> f64 {
    let rule = |m: &Motion| (m.chain().time_step(SAFETY) / m.time_step - 1.0).abs();
    largest(runs.iter().map(rule))
}

/// Points every [`SHARED_SPACING`].
pub fn shared_x() -> Vec<f64> {
    (0..=2000).map(|j| f64::from(j) * SHARED_SPACING).collect()
}

/// Displacements there.
pub fn shared(motion: &Motion, u: &[f64]) -> Vec<f64> {
    let every = (SHARED_SPACING / motion.spacing).round() as usize;
    u.iter().step_by(every).copied().collect()
}

/// `√∫(a − b)²` of values there.
pub fn distance<'u>(pairs: impl IntoIterator<Item = (&'u f64, &'u f64)>) -> f64 {
    let squares = pairs.into_iter().map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() * SHARED_SPACING).sqrt()
}

/// The lowest displacement, 0 if all are above.
pub fn lowest(u: &[f64]) -> f64 {
    -largest(u.iter().map(|u| -u))
}
