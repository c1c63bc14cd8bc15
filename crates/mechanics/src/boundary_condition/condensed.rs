//! A load on points of a finer body, passed on by the body that was condensed from it.

use super::Program;
use crate::space::Point;
use crate::spec::LoadMap;

/// The points that carry a load, and what of their forces reaches each slot.
#[derive(Debug, Clone)]
pub struct Condensed<const D: usize> {
    points: Vec<Point>,
    volume: Vec<f64>,
    /// `[slots + 1]`
    start: Vec<usize>,
    /// Numbers of the points.
    from: Vec<u32>,
    block: Vec<[[f64; D]; D]>,
    /// `[points]` forces of now.
    force: Vec<[f64; D]>,
}

impl<const D: usize> Condensed<D> {
    /// Of some points of a finer body; also the ids of the points of the body that their forces reach, in order of which slots
    /// are numbered here.
    pub fn new(load_map: &LoadMap<D>, members: &[u32]) -> (Condensed<D>, Vec<u32>) {
        let mut reached: Vec<(u32, u32, [[f64; D]; D])> = vec![];
        for (n, p) in (0..).zip(members) {
            let (targets, blocks) = load_map.row(*p as usize);
            reached.extend(targets.iter().zip(blocks).map(|(q, t)| (*q, n, *t)));
        }
        reached.sort_by_key(|r| (r.0, r.1));
        let (mut ids, mut start) = (vec![], vec![]);
        for (k, r) in reached.iter().enumerate() {
            if ids.last() != Some(&r.0) {
                ids.push(r.0);
                start.push(k);
            }
        }
        start.push(reached.len());
        let at = |p: &u32| {
            let x = &load_map.position[*p as usize];
            crate::array::from_fn(|a| if a < D { x[a] } else { 0.0 })
        };
        let condensed = Condensed {
            points: members.iter().map(at).collect(),
            volume: members
                .iter()
                .map(|p| load_map.volume[*p as usize])
                .collect(),
            start,
            from: reached.iter().map(|r| r.1).collect(),
            block: reached.iter().map(|r| r.2).collect(),
            force: vec![[0.0; D]; members.len()],
        };
        (condensed, ids)
    }

    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Total volume of the points (length^D times the section).
    pub fn volume(&self) -> f64 {
        self.volume.iter().sum()
    }

    /// Only these slots are there, from now on.
    pub fn pick(&mut self, kept: &[usize]) {
        let (mut start, mut from, mut block) = (vec![0], vec![], vec![]);
        for k in kept {
            let range = self.start[*k]..self.start[k + 1];
            from.extend_from_slice(&self.from[range.clone()]);
            block.extend_from_slice(&self.block[range]);
            start.push(from.len());
        }
        (self.start, self.from, self.block) = (start, from, block);
    }

    /// Forces of force densities at time `t`.
    pub fn evaluate(&mut self, density: &Program<D>, t: f64) {
        for (k, force) in self.force.iter_mut().enumerate() {
            let at = |a| self.volume[k] * density.at(a, k, &self.points[k], t);
            *force = crate::array::from_fn(at);
        }
    }

    /// Component `a` of the force that reaches the k-th slot.
    pub fn reaching(&self, k: usize, a: usize) -> f64 {
        let range = self.start[k]..self.start[k + 1];
        let each = self.from[range.clone()].iter().zip(&self.block[range]);
        each.map(|(p, t)| {
            let force = &self.force[*p as usize];
            (0..D).map(|b| t[a][b] * force[b]).sum::<f64>()
        })
        .sum()
    }
}
