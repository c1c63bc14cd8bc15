//! A potential between atoms that are near now: molecular dynamics.

use super::{Faults, bad_density, embed, find_fault};
use crate::body::{Body, Field, Identity, Values};
use crate::execute::blocks::{PerBlock, Shared, run_blocks};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::{Kernel, Simd};
use crate::family::neighbours::near::NearList;
use crate::interaction::along;
use crate::interaction::tangent::curvature;
use crate::interaction::{
    BondForce, BondState, BondTangent, Fault, Interaction, PointEnergies, Sweep, Tally,
};
use crate::law::number::Dual;
use crate::law::potential::Potential;

/// Margin of the list, in cut-offs.
const SKIN: f64 = 0.12;

/// A potential on current neighbours.
pub struct CurrentAtoms<const D: usize, P> {
    body: Identity,
    simd: Simd,
    potential: P,
    cutoff: f64,
    list: NearList<D>,
    faults: Faults,
    sums: PerBlock<[f64; 7]>,
    /// Neighbours of every slot in the reference.
    family: Vec<u16>,
    /// F″ per slot, of the last tangent.
    curvature: Vec<f64>,
}

impl<const D: usize, P: Potential> CurrentAtoms<D, P> {
    pub fn new(body: &Body<D>, potential: P, simd: Simd) -> Self {
        let cutoff = potential.cutoff();
        let list = list_at(body, cutoff, &body.at_rest(), simd);
        let mut family = vec![0; body.len];
        let blocks = list.blocks();
        let at = list.positions();
        for (t, lines) in (0..blocks).flat_map(|b| list.tiles(b)) {
            for (l, &slot) in list.slots(t).iter().enumerate() {
                let x = at[t * TILE + l];
                let near = |j: u32| -> bool {
                    let y = at[j as usize];
                    (0..D).map(|a| (y[a] - x[a]).powi(2)).sum::<f64>() < cutoff * cutoff
                };
                let count = lines.iter().filter(|line| near(line[l])).count();
                family[slot as usize] = count.min(u16::MAX as usize) as u16;
            }
        }
        CurrentAtoms {
            body: body.identity,
            simd,
            potential,
            cutoff,
            list,
            faults: PerBlock::new(blocks, None),
            sums: PerBlock::sums(blocks),
            family,
            curvature: vec![],
        }
    }

    /// Positions and, with embedding, F′ in their fourth place.
    fn ready(&mut self, body: &Body<D>, u: &Field<D>) -> Tally {
        self.list.update(body, u, self.simd);
        if !P::EMBEDDED {
            return Tally::default();
        }
        let position = self.list.positions_mut().as_mut_ptr();
        let kernel = Density {
            view: self.view(&self.list, position),
            slope: Shared(position.cast()),
        };
        let tally = find_fault(&self.faults, self.simd, &kernel);
        self.list.copy_to_ghosts();
        tally
    }

    /// `position` points to those of all that `list` knows.
    fn view<'a>(&'a self, list: &'a NearList<D>, position: *const [f64; 4]) -> View<'a, D, P> {
        View {
            list,
            position: position.cast(),
            potential: &self.potential,
            limit: self.cutoff * self.cutoff,
        }
    }

    /// Energy, the virial where asked for (of [ready](Self::ready) positions), and energies per slot where asked for.
    fn sums(
        &self,
        virial: bool,
        list: &NearList<D>,
        position: &[[f64; 4]],
        out: Shared,
        volume: &Values,
    ) -> [f64; 7] {
        let kernel = Energies {
            virial,
            view: self.view(list, position.as_ptr()),
            out,
            volume,
        };
        self.sums.sum(self.simd, &kernel)
    }

    /// Energies of all points, of the list as it is.
    fn see(
        &self,
        body: &Body<D>,
        list: &NearList<D>,
        position: &[[f64; 4]],
        out: &mut PointEnergies,
    ) {
        out.zeros(body.len);
        let strain = Shared(out.strain.as_mut_ptr());
        self.sums(false, list, position, strain, &body.volume);
    }
}

/// A list for the displacements `u`.
fn list_at<const D: usize>(body: &Body<D>, cutoff: f64, u: &Field<D>, simd: Simd) -> NearList<D> {
    let mut list = NearList::new(body, cutoff, SKIN * cutoff);
    list.update(body, u, simd);
    list
}

struct View<'a, const D: usize, P> {
    list: &'a NearList<D>,
    /// `[atoms][4]`
    position: *const f64,
    potential: &'a P,
    /// Squared length.
    limit: f64,
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

struct Density<'a, const D: usize, P> {
    view: View<'a, D, P>,
    /// `[atoms][4]`: F′ goes to the fourth place of own atoms.
    slope: Shared,
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
            if fault.is_none()
                && let Some((l, density)) = bad_density(view.potential, density.to_array(), owned)
            {
                fault = Some(Fault::Density {
                    slot: slots[l] as usize,
                    density,
                });
            }
        }
        fault
    }
}

struct Forces<'a, const D: usize, P> {
    view: View<'a, D, P>,
    f: [Shared; D],
    volume: &'a Values,
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

struct Energies<'a, const D: usize, P> {
    view: View<'a, D, P>,
    virial: bool,
    /// Energy density per slot, if asked for.
    out: Shared,
    volume: &'a Values,
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
                for (v, (m, n)) in virial.iter_mut().zip(crate::interaction::VIRIAL) {
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

impl<const D: usize, P: Potential> Interaction<D> for CurrentAtoms<D, P> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        "neighbours"
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        f: &mut Field<D>,
        _: Sweep<D>,
        seen: Option<&mut PointEnergies>,
    ) -> Tally {
        let tally = self.ready(body, u);
        if let Some(seen) = seen {
            self.see(body, &self.list, self.list.positions(), seen);
        }
        let kernel = Forces {
            view: self.view(&self.list, self.list.positions().as_ptr()),
            f: std::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            volume: &body.volume,
        };
        run_blocks(self.simd, &kernel, self.list.blocks());
        tally
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: &Field<D>) -> [f64; 2] {
        self.list.update(body, u, self.simd);
        let list = &self.list;
        let sums = self.sums(false, list, list.positions(), Shared::NULL, &body.volume);
        [sums[0], 0.0]
    }

    unsafe fn observe_unchecked(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies) {
        if let Some(position) = self.list.positions_at(u, self.simd) {
            self.see(body, &self.list, &position, out);
        } else {
            let list = list_at(body, self.cutoff, u, self.simd);
            self.see(body, &list, list.positions(), out);
        }
    }

    fn observe_gradient(&self, body: &Body<D>, gradient: &[[f64; D]; D], out: &mut PointEnergies) {
        self.check(body, &[]);
        let list = list_at(body, self.cutoff, &body.at_rest(), self.simd);
        let mut position = list.positions().to_vec();
        // what is nowhere stays there
        for x in position.iter_mut().filter(|x| x[0].is_finite()) {
            let moved = along(gradient, &x[..D]);
            for a in 0..D {
                x[a] += moved[a];
            }
        }
        self.see(body, &list, &position, out);
    }

    fn each_force(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        visit: &mut dyn FnMut(BondForce<D>),
    ) -> bool {
        self.tangents(body, u, &mut |bond| visit(bond.force()));
        true
    }

    fn is_potential(&self) -> bool {
        true
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        self.ready(body, u);
        let at = self.list.positions();
        let mut density = vec![0.0; if P::EMBEDDED { body.len } else { 0 }];
        for (t, lines) in (0..self.list.blocks()).flat_map(|b| self.list.tiles(b)) {
            for (l, &slot) in self.list.slots(t).iter().enumerate() {
                let i = slot as usize;
                let x = at[t * TILE + l];
                for line in lines {
                    let z = at[line[l] as usize];
                    let y: [f64; D] = std::array::from_fn(|a| z[a] - x[a]);
                    let q: f64 = y.iter().map(|c| c * c).sum();
                    let Some(j) = self.list.original(line[l] as usize) else {
                        continue;
                    };
                    if q >= self.cutoff * self.cutoff {
                        continue;
                    }
                    if P::EMBEDDED {
                        density[i] += self.potential.density(q);
                    }
                    visit(BondTangent::of_potential(
                        &self.potential,
                        [i, j],
                        y,
                        if P::EMBEDDED { x[3] + z[3] } else { 0.0 },
                        2.0 / body.volume.at(i),
                    ));
                }
            }
        }
        self.curvature = density
            .iter()
            .map(|d| curvature(&self.potential, *d))
            .collect();
    }

    fn gain(&self, slot: usize) -> f64 {
        self.curvature.get(slot).copied().unwrap_or(0.0)
    }

    /// Pairs of the current list that are within the cut-off now.
    fn each_bond(&self, _: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D], BondState)) {
        let at = self.list.positions();
        for (t, lines) in (0..self.list.blocks()).flat_map(|b| self.list.tiles(b)) {
            for line in lines {
                for (l, &slot) in self.list.slots(t).iter().enumerate() {
                    let (x, y) = (at[t * TILE + l], at[line[l] as usize]);
                    let xi: [f64; D] = std::array::from_fn(|a| y[a] - x[a]);
                    let near = xi.iter().map(|c| c * c).sum::<f64>() < self.cutoff * self.cutoff;
                    if let Some(j) = self.list.original(line[l] as usize)
                        && near
                        && (slot as usize) < j
                    {
                        visit(slot as usize, j, xi, BondState::Whole);
                    }
                }
            }
        }
    }

    fn virial(&mut self, body: &Body<D>, u: &Field<D>) -> Option<[f64; 6]> {
        self.check(body, &[u]);
        self.ready(body, u);
        let list = &self.list;
        let sums = self.sums(true, list, list.positions(), Shared::NULL, &body.volume);
        Some(std::array::from_fn(|n| sums[n + 1]))
    }

    fn directed_bonds(&self) -> u64 {
        self.family.iter().map(|n| *n as u64).sum()
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        self.family[slot] as usize
    }

    fn bytes(&self) -> usize {
        self.list.bytes() + 2 * self.family.len()
    }
}
