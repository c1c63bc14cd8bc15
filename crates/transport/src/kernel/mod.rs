//! Kernels of difference `z = y − x`: odd ones carry, even ones spread.
//!
//! On a line `φ_a(y, x) = a(|z|) sign z` and `φ_s(y, x) = s(|z|)`; in a plane `φ_a(y, x) = a(|z|) z/|z| · d` along a direction d,
//! and `s(|z|)`. The local limits are `u_t + (M/2)∇·(f(u) d)` with `M = ∫ z_1 φ_a` and `(M/2) Δu` with `M = ∫ z_1² φ_s`: both moments have to be 2.
//! sandia2010 (2.0.6) has `−δ′`, whose first moment is 1 (the limit is then half the flux), and (2.0.15) has `−δ″`, whose second
//! moment is −2 (it sharpens): here it is `−2δ′` and `+δ″`, mollified.

mod bump;

pub use bump::Bump;

use crate::quadrature::Gauss;
use peridyne::error::BuildError;
use peridyne::quantity::rounded;
use std::fmt;
use std::sync::Arc;

/// What both moments have to be for the local law to be the limit.
pub const MOMENT: f64 = 2.0;

/// How far a moment may be off: tables and expressions have rounded constants.
const CLOSE: f64 = 1e-6;

/// Least moment, of that of |φ|: quadrature knows the first to 1e-14 of the second, and a moment is asked for to [`CLOSE`].
const LEAST: f64 = 1e-14 / CLOSE;

/// How far `φ(−z)` may be from `∓φ(z)`, of the largest value.
const PARITY: f64 = 1e-9;

/// A function of z.
pub type Function = Arc<dyn Fn(f64) -> f64 + Send + Sync>;

/// Whether a kernel is antisymmetric or symmetric in x and y.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parity {
    /// φ_a
    Odd,
    /// φ_s
    Even,
}

/// Where the values of a kernel come from.
#[derive(Clone)]
pub enum Profile {
    /// `−2b′`: mollified `−2δ′`, odd.
    Slope(Bump),
    /// `b`: not negative, even.
    Value(Bump),
    /// `−2b′(z)/z`: not negative, even; the partner of [`Profile::Slope`], as `z φ_s = φ_a`.
    SlopeOverDistance(Bump),
    /// `b″`: mollified `+δ″`, even; changes its sign.
    Curvature(Bump),
    /// Given on both sides of 0.
    Function(Function),
    /// Straight lines between points `(z, φ)` in order of z, either on one side (from z ≥ 0 on) or on both.
    Table(Vec<[f64; 2]>),
}

impl fmt::Debug for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Profile::Slope(b) => write!(f, "Slope({b:?})"),
            Profile::Value(b) => write!(f, "Value({b:?})"),
            Profile::SlopeOverDistance(b) => write!(f, "SlopeOverDistance({b:?})"),
            Profile::Curvature(b) => write!(f, "Curvature({b:?})"),
            Profile::Function(_) => f.write_str("Function"),
            Profile::Table(t) => write!(f, "Table({})", t.len()),
        }
    }
}

impl Profile {
    /// The bump that it is made of; its size is then ours to choose.
    fn bump(&self) -> Option<Bump> {
        match self {
            Profile::Slope(b)
            | Profile::Value(b)
            | Profile::SlopeOverDistance(b)
            | Profile::Curvature(b) => Some(*b),
            Profile::Function(_) | Profile::Table(_) => None,
        }
    }
}

/// A kernel of a horizon: its values at distances, and its moment.
#[derive(Debug, Clone)]
pub struct Kernel {
    profile: Profile,
    parity: Parity,
    horizon: f64,
    dimension: usize,
    scale: f64,
}

impl Kernel {
    /// A kernel whose moment is 2, in 1 or 2 dimensions. Bumps are brought to it; functions and tables have to have it, or are
    /// brought to it by a factor if `normalise`.
    ///
    /// # Errors
    /// `path` is in all of them. A horizon that is not positive; a function or table that is not odd (even) or not finite; a moment other
    /// than 2, with the factor; `b″` of a bump that has none; a table that is not in order or ends before the horizon.
    pub fn new(
        parity: Parity,
        profile: Profile,
        horizon: f64,
        dimension: usize,
        normalise: bool,
        path: &str,
    ) -> Result<Kernel, BuildError> {
        if !(horizon > 0.0 && horizon.is_finite()) {
            return Err(BuildError::invalid(
                path,
                format!("the horizon must be positive, it is {horizon}"),
            ));
        }
        let mut kernel = Kernel {
            profile,
            parity,
            horizon,
            dimension,
            scale: 1.0,
        };
        kernel.check_table(path)?;
        kernel.check_values(path)?;
        let moment = kernel.moment();
        if !(moment.abs() > 0.0 && moment.is_finite()) {
            return Err(BuildError::invalid(
                path,
                format!(
                    "the {} of this kernel is {moment:.6}: there is no local limit",
                    kernel.moment_name()
                ),
            ));
        }
        let absolute = kernel.absolute_moment();
        if moment.abs() <= LEAST * absolute {
            return Err(BuildError::ill_posed(
                path,
                format!(
                    "the {} of this kernel is 0 but for round-off, {moment:.1e} where that of |φ| is {absolute:.3e}: there is no local limit, and no factor that brings it to 2",
                    kernel.moment_name()
                ),
            )
            .help(match parity {
                Parity::Odd => "take a kernel whose parts for z > 0 do not cancel, such as z*(delta - abs(z))",
                Parity::Even => "take a kernel whose parts do not cancel, such as delta - abs(z)",
            }));
        }
        let factor = MOMENT / moment;
        if normalise && factor < 0.0 {
            return Err(BuildError::ill_posed(
                path,
                format!(
                    "the {} of this kernel is {moment:.6}: brought to 2 it would have the other sign, and {} the other way",
                    kernel.moment_name(),
                    match parity {
                        Parity::Odd => "carry",
                        Parity::Even => "spread",
                    }
                ),
            )
            .help("write the kernel with the other sign"));
        }
        if normalise || kernel.profile.bump().is_some() {
            kernel.scale = factor;
        } else if (factor - 1.0).abs() > CLOSE {
            let name = kernel.moment_name();
            return Err(BuildError::invalid(
                path,
                format!("the {name} of this kernel is {moment:.9}, not 2: the local limit has {:.9} of the {}", 1.0 / factor, match parity {
                    Parity::Odd => "flux",
                    Parity::Even => "diffusion",
                }),
            )
            .help(format!("multiply it by {factor:.12}, or write normalise = true")));
        }
        Ok(kernel)
    }

    fn moment_name(&self) -> &'static str {
        match self.parity {
            Parity::Odd => "first moment ∫zφ dz",
            Parity::Even => "second moment ∫z²φ dz",
        }
    }

    fn check_table(&self, path: &str) -> Result<(), BuildError> {
        let Profile::Table(table) = &self.profile else {
            return Ok(());
        };
        let wrong = |what: String| Err(BuildError::invalid(path, what));
        if table.len() < 2 {
            return wrong("a table of a kernel needs two points [z, φ] or more".into());
        }
        if let Some(w) = table.windows(2).find(|w| !(w[0][0] < w[1][0])) {
            return wrong(format!(
                "points of a table come in order of z: {} stands before {}",
                w[0][0], w[1][0]
            ));
        }
        let (first, last) = (table[0][0], table[table.len() - 1][0]);
        let reaches = |z: f64| z >= self.horizon * (1.0 - 1e-9);
        if first > 1e-9 * self.horizon {
            return wrong(format!(
                "the table begins at z = {first}, and says nothing of what lies between that and 0"
            ));
        }
        if !reaches(last) || first < 0.0 && !reaches(-first) {
            return wrong(format!(
                "the table goes from z = {first} to {last}, the horizon is {}",
                self.horizon
            ));
        }
        Ok(())
    }

    /// Finite, and as its parity asks.
    fn check_values(&self, path: &str) -> Result<(), BuildError> {
        if let Profile::Curvature(bump) = self.profile
            && !bump.has_curvature()
        {
            return Err(BuildError::invalid(
                path,
                format!("{bump:?} has no second derivative without points of mass"),
            )
            .help("take cosine, smooth, or polynomial of a power of 2 or more"));
        }
        let both_sides = match &self.profile {
            Profile::Function(_) => true,
            Profile::Table(t) => t[0][0] < 0.0,
            Profile::Slope(_)
            | Profile::Value(_)
            | Profile::SlopeOverDistance(_)
            | Profile::Curvature(_) => false,
        };
        let places: Vec<f64> = (1..=400)
            .map(|k| (f64::from(k) - 0.37) / 400.0 * self.horizon)
            .collect();
        let right: Vec<f64> = places.iter().map(|z| self.raw(*z)).collect();
        let largest = right.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        for (z, v) in places.iter().zip(&right) {
            let other = if both_sides { self.raw(-z) } else { *v };
            if !v.is_finite() || !other.is_finite() {
                return Err(BuildError::invalid(
                    path,
                    format!(
                        "the kernel is {v} at z = {z:.6} and {other} at z = {:.6}",
                        -z
                    ),
                ));
            }
            let (sum, name) = match self.parity {
                Parity::Odd => (v + other, "antisymmetric: φ(−z) must be −φ(z)"),
                Parity::Even => (v - other, "symmetric: φ(−z) must be φ(z)"),
            };
            if both_sides && sum.abs() > PARITY * largest {
                return Err(BuildError::invalid(
                    path,
                    format!(
                        "the kernel is not {name}, and is {} at z = {z:.6}, {} at z = {:.6}",
                        rounded(*v, 6),
                        rounded(other, 6),
                        -z
                    ),
                )
                .help(match self.parity {
                    Parity::Odd => "use an odd function of z; sign(z) and abs(z) are at hand",
                    Parity::Even => "use an even function of z, such as of abs(z)",
                }));
            }
        }
        Ok(())
    }

    /// The profile before it is scaled, on either side where it has two.
    fn raw(&self, z: f64) -> f64 {
        let (r, d) = (z.abs(), self.horizon);
        let s = r / d;
        match &self.profile {
            _ if s > 1.0 + 1e-12 => 0.0,
            Profile::Slope(b) => -2.0 * b.slope(s.min(1.0)) / (d * d),
            Profile::Value(b) => b.value(s) / d,
            Profile::SlopeOverDistance(b) => -2.0 * b.slope(s.min(1.0)) / (d * d * r),
            Profile::Curvature(b) => b.curvature(s.min(1.0)) / (d * d * d),
            Profile::Function(f) => f(z),
            Profile::Table(t) => {
                let z = if t[0][0] < 0.0 { z } else { r };
                let next = t.partition_point(|p| p[0] < z).clamp(1, t.len() - 1);
                let ([z0, f0], [z1, f1]) = (t[next - 1], t[next]);
                f0 + (f1 - f0) * ((z - z0) / (z1 - z0))
            }
        }
    }

    pub fn parity(&self) -> Parity {
        self.parity
    }

    pub fn horizon(&self) -> f64 {
        self.horizon
    }

    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// `a(r)` or `s(r)` at a distance (1/length² of an odd and 1/length³ of an even one on a line; a length more in a plane).
    pub fn value(&self, r: f64) -> f64 {
        self.scale * self.raw(r)
    }

    /// Ends of parts on which the profile is smooth.
    pub(crate) fn parts(&self) -> Vec<f64> {
        let mut ends = vec![0.0];
        if let Profile::Table(t) = &self.profile {
            ends.extend(
                t.iter()
                    .map(|p| p[0])
                    .filter(|z| *z > 0.0 && *z < self.horizon),
            );
        }
        ends.push(self.horizon);
        ends
    }

    /// `∫ z_1 φ` of an odd, `∫ z_1² φ` of an even kernel, by quadrature in 1-D and in a plane, to 1e-14; 2 once the kernel is made.
    pub fn moment(&self) -> f64 {
        self.power_moment(match self.parity {
            Parity::Odd => 1,
            Parity::Even => 2,
        })
    }

    /// The same of |φ|.
    fn absolute_moment(&self) -> f64 {
        self.radial(
            match self.parity {
                Parity::Odd => 1,
                Parity::Even => 2,
            },
            f64::abs,
        )
    }

    /// `∫ |z|^p φ` on a line; in a plane with the part of one axis, `π ∫ r^{p+1} φ dr`.
    pub fn power_moment(&self, p: i32) -> f64 {
        self.radial(p, |value| value)
    }

    fn radial(&self, p: i32, of: impl Fn(f64) -> f64) -> f64 {
        let (factor, more) = match self.dimension {
            1 => (2.0, 0),
            _ => (std::f64::consts::PI, 1),
        };
        factor * self.integral(64, |r| r.powi(p + more) * of(self.value(r)))
    }

    /// `∫₀^δ f`, where f is smooth on the parts of the profile; of a function nobody says where these end.
    fn integral(&self, panels: usize, f: impl Fn(f64) -> f64) -> f64 {
        let gauss = Gauss::new(panels);
        match self.profile {
            Profile::Function(_) => gauss.adaptive(0.0, self.horizon, f),
            Profile::Slope(_)
            | Profile::Value(_)
            | Profile::SlopeOverDistance(_)
            | Profile::Curvature(_)
            | Profile::Table(_) => gauss.between(&self.parts(), f),
        }
    }

    /// On a line: `α(k) = ∫₀ a sin kz dz` of an odd kernel (`∫ φ_a (u(y)+u(x))/2 dy` of `e^{ikx}` is `iα e^{ikx}`), and
    /// `2 ∫₀ s (cos kz − 1) dz` of an even one; 1/length and 1/length².
    pub fn symbol(&self, k: f64) -> f64 {
        let panels = 16 + (k.abs() * self.horizon / 4.0) as usize;
        self.integral(panels, |z| match self.parity {
            Parity::Odd => self.value(z) * libm::sin(k * z),
            // cos − 1 without cancellation
            Parity::Even => -4.0 * self.value(z) * libm::sin(0.5 * k * z).powi(2),
        })
    }

    /// The same of `e^{μx}`: `∫₀ a sinh μz dz` and `2 ∫₀ s (cosh μz − 1) dz`.
    pub fn growth(&self, mu: f64) -> f64 {
        let panels = 16 + (mu.abs() * self.horizon / 4.0) as usize;
        self.integral(panels, |z| match self.parity {
            Parity::Odd => self.value(z) * libm::sinh(mu * z),
            Parity::Even => 4.0 * self.value(z) * libm::sinh(0.5 * mu * z).powi(2),
        })
    }
}
