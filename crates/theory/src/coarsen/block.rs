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

pub(super) fn product<const D: usize>(x: &Block<D>, y: &Block<D>) -> Block<D> {
    let mut product = zero();
    add_product(&mut product, x, y);
    product
}

/// By Gauss and Jordan with pivots; `None` if it is singular to round-off.
pub(super) fn inverse<const D: usize>(m: &Block<D>) -> Option<Block<D>> {
    let scale = largest(m);
    let (mut m, mut inverse) = (*m, unit::<D>());
    for k in 0..D {
        let pivot = (k..D).max_by(|p, q| m[*p][k].abs().total_cmp(&m[*q][k].abs()))?;
        m.swap(k, pivot);
        inverse.swap(k, pivot);
        let value = m[k][k];
        if !(value.abs() > 1e-12 * scale) {
            return None;
        }
        for c in 0..D {
            m[k][c] /= value;
            inverse[k][c] /= value;
        }
        for i in (0..D).filter(|i| *i != k) {
            let factor = m[i][k];
            for c in 0..D {
                m[i][c] -= factor * m[k][c];
                inverse[i][c] -= factor * inverse[k][c];
            }
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_inverted() {
        let m = [[0.0, 2.0, 1.0], [1.0, 0.0, 0.0], [3.0, 1.0, 1.0]];
        let mut off = product(&m, &inverse(&m).unwrap());
        add(&mut off, &scaled(-1.0, &unit()));
        assert!(largest(&off) < 1e-15, "{off:?}");
        assert_eq!(inverse(&[[1.0, 2.0], [2.0, 4.0]]), None);
    }
}
