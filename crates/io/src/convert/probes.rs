//! Fields and compute classes of both programs.

use super::quoted;
use super::tree::Entry;

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
        "block id" => ("block", None),
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
