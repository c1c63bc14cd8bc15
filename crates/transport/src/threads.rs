//! Fixed pieces of arrays on threads. Every number is made by the same operations whoever makes it, so the bits do not know how many threads there are.

use rayon::prelude::*;

/// Numbers of a piece: whole blocks of direct sums.
pub(crate) const PIECE: usize = 2048;

/// Additions that are worth waking a thread for.
const LEAST: usize = 1 << 16;

/// Are so many numbers, of so many additions each, worth more than one thread?
pub(crate) fn pays(numbers: usize, work: usize) -> bool {
    rayon::current_num_threads() > 1 && numbers.saturating_mul(work) >= LEAST
}

/// `change(first, piece)` of all pieces of `length` numbers, which begin at the number `first`; `work`: additions for a number.
pub(crate) fn pieces<T: Send>(
    out: &mut [T],
    length: usize,
    work: usize,
    change: impl Fn(usize, &mut [T]) + Sync,
) {
    if out.len() > length && pays(out.len(), work) {
        let each = out.par_chunks_mut(length).enumerate();
        each.for_each(|(n, piece)| change(n * length, piece));
    } else {
        let each = out.chunks_mut(length).enumerate();
        each.for_each(|(n, piece)| change(n * length, piece));
    }
}

/// The same of two arrays of one length.
pub(crate) fn pieces_of_two(
    a: &mut [f64],
    b: &mut [f64],
    work: usize,
    change: impl Fn(usize, &mut [f64], &mut [f64]) + Sync,
) {
    if a.len() > PIECE && pays(a.len(), work) {
        let each = a.par_chunks_mut(PIECE).zip(b.par_chunks_mut(PIECE));
        each.enumerate()
            .for_each(|(n, (a, b))| change(n * PIECE, a, b));
    } else {
        change(0, a, b);
    }
}

/// Pieces with memory of their own, which `room` makes for a thread.
pub(crate) fn pieces_with<T: Send, R>(
    out: &mut [T],
    length: usize,
    work: usize,
    room: impl Fn() -> R + Sync + Send,
    change: impl Fn(&mut R, usize, &mut [T]) + Sync + Send,
) {
    if out.len() > length && pays(out.len(), work) {
        let each = out.par_chunks_mut(length).enumerate();
        each.for_each_init(room, |room, (n, piece)| change(room, n * length, piece));
    } else {
        let mut room = room();
        let each = out.chunks_mut(length).enumerate();
        each.for_each(|(n, piece)| change(&mut room, n * length, piece));
    }
}
