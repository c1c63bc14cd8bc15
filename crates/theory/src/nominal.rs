//! Nominal moduli: those that a law is made for, as the solid would have them.

use peridyne::law::micromodulus::Moments;
use peridyne::spec::{LawSpec, Moduli, Plane, PmbStiffness};

/// Young's modulus and Poisson's ratio of the three-dimensional solid that the law stands for in a body of
/// `dimension` dimensions; `None` where it stands for none. In 1-D Poisson's ratio is NaN.
///
/// A micromodulus is read with the sums of a full ball, `moments`.
pub fn nominal_moduli(
    law: &LawSpec,
    dimension: usize,
    plane: Plane,
    moments: Moments,
) -> Option<Moduli> {
    let d = dimension as f64;
    let bond_based = |young: f64| Moduli {
        young,
        poisson: match (dimension, plane) {
            (1, _) => f64::NAN,
            (2, Plane::Stress) => 1.0 / 3.0,
            _ => 0.25,
        },
    };
    let bar = |young: f64| Moduli {
        young,
        poisson: f64::NAN,
    };
    // springs are the bond-based solid at small strains
    let springs;
    let law = match law {
        // no isotropic solid
        LawSpec::Named(law) if !law.isotropic => return None,
        LawSpec::Springs(s) => {
            springs = LawSpec::Pmb(*s);
            &springs
        }
        other => other.linear(),
    };
    match (law, dimension, plane) {
        (LawSpec::Pmb(PmbStiffness::Young(e)), ..) => Some(bond_based(*e)),
        (LawSpec::Pmb(PmbStiffness::Bulk(k)), 1, _) => Some(bar(*k)),
        (LawSpec::Pmb(PmbStiffness::Bulk(k)), 2, Plane::Stress) => Some(bond_based(*k)),
        (LawSpec::Pmb(PmbStiffness::Bulk(k)), ..) => Some(bond_based(1.5 * k)),
        (LawSpec::Pmb(PmbStiffness::Micromodulus(c)), ..) => {
            let shear = c * moments.first / (2.0 * d * (d + 2.0));
            Some(bond_based(match (dimension, plane) {
                (1, _) => 3.0 * shear,
                (2, Plane::Stress) => shear * 8.0 / 3.0,
                _ => 2.5 * shear,
            }))
        }
        (LawSpec::Lps(m), 1, _) => Some(bar(m.young)),
        (LawSpec::Lps(m), ..) => Some(*m),
        (LawSpec::Lps3d { bulk, shear }, 3, _) => Some(Moduli::from_bulk_shear(*bulk, *shear)),
        (LawSpec::EamLike { pair, volume }, 3, _) => {
            let shear = pair / 30.0;
            let bulk = volume / 3.0 + 5.0 / 3.0 * shear;
            Some(Moduli::from_bulk_shear(bulk, shear))
        }
        (
            LawSpec::Lps3d { .. }
            | LawSpec::EamLike { .. }
            | LawSpec::Springs(_)
            | LawSpec::Atoms(_)
            | LawSpec::Micromoduli(_)
            | LawSpec::Named(_),
            ..,
        ) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::law::micromodulus::micromodulus;
    use peridyne::spec::Influence;

    #[test]
    fn a_micromodulus_asks_for_the_modulus_it_was_made_of() {
        for d in 1..=3 {
            for plane in [Plane::Stress, Plane::Strain] {
                let moments = Moments::continuum(d, 0.3, 1.0, Influence::Constant);
                for stiffness in [PmbStiffness::Young(7.0), PmbStiffness::Bulk(5.0)] {
                    let c = micromodulus(d, plane, stiffness, moments);
                    let direct =
                        nominal_moduli(&LawSpec::Pmb(stiffness), d, plane, moments).unwrap();
                    let law = LawSpec::Pmb(PmbStiffness::Micromodulus(c));
                    let by_c = nominal_moduli(&law, d, plane, moments).unwrap();
                    assert!((direct.young / by_c.young - 1.0).abs() < 1e-13);
                }
            }
        }
    }
}
