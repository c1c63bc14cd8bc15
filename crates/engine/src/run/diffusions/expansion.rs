//! Bodies that expand, and what that costs and heats.

use super::make::Maker;
use super::state::Diffusions;
use crate::body::view;
use crate::error::BuildError;
use crate::run::system::System;
use crate::spec::Spec;

impl<const D: usize> Maker<'_, D> {
    /// Bodies that expand: can their bonds?
    pub(super) fn make_expansion(&mut self, spec: &Spec) -> Result<(), BuildError> {
        let system = &mut *self.system;
        for (n, t) in spec.interactions.diffusions.iter().enumerate() {
            let strains: Vec<f64> = t.materials.iter().map(|m| m.expansion).collect();
            if strains.iter().any(|x| *x != 0.0) {
                system.diffusions.grown.push((n, t.reference, strains));
            }
        }
        let Some((n, ..)) = system.diffusions.grown.first() else {
            return Ok(());
        };
        let name = spec.interactions.diffusions[*n].quantity.name();
        system.diffusions.strain = vec![0.0; system.body.len()];
        if !system
            .interaction
            .expand(&system.body, &system.diffusions.strain)
        {
            return Err(BuildError::unsupported(
                name,
                "the bonds of this law or body have no thermal expansion: those of pmb, lps and springs have, and laws such as elastic_plastic, viscoelastic, correspondence, softening",
            )
            .help("take one of these, or leave expansion and swelling out"));
        }
        Ok(())
    }

    /// What deformation heats.
    pub(super) fn make_heated(&mut self, spec: &Spec) -> Result<(), BuildError> {
        let system = &mut *self.system;
        let diffusions = &spec.interactions.diffusions;
        let Some(n) = diffusions.iter().position(|t| t.deformation) else {
            return Ok(());
        };
        let mut trace = vec![0.0; system.body.len()];
        let (body, u) = (&system.body, &system.u);
        if D == 2
            && system.expands()
            && !system
                .interaction
                .add_stress_across(body, view(u), &mut trace)
        {
            return Err(BuildError::unsupported(
                diffusions[n].quantity.name(),
                "deformation heats by the change of the whole mean stress, and the stress across plane strain does not follow from that in the plane: this law is anisotropic, or flows bond by bond",
            )
            .help("leave deformation out, or take three dimensions"));
        }
        let strains = diffusions[n].materials.iter().map(|m| m.expansion);
        system.diffusions.heated = Some((n, strains.collect()));
        Ok(())
    }
}

impl<const D: usize> System<D> {
    /// Do bodies expand?
    pub(in crate::run) fn expands(&self) -> bool {
        !self.diffusions.grown.is_empty()
    }

    /// Bonds get the lengths that the values of now give them.
    pub(super) fn expand(&mut self) {
        if !self.expands() {
            return;
        }
        self.diffusions.past.clone_from(&self.diffusions.strain);
        let Diffusions {
            all,
            places,
            grown,
            strain,
            ..
        } = &mut self.diffusions;
        let body = &self.body;
        body.set_points(strain, |i| {
            let of = |(n, reference, strains): &(usize, f64, Vec<f64>)| {
                strains[body.material_of(i)] * (all[*n].values()[places.at(i)] - reference)
            };
            grown.iter().map(of).sum()
        });
        self.interaction.expand(body, strain);
    }

    /// Bonds get back the lengths that they had before the last step.
    pub(super) fn contract(&mut self) {
        if self.expands() {
            self.diffusions.strain.clone_from(&self.diffusions.past);
            self.interaction.expand(&self.body, &self.diffusions.strain);
        }
    }

    /// What the last step's expansion changes of the energy of bonds at displacements a time before those of now, and so much of it:
    /// work of whoever heats. Half at either end of a step, or all in its middle, is of second order in the step.
    pub(in crate::run) fn account_work(&mut self, part: f64, before: f64) {
        if !self.expands() {
            return;
        }
        let mut u = self.u.clone();
        let then = |_, i: usize| crate::array::from_fn(|a| self.u[a][i] - before * self.v[a][i]);
        self.body.set_vectors(&mut u, then);
        let (body, diffusions) = (&self.body, &mut self.diffusions);
        self.interaction.expand(body, &diffusions.past);
        let past = self.interaction.energy(body, view(&u))[0];
        self.interaction.expand(body, &diffusions.strain);
        let price = part * (self.interaction.energy(body, view(&u))[0] - past);
        diffusions.price += price;
        self.accounts.past.conditions += price;
    }

    /// `−V tr σ` of every slot, where deformation heats.
    pub(in crate::run) fn pressed(&mut self) -> Option<Vec<f64>> {
        self.diffusions.heated.as_ref()?;
        self.refresh_images();
        let all = self.virials_of_bonds();
        if D != 2 {
            return Some(all.iter().map(|w| w[0] + w[1] + w[2]).collect());
        }
        let volume = |i: usize| self.body.volume().at(i);
        let per = |(i, w): (usize, &[f64; 6])| match volume(i) > 0.0 {
            true => -(w[0] + w[1]) / volume(i),
            false => 0.0,
        };
        let mut trace: Vec<f64> = all.iter().enumerate().map(per).collect();
        self.interaction
            .add_stress_across(&self.body, view(&self.u), &mut trace);
        let whole = trace.iter().enumerate();
        Some(whole.map(|(i, s)| -volume(i) * s).collect())
    }

    /// Heat of the deformation since `−V tr σ` was this, at the temperatures of now.
    pub(in crate::run) fn heat_by_deformation(&mut self, before: Option<Vec<f64>>) {
        let (Some(before), Some(now)) = (before, self.pressed()) else {
            return;
        };
        let Diffusions {
            all,
            places,
            heated,
            ..
        } = &mut self.diffusions;
        let Some((n, strains)) = heated else { return };
        let mut more = vec![0.0; self.body.points()];
        for &s in self.body.slots() {
            let i = s as usize;
            let strain = strains[self.body.material_of(i)];
            more[places.at(i)] = strain * (now[i] - before[i]);
        }
        all[*n].give((&self.body, places), |i, value| value * more[i]);
    }
}
