//! A bond that softens: linear up to a stretch s0, then falling to nothing at the critical stretch s_c along a curve; it unloads to the
//! origin and remembers its greatest stretch. Pushed together it is linear.
//!
//! The force state of each end is `½ c ω (1 − d) s` along the bond. With `x = (s − s0)/(s_c − s0)`, `(1 − d) s = s0 g(x)` on the way down:
//! linear `g = 1 − x` (bilinear law of cohesive zones, Petersson 1981, on bonds; Zaccariotto et al. 2015); trilinear, by way of a kink at
//! (x_k, g_k) (Yang, Dong, Liu, Yi & Hu 2018); exponential `g = (e^(−ax) − e^(−a))/(1 − e^(−a))` (Cornelissen, Hordijk & Reinhardt 1986 have
//! this term; Tong, Shen, Shao & Chen 2020 on bonds).
//! At s_c both ends together have dissipated `c ω |ξ| s0 (½ s0 + (s_c − s0) ∫g dx)`, with linear g `½ c ω |ξ| s0 s_c`, where a brittle bond
//! with the same critical stretch has `½ c ω |ξ| s_c²`.

use super::{Along, Bond, Columns, End, Material};
use crate::columns::{Declaration, Dimension};
use crate::law::descriptor::{
    self, Bounds, Descriptor, Given, Key, Memory, Need, Registered, Value,
};
use crate::law::number::Number;
use crate::spec::{LawSpec, Parameters, Plane, PmbStiffness};

/// Constants of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SofteningConstants {
    /// Micromodulus c (force / volume²).
    pub micromodulus: f64,
    /// Stretch at which softening begins.
    pub onset: f64,
    /// Stretch at which nothing is left; above the onset.
    pub critical: f64,
    pub curve: Curve,
}

/// How a bond softens, by x from 0 at the onset to 1 at the critical stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Curve {
    Linear,
    /// By way of (x, g), both between 0 and 1.
    Trilinear([f64; 2]),
    /// Steepness a.
    Exponential(f64),
}

impl Curve {
    /// `∫ g dx` from 0 to 1.
    fn area(self) -> f64 {
        match self {
            Curve::Linear => 0.5,
            Curve::Trilinear([x, g]) => 0.5 * (x + g),
            Curve::Exponential(a) => 1.0 / a - 1.0 / libm::expm1(a),
        }
    }
}

/// See the module.
#[derive(Debug, Clone)]
pub struct Softening {
    /// All materials of a body have this kind of curve, or lines.
    pub exponential: bool,
    /// Per material.
    pub materials: Vec<SofteningConstants>,
}

const C: usize = 0; // ½c
const ONSET: usize = 1;
const SPAN: usize = 2; // s_c − s0, and its inverse
const SLOWNESS: usize = 3;
// where lines have their kink, and how steep they are before and after
const KINK: usize = 4;
const FIRST: usize = 5;
const SECOND: usize = 6;
// of exponential curves a, 1/(1 − e^(−a)); else 0
const STEEP: usize = 7;
const SCALE: usize = 8;
const COUNT: usize = 9;

type Ends<'a, N> = End<'a, [N; COUNT], [N; 0], [N; 1]>;

/// Force and greatest stretch so far.
struct Branch<N> {
    /// `(1 − d) s`
    force: N,
    peak: N,
    /// What is dissipated, per `½ c ω |ξ|`.
    lost: N,
}

/// g and its integral from 0, at an x of at least 0; beyond 1 nothing is left.
#[inline(always)]
fn fall<N: Number>(c: &[N; COUNT], x: N, exponential: bool) -> [N; 2] {
    let (zero, one, half) = (N::constant(0.0), N::constant(1.0), N::constant(0.5));
    let x = x.least(one);
    if exponential {
        // g = 1 − (1 − e^(−ax))/(1 − e^(−a))
        let fallen = c[SCALE] * (zero - (zero - c[STEEP] * x).exp_m1());
        // ∫ (1 − e^(−ay)) dy = x − (1 − e^(−ax))/a
        let lost = c[SCALE] * x - fallen.div(c[STEEP]);
        return [one - fallen, x - lost];
    }
    let (before, after) = (x.least(c[KINK]), (x - c[KINK]).most(zero));
    let at_kink = one - c[FIRST] * before;
    let g = at_kink - c[SECOND] * after;
    let area = half.fma((one + at_kink) * before, half * (at_kink + g) * after);
    [g.most(zero), area]
}

#[inline(always)]
fn branch<N: Number>(s: N, c: &[N; COUNT], past: N, exponential: bool) -> Branch<N> {
    let zero = N::constant(0.0);
    let peak = past.most(s);
    let x = ((peak - c[ONSET]) * c[SLOWNESS]).most(zero);
    let [g, area] = fall(c, x, exponential);
    // at most the onset nothing has softened
    let envelope = c[ONSET].choose(peak, c[ONSET] * g, peak);
    let part = c[ONSET].choose(peak, envelope.div(peak), N::constant(1.0));
    let force = zero.choose(s, part * s, s);
    // the area under the curve less the triangle that unloading gives back; beyond the critical stretch nothing is left of either
    let half = N::constant(0.5);
    let under = c[ONSET] * (half * c[ONSET] + c[SPAN] * area);
    let lost = under - half * envelope * peak;
    Branch {
        force,
        peak,
        lost: c[ONSET].choose(peak, lost, zero),
    }
}

impl<const D: usize> Material<D> for Softening {
    type Constants<N: Number> = [N; COUNT];
    type Form<N: Number> = [N; 0];
    type Sum<N: Number> = [N; 0];
    type Point<N: Number> = [N; 0];
    type Past<N: Number> = [N; 0];
    /// Greatest stretch.
    type Memory<N: Number> = [N; 1];
    type State<N: Number> = Along<N>;
    const PASSES: usize = 0;
    const ALIKE: bool = true;
    const OF_BONDS: bool = true;

    fn columns(&self) -> Columns {
        Columns {
            memory: vec![Declaration::of_bonds(
                "greatest_stretch",
                Dimension::NUMBER,
                "Greatest stretch that a bond has seen.",
            )],
            ..Columns::default()
        }
    }

    fn constants(&self, material: usize, _: f64) -> [f64; COUNT] {
        let m = &self.materials[material];
        let span = m.critical - m.onset;
        let ([kink, level], [steep, scale]) = match m.curve {
            Curve::Linear => ([1.0, 0.0], [0.0, 0.0]),
            Curve::Trilinear(kink) => (kink, [0.0, 0.0]),
            Curve::Exponential(a) => ([1.0, 0.0], [a, -1.0 / libm::expm1(-a)]),
        };
        let second = match 1.0 - kink {
            0.0 => 0.0,
            rest => level / rest,
        };
        let mut c = [0.0; COUNT];
        [c[C], c[ONSET]] = [0.5 * m.micromodulus, m.onset];
        [c[SPAN], c[SLOWNESS]] = [span, 1.0 / span];
        [c[KINK], c[FIRST], c[SECOND]] = [kink, (1.0 - level) / kink, second];
        [c[STEEP], c[SCALE]] = [steep, scale];
        c
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> Along<N> {
        let b = branch(bond.stretch, end.constants, end.memory[0], self.exponential);
        Along(end.constants[C] * bond.omega * b.force * bond.inv_current)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> N {
        let (c, past) = (end.constants, end.memory[0]);
        let b = branch(bond.stretch, c, past, self.exponential);
        let before = branch(past, c, past, self.exponential);
        let more = b.lost - before.lost;
        let stored = N::constant(0.5).fma(b.force * bond.stretch, more);
        c[C] * bond.omega * bond.length * stored
    }

    #[inline(always)]
    fn state_update<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>, memory: &mut [N; 1]) -> N {
        let (c, past) = (end.constants, end.memory[0]);
        let b = branch(bond.stretch, c, past, self.exponential);
        let before = branch(past, c, past, self.exponential);
        memory[0] = b.peak;
        let more = b.lost - before.lost;
        c[C] * bond.omega * bond.length * more
    }
}

/// Of the keys.
fn curve(parameters: &Parameters) -> Result<Curve, String> {
    let (kink, steepness) = (parameters.list("kink"), parameters.number("steepness"));
    let curve = parameters.word("curve").unwrap_or("linear");
    match (curve, kink, steepness) {
        ("linear", None, None) => Ok(Curve::Linear),
        ("exponential", None, Some(a)) => Ok(Curve::Exponential(a)),
        ("trilinear", Some(&[x, g]), None) if x + g < 1.0 => Ok(Curve::Trilinear([x, g])),
        ("trilinear", Some(kink), None) => Err(format!(
            "the kink {kink:?} lies on or above the straight line, expected [x, g] with x + g < 1"
        )),
        ("exponential", None, None) => Err(
            "an exponential curve needs `steepness`; 5 is near the softening of concrete".into(),
        ),
        ("trilinear", None, None) => {
            Err("a trilinear curve needs `kink` = [x, g]; [0.2, 0.3] is usual".into())
        }
        (_, Some(_), _) => Err("`kink` is of trilinear curves".into()),
        (_, _, Some(_)) => Err("`steepness` is of exponential curves".into()),
        _ => Err(format!("there is no curve {curve}")),
    }
}

impl Registered for Softening {
    const OWN_CRITICAL_STRETCH: bool = true;
    const SOFTENS_TO_ZERO: bool = true;

    fn descriptor() -> Descriptor {
        Descriptor::new(
            "softening",
            "Bond-based, f = c ω ν V (1 − d) s: linear up to the onset, then falling to nothing at the critical stretch, along a line, two lines or an exponential; Poisson ratio 1/4, plane stress 1/3. With a fracture energy the critical stretch follows from the area under the curve.",
        )
        .source("cohesive laws, Petersson 1981; Cornelissen, Hordijk & Reinhardt 1986; on bonds Zaccariotto, Luongo, Sarego & Galvanetto 2015; Yang, Dong, Liu, Yi & Hu 2018")
        .example("{ young = \"30 GPa\", onset = 0.1 }")
        .memory(Memory::Path)
        .keys(&[
            descriptor::number(
                "young",
                Dimension::PRESSURE,
                Bounds::POSITIVE,
                "Young's modulus E.",
            ),
            descriptor::number(
                "onset",
                Dimension::NUMBER,
                Bounds {
                    most: 1.0 - 1e-9,
                    ..Bounds::PART
                },
                "Stretch at which softening begins, over the critical stretch.",
            ),
            descriptor::word(
                "curve",
                &[
                    ("linear", "a line to the critical stretch"),
                    ("trilinear", "two lines by way of `kink`"),
                    ("exponential", "(e^(−ax) − e^(−a))/(1 − e^(−a)), x from 0 at the onset to 1 at the critical stretch, with `steepness` a"),
                ],
                "How the bond softens.",
            ),
            Key {
                name: "kink",
                value: Value::List(
                    2,
                    Dimension::NUMBER,
                    Bounds {
                        below: true,
                        ..Bounds::PART
                    },
                ),
                need: Need::Optional,
                doc: "[x, g] of trilinear: where the lines meet, from 0 at the onset to 1 at the critical stretch, and the force there over that at the onset; below the straight line, x + g < 1.",
            },
            descriptor::number(
                "steepness",
                Dimension::NUMBER,
                Bounds {
                    most: 50.0,
                    ..Bounds::POSITIVE
                },
                "a of exponential.",
            )
            .need(Need::Optional),
        ])
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        match parameters.number("young") {
            Some(young) => Ok(LawSpec::Pmb(PmbStiffness::Young(young))),
            None => Err("a softening bond needs young".into()),
        }
    }

    /// The area under the curve is `½ c s0 (s0 + 2 (s_c − s0) ∫g dx)`, that of a brittle bond `½ c s_c²`.
    fn brittle_energy(parameters: &Parameters, energy: f64) -> f64 {
        let onset = parameters.number("onset").unwrap_or(1.0);
        let area = curve(parameters).map_or(0.5, Curve::area);
        energy / (onset * (onset + 2.0 * (1.0 - onset) * area))
    }

    fn make(_: usize, _: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let of = |m: &Given| {
            let (Some(c), Some(onset)) = (m.micromodulus, m.parameters.number("onset")) else {
                return Err("a softening bond needs young and onset".into());
            };
            if !m.critical_stretch.is_finite() {
                return Err("a softening bond ends at its critical stretch: give the material a fracture with critical_stretch or energy".into());
            }
            Ok(SofteningConstants {
                micromodulus: c,
                onset: onset * m.critical_stretch,
                critical: m.critical_stretch,
                curve: curve(m.parameters)?,
            })
        };
        let made = descriptor::each(materials, of)?;
        let exponential = |m: &SofteningConstants| matches!(m.curve, Curve::Exponential(_));
        let first = made.first().is_some_and(exponential);
        if let Some(n) = made.iter().position(|m| exponential(m) != first) {
            let message = "all materials of a body soften along lines, or all along exponentials";
            return Err((n, message.into()));
        }
        Ok(Softening {
            exponential: first,
            materials: made,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::spec::Parameter;

    const C_S: [f64; 3] = [2.0, 0.01, 0.06];
    const CURVES: [Curve; 4] = [
        Curve::Linear,
        Curve::Trilinear([0.2, 0.3]),
        Curve::Exponential(5.0),
        Curve::Exponential(1e-3),
    ];

    fn of(curve: Curve) -> ([f64; COUNT], bool) {
        let [micromodulus, onset, critical] = C_S;
        let materials = vec![SofteningConstants {
            micromodulus,
            onset,
            critical,
            curve,
        }];
        let exponential = matches!(curve, Curve::Exponential(_));
        let law = Softening {
            exponential,
            materials,
        };
        (
            <Softening as Material<1>>::constants(&law, 0, 0.0),
            exponential,
        )
    }

    /// The curve goes through its points, and what a bond has lost at the end is the area under it, summed up in 200,000 trapezia.
    #[test]
    fn what_is_lost_is_the_area_under_the_curve() {
        let [_, onset, critical] = C_S;
        for curve in CURVES {
            let (c, exponential) = of(curve);
            let at = |s: f64| branch(s, &c, 0.0, exponential);
            assert!((at(onset).force - onset).abs() < 1e-16, "{curve:?}");
            assert!(at(critical).force.abs() < 1e-15, "{curve:?}");
            assert!(at(2.0 * critical).force.abs() < 1e-15, "{curve:?}");
            assert_eq!(at(-0.02).force, -0.02);
            if let Curve::Trilinear([x, g]) = curve {
                let kink = at(onset + x * (critical - onset));
                assert!((kink.force - g * onset).abs() < 1e-15);
            }
            let steps = 200_000;
            let place = |k: i32| critical * f64::from(k) / f64::from(steps);
            let whole = (0..steps).map(|k| 0.5 * (at(place(k)).force + at(place(k + 1)).force));
            let sum: f64 = whole.sum::<f64>() * critical / f64::from(steps);
            let lost = at(critical).lost;
            assert!((sum / lost - 1.0).abs() < 1e-6, "{curve:?}: {sum} {lost}");
            assert!(
                (at(2.0 * critical).lost / lost - 1.0).abs() < 1e-12,
                "{curve:?}"
            );
            // the area that a fracture energy is given by
            let said = onset * (0.5 * onset + (critical - onset) * curve.area());
            assert!((said / lost - 1.0).abs() < 1e-9, "{curve:?}: {said} {lost}");
        }
    }

    /// What is stored and lost grows by force times stretch, on the way down, on the way back, and down again.
    #[test]
    fn force_is_the_slope_of_what_is_stored_and_lost() {
        for curve in CURVES {
            let (c, exponential) = of(curve);
            for past in [0.0, 0.015, 0.03, 0.055] {
                for s in [0.004, 0.012, 0.017, 0.025, 0.0405, 0.058, 0.07, -0.01] {
                    let work = |s: f64| {
                        let b = branch(s, &c, past, exponential);
                        0.5 * b.force * s + b.lost
                    };
                    let h = 1e-6;
                    let slope = (work(s + h) - work(s - h)) / (2.0 * h);
                    let force = branch(s, &c, past, exponential).force;
                    assert!(
                        (slope - force).abs() < 1e-9,
                        "{curve:?} {past} {s}: {slope} {force}"
                    );
                }
            }
        }
    }

    #[test]
    fn curves_without_their_keys_are_refused() {
        let with = |word: &str, more: &[(&str, Parameter)]| {
            let word = Parameter::Word(word.into());
            let mut all = Parameters::default().with("curve", word);
            more.iter().for_each(|(k, v)| all.set(k, v.clone()));
            curve(&all)
        };
        let kink = |x: f64, g: f64| ("kink", Parameter::List(vec![x, g]));
        let steep = ("steepness", Parameter::Number(5.0));
        assert_eq!(
            with("exponential", std::slice::from_ref(&steep)),
            Ok(Curve::Exponential(5.0))
        );
        assert!(
            with("exponential", &[])
                .unwrap_err()
                .contains("needs `steepness`")
        );
        assert!(with("trilinear", &[]).unwrap_err().contains("needs `kink`"));
        assert!(
            with("trilinear", &[kink(0.5, 0.6)])
                .unwrap_err()
                .contains("straight line")
        );
        assert!(
            with("linear", &[kink(0.2, 0.3)])
                .unwrap_err()
                .contains("of trilinear")
        );
        assert!(
            with("linear", &[steep])
                .unwrap_err()
                .contains("of exponential")
        );
    }
}
