//! The batteries: what every material must do on every lattice and in every dimension, through the public interface.
//!
//! A line in [`sample::materials`] buys a material all of these tests.

mod accounts;
mod calibration;
mod cracks;
mod equivalence;
mod mechanics;
mod motion;
mod repeat;
mod sample;
mod shifted;
mod stability;
mod tangents;
mod waves;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// Counts allocations of each thread, so that tests beside each other do not disturb the count.
struct Counting;
thread_local!(static ALLOCATIONS: Cell<u64> = const { Cell::new(0) });

// SAFETY: hands everything to the system
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = ALLOCATIONS.try_with(|n| n.set(n.get() + 1));
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, p: *mut u8, layout: Layout) {
        unsafe { System.dealloc(p, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Allocations of this thread so far.
fn allocations() -> u64 {
    ALLOCATIONS.with(Cell::get)
}
