//! The displacement gradient that fits the bonds of a point best.

use super::State;

/// A shape tensor whose determinant is below this part of that of a ball is one of bonds that do not span the space.
const FLAT: f64 = 1e-9;

/// `H = (Σ ω V η⊗ξ) K⁻¹` with `K = Σ ω V ξ⊗ξ` of every point over its whole bonds, row by row (–): the gradient that
/// minimises `Σ ω V |η − H ξ|²`. 0 where K cannot be inverted.
pub fn gradient(state: &mut dyn State) -> Vec<[f64; 9]> {
    let (d, n) = (state.dimension(), state.points());
    let mut shape = vec![[0.0; 9]; n];
    let mut moved = vec![[0.0; 9]; n];
    state.each_bond(&mut |bond| {
        if !bond.whole {
            return;
        }
        let weight = bond.weight * bond.volume;
        let (shape, moved) = (&mut shape[bond.id], &mut moved[bond.id]);
        for a in 0..d {
            for b in 0..d {
                shape[3 * a + b] += weight * bond.xi[a] * bond.xi[b];
                moved[3 * a + b] += weight * bond.eta[a] * bond.xi[b];
            }
        }
    });
    let fit = shape.iter().zip(&moved);
    fit.map(|(k, m)| match inverse(k, d) {
        None => [0.0; 9],
        Some(k) => crate::array::from_fn(|ab| {
            let (a, b) = (ab / 3, ab % 3);
            (0..3).map(|c| m[3 * a + c] * k[3 * c + b]).sum()
        }),
    })
    .collect()
}

/// Of a symmetric positive matrix in the first `d` axes; `None`: it is flat.
fn inverse(k: &[f64; 9], d: usize) -> Option<[f64; 9]> {
    let trace: f64 = (0..d).map(|a| k[4 * a]).sum();
    let mean = trace / d as f64;
    if !(mean > 0.0) {
        return None;
    }
    // scaled, with 1 on axes that are not there
    let at = |a: usize, b: usize| match a < d && b < d {
        true => k[3 * a + b] / mean,
        false => f64::from(u8::from(a == b)),
    };
    let minor = |a: usize, b: usize| {
        let (p, q) = ((a + 1) % 3, (a + 2) % 3);
        let (r, s) = ((b + 1) % 3, (b + 2) % 3);
        at(p, r) * at(q, s) - at(p, s) * at(q, r)
    };
    let determinant: f64 = (0..3).map(|b| at(0, b) * minor(0, b)).sum();
    if !(determinant > FLAT) {
        return None;
    }
    Some(crate::array::from_fn(|ab| {
        let (a, b) = (ab / 3, ab % 3);
        match a < d && b < d {
            true => minor(b, a) / determinant / mean,
            false => 0.0,
        }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverse_is_one_in_every_dimension() {
        let k = [4.0, 1.0, 0.5, 1.0, 3.0, -0.2, 0.5, -0.2, 2.0].map(|x| 1e-12 * x);
        for d in 1..=3 {
            let inverse = inverse(&k, d).unwrap();
            for a in 0..3 {
                for b in 0..3 {
                    let product: f64 = (0..d).map(|c| k[3 * a + c] * inverse[3 * c + b]).sum();
                    let one = f64::from(u8::from(a == b && a < d));
                    let wanted = if a < d { one } else { product };
                    assert!((product - wanted).abs() < 1e-15, "{d}: {a} {b}: {product}");
                }
            }
        }
        // in a line, in a plane, nothing
        assert!(inverse(&[1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0], 2).is_none());
        assert!(inverse(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0], 3).is_none());
        assert!(inverse(&[0.0; 9], 1).is_none());
    }
}
