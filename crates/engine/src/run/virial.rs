//! The virial, pair by pair: what a pressure is made of. Slow and plain; no sweep knows of it.

use super::system::System;
use crate::body::view;
use crate::interaction::add_virial;

/// Axes of the components of a virial.
const AXES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Adds a pair whose force density on either end is `pull` times the partner's volume along `y`.
fn add<const D: usize>(virial: &mut [f64; 6], y: &[f64; D], pull: f64, volumes: [f64; 2]) {
    for (sum, (m, n)) in virial.iter_mut().zip(AXES) {
        if n < D {
            *sum -= y[m] * y[n] * pull * volumes[0] * volumes[1];
        }
    }
}

impl<const D: usize> System<D> {
    /// Of bonds and of repulsion inside families; images of `u` must be fresh. Not a number where the law has no forces of
    /// single bonds.
    pub(super) fn virial_of_bonds(&mut self) -> [f64; 6] {
        let virial = self.interaction.virial(&self.body, view(&self.u));
        virial.unwrap_or([f64::NAN; 6])
    }

    /// Half of the virial of its pairs for each slot, of bonds and of repulsion inside families; as
    /// [`System::virial_of_bonds`].
    pub(super) fn virials_of_bonds(&mut self) -> Vec<[f64; 6]> {
        let (body, mut points) = (&self.body, vec![[0.0; 6]; self.body.len()]);
        let known = self
            .interaction
            .each_force(body, view(&self.u), &mut |bond| {
                let factor = -0.5 * body.volume().at(bond.i);
                add_virial(&mut points[bond.i], &bond.force, &bond.y, factor);
            });
        if !known {
            points.fill([f64::NAN; 6]);
        }
        points
    }

    /// Adds those of repulsion between points that are in no common family.
    pub(super) fn add_virials_of_contact(&self, points: &mut [[f64; 6]]) {
        let Some(contact) = &self.contact else {
            return;
        };
        contact.central.each_pull(&self.u, |touch| {
            let volumes = [touch.i, touch.j].map(|s| self.body.volume().at(s));
            add(&mut points[touch.i], &touch.y, 0.5 * touch.pull, volumes);
            add(&mut points[touch.j], &touch.y, 0.5 * touch.pull, volumes);
        });
    }

    /// Adds repulsion between points that are in no common family, at the `u` of the contact's last update.
    pub(super) fn add_virial_of_contact(&self, virial: &mut [f64; 6]) {
        let Some(contact) = &self.contact else {
            return;
        };
        contact.central.each_pull(&self.u, |touch| {
            let volumes = [touch.i, touch.j].map(|s| self.body.volume().at(s));
            add(virial, &touch.y, touch.pull, volumes);
        });
    }

    /// At the current state, with the bonds that are whole now.
    pub(super) fn virial_now(&mut self) -> [f64; 6] {
        self.refresh_images();
        if let Some(pairs) = &mut self.contact {
            pairs.find(&self.body, &self.u, self.interaction.as_ref());
        }
        let mut virial = self.virial_of_bonds();
        self.add_virial_of_contact(&mut virial);
        virial
    }

    /// The same for each slot.
    pub(super) fn virials_now(&mut self) -> Vec<[f64; 6]> {
        self.refresh_images();
        if let Some(pairs) = &mut self.contact {
            pairs.find(&self.body, &self.u, self.interaction.as_ref());
        }
        let mut points = self.virials_of_bonds();
        self.add_virials_of_contact(&mut points);
        points
    }
}
