//! Arithmetic of D×D blocks.

pub(super) type Block<const D: usize> = [[f64; D]; D];

pub(super) fn zero<const D: usize>() -> Block<D> {
    [[0.0; D]; D]
}

pub(super) fn unit<const D: usize>() -> Block<D> {
    std::array::from_fn(|a| std::array::from_fn(|b| f64::from(u8::from(a == b))))
}

pub(super) fn scaled<const D: usize>(x: f64, m: &Block<D>) -> Block<D> {
    m.map(|row| row.map(|m| x * m))
}

pub(super) fn transposed<const D: usize>(m: &Block<D>) -> Block<D> {
    std::array::from_fn(|a| std::array::from_fn(|b| m[b][a]))
}

/// `sum += m`
pub(super) fn add<const D: usize>(sum: &mut Block<D>, m: &Block<D>) {
    for (s, m) in sum.as_flattened_mut().iter_mut().zip(m.as_flattened()) {
        *s += m;
    }
}

/// `sum += x m`
pub(super) fn add_product<const D: usize>(sum: &mut Block<D>, x: &Block<D>, m: &Block<D>) {
    for a in 0..D {
        for b in 0..D {
            for c in 0..D {
                sum[a][c] += x[a][b] * m[b][c];
            }
        }
    }
}

pub(super) fn largest<const D: usize>(m: &Block<D>) -> f64 {
    m.as_flattened()
        .iter()
        .fold(0.0, |a: f64, x| a.max(x.abs()))
}
