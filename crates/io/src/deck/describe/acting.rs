//! What breaks, touches, spreads and acts.

use super::shape::rigid;
use crate::deck::units::{Dim, UnitSystem, counted, short};
use peridyne::spec::{
    ContactSpec, DiffusionMethod, DiffusionSpec, RigidBodyMotion, RigidBodySpec, Spec,
    ToughnessFactor,
};

pub(super) fn lines(spec: &Spec, units: UnitSystem) -> Vec<String> {
    let mut lines = vec![];
    for t in &spec.damage.toughness {
        let of = match &t.factor {
            ToughnessFactor::Stretch(e) => format!("critical stretch times {}", e.source()),
            ToughnessFactor::Energy(e) => format!("fracture energy times {}", e.source()),
            ToughnessFactor::Temperature(rows) => {
                let row =
                    |[t, x]: &[f64; 2]| format!("{x} at {}", units.write(*t, Dim::TEMPERATURE));
                let rows: Vec<String> = rows.iter().map(row).collect();
                format!("critical stretch times {}", rows.join(", "))
            }
            ToughnessFactor::NoFailure => "bonds never break".to_string(),
        };
        lines.push(format!("toughness  on {}: {of}", t.set));
    }
    if let Some(healing) = &spec.damage.healing {
        lines.push(format!(
            "healing    of bonds of {} below a stretch of {}",
            healing.set,
            healing.below.source()
        ));
    }
    lines.extend(spec.interactions.contact.iter().map(|c| touching(c, units)));
    let rigid = spec.loading.rigid_bodies.iter();
    lines.extend(rigid.map(|i| rigid_body(i, units, spec.space.dimension)));
    lines.extend(spec.interactions.diffusions.iter().map(spreading));
    lines.push(format!(
        "acting     {}, {}, {}",
        counted(spec.loading.initial.len() as u64, "initial value"),
        counted(spec.loading.conditions.len() as u64, "boundary condition"),
        counted(spec.damage.precracks.len() as u64, "pre-crack")
    ));
    lines
}

fn touching(contact: &ContactSpec, units: UnitSystem) -> String {
    format!(
        "contact    below {} of the reference distance, within {} spacings{}{}",
        contact.bonded,
        contact.free,
        match &contact.friction {
            None => String::new(),
            Some(friction) => {
                let sliding = friction.kinetic.source();
                match &friction.at_rest {
                    None => format!(", friction {sliding}"),
                    Some(rest) => format!(
                        ", friction {} at rest, {sliding} sliding",
                        rest.coefficient.source()
                    ),
                }
            }
        },
        { contact.cohesion.as_ref() }.map_or(String::new(), |c| {
            format!(
                ", bodies stick with {} and {}",
                units.write(c.energy, Dim::FRACTURE_ENERGY),
                units.write(c.strength, Dim::PRESSURE)
            )
        }),
    )
}

fn rigid_body(rigid_body: &RigidBodySpec, units: UnitSystem, dimension: usize) -> String {
    let motion = match &rigid_body.motion {
        RigidBodyMotion::Kinematic(center) => {
            let center: Vec<&str> = center.iter().take(dimension).map(|c| c.source()).collect();
            format!("moved along ({})", center.join(", "))
        }
        RigidBodyMotion::Free(free) => {
            format!("free with {}", units.write(free.mass, Dim::MASS))
        }
    };
    let name = match rigid_body.name.is_empty() {
        true => String::new(),
        false => format!("{}: ", rigid_body.name),
    };
    let friction = { rigid_body.friction.as_ref() }.map_or(String::new(), |f| {
        format!(", friction {}", f.kinetic.source())
    });
    let cohesion = { rigid_body.cohesion.as_ref() }.map_or(String::new(), |c| {
        format!(", sticky up to {}", units.write(c.range(), Dim::LENGTH))
    });
    format!(
        "rigid body {name}{}, {motion}{friction}{cohesion}",
        rigid(&rigid_body.shape, units, dimension)
    )
}

/// What spreads, and how.
fn spreading(t: &DiffusionSpec) -> String {
    let how = match t.method {
        DiffusionMethod::Explicit { safety } => {
            format!("explicit, in parts of {safety} of its stable step")
        }
        DiffusionMethod::Implicit { theta, tolerance } => {
            let name = match theta < 1.0 {
                true => "Crank and Nicolson",
                false => "backward Euler",
            };
            format!("implicit ({name}), tolerance {}", short(tolerance))
        }
        DiffusionMethod::Steady { tolerance } => format!("steady, tolerance {}", short(tolerance)),
    };
    format!(
        "{:<11}{how}, {}, {}",
        t.quantity.name(),
        counted(t.initial.len() as u64, "initial value"),
        counted(t.conditions.len() as u64, "boundary condition")
    )
}
