//! Materials and damage models of both programs as laws of the registry.

use super::program::Program;
use super::tree::Entry;
use std::f64::consts::PI;

/// A law as a deck has it, `{ lps = { … } }`.
#[derive(Debug, Clone, PartialEq)]
pub struct Law {
    pub text: String,
    /// In a plane: "stress" or "strain".
    pub plane: Option<&'static str>,
    /// Thickness of the plane, where volumes have it.
    pub height: Option<f64>,
}

/// What constants of a law depend on besides.
#[derive(Debug, Clone, Copy)]
pub struct Setting {
    pub program: Program,
    /// 2 where points have no z.
    pub dimension: usize,
    /// All points have one z.
    pub flat: bool,
    pub horizon: f64,
    /// Another material of the body yields.
    pub yields: bool,
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

static NAMED: [Named; 12] = [
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
pub fn law(material: &Entry, setting: &Setting) -> Option<Law> {
    let Some(named) = named_of(material) else {
        let model = material.text("Material Model").unwrap_or("");
        material.refuse(&format!("no law here is the material model \"{model}\""));
        return None;
    };
    let plane = match plane(material, named, setting) {
        Ok(plane) => plane,
        Err(why) => {
            material.refuse(why);
            return None;
        }
    };
    let solid = setting.program == Program::PeriLab && setting.dimension == 2 && plane.is_none();
    let text = match (named.here, solid) {
        ("pmb", _) => bond_based(material, setting, plane),
        // the formulas of a solid
        ("lps", true) => bulk_and_shear(material)
            .map(|[k, g]| format!("{{ lps_3d = {{ bulk = {k:?}, shear = {g:?} }} }}")),
        (_, true) => Err("PeriLab asks for plane stress or plane strain in 2-D (Symmetry)".into()),
        // laws of a body are of one kind
        ("lps", false) if setting.yields && plane.is_none() => keys(material, named).map(|keys| {
            let keys = keys.join(", ");
            format!("{{ elastic_plastic = {{ {keys}, yield_stress = {NEVER:?} }} }}")
        }),
        _ => keys(material, named)
            .map(|keys| format!("{{ {} = {{ {} }} }}", named.here, keys.join(", "))),
    };
    let text = text.map_err(|why| material.refuse(&why)).ok()?;
    switches(material);
    let thick = setting.program == Program::Peridigm && plane.is_some();
    Some(Law {
        text,
        plane,
        height: thick.then(|| material.number("Height")).flatten(),
    })
}

/// A yield stress that no deformation reaches.
const NEVER: f64 = 1e100;

/// Does a material of the ordinary kind yield?
pub fn yields(material: &Entry) -> bool {
    named_of(material).is_some_and(|n| n.here == "elastic_plastic")
}

/// What its model is called here.
fn named_of(material: &Entry) -> Option<&'static Named> {
    let model = material.text("Material Model").unwrap_or("");
    NAMED.iter().find(|n| n.there.eq_ignore_ascii_case(model))
}

/// The plane that a material is in.
fn plane(
    material: &Entry,
    named: &Named,
    setting: &Setting,
) -> Result<Option<&'static str>, &'static str> {
    if setting.program == Program::Peridigm {
        let plane = match ["Plane Stress", "Plane Strain"].map(|key| material.is_true(key)) {
            [true, true] => return Err("it is of plane stress and of plane strain"),
            [true, false] => "stress",
            [false, true] => "strain",
            [false, false] => return Ok(None),
        };
        return match (named.here, material.find("Height")) {
            ("pmb", None) => Err("Peridigm asks for the Height of a plane"),
            ("pmb", Some(_)) if setting.flat => Ok(Some(plane)),
            ("pmb", Some(_)) => {
                Err("its constants are those of a plane, and the points are in none")
            }
            _ => Err("Peridigm has planes in its bond-based material alone"),
        };
    }
    let symmetry = material.text("Symmetry").unwrap_or("").to_lowercase();
    if symmetry.contains("tropic") && !symmetry.trim_start().starts_with("isotropic") {
        return Err("laws here are isotropic");
    }
    let plane = match () {
        () if symmetry.contains("plane strain") => "strain",
        () if symmetry.contains("plane stress") => "stress",
        () => return Ok(None),
    };
    match (setting.dimension, named.here) {
        (2, _) => Ok(Some(plane)),
        // of bodies with z PeriLab ignores it there
        (_, "correspondence") => Ok(None),
        _ if setting.flat => Ok(Some(plane)),
        _ => Err("its constants are those of a plane, and the points are in none"),
    }
}

/// The moduli that are given: there, here, value.
fn moduli(material: &Entry) -> Vec<(&'static str, &'static str, f64)> {
    let given = |(there, here)| Some((there, here, material.number(there)?));
    MODULI.into_iter().filter_map(given).collect()
}

/// Keys of a law of two moduli.
fn keys(material: &Entry, named: &Named) -> Result<Vec<String>, String> {
    let given = moduli(material);
    let [_, _, others @ ..] = &given[..] else {
        return Err("its moduli are not all there".into());
    };
    for other in others {
        material.refuse_entry(other.0, "two moduli say all");
    }
    let mut keys: Vec<String> = { given.iter().take(2) }
        .map(|m| format!("{} = {:?}", m.1, m.2))
        .collect();
    for (there, here) in named.keys {
        match material.number(there) {
            Some(x) => keys.push(format!("{here} = {x:?}")),
            None if *here == "hardening" || *here == "softening_strain" => {}
            None => return Err(format!("it has no {there}")),
        }
    }
    if !named.always.is_empty() {
        keys.push(named.always.into());
    }
    Ok(keys)
}

/// Bulk and shear modulus of a solid.
fn bulk_and_shear(material: &Entry) -> Result<[f64; 2], String> {
    let given = moduli(material);
    let of = |here: &str| given.iter().find(|m| m.1 == here).map(|m| m.2);
    match ["young", "poisson", "bulk", "shear"].map(of) {
        [_, _, Some(k), Some(g)] => Ok([k, g]),
        [Some(e), Some(nu), ..] => Ok([e / (3.0 - 6.0 * nu), e / (2.0 + 2.0 * nu)]),
        [Some(e), _, Some(k), _] => Ok([k, 3.0 * k * e / (9.0 * k - e)]),
        [Some(e), _, _, Some(g)] => Ok([e * g / (9.0 * g - 3.0 * e), g]),
        [_, Some(nu), Some(k), _] => Ok([k, 3.0 * k * (1.0 - 2.0 * nu) / (2.0 + 2.0 * nu)]),
        [_, Some(nu), _, Some(g)] => Ok([2.0 * g * (1.0 + nu) / (3.0 - 6.0 * nu), g]),
        _ => Err("its moduli are not all there".into()),
    }
}

/// The law of bonds, whose Poisson's ratio is fixed. A plane without `Symmetry` has the constant of a solid in PeriLab; in Peridigm bulk
/// moduli of planes are those of two dimensions.
fn bond_based(
    material: &Entry,
    setting: &Setting,
    plane: Option<&'static str>,
) -> Result<String, String> {
    let given = moduli(material);
    let of = |here: &str| given.iter().find(|m| m.1 == here).map(|m| m.2);
    let [young, _, bulk, shear] = ["young", "poisson", "bulk", "shear"].map(of);
    let missing = "its modulus is not there";
    let pmb = |key: &str, x: f64| Ok(format!("{{ pmb = {{ {key} = {x:?} }} }}"));
    let delta = setting.horizon;
    match (setting.program, plane) {
        (Program::Peridigm, None) => {
            for (there, here, _) in &given {
                if !matches!(*here, "young" | "bulk") || (young.is_some() && *here == "bulk") {
                    material.refuse_entry(there, "a bond-based law has one modulus");
                }
            }
            match (young, bulk) {
                (Some(young), _) => pmb("young", young),
                (None, Some(bulk)) => pmb("bulk", bulk),
                _ => Err(missing.into()),
            }
        }
        (Program::Peridigm, Some(plane)) => {
            let of_young = if plane == "stress" { 0.75 } else { 0.8 };
            let bulk = bulk.or(young.map(|e| of_young * e)).ok_or(missing)?;
            pmb("micromodulus", 12.0 * bulk / (PI * delta.powi(3)))
        }
        (Program::PeriLab, plane) => {
            if given.iter().any(|m| m.1 == "poisson") {
                material.idle(&["Poisson's Ratio"]);
            }
            let nu = if setting.dimension == 2 {
                1.0 / 3.0
            } else {
                0.25
            };
            let young = match (young, bulk, shear) {
                (_, Some(k), Some(g)) => 9.0 * k * g / (3.0 * k + g),
                (_, _, Some(g)) => 2.0 * g * (1.0 + nu),
                (_, Some(k), _) => 3.0 * k * (1.0 - 2.0 * nu),
                (Some(e), None, None) => e,
                _ => return Err(missing.into()),
            };
            match plane {
                None if setting.dimension == 2 => {
                    pmb("micromodulus", 12.0 * young / (PI * delta.powi(4)))
                }
                _ => pmb("young", young),
            }
        }
    }
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
            tension(damage);
            Some(format!("{{ critical_stretch = {s:?} }}"))
        }
        ("critical energy", Some(g)) => {
            remarks.push(format!(
                "line {}: Critical Energy compares the energy of each bond with a critical one; fracture.energy makes a critical stretch of it, which is not the same; with criterion = \"bond_energy\" it is the work of both force states, of which PeriLab counts half: write 2 G (in a plane 4 G/pi) for the same limit",
                damage.line
            ));
            tension(damage);
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

/// Bonds break in tension alone, which is the rule there where nothing is said.
fn tension(damage: &Entry) {
    match damage.text("Only Tension") {
        Some(text) if !text.eq_ignore_ascii_case("true") => {
            damage.refuse_entry("Only Tension", "bonds here break in tension alone");
        }
        _ => {}
    }
}
