//! An interaction that every rank has as a whole, of a body whose points they share: each finds all of it, and keeps what is of its own points. It costs no
//! less on more ranks.

use crate::body::{Body, Field, FieldView, FieldViewMut, Identity, view, view_mut, zeros};
use crate::interaction::{
    BondForce, BondTangent, Crosses, EachBond, EachForce, EachTangent, Fault, Gradient,
    Interaction, PointEnergies, PointEnergiesMut, Sweep, Tally,
};
use crate::spec::CrackKind;
use crate::state::Archive;

/// An interaction of the whole body, for the part of it that this rank has.
pub struct Replicated<const D: usize> {
    part: Identity,
    whole: Body<D>,
    inner: Box<dyn Interaction<D>>,
    /// Slots in the whole of the points of all ranks, one rank after the other.
    places: Vec<u32>,
    /// Slots of this rank's points, here and in the whole.
    own: Vec<[usize; 2]>,
    /// By slot of the whole: the slot here, of its own or of a copy; ids of others after all slots.
    here: Vec<usize>,
    /// By slot of the whole: is it of this rank?
    is_own: Vec<bool>,
    /// Sizes of families by slot here.
    sizes: Vec<u32>,
}

impl<const D: usize> Replicated<D> {
    /// `inner` is made for the `whole` body of which this is a part. All ranks ask at once.
    pub fn new(part: &Body<D>, whole: Body<D>, inner: Box<dyn Interaction<D>>) -> Self {
        let slot = |id: u32| whole.slots[id as usize];
        let ids: Vec<u32> = (0..part.points())
            .map(|id| part.id_of_all(id) as u32)
            .collect();
        let places = part.all_of(&ids).concat();
        let mut here = vec![usize::MAX; whole.len];
        let mut is_own = vec![false; whole.len];
        for (id, s) in whole.slots.iter().enumerate() {
            here[*s as usize] = part.len + id;
        }
        let all = part.ids_of_all();
        for copy in part.exchange.copies() {
            here[slot(all[copy]) as usize] = copy;
        }
        let (mut own, mut sizes) = (vec![], vec![0; part.len]);
        for (id, s) in ids.iter().zip(&part.slots) {
            let there = slot(*id) as usize;
            (here[there], is_own[there]) = (*s as usize, true);
            own.push([*s as usize, there]);
            sizes[*s as usize] = inner.family_size(&whole, there) as u32;
        }
        Replicated {
            part: part.identity,
            places: places.into_iter().map(slot).collect(),
            whole,
            inner,
            own,
            here,
            is_own,
            sizes,
        }
    }

    /// What all points have of a field of the part. All ranks ask at once.
    fn spread(&self, body: &Body<D>, of: FieldView<D>) -> Field<D> {
        let own: Vec<[f64; D]> = body.by_id(|i| crate::array::from_fn(|a| of[a][i]));
        let mut whole = self.whole.at_rest();
        let all = body.all_of(own.as_flattened()).concat();
        for (x, slot) in all.as_chunks::<D>().0.iter().zip(&self.places) {
            (0..D).for_each(|a| whole[a][*slot as usize] = x[a]);
        }
        whole
    }

    /// Keeps what is of this rank's points.
    fn keep(&self, whole: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        { self.own.iter() }.for_each(|[here, there]| out[*here] = whole[*there]);
    }

    fn keep_energies(&self, whole: &PointEnergies, out: &mut PointEnergiesMut) {
        self.keep(&whole.strain, out.strain);
        self.keep(&whole.repulsion, out.repulsion);
        self.keep(&whole.dilatation, out.dilatation);
        self.keep(&whole.whole, out.whole);
    }
}

impl<const D: usize> Interaction<D> for Replicated<D> {
    fn made_for(&self) -> Identity {
        self.part
    }

    fn family(&self) -> &'static str {
        self.inner.family()
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        mut f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let u = self.spread(body, u);
        let velocity;
        let sweep = match sweep {
            Sweep::Evolve { v, steps, breakage } => {
                velocity = self.spread(body, v);
                Sweep::Evolve {
                    v: view(&velocity),
                    steps,
                    breakage,
                }
            }
            Sweep::Hold => Sweep::Hold,
        };
        let mut all: Field<D> = zeros(self.whole.len);
        let mut energies = seen.is_some().then(PointEnergies::default);
        let mut workspace = energies.as_mut().map(|e| e.for_slots(self.whole.len));
        let tally = self.inner.forces(
            &self.whole,
            view(&u),
            view_mut(&mut all),
            sweep,
            workspace.as_mut(),
        );
        for (f, all) in f.iter_mut().zip(&all) {
            self.keep(all, f);
        }
        if let (Some(seen), Some(energies)) = (seen, energies) {
            self.keep_energies(&energies, seen);
        }
        // whose point it is says so
        let fault = tally.fault.filter(|fault| match *fault {
            Fault::Density { slot, .. } => self.is_own[slot],
            Fault::Crossing { i, .. } => self.is_own[i],
        });
        let fault = fault.map(|fault| fault.at(|slot| self.here[slot]));
        match body.is_first() {
            true => Tally { fault, ..tally },
            false => Tally {
                fault,
                ..Tally::default()
            },
        }
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        let u = self.spread(body, u);
        self.inner.energy(&self.whole, view(&u))
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        let (u, mut seen) = (self.spread(body, u), PointEnergies::default());
        let mut workspace = seen.for_slots(self.whole.len);
        self.inner.observe(&self.whole, view(&u), &mut workspace);
        self.keep_energies(&seen, out);
    }

    fn observe_gradient(&self, body: &Body<D>, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        self.check(body, &[]);
        let mut seen = PointEnergies::default();
        let mut workspace = seen.for_slots(self.whole.len);
        self.inner
            .observe_gradient(&self.whole, gradient, &mut workspace);
        self.keep_energies(&seen, out);
    }

    fn is_potential(&self) -> bool {
        self.inner.is_potential()
    }

    fn has_many_body(&self) -> bool {
        self.inner.has_many_body()
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        let u = self.spread(body, u);
        let mut own: Vec<BondTangent<D>> = vec![];
        self.inner.tangents(&self.whole, view(&u), &mut |bond| {
            if self.is_own[bond.i] {
                own.push(BondTangent {
                    i: self.here[bond.i],
                    j: self.here[bond.j],
                    ..bond
                });
            }
        });
        own.sort_by_key(|bond| bond.i);
        own.into_iter().for_each(visit);
    }

    /// The point with the lower slot says it.
    fn each_bond(&self, _: &Body<D>, visit: &mut EachBond<D>) {
        self.inner.each_bond(&self.whole, &mut |i, j, xi, state| {
            if self.is_own[i] {
                visit(self.here[i], self.here[j], xi, state);
            }
        });
    }

    fn each_partner(&self, _: &Body<D>, visit: &mut EachBond<D>) {
        self.inner
            .each_partner(&self.whole, &mut |i, j, xi, state| {
                if self.is_own[i] {
                    visit(self.here[i], self.here[j], xi, state);
                }
            });
    }

    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        let u = self.spread(body, u);
        let (is_own, here) = (&self.is_own, &self.here);
        self.inner.each_force(&self.whole, view(&u), &mut |bond| {
            if is_own[bond.i] {
                visit(BondForce {
                    i: here[bond.i],
                    j: here[bond.j],
                    ..bond
                });
            }
        })
    }

    fn virial(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<[f64; 6]> {
        let u = self.spread(body, u);
        self.inner.virial(&self.whole, view(&u))
    }

    fn damage(&self, _: &Body<D>, out: &mut [f64]) {
        let mut whole = vec![0.0; self.whole.len];
        self.inner.damage(&self.whole, &mut whole);
        self.keep(&whole, out);
    }

    fn cut(&mut self, body: &Body<D>, kind: CrackKind, crosses: &Crosses<D>) -> u64 {
        let cut = self.inner.cut(&self.whole, kind, crosses);
        if body.is_first() { cut } else { 0 }
    }

    fn directed_bonds(&self) -> u64 {
        self.sizes.iter().map(|n| u64::from(*n)).sum()
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        self.sizes[slot] as usize
    }

    fn archive(&mut self, _: &Body<D>, archive: &mut Archive<'_>) {
        self.inner.archive(&self.whole, archive);
    }

    fn bytes(&self) -> usize {
        let [all, here] = [self.here.len(), self.sizes.len()];
        let lists = 4 * self.places.len() + 16 * self.own.len() + 9 * all + 4 * here;
        self.inner.bytes() + self.whole.bytes() + lists
    }
}
