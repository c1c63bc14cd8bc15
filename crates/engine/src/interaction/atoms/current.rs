//! A potential between atoms that are near now: molecular dynamics.

mod kernel;

use super::{Curvatures, Faults, find_fault};
use crate::body::{Body, Field, Identity, Values};
use crate::execute::blocks::{PerBlock, Shared, run_blocks};
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::family::neighbours::near::NearList;
use crate::interaction::along;
use crate::interaction::{
    BondForce, BondState, BondTangent, Interaction, PointEnergies, Sweep, Tally,
};
use crate::law::potential::Potential;
use kernel::{Density, Energies, Forces, View};

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
    curvatures: Curvatures,
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
            curvatures: Curvatures::default(),
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
        self.curvatures = Curvatures::of(&self.potential, &density);
    }

    fn gain(&self, slot: usize) -> f64 {
        self.curvatures.at(slot)
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
