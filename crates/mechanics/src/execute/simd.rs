//! The one place where an instruction set is chosen: detected at start, or asked for.

use super::lane::{Eight, Lane, Piece};
#[cfg(target_arch = "aarch64")]
use super::lane::{F64x2, Pair};
#[cfg(target_arch = "x86_64")]
use super::lane::{F64x4, F64x8, Pair};
#[cfg(target_arch = "x86_64")]
use std::{hint::black_box, mem::MaybeUninit};

/// A loop is compiled for every path it has, which is what most of a build is spent on. x86 processors have had AVX2 since 2013: what
/// they run eight numbers by eight is not made for them unless the build asks for it (PERIDYNE_PORTABLE=1), which tests of widths do.
/// 64-bit ARM has NEON always.
const PORTABLE: bool = cfg!(not(any(target_arch = "x86_64", target_arch = "aarch64")))
    || option_env!("PERIDYNE_PORTABLE").is_some();

/// For work on the engine: built with PERIDYNE_AVX2_ALONE=1 it has one path. So have its unit tests: that widths do not show is for the
/// tests of the library as it is.
#[cfg(target_arch = "x86_64")]
const WIDE: bool = option_env!("PERIDYNE_AVX2_ALONE").is_none() && cfg!(not(test));

/// Instruction sets with a path of their own. All give the same bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Simd {
    Portable,
    Neon,
    Avx2,
    Avx512,
}

/// A loop over blocks of work, written once over any [`Lane`] of eight numbers; implement `block` with `#[inline(always)]`.
pub trait Kernel: Sync {
    type Out: Send;
    /// The type in whose module the code of this loop is made: that of the law that it is compiled for, else the loop's own. All loops in one
    /// module were one piece of a third of this crate for one thread of the compiler.
    type Home: ?Sized;
    /// Work that is done now and then, of which there are many (one for each law): it has no path of its own for AVX-512, and takes that
    /// of AVX2.
    const SELDOM: bool = false;
    /// Do block `b`.
    fn block<L: Lane>(&self, b: usize) -> Self::Out;
}

impl Simd {
    /// The widest instruction set of this machine.
    pub fn detect() -> Simd {
        *Simd::available().last().unwrap_or(&Simd::Portable)
    }

    /// All instruction sets that this machine and this build have, the widest last. Empty on an x86 processor without AVX2, where
    /// nothing can run.
    pub fn available() -> Vec<Simd> {
        #[allow(unused_mut)]
        let mut all = Vec::new();
        if PORTABLE {
            all.push(Simd::Portable);
        }
        #[cfg(target_arch = "aarch64")]
        all.push(Simd::Neon);
        #[cfg(target_arch = "x86_64")]
        {
            if has_avx2() {
                all.push(Simd::Avx2);
            }
            if WIDE && has_avx512() {
                all.push(Simd::Avx512);
            }
        }
        all
    }

    pub fn name(self) -> &'static str {
        match self {
            Simd::Portable => "portable",
            Simd::Neon => "neon",
            Simd::Avx2 => "avx2",
            Simd::Avx512 => "avx512",
        }
    }

    /// Run block `b` of `kernel` with this instruction set. Detection is cached, and asked once per block.
    ///
    /// # Panics
    /// Where machine or build have no such path: what runs was asked for by `build`, which refuses it.
    #[inline]
    pub(crate) fn run<K: Kernel>(self, kernel: &K, b: usize) -> K::Out {
        #[cfg(target_arch = "x86_64")]
        {
            let path: Option<unsafe fn(&K, usize) -> K::Out> = match self {
                Simd::Avx512 if WIDE && !K::SELDOM && has_avx512() => Some(K::Home::wide),
                Simd::Avx2 | Simd::Avx512 if has_avx2() => Some(K::Home::pairs),
                Simd::Portable | Simd::Neon | Simd::Avx2 | Simd::Avx512 => None,
            };
            if let Some(path) = path {
                // SAFETY: what the processor has was just asked
                return unsafe { from_a_line(path, kernel, b) };
            }
        }
        #[cfg(target_arch = "aarch64")]
        if self == Simd::Neon {
            return kernel.block::<Pair<Pair<F64x2>>>(b);
        }
        match PORTABLE {
            true => kernel.block::<Eight>(b),
            false => panic!("{}", NEITHER),
        }
    }

    /// Block 0 with every instruction set that this machine has.
    #[cfg(test)]
    pub(crate) fn each<K: Kernel>(kernel: &K) -> Vec<K::Out> {
        #[allow(unused_mut)]
        let mut all = vec![kernel.block::<Eight>(0)];
        #[cfg(target_arch = "aarch64")]
        all.push(kernel.block::<Pair<Pair<F64x2>>>(0));
        #[cfg(target_arch = "x86_64")]
        {
            // SAFETY, both: just detected
            if has_avx2() {
                all.push(unsafe { K::Home::pairs(kernel, 0) });
            }
            if has_avx512() {
                all.push(unsafe { K::Home::wide(kernel, 0) });
            }
        }
        all
    }
}

/// Calls where the stack is at the begin of a cache line. What a loop has no registers for lies in its frame, which the compiler lays out as
/// if it began there but does not align: begun 16 bytes beside, half of those numbers cross a line, and laws of tensors took 1.08 of the
/// time. Where it began was the luck of who had called whom.
///
/// # Safety
/// Those of the path.
#[cfg(target_arch = "x86_64")]
#[inline(never)]
unsafe fn from_a_line<K, T>(path: unsafe fn(&K, usize) -> T, kernel: &K, b: usize) -> T {
    #[repr(align(64))]
    struct Line {
        _bytes: MaybeUninit<[u8; 64]>,
    }
    let line = Line {
        _bytes: MaybeUninit::uninit(),
    };
    black_box(&line);
    // SAFETY: the caller's promise; nothing lies between this frame and that of the loop
    let out = unsafe { path(kernel, b) };
    // the frame lasts as long as the call
    black_box(&line);
    out
}

/// Work on single numbers, with the fused multiply-add of the processor: the same bits, without the call that plain code makes for each.
///
/// # Panics
/// Where machine or build have no path, as in [`Simd::run`].
#[inline]
pub(crate) fn fused<P: Piece>(piece: P) -> P::Out {
    #[cfg(target_arch = "x86_64")]
    if !PORTABLE {
        assert!(has_avx2(), "{}", NEITHER);
        // SAFETY: what the processor has was just asked
        return unsafe { with_fma(piece) };
    }
    piece.run()
}

/// # Safety
/// The processor has AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn with_fma<P: Piece>(piece: P) -> P::Out {
    piece.run()
}

/// Why nothing runs.
pub const NEITHER: &str = "this program was built for processors with AVX2 and FMA, which this one lacks: build it with PERIDYNE_PORTABLE=1";

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    has_avx2() && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq")
}

/// Loops for one instruction set each, made where the type is at home: the compiler makes the code of generic functions module by module,
/// and these in parallel.
#[cfg(target_arch = "x86_64")]
trait Home {
    /// # Safety
    /// The processor has AVX2 and FMA.
    #[target_feature(enable = "avx2,fma")]
    unsafe fn pairs<K: Kernel>(kernel: &K, b: usize) -> K::Out {
        kernel.block::<Pair<F64x4>>(b)
    }

    /// # Safety
    /// The processor has AVX2, FMA, AVX512F and AVX512DQ.
    #[target_feature(enable = "avx512f,avx512dq,avx2,fma")]
    unsafe fn wide<K: Kernel>(kernel: &K, b: usize) -> K::Out {
        kernel.block::<F64x8>(b)
    }
}

#[cfg(target_arch = "x86_64")]
impl<T: ?Sized> Home for T {}
