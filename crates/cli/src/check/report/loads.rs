//! What acts on sets, as a whole.

use super::row::{AXES, row};
use crate::check::Findings;
use peridyne_io::deck::Dim;

/// Each load with the area that it acts on and the force, or power, that it comes to.
pub(super) fn loads(found: &Findings) -> String {
    let (d, units) = (found.info.dimension, found.units);
    let mut out = String::from("Loads\n");
    for load in &found.info.loads {
        let mut told = vec![];
        if let Some(force) = load.force {
            let along = (0..d).filter(|a| force[*a] != 0.0);
            let each: Vec<String> = along
                .map(|a| format!("{} along {}", units.show(force[a], Dim::FORCE), AXES[a]))
                .collect();
            let most = if load.varies { "up to " } else { "" };
            told.push(match each.is_empty() {
                true => "force 0".into(),
                false => format!("force {most}{}", each.join(", ")),
            });
        }
        if let Some(power) = load.power {
            let start = if load.varies { " at the start" } else { "" };
            told.push(match load.what {
                "heat flux" | "heat source" => format!("{}{start}", units.show(power, Dim::POWER)),
                _ => format!("{}{start}", units.show(power, Dim::FREQUENCY)),
            });
        }
        if let Some(area) = load.area {
            told.push(format!("area {}", units.show(area, Dim::AREA)));
        }
        row(
            &mut out,
            load.what,
            format!("`{}`: {}", load.set, told.join(", ")),
        );
    }
    out
}
