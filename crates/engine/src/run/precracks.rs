//! The bonds that a spec cuts before the first step.

use crate::body::Body;
use crate::error::BuildError;
use crate::fracture::precrack::Crack;
use crate::interaction::{BondStatus, Interaction};
use crate::message;
use crate::quantity::{Message, Warnings, place};
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
    for kind in [CrackKind::Excluded, CrackKind::Broken] {
        if kind == CrackKind::Broken {
            interaction.prepare(body);
        }
        for (n, crack) in spec
            .damage
            .precracks
            .iter()
            .enumerate()
            .filter(|(_, c)| c.kind == kind)
        {
            let shape = Crack::new(&crack.shape, body.period())
                .map_err(|e| e.at(format!("precracks[{n}]")))?;
            let count = interaction.cut(body, kind, &|from, to| shape.crosses(&from, &to));
            let count = body.count(count);
            if count == 0 {
                warnings.push(format!("pre-crack {} cuts no bond", n + 1));
            }
            warnings.extend(along_points(n + 1, &shape, body));
            cut += count;
        }
    }
    Ok(cut)
}

/// Directed bonds that are whole.
pub(super) fn left<const D: usize>(body: &Body<D>, interaction: &dyn Interaction<D>) -> u64 {
    let mut left = 0;
    interaction.each_bond(body, &mut |_, _, _, state| {
        left += u64::from(state == BondStatus::Whole);
    });
    body.count(left)
}

/// Points on a crack have lost the bonds on one of its sides only.
fn along_points<const D: usize>(
    number: usize,
    shape: &Crack<D>,
    body: &Body<D>,
) -> Option<Message> {
    let on = |slot: &&u32| {
        let slot = **slot as usize;
        let x = body.position(slot);
        shape.carries(
            &crate::array::from_fn(|a| x[a]),
            1e-6 * body.spacing_at(slot),
        )
    };
    let count = body.count(body.slots().iter().filter(on).count() as u64);
    // a crack may meet a point or two
    if count < if D == 1 { 1 } else { 3 } {
        return None;
    }
    let own = body.slots().iter().position(|slot| on(&slot));
    let own = own.map_or(f64::INFINITY, |id| body.id_of_all(id) as f64);
    let first = body.position_of(body.least(own) as usize);
    Some(message![
        format!("pre-crack {number} runs through {count} points, "),
        place(&first[..D]),
        " is one of them: they belong to one of its faces, and the crack is half a spacing beside where it was drawn. Move it, or the origin of the lattice, by half a spacing",
    ])
}
