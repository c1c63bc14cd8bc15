//! What spreads through the bonds of a model: driven step by step beside the motion.

mod contact;
mod expansion;
pub(super) mod make;
pub(super) mod state;
mod warmth;

pub use state::TransferInfo;

use super::system::System;
use crate::columns::{Declaration, Dimension, Shape};
use crate::error::RunError;
use crate::spec::Quantity;
use crate::transfer::{Transfer, TransferAccount};
use state::Transfers;

/// What its column is.
fn declaration(quantity: Quantity) -> Declaration {
    match quantity {
        Quantity::Heat => Declaration::of_points(
            quantity.column(),
            Shape::Scalar,
            Dimension::TEMPERATURE,
            "Temperature T that the bonds conduct: ρ c V_i dT_i/dt = Σ_j g_ij (T_j − T_i) + P_i (Bobaru & Duangpanya 2010).",
        ),
        Quantity::Species => Declaration::of_points(
            quantity.column(),
            Shape::Scalar,
            Dimension::CONCENTRATION,
            "Concentration of the species that the bonds conduct: V_i dc_i/dt = Σ_j g_ij (c_j − c_i) + P_i.",
        ),
    }
}

impl<const D: usize> System<D> {
    /// Values and accounts at the start of a run.
    pub(super) fn start_transfers(&mut self) {
        let t = self.clock.time();
        self.break_transfers();
        let Transfers { all, places, .. } = &mut self.transfers;
        { all.iter_mut() }.for_each(|transfer| transfer.start(&self.body, places, t));
        self.expand();
        self.warm();
    }

    /// The bonds that are whole now conduct, where others broke or healed since.
    pub(super) fn break_transfers(&mut self) {
        self.transfers.seen = self.accounts.swept.broken;
        if self.transfers.all.is_empty() {
            return;
        }
        let Transfers { all, places, .. } = &mut self.transfers;
        for t in all.iter_mut().filter(|t| !t.across_broken) {
            t.rows
                .conduct(&self.body, self.interaction.as_ref(), places);
        }
    }

    /// What spreads in the step that begins at `t`.
    ///
    /// # Errors
    /// Equations were not solved; all is as before.
    pub(super) fn spread(&mut self, t: f64, dt: f64) -> Result<(), RunError> {
        self.spread_after(t, dt, None)
    }

    /// The same of a step whose points have moved already, since `−V tr σ` was this.
    pub(super) fn spread_after(
        &mut self,
        t: f64,
        dt: f64,
        pressed: Option<Vec<f64>>,
    ) -> Result<(), RunError> {
        self.transfers.all.iter_mut().for_each(Transfer::keep);
        self.heat_by_deformation(pressed);
        let broke = self.transfers.seen != self.accounts.swept.broken;
        if !self.transfers.all.is_empty() && self.body.exchange().any(broke) {
            self.break_transfers();
        }
        self.conduct_contact();
        for n in 0..self.transfers.all.len() {
            let Transfers { all, places, .. } = &mut self.transfers;
            if let Err(error) = all[n].advance(&self.body, places, t, dt) {
                self.transfers.all.iter_mut().for_each(Transfer::retreat);
                return Err(RunError::Transfer {
                    step: self.clock.step() + 1,
                    quantity: self.transfers.all[n].quantity.name(),
                    error,
                });
            }
        }
        self.expand();
        self.warm();
        self.transfers.price = 0.0;
        Ok(())
    }

    /// Back to before the last step.
    pub(super) fn retreat_transfers(&mut self) {
        self.transfers.all.iter_mut().for_each(Transfer::retreat);
        self.contract();
        self.warm();
        self.accounts.past.conditions -= std::mem::take(&mut self.transfers.price);
    }

    pub(super) fn transfer_columns(&self) -> Vec<Declaration> {
        let each = self.transfers.all.iter();
        each.map(|t| declaration(t.quantity)).collect()
    }

    /// Values of a column, by point id.
    pub(super) fn transferred(&self, name: &str) -> Option<Vec<f64>> {
        let found = self
            .transfers
            .all
            .iter()
            .find(|t| t.quantity.column() == name)?;
        let places = &self.transfers.places;
        Some(self.body.by_id(|i| found.values()[places.at(i)]))
    }

    /// Sets a column by point id; false: there is no such, or the number of values is another.
    pub(super) fn set_transferred(&mut self, name: &str, values: &[f64]) -> bool {
        let Transfers { all, places, .. } = &mut self.transfers;
        let Some(found) = all.iter_mut().find(|t| t.quantity.column() == name) else {
            return false;
        };
        if values.len() != self.body.points() {
            return false;
        }
        let mut placed = vec![0.0; values.len()];
        for (value, s) in values.iter().zip(self.body.slots()) {
            placed[places.at(*s as usize)] = *value;
        }
        found.set_values(&self.body, places, &placed);
        // bonds have other lengths now, laws other temperatures
        self.expand();
        self.warm();
        true
    }

    pub(super) fn transfer_accounts(&self) -> Vec<(Quantity, TransferAccount)> {
        let each = self.transfers.all.iter();
        each.map(|t| (t.quantity, t.account(&self.body))).collect()
    }
}
