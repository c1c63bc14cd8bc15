//! `G(x) = ∫ g` of any function, tabulated.

use crate::quadrature::Gauss;

/// Equal parts in which a place is found at once.
const PARTS: usize = 4096;

/// How well cubics between two places agree with the integral there, of the largest |g| times the whole length.
const CLOSE: f64 = 4e-15;

/// Of the whole length: parts in which g jumps are halved down to this.
const NARROWEST: f64 = 1e-13;

/// A cubic from place to place with the values of G and g at both.
#[derive(Debug, Clone, Copy)]
struct Cubic {
    places: [f64; 2],
    values: [f64; 2],
    slopes: [f64; 2],
}

impl Cubic {
    fn value(&self, x: f64) -> f64 {
        let ([a, b], [low, high]) = (self.places, self.values);
        let h = b - a;
        let s = (x - a) / h;
        let r = 1.0 - s;
        let bent = r * r * s * self.slopes[0] - s * s * r * self.slopes[1];
        low + (high - low) * s * s * (3.0 - 2.0 * s) + h * bent
    }
}

/// G of a function on an interval, beyond which it goes on as it is there: with the period of the interval, or along straight lines.
#[derive(Debug, Clone)]
pub struct Primitive {
    ends: [f64; 2],
    periodic: bool,
    cubics: Vec<Cubic>,
    /// The first cubic of each of the equal parts.
    first: Vec<usize>,
}

impl Primitive {
    /// Of `g` from `a` to `b`, as small there as `largest`; G(a) = 0. Cubics are halved until they agree with the integral by Gauss, so that g may bend and jump.
    pub fn new(
        g: impl Fn(f64) -> f64,
        [a, b]: [f64; 2],
        largest: f64,
        periodic: bool,
    ) -> Primitive {
        let gauss = Gauss::new(1);
        let length = b - a;
        let close = CLOSE * length * largest;
        let place = |k: usize| a + length * (k as f64 / PARTS as f64);
        let (mut cubics, mut first, mut sum) = (vec![], vec![], 0.0);
        for k in 0..PARTS {
            first.push(cubics.len());
            let mut open = vec![[place(k), place(k + 1)]];
            while let Some([a, b]) = open.pop() {
                let middle = 0.5 * (a + b);
                let [left, right] = [[a, middle], [middle, b]];
                let half = |[a, b]: [f64; 2]| gauss.integral(a, b, &g);
                let (whole, low, high) = (half([a, b]), half(left), half(right));
                let cubic = Cubic {
                    places: [a, b],
                    values: [sum, sum + low + high],
                    slopes: [g(a), g(b)],
                };
                let off = (whole - low - high)
                    .abs()
                    .max((cubic.value(middle) - sum - low).abs());
                if off > close && b - a > NARROWEST * length && a < middle && middle < b {
                    open.extend([right, left]);
                } else {
                    cubics.push(cubic);
                    sum += low + high;
                }
            }
        }
        Primitive {
            ends: [a, b],
            periodic,
            cubics,
            first,
        }
    }

    pub fn value(&self, x: f64) -> f64 {
        let [a, b] = self.ends;
        let length = b - a;
        let periods = match self.periodic {
            true => ((x - a) / length).floor(),
            false => 0.0,
        };
        let inside = (x - periods * length).clamp(a, b);
        let part = ((inside - a) / length * PARTS as f64) as usize;
        let mut n = self.first[part.min(PARTS - 1)];
        while n + 1 < self.cubics.len() && self.cubics[n].places[1] < inside {
            n += 1;
        }
        let last = &self.cubics[self.cubics.len() - 1];
        let beyond = match self.periodic {
            true => periods * last.values[1],
            false if x < a => (x - a) * self.cubics[0].slopes[0],
            false => (x - inside) * last.slopes[1],
        };
        self.cubics[n].value(inside) + beyond
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a sine, of what bends and of what jumps, and beyond the ends.
    #[test]
    fn primitives_are_closed_forms() {
        let tau = std::f64::consts::TAU;
        let sine = Primitive::new(|x| 0.25 + x.sin(), [0.0, tau], 1.25, true);
        let bend = Primitive::new(|x: f64| (x - 0.3).abs(), [-1.0, 1.0], 1.3, false);
        let jump = Primitive::new(|x| f64::from(x < 0.1), [-1.0, 1.0], 1.0, false);
        for k in -300..=600 {
            let x = 0.0171 * f64::from(k);
            let exact = 0.25 * x + 1.0 - x.cos();
            assert!((sine.value(x) - exact).abs() < 1e-13, "{x}");
            let y = (0.3 * x).clamp(-1.0, 1.0);
            let d = y - 0.3;
            let exact = 0.5 * (d * d.abs() + 1.69);
            assert!((bend.value(y) - exact).abs() < 1e-13, "{y}");
            let y = 0.3 * x;
            assert!((jump.value(y) - (y.min(0.1) + 1.0)).abs() < 1e-12, "{y}");
        }
    }
}
