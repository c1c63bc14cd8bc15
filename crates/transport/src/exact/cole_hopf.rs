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

/// Points of the trapezoidal rule, which errs less than any power of their distance for what decays like a bell.
const POINTS: usize = 4001;

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

    /// u at x and t > 0.
    pub fn value(&self, x: f64, t: f64) -> f64 {
        // beyond, Φ is 80ε above its least value at the least
        let reach = 2.0 * self.fastest * t + (160.0 * self.viscosity * t).sqrt();
        let step = 2.0 * reach / (POINTS - 1) as f64;
        let place = |n: usize| x - reach + step * n as f64;
        let phase = |y: f64| (self.primitive)(y) + (x - y) * (x - y) / (2.0 * t);
        let phases: Vec<f64> = (0..POINTS).map(|n| phase(place(n))).collect();
        let least = phases.iter().copied().fold(f64::INFINITY, f64::min);
        let (mut above, mut below) = (0.0, 0.0);
        for (n, p) in phases.iter().enumerate() {
            let weight = (-(p - least) / (2.0 * self.viscosity)).exp();
            above += weight * (x - place(n)) / t;
            below += weight;
        }
        above / below
    }
}
