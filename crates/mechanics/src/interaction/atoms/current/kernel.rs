//! The sweeps over current neighbours: lanes run over the atoms of a tile. Of several kinds, all pairs of a line are of one pair of
//! kinds, so that their potential is the same; or, where potentials differ in constants alone, each lane has its own.

use crate::body::Values;
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::family::neighbours::near::{NearList, Tile};
use crate::interaction::Fault;
use crate::interaction::atoms::line::{Alike, Line, Mixed, Pulls, Sum, Sums, Table};
use crate::interaction::atoms::{Places, density_fault, embed};
use crate::law::number::Dual;
use crate::law::potential::Potential;
use crate::law::potential::mixture::{FEW, Mixture};

pub(super) struct View<'a, const D: usize, P> {
    pub list: &'a NearList<D>,
    /// `[atoms][4]`
    pub position: *const f64,
    pub potential: &'a Mixture<P>,
    /// Squared lengths, `[i][j]` of kinds.
    pub limits: &'a [f64],
    /// Where lines are mixed: constants of pairs of kinds, and the potential of any.
    pub mixed: Option<(&'a Table, &'a P)>,
}

// SAFETY: the pointer is into the list that the view borrows
unsafe impl<const D: usize, P: Sync> Sync for View<'_, D, P> {}

impl<'a, const D: usize, P: Potential> View<'a, D, P> {
    /// Positions and fourth numbers of a tile.
    #[inline(always)]
    fn here<L: Lane>(&self, tile: usize) -> [L; 4] {
        let first = (tile * TILE) as u32;
        let mut index = [first; TILE];
        for (l, i) in index.iter_mut().enumerate() {
            *i += l as u32;
        }
        // SAFETY: there are whole tiles of positions
        unsafe { L::gather4(self.position, index.as_ptr()) }
    }

    /// Vectors to a line of neighbours, their squares, and their fourth numbers.
    #[inline(always)]
    fn vector<L: Lane>(&self, line: &[u32; TILE], i: &[L; 4]) -> ([L; D], L, L) {
        // SAFETY: listed atoms have positions
        let j = unsafe { L::gather4(self.position, line.as_ptr()) };
        let mut y = [L::splat(0.0); D];
        let mut q = L::splat(0.0);
        for a in 0..D {
            y[a] = j[a] - i[a];
            q = y[a].fma(y[a], q);
        }
        (y, q, j[3])
    }

    /// Σ f of a tile.
    #[inline(always)]
    fn density<L: Lane>(&self, tile: &Tile<'a>, i: &[L; 4]) -> L {
        let mut density = L::splat(0.0);
        let kinds = self.potential.kinds();
        for kind in 0..kinds {
            let Some(potential) = self.potential.of(tile.kind, kind) else {
                continue;
            };
            let limit = L::splat(self.limits[tile.kind * kinds + kind]);
            for line in tile.of_kind(kind) {
                let (_, q, _) = self.vector(line, i);
                let f = potential.density(Dual::variable(q)).value;
                density = density + f.zero_if(q.ge(limit));
            }
        }
        density
    }

    /// Adds what all pairs of a tile say.
    #[inline(always)]
    fn visit<L: Lane>(&self, tile: &Tile<'a>, i: &[L; 4], sum: &mut impl Sum<L, D>) {
        if P::CONSTANTS > 0
            && let Some((table, any)) = self.mixed
        {
            let lines = tile.lines();
            match table.kinds() {
                2 => self.add(lines, &Mixed::<P, L, 2>::new(any, table, i[3]), i, sum),
                _ => self.add(lines, &Mixed::<P, L, FEW>::new(any, table, i[3]), i, sum),
            }
            return;
        }
        let kinds = self.potential.kinds();
        for kind in 0..kinds {
            let Some(potential) = self.potential.of(tile.kind, kind) else {
                continue;
            };
            let (lines, limit) = (tile.of_kind(kind), self.limits[tile.kind * kinds + kind]);
            if P::EMBEDDED && tile.kind != kind {
                self.add(lines, &Alike::<P, true> { potential, limit }, i, sum);
            } else {
                self.add(lines, &Alike::<P, false> { potential, limit }, i, sum);
            }
        }
    }

    #[inline(always)]
    fn add<L: Lane>(
        &self,
        lines: &[[u32; TILE]],
        says: &impl Line<L>,
        i: &[L; 4],
        sum: &mut impl Sum<L, D>,
    ) {
        for line in lines {
            let (y, q, other) = self.vector(line, i);
            sum.add(says, &y, q, [i[3], other]);
        }
    }
}

pub(super) struct Density<'a, const D: usize, P> {
    pub view: View<'a, D, P>,
    /// `[atoms][4]`: F′ goes to the fourth place of own atoms.
    pub slope: Shared,
}

impl<const D: usize, P: Potential> Kernel for Density<'_, D, P> {
    type Out = Option<Fault>;
    type Home = P;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Option<Fault> {
        let view = &self.view;
        let mut fault = None;
        for tile in view.list.tiles_of_kinds(block) {
            let t = tile.number;
            let slots = view.list.slots(t);
            let Some(own) = view.potential.own(tile.kind) else {
                for l in 0..slots.len() {
                    // SAFETY: as below
                    unsafe { *self.slope.at(4 * (t * TILE + l) + 3) = 0.0 };
                }
                continue;
            };
            let density = view.density::<L>(&tile, &view.here(t));
            let [_, slope] = embed(own, density);
            for (l, slope) in slope.to_array().iter().enumerate().take(slots.len()) {
                // SAFETY: tiles are disjoint, and no pass reads these places now
                unsafe { *self.slope.at(4 * (t * TILE + l) + 3) = *slope };
            }
            let owned = ((1u32 << slots.len()) - 1) as u8;
            if fault.is_none() {
                fault = density_fault(own, density, owned, |l| slots[l] as usize);
            }
        }
        fault
    }
}

pub(super) struct Forces<'a, const D: usize, P> {
    pub view: View<'a, D, P>,
    pub f: [Shared; D],
    pub volume: &'a Values,
}

impl<const D: usize, P: Potential> Kernel for Forces<'_, D, P> {
    type Out = ();
    type Home = P;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let view = &self.view;
        for tile in view.list.tiles_of_kinds(block) {
            let i = view.here::<L>(tile.number);
            let mut force = Pulls([L::splat(0.0); D]);
            view.visit(&tile, &i, &mut force);
            for a in 0..D {
                let f = force.0[a].to_array();
                for (f, &slot) in f.iter().zip(view.list.slots(tile.number)) {
                    let scale = 2.0 / self.volume.at(slot as usize);
                    // SAFETY: every slot belongs to one atom
                    unsafe { *self.f[a].at(slot as usize) = scale * f };
                }
            }
        }
    }
}

pub(super) struct Energies<'a, const D: usize, P> {
    pub view: View<'a, D, P>,
    pub said: Places,
}

impl<const D: usize, P: Potential> Kernel for Energies<'_, D, P> {
    type Out = ();
    type Home = P;
    const SELDOM: bool = true;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let view = &self.view;
        for tile in view.list.tiles_of_kinds(block) {
            let i = view.here::<L>(tile.number);
            let mut sums = Sums::zero(self.said.asks_virial());
            view.visit(&tile, &i, &mut sums);
            let Sums {
                mut energy, virial, ..
            } = sums;
            energy = energy * L::splat(0.5);
            if P::EMBEDDED
                && let Some(own) = view.potential.own(tile.kind)
            {
                let [f, _] = embed(own, view.density(&tile, &i));
                energy = energy + f;
            }
            let slots = view.list.slots(tile.number);
            // SAFETY: every slot belongs to one atom
            unsafe { self.said.put(slots, energy, virial, -1.0) };
        }
    }
}
