//! Numbers as bytes, little end first.

use crate::quantity::Dimension;

/// Something of a fixed number of bytes.
pub trait Word: Copy {
    const BYTES: usize;

    /// Writes it into the first [`BYTES`](Word::BYTES) of `to`.
    fn put(&self, to: &mut [u8]);

    /// Reads what [`put`](Word::put) wrote.
    fn take(from: &[u8]) -> Self;
}

macro_rules! numbers {
    ($($t:ty),*) => {$(
        impl Word for $t {
            const BYTES: usize = size_of::<$t>();

            fn put(&self, to: &mut [u8]) {
                to[..Self::BYTES].copy_from_slice(&self.to_le_bytes());
            }

            fn take(from: &[u8]) -> Self {
                let mut bytes = [0; Self::BYTES];
                bytes.copy_from_slice(&from[..Self::BYTES]);
                Self::from_le_bytes(bytes)
            }
        }
    )*};
}

numbers!(i8, u8, u16, u32, u64, f32, f64);

impl Word for Dimension {
    const BYTES: usize = 4;

    fn put(&self, to: &mut [u8]) {
        self.0.put(to);
    }

    fn take(from: &[u8]) -> Self {
        Dimension(Word::take(from))
    }
}

impl Word for bool {
    const BYTES: usize = 1;

    fn put(&self, to: &mut [u8]) {
        to[0] = u8::from(*self);
    }

    fn take(from: &[u8]) -> Self {
        from[0] != 0
    }
}

/// As 64 bits on every machine.
impl Word for usize {
    const BYTES: usize = 8;

    fn put(&self, to: &mut [u8]) {
        (*self as u64).put(to);
    }

    fn take(from: &[u8]) -> Self {
        u64::take(from) as usize
    }
}

impl<T: Word, const N: usize> Word for [T; N] {
    const BYTES: usize = N * T::BYTES;

    fn put(&self, to: &mut [u8]) {
        for (x, to) in self.iter().zip(to.chunks_mut(T::BYTES)) {
            x.put(to);
        }
    }

    fn take(from: &[u8]) -> Self {
        crate::array::from_fn(|n| T::take(&from[n * T::BYTES..]))
    }
}

impl<A: Word, B: Word> Word for (A, B) {
    const BYTES: usize = A::BYTES + B::BYTES;

    fn put(&self, to: &mut [u8]) {
        self.0.put(to);
        self.1.put(&mut to[A::BYTES..]);
    }

    fn take(from: &[u8]) -> Self {
        (A::take(from), B::take(&from[A::BYTES..]))
    }
}

/// A flag beside the value; the default where there is none.
impl<T: Word + Default> Word for Option<T> {
    const BYTES: usize = 1 + T::BYTES;

    fn put(&self, to: &mut [u8]) {
        self.is_some().put(to);
        self.unwrap_or_default().put(&mut to[1..]);
    }

    fn take(from: &[u8]) -> Self {
        bool::take(from).then(|| T::take(&from[1..]))
    }
}

/// Makes a [`Word`] of a structure of words, field by field.
#[doc(hidden)]
#[macro_export]
macro_rules! words_of_state {
    ([$($generics:tt)*] $name:ty { $($field:ident: $of:ty),* $(,)? }) => {
        impl<$($generics)*> $crate::state::Word for $name {
            const BYTES: usize = 0 $(+ <$of as $crate::state::Word>::BYTES)*;

            #[allow(unused_assignments)] // the last place
            fn put(&self, to: &mut [u8]) {
                let mut at = 0;
                $(
                    $crate::state::Word::put(&self.$field, &mut to[at..]);
                    at += <$of as $crate::state::Word>::BYTES;
                )*
            }

            #[allow(unused_assignments)]
            fn take(from: &[u8]) -> Self {
                let mut at = 0;
                $(
                    let $field = <$of as $crate::state::Word>::take(&from[at..]);
                    at += <$of as $crate::state::Word>::BYTES;
                )*
                Self { $($field),* }
            }
        }
    };
}
pub use crate::words_of_state as words;

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Clone, Copy, PartialEq)]
    struct Pair<const N: usize> {
        ends: [u32; 2],
        way: [f64; N],
        force: Option<f64>,
    }

    words!([const N: usize] Pair<N> { ends: [u32; 2], way: [f64; N], force: Option<f64> });

    #[test]
    fn a_structure_comes_back_bit_for_bit() {
        for force in [None, Some(-0.0), Some(f64::MIN_POSITIVE / 3.0)] {
            let pair = Pair {
                ends: [7, u32::MAX],
                way: [1.0 / 3.0, f64::INFINITY, -1e300],
                force,
            };
            assert_eq!(Pair::<3>::BYTES, 8 + 24 + 9);
            let mut bytes = [0xaa; 41];
            pair.put(&mut bytes);
            assert_eq!(Pair::<3>::take(&bytes), pair);
        }
    }
}
