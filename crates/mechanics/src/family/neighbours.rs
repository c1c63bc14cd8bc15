//! Neighbours: pairs of points that are close now, whatever they were in the reference.
//!
//! Pairs within `cutoff + skin` are listed; the list stays valid until a point can have moved more than `skin/2`, since
//! two points can then have come `skin` closer, and is built again by itself. Whoever moves points says how far the
//! fastest one went; the sum of that bounds them all and needs no memory per point. Linked cells make a build O(N).

mod cells;
pub(crate) mod ghosts;
pub mod near;
mod rings;

use crate::body::{Body, FieldView};
use cells::Cells;
use ghosts::Ghosts;

/// A point that holds together with no other.
pub const LOOSE: u16 = u16::MAX;

/// The half list of near pairs: every point i with its neighbours j > i, both in order of slot. On ranks that share a body each has the pairs of its
/// points, with [ghosts](Ghosts) as numbers from the slots on, and the order is that of the slots of the whole.
#[derive(Debug, Clone)]
pub struct Neighbours<const D: usize> {
    reach: f64,
    apart: f64,
    /// `[slots]`: which points hold together, where not all do ([`LOOSE`]: a point does with none).
    group: Vec<u16>,
    cells: Cells<D>,
    /// A ball around the displacements of each cell: centre and radius.
    balls: Vec<([f32; D], f32)>,
    /// The group of all points in each cell, or [`LOOSE`].
    cell_group: Vec<u16>,
    skin: f64,
    /// Bound on the path of any point since the build (length); not a number or infinite: build.
    path: f64,
    /// `i << 32 | j` as found.
    found: Vec<u64>,
    /// Points that have neighbours, and where their neighbours end.
    rows: Vec<(u32, u32)>,
    partner: Vec<u32>,
    builds: u64,
}

impl<const D: usize> Neighbours<D> {
    /// An empty list of pairs closer than `cutoff`, with a margin of `skin` (lengths).
    ///
    /// On periodic axes the nearest image counts; the period should be at least `2 (cutoff + skin)`.
    pub fn new(body: &Body<D>, cutoff: f64, skin: f64) -> Self {
        let reach = cutoff + skin;
        Neighbours {
            reach,
            apart: 0.0,
            group: vec![],
            cell_group: vec![],
            cells: Cells::new(body, reach),
            balls: vec![],
            skin,
            path: f64::INFINITY,
            found: vec![],
            rows: vec![],
            partner: vec![],
            builds: 0,
        }
    }

    /// Leave out pairs whose displacements differ by less than `apart` (length). Where only pairs that were far from
    /// each other in the reference matter, this passes over whole cells of a body that holds together.
    pub fn apart(mut self, apart: f64) -> Self {
        self.apart = apart;
        self
    }

    /// `[slots]`: only pairs of the same group may be left out by [`Neighbours::apart`].
    pub fn groups(mut self, group: Vec<u16>) -> Self {
        self.group = group;
        self
    }

    /// No point has gone further than `path` (length) since the last call.
    pub fn moved(&mut self, path: f64) {
        self.path += path;
    }

    /// Points may be anywhere now.
    pub fn invalidate_neighbours(&mut self) {
        self.path = f64::INFINITY;
    }

    /// Make the list valid at displacement `u`: build it if it is not, with the points of other ranks that are near. Pairs that `keep` refuses are left
    /// out; it is asked once per near pair and build, by slots, of ghosts by those of their copies. Returns whether the list was built.
    pub fn update(
        &mut self,
        body: &Body<D>,
        ghosts: &mut Ghosts<D>,
        u: FieldView<D>,
        keep: &dyn Fn(usize, usize) -> bool,
    ) -> bool {
        // a thousandth for round-off
        let valid = self.path <= (0.5 - 1e-3) * self.skin;
        if self.reach.is_nan() || self.reach <= 0.0 || valid {
            return false;
        }
        self.path = 0.0;
        ghosts.find(body, u, self.reach);
        let moved = ghosts.after(u);
        let u = crate::array::from_fn(|a| &*moved[a]);
        self.cells.sort(body, ghosts.all(), u);
        let own = self.group.len();
        if own > 0 {
            let groups = ghosts.ask(|slot| self.group[slot]);
            self.group.extend(groups);
        }
        self.find(body, ghosts, u, keep);
        self.group.truncate(own);
        let mut listed = vec![false; ghosts.all().len()];
        self.compress(body, ghosts, |n| {
            if let Some(ghost) = (n as usize).checked_sub(body.len) {
                listed[ghost] = true;
            }
        });
        let called = ghosts.keep(&listed);
        if !called.is_empty() {
            let rows = self.rows.iter_mut().map(|(i, _)| i);
            for n in rows.chain(&mut self.partner) {
                if let Some(ghost) = (*n as usize).checked_sub(body.len) {
                    *n = body.len as u32 + called[ghost];
                }
            }
        }
        self.builds += 1;
        true
    }

    fn find(
        &mut self,
        body: &Body<D>,
        ghosts: &Ghosts<D>,
        u: FieldView<D>,
        keep: &dyn Fn(usize, usize) -> bool,
    ) {
        let (cells, apart, reach) = (&self.cells, self.apart, self.reach);
        let difference = |i: u32, j: u32| {
            (0..D)
                .map(|a| u[a][j as usize] - u[a][i as usize])
                .map(|d| d * d)
                .sum::<f64>()
        };
        let group = &self.group;
        let together = |i: u32, j: u32| {
            group.is_empty()
                || (group[i as usize] != LOOSE && group[i as usize] == group[j as usize])
        };
        self.cell_group.clear();
        if !group.is_empty() {
            self.cell_group.extend((0..cells.len()).map(|c| {
                let mut slots = cells.slots(c).iter();
                let first = slots.next().map_or(LOOSE, |s| group[*s as usize]);
                match slots.all(|s| group[*s as usize] == first) {
                    true => first,
                    false => LOOSE,
                }
            }));
        }
        let cell_group = &self.cell_group;
        self.balls.clear();
        if apart > 0.0 {
            self.balls.extend((0..cells.len()).map(|c| {
                let slots = cells.slots(c);
                let Some(first) = slots.first() else {
                    return ([0.0; D], 0.0);
                };
                let center: [f32; D] = crate::array::from_fn(|a| u[a][*first as usize] as f32);
                let mut most = 0.0;
                for &s in slots {
                    let d: [f64; D] =
                        crate::array::from_fn(|a| u[a][s as usize] - center[a] as f64);
                    most = f64::max(most, d.iter().map(|c| c * c).sum());
                }
                // rounded up
                (center, (most.sqrt() * (1.0 + 1e-6)) as f32)
            }));
        }
        let balls = &self.balls;
        let alike = |a: usize, b: usize| {
            let mixed = !cell_group.is_empty()
                && (cell_group[a] == LOOSE || cell_group[a] != cell_group[b]);
            apart > 0.0 && !mixed && {
                let ((p, pr), (q, qr)) = (&balls[a], &balls[b]);
                let workspace = apart - *pr as f64 - *qr as f64;
                let square: f64 = (0..D).map(|a| (q[a] as f64 - p[a] as f64).powi(2)).sum();
                workspace > 0.0 && square < workspace * workspace
            }
        };
        let own = body.len as u32;
        let found = &mut self.found;
        found.clear();
        cells.each_near(alike, |i, j| {
            if apart > 0.0 && together(i, j) && difference(i, j) < apart * apart {
                return;
            }
            let (mut i, mut j) = (i.min(j), i.max(j));
            let kept = match ghosts.of(body, j as usize) {
                None => keep(i as usize, j as usize),
                // both are of others
                Some(_) if i >= own => false,
                Some(ghost) => {
                    if ghost.order < body.order(i as usize) {
                        (i, j) = (j, i);
                    }
                    let copy = ghosts.copy((i.max(j) - own) as usize);
                    copy.is_none_or(|copy| keep(i.min(j) as usize, copy))
                }
            };
            if !kept {
                return;
            }
            let [p, q] = [i, j].map(|n| ghosts.position(body, n as usize));
            let y: [f64; D] =
                crate::array::from_fn(|a| q[a] - p[a] + (u[a][j as usize] - u[a][i as usize]));
            let back = periods(body, &y);
            let y: [f64; D] = crate::array::from_fn(|a| y[a] - back[a]);
            if y.iter().map(|c| c * c).sum::<f64>() < reach * reach {
                found.push((i as u64) << 32 | j as u64);
            }
        });
    }

    /// The pairs that were found, in order; says who is listed.
    fn compress(&mut self, body: &Body<D>, ghosts: &Ghosts<D>, mut list: impl FnMut(u32)) {
        match ghosts.all().is_empty() {
            true => self.found.sort_unstable(),
            false => {
                let order = |n: u64| match ghosts.of(body, n as usize) {
                    None => body.order(n as usize),
                    Some(ghost) => ghost.order,
                };
                let ends = |pair: &u64| [order(pair >> 32), order(pair & u64::from(u32::MAX))];
                self.found.sort_unstable_by_key(ends);
            }
        }
        self.rows.clear();
        self.partner.clear();
        for pair in &self.found {
            let (i, j) = ((pair >> 32) as u32, *pair as u32);
            [i, j].into_iter().for_each(&mut list);
            self.partner.push(j);
            let end = self.partner.len() as u32;
            match self.rows.last_mut() {
                Some(row) if row.0 == i => row.1 = end,
                _ => self.rows.push((i, end)),
            }
        }
    }

    /// Every point that has neighbours j > i, with them (slots and ghosts, in order).
    pub fn rows(&self) -> impl Iterator<Item = (usize, &[u32])> {
        let mut start = 0;
        self.rows.iter().map(move |&(i, end)| {
            let row = &self.partner[start..end as usize];
            start = end as usize;
            (i as usize, row)
        })
    }

    /// Number of listed pairs.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.partner.len()
    }

    /// How often the list was built.
    pub fn builds(&self) -> u64 {
        self.builds
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.cells.bytes()
            + size_of::<([f32; D], f32)>() * self.balls.capacity()
            + 8 * (self.found.capacity() + self.rows.capacity())
            + 4 * self.partner.capacity()
    }
}

/// The whole periods in a vector between two points: what is left without them leads to the nearest image.
pub fn periods<const D: usize>(body: &Body<D>, y: &[f64; D]) -> [f64; D] {
    crate::array::from_fn(|a| body.period[a].map_or(0.0, |p| p * (y[a] / p).round()))
}

/// From one point to another that is ξ away in the reference, to the image of it that is nearest now, `moved` more (lengths): with that the way between them.
pub fn base<const D: usize>(body: &Body<D>, xi: &[f64; D], moved: &[f64; D]) -> [f64; D] {
    let now = periods(body, &crate::array::from_fn(|a| xi[a] + moved[a]));
    crate::array::from_fn(|a| xi[a] - now[a])
}

#[cfg(test)]
mod tests;
