//! Fragments: points connected by whole bonds.

use crate::body::Body;
use crate::interaction::{BondStatus, Interaction};

/// Does a bond (slots, ξ, state) join its ends?
pub type Joins<'a, const D: usize> = dyn Fn(usize, usize, &[f64; D], BondStatus) -> bool + 'a;

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
    /// Connected components over the intact bonds of `interaction`. A point without whole bonds is a fragment of one. Where ranks share the body these are
    /// the pieces of all ranks, and in which of them the points are that are here; masses are not known then. All ask at once.
    pub fn of<const D: usize>(body: &Body<D>, interaction: &dyn Interaction<D>) -> Fragments {
        Self::by(body, interaction, &|_, _, _, state| {
            state == BondStatus::Whole
        })
    }

    /// The same over the bonds (slots, ξ, state) for which `joins` holds.
    pub fn by<const D: usize>(
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
        joins: &Joins<'_, D>,
    ) -> Fragments {
        if body.subdomain().is_some() {
            return Self::of_parts(body, Parts::of(body, interaction, joins));
        }
        let mut sets = Sets::new(body.len);
        interaction.each_bond(body, &mut |i, j, xi, state| {
            if joins(i, j, &xi, state) {
                sets.join(i as u32, j as u32);
            }
        });
        let roots = { body.slots.iter() }.map(|slot| sets.root(*slot));
        let mass = |slot: u32| body.volume.at(slot as usize) * body.density.at(slot as usize);
        let masses = { body.slots.iter() }.map(|slot| mass(*slot));
        Self::of_roots(roots.collect(), masses)
    }

    /// Of points that are named by one of the points that each is joined to; mass of each.
    fn of_roots(roots: Vec<u32>, masses: impl Iterator<Item = f64>) -> Fragments {
        // pieces in order of their lowest id
        const UNSEEN: u32 = u32::MAX;
        let most = roots.iter().max().map_or(0, |root| *root as usize + 1);
        let mut piece = vec![UNSEEN; most];
        let mut size: Vec<u32> = vec![];
        let mut label = Vec::with_capacity(roots.len());
        for root in roots {
            let piece = &mut piece[root as usize];
            if *piece == UNSEEN {
                *piece = size.len() as u32;
                size.push(0);
            }
            size[*piece as usize] += 1;
            label.push(*piece);
        }
        let rank = by_size(&size);
        let mut mass = vec![0.0; size.len()];
        for (l, own) in label.iter_mut().zip(masses) {
            *l = rank[*l as usize];
            mass[*l as usize] += own;
        }
        size.sort_unstable_by(|a, b| b.cmp(a));
        Fragments { label, size, mass }
    }

    fn of_parts<const D: usize>(body: &Body<D>, parts: Parts) -> Fragments {
        let mut all: Vec<[u32; 2]> = body.all_of(&parts.sizes).concat();
        all.sort_unstable();
        let place = |name: u32| {
            { all.binary_search_by_key(&name, |[name, _]| *name) }
                .expect("somebody has a part of this name") as u32
        };
        let mut sets = Sets::new(all.len());
        for [a, b] in body.all_of(&parts.joined).concat() {
            sets.join(place(a), place(b));
        }
        // a part of many is called by the lowest of their names, and pieces are in order of these
        let (mut piece, mut size) = (vec![0; all.len()], vec![]);
        for (n, [_, points]) in (0..).zip(&all) {
            let root = sets.root(n);
            if root == n {
                piece[n as usize] = size.len() as u32;
                size.push(0);
            }
            piece[n as usize] = piece[root as usize];
            size[piece[n as usize] as usize] += points;
        }
        let rank = by_size(&size);
        let label = |name: u32| rank[piece[place(name) as usize] as usize];
        let label = parts.names.into_iter().map(label).collect();
        size.sort_unstable_by(|a, b| b.cmp(a));
        let mass = vec![0.0; size.len()];
        Fragments { label, size, mass }
    }

    /// Number of fragments, single points included.
    pub fn count(&self) -> usize {
        self.size.len()
    }
}

/// The places of pieces where larger ones come first, and of equal ones those that came first.
fn by_size(size: &[u32]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..size.len() as u32).collect();
    order.sort_by_key(|p| std::cmp::Reverse(size[*p as usize]));
    let mut place = vec![0u32; order.len()];
    for (n, p) in (0..).zip(&order) {
        place[*p as usize] = n;
    }
    place
}

/// What hangs together on one rank, called by the lowest id among all points that it has there.
struct Parts {
    /// The part of each point that is here, in order of id.
    names: Vec<u32>,
    /// Names with numbers of points.
    sizes: Vec<[u32; 2]>,
    /// Parts, also of other ranks, that hang together over bonds of this one.
    joined: Vec<[u32; 2]>,
}

impl Parts {
    fn of<const D: usize>(
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
        joins: &Joins<'_, D>,
    ) -> Parts {
        const NONE: u32 = u32::MAX;
        let mut sets = Sets::new(body.len);
        // points without a slot here go by their ids
        let mut away: Vec<[u32; 2]> = vec![];
        interaction.each_bond(body, &mut |i, j, xi, state| {
            if !joins(i, j, &xi, state) {
                return;
            }
            match [i.checked_sub(body.len), j.checked_sub(body.len)] {
                [None, None] => sets.join(i as u32, j as u32),
                [None, Some(id)] => away.push([i as u32, id as u32]),
                [Some(id), None] => away.push([j as u32, id as u32]),
                [Some(_), Some(_)] => unreachable!("one end of a bond is here"),
            }
        });
        let mut first = vec![NONE; body.len];
        let mut names = Vec::with_capacity(body.points());
        for (id, slot) in body.slots.iter().enumerate() {
            let first = &mut first[sets.root(*slot) as usize];
            if *first == NONE {
                *first = body.id_of_all(id) as u32;
            }
            names.push(*first);
        }
        let mut ordered = names.clone();
        ordered.sort_unstable();
        let parts = ordered.chunk_by(|a, b| a == b);
        let sizes = parts.map(|of| [of[0], of.len() as u32]).collect();
        // copies are called as where they are at home
        let mut of_slots = vec![NONE; body.len];
        { body.slots.iter().zip(&names) }.for_each(|(slot, name)| of_slots[*slot as usize] = *name);
        body.exchange.fill(&mut of_slots);
        let mut joined = vec![];
        for slot in body.exchange.copies() {
            let (root, name) = (sets.root(slot as u32) as usize, of_slots[slot]);
            match (first[root], name) {
                // of a point that was taken away
                (_, NONE) => {}
                (NONE, name) => first[root] = name,
                (other, name) => joined.push([other, name]),
            }
        }
        if body.exchange.any(!away.is_empty()) {
            let mut ids: Vec<u32> = away.iter().map(|[_, id]| *id).collect();
            ids.sort_unstable();
            ids.dedup();
            let own = body.whose();
            let asked = body.all_of(&ids).concat().into_iter();
            let known = asked.filter_map(|id| Some([id, names[own.place(id)?]]));
            let mut known = body.all_of(&known.collect::<Vec<_>>()).concat();
            known.sort_unstable();
            for [slot, id] in away {
                let at = known.binary_search_by_key(&id, |[id, _]| *id);
                let [_, name] = known[at.expect("somebody has the point")];
                joined.push([first[sets.root(slot) as usize], name]);
            }
        }
        joined.retain(|[a, b]| a != b);
        joined.sort_unstable();
        joined.dedup();
        Parts {
            names,
            sizes,
            joined,
        }
    }
}

/// Disjoint sets; the root of a set is its lowest slot.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fracture::precrack::Crack;
    use crate::samples::{lattice, sites};
    use crate::space::lattice::LatticeKind;
    use crate::spec::{CrackKind, CrackShape};

    #[test]
    fn two_blocks_and_a_loose_point_are_three_fragments() {
        // rows 0..2, rows 6..10 and one site beyond the horizon of 2
        let quarters = sites([4, 16, 1], |x| {
            x[1] < 2 || (6..10).contains(&x[1]) || x == [1, 15, 0]
        });
        let (body, law) = lattice::<2>(LatticeKind::Square, &quarters, 0.5, 2, [false; 2]);
        let f = Fragments::of(&body, law.as_ref());
        assert_eq!((f.count(), f.size.as_slice()), (3, [16, 8, 1].as_slice()));
        assert_eq!(f.mass, [16.0 * 0.25, 8.0 * 0.25, 0.25]);
        let expected: Vec<u32> = quarters
            .iter()
            .map(|q| match q[1] / 4 {
                0 | 1 => 1,
                15 => 2,
                _ => 0,
            })
            .collect();
        assert_eq!(f.label, expected);
        // rows 0, 1 and 4, 5 are three apart inside, and one across a period of six
        let quarters = sites([4, 6, 1], |x| x[1] < 2 || x[1] >= 4);
        for (periodic, count) in [(false, 2), (true, 1)] {
            let (body, law) =
                lattice::<2>(LatticeKind::Square, &quarters, 1.0, 2, [false, periodic]);
            assert_eq!(Fragments::of(&body, law.as_ref()).count(), count);
        }
    }

    #[test]
    fn a_cut_through_the_body_makes_two() {
        let quarters = sites([7, 5, 5], |_| true);
        for kind in [CrackKind::Excluded, CrackKind::Broken] {
            let (body, mut law) = lattice::<3>(LatticeKind::Cubic, &quarters, 1.0, 3, [false; 3]);
            assert_eq!(Fragments::of(&body, law.as_ref()).size, [175]);
            let plane = |x: f64, to: f64| CrackShape::Segment {
                from: [x, -1.0, 0.0],
                to: [x, to, 0.0],
            };
            // a notch leaves one piece
            for (x, to, sizes) in [
                (2.5, 2.5, vec![175]),
                (2.5, 9.0, vec![100, 75]),
                // planes of points that lose all bonds across, on both sides
                (0.5, 9.0, vec![100, 50, 25]),
            ] {
                let crack = Crack::new(&plane(x, to), [None; 3]).unwrap();
                assert!(law.cut(&body, kind, &|a, b| crack.crosses(&a, &b)) > 0);
                assert_eq!(Fragments::of(&body, law.as_ref()).size, sizes);
            }
        }
    }

    #[test]
    fn without_bonds_every_point_is_a_fragment_and_ties_go_by_id() {
        let quarters = sites([6, 1, 1], |_| true);
        let (body, mut law) = lattice::<1>(LatticeKind::Chain, &quarters, 1.0, 2, [false]);
        let cut = law.cut(&body, CrackKind::Broken, &|_, _| true);
        assert_eq!(cut, law.directed_bonds());
        let f = Fragments::of(&body, law.as_ref());
        assert_eq!(f.label, [0, 1, 2, 3, 4, 5]);
        assert_eq!(f.size, [1; 6]);
    }
}
