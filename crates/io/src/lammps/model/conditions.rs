//! A script's conditions as the engine takes them.

use peridyne::condition::driven::Drive;

use crate::lammps::atoms::Members;
use crate::lammps::host::Condition;

/// Its values at this instant; `None` for `enforce2d`, which a body in two dimensions obeys by itself.
pub fn drive(condition: &Condition) -> Option<Drive> {
    match condition {
        Condition::Indent {
            stiffness,
            center,
            radius,
            ..
        } => Some(Drive::Indent {
            stiffness: *stiffness,
            center: *center,
            radius: *radius,
        }),
        Condition::SetForce { force, .. } => Some(Drive::Replace(*force)),
        Condition::AddForce { force, .. } => Some(Drive::Add(*force)),
        Condition::Enforce2d { .. } => None,
    }
}

/// Ids (from 0) of the atoms it acts on; `None`: all `n`.
pub fn members(condition: &Condition, n: usize) -> Option<Vec<u32>> {
    let (Condition::Indent { members, .. }
    | Condition::SetForce { members, .. }
    | Condition::AddForce { members, .. }
    | Condition::Enforce2d { members }) = condition;
    match members.as_ref() {
        Members::All => None,
        some => Some(
            (0..n as u32)
                .filter(|i| some.contains(*i as usize))
                .collect(),
        ),
    }
}
