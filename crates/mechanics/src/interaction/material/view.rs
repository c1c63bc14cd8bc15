//! What the sweeps of a law read, and the arithmetic of one bond. No closure touches a lane (see the stencil's kernel).

use crate::body::FieldView;
use crate::execute::lane::series::{Series, Stretch};
use crate::execute::lane::{self, Lane, TILE};
use crate::interaction::bond::relative_square_stretch;
use crate::interaction::bonds::family::{Family, Slots};
use crate::interaction::bonds::store::OwnRows;
use crate::interaction::bonds::view::{BondView, grown};
use crate::law::material::{Around, Bond, End, Material, Numbers, Sink, Site, part_of};
use crate::law::number::Number;
use std::ops::Deref;

/// Bonds, and their law.
pub struct View<'a, const D: usize, F, M> {
    pub law: &'a M,
    pub bonds: BondView<'a, D, F>,
}

/// A law reads bonds wherever it stands.
impl<'a, const D: usize, F, M> Deref for View<'a, D, F, M> {
    type Target = BondView<'a, D, F>;

    #[inline(always)]
    fn deref(&self) -> &BondView<'a, D, F> {
        &self.bonds
    }
}

/// The points of a group.
pub struct Group<L: Lane, S, P, C, const D: usize> {
    pub number: usize,
    pub rows: S,
    pub place: P,
    pub u: [L; D],
    pub constants: C,
}

/// Displacements a time away from those of now.
#[derive(Clone, Copy)]
pub struct Drift<'a, const D: usize> {
    pub v: FieldView<'a, D>,
    pub time: f64,
}

/// The points of a group of a family and a law.
pub type GroupOf<L, const D: usize, F, M> = Group<
    L,
    <F as Family<D>>::Slots,
    <F as Family<D>>::Place<L>,
    <M as Material<D>>::Constants<L>,
    D,
>;

impl<const D: usize, F: Family<D>, M: Material<D>> View<'_, D, F, M> {
    /// # Safety
    /// A group of the family.
    #[inline(always)]
    pub unsafe fn group<L: Lane>(&self, number: usize) -> GroupOf<L, D, F, M> {
        let rows = self.family.rows(number);
        // SAFETY: rows of the family
        unsafe {
            Group {
                number,
                rows,
                place: self.family.place::<L>(rows),
                u: F::displacement::<L>(&self.moved, rows),
                constants: self.constants_at::<L>(rows),
            }
        }
    }

    /// Constants of the materials at some slots, or of the slots.
    #[inline(always)]
    pub unsafe fn constants_at<L: Lane>(&self, slots: F::Slots) -> M::Constants<L> {
        let count = <M::Constants<L> as Numbers<L>>::COUNT;
        let mut out = <M::Constants<L> as Numbers<L>>::constant(0.0);
        if self.alike {
            for n in 0..count {
                // SAFETY: a row per material
                out.set(n, L::splat(unsafe { *self.constants.get_unchecked(n) }));
            }
            return out;
        }
        if M::PLACED && self.placed.layout.numbers > 0 {
            // SAFETY: slots of the family, constants for each
            return unsafe { slots.load::<L, M::Constants<L>>(self.placed) };
        }
        for n in 0..count {
            let mut all = [0.0; TILE];
            for l in 0..L::N {
                // SAFETY: a material per slot, a row per material
                unsafe {
                    let m = *self.material.get_unchecked(slots.slot(l)) as usize;
                    all[l] = *self.constants.get_unchecked(m * count + n);
                }
            }
            // SAFETY: a number per lane
            out.set(n, unsafe { L::load(all.as_ptr()) });
        }
        out
    }

    /// Constants of the group's end of its bonds to these ends.
    ///
    /// # Safety
    /// The ends of a bond of the group.
    #[inline(always)]
    pub unsafe fn constants_to<L: Lane>(
        &self,
        at: &GroupOf<L, D, F, M>,
        ends: F::Slots,
    ) -> M::Constants<L> {
        if !M::MEETS || self.alike {
            return at.constants;
        }
        // SAFETY: the caller's promise
        let other = unsafe { self.constants_at::<L>(ends) };
        self.law.between(at.constants, &other)
    }

    /// η of a group's bonds; 0 in lanes without one.
    ///
    /// # Safety
    /// Ends of the group's bond.
    #[inline(always)]
    pub unsafe fn relative_displacement<L: Lane>(
        &self,
        at: &GroupOf<L, D, F, M>,
        ends: F::Slots,
        dead: L::Mask,
    ) -> [L; D] {
        // SAFETY: the caller's promise
        let mut eta = unsafe { F::displacement::<L>(&self.moved, ends) };
        for a in 0..D {
            eta[a] = (eta[a] - at.u[a]).zero_if(dead);
        }
        eta
    }

    /// Bond `k` of a group, and `ν V_j`. Lanes without one have a bond at rest and a weight of 0.
    ///
    /// # Safety
    /// A bond of the group, and its ends.
    #[inline(always)]
    pub unsafe fn bond<L: Lane>(
        &self,
        at: &GroupOf<L, D, F, M>,
        k: usize,
        ends: F::Slots,
        dead: L::Mask,
    ) -> (Bond<L, D>, L) {
        // SAFETY: the caller's promise
        unsafe {
            let eta = self.relative_displacement::<L>(at, ends, dead);
            self.deformed(at, k, ends, dead, eta)
        }
    }

    /// The same with an η of its own.
    ///
    /// # Safety
    /// As of [`View::bond`].
    #[inline(always)]
    pub unsafe fn deformed<L: Lane>(
        &self,
        at: &GroupOf<L, D, F, M>,
        k: usize,
        ends: F::Slots,
        dead: L::Mask,
        eta: [L; D],
    ) -> (Bond<L, D>, L) {
        // SAFETY: a bond of the group
        let r = unsafe {
            self.family
                .reference::<L>(at.number, k, &at.place, ends, dead)
        };
        let mut eta = eta;
        if !self.expansion.is_empty() {
            // SAFETY: slots of the family, a number per slot
            let [strain, per_length] = unsafe { grown(self.expansion, at.rows, ends) };
            for a in 0..D {
                eta[a] = ((eta[a] - strain * r.xi[a]) * per_length).zero_if(dead);
            }
        }
        let e = relative_square_stretch(eta, r.xi, r.two_by_square);
        let bond = Bond {
            xi: r.xi,
            eta,
            length: r.length,
            inv_length: r.inv_length,
            omega: r.omega.zero_if(dead),
            omega_back: r.omega_back.zero_if(dead),
            stretch: if M::STRETCHES {
                Series::<Stretch>::new().at(e)
            } else {
                e
            },
            inv_current: r.inv_length * lane::inv_sqrt(L::splat(1.0) + e),
        };
        (bond, r.weight)
    }

    /// What points have from outside.
    ///
    /// # Safety
    /// Slots of the family.
    #[inline(always)]
    pub unsafe fn around<L: Lane>(&self, slots: F::Slots) -> Around<L> {
        let mut section = L::splat(0.0);
        if M::SECTION && D == 2 && self.held && !self.expansion.is_empty() {
            // SAFETY: a number per slot
            let strain = unsafe { slots.one::<L>(self.expansion.as_ptr()) };
            section = (L::splat(0.0) - strain).div(L::splat(1.0) + strain);
        }
        Around { section }
    }

    /// `1/(1 + ε)` of the bonds from a group to these ends: what forces are multiplied by, since the law answers to `(ξ + η)/(1 + ε)`.
    ///
    /// # Safety
    /// The ends of a bond of the group.
    #[inline(always)]
    pub unsafe fn per_length<L: Lane>(&self, at: &GroupOf<L, D, F, M>, ends: F::Slots) -> L {
        if self.expansion.is_empty() {
            return L::splat(1.0);
        }
        // SAFETY: the caller's promise
        let [_, per_length] = unsafe { grown(self.expansion, at.rows, ends) };
        per_length
    }

    /// What is left of points' energy and force states.
    ///
    /// # Safety
    /// Slots of the family.
    #[inline(always)]
    pub unsafe fn integrity<L: Lane>(&self, slots: F::Slots) -> L {
        match !M::FORM_OF_WHOLE || self.integrity.is_empty() {
            true => L::splat(1.0),
            // SAFETY: a number per slot
            false => unsafe { slots.one::<L>(self.integrity.as_ptr()) },
        }
    }

    /// Stress across a body in plane strain, of points that have settled.
    ///
    /// # Safety
    /// A group of the family.
    #[inline(always)]
    pub unsafe fn across<L: Lane>(&self, at: &GroupOf<L, D, F, M>, point: &M::Point<L>) -> L {
        // SAFETY: rows of the family
        unsafe {
            let form = at.rows.load::<L, M::Form<L>>(self.form);
            let past = at.rows.load::<L, M::Past<L>>(self.past);
            let site = Site {
                constants: &at.constants,
                form: &form,
                past: &past,
                around: self.around::<L>(at.rows),
            };
            part_of(self.integrity::<L>(at.rows), self.law.across(&site, point))
        }
    }

    /// What a group's bond remembers.
    #[inline(always)]
    pub unsafe fn memory<L: Lane>(&self, number: usize, k: usize) -> M::Memory<L> {
        let count = <M::Memory<L> as Numbers<L>>::COUNT;
        let mut out = <M::Memory<L> as Numbers<L>>::constant(0.0);
        for n in 0..count {
            // SAFETY: numbers for every bond
            unsafe {
                let place = self.family.own(number, k, n, count);
                out.set(n, L::load(self.memory.at(place)));
            }
        }
        out
    }

    /// What the bonds remember that lead back.
    #[inline(always)]
    pub unsafe fn memory_back<L: Lane>(&self, number: usize, k: usize) -> M::Memory<L> {
        let count = <M::Memory<L> as Numbers<L>>::COUNT;
        let mut out = <M::Memory<L> as Numbers<L>>::constant(0.0);
        for n in 0..count {
            // SAFETY: numbers for every bond
            out.set(n, unsafe {
                self.family.back::<L>(self.memory, number, k, 0, n, count)
            });
        }
        out
    }

    #[inline(always)]
    pub unsafe fn point<L: Lane>(&self, slots: F::Slots) -> M::Point<L> {
        // SAFETY: slots of the family
        unsafe { slots.load::<L, M::Point<L>>(self.point) }
    }

    /// The sum of a pass over the intact bonds of a group, whose points are as the pass before left them.
    ///
    /// # Safety
    /// A group of the family.
    #[inline(always)]
    pub unsafe fn sum<L: Lane>(
        &self,
        pass: usize,
        at: &GroupOf<L, D, F, M>,
        point: &M::Point<L>,
    ) -> M::Sum<L> {
        let mut sum = <M::Sum<L> as Numbers<L>>::constant(0.0);
        // SAFETY: bonds of the group
        unsafe {
            for k in 0..self.family.bonds(at.number) {
                let ends = self.family.ends(at.number, k);
                let (bond, weight) = self.bond::<L>(at, k, ends, self.dead::<L>(at.number, k));
                let memory = self.memory::<L>(at.number, k);
                let end = End {
                    constants: &at.constants,
                    point,
                    memory: &memory,
                };
                sum = sum.plus(weight, self.law.pair_pass(pass, &bond, &end));
            }
        }
        sum
    }

    /// What points make of a sum.
    #[inline(always)]
    pub unsafe fn point_update<L: Lane>(
        &self,
        pass: usize,
        at: &GroupOf<L, D, F, M>,
        sum: M::Sum<L>,
        point: &mut M::Point<L>,
    ) {
        // SAFETY: rows of the family
        unsafe {
            let form = at.rows.load::<L, M::Form<L>>(self.form);
            let past = at.rows.load::<L, M::Past<L>>(self.past);
            let site = Site {
                constants: &at.constants,
                form: &form,
                past: &past,
                around: self.around::<L>(at.rows),
            };
            self.law.point_update(pass, &site, sum, point);
        }
    }
}

/// `bond` from its other end.
#[inline(always)]
pub fn mirrored<N: Number, const D: usize>(bond: &Bond<N, D>) -> Bond<N, D> {
    let mut out = *bond;
    (out.omega, out.omega_back) = (bond.omega_back, bond.omega);
    let zero = N::constant(0.0);
    for a in 0..D {
        out.xi[a] = zero - bond.xi[a];
        out.eta[a] = zero - bond.eta[a];
    }
    out
}

/// Write a group's numbers.
///
/// # Safety
/// Rows of the store's family, and nobody else writes them.
#[inline(always)]
pub unsafe fn save<L: Lane, S: Slots, N: Numbers<L>>(rows: OwnRows, slots: S, value: &N) {
    value.write(&mut RowsOf(rows, slots), 0);
}

/// The numbers of a group, made where nobody else writes them.
struct RowsOf<S>(OwnRows, S);

impl<L: Lane, S: Slots> Sink<L> for RowsOf<S> {
    #[inline(always)]
    fn put(&mut self, n: usize, x: L) {
        let RowsOf(rows, slots) = self;
        // SAFETY: the promise of `save`
        unsafe {
            if rows.layout.records {
                let all = x.to_array();
                for l in 0..TILE {
                    *rows.data.at(rows.layout.at(n, slots.slot(l))) = all[l];
                }
            } else {
                x.store(rows.data.at(rows.layout.at(n, slots.slot(0))));
            }
        }
    }
}
