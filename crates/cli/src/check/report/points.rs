//! Points, bonds and families.

use super::row::{AXES, row};
use crate::check::Findings;
use crate::numbers::whole;
use peridyne_io::deck::{Dim, each_once};
use peridyne_theory::patch_test::{Class, Place};
use std::fmt::Write;

pub(super) fn points(found: &Findings) -> String {
    let (info, units) = (&found.info, found.units);
    let d = info.dimension;
    let mut out = String::from("Points and bonds\n");
    row(&mut out, "points", whole(info.points));
    let span = |a: usize| {
        let [low, high] = found.extent(a).map(|x| units.show(x, Dim::LENGTH));
        format!("{} {low} to {high}", AXES[a])
    };
    let spans: Vec<String> = (0..d).map(span).collect();
    row(&mut out, "extent", spans.join(", "));
    row(
        &mut out,
        "volume, mass",
        format!(
            "{}, {}",
            units.show(info.volume, Dim::VOLUME),
            units.show(info.mass, Dim::MASS)
        ),
    );
    let atoms = found.spec.potential().is_some();
    row(
        &mut out,
        if atoms { "cut-off" } else { "horizon" },
        format!(
            "{} = {:.4} spacings of {}",
            units.show(info.horizon, Dim::LENGTH),
            info.horizon / info.spacing,
            units.show(info.spacing, Dim::LENGTH)
        ),
    );
    row(
        &mut out,
        "bonds",
        format!(
            "{}, as a {}",
            whole(each_once(info.directed_bonds)),
            info.family_kind
        ),
    );
    for (n, sweeps) in info.sweeps.iter().enumerate() {
        let Some(sweeps) = sweeps else { continue };
        let of = match info.bodies.get(n) {
            Some((name, _)) => format!("{name}: "),
            None => String::new(),
        };
        row(&mut out, "bond forces", format!("{of}{sweeps}"));
    }
    let (least, mean, most) = info.family;
    row(
        &mut out,
        "family size",
        format!("{least} to {most}, mean {mean:.2}"),
    );
    for (n, (name, points)) in info.bodies.iter().enumerate() {
        let gaps = info.gaps.iter().filter_map(|g| {
            let other = match g.bodies {
                [a, b] if a == n => b,
                [a, b] if b == n => a,
                _ => return None,
            };
            let distance = units.show(g.distance, Dim::LENGTH);
            Some(format!("{distance} from {}", info.bodies[other].0))
        });
        let gaps: Vec<String> = gaps.collect();
        let near = match gaps.is_empty() {
            true => "no other within the horizon or the range of contact".to_string(),
            false => gaps.join(", "),
        };
        row(
            &mut out,
            "body",
            format!("{name}: {} points, {near}", whole(*points)),
        );
    }
    let near = match info.near_horizon {
        0 => "no bond within round-off of it".to_string(),
        n => format!("{} bonds within round-off of it", whole(n)),
    };
    if !atoms {
        row(&mut out, "near the horizon", near);
    }
    if info.cut > 0 {
        row(
            &mut out,
            "pre-cracks cut",
            format!("{} bonds", whole(each_once(info.cut))),
        );
    }
    out
}

/// Where points are, by the part of a full family that they have, as a histogram.
pub(super) fn families(found: &Findings) -> String {
    let Some(patch) = &found.patch else {
        return String::new();
    };
    let d = found.info.dimension;
    let total = found.info.points.max(1) as f64;
    let mut out = String::from(
        "Families (by the part of a full family that a point has)\n  place             points   share  mean size  of a full one\n",
    );
    for place in Place::ALL {
        let classes: Vec<&Class> = patch.classes.iter().filter(|c| c.place == place).collect();
        let count: usize = classes.iter().map(|c| c.points).sum();
        if count == 0 {
            continue;
        }
        let mean = |value: fn(&Class) -> f64| {
            classes
                .iter()
                .map(|c| value(c) * c.points as f64)
                .sum::<f64>()
                / count as f64
        };
        let share = count as f64 / total;
        let _ = writeln!(
            out,
            "  {:<12}{:>12}{:>6.1} %{:>11.1}{:>13.1} %  {}",
            place.name(d),
            whole(count as u64),
            100.0 * share,
            mean(|c| c.family),
            100.0 * mean(|c| c.part),
            "▇".repeat((30.0 * share).ceil() as usize)
        );
    }
    out
}
