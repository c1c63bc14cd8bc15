//! Lowest modes of vibration: `K φ = ω² M φ`, by Lanczos on the inverse.

use super::direct::{Direct, SYMMETRIC};
use super::masses::Masses;
use super::support::Support;
use super::vectors::{add, dot};
use crate::error::SolveError;
use crate::execute::memory;
use crate::spec::LinearBody;
use peridyne_algebra::symmetric_eigen;

/// A mode of vibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode<const D: usize> {
    /// `ω²` (1 / time²), round-off of 0 for rigid motions; negative: unstable.
    pub square: f64,
    /// `[N]` displacement, `φ·Mφ = 1`.
    pub shape: Vec<[f64; D]>,
}

impl<const D: usize> Mode<D> {
    /// Cycles per time; 0 for rigid motions.
    pub fn frequency(&self) -> f64 {
        self.square.max(0.0).sqrt() / (2.0 * std::f64::consts::PI)
    }
}

/// Residual of a mode, `|Kφ − ω²Mφ|` over `ω²_max`'s bound, that counts as found.
const TOLERANCE: f64 = 1e-10;

/// The lowest `count` modes, lowest first; fewer if the body has fewer.
///
/// # Errors
/// Those of the factorisation.
pub fn lowest<const D: usize>(
    body: &LinearBody<D>,
    support: &Support<D>,
    count: usize,
) -> Result<Vec<Mode<D>>, SolveError> {
    let asymmetry = body.soundness().asymmetry;
    if asymmetry > SYMMETRIC {
        return Err(SolveError::NotSymmetric { asymmetry });
    }
    let mass = body.masses();
    let coupled = Masses::of(body);
    // a bound on ω², for the shift that makes rigid motions harmless
    let stiffest = (0..body.points())
        .map(|i| {
            let sum: f64 = body.row(i).1.iter().map(largest).sum();
            2.0 * sum / body.density[i]
        })
        .fold(0.0, f64::max);
    let shift = 1e-8 * stiffest;
    let most = support.unknowns();
    let count = count.min(most);
    let steps = (4 * count + 40).min(most);
    // the basis and its products with the masses
    let bytes = 16.0 * (steps * D) as f64 * body.points() as f64;
    if let Some(left) = memory::available().filter(|left| bytes > *left) {
        return Err(SolveError::TooManyModes { count, bytes, left });
    }
    let factors = match &coupled {
        None => Direct::new(body, support, shift)?,
        Some(masses) => {
            let (shifted, own) = masses.with(body, shift);
            Direct::against(&shifted, support, &own)?
        }
    };
    let mut q = all_in_motion(body.points());
    support.mask(&mut q);
    let of = Vibration {
        body,
        support,
        mass,
        coupled,
        stiffest,
    };
    let krylov = of.krylov(q, &factors, steps);
    let n = krylov.basis.len();
    let (_, vectors) =
        symmetric_eigen(n, |i, j| krylov.entry(i, j)).ok_or(SolveError::NotFinite)?;
    let modes = (n - count.min(n)..n).rev();
    let modes = modes.map(|k| of.mode(&krylov.basis, &vectors[k]));
    let mut modes = modes.collect::<Result<Vec<_>, _>>()?;
    modes.sort_by(|a, b| a.square.total_cmp(&b.square));
    Ok(modes)
}

/// A displacement in which every point moves and that has no symmetry.
fn all_in_motion<const D: usize>(points: usize) -> Vec<[f64; D]> {
    (0..points)
        .map(|i| {
            crate::array::from_fn(|a| {
                ((i * D + a + 1) as f64 * 0.618_033_988_749_894_9).fract() - 0.5
            })
        })
        .collect()
}

/// What Lanczos found: an orthonormal basis, its products with the masses, and the tridiagonal matrix on it.
struct Krylov<const D: usize> {
    basis: Vec<Vec<[f64; D]>>,
    images: Vec<Vec<[f64; D]>>,
    alpha: Vec<f64>,
    beta: Vec<f64>,
}

impl<const D: usize> Krylov<D> {
    /// Of the lower triangle.
    fn entry(&self, i: usize, j: usize) -> f64 {
        match i - j {
            0 => self.alpha[i],
            1 => self.beta[j],
            _ => 0.0,
        }
    }
}

/// A supported body that vibrates.
struct Vibration<'a, const D: usize> {
    body: &'a LinearBody<D>,
    support: &'a Support<D>,
    mass: Vec<f64>,
    /// Where masses couple points.
    coupled: Option<Masses<D>>,
    /// A bound on `ω²`.
    stiffest: f64,
}

impl<const D: usize> Vibration<'_, D> {
    fn times_mass(&self, x: &[[f64; D]]) -> Vec<[f64; D]> {
        match &self.coupled {
            None => {
                let both = x.iter().zip(&self.mass);
                both.map(|(x, m)| x.map(|c| c * m)).collect()
            }
            Some(masses) => {
                let mut product = masses.times(x);
                self.support.mask(&mut product);
                product
            }
        }
    }

    /// From `q` on, as many steps or until nothing new comes.
    fn krylov(&self, mut q: Vec<[f64; D]>, factors: &Direct<D>, steps: usize) -> Krylov<D> {
        let mut made = Krylov {
            basis: vec![],
            images: vec![],
            alpha: vec![],
            beta: vec![],
        };
        for _ in 0..steps {
            let mut mq = self.times_mass(&q);
            // twice is enough
            for _ in 0..2 {
                for (b, m) in made.basis.iter().zip(&made.images) {
                    let part = dot(&q, m);
                    add(&mut q, -part, b);
                }
                mq = self.times_mass(&q);
            }
            let norm = dot(&q, &mq).sqrt();
            let entries = made.alpha.iter().copied();
            let scale = entries.fold(0.0f64, |m, a: f64| m.max(a.abs()));
            if !(norm > 1e-13 * scale) {
                break;
            }
            if !made.alpha.is_empty() {
                made.beta.push(norm);
            }
            for c in q.iter_mut().chain(&mut mq).flatten() {
                *c /= norm;
            }
            let next = factors.solve(&mq);
            made.alpha.push(dot(&next, &mq));
            made.basis.push(std::mem::replace(&mut q, next));
            made.images.push(mq);
        }
        made
    }

    /// The mode that has these parts of the basis, if it is one.
    fn mode(&self, basis: &[Vec<[f64; D]>], parts: &[f64]) -> Result<Mode<D>, SolveError> {
        let body = self.body;
        let mut shape = vec![[0.0; D]; body.points()];
        for (part, b) in parts.iter().zip(basis) {
            add(&mut shape, *part, b);
        }
        // Rayleigh's quotient is better than the eigenvalue, above all for rigid motions
        let m = self.times_mass(&shape);
        let energy: f64 = (0..body.points())
            .map(|i| {
                let f = body.force(&shape, i);
                -body.volume[i] * (0..D).map(|a| f[a] * shape[i][a]).sum::<f64>()
            })
            .sum();
        let square = energy / dot(&shape, &m);
        let residual: f64 = (0..body.points())
            .map(|i| {
                let f = body.force(&shape, i);
                let free = (0..D).filter(|a| self.support.free[i][*a]);
                free.map(|a| (body.volume[i] * f[a] + square * m[i][a]).powi(2) / self.mass[i])
                    .sum::<f64>()
            })
            .sum::<f64>()
            .sqrt();
        if residual > TOLERANCE.sqrt() * self.stiffest {
            return Err(SolveError::NotConverged {
                iterations: basis.len(),
                residual: residual / self.stiffest,
                tolerance: TOLERANCE.sqrt(),
            });
        }
        Ok(Mode { square, shape })
    }
}

fn largest<const D: usize>(c: &[[f64; D]; D]) -> f64 {
    c.iter()
        .map(|row| row.iter().map(|x| x.abs()).sum())
        .fold(0.0, f64::max)
}
