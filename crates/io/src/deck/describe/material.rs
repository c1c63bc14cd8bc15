//! Materials and laws in words.

use crate::deck::units::{Dim, UnitSystem, short};
use peridyne::law::descriptor::Value;
use peridyne::run::Registry;
use peridyne::spec::{Acting, Criterion, LawSpec, MaterialSpec, Parameter, PotentialSpec, Spec};

/// All potentials between atoms that a spec names.
pub(super) fn potentials(spec: &Spec) -> impl Iterator<Item = &PotentialSpec> {
    let own = spec.materials.iter().filter_map(|m| m.law.potential());
    own.chain(spec.interactions.potentials.iter().map(|a| &a.potential))
}

/// What atoms of several kinds have with each other.
pub(super) fn between_atoms(spec: &Spec, units: UnitSystem) -> Vec<String> {
    let mut lines = vec![];
    for acting in &spec.interactions.potentials {
        let Acting::Between(pair) = acting.on;
        let [a, b] = pair.map(|n| spec.materials.get(n).map_or("", |m| &*m.name));
        let said = constants(&LawSpec::Atoms(acting.potential.clone()), units);
        lines.push(format!("pair       {a} and {b}: {said}"));
    }
    if let Some(rule) = spec.interactions.mixing {
        lines.push(format!("mixing     {}", rule.name()));
    }
    lines
}

/// A law, of all but potentials with its constants.
fn law(law: &LawSpec, units: UnitSystem) -> String {
    match law.potential() {
        Some(potential) => potential.name.replace('_', "-"),
        None => constants(law, units),
    }
}

/// A law with its constants.
fn constants(law: &LawSpec, units: UnitSystem) -> String {
    let registry = Registry::standard();
    let Some((descriptor, parameters)) = registry.written(law) else {
        return "a law of its own".into();
    };
    let mut said = descriptor.name.replace('_', "-");
    for (key, given) in &parameters.0 {
        let value = match (descriptor.key(key).map(|k| k.value), given) {
            (Some(Value::Number(dimension, _)), Parameter::Number(x)) => units.write(*x, dimension),
            (Some(Value::List(_, dimension, _)), Parameter::List(list)) => {
                let each = list.iter().map(|x| units.write(*x, dimension));
                format!("[{}]", each.collect::<Vec<_>>().join(", "))
            }
            (Some(Value::Rows(columns)), Parameter::Rows(rows)) => {
                let row = |row: &Vec<f64>| {
                    let each = row.iter().zip(columns);
                    let each: Vec<String> = each.map(|(x, c)| units.write(*x, c.1)).collect();
                    format!("[{}]", each.join(", "))
                };
                rows.iter().map(row).collect::<Vec<_>>().join(" ")
            }
            (_, Parameter::Word(word)) => word.clone(),
            (_, Parameter::Number(x)) => short(*x),
            (_, Parameter::List(list)) => format!("{list:?}"),
            (_, Parameter::Rows(rows)) => format!("{rows:?}"),
            (_, Parameter::Formula(formula)) => formula.source().into(),
            (_, Parameter::Direction(components)) => {
                let each = components.iter().map(|e| e.source());
                format!("[{}]", each.collect::<Vec<_>>().join(", "))
            }
            (_, Parameter::Table(_)) => "tables".into(),
        };
        said += &format!(", {} = {value}", key.replace('_', " "));
    }
    said
}

/// When bonds break.
pub(super) fn criterion(criterion: Criterion, units: UnitSystem) -> String {
    match criterion {
        Criterion::Stretch(s) => format!("breaks at stretch {s}"),
        Criterion::Energy(g) => format!("breaks at {}", units.write(g, Dim::FRACTURE_ENERGY)),
        Criterion::BondEnergy(g) => format!(
            "bonds break by their work at {}",
            units.write(g, Dim::FRACTURE_ENERGY)
        ),
        Criterion::VonMises(s) => {
            format!(
                "breaks at the von Mises stress {}",
                units.write(s, Dim::PRESSURE)
            )
        }
        Criterion::PlasticStrain(e) => format!("breaks at the plastic strain {e}"),
    }
}

pub(super) fn material(m: &MaterialSpec, units: UnitSystem) -> String {
    let law = law(&m.law, units);
    let fracture = match m.fracture {
        None => "unbreakable".to_string(),
        Some(f) => {
            let mut said = criterion(f.criterion, units);
            if f.alpha != 0.0 {
                said += &format!(", α = {}", f.alpha);
            }
            if let Some(rate) = f.rate {
                let reference = units.write(rate.reference, Dim::FREQUENCY);
                said += &format!(", times 1 + {} ln(rate/({reference}))", rate.coefficient);
            }
            if let Some(fatigue) = f.fatigue {
                let law = |[a, m]: [f64; 2]| format!("{a} ε^{m}");
                let of = |law: String, place: &str| format!(", {law} of a life a cycle {place}");
                let far = format!("far from any crack above {}", fatigue.limit);
                let growth = fatigue.growth.map(|x| of(law(x), "near a crack"));
                let nucleation = fatigue.nucleation.map(|x| of(law(x), &far));
                said += &[growth, nucleation].map(Option::unwrap_or_default).concat();
            }
            said
        }
    };
    format!(
        "{} on {}: {law}, ρ = {}, {fracture}",
        m.name,
        m.set,
        units.write(m.density, Dim::DENSITY)
    )
}
