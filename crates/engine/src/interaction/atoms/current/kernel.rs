//! The sweeps over current neighbours: lanes run over the atoms of a tile.

use crate::body::Values;
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::family::neighbours::near::NearList;
use crate::interaction::atoms::{density_fault, embed};
use crate::interaction::{Fault, VIRIAL};
use crate::law::number::Dual;
use crate::law::potential::Potential;

pub(super) struct View<'a, const D: usize, P> {
    pub list: &'a NearList<D>,
    /// `[atoms][4]`
    pub position: *const f64,
    pub potential: &'a P,
    /// Squared length.
    pub limit: f64,
}

// SAFETY: the pointer is into the list that the view borrows
unsafe impl<const D: usize, P: Sync> Sync for View<'_, D, P> {}

impl<const D: usize, P: Potential> View<'_, D, P> {
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
    fn density<L: Lane>(&self, lines: &[[u32; TILE]], i: &[L; 4]) -> L {
        let mut density = L::splat(0.0);
        for line in lines {
            let (_, q, _) = self.vector(line, i);
            let f = self.potential.density(Dual::variable(q)).value;
            density = density + f.zero_if(q.ge(L::splat(self.limit)));
        }
        density
    }

    /// `dφ/dq + (F′_i + F′_j) df/dq`, 0 beyond the cut-off.
    #[inline(always)]
    fn pull<L: Lane>(&self, q: L, slopes: L) -> L {
        let pull = if P::EMBEDDED {
            let [pair, density] = self.potential.both(Dual::variable(q));
            density.slope.fma(slopes, pair.slope)
        } else {
            self.potential.pair(Dual::variable(q)).slope
        };
        pull.zero_if(q.ge(L::splat(self.limit)))
    }
}

pub(super) struct Density<'a, const D: usize, P> {
    pub view: View<'a, D, P>,
    /// `[atoms][4]`: F′ goes to the fourth place of own atoms.
    pub slope: Shared,
}

impl<const D: usize, P: Potential> Kernel for Density<'_, D, P> {
    type Out = Option<Fault>;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Option<Fault> {
        let view = &self.view;
        let mut fault = None;
        for (t, lines) in view.list.tiles(block) {
            let density = view.density::<L>(lines, &view.here(t));
            let [_, slope] = embed(view.potential, density);
            let slots = view.list.slots(t);
            for (l, slope) in slope.to_array().iter().enumerate().take(slots.len()) {
                // SAFETY: tiles are disjoint, and no pass reads these places now
                unsafe { *self.slope.at(4 * (t * TILE + l) + 3) = *slope };
            }
            let owned = ((1u32 << slots.len()) - 1) as u8;
            if fault.is_none() {
                fault = density_fault(view.potential, density, owned, |l| slots[l] as usize);
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
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let view = &self.view;
        for (t, lines) in view.list.tiles(block) {
            let i = view.here::<L>(t);
            let mut force = [L::splat(0.0); D];
            for line in lines {
                let (y, q, other) = view.vector(line, &i);
                let pull = view.pull(q, i[3] + other);
                for a in 0..D {
                    force[a] = pull.fma(y[a], force[a]);
                }
            }
            for a in 0..D {
                let f = force[a].to_array();
                for (f, &slot) in f.iter().zip(view.list.slots(t)) {
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
    pub virial: bool,
    /// Energy density per slot, if asked for.
    pub out: Shared,
    pub volume: &'a Values,
}

impl<const D: usize, P: Potential> Kernel for Energies<'_, D, P> {
    /// Energy and, where asked for, virial.
    type Out = [f64; 7];
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 7] {
        let view = &self.view;
        let mut sum = [0.0; 7];
        for (t, lines) in view.list.tiles(block) {
            let i = view.here::<L>(t);
            let mut energy = L::splat(0.0);
            let mut virial = [L::splat(0.0); 6];
            for line in lines {
                let (y, q, other) = view.vector(line, &i);
                let pair = view.potential.pair(Dual::variable(q)).value;
                energy = energy + pair.zero_if(q.ge(L::splat(view.limit)));
                if !self.virial {
                    continue;
                }
                let pull = view.pull(q, i[3] + other);
                for (v, (m, n)) in virial.iter_mut().zip(VIRIAL) {
                    if n < D {
                        *v = (pull * y[m]).fma(y[n], *v);
                    }
                }
            }
            energy = energy * L::splat(0.5);
            if P::EMBEDDED {
                let [f, _] = embed(view.potential, view.density(lines, &i));
                energy = energy + f;
            }
            let slots = view.list.slots(t);
            for (e, &slot) in energy.to_array().iter().zip(slots) {
                if !self.out.0.is_null() {
                    let slot = slot as usize;
                    // SAFETY: every slot belongs to one atom
                    unsafe { *self.out.at(slot) = e / self.volume.at(slot) };
                }
                sum[0] += e;
            }
            for (sum, v) in sum[1..].iter_mut().zip(virial) {
                *sum -= v.to_array()[..slots.len()].iter().sum::<f64>();
            }
        }
        sum
    }
}
