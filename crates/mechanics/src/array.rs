//! Arrays made by their index.

use std::mem::MaybeUninit;

/// As [`std::array::from_fn`], in one small function for each closure: the standard one is five, and with some 1,600 closures they were a
/// twentieth of what this crate had the compiler do. Elements that are made when `make` panics are leaked.
#[inline]
pub fn from_fn<T, const N: usize, F: FnMut(usize) -> T>(mut make: F) -> [T; N] {
    let mut out = [const { MaybeUninit::<T>::uninit() }; N];
    for n in 0..N {
        out[n].write(make(n));
    }
    // SAFETY: all are written, and an array of them is laid out as one of what they hold
    unsafe { std::mem::transmute_copy::<[MaybeUninit<T>; N], [T; N]>(&out) }
}
