//! A sum of potentials on one body of atoms, each with the atoms that it acts on.

use super::breaking::Held;
use super::union::Union;
use crate::body::{Body, Field, FieldView, FieldViewMut, Identity, view_mut, zeros};
use crate::execute::simd::Simd;
use crate::family::neighbours::near::NearList;
use crate::interaction::history::damage;
use crate::interaction::{
    BondStatus, Crosses, EachBond, EachForce, EachTangent, Gradient, Interaction, PointEnergies,
    PointEnergiesMut, Sweep, Tally,
};
use crate::spec::CrackKind;
use crate::state::Archive;

/// Potentials whose energies are added.
pub struct SumOfPotentials<const D: usize, P: Interaction<D> + ?Sized = dyn Interaction<D>> {
    body: Identity,
    parts: Vec<Box<P>>,
    /// The bonds of all, where they are held and break together.
    union: Option<Union<D>>,
    /// Forces of one of them.
    own: Field<D>,
    /// Partners of every slot in the reference.
    family: Vec<u16>,
    /// Directed bonds that are broken.
    broken: u64,
}

impl<const D: usize> SumOfPotentials<D, dyn Held<D>> {
    /// Of potentials that hold families of this `horizon` (length), whose bonds break by the work of all.
    pub fn of_reference(
        body: &Body<D>,
        parts: Vec<Box<dyn Held<D>>>,
        horizon: f64,
        simd: Simd,
    ) -> Self {
        let union = Some(Union::new(body, &parts, horizon, simd));
        SumOfPotentials {
            union,
            ..SumOfPotentials::new(body, parts)
        }
    }

    fn union(&self) -> &Union<D> {
        self.union.as_ref().expect("made of held families")
    }
}

impl<const D: usize> Held<D> for SumOfPotentials<D, dyn Held<D>> {
    fn list(&self) -> &NearList<D> {
        &self.union().list
    }

    fn list_mut(&mut self) -> &mut NearList<D> {
        &mut self.union.as_mut().expect("made of held families").list
    }

    fn pulls(&self, _: &[u32], out: &mut [[f64; D]]) {
        self.union().pulls(&self.parts, out);
    }

    fn follow(&mut self, place: usize, whole: bool) {
        if let Some(union) = &self.union {
            union.follow(&mut self.parts, place, whole);
        }
    }
}

impl<const D: usize, P: Interaction<D> + ?Sized> SumOfPotentials<D, P> {
    /// All are made for the body.
    pub fn new(body: &Body<D>, parts: Vec<Box<P>>) -> Self {
        let mut made = SumOfPotentials {
            body: body.identity,
            parts,
            union: None,
            own: zeros(body.len),
            family: vec![],
            broken: 0,
        };
        let mut family = vec![0u16; body.len];
        made.each_partner(body, &mut |i, _, _, _| family[i] += 1);
        made.family = family;
        made
    }

    /// What parts visit, a pair once.
    fn each_once(
        &self,
        body: &Body<D>,
        each: &dyn Fn(&P, &mut EachBond<D>),
        visit: &mut EachBond<D>,
    ) {
        let (id, mut all) = (body.id_of(), vec![]);
        for part in &self.parts {
            each(part, &mut |i, j, xi, state| all.push((i, j, xi, state)));
        }
        let pair = |&(i, j, _, _): &(usize, usize, [f64; D], BondStatus)| (i, id(j));
        all.sort_by_key(pair);
        all.dedup_by_key(|bond| pair(bond));
        for (i, j, xi, state) in all {
            visit(i, j, xi, state);
        }
    }

    /// Broken bonds, of which a part may know each, since the last time that they were counted.
    fn count_broken(&mut self, body: &Body<D>) -> u64 {
        let mut broken = 0;
        self.each_bond(body, &mut |_, _, _, state| {
            broken += 2 * u64::from(state == BondStatus::Broken);
        });
        let before = std::mem::replace(&mut self.broken, broken);
        broken.saturating_sub(before)
    }
}

/// Adds energy densities.
fn add(to: &mut [f64], of: &[f64]) {
    to.iter_mut().zip(of).for_each(|(a, b)| *a += b);
}

impl<const D: usize, P: Interaction<D> + ?Sized> Interaction<D> for SumOfPotentials<D, P> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        self.parts.first().map_or("neighbours", |p| p.family())
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        mut f: FieldViewMut<D>,
        sweep: Sweep<D>,
        mut seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let mut tally = Tally::default();
        if let Some(union) = &mut self.union {
            union.list.update(body, u, union.simd);
        }
        if let Some(seen) = seen.as_deref_mut() {
            seen.zeros(body.len);
        }
        for (n, part) in self.parts.iter_mut().enumerate() {
            let mut energies = seen.is_some().then(PointEnergies::default);
            let into = match n {
                0 => view_mut(&mut f),
                _ => view_mut(&mut self.own),
            };
            let mut workspace = energies.as_mut().map(|e| e.for_slots(body.len));
            tally += part.forces(body, u, into, sweep, workspace.as_mut());
            if n > 0 {
                for (f, own) in f.iter_mut().zip(&self.own) {
                    add(f, own);
                }
            }
            if let (Some(seen), Some(energies)) = (seen.as_deref_mut(), energies) {
                add(seen.strain, &energies.strain);
            }
        }
        if tally.broken > 0 {
            tally.broken = self.count_broken(body);
        }
        tally
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        let each = self.parts.iter_mut().map(|p| p.energy(body, u));
        each.fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d])
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        out.zeros(body.len);
        for part in &self.parts {
            let mut own = PointEnergies::default();
            part.observe(body, u, &mut own.for_slots(body.len));
            add(out.strain, &own.strain);
        }
    }

    fn observe_gradient(&self, body: &Body<D>, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        self.check(body, &[]);
        out.zeros(body.len);
        for part in &self.parts {
            let mut own = PointEnergies::default();
            part.observe_gradient(body, gradient, &mut own.for_slots(body.len));
            add(out.strain, &own.strain);
        }
    }

    fn is_potential(&self) -> bool {
        true
    }

    fn has_many_body(&self) -> bool {
        self.parts.iter().any(|p| p.has_many_body())
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        for part in &mut self.parts {
            part.tangents(body, u, visit);
        }
    }

    /// At most one of them has embedding energies.
    fn gain(&self, slot: usize) -> f64 {
        self.parts.iter().map(|p| p.gain(slot)).sum()
    }

    /// A pair is one bond, however many potentials it has.
    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        self.each_once(body, &|part, visit| part.each_bond(body, visit), visit);
    }

    fn each_partner(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        self.each_once(body, &|part, visit| part.each_partner(body, visit), visit);
    }

    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        let mut all = true;
        for part in &mut self.parts {
            all &= part.each_force(body, u, visit);
        }
        all
    }

    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        let mut family = vec![0.0; body.len];
        out.fill(0.0);
        self.each_partner(body, &mut |i, j, _, state| {
            // bonds with who is no slot here are of now, and never broken
            let volume = if j < body.len { body.volume.at(j) } else { 1.0 };
            family[i] += volume;
            out[i] += if state == BondStatus::Whole {
                volume
            } else {
                0.0
            };
        });
        for (out, family) in out.iter_mut().zip(family) {
            *out = damage(*out, family);
        }
    }

    fn cut(&mut self, body: &Body<D>, kind: CrackKind, crosses: &Crosses<D>) -> u64 {
        let count = |all: &Self| {
            let mut whole = 0;
            all.each_bond(body, &mut |_, _, _, state| {
                whole += 2 * u64::from(state == BondStatus::Whole);
            });
            whole
        };
        let before = count(self);
        for part in &mut self.parts {
            part.cut(body, kind, crosses);
        }
        let left = count(self);
        // bonds that were never there are none of the broken ones
        self.count_broken(body);
        before - left
    }

    fn virial(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<[f64; 6]> {
        let mut sum = [0.0; 6];
        for part in &mut self.parts {
            let own = part.virial(body, u)?;
            add(&mut sum, &own);
        }
        Some(sum)
    }

    fn directed_bonds(&self) -> u64 {
        self.family.iter().map(|n| u64::from(*n)).sum()
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        usize::from(self.family[slot])
    }

    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        for part in &mut self.parts {
            archive.within("part", |archive| part.archive(body, archive));
        }
        if let Some(union) = &mut self.union {
            let (list, simd) = (&mut union.list, union.simd);
            archive.within("union", |archive| list.archive(body, simd, archive));
        }
        if archive.loads() {
            self.count_broken(body);
        }
    }

    fn bytes(&self) -> usize {
        let own: usize = self.own.iter().map(|c| 8 * c.len()).sum();
        let union = self.union.as_ref().map_or(0, Union::bytes);
        own + union + 2 * self.family.len() + self.parts.iter().map(|p| p.bytes()).sum::<usize>()
    }
}
