//! Rigid bodies that push points.

use super::Files;
use super::contact::{cohesion, friction};
use super::context::{Context, Result};
use crate::deck::document::{Document, Rigid, RigidBody, Rotation};
use crate::deck::quantity::{Inertia, Measure};
use crate::deck::units::Dim;
use crate::deck::value::{At, Quantity, Vector, Written, span};
use peridyne::expression::Expression;
use peridyne::law::micromodulus::Moments;
use peridyne::space::Point;
use peridyne::space::rigid::RigidShape;
use peridyne::space::triangles::Solid;
use peridyne::spec::{BodySpec, FreeSpec, RigidBodyMotion, RigidBodySpec, Spec, TurnSpec};
use peridyne_theory::nominal::nominal_moduli;
use std::sync::Arc;

/// What an rigid_body has until its stiffness is that of the material.
const OF_MATERIAL: f64 = f64::NAN;
/// A point is pushed out as stiffly as the material where it is this part of a spacing deep.
const DEPTH: f64 = 0.1;

/// Gives rigid_bodies without a stiffness one of the materials, and says it.
///
/// The pressure on a layer of cells of thickness Δx is `K g² Δx`, and what the same layer says when it is shortened by g `B g/Δx`: they
/// agree at a depth `g = Δx/10` for `K = 10 B/Δx³`. Points go less deep than that as long as the pressure is below B/10, and the slope
/// `2 K g` of the force density is below that of the bonds (some `B/Δx²`), so that it does not shorten the stable step.
pub(super) fn of_material(
    context: &mut Context,
    document: &Document,
    spec: &mut Spec,
) -> Result<()> {
    let before = spec
        .run
        .preload
        .iter_mut()
        .flat_map(|p| &mut p.rigid_bodies);
    let all: Vec<&mut RigidBodySpec> = before
        .chain(&mut spec.loading.rigid_bodies)
        .filter(|i| i.stiffness.is_nan())
        .collect();
    if all.is_empty() {
        return Ok(());
    }
    let spacing = match &spec.body {
        BodySpec::Several(pieces) => { pieces.iter() }
            .filter_map(|p| p.body.spacing())
            .reduce(f64::min),
        one => one
            .spacing()
            .or_else(|| mean_spacing(one, spec.space.dimension, spec.space.section)),
    };
    let horizon = spacing.map(|s| spec.bonds.horizon.length(s));
    let bulk = horizon.and_then(|horizon| {
        let d = spec.space.dimension;
        let moments = Moments::continuum(d, horizon, spec.space.section, spec.bonds.influence);
        { spec.materials.iter() }
            .filter_map(|m| nominal_moduli(&m.law, d, spec.space.plane, moments))
            .map(|m| if d == 1 { m.young } else { m.bulk() })
            .reduce(f64::max)
    });
    let (Some(spacing), Some(bulk)) = (spacing, bulk) else {
        let span = { document.rigid_body.iter() }
            .find(|i| i.value.stiffness.is_none())
            .map_or(0..0, |i| i.span.clone());
        return Err(context.error_with(
            &span,
            "the rigid body needs a `stiffness`: these materials have no bulk modulus to take it from, or the points no spacing",
            "write stiffness = …, about ten times the stiffness of the material over the cube of the spacing",
        ));
    };
    let stiffness = bulk / (DEPTH * spacing.powi(3));
    all.into_iter().for_each(|i| i.stiffness = stiffness);
    let units = context.units;
    context.notes.push(format!(
        "stiffness of rigid bodies that give none: {}, ten times the bulk modulus {} over the cube of the spacing {}",
        units.show(stiffness, Dim::RIGID_BODY_STIFFNESS),
        units.show(bulk, Dim::PRESSURE),
        units.show(spacing, Dim::LENGTH),
    ));
    Ok(())
}

/// Of points that do not say their spacing.
fn mean_spacing(body: &BodySpec, dimension: usize, section: f64) -> Option<f64> {
    let BodySpec::Cloud(cloud) = body else {
        return None;
    };
    let mean = cloud.volume.iter().sum::<f64>() / cloud.volume.len() as f64 / section;
    Some(libm::pow(mean, 1.0 / dimension as f64)).filter(|s| s.is_finite())
}

pub(super) fn rigid_body(
    context: &Context,
    at: &At<RigidBody>,
    section: f64,
    files: &Files,
) -> Result<RigidBodySpec> {
    let i = &at.value;
    let given = [("radius", i.radius.is_some()), ("shape", i.shape.is_some())];
    context.one_of(&at.span, "a rigid body", &given)?;
    let shape = match (&i.radius, &i.shape) {
        (Some(radius), _) => RigidShape::Sphere {
            radius: context.value(radius)?,
        },
        (None, Some(shape)) => rigid(context, shape, files)?,
        (None, None) => unreachable!("one of them is given"),
    };
    let center = center(context, at, &shape)?;
    let motion = match mass(context, i, &shape, section)? {
        Some(mass) => RigidBodyMotion::Free(free(context, i, mass, &center)?),
        None => {
            for (key, span) in of_free(i) {
                if let Some(span) = span {
                    let message =
                        format!("{key} belongs to a free rigid body, this one is prescribed");
                    let help = "give it a mass or a density, or leave this out";
                    return Err(context.error_with(&span, message, help));
                }
            }
            RigidBodyMotion::Kinematic(driven(context, i, center)?)
        }
    };
    Ok(RigidBodySpec {
        name: i.name.as_ref().map_or(String::new(), |n| n.value.clone()),
        stiffness: match &i.stiffness {
            Some(given) => context.value(given)?,
            None => OF_MATERIAL,
        },
        shape,
        turn: i.rotation.as_ref().map(|r| turn(context, r)).transpose()?,
        motion,
        friction: i
            .friction
            .as_ref()
            .map(|f| friction(context, f))
            .transpose()?,
        cohesion: { i.cohesion.as_ref() }
            .map(|c| cohesion(context, &c.value))
            .transpose()?,
    })
}

/// A direction of length 1.
fn direction(context: &Context, vector: &Vector) -> Result<Point> {
    let way = context.finite_vector(vector)?;
    let size = way.iter().map(|c| c * c).sum::<f64>().sqrt();
    match size > 0.0 {
        true => Ok(way.map(|c| c / size)),
        false => Err(context.error(&vector.span, "this is no direction")),
    }
}

fn rigid(context: &Context, at: &At<Rigid>, files: &Files) -> Result<RigidShape> {
    let only = |shape: RigidShape| match shape.fits(context.dimension) {
        true => Ok(shape),
        false => {
            let message = format!(
                "a rigid {} is nothing in {}-D",
                shape.name(),
                context.dimension
            );
            let help = "in 2-D there are sphere (a disk), box and plane, in 1-D sphere and plane";
            Err(context.error_with(&at.span, message, help))
        }
    };
    Ok(match &at.value {
        Rigid::Sphere { radius } => RigidShape::Sphere {
            radius: context.value(radius)?,
        },
        Rigid::Box { size } => {
            let edges = context.finite_vector(size)?;
            only(RigidShape::Box {
                half: edges.map(|e| 0.5 * e),
            })?
        }
        Rigid::Cylinder {
            radius,
            length: long,
            axis,
        } => {
            let radius = context.value(radius)?;
            let half = 0.5 * context.value(long)?;
            // before its axis is looked at
            let axis_z = [0.0, 0.0, 1.0];
            only(RigidShape::Cylinder {
                radius,
                half,
                axis: axis_z,
            })?;
            RigidShape::Cylinder {
                radius,
                half,
                axis: { axis.as_ref() }.map_or(Ok(axis_z), |a| direction(context, a))?,
            }
        }
        Rigid::Plane { normal } => RigidShape::Plane {
            normal: direction(context, normal)?,
        },
        Rigid::Stl { file, unit } => {
            let triangles = files.stl(context, file, unit)?;
            let solid = Solid::new(triangles)
                .map_err(|e| context.error(&file.span, format!("{}: {e}", file.value)))?;
            only(RigidShape::Solid(Arc::new(solid)))?
        }
    })
}

/// Expressions of the centre.
fn center(context: &Context, at: &At<RigidBody>, shape: &RigidShape) -> Result<[Expression; 3]> {
    match (&at.value.center, shape) {
        (Some(center), _) => context.expressions(center),
        (None, RigidShape::Solid(solid)) => Ok(solid.centroid().map(Expression::constant)),
        (None, _) => Err(context.error_with(
            &at.span,
            "a rigid body needs a center",
            "center = [0, \"5 mm\", 0]",
        )),
    }
}

fn mass(context: &Context, i: &RigidBody, shape: &RigidShape, section: f64) -> Result<Option<f64>> {
    match (&i.mass, &i.density) {
        (Some(_), Some(density)) => Err(context.error(
            &density.span,
            "a rigid body has mass and density: give one of them",
        )),
        (Some(mass), None) => Ok(Some(context.value(mass)?)),
        (None, Some(density)) => {
            let of = context.value(density)?;
            let volume = shape.volume(context.dimension) * section;
            if !volume.is_finite() {
                let message =
                    "an infinite plane has no mass and cannot move freely: prescribe its motion";
                return Err(context.error(&density.span, message));
            }
            Ok(Some(of * volume))
        }
        (None, None) => Ok(None),
    }
}

/// Keys of free bodies alone.
fn of_free(i: &RigidBody) -> [(&'static str, Option<std::ops::Range<usize>>); 5] {
    [
        ("inertia", span(&i.inertia)),
        ("angular_velocity", span(&i.angular_velocity)),
        ("force", span(&i.force)),
        ("torque", span(&i.torque)),
        ("gravity", span(&i.gravity)),
    ]
}

fn free(context: &Context, i: &RigidBody, mass: f64, center: &[Expression; 3]) -> Result<FreeSpec> {
    let mut start = [0.0; 3];
    for (x, e) in start.iter_mut().zip(center) {
        let Some(c) = e.as_constant().filter(|c| c.is_finite()) else {
            let span = i.center.as_ref().map_or(0..0, |c| c.span.clone());
            return Err(context.error(
                &span,
                "a free rigid body begins at a place: its center is made of finite numbers",
            ));
        };
        *x = c;
    }
    let velocity = { i.velocity.as_ref() }.map_or(Ok([0.0; 3]), |v| context.finite_vector(v))?;
    let mut free = FreeSpec::new(mass, start, velocity);
    if let Some(inertia) = &i.inertia {
        free.inertia = Some(tensor(context, inertia)?);
    }
    if let Some(spin) = &i.angular_velocity {
        let counts_turns = |of: &Quantity<_>| match &of.value.written {
            Written::Text(text) => text
                .split(|c: char| !c.is_alphabetic())
                .any(|w| w.ends_with("Hz")),
            Written::Plain(_) => false,
        };
        if spin.value.0.iter().any(counts_turns) {
            return Err(context.error(
                &spin.span,
                "`angular_velocity` is in radians per second, Hz counts turns: 1 Hz is \"6.2832 rad/s\"",
            ));
        }
        for (x, e) in free.spin.iter_mut().zip(about(context, spin)?) {
            let Some(c) = e.as_constant().filter(|c| c.is_finite()) else {
                return Err(context.error(
                    &spin.span,
                    "the angular velocity at the start is made of finite numbers",
                ));
            };
            *x = c;
        }
    }
    if let Some(force) = &i.force {
        free.force = context.expressions(force)?;
    }
    if let Some(gravity) = &i.gravity {
        free.gravity = context.expressions(gravity)?;
    }
    if let Some(torque) = &i.torque {
        free.torque = about(context, torque)?;
    }
    Ok(free)
}

/// What goes around axes: three numbers, in 2-D that around z.
fn about<K: Measure>(context: &Context, vector: &Vector<K>) -> Result<[Expression; 3]> {
    match (&vector.value.0[..], context.dimension) {
        ([one], 2) => {
            let zero = || Expression::constant(0.0);
            let number = At {
                value: one.value.clone(),
                span: vector.span.clone(),
            };
            Ok([zero(), zero(), context.expression(&number)?])
        }
        (_, 2) => Err(context.error(
            &vector.span,
            "in 2-D a body rotates about z: expected one number",
        )),
        (_, 1) => Err(context.error(&vector.span, "on a line nothing rotates")),
        _ => context.expressions(vector),
    }
}

/// A symmetric tensor by its components.
fn tensor(context: &Context, at: &At<Vec<Quantity<Inertia>>>) -> Result<[Point; 3]> {
    let numbers = at.value.iter().map(|n| context.value(n));
    let numbers = numbers.collect::<Result<Vec<f64>>>()?;
    let off = |n: usize| numbers.get(n).copied().unwrap_or(0.0);
    match (numbers.len(), context.dimension) {
        (1, 2) => Ok([[0.0; 3], [0.0; 3], [0.0, 0.0, numbers[0]]]),
        (3 | 6, 3) => Ok([
            [numbers[0], off(3), off(4)],
            [off(3), numbers[1], off(5)],
            [off(4), off(5), numbers[2]],
        ]),
        (n, d) => {
            let expected = ["nothing", "one number", "three numbers, or six"][d.clamp(1, 3) - 1];
            let message = format!("the inertia has {n} numbers, expected {expected} in {d}-D");
            Err(context.error(&at.span, message))
        }
    }
}

/// The centre of a driven one, which a velocity may move.
fn driven(
    context: &Context,
    i: &RigidBody,
    mut center: [Expression; 3],
) -> Result<[Expression; 3]> {
    if let Some(velocity) = &i.velocity {
        let speed = context.finite_vector(velocity)?;
        for (a, c) in center.iter_mut().enumerate() {
            let Some(start) = c.as_constant() else {
                return Err(context.error(
                    &velocity.span,
                    "the centre moves already by its expression: drop one of them",
                ));
            };
            if speed[a] != 0.0 {
                *c = Expression::parse(&format!("{start:e} + {:e}*t", speed[a]), &[])
                    .map_err(|e| context.error(&velocity.span, e.message))?;
            }
        }
    }
    Ok(center)
}

fn turn(context: &Context, at: &At<Rotation>) -> Result<TurnSpec> {
    let z = [0.0, 0.0, 1.0];
    let axis = match (&at.value.axis, context.dimension) {
        (_, 1) => return Err(context.error(&at.span, "on a line nothing rotates")),
        (Some(axis), 2) => {
            return Err(context.error(&axis.span, "in 2-D a body rotates about z: leave axis out"));
        }
        (Some(axis), _) => direction(context, axis)?,
        (None, _) => z,
    };
    let angle = context.expression(&at.value.angle)?;
    if angle.depends_on_position() {
        let message = "the angle depends on the place, expected an expression of t";
        return Err(context.error(&at.value.angle.span, message));
    }
    Ok(TurnSpec { axis, angle })
}
