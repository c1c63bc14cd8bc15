//! Contact: repulsion between points that are not in each other's family.
//!
//! A pair of reference distance r0 that is closer than `d = min(bonded r0, range)` repels with the force density
//! `K V_j (r − d)` along its current direction; its energy is `½ K (r − d)² V_i V_j` (Parks et al. 2008 (3.0.6);
//! LAMMPS's observed behaviour: the volumes are not scaled at the horizon). Pairs inside a family repel in the
//! family's own sweep.

use super::Repulsion;
use crate::body::{Body, Field};
use crate::family::neighbours::{Neighbours, periods};

/// A listed pair, in the order of the list.
#[derive(Debug, Clone, Copy)]
struct Pair<const D: usize> {
    /// From i to j in the reference, to the image of j that is near now.
    base: [f64; D],
    /// Distance below which they repel.
    distance: f64,
}

/// Short-range repulsion outside the families.
#[derive(Debug, Clone)]
pub struct Contact<const D: usize> {
    repulsion: Repulsion,
    neighbours: Neighbours<D>,
    pairs: Vec<Pair<D>>,
}

impl<const D: usize> Contact<D> {
    /// Contact in `body`, to the nearest image on periodic axes.
    ///
    /// `horizon` (length) is a promise that `in_family` holds for all pairs closer than that in the reference, broken
    /// or not; it lets the search pass over what has hardly deformed. 0 promises nothing, for families that forget
    /// bonds that a crack made absent.
    pub fn new(repulsion: Repulsion, body: &Body<D>, horizon: f64) -> Self {
        // two points out of a body that holds together come that close only if their displacements differ by the rest
        // of the horizon; half of it as skin leaves the other half to pass over cells that have hardly deformed
        let range = repulsion.range;
        let skin = (0.5 * (horizon - range)).max(0.25 * range).min(0.5 * range);
        // bonds within round-off of the horizon may be in the family or not
        let apart = (horizon * (1.0 - 1e-6) - range - skin).max(0.0);
        Contact {
            repulsion,
            neighbours: Neighbours::new(body, range, skin).apart(apart),
            pairs: vec![],
        }
    }

    /// No point has gone further than `path` (length) since the last call.
    pub fn moved(&mut self, path: f64) {
        self.neighbours.moved(path);
    }

    /// Points may be anywhere now.
    pub fn look_again(&mut self) {
        self.neighbours.look_again();
    }

    /// Add the force density of all pairs for which `in_family` is false to `f`. Finds the pairs anew when points
    /// may have moved too far. The same bits for any number of threads.
    pub fn add_forces(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        f: &mut Field<D>,
        in_family: &dyn Fn(usize, usize) -> bool,
    ) {
        self.update(body, u, in_family);
        let stiffness = self.repulsion.stiffness;
        self.each_contact(u, |i, j, y, r, d| {
            // two points on one spot have no direction
            if r == 0.0 {
                return;
            }
            let pull = stiffness * (r - d) / r;
            let (vi, vj) = (body.volume.at(i), body.volume.at(j));
            for a in 0..D {
                f[a][i] += pull * vj * y[a];
                f[a][j] -= pull * vi * y[a];
            }
        });
    }

    /// Find the pairs anew if points may have moved too far.
    pub fn update(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        in_family: &dyn Fn(usize, usize) -> bool,
    ) {
        if !self.neighbours.update(body, u, &|i, j| !in_family(i, j)) {
            return;
        }
        self.pairs.clear();
        for (i, row) in self.neighbours.rows() {
            let p = body.position(i);
            for &j in row {
                let j = j as usize;
                let q = body.position(j);
                let xi: [f64; D] = std::array::from_fn(|a| q[a] - p[a]);
                let now = std::array::from_fn(|a| xi[a] + (u[a][j] - u[a][i]));
                let (then, now) = (periods(body, &xi), periods(body, &now));
                let square: f64 = (0..D).map(|a| (xi[a] - then[a]).powi(2)).sum();
                self.pairs.push(Pair {
                    base: std::array::from_fn(|a| xi[a] - now[a]),
                    distance: self.repulsion.distance(square.sqrt()),
                });
            }
        }
    }

    /// Energy of all contacts (energy). `u` is that of the last [`Contact::add_forces`] or [`Contact::update`].
    pub fn energy(&self, body: &Body<D>, u: &Field<D>) -> f64 {
        let mut energy = 0.0;
        self.each_contact(u, |i, j, _, r, d| {
            energy += 0.5
                * self.repulsion.stiffness
                * (r - d)
                * (r - d)
                * body.volume.at(i)
                * body.volume.at(j);
        });
        energy
    }

    /// Add the energy density of all contacts to `out`, per slot, half of a pair's at each end (energy / volume).
    /// `u` as for [`Contact::energy`].
    pub fn add_energy_density(&self, body: &Body<D>, u: &Field<D>, out: &mut [f64]) {
        let stiffness = self.repulsion.stiffness;
        self.each_contact(u, |i, j, _, r, d| {
            let quarter = 0.25 * stiffness * (r - d) * (r - d);
            out[i] += quarter * body.volume.at(j);
            out[j] += quarter * body.volume.at(i);
        });
    }

    /// Number of pairs that repel, at the `u` of the last [`Contact::add_forces`] or [`Contact::update`].
    pub fn pairs_in_contact(&self, u: &Field<D>) -> usize {
        let mut count = 0;
        self.each_contact(u, |_, _, _, _, _| count += 1);
        count
    }

    /// How often the pairs were found anew.
    pub fn builds(&self) -> u64 {
        self.neighbours.builds()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.neighbours.bytes() + size_of::<Pair<D>>() * self.pairs.capacity()
    }

    /// Visit the pairs closer than allowed: slots, current vector and distance, allowed distance.
    pub fn each_contact(
        &self,
        u: &Field<D>,
        mut visit: impl FnMut(usize, usize, [f64; D], f64, f64),
    ) {
        let mut pairs = self.pairs.iter();
        for (i, row) in self.neighbours.rows() {
            let ui: [f64; D] = std::array::from_fn(|a| u[a][i]);
            for (&j, pair) in row.iter().zip(&mut pairs) {
                let j = j as usize;
                let y: [f64; D] = std::array::from_fn(|a| pair.base[a] + (u[a][j] - ui[a]));
                let square: f64 = y.iter().map(|c| c * c).sum();
                if square < pair.distance * pair.distance {
                    visit(i, j, y, square.sqrt(), pair.distance);
                }
            }
        }
    }
}

#[cfg(test)]
#[path = "contact_tests.rs"]
mod tests;
