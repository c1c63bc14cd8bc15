//! How work is cut for threads. The sums of a parallel factorisation follow the cut, so the cut must not follow the number of
//! threads: it is the same for one as for many, and so are the bits.

use faer::Par;

/// Parts that the work of faer is cut into, whoever does them.
const PARTS: usize = 4;

/// Cut what faer does next into [`PARTS`]; by itself it would ask how many threads there are.
pub(crate) fn fix() {
    faer::set_global_parallelism(Par::rayon(PARTS));
}
