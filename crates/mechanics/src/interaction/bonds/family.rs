//! What a family is to the sweeps of a law: groups of eight points, whose bonds are walked together.

use super::store::Rows;
use crate::body::grid::BLOCK;
use crate::body::{Body, Exchange, FieldView};
use crate::execute::blocks::{Seen, Shared};
use crate::execute::lane::{Lane, TILE};
use crate::law::material::{Numbers, Partner, ReferenceFamily};
use std::ops::Range;

/// Eight slots: where the points of a group are, or their partners along one of its bonds.
pub trait Slots: Copy {
    /// One of them.
    fn slot(self, l: usize) -> usize;
    /// Those from the l-th on, for a lane of one.
    fn from(self, l: usize) -> Self;
    /// # Safety
    /// The slots lie inside the array.
    unsafe fn one<L: Lane>(self, column: *const f64) -> L;
    /// # Safety
    /// The slots lie inside the store, which has the layout of the family.
    unsafe fn load<L: Lane, N: Numbers<L>>(self, rows: Rows) -> N;
}

/// A bond in the reference.
#[derive(Clone, Copy)]
pub struct Reference<L, const D: usize> {
    pub xi: [L; D],
    pub length: L,
    pub inv_length: L,
    /// 2/|ξ|²
    pub two_by_square: L,
    /// ω, and that of the other end
    pub omega: L,
    pub omega_back: L,
    /// `ν V_j`
    pub weight: L,
}

/// Displacements as sweeps read them.
#[derive(Clone, Copy)]
pub struct Moved<'a, const D: usize> {
    pub columns: FieldView<'a, D>,
    /// `[slots][4]`: displacement, where the family gathers; else empty.
    pub records: &'a [f64],
}

/// A family in groups of eight points. Implemented by what the engine itself made: unsafe functions trust it.
pub trait Family<const D: usize>: Send + Sync + 'static {
    type Slots: Slots;
    /// What a group has of its points in the reference.
    type Place<L: Lane>: Copy;

    fn groups(&self) -> usize;
    fn rows(&self, group: usize) -> Self::Slots;
    /// Bonds that any of a group's points has.
    fn bonds(&self, group: usize) -> usize;
    fn ends(&self, group: usize, k: usize) -> Self::Slots;
    /// Place of the byte with a bit for each of the eight.
    fn byte(&self, group: usize, k: usize) -> usize;
    /// Bytes in all.
    fn bytes_of_bits(&self) -> usize;
    /// Is the point of this group a point of the body?
    fn is_point(&self, group: usize, l: usize) -> bool;
    /// Is there a partner, whole bond or not?
    fn is_bond(&self, group: usize, k: usize, l: usize) -> bool;

    /// # Safety
    /// Rows of this family.
    unsafe fn place<L: Lane>(&self, rows: Self::Slots) -> Self::Place<L>;
    /// # Safety
    /// A bond of the group, and its ends; `dead` are lanes without a whole bond.
    unsafe fn reference<L: Lane>(
        &self,
        group: usize,
        k: usize,
        at: &Self::Place<L>,
        ends: Self::Slots,
        dead: L::Mask,
    ) -> Reference<L, D>;
    /// # Safety
    /// Slots of this family, and the columns of its body.
    unsafe fn displacement<L: Lane>(moved: &Moved<D>, slots: Self::Slots) -> [L; D];

    /// Horizon of a point over that of the body (–).
    fn reach(&self, _slot: usize) -> f64 {
        1.0
    }

    /// Blocks of work.
    fn blocks(&self) -> usize {
        self.groups().div_ceil(BLOCK)
    }
    /// The groups of a block.
    #[inline(always)]
    fn block(&self, block: usize) -> Range<usize> {
        block * BLOCK..((block + 1) * BLOCK).min(self.groups())
    }

    /// How numbers of points are laid out.
    fn layout(&self, numbers: usize) -> super::store::Layout;
    /// How many numbers it takes to remember one for each bond.
    fn memory(&self) -> usize;
    /// Where number `n` of `count` of a bond's eight is remembered, side by side.
    fn own(&self, group: usize, k: usize, n: usize, count: usize) -> usize;
    /// The same of the bonds that lead back.
    ///
    /// # Safety
    /// A bond of the group; memory as large as [`Family::memory`] says.
    unsafe fn back<L: Lane>(
        &self,
        memory: Seen,
        group: usize,
        k: usize,
        part: usize,
        n: usize,
        count: usize,
    ) -> L;
    /// Fills what the bonds of copies remember, `count` numbers each.
    fn fill_memory(&self, exchange: &Exchange, memory: &mut [f64], count: usize);

    /// One bond in the reference, whole or not.
    fn plain(&self, group: usize, k: usize, l: usize) -> Reference<f64, D> {
        let (rows, ends) = (self.rows(group).from(l), self.ends(group, k).from(l));
        // SAFETY: a bond of this family
        unsafe {
            let at = self.place::<f64>(rows);
            self.reference::<f64>(group, k, &at, ends, f64::dead(1))
        }
    }

    /// ξ and `ν V_j` of one bond.
    fn bond(&self, group: usize, k: usize, l: usize) -> ([f64; D], f64) {
        let r = self.plain(group, k, l);
        (r.xi, r.weight)
    }

    /// Does damage count a bond? All that the family ever had, where no bits say which.
    fn counts(&self, counted: &[u8], (group, k, l): (usize, usize, usize)) -> bool {
        match counted.get(self.byte(group, k)) {
            Some(bits) => bits >> l & 1 == 1,
            None => self.is_bond(group, k, l),
        }
    }

    /// Bits of the bonds of a group, among those of all.
    fn bits<'a>(&self, all: &'a [u8], group: usize) -> &'a [u8] {
        match self.bonds(group) {
            0 => &[],
            bonds => &all[self.byte(group, 0)..][..bonds],
        }
    }

    /// Asks something of the reference family of one point, of which these bonds are left.
    fn reference_family(
        &self,
        group: usize,
        bits: &[u8],
        l: usize,
        ask: &mut dyn FnMut(ReferenceFamily<D>),
    ) {
        let each = |visit: &mut dyn FnMut(&Partner<D>)| {
            for (k, bits) in bits.iter().enumerate() {
                if bits >> l & 1 == 0 {
                    continue;
                }
                let r = self.plain(group, k, l);
                visit(&Partner {
                    xi: r.xi,
                    omega: r.omega,
                    volume: r.weight,
                });
            }
        };
        let slot = self.rows(group).from(l).slot(0);
        let lost = |(k, bits): (usize, &u8)| self.is_bond(group, k, l) && bits >> l & 1 == 0;
        let damaged = bits.iter().enumerate().any(lost);
        ask(ReferenceFamily::new(&each)
            .within(self.reach(slot))
            .damaged(damaged));
    }

    /// Points of the body, group by group: group, place in it, slot.
    fn points(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        self.points_of(0..self.groups())
    }

    /// Those of some groups.
    fn points_of(&self, groups: Range<usize>) -> impl Iterator<Item = (usize, usize, usize)> {
        groups.flat_map(move |group| {
            let places = (0..TILE).filter(move |l| self.is_point(group, *l));
            places.map(move |l| (group, l, self.rows(group).slot(l)))
        })
    }

    /// Do two points have a bond, whole or not, images resolved?
    fn joins(&self, body: &Body<D>, i: usize, j: usize) -> bool {
        let Some((group, l)) = self.find(i) else {
            return false;
        };
        (0..self.bonds(group)).any(|k| {
            body.exchange.original(self.ends(group, k).slot(l)) == j && self.is_bond(group, k, l)
        })
    }

    /// Group and place in it of a slot; `None`: no point.
    fn find(&self, slot: usize) -> Option<(usize, usize)>;
    fn bytes(&self) -> usize;
}

/// Write eight numbers to a column.
///
/// # Safety
/// The slots lie inside the array, and nobody else writes there.
#[inline(always)]
pub unsafe fn put<L: Lane, S: Slots>(value: L, out: Shared, slots: S) {
    let all = value.to_array();
    for l in 0..TILE {
        // SAFETY: the caller's promise
        unsafe { *out.at(slots.slot(l)) = all[l] };
    }
}
