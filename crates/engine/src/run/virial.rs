//! The virial, pair by pair: what a pressure is made of. Slow and plain; no sweep knows of it.

use super::system::System;
use crate::body::view;
use crate::execute::exact::Exact;
use crate::interaction::add_virial;

/// Axes of the components of a virial.
const AXES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// What a pair whose force density on either end is `pull` times the partner's volume along `y` has of it.
fn of_pair<const D: usize>(y: &[f64; D], pull: f64, volumes: [f64; 2]) -> [f64; 6] {
    let there = |(m, n): (usize, usize)| if n < D { y[m] * y[n] } else { 0.0 };
    AXES.map(|axes| -there(axes) * pull * volumes[0] * volumes[1])
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
        let body = &self.body;
        contact.central.each_end(body, &self.u, |end| {
            let volumes = [body.volume().at(end.at), end.volume];
            let of_pair = of_pair(&end.y, 0.5 * end.pull, volumes);
            { points[end.at].iter_mut().zip(of_pair) }.for_each(|(sum, of)| *sum += of);
        });
    }

    /// Adds repulsion between points that are in no common family, at the `u` of the contact's last update.
    pub(super) fn add_virial_of_contact(&self, virial: &mut [f64; 6]) {
        let Some(contact) = &self.contact else {
            return;
        };
        let mut sums = [const { Exact::ZERO }; 6];
        contact.central.each_once(&self.body, &self.u, |touch| {
            let of_pair = of_pair(&touch.y, touch.pull, touch.volumes);
            { sums.iter_mut().zip(of_pair) }.for_each(|(sum, of)| sum.add(of));
        });
        let sums = self.body.sums(sums);
        { virial.iter_mut().zip(sums) }.for_each(|(all, of)| *all += of);
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
