//! Healing: broken bonds that become whole again, in motion.
//!
//! A bond heals with the length that it had in the reference (longer by what temperature or swelling gives it), where both its ends may heal and the size of its
//! stretch is below the limit of the time; bonds of absent cracks were never there and do not. It is new: without memory, work and wear. What it
//! holds then comes from what healing is driven by, not from the body: it is taken from the energy released.

pub(super) mod state;

use super::system::System;
use crate::body::view;
use crate::error::BuildError;
use crate::interaction::history;
use crate::message;
use crate::spec::{HealingSpec, Spec};
use state::Healing;
use std::cell::Cell;

/// What does not heal.
fn refused(spec: &Spec, healing: &HealingSpec) -> Result<(), BuildError> {
    let unsupported =
        |message: &str, help: &str| Err(BuildError::unsupported("healing", message).help(help));
    let materials = spec.materials.iter().map(|m| m.fracture);
    let interfaces = spec.interactions.interfaces.iter().map(|i| i.fracture);
    if materials.chain(interfaces).all(|f| f.is_none()) && spec.damage.precracks.is_empty() {
        return unsupported(
            "nothing of this body breaks",
            "give a material a fracture, or leave healing out",
        );
    }
    if healing.below.depends_on_position() {
        return unsupported(
            "the stretch below which bonds heal depends on the place, expected an expression of t",
            "name a set",
        );
    }
    let first = healing.below.eval(&[0.0; 3], 0.0);
    if !first.is_finite() {
        let message = format!("bonds heal below a stretch of {first}, expected a number");
        return Err(BuildError::invalid("healing", message).help("1e-3 is usual"));
    }
    Ok(())
}

impl<const D: usize> System<D> {
    /// Of a spec; `None`: what is broken stays so.
    pub(super) fn healing_of(
        &mut self,
        spec: &Spec,
        sets: &[(String, Vec<u32>)],
    ) -> Result<Option<Healing>, BuildError> {
        let Some(healing) = &spec.damage.healing else {
            return Ok(None);
        };
        refused(spec, healing)?;
        if self
            .interaction
            .mend(&self.body, view(&self.u), &|_, _, _| false)
            .is_none()
        {
            let message = "bonds of this body break by what their points remember (plastic strain, damage of a law), and what heals would break at once; or they are those of several potentials, or of atoms that nodes carry, whose ends have no displacements of their own";
            return Err(BuildError::unsupported("healing", message).help(
                "bonds heal that break by their stretch, energy, work, stress, rate or cycles",
            ));
        }
        let mut may = vec![0; self.body.len()];
        match sets.iter().find(|(name, _)| *name == healing.set) {
            Some((_, ids)) => {
                for id in ids {
                    may[self.body.slots()[*id as usize] as usize] = 1;
                }
                self.body.exchange().fill(&mut may);
            }
            None if healing.set == "all" => may.fill(1),
            None => {
                return Err(BuildError::invalid(
                    "healing",
                    message![format!("there is no set {}", healing.set)],
                ));
            }
        }
        Ok(Some(Healing {
            below: healing.below.clone(),
            may,
        }))
    }

    /// Bonds heal at the displacements of now, before the forces there. Did any?
    pub(super) fn heal(&mut self, t: f64) -> bool {
        let Some(healing) = &self.healing else {
            return false;
        };
        let below = healing.below.eval(&[0.0; 3], t);
        if !(below > 0.0) {
            return false;
        }
        self.refresh_images();
        let Some(healing) = &self.healing else {
            return false;
        };
        let heals = |i: usize, j: usize, e: f64| {
            history::stretch(e).abs() < below && [i, j].iter().all(|s| healing.may[*s] == 1)
        };
        let (body, u) = (&self.body, &self.u);
        // bonds of absent cracks do not heal, however near their ends are: who may is asked of those that do
        let any = Cell::new(false);
        let look = |i: usize, j: usize, e: f64| {
            any.set(any.get() || heals(i, j, e));
            false
        };
        self.interaction.mend(body, view(u), &look);
        if !body.exchange().any(any.get()) {
            return false;
        }
        let [before, _] = self.interaction.energy(body, view(u));
        self.interaction.mend(body, view(u), &heals);
        let [after, _] = self.interaction.energy(body, view(u));
        self.accounts.released.lost -= after - before;
        // they conduct again
        self.break_diffusions();
        true
    }
}
