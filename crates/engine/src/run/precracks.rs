//! The bonds that a spec cuts before the first step.

use crate::body::Body;
use crate::error::BuildError;
use crate::fracture::precrack::Crack;
use crate::interaction::Interaction;
use crate::quantity::Warnings;
use crate::spec::{CrackKind, Spec};

/// Cuts the bonds that pre-cracks cross, and lets the interaction weigh its families between those that were never there and those
/// that broke. Directed bonds cut.
pub(super) fn cut<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    interaction: &mut dyn Interaction<D>,
    warnings: &mut Warnings,
) -> Result<u64, BuildError> {
    let mut cut = 0;
    for kind in [CrackKind::Absent, CrackKind::Broken] {
        if kind == CrackKind::Broken {
            interaction.prepare(body);
        }
        for (n, crack) in spec
            .precracks
            .iter()
            .enumerate()
            .filter(|(_, c)| c.kind == kind)
        {
            let shape = Crack::new(&crack.shape, body.period)
                .map_err(|e| e.at(format!("precracks[{n}]")))?;
            let count = interaction.cut(body, kind, &|from, to| shape.crosses(&from, &to));
            if count == 0 {
                warnings.push(format!("pre-crack {} cuts no bond", n + 1));
            }
            cut += count;
        }
    }
    Ok(cut)
}
