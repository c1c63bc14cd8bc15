//! A few bonds of a tile on their way through a sweep.

use super::{Bond, View};
use crate::execute::lane::Lane;
use crate::execute::lane::series::{Function, Series, Sink};
use crate::law::Law;
use std::mem::MaybeUninit;

/// Bonds that go from loop to loop together. Short loops keep more bonds in flight than one long one, whose chain of
/// dependent operations fills the processor's window; and nothing that depends on a bond decides where something is
/// stored (docs/decisions/0001-hot-loop.md).
pub const CHUNK: usize = 32;

/// A number for each bond: `e`, or a function of it; not a number where the bond is not whole.
pub struct Chunk<L>([MaybeUninit<L>; CHUNK]);

/// What the bonds of a chunk have in common.
pub struct Extremes<L: Lane> {
    /// The lowest `e` of a whole bond; infinite if there is none.
    pub low: L,
    /// The highest, at least 0.
    pub high: L,
    /// Lanes with a bond that is closer than allowed, whole or not; not known of tiles whose bonds are all whole.
    pub close: L::Mask,
}

impl<L: Lane> Extremes<L> {
    /// No `e` is larger in size.
    #[inline(always)]
    fn largest(&self) -> L {
        (L::splat(0.0) - self.low).max(self.high)
    }
}

impl<L: Lane> Sink<L> for Chunk<L> {
    #[inline(always)]
    fn put(&mut self, k: usize, value: L) {
        debug_assert!(k < CHUNK);
        // SAFETY: `each` takes no more numbers than a chunk has
        unsafe {
            self.0.get_unchecked_mut(k).write(value);
        }
    }
}

impl<L: Lane> Chunk<L> {
    #[inline(always)]
    pub fn new() -> Self {
        Chunk([MaybeUninit::uninit(); CHUNK])
    }

    /// `e` of `bonds` for the points at `i`. With `MASKED` some bonds are not whole, as `row` says; with `CONTACT` they
    /// may be too close.
    ///
    /// # Safety
    /// At most [`CHUNK`] bonds, with a byte for each in `row`; all points inside the arrays.
    #[inline(always)]
    pub unsafe fn deform<const D: usize, W: Law, const MASKED: bool, const CONTACT: bool>(
        &mut self,
        view: &View<D, W>,
        bonds: &[Bond<D>],
        row: *const u8,
        i: usize,
        ui: &[L; D],
    ) -> Extremes<L> {
        let zero = L::splat(0.0);
        let (mut low, mut high) = (L::splat(f64::INFINITY), zero);
        let mut close = zero.lt(zero);
        for (c, b) in bonds.iter().enumerate() {
            // SAFETY: the caller's promise
            unsafe {
                let raw = view.deform(b, i, ui);
                let mut e = raw;
                if MASKED {
                    e = raw.nan_if(L::dead(*row.add(b.number as usize)));
                    if CONTACT {
                        close = L::or(close, raw.lt(L::splat(b.contact_e)));
                    }
                }
                low = e.min(low);
                high = e.max(high);
                self.0.get_unchecked_mut(c).write(e);
            }
        }
        Extremes { low, high, close }
    }

    /// A function of the first `n`, in the chunk that is returned: near rest in `near`, which no call ever sees, so that the
    /// compiler knows what writing to it can change; else in this one.
    ///
    /// # Safety
    /// They were written, and none lies outside the extremes.
    #[inline(always)]
    pub unsafe fn each<'a, F: Function>(
        &'a mut self,
        n: usize,
        series: Series<F>,
        of: &Extremes<L>,
        near: &'a mut Chunk<L>,
    ) -> &'a Chunk<L> {
        // SAFETY: the caller's promise
        let e = unsafe { self.first(n) };
        if series.near(e, of.largest(), near) {
            return near;
        }
        series.far(e, of.largest());
        self
    }

    /// The same to `sink`, in order.
    ///
    /// # Safety
    /// As of [`Chunk::each`].
    #[inline(always)]
    pub unsafe fn each_to<F: Function>(
        &mut self,
        n: usize,
        series: Series<F>,
        of: &Extremes<L>,
        sink: &mut impl Sink<L>,
    ) {
        // SAFETY: the caller's promise
        let e = unsafe { self.first(n) };
        if !series.near(e, of.largest(), sink) {
            series.far(e, of.largest());
            for (k, value) in e.iter().enumerate() {
                sink.put(k, *value);
            }
        }
    }

    /// # Safety
    /// They were written.
    #[inline(always)]
    unsafe fn first(&mut self, n: usize) -> &mut [L] {
        debug_assert!(n <= CHUNK);
        // SAFETY: the caller's promise
        unsafe { std::slice::from_raw_parts_mut(self.0.as_mut_ptr().cast(), n) }
    }

    /// # Safety
    /// Number `c` was written.
    #[inline(always)]
    pub unsafe fn get(&self, c: usize) -> L {
        // SAFETY: the caller's promise
        unsafe { self.0.get_unchecked(c).assume_init() }
    }

    /// Leave lanes out of what follows.
    ///
    /// # Safety
    /// Number `c` was written.
    #[inline(always)]
    pub unsafe fn leave_out(&mut self, c: usize, lanes: L::Mask) {
        // SAFETY: the caller's promise
        unsafe {
            let e = self.get(c).nan_if(lanes);
            self.0.get_unchecked_mut(c).write(e);
        }
    }
}
