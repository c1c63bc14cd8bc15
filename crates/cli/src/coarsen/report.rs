//! What is told and recorded of a level.

use super::level::Level;
use super::way::Way;
use peridyne::statics::SYMMETRIC;
use peridyne_io::deck::{Dim, UnitSystem, rounded};
use peridyne_io::write::table::Table;
use peridyne_theory::coarsen::waves::{Frequencies, Wave, greatest_frequency};
use peridyne_theory::coarsen::{Mass, Scheme, Stability};
use std::collections::HashSet;

const AXES: [&str; 3] = ["x", "y", "z"];

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

fn mass(way: Way) -> &'static str {
    match way.mass {
        Mass::Blend => "blend",
        Mass::Lumped => "lumped",
        Mass::Consistent => "consistent",
    }
}

/// How fast a level vibrates: waves or modes against level 0, the greatest frequency, the stable step.
pub(super) fn card<const D: usize>(made: &Level<D>, way: Way, units: UnitSystem) -> String {
    let percent = |x: f64| format!("{:+.2} %", 100.0 * x);
    let mut lines = vec![];
    match &made.frequencies {
        Frequencies::Waves(waves) => {
            for axis in 0..D {
                let along = |w: &&Wave| w.axis == axis && w.moves == axis;
                let each: Vec<String> = (waves.iter().filter(along))
                    .filter(|w| [50.0, 25.0, 10.0, 5.0].contains(&w.spacings))
                    .map(|w| format!("{} at {}", percent(w.error()), w.spacings))
                    .collect();
                lines.push(format!(
                    "  frequency of waves along {} ({} mass): {} coarse spacings per wave",
                    AXES[axis],
                    mass(way),
                    each.join(", ")
                ));
            }
        }
        Frequencies::Modes(modes) => {
            let each: Vec<String> = modes.iter().map(|[f, c]| percent(c / f - 1.0)).collect();
            lines.push(format!(
                "  frequency of the lowest modes of the free body ({} mass): {}",
                mass(way),
                each.join(", ")
            ));
        }
        Frequencies::Unknown(why) => lines.push(format!("  no error of frequencies: {why}")),
    }
    if let [Some(fine), Some(coarse)] = made.steps {
        lines.push(format!(
            "  greatest frequency {}, stable step {}, {} times that of level 0",
            units.show(greatest_frequency(coarse), Dim::FREQUENCY),
            units.show(coarse, Dim::TIME),
            rounded(coarse / fine, 3)
        ));
    }
    lines.join("\n")
}

/// Waves of a level, where it is a lattice.
pub(super) fn waves_table<const D: usize>(made: &Level<D>, units: UnitSystem) -> Option<Table> {
    let Frequencies::Waves(waves) = &made.frequencies else {
        return None;
    };
    let axis = |a: usize| AXES[a];
    let column = |of: fn(&Wave) -> f64| waves.iter().map(of).collect::<Vec<f64>>();
    let (length, frequency) = (units.unit(Dim::LENGTH), units.unit(Dim::FREQUENCY));
    Some(
        Table::new()
            .text("along", waves.iter().map(|w| axis(w.axis)))
            .text("moves", waves.iter().map(|w| axis(w.moves)))
            .column("coarse spacings per wave", "", column(|w| w.spacings))
            .column("wavelength", &length, column(|w| w.length))
            .column("frequency of level 0", &frequency, column(|w| w.fine))
            .column("frequency", &frequency, column(|w| w.coarse))
            .column("error", "", column(Wave::error)),
    )
}

fn frequencies(all: &Frequencies) -> serde_json::Value {
    match all {
        Frequencies::Waves(waves) => serde_json::json!({
            "waves": waves.iter().map(|w| serde_json::json!({
                "along": AXES[w.axis], "moves": AXES[w.moves],
                "coarse_spacings": w.spacings, "wavelength": w.length,
                "fine": w.fine, "coarse": w.coarse, "error": w.error(),
            })).collect::<Vec<_>>(),
        }),
        Frequencies::Modes(modes) => serde_json::json!({
            "modes": modes.iter().map(|[f, c]| serde_json::json!({
                "fine": f, "coarse": c, "error": c / f - 1.0,
            })).collect::<Vec<_>>(),
        }),
        Frequencies::Unknown(why) => serde_json::json!({ "unknown": why }),
    }
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
        "bonds": body.partner.len().div_ceil(2),
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
        "masses": mass(way),
        "frequencies": frequencies(&level.frequencies),
        "greatest_frequency": level.steps[1].map(greatest_frequency),
        "stable_step": level.steps[1],
        "stable_step_of_level_0": level.steps[0],
        "range": report.range,
        "seconds": level.seconds,
    })
}
