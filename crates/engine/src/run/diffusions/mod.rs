//! What spreads through the bonds of a model: driven step by step beside the motion.

mod contact;
mod expansion;
pub(super) mod make;
pub(super) mod state;
mod warmth;

pub use state::DiffusionInfo;

use super::system::System;
use crate::columns::{Declaration, Dimension, Shape};
use crate::diffusion::{Diffusion, DiffusionAccount};
use crate::error::RunError;
use crate::spec::Quantity;
use state::Diffusions;

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
    pub(super) fn start_diffusions(&mut self) {
        let t = self.clock.time();
        self.break_diffusions();
        let Diffusions { all, places, .. } = &mut self.diffusions;
        { all.iter_mut() }.for_each(|diffusion| diffusion.start(&self.body, places, t));
        self.expand();
        self.warm();
    }

    /// The bonds that are whole now conduct, where others broke or healed since.
    pub(super) fn break_diffusions(&mut self) {
        self.diffusions.seen = self.accounts.swept.broken;
        if self.diffusions.all.is_empty() {
            return;
        }
        let Diffusions { all, places, .. } = &mut self.diffusions;
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
        self.diffusions.all.iter_mut().for_each(Diffusion::keep);
        self.heat_by_deformation(pressed);
        let broke = self.diffusions.seen != self.accounts.swept.broken;
        if !self.diffusions.all.is_empty() && self.body.exchange().any(broke) {
            self.break_diffusions();
        }
        self.conduct_contact();
        for n in 0..self.diffusions.all.len() {
            let Diffusions { all, places, .. } = &mut self.diffusions;
            if let Err(error) = all[n].advance(&self.body, places, t, dt) {
                self.diffusions.all.iter_mut().for_each(Diffusion::retreat);
                return Err(RunError::Diffusion {
                    step: self.clock.step() + 1,
                    quantity: self.diffusions.all[n].quantity.name(),
                    error,
                });
            }
        }
        self.expand();
        self.warm();
        self.diffusions.price = 0.0;
        Ok(())
    }

    /// Back to before the last step.
    pub(super) fn retreat_diffusions(&mut self) {
        self.diffusions.all.iter_mut().for_each(Diffusion::retreat);
        self.contract();
        self.warm();
        self.accounts.past.conditions -= std::mem::take(&mut self.diffusions.price);
    }

    pub(super) fn diffusion_columns(&self) -> Vec<Declaration> {
        let each = self.diffusions.all.iter();
        each.map(|t| declaration(t.quantity)).collect()
    }

    /// Values of a column, by point id.
    pub(super) fn transferred(&self, name: &str) -> Option<Vec<f64>> {
        let found = self
            .diffusions
            .all
            .iter()
            .find(|t| t.quantity.column() == name)?;
        let places = &self.diffusions.places;
        Some(self.body.by_id(|i| found.values()[places.at(i)]))
    }

    /// Sets a column by point id; false: there is no such, or the number of values is another.
    pub(super) fn set_transferred(&mut self, name: &str, values: &[f64]) -> bool {
        let Diffusions { all, places, .. } = &mut self.diffusions;
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

    pub(super) fn diffusion_accounts(&self) -> Vec<(Quantity, DiffusionAccount)> {
        let each = self.diffusions.all.iter();
        each.map(|t| (t.quantity, t.account(&self.body))).collect()
    }
}
