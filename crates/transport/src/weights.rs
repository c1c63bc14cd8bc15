//! Weights of bonds on a grid: conservative and with the right moments.
//!
//! `∫ g(z) φ(z) dz ≈ Σ_m w_m g(mh)` with `w_m = h φ(mh) (α + β (m/M)²)`, half at an end that lies on the horizon. Weights of −m and m are
//! ∓ each other, so the sum over all points telescopes and `Σ u` is kept to round-off; α and β give the moment 2, which the local limit
//! needs on every grid, and on a line the next moment, which is that of the δ² term, where that leaves the signs of the kernel (else β is 0).
//! In a plane the moment is a tensor, `Σ w_a m_b h` of an odd and `Σ w m_a m_b h²` of an even kernel. The family is the same after a turn by 90° and in a mirror, and so are its
//! weights, whence that tensor is a multiple of the unit tensor, and α alone makes it 2: xx, yy and xy are exact.

use crate::grid::Grid;
use crate::kernel::{Kernel, MOMENT, Parity};
use peridyne::error::BuildError;
use peridyne::quantity::rounded;

/// Spacings that a horizon has at least: two bonds on either side, though the kernel may be 0 at the horizon, for two moments.
pub const FEWEST: f64 = 3.0;

/// Factor by which the moment of the sum may be off before it is corrected: bumps of three spacings and more are within a third, and a sum that is farther off is no
/// quadrature of the kernel.
const OFF: f64 = 4.0;

/// Half of the bonds of a point: those of +m; a bond of −m has the weight ∓.
#[derive(Debug, Clone, PartialEq)]
pub struct Stencil {
    pub parity: Parity,
    /// Steps of the grid.
    pub steps: Vec<[isize; 2]>,
    /// Of each step: of an odd kernel a vector `w_m m/|m|`, of an even one the weight and 0.
    pub weights: Vec<[f64; 2]>,
}

impl Stencil {
    /// # Errors
    /// A horizon of fewer than 3 spacings, and of more than a million (in a plane 500); a kernel that the grid does not resolve.
    pub fn new(kernel: &Kernel, grid: &Grid, path: &str) -> Result<Stencil, BuildError> {
        let ratio = kernel.horizon() / grid.spacing;
        let coarse = |what: String| {
            Err(BuildError::invalid(path, what).help(format!(
                "write a horizon of {FEWEST} spacings or more, or more points"
            )))
        };
        if ratio < FEWEST * (1.0 - 1e-9) {
            return coarse(format!(
                "the horizon is under-resolved: {} is {ratio:.3} spacings of {}",
                rounded(kernel.horizon(), 6),
                rounded(grid.spacing, 6)
            ));
        }
        let most = if grid.dimension == 1 { 1e6 } else { 500.0 };
        if ratio > most {
            return Err(BuildError::too_many(
                path,
                format!("the horizon has {ratio:.0} spacings: it may have {most:.0} at most"),
            ));
        }
        let (steps, raw) = sampled(kernel, grid, ratio);
        let power = match kernel.parity() {
            Parity::Odd => 1,
            Parity::Even => 2,
        };
        let length = |m: &[isize; 2]| grid.spacing * ((m[0] * m[0] + m[1] * m[1]) as f64).sqrt();
        // of an axis: on a line |z|^p, in a plane the part of both axes halved
        let share = if grid.dimension == 1 { 2.0 } else { 1.0 };
        let moment = |p: i32, s: i32| -> f64 {
            let parts = steps.iter().zip(&raw);
            parts
                .map(|(m, w)| {
                    share * w * length(m).powi(p) * (length(m) / kernel.horizon()).powi(s)
                })
                .sum()
        };
        let found = moment(power, 0);
        if !(found > MOMENT / OFF && found < MOMENT * OFF) {
            return Err(BuildError::ill_posed(
                path,
                format!(
                    "this grid does not resolve the kernel: its moment, summed over bonds of {} spacings at most, is {found:.4}, and 2 in the continuum",
                    rounded(ratio, 4)
                ),
            )
            .help("write more points, or a kernel without parts that are narrower than a spacing"));
        }
        let one = MOMENT / found;
        let factors = match grid.dimension {
            1 => {
                let (a, b, c, d) = (
                    moment(power, 0),
                    moment(power, 2),
                    moment(power + 2, 0),
                    moment(power + 2, 2),
                );
                let (first, next) = (MOMENT, kernel.power_moment(power + 2));
                let determinant = a * d - b * c;
                [
                    (first * d - b * next) / determinant,
                    (a * next - c * first) / determinant,
                ]
            }
            _ => [one, 0.0],
        };
        let with = |factors: [f64; 2]| -> Vec<f64> {
            let each = steps.iter().zip(&raw).map(|(m, w)| {
                w * (factors[0] + factors[1] * (length(m) / kernel.horizon()).powi(2))
            });
            each.collect()
        };
        let mut corrected = with(factors);
        let first: f64 = { steps.iter().zip(&corrected) }
            .map(|(m, w)| share * w * length(m).powi(power))
            .sum();
        // few bonds: both moments would need a weight of the other sign, or differ by round-off alone; one does not
        let turned = corrected.iter().zip(&raw).any(|(c, w)| !(c * w >= 0.0));
        if turned || !((first - MOMENT).abs() < 1e-9 * MOMENT) {
            corrected = with([one, 0.0]);
        }
        let weights = steps.iter().zip(&corrected).map(|(m, w)| {
            let r = ((m[0] * m[0] + m[1] * m[1]) as f64).sqrt();
            match kernel.parity() {
                Parity::Odd => [w * m[0] as f64 / r, w * m[1] as f64 / r],
                Parity::Even => [*w, 0.0],
            }
        });
        let weights: Vec<[f64; 2]> = weights.collect();
        Ok(Stencil {
            parity: kernel.parity(),
            steps,
            weights,
        })
    }

    /// Steps of the longest bond along an axis.
    pub fn reach(&self) -> usize {
        self.steps
            .iter()
            .flatten()
            .map(|m| m.unsigned_abs())
            .max()
            .unwrap_or(0)
    }

    /// Of a wave `e^{i(k·x)}`: `Σ w sin(k·mh)` along each axis of an odd, `2 Σ w (cos(k·mh) − 1)` of an even kernel, with the phases `k_1 h, k_2 h`.
    pub fn symbol(&self, phase: [f64; 2]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (m, w) in self.steps.iter().zip(&self.weights) {
            let angle = phase[0] * m[0] as f64 + phase[1] * m[1] as f64;
            let value = match self.parity {
                Parity::Odd => libm::sin(angle),
                Parity::Even => -4.0 * libm::sin(0.5 * angle).powi(2),
            };
            sum[0] += w[0] * value;
            sum[1] += w[1] * value;
        }
        sum
    }
}

/// Steps within the horizon, half of them, with `h^D φ(|m|h)`.
fn sampled(kernel: &Kernel, grid: &Grid, ratio: f64) -> (Vec<[isize; 2]>, Vec<f64>) {
    let whole = ratio.floor().max((ratio * (1.0 + 1e-9)).floor()) as isize;
    let h = grid.spacing;
    let mut steps = Vec::new();
    let mut weights = Vec::new();
    if grid.dimension == 1 {
        // the last takes what lies between it and the horizon besides half a cell
        for m in 1..=whole {
            let part = if m < whole {
                1.0
            } else {
                0.5 + (ratio - whole as f64).max(0.0)
            };
            steps.push([m, 0]);
            weights.push(h * part * kernel.value((m as f64 * h).min(kernel.horizon())));
        }
        return (steps, weights);
    }
    for j in 0..=whole {
        for i in -whole..=whole {
            let r = ((i * i + j * j) as f64).sqrt();
            if (j == 0 && i <= 0) || r > ratio * (1.0 + 1e-9) {
                continue;
            }
            steps.push([i, j]);
            weights.push(h * h * kernel.value((r * h).min(kernel.horizon())));
        }
    }
    (steps, weights)
}
