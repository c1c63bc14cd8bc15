//! `convergence.csv`, `.json` and the picture.

use super::level::Level;
use super::{Finished, words};
use peridyne_io::deck::UnitSystem;
use peridyne_io::write::WriteError;
use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;
use peridyne_theory::convergence::{Kind, Order};
use serde_json::{Value, json};
use std::path::Path;

fn length_unit(units: UnitSystem) -> &'static str {
    match units {
        UnitSystem::Si => "m",
        UnitSystem::Metal(_) => "Å",
        UnitSystem::Lj | UnitSystem::None => "",
    }
}

pub fn write(dir: &Path, f: &Finished, units: UnitSystem) -> Result<(), WriteError> {
    create_directory(dir)?;
    let length = length_unit(units);
    let time = match units {
        UnitSystem::Si => "s",
        UnitSystem::Metal(_) => "ps",
        UnitSystem::Lj | UnitSystem::None => "",
    };
    let column = |get: &dyn Fn(&Level) -> f64| -> Vec<f64> { f.levels.iter().map(get).collect() };
    Table::new()
        .column("spacing", length, column(&|l| l.spacing))
        .column("horizon", length, column(&|l| l.horizon))
        .column("m", "", column(&|l| l.horizon / l.spacing))
        .column("points", "", column(&|l| l.points as f64))
        .column("volume", "", column(&|l| l.volume))
        .column("steps", "", column(&|l| l.steps as f64))
        .column("time step", time, column(&|l| f.time / l.steps as f64))
        .column(
            "error rms",
            "",
            column(&|l| l.error.map_or(f64::NAN, |e| e[0])),
        )
        .column(
            "error max",
            "",
            column(&|l| l.error.map_or(f64::NAN, |e| e[1])),
        )
        .column(
            "difference to the next",
            "",
            column(&|l| l.difference.unwrap_or(f64::NAN)),
        )
        .save(&dir.join("convergence.csv"))?;
    write_file(&dir.join("convergence.json"), |w| {
        Ok(serde_json::to_writer_pretty(w, &json(f))?)
    })?;
    // without an order there is no positive error to put on a logarithmic axis
    if f.order().is_some() {
        plot(f, length).save(dir, "convergence")?;
    }
    Ok(())
}

fn plot(f: &Finished, length: &str) -> Plot {
    let name = if f.kind == Kind::M {
        "spacing"
    } else {
        "horizon"
    };
    let mut plot = Plot::new(f.kind.name())
        .x(name, length)
        .y("relative error of the displacement", "")
        .log_x()
        .log_y();
    let series = |get: &dyn Fn(&Level) -> Option<f64>| -> (Vec<f64>, Vec<f64>) {
        f.levels
            .iter()
            .filter_map(|l| get(l).map(|e| (l.length(f.kind), e)))
            .unzip()
    };
    let against = match f.exact.is_empty() {
        true => "against the finest level",
        false => "against the exact solution",
    };
    let (x, y) = series(&|l| l.error.map(|e| e[0]));
    plot = plot.series(against, &x, &y, Stroke::Solid, Mark::Disc);
    let (x, y) = series(&|l| l.difference);
    plot = plot.series("to the next level", &x, &y, Stroke::Solid, Mark::Square);
    if let Some(o) = f.order() {
        // many points: the legend keeps away from them
        let ends = [&f.levels[0], &f.levels[f.levels.len() - 1]].map(|l| l.length(f.kind));
        let x: Vec<f64> = (0..=60)
            .map(|n| ends[0] * libm::pow(ends[1] / ends[0], f64::from(n) / 60.0))
            .collect();
        let y: Vec<f64> = x
            .iter()
            .map(|h| o.constant * libm::pow(*h, o.fitted))
            .collect();
        plot = plot.dashed(&format!("order {:.2}", o.fitted), &x, &y);
    }
    plot
}

fn of(order: &Option<Order>) -> Value {
    order.as_ref().map_or(Value::Null, |o| {
        json!({
            "fitted": o.fitted,
            "constant": o.constant,
            "between_levels": o.pairwise,
            "verdict": format!("{:?}", o.verdict).to_lowercase(),
            "in_words": words(o.verdict),
        })
    })
}

fn json(f: &Finished) -> Value {
    json!({
        "study": f.kind.name(),
        "reference": match f.exact.is_empty() {
            true => json!("finest level"),
            false => json!({ "exact": f.exact }),
        },
        "time": f.time,
        "time_step": f.time_step,
        "points_compared": f.points,
        "time_error_of_the_finest_level": f.time_error,
        "levels": f.levels.iter().map(|l| json!({
            "spacing": l.spacing,
            "horizon": l.horizon,
            "points": l.points,
            "volume": l.volume,
            "steps": l.steps,
            "seconds": l.seconds,
            "error_rms": l.error.map(|e| e[0]),
            "error_max": l.error.map(|e| e[1]),
            "difference_to_the_next": l.difference,
        })).collect::<Vec<_>>(),
        "order_of_errors": of(&f.errors),
        "order_of_differences": of(&f.differences),
        "notes": f.notes,
    })
}
