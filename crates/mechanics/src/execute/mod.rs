//! How loops run: lanes of a vector register, and blocks of points shared out to threads.

pub(crate) mod blocks;
pub mod exact;
pub mod lane;
pub mod memory;
pub mod simd;

pub use blocks::{Shared, for_each_block, for_each_piece};
