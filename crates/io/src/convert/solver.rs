//! Solvers and outputs of both programs.

use super::conditions::{Clock, field};
use super::tree::{Entry, Value};
use super::{Program, quoted};

/// How the deck runs.
pub struct Solver {
    /// Its table.
    pub text: String,
    pub clock: Clock,
    /// Do bonds break?
    pub damage: bool,
    /// Steps or increments, where they are known.
    steps: Option<u64>,
}

/// Lists of the top whose name begins so, in order.
fn numbered<'a>(root: &'a Entry, word: &str) -> Vec<&'a Entry> {
    let begins = |e: &&Entry| e.key.to_lowercase().starts_with(word);
    root.lists().filter(begins).collect()
}

/// What both programs need and nothing here does.
const RESIDUAL: &str =
    "residuals are measured in another way here: `tolerance` is left at its usual value";

/// The solver of the deck.
///
/// # Errors
/// There is none, or it says no times.
pub fn solver(root: &Entry, program: Program, remarks: &mut Vec<String>) -> Result<Solver, String> {
    let all = numbered(root, "solver");
    let Some((solver, others)) = all.split_first() else {
        return Err("it has no list Solver".into());
    };
    for other in others {
        other.refuse("a deck has one solver: write a second deck");
    }
    solver.idle(&["Verbose", "Material Models", "Maximum Damage"]);
    let damage = match program {
        Program::Peridigm => true,
        Program::PeriLab => solver.is_true("Damage Models"),
    };
    let from = solver.number("Initial Time").unwrap_or(0.0);
    let to = solver
        .number("Final Time")
        .ok_or("the solver has no Final Time")?;
    if !(to > from) {
        return Err(format!("the solver ends at {to}, and begins at {from}"));
    }
    for off in [
        "Thermal Models",
        "Additive Models",
        "Degradation Models",
        "Pre Calculation Models",
    ] {
        if !solver.is_true(off) {
            solver.idle(&[off]);
        } else {
            solver.refuse_entry(off, "there are no such models");
        }
    }
    let moving = Clock {
        start: from,
        scale: 1.0,
    };
    if let Some(list) = solver.list("Verlet") {
        let (time, steps) = step(list, to - from);
        list.refuse_entry(
            "Numerical Damping",
            "write damping in a [[condition]], force density / velocity",
        );
        return Ok(Solver {
            text: format!("\n[run]\n{time}"),
            clock: moving,
            damage,
            steps,
        });
    }
    for name in ["Implicit", "Newmark"] {
        let Some(list) = solver.list(name) else {
            continue;
        };
        let (time, steps) = step(list, to - from);
        let mut text = format!("\n[run]\nintegrator = \"newmark\"\n{time}");
        for (there, here) in [("Beta", "beta"), ("Gamma", "gamma")] {
            if let Some(x) = list.number(there) {
                text += &format!("{here} = {x:?}\n");
            }
        }
        residuals(list);
        if program == Program::Peridigm {
            remarks.push("Peridigm takes the first acceleration of implicit motion as 0; here forces act from the start: loads that are there at t = 0 differ by half a step of them".into());
        }
        return Ok(Solver {
            text,
            clock: moving,
            damage,
            steps,
        });
    }
    for name in [
        "QuasiStatic",
        "NOXQuasiStatic",
        "Static",
        "Linear Static Matrix Based",
    ] {
        let Some(list) = solver.list(name) else {
            continue;
        };
        let steps = ["Number of Load Steps", "Number of Steps"];
        let steps = steps.into_iter().find_map(|key| list.number(key));
        let increments = steps.unwrap_or(1.0).max(1.0) as u64;
        let method = if name.starts_with("Linear") {
            "linear"
        } else {
            "newton"
        };
        list.refuse_entry("Time Steps", "increments of a load are equal here");
        residuals(list);
        remarks.push(format!(
            "t goes from 0 to 1 in statics: conditions have ({from:?} + {:?} t) in place of t",
            to - from
        ));
        return Ok(Solver {
            text: format!("\n[statics]\nmethod = \"{method}\"\nincrements = {increments}\n"),
            clock: Clock {
                start: from,
                scale: to - from,
            },
            damage,
            steps: Some(increments),
        });
    }
    Err("the solver is none of Verlet, Implicit, Newmark, QuasiStatic, NOXQuasiStatic, Static, Linear Static Matrix Based".into())
}

fn residuals(list: &Entry) {
    for key in [
        "Absolute Tolerance",
        "Relative Tolerance",
        "Maximum Solver Iterations",
        "Residual tolerance",
        "Solution tolerance",
        "Maximum number of iterations",
    ] {
        list.refuse_entry(key, RESIDUAL);
    }
}

/// Steps in time: what a table says of them, and how many where that is known. As many whole steps as fit are done.
fn step(list: &Entry, duration: f64) -> (String, Option<u64>) {
    match (list.number("Fixed dt"), list.number("Safety Factor")) {
        (Some(dt), safety) if dt > 0.0 => {
            if safety.is_some_and(|s| s != 1.0) {
                list.refuse_entry("Safety Factor", "the step is given");
            }
            let steps = ((duration / dt).floor() as u64).max(1);
            (
                format!("steps = {steps}\ntime_step = {dt:?}\n"),
                Some(steps),
            )
        }
        (_, Some(s)) if s > 0.0 && s <= 1.0 => {
            let text = format!("duration = {duration:?}\ntime_step = {{ safety = {s:?} }}\n");
            (text, None)
        }
        (_, safety) => {
            if safety.is_some() {
                list.refuse_entry("Safety Factor", "it is above 0 and at most 1 here");
            }
            (format!("duration = {duration:?}\n"), None)
        }
    }
}

/// The table of outputs: one file of frames; `labels` are those of probes.
pub fn output(
    root: &Entry,
    solver: &Solver,
    labels: &[String],
    remarks: &mut Vec<String>,
) -> String {
    let mut lists: Vec<&Entry> = root
        .lists()
        .filter(|e| e.list("Output Variables").is_some())
        .collect();
    if let Some(all) = root.list("Outputs") {
        lists.extend(all.lists());
    }
    let mut fields: Vec<&str> = vec![];
    let (mut name, mut every) = (None, None);
    for list in lists {
        list.idle(&[
            "Output Format",
            "Output File Type",
            "Parallel Write",
            "Write After Damage",
            "Flush File",
        ]);
        let file = list.text("Output Filename");
        let frequency = match list.number("Number of Output Steps").filter(|n| *n >= 1.0) {
            Some(n) => solver.steps.map(|steps| (steps / n as u64).max(1)),
            None => list.number("Output Frequency").map(|n| n.max(1.0) as u64),
        };
        let variables = list.list("Output Variables").map_or(&[][..], Entry::all);
        let mut own = 0;
        for variable in variables {
            let Value::Text(text) = &variable.value else {
                continue;
            };
            let is_label = labels.iter().any(|l| l.eq_ignore_ascii_case(&variable.key));
            let nothing = ["Proc_Num", "Element_Id", "Number of Neighbors"];
            if !text.trim().eq_ignore_ascii_case("true") || is_label {
                variable.own();
                continue;
            }
            if nothing[..2]
                .iter()
                .any(|n| super::tree::same(n, &variable.key))
            {
                // numbers of points are in every file, and there is one process
                variable.own();
                continue;
            }
            match field(&variable.key) {
                Ok((here, note)) => {
                    variable.own();
                    own += 1;
                    if !fields.contains(&here) {
                        fields.push(here);
                    }
                    if let Some(note) = note {
                        remarks.push(format!("line {}: {note}", variable.line));
                    }
                }
                Err(why) => variable.refuse(why),
            }
        }
        match (
            own > 0 || name.is_none(),
            name.is_some() && every != frequency,
        ) {
            (true, true) => list.refuse_entry(
                "Output Frequency",
                "all fields are in the frames of the first output",
            ),
            (true, false) => {
                name = name.or(file);
                every = every.or(frequency);
            }
            (false, _) => {}
        }
        list.refuse_entry("Initial Output Step", "frames begin at the start");
    }
    let mut text = String::from("\n[output]\nvtu = false\n");
    let stem = name.unwrap_or("results");
    let stem = stem.rsplit(['/', '\\']).next().unwrap_or(stem);
    text += &format!("exodus = {}\n", quoted(&format!("{stem}.e")));
    if let Some(every) = every {
        text += &format!("every = {every}\n");
    }
    if !fields.is_empty() {
        text += &format!("fields = {fields:?}\n");
    }
    text
}
