//! Blocks of work on threads. A block is a fixed piece of the work, whoever does it, and results are kept in
//! block order: the number of threads never shows in the bits.

use super::simd::{Kernel, Simd};
use rayon::prelude::*;

/// Run `kernel` on every block and leave block `b`'s result in `out[b]`.
pub fn for_each_block<K: Kernel>(simd: Simd, kernel: &K, out: &mut [K::Out]) {
    if rayon::current_num_threads() == 1 || out.len() == 1 {
        out.iter_mut()
            .enumerate()
            .for_each(|(b, o)| *o = simd.run(kernel, b));
    } else {
        out.par_iter_mut()
            .enumerate()
            .for_each(|(b, o)| *o = simd.run(kernel, b));
    }
}

/// A pointer that several blocks write through, each to its own points.
#[derive(Clone, Copy)]
pub struct Shared(pub *mut f64);

// SAFETY: whoever uses it writes disjoint points from different blocks
unsafe impl Send for Shared {}
unsafe impl Sync for Shared {}

impl Shared {
    pub const NULL: Shared = Shared(std::ptr::null_mut());
    /// # Safety
    /// `i` lies inside the array.
    #[inline(always)]
    pub unsafe fn at(self, i: usize) -> *mut f64 {
        // SAFETY: the caller's promise
        unsafe { self.0.add(i) }
    }
}
