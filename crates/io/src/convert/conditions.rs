//! Boundary and initial conditions, bond filters and compute classes of both programs.

use super::quoted;
use super::tree::Entry;
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
        let text = given.trim().trim_end_matches(';').trim();
        let text = match text.strip_prefix("value") {
            Some(rest) if rest.trim_start().starts_with('=') => {
                rest.trim_start().trim_start_matches('=').trim()
            }
            _ => text,
        };
        if text.contains(['{', ';']) {
            return Err("a program is no expression: write it as a ? b : c".into());
        }
        Expression::parse(text, &[]).map_err(|e| format!("no expression: {}", e.message))?;
        if self.start == 0.0 && self.scale == 1.0 {
            return Ok(text.into());
        }
        let time = match self.start == 0.0 {
            true => format!("({:?}*t)", self.scale),
            false => format!("({:?} + {:?}*t)", self.start, self.scale),
        };
        let letter = |c: char| c.is_alphanumeric() || c == '_';
        let mut out = String::new();
        let mut before = ' ';
        let mut rest = text.chars().peekable();
        while let Some(c) = rest.next() {
            let alone = c == 't' && !letter(before) && !rest.peek().is_some_and(|n| letter(*n));
            match alone {
                true => out += &time,
                false => out.push(c),
            }
            before = c;
        }
        Ok(out)
    }
}

/// What a condition does here: the table and the key.
fn kind(entry: &Entry) -> Result<(&'static str, &'static str), String> {
    let given = entry.text("Type").unwrap_or("").to_lowercase();
    let variable = entry.text("Variable").unwrap_or("").to_lowercase();
    let initial = given.starts_with("initial");
    let key = match (given.trim_start_matches("initial ").trim(), &*variable) {
        // Peridigm says it in the type, PeriLab in the variable
        ("prescribed displacement" | "displacement", _) | (_, "displacements") => "displacement",
        ("velocity", _) | (_, "velocity") => "velocity",
        ("body force", _) | (_, "body forces" | "force densities") => "body_force",
        _ => {
            return Err(format!("no condition of type \"{given}\" {variable}")
                .trim_end()
                .into());
        }
    };
    match (initial, key) {
        (true, "body_force") => Err("a body force has no initial value".into()),
        (true, key) => Ok(("initial", key)),
        (false, key) => Ok(("condition", key)),
    }
}

/// Tables of the conditions; `sets` are the names that there are.
pub fn conditions(all: &Entry, sets: &[String], clock: Clock, dimension: usize) -> String {
    let mut out = String::new();
    for entry in all.lists() {
        match condition(entry, sets, clock, dimension) {
            Ok(text) => out += &text,
            Err(why) => entry.refuse(&why),
        }
    }
    out
}

fn condition(
    entry: &Entry,
    sets: &[String],
    clock: Clock,
    dimension: usize,
) -> Result<String, String> {
    let (table, key) = kind(entry)?;
    let set = entry.text("Node Set").or_else(|| entry.text("Block"));
    let set = set.ok_or("it has no Node Set")?;
    let name = sets.iter().find(|s| s.eq_ignore_ascii_case(set));
    let name = name.ok_or_else(|| format!("there is no node set \"{set}\", or it is empty"))?;
    let axis = entry.text("Coordinate").unwrap_or("x").to_lowercase();
    if !["x", "y", "z"].contains(&&*axis) {
        return Err(format!("the coordinate \"{axis}\" is not x, y or z"));
    }
    if axis == "z" && dimension == 2 {
        return Err("there is no z in 2-D".into());
    }
    let value = entry.text("Value").ok_or("it has no Value")?;
    let value = clock.expression(value)?;
    let comment = entry.key.replace(['\n', '\r'], " ");
    Ok(format!(
        "\n# {comment}\n[[{table}]]\nset = {}\n{key} = {{ {axis} = {} }}\n",
        quoted(name),
        quoted(&value)
    ))
}

/// Pre-cracks of bond filters.
pub fn filters(all: &Entry, dimension: usize) -> String {
    let mut out = String::new();
    for entry in all.lists() {
        match filter(entry, dimension) {
            Ok(text) => out += &text,
            Err(why) => entry.refuse(&why),
        }
    }
    out
}

/// Three numbers; in a plane z may be left out.
fn vector(entry: &Entry, name: &str) -> Result<[f64; 3], String> {
    let mut v = [0.0; 3];
    for (c, axis) in v.iter_mut().zip(["X", "Y", "Z"]) {
        let key = format!("{name} {axis}");
        *c = match entry.number(&key) {
            Some(x) => x,
            None if axis == "Z" => 0.0,
            None => return Err(format!("it has no {key}")),
        };
    }
    Ok(v)
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

fn filter(entry: &Entry, dimension: usize) -> Result<String, String> {
    let kind = entry
        .text("Type")
        .unwrap_or("")
        .to_lowercase()
        .replace('_', " ");
    let number = |key: &str| entry.number(key).ok_or_else(|| format!("it has no {key}"));
    let shape = match &*kind {
        "rectangular plane" => {
            let normal = vector(entry, "Normal")?;
            let corner = vector(entry, "Lower Left Corner")?;
            let bottom = vector(entry, "Bottom Unit Vector")?;
            let length = number("Bottom Length")?;
            let side = number("Side Length")?;
            // the other edge is bottom × normal in both programs
            let (bottom, normal) = (unit(bottom), unit(normal));
            let up: [f64; 3] = std::array::from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                bottom[j] * normal[k] - bottom[k] * normal[j]
            });
            let at = |a: f64, b: f64| -> [f64; 3] {
                std::array::from_fn(|i| corner[i] + a * length * bottom[i] + b * side * up[i])
            };
            let flat = |p: [f64; 3]| format!("[{:?}, {:?}]", p[0], p[1]);
            match dimension {
                2 => format!(
                    "segment = {{ from = {}, to = {} }}",
                    flat(corner),
                    flat(at(1.0, 0.0))
                ),
                _ => {
                    let corners = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
                    format!("polygon = {corners:?}")
                }
            }
        }
        "disk" if dimension == 3 => format!(
            "disk = {{ center = {:?}, normal = {:?}, radius = {:?} }}",
            vector(entry, "Center")?,
            vector(entry, "Normal")?,
            number("Radius")?
        ),
        other => return Err(format!("no pre-crack of type \"{other}\"")),
    };
    Ok(format!("\n[[precrack]]\n{shape}\n"))
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
