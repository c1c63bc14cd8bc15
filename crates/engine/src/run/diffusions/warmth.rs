//! One temperature: that of a body which conducts heat is the one its law softens by, and what flow makes of it is conducted.
//!
//! A step takes turns: heat spreads, the law flows at the temperatures that this left, `T₁ = T₀ + β Δw_p/(ρ c)`. So each part of the plastic work
//! heats once, and with nothing conducted the step is the adiabatic one of the law alone. Of first order in the step where heat is conducted.

use super::make::Maker;
use super::state::{Diffusions, Warmth};
use crate::constitutive::Softens;
use crate::error::BuildError;
use crate::message;
use crate::quantity::Dimension;
use crate::run::system::System;
use crate::spec::{DiffusionMethod, DiffusionSpec, Quantity, Spec};

/// Heat capacities that differ by this part are the same, written in other units.
const ROUND_OFF: f64 = 1e-9;

impl<const D: usize> Maker<'_, D> {
    /// Laws that know a temperature take that of the body.
    pub(super) fn make_warmth(&mut self, spec: &Spec) -> Result<(), BuildError> {
        let is_heat = |t: &DiffusionSpec| t.quantity == Quantity::Heat;
        let Some(heat) = spec.interactions.diffusions.iter().position(is_heat) else {
            return Ok(());
        };
        let above = vec![0.0; self.system.body.len()];
        if !self.system.interaction.warm(&self.system.body, &above) {
            return Ok(());
        }
        let t = &spec.interactions.diffusions[heat];
        let softens = self.system.constitutive.softens(spec.materials.len());
        for (n, softens) in softens.iter().enumerate() {
            alike(t, n, softens)?;
        }
        let reference = softens.iter().map(|s| s.reference.unwrap_or(t.reference));
        self.system.diffusions.warmth = Some(Warmth {
            heat,
            reference: reference.collect(),
            above,
        });
        self.system.warm();
        Ok(())
    }
}

impl<const D: usize> System<D> {
    /// Laws have the temperatures of now.
    pub(super) fn warm(&mut self) {
        let Some(warmth) = &mut self.diffusions.warmth else {
            return;
        };
        let values = self.diffusions.all[warmth.heat].values();
        for &s in self.body.slots() {
            let i = s as usize;
            let reference = warmth.reference[self.body.material_of(i)];
            warmth.above[i] = values[self.diffusions.places.at(i)] - reference;
        }
        self.interaction.warm(&self.body, &warmth.above);
    }

    /// What flow has warmed in the step that laws have just remembered, the body gets.
    pub(in crate::run) fn take_heat_of_flow(&mut self) {
        let Some(warmth) = &self.diffusions.warmth else {
            return;
        };
        let heat = warmth.heat;
        let mut now = warmth.above.clone();
        self.interaction.read_warmth(&self.body, &mut now);
        let mut by = vec![0.0; self.body.points()];
        for &s in self.body.slots() {
            let i = s as usize;
            by[self.diffusions.places.at(i)] = now[i] - warmth.above[i];
        }
        let Diffusions { all, places, .. } = &mut self.diffusions;
        all[heat].warm((&self.body, places), &by);
        self.warm();
    }
}

/// Has a material of one heat capacity one, and a temperature that flow can change?
fn alike(t: &DiffusionSpec, n: usize, softens: &Softens) -> Result<(), BuildError> {
    let (path, capacity) = (format!("materials[{n}].law"), t.materials[n].capacity);
    let Some(own) = softens.capacity else {
        return Ok(());
    };
    if (own - capacity).abs() > ROUND_OFF * capacity {
        return Err(BuildError::conflict(
            path,
            message![
                "the material has two heat capacities: ",
                Dimension::HEAT_CAPACITY.of(own),
                " of its law, by which plastic work heats, and ",
                Dimension::HEAT_CAPACITY.of(capacity),
                " of its heat, by which heat is conducted",
            ],
        )
        .help("write the same heat_capacity in the law as capacity in heat"));
    }
    if let DiffusionMethod::Steady { .. } = t.method {
        return Err(BuildError::unsupported(
            path,
            "plastic work heats this material, and a temperature that is steady at the end of every step keeps no heat that was made within it",
        )
        .help("write method = \"implicit\" in [heat], or leave heat_capacity out of the law: plastic work does not heat then"));
    }
    if softens.pressed && t.materials[n].expansion != 0.0 {
        return Err(BuildError::unsupported(
            path,
            "the pressure of an equation of state has the heat of plastic work in it (Γ₀E), and a body that expands by the same heat would be pressed by it twice",
        )
        .help("leave expansion out of the material's heat, equation_of_state out of its law, or heat_capacity: plastic work does not heat then"));
    }
    Ok(())
}
