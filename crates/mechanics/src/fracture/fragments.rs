//! Fragments: points connected by whole bonds.

use crate::body::Body;
use crate::interaction::{BondStatus, Interaction};

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
        Self::by(body, interaction, |_, _, _, state| {
            state == BondStatus::Whole
        })
    }

    /// Connected components over the bonds (slots, ξ, state) for which `joins` holds.
    pub fn by<const D: usize>(
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
        joins: impl Fn(usize, usize, &[f64; D], BondStatus) -> bool,
    ) -> Fragments {
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
        let mut order: Vec<u32> = (0..size.len() as u32).collect();
        order.sort_by_key(|p| std::cmp::Reverse(size[*p as usize])); // stable: ties stay in order of lowest id
        let mut rank = vec![0u32; order.len()];
        for (r, p) in order.iter().enumerate() {
            rank[*p as usize] = r as u32;
        }
        let mut mass = vec![0.0; order.len()];
        for (l, own) in label.iter_mut().zip(masses) {
            *l = rank[*l as usize];
            mass[*l as usize] += own;
        }
        size.sort_unstable_by(|a, b| b.cmp(a));
        Fragments { label, size, mass }
    }

    /// The pieces of the body of all ranks, on the first; of more than one rank their masses are not known.
    pub fn of_all<const D: usize>(
        body: &Body<D>,
        interaction: &dyn Interaction<D>,
    ) -> Option<Fragments> {
        if body.subdomain().is_none() {
            return Some(Fragments::of(body, interaction));
        }
        let joined = body.joined(Self::joined(body, interaction))?;
        Some(Self::of_joined(body.all_points(), joined.iter()))
    }

    /// What whole bonds of this rank's points join: ids among all points, the lowest of each piece beside the others.
    fn joined<const D: usize>(body: &Body<D>, interaction: &dyn Interaction<D>) -> Vec<[u32; 2]> {
        let id = body.id_of();
        let mut sets = Sets::new(body.all_points());
        interaction.each_bond(body, &mut |i, j, _, state| {
            if state == BondStatus::Whole {
                sets.join(id(i), id(j));
            }
        });
        let all = 0..body.all_points() as u32;
        all.map(|id| [id, sets.root(id)])
            .filter(|[id, root]| id != root)
            .collect()
    }

    /// Of so many points, from what is joined; their masses are not known.
    fn of_joined<'a>(points: usize, joined: impl Iterator<Item = &'a [u32; 2]>) -> Fragments {
        let mut sets = Sets::new(points);
        joined.for_each(|[i, j]| sets.join(*i, *j));
        let roots = (0..points as u32).map(|id| sets.root(id)).collect();
        Self::of_roots(roots, std::iter::repeat(0.0))
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
        for kind in [CrackKind::Absent, CrackKind::Broken] {
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
