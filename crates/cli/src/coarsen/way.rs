//! What the flags of coarsening want.

use super::arguments::CoarsenArguments;
use crate::failure::Failure;
use peridyne_theory::coarsen::{Mass, Scheme};

/// How the flags want it.
#[derive(Clone, Copy)]
pub(super) struct Way {
    pub scheme: Scheme,
    pub symmetrise: bool,
    /// Are loads condensed, or as in the paper?
    pub condensed: bool,
    /// Are all prescribed points retained?
    pub supports: bool,
    pub mass: Mass,
}

impl Way {
    pub fn of(arguments: &CoarsenArguments) -> Result<Way, Failure> {
        let one_of = |flag: &str, value: &str, names: &[&str]| {
            names.iter().position(|n| *n == value).ok_or_else(|| {
                let (last, first) = names.split_last().unwrap_or((&"", &[]));
                Failure::input(format!(
                    "--{flag} {value}: expected {} or {last}",
                    first.join(", ")
                ))
            })
        };
        let masses = [Mass::Blend, Mass::Lumped, Mass::Consistent];
        let mass = one_of("mass", &arguments.mass, &["blend", "lumped", "consistent"])?;
        let schemes = [Scheme::Energy, Scheme::Rows, Scheme::Schur];
        let scheme = one_of("scheme", &arguments.scheme, &["energy", "rows", "schur"])?;
        if !(arguments.rotation >= 0.0) {
            return Err(Failure::input(format!(
                "--rotation {}: expected a fraction of the stiffness, such as 0.001",
                arguments.rotation
            )));
        }
        Ok(Way {
            scheme: schemes[scheme],
            symmetrise: one_of("symmetrise", &arguments.symmetrise, &["no", "yes"])? == 1,
            condensed: one_of("loads", &arguments.loads, &["condensed", "silling"])? == 0,
            mass: masses[mass],
            supports: one_of("supports", &arguments.supports, &["kept", "thinned"])? == 0,
        })
    }
}
