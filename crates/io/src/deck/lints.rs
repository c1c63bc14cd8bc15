//! Numbers of materials that no solid has: another unit or prefix was likely meant.

use super::units::{Dim, UnitSystem};
use peridyne::law::micromodulus::Moments;
use peridyne::message;
use peridyne::quantity::{Dimension, Message, Quantity};
use peridyne::run::Info;
use peridyne::spec::{Criterion, LawSpec, MaterialSpec, Spec};
use peridyne_theory::nominal::nominal_moduli;

/// Densities of solids (kg/m³): foams have 20, osmium 22,590.
const DENSITIES: [f64; 2] = [10.0, 25e3];
/// Speeds of waves along a bar (m/s): gels have 1, graphene 21,000.
const SPEEDS: [f64; 2] = [1.0, 25e3];
/// What is denser than this (kg/m³) is no rubber, foam or gel, and its waves are faster than this (m/s): lead has 1,200.
const DENSE: (f64, f64) = (2000.0, 300.0);
/// Below this Young's modulus (Pa) bonds may well be twice as long before they break.
const RUBBER: f64 = 1e9;
const STRETCHES: [f64; 2] = [1e-6, 1.0];
/// Strength over Young's modulus: that of a perfect lattice is a tenth.
const STRENGTHS: [f64; 2] = [1e-5, 0.1];

/// A doubt, and the entry of the spec that it is about.
pub struct Lint {
    pub path: String,
    pub text: Message,
}

/// What is doubtful of the materials of a model, each once.
pub fn lints(spec: &Spec, info: &Info, units: UnitSystem) -> Vec<Lint> {
    let mut all: Vec<Lint> = vec![];
    if !units.has_units() {
        return all;
    }
    let mut names: Vec<&str> = vec![];
    for (n, m) in spec.materials.iter().enumerate() {
        // of several bodies of one material each has an entry
        if names.contains(&&*m.name) {
            continue;
        }
        names.push(&m.name);
        let of_all = (info.horizon, spec.bonds.influence);
        let (horizon, influence) = info.families.get(n).copied().unwrap_or(of_all);
        let moments =
            Moments::continuum(spec.space.dimension, horizon, spec.space.section, influence);
        let Some(nominal) = nominal_moduli(&m.law, spec.space.dimension, spec.space.plane, moments)
        else {
            continue;
        };
        let place = names.len() - 1;
        let mut tell = |key: &str, text: Message| {
            let path = format!("materials[{place}].{key}");
            all.push(Lint { path, text });
        };
        // equilibrium asks for no density
        if info.stepper.statics().is_none() {
            match (of_density(m, units), of_speed(m, nominal.young, units)) {
                (Some(text), _) => tell("density", text),
                (None, Some(text)) => tell("law", text),
                (None, None) => {}
            }
        }
        let stretch = info.critical_stretch.get(n).copied();
        if let Some(text) = stretch.and_then(|s| of_energy(m, s, nominal.young, units)) {
            tell("fracture", text);
        }
        for (key, what, stress) in strengths(m) {
            if let Some(text) = of_strength(m, what, stress, nominal.young) {
                tell(key, text);
            }
        }
    }
    all
}

fn outside([low, high]: [f64; 2], x: f64) -> bool {
    x < low || x > high
}

/// Of a number times or over powers of 1000 the first that is usual: `is 14.9 GPa meant?`.
fn unlikely(number: Quantity, usual: impl Fn(f64) -> bool) -> Message {
    let powers = [1e3, 1e-3, 1e6, 1e-6, 1e9, 1e-9];
    match powers.into_iter().find(|p| usual(*p)) {
        Some(p) => message!["is ", number.dimension.of(number.value * p), " meant?"],
        None => "are its unit and prefix right?".into(),
    }
}

fn of_density(m: &MaterialSpec, units: UnitSystem) -> Option<Message> {
    let density = units.to_si(m.density, Dim::DENSITY);
    outside(DENSITIES, density).then(|| {
        let side = if density < DENSITIES[0] {
            "below"
        } else {
            "above"
        };
        let number = Dimension::DENSITY.of(m.density);
        let usual = |p: f64| !outside([500.0, DENSITIES[1]], density * p);
        let text = message![format!("the density of `{}`, ", m.name), number];
        message![
            text,
            format!(", is {side} that of any solid: "),
            unlikely(number, usual)
        ]
    })
}

fn of_speed(m: &MaterialSpec, young: f64, units: UnitSystem) -> Option<Message> {
    let density = units.to_si(m.density, Dim::DENSITY);
    let speed = (units.to_si(young, Dim::PRESSURE) / density).sqrt();
    let (dense, least) = DENSE;
    let why = match speed {
        s if s < SPEEDS[0] => "slower than in any solid",
        s if s > SPEEDS[1] => "faster than in any solid",
        s if s < least && density > dense => "slower than in any solid so dense",
        _ => return None,
    };
    let number = Dimension::PRESSURE.of(young);
    let usual = |p: f64| !outside([700.0, 15e3], speed * p.sqrt());
    Some(message![
        format!("waves along a bar of `{}` run at ", m.name),
        Dimension::VELOCITY.of((young / m.density).sqrt()),
        format!(", {why}, with a Young's modulus of "),
        number,
        " and a density of ",
        Dimension::DENSITY.of(m.density),
        ": ",
        unlikely(number, usual),
    ])
}

/// Of a fracture energy that gives an odd critical stretch.
fn of_energy(m: &MaterialSpec, stretch: f64, young: f64, units: UnitSystem) -> Option<Message> {
    let Criterion::Energy(energy) = m.fracture?.criterion else {
        return None;
    };
    let [low, high] = STRETCHES;
    let stiff = units.to_si(young, Dim::PRESSURE) > RUBBER;
    let odd = match stretch {
        s if s < low => "below 0.0001 %",
        s if s > high && s.is_finite() && stiff => "above 100 %",
        _ => return None,
    };
    Some(message![
        format!(
            "bonds of `{}` break at a stretch {odd} with a fracture energy of ",
            m.name
        ),
        Dimension::FRACTURE_ENERGY.of(energy),
        " and a Young's modulus of ",
        Dimension::PRESSURE.of(young),
        ": are their units and prefixes right?",
    ])
}

/// Strengths with their keys.
fn strengths(m: &MaterialSpec) -> Vec<(&'static str, &'static str, f64)> {
    let mut all = vec![];
    if let LawSpec::Named(law) = &m.law {
        let yielding = law.parameters.number("yield_stress");
        all.extend(yielding.map(|stress| ("law", "yield stress", stress)));
    }
    if let Some(Criterion::VonMises(stress)) = m.fracture.map(|f| f.criterion) {
        all.push(("fracture", "von Mises stress", stress));
    }
    all
}

fn of_strength(m: &MaterialSpec, what: &str, stress: f64, young: f64) -> Option<Message> {
    let part = stress / young;
    outside(STRENGTHS, part).then(|| {
        let number = Dimension::PRESSURE.of(stress);
        let usual = |p: f64| !outside([1e-4, 0.05], part * p);
        let side = if part < STRENGTHS[0] {
            "less than 1/100,000"
        } else {
            "more than a tenth"
        };
        message![
            format!("the {what} of `{}`, ", m.name),
            number,
            format!(", is {side} of Young's modulus, "),
            Dimension::PRESSURE.of(young),
            ": ",
            unlikely(number, usual),
        ]
    })
}
