//! What sweeps read of bonds, whatever their law.

use super::family::{Family, Moved, Reference, Slots};
use super::store::Rows;
use crate::execute::blocks::Seen;
use crate::execute::lane::Lane;

/// Groups per block of work.
pub use crate::body::grid::BLOCK;

/// Bonds as sweeps of a law, and what is made of their answers, read them.
pub struct BondView<'a, const D: usize, F> {
    pub family: &'a F,
    pub moved: Moved<'a, D>,
    /// Bits of whole bonds.
    pub alive: Seen<u8>,
    /// `[materials][numbers]`
    pub constants: &'a [f64],
    /// Material per slot; empty: one.
    pub material: &'a [u8],
    /// Constants of every point, of laws whose constants differ from place to place.
    pub placed: Rows,
    /// Are those of all points the same?
    pub alike: bool,
    pub form: Rows,
    pub point: Rows,
    pub past: Rows,
    /// What bonds remember.
    pub memory: Seen,
    /// Strain by temperature or swelling per slot; empty: none.
    pub expansion: &'a [f64],
    /// Is the section held, as in plane strain?
    pub held: bool,
    /// What is left of each slot's energy and force states ([`BondState::integrity`](super::BondState)); empty: all of them.
    pub integrity: &'a [f64],
}

impl<const D: usize, F> Clone for BondView<'_, D, F> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<const D: usize, F> Copy for BondView<'_, D, F> {}

/// The points of a group.
pub struct Points<L: Lane, S, P, const D: usize> {
    pub number: usize,
    pub rows: S,
    pub place: P,
    pub u: [L; D],
}

/// The points of a group of a family.
pub type PointsOf<L, const D: usize, F> =
    Points<L, <F as Family<D>>::Slots, <F as Family<D>>::Place<L>, D>;

impl<const D: usize, F: Family<D>> BondView<'_, D, F> {
    /// # Safety
    /// A group of the family.
    #[inline(always)]
    pub unsafe fn points<L: Lane>(&self, number: usize) -> PointsOf<L, D, F> {
        let rows = self.family.rows(number);
        // SAFETY: rows of the family
        unsafe {
            Points {
                number,
                rows,
                place: self.family.place::<L>(rows),
                u: F::displacement::<L>(&self.moved, rows),
            }
        }
    }

    /// Bond `k` of a group in the reference, and its η as laws see it; lanes that are `dead` have a bond at rest and a weight of 0.
    ///
    /// # Safety
    /// A bond of the group.
    #[inline(always)]
    pub unsafe fn stretched<L: Lane>(
        &self,
        at: &PointsOf<L, D, F>,
        k: usize,
        dead: L::Mask,
    ) -> (Reference<L, D>, [L; D]) {
        let ends = self.family.ends(at.number, k);
        // SAFETY: a bond of the group, whose ends are slots of the family
        unsafe {
            let mut eta = F::displacement::<L>(&self.moved, ends);
            for a in 0..D {
                eta[a] = (eta[a] - at.u[a]).zero_if(dead);
            }
            let r = self
                .family
                .reference::<L>(at.number, k, &at.place, ends, dead);
            if !self.expansion.is_empty() {
                let [strain, per_length] = grown(self.expansion, at.rows, ends);
                for a in 0..D {
                    eta[a] = ((eta[a] - strain * r.xi[a]) * per_length).zero_if(dead);
                }
            }
            (r, eta)
        }
    }

    /// Lanes without a whole bond.
    ///
    /// # Safety
    /// A bond of the group.
    #[inline(always)]
    pub unsafe fn dead<L: Lane>(&self, group: usize, k: usize) -> L::Mask {
        // SAFETY: a byte per bond
        L::dead(unsafe { *self.alive.at(self.family.byte(group, k)) })
    }

    pub fn block(&self, block: usize) -> std::ops::Range<usize> {
        self.family.block(block)
    }

    /// Bits of the bonds of a group.
    ///
    /// # Safety
    /// A group of the family; nobody writes them meanwhile.
    #[inline(always)]
    pub unsafe fn bits(&self, group: usize) -> &[u8] {
        let bonds = self.family.bonds(group);
        if bonds == 0 {
            return &[];
        }
        // SAFETY: the bytes of a group lie side by side
        unsafe { std::slice::from_raw_parts(self.alive.at(self.family.byte(group, 0)), bonds) }
    }
}

/// ε and `1/(1 + ε)` of bonds, ε the mean of both ends. Laws see `(ξ + η)/(1 + ε) = ξ + (η − ε ξ)/(1 + ε)`.
///
/// # Safety
/// A number for each of the slots.
#[inline(always)]
pub unsafe fn grown<L: Lane, S: Slots>(expansion: &[f64], own: S, ends: S) -> [L; 2] {
    let column = expansion.as_ptr();
    // SAFETY: the caller's promise
    let both = unsafe { own.one::<L>(column) + ends.one::<L>(column) };
    let strain = L::splat(0.5) * both;
    [strain, L::splat(1.0).div(strain + L::splat(1.0))]
}
