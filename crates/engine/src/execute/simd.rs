//! The one place where an instruction set is chosen: detected at start, or asked for.

use super::lane::{Eight, Lane};
#[cfg(target_arch = "x86_64")]
use super::lane::{F64x4, F64x8, Pair};

/// For work on the engine: built with PERIDYNE_AVX2_ALONE=1 it has one path, and compiles in a third of the time. So are its unit tests:
/// that widths do not show is for the tests of the library as it is.
const ALL: bool =
    option_env!("PERIDYNE_AVX2_ALONE").is_none() && cfg!(not(all(test, target_arch = "x86_64")));

/// Instruction sets with a path of their own. All give the same bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Simd {
    Portable,
    Avx2,
    Avx512,
}

/// A loop over blocks of work, written once over any [`Lane`] of eight numbers; implement `block` with `#[inline(always)]`.
pub trait Kernel: Sync {
    type Out: Send;
    /// Do block `b`.
    fn block<L: Lane>(&self, b: usize) -> Self::Out;
}

impl Simd {
    /// The widest instruction set of this machine.
    pub fn detect() -> Simd {
        *Simd::available().last().unwrap_or(&Simd::Portable)
    }

    /// All instruction sets that this machine has, the widest last.
    pub fn available() -> Vec<Simd> {
        #[allow(unused_mut)]
        let mut all = vec![Simd::Portable];
        if !ALL {
            all.clear();
        }
        #[cfg(target_arch = "x86_64")]
        {
            if has_avx2() {
                all.push(Simd::Avx2);
            }
            if ALL && has_avx512() {
                all.push(Simd::Avx512);
            }
        }
        all
    }

    pub fn name(self) -> &'static str {
        match self {
            Simd::Portable => "portable",
            Simd::Avx2 => "avx2",
            Simd::Avx512 => "avx512",
        }
    }

    /// Run block `b` of `kernel` with this instruction set.
    ///
    /// A set that this machine lacks falls back to the portable path, which gives the same bits. Detection is cached,
    /// and asked once per block.
    #[inline]
    pub(crate) fn run<K: Kernel>(self, kernel: &K, b: usize) -> K::Out {
        match self {
            // SAFETY, both: just detected
            #[cfg(target_arch = "x86_64")]
            Simd::Avx2 if has_avx2() => unsafe { pairs::run(kernel, b) },
            #[cfg(target_arch = "x86_64")]
            Simd::Avx512 if ALL && has_avx512() => unsafe { wide::run(kernel, b) },
            _ if ALL => portable::run(kernel, b),
            _ => panic!("built for machines that have AVX2 (unit tests, PERIDYNE_AVX2_ALONE)"),
        }
    }

    /// Block 0 with every instruction set that this machine has.
    #[cfg(test)]
    pub(crate) fn each<K: Kernel>(kernel: &K) -> Vec<K::Out> {
        #[allow(unused_mut)]
        let mut all = vec![portable::run(kernel, 0)];
        #[cfg(target_arch = "x86_64")]
        {
            // SAFETY, both: just detected
            if has_avx2() {
                all.push(unsafe { pairs::run(kernel, 0) });
            }
            if has_avx512() {
                all.push(unsafe { wide::run(kernel, 0) });
            }
        }
        all
    }
}

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    has_avx2() && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq")
}

/// Kernels on eight single numbers. A module for each instruction set: the compiler makes the code of generic functions module by
/// module, and these in parallel.
mod portable {
    use super::{Eight, Kernel};

    pub fn run<K: Kernel>(kernel: &K, b: usize) -> K::Out {
        kernel.block::<Eight>(b)
    }
}

#[cfg(target_arch = "x86_64")]
mod pairs {
    use super::{F64x4, Kernel, Pair};

    #[target_feature(enable = "avx2,fma")]
    pub unsafe fn run<K: Kernel>(kernel: &K, b: usize) -> K::Out {
        kernel.block::<Pair<F64x4>>(b)
    }
}

#[cfg(target_arch = "x86_64")]
mod wide {
    use super::{F64x8, Kernel};

    #[target_feature(enable = "avx512f,avx512dq,avx2,fma")]
    pub unsafe fn run<K: Kernel>(kernel: &K, b: usize) -> K::Out {
        kernel.block::<F64x8>(b)
    }
}
