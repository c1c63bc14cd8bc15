//! What is told and recorded of a level.

use super::Level;
use super::way::Way;
use peridyne::statics::SYMMETRIC;
use peridyne_io::deck::{Dim, UnitSystem, rounded};
use peridyne_theory::coarsen::{Scheme, Stability};
use std::collections::HashSet;

pub(super) fn told<const D: usize>(
    level: usize,
    made: &Level<D>,
    way: Way,
    units: UnitSystem,
) -> String {
    let (body, report) = (&made.body, &made.report);
    let small = |x: f64| rounded(x, 2);
    let n = body.points();
    let mut lines = vec![format!(
        "level {level}: {n} points{}, {:.1} bonds each, {}, {:.2} s",
        match made.supports {
            0 => String::new(),
            k => format!(" ({k} only because they are held)"),
        },
        body.partner.len() as f64 / n.max(1) as f64,
        match way.scheme {
            Scheme::Schur => "all others eliminated at once".to_string(),
            Scheme::Energy | Scheme::Rows => format!(
                "balls of radius {} ({} solved{})",
                units.show(report.radius, Dim::LENGTH),
                report.work.solved,
                match report.work.direct {
                    0 => String::new(),
                    k => format!(", {k} by LU"),
                }
            ),
        },
        made.seconds
    )];
    for tried in report.convergence.iter().filter(|t| t.radius.is_finite()) {
        lines.push(format!(
            "  radius {}: effective modulus {}{}",
            units.show(tried.radius, Dim::LENGTH),
            units.show(tried.modulus, Dim::PRESSURE),
            match tried.left.is_finite() || tried.change > 0.0 {
                true => format!(", changed by {} %", rounded(100.0 * tried.change, 2)),
                // the first of all has nothing to be compared with
                false => String::new(),
            }
        ));
    }
    let asymmetry = match report.soundness.asymmetry == report.asymmetry {
        true => format!("asymmetry {}", small(report.asymmetry)),
        false => format!(
            "asymmetry {}, repaired to {}",
            small(report.asymmetry),
            small(report.soundness.asymmetry)
        ),
    };
    lines.push(format!(
        "  {asymmetry}, rotation {}, {}, mass kept to {}",
        small(report.soundness.rotation),
        match report.stability {
            Stability::Definite => "no unstable mode",
            Stability::Stable { .. } => "no unstable mode of the operator as it is",
            Stability::Positive => "no unstable mode (by its symmetric part)",
            Stability::Unknown => "too large to look for unstable modes",
        },
        small((report.mass[1] / report.mass[0] - 1.0).abs()),
    ));
    lines.push(match (way.condensed, report.loss) {
        (true, Some(loss)) => {
            format!("  loads condensed with the body, kept to {}", small(loss))
        }
        (true, None) => "  no loads to condense".into(),
        (false, _) => {
            "  loads as in the paper: the same force density on the volumes of level 0".into()
        }
    });
    lines.join("\n")
}

pub(super) fn record<const D: usize>(level: &Level<D>, way: Way) -> serde_json::Value {
    let (body, report) = (&level.body, &level.report);
    let (stability, growth) = match report.stability {
        Stability::Definite => ("definite", None),
        Stability::Stable { growth } => ("stable", Some(growth)),
        Stability::Positive => ("stable by the symmetric part", None),
        Stability::Unknown => ("not looked at", None),
    };
    let distinct: HashSet<usize> = body.start.windows(2).map(|w| w[1] - w[0]).collect();
    serde_json::json!({
        "points": body.points(),
        "directed_bonds": body.partner.len(),
        "different_family_sizes": distinct.len(),
        "radius": report.radius.is_finite().then_some(report.radius),
        "convergence": report.convergence.iter().map(|t| serde_json::json!({
            "radius": t.radius, "modulus": t.modulus, "change": t.change,
            "left": t.left.is_finite().then_some(t.left),
        })).collect::<Vec<_>>(),
        "balls_solved": report.work.solved,
        "balls_solved_by_lu": report.work.direct,
        "symmetrised": way.symmetrise,
        "symmetric": report.soundness.asymmetry < SYMMETRIC,
        "stability": stability,
        "growth_rate": growth,
        "loads": if way.condensed { "condensed" } else { "silling" },
        "loads_lost": report.loss,
        "supports": if way.supports { "kept" } else { "thinned" },
        "support_points": level.supports,
        "flops": report.work.flops,
        "asymmetry_before_repair": report.asymmetry,
        "asymmetry": report.soundness.asymmetry,
        "rotation": report.soundness.rotation,
        "checked_positive_semidefinite": report.definite,
        "mass": report.mass,
        "range": report.range,
        "seconds": level.seconds,
    })
}
