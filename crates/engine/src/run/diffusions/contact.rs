//! Heat through contact: who touches whom in every step, and where that is not known.

use super::make::Maker;
use crate::diffusion::{Met, Touching};
use crate::error::BuildError;
use crate::run::system::System;
use crate::space::lattice::LatticeKind;
use crate::spec::{BodySpec, Quantity, Spec};

/// Where faces are not those of cubic cells.
const ROUGH: &str = "contact.conductance: the face of a point is taken as its volume over the spacing, which is that of chain, square and cubic lattices; faces of this body may be a third larger or smaller, and so is what they conduct: multiply the conductance by the true area of the faces over that";

/// Are all points in the middle of cubic cells?
fn is_cubic(body: &BodySpec) -> bool {
    match body {
        BodySpec::Lattice { kind, .. } | BodySpec::Sites { kind, .. } => matches!(
            kind,
            LatticeKind::Chain | LatticeKind::Square | LatticeKind::Cubic
        ),
        BodySpec::Cloud(_) => false,
        BodySpec::Several(pieces) => pieces.iter().all(|p| is_cubic(&p.body)),
    }
}

impl<const D: usize> Maker<'_, D> {
    /// Takes the contact conductance of a spec whose transfers are made.
    pub(super) fn make_contact(&mut self, spec: &Spec) -> Result<(), BuildError> {
        let system = &mut *self.system;
        const PATH: &str = "contact.conductance";
        let Some(h) = spec
            .interactions
            .contact
            .as_ref()
            .and_then(|c| c.conductance)
        else {
            return Ok(());
        };
        if !(h > 0.0 && h.is_finite()) {
            let message = format!("the contact conductance is {h}, expected a positive number");
            return Err(BuildError::invalid(PATH, message).help("leave it out for none"));
        }
        let each = &mut system.diffusions.all;
        let Some(heat) = each.iter_mut().find(|t| t.quantity == Quantity::Heat) else {
            let message = "contact conducts heat, and there is no heat";
            return Err(BuildError::conflict(PATH, message)
                .help("add [heat] and the heat of every material, or leave conductance out"));
        };
        let mut faces = vec![0.0; system.body.points()];
        for &s in system.body.slots() {
            faces[system.diffusions.places.at(s as usize)] = system.body.face_at(s as usize);
        }
        heat.with_contact(Touching::new(h, faces));
        if !is_cubic(&spec.body) {
            system.info.warnings.push(ROUGH);
        }
        system.conduct_contact();
        let told = system
            .info
            .diffusions
            .iter_mut()
            .zip(&system.diffusions.all);
        told.for_each(|(info, t)| info.stable_step = t.stable_step(&system.body, 0.0));
        Ok(())
    }
}

impl<const D: usize> System<D> {
    /// Who touches whom now, and what they conduct.
    pub(super) fn conduct_contact(&mut self) {
        let touching = self
            .diffusions
            .all
            .iter_mut()
            .find_map(|t| t.touching.as_mut());
        let Some(touching) = touching else { return };
        touching.clear();
        let Some(contact) = &mut self.contact else {
            // statics before motion that knows no contact
            return touching.share();
        };
        let places = &self.diffusions.places;
        if self.regime.implicit || self.regime.equilibrium {
            // trials went anywhere
            contact.central.invalidate_neighbours();
        }
        let body = &self.body;
        contact.find(body, &self.u, self.interaction.as_ref());
        if !body.exchange().is_shared() {
            contact.central.each_near(&self.u, |ends, weight| {
                let bodies = ends.map(|s| body.piece_of(s) as u32);
                touching.add(ends.map(|s| places.at(s) as u32), bodies, weight);
            });
            return touching.share();
        }
        let mut met = vec![];
        contact.central.each_near(&self.u, |ends, weight| {
            // of two ranks one counts a pair across their border
            if ends[0] < body.len() {
                let named = ends.map(|n| contact.central.named(body, n));
                met.push(Met {
                    order: named.map(|n| n.order),
                    ids: named.map(|n| n.id),
                    bodies: named.map(|n| n.piece),
                    weight,
                });
            }
        });
        touching.share_among(body, places, &met);
    }
}
