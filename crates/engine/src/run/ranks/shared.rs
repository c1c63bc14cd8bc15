//! What ranks share of a spec so far.

use crate::error::BuildError;
use crate::spec::{LawSpec, Spec};

/// Can ranks share the model of a spec?
///
/// # Errors
/// What they do not share yet.
pub fn shared(spec: &Spec) -> Result<(), BuildError> {
    let bonds = |law: &LawSpec| match law {
        LawSpec::Pmb(_)
        | LawSpec::Lps(_)
        | LawSpec::Lps3d { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Springs(_)
        | LawSpec::Atoms(_)
        | LawSpec::Named(_) => true,
        LawSpec::Micromoduli(linear) => !linear.couples_masses() && !linear.has_load_map(),
    };
    match spec.materials.iter().all(|m| bonds(&m.law)) {
        true => Ok(()),
        false => Err(BuildError::unsupported(
            "materials",
            "ranks do not share coarsened bodies whose masses are coupled, or that carry loads of a finer one, yet",
        )
        .help("run it in one process, on as many threads as there are")),
    }
}
