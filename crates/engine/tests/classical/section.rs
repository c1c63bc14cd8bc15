//! Planes and lines as slices of a three-dimensional solid: what relaxes and what flows, beside a point of that solid whose strain across is
//! that of the plane: none, or the one that leaves no stress there.

use super::{block, led, stress};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

const YOUNG: f64 = 1.0;
const POISSON: f64 = 0.3;
const SHEAR: f64 = YOUNG / (2.0 + 2.0 * POISSON);
const BULK: f64 = YOUNG / (3.0 - 6.0 * POISSON);
/// So small that stretches are linear in it.
const SMALL: f64 = 1e-7;

/// What happens to the deviator of a solid.
#[derive(Clone)]
enum Deviator {
    /// Parts and times of branches, and their back strains.
    Relaxes(Vec<([f64; 2], [f64; 3])>),
    /// Yield stress, hardening; ε̄ and plastic strain.
    Flows([f64; 2], f64, [f64; 3]),
}

/// A point of the solid along its principal axes. Bonds of a lattice resist the deviator along its axes by a G, which is all there is of the
/// lattice in such a strain; what is across has G.
#[derive(Clone)]
struct Solid {
    d: usize,
    lattice: f64,
    deviator: Deviator,
}

impl Solid {
    /// The deviator, as what lies in the body and is its own deviator there, and the rest.
    fn split(&self, strain: [f64; 3]) -> [[f64; 3]; 2] {
        let mean = strain.iter().sum::<f64>() / 3.0;
        let own = strain[..self.d].iter().sum::<f64>() / self.d as f64;
        let inside = std::array::from_fn(|a| if a < self.d { strain[a] - own } else { 0.0 });
        let rest = std::array::from_fn(|a| strain[a] - mean - inside[a]);
        [inside, rest]
    }

    /// Stress of an elastic strain.
    fn hooke(&self, strain: [f64; 3]) -> [f64; 3] {
        let pressure = BULK * strain.iter().sum::<f64>();
        let [inside, rest] = self.split(strain);
        std::array::from_fn(|a| pressure + 2.0 * SHEAR * (self.lattice * inside[a] + rest[a]))
    }

    /// The stress at the end of a step in which the strain goes from one to the other, and the solid then. A step of flow is Euler's backward one,
    /// found by halving; relaxation goes in many small steps of the middle.
    fn step(&self, before: [f64; 3], after: [f64; 3]) -> ([f64; 3], Solid) {
        let mut now = self.clone();
        let gone = match &mut now.deviator {
            Deviator::Relaxes(branches) => {
                const PARTS: usize = 400;
                let dt = 1.0 / PARTS as f64;
                let mut gone = [0.0; 3];
                for ([part, time], back) in branches.iter_mut() {
                    for n in 0..PARTS {
                        let at = (n as f64 + 0.5) * dt;
                        let strain: [f64; 3] =
                            std::array::from_fn(|a| before[a] + at * (after[a] - before[a]));
                        let [inside, rest] = self.split(strain);
                        for a in 0..3 {
                            let to = inside[a] + rest[a];
                            let half = 0.5 * dt / *time;
                            back[a] = (back[a] * (1.0 - half) + 2.0 * half * to) / (1.0 + half);
                        }
                    }
                    (0..3).for_each(|a| gone[a] += *part * back[a]);
                }
                gone
            }
            Deviator::Flows([limit, hardening], flown, plastic) => {
                let elastic = |p: &[f64; 3]| std::array::from_fn(|a| after[a] - p[a]);
                // work-conjugate: the deviator inside returns as the one of a solid of a G, by the same part as what is across
                let of = |factor: f64| {
                    let [inside, rest] = self.split(elastic(plastic));
                    let square = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>();
                    let all = self.lattice * square(inside) + square(rest);
                    (6.0 * SHEAR * SHEAR * all).sqrt() * factor
                };
                let trial = of(1.0);
                if trial > *limit + *hardening * *flown {
                    let (mut low, mut high) = (0.0, trial / (3.0 * SHEAR));
                    for _ in 0..200 {
                        let flow = 0.5 * (low + high);
                        let over =
                            trial - 3.0 * SHEAR * flow - (*limit + *hardening * (*flown + flow));
                        if over > 0.0 {
                            low = flow;
                        } else {
                            high = flow;
                        }
                    }
                    let part = 3.0 * SHEAR * low / trial;
                    let [inside, rest] = self.split(elastic(plastic));
                    (0..3).for_each(|a| plastic[a] += part * (inside[a] + rest[a]));
                    *flown += low;
                }
                *plastic
            }
        };
        let elastic = std::array::from_fn(|a| after[a] - gone[a]);
        (now.hooke(elastic), now)
    }

    /// The same where strains across are those without stress there, after a step from this strain across.
    fn free(&self, before: [f64; 3], along: &[f64]) -> ([f64; 3], [f64; 3], Solid) {
        let strain = |across: f64| -> [f64; 3] {
            std::array::from_fn(|a| along.get(a).copied().unwrap_or(across))
        };
        let [mut low, mut high] = [-100.0 * SMALL, 100.0 * SMALL];
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            let (stress, _) = self.step(before, strain(middle));
            if stress[2] > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        let after = strain(0.5 * (low + high));
        let (stress, now) = self.step(before, after);
        (stress, after, now)
    }
}

/// A path of strains along the axes: pulled, held, pushed back beyond yield.
const STEPS: usize = 36;
fn path(n: usize, end: f64) -> f64 {
    let at = |n: f64| match n {
        n if n < 12.0 => n / 12.0,
        n if n < 24.0 => 1.0,
        n => 1.0 - (n - 24.0) / 8.0,
    };
    end * at(n as f64)
}

fn text(end: f64) -> String {
    format!("({end:e})*(min(t, 12)/12 - max(t - 24, 0)/8)")
}

fn elastic() -> Parameters {
    Parameters::numbers(&[("young", YOUNG), ("poisson", POISSON)])
}

fn lps() -> LawSpec {
    LawSpec::Lps(Moduli {
        young: YOUNG,
        poisson: POISSON,
    })
}

const BRANCHES: [[f64; 2]; 2] = [[0.5, 3.0], [0.3, 20.0]];
const LIMIT: [f64; 2] = [2e-7, 0.2];

fn relaxes() -> (LawSpec, Deviator) {
    let rows = BRANCHES.iter().map(|b| b.to_vec()).collect();
    let law = LawSpec::named(
        "viscoelastic",
        elastic().with("branches", Parameter::Rows(rows)),
    );
    let branches = BRANCHES.map(|b| (b, [0.0; 3])).to_vec();
    (law, Deviator::Relaxes(branches))
}

fn flows() -> (LawSpec, Deviator) {
    let parameters = elastic()
        .with("yield_stress", Parameter::Number(LIMIT[0]))
        .with("hardening", Parameter::Number(LIMIT[1]));
    let law = LawSpec::named("elastic_plastic", parameters);
    (law, Deviator::Flows(LIMIT, 0.0, [0.0; 3]))
}

/// Largest difference of the stress along the axes from that of the solid, over the largest stress.
fn off(d: usize, plane: Plane, (law, deviator): (LawSpec, Deviator), ends: [f64; 2]) -> f64 {
    let kind = [LatticeKind::Chain, LatticeKind::Square][d - 1];
    let led_by = |law: LawSpec| {
        let mut spec = block(kind, [9, if d == 2 { 9 } else { 1 }, 1], 2, law);
        spec.space.plane = plane;
        let [x, y] = ends.map(text);
        let y = if d == 2 { format!("y*{y}") } else { "0".into() };
        led(&mut spec, [&format!("x*{x}"), &y, "0"])
    };
    let axes = &["xx", "yy"][..d];
    let mut lattice = 1.0;
    if d == 2 && ends[0] != ends[1] {
        let mut sim = led_by(lps());
        sim.step().unwrap();
        let [x, y] = ["xx", "yy"].map(|c| stress(sim.as_mut(), c));
        lattice = (x - y) / (2.0 * SHEAR * (path(1, ends[0]) - path(1, ends[1])));
        assert!((lattice - 1.0).abs() < 0.2, "{lattice}");
    }
    let mut solid = Solid {
        d,
        lattice,
        deviator,
    };
    let mut sim = led_by(law);
    let (mut strain, mut worst, mut size) = ([0.0; 3], 0.0f64, 0.0f64);
    for n in 1..=STEPS {
        sim.step().unwrap();
        let along: Vec<f64> = ends[..d].iter().map(|e| path(n, *e)).collect();
        let (expected, after, now) = if d == 2 && plane == Plane::Strain {
            let after = [along[0], along[1], 0.0];
            let (stress, now) = solid.step(strain, after);
            (stress, after, now)
        } else {
            solid.free(strain, &along)
        };
        (strain, solid) = (after, now);
        for (a, axis) in axes.iter().enumerate() {
            let found = stress(sim.as_mut(), axis);
            worst = worst.max((found - expected[a]).abs());
            size = size.max(expected[a].abs());
        }
    }
    worst / size
}

const ENDS: [[f64; 2]; 3] = [[5e-7, 5e-7], [6e-7, -1e-7], [5e-7, 2e-7]];

/// To what a step of relaxation is off, exact for a deviator that is linear over it: across a free section it nearly is.
#[test]
fn what_relaxes_in_a_slice_is_the_deviator_of_the_solid() {
    for ends in ENDS {
        let held = off(2, Plane::Strain, relaxes(), ends);
        assert!(held < 2e-6, "plane strain {ends:?}: {held:e}");
        let free = off(2, Plane::Stress, relaxes(), ends);
        assert!(free < 2e-3, "plane stress {ends:?}: {free:e}");
    }
    let line = off(1, Plane::Stress, relaxes(), ENDS[1]);
    assert!(line < 2e-3, "a line: {line:e}");
}

#[test]
fn what_flows_in_a_slice_is_the_deviator_of_the_solid() {
    for ends in ENDS {
        for plane in [Plane::Strain, Plane::Stress] {
            let off = off(2, plane, flows(), ends);
            assert!(off < 2e-6, "{plane:?} {ends:?}: {off:e}");
        }
    }
    let line = off(1, Plane::Stress, flows(), ENDS[1]);
    assert!(line < 2e-6, "a line: {line:e}");
}

/// Known numbers: a bar yields at its yield stress, a sheet that is pulled alike along both axes too, and both harden by `EH/(E + H)` and
/// its biaxial kin `E′H/(E′ + 2·½H)`, E′ = E/(1 − ν): there σ is the von Mises stress, and the plastic strains ½Δε̄.
#[test]
fn a_bar_and_a_sheet_yield_at_the_yield_stress() {
    let tangents = [
        YOUNG * LIMIT[1] / (YOUNG + LIMIT[1]),
        2.0 / (2.0 * (1.0 - POISSON) / YOUNG + 1.0 / LIMIT[1]),
    ];
    let moduli = [YOUNG, YOUNG / (1.0 - POISSON)];
    let metal = |gradient: &str| {
        let parameters = elastic()
            .with("yield_stress", Parameter::Number(LIMIT[0]))
            .with("hardening", Parameter::Number(LIMIT[1]))
            .with("gradient", Parameter::Word(gradient.into()));
        LawSpec::named("hypoelastic_plastic", parameters)
    };
    for (d, law) in [
        (1, flows().0),
        (2, flows().0),
        (2, metal("family")),
        (2, metal("bond")),
    ] {
        let kind = [LatticeKind::Chain, LatticeKind::Square][d - 1];
        let mut spec = block(kind, [9, if d == 2 { 9 } else { 1 }, 1], 2, law);
        spec.space.plane = Plane::Stress;
        let y = if d == 2 { "1e-7*y*t" } else { "0" };
        let mut sim = led(&mut spec, ["1e-7*x*t", y, "0"]);
        for n in 1..=10 {
            sim.step().unwrap();
            let strain = 1e-7 * f64::from(n);
            let begins = LIMIT[0] / moduli[d - 1];
            let exact = match strain < begins {
                true => moduli[d - 1] * strain,
                false => LIMIT[0] + tangents[d - 1] * (strain - begins),
            };
            let found = stress(sim.as_mut(), "xx");
            assert!(
                (found / exact - 1.0).abs() < 2e-6,
                "{d} {n}: {found} {exact}"
            );
        }
    }
}

/// The same energy written by a user, whose thickness is searched for, and with a thickness of its own, to large strains: and where nothing changes
/// the volume the sheet of Treloar (1944), `σ = μ (λ² − λ⁻⁴)` of the current area.
#[test]
fn a_sheet_of_rubber_gets_thinner() {
    use peridyne::expression::Expression;
    let written = |text: &str, gradient: &str| {
        let of = [("mu", SHEAR), ("l", BULK - 2.0 / 3.0 * SHEAR)];
        let energy = Expression::of(&["I1", "I2", "J"], text, &of).unwrap();
        let parameters = Parameters::default()
            .with("energy", Parameter::Formula(energy))
            .with("gradient", Parameter::Word(gradient.into()));
        LawSpec::named("hyperelastic", parameters)
    };
    let named = |gradient: &str| {
        let parameters = elastic()
            .with("stress", Parameter::Word("neo_hookean".into()))
            .with("gradient", Parameter::Word(gradient.into()));
        LawSpec::named("correspondence", parameters)
    };
    let pulled = |law: LawSpec, ways: [&str; 2]| {
        let mut spec = block(LatticeKind::Square, [9, 9, 1], 2, law);
        spec.space.plane = Plane::Stress;
        led(&mut spec, [ways[0], ways[1], "0"])
    };
    for gradient in ["family", "bond"] {
        let ways = ["0.04*x*t + 0.02*y*t", "0.03*x*t - 0.02*y*t"];
        let neo_hooke = "mu/2*(I1 - 3) - mu*ln(J) + l/2*ln(J)^2";
        let mut sheets = [written(neo_hooke, gradient), named(gradient)].map(|l| pulled(l, ways));
        for n in 1..=10 {
            let [one, other] = sheets.each_mut().map(|sim| {
                sim.step().unwrap();
                ["xx", "yy", "xy"].map(|c| stress(sim.as_mut(), c))
            });
            for (a, b) in one.iter().zip(other) {
                assert!(
                    (a - b).abs() < 1e-10 * one[0].abs(),
                    "{gradient} {n}: {one:?} {other:?}"
                );
            }
        }
        let stiff = "mu/2*(I1*J^(-2/3) - 3) + 5e5*mu*(J - 1)^2";
        let mut sim = pulled(written(stiff, gradient), ["0.05*x*t", "0.05*y*t"]);
        for n in 1..=10 {
            sim.step().unwrap();
            let stretch = 1.0 + 0.05 * f64::from(n);
            let exact = SHEAR * (stretch.powi(2) - stretch.powi(-4));
            let found = stress(sim.as_mut(), "xx");
            // a bulk modulus of a million μ is hardly pressed
            assert!(
                (found / exact - 1.0).abs() < 1e-5,
                "{gradient} {n}: {found} {exact}"
            );
        }
    }
}

/// A family that a crack has torn sees the strain of the body as a whole one does, as long as its bonds span the space: a plane is a slice there, too.
#[test]
fn a_torn_slice_is_one_of_the_solid() {
    let with = |name: &str, words: &[(&str, &str)], numbers: &[(&str, f64)]| {
        let word =
            |p: Parameters, (key, x): &(&str, &str)| p.with(key, Parameter::Word((*x).into()));
        let number = |p: Parameters, (key, x): &(&str, f64)| p.with(key, Parameter::Number(*x));
        let parameters = words.iter().fold(elastic(), word);
        LawSpec::named(name, numbers.iter().fold(parameters, number))
    };
    for gradient in ["family", "bond"] {
        let words = [("gradient", gradient)];
        for law in [
            with("hypoelastic", &words, &[]),
            with(
                "hypoelastic_plastic",
                &words,
                &[("yield_stress", 0.01), ("hardening", 0.1)],
            ),
            with(
                "correspondence",
                &[words[0], ("stress", "neo_hookean")],
                &[],
            ),
        ] {
            let of = |kind: LatticeKind, sites: [i32; 3]| {
                let mut spec = block(kind, sites, 2, law.clone());
                spec.space.plane = Plane::Strain;
                let [low, high] = [[0.4, -0.4, -9.0], [0.4, 9.0, 9.0]];
                let corner = |y: f64, z: f64| [low[0], y, z];
                let shape = match kind {
                    LatticeKind::Square => CrackShape::Segment {
                        from: low,
                        to: high,
                    },
                    _ => CrackShape::Polygon {
                        corners: vec![
                            corner(low[1], low[2]),
                            corner(high[1], low[2]),
                            corner(high[1], high[2]),
                            corner(low[1], high[2]),
                        ],
                    },
                };
                spec.damage.precracks = vec![PrecrackSpec {
                    shape,
                    kind: CrackKind::Broken,
                }];
                let mut sim = led(
                    &mut spec,
                    ["0.03*x*t + 0.01*y*t", "0.02*x*t - 0.01*y*t", "0"],
                );
                (0..3).for_each(|_| sim.step().unwrap());
                let n = sim.info().points as usize;
                let torn = sim.column("damage").unwrap().values.at(n / 2, 0);
                assert!(torn > 0.15, "{torn}");
                sim.column("strain_energy_density")
                    .unwrap()
                    .values
                    .at(n / 2, 0)
            };
            let [plane, solid] = [
                of(LatticeKind::Square, [9, 9, 1]),
                of(LatticeKind::Cubic, [9, 9, 7]),
            ];
            assert!(
                (plane / solid - 1.0).abs() < 1e-9,
                "{gradient} {law:?}: {plane} {solid}"
            );
        }
    }
}
