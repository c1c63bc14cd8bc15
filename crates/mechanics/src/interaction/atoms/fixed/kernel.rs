//! The sweeps over fixed neighbours: lanes run over the atoms of a tile. Of several kinds, a bond is taken once for each pair of kinds
//! that the eight atoms and their partners have: one, where kinds lie on sites of the cell.

use crate::body::Column;
use crate::execute::blocks::Shared;
use crate::execute::lane::Lane;
use crate::execute::simd::Kernel;
use crate::family::links::{Tile, Tiles};
use crate::interaction::Fault;
use crate::interaction::atoms::line::{Alike, Line, Pulls, Sum, Sums};
use crate::interaction::atoms::{density_fault, embed};
use crate::law::potential::Potential;
use crate::law::potential::mixture::Mixture;

pub(super) struct View<'a, const D: usize, P> {
    pub tiles: Tiles<'a, D>,
    pub potential: &'a Mixture<P>,
    /// Squared lengths, `[i][j]` of kinds.
    pub limits: &'a [f64],
    /// Kind per slot; empty: there is one.
    pub kind: &'a Column,
    /// F′ per slot; empty without embedding.
    pub slope: &'a Column,
}

/// Eight numbers of a column that is not empty.
#[inline(always)]
fn eight<L: Lane>(column: &Column, first: usize) -> L {
    // SAFETY: columns reach as far as displacements, which are read at the same places
    unsafe { L::load(column.as_ptr().add(first)) }
}

impl<const D: usize, P: Potential> View<'_, D, P> {
    /// Current vector to the partners along bond `k`, and its square, infinite where there is no partner; `i` are the tile's own
    /// displacements.
    #[inline(always)]
    fn vector<L: Lane>(&self, tile: &Tile<D>, k: usize, i: &[L; D]) -> ([L; D], L) {
        let link = &tile.links[k];
        let j = self.tiles.partners::<L>(tile, link);
        let mut y = *i;
        let mut q = L::splat(0.0);
        for a in 0..D {
            y[a] = L::splat(link.xi[a]) + (j[a] - i[a]);
            q = y[a].fma(y[a], q);
        }
        if let Some(bits) = tile.bits {
            q = L::select(L::dead(bits[k]), L::splat(f64::INFINITY), q);
        }
        (y, q)
    }

    /// Which of eight points from `first` on are of a kind.
    #[inline(always)]
    fn of_kind<L: Lane>(&self, first: usize, kind: usize) -> u8 {
        if self.kind.is_empty() {
            return 0xff;
        }
        let here = eight::<L>(self.kind, first);
        let (low, high) = (L::splat(kind as f64 - 0.5), L::splat(kind as f64 + 0.5));
        (L::bits(here.ge(low)) & L::bits(here.lt(high))) as u8
    }

    /// Adds what all bonds of a tile say.
    #[inline(always)]
    fn visit<L: Lane>(&self, tile: &Tile<D>, i: &[L; D], sum: &mut impl Sum<L, D>) {
        let kinds = self.potential.kinds();
        if kinds == 1
            && let Some(potential) = self.potential.own(0)
        {
            let says = Alike::<P, false> {
                potential,
                limit: self.limits[0],
            };
            return self.add::<L, false>(tile, &says, i, [0xff, 0], sum);
        }
        for own in 0..kinds {
            let here = self.of_kind::<L>(tile.first, own);
            if here & tile.owned == 0 {
                continue;
            }
            for other in 0..kinds {
                let Some(potential) = self.potential.of(own, other) else {
                    continue;
                };
                let limit = self.limits[own * kinds + other];
                let pair = [here, other as u8];
                if P::EMBEDDED && own != other {
                    let says = Alike::<P, true> { potential, limit };
                    self.add::<L, true>(tile, &says, i, pair, sum);
                } else {
                    let says = Alike::<P, false> { potential, limit };
                    self.add::<L, true>(tile, &says, i, pair, sum);
                }
            }
        }
    }

    /// What bonds say; of `SEVERAL` kinds those from the lanes `here` to partners of a kind.
    #[inline(always)]
    fn add<L: Lane, const SEVERAL: bool>(
        &self,
        tile: &Tile<D>,
        says: &impl Line<L>,
        i: &[L; D],
        [here, kind]: [u8; 2],
        sum: &mut impl Sum<L, D>,
    ) {
        let slope = |first: usize| match P::EMBEDDED {
            true => eight(self.slope, first),
            false => L::splat(0.0),
        };
        let own = slope(tile.first);
        for (k, link) in tile.links.iter().enumerate() {
            let there = tile.first.wrapping_add_signed(link.shift);
            let (y, mut q) = self.vector(tile, k, i);
            if SEVERAL {
                let these = here & self.of_kind::<L>(there, kind as usize);
                if these == 0 {
                    continue;
                }
                q = L::select(L::dead(these), L::splat(f64::INFINITY), q);
            }
            sum.add(says, &y, q, [own, slope(there)]);
        }
    }

    /// Σ f of a tile.
    #[inline(always)]
    fn density<L: Lane>(&self, tile: &Tile<D>, i: &[L; D]) -> L {
        let mut density = Densities(L::splat(0.0));
        self.visit(tile, i, &mut density);
        density.0
    }

    /// F and F′ of a tile's densities, of each atom by its kind; 0 where it has none.
    #[inline(always)]
    fn embedded<L: Lane>(&self, tile: &Tile<D>, density: L) -> [L; 2] {
        let mut found = [L::splat(0.0); 2];
        for kind in 0..self.potential.kinds() {
            let here = self.of_kind::<L>(tile.first, kind);
            if let Some(own) = self.potential.own(kind)
                && here & tile.owned != 0
            {
                let other = L::dead(here);
                let both = embed(own, density);
                for n in 0..2 {
                    found[n] = L::select(other, found[n], both[n]);
                }
            }
        }
        found
    }

    /// The first of a tile's points that went through its partner at bond `k` of a chain.
    #[inline(always)]
    fn crossed<L: Lane>(&self, tile: &Tile<D>, k: usize, i: &[L; D]) -> Option<Fault> {
        let (y, _) = self.vector(tile, k, i);
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

/// Σ f
struct Densities<L>(L);

impl<L: Lane, const D: usize> Sum<L, D> for Densities<L> {
    #[inline(always)]
    fn add(&mut self, line: &impl Line<L>, _: &[L; D], q: L, _: [L; 2]) {
        self.0 = self.0 + line.density(q);
    }
}

pub(super) struct Density<'a, const D: usize, P> {
    pub view: View<'a, D, P>,
    pub slope: Shared,
}

impl<const D: usize, P: Potential> Kernel for Density<'_, D, P> {
    type Out = Option<Fault>;
    type Home = P;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Option<Fault> {
        let view = &self.view;
        let mut fault = None;
        for tile in view.tiles.block(block) {
            let density = view.density::<L>(&tile, &view.tiles.own(&tile));
            let [_, slope] = view.embedded(&tile, density);
            // SAFETY: tiles are disjoint
            unsafe {
                slope
                    .zero_if(L::dead(tile.owned))
                    .store(self.slope.at(tile.first))
            };
            for kind in 0..view.potential.kinds() {
                let here = view.of_kind::<L>(tile.first, kind) & tile.owned;
                if let Some(own) = view.potential.own(kind)
                    && fault.is_none()
                    && here != 0
                {
                    fault = density_fault(own, density, here, |l| tile.first + l);
                }
            }
        }
        fault
    }
}

pub(super) struct Forces<'a, const D: usize, P> {
    pub view: View<'a, D, P>,
    pub f: [Shared; D],
    /// 2 / volume
    pub scale: f64,
    /// The bond of a chain that must not turn over.
    pub next: Option<usize>,
}

impl<const D: usize, P: Potential> Kernel for Forces<'_, D, P> {
    type Out = Option<Fault>;
    type Home = P;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Option<Fault> {
        let view = &self.view;
        let mut fault = None;
        for tile in view.tiles.block(block) {
            let i = view.tiles.own::<L>(&tile);
            let mut force = Pulls([L::splat(0.0); D]);
            view.visit(&tile, &i, &mut force);
            let dead = L::dead(tile.owned);
            for a in 0..D {
                let f = force.0[a] * L::splat(self.scale);
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
    type Home = P;
    const SELDOM: bool = true;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 1] {
        let view = &self.view;
        let mut sum = 0.0;
        for tile in view.tiles.block(block) {
            let i = view.tiles.own::<L>(&tile);
            let mut sums = Sums::zero(false);
            view.visit(&tile, &i, &mut sums);
            let mut energy = sums.energy * L::splat(0.5);
            if P::EMBEDDED {
                let [f, _] = view.embedded(&tile, view.density(&tile, &i));
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
