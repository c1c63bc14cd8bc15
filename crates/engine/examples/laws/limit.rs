//! What the arithmetic of a bond costs where there is nothing else: no breaking, no surfaces, one material, a full cube in a padded array.
//! Written by hand for AVX-512, a loop for each pass of a law: the bar for the engine's laws of the same passes.
#![cfg(target_arch = "x86_64")]

use std::arch::x86_64::*;
use std::time::Instant;

/// Points along an edge, and room for the bonds of those at a face.
const EDGE: usize = 96;
const ROOM: usize = 8;
const ROW: usize = EDGE + 2 * ROOM;
/// Horizon in spacings: 122 bonds.
const M: i32 = 3;
const REPEATS: usize = 7;

/// Eight numbers.
#[derive(Clone, Copy)]
struct X(__m512d);

macro_rules! x {
    ($e:expr) => {
        // SAFETY: called from loops that have the instruction set
        X(unsafe { $e })
    };
}

impl X {
    #[inline(always)]
    fn of(v: f64) -> X {
        x!(_mm512_set1_pd(v))
    }
    #[inline(always)]
    fn plus(self, o: X) -> X {
        x!(_mm512_add_pd(self.0, o.0))
    }
    #[inline(always)]
    fn minus(self, o: X) -> X {
        x!(_mm512_sub_pd(self.0, o.0))
    }
    #[inline(always)]
    fn times(self, o: X) -> X {
        x!(_mm512_mul_pd(self.0, o.0))
    }
    /// `self · o + p`
    #[inline(always)]
    fn fma(self, o: X, p: X) -> X {
        x!(_mm512_fmadd_pd(self.0, o.0, p.0))
    }
    /// 1/√x to the last digits: 14 bits, and a step of fourth order.
    #[inline(always)]
    fn inverse_root(self) -> X {
        let y = x!(_mm512_rsqrt14_pd(self.0));
        let e = x!(_mm512_fnmadd_pd(self.times(y).0, y.0, X::of(1.0).0));
        let p = e.fma(X::of(0.3125), X::of(0.375)).fma(e, X::of(0.5));
        y.times(e).fma(p, y)
    }
}

/// Pointers to what the loops read and write, three components each.
#[derive(Clone, Copy)]
struct Arrays<const A: usize> {
    u: [*const f64; 3],
    f: [*mut f64; 3],
    /// What the points make of their sums.
    point: [*mut f64; A],
}

/// A bond of the stencil: slots away, ξ, its length.
#[derive(Clone, Copy)]
struct Bond {
    away: isize,
    xi: [f64; 3],
    length: f64,
}

/// A law with A numbers per point; none: its force pass is all.
trait Law<const A: usize> {
    fn share(bond: &Bond, y: [X; 3]) -> [X; A];
    fn settle(sum: [X; A]) -> [X; A];
    fn pull(bond: &Bond, y: [X; 3], own: [X; A], other: [X; A]) -> [X; 3];
}

#[inline(always)]
fn dot(a: [X; 3], b: [X; 3]) -> X {
    a[0].fma(b[0], a[1].fma(b[1], a[2].times(b[2])))
}

/// One pass: the force along the bond by its stretch.
struct BondBased;

impl Law<0> for BondBased {
    #[inline(always)]
    fn share(_: &Bond, _: [X; 3]) -> [X; 0] {
        []
    }
    #[inline(always)]
    fn settle(sum: [X; 0]) -> [X; 0] {
        sum
    }
    #[inline(always)]
    fn pull(bond: &Bond, y: [X; 3], _: [X; 0], _: [X; 0]) -> [X; 3] {
        let c = X::of(1.0 / bond.length).minus(dot(y, y).inverse_root());
        [c.times(y[0]), c.times(y[1]), c.times(y[2])]
    }
}

/// Two passes, a scalar per point: the linear solid.
struct StateBased;

#[inline(always)]
fn extension(bond: &Bond, y: [X; 3]) -> (X, X) {
    let square = dot(y, y);
    let inverse = square.inverse_root();
    (square.times(inverse).minus(X::of(bond.length)), inverse)
}

impl Law<1> for StateBased {
    #[inline(always)]
    fn share(bond: &Bond, y: [X; 3]) -> [X; 1] {
        [extension(bond, y).0.times(X::of(bond.length))]
    }
    #[inline(always)]
    fn settle(sum: [X; 1]) -> [X; 1] {
        [sum[0].times(X::of(0.01))]
    }
    #[inline(always)]
    fn pull(bond: &Bond, y: [X; 3], own: [X; 1], other: [X; 1]) -> [X; 3] {
        let (e, inverse) = extension(bond, y);
        let c = own[0].plus(other[0]).fma(X::of(bond.length), e);
        let c = c.times(inverse);
        [c.times(y[0]), c.times(y[1]), c.times(y[2])]
    }
}

/// Two passes, a tensor per point: F by sums, Saint Venant–Kirchhoff, `P K⁻¹ ξ` of both ends (K of a full family is isotropic).
struct Correspondence;

impl Law<9> for Correspondence {
    #[inline(always)]
    fn share(bond: &Bond, y: [X; 3]) -> [X; 9] {
        let mut out = [X::of(0.0); 9];
        for r in 0..3 {
            for c in 0..3 {
                out[3 * r + c] = y[r].times(X::of(bond.xi[c]));
            }
        }
        out
    }
    #[inline(always)]
    fn settle(sum: [X; 9]) -> [X; 9] {
        let shape = X::of(1.0 / 244.0);
        let mut f = sum;
        for x in &mut f {
            *x = x.times(shape);
        }
        let mut strain = f;
        for r in 0..3 {
            for c in 0..3 {
                let mut square = f[r].times(f[c]);
                square = f[3 + r].fma(f[3 + c], square);
                square = f[6 + r].fma(f[6 + c], square);
                let unit = X::of(f64::from(u8::from(r == c)));
                strain[3 * r + c] = square.minus(unit).times(X::of(0.5));
            }
        }
        let trace = strain[0].plus(strain[4]).plus(strain[8]);
        let mut second = strain;
        for n in 0..9 {
            second[n] = strain[n].plus(strain[n]);
            if n % 4 == 0 {
                second[n] = second[n].plus(trace);
            }
        }
        let mut out = f;
        for r in 0..3 {
            for c in 0..3 {
                let mut p = f[3 * r].times(second[c]);
                p = f[3 * r + 1].fma(second[3 + c], p);
                p = f[3 * r + 2].fma(second[6 + c], p);
                out[3 * r + c] = p.times(shape);
            }
        }
        out
    }
    #[inline(always)]
    fn pull(bond: &Bond, _: [X; 3], own: [X; 9], other: [X; 9]) -> [X; 3] {
        let mut out = [X::of(0.0); 3];
        for r in 0..3 {
            for c in 0..3 {
                let both = own[3 * r + c].plus(other[3 * r + c]);
                out[r] = both.fma(X::of(bond.xi[c]), out[r]);
            }
        }
        out
    }
}

/// Current bond vector of eight points side by side.
///
/// # Safety
/// Inside the arrays.
#[inline(always)]
unsafe fn bond_of<const A: usize>(all: &Arrays<A>, i: isize, own: [X; 3], bond: &Bond) -> [X; 3] {
    let mut y = own;
    for a in 0..3 {
        // SAFETY: the caller's promise
        let u = x!(_mm512_loadu_pd(all.u[a].offset(i + bond.away)));
        y[a] = u.minus(own[a]).plus(X::of(bond.xi[a]));
    }
    y
}

/// # Safety
/// As [`bond_of`]; the machine has AVX-512.
#[target_feature(enable = "avx512f,avx512dq,avx2,fma")]
unsafe fn sweep<const A: usize, W: Law<A>>(
    all: &Arrays<A>,
    bonds: &[Bond],
    inner: &[isize],
    outer: &[isize],
) {
    let mut own = [X::of(0.0); 3];
    // SAFETY: rows of eight points inside the arrays
    unsafe {
        if A > 0 {
            for &i in outer {
                for a in 0..3 {
                    own[a] = X(_mm512_loadu_pd(all.u[a].offset(i)));
                }
                let mut sum = [X::of(0.0); A];
                for bond in bonds {
                    let share = W::share(bond, bond_of(all, i, own, bond));
                    for n in 0..A {
                        sum[n] = sum[n].plus(share[n]);
                    }
                }
                let point = W::settle(sum);
                for n in 0..A {
                    _mm512_storeu_pd(all.point[n].offset(i), point[n].0);
                }
            }
        }
        for &i in inner {
            for a in 0..3 {
                own[a] = X(_mm512_loadu_pd(all.u[a].offset(i)));
            }
            let mut point = [X::of(0.0); A];
            for n in 0..A {
                point[n] = X(_mm512_loadu_pd(all.point[n].offset(i)));
            }
            let mut force = [X::of(0.0); 3];
            for bond in bonds {
                let y = bond_of(all, i, own, bond);
                let mut other = [X::of(0.0); A];
                for n in 0..A {
                    other[n] = X(_mm512_loadu_pd(all.point[n].offset(i + bond.away)));
                }
                let pull = W::pull(bond, y, point, other);
                for a in 0..3 {
                    force[a] = force[a].plus(pull[a]);
                }
            }
            for a in 0..3 {
                _mm512_storeu_pd(all.f[a].offset(i), force[a].0);
            }
        }
    }
}

/// ns per directed bond, the best of some sweeps on this thread.
fn time<const A: usize, W: Law<A>>() -> f64 {
    let (line, plane) = (ROW as isize, (ROW * ROW) as isize);
    let mut bonds = vec![];
    for z in -M..=M {
        for y in -M..=M {
            for x in -M..=M {
                let square = x * x + y * y + z * z;
                if square > 0 && square <= M * M {
                    bonds.push(Bond {
                        away: x as isize + y as isize * line + z as isize * plane,
                        xi: [x, y, z].map(f64::from),
                        length: f64::from(square).sqrt(),
                    });
                }
            }
        }
    }
    // arrays that begin at the same place of a page compete for the same lines of a cache
    let size = ROW * ROW * ROW + 2048;
    let mut arrays = vec![vec![0.0; size]; 6 + A];
    let mut random = 1u64;
    for column in &mut arrays[..3] {
        for x in column {
            random = random.wrapping_mul(6364136223846793005).wrapping_add(1);
            *x = ((random >> 33) as f64 / 4e9 - 0.5) * 1e-3;
        }
    }
    let at = arrays.iter_mut().enumerate();
    // SAFETY: less than the room behind the cube
    let at: Vec<*mut f64> = at
        .map(|(n, x)| unsafe { x.as_mut_ptr().add(40 * n) })
        .collect();
    let all = Arrays {
        u: [at[0] as _, at[1] as _, at[2] as _],
        f: [at[3], at[4], at[5]],
        point: std::array::from_fn(|n| at[6 + n]),
    };
    // points by eights: of the cube, and of what their bonds reach
    let rows = |beyond: usize| -> Vec<isize> {
        let along = |by: usize| ROOM - by..ROOM + EDGE + by;
        let mut out = vec![];
        for z in along(beyond) {
            for y in along(beyond) {
                let first = z * ROW * ROW + y * ROW;
                let x = along(if beyond > 0 { 4 } else { 0 });
                out.extend(x.step_by(8).map(|x| (first + x) as isize));
            }
        }
        out
    };
    let (inner, outer) = (rows(0), rows(M as usize));
    let mut best = f64::INFINITY;
    for _ in 0..REPEATS {
        let start = Instant::now();
        // SAFETY: asked for by the caller; rows and bonds stay inside
        unsafe { sweep::<A, W>(&all, &bonds, &inner, &outer) };
        best = best.min(start.elapsed().as_secs_f64());
    }
    1e9 * best / (EDGE * EDGE * EDGE * bonds.len()) as f64
}

/// A line for each kind of law.
pub fn print() {
    if !(is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq")) {
        return println!("limits: written for AVX-512, which this machine lacks");
    }
    for (name, ns) in [
        ("one pass (bond-based)", time::<0, BondBased>()),
        ("two passes, a scalar (lps)", time::<1, StateBased>()),
        (
            "two passes, a tensor (correspondence)",
            time::<9, Correspondence>(),
        ),
    ] {
        println!(
            "{:55} {ns:7.3} ns/bond",
            format!("limit             {name}")
        );
    }
}
