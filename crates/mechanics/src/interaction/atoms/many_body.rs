//! A many-body potential between atoms that are near now, in three dimensions; or that were near in the reference, held for ever.
//!
//! Each atom evaluates its own many-body energy and says how it pulls at the ends; an atom gathers what the fans of its neighbours say of it through
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
use super::{Places, Said};
use crate::body::{Body, FieldView, FieldViewMut, Identity, Values, view};
use crate::execute::blocks::{Shared, run_blocks};
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::family::neighbours::near::{Lines, NearList, Reaches};
use crate::interaction::along;
use crate::interaction::{
    BondStatus, BondTangent, EachBond, EachTangent, Gradient, Interaction, PointEnergiesMut, Sweep,
    Tally,
};
use crate::law::many_body::{ManyBody, tangents};
use crate::law::terms::Near;
use crate::state::Archive;
use back::{Back, Ends};
use gather::Gather;
use kernel::{Centres, View};

/// Margin of the list, in cut-offs.
const SKIN: f64 = 0.12;

/// A fan on current neighbours, or on those of the reference.
pub struct ManyBodyAtoms<F> {
    body: Identity,
    simd: Simd,
    many_body: F,
    /// Horizon of the families of the reference, if these are held (length).
    held: Option<f64>,
    list: NearList<3>,
    back: Back,
    /// Kind per slot.
    kinds: Vec<u8>,
    /// Neighbours of every slot in the reference.
    family: Vec<u16>,
}

impl<F: ManyBody> ManyBodyAtoms<F> {
    /// Kinds are the materials of the body.
    ///
    /// # Panics
    /// If the body has more materials than the fan knows kinds.
    pub fn new(body: &Body<3>, many_body: F, simd: Simd) -> Self {
        Self::made(body, many_body, None, simd)
    }

    /// The same on those that are within `horizon` (length) in the reference, and nobody else, wherever they go: force states
    /// `∂U^(j)/∂x_k` of a peridynamic material (sandia2010 (4.0.122)).
    ///
    /// # Panics
    /// As [`new`](Self::new).
    pub fn of_reference(body: &Body<3>, many_body: F, horizon: f64, simd: Simd) -> Self {
        Self::made(body, many_body, Some(horizon), simd)
    }

    fn made(body: &Body<3>, many_body: F, held: Option<f64>, simd: Simd) -> Self {
        let kinds: Vec<u8> = (0..body.len).map(|s| body.material_of(s) as u8).collect();
        let known = many_body.table().kinds();
        let highest = body.slots.iter().map(|s| kinds[*s as usize]).max();
        assert!(
            highest.is_none_or(|k| usize::from(k) < known),
            "a fan of {known} kinds of atom on a body of more"
        );
        let list = list_at(
            body,
            many_body.cutoff(),
            held,
            &kinds,
            view(&body.at_rest()),
            simd,
        );
        let mut made = ManyBodyAtoms {
            body: body.identity,
            simd,
            family: vec![0; body.len],
            back: Back::of(&list, simd),
            many_body,
            held,
            list,
            kinds,
        };
        let mut family = vec![0u16; body.len];
        made.each_near(false, &mut |own, near, _| {
            family[own.slot] = near.len() as u16
        });
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

    /// What many-body potentials say, where it is asked for.
    fn centres(
        &self,
        list: &NearList<3>,
        position: &[[f64; 4]],
        ends: Option<Ends>,
        f: [Shared; 3],
        said: Option<Places>,
        volume: &Values,
    ) {
        let view = View {
            list,
            position: position.as_ptr().cast(),
            many_body: &self.many_body,
            limit: self.many_body.cutoff() * self.many_body.cutoff(),
            ends,
            back: &self.back,
            f,
            said,
            volume,
        };
        match self.many_body.table().kinds() {
            1 => run_blocks(self.simd, &Centres::<F, false>(view), list.blocks()),
            _ => run_blocks(self.simd, &Centres::<F, true>(view), list.blocks()),
        }
    }

    /// What each point of a list says.
    fn said(
        &self,
        body: &Body<3>,
        virial: bool,
        list: &NearList<3>,
        position: &[[f64; 4]],
    ) -> Said {
        let mut said = Said::new(body, virial);
        let places = Some(said.places());
        self.centres(
            list,
            position,
            None,
            [Shared::NULL; 3],
            places,
            &body.volume,
        );
        said
    }

    /// Energies of all points, of a list as it is.
    fn see(
        &self,
        body: &Body<3>,
        list: &NearList<3>,
        position: &[[f64; 4]],
        out: &mut PointEnergiesMut,
    ) {
        self.said(body, false, list, position).see(body, out);
    }

    /// Every own atom, or every one whose neighbours are known, with those within the cut-off now, and what they are called.
    fn each_near(&self, known: bool, visit: &mut dyn FnMut(Centre, &[Near], &[usize])) {
        let at = self.list.positions();
        let limit = self.many_body.cutoff() * self.many_body.cutoff();
        let (mut near, mut slots) = (vec![], vec![]);
        for (t, lines) in (0..self.list.blocks()).flat_map(|b| self.list.tiles(b)) {
            let own = self.list.slots(t).len();
            for l in 0..if known { self.list.lanes(t) } else { own } {
                near.clear();
                slots.clear();
                let n = t * TILE + l;
                let Some(slot) = self.list.original(n) else {
                    continue;
                };
                let x = at[n];
                for line in lines {
                    let z = at[line[l] as usize];
                    let y: [f64; 3] = crate::array::from_fn(|a| z[a] - x[a]);
                    let square = y.iter().map(|c| c * c).sum::<f64>();
                    let j = self.list.original(line[l] as usize);
                    if let Some(j) = j.filter(|_| square < limit) {
                        let kind = z[3] as u32;
                        near.push(Near { kind, y });
                        slots.push(j);
                    }
                }
                let kind = x[3] as u32;
                visit(Centre { slot, kind }, &near, &slots);
            }
        }
    }
}

/// Whose fan it is.
struct Centre {
    slot: usize,
    kind: u32,
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
    }
    .wide();
    list.update(body, u, simd);
    put_kinds(&mut list, kinds);
    list
}

/// Kinds into the fourth numbers of all atoms.
fn put_kinds(list: &mut NearList<3>, kinds: &[u8]) {
    let own = list.by_slot();
    let at = list.positions_mut();
    // nobody is of the first
    at.iter_mut().for_each(|x| x[3] = 0.0);
    for (n, kind) in own.iter().zip(kinds).filter(|(n, _)| **n != u32::MAX) {
        at[*n as usize][3] = f64::from(*kind);
    }
    list.copy_fourth();
}

impl<F: ManyBody> Held<3> for ManyBodyAtoms<F> {
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

impl<F: ManyBody> Interaction<3> for ManyBodyAtoms<F> {
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
        let mut said = seen.is_some().then(|| Said::new(body, false));
        let places = said.as_mut().map(Said::places);
        let f: [Shared; 3] = crate::array::from_fn(|a| Shared(f[a].as_mut_ptr()));
        let ends = self.back.ends();
        let (list, volume) = (&self.list, &body.volume);
        self.centres(list, list.positions(), Some(ends), f, places, volume);
        if let (Some(said), Some(seen)) = (said, seen) {
            said.see(body, seen);
        }
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
        [
            self.said(body, false, list, list.positions()).energy(body),
            0.0,
        ]
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
            let cutoff = self.many_body.cutoff();
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
            let cutoff = self.many_body.cutoff();
            let list = list_at(body, cutoff, self.held, &self.kinds, view(&rest), self.simd);
            self.see(body, &list, &strain(list.positions().to_vec()), out);
        }
    }

    fn is_potential(&self) -> bool {
        true
    }

    fn has_many_body(&self) -> bool {
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
        let (id, own) = (body.id_of(), self.list.by_slot());
        let is_own = |slot: &usize| own.get(*slot).is_some_and(|n| *n != u32::MAX);
        let volume = |slot| Some(slot).filter(is_own).map(|slot| body.volume.at(slot));
        // what several centres say of a pair stays apart, in order of their atoms
        let mut all: Vec<([u32; 3], BondTangent<3>)> = vec![];
        self.each_near(true, &mut |Centre { slot, kind }, near, others| {
            let of = |n: u32| match n {
                0 => slot,
                n => others[n as usize - 1],
            };
            tangents(&self.many_body, kind, near, &mut |pair| {
                let ends = [pair.a, pair.b].map(of);
                for bond in BondTangent::both(volume, ends, &pair) {
                    all.push(([bond.i as u32, id(bond.j), id(slot)], bond));
                }
            });
        });
        all.sort_by_key(|(order, _)| *order);
        all.into_iter().for_each(|(_, bond)| visit(bond));
    }

    /// Pairs of the current list that are within the cut-off now.
    fn each_bond(&self, body: &Body<3>, visit: &mut EachBond<3>) {
        let id = body.id_of();
        self.each_near(false, &mut |Centre { slot, .. }, near, slots| {
            for (near, &j) in near.iter().zip(slots) {
                if id(slot) < id(j) {
                    visit(slot, j, near.y, BondStatus::Whole);
                }
            }
        });
    }

    fn each_partner(&self, _: &Body<3>, visit: &mut EachBond<3>) {
        self.each_near(false, &mut |Centre { slot, .. }, near, slots| {
            for (near, &j) in near.iter().zip(slots) {
                visit(slot, j, near.y, BondStatus::Whole);
            }
        });
    }

    fn virial(&mut self, body: &Body<3>, u: FieldView<3>) -> Option<[f64; 6]> {
        self.check(body, &[u]);
        self.ready(body, u);
        let list = &self.list;
        Some(self.said(body, true, list, list.positions()).virial(body))
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
            put_kinds(&mut self.list, &self.kinds);
            self.back = Back::of(&self.list, self.simd);
        }
    }

    fn bytes(&self) -> usize {
        self.list.bytes() + self.back.bytes() + self.kinds.len() + 2 * self.family.len()
    }
}
