//! The bonds of several potentials on families of the reference: who is near in any of them, and where each has that bond in its own list.

use super::breaking::{Held, lines_of};
use crate::body::{Body, view};
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::family::neighbours::near::{Lines, NearList, Reaches};

use std::collections::HashMap;

/// In place of a place where a potential does not know the bond.
const NOWHERE: u32 = u32::MAX;

/// See the module.
pub(super) struct Union<const D: usize> {
    pub list: NearList<D>,
    pub simd: Simd,
    parts: Vec<Part>,
}

/// The list of one of them as it was made.
struct Part {
    /// First line of each tile.
    first: Vec<u32>,
    /// `[lines]`
    family: Vec<[u32; TILE]>,
    /// Its place of every place of the union.
    own: Vec<u32>,
}

impl<const D: usize> Union<D> {
    /// Of potentials that hold families of this `horizon` (length).
    pub fn new(body: &Body<D>, parts: &[Box<dyn Held<D>>], horizon: f64, simd: Simd) -> Self {
        let reaches = Reaches::new(1, |_, _| horizon);
        let mut list = NearList::of_reference(body, reaches, Lines::ByKind).wide();
        list.update(body, view(&body.at_rest()), simd);
        let all = lines_of(&list);
        let parts = { parts.iter() }.map(|p| Part::of(p.list(), (&list, &all)));
        let parts: Vec<Part> = parts.collect();
        // who is near to somebody and feels nothing of it has no bond with it
        let nowhere = list.nowhere();
        for (tile, first) in all.0.iter().enumerate() {
            for (line, others) in list.lines_mut(tile).iter_mut().enumerate() {
                for (lane, other) in others.iter_mut().enumerate() {
                    let place = (*first as usize + line) * TILE + lane;
                    if parts.iter().all(|p| p.own[place] == NOWHERE) {
                        *other = nowhere;
                    }
                }
            }
        }
        Union { list, simd, parts }
    }

    /// [`Held::pulls`] of all of them together.
    pub fn pulls(&self, parts: &[Box<dyn Held<D>>], out: &mut [[f64; D]]) {
        out.fill([0.0; D]);
        for (potential, part) in parts.iter().zip(&self.parts) {
            let mut own = vec![[0.0; D]; part.family.len() * TILE];
            potential.pulls(&part.first, &mut own);
            for (out, place) in out.iter_mut().zip(&part.own) {
                if let Some(pull) = own.get(*place as usize) {
                    out.iter_mut().zip(pull).for_each(|(a, b)| *a += b);
                }
            }
        }
    }

    /// [`Held::follow`] of each.
    pub fn follow(&self, parts: &mut [Box<dyn Held<D>>], place: usize, whole: bool) {
        for (potential, part) in parts.iter_mut().zip(&self.parts) {
            let own = part.own[place];
            if own == NOWHERE {
                continue;
            }
            let (line, lane) = (own as usize / TILE, own as usize % TILE);
            let tile = part.first.partition_point(|f| *f as usize <= line) - 1;
            let list = potential.list_mut();
            let named = match whole {
                true => part.family[line][lane],
                false => list.nowhere(),
            };
            list.lines_mut(tile)[line - part.first[tile] as usize][lane] = named;
        }
    }

    pub fn bytes(&self) -> usize {
        let of = |p: &Part| 4 * (p.first.len() + TILE * p.family.len() + p.own.len());
        self.list.bytes() + self.parts.iter().map(of).sum::<usize>()
    }
}

impl Part {
    fn of<const D: usize>(
        list: &NearList<D>,
        (all, lines): (&NearList<D>, &(Vec<u32>, Vec<[u32; TILE]>)),
    ) -> Part {
        let own = lines_of(list);
        let mut near: HashMap<usize, Vec<_>> = HashMap::new();
        each_bond(list, &own, |i, j, xi, place| {
            near.entry(i).or_default().push((j, xi, place));
        });
        let mut places = vec![NOWHERE; lines.1.len() * TILE];
        each_bond(all, lines, |i, j, xi, place| {
            let near = near.get(&i).into_iter().flatten();
            let found = { near }.find(|(k, of, _)| *k == j && alike(of, &xi));
            if let Some((_, _, own)) = found {
                places[place] = *own as u32;
            }
        });
        let (first, family) = own;
        Part {
            first,
            family,
            own: places,
        }
    }
}

/// All bonds of a list at its positions of now: slots, ξ and place.
fn each_bond<const D: usize>(
    list: &NearList<D>,
    (first, family): &(Vec<u32>, Vec<[u32; TILE]>),
    mut visit: impl FnMut(usize, usize, [f64; D], usize),
) {
    let at = list.positions();
    for tile in 0..first.len() {
        let begin = first[tile] as usize;
        let end = first.get(tile + 1).map_or(family.len(), |f| *f as usize);
        for lane in 0..list.lanes(tile) {
            let own = tile * TILE + lane;
            let Some(i) = list.original(own) else {
                continue;
            };
            let x = at[own];
            for (line, others) in family[begin..end].iter().enumerate() {
                let other = others[lane] as usize;
                if let Some(j) = list.original(other) {
                    let xi = crate::array::from_fn(|a| at[other][a] - x[a]);
                    visit(i, j, xi, (begin + line) * TILE + lane);
                }
            }
        }
    }
}

/// Do two bonds lead to the same image?
fn alike<const D: usize>(a: &[f64; D], b: &[f64; D]) -> bool {
    let square = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>();
    let off: [f64; D] = crate::array::from_fn(|k| a[k] - b[k]);
    square(&off) < 1e-12 * square(a)
}
