//! What laws and what acts on a system have not, once it is built, and what its steppers ask for.

use super::{Lack, Need, Property, met};
use crate::boundary_condition::load::{Load, LoadKind};
use crate::error::BuildError;
use crate::law::descriptor::Memory;
use crate::quantity::rounded;
use crate::run::system::System;
use crate::spec::{Method, Solver, Statics};
use crate::statics;

/// What increments of load ask for.
pub(in crate::run) fn of_statics<const D: usize>(
    system: &System<D>,
    options: Statics,
) -> Result<(), BuildError> {
    let mut needs = vec![Need::new(
        Property::Motionless,
        "statics",
        ", and in equilibrium nothing moves",
        "",
    )];
    if !options.timed {
        needs.push(Need::new(
            Property::Timeless,
            "statics",
            ", and t of these increments is the load factor, not a time",
            "write duration, the time in which the load is applied; its increments are steps in time then",
        ));
    }
    needs.extend([
        Need::new(
            Property::Balance,
            "conditions",
            ", which is what increments look for",
            "prescribe a displacement, as a function of t from 0 to 1",
        ),
        Need::new(
            Property::Tangent,
            "conditions",
            ", which equilibrium needs",
            "take velocity Verlet, or write the force as expressions of x, y, z and t",
        ),
    ]);
    match options.method {
        Method::Linear => needs.extend([
            Need::new(
                Property::Memoryless,
                "statics.method",
                ", and a linear solution knows the reference alone",
                "write method = \"newton\" or \"relaxation\"",
            ),
            Need::new(
                Property::DeadLoads,
                "statics.method",
                ", and a linear solution has the slopes of bonds alone",
                "write method = \"newton\"",
            ),
            Need::new(
                Property::Continuous,
                "statics.method",
                ", and a linear solution has one slope",
                "write method = \"relaxation\"",
            ),
        ]),
        Method::Newton => needs.push(Need::new(
            Property::Continuous,
            "statics.method",
            ": where that begins the slope of forces jumps, and nothing but inertia takes Newton's method across",
            "write method = \"relaxation\"",
        )),
        Method::Relaxation | Method::Fire => needs.push(Need::new(
            Property::Symmetric,
            "statics.method",
            ", and this method seeks the least energy",
            "write method = \"linear\"",
        )),
    }
    needs.extend(of_solver(options.solver, "statics.solver"));
    met(needs, &lacks(system))
}

/// What implicit steps ask for.
pub(in crate::run) fn of_implicit_steps<const D: usize>(
    system: &System<D>,
    solver: Solver,
) -> Result<(), BuildError> {
    let mut needs = vec![Need::new(
        Property::Tangent,
        "conditions",
        ", which an implicit step needs",
        "integrator = \"verlet\" knows it; or leave it out",
    )];
    needs.extend(of_solver(solver, "schedule.solver"));
    met(needs, &lacks(system))
}

/// What a load asks for whose factor is sought.
pub(in crate::run) fn of_control<const D: usize>(
    system: &System<D>,
    proportional: bool,
) -> Result<(), BuildError> {
    let mut lacks = lacks(system);
    if !proportional {
        let says = "loads that are not proportional to t have no factor that rises and falls";
        let instead = "write each as t times what it is at t = 1; what is held is held at 0";
        lacks.push(Lack::new(Property::Proportional, says, instead).at("conditions"));
    }
    let needs = vec![
        Need::new(
            Property::ForceFree,
            "statics.control",
            ", and the load factor is counted from where nothing pulls",
            "leave control out",
        ),
        Need::new(
            Property::Proportional,
            "conditions",
            ", which control looks for",
            "",
        ),
    ];
    met(needs, &lacks)
}

fn of_solver(solver: Solver, path: &str) -> Option<Need> {
    let needs = Need::new(
        Property::Symmetric,
        path,
        ", and conjugate gradients need a symmetric body",
        "write solver = \"direct\"",
    );
    match solver {
        Solver::ConjugateGradients => Some(needs),
        Solver::Auto | Solver::Direct => None,
    }
}

fn lacks<const D: usize>(system: &System<D>) -> Vec<Lack> {
    let named = system.constitutive.named();
    let mut lacks: Vec<Lack> = named.flat_map(|law| of_law(law.memory())).collect();
    let applied = &system.applied;
    if applied.free().next().is_some() {
        let says = "a rigid body with a mass is moved by forces";
        let instead =
            "leave mass and velocity out, and write center as a function of t from 0 to 1";
        lacks.push(Lack::new(Property::Motionless, says, instead).at("rigid_bodies"));
    }
    let mut constraints = system.prescribed.constraints.iter();
    if constraints.any(|c| c.is_velocity()) {
        let says = "a prescribed velocity moves its points on and on";
        let instead = "prescribe a displacement, as a function of t from 0 to 1";
        lacks.push(Lack::new(Property::Motionless, says, instead).at("conditions"));
    }
    let replaces = |kind: &LoadKind<D>| matches!(kind, LoadKind::Replace(_));
    if applied.loads.iter().any(|l| replaces(&l.kind)) {
        let says = "a force that replaces all others keeps its points out of equilibrium";
        lacks.push(Lack::new(Property::Balance, says, ""));
    }
    if applied.loads.iter().any(Load::has_stiffness) {
        let says = "a force on points changes with their displacements";
        lacks.push(Lack::new(Property::DeadLoads, says, ""));
    }
    if let Some(what) = applied.without_tangent() {
        let says = format!("{what} has no tangent");
        lacks.push(Lack::new(Property::Tangent, says, ""));
    }
    if system.contact.is_some() || !applied.rigid.is_empty() {
        let says = "contact forces begin when something touches";
        let instead = "write contact = false";
        lacks.push(Lack::new(Property::Continuous, says, instead));
    }
    let asymmetry = system.interaction.asymmetry();
    if asymmetry > statics::SYMMETRIC {
        let asymmetry = rounded(asymmetry, 2);
        let says = format!("action is not reaction in this body (asymmetry {asymmetry})");
        lacks.push(Lack::new(Property::Symmetric, says, ""));
    }
    if !system.at_peace() {
        let says = "bonds of this law or body pull at each other in the reference";
        lacks.push(Lack::new(Property::ForceFree, says, ""));
    }
    lacks
}

fn of_law((memory, name): (Memory, &str)) -> Vec<Lack> {
    let answers = format!("the law {name} is rate-dependent");
    let remembers = || {
        let says = format!("the law {name} is history-dependent");
        Lack::new(Property::Memoryless, says, "")
    };
    match memory {
        Memory::Nothing => vec![],
        Memory::Path => vec![remembers()],
        Memory::Time => vec![Lack::new(Property::Timeless, answers, ""), remembers()],
        Memory::Shock => {
            let says = format!("{answers} and sustains no shear at rest");
            let instead = "write [run] with a duration, without integrator";
            vec![Lack::new(Property::Motionless, says, instead), remembers()]
        }
    }
}
