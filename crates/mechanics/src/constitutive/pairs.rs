//! Constants of pairs of materials, where they do not follow from the two.

use super::Laws;
use crate::error::BuildError;
use crate::interaction::pairs::{BondConstants, BondTable};
use crate::interaction::{PairTable, Toughness, in_series};
use crate::law::solid::eam_like::Solid;
use crate::message;
use crate::quantity::{Dimension, Message, rounded};
use crate::spec::{ContactStiffness, LawSpec, PmbStiffness, Spec};

/// What pairs of materials have, checked.
pub(super) fn bond_table(
    spec: &Spec,
    laws: &Laws,
    horizon: f64,
    spacing: f64,
) -> Result<Option<BondTable>, BuildError> {
    let materials = spec.materials.len();
    if spec.interactions.pairs.is_empty() {
        return Ok(None);
    }
    let invalid = |message: Message| Err(BuildError::invalid("pairs", message));
    let unsupported = |message: &str| Err(BuildError::unsupported("pairs", message));
    if spec.interactions.pairs.len() != materials * materials {
        return invalid(message![format!(
            "{} pairs of {materials} materials, expected {}",
            spec.interactions.pairs.len(),
            materials * materials
        )]);
    }
    if spec.bonds.influence.is_directed() && matches!(laws, Laws::Solid(_)) {
        return unsupported(
            "an influence function that knows directions is one of each family, and pairs of state-based materials have constants of each bond",
        );
    }
    let mut pairs = vec![];
    for (n, p) in spec.interactions.pairs.iter().enumerate() {
        let (of, with) = (n / materials, n % materials);
        let (stiffness, volume) = match (laws, &p.law) {
            (Laws::Bond(_), LawSpec::Pmb(PmbStiffness::Micromodulus(c))) => (*c, 0.0),
            (Laws::Solid(_), law @ LawSpec::Lps3d { .. }) => {
                let Some(solid) = Solid::of_law(spec.space.dimension, spec.space.plane, law) else {
                    return unsupported("a law that is no solid");
                };
                (solid.beta, solid.kappa)
            }
            _ => {
                return unsupported(
                    "pairs have a micromodulus (pmb) or three-dimensional moduli (lps), of the law of the materials",
                );
            }
        };
        let mirrored = &spec.interactions.pairs[with * materials + of];
        let fine = |x: f64| x >= 0.0 && x.is_finite();
        if !fine(stiffness) || !fine(p.horizon) || p.horizon > horizon * (1.0 + 1e-9) {
            return invalid(message![
                format!(
                    "materials {of} and {with} have the stiffness {} and the horizon ",
                    rounded(stiffness, 4)
                ),
                Dimension::LENGTH.of(p.horizon),
                "; that of the body is ",
                Dimension::LENGTH.of(horizon),
            ]);
        }
        if p.horizon != mirrored.horizon {
            return invalid(message![format!(
                "materials {of} and {with} must have the same horizon both ways round"
            )]);
        }
        pairs.push(BondConstants {
            horizon: p.horizon,
            stiffness,
            volume,
            toughness: Toughness {
                s00: p.critical_stretch,
                alpha: p.alpha,
            },
        });
    }
    let scaling = spec.bonds.partial_volume_correction.then_some(spacing);
    Ok(Some(BondTable::new(materials, pairs, scaling)))
}

/// The table of all pairs of materials, whose own stiffnesses are `own`.
pub fn contact_stiffness(
    stiffness: &ContactStiffness,
    own: &[f64],
) -> Result<PairTable, BuildError> {
    let table = match stiffness {
        ContactStiffness::Same(one) => PairTable::uniform(*one),
        ContactStiffness::Laws => PairTable::new(own.len(), |a, b| in_series(own[a], own[b])),
        ContactStiffness::Pairs(rows) => {
            let fits = rows.len() == own.len() && rows.iter().all(|r| r.len() == own.len());
            let symmetric = || (0..rows.len()).all(|a| (0..a).all(|b| rows[a][b] == rows[b][a]));
            if !fits || !symmetric() {
                return Err(BuildError::invalid(
                    "contact.stiffness",
                    format!(
                        "expected a symmetric table of {0} by {0} numbers, one for every pair of materials",
                        own.len()
                    ),
                ));
            }
            PairTable::new(own.len(), |a, b| rows[a][b])
        }
    };
    Ok(table)
}
