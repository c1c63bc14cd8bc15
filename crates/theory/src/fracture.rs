//! Critical stretch and fracture energy of one material, each from the other.

use peridyne::law::fracture_energy;
use peridyne::law::micromodulus::{Moments, micromodulus};
use peridyne::law::solid::eam_like::Solid;
use peridyne::spec::{Influence, LawSpec, Plane, PmbStiffness};

/// What of a body the conversion depends on.
#[derive(Debug, Clone, Copy)]
pub struct Body {
    pub dimension: usize,
    pub plane: Plane,
    /// Length.
    pub horizon: f64,
    pub influence: Influence,
    /// Sums over a full family.
    pub moments: Moments,
}

/// `G0 / s0²` (energy / area) of a material; `None` where no formula is known.
/// See [`fracture_energy`].
pub fn energy_per_stretch_squared(law: &LawSpec, c: Option<f64>, body: Body) -> Option<f64> {
    let Body {
        dimension: d,
        plane,
        horizon,
        influence,
        moments,
    } = body;
    match law {
        LawSpec::Pmb(_) => Some(fracture_energy::bond_based(d, c?, moments)),
        LawSpec::Lps(m) if d == 1 => {
            let c = micromodulus(d, plane, PmbStiffness::Young(m.young), moments);
            Some(fracture_energy::bond_based(d, c, moments))
        }
        LawSpec::Lps(m) => {
            let of_unit_stretch = fracture_energy::state_based(d, plane, m, horizon, influence);
            Some(of_unit_stretch)
        }
        LawSpec::Lps3d { .. }
        | LawSpec::EamLike { .. }
        | LawSpec::Springs(_)
        | LawSpec::Atoms(_)
        | LawSpec::Micromoduli(_)
        | LawSpec::Named(_) => {
            let solid = Solid::of_law(d, plane, law)?;
            Some(match d {
                1 => {
                    let young = PmbStiffness::Young(solid.along_a_line());
                    fracture_energy::bond_based(d, micromodulus(d, plane, young, moments), moments)
                }
                _ => fracture_energy::of_solid(d, solid, horizon, influence),
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::spec::Moduli;
    use std::f64::consts::PI;

    fn body(dimension: usize) -> Body {
        Body {
            dimension,
            plane: Plane::Stress,
            horizon: 0.003,
            influence: Influence::Inverse,
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
