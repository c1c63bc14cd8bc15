//! Toughness of places and times: before every test each point is told what it bears.

use super::constitutive::Shelf;
use super::model::Model;
use crate::condition::toughness::ToughnessField;
use crate::error::{BuildError, RunError};
use crate::interaction::history;
use crate::message;
use crate::quantity::place;
use crate::spec::{LawSpec, Spec};

/// What has no toughness of places.
fn refused(spec: &Spec, shelf: &Shelf) -> Result<(), BuildError> {
    let unsupported = |path: &str, message: &str| Err(BuildError::unsupported(path, message));
    if spec.materials.iter().all(|m| m.fracture.is_none()) {
        let message = "no material of this body breaks";
        return Err(BuildError::unsupported("toughness[0]", message)
            .help("give a material a fracture, or leave toughness out"));
    }
    if !spec.pairs.is_empty() {
        let message = "critical stretches of pairs of materials have no factors of points";
        return unsupported("toughness[0]", message);
    }
    for (n, m) in spec.materials.iter().enumerate() {
        if m.fracture.is_some_and(|f| f.alpha != 0.0) {
            return unsupported(
                &format!("materials[{n}].fracture"),
                "strengthening under compression (alpha) and a toughness of places do not go together",
            );
        }
        if let LawSpec::Named(law) = &m.law
            && shelf.ends(&law.name)
        {
            let message = format!(
                "the law {} has its critical stretch among its constants: it cannot depend on the place",
                law.name
            );
            return unsupported("toughness[0]", &message);
        }
    }
    Ok(())
}

impl<const D: usize> Model<D> {
    /// Of a spec; `None`: it is that of the materials, always.
    ///
    /// # Errors
    /// What has no such toughness, and factors that are not positive at the start.
    pub(super) fn toughness_of(
        &self,
        spec: &Spec,
        shelf: &Shelf,
        sets: &[(String, Vec<u32>)],
    ) -> Result<Option<ToughnessField>, BuildError> {
        if spec.toughness.is_empty() {
            return Ok(None);
        }
        refused(spec, shelf)?;
        let mut base = vec![f64::INFINITY; self.body.len];
        for &s in &self.body.slots {
            let of = self
                .info
                .critical_stretch
                .get(self.body.material_of(s as usize));
            base[s as usize] = of.copied().unwrap_or(f64::INFINITY);
        }
        let mut factors = vec![];
        for (n, t) in spec.toughness.iter().enumerate() {
            let (slots, _) =
                { self.slots_of(&t.set, sets) }.map_err(|e| e.at(format!("toughness[{n}].set")))?;
            factors.push((slots, t.factor.clone()));
        }
        let mut field = ToughnessField::new(base, factors);
        field.set(&self.body, 0.0).map_err(|unfit| {
            let message = message![
                format!("the factor is {} at ", unfit.value),
                place(&self.body.position(unfit.slot)[..D]),
                ", expected a positive number",
            ];
            BuildError::invalid(format!("toughness[{}]", unfit.number), message)
                .help("no_failure = true spares a set")
        })?;
        Ok(Some(field))
    }

    /// What points bear at a time, of which they are told before the next forces.
    pub(super) fn update_toughness(&mut self, t: f64) -> Result<(), RunError> {
        let Some(field) = self.toughness.as_mut().filter(|f| f.changes()) else {
            return Ok(());
        };
        field
            .set(&self.body, t)
            .map_err(|unfit| RunError::Toughness {
                step: self.step + 1,
                position: self.body.position(unfit.slot),
                value: unfit.value,
            })
    }

    /// Tell points what they bear, before bonds are tested: laws answer every test with what their materials bear. At the start of a run nothing
    /// breaks yet.
    pub(super) fn tell_toughness(&mut self) {
        if let Some(field) = &self.toughness
            && self.initial_energy.is_some()
        {
            self.interaction
                .write_column(&self.body, history::ELONGATION, field.values());
        }
    }
}
