//! Boundary and initial conditions and compute classes of both programs.

use super::points::Points;
use super::solver::Solver;
use super::tree::{Entry, same};
use super::{Program, increments, quoted};
use peridyne::expression::Expression;

/// How the time of the other deck follows from ours: `start + scale t`.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    pub start: f64,
    pub scale: f64,
}

impl Clock {
    /// An expression with our t in it.
    ///
    /// # Errors
    /// It is none, with the reason.
    pub fn expression(self, given: &str) -> Result<String, String> {
        let text = plain(given);
        if text.contains(['{', ';']) {
            return Err("a program is no expression: write it as a ? b : c".into());
        }
        // PeriLab's time since the start
        let text = put(&text, "st", &format!("(t - {:?})", self.start));
        Expression::parse(&text, &[]).map_err(|e| format!("no expression: {}", e.message))?;
        if self.start == 0.0 && self.scale == 1.0 {
            return Ok(text);
        }
        let time = match (self.start == 0.0, self.scale == 1.0) {
            (true, _) => format!("({:?}*t)", self.scale),
            (_, true) => format!("({:?} + t)", self.start),
            _ => format!("({:?} + {:?}*t)", self.start, self.scale),
        };
        Ok(put(&text, "t", &time))
    }

    /// The same at a time of the other program, as an expression of the place.
    ///
    /// # Errors
    /// As [`Self::expression`].
    pub fn at(self, given: &str, time: f64) -> Result<String, String> {
        let there = Clock {
            start: 0.0,
            scale: 1.0,
        };
        Ok(put(&there.expression(given)?, "t", &format!("({time:?})")))
    }
}

/// Without what the other programs write around and into an expression: `value = …;`, and dots before operators of Julia.
fn plain(given: &str) -> String {
    let text = given.trim().trim_end_matches(';').trim();
    let text = match text.strip_prefix("value") {
        Some(rest) if rest.trim_start().starts_with('=') => {
            rest.trim_start().trim_start_matches('=').trim()
        }
        _ => text,
    };
    let mut text = text.to_string();
    for operator in ["*", "/", "+", "-", "^"] {
        text = text.replace(&format!(".{operator}"), operator);
    }
    text
}

/// Places of a word that stands alone.
fn words<'a>(text: &'a str, word: &'a str) -> impl Iterator<Item = usize> + 'a {
    let letter = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    text.match_indices(word)
        .map(|(at, _)| at)
        .filter(move |at| {
            let before = text[..*at].chars().next_back();
            let after = text[at + word.len()..].chars().next();
            !before.is_some_and(letter) && !after.is_some_and(letter)
        })
}

/// `by` in place of a word that stands alone.
fn put(text: &str, word: &str, by: &str) -> String {
    let (mut out, mut from) = (String::new(), 0);
    for at in words(text, word) {
        out += &text[from..at];
        out += by;
        from = at + word.len();
    }
    out + &text[from..]
}

/// What conditions act on, and when.
pub struct Stage<'a> {
    pub program: Program,
    pub points: &'a Points,
    pub names: &'a [String],
    pub solver: &'a Solver,
    pub dimension: usize,
}

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
        (false, key) => Ok(("condition", key)),
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

/// What a field is called here, and what should be known of it.
pub fn field(there: &str) -> Result<(&'static str, Option<&'static str>), &'static str> {
    let name = there.to_lowercase().replace('_', " ");
    Ok(match &*name {
        "displacement" | "displacements" => ("displacement", None),
        "velocity" => ("velocity", None),
        "damage" => ("damage", None),
        "dilatation" => ("dilatation", None),
        "force density" | "force densities" => ("force_density", None),
        "volume" => ("volume", None),
        "strain" => ("strain", None),
        "unrotated cauchy stress" => ("unrotated_stress", None),
        "equivalent plastic strain" => ("plastic_strain", None),
        "block id" => ("mark", None),
        "stored elastic energy density" | "strain energy density" => {
            ("strain_energy_density", None)
        }
        "force" | "forces" => (
            "force_density",
            Some("a force is force_density times volume"),
        ),
        "cauchy stress" => (
            "stress",
            Some("stress is the Kirchhoff stress of the bonds"),
        ),
        "deformation gradient" => (
            "displacement_gradient",
            Some("the deformation gradient is 1 + displacement_gradient"),
        ),
        "stored elastic energy" => (
            "strain_energy_density",
            Some("a stored energy is strain_energy_density times volume"),
        ),
        "kinetic energy" => (
            "kinetic_energy_density",
            Some("a kinetic energy is kinetic_energy_density times volume"),
        ),
        _ => return Err("there is no such field"),
    })
}

/// Probes of compute classes; answers their tables and labels.
pub fn probes(all: &Entry, sets: &[String], remarks: &mut Vec<String>) -> (String, Vec<String>) {
    let (mut out, mut labels) = (String::new(), vec![]);
    for entry in all.lists() {
        match probe(entry, sets, remarks) {
            Ok((text, label)) => {
                out += &text;
                labels.push(label);
            }
            Err(why) => entry.refuse(&why),
        }
    }
    (out, labels)
}

fn probe(
    entry: &Entry,
    sets: &[String],
    remarks: &mut Vec<String>,
) -> Result<(String, String), String> {
    let class = entry
        .text("Compute Class")
        .unwrap_or("")
        .to_lowercase()
        .replace('_', " ");
    let label = entry.text("Output Label").unwrap_or(&entry.key).to_string();
    entry.idle(&["Verbose"]);
    let variable = entry.text("Variable").ok_or("it has no Variable")?;
    let plain = variable.to_lowercase().replace('_', " ");
    let calculation = entry.text("Calculation Type").unwrap_or("").to_lowercase();
    if matches!(&*plain, "force" | "forces") {
        return Err("write a [[probe]] with measure = \"reaction\" on the set that is held: the force of its supports, which has the other sign".into());
    }
    let (of, note) = field(variable)?;
    let energy =
        matches!(&*plain, "stored elastic energy" | "kinetic energy") && calculation == "sum";
    if !energy && let Some(note) = note {
        remarks.push(format!("line {}: {note}", entry.line));
    }
    let mut table = format!("\n[[probe]]\nname = {}\n", quoted(&label));
    match &*class {
        "nearest point data" => {
            let number = |key: &str| entry.number(key).ok_or_else(|| format!("it has no {key}"));
            let place = [number("X")?, number("Y")?, number("Z")?];
            table += &format!("measure = \"value\"\nof = \"{of}\"\nat = {place:?}\n");
        }
        "block data" | "node set data" => {
            let set = entry.text("Block").or_else(|| entry.text("Node Set"));
            let set = set.ok_or("it has no Block or Node Set")?;
            let known = sets.iter().find(|s| s.eq_ignore_ascii_case(set));
            let known = known.ok_or_else(|| format!("there is no set \"{set}\""))?;
            table += &format!("set = {}\n", quoted(known));
            let measure = match &*calculation {
                "sum" if energy => "energy",
                "sum" => "sum",
                "minimum" | "min" => "min",
                "maximum" | "max" => "max",
                "average" => "mean",
                other => return Err(format!("no measure \"{other}\"")),
            };
            table += &format!("measure = \"{measure}\"\n");
            if measure != "energy" {
                table += &format!("of = \"{of}\"\n");
            }
        }
        other => return Err(format!("no compute class \"{other}\"")),
    }
    Ok((table, label))
}
