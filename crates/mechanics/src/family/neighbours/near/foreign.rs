//! Atoms that other ranks have, of those within reach of own ones: listed after these, before all images.
//!
//! Who is there is found with every list ([`Ghosts`]); where they are, and their fourth numbers, those who have them say at every step.

use super::cells::{Cells, Marked, NOBODY, NOWHERE};
use super::images::{Image, add_images};
use crate::body::{Body, FieldView};
use crate::execute::lane::TILE;
use crate::family::neighbours::ghosts::Ghosts;

/// See the module.
#[derive(Debug)]
pub(super) struct Foreign<const D: usize> {
    ghosts: Ghosts<D>,
    /// By slot: the own atom. Empty where nobody else has any.
    own: Vec<u32>,
    /// The listed atom that each ghost is.
    listed: Vec<u32>,
    /// The ghost that each listed atom is, from the first of other ranks on; [`NOBODY`] where the last tile of a kind ends.
    ghost: Vec<u32>,
    /// Of these, in whole tiles, those whose lists are made, too.
    centres: usize,
}

impl<const D: usize> Default for Foreign<D> {
    fn default() -> Self {
        Foreign {
            ghosts: Ghosts::default(),
            own: vec![],
            listed: vec![],
            ghost: vec![],
            centres: 0,
        }
    }
}

/// Atoms of the box as lists are made of them.
pub(super) struct Sort<'a, const D: usize> {
    pub cells: &'a Cells<D>,
    pub period: &'a [Option<f64>; D],
    pub reach: f64,
    /// Kinds that lines are in the order of.
    pub groups: usize,
    /// Own atoms feel what their neighbours feel of each other.
    pub wide: bool,
}

/// One of another rank.
struct Met {
    ghost: u32,
    /// Its group, cell and id: atoms of the box stand in this order.
    order: (usize, usize, u32),
    kind: u8,
    at: [f64; 4],
    is_centre: bool,
}

impl<const D: usize> Foreign<D> {
    /// Takes those that are near, of whom own atoms stand in `order` at these positions and are of these kinds. `None`: there are no other ranks. Else which
    /// listed atoms are in the box, in order of groups, cells and ids; positions and kinds of others are put behind. All ranks come here at once.
    pub fn meet(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        sort: &Sort<'_, D>,
        order: &[u32],
        (position, kind): (&mut Vec<[f64; 4]>, &mut Vec<u8>),
    ) -> Option<Vec<u32>> {
        let reach = if sort.wide { 2.0 } else { 1.0 } * sort.reach;
        self.ghosts.find(body, u, reach);
        if !self.ghosts.is_shared() {
            return None;
        }
        self.own = vec![NOBODY; body.len];
        for (n, slot) in order.iter().enumerate() {
            if *slot != NOBODY {
                self.own[*slot as usize] = n as u32;
            }
        }
        let own = &self.own;
        let kind_of = |n: usize| kind.get(n).copied().unwrap_or(0);
        let said: Vec<[f64; 4]> = self.ghosts.ask(|slot| {
            let n = own[slot] as usize;
            let mut said = position[n];
            said[3] = f64::from(kind_of(n));
            said
        });
        let mut marked = Marked::none(sort.cells);
        let there = |n: &usize| order[*n] != NOBODY;
        (0..order.len())
            .filter(there)
            .for_each(|n| marked.mark(sort.cells, &position[n]));
        let mut images: Vec<Image<D>> = vec![];
        let mut near = |at: &[f64; 4], reaches: usize| {
            images.clear();
            add_images(0, at, sort.period, reach, &mut images);
            let all = std::iter::once(*at).chain(images.iter().map(|image| image.at(at)));
            { all }.any(|at| marked.is_near(sort.cells, &at, reaches))
        };
        let listed: Vec<bool> = said
            .iter()
            .map(|at| near(at, if sort.wide { 2 } else { 1 }))
            .collect();
        self.ghosts.keep(&listed);
        let said = said.into_iter().zip(listed).filter(|(_, listed)| *listed);
        let groups = |kind: u8| {
            if sort.groups > 1 {
                usize::from(kind)
            } else {
                0
            }
        };
        let mut met: Vec<Met> = { said.zip(self.ghosts.all()).enumerate() }
            .map(|(n, ((mut at, _), ghost))| {
                let kind = at[3] as u8;
                at[3] = 0.0;
                Met {
                    ghost: n as u32,
                    order: (groups(kind), sort.cells.of(&at), ghost.id as u32),
                    kind,
                    at,
                    is_centre: sort.wide && near(&at, 1),
                }
            })
            .collect();
        met.sort_unstable_by_key(|m| m.order);
        let many = !kind.is_empty();
        let first = order.len().next_multiple_of(TILE);
        let nowhere = [NOWHERE * sort.reach; 4];
        self.ghost.clear();
        self.listed = vec![NOBODY; met.len()];
        let mut put = |m: Option<&Met>, kind_of_fill: u8| {
            if let Some(m) = m {
                self.listed[m.ghost as usize] = (first + self.ghost.len()) as u32;
            }
            self.ghost.push(m.map_or(NOBODY, |m| m.ghost));
            position.push(m.map_or(nowhere, |m| m.at));
            if many {
                kind.push(m.map_or(kind_of_fill, |m| m.kind));
            }
            self.ghost.len()
        };
        let mut length = 0usize;
        let mut before: Option<&Met> = None;
        for m in met.iter().filter(|m| m.is_centre) {
            if before.is_some_and(|b| b.order.0 != m.order.0) {
                while !length.is_multiple_of(TILE) {
                    length = put(None, before.map_or(0, |b| b.kind));
                }
            }
            length = put(Some(m), 0);
            before = Some(m);
        }
        while !length.is_multiple_of(TILE) {
            length = put(None, before.map_or(0, |b| b.kind));
        }
        self.centres = length;
        for m in met.iter().filter(|m| !m.is_centre) {
            put(Some(m), 0);
        }
        let ids = body.ids_of_all();
        let own = { order.iter().enumerate() }.filter(|(_, slot)| **slot != NOBODY);
        let own = own.map(|(n, slot)| {
            let order = (
                groups(kind.get(n).copied().unwrap_or(0)),
                sort.cells.of(&position[n]),
                ids[*slot as usize],
            );
            (order, n as u32)
        });
        let others = met.iter().map(|m| (m.order, self.listed[m.ghost as usize]));
        let mut all: Vec<_> = own.chain(others).collect();
        all.sort_unstable();
        Some(all.into_iter().map(|(_, listed)| listed).collect())
    }

    /// Listed atoms of other ranks, and how many of them, from the first on, have lists.
    pub fn len(&self) -> usize {
        self.ghost.len()
    }

    /// See [`len`](Self::len).
    pub fn centres(&self) -> usize {
        self.centres
    }

    /// The ghost that the nth listed one is.
    #[inline(always)]
    pub fn ghost(&self, n: usize) -> Option<usize> {
        let ghost = *self.ghost.get(n)?;
        (ghost != NOBODY).then_some(ghost as usize)
    }

    pub fn ghosts(&self) -> &Ghosts<D> {
        &self.ghosts
    }

    /// Where they are now.
    pub fn follow(&self, position: &mut [[f64; 4]]) {
        let own = &self.own;
        let now: Vec<[f64; 3]> = (self.ghosts).ask(|slot| {
            let x = position[own[slot] as usize];
            [x[0], x[1], x[2]]
        });
        for (x, listed) in now.into_iter().zip(&self.listed) {
            position[*listed as usize][..3].copy_from_slice(&x);
        }
    }

    /// Their fourth numbers.
    pub fn copy_fourth(&self, position: &mut [[f64; 4]]) {
        let own = &self.own;
        let fourth: Vec<f64> = (self.ghosts).ask(|slot| position[own[slot] as usize][3]);
        for (x, listed) in fourth.into_iter().zip(&self.listed) {
            position[*listed as usize][3] = x;
        }
    }

    pub fn bytes(&self) -> usize {
        self.ghosts.bytes()
            + 4 * (self.own.capacity() + self.listed.capacity() + self.ghost.capacity())
    }
}
