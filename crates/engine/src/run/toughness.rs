//! Toughness of places and times: before every test each point is told what it resistance.

use super::agreed::agreed;
use super::system::System;
use crate::boundary_condition::toughness::{Resistance, SpatialToughness};
use crate::error::{BuildError, RunError};
use crate::message;
use crate::quantity::place;
use crate::spec::{Quantity, Spec, ToughnessFactor};

/// What has no toughness of places.
fn refused(spec: &Spec) -> Result<(), BuildError> {
    if spec.materials.iter().all(|m| m.fracture.is_none()) {
        let message = "no material of this body breaks";
        return Err(BuildError::unsupported("toughness[0]", message)
            .help("give a material a fracture, or leave toughness out"));
    }
    for (n, t) in spec.damage.toughness.iter().enumerate() {
        if let ToughnessFactor::Temperature(rows) = &t.factor {
            let rises = rows.windows(2).all(|r| r[0][0] < r[1][0]);
            if rows.is_empty() || !rises || !rows.iter().all(|r| r[1] > 0.0 && r[1].is_finite()) {
                return Err(BuildError::invalid(
                    format!("toughness[{n}]"),
                    "factors of temperatures are rows [T, factor] with T rising and factors above 0",
                ));
            }
            if !spec
                .interactions
                .diffusions
                .iter()
                .any(|t| t.quantity == Quantity::Heat)
            {
                return Err(BuildError::unsupported(
                    format!("toughness[{n}]"),
                    "this body has no temperature",
                )
                .help("add [heat], or write the factor as an expression of x, y, z, t"));
            }
        }
    }
    Ok(())
}

impl<const D: usize> System<D> {
    /// Of a spec, and of horizons of points; `None`: it is that of the materials, always.
    ///
    /// # Errors
    /// What has no such toughness, and factors that are not positive at the start.
    pub(super) fn toughness_of(
        &self,
        spec: &Spec,
        sets: &[(String, Vec<u32>)],
    ) -> Result<Option<SpatialToughness>, BuildError> {
        match spec.damage.toughness.is_empty() {
            true if self.constitutive.all().all(|m| m.strength.is_empty()) => return Ok(None),
            true => {}
            false => refused(spec)?,
        }
        let mut base = vec![(Resistance::Stretch, f64::INFINITY); self.body.len()];
        for &s in self.body.slots() {
            let s = s as usize;
            base[s] = self.constitutive.resistance(s, self.body.material_of(s));
        }
        let works = |s: &u32| base[*s as usize].0 == Resistance::Work;
        if self.body.slots().iter().all(works) {
            // slots without a point are as all others: no column of stretches
            base.iter_mut().for_each(|b| b.0 = Resistance::Work);
        }
        let mut factors = vec![];
        for (n, t) in spec.damage.toughness.iter().enumerate() {
            let (slots, _) = { self.body.slots_of(&t.set, sets) }
                .map_err(|e| e.at(format!("toughness[{n}].set")))?;
            factors.push((slots, t.factor.clone()));
        }
        let mut field = SpatialToughness::new(base, factors);
        let heat = self.temperatures(field.feels_heat());
        let at = |s: usize| heat.get(s).copied().unwrap_or(0.0);
        let fits = field.set(&self.body, 0.0, at).map_err(|unfit| {
            let message = message![
                format!("the factor is {} at ", unfit.value),
                place(&self.body.position(unfit.slot)[..D]),
                ", expected a positive number",
            ];
            BuildError::invalid(format!("toughness[{}]", unfit.number), message)
                .help("no_failure = true spares a set")
        });
        agreed(&self.body, fits)?;
        Ok(Some(field))
    }

    /// What points bear at a time, of which they are told before the next forces.
    pub(super) fn update_toughness(&mut self, t: f64) -> Result<(), RunError> {
        let feels = self
            .toughness
            .as_ref()
            .is_some_and(SpatialToughness::feels_heat);
        let heat = self.temperatures(feels);
        let Some(field) = self.toughness.as_mut().filter(|f| f.changes()) else {
            return Ok(());
        };
        let at = |s: usize| heat.get(s).copied().unwrap_or(0.0);
        let unfit = field.set(&self.body, t, at).err().map(|unfit| {
            let [x, y, z] = self.body.position(unfit.slot);
            [x, y, z, unfit.value]
        });
        // what one rank finds all know
        let all = self.body.all_of(unfit.as_slice()).concat();
        match all.first() {
            None => Ok(()),
            Some([x, y, z, value]) => Err(RunError::Toughness {
                step: self.clock.step() + 1,
                position: [*x, *y, *z],
                value: *value,
            }),
        }
    }

    /// The temperature of every slot of now; none where nobody asks.
    fn temperatures(&self, asked: bool) -> Vec<f64> {
        let mut all = vec![0.0; if asked { self.body.len() } else { 0 }];
        if let (true, Some(values)) = (asked, self.transferred(Quantity::Heat.column())) {
            for (&s, value) in self.body.slots().iter().zip(values) {
                all[s as usize] = value;
            }
        }
        all
    }

    /// Tell points what they bear, before bonds are tested: laws answer every test with what their materials bear. At the start of a run nothing
    /// breaks yet.
    pub(super) fn tell_toughness(&mut self) {
        let Some(field) = &self.toughness else {
            return;
        };
        for resistance in [Resistance::Stretch, Resistance::Work] {
            let (column, at_once) = resistance.column();
            if let Some(values) = field.values(resistance)
                && (at_once || self.accounts.initial.is_some())
            {
                self.interaction.write_column(&self.body, column, &values);
            }
        }
    }
}
