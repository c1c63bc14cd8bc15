//! Gauss's quadrature for what is known as a function.

/// Points of a panel.
const ORDER: usize = 16;

/// Nodes and weights of Gauss and Legendre on [−1, 1], by Newton's method on the Legendre polynomial.
fn nodes() -> [(f64, f64); ORDER] {
    let n = ORDER as f64;
    std::array::from_fn(|i| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut before, mut here) = (1.0, x);
            for k in 2..=ORDER {
                let k = k as f64;
                (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
            }
            slope = n * (x * here - before) / (x * x - 1.0);
            let step = here / slope;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// A composite rule of Gauss: made once, used for many functions.
#[derive(Debug, Clone)]
pub struct Gauss {
    nodes: [(f64, f64); ORDER],
    panels: usize,
}

impl Gauss {
    /// `panels` equal parts of an interval with 16 points each.
    pub fn new(panels: usize) -> Gauss {
        Gauss {
            nodes: nodes(),
            panels: panels.max(1),
        }
    }

    /// `∫ f` from `a` to `b`.
    pub fn integral(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        let half = 0.5 * (b - a) / self.panels as f64;
        let mut sum = 0.0;
        for p in 0..self.panels {
            let middle = a + half * (2 * p + 1) as f64;
            for (x, w) in &self.nodes {
                sum += w * f(middle + half * x);
            }
        }
        sum * half
    }

    /// `∫ f` over the parts between `ends`, which are in order: kinks of f belong there.
    pub fn between(&self, ends: &[f64], mut f: impl FnMut(f64) -> f64) -> f64 {
        let parts = ends.windows(2);
        parts.map(|w| self.integral(w[0], w[1], &mut f)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_and_sines_are_exact() {
        let g = Gauss::new(1);
        assert!(
            (g.integral(0.0, 2.0, |x| x.powi(31)) / (2f64.powi(32) / 32.0) - 1.0).abs() < 1e-14
        );
        let g = Gauss::new(4);
        assert!((g.integral(0.0, 3.0, f64::sin) - (1.0 - 3f64.cos())).abs() < 1e-15);
        assert!((g.between(&[-1.0, 0.0, 2.0], f64::abs) - 2.5).abs() < 1e-15);
    }
}
