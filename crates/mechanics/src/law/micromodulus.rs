//! Stiffness constants of the bond-based solid from moduli.
//!
//! All follow from three sums over a full family in the bulk, continuum integrals or discrete:
//! `M1 = Σ ω ν V r0`, `M2 = Σ ω ν V r0²`, `m = Σ ω ν V r0²` with the law's own weights.

use crate::law::influence::influence;
use crate::law::quadrature::integral;
use crate::spec::{Formula, Influence, Plane, PmbStiffness};
use std::f64::consts::{FRAC_PI_2, PI};

/// Sums over a full bulk family: `first = Σ ω ν V r0`, `second = Σ ω ν V r0²`, `bare = Σ ν V r0`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    pub first: f64,
    pub second: f64,
    pub bare: f64,
}

impl Moments {
    /// Integrals over the ball (3-D), disk (2-D, times thickness) or segment (1-D, times area) of radius δ, by
    /// composite Gauss quadrature of the influence function (exact to round-off for the polynomial ones), of an expression by adaptive
    /// quadrature, over all directions if it knows them; infinite where an integral is.
    pub fn continuum(dimension: usize, horizon: f64, section: f64, kind: Influence) -> Moments {
        let integral = |p: i32, kind: Influence| radial(dimension, horizon, section, p, kind);
        Moments {
            first: integral(1, kind),
            second: integral(2, kind),
            bare: integral(1, Influence::Constant),
        }
    }
}

/// The integral of `ω r0` over the ball of a horizon over that of another, `of` (lengths).
pub fn first_moments(dimension: usize, of: f64, horizon: f64, kind: Influence) -> f64 {
    let power = match kind {
        Influence::Constant | Influence::Linear | Influence::Gaussian | Influence::CubicSpline => {
            dimension + 1
        }
        Influence::Inverse => dimension,
        Influence::Formula(_) => {
            let first = |horizon| radial(dimension, horizon, 1.0, 1, kind);
            return first(of) / first(horizon);
        }
    };
    (of / horizon).powi(power as i32)
}

/// `Σ ω ν V r0³ / Σ ω ν V r0²` of the full family (length).
pub fn mean_length(dimension: usize, horizon: f64, kind: Influence) -> f64 {
    radial(dimension, horizon, 1.0, 3, kind) / radial(dimension, horizon, 1.0, 2, kind)
}

/// `∫ ω r^p dV` over the ball, the disk or the segment of radius δ.
fn radial(dimension: usize, horizon: f64, section: f64, p: i32, kind: Influence) -> f64 {
    let shell = |r: f64| match dimension {
        1 => 2.0 * section,
        2 => 2.0 * PI * r * section,
        _ => 4.0 * PI * r * r,
    };
    if let Influence::Formula(formula) = kind {
        let (tolerance, mean) = match formula.is_directed() {
            true => (1e-13, dimension),
            false => (1e-14, 0),
        };
        let of = |r: f64| mean_over_directions(formula, mean, r, horizon) * r.powi(p) * shell(r);
        return integral(&of, 0.0, horizon, tolerance);
    }
    // five-point Gauss on 64 pieces; the spline's knot at δ/2 is a border
    const X: [f64; 5] = [
        -0.906179845938664,
        -0.5384693101056831,
        0.0,
        0.5384693101056831,
        0.906179845938664,
    ];
    const W: [f64; 5] = [
        0.2369268850561891,
        0.4786286704993665,
        0.5688888888888889,
        0.4786286704993665,
        0.2369268850561891,
    ];
    let pieces = 64;
    let h = horizon / pieces as f64;
    (0..pieces)
        .flat_map(|k| {
            X.iter()
                .zip(W)
                .map(move |(x, w)| (h * (k as f64 + 0.5 + 0.5 * x), 0.5 * h * w))
        })
        .map(|(r, w)| w * influence(kind, &[r], r, horizon) * r.powi(p) * shell(r))
        .sum()
}

/// The mean of ω over all directions of so many dimensions; of none: it knows none.
fn mean_over_directions(formula: Formula, dimensions: usize, r: f64, horizon: f64) -> f64 {
    let at = |xi: [f64; 3]| formula.at(xi.map(|x| x * r), r, horizon);
    let round = |across: f64, along: f64| {
        let of = |phi: f64| {
            let (sin, cos) = libm::sincos(phi);
            // both halves and both sides at once: an integral over a quarter
            let all = [[cos, sin], [-cos, sin], [cos, -sin], [-cos, -sin]];
            let each = all.map(|[x, y]| at([across * x, across * y, along]));
            each.iter().sum::<f64>()
        };
        integral(&of, 0.0, FRAC_PI_2, 1e-14) / (2.0 * PI)
    };
    match dimensions {
        0 => at([0.0; 3]),
        1 => 0.5 * (at([1.0, 0.0, 0.0]) + at([-1.0, 0.0, 0.0])),
        2 => round(1.0, 0.0),
        _ => {
            let ring = |z: f64| {
                let across = (1.0 - z * z).sqrt();
                round(across, z) + round(across, -z)
            };
            0.5 * integral(&ring, 0.0, 1.0, 3e-14)
        }
    }
}

/// Micromodulus c of the bond-based solid in `dimension` dimensions.
///
/// With `W = ¼ c M1 (tr²ε + 2 ε:ε)/(D(D+2))` the shear modulus is `G = c M1 / (2 D (D+2))` and the Lamé constant of
/// the D dimensions equals it. Bulk modulus of the solid: K = 5G/3 (3-D and plane strain, where E = 5G/2); plane
/// stress (ν = ⅓): E = 8G/3 and K = E/(3(1−2ν)) = E; 1-D: E = 3G, K is read as E.
/// Full-ball values: 18K/(πδ⁴); 9E/(πtδ³), 48E/(5πtδ³); 2E/(Aδ²).
pub fn micromodulus(
    dimension: usize,
    plane: Plane,
    stiffness: PmbStiffness,
    moments: Moments,
) -> f64 {
    let shear = match (stiffness, dimension, plane) {
        (PmbStiffness::Micromodulus(c), ..) => return c,
        (PmbStiffness::Bulk(e) | PmbStiffness::Young(e), 1, _) => e / 3.0,
        (PmbStiffness::Bulk(k), 2, Plane::Stress) => k * 3.0 / 8.0,
        (PmbStiffness::Bulk(k), ..) => 0.6 * k,
        (PmbStiffness::Young(e), 2, Plane::Stress) => e * 3.0 / 8.0,
        (PmbStiffness::Young(e), ..) => 0.4 * e,
    };
    let d = dimension as f64;
    2.0 * d * (d + 2.0) * shear / moments.first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::fracture_energy::bond_based;

    fn critical_stretch(dimension: usize, energy: f64, c: f64, moments: Moments) -> f64 {
        (energy / bond_based(dimension, c, moments)).sqrt()
    }

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-13 * b.abs(), "{a} is not {b}");
    }

    #[test]
    fn full_ball_constants_are_the_published_ones() {
        let (d, t) = (0.003, 0.002);
        let m =
            |dim| Moments::continuum(dim, d, if dim == 3 { 1.0 } else { t }, Influence::Constant);
        let k = 14.9e9;
        let c = micromodulus(3, Plane::Stress, PmbStiffness::Bulk(k), m(3));
        close(c, 18.0 * k / (PI * d.powi(4)));
        close(
            micromodulus(2, Plane::Stress, PmbStiffness::Young(k), m(2)),
            9.0 * k / (PI * t * d.powi(3)),
        );
        close(
            micromodulus(2, Plane::Strain, PmbStiffness::Young(k), m(2)),
            48.0 * k / (5.0 * PI * t * d.powi(3)),
        );
        close(
            micromodulus(1, Plane::Stress, PmbStiffness::Young(k), m(1)),
            2.0 * k / (t * d * d),
        );
        close(
            critical_stretch(3, 10.0, c, m(3)),
            (5.0 * 10.0 / (9.0 * k * d)).sqrt(),
        );
        let c = micromodulus(2, Plane::Stress, PmbStiffness::Young(k), m(2));
        close(
            critical_stretch(2, 10.0, c, m(2)),
            (4.0 * PI * 10.0 / (9.0 * k * d)).sqrt(),
        );
        let c = micromodulus(2, Plane::Strain, PmbStiffness::Young(k), m(2));
        close(
            critical_stretch(2, 10.0, c, m(2)),
            (5.0 * PI * 10.0 / (12.0 * k * d)).sqrt(),
        );
    }

    /// Words as expressions, `∫ r^(p−½) dV` in closed form, and `1 + (n·e)² + n·e`, whose mean is `1 + 1/D`.
    #[test]
    fn integrals_of_expressions_are_those_of_the_words_and_of_closed_forms() {
        let d = 0.0031;
        let formula = |text: &str| Influence::Formula(Formula::parse(text, &[]).unwrap());
        for dimension in 1..=3 {
            let of = |kind| Moments::continuum(dimension, d, 0.7, kind);
            let all = |m: Moments| [m.first, m.second, m.bare];
            for (word, text) in [
                (Influence::Inverse, "1/r"),
                (Influence::Linear, "1 - r/delta"),
                (Influence::Gaussian, "exp(-4*(r/delta)^2)"),
                (
                    Influence::CubicSpline,
                    "r < delta/2 ? 1 - 6*(r/delta)^2 + 6*(r/delta)^3 : 2*(1 - r/delta)^3",
                ),
            ] {
                let both = all(of(formula(text))).into_iter().zip(all(of(word)));
                both.for_each(|(found, exact)| close(found, exact));
            }
            let n = dimension as f64;
            let shell = [2.0 * 0.7, 2.0 * PI * 0.7, 4.0 * PI][dimension - 1];
            let root = of(formula("r^-0.5"));
            close(root.first, shell * d.powf(n + 0.5) / (n + 0.5));
            let directed = of(formula("1 + (xi_x/r)^2 + xi_x/r"));
            close(
                directed.second,
                (1.0 + 1.0 / n) * of(Influence::Constant).second,
            );
        }
        let line = Moments::continuum(1, d, 1.0, formula("r^-2"));
        assert_eq!(line.first, f64::INFINITY);
        close(line.second, 2.0 * d);
    }
}
