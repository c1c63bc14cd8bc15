//! Continuum fields.

use super::row::row;
use crate::check::Findings;
use crate::check::continuum::{Found, Seen};
use crate::numbers::{duration, memory, whole};
use peridyne_io::continuum::plan::Place;
use peridyne_io::deck::Dim;
use std::fmt::Write;

pub(super) fn fields(found: &Findings) -> String {
    let mut out = String::new();
    for one in &found.fields {
        let _ = writeln!(out, "Continuum fields, folder {}", one.asked.name);
        rows(&mut out, found, one);
    }
    out
}

fn rows(out: &mut String, found: &Findings, one: &Found) {
    let (asked, spacing) = (&one.asked, found.info.spacing);
    let formula = format!("{}: {}", asked.shape.name(), asked.shape.formula());
    row(out, "function", formula);
    let mut width = format!(
        "S = {} = {:.2} spacings of the particles",
        found.units.write(asked.width, Dim::LENGTH),
        asked.width / spacing
    );
    if let Some(Seen::Made { grid, .. }) = &one.seen
        && let Some(widest) = grid.iter().copied().reduce(f64::max)
    {
        let _ = write!(width, ", {:.2} of the points", asked.width / widest);
    }
    row(out, "width", width);
    let points = match &asked.place {
        Place::Grid { counts, .. } => {
            let [x, y, z] = counts;
            format!("a grid of {x} × {y} × {z}")
        }
        Place::Points(points) => whole(points.len() as u64),
    };
    row(out, "points", points);
    let frames = match asked.every {
        Some(every) => format!("{}, one in {every} steps: their means", whole(one.frames)),
        None => "the last state".into(),
    };
    let each = if asked.each { ", and each of them" } else { "" };
    row(out, "frames", frames + each);
    match &one.seen {
        Some(Seen::Made {
            made,
            missing,
            seconds,
            ..
        }) => {
            let names: Vec<&str> = made.iter().map(|q| q.symbol()).collect();
            row(out, "quantities", names.join(" "));
            for (quantity, why) in missing {
                row(out, "", format!("no {}: {why}", quantity.symbol()));
            }
            let all = duration(seconds * one.frames as f64);
            let each = duration(*seconds);
            row(
                out,
                "time",
                format!("about {each} for a frame, {all} for all, and residuals"),
            );
        }
        Some(Seen::Nothing(why)) => row(out, "quantities", format!("none: {why}")),
        None => row(out, "time", "too many points to try a frame"),
    }
    row(out, "disk", format!("at most {}", memory(one.bytes)));
}
