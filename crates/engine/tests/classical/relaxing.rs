//! Relaxation of a strain that is held: of shear exactly, of a bar with free sides.

use super::{block, e, led, stress};
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn elastic() -> Parameters {
    Parameters::numbers(&[("young", 1.0), ("poisson", 0.3)])
}

fn viscoelastic(branches: &[[f64; 2]]) -> LawSpec {
    let rows = branches.iter().map(|b| b.to_vec()).collect();
    LawSpec::named(
        "viscoelastic",
        elastic().with("branches", Parameter::Rows(rows)),
    )
}

fn lps() -> LawSpec {
    LawSpec::Lps(Moduli {
        young: 1.0,
        poisson: 0.3,
    })
}

/// `σ(t) = Gγ (1 − Σλ + Σ λ (τ/t₁)(e^(t₁/τ) − 1) e^(−t/τ))` after a ramp of length t₁, which here is one step.
#[test]
fn shear_relaxes_by_its_modulus() {
    let branches = [[0.5, 3.0], [0.2, 40.0]];
    let slid = |law: LawSpec| {
        let mut spec = block(LatticeKind::Cubic, [9; 3], 2, law);
        led(&mut spec, ["1e-7*y*min(t, 1)", "0", "0"])
    };
    let mut solid = slid(lps());
    solid.step().unwrap();
    let at_once = stress(solid.as_mut(), "xy");
    let mut sim = slid(viscoelastic(&branches));
    for n in 1..=60 {
        sim.step().unwrap();
        let relaxed: f64 = branches
            .iter()
            .map(|[part, time]| {
                let ramp = time * (1.0 / time).exp_m1();
                part * (ramp * (-f64::from(n) / time).exp() - 1.0)
            })
            .sum();
        let found = stress(sim.as_mut(), "xy") / at_once;
        assert!(
            (found - (1.0 + relaxed)).abs() < 1e-6,
            "{n}: {found} is not {}",
            1.0 + relaxed
        );
    }
}

/// The pull of a bar with free sides, whose bulk modulus stays and whose shear modulus has one branch:
/// `E(t) = E∞ + (E₀ − E∞) e^(−t/τ_E)`, `1/τ_E = (3K b + G a)/(3K + G)`, `b = 1/τ`, `a = (1 − λ)/τ`, `E₀ = 9KG/(3K + G)`,
/// `E∞ = 9KG a/(3K b + G a)` (the elastic solution in Laplace space), after a ramp of length t₁.
#[test]
fn a_bar_relaxes_as_the_classical_one() {
    let (part, time, ramp) = (0.6, 500.0f64, 100.0f64);
    let pull = |law: LawSpec| -> Vec<f64> {
        let mut spec = block(LatticeKind::Cubic, [16, 4, 4], 2, law);
        let end = |sign: f64| {
            Members::Region(Region::HalfSpace {
                point: [6.0 * sign, 0.0, 0.0],
                normal: [-sign, 0.0, 0.0],
            })
        };
        spec.sets = [("low", -1.0), ("high", 1.0)]
            .map(|(name, sign)| SetSpec {
                name: name.into(),
                members: end(sign),
            })
            .to_vec();
        let held = |set: &str, u: &str| ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Displacement([Some(e(u)), None, None]),
        };
        spec.conditions = vec![
            held("low", "0"),
            held("high", &format!("1e-4*min(t/{ramp}, 1)")),
            ConditionSpec {
                set: "all".into(),
                kind: ConditionKind::Damping(e("0.1")),
            },
        ];
        spec.probes = vec![ProbeSpec {
            name: "pull".into(),
            set: "high".into(),
            measure: Measure::Reaction,
        }];
        spec.schedule.time_step = TimeStep::Fixed(0.25);
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let mut all = vec![];
        for n in 1..=6000 {
            sim.step().unwrap();
            if n % 600 == 0 && n > 1200 {
                all.push(sim.measure()[0]);
            }
        }
        all
    };
    let (k, g) = (1.0 / 1.2, 1.0 / 2.6);
    let (b, a) = (1.0 / time, (1.0 - part) / time);
    let at_once = 9.0 * k * g / (3.0 * k + g);
    let at_last = 9.0 * k * g * a / (3.0 * k * b + g * a);
    let of_bar = (3.0 * k + g) / (3.0 * k * b + g * a);
    let spread = of_bar / ramp * (ramp / of_bar).exp_m1();
    let found = pull(viscoelastic(&[[part, time]]));
    for ((n, relaxed), solid) in found.iter().enumerate().zip(pull(lps())) {
        let t = 150.0 * (n + 3) as f64;
        let classical = (at_last + (at_once - at_last) * spread * (-t / of_bar).exp()) / at_once;
        let ratio = relaxed / solid;
        println!("t = {t}: {ratio:.4}, classical {classical:.4}");
        assert!(
            (ratio - classical).abs() < 0.02,
            "{t}: {ratio} is not {classical}"
        );
    }
}
