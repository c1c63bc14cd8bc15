//! β of polynomials: means of powers over the part of a bond that lies in the ball of φ, in closed form, eight points at a time.

use crate::kernel::{Kernel, dot};

#[inline(always)]
pub(crate) fn polynomial(
    kernel: &Kernel,
    n: u32,
    d: [&[f64]; 3],
    off: [f64; 3],
    bond: [f64; 3],
    out: &mut [f64],
) {
    match n {
        0 => of_degree::<0>(kernel, d, off, bond, out),
        1 => of_degree::<1>(kernel, d, off, bond, out),
        2 => of_degree::<2>(kernel, d, off, bond, out),
        3 => of_degree::<3>(kernel, d, off, bond, out),
        4 => of_degree::<4>(kernel, d, off, bond, out),
        5 => of_degree::<5>(kernel, d, off, bond, out),
        6 => of_degree::<6>(kernel, d, off, bond, out),
        _ => of_degree::<7>(kernel, d, off, bond, out),
    }
}

/// `½ ∫₋₁¹ (A − B s² − E s)ⁿ ds = Σ c[k][j] A^(n−2k−j) B^j E^2k`.
type Means = [[f64; 8]; 4];

const fn means(n: usize) -> Means {
    const fn factorial(n: usize) -> f64 {
        let (mut product, mut k) = (1.0, 1);
        while k <= n {
            product *= k as f64;
            k += 1;
        }
        product
    }
    let mut all = [[0.0; 8]; 4];
    let mut k = 0;
    while 2 * k <= n {
        let mut j = 0;
        while 2 * k + j <= n {
            let ways = factorial(n) / (factorial(n - 2 * k - j) * factorial(j) * factorial(2 * k));
            let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
            all[k][j] = sign * ways / (2 * (j + k) + 1) as f64;
            j += 1;
        }
        k += 1;
    }
    all
}

#[inline(always)]
fn of_degree<const N: usize>(
    kernel: &Kernel,
    [dx, dy, dz]: [&[f64]; 3],
    off: [f64; 3],
    bond: [f64; 3],
    out: &mut [f64],
) {
    let table: Means = const { means(N) };
    let radius = kernel.radius() * kernel.radius();
    let length = dot(bond, bond);
    let (over_length, over_radius) = (1.0 / length, 1.0 / radius);
    let along = length * over_radius;
    let norm = kernel.norm;
    let count = out.len();
    let (dx, dy, dz) = (&dx[..count], &dy[..count], &dz[..count]);
    let [bx, by, bz] = bond;
    for n in 0..count {
        let (x, y, z) = (dx[n] + off[0], dy[n] + off[1], dz[n] + off[2]);
        let foot = x.mul_add(bx, y.mul_add(by, z * bz)) * over_length;
        let (ax, ay, az) = (
            (-foot).mul_add(bx, x),
            (-foot).mul_add(by, y),
            (-foot).mul_add(bz, z),
        );
        let rest = (-ax).mul_add(ax, (-ay).mul_add(ay, (-az).mul_add(az, radius)));
        let rest = if rest > 0.0 { rest } else { 0.0 };
        let half = (rest * over_length).sqrt();
        let (low, high) = (foot - half, foot + half);
        let low = if low > 0.0 { low } else { 0.0 };
        let high = if high < 1.0 { high } else { 1.0 };
        let span = high - low;
        let span = if span > 0.0 { span } else { 0.0 };
        // 1 − r²/S² is A − B s² − E s with s from −1 to 1
        let middle = 0.5f64.mul_add(low + high, -foot);
        let m = along * (middle * middle);
        let a = rest.mul_add(over_radius, -m);
        let b = (0.25 * along) * (span * span);
        let e = 4.0 * m * b;
        let mut power = [1.0; 8];
        for k in 0..N {
            power[k + 1] = power[k] * a;
        }
        let mut sum = 0.0;
        for k in (0..=N / 2).rev() {
            let most = N - 2 * k;
            let mut part = table[k][most];
            for j in (0..most).rev() {
                part = part.mul_add(b, table[k][j] * power[most - j]);
            }
            sum = e.mul_add(sum, part);
        }
        out[n] = norm * span * sum;
    }
}
