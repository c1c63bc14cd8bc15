//! The linear peristatic bar: points a spacing Δ apart, bonds over at most m of them, pulled at both ends.
//!
//! `c A Σ_j s_ij (u_j − u_i) = −b_i`, `s_ij = α_ij w_ij/|i − j|`: w is the part of the volume AΔ that point i sees of point j,
//! ½ for a point on the horizon or an end point of half weight (not ¼ for one that is both), else 1; α are the factors of
//! bonds to an end point, which make the bar homogeneous. `c = 2E/(Aδ²)`, δ = mΔ. Ends carry `b = ±σ/Δ`, of half weight
//! `±2σ/Δ`. In units of Δσ/E for displacements: `Σ_j s_ij (u_j − u_i) = −m²/2` at a full end, `−m²` at a half one, 0 elsewhere.
//!
//! | question | module |
//! |---|---|
//! | coefficients of the equations | [`stiffness_matrix`], [`equations`] |
//! | which factors make uniform strain exact? | [`parameters`] |
//! | strains and displacements, a million points or fractions | [`strain`] |
//! | f(N), the elongation over the classical one, as a fraction | [`elongation`] |
//! | f(∞) to any number of digits | [`limit`] |
//! | micromodulus of a finite family | [`micromodulus`] |
//! | energy of each point | [`energy`] |
//! | frequencies and motion of a fixed-free bar | [`vibration`] |
//! | the same equilibrium by damped motion | [`relaxation`] |
//!
//! Source: Eriksson, Stenström, J. Peridyn. Nonlocal Model. 2 (2020). Corrected here: (59), which must read `2(m−i)+1`;
//! f(∞) of half-weight bars in Table 1; "(9) is 1 only if α = β = 0".

pub mod elongation;
pub mod energy;
pub mod equations;
pub mod limit;
pub mod micromodulus;
pub mod parameters;
pub mod relaxation;
pub mod stiffness_matrix;
pub mod strain;
pub mod vibration;

/// Volume of an end point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// AΔ, as of every point.
    Full,
    /// AΔ/2.
    Half,
}

/// A bar; N ≥ 2m+1, so that some point sees a whole family.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bar {
    m: usize,
    points: usize,
    ends: Ends,
    homogenized: bool,
}

/// Why there is no such bar, or no such answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BarError {
    #[error("a horizon of m = 0 spacings has no bonds: m is at least 1")]
    NoBonds,
    #[error(
        "{points} points are too few for a horizon of m = {m} spacings: at least 2m + 1 = {least}"
    )]
    TooFew {
        m: usize,
        points: usize,
        least: usize,
    },
    #[error(
        "a bar with half-weight ends breaks action and reaction at its ends and has no energy to vibrate with: take full ends"
    )]
    NotSymmetric,
    #[error(
        "the relaxation is not at rest after {steps} steps: the largest residual is {} of the load", peridyne::quantity::rounded(*.residual, 2)
    )]
    NotAtRest { steps: usize, residual: f64 },
}

impl Bar {
    /// m ≥ 1 spacings in the horizon, N ≥ 2m+1 points.
    ///
    /// # Errors
    /// m = 0; too few points.
    pub fn new(m: usize, points: usize, ends: Ends, homogenized: bool) -> Result<Bar, BarError> {
        if m == 0 {
            return Err(BarError::NoBonds);
        }
        let least = m.saturating_mul(2).saturating_add(1);
        if points < least {
            return Err(BarError::TooFew { m, points, least });
        }
        Ok(Bar {
            m,
            points,
            ends,
            homogenized,
        })
    }

    /// Spacings in the horizon.
    pub fn m(&self) -> usize {
        self.m
    }

    pub fn points(&self) -> usize {
        self.points
    }

    pub fn ends(&self) -> Ends {
        self.ends
    }

    pub fn homogenized(&self) -> bool {
        self.homogenized
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_bar_is_told() {
        let told = |m, n| Bar::new(m, n, Ends::Full, false).unwrap_err().to_string();
        assert!(told(0, 9).contains("m is at least 1"));
        assert!(told(3, 6).contains("at least 2m + 1 = 7"));
        assert!(told(usize::MAX, 6).contains("too few"));
        assert!(Bar::new(3, 7, Ends::Half, true).is_ok());
    }
}
