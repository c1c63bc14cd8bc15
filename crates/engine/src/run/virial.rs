//! The virial, pair by pair: what a pressure is made of. Slow and plain; no sweep knows of it.

use super::constitutive::Laws;
use super::model::Model;
use crate::interaction::{BondState, PointEnergies};
use crate::law::BondFactors;
use crate::law::Law;
use crate::law::solid::bond_based::BondBasedMixed;
use crate::law::solid::eam_like::EamLike;

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

impl<const D: usize> Model<D> {
    /// Of bonds and of repulsion inside families; images of `u` must be fresh.
    pub(super) fn virial_of_bonds(&mut self) -> [f64; 6] {
        if let Some(virial) = self.interaction.virial(&self.body, &self.u) {
            return virial;
        }
        let mut virial = [0.0; 6];
        self.each_pull(&mut |_, y, pull, volumes| add(&mut virial, y, pull, volumes));
        virial
    }

    /// Every bond whose ends pull or push each other: slots, the way between them now, and `pull`, which times the
    /// partner's volume and that way is the force density on an end; images of `u` must be fresh.
    fn each_pull(&self, visit: &mut dyn FnMut([usize; 2], &[f64; D], f64, [f64; 2])) {
        let constitutive = &self.constitutive;
        let mut dilatation = vec![];
        if constitutive.all().any(|r| matches!(r.laws, Laws::Solid(_))) {
            let mut seen = PointEnergies::default();
            self.interaction.observe(&self.body, &self.u, &mut seen);
            dilatation = seen.dilatation;
        }
        // among those of its body
        let material = |slot: usize, first: usize| match self.body.pieces() {
            [] => self.body.material_of(slot),
            pieces => pieces[self.body.piece_of(slot)]
                .body
                .material_of(slot - first),
        };
        let fields = |i: usize| -> [f64; 2] {
            let (model, first) = constitutive.at(i);
            let material = material(i, first);
            match &model.laws {
                Laws::Bond(c) => [c[material], 0.0],
                Laws::Springs(_) | Laws::Atoms(_) | Laws::Micromoduli(_) => [0.0; 2],
                Laws::Solid(s) => {
                    let (s, b) = (&s[material], self.interaction.point_field(1, i));
                    // P = n κ θ / m
                    [s.n * s.kappa / s.beta * b * dilatation[i], b]
                }
            }
        };
        // a state-based bond pulls at rest, too
        let at_rest_free = constitutive.all().all(|model| {
            matches!(model.laws, Laws::Bond(_))
                && model.repulsion.as_ref().is_none_or(|c| c.bonded <= 1.0)
        });
        self.interaction
            .each_bond(&self.body, &mut |i, j, xi, state| {
                let eta: [f64; D] = std::array::from_fn(|a| self.u[a][j] - self.u[a][i]);
                let y: [f64; D] = std::array::from_fn(|a| xi[a] + eta[a]);
                if at_rest_free && eta == [0.0; D] {
                    return;
                }
                let (model, first) = constitutive.at(i);
                let squared: f64 = xi.iter().map(|x| x * x).sum();
                let r0 = squared.sqrt();
                let change: f64 = (0..D).map(|a| eta[a] * (xi[a] + 0.5 * eta[a])).sum();
                let e = 2.0 * change / squared;
                // (r − r0)/r without cancellation
                let w = (1.0 + e).sqrt();
                let volumes = [i, j].map(|s| self.body.volume.at(s));
                let mut pull = 0.0;
                if state == BondState::Whole {
                    let (g, weight) = (e / (w * (1.0 + w)), model.weight(r0));
                    let (fi, fj) = (fields(i), fields(j));
                    let reached = self.interaction.reached(&self.body, i, xi);
                    let (volume, factors) = reached.unwrap_or((volumes[1], BondFactors::ONE));
                    pull = match &model.laws {
                        Laws::Bond(_) => {
                            let law = BondBasedMixed { rule: model.rule };
                            let k = law.constant(r0, r0.recip(), weight);
                            law.scaled_pull(k, g, fi, fj, factors)
                        }
                        Laws::Springs(_) | Laws::Atoms(_) | Laws::Micromoduli(_) => 0.0,
                        Laws::Solid(_) => {
                            EamLike { ratio: 0.0 }.scaled_pull(weight, g, fi, fj, factors)
                        }
                    };
                    pull *= volume / volumes[1];
                }
                if let Some(repulsion) = &model.repulsion {
                    let materials = [i, j].map(|s| material(s, first));
                    let (r, d) = (r0 * w, repulsion.distance(r0, materials));
                    if r < d {
                        pull += repulsion.of(materials) * (r - d) / r;
                    }
                }
                visit([i, j], &y, pull, volumes);
            });
    }

    /// Half of the virial of its pairs for each slot, of bonds and of repulsion inside families.
    pub(super) fn virials_of_bonds(&mut self) -> Vec<[f64; 6]> {
        let mut points = vec![[0.0; 6]; self.body.len];
        let original = self.body.originals();
        self.each_pull(&mut |ends, y, pull, volumes| {
            for i in ends {
                add(&mut points[original(i)], y, 0.5 * pull, volumes);
            }
        });
        points
    }

    /// Adds those of repulsion between points that are in no common family.
    pub(super) fn add_virials_of_contact(&self, points: &mut [[f64; 6]]) {
        let Some(contact) = &self.contact else {
            return;
        };
        contact.each_contact(&self.u, |touch| {
            if let Some(pull) = touch.pull() {
                let volumes = [touch.i, touch.j].map(|s| self.body.volume.at(s));
                add(&mut points[touch.i], &touch.y, 0.5 * pull, volumes);
                add(&mut points[touch.j], &touch.y, 0.5 * pull, volumes);
            }
        });
    }

    /// Adds repulsion between points that are in no common family, at the `u` of the contact's last update.
    pub(super) fn add_virial_of_contact(&self, virial: &mut [f64; 6]) {
        let Some(contact) = &self.contact else {
            return;
        };
        contact.each_contact(&self.u, |touch| {
            if let Some(pull) = touch.pull() {
                let volumes = [touch.i, touch.j].map(|s| self.body.volume.at(s));
                add(virial, &touch.y, pull, volumes);
            }
        });
    }

    /// At the current state, with the bonds that are whole now.
    pub(super) fn virial_now(&mut self) -> [f64; 6] {
        self.refresh_images();
        if let Some(pairs) = &mut self.contact {
            let (body, interaction) = (&self.body, &self.interaction);
            pairs.update(body, &self.u, &|i, j| interaction.in_family(body, i, j));
        }
        let mut virial = self.virial_of_bonds();
        self.add_virial_of_contact(&mut virial);
        virial
    }
}
