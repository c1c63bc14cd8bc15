//! The thickness of a sheet whose faces are free: the strain across at which nothing is borne there, found for any [`Classical`] law from
//! its own stress. So in plane stress ψ(F) is the least of ψ over the thickness, and P its slope in the plane.

use super::{Asked, Classical, Stressed, Unseen};
use crate::law::material::tensor;
use crate::law::number::Number;

/// Steps of the search: most laws take 4 to 6, kinks of yield some more.
const STEPS: usize = 40;
/// Strain over which the first slope is taken, to both sides.
const APART: f64 = 1e-6;
/// Steps below this part of the strain say nothing of the slope.
const SHORT: f64 = 1e-8;
/// A step of the search below this part of it is the last but one.
const CLOSE: f64 = 1e-14;
/// Beyond any strain across.
const THICK: f64 = 1e6;

/// The stress of the law at a strain across.
#[inline(always)]
fn at<N: Number, L: Classical<D>, const D: usize>(
    asked: &Asked<'_, L, N, D>,
    across: N,
) -> Stressed<N, L::Past<N>, D> {
    N::out_of_line(Asked {
        unseen: Unseen {
            across,
            ..asked.unseen
        },
        ..*asked
    })
}

/// The stress of a law at the thickness that it gives itself, by the secant method between bounds.
#[inline(always)]
pub(super) fn relaxed<N: Number, L: Classical<D>, const D: usize>(
    asked: &Asked<'_, L, N, D>,
) -> Stressed<N, L::Past<N>, D> {
    let (zero, one, two) = (N::constant(0.0), N::constant(1.0), N::constant(2.0));
    let half = N::constant(0.5);
    let strain = tensor::contraction(asked.h, asked.h);
    let mut x = asked.law.thickness(asked.past, tensor::dilation(asked.h));
    let mut f = at(asked, x).across;
    let out_of_line = N::constant(APART);
    let ends = at(asked, x + out_of_line).across - at(asked, x - out_of_line).across;
    let mut slope = ends.div(two * out_of_line);
    let (mut low, mut high) = (N::constant(-1.0), N::constant(THICK));
    // 2 until it is close, 1 in the last step: what other lanes are still after changes no last digit of this one
    let mut sought = two;
    for _ in 0..STEPS {
        low = f.choose(zero, x, low);
        high = zero.choose(f, x, high);
        let middle = half * (low + high.least(two.fma(x, one)));
        let guess = zero.choose(slope, x - f.div(slope), middle);
        // a correction below the last digit leaves it at a bound
        let inside = guess.choose(low, middle, high.choose(guess, middle, guess));
        // where nothing is borne it stays, with its slopes
        let next = zero.choose(f * f, inside, zero.choose(slope, guess, x));
        let next = zero.choose(sought, next, x);
        let step = next - x;
        let square = step * step;
        let size = next.fma(next, strain);
        let short = N::constant(SHORT * SHORT) * size;
        let then = at(asked, next).across;
        let secant = (then - f).div(short.choose(square, step, one));
        let steep = short.choose(square, secant, slope);
        slope = zero.choose(steep, steep, slope);
        (x, f) = (next, then);
        let far = (N::constant(CLOSE * CLOSE) * size - square).choose(zero, two, one);
        sought = sought.below(1.5, zero, far);
        if !(zero - sought).any_below(0.0) {
            break;
        }
    }
    at(asked, x)
}

#[cfg(test)]
mod tests {
    use super::super::correspondence::Correspondence;
    use super::super::hyperelastic::Hyperelastic;
    use super::super::hypoelastic::Hypoelastic;
    use super::super::hypoelastic_plastic::HypoelasticPlastic;
    use super::super::tried::made;
    use super::super::{answered, energy};
    use super::*;
    use crate::expression::Expression;
    use crate::law::descriptor::Registered;
    use crate::law::material::Numbers;
    use crate::law::material::tensor::Matrix;
    use crate::law::number::Dual;
    use crate::spec::{Parameter, Parameters, Plane};

    fn unseen<N: Number>(across: f64) -> Unseen<N> {
        Unseen {
            stiffness: N::constant(0.0),
            square: N::constant(0.0),
            reach: N::constant(1.0),
            across: N::constant(across),
        }
    }

    fn sheet<N: Number, L: Classical<2>>(
        law: &L,
        past: &L::Past<N>,
        h: &Matrix<N, 2>,
    ) -> Stressed<N, L::Past<N>, 2> {
        let of = Classical::<2>::constants(law, 0, 1.0);
        let mut constants = <L::Constants<N> as Numbers<N>>::constant(0.0);
        for n in 0..<L::Constants<N> as Numbers<N>>::COUNT {
            constants.set(n, N::constant(of.get(n)));
        }
        answered(Asked {
            law,
            constants: &constants,
            past,
            h,
            unseen: unseen(0.0),
        })
    }

    /// A path that turns, shears, stretches up to a third, and comes back some way.
    fn path(size: f64, t: f64) -> Matrix<f64, 2> {
        let s = size * (2.0 * t - t * t * t);
        // a turn as large as the strain: of a greater one F − 1 has but the digits that are left of it
        let (sin, cos) = (2.3 * size * t).sin_cos();
        let u = [[1.0 + s, 0.4 * s], [0.4 * s, 1.0 - 0.2 * s]];
        let f = [
            [cos * u[0][0] - sin * u[1][0], cos * u[0][1] - sin * u[1][1]],
            [sin * u[0][0] + cos * u[1][0], sin * u[0][1] + cos * u[1][1]],
        ];
        [[f[0][0] - 1.0, f[0][1]], [f[1][0], f[1][1] - 1.0]]
    }

    /// The solid of three dimensions whose stretch across is found by halving, beside the sheet, along a path with memory.
    fn beside<L: Registered + Classical<2> + Classical<3>>(
        name: &str,
        parameters: &Parameters,
        size: f64,
    ) {
        const PARTS: u32 = 12;
        let solid: L = made(3, Plane::Strain, parameters).unwrap();
        let plane: L = made(2, Plane::Stress, parameters).unwrap();
        let constants = Classical::<3>::constants(&solid, 0, 1.0);
        let mut thick = <<L as Classical<3>>::Past<f64> as Numbers<f64>>::constant(0.0);
        let mut thin = <<L as Classical<2>>::Past<f64> as Numbers<f64>>::constant(0.0);
        let mut most = 0.0f64;
        for n in 1..=PARTS {
            let h = path(size, f64::from(n) / f64::from(PARTS));
            let with = |z: f64| {
                [
                    [h[0][0], h[0][1], 0.0],
                    [h[1][0], h[1][1], 0.0],
                    [0.0, 0.0, z],
                ]
            };
            let [mut low, mut high] = [-0.9, 2.0];
            for _ in 0..100 {
                let z = 0.5 * (low + high);
                let p = Classical::<3>::stress(&solid, &constants, &thick, &with(z), &unseen(0.0));
                if p.stress[2][2] > 0.0 {
                    high = z;
                } else {
                    low = z;
                }
            }
            let of_solid =
                Classical::<3>::stress(&solid, &constants, &thick, &with(high), &unseen(0.0));
            let of_sheet = sheet(&plane, &thin, &h);
            most = (0..2).fold(most, |m, a| m.max(of_solid.stress[a][a].abs()));
            for r in 0..2 {
                for c in 0..2 {
                    let off = (of_sheet.stress[r][c] - of_solid.stress[r][c]).abs();
                    assert!(off < 1e-10 * most, "{name} {n} {r}{c}: {off:e} of {most}");
                }
            }
            let off = (of_sheet.energy - of_solid.energy).abs();
            assert!(off < 1e-10 * most, "{name} {n}: energy {off:e} of {most}");
            assert!(
                of_sheet.across.abs() < 1e-12 * most,
                "{name} {n}: {:e}",
                of_sheet.across
            );
            slopes(name, &plane, &thin, &h, 1e-4 * size);
            (thick, thin) = (of_solid.past, of_sheet.past);
        }
    }

    /// Dual numbers know how the thickness follows.
    fn slopes<L: Classical<2>>(
        name: &str,
        law: &L,
        past: &<L as Classical<2>>::Past<f64>,
        h: &Matrix<f64, 2>,
        small: f64,
    ) {
        type Real = Dual<f64>;
        let mut lifted = <L::Past<Real> as Numbers<Real>>::constant(0.0);
        for n in 0..<L::Past<Real> as Numbers<Real>>::COUNT {
            lifted.set(n, <Real as Number>::constant(past.get(n)));
        }
        for (r, c) in [(0, 0), (0, 1), (1, 1)] {
            let mut up = h.map(|row| row.map(<Real as Number>::constant));
            up[r][c].slope = 1.0;
            let p = sheet(law, &lifted, &up).stress;
            let ends = [small, -small].map(|by| {
                let mut h = *h;
                h[r][c] += by;
                sheet(law, past, &h).stress
            });
            for a in 0..2 {
                for b in 0..2 {
                    let by_hand = (ends[0][a][b] - ends[1][a][b]) / (2.0 * small);
                    let off = (p[a][b].slope - by_hand).abs();
                    // central differences, of a modulus of about 1
                    assert!(off < 1e-5, "{name} {r}{c} {a}{b}: {off:e}");
                }
            }
        }
    }

    fn written(text: &str) -> Parameters {
        let formula = Expression::of(energy::INVARIANTS, text, &[]).unwrap();
        Parameters::default().with("energy", Parameter::Formula(formula))
    }

    fn checked<L: Registered>(mut parameters: Parameters) -> Parameters {
        let wrong = L::descriptor().check(&mut parameters).err();
        assert!(wrong.is_none(), "{wrong:?}");
        parameters
    }

    #[test]
    fn a_sheet_is_a_solid_whose_faces_are_free() {
        let elastic = || Parameters::numbers(&[("young", 1.0), ("poisson", 0.3)]);
        let word = |p: Parameters, key: &str, word: &str| p.with(key, Parameter::Word(word.into()));
        for size in [1e-8, 0.3] {
            beside::<Hyperelastic>(
                "neo-Hooke",
                &written("0.35*(I1 - 3 - 2*ln(J)) + 0.6*ln(J)^2"),
                size,
            );
            beside::<Hyperelastic>(
                "nearly incompressible",
                &written("0.2*(J^(-2/3)*I1 - 3) + 0.1*(J^(-4/3)*I2 - 3) + 40*(J - 1)^2"),
                size,
            );
            let rubber = word(elastic(), "stress", "mooney_rivlin")
                .with("second_invariant", Parameter::Number(0.1));
            beside::<Correspondence>("Mooney-Rivlin", &checked::<Correspondence>(rubber), size);
            beside::<Hypoelastic>("hypoelastic", &checked::<Hypoelastic>(elastic()), size);
            let flows = elastic()
                .with("yield_stress", Parameter::Number(0.3 * size))
                .with("hardening", Parameter::Number(0.1));
            beside::<HypoelasticPlastic>(
                "von Mises",
                &checked::<HypoelasticPlastic>(flows.clone()),
                size,
            );
            let soil = flows
                .with("friction", Parameter::Number(0.5))
                .with("dilatancy", Parameter::Number(0.2));
            beside::<HypoelasticPlastic>(
                "Drucker-Prager",
                &checked::<HypoelasticPlastic>(soil),
                size,
            );
        }
    }
}
