//! Small sets of numbers: arrays, arrays of arrays, pairs, or none. Sizes of 0 cost nothing.

use crate::law::number::Number;

/// Where numbers come from, by their places.
pub trait Source<N> {
    fn number(&self, n: usize) -> N;
}

/// Where they go.
pub trait Sink<N> {
    fn put(&mut self, n: usize, x: N);
}

/// Kernels read and write as many numbers as [`Numbers`] says, without looking: only this crate says how many.
mod sealed {
    use crate::law::number::Number;

    pub trait Sealed<N> {}
    impl<N: Number> Sealed<N> for N {}
    impl<N: Copy, A: Sealed<N>, const C: usize> Sealed<N> for [A; C] {}
    impl<N: Copy, A: Sealed<N>, B: Sealed<N>> Sealed<N> for (A, B) {}
}

/// A fixed count of numbers, in one order: a number, and arrays and pairs of such, as deep as a law wants. Nobody else makes one,
///
/// ```compile_fail,E0277
/// use peridyne_mechanics::law::{material::{Numbers, Sink, Source}, number::Number};
///
/// #[derive(Clone, Copy)]
/// struct Astray<N>(N);
/// impl<N: Number> Numbers<N> for Astray<N> {
///     const COUNT: usize = 1;
///     fn read(source: &impl Source<N>, first: usize) -> Self { Astray(source.number(first)) }
///     fn write(&self, sink: &mut impl Sink<N>, _: usize) { sink.put(1 << 24, self.0) }
///     fn constant(x: f64) -> Self { Astray(N::constant(x)) }
///     fn get(&self, _: usize) -> N { self.0 }
///     fn set(&mut self, _: usize, x: N) { self.0 = x }
///     fn plus(self, factor: N, x: Self) -> Self { Astray(factor.fma(x.0, self.0)) }
/// }
/// ```
///
/// since a kernel writes to the places that it names; nor can a law remember something else than one,
///
/// ```compile_fail,E0277
/// use peridyne_mechanics::law::{material::Numbers, number::Number};
///
/// fn remembered<N: Number, P: Numbers<N>>(_: P) {}
/// remembered::<f64, Vec<f64>>(vec![1.0]);
/// ```
///
/// while nested ones are
///
/// ```
/// use peridyne_mechanics::law::material::Numbers;
///
/// type Own = ([f64; 3], ([[f64; 2]; 2], f64));
/// assert_eq!(<Own as Numbers<f64>>::COUNT, 8);
/// ```
pub trait Numbers<N>: Copy + sealed::Sealed<N> {
    const COUNT: usize;

    /// All of them, from place `first` on. Part by part: what nobody looks at is then not read, however many there are.
    fn read(source: &impl Source<N>, first: usize) -> Self;
    fn write(&self, sink: &mut impl Sink<N>, first: usize);

    fn constant(x: f64) -> Self;
    /// Number `n`, below the count.
    fn get(&self, n: usize) -> N;
    fn set(&mut self, n: usize, x: N);
    /// `self + factor · x`
    fn plus(self, factor: N, x: Self) -> Self;
}

impl<N: Number> Numbers<N> for N {
    const COUNT: usize = 1;

    #[inline(always)]
    fn read(source: &impl Source<N>, first: usize) -> N {
        source.number(first)
    }
    #[inline(always)]
    fn write(&self, sink: &mut impl Sink<N>, first: usize) {
        sink.put(first, *self);
    }

    #[inline(always)]
    fn constant(x: f64) -> N {
        <N as Number>::constant(x)
    }
    #[inline(always)]
    fn get(&self, _: usize) -> N {
        *self
    }
    #[inline(always)]
    fn set(&mut self, _: usize, x: N) {
        *self = x;
    }
    #[inline(always)]
    fn plus(self, factor: N, x: N) -> N {
        factor.fma(x, self)
    }
}

impl<N: Copy, A: Numbers<N>, const C: usize> Numbers<N> for [A; C] {
    const COUNT: usize = C * A::COUNT;

    #[inline(always)]
    fn read(source: &impl Source<N>, first: usize) -> Self {
        let mut out = [A::constant(0.0); C];
        for c in 0..C {
            out[c] = A::read(source, first + c * A::COUNT);
        }
        out
    }
    #[inline(always)]
    fn write(&self, sink: &mut impl Sink<N>, first: usize) {
        for c in 0..C {
            self[c].write(sink, first + c * A::COUNT);
        }
    }

    #[inline(always)]
    fn constant(x: f64) -> Self {
        [A::constant(x); C]
    }
    #[inline(always)]
    fn get(&self, n: usize) -> N {
        self[n / A::COUNT].get(n % A::COUNT)
    }
    #[inline(always)]
    fn set(&mut self, n: usize, x: N) {
        self[n / A::COUNT].set(n % A::COUNT, x);
    }
    #[inline(always)]
    fn plus(mut self, factor: N, x: Self) -> Self {
        for c in 0..C {
            self[c] = self[c].plus(factor, x[c]);
        }
        self
    }
}

impl<N: Copy, A: Numbers<N>, B: Numbers<N>> Numbers<N> for (A, B) {
    const COUNT: usize = A::COUNT + B::COUNT;

    #[inline(always)]
    fn read(source: &impl Source<N>, first: usize) -> Self {
        (A::read(source, first), B::read(source, first + A::COUNT))
    }
    #[inline(always)]
    fn write(&self, sink: &mut impl Sink<N>, first: usize) {
        self.0.write(sink, first);
        self.1.write(sink, first + A::COUNT);
    }

    #[inline(always)]
    fn constant(x: f64) -> Self {
        (A::constant(x), B::constant(x))
    }
    #[inline(always)]
    fn get(&self, n: usize) -> N {
        if n < A::COUNT {
            self.0.get(n)
        } else {
            self.1.get(n - A::COUNT)
        }
    }
    #[inline(always)]
    fn set(&mut self, n: usize, x: N) {
        if n < A::COUNT {
            self.0.set(n, x);
        } else {
            self.1.set(n - A::COUNT, x);
        }
    }
    #[inline(always)]
    fn plus(self, factor: N, x: Self) -> Self {
        (self.0.plus(factor, x.0), self.1.plus(factor, x.1))
    }
}
