//! Bonds of the bodies of a spec: bound, scaled, cut, and looked at.

use super::bodies::Bodies;
use crate::body::Body;
use crate::constitutive::{ConstitutiveModels, breaks};
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::interaction::Interaction;
use crate::interaction::{Replicated, Smoothed};
use crate::message;
use crate::quantity::{Dimension, Warnings, rounded};
use crate::run::bind::bind;
use crate::run::{bonds, gaps, lints, precracks};
use crate::spec::Spec;
use crate::statics::SYMMETRIC;

/// Laws and bonds.
pub(super) struct Bonds<const D: usize> {
    pub constitutive: ConstitutiveModels,
    pub interaction: Box<dyn Interaction<D>>,
    /// Volume that all cells had before surfaces were scaled; `None`: they have several.
    pub cell_volume: Option<f64>,
    /// Directed bonds within round-off of the horizon.
    pub near_horizon: u64,
    pub directed: u64,
    /// Cut by pre-cracks, directed.
    pub cut: u64,
    pub asymmetry: f64,
}

impl<const D: usize> Bonds<D> {
    pub fn new(
        spec: &Spec,
        simd: Simd,
        bodies: &mut Bodies<'_, D>,
        warnings: &mut Warnings,
    ) -> Result<Self, BuildError> {
        let (registry, parts, body) = (&bodies.names.registry, &mut bodies.parts, &mut bodies.body);
        let cell_volume = body.volume().uniform();
        let (constitutive, mut interaction) = match bodies.smoothed.take() {
            None => bind(spec, parts, body, registry, simd, warnings)?,
            Some((mut atoms, kinematic)) => {
                let (constitutive, inner) =
                    bind(spec, parts, &mut atoms, registry, simd, warnings)?;
                let nodes = bodies.whole_nodes.take();
                let of = nodes.as_ref().unwrap_or(body);
                let made = Box::new(Smoothed::new(of, atoms, inner, kinematic, breaks(spec)));
                let made: Box<dyn Interaction<D>> = match nodes {
                    None => made,
                    Some(nodes) => Box::new(Replicated::new(body, nodes, made)),
                };
                (constitutive, made)
            }
        };
        warnings.extend(bonds::scale(spec, body, interaction.as_mut())?);
        // a ratio is meant inclusively; only a length leaves the decision to round-off
        let ratios = constitutive.all().filter(|m| m.ratio).count();
        let near_horizon = match ratios {
            0 => bodies.ends.max(body.count(interaction.near_horizon())),
            // lists do not say whose bonds they count
            _ => bodies.ends,
        };
        if near_horizon > 0 {
            let (count, what) = match bodies.ends {
                0 => (near_horizon.div_ceil(2), "bonds"),
                ends => (ends, "bonds of the stencil"),
            };
            warnings.push(message![
                format!("{count} {what} end within round-off of the horizon "),
                Dimension::LENGTH.of(bodies.horizon),
                ": a larger or smaller number in its last digits changes the family; write the horizon as a whole number of spacings (m_ratio), or well between two distances",
            ]);
        }
        let cut = cut(spec, body, interaction.as_mut(), warnings)?;
        if bodies.atoms && breaks(spec) {
            warnings.push(
                "atoms interact with those of their family in the reference whose bonds are intact, and with no others: parts that come apart and meet again go through each other",
            );
        }
        // of a part it was told before it was cut
        if body.subdomain().is_none() {
            warnings.extend(lints::all(spec, body, &bodies.names.sets)?);
        }
        if { spec.interactions.contact.as_ref() }.is_some_and(|c| c.conductance.is_some())
            && spec.materials.iter().any(|m| m.fracture.is_some())
        {
            warnings.push(
                "contact conducts heat between points that were never bonded: none crosses a crack, whether its faces touch or not",
            );
        }
        let asymmetry = body.most(interaction.asymmetry());
        if asymmetry > SYMMETRIC {
            warnings.push(format!(
                "action is not reaction in this body (asymmetry {}): it has no energy, what is printed as strain energy is that of its symmetric part, and neither energy nor momentum need balance",
                rounded(asymmetry, 2)
            ));
        }
        let made = Bonds {
            directed: body.count(interaction.directed_bonds()),
            constitutive,
            interaction,
            cell_volume,
            near_horizon,
            cut,
            asymmetry,
        };
        made.check(bodies)?;
        Ok(made)
    }

    /// Is there a bond left?
    fn check(&self, bodies: &Bodies<'_, D>) -> Result<(), BuildError> {
        let (body, bonds) = (&bodies.body, self.interaction.as_ref());
        let bonded = bodies.parts.iter().any(|p| p.bonded);
        if self.cut > 0 && self.directed <= self.cut && precracks::left(body, bonds) == 0 {
            let message = format!(
                "the pre-crack cuts all bonds: none of the {} between {} points is left",
                self.cut / 2,
                body.all_points()
            );
            return Err(BuildError::empty("precracks[0]", message).help(
                "make it shorter than the body, or the spacing smaller; parts that nothing holds together are bodies of their own",
            ));
        }
        let points = body.all_points();
        if self.directed == 0 && points > 1 && bonded && points > body.pieces().len() {
            return Err(BuildError::empty(
                "horizon",
                message![
                    format!("no two of the {points} points are within the horizon "),
                    Dimension::LENGTH.of(bodies.horizon),
                ],
            )
            .help(message![
                "the spacing is ",
                Dimension::LENGTH.of(body.spacing()),
                ": a horizon of three spacings is usual; points that only touch are a body with bonded = false",
            ]));
        }
        Ok(())
    }
}

/// Cuts the bonds that pre-cracks cross, directed, and says where bodies are in pieces or bridged.
fn cut<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
    interaction: &mut dyn Interaction<D>,
    warnings: &mut Warnings,
) -> Result<u64, BuildError> {
    let solid = spec.potential().is_none() && spec.micromoduli().is_none();
    let separate = match solid {
        true => gaps::across(spec, body, interaction),
        false => vec![],
    };
    let solid = solid && separate.is_empty();
    warnings.extend(separate);
    let cut = precracks::cut(spec, body, interaction, warnings)?;
    if solid {
        warnings.extend(gaps::bridged(body, interaction));
    }
    Ok(cut)
}
