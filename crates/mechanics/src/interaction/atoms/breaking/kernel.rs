//! The sweeps of bonds that break: which of a tile's bonds go, and the work that is done on each.

use crate::body::Body;
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::family::neighbours::near::NearList;
use crate::interaction::bond::relative_square_stretch;
use crate::interaction::{Toughness, history};

/// Finds the bonds of a block that go, and what points bear from now on.
pub(super) struct Test<'a, const D: usize> {
    pub body: &'a Body<D>,
    pub list: &'a NearList<D>,
    /// `[listed][4]`: places in the reference, and critical values.
    pub reference: &'a [[f64; 4]],
    /// First line of each tile.
    pub first: &'a [u32],
    /// Work done on each bond, by place (energy / volume²); empty: bonds break by their stretch.
    pub work: &'a [f64],
    pub toughness: &'a [Toughness],
    /// `[own]`: critical values of `e` from now on, where bonds break by their stretch.
    pub next: Shared,
    /// Places of bonds that go, for each block.
    pub found: Shared<Vec<u32>>,
}

impl<const D: usize> Kernel for Test<'_, D> {
    type Out = ();
    type Home = Self;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        // SAFETY: a place for each block
        let found = unsafe { &mut *self.found.at(block) };
        found.clear();
        let nowhere = self.list.nowhere();
        let now = self.list.positions().as_ptr().cast();
        let then = self.reference.as_ptr().cast();
        // SAFETY: listed atoms have positions and a reference, and there are whole tiles of both
        let at = |of: *const f64, index: &[u32; TILE]| unsafe { L::gather4(of, index.as_ptr()) };
        for (t, lines) in self.list.tiles(block) {
            // whose own atoms are here
            if self.list.slots(t).is_empty() {
                continue;
            }
            let own = crate::array::from_fn(|l| (t * TILE + l) as u32);
            let (y, x) = (at(now, &own), at(then, &own));
            let mut lowest = L::splat(f64::INFINITY);
            for (n, line) in lines.iter().enumerate() {
                let (z, w) = (at(now, line), at(then, line));
                let mut eta = [L::splat(0.0); D];
                let mut xi = eta;
                let mut square = L::splat(0.0);
                for a in 0..D {
                    xi[a] = w[a] - x[a];
                    eta[a] = (z[a] - y[a]) - xi[a];
                    square = xi[a].fma(xi[a], square);
                }
                let e = relative_square_stretch(eta, xi, L::splat(2.0).div(square));
                let there = (0..TILE).fold(0u8, |bits, l| bits | u8::from(line[l] != nowhere) << l);
                lowest = lowest.min(L::select(L::dead(there), L::splat(f64::INFINITY), e));
                let limit = history::limit(x[3], w[3]);
                let place = (self.first[t] as usize + n) * TILE;
                let beyond = match self.work.is_empty() {
                    true => L::bits(limit.lt(e)),
                    false => {
                        // SAFETY: there is a number for every place
                        let work = unsafe { L::load(self.work.as_ptr().add(place)) };
                        L::bits(limit.lt(work)) & L::bits(L::splat(0.0).lt(e))
                    }
                };
                let mut damaged = beyond as u8 & there;
                while damaged != 0 {
                    found.push(place as u32 + damaged.trailing_zeros());
                    damaged &= damaged - 1;
                }
            }
            if self.work.is_empty() {
                let slots = self.list.slots(t);
                let material = |l: usize| match slots.get(l) {
                    Some(slot) => self.body.material_of(*slot as usize),
                    None => 0,
                };
                let alone = L::splat(f64::INFINITY);
                let next = history::next_critical(self.toughness, material, lowest, alone);
                // SAFETY: whole tiles, each of one block
                unsafe { next.store(self.next.at(t * TILE)) };
            }
        }
    }
}

/// `w += ½ (T then + T now)·Δy` of every bond, over the volumes of both ends.
pub(super) struct Add<'a, const D: usize> {
    pub body: &'a Body<D>,
    pub list: &'a NearList<D>,
    /// First line of each tile.
    pub first: &'a [u32],
    /// Positions at the step before, and forces of all bonds by place, of then and now.
    pub then: &'a [[f64; 4]],
    pub before: &'a [[f64; D]],
    pub pulls: &'a [[f64; D]],
    pub work: Shared,
}

impl<const D: usize> Kernel for Add<'_, D> {
    type Out = ();
    type Home = Self;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let now = self.list.positions();
        for (t, lines) in self.list.tiles(block) {
            for (l, slot) in self.list.slots(t).iter().enumerate() {
                let own = t * TILE + l;
                let volume = self.body.volume.at(*slot as usize);
                for (n, line) in lines.iter().enumerate() {
                    let other = line[l] as usize;
                    let Some(partner) = self.list.original(other) else {
                        continue;
                    };
                    let place = (self.first[t] as usize + n) * TILE + l;
                    let (before, pull) = (&self.before[place], &self.pulls[place]);
                    let done: f64 = (0..D)
                        .map(|a| {
                            let y = now[other][a] - now[own][a];
                            let moved = y - (self.then[other][a] - self.then[own][a]);
                            0.5 * (before[a] + pull[a]) * moved
                        })
                        .sum();
                    // SAFETY: each place belongs to one tile
                    unsafe {
                        *self.work.at(place) += done / (volume * self.body.volume.at(partner))
                    };
                }
            }
        }
    }
}
