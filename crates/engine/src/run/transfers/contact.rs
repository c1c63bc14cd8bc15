//! Heat through contact: who touches whom in every step, and where that is not known.

use super::make::Maker;
use crate::error::BuildError;
use crate::run::system::System;
use crate::space::lattice::LatticeKind;
use crate::spec::{BodySpec, Quantity, Spec, Stepper, TransferMethod};
use crate::transfer::Touching;

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
        const PATH: &str = "contact.conductance";
        let Some(h) = spec.contact.as_ref().and_then(|c| c.conductance) else {
            return Ok(());
        };
        if !(h > 0.0 && h.is_finite()) {
            let message = format!("the contact conductance is {h}, expected a positive number");
            return Err(BuildError::invalid(PATH, message).help("leave it out for none"));
        }
        let each = &mut self.system.transfers.all;
        let Some(heat) = each.iter_mut().find(|t| t.quantity == Quantity::Heat) else {
            let message = "contact conducts heat, and there is no heat";
            return Err(BuildError::conflict(PATH, message)
                .help("add [heat] and the heat of every material, or leave conductance out"));
        };
        match heat.method {
            TransferMethod::Explicit { .. } | TransferMethod::Implicit { .. } => {}
            TransferMethod::Steady { .. } => {
                let message = "contact comes and goes, and a body that nothing else holds has no steady temperature without it";
                return Err(BuildError::unsupported(PATH, message).help(
                    "write method = \"implicit\" in [heat] with steps as long as you like, or leave conductance out",
                ));
            }
        }
        if !spec.interfaces.is_empty() {
            let message = "bonds between bodies conduct, and contact would conduct beside them";
            return Err(BuildError::unsupported(PATH, message)
                .help("leave conductance out, or take the interfaces away"));
        }
        if let BodySpec::Several(pieces) = &spec.body
            && let Some(loose) = pieces.iter().find(|p| !p.bonded)
        {
            let message = format!(
                "the points of `{}` are loose, and contact does not know which way the faces of such points look",
                loose.name
            );
            return Err(BuildError::unsupported(PATH, message)
                .help("leave conductance out, or bonded = false"));
        }
        let moves = match spec.schedule.stepper {
            Stepper::Verlet | Stepper::Still => true,
            Stepper::Newmark(_) | Stepper::Statics(_) => false,
        };
        if !moves || spec.preload.is_some() {
            let message = "contact conducts heat beside explicit motion or at rest only, not in implicit steps or equilibrium";
            return Err(BuildError::unsupported(PATH, message).help(
                "take [run] with integrator = \"verlet\" or \"still\" and no [statics], or leave conductance out",
            ));
        }
        let mut faces = vec![0.0; self.system.body.points()];
        for &s in &self.system.body.slots {
            faces[self.system.transfers.place[s as usize] as usize] =
                self.system.body.face_at(s as usize);
        }
        heat.with_contact(Touching::new(h, faces));
        if !is_cubic(&spec.body) {
            self.system.info.warnings.push(ROUGH);
        }
        self.system.conduct_contact();
        let told = self
            .system
            .info
            .transfers
            .iter_mut()
            .zip(&self.system.transfers.all);
        told.for_each(|(info, t)| info.stable_step = t.stable_step(0.0));
        Ok(())
    }
}

impl<const D: usize> System<D> {
    /// Who touches whom now, and what they conduct.
    pub(super) fn conduct_contact(&mut self) {
        let touching = self
            .transfers
            .all
            .iter_mut()
            .find_map(|t| t.touching.as_mut());
        let (Some(touching), Some(contact)) = (touching, &mut self.contact) else {
            return;
        };
        let body = &self.body;
        contact.find(body, &self.u, self.interaction.as_ref());
        let place = &self.transfers.place;
        touching.clear();
        contact.central.each_near(&self.u, |ends, weight| {
            let bodies = ends.map(|s| body.piece_of(s) as u32);
            touching.add(ends.map(|s| place[s]), bodies, weight);
        });
        touching.share();
    }
}
