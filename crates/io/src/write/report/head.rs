//! What stands at the head of a report, and its words about files and sources.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::NAME;
use super::history::Column;
use super::scene::Scene;
use crate::write::run_json::Setting;

/// Numbers at a glance: name, value, unit ("#" of what is counted), and what is beside it.
pub fn facts(run: &Value, setting: &Setting, history: &[Column]) -> Vec<Value> {
    let mut all = vec![];
    let mut fact = |name: &str, value: Value, unit: &str, more: String| {
        if !value.is_null() {
            all.push(json!([name, value, unit, more]));
        }
    };
    let number = |key: &str| run[key].as_f64();
    let some = |key: &str| number(key).filter(|v| *v > 0.0);
    let points = some("particles").or(some("points"));
    let word = if setting.atoms { "Atoms" } else { "Points" };
    let dimension = match setting.dimension {
        0 => String::new(),
        d => format!("in {d}-D"),
    };
    fact(word, points.into(), "#", dimension);
    let bonds = some("bonds");
    if !setting.atoms {
        fact("Bonds", bonds.into(), "#", String::new());
    }
    let steps = number("steps");
    let last = |name: &str| {
        let column = history.iter().find(|c| c.name == name)?;
        column.values.last().copied()
    };
    let time = last("time").or(last("t"));
    let units = &setting.units;
    if setting.statics {
        fact("Increments of load", steps.into(), "#", String::new());
    } else {
        let time_step = some("time_step");
        let more = match (steps, time_step) {
            (Some(n), Some(_)) | (Some(n), None) => format!("{n:.0} steps"),
            (None, _) => String::new(),
        };
        fact("Time", time.into(), &units.time, more);
        fact("Time step", time_step.into(), &units.time, String::new());
    }
    if let (Some(broken), Some(bonds)) = (some("broken_bonds"), bonds) {
        let part = format!("{} % of all", digits(100.0 * broken / bonds));
        fact("Broken bonds", broken.into(), "#", part);
    }
    if let Some(fragments) = some("fragments") {
        fact("Fragments", fragments.into(), "#", String::new());
    }
    if let Some(residual) = run["energy"]["balance_error"].as_f64() {
        let of = |key: &str| run["energy"][key].as_f64().unwrap_or(0.0).abs();
        let given = of("initial") + of("work_boundary_conditions") + of("work_rigid_bodies");
        if given > 0.0 {
            let part = 100.0 * residual.abs() / given;
            let text = match part < 0.001 {
                true => "< 0.001 %".to_string(),
                false => format!("{} %", digits(part)),
            };
            let more = "of the energy that came in".to_string();
            fact("Energy balance error", text.into(), "", more);
        }
    }
    let threads = run["threads"].as_u64();
    let more = match (threads, some("ns_per_bond_step"), some("ns_per_point_step")) {
        (Some(1), Some(ns), _) => format!("1 thread, {} ns per bond and step", digits(ns)),
        (Some(n), Some(ns), _) => format!("{n} threads, {} ns per bond and step", digits(ns)),
        (_, _, Some(ns)) => format!("{} ns per point and step", digits(ns)),
        (_, None, None) | (None, Some(_), None) => String::new(),
    };
    fact(
        "Computing time",
        number("seconds_stepping").into(),
        "s",
        more,
    );
    all
}

/// Three significant digits.
fn digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    format!("{rounded}")
}

/// What stands behind how the run ended.
pub fn subtitle(run: &Value) -> String {
    let text = |key: &str| run[key].as_str().unwrap_or("");
    let deck = text("deck").rsplit(['/', '\\']).next().unwrap_or("");
    format!("{deck} by peridyne {}", text("version"))
}

pub fn cite(run: &Value) -> String {
    let text = |key: &str| run[key].as_str().unwrap_or("");
    format!(
        "peridyne, version {}: peridynamics and molecular dynamics. With it name the deck “{}” and its hash, {}.",
        text("version"),
        text("deck"),
        text("deck_hash")
    )
}

/// The field that is shown first: damage where bonds broke, displacements in statics and of modes, speed of atoms.
pub fn first(scene: &Scene, run: &Value, setting: &Setting) -> String {
    let broken = run["broken_bonds"].as_u64().unwrap_or(0) > 0;
    let mut wanted = vec![];
    if scene.kind == "run" && broken {
        wanted.push("damage");
    }
    match (scene.kind, setting.atoms) {
        ("law", _) => wanted.push("u"),
        ("run", true) => wanted.extend(["kind", "material", "velocity"]),
        _ => {}
    }
    let moves = scene.moved.iter().any(|m| m.size > 0.0);
    let there = |name: &&&str| scene.fields.iter().any(|f| f.name == **name);
    match wanted.iter().find(there) {
        Some(name) => (*name).to_string(),
        None if moves => "displacement".into(),
        None => { scene.fields.first() }.map_or(String::new(), |f| f.name.clone()),
    }
}

/// Files of the run: name, bytes, what they are.
pub fn files(dir: &Path, setting: &Setting) -> Vec<Value> {
    let own = ["run.json".to_string()];
    let names = setting.files.iter().chain(&own);
    let known = names.filter_map(|name| {
        let bytes = fs::metadata(dir.join(name)).ok()?.len();
        let says = match name.rsplit('/').next().unwrap_or(name) {
            "history.csv" => "Energies and probes over time.",
            "run.json" => "What ran and how it ended, for programs.",
            "points.pvd" if name.starts_with("modes") => "Shapes of modes for ParaView.",
            "points.pvd" => "Frames of the points for ParaView (points_*.vtu).",
            "bonds.pvd" => "Bonds as lines for ParaView (bonds_*.vtu).",
            "modes.csv" => "Frequencies of modes.",
            "frames.npz" => "Frames for NumPy: x, t, u.",
            "linear_body.npz" => "The linear body about the last state, for NumPy.",
            n if n.ends_with(".png") => "Picture.",
            n if n.ends_with(".svg") => "Drawing.",
            n if n.ends_with(".extxyz") || n.ends_with(".xyz") => {
                "Trajectory of the atoms (extended XYZ)."
            }
            n if n.ends_with(".lammpstrj") || n.ends_with(".dump") => "Frames as a LAMMPS dump.",
            _ => "",
        };
        Some(json!({"name": name, "bytes": bytes, "says": says, "link": true}))
    });
    known.filter(|f| f["name"] != NAME).collect()
}
