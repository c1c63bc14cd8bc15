//! Small matrices of numbers. Loops, not closures: these are compiled into sweeps.

use crate::law::number::Number;

pub type Matrix<N, const D: usize> = [[N; D]; D];

#[inline(always)]
pub fn zero<N: Number, const D: usize>() -> Matrix<N, D> {
    [[N::constant(0.0); D]; D]
}

/// `A B`
#[inline(always)]
pub fn product<N: Number, const D: usize>(a: &Matrix<N, D>, b: &Matrix<N, D>) -> Matrix<N, D> {
    let mut out = *a;
    for r in 0..D {
        for c in 0..D {
            let mut sum = a[r][0] * b[0][c];
            for k in 1..D {
                sum = a[r][k].fma(b[k][c], sum);
            }
            out[r][c] = sum;
        }
    }
    out
}

/// `Aᵀ B`
#[inline(always)]
pub fn transposed_product<N: Number, const D: usize>(
    a: &Matrix<N, D>,
    b: &Matrix<N, D>,
) -> Matrix<N, D> {
    let mut out = *a;
    for r in 0..D {
        for c in 0..D {
            let mut sum = a[0][r] * b[0][c];
            for k in 1..D {
                sum = a[k][r].fma(b[k][c], sum);
            }
            out[r][c] = sum;
        }
    }
    out
}

/// `A x`
#[inline(always)]
pub fn times<N: Number, const D: usize>(a: &Matrix<N, D>, x: &[N; D]) -> [N; D] {
    let mut out = *x;
    for r in 0..D {
        let mut sum = a[r][0] * x[0];
        for k in 1..D {
            sum = a[r][k].fma(x[k], sum);
        }
        out[r] = sum;
    }
    out
}

#[inline(always)]
pub fn trace<N: Number, const D: usize>(a: &Matrix<N, D>) -> N {
    let mut sum = a[0][0];
    for r in 1..D {
        sum = sum + a[r][r];
    }
    sum
}

/// `A : B`
#[inline(always)]
pub fn contraction<N: Number, const D: usize>(a: &Matrix<N, D>, b: &Matrix<N, D>) -> N {
    let mut sum = a[0][0] * b[0][0];
    for r in 0..D {
        for c in 0..D {
            if r + c > 0 {
                sum = a[r][c].fma(b[r][c], sum);
            }
        }
    }
    sum
}

/// Cofactors `∂ det A / ∂ A`.
#[inline(always)]
pub fn cofactor<N: Number, const D: usize>(a: &Matrix<N, D>) -> Matrix<N, D> {
    let mut out = *a;
    match D {
        1 => out[0][0] = N::constant(1.0),
        2 => {
            let zero = N::constant(0.0);
            out[0][0] = a[1][1];
            out[0][1] = zero - a[1][0];
            out[1][0] = zero - a[0][1];
            out[1][1] = a[0][0];
        }
        _ => {
            for r in 0..D {
                for c in 0..D {
                    let ([r1, r2], [c1, c2]) = (others(r), others(c));
                    out[r][c] = a[r1][c1] * a[r2][c2] - a[r1][c2] * a[r2][c1];
                }
            }
        }
    }
    out
}

#[inline(always)]
fn others(axis: usize) -> [usize; 2] {
    [(axis + 1) % 3, (axis + 2) % 3]
}

/// `det A`
#[inline(always)]
pub fn determinant<N: Number, const D: usize>(a: &Matrix<N, D>) -> N {
    let cofactors = cofactor(a);
    let mut sum = a[0][0] * cofactors[0][0];
    for c in 1..D {
        sum = a[0][c].fma(cofactors[0][c], sum);
    }
    sum
}

/// `det(1 + H) − 1`, without cancellation.
#[inline(always)]
pub fn dilation<N: Number, const D: usize>(h: &Matrix<N, D>) -> N {
    trace(h) + dilation_beyond(h)
}

/// `det(1 + H) − 1 − tr H`
#[inline(always)]
pub fn dilation_beyond<N: Number, const D: usize>(h: &Matrix<N, D>) -> N {
    match D {
        1 => N::constant(0.0),
        2 => determinant(h),
        _ => trace(&cofactor(h)) + determinant(h),
    }
}

/// `cof(1 + H) − 1`, without cancellation.
#[inline(always)]
pub fn cofactor_beyond<N: Number, const D: usize>(h: &Matrix<N, D>) -> Matrix<N, D> {
    let mut out = zero::<N, D>();
    if D == 1 {
        return out;
    }
    // linear in H in the plane; in space 1 tr H − Hᵀ + cof H
    let t = trace(h);
    let cofactors = cofactor(h);
    for r in 0..D {
        for c in 0..D {
            let mut x = N::constant(0.0) - h[c][r];
            if r == c {
                x = x + t;
            }
            if D == 3 {
                x = x + cofactors[r][c];
            }
            out[r][c] = x;
        }
    }
    out
}

/// R − 1 and U − 1 of `1 + H = R U`, without cancellation, for stretches from 0.1 to 10: Newton's iteration `X′ = ½(X + X⁻ᵀ)` for R
/// (Higham 1986), which squares its error in each step.
#[inline(always)]
pub fn polar<N: Number, const D: usize>(h: &Matrix<N, D>) -> (Matrix<N, D>, Matrix<N, D>) {
    let half = N::constant(0.5);
    let turn = orthogonal(h, POLAR_STEPS);
    // Rᵀ(1 + H) − 1, of which rounding leaves only the symmetric part
    let more = transposed_product(&turn, h);
    let mut stretch = *h;
    for r in 0..D {
        for c in 0..D {
            let ends = (h[r][c] + turn[c][r]) + (h[c][r] + turn[r][c]);
            stretch[r][c] = half * (ends + (more[r][c] + more[c][r]));
        }
    }
    (turn, stretch)
}

/// R − 1 of `1 + S + A = R U` by so many steps of [`polar`]'s iteration, S symmetric and A not at all. Each has a column of its own all the way,
/// so that a rotation far below the last digit of S is there to its own last digit; exactly 0 of an A that is.
///
/// `cof(P + A) = (cof P + cof A) + (A tr P − PA − AP)`, symmetric and not, and `det(P + A) = det P + cof A : P`; in the plane `cof A = A`.
#[inline(always)]
pub fn rotation<N: Number, const D: usize>(
    symmetric: &Matrix<N, D>,
    skew: &Matrix<N, D>,
    steps: usize,
) -> Matrix<N, D> {
    let (half, one) = (N::constant(0.5), N::constant(1.0));
    let (mut s, mut a) = (*symmetric, *skew);
    for _ in 0..steps {
        let (more, [cofactors, turned]) = (dilation_apart(&s, &a), cofactor_apart(&s, &a));
        let inverse = (one + more).recip();
        for r in 0..D {
            for c in 0..D {
                // X⁻ᵀ − 1 = ((cof X − 1) − (det X − 1) 1)/det X
                let mut x = cofactors[r][c];
                if r == c {
                    x = x - more;
                }
                s[r][c] = half * inverse.fma(x, s[r][c]);
                a[r][c] = half * inverse.fma(turned[r][c], a[r][c]);
            }
        }
    }
    // R = 1 + A + A²/(1 + cos θ) of its antisymmetric part A (Rodrigues), in D = 2 and 3; good below a right angle
    let cosine = half.fma(trace(&s), one);
    let square = product(&a, &a);
    let per = (one + cosine.most(N::constant(0.0))).recip();
    let mut out = s;
    for r in 0..D {
        for c in 0..D {
            let near = per.fma(square[r][c], a[r][c]);
            out[r][c] = cosine.below(0.0, s[r][c] + a[r][c], near);
        }
    }
    out
}

/// `det(1 + S + A) − 1` of a symmetric S and an antisymmetric A.
#[inline(always)]
pub fn dilation_apart<N: Number, const D: usize>(s: &Matrix<N, D>, a: &Matrix<N, D>) -> N {
    // cof A : (1 + S), in the plane det A
    let cofactors = cofactor(a);
    let more = match D {
        1 => N::constant(0.0),
        2 => determinant(a),
        _ => trace(&cofactors) + contraction(&cofactors, s),
    };
    dilation(s) + more
}

/// `cof(1 + S + A) − 1` of a symmetric S and an antisymmetric A: what is symmetric of it, and what is not.
#[inline(always)]
pub fn cofactor_apart<N: Number, const D: usize>(
    s: &Matrix<N, D>,
    a: &Matrix<N, D>,
) -> [Matrix<N, D>; 2] {
    let (mut even, mut odd) = (cofactor_beyond(s), *a);
    if D == 3 {
        let (cofactors, t) = (cofactor(a), trace(s));
        let (one_way, other) = (product(s, a), product(a, s));
        for r in 0..D {
            for c in 0..D {
                even[r][c] = even[r][c] + cofactors[r][c];
                odd[r][c] = t.fma(a[r][c], a[r][c]) - (one_way[r][c] + other[r][c]);
            }
        }
    }
    [even, odd]
}

/// Newton's iteration of [`polar`].
#[inline(always)]
fn orthogonal<N: Number, const D: usize>(h: &Matrix<N, D>, steps: usize) -> Matrix<N, D> {
    let half = N::constant(0.5);
    let mut turn = *h;
    for _ in 0..steps {
        let beyond = dilation(&turn);
        let inverse = (N::constant(1.0) + beyond).recip();
        let cofactors = cofactor_beyond(&turn);
        for r in 0..D {
            for c in 0..D {
                // X⁻ᵀ − 1 = ((cof X − 1) − (det X − 1) 1)/det X
                let mut x = cofactors[r][c];
                if r == c {
                    x = x - beyond;
                }
                turn[r][c] = half * inverse.fma(x, turn[r][c]);
            }
        }
    }
    turn
}

/// From a stretch of 10 to round-off.
const POLAR_STEPS: usize = 9;

/// Inverse of a symmetric matrix that is not negative, by its eigenvalues: of those below 1e-6 of the largest the inverse is 0. False: there
/// are such, or all are 0.
pub fn inverse<const D: usize>(a: Matrix<f64, D>) -> (Matrix<f64, D>, bool) {
    inverse_within(a, 1e-6)
}

/// The same with the part of the largest eigenvalue below which a direction is none.
pub fn inverse_within<const D: usize>(a: Matrix<f64, D>, part: f64) -> (Matrix<f64, D>, bool) {
    let (values, vectors) = eigen(a);
    let most = values.iter().fold(0.0f64, |m, x| m.max(*x));
    let counts = |x: f64| most > 0.0 && x > part * most;
    let mut out = [[0.0; D]; D];
    for (k, value) in values.iter().enumerate() {
        if counts(*value) {
            for r in 0..D {
                for c in 0..D {
                    out[r][c] += vectors[r][k] * vectors[c][k] / value;
                }
            }
        }
    }
    (out, values.iter().all(|x| counts(*x)))
}

/// The largest eigenvalue of [`inverse`], 0 where that is.
pub fn greatest_of_inverse<const D: usize>(a: Matrix<f64, D>) -> f64 {
    let (values, _) = eigen(inverse(a).0);
    values.into_iter().fold(0.0, f64::max)
}

/// Eigenvalues of a symmetric matrix and its eigenvectors in columns, by Jacobi's rotations.
pub fn eigen<const D: usize>(mut a: Matrix<f64, D>) -> ([f64; D], Matrix<f64, D>) {
    let mut v = [[0.0; D]; D];
    for r in 0..D {
        v[r][r] = 1.0;
    }
    // convergence is quadratic: a dozen sweeps are more than any matrix needs
    for _ in 0..12 {
        for p in 0..D {
            for q in p + 1..D {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
                let t = theta.signum() / (theta.abs() + libm::hypot(theta, 1.0));
                let c = 1.0 / libm::hypot(t, 1.0);
                let s = t * c;
                for k in 0..D {
                    let (x, y) = (a[k][p], a[k][q]);
                    (a[k][p], a[k][q]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..D {
                    let (x, y) = (a[p][k], a[q][k]);
                    (a[p][k], a[q][k]) = (c * x - s * y, s * x + c * y);
                    let (x, y) = (v[k][p], v[k][q]);
                    (v[k][p], v[k][q]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    (crate::array::from_fn(|k| a[k][k]), v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariants_are_those_of_the_matrix() {
        let h = [[0.1, -0.3, 0.2], [0.05, 0.4, -0.1], [0.3, 0.2, -0.25]];
        let mut f = h;
        for a in 0..3 {
            f[a][a] += 1.0;
        }
        assert!((dilation(&h) - (determinant(&f) - 1.0)).abs() < 1e-15);
        let (beyond, cofactors) = (cofactor_beyond(&h), cofactor(&f));
        for r in 0..3 {
            for c in 0..3 {
                let exact = cofactors[r][c] - if r == c { 1.0 } else { 0.0 };
                assert!((beyond[r][c] - exact).abs() < 1e-15);
            }
        }
        // A cof(A)ᵀ = det A
        let p = product(&f, &{
            let mut t = cofactors;
            for r in 0..3 {
                for c in 0..3 {
                    t[r][c] = cofactors[c][r];
                }
            }
            t
        });
        assert!((p[0][0] - determinant(&f)).abs() < 1e-15 && p[0][1].abs() < 1e-15);
        let plane = [[0.2, -0.1], [0.3, 0.15]];
        assert!((dilation(&plane) - (1.2 * 1.15 + 0.03 - 1.0)).abs() < 1e-15);
        let beyond = cofactor_beyond(&plane);
        for (found, exact) in beyond.iter().flatten().zip([0.15, -0.3, 0.1, 0.2]) {
            assert!((found - exact).abs() < 1e-15);
        }
    }

    #[test]
    fn rotations_and_stretches_are_told_apart() {
        let (s, c) = 2.9f64.sin_cos();
        let turn = [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]];
        for size in [1e-9, 0.3, 9.0] {
            // eigenvalues between 0.1 and 10
            let v = [
                [0.7 * size, 0.1 * size, 0.0],
                [0.1 * size, -0.08 * size, 0.02 * size],
                [0.0, 0.02 * size, 0.2 * size],
            ];
            let mut u = v;
            (0..3).for_each(|a| u[a][a] += 1.0);
            for turn in [turn, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]] {
                let mut h = product(&turn, &u);
                (0..3).for_each(|a| h[a][a] -= 1.0);
                let still = turn[0][0] == 1.0;
                if still {
                    h = v;
                }
                let (found, stretch) = polar(&h);
                for a in 0..3 {
                    for b in 0..3 {
                        let one = if a == b { 1.0 } else { 0.0 };
                        let off = (found[a][b] - (turn[a][b] - one)).abs();
                        let off = off.max((stretch[a][b] - v[a][b]).abs());
                        // without a rotation nothing is lost to the 1
                        let scale = if still { size } else { 1.0 + size };
                        assert!(
                            off < 3e-15 * scale,
                            "{size} {turn:?}: {found:?} {stretch:?}"
                        );
                    }
                }
            }
        }
        // in the plane
        let (turn, stretch) = polar(&[[0.0, 2.0], [0.0, 0.0]]);
        let root = 0.5f64.sqrt();
        assert!((turn[0][1] - root).abs() < 1e-15 && (turn[0][0] + 1.0 - root).abs() < 1e-15);
        assert!(
            (stretch[0][1] - root).abs() < 1e-15
                && (stretch[1][1] + 1.0 - 3.0 * root).abs() < 1e-15
        );
    }

    #[test]
    fn symmetric_matrices_are_inverted_as_far_as_they_go() {
        let a = [[2.0, 0.3, -0.5], [0.3, 1.0, 0.2], [-0.5, 0.2, 3.0]];
        let (inverse_of, whole) = inverse(a);
        let one = product(&a, &inverse_of);
        assert!(whole);
        for r in 0..3 {
            for c in 0..3 {
                assert!((one[r][c] - if r == c { 1.0 } else { 0.0 }).abs() < 1e-14);
            }
        }
        // one direction only
        let n = [0.6, 0.8];
        let line = [[n[0] * n[0], n[0] * n[1]], [n[0] * n[1], n[1] * n[1]]];
        let (back, whole) = inverse(line);
        assert!(!whole && (back[0][1] - 0.48).abs() < 1e-15);
        assert_eq!(inverse([[0.0]]), ([[0.0]], false));
    }
}
