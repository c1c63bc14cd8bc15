//! What rigid bodies must be before they touch anything.

use super::contact::check_friction;
use crate::body::Body;
use crate::error::BuildError;
use crate::law::material::tensor;
use crate::message;
use crate::quantity::{Dimension, Quantity};
use crate::space::rigid::RigidShape;
use crate::spec::{CohesionSpec, FreeSpec, RigidBodyMotion, RigidBodySpec, Spec};

fn length(x: f64) -> Quantity {
    Dimension::LENGTH.of(x)
}

/// Refuses rigid bodies that are none in this dimension, or of numbers without meaning.
pub(super) fn check<const D: usize>(spec: &Spec, body: &Body<D>) -> Result<(), BuildError> {
    for (n, rigid_body) in { spec.run.preload.iter() }
        .flat_map(|p| p.rigid_bodies.iter())
        .enumerate()
    {
        let path = format!("preload.rigid_bodies[{n}]");
        one::<D>(rigid_body, &path)?;
        recurs(rigid_body, body, &path)?;
        if let Some(cohesion) = &rigid_body.cohesion {
            sticks(cohesion, body, &path)?;
        }
    }
    let mut names: Vec<&str> = vec![];
    for (n, rigid_body) in spec.loading.rigid_bodies.iter().enumerate() {
        let path = format!("rigid_bodies[{n}]");
        let name = rigid_body.name.as_str();
        if !name.is_empty() && names.contains(&name) {
            let message = format!("two rigid bodies are called `{name}`");
            return Err(BuildError::conflict(format!("{path}.name"), message));
        }
        names.push(name);
        one::<D>(rigid_body, &path)?;
        recurs(rigid_body, body, &path)?;
        if let Some(cohesion) = &rigid_body.cohesion {
            sticks(cohesion, body, &path)?;
        }
    }
    Ok(())
}

fn one<const D: usize>(rigid_body: &RigidBodySpec, path: &str) -> Result<(), BuildError> {
    let shape = &rigid_body.shape;
    if !shape.fits(D) {
        let shapes = ["sphere or plane", "sphere (a disk), box or plane", ""][D.clamp(1, 3) - 1];
        let message = format!("a rigid {} is nothing in {D} dimensions", shape.name());
        return Err(BuildError::unsupported(format!("{path}.shape"), message)
            .help(format!("take a {shapes}")));
    }
    let sizes = match shape {
        RigidShape::Sphere { radius } => vec![*radius],
        RigidShape::Box { half } => half[..D].to_vec(),
        RigidShape::Cylinder { radius, half, .. } => vec![*radius, *half],
        RigidShape::Plane { .. } | RigidShape::Solid(_) => vec![],
    };
    let positive = |x: f64| x > 0.0 && x.is_finite();
    if let Some(size) = sizes.iter().find(|x| !positive(**x)) {
        let message = format!(
            "a size of the rigid {} is {size}, expected a positive length",
            shape.name()
        );
        return Err(BuildError::invalid(format!("{path}.shape"), message));
    }
    if !positive(rigid_body.stiffness) {
        let message = format!(
            "the stiffness is {}, expected a positive number",
            rigid_body.stiffness
        );
        return Err(BuildError::invalid(format!("{path}.stiffness"), message));
    }
    if let Some(turn) = &rigid_body.turn
        && (D == 1 || (D == 2 && turn.axis[..2] != [0.0; 2]))
    {
        let message = "a body in a plane rotates about z, one on a line not at all";
        return Err(BuildError::unsupported(format!("{path}.rotation"), message));
    }
    if let Some(friction) = &rigid_body.friction {
        check_friction::<D>(friction, &format!("{path}.friction"))?;
    }
    match &rigid_body.motion {
        RigidBodyMotion::Kinematic(_) => Ok(()),
        RigidBodyMotion::Free(free) => free_one::<D>(free, shape, path),
    }
}

fn free_one<const D: usize>(
    free: &FreeSpec,
    shape: &RigidShape,
    path: &str,
) -> Result<(), BuildError> {
    if matches!(shape, RigidShape::Plane { .. }) {
        let message = "an infinite plane has no mass and cannot move freely: prescribe its motion";
        return Err(BuildError::unsupported(format!("{path}.mass"), message)
            .help("leave mass out, or take a box"));
    }
    if !(free.mass > 0.0 && free.mass.is_finite()) {
        let message = format!("the mass is {}, expected a positive number", free.mass);
        return Err(BuildError::invalid(format!("{path}.mass"), message));
    }
    let Some(inertia) = free.inertia else {
        return Ok(());
    };
    let size = inertia.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let twisted =
        (0..3).any(|a| (0..a).any(|b| (inertia[a][b] - inertia[b][a]).abs() > 1e-12 * size));
    let moments = match D {
        3 => tensor::eigen::<3>(inertia).0.to_vec(),
        _ => vec![inertia[2][2]],
    };
    // no mass lies further from one axis than from both others together
    let sum: f64 = moments.iter().sum();
    let wrong = moments.iter().any(|i| !(*i > 0.0 && i.is_finite()))
        || (D == 3 && moments.iter().any(|i| 2.0 * i > sum * (1.0 + 1e-12)));
    if twisted || wrong {
        let message = format!(
            "the principal moments of inertia are {moments:?}: a body has positive ones, of a symmetric tensor, each at most the sum of the other two"
        );
        return Err(BuildError::invalid(format!("{path}.inertia"), message));
    }
    Ok(())
}

/// The image whose centre is nearest is the nearest one of a sphere, of other shapes only where they are smaller than half a period.
fn recurs<const D: usize>(
    rigid_body: &RigidBodySpec,
    body: &Body<D>,
    path: &str,
) -> Result<(), BuildError> {
    let reach = match &rigid_body.shape {
        RigidShape::Sphere { .. } | RigidShape::Plane { .. } => return Ok(()),
        shape => shape.reach(D),
    };
    match body.period().iter().flatten().find(|p| 2.0 * reach > **p) {
        None => Ok(()),
        Some(period) => Err(BuildError::conflict(
            format!("{path}.shape"),
            message![
                format!("the rigid {} reaches ", rigid_body.shape.name()),
                length(reach),
                " from its centre, more than half of the period ",
                length(*period),
                ": it would meet its own image",
            ],
        )),
    }
}

/// Cohesion that reaches the layers below the surface of a body would do more than its work of adhesion.
fn sticks<const D: usize>(
    cohesion: &CohesionSpec,
    body: &Body<D>,
    path: &str,
) -> Result<(), BuildError> {
    let path = format!("{path}.cohesion");
    let spacings = body.slots().iter().map(|s| body.spacing_at(*s as usize));
    let least = body.least(spacings.fold(f64::INFINITY, f64::min));
    let range = cohesion.range();
    if !(range > 0.0 && range.is_finite()) {
        let message = format!(
            "cohesion of the energy {} and the strength {} has no range",
            cohesion.energy, cohesion.strength
        );
        return Err(BuildError::invalid(path, message));
    }
    if range > least {
        return Err(BuildError::conflict(
            path,
            message![
                "cohesion reaches 16 energy/(9 strength), ",
                length(range),
                ", more than the spacing ",
                length(least),
                ": it would pull the points below the surface, too",
            ],
        )
        .help(message![
            "write a strength of at least ",
            Dimension::PRESSURE.of(16.0 / 9.0 * cohesion.energy / least),
            ", or a larger spacing",
        ]));
    }
    Ok(())
}
