//! Heat through contact: who touches whom in every step, and where that is not known.

use super::make::face;
use crate::error::BuildError;
use crate::run::model::Model;
use crate::spec::{Quantity, Spec, Stepper, TransferMethod};

impl<const D: usize> Model<D> {
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
        let each = &mut self.transfers.all;
        let Some(heat) = each.iter_mut().find(|t| t.quantity == Quantity::Heat) else {
            let message = "contact conducts heat, and there is no heat";
            return Err(BuildError::conflict(PATH, message)
                .help("add [heat] and the heat of every material, or leave conductance out"));
        };
        match heat.method {
            TransferMethod::Explicit { .. } => {}
            TransferMethod::Implicit { .. } | TransferMethod::Steady { .. } => {
                let message = "contact conducts heat in explicit steps of heat only";
                return Err(BuildError::unsupported(PATH, message)
                    .help("write method = \"explicit\" in [heat], or leave conductance out"));
            }
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
        heat.touching.resize(self.body.points());
        self.transfers.conductance = Some(h);
        Ok(())
    }

    /// Who touches whom now.
    pub(super) fn conduct_contact(&mut self) {
        let (Some(h), Some(contact)) = (self.transfers.conductance, &mut self.contact) else {
            return;
        };
        let (body, interaction) = (&self.body, &self.interaction);
        contact.update(body, &self.u, &|i, j| interaction.in_family(body, i, j));
        let place = &self.transfers.place;
        let mut faces = vec![0.0; body.points()];
        let mut pairs = vec![];
        contact.each_contact(&self.u, |touch| {
            let [a, b] = [touch.i, touch.j].map(|s| place[s]);
            faces[a as usize] = face(body, touch.i);
            faces[b as usize] = face(body, touch.j);
            pairs.push((a, b));
        });
        for t in { self.transfers.all.iter_mut() }.filter(|t| t.quantity == Quantity::Heat) {
            t.touching.set(h, &pairs, |i| faces[i]);
        }
    }
}
