//! Critical stretch and fracture energy of one material, each from the other.

use peridyne::law::micromodulus::Moments;
use peridyne::spec::{LawSpec, Plane};
use std::f64::consts::{FRAC_2_PI, PI};

/// What of a body the conversion depends on.
#[derive(Debug, Clone, Copy)]
pub struct Body {
    pub dimension: usize,
    pub plane: Plane,
    /// Length.
    pub horizon: f64,
    /// Sums over a full family.
    pub moments: Moments,
}

/// `G0 / s0²` (energy / area) of a material; `None` where no formula is known.
///
/// Bond-based, of micromodulus `c`: all bonds across a plane hold `¼ c s0² ⟨|n|⟩ M2` (Silling & Askari 2005 is the
/// full ball). State-based: Madenci & Oterkus 2014 (6.19), (6.20).
pub fn energy_per_stretch_squared(law: &LawSpec, c: Option<f64>, body: Body) -> Option<f64> {
    let Body {
        dimension: d,
        plane,
        horizon,
        moments,
    } = body;
    let mean = match d {
        1 => 1.0,
        2 => FRAC_2_PI,
        _ => 0.5,
    };
    match law {
        LawSpec::Pmb(_) => Some(0.25 * c? * mean * moments.second),
        // E = 3 G of the chain's two sums: c = 2 E / M1
        LawSpec::Lps(m) if d == 1 => {
            Some(0.25 * 2.0 * m.young / moments.first * mean * moments.second)
        }
        LawSpec::Lps(m) => {
            let (k, g, l) = (m.bulk(), m.shear(), m.lame());
            let stiffness = if d == 3 {
                3.0 * g + 0.75f64.powi(4) * (k - 5.0 * g / 3.0)
            } else {
                let in_plane = match plane {
                    Plane::Strain => l + g,
                    Plane::Stress => 2.0 * l * g / (l + 2.0 * g) + g,
                };
                6.0 * g / PI + 16.0 * (in_plane - 2.0 * g) / (9.0 * PI * PI)
            };
            Some(stiffness * horizon)
        }
        LawSpec::LpsAsTyped { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Springs(_)
        | LawSpec::Atoms(_)
        | LawSpec::Micromoduli(_)
        | LawSpec::Named(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::spec::{Influence, Moduli, PmbStiffness};

    fn body(dimension: usize) -> Body {
        Body {
            dimension,
            plane: Plane::Stress,
            horizon: 0.003,
            moments: Moments::continuum(dimension, 0.003, 1.0, Influence::Constant),
        }
    }

    #[test]
    fn the_solid_ball_gives_the_published_stretch() {
        let (k, d) = (14.9e9, 0.003f64);
        let c = 18.0 * k / (PI * d.powi(4));
        let law = LawSpec::Pmb(PmbStiffness::Bulk(k));
        let found = energy_per_stretch_squared(&law, Some(c), body(3)).unwrap();
        assert!((found / (1.8 * k * d) - 1.0).abs() < 1e-13);
    }

    #[test]
    fn both_solids_of_poisson_a_quarter_need_the_same_energy() {
        let (k, d) = (10.0, 0.003f64);
        let m = Moduli::from_bulk_shear(k, 0.6 * k);
        let lps = energy_per_stretch_squared(&LawSpec::Lps(m), None, body(3)).unwrap();
        assert!((lps / (1.8 * k * d) - 1.0).abs() < 1e-13, "{lps}");
    }
}
