//! How faer works: one thread for one matrix. Its parallel sums follow the number of threads, and so would the last bits; they are
//! no faster either: a plate of 150 × 150 points (LPS, 45,000 unknowns) took 4.0 s on one thread, 5.6 s on two and 9.8 s on
//! four of a busy machine of two cores (docs/decisions/0005-factors.md).

use faer::Par;

/// What faer does next it does by itself; left alone it would ask how many threads there are.
pub(crate) fn fix() {
    faer::set_global_parallelism(Par::Seq);
}
