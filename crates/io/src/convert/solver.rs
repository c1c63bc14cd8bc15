//! Solvers and outputs of both programs.

use super::clock::Clock;
use super::probes::field;
use super::program::Program;
use super::quoted;
use super::tree::{Entry, Value, same};

/// How the deck runs.
pub struct Solver {
    /// Its table.
    pub text: String,
    pub clock: Clock,
    /// Times there: the first and the last.
    pub from: f64,
    pub to: f64,
    /// Do bonds break?
    pub damage: bool,
    /// Steps or increments, where they are known.
    pub steps: Option<u64>,
    /// Part of a velocity that is lost in a unit of time, where it is known; 0: none.
    pub damping: f64,
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
    refuse_models(solver);
    let damage = match program {
        Program::Peridigm => true,
        Program::PeriLab => solver.is_true("Damage Models"),
    };
    let [from, to] = times(solver)?;
    if !(to > from) {
        return Err(format!("the solver ends at {to}, and begins at {from}"));
    }
    let all = All {
        solver,
        program,
        from,
        to,
        damage,
    };
    if let Some(list) = solver.list("Verlet") {
        return Ok(all.verlet(list, remarks));
    }
    let list = |name: &&str| solver.list(name);
    if let Some(list) = ["Implicit", "Newmark"].iter().find_map(list) {
        return Ok(all.newmark(list, remarks));
    }
    for name in [
        "QuasiStatic",
        "NOXQuasiStatic",
        "Static",
        "Linear Static Matrix Based",
    ] {
        if let Some(list) = solver.list(name) {
            return Ok(all.statics(name, list, remarks));
        }
    }
    Err("the solver is none of Verlet, Implicit, Newmark, QuasiStatic, NOXQuasiStatic, Static, Linear Static Matrix Based".into())
}

/// Names models and limits that there are none of here.
fn refuse_models(solver: &Entry) {
    solver.idle(&["Verbose"]);
    if solver
        .text("Material Models")
        .is_some_and(|t| t.eq_ignore_ascii_case("false"))
    {
        solver.refuse_entry(
            "Material Models",
            "bodies here have materials, whose forces act",
        );
    }
    match solver.number("Maximum Damage") {
        Some(most) if most < 1.0 => solver.refuse_entry(
            "Maximum Damage",
            "a run does not end where a point is damaged",
        ),
        _ => {}
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
}

/// What any method is about.
struct All<'a> {
    solver: &'a Entry,
    program: Program,
    from: f64,
    to: f64,
    damage: bool,
}

impl All<'_> {
    fn duration(&self) -> f64 {
        self.to - self.from
    }

    /// One that moves points.
    fn motion(&self, text: String, steps: Option<u64>, damping: f64) -> Solver {
        Solver {
            text,
            clock: Clock {
                start: self.from,
                scale: 1.0,
            },
            from: self.from,
            to: self.to,
            damage: self.damage,
            steps,
            damping,
        }
    }

    fn verlet(&self, list: &Entry, remarks: &mut Vec<String>) -> Solver {
        let (time, steps) = step(list, self.duration(), self.program);
        // a part of the velocity is taken in each step; Peridigm has no such entry
        let part = match self.program {
            Program::PeriLab => list.number("Numerical Damping"),
            Program::Peridigm => None,
        };
        let damping = match (part, steps) {
            (Some(part), Some(steps)) if part >= 0.0 => part * steps as f64 / self.duration(),
            (Some(part), _) if part != 0.0 => {
                list.refuse_entry(
                    "Numerical Damping",
                    "it is a part of the velocity in each step, and there is no Fixed dt, or it is negative: write damping in a [[boundary_condition]], density times that part / step",
                );
                0.0
            }
            _ => 0.0,
        };
        if self.program == Program::PeriLab {
            remarks.push("Verlet of PeriLab (as of August 2026) adds half of the acceleration in each step: its points move as if twice as heavy, from the second step on".into());
        }
        self.motion(format!("\n[run]\n{time}"), steps, damping)
    }

    fn newmark(&self, list: &Entry, remarks: &mut Vec<String>) -> Solver {
        let (time, steps) = match self.program {
            Program::Peridigm => step(list, self.duration(), self.program),
            Program::PeriLab => {
                // its steps are those of statics
                list.idle(&["Safety Factor", "Fixed dt", "Numerical Damping"]);
                let steps = increments(self.solver, list, self.duration(), self.program);
                let step = self.duration() / steps as f64;
                let text = format!("steps = {steps}\ntime_step = {step:?}\n");
                (text, Some(steps))
            }
        };
        let mut text = format!("\n[run]\nintegrator = \"newmark\"\n{time}");
        let names = match self.program {
            Program::Peridigm => [("Beta", "beta"), ("Gamma", "gamma")],
            Program::PeriLab => [("Newmark Alpha", "beta"), ("Newmark Delta", "gamma")],
        };
        for (there, here) in names {
            if let Some(x) = list.number(there) {
                text += &format!("{here} = {x:?}\n");
            }
        }
        residuals(list);
        if self.program == Program::Peridigm {
            remarks.push("Peridigm takes the first acceleration of implicit motion as 0; here forces act from the start: loads that are there at t = 0 differ by half a step of them".into());
        }
        self.motion(text, steps, 0.0)
    }

    fn statics(&self, name: &str, list: &Entry, remarks: &mut Vec<String>) -> Solver {
        let from = self.from;
        let increments = increments(self.solver, list, self.duration(), self.program);
        let method = if name.starts_with("Linear") {
            "linear"
        } else {
            "newton"
        };
        residuals(list);
        // as many whole steps as are nearest to the time that is asked for
        let fixed = list.number("Fixed dt").filter(|dt| *dt > 0.0);
        let to = match (self.program, fixed) {
            (Program::PeriLab, Some(dt)) if same(name, "Static") => from + dt * increments as f64,
            _ => self.to,
        };
        remarks.push(format!(
            "t goes from 0 to 1 in statics: boundary conditions have ({from:?} + {:?} t) in place of t",
            to - from
        ));
        Solver {
            text: format!("\n[statics]\nmethod = \"{method}\"\nincrements = {increments}\n"),
            clock: Clock {
                start: from,
                scale: to - from,
            },
            from,
            to,
            damage: self.damage,
            steps: Some(increments),
            damping: 0.0,
        }
    }
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

/// The first and the last time. Peridigm's statics may say them with all others, as `Time Steps`.
fn times(solver: &Entry) -> Result<[f64; 2], String> {
    let listed = { solver.lists() }.find_map(|list| listed(list).map(|t| [t[0], t[t.len() - 1]]));
    let from = solver.number("Initial Time");
    match (solver.number("Final Time"), listed) {
        (Some(to), None) => Ok([from.unwrap_or(0.0), to]),
        (Some(to), Some(_)) if steps_given(solver) => Ok([from.unwrap_or(0.0), to]),
        (_, Some(listed)) => Ok(listed),
        (None, None) => Err("the solver has no Final Time".into()),
    }
}

/// Peridigm takes a number of load steps before a list of times.
fn steps_given(solver: &Entry) -> bool {
    { solver.lists() }.any(|list| list.find("Number of Load Steps").is_some())
}

/// `Time Steps` of a list, where they are two or more numbers.
fn listed(list: &Entry) -> Option<Vec<f64>> {
    let words = list.text("Time Steps")?.split_whitespace();
    let times: Option<Vec<f64>> = words.map(|w| w.parse().ok()).collect();
    times.filter(|t| t.len() >= 2)
}

/// Increments of a load: PeriLab's `Number of Steps` stands beside the method, and `Fixed dt` in it goes first.
fn increments(solver: &Entry, list: &Entry, duration: f64, program: Program) -> u64 {
    let count = |x: f64| x.clamp(1.0, 1e9) as u64;
    if program == Program::PeriLab {
        // in nonlinear statics a step that is given goes first
        let fixed = if same(&list.key, "Static") {
            list.number("Fixed dt")
        } else {
            None
        };
        let fixed = fixed.filter(|dt| *dt > 0.0);
        let steps = { solver.number("Number of Steps") }.or_else(|| list.number("Number of Steps"));
        let fixed = fixed.map(|dt| (duration / dt).round());
        return fixed.or(steps).map_or(1, count);
    }
    if let Some(steps) = list.number("Number of Load Steps") {
        list.refuse_entry("Time Steps", "the number of load steps is given");
        return count(steps);
    }
    let Some(times) = listed(list) else { return 1 };
    let each = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let uneven = |pair: &[f64]| (pair[1] - pair[0] - each).abs() > 1e-9 * each.abs();
    if times.windows(2).any(uneven) {
        list.refuse_entry("Time Steps", "increments of a load are equal here");
    }
    (times.len() - 1) as u64
}

/// Steps in time: what a table says of them, and how many where that is known. Peridigm does as many whole steps as fit, and a safety
/// factor shortens a step that is given, too; PeriLab does so many equal steps that none is longer.
fn step(list: &Entry, duration: f64, program: Program) -> (String, Option<u64>) {
    let safety = list.number("Safety Factor");
    match (list.number("Fixed dt"), safety) {
        (Some(dt), _) if dt > 0.0 => {
            let (steps, dt) = match program {
                Program::Peridigm => {
                    let dt = safety.filter(|s| *s > 0.0).map_or(dt, |s| dt * s);
                    ((duration / dt).floor(), dt)
                }
                Program::PeriLab => {
                    if safety.is_some() {
                        list.idle(&["Safety Factor"]);
                    }
                    let steps = (duration / dt).ceil();
                    (steps, duration / steps)
                }
            };
            let steps = (steps as u64).max(1);
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
    let (mut name, mut frames) = (None, None);
    for list in lists {
        list.idle(&[
            "Output Format",
            "Output File Type",
            "Parallel Write",
            "Flush File",
        ]);
        let file = list.text("Output Filename");
        let frequency = frequency(list, solver);
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
            if nothing[..2].iter().any(|n| same(n, &variable.key)) {
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
            name.is_some() && frames != frequency,
        ) {
            (true, true) => list.refuse_entry(
                "Output Frequency",
                "all fields are in the frames of the first output",
            ),
            (true, false) => {
                name = name.or(file);
                frames = frames.or(frequency);
            }
            (false, _) => {}
        }
        let all = |key: &str, none: f64| match list.number(key) {
            Some(x) if x == none => {}
            _ => list.refuse_entry(key, "frames are of the whole run"),
        };
        if list.is_true("Write After Damage") {
            list.refuse_entry("Write After Damage", "frames are of the whole run");
        }
        all("Initial Output Step", 1.0);
        all("Final Output Step", f64::MAX);
        all("Start Time", 0.0);
        all("End Time", f64::MAX);
    }
    let mut text = String::from("\n[output]\nvtu = false\n");
    let stem = name.unwrap_or("results");
    let stem = stem.rsplit(['/', '\\']).next().unwrap_or(stem);
    text += &format!("exodus = {}\n", quoted(&format!("{stem}.e")));
    if let Some(frames) = frames {
        text += &frames;
    }
    if !fields.is_empty() {
        text += &format!("fields = {fields:?}\n");
    }
    text
}

/// How often there are frames, as a key of the output; the same number of steps between them as there, where they are counted there.
fn frequency(list: &Entry, solver: &Solver) -> Option<String> {
    let number = list.number("Number of Output Steps").filter(|n| *n >= 1.0);
    let every = list.number("Output Frequency").filter(|n| *n >= 1.0);
    match (number, every, solver.steps) {
        (Some(n), _, Some(steps)) => Some(format!(
            "every = {}\n",
            steps.div_ceil(n as u64).clamp(1, steps)
        )),
        (Some(n), _, None) => Some(format!("frames = {}\n", n as u64)),
        (None, Some(every), _) => Some(format!("every = {}\n", every as u64)),
        (None, None, _) => None,
    }
}
