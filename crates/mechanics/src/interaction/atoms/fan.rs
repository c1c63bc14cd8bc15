//! A potential of fans between atoms that are near now, in three dimensions; or that were near in the reference, held for ever.
//!
//! Each atom evaluates its own fan and says how it pulls at the ends; an atom gathers what the fans of its neighbours say of it through
//! the place of the bond that leads back, which is found when the list is made. No races, and the same bits on any number of threads
//! and any width.
//!
//! The energy of an atom is that of its own fan: `U_i`, half of each pair and the whole of each angle at it. LAMMPS's `pe/atom` gives a
//! third of an angle of Stillinger & Weber to each of its three atoms, and half of Tersoff's bond to each of its ends; who wants equal
//! shares adds up terms ([`crate::law::terms`]). Totals are the same.

mod back;
mod gather;
mod kernel;

use super::breaking::Held;
use crate::body::{Body, FieldView, FieldViewMut, Identity, Values, view};
use crate::execute::blocks::{PerBlock, Shared, run_blocks};
use crate::execute::lane::TILE;
use crate::execute::simd::{Kernel, Simd};
use crate::family::neighbours::near::{Lines, NearList, Reaches};
use crate::interaction::along;
use crate::interaction::{
    BondStatus, BondTangent, EachBond, EachTangent, Gradient, Interaction, PointEnergiesMut, Sweep,
    Tally,
};
use crate::law::fan::{Fan, tangents};
use crate::law::terms::Near;
use crate::state::Archive;
use back::{Back, Ends};
use gather::Gather;
use kernel::{Centres, View};

/// Margin of the list, in cut-offs.
const SKIN: f64 = 0.12;

/// A fan on current neighbours, or on those of the reference.
pub struct FanAtoms<F> {
    body: Identity,
    simd: Simd,
    fan: F,
    /// Horizon of the families of the reference, if these are held (length).
    held: Option<f64>,
    list: NearList<3>,
    back: Back,
    /// Kind per slot.
    kinds: Vec<u8>,
    sums: PerBlock<[f64; 7]>,
    /// Neighbours of every slot in the reference.
    family: Vec<u16>,
}

impl<F: Fan> FanAtoms<F> {
    /// Kinds are the materials of the body.
    ///
    /// # Panics
    /// If the body has more materials than the fan knows kinds.
    pub fn new(body: &Body<3>, fan: F, simd: Simd) -> Self {
        Self::made(body, fan, None, simd)
    }

    /// The same on those that are within `horizon` (length) in the reference, and nobody else, wherever they go: force states
    /// `∂U^(j)/∂x_k` of a peridynamic material (sandia2010 (4.0.122)).
    ///
    /// # Panics
    /// As [`new`](Self::new).
    pub fn of_reference(body: &Body<3>, fan: F, horizon: f64, simd: Simd) -> Self {
        Self::made(body, fan, Some(horizon), simd)
    }

    fn made(body: &Body<3>, fan: F, held: Option<f64>, simd: Simd) -> Self {
        let kinds: Vec<u8> = (0..body.len).map(|s| body.material_of(s) as u8).collect();
        let known = fan.table().kinds();
        let highest = body.slots.iter().map(|s| kinds[*s as usize]).max();
        assert!(
            highest.is_none_or(|k| usize::from(k) < known),
            "a fan of {known} kinds of atom on a body of more"
        );
        let list = list_at(
            body,
            fan.cutoff(),
            held,
            &kinds,
            view(&body.at_rest()),
            simd,
        );
        let mut made = FanAtoms {
            body: body.identity,
            simd,
            family: vec![0; body.len],
            back: Back::of(&list, simd),
            sums: PerBlock::sums(list.blocks()),
            fan,
            held,
            list,
            kinds,
        };
        let mut family = vec![0u16; body.len];
        made.each_near(&mut |slot, near, _| family[slot] = near.len() as u16);
        made.family = family;
        made
    }

    /// Positions, and after a new list the bonds that lead back.
    fn ready(&mut self, body: &Body<3>, u: FieldView<3>) {
        if self.list.update(body, u, self.simd) {
            put_kinds(&mut self.list, &self.kinds);
            self.back = Back::of(&self.list, self.simd);
        }
    }

    /// Energy and virial, and what else is asked for.
    fn centres(
        &self,
        list: &NearList<3>,
        position: &[[f64; 4]],
        ends: Option<Ends>,
        f: [Shared; 3],
        energy: Shared,
        volume: &Values,
    ) -> [f64; 7] {
        let view = View {
            list,
            position: position.as_ptr().cast(),
            fan: &self.fan,
            limit: self.fan.cutoff() * self.fan.cutoff(),
            ends,
            back: &self.back,
            f,
            energy,
            volume,
        };
        match self.fan.table().kinds() {
            1 => self.run(&Centres::<F, false>(view)),
            _ => self.run(&Centres::<F, true>(view)),
        }
    }

    fn run<K: Kernel<Out = [f64; 7]>>(&self, kernel: &K) -> [f64; 7] {
        self.sums.sum(self.simd, kernel)
    }

    /// Energy and virial alone, and energies of points where asked for.
    fn energies(
        &self,
        list: &NearList<3>,
        position: &[[f64; 4]],
        out: Shared,
        volume: &Values,
    ) -> [f64; 7] {
        self.centres(list, position, None, [Shared::NULL; 3], out, volume)
    }

    /// Energies of all points, of a list as it is.
    fn see(
        &self,
        body: &Body<3>,
        list: &NearList<3>,
        position: &[[f64; 4]],
        out: &mut PointEnergiesMut,
    ) {
        out.zeros(body.len);
        let strain = Shared(out.strain.as_mut_ptr());
        self.energies(list, position, strain, &body.volume);
    }

    /// Every slot with its neighbours within the cut-off now, and their slots.
    fn each_near(&self, visit: &mut dyn FnMut(usize, &[Near], &[usize])) {
        let at = self.list.positions();
        let limit = self.fan.cutoff() * self.fan.cutoff();
        let (mut near, mut slots) = (vec![], vec![]);
        for (t, lines) in (0..self.list.blocks()).flat_map(|b| self.list.tiles(b)) {
            for (l, &slot) in self.list.slots(t).iter().enumerate() {
                near.clear();
                slots.clear();
                let x = at[t * TILE + l];
                for line in lines {
                    let z = at[line[l] as usize];
                    let y: [f64; 3] = crate::array::from_fn(|a| z[a] - x[a]);
                    let square = y.iter().map(|c| c * c).sum::<f64>();
                    let j = self.list.original(line[l] as usize);
                    if let Some(j) = j.filter(|_| square < limit) {
                        let kind = u32::from(self.kinds[j]);
                        near.push(Near { kind, y });
                        slots.push(j);
                    }
                }
                visit(slot as usize, &near, &slots);
            }
        }
    }
}

/// A list for the displacements `u`, with kinds; held where there is a horizon.
fn list_at(
    body: &Body<3>,
    cutoff: f64,
    held: Option<f64>,
    kinds: &[u8],
    u: FieldView<3>,
    simd: Simd,
) -> NearList<3> {
    let mut list = match held {
        Some(horizon) => {
            let reaches = Reaches::new(1, |_, _| horizon);
            NearList::of_reference(body, reaches, Lines::ByKind)
        }
        None => NearList::new(body, cutoff, SKIN * cutoff),
    };
    list.update(body, u, simd);
    put_kinds(&mut list, kinds);
    list
}

/// Kinds into the fourth numbers of all atoms.
fn put_kinds(list: &mut NearList<3>, kinds: &[u8]) {
    let of: Vec<f64> = (0..list.positions().len())
        .map(|n| list.original(n).map_or(0.0, |s| f64::from(kinds[s])))
        .collect();
    for (x, kind) in list.positions_mut().iter_mut().zip(of) {
        x[3] = kind;
    }
}

impl<F: Fan> Held<3> for FanAtoms<F> {
    fn list(&self) -> &NearList<3> {
        &self.list
    }

    fn list_mut(&mut self) -> &mut NearList<3> {
        &mut self.list
    }

    fn pulls(&self, first: &[u32], out: &mut [[f64; 3]]) {
        for (tile, first) in first.iter().enumerate() {
            let lines = self.list.lines(tile).len();
            let place = self.back.place(tile);
            let out = &mut out[*first as usize * TILE..][..lines * TILE];
            for (n, out) in out.iter_mut().enumerate() {
                *out = self.back.pull(place + n);
            }
        }
    }
}

impl<F: Fan> Interaction<3> for FanAtoms<F> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        match self.held {
            Some(_) => "reference",
            None => "neighbours",
        }
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<3>,
        u: FieldView<3>,
        f: FieldViewMut<3>,
        _: Sweep<3>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        self.ready(body, u);
        let energy = match seen {
            Some(seen) => {
                seen.zeros(body.len);
                Shared(seen.strain.as_mut_ptr())
            }
            None => Shared::NULL,
        };
        let f: [Shared; 3] = crate::array::from_fn(|a| Shared(f[a].as_mut_ptr()));
        let ends = self.back.ends();
        let (list, volume) = (&self.list, &body.volume);
        self.centres(list, list.positions(), Some(ends), f, energy, volume);
        let gather = Gather {
            list,
            back: &self.back,
            f,
            volume,
        };
        run_blocks(self.simd, &gather, list.blocks());
        Tally::default()
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<3>, u: FieldView<3>) -> [f64; 2] {
        self.ready(body, u);
        let list = &self.list;
        let sums = self.energies(list, list.positions(), Shared::NULL, &body.volume);
        [sums[0], 0.0]
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<3>,
        u: FieldView<3>,
        out: &mut PointEnergiesMut,
    ) {
        if let Some(position) = self.list.positions_at(u, self.simd) {
            self.see(body, &self.list, &position, out);
        } else {
            let cutoff = self.fan.cutoff();
            let list = list_at(body, cutoff, self.held, &self.kinds, u, self.simd);
            self.see(body, &list, list.positions(), out);
        }
    }

    fn observe_gradient(&self, body: &Body<3>, gradient: &Gradient<3>, out: &mut PointEnergiesMut) {
        self.check(body, &[]);
        let rest = body.at_rest();
        let strain = |mut position: Vec<[f64; 4]>| {
            for x in &mut position {
                let moved = along(gradient, &x[..3]);
                for a in 0..3 {
                    x[a] += moved[a];
                }
            }
            position
        };
        // of a list that is held some may have been taken out
        let held = self
            .held
            .and(self.list.positions_at(view(&rest), self.simd));
        if let Some(position) = held {
            self.see(body, &self.list, &strain(position), out);
        } else {
            let cutoff = self.fan.cutoff();
            let list = list_at(body, cutoff, self.held, &self.kinds, view(&rest), self.simd);
            self.see(body, &list, &strain(list.positions().to_vec()), out);
        }
    }

    fn is_potential(&self) -> bool {
        true
    }

    fn has_fans(&self) -> bool {
        true
    }

    /// Pairs of the same fan as well as bonds: forces are central between them.
    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<3>,
        u: FieldView<3>,
        visit: &mut EachTangent<3>,
    ) {
        self.ready(body, u);
        let mut all: Vec<BondTangent<3>> = vec![];
        self.each_near(&mut |slot, near, slots| {
            let of = |n: u32| match n {
                0 => slot,
                n => slots[n as usize - 1],
            };
            let kind = u32::from(self.kinds[slot]);
            tangents(&self.fan, kind, near, &mut |pair| {
                let ends = [pair.a, pair.b].map(of);
                all.extend(BondTangent::both(body, ends, &pair));
            });
        });
        // in order of slots; what several fans say of a pair stays apart
        all.sort_by_key(|bond| (bond.i, bond.j));
        all.into_iter().for_each(visit);
    }

    /// Pairs of the current list that are within the cut-off now.
    fn each_bond(&self, _: &Body<3>, visit: &mut EachBond<3>) {
        self.each_near(&mut |slot, near, slots| {
            for (near, &j) in near.iter().zip(slots) {
                if slot < j {
                    visit(slot, j, near.y, BondStatus::Whole);
                }
            }
        });
    }

    fn virial(&mut self, body: &Body<3>, u: FieldView<3>) -> Option<[f64; 6]> {
        self.check(body, &[u]);
        self.ready(body, u);
        let list = &self.list;
        let sums = self.energies(list, list.positions(), Shared::NULL, &body.volume);
        Some(crate::array::from_fn(|n| sums[n + 1]))
    }

    fn directed_bonds(&self) -> u64 {
        self.family.iter().map(|n| *n as u64).sum()
    }

    fn family_size(&self, _: &Body<3>, slot: usize) -> usize {
        self.family[slot] as usize
    }

    fn archive(&mut self, body: &Body<3>, archive: &mut Archive<'_>) {
        self.list.archive(body, self.simd, archive);
        if archive.loads() {
            self.back = Back::of(&self.list, self.simd);
        }
    }

    fn bytes(&self) -> usize {
        self.list.bytes() + self.back.bytes() + self.kinds.len() + 2 * self.family.len()
    }
}
