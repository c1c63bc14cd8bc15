//! The offsets that lead anywhere from a tile.

use super::{Bond, MOST};
use std::mem::MaybeUninit;

/// Words of `reach` that are taken together.
const WORDS: usize = 8;

/// Bonds of a tile, side by side: those of the stencil itself where all of a stretch lead somewhere, else copies of
/// those that do. Neighbouring tiles mostly share them.
pub struct Offsets<const D: usize> {
    /// What the copies were made from.
    stencil: *const Bond<D>,
    first: usize,
    reach: [u64; WORDS],
    copies: [MaybeUninit<Bond<D>>; 64 * WORDS],
    len: usize,
}

impl<const D: usize> Offsets<D> {
    #[inline(always)]
    pub fn new() -> Self {
        const { assert!(MOST.is_multiple_of(64 * WORDS)) };
        Offsets {
            stencil: std::ptr::null(),
            first: 0,
            reach: [0; WORDS],
            copies: [const { MaybeUninit::uninit() }; 64 * WORDS],
            len: 0,
        }
    }

    /// Those of `stencil` from word `first` of `reach` on, and the word after them.
    #[inline(always)]
    pub fn stretch<'a>(
        &'a mut self,
        stencil: &'a [Bond<D>],
        reach: &[u64],
        first: usize,
    ) -> (&'a [Bond<D>], usize) {
        let end = (first + WORDS).min(reach.len());
        let words = &reach[first..end];
        let all = &stencil[64 * first..(64 * end).min(stencil.len())];
        let count: u32 = words.iter().map(|w| w.count_ones()).sum();
        if count as usize == all.len() {
            return (all, end);
        }
        let known = self.stencil == stencil.as_ptr()
            && self.first == first
            && self.reach[..words.len()] == *words;
        if !known {
            self.copy(all, words);
            (self.stencil, self.first) = (stencil.as_ptr(), first);
        }
        // SAFETY: `copy` wrote this many
        let copies = unsafe { std::slice::from_raw_parts(self.copies.as_ptr().cast(), self.len) };
        (copies, end)
    }

    #[inline(never)]
    fn copy(&mut self, all: &[Bond<D>], words: &[u64]) {
        self.len = 0;
        for (w, &word) in words.iter().enumerate() {
            self.reach[w] = word;
            let mut bits = word;
            while bits != 0 {
                self.copies[self.len].write(all[64 * w + bits.trailing_zeros() as usize]);
                self.len += 1;
                bits &= bits - 1;
            }
        }
    }
}
