//! Heat and species: how fast, and in which steps.

use super::row::row;
use crate::check::Findings;
use crate::numbers::whole;
use peridyne::spec::DiffusionMethod;
use peridyne_io::deck::Dim;

pub(super) fn spread(found: &Findings) -> String {
    let (info, units) = (&found.info, found.units);
    let mut out = String::new();
    for t in &info.diffusions {
        if out.is_empty() {
            out.push_str("Heat and species\n");
        }
        let name = t.quantity.name();
        let each = t.diffusivity.iter().zip(&found.materials);
        let each = each.map(|(d, m)| {
            let of = match found.materials.len() {
                1 => String::new(),
                _ => format!(" of {}", m.name),
            };
            format!("{}{of}", units.show(*d, Dim::DIFFUSIVITY))
        });
        let all: Vec<String> = each.collect();
        row(&mut out, &format!("{name}, diffusivity"), all.join(", "));
        let time = |x: f64| units.show(x, Dim::TIME);
        row(
            &mut out,
            "over the body",
            format!("in about {} (extent² / diffusivity)", time(t.spread)),
        );
        let steps = match t.method {
            DiffusionMethod::Explicit { safety } => {
                let parts = (info.time_step / (safety * t.stable_step)).ceil().max(1.0);
                format!(
                    "explicit, {} of the run in {} of at most {safety} of the stable {}",
                    time(info.time_step),
                    match parts > 1.0 {
                        true => format!("{} parts", whole(parts as u64)),
                        false => "one part".into(),
                    },
                    time(t.stable_step)
                )
            }
            DiffusionMethod::Implicit { .. } => format!(
                "implicit, {} times the stable explicit {}",
                peridyne_io::deck::rounded(info.time_step / t.stable_step, 3),
                time(t.stable_step)
            ),
            DiffusionMethod::Steady { .. } => "steady after every step".into(),
        };
        row(&mut out, "its steps", steps);
    }
    out
}
