//! The sweeps over fixed neighbours: lanes run over the atoms of a tile.

use crate::body::Column;
use crate::execute::blocks::Shared;
use crate::execute::lane::Lane;
use crate::execute::simd::Kernel;
use crate::family::links::{Link, Tile, Tiles};
use crate::interaction::Fault;
use crate::interaction::atoms::{density_fault, embed};
use crate::law::number::Dual;
use crate::law::potential::Potential;

pub(super) struct View<'a, const D: usize, P> {
    pub tiles: Tiles<'a, D>,
    pub potential: &'a P,
    /// Squared length.
    pub limit: f64,
}

impl<const D: usize, P: Potential> View<'_, D, P> {
    /// Current vector to the partners along a bond, and its square; `i` are the tile's own displacements.
    #[inline(always)]
    fn vector<L: Lane>(&self, tile: &Tile<D>, link: &Link<D>, i: &[L; D]) -> ([L; D], L) {
        let j = self.tiles.partners::<L>(tile, link);
        let mut y = *i;
        let mut q = L::splat(0.0);
        for a in 0..D {
            y[a] = L::splat(link.xi[a]) + (j[a] - i[a]);
            q = y[a].fma(y[a], q);
        }
        (y, q)
    }

    /// Lanes whose partners at bond `k` are beyond the cut-off or not there.
    #[inline(always)]
    fn out<L: Lane>(&self, q: L, tile: &Tile<D>, k: usize) -> L::Mask {
        let far = q.ge(L::splat(self.limit));
        match tile.bits {
            None => far,
            Some(bits) => L::or(far, L::dead(bits[k])),
        }
    }

    /// Σ f of a tile.
    #[inline(always)]
    fn density<L: Lane>(&self, tile: &Tile<D>, i: &[L; D]) -> L {
        let mut density = L::splat(0.0);
        for (k, link) in tile.links.iter().enumerate() {
            let (_, q) = self.vector(tile, link, i);
            let f = self.potential.density(Dual::variable(q)).value;
            density = density + f.zero_if(self.out(q, tile, k));
        }
        density
    }

    /// The first of a tile's points that went through its partner at bond `k` of a chain.
    #[inline(always)]
    fn crossed<L: Lane>(&self, tile: &Tile<D>, k: usize, i: &[L; D]) -> Option<Fault> {
        let (y, _) = self.vector(tile, &tile.links[k], i);
        let there = tile.bits.map_or(tile.owned, |bits| bits[k]);
        let crossed = L::bits(L::splat(0.0).ge(y[0])) as u8 & there;
        if crossed == 0 {
            return None;
        }
        let i = tile.first + crossed.trailing_zeros() as usize;
        let j = i.wrapping_add_signed(tile.links[k].shift);
        Some(Fault::Crossing { i, j })
    }
}

pub(super) struct Density<'a, const D: usize, P> {
    pub view: View<'a, D, P>,
    pub slope: Shared,
}

impl<const D: usize, P: Potential> Kernel for Density<'_, D, P> {
    type Out = Option<Fault>;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Option<Fault> {
        let view = &self.view;
        let mut fault = None;
        for tile in view.tiles.block(block) {
            let density = view.density::<L>(&tile, &view.tiles.own(&tile));
            let [_, slope] = embed(view.potential, density);
            // SAFETY: tiles are disjoint
            unsafe {
                slope
                    .zero_if(L::dead(tile.owned))
                    .store(self.slope.at(tile.first))
            };
            if fault.is_none() {
                fault = density_fault(view.potential, density, tile.owned, |l| tile.first + l);
            }
        }
        fault
    }
}

pub(super) struct Forces<'a, const D: usize, P> {
    pub view: View<'a, D, P>,
    pub slope: &'a Column,
    pub f: [Shared; D],
    /// 2 / volume
    pub scale: f64,
    /// The bond of a chain that must not turn over.
    pub next: Option<usize>,
}

impl<const D: usize, P: Potential> Kernel for Forces<'_, D, P> {
    type Out = Option<Fault>;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Option<Fault> {
        let view = &self.view;
        let mut fault = None;
        for tile in view.tiles.block(block) {
            let i = view.tiles.own::<L>(&tile);
            let mut own = L::splat(0.0);
            if P::EMBEDDED {
                // SAFETY: as the displacements
                own = unsafe { L::load(self.slope.as_ptr().add(tile.first)) };
            }
            let mut force = [L::splat(0.0); D];
            for (k, link) in tile.links.iter().enumerate() {
                let (y, q) = view.vector(&tile, link, &i);
                let mut pull = view.potential.pair(Dual::variable(q)).slope;
                if P::EMBEDDED {
                    // SAFETY: as the displacements
                    let other =
                        unsafe { L::load(self.slope.as_ptr().add(tile.first).offset(link.shift)) };
                    let f = view.potential.density(Dual::variable(q)).slope;
                    pull = f.fma(own + other, pull);
                }
                let pull = pull.zero_if(view.out(q, &tile, k));
                for a in 0..D {
                    force[a] = pull.fma(y[a], force[a]);
                }
            }
            let dead = L::dead(tile.owned);
            for a in 0..D {
                let f = force[a] * L::splat(self.scale);
                // SAFETY: tiles are disjoint
                unsafe { f.zero_if(dead).store(self.f[a].at(tile.first)) };
            }
            if D == 1
                && fault.is_none()
                && let Some(k) = self.next
            {
                fault = view.crossed(&tile, k, &i);
            }
        }
        fault
    }
}

pub(super) struct Energies<'a, const D: usize, P> {
    pub view: View<'a, D, P>,
    /// Energy density per slot, if asked for.
    pub out: Shared,
    /// 1 / volume
    pub inverse: f64,
}

impl<const D: usize, P: Potential> Kernel for Energies<'_, D, P> {
    type Out = [f64; 1];
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 1] {
        let view = &self.view;
        let mut sum = 0.0;
        for tile in view.tiles.block(block) {
            let i = view.tiles.own::<L>(&tile);
            let mut energy = L::splat(0.0);
            for (k, link) in tile.links.iter().enumerate() {
                let (_, q) = view.vector(&tile, link, &i);
                let pair = view.potential.pair(Dual::variable(q)).value;
                energy = energy + pair.zero_if(view.out(q, &tile, k));
            }
            energy = energy * L::splat(0.5);
            if P::EMBEDDED {
                let [f, _] = embed(view.potential, view.density(&tile, &i));
                energy = energy + f;
            }
            let energy = energy.zero_if(L::dead(tile.owned));
            if !self.out.0.is_null() {
                // SAFETY: tiles are disjoint
                unsafe { (energy * L::splat(self.inverse)).store(self.out.at(tile.first)) };
            }
            sum += energy.to_array().iter().sum::<f64>();
        }
        [sum]
    }
}
