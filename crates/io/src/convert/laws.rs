//! Materials and damage models of both programs as laws of the shelf.

use super::tree::Entry;

/// A law as a deck has it, `{ lps = { … } }`, and which influence function it has there.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    pub text: String,
    /// In a plane: "stress" or "strain".
    pub plane: Option<&'static str>,
}

/// What a material model is called here.
struct Named {
    there: &'static str,
    here: &'static str,
    /// Keys beside the moduli: there, here.
    keys: &'static [(&'static str, &'static str)],
    /// Keys that are always so.
    always: &'static str,
}

/// Of Peridigm's models in rate form the rate is that at the end of a step.
const END: &str = "increment = \"end\"";

const NEEDLEMAN: &[(&str, &str)] = &[
    ("Yield Stress", "yield_stress"),
    ("Strain Hardening Exponent", "exponent"),
    ("Reference Strain 0", "reference_strain"),
    ("Reference Strain 1", "softening_strain"),
    ("Rate Hardening Exponent", "rate_sensitivity"),
    ("Reference Strain Rate", "reference_rate"),
];

const NAMED: [Named; 12] = [
    named("Elastic", "lps", &[], ""),
    named("Elastic Bond Based", "pmb", &[], ""),
    named(
        "Elastic Plastic",
        "elastic_plastic",
        &[("Yield Stress", "yield_stress")],
        "",
    ),
    named("Elastic Correspondence", "hypoelastic", &[], END),
    named(
        "Elastic Hypoelastic Correspondence",
        "hypoelastic",
        &[],
        END,
    ),
    named(
        "Elastic Plastic Correspondence",
        "hypoelastic_plastic",
        &[("Yield Stress", "yield_stress")],
        END,
    ),
    named(
        "Isotropic Hardening Correspondence",
        "hypoelastic_plastic",
        &[
            ("Yield Stress", "yield_stress"),
            ("Hardening Modulus", "hardening"),
        ],
        END,
    ),
    named(
        "Viscoplastic Needleman Correspondence",
        "hypoelastic_plastic",
        NEEDLEMAN,
        "increment = \"end\", hardening_law = \"swift\", rate_law = \"power\"",
    ),
    // PeriLab's
    named("PD Solid Elastic", "lps", &[], ""),
    named("Bond-based Elastic", "pmb", &[], ""),
    named("Correspondence Elastic", "correspondence", &[], ""),
    named(
        "PD Solid Plastic",
        "elastic_plastic",
        &[("Yield Stress", "yield_stress")],
        "",
    ),
];

const fn named(
    there: &'static str,
    here: &'static str,
    keys: &'static [(&'static str, &'static str)],
    always: &'static str,
) -> Named {
    Named {
        there,
        here,
        keys,
        always,
    }
}

const MODULI: [(&str, &str); 4] = [
    ("Young's Modulus", "young"),
    ("Poisson's Ratio", "poisson"),
    ("Bulk Modulus", "bulk"),
    ("Shear Modulus", "shear"),
];

/// The law of a material; `None`: there is none, and its entries say so.
pub fn law(material: &Entry) -> Option<Law> {
    let model = material.text("Material Model").unwrap_or("");
    let Some(named) = NAMED.iter().find(|n| n.there.eq_ignore_ascii_case(model)) else {
        material.refuse(&format!("no law here is the material model \"{model}\""));
        return None;
    };
    let mut keys = vec![];
    let wanted = if named.here == "pmb" { 1 } else { 2 };
    for (there, here) in MODULI {
        let fits = named.here != "pmb" || matches!(here, "young" | "bulk");
        match material.number(there) {
            Some(x) if fits && keys.len() < wanted => keys.push(format!("{here} = {x:?}")),
            Some(_) if named.here == "pmb" => {
                material.refuse_entry(there, "a bond-based law has one modulus")
            }
            Some(_) => material.refuse_entry(there, "two moduli say all"),
            None => {}
        }
    }
    if keys.len() < wanted {
        material.refuse("its moduli are not all there");
        return None;
    }
    for (there, here) in named.keys {
        match material.number(there) {
            Some(x) => keys.push(format!("{here} = {x:?}")),
            None if *here == "hardening" || *here == "softening_strain" => {}
            None => {
                material.refuse(&format!("it has no {there}"));
                return None;
            }
        }
    }
    if !named.always.is_empty() {
        keys.push(named.always.into());
    }
    switches(material);
    let plane = match material.text("Symmetry").map(str::to_lowercase).as_deref() {
        None | Some("isotropic") => None,
        Some("isotropic plane stress") => Some("stress"),
        Some("isotropic plane strain") => Some("strain"),
        Some(_) => {
            material.refuse_entry("Symmetry", "laws here are isotropic");
            None
        }
    };
    let flat = ["Plane Stress", "Plane Strain"].map(|key| material.is_true(key));
    Some(Law {
        text: format!("{{ {} = {{ {} }} }}", named.here, keys.join(", ")),
        plane: match flat {
            [true, _] => Some("stress"),
            [_, true] => Some("strain"),
            [false, false] => plane,
        },
    })
}

/// Entries that turn something on: off is nothing.
fn switches(material: &Entry) {
    for (key, why) in [
        (
            "Apply Shear Correction Factor",
            "factors of surfaces exist on lattices only (surface)",
        ),
        ("Apply Automatic Differentiation Jacobian", ""),
        ("Enable Flaw", "a yield stress that depends on the place"),
        (
            "Disable Plasticity",
            "leave out the yield stress in place of it",
        ),
    ] {
        if material.is_true(key) && !why.is_empty() {
            material.refuse_entry(key, why);
        }
    }
    if !material.is_true("Enable Flaw") {
        let keys = ["X", "Y", "Z"].map(|a| format!("Flaw Location {a}"));
        material.idle(&keys.each_ref().map(|k| &**k));
        material.idle(&["Flaw Size", "Flaw Magnitude"]);
    } else {
        material.refuse_entry("Enable Flaw", "a yield stress that depends on the place");
    }
    for key in ["Hourglass Coefficient", "Zero Energy Control"] {
        material.refuse_entry(
            key,
            "zero-energy modes are controlled in another way here (control), left at its usual value",
        );
    }
}

/// `{ critical_stretch = … }` of a damage model; `None`: there is none, and its entries say so.
pub fn fracture(damage: &Entry, remarks: &mut Vec<String>) -> Option<String> {
    let model = damage.text("Damage Model").unwrap_or("");
    let value = ["Critical Stretch", "Critical Value"];
    let value = value.into_iter().find_map(|key| damage.number(key));
    match (model.to_lowercase().as_str(), value) {
        ("critical stretch", Some(s)) => {
            damage.idle(&["Only Tension"]);
            Some(format!("{{ critical_stretch = {s:?} }}"))
        }
        ("critical energy", Some(g)) => {
            remarks.push(format!(
                "line {}: Critical Energy compares the energy of each bond with a critical one; fracture.energy makes a critical stretch of it, which is not the same; with criterion = \"bond_energy\" it is the work of both force states, of which PeriLab counts half: write 2 G (in a plane 4 G/pi) for the same limit",
                damage.line
            ));
            damage.idle(&["Only Tension"]);
            Some(format!("{{ energy = {g:?} }}"))
        }
        _ => {
            damage.refuse(&format!(
                "no damage model \"{model}\" with one critical value"
            ));
            None
        }
    }
}
