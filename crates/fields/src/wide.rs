//! The widest instructions that there are.

/// A function of the same arguments as one that is always inlined, which runs it with AVX-512, AVX2 or what every machine has. Sums are in
/// one order, and products are fused in all of them: the bits are the same.
macro_rules! widest {
    ($(#[$about:meta])* $sight:vis $name:ident, ($($argument:ident: $kind:ty),*) -> $out:ty, $plain:path) => {
        $(#[$about])*
        $sight fn $name($($argument: $kind),*) -> $out {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma")]
                fn avx512($($argument: $kind),*) -> $out {
                    $plain($($argument),*)
                }
                #[target_feature(enable = "avx2,fma")]
                fn avx2($($argument: $kind),*) -> $out {
                    $plain($($argument),*)
                }
                let fused = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
                if fused
                    && is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512dq")
                {
                    // SAFETY: just detected
                    return unsafe { avx512($($argument),*) };
                }
                if fused {
                    // SAFETY: just detected
                    return unsafe { avx2($($argument),*) };
                }
            }
            $plain($($argument),*)
        }
    };
}

pub(crate) use widest;
