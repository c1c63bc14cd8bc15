//! Where points are beside the surface of a rigid body.

use crate::body::{Body, Field};
use crate::boundary_condition::rigid::Rigid;
use crate::space::full;
use crate::space::rigid::RigidShape;
use crate::space::rotation::{times, transposed_times};
use crate::state::words;

/// The surface of an rigid_body along the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// About a centre.
    Sphere,
    /// About the line through the centre along this axis.
    Cylinder(usize),
    /// Across this axis, through the centre.
    Plane(usize),
}

/// The surface of an rigid_body.
#[derive(Debug, Clone)]
pub(super) enum Surface {
    /// Along the axes, whatever the body's own; a plane has the radius 0.
    Aligned(Form, Push, f64),
    /// Turns with the body.
    Turned(RigidShape),
}

/// Which way an rigid_body pushes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Push {
    /// Out of a sphere or cylinder; up what is below a plane.
    Out,
    /// Back into a sphere or cylinder; down what is above a plane.
    In,
}

impl Form {
    /// Length of `d`, the way from the centre, across the form; `aside` is squared on axes that the body does not have.
    fn distance<const D: usize>(self, d: &[f64; D], aside: f64) -> f64 {
        match self {
            Form::Sphere => (d.iter().map(|c| c * c).sum::<f64>() + aside).sqrt(),
            Form::Cylinder(axis) => {
                let across = (0..D).filter(|a| *a != axis).map(|a| d[a] * d[a]);
                (across.sum::<f64>() + aside).sqrt()
            }
            Form::Plane(axis) => d.get(axis).copied().unwrap_or(0.0),
        }
    }

    /// The way from the centre to a point, and its length across the form.
    fn offset<const D: usize>(
        self,
        center: &[f64; 3],
        body: &Body<D>,
        u: &Field<D>,
        i: usize,
    ) -> ([f64; D], f64) {
        // the centre may lie off a plane or line of points
        let off = (D..3).filter(|a| self != Form::Cylinder(*a));
        let aside: f64 = off.map(|a| center[a] * center[a]).sum();
        let x = body.position(i);
        let d: [f64; D] = crate::array::from_fn(|a| {
            let d = x[a] + u[a][i] - center[a];
            match (self, body.period[a]) {
                (Form::Sphere | Form::Cylinder(_), Some(p)) => d - p * (d / p).round(),
                (Form::Plane(_), _) | (_, None) => d,
            }
        });
        (d, self.distance(&d, aside))
    }

    /// Force density on a point of surfaces along the axes, in the order of operations of LAMMPS.
    pub(super) fn force<const D: usize>(
        self,
        push: Push,
        stiffness: f64,
        near: &Near<D>,
    ) -> [f64; D] {
        let Near { arm, r, gap, .. } = *near;
        let strength = match push {
            Push::Out => stiffness * gap * gap,
            Push::In => -stiffness * gap * gap,
        };
        crate::array::from_fn(|a| match self {
            Form::Sphere => strength / r * arm[a],
            Form::Cylinder(axis) if a == axis => 0.0,
            Form::Cylinder(_) => strength / r * arm[a],
            Form::Plane(axis) if a == axis => strength,
            Form::Plane(_) => 0.0,
        })
    }
}

impl Push {
    /// From a surface of this radius to a point at this distance; negative where it is pushed.
    fn gap(self, distance: f64, radius: f64) -> f64 {
        match self {
            Push::Out => distance - radius,
            Push::In => radius - distance,
        }
    }
}

/// A point near a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near<const D: usize> {
    /// From the centre, and how long that is across a form along the axes (1 of others).
    pub arm: [f64; D],
    pub r: f64,
    /// Negative where it is pushed.
    pub gap: f64,
    /// Along which it is pushed out, of length 1.
    pub normal: [f64; D],
}

words!([const D: usize] Near<D> { arm: [f64; D], r: f64, gap: f64, normal: [f64; D] });

impl Surface {
    /// Where a point is beside the surface; `None`: further away than `most` for sure.
    pub(super) fn near<const D: usize>(
        &self,
        rigid: &Rigid<D>,
        body: &Body<D>,
        u: &Field<D>,
        i: usize,
        most: f64,
    ) -> Option<Near<D>> {
        let center = &rigid.center;
        match self {
            Surface::Aligned(form, push, radius) => {
                let (arm, r) = form.offset(center, body, u, i);
                let normal = match form {
                    // a point in the centre has no direction
                    Form::Sphere | Form::Cylinder(_) if r == 0.0 => [0.0; D],
                    Form::Sphere => arm.map(|c| c / r),
                    Form::Cylinder(axis) => {
                        crate::array::from_fn(|a| if a == *axis { 0.0 } else { arm[a] / r })
                    }
                    Form::Plane(axis) => {
                        crate::array::from_fn(|a| if a == *axis { 1.0 } else { 0.0 })
                    }
                };
                Some(Near {
                    arm,
                    r,
                    gap: push.gap(r, *radius),
                    normal: match push {
                        Push::Out => normal,
                        Push::In => normal.map(|c| -c),
                    },
                })
            }
            Surface::Turned(shape) => {
                let x = body.position(i);
                let plane = matches!(shape, RigidShape::Plane { .. });
                let arm: [f64; D] = crate::array::from_fn(|a| {
                    let d = x[a] + u[a][i] - center[a];
                    match body.period[a] {
                        Some(p) if !plane => d - p * (d / p).round(),
                        Some(_) | None => d,
                    }
                });
                let square: f64 = arm.iter().map(|c| c * c).sum();
                let far = shape.reach(D) + most;
                if square > far * far {
                    return None;
                }
                let (gap, normal) = shape.distance(&transposed_times(&rigid.axes, &full(&arm)));
                let normal = times(&rigid.axes, &normal);
                Some(Near {
                    arm,
                    r: 1.0,
                    gap,
                    normal: crate::array::from_fn(|a| normal[a]),
                })
            }
        }
    }
}
