//! Gauss's quadrature for what is known as a function.

/// Points of a panel.
const ORDER: usize = 16;

/// Nodes and weights of Gauss and Legendre on [−1, 1], by Newton's method on the Legendre polynomial.
fn nodes() -> [(f64, f64); ORDER] {
    let n = ORDER as f64;
    std::array::from_fn(|i| {
        let mut x = libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
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

    /// `∫ f` from `a` to `b` of what may jump or bend anywhere: panels are halved until both halves agree with the whole to 1e-14 of `∫ |f|`.
    pub fn adaptive(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        /// Of the integral.
        const CLOSE: f64 = 1e-14;
        /// Panels of what never agrees, such as noise.
        const MOST: usize = 1 << 16;
        let one = Gauss {
            nodes: self.nodes,
            panels: 1,
        };
        let width = (b - a) / self.panels as f64;
        let all = 0..self.panels;
        let mut open: Vec<(f64, f64, f64)> = all
            .rev()
            .map(|p| {
                let (a, b) = (a + width * p as f64, a + width * (p + 1) as f64);
                (a, b, one.integral(a, b, &mut f))
            })
            .collect();
        let size: f64 = self.integral(a, b, |x| f(x).abs());
        let (mut sum, mut looked) = (0.0, open.len());
        while let Some((a, b, whole)) = open.pop() {
            let middle = 0.5 * (a + b);
            let halves = [(a, middle), (middle, b)].map(|(a, b)| one.integral(a, b, &mut f));
            looked += 2;
            let off = (whole - halves[0] - halves[1]).abs();
            if off > CLOSE * size && looked < MOST && a < middle && middle < b {
                open.push((middle, b, halves[1]));
                open.push((a, middle, halves[0]));
            } else {
                sum += halves[0] + halves[1];
            }
        }
        sum
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

    #[test]
    fn jumps_and_bends_are_found() {
        let g = Gauss::new(8);
        let jump = |x: f64| if x < 1.0 / 3.0 { x.exp() } else { 0.0 };
        let exact = (1.0f64 / 3.0).exp() - 1.0;
        assert!((g.adaptive(0.0, 1.0, jump) / exact - 1.0).abs() < 1e-13);
        // panels alone do not see where it jumps
        assert!((g.integral(0.0, 1.0, jump) / exact - 1.0).abs() > 1e-5);
        let bend = |x: f64| (x - 0.3).abs();
        assert!((g.adaptive(0.0, 1.0, bend) - 0.29).abs() < 1e-15);
        assert!((g.adaptive(0.0, 1.0, |x| x.powf(-0.5)) - 2.0).abs() < 1e-8);
        // what never agrees comes to an end
        assert!(g.adaptive(0.0, 1.0, |x| (1e9 * x).sin()).abs() < 1.0);
    }
}
