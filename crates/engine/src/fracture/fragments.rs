//! Fragments: points connected by whole bonds.

use crate::body::Body;
use crate::interaction::{BondState, Interaction};

/// The pieces of a body, the one with the most points first (ties: the one that holds the lowest point id).
#[derive(Debug, Clone, PartialEq)]
pub struct Fragments {
    /// `[N]` fragment of every point, in order of id.
    pub label: Vec<u32>,
    /// `[fragments]` number of points.
    pub size: Vec<u32>,
    /// `[fragments]` mass.
    pub mass: Vec<f64>,
}

impl Fragments {
    /// Connected components over the whole bonds of `interaction`. A point without whole bonds is a fragment of one.
    pub fn of<const D: usize>(body: &Body<D>, interaction: &dyn Interaction<D>) -> Fragments {
        let mut sets = Sets::new(body.len);
        interaction.each_bond(body, &mut |i, j, _, state| {
            if state == BondState::Whole {
                sets.join(i as u32, j as u32);
            }
        });
        // pieces in order of their lowest id
        const UNSEEN: u32 = u32::MAX;
        let mut piece = vec![UNSEEN; body.len];
        let mut size: Vec<u32> = vec![];
        let mut label = Vec::with_capacity(body.points());
        for &slot in &body.slots {
            let root = sets.root(slot) as usize;
            if piece[root] == UNSEEN {
                piece[root] = size.len() as u32;
                size.push(0);
            }
            size[piece[root] as usize] += 1;
            label.push(piece[root]);
        }
        let mut order: Vec<u32> = (0..size.len() as u32).collect();
        order.sort_by_key(|p| std::cmp::Reverse(size[*p as usize])); // stable: ties stay in order of lowest id
        let mut rank = vec![0u32; order.len()];
        for (r, p) in order.iter().enumerate() {
            rank[*p as usize] = r as u32;
        }
        let mut mass = vec![0.0; order.len()];
        for (l, &slot) in label.iter_mut().zip(&body.slots) {
            *l = rank[*l as usize];
            let slot = slot as usize;
            mass[*l as usize] += body.volume.at(slot) * body.density.at(slot);
        }
        size.sort_unstable_by(|a, b| b.cmp(a));
        Fragments { label, size, mass }
    }

    /// Number of fragments, single points included.
    pub fn count(&self) -> usize {
        self.size.len()
    }
}

/// Disjoint sets of slots; the root of a set is its lowest slot.
struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    fn new(len: usize) -> Sets {
        Sets {
            parent: (0..len as u32).collect(),
        }
    }

    /// Every visited slot is linked to its grandparent, so that paths halve.
    fn root(&mut self, mut i: u32) -> u32 {
        loop {
            let p = self.parent[i as usize];
            if p == i {
                return i;
            }
            let g = self.parent[p as usize];
            self.parent[i as usize] = g;
            i = g;
        }
    }

    fn join(&mut self, i: u32, j: u32) {
        if self.parent[i as usize] == self.parent[j as usize] {
            return;
        }
        let (a, b) = (self.root(i), self.root(j));
        self.parent[a.max(b) as usize] = a.min(b);
    }
}
