//! The viscous Burgers equation of Cole and Hopf.

use peridyne::error::BuildError;

/// `u_t + u u_x = ε u_xx` from `u = g` with `G′ = g`:
/// `u(x, t) = ∫ ((x − y)/t) e^{−Φ/2ε} dy / ∫ e^{−Φ/2ε} dy`, `Φ = G(y) + (x − y)²/2t` (Cole 1951, Hopf 1950).
#[derive(Debug, Clone)]
pub struct ColeHopf<G> {
    /// The primitive G of the initial state.
    pub primitive: G,
    /// Largest `|g|`.
    pub fastest: f64,
    /// ε
    pub viscosity: f64,
}

/// Places at which Φ is looked at first: G may bend once between neighbours, not oscillate.
const LOOKS: usize = 4001;

/// Points of the trapezoidal rule in each well of Φ, which errs less than any power of their distance for what decays like a bell.
const POINTS: usize = 2001;

impl<G: Fn(f64) -> f64> ColeHopf<G> {
    /// # Errors
    /// A viscosity that is not positive.
    pub fn new(primitive: G, fastest: f64, viscosity: f64) -> Result<Self, BuildError> {
        match viscosity > 0.0 {
            true => Ok(ColeHopf {
                primitive,
                fastest,
                viscosity,
            }),
            false => Err(BuildError::invalid(
                "diffusion.viscosity",
                "Cole and Hopf need a positive viscosity",
            )),
        }
    }

    /// u at x and t > 0, for ε of any size: exponents are taken from the least Φ on, so that the largest weight is 1 and none overflows, and only wells where Φ is within 80ε of
    /// that are summed, each by points of its own. Two wells of one depth are a shock. Where ε is below the round-off of Φ, u is good to its root, 1e-8.
    pub fn value(&self, x: f64, t: f64) -> f64 {
        // e^{−40}
        let deep = 80.0 * self.viscosity;
        // beyond, Φ is above its least value by more than that
        let reach = 2.0 * self.fastest * t + (2.0 * deep * t).sqrt();
        let step = 2.0 * reach / (LOOKS - 1) as f64;
        let place = |n: usize| x - reach + step * n as f64;
        let phase = |y: f64| (self.primitive)(y) + (x - y) * (x - y) / (2.0 * t);
        let looked: Vec<f64> = (0..LOOKS).map(|n| phase(place(n))).collect();
        let bottoms: Vec<(usize, f64, f64)> = (0..LOOKS)
            .filter(|n| {
                looked[n.saturating_sub(1)].min(looked[(n + 1).min(LOOKS - 1)]) >= looked[*n]
            })
            .map(|n| {
                let y = bottom(place(n) - step, place(n) + step, phase);
                match phase(y) < looked[n] {
                    true => (n, y, phase(y)),
                    false => (n, place(n), looked[n]),
                }
            })
            .collect();
        let least = bottoms.iter().map(|b| b.2).fold(f64::INFINITY, f64::min);
        let inside = |y: f64| phase(y) - least < deep;
        // from a bottom to where Φ leaves the well, first in steps of the looks, then between two of them
        let edge = |n: usize, y: f64, way: f64| {
            let (mut within, mut beyond) = (y, place(n) + way * step);
            while inside(beyond) && (beyond - x).abs() < reach {
                (within, beyond) = (beyond, beyond + way * step);
            }
            for _ in 0..60 {
                let middle = 0.5 * (within + beyond);
                match inside(middle) {
                    true => within = middle,
                    false => beyond = middle,
                }
            }
            beyond
        };
        let mut wells: Vec<[f64; 2]> = vec![];
        for (n, y, _) in bottoms.iter().filter(|b| b.2 - least < deep) {
            let [low, high] = [edge(*n, *y, -1.0), edge(*n, *y, 1.0)];
            match wells.last_mut() {
                Some(last) if low <= last[1] => last[1] = last[1].max(high),
                _ => wells.push([low, high]),
            }
        }
        let (mut above, mut below) = (0.0, 0.0);
        for [low, high] in wells {
            let width = (high - low) / (POINTS - 1) as f64;
            // of wells narrower than numbers are apart the places are one, and any width does
            let width = width.max(f64::MIN_POSITIVE);
            for k in 0..POINTS {
                let y = low + width * k as f64;
                let weight =
                    width * libm::exp(-(phase(y) - least).max(0.0) / (2.0 * self.viscosity));
                above += weight * (x - y) / t;
                below += weight;
            }
        }
        above / below
    }
}

/// The place of the least value between `a` and `b`, where there is one.
fn bottom(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..100 {
        let (p, q) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        match f(p) <= f(q) {
            true => b = q,
            false => a = p,
        }
    }
    0.5 * (a + b)
}
