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
        | LawSpec::LpsAsTyped { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Springs(_)
        | LawSpec::Atoms(_)
        | LawSpec::Named(_) => true,
        LawSpec::Micromoduli(linear) => !linear.couples_masses() && !linear.has_carriers(),
    };
    let limits = [
        ("bonds", "fields on nodes", spec.bonds.smooth.is_some()),
        (
            "materials",
            "coarsened bodies whose masses are coupled, or that carry loads of a finer one",
            !spec.materials.iter().all(|m| bonds(&m.law)),
        ),
    ];
    match limits.into_iter().find(|(_, _, wrong)| *wrong) {
        None => Ok(()),
        Some((path, what, _)) => Err(BuildError::unsupported(
            path,
            format!("ranks do not share {what} yet"),
        )
        .help("run it in one process, on as many threads as there are")),
    }
}
