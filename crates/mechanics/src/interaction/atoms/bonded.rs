//! A potential between all atoms, and what those say beside it that are bonded to each other whatever moves.
//!
//! Terms are evaluated one by one into places of their own, and every atom gathers from its terms in their order: no races, and the same
//! bits on any number of threads. Of pairs that are a few bonds apart, what the potential says is taken away again, in whole or in part:
//! so its kernels know nothing of molecules, and some digits of forces between neighbours of a chain are lost.

mod kernel;

use super::super::{BondStatus, BondTangent, Interaction, PointEnergiesMut, Sweep, Tally};
use crate::body::{Body, FieldView, FieldViewMut, Identity, view, view_mut};
use crate::columns::Declaration;
use crate::execute::blocks::{Shared, run_blocks};
use crate::execute::simd::Simd;
use crate::family::neighbours::periods;
use crate::interaction::{EachBond, EachPair, EachTangent};
use crate::law::blocks::Quadratic;
use crate::law::bonded::{Tangents, special_pairs};
use crate::spec::BondedSpec;
use crate::state::Archive;
pub use kernel::PairEnergy;
use kernel::{BLOCK, Evaluate, Gather, Says, Term};
use std::sync::Arc;

/// A potential with the bonded terms of a body.
pub struct BondedAtoms<const D: usize> {
    inner: Box<dyn Interaction<D>>,
    simd: Simd,
    spec: Arc<BondedSpec>,
    pair: Box<PairEnergy>,
    terms: Vec<Term>,
    /// Forces on the particles of each term.
    force: Vec<[[f64; D]; 4]>,
    /// `[points + 1]`: where the terms of a point begin, and these: `4 term + place`.
    first: Vec<u32>,
    of: Vec<u32>,
    /// By slot: is it a point of this rank?
    own: Vec<bool>,
    /// By slot, how many are bonded to it, where the potential between all atoms has no families; else empty.
    bonded: Vec<u32>,
}

/// No two atoms of a term, nor of a pair that is left out, are farther from each other than this in the reference (length).
pub fn longest_term<const D: usize>(body: &Body<D>, spec: &BondedSpec) -> f64 {
    let place = |id: u32| body.position(body.slots[id as usize] as usize);
    let longest = spec.terms.iter().map(|term| {
        let count = spec.forms[term.form as usize].particles();
        let way = term.points[..count].windows(2).map(|ends| {
            let (x, y) = (place(ends[0]), place(ends[1]));
            let y: [f64; D] = crate::array::from_fn(|a| y[a] - x[a]);
            let back = periods(body, &y);
            (0..D).map(|a| (y[a] - back[a]).powi(2)).sum::<f64>().sqrt()
        });
        // pairs are left out that are three bonds apart
        way.sum::<f64>() * if count == 2 { 3.0 } else { 1.0 }
    });
    // for the round-off of places
    1.001 * longest.fold(0.0, f64::max)
}

impl<const D: usize> BondedAtoms<D> {
    /// `inner` is the potential between all atoms, `pair` the same between two.
    ///
    /// # Panics
    /// If a term names a point or a form that does not exist, or, of a part of a body, one of which it has no copy.
    pub fn new(
        inner: Box<dyn Interaction<D>>,
        body: &Body<D>,
        spec: Arc<BondedSpec>,
        pair: Box<PairEnergy>,
        simd: Simd,
    ) -> Self {
        let mut own = vec![false; body.len];
        body.slots.iter().for_each(|s| own[*s as usize] = true);
        let slots = body.slots_of_ids();
        // of a part of a body those with a point of it
        let term = |count: usize, points: [u32; 4], says: Says| {
            let mut of = points.map(|n| slots[n as usize]);
            let is_own = |s: &u32| own.get(*s as usize) == Some(&true);
            of[..count].iter().any(is_own).then(|| {
                assert!(
                    of[..count].iter().all(|s| *s != Body::<D>::NOWHERE),
                    "a copy of each atom of a term"
                );
                let filler = of[0];
                of[count..].fill(filler);
                Term {
                    count,
                    slots: of,
                    says,
                    first: is_own(&of[0]),
                }
            })
        };
        let mut terms: Vec<Term> = { spec.terms.iter() }
            .filter_map(|t| {
                let count = spec.forms[t.form as usize].particles();
                term(count, t.points, Says::Form(t.form))
            })
            .collect();
        for ([a, b], apart) in special_pairs(&spec) {
            let left = spec.special[apart - 1];
            if left != 1.0 {
                terms.extend(term(2, [a, b, a, a], Says::Pair(left - 1.0)));
            }
        }
        let mut point = vec![u32::MAX; body.len];
        for (n, s) in body.slots.iter().enumerate() {
            point[*s as usize] = n as u32;
        }
        let mut lists = vec![vec![]; body.points()];
        for (t, term) in terms.iter().enumerate() {
            for (n, s) in term.slots[..term.count].iter().enumerate() {
                if let Some(list) = lists.get_mut(point[*s as usize] as usize) {
                    list.push((4 * t + n) as u32);
                }
            }
        }
        let mut first = vec![0];
        for list in &lists {
            first.push(first.last().map_or(0, |f| f + list.len() as u32));
        }
        let mut bonded = vec![];
        if body.count(inner.directed_bonds()) == 0 {
            bonded.resize(body.len, 0);
            let ends = { terms.iter() }
                .filter(|t| t.is_bond())
                .flat_map(Term::ends);
            ends.filter(|end| own[*end])
                .for_each(|end| bonded[end] += 1);
        }
        BondedAtoms {
            bonded,
            inner,
            simd,
            spec,
            pair,
            force: vec![[[0.0; D]; 4]; terms.len()],
            own,
            terms,
            first,
            of: lists.concat(),
        }
    }

    /// Forces on the particles of terms, where they are asked for, and what each term says.
    fn evaluate(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        force: Shared<[[f64; D]; 4]>,
        said: Shared<[f64; 7]>,
    ) {
        let kernel = Evaluate {
            body,
            u,
            forms: &self.spec.forms,
            pair: &*self.pair,
            terms: &self.terms,
            force,
            said,
        };
        run_blocks(self.simd, &kernel, self.terms.len().div_ceil(BLOCK));
    }

    /// Energy and virial of each term.
    fn said(&self, body: &Body<D>, u: FieldView<D>) -> Vec<[f64; 7]> {
        let mut said = vec![[0.0; 7]; self.terms.len()];
        self.evaluate(body, u, Shared::nobody(), Shared(said.as_mut_ptr()));
        said
    }

    /// Of all terms, of all ranks.
    fn sums<const N: usize>(&self, body: &Body<D>, u: FieldView<D>, first: usize) -> [f64; N] {
        let said = self.said(body, u);
        body.sums(crate::array::from_fn(|n| {
            let own = self.terms.iter().zip(&said).filter(|(term, _)| term.first);
            own.map(|(_, said)| said[first + n]).collect()
        }))
    }

    /// Where the potential between all atoms has no families, those that are bonded, from each that is here.
    fn each_term(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        if self.bonded.is_empty() {
            return;
        }
        let rest = body.at_rest();
        for term in self.terms.iter().filter(|t| t.is_bond()) {
            for turned in [false, true] {
                let mut of = *term;
                if turned {
                    of.slots.swap(0, 1);
                }
                let [i, j] = of.ends();
                if self.own[i] {
                    let (at, _) = kernel::places(body, view(&rest), &of);
                    let xi = crate::array::from_fn(|a| at[1][a] - at[0][a]);
                    visit(i, j, xi, BondStatus::Whole);
                }
            }
        }
    }

    /// Energies of all points with those of their terms, in equal shares.
    fn share(&self, body: &Body<D>, u: FieldView<D>, out: &mut PointEnergiesMut) {
        for (term, said) in self.terms.iter().zip(self.said(body, u)) {
            for s in &term.slots[..term.count] {
                let slot = *s as usize;
                out.strain[slot] += said[0] / (term.count as f64 * body.volume.at(slot));
            }
        }
    }
}

impl<const D: usize> Interaction<D> for BondedAtoms<D> {
    fn made_for(&self) -> Identity {
        self.inner.made_for()
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        mut f: FieldViewMut<D>,
        sweep: Sweep<D>,
        mut seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        // SAFETY: as promised
        let tally = unsafe {
            self.inner
                .forces_unchecked(body, u, view_mut(&mut f), sweep, seen.as_deref_mut())
        };
        let force = Shared(self.force.as_mut_ptr());
        self.evaluate(body, u, force, Shared::nobody());
        if let Some(seen) = seen {
            self.share(body, u, seen);
        }
        let gather = Gather {
            body,
            first: &self.first,
            of: &self.of,
            force: &self.force,
            f: crate::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
        };
        run_blocks(self.simd, &gather, body.points().div_ceil(BLOCK));
        tally
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        // SAFETY: as promised
        let [inner, repulsion] = unsafe { self.inner.energy_unchecked(body, u) };
        let [own] = self.sums(body, u, 0);
        [inner + own, repulsion]
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        // SAFETY: as promised
        unsafe { self.inner.observe_unchecked(body, u, out) };
        self.share(body, u, out);
    }

    fn is_potential(&self) -> bool {
        true
    }

    fn has_many_body(&self) -> bool {
        true
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        let mut all = vec![];
        // SAFETY: as promised
        unsafe {
            self.inner
                .tangents_unchecked(body, u, &mut |bond| all.push(bond))
        };
        // all bonds have as many channels
        let channels = all.first().map_or(0, |b| b.channels.len());
        for term in &self.terms {
            let (at, xi) = kernel::places(body, u, term);
            let Some(Tangents { first, second }) = (match term.says {
                Says::Form(form) => {
                    Some(self.spec.forms[form as usize].tangents(&xi[..term.pairs()]))
                }
                Says::Pair(factor) => kernel::left_out(body, &*self.pair, term, factor, xi[0]),
            }) else {
                continue;
            };
            let mut sum = Quadratic::new(term.count);
            let of: Vec<usize> = (0..term.pairs()).collect();
            sum.add(&of, &first.pulls, |m, n| second[m][n], 1.0);
            sum.visit(&at[..term.count], &mut |pair| {
                let ends = [pair.a, pair.b].map(|n| term.slots[n as usize] as usize);
                debug_assert!(channels == 0);
                let volume = |slot: usize| self.own[slot].then(|| body.volume.at(slot));
                all.extend(BondTangent::both(volume, ends, &pair));
            });
        }
        let id = body.id_of();
        all.sort_by_key(|bond| (bond.i, id(bond.j)));
        all.into_iter().for_each(visit);
    }

    fn gain(&self, slot: usize) -> f64 {
        self.inner.gain(slot)
    }

    /// Of atoms that do not feel each other otherwise those that are bonded.
    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        self.inner.each_bond(body, visit);
        let id = body.id_of();
        self.each_term(body, &mut |i, j, xi, state| {
            if id(i) < id(j) {
                visit(i, j, xi, state);
            }
        });
    }

    fn each_partner(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        self.inner.each_partner(body, visit);
        self.each_term(body, visit);
    }

    fn family(&self) -> &'static str {
        self.inner.family()
    }

    fn virial(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<[f64; 6]> {
        let mut virial = self.inner.virial(body, u)?;
        for (v, own) in virial.iter_mut().zip(self.sums::<6>(body, u, 1)) {
            *v += own;
        }
        Some(virial)
    }

    fn directed_bonds(&self) -> u64 {
        match self.bonded.is_empty() {
            true => self.inner.directed_bonds(),
            false => self.bonded.iter().map(|n| u64::from(*n)).sum(),
        }
    }

    fn family_size(&self, body: &Body<D>, slot: usize) -> usize {
        match self.bonded.get(slot) {
            None => self.inner.family_size(body, slot),
            Some(count) => *count as usize,
        }
    }

    fn columns(&self) -> Vec<Declaration> {
        self.inner.columns()
    }

    fn each_directed(&self, body: &Body<D>, name: &str, visit: &mut EachPair<D>) {
        self.inner.each_directed(body, name, visit);
    }

    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        self.inner.archive(body, archive);
    }

    fn bytes(&self) -> usize {
        self.inner.bytes()
            + size_of::<Term>() * self.terms.capacity()
            + size_of::<[[f64; D]; 4]>() * self.force.capacity()
            + self.own.capacity()
            + 4 * (self.first.capacity() + self.of.capacity() + self.bonded.capacity())
    }
}

#[cfg(test)]
mod tests;
