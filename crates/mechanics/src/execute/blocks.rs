//! Blocks of work on threads. A block is a fixed piece of the work, whoever does it, and results are kept in
//! block order: the number of threads never shows in the bits.

use super::exact::Exact;
use super::simd::{Kernel, Simd};
use peridyne_comm::Comm;
use rayon::prelude::*;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Do `work` for every number below `count`, on threads. One call through a pointer per block costs nothing; the machinery of
/// threads compiled for each of hundreds of kernels was a third of this crate.
fn spread(count: usize, work: &(dyn Fn(usize) + Sync)) {
    if rayon::current_num_threads() == 1 || count == 1 {
        (0..count).for_each(work);
    } else {
        (0..count).into_par_iter().for_each(work);
    }
}

/// Blocks of work, in ascending order.
#[derive(Debug, Clone, Copy)]
pub enum Which<'a> {
    All,
    These(&'a [u32]),
}

impl Which<'_> {
    /// Do `work` for each of these of so many.
    fn spread(self, all: usize, work: &(dyn Fn(usize) + Sync)) {
        match self {
            Which::All => spread(all, work),
            Which::These(blocks) => {
                let ascend = blocks.is_sorted_by(|a, b| a < b);
                assert!(ascend && blocks.last().is_none_or(|b| (*b as usize) < all));
                spread(blocks.len(), &|n| work(blocks[n] as usize));
            }
        }
    }
}

/// Run `kernel` on every block and leave block `b`'s result in `out[b]`.
pub fn for_each_block<K: Kernel>(simd: Simd, kernel: &K, out: &mut [K::Out]) {
    for_which_blocks(simd, kernel, Which::All, out);
}

fn for_which_blocks<K: Kernel>(simd: Simd, kernel: &K, which: Which<'_>, out: &mut [K::Out]) {
    let place = Shared(out.as_mut_ptr());
    which.spread(out.len(), &|b| {
        let result = simd.run(kernel, b);
        // SAFETY: each number below the length is asked for at most once, by one thread
        unsafe { *place.at(b) = result };
    });
}

/// Run `kernel`, which returns nothing, on so many blocks.
pub fn run_blocks<K: Kernel<Out = ()>>(simd: Simd, kernel: &K, blocks: usize) {
    run_which_blocks(simd, kernel, Which::All, blocks);
}

/// The same on some of so many.
pub fn run_which_blocks<K: Kernel<Out = ()>>(
    simd: Simd,
    kernel: &K,
    which: Which<'_>,
    blocks: usize,
) {
    which.spread(blocks, &|b| simd.run(kernel, b));
}

/// Room for a result per block, kept from sweep to sweep so that sweeps do not allocate.
#[derive(Debug)]
pub struct PerBlock<T> {
    blocks: usize,
    empty: T,
    workspace: Mutex<Vec<T>>,
    /// Ranks that have the other blocks.
    ranks: Option<Arc<Comm>>,
}

impl<T: Copy + Send> PerBlock<T> {
    pub fn new(blocks: usize, empty: T) -> Self {
        PerBlock {
            blocks,
            empty,
            workspace: Mutex::new(vec![empty; blocks]),
            ranks: None,
        }
    }

    /// The same, of a body of which other ranks have other parts; `None`: it is whole.
    pub fn among(mut self, ranks: Option<&Arc<Comm>>) -> Self {
        self.ranks = ranks.cloned();
        self
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.blocks
    }

    fn workspace(&self) -> MutexGuard<'_, Vec<T>> {
        self.workspace
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Run `kernel` on every block of this rank and fold its results, in the order of blocks.
    pub fn fold<K: Kernel<Out = T>>(&self, simd: Simd, kernel: &K, add: impl Fn(&mut T, T)) -> T {
        let mut total = self.empty;
        self.for_each(simd, kernel, Which::All, |result| add(&mut total, *result));
        total
    }

    /// Run `kernel` on blocks of this rank and look at the last results of all, in the order of blocks.
    pub fn for_each<K: Kernel<Out = T>>(
        &self,
        simd: Simd,
        kernel: &K,
        which: Which<'_>,
        mut look: impl FnMut(&T),
    ) {
        self.each(
            &|workspace| for_which_blocks(simd, kernel, which, workspace),
            &mut look,
        );
    }

    /// The same of who fills the room: the kernel does not show in this code.
    fn each(&self, fill: &dyn Fn(&mut [T]), look: &mut dyn FnMut(&T)) {
        // taken, not held: a thread that waits for its blocks may be lent to a sweep that also wants the room
        let mut workspace = std::mem::take(&mut *self.workspace());
        workspace.resize(self.blocks, self.empty);
        fill(&mut workspace);
        workspace.iter().for_each(look);
        *self.workspace() = workspace;
    }
}

impl<const N: usize> PerBlock<[f64; N]> {
    /// Room for `N` sums.
    pub fn sums(blocks: usize) -> Self {
        PerBlock::new(blocks, [0.0; N])
    }

    /// Run `kernel` on every block, of all ranks, and add its results up.
    pub fn sum<K: Kernel<Out = [f64; N]>>(&self, simd: Simd, kernel: &K) -> [f64; N] {
        self.total(&|workspace| for_each_block(simd, kernel, workspace))
    }

    fn total(&self, fill: &dyn Fn(&mut [[f64; N]])) -> [f64; N] {
        let mut sums = [const { Exact::ZERO }; N];
        self.each(fill, &mut |result| {
            for (sum, x) in sums.iter_mut().zip(result) {
                sum.add(*x);
            }
        });
        if let Some(ranks) = &self.ranks {
            Exact::of_all(&mut sums, ranks);
        }
        sums.map(|sum| sum.value())
    }
}

/// Elements of an array that one thread takes at a time.
const PIECE: usize = 2048;

/// Change an array piece by piece, on threads: `change(n, piece)`, where `n` is the number of the piece's first element.
pub fn for_each_piece<T: Send>(data: &mut [T], change: impl Fn(usize, &mut [T]) + Sync) {
    if rayon::current_num_threads() == 1 || data.len() <= PIECE {
        return change(0, data);
    }
    let (place, len) = (Shared(data.as_mut_ptr()), data.len());
    spread(len.div_ceil(PIECE), &|n| {
        let first = n * PIECE;
        let count = PIECE.min(len - first);
        // SAFETY: pieces lie inside the array and do not overlap; each is asked for once, by one thread
        change(first, unsafe {
            std::slice::from_raw_parts_mut(place.at(first), count)
        });
    });
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

/// A pointer that blocks only read through: what was borrowed without `mut` is not written.
pub struct Seen<T = f64>(pub *const T);

impl<T> Clone for Seen<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Seen<T> {}

// SAFETY: whoever writes what it points to does so at other points than those that other blocks read meanwhile
unsafe impl<T: Sync> Send for Seen<T> {}
unsafe impl<T: Sync> Sync for Seen<T> {}

impl<T> Seen<T> {
    /// # Safety
    /// `i` lies inside the array.
    #[inline(always)]
    pub unsafe fn at(self, i: usize) -> *const T {
        // SAFETY: the caller's promise
        unsafe { self.0.add(i) }
    }
}

impl<T> Shared<T> {
    /// Nobody asks for what would be written.
    pub const fn nobody() -> Self {
        Shared(std::ptr::null_mut())
    }

    /// For those who read beside those who write.
    #[inline(always)]
    pub fn seen(self) -> Seen<T> {
        Seen(self.0)
    }
}

impl Shared {
    pub const NULL: Shared = Shared::nobody();
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
