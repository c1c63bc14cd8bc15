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
pub struct Shared<T = f64>(pub *mut T);

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Shared<T> {}

// SAFETY: whoever uses it writes disjoint points from different blocks
unsafe impl<T: Send> Send for Shared<T> {}
unsafe impl<T: Send> Sync for Shared<T> {}

impl Shared {
    pub const NULL: Shared = Shared(std::ptr::null_mut());
}

impl<T> Shared<T> {
    /// # Safety
    /// `i` lies inside the array.
    #[inline(always)]
    pub unsafe fn at(self, i: usize) -> *mut T {
        // SAFETY: the caller's promise
        unsafe { self.0.add(i) }
    }
}
