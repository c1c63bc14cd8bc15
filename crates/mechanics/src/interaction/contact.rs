//! Contact: repulsion between points that are not in each other's family, and [`Cohesion`] of bodies.
//!
//! A pair repels as its materials do ([`Repulsion`]); its energy is `½ K (r − d)² V_i V_j`, and volumes are not scaled at
//! the horizon. Pairs inside a family repel in the family's own sweep.

use super::cohesion::Cohesion;
use super::nearness::{Bounds, Nearness};
use super::pull::{End, Pull};
use super::{EachTangent, Repulsion};
use crate::body::{Body, Field, view};
use crate::execute::exact::Exact;
use crate::family::neighbours::ghosts::Ghosts;
use crate::family::neighbours::{LOOSE, Neighbours, base, periods};

/// A listed pair, in the order of the list.
#[derive(Debug, Clone, Copy)]
struct Pair<const D: usize> {
    /// From i to j in the reference, to the image of j that is near now.
    base: [f64; D],
    /// Distance below which they repel.
    distance: f64,
    /// K (force / volume² / length).
    stiffness: f64,
}

/// A pair that is closer than allowed.
#[derive(Debug, Clone, Copy)]
pub struct Touch<const D: usize> {
    pub i: usize,
    pub j: usize,
    /// From i to j now, and its length.
    pub y: [f64; D],
    pub r: f64,
    /// Allowed distance.
    pub d: f64,
    /// K (force / volume² / length).
    pub stiffness: f64,
}

impl<const D: usize> Touch<D> {
    fn pull(&self, volumes: [f64; 2]) -> Pull<D> {
        let over = self.r - self.d;
        Pull {
            i: self.i,
            j: self.j,
            volumes,
            y: self.y,
            r: self.r,
            // two points on one spot have no direction
            pull: match self.r > 0.0 {
                true => self.stiffness * over / self.r,
                false => 0.0,
            },
            slope: self.stiffness,
            energy: 0.5 * self.stiffness * over * over,
        }
    }
}

/// Short-range repulsion outside the families.
#[derive(Debug, Clone)]
pub struct Contact<const D: usize> {
    repulsion: Repulsion,
    neighbours: Neighbours<D>,
    ghosts: Ghosts<D>,
    /// Of ghosts: rows of the tables, and volumes.
    kinds_there: Vec<u32>,
    volumes_there: Vec<f64>,
    own_there: Vec<f64>,
    /// `[slots]`: which row of the tables of `repulsion` a point has; empty: that of its material.
    kind: Vec<u16>,
    pairs: Vec<Pair<D>>,
    /// Who touches, where that is asked for.
    near: Option<Nearness>,
    /// Of every pair, where that is asked for.
    bounds: Vec<Bounds>,
    /// What bodies attract each other by.
    cohesion: Option<Cohesion<D>>,
}

/// A point among those of all ranks.
#[derive(Debug, Clone, Copy)]
pub struct Named {
    /// In the order of slots of the whole.
    pub order: u64,
    pub id: u32,
    /// Which of several bodies has it.
    pub piece: u32,
}

impl<const D: usize> Contact<D> {
    /// Contact in `body`, to the nearest image on periodic axes.
    ///
    /// `horizon` (length) is a promise that `in_family` holds for all pairs closer than that in the reference, broken
    /// or not; it lets the search pass over what has hardly deformed. 0 promises nothing, for families that forget
    /// bonds that a crack made absent.
    /// Where there are several bodies, it holds within each of them that is `bonded`; empty: in all.
    pub fn new(repulsion: Repulsion, body: &Body<D>, horizon: f64, bonded: &[bool]) -> Self {
        Contact::with_nearness(repulsion, None, body, horizon, bonded)
    }

    /// The same, and it knows who touches ([`Contact::each_near`]).
    pub fn with_nearness(
        repulsion: Repulsion,
        near: Option<Nearness>,
        body: &Body<D>,
        horizon: f64,
        bonded: &[bool],
    ) -> Self {
        // two points out of a body that holds together come that close only if their displacements differ by the rest
        // of the horizon; half of it as skin leaves the other half to pass over cells that have hardly deformed
        let repels = repulsion.range.highest();
        let touches = { near.as_ref() }.map_or(0.0, |n| n.longest(&repulsion.range));
        let range = repels.max(touches);
        let skin = (0.5 * (horizon - range)).max(0.25 * range).min(0.5 * range);
        // bonds within round-off of the horizon may be in the family or not
        let apart = (horizon * (1.0 - 1e-6) - range - skin).max(0.0);
        Contact {
            repulsion,
            neighbours: Neighbours::new(body, range, skin)
                .apart(apart)
                .groups(groups(body, bonded)),
            ghosts: Ghosts::default(),
            kinds_there: vec![],
            volumes_there: vec![],
            own_there: vec![],
            kind: vec![],
            pairs: vec![],
            near,
            bounds: vec![],
            cohesion: None,
        }
    }

    /// The same, and bodies attract each other.
    pub fn cohesive(mut self, cohesion: Option<Cohesion<D>>) -> Self {
        self.cohesion = cohesion;
        self
    }

    /// `[slots]`: the row of the tables of repulsion that a point has, instead of that of its material.
    pub fn kinds(mut self, kind: Vec<u16>) -> Self {
        self.kind = kind;
        self
    }

    /// No point has gone further than `path` (length) since the last call.
    pub fn moved(&mut self, path: f64) {
        self.neighbours.moved(path);
        if let Some(cohesion) = &mut self.cohesion {
            cohesion.moved(path);
        }
    }

    /// Points may be anywhere now.
    pub fn invalidate_neighbours(&mut self) {
        self.neighbours.invalidate_neighbours();
        if let Some(cohesion) = &mut self.cohesion {
            cohesion.invalidate_neighbours();
        }
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
        self.each_end(body, u, |end| {
            for a in 0..D {
                f[a][end.at] += end.pull * end.volume * end.y[a];
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
        if let Some(cohesion) = &mut self.cohesion {
            cohesion.update(body, u);
        }
        let ghosts = &mut self.ghosts;
        let other = |i, j| !in_family(i, j);
        if self.neighbours.update(body, ghosts, view(u), &other) {
            self.look(body, u);
        }
        self.ghosts.follow(view(u));
    }

    /// At the pairs as they are when they are found.
    fn look(&mut self, body: &Body<D>, u: &Field<D>) {
        self.pairs.clear();
        self.bounds.clear();
        self.kinds_there = self.ghosts.ask(|s| self.kind_of(body, s) as u32);
        self.volumes_there = self.ghosts.ask(|s| body.volume.at(s));
        self.own_there = self.ghosts.ask(|s| self.repulsion.own_at(s));
        for (i, row) in self.neighbours.rows() {
            let (p, ui) = (
                self.ghosts.position(body, i),
                self.ghosts.displacement(u, i),
            );
            for &j in row {
                let j = j as usize;
                let (q, uj) = (
                    self.ghosts.position(body, j),
                    self.ghosts.displacement(u, j),
                );
                let xi: [f64; D] = crate::array::from_fn(|a| q[a] - p[a]);
                let then = periods(body, &xi);
                let square: f64 = (0..D).map(|a| (xi[a] - then[a]).powi(2)).sum();
                let materials = self.materials(body, [i, j]);
                let r0 = square.sqrt();
                let distance = self.repulsion.distance(r0, materials);
                if let Some(near) = &self.near {
                    let same = self.piece_of(body, i) == self.piece_of(body, j);
                    self.bounds.push(near.bounds(materials, same, r0, distance));
                }
                self.pairs.push(Pair {
                    base: base(body, &xi, &crate::array::from_fn(|a| uj[a] - ui[a])),
                    distance,
                    stiffness: self.stiffness(body, materials, [i, j]),
                });
            }
        }
    }

    fn stiffness(&self, body: &Body<D>, materials: [usize; 2], ends: [usize; 2]) -> f64 {
        let own = ends.map(|n| match n.checked_sub(body.len) {
            None => self.repulsion.own_at(n),
            Some(ghost) => self.own_there[ghost],
        });
        self.repulsion.of_both(materials, own)
    }

    /// Rows of the tables of repulsion.
    fn materials(&self, body: &Body<D>, ends: [usize; 2]) -> [usize; 2] {
        ends.map(|n| match n.checked_sub(body.len) {
            None => self.kind_of(body, n),
            Some(ghost) => self.kinds_there[ghost] as usize,
        })
    }

    fn kind_of(&self, body: &Body<D>, slot: usize) -> usize {
        match self.kind.get(slot) {
            Some(kind) => *kind as usize,
            None => body.material_of(slot),
        }
    }

    /// What two points resist with once they repel (force / length); `None`: others come in between before they do, as they are this far apart in
    /// the reference.
    pub fn first_stiffness(&self, body: &Body<D>, ends: [usize; 2], r0: f64) -> Option<f64> {
        let materials @ [a, b] = self.materials(body, ends);
        let first = self.repulsion.bonded * r0 <= self.repulsion.range.at(a, b);
        let [vi, vj] = ends.map(|s| body.volume.at(s));
        first.then(|| self.repulsion.between(materials, ends) * vi * vj)
    }

    /// The touch of two points of one family, ξ apart in the reference; `None`: they do not repel.
    pub fn touch_inside(
        &self,
        body: &Body<D>,
        u: &Field<D>,
        [i, j]: [usize; 2],
        xi: [f64; D],
    ) -> Option<Touch<D>> {
        let length = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>().sqrt();
        let y: [f64; D] = crate::array::from_fn(|a| xi[a] + (u[a][j] - u[a][i]));
        let materials = self.materials(body, [i, j]);
        let (r, d) = (length(&y), self.repulsion.distance(length(&xi), materials));
        (r < d).then(|| Touch {
            i,
            j,
            y,
            r,
            d,
            stiffness: self.repulsion.between(materials, [i, j]),
        })
    }

    /// Tangents of all contacts, as those of bonds between points that touch, of points that are here. `u` as for [`Contact::energy`].
    pub fn tangents(&self, body: &Body<D>, u: &Field<D>, visit: &mut EachTangent<D>) {
        self.each_pull(body, u, |pull| {
            pull.tangents(&mut |bond| {
                if bond.i < body.len {
                    visit(bond);
                }
            });
        });
    }

    /// Adds what points that touch resist with (force / length) to sums by slot; `u` as for [`Contact::energy`].
    pub fn add_stiffness(&self, body: &Body<D>, u: &Field<D>, sum: &mut [f64]) {
        self.each_pull(body, u, |touch| {
            let [vi, vj] = touch.volumes;
            for s in [touch.i, touch.j].into_iter().filter(|s| *s < body.len) {
                sum[s] += touch.slope.abs().max(touch.pull.abs()) * vi * vj;
            }
        });
    }

    /// Energy of all contacts (energy), of which ranks that share one have it once. `u` is that of the last [`Contact::add_forces`] or [`Contact::update`].
    pub fn energy(&self, body: &Body<D>, u: &Field<D>) -> Exact {
        let mut energy = Exact::ZERO;
        self.each_once(body, u, |pull| {
            let [vi, vj] = pull.volumes;
            energy.add(pull.energy * vi * vj);
        });
        energy
    }

    /// Visit every central force that this rank counts, each of all ranks once.
    pub fn each_once(&self, body: &Body<D>, u: &Field<D>, mut visit: impl FnMut(Pull<D>)) {
        self.each_pull(body, u, |pull| {
            if pull.i < body.len {
                visit(pull);
            }
        });
    }

    /// Add the energy density of all contacts to `out`, per slot, half of a pair's at each end (energy / volume).
    /// `u` as for [`Contact::energy`].
    pub fn add_energy_density(&self, body: &Body<D>, u: &Field<D>, out: &mut [f64]) {
        self.each_end(body, u, |end| out[end.at] += 0.5 * end.energy * end.volume);
    }

    /// Number of pairs that repel, at the `u` of the last [`Contact::add_forces`] or [`Contact::update`].
    pub fn pairs_in_contact(&self, u: &Field<D>) -> usize {
        let mut count = 0;
        self.each_contact(u, |_| count += 1);
        count
    }

    /// Visit the ends of all listed pairs: who may touch before the pairs are found anew.
    pub fn each_listed(&self, mut visit: impl FnMut([usize; 2])) {
        for (i, row) in self.neighbours.rows() {
            row.iter().for_each(|j| visit([i, *j as usize]));
        }
    }

    /// A pair of [`each_contact`](Contact::each_contact) with its ends as they [are called](Body::id_of).
    pub fn called(&self, body: &Body<D>, touch: Touch<D>) -> Touch<D> {
        Touch {
            i: self.called_end(body, touch.i),
            j: self.called_end(body, touch.j),
            ..touch
        }
    }

    /// The same of an end.
    pub fn called_end(&self, body: &Body<D>, n: usize) -> usize {
        self.ghosts.name(body, n)
    }

    /// Who an end of a [near](Contact::each_near) pair is among the points of all ranks.
    pub fn named(&self, body: &Body<D>, n: usize) -> Named {
        let (order, id) = match self.ghosts.of(body, n) {
            None => (body.order(n), body.ids_of_all()[n]),
            Some(ghost) => (ghost.order, ghost.id as u32),
        };
        Named {
            order,
            id,
            piece: self.piece_of(body, n) as u32,
        }
    }

    fn piece_of(&self, body: &Body<D>, n: usize) -> usize {
        match self.ghosts.of(body, n) {
            None => body.piece_of(n),
            Some(ghost) => Body::<D>::piece_of_order(ghost.order),
        }
    }

    /// How often the pairs were found anew.
    pub fn builds(&self) -> u64 {
        self.neighbours.builds()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.neighbours.bytes()
            + self.ghosts.bytes()
            + self.cohesion.as_ref().map_or(0, Cohesion::bytes)
            + size_of::<Pair<D>>() * self.pairs.capacity()
            + size_of::<Bounds>() * self.bounds.capacity()
    }

    /// Visit both ends of every central force, those that are here, a point's in the order of the slots of its partners.
    pub fn each_end(&self, body: &Body<D>, u: &Field<D>, mut visit: impl FnMut(End<D>)) {
        self.each_pull(body, u, |pull| pull.ends(body.len).for_each(&mut visit));
    }

    /// Visit every central force: of pairs closer than allowed, then of those that attract each other.
    pub fn each_pull(&self, body: &Body<D>, u: &Field<D>, mut visit: impl FnMut(Pull<D>)) {
        self.each_repulsion(body, u, &mut visit);
        if let Some(cohesion) = &self.cohesion {
            cohesion.each_pull(body, u, visit);
        }
    }

    fn each_repulsion(&self, body: &Body<D>, u: &Field<D>, mut visit: impl FnMut(Pull<D>)) {
        let volume = |n: usize| match n.checked_sub(body.len) {
            None => body.volume.at(n),
            Some(ghost) => self.volumes_there[ghost],
        };
        self.each_contact(u, |touch| {
            let pull = touch.pull([touch.i, touch.j].map(volume));
            visit(pull.named(|n| self.ghosts.name(body, n)));
        });
    }

    /// Visit the pairs closer than allowed.
    pub fn each_contact(&self, u: &Field<D>, mut visit: impl FnMut(Touch<D>)) {
        self.each_pair(u, |_, [i, j], y, pair| {
            let square: f64 = y.iter().map(|c| c * c).sum();
            if square < pair.distance * pair.distance {
                visit(Touch {
                    i,
                    j,
                    y,
                    r: square.sqrt(),
                    d: pair.distance,
                    stiffness: pair.stiffness,
                });
            }
        });
    }

    /// Visit the pairs that touch, with a weight from 0 to 1; `u` as for [`Contact::energy`]. None without [`Nearness`].
    pub fn each_near(&self, u: &Field<D>, mut visit: impl FnMut([usize; 2], f64)) {
        if self.near.is_none() {
            return;
        }
        self.each_pair(u, |n, ends, y, _| {
            let r = y.iter().map(|c| c * c).sum::<f64>().sqrt();
            let weight = self.bounds[n].weight(r);
            if weight > 0.0 {
                visit(ends, weight);
            }
        });
    }

    /// Visit the listed pairs: place in the list, ends, and the way between them now.
    #[inline(always)]
    fn each_pair(
        &self,
        u: &Field<D>,
        mut visit: impl FnMut(usize, [usize; 2], [f64; D], &Pair<D>),
    ) {
        let mut pairs = self.pairs.iter().enumerate();
        for (i, row) in self.neighbours.rows() {
            let ui = self.ghosts.displacement(u, i);
            for (&j, (n, pair)) in row.iter().zip(&mut pairs) {
                let j = j as usize;
                let uj = self.ghosts.displacement(u, j);
                let y: [f64; D] = crate::array::from_fn(|a| pair.base[a] + (uj[a] - ui[a]));
                visit(n, [i, j], y, pair);
            }
        }
    }
}

/// Which points hold together, where not all do.
fn groups<const D: usize>(body: &Body<D>, bonded: &[bool]) -> Vec<u16> {
    let pieces = body.pieces();
    let mut group = vec![LOOSE; if pieces.is_empty() { 0 } else { body.len }];
    for (n, p) in pieces.iter().enumerate() {
        // two bodies of one number would be taken for one: those beyond are searched in full
        if bonded.get(n) != Some(&false) && n < LOOSE as usize {
            group[p.range()].fill(n as u16);
        }
    }
    group
}

#[cfg(test)]
#[path = "contact_tests.rs"]
mod tests;
