//! The time step of a model: what it may be, and what it is.

use super::atoms;
use super::contact::Rules;
use super::inertia::state::Inertia;
use super::parts::Part;
use super::probe;
use crate::body::Body;
use crate::constitutive::ConstitutiveModels;
use crate::dynamics::contact_step::ContactLimit;
use crate::error::BuildError;
use crate::interaction::Interaction;
use crate::message;
use crate::quantity::{Dimension, Warnings};
use crate::spec::{Spec, TimeStep};

/// Part of the stability limit that peridynamic bodies run at if nobody says otherwise.
const SOLID_FRACTION: f64 = 0.8;

/// The longest stable explicit steps (time); infinite where nothing limits them, or nobody looked.
pub(super) struct Limits {
    /// Of the bonds.
    pub bond: f64,
    /// Of points that touch.
    pub contact: f64,
    touching: Option<ContactLimit>,
}

impl Limits {
    /// Nobody looked.
    pub const UNKNOWN: Limits = Limits {
        bond: f64::INFINITY,
        contact: f64::INFINITY,
        touching: None,
    };

    pub fn stable(&self) -> f64 {
        self.bond.min(self.contact)
    }

    /// Those of a body with these bonds, whose cells had `cell_volume`.
    pub fn of<const D: usize>(
        spec: &Spec,
        (parts, constitutive): (&[Part], &ConstitutiveModels),
        (body, inertia): (&Body<D>, Option<&Inertia<D>>),
        interaction: &mut dyn Interaction<D>,
        cell_volume: Option<f64>,
        repulsion: Option<&Rules>,
    ) -> Result<Limits, BuildError> {
        let lambda = match inertia {
            Some(inertia) => inertia.largest_eigenvalue(body, interaction),
            None => probe::bonds(constitutive.first(), body, interaction, spec, cell_volume)?,
        };
        let touching = repulsion.and_then(|r| r.limit(parts, body, lambda));
        Ok(Limits {
            bond: probe::step(lambda),
            contact: touching.map_or(f64::INFINITY, |t| probe::step(t.lambda)),
            touching,
        })
    }
}

/// The time step that a spec asks for, of a body of so many points.
pub(super) fn time_step(
    spec: &Spec,
    points: usize,
    limits: &Limits,
    repulsion: Option<&Rules>,
    warnings: &mut Warnings,
) -> Result<f64, BuildError> {
    let stepper = spec.run.schedule.stepper;
    if stepper.rests() {
        // what spreads says how long a step may be
        return match spec.run.schedule.time_step {
            TimeStep::Fixed(dt) => Ok(dt),
            TimeStep::Fraction(_) | TimeStep::Auto => Ok(1.0),
        };
    }
    let implicit = stepper.has_inertia() && stepper.solves();
    if implicit && spec.run.schedule.time_step == TimeStep::Auto {
        return Err(BuildError::missing(
            "schedule.time_step",
            "an implicit step is stable at any length: how long it is must be said",
        )
        .help("write time_step as a number, a thirtieth of the shortest period of interest, or { safety = 20 } for twenty explicit ones"));
    }
    let fraction = match spec.run.schedule.time_step {
        TimeStep::Fixed(_) => None,
        TimeStep::Fraction(x) => Some(x),
        TimeStep::Auto if spec.potential().is_some() => Some(atoms::FRACTION),
        TimeStep::Auto => Some(SOLID_FRACTION),
    };
    let dt = match (spec.run.schedule.time_step, fraction) {
        (_, Some(x)) if limits.stable().is_finite() => x * limits.stable(),
        (TimeStep::Fraction(_) | TimeStep::Auto, _) if points == 1 => {
            return Err(BuildError::empty(
                "body",
                "the body has one point, and a point alone has no bonds: no stable step can be derived",
            )
            .help("a larger region or a smaller spacing, or time_step as a number"));
        }
        (TimeStep::Fraction(_) | TimeStep::Auto, _) => {
            return Err(BuildError::ill_posed(
                "schedule.time_step",
                "nothing resists: no stable step can be derived",
            )
            .help("give time_step as a number"));
        }
        (TimeStep::Fixed(dt), _) => dt,
    };
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(BuildError::invalid(
            "schedule.time_step",
            format!("the time step is {dt}, expected a positive number"),
        ));
    }
    // a step that was chosen may be right where nothing ever touches
    let chosen = matches!(spec.run.schedule.time_step, TimeStep::Fixed(_));
    let limit = if chosen { limits.bond } else { limits.stable() };
    if dt > limits.contact && dt <= limit && !implicit {
        let of = limits
            .touching
            .map_or([0, 0], |t| t.materials)
            .map(|k| repulsion.map_or("", |r| r.name(spec, k)));
        let [a, b] = of;
        let between = if a == b {
            format!("points of {a}")
        } else {
            format!("{a} and {b}")
        };
        warnings.push(message![
            "the time step ",
            Dimension::TIME.of(dt),
            " is above the stability limit ",
            Dimension::TIME.of(limits.contact),
            format!(" of contact between {between}: the run goes unstable if many of them touch"),
        ]);
    }
    if dt > limit && !implicit {
        let message = message![
            "the time step ",
            Dimension::TIME.of(dt),
            " is above the stability limit ",
            Dimension::TIME.of(limit),
            " of this body",
        ];
        if !spec.run.schedule.force_unstable {
            return Err(
                BuildError::invalid("schedule.time_step", message).help(message![
                    "write time_step = \"auto\", or ",
                    Dimension::TIME.of(0.8 * limits.stable()),
                    "; force_unstable = true under [run] runs it all the same",
                ]),
            );
        }
        warnings.push(message);
    }
    Ok(dt)
}
