//! What a body of fewer than three dimensions does across itself: the part of the solid's deviator that its points do not span.
//!
//! A solid whose deviator relaxes or flows is three-dimensional however few dimensions its points span. With the dilatation θ in the D
//! dimensions, the c = 3 − D others each strained by s, and the D-dimensional deviator left to the bonds, it has the deviator d in each
//! direction across and −cd/D in each along, `d = (Ds − θ)/3`. Parts λ_b of the shear modulus whose deviators have gone by z_b store
//!
//! `W = ½K(θ + cs)² + (3cG/D) ((1 − Σλ) d² + Σ λ_b (d − z_b)²)`.
//!
//! In plane strain s is given: minus the strain by temperature or swelling, else 0. Plane stress (D = 2) and a bar with a free section (D = 1)
//! have the s at which W is least, that is no stress across. Either way, with `Z = Σ λ_b z_b`,
//! `d = (D/3)s − fθ + gZ`; f = ⅓, g = 0 where s is given, else s does not show, `f = 3K/(3cK + 2DG)` and `g = 1 − cf`; and
//! `W = ½κθ² + (6cGf/D) Zθ + (3cG/D)(Σ λ_b z_b² − gZ²) + λsθ + ½(λ + 2G)s² − 2GsZ`, with the κ of the elastic body. In three dimensions there is
//! nothing across, and all of it is 0.

use crate::law::number::Number;
use crate::spec::{Moduli, Plane};

/// f, g, G and Lamé's λ.
pub type Section<N> = [N; 4];

const FALLS: usize = 0;
const GIVES: usize = 1;
const SHEAR: usize = 2;
const LAME: usize = 3;

/// Of a material in `dimension` dimensions.
pub fn of(dimension: usize, plane: Plane, moduli: &Moduli) -> Section<f64> {
    let (d, c) = (dimension as f64, 3.0 - dimension as f64);
    let (bulk, shear) = (moduli.bulk(), moduli.shear());
    let given = dimension == 3 || (dimension == 2 && plane == Plane::Strain);
    let falls = match given {
        true => 1.0 / 3.0,
        false => 3.0 * bulk / (3.0 * c * bulk + 2.0 * d * shear),
    };
    let gives = if given { 0.0 } else { 1.0 - c * falls };
    [falls, gives, shear, moduli.lame()]
}

/// `c/D`, the part of what is across that is along.
#[inline(always)]
fn part<N: Number, const D: usize>(factor: f64) -> N {
    N::constant(factor * (3 - D) as f64 / D as f64)
}

/// g.
#[inline(always)]
pub fn gives<N: Number>(c: &Section<N>) -> N {
    c[GIVES]
}

/// G.
#[inline(always)]
pub fn shear<N: Number>(c: &Section<N>) -> N {
    c[SHEAR]
}

/// d without the part `gZ` of what has gone.
#[inline(always)]
pub fn deviator<N: Number, const D: usize>(c: &Section<N>, dilatation: N, strain: N) -> N {
    N::constant(D as f64 / 3.0) * strain - c[FALLS] * dilatation
}

/// `∂W/∂θ` beside that of the elastic body, `(6cGf/D)Z + cλs`.
#[inline(always)]
pub fn pressure<N: Number, const D: usize>(c: &Section<N>, gone: N, strain: N) -> N {
    let held = N::constant((3 - D) as f64) * c[LAME] * strain;
    (part::<N, D>(6.0) * c[SHEAR] * c[FALLS]).fma(gone, held)
}

/// W beside that of the elastic body; `squares` is `Σ λ_b z_b²`.
#[inline(always)]
pub fn energy<N: Number, const D: usize>(
    c: &Section<N>,
    dilatation: N,
    (gone, squares): (N, N),
    strain: N,
) -> N {
    let two = N::constant(2.0);
    let own = part::<N, D>(3.0) * c[SHEAR] * (squares - c[GIVES] * gone * gone);
    let across = N::constant(0.5) * two.fma(c[SHEAR], c[LAME]) * strain - two * c[SHEAR] * gone;
    let held = N::constant((3 - D) as f64) * strain * c[LAME].fma(dilatation, across);
    (part::<N, D>(6.0) * c[SHEAR] * c[FALLS] * gone).fma(dilatation, own) + held
}

/// Stress across where s is given, `∂W/∂s = λθ + (λ + 2G)s − 2GZ`.
#[inline(always)]
pub fn stress<N: Number>(c: &Section<N>, dilatation: N, gone: N, strain: N) -> N {
    let two = N::constant(2.0);
    let elastic = c[LAME].fma(dilatation + strain, two * c[SHEAR] * strain);
    elastic - two * c[SHEAR] * gone
}

/// What is dissipated where a part of d that remembers goes from one z to another: `(3cG/D) (x + x′)(z′ − z)` with `x = d − z` at both ends.
#[inline(always)]
pub fn dissipated<N: Number, const D: usize>(c: &Section<N>, both: N, moved: N) -> N {
    part::<N, D>(3.0) * c[SHEAR] * both * moved
}

/// Von Mises' stress of `x = d − z` alone, `3G √(2c/D) |x|`, with its sign.
#[inline(always)]
pub fn mises<N: Number, const D: usize>(c: &Section<N>, x: N) -> N {
    N::constant(3.0 * (2.0 * (3 - D) as f64 / D as f64).sqrt()) * c[SHEAR] * x
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODULI: Moduli = Moduli {
        young: 2.6,
        poisson: 0.3,
    };

    /// W of the module's first equation, at given s.
    fn stored<const D: usize>(theta: f64, s: f64, parts: &[(f64, f64)]) -> f64 {
        let (c, n) = (3.0 - D as f64, D as f64);
        let (k, g) = (MODULI.bulk(), MODULI.shear());
        let d = (n * s - theta) / 3.0;
        let lasting: f64 = 1.0 - parts.iter().map(|p| p.0).sum::<f64>();
        let relaxing: f64 = parts.iter().map(|(l, z)| l * (d - z).powi(2)).sum();
        let volume = theta + c * s;
        0.5 * k * volume * volume + 3.0 * c * g / n * (lasting * d * d + relaxing)
    }

    /// The same by what laws ask for; the elastic κ is that of `W = ½ λ tr² + G ε:ε` for equal strains.
    fn found<const D: usize>(plane: Plane, theta: f64, s: f64, parts: &[(f64, f64)]) -> [f64; 4] {
        let of = of(D, plane, &MODULI);
        let kappa = MODULI.lame_of(D, plane) + 2.0 * MODULI.shear() / D as f64;
        let gone: f64 = parts.iter().map(|(l, z)| l * z).sum();
        let squares: f64 = parts.iter().map(|(l, z)| l * z * z).sum();
        [
            0.5 * kappa * theta * theta + energy::<f64, D>(&of, theta, (gone, squares), s),
            kappa * theta + pressure::<f64, D>(&of, gone, s),
            deviator::<f64, D>(&of, theta, s) + gives(&of) * gone,
            stress(&of, theta, gone, s),
        ]
    }

    const PARTS: [(f64, f64); 2] = [(0.5, -0.02), (0.2, 0.007)];

    #[test]
    fn a_given_section_stores_what_the_solid_does() {
        let (theta, s, step) = (0.031, -0.0123, 1e-5);
        let [w, p, d, across] = found::<2>(Plane::Strain, theta, s, &PARTS);
        let slope = |at: &dyn Fn(f64) -> f64| (at(step) - at(-step)) / (2.0 * step);
        assert!((w - stored::<2>(theta, s, &PARTS)).abs() < 1e-16);
        assert!((p - slope(&|x| stored::<2>(theta + x, s, &PARTS))).abs() < 1e-11);
        assert!((across - slope(&|x| stored::<2>(theta, s + x, &PARTS))).abs() < 1e-11);
        assert!((d - (2.0 * s - theta) / 3.0).abs() < 1e-17);
    }

    /// The section gives way until nothing is pulled across, found here by the parabola through three of its strains.
    #[test]
    fn a_free_section_bears_nothing() {
        fn check<const D: usize>() {
            let theta = 0.031;
            let least = |theta: f64| {
                let w = |s: f64| stored::<D>(theta, s, &PARTS);
                let (slope, curve) = (0.5 * (w(1.0) - w(-1.0)), w(1.0) - 2.0 * w(0.0) + w(-1.0));
                let s = -slope / curve;
                (s, w(s))
            };
            let (s, stored) = least(theta);
            let [w, p, d, _] = found::<D>(Plane::Stress, theta, 0.0, &PARTS);
            let step = 1e-3;
            let slope = (least(theta + step).1 - least(theta - step).1) / (2.0 * step);
            assert!((w - stored).abs() < 1e-14, "{D}: {w} {stored}");
            assert!((p - slope).abs() < 1e-11, "{D}: {p} {slope}");
            assert!((d - (D as f64 * s - theta) / 3.0).abs() < 1e-14, "{D}: {d}");
        }
        check::<1>();
        check::<2>();
    }

    #[test]
    fn space_has_nothing_across() {
        let [w, p, ..] = found::<3>(Plane::Strain, 0.03, 0.0, &PARTS);
        let kappa = MODULI.bulk();
        assert!((w - 0.5 * kappa * 9e-4).abs() < 1e-17 && (p - kappa * 0.03).abs() < 1e-16);
    }
}
