//! The sweeps over current neighbours: lanes run over the atoms of a tile. Of several kinds, all pairs of a line are of one pair of
//! kinds, so that their potential is the same.

use crate::body::Values;
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::family::neighbours::near::{NearList, Tile};
use crate::interaction::atoms::{density_fault, embed};
use crate::interaction::{Fault, VIRIAL};
use crate::law::number::Dual;
use crate::law::potential::Potential;
use crate::law::potential::mixture::Mixture;

pub(super) struct View<'a, const D: usize, P> {
    pub list: &'a NearList<D>,
    /// `[atoms][4]`
    pub position: *const f64,
    pub potential: &'a Mixture<P>,
    /// Squared lengths, `[i][j]` of kinds.
    pub limits: &'a [f64],
}

/// What a tile has with its neighbours of a kind.
struct Pair<'a, P> {
    potential: &'a P,
    /// Squared length.
    limit: f64,
    lines: &'a [[u32; TILE]],
    unlike: bool,
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

    /// With neighbours of a kind; `None`: nothing.
    #[inline(always)]
    fn pair(&self, tile: &Tile<'a>, kind: usize) -> Option<Pair<'a, P>> {
        let kinds = self.potential.kinds();
        Some(Pair {
            potential: self.potential.of(tile.kind, kind)?,
            limit: self.limits[tile.kind * kinds + kind],
            lines: tile.of_kind(kind),
            unlike: tile.kind != kind,
        })
    }

    /// Σ f of a tile.
    #[inline(always)]
    fn density<L: Lane>(&self, tile: &Tile<'a>, i: &[L; 4]) -> L {
        let mut density = L::splat(0.0);
        for kind in 0..self.potential.kinds() {
            let Some(pair) = self.pair(tile, kind) else {
                continue;
            };
            for line in pair.lines {
                let (_, q, _) = self.vector(line, i);
                let f = pair.potential.density(Dual::variable(q)).value;
                density = density + f.zero_if(q.ge(L::splat(pair.limit)));
            }
        }
        density
    }

    /// Adds the forces of neighbours of a kind.
    #[inline(always)]
    fn pulls<const UNLIKE: bool, L: Lane>(
        &self,
        pair: &Pair<'a, P>,
        i: &[L; 4],
        force: &mut [L; D],
    ) {
        for line in pair.lines {
            let (y, q, other) = self.vector(line, i);
            let pull = pair.pull::<UNLIKE, L>(q, i[3], other);
            for a in 0..D {
                force[a] = pull.fma(y[a], force[a]);
            }
        }
    }
}

impl<P: Potential> Pair<'_, P> {
    /// `dφ/dq + (F′_i + F′_j) df/dq`, of unlike atoms `dφ/dq + F′_i df_ij/dq + F′_j df_ji/dq`; 0 beyond the cut-off.
    #[inline(always)]
    fn pull<const UNLIKE: bool, L: Lane>(&self, q: L, own: L, other: L) -> L {
        let at = Dual::variable(q);
        let pull = if P::EMBEDDED {
            let [pair, density] = self.potential.both(at);
            if UNLIKE {
                let given = self.potential.given(at).slope;
                given.fma(other, density.slope.fma(own, pair.slope))
            } else {
                density.slope.fma(own + other, pair.slope)
            }
        } else {
            self.potential.pair(at).slope
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
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let view = &self.view;
        for tile in view.list.tiles_of_kinds(block) {
            let i = view.here::<L>(tile.number);
            let mut force = [L::splat(0.0); D];
            for kind in 0..view.potential.kinds() {
                let Some(pair) = view.pair(&tile, kind) else {
                    continue;
                };
                if P::EMBEDDED && pair.unlike {
                    view.pulls::<true, L>(&pair, &i, &mut force);
                } else {
                    view.pulls::<false, L>(&pair, &i, &mut force);
                }
            }
            for a in 0..D {
                let f = force[a].to_array();
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
        for tile in view.list.tiles_of_kinds(block) {
            let i = view.here::<L>(tile.number);
            let mut energy = L::splat(0.0);
            let mut virial = [L::splat(0.0); 6];
            for kind in 0..view.potential.kinds() {
                let Some(pair) = view.pair(&tile, kind) else {
                    continue;
                };
                for line in pair.lines {
                    let (y, q, other) = view.vector(line, &i);
                    let phi = pair.potential.pair(Dual::variable(q)).value;
                    energy = energy + phi.zero_if(q.ge(L::splat(pair.limit)));
                    if !self.virial {
                        continue;
                    }
                    let pull = match pair.unlike {
                        true => pair.pull::<true, L>(q, i[3], other),
                        false => pair.pull::<false, L>(q, i[3], other),
                    };
                    for (v, (m, n)) in virial.iter_mut().zip(VIRIAL) {
                        if n < D {
                            *v = (pull * y[m]).fma(y[n], *v);
                        }
                    }
                }
            }
            energy = energy * L::splat(0.5);
            if P::EMBEDDED
                && let Some(own) = view.potential.own(tile.kind)
            {
                let [f, _] = embed(own, view.density(&tile, &i));
                energy = energy + f;
            }
            let slots = view.list.slots(tile.number);
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
