//! Boundary and initial conditions of both programs.

use super::increments::{self, Stage};
use super::program::Program;
use super::quoted;
use super::tree::{Entry, same};

/// One condition of the other program.
struct Given<'a> {
    entry: &'a Entry,
    table: &'static str,
    key: &'static str,
    set: String,
    axis: usize,
    value: &'a str,
}

/// What a condition does here: the table and the key.
fn kind(entry: &Entry) -> Result<(&'static str, &'static str), String> {
    let plain = |key: &str| {
        entry
            .text(key)
            .unwrap_or("")
            .to_lowercase()
            .replace('_', " ")
    };
    let (given, variable) = (plain("Type"), plain("Variable"));
    let initial = given.starts_with("initial");
    let key = match (given.trim_start_matches("initial").trim(), &*variable) {
        ("neumann", _) => return Err("PeriLab reads Neumann conditions and applies none".into()),
        // Peridigm says it in the type, PeriLab in the variable
        ("prescribed displacement" | "displacement", _) | (_, "displacements") => "displacement",
        ("velocity", _) | (_, "velocity") => "velocity",
        ("body force", _) | (_, "body forces" | "force densities") => "body_force",
        (_, "forces") => "force",
        _ => {
            return Err(format!("no condition of type \"{given}\" {variable}")
                .trim_end()
                .into());
        }
    };
    match (initial, key) {
        (true, "body_force" | "force") => Err("a body force has no initial value".into()),
        (true, key) => Ok(("initial", key)),
        (false, key) => Ok(("boundary_condition", key)),
    }
}

/// Tables of the conditions.
pub fn conditions(all: &Entry, stage: &Stage, remarks: &mut Vec<String>) -> String {
    let mut given: Vec<Given> = vec![];
    for entry in all.lists() {
        match read(entry, stage) {
            Ok(one) => given.push(one),
            Err(why) => entry.refuse(&why),
        }
    }
    let mut out = String::new();
    for one in &given {
        let entry = one.entry;
        match value(one, &given, stage, remarks) {
            Ok((key, value)) => {
                out += &format!(
                    "\n# {}\n[[{}]]\nset = {}\n{key} = {{ {} = {} }}\n",
                    entry.key.replace(['\n', '\r'], " "),
                    one.table,
                    quoted(&one.set),
                    AXES[one.axis],
                    quoted(&value)
                );
            }
            Err(why) => entry.refuse(&why),
        }
    }
    out
}

const AXES: [&str; 3] = ["x", "y", "z"];

fn read<'a>(entry: &'a Entry, stage: &Stage) -> Result<Given<'a>, String> {
    let (table, key) = kind(entry)?;
    let set = entry.text("Node Set").or_else(|| entry.text("Block"));
    let set = set.ok_or("it has no Node Set")?;
    let name = stage.names.iter().find(|s| same(s, set));
    let name = name.ok_or_else(|| format!("there is no node set \"{set}\", or it is empty"))?;
    let axis = entry.text("Coordinate").unwrap_or("x").to_lowercase();
    let axis = AXES.iter().position(|a| *a == axis);
    let axis = axis.ok_or("the coordinate is not x, y or z")?;
    if axis == 2 && stage.dimension == 2 {
        return Err("there is no z in 2-D".into());
    }
    Ok(Given {
        entry,
        table,
        key,
        set: name.clone(),
        axis,
        value: entry.text("Value").ok_or("it has no Value")?,
    })
}

/// The key of a condition, and its value as the program applies it.
fn value(
    given: &Given,
    all: &[Given],
    stage: &Stage,
    remarks: &mut Vec<String>,
) -> Result<(&'static str, String), String> {
    let (clock, from) = (stage.solver.clock, stage.solver.from);
    match (stage.program, given.table, given.key) {
        // initial values are those at time 0, also where a deck begins later
        (Program::Peridigm, "initial", key) => Ok((key, clock.at(given.value, 0.0)?)),
        (Program::PeriLab, "initial", _) if from != 0.0 => Err(format!(
            "PeriLab applies initial values at time 0 alone, and it begins at {from:?}"
        )),
        (Program::PeriLab, "initial", key) => Ok((key, clock.at(given.value, 0.0)?)),
        (Program::Peridigm, _, "displacement") => {
            let initial = |g: &&Given| {
                g.table == "initial" && g.key == "displacement" && g.axis == given.axis
            };
            let before: Vec<(&str, Vec<u32>)> = { all.iter().filter(initial) }
                .map(|g| (g.value, stage.points.of(&g.set)))
                .collect();
            let (value, told) = increments::total(given.value, &given.set, &before, stage)?;
            if told {
                remarks.push("Peridigm adds what a prescribed displacement changes by in each step: f(t) - f(t0) on what is there at the start; one that does not change is taken itself".into());
            }
            Ok(("displacement", value))
        }
        (_, _, "force") => {
            let volume = stage.points.volume_of(&given.set);
            let volume = volume.ok_or("it is a force on each point, and their volumes differ: give a body force for each volume")?;
            Ok((
                "body_force",
                format!("({})/{volume:?}", clock.expression(given.value)?),
            ))
        }
        (_, _, key) => Ok((key, clock.expression(given.value)?)),
    }
}
