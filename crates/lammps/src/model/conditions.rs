//! A script's conditions as the engine takes them.

use peridyne::boundary_condition::driven::Drive;

use crate::atoms::Members;
use crate::host::Condition;

/// Its values at this instant; `None` for `enforce2d`, which a body in two dimensions obeys by itself.
///
/// `height`: z of a body in two dimensions, which the engine puts at 0.
pub fn drive(condition: &Condition, height: f64) -> Option<Drive> {
    match condition {
        Condition::Indent {
            stiffness,
            form,
            push,
            center: [x, y, z],
            radius,
            ..
        } => Some(Drive::Indent {
            stiffness: *stiffness,
            form: *form,
            push: *push,
            center: [*x, *y, z - height],
            radius: *radius,
        }),
        Condition::SetForce { force, .. } => Some(Drive::Replace(*force)),
        Condition::SetForceEach { force, .. } => Some(Drive::ReplaceEach(force.clone())),
        Condition::AddForce { force, .. } => Some(Drive::Add(*force)),
        Condition::AddForceEach { force, .. } => Some(Drive::AddEach(force.clone())),
        Condition::Drag { gamma, .. } => Some(Drive::Drag(gamma.clone())),
        Condition::Enforce2d { .. } => None,
    }
}

/// Ids (from 0) of the atoms it acts on; `None`: all `n`.
pub fn members(condition: &Condition, n: usize) -> Option<Vec<u32>> {
    let (Condition::Indent { members, .. }
    | Condition::SetForce { members, .. }
    | Condition::SetForceEach { members, .. }
    | Condition::AddForce { members, .. }
    | Condition::AddForceEach { members, .. }
    | Condition::Drag { members, .. }
    | Condition::Enforce2d { members }) = condition;
    ids(members, n)
}

/// Ids (from 0) of members; `None`: all `n`.
pub fn ids(members: &Members, n: usize) -> Option<Vec<u32>> {
    match members {
        Members::All => None,
        some @ Members::Some(_) => Some(
            (0..n as u32)
                .filter(|i| some.contains(*i as usize))
                .collect(),
        ),
    }
}
