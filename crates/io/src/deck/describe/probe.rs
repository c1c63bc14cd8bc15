//! What is measured.

use crate::deck::units::{Dim, UnitSystem};
use peridyne::spec::{Fold, Measure, Part, ProbeSpec, RigidQuantity, Spec};

pub(super) fn lines(spec: &Spec, units: UnitSystem) -> Vec<String> {
    let mut lines = vec![];
    for probe in &spec.run.probes {
        let ProbeSpec { name, set, measure } = probe;
        lines.push(format!(
            "probe      {name}: {}",
            measured(measure, set, units, spec.space.dimension)
        ));
    }
    lines
}

fn measured(measure: &Measure, set: &str, units: UnitSystem, dimension: usize) -> String {
    let place = |x: &[f64]| {
        let each = x
            .iter()
            .take(dimension)
            .map(|x| units.write(*x, Dim::LENGTH));
        format!("({})", each.collect::<Vec<_>>().join(", "))
    };
    let part = |part: &Part| match part {
        Part::All => String::new(),
        Part::Component(name) => format!(", {name}"),
        Part::Magnitude => ", magnitude".into(),
    };
    match measure {
        Measure::Reaction => format!("force of the constraints on {set}"),
        Measure::Moment { about } => {
            format!("moment of the constraints on {set} about {}", place(about))
        }
        Measure::Energy => format!("energies of {set}"),
        Measure::Over { fold, of, part: p } => {
            let fold = match fold {
                Fold::Mean => "mean",
                Fold::Min => "smallest",
                Fold::Max => "largest",
                Fold::Sum => "sum",
            };
            format!("{fold} {of}{} of {set}", part(p))
        }
        Measure::Value { at, of, part: p } => {
            format!(
                "{of}{} of the point of {set} nearest to {}",
                part(p),
                place(at)
            )
        }
        Measure::RigidBody {
            rigid_body: name,
            of,
        } => format!(
            "{} of the rigid body {name}",
            of.map_or("all", RigidQuantity::name)
        ),
        Measure::JIntegral(c) => format!(
            "J and K by the rectangle {} to {}",
            place(&c.low),
            place(&c.high)
        ),
        Measure::CrackTip(c) => format!(
            "tip of the crack from {} along ({}), points of {set} with a damage of {} and more",
            place(&c.from),
            { c.direction.iter().take(dimension) }
                .map(|x| ((x * 1e4).round() * 1e-4).to_string())
                .collect::<Vec<_>>()
                .join(", "),
            c.damage
        ),
        Measure::Opening { between: [a, b] } => format!(
            "opening between the points of {set} nearest to {} and {}",
            place(a),
            place(b)
        ),
        Measure::Fragments { points: 0 | 1 } => "number and masses of fragments".into(),
        Measure::Fragments { points } => {
            format!("number of fragments of {points} points and more, and masses")
        }
    }
}
