//! A potential between all atoms, and what those say beside it that are bonded to each other whatever moves.
//!
//! Terms are evaluated one by one into places of their own, and every atom gathers from its terms in their order: no races, and the same
//! bits on any number of threads. Of pairs that are a few bonds apart, what the potential says is taken away again, in whole or in part:
//! so its kernels know nothing of molecules, and some digits of forces between neighbours of a chain are lost.

mod kernel;

use super::super::{BondStatus, BondTangent, Interaction, PointEnergiesMut, Sweep, Tally};
use crate::body::{Body, FieldView, FieldViewMut, Identity, view, view_mut};
use crate::columns::Declaration;
use crate::execute::blocks::{PerBlock, Shared, run_blocks};
use crate::execute::simd::Simd;
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
    sums: PerBlock<[f64; 7]>,
    /// By slot, how many are bonded to it, where the potential between all atoms has no families; else empty.
    bonded: Vec<u32>,
}

impl<const D: usize> BondedAtoms<D> {
    /// `inner` is the potential between all atoms, `pair` the same between two.
    ///
    /// # Panics
    /// If a term names a point or a form that does not exist.
    pub fn new(
        inner: Box<dyn Interaction<D>>,
        body: &Body<D>,
        spec: Arc<BondedSpec>,
        pair: Box<PairEnergy>,
        simd: Simd,
    ) -> Self {
        let slot = |n: u32| body.slots[n as usize];
        let mut terms: Vec<Term> = spec
            .terms
            .iter()
            .map(|t| Term {
                count: spec.forms[t.form as usize].particles(),
                slots: t.points.map(slot),
                says: Says::Form(t.form),
            })
            .collect();
        for ([a, b], apart) in special_pairs(&spec) {
            let left = spec.special[apart - 1];
            if left != 1.0 {
                terms.push(Term {
                    count: 2,
                    slots: [a, b, 0, 0].map(slot),
                    says: Says::Pair(left - 1.0),
                });
            }
        }
        let mut point = vec![u32::MAX; body.len];
        for (n, s) in body.slots.iter().enumerate() {
            point[*s as usize] = n as u32;
        }
        let mut lists = vec![vec![]; body.points()];
        for (t, term) in terms.iter().enumerate() {
            for (n, s) in term.slots[..term.count].iter().enumerate() {
                lists[point[*s as usize] as usize].push((4 * t + n) as u32);
            }
        }
        let mut first = vec![0];
        for list in &lists {
            first.push(first.last().map_or(0, |f| f + list.len() as u32));
        }
        let mut bonded = vec![];
        if inner.directed_bonds() == 0 {
            bonded.resize(body.len, 0);
            for end in { terms.iter() }
                .filter(|t| t.is_bond())
                .flat_map(Term::ends)
            {
                bonded[end] += 1;
            }
        }
        BondedAtoms {
            bonded,
            inner,
            simd,
            spec,
            pair,
            force: vec![[[0.0; D]; 4]; terms.len()],
            sums: PerBlock::sums(terms.len().div_ceil(BLOCK)),
            terms,
            first,
            of: lists.concat(),
        }
    }

    fn evaluate(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        force: Shared<[[f64; D]; 4]>,
        energy: Shared,
    ) -> [f64; 7] {
        let kernel = Evaluate {
            body,
            u,
            forms: &self.spec.forms,
            pair: &*self.pair,
            terms: &self.terms,
            force,
            energy,
        };
        self.sums.sum(self.simd, &kernel)
    }

    /// Energies of all points with those of their terms, in equal shares.
    fn share(&self, body: &Body<D>, u: FieldView<D>, out: &mut PointEnergiesMut) {
        let mut each = vec![0.0; self.terms.len()];
        self.evaluate(
            body,
            u,
            Shared(std::ptr::null_mut()),
            Shared(each.as_mut_ptr()),
        );
        for (term, energy) in self.terms.iter().zip(each) {
            for s in &term.slots[..term.count] {
                let slot = *s as usize;
                out.strain[slot] += energy / (term.count as f64 * body.volume.at(slot));
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
        self.evaluate(body, u, force, Shared::NULL);
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
        let own = self.evaluate(body, u, Shared(std::ptr::null_mut()), Shared::NULL);
        [inner + own[0], repulsion]
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

    fn has_fans(&self) -> bool {
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
                all.extend(BondTangent::both(body, ends, &pair));
            });
        }
        all.sort_by_key(|bond| (bond.i, bond.j));
        all.into_iter().for_each(visit);
    }

    fn gain(&self, slot: usize) -> f64 {
        self.inner.gain(slot)
    }

    /// Of atoms that do not feel each other otherwise those that are bonded.
    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        self.inner.each_bond(body, visit);
        if self.bonded.is_empty() {
            return;
        }
        let rest = body.at_rest();
        for term in self.terms.iter().filter(|t| t.is_bond()) {
            let [mut i, mut j] = term.ends();
            if i > j {
                std::mem::swap(&mut i, &mut j);
            }
            let mut sorted = *term;
            (sorted.slots[0], sorted.slots[1]) = (i as u32, j as u32);
            let (at, _) = kernel::places(body, view(&rest), &sorted);
            let xi = crate::array::from_fn(|a| at[1][a] - at[0][a]);
            visit(i, j, xi, BondStatus::Whole);
        }
    }

    fn family(&self) -> &'static str {
        self.inner.family()
    }

    fn virial(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<[f64; 6]> {
        let mut virial = self.inner.virial(body, u)?;
        let own = self.evaluate(body, u, Shared(std::ptr::null_mut()), Shared::NULL);
        for (v, own) in virial.iter_mut().zip(&own[1..]) {
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
            + 4 * (self.first.capacity() + self.of.capacity() + self.bonded.capacity())
    }
}

#[cfg(test)]
mod tests;
