//! Laws that flow, one point of them: closed forms, and what must hold after every step whatever the constants.

use peridyne::expression::Expression;
use peridyne::law::descriptor::{Given, Registered};
use peridyne::law::material::non_ordinary::hypoelastic_plastic::HypoelasticPlastic;
use peridyne::law::material::non_ordinary::{Classical, Unseen};
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

const LAMBDA: f64 = 60.0;
const MU: f64 = 40.0;
const BULK: f64 = LAMBDA + 2.0 * MU / 3.0;
const DENSITY: f64 = 2.0;

type Matrix<const D: usize> = [[f64; D]; D];
type Past<const D: usize> = ([Matrix<D>; 2], [f64; 11]);
/// A deformation that F sees all of.
const SEEN: Unseen<f64> = Unseen {
    stiffness: 0.0,
    square: 0.0,
    across: 0.0,
    reach: 1.0,
};
const WORK: usize = 0;
const MEAN: usize = 1;
const STRAIN: usize = 2;
const PLASTIC_WORK: usize = 3;
const RISE: usize = 4;
const DAMAGE: usize = 5;

fn elastic() -> Parameters {
    Parameters::numbers(&[("bulk", BULK), ("shear", MU)])
}

fn made(d: usize, mut parameters: Parameters) -> Result<HypoelasticPlastic, String> {
    let checked = HypoelasticPlastic::descriptor().check(&mut parameters);
    checked.map_err(|(key, message)| format!("{key}: {message}"))?;
    let given = Given {
        parameters: &parameters,
        solid: None,
        micromodulus: None,
        critical_stretch: f64::INFINITY,
        breaks: false,
        density: DENSITY,
        weighted_volume: None,
        first_moment: 1.0,
        horizon: 1.0,
        family: &[],
    };
    HypoelasticPlastic::make(d, Plane::Strain, &[given]).map_err(|(_, message)| message)
}

fn law(more: &[(&str, f64)], words: &[(&str, &str)]) -> HypoelasticPlastic {
    let mut all = elastic();
    for (key, x) in more {
        all.set(key, Parameter::Number(*x));
    }
    for (key, word) in words {
        all.set(key, Parameter::Word((*word).into()));
    }
    made(3, all).unwrap()
}

/// What is remembered after each of `steps` equal steps along `path` from 0 to 1, which gives H; `dt` each.
fn along<const D: usize>(
    law: &HypoelasticPlastic,
    steps: usize,
    dt: f64,
    path: impl Fn(f64) -> Matrix<D>,
) -> Vec<Past<D>> {
    let constants = Classical::<D>::constants(law, 0, dt);
    let mut past = ([[[0.0; D]; D]; 2], [0.0; 11]);
    let mut all = vec![];
    for n in 1..=steps {
        past = law
            .stress(&constants, &past, &path(n as f64 / steps as f64), &SEEN)
            .past;
        all.push(past);
    }
    all
}

/// Strain along x alone, to a logarithmic strain of `end`.
fn uniaxial(end: f64) -> impl Fn(f64) -> Matrix<3> {
    move |t| [[(end * t).exp_m1(), 0.0, 0.0], [0.0; 3], [0.0; 3]]
}

/// q of an unrotated stress with this mean, with what is across a plane.
fn mises<const D: usize>(past: &Past<D>) -> f64 {
    let (s, p) = (past.0[1], past.1[MEAN]);
    let mut square = 0.0;
    let mut across = 0.0;
    for r in 0..D {
        for c in 0..D {
            let x = s[r][c] - if r == c { p } else { 0.0 };
            square += x * x;
        }
        across -= s[r][r] - p;
    }
    if D == 2 {
        square += across * across;
    }
    (1.5 * square).sqrt()
}

/// Strain along a line: `q̇ = 2μ ε̇` while elastic, then `ε̄̇ = 2μ ε̇/(3μ + H)`; `p = K ln F`.
#[test]
fn a_line_of_strain_has_its_closed_form() {
    let (y, h, end) = (0.3, 5.0, 0.08);
    let law = law(&[("yield_stress", y), ("hardening", h)], &[]);
    let onset = y / (2.0 * MU);
    let strain = 2.0 * MU * (end - onset) / (3.0 * MU + h);
    let stress = BULK * end + 2.0 / 3.0 * (y + h * strain);
    let errors = [100usize, 200, 400].map(|n| {
        let past = along(&law, n, 0.0, uniaxial(end))[n - 1];
        let off = [
            past.0[1][0][0] / stress - 1.0,
            past.1[STRAIN] / strain - 1.0,
        ];
        off.map(f64::abs).into_iter().fold(0.0, f64::max)
    });
    // the increments of strain are of second order, all else is exact
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.2, "{errors:?}");
    }
    assert!(errors[2] < 2e-8, "{errors:?}");
}

/// Where it flowed, the yield surface holds for the new stress, whatever hardens it; the stress of the plastic strain's complement is
/// that of Hooke; what is dissipated is not negative.
#[test]
fn the_yield_surface_holds() {
    let dt = 1e-3;
    let rates: [(&str, fn(f64, f64) -> f64); 3] = [
        ("none", |_, _| 1.0),
        ("johnson_cook", |rate, c| 1.0 + c * rate.max(1.0).ln()),
        ("power", |rate, m| rate.powf(m)),
    ];
    type Law = fn(f64) -> f64;
    let laws: [(&str, &[(&str, f64)], Law); 5] = [
        ("linear", &[("hardening", 2.0)], |e| 0.3 + 2.0 * e),
        ("ludwik", &[("hardening", 0.8), ("exponent", 0.31)], |e| {
            0.3 + 0.8 * e.powf(0.31)
        }),
        (
            "swift",
            &[
                ("reference_strain", 0.002),
                ("exponent", 0.1),
                ("softening_strain", 0.4),
            ],
            |e| 0.3 * (1.0 + e / 0.002).powf(0.1) / (1.0 + e * e / 0.16),
        ),
        (
            "voce",
            &[("hardening", 0.2), ("reference_strain", 0.03)],
            |e| 0.3 + 0.2 * (1.0 - (-e / 0.03).exp()),
        ),
        ("table", &[], |e| match e {
            e if e < 0.01 => 0.3 + 10.0 * e,
            e if e < 0.05 => 0.4 + 2.5 * (e - 0.01),
            _ => 0.5,
        }),
    ];
    // sheared, stretched, turned, and back
    let path = |t: f64| {
        let back = (2.0 * std::f64::consts::PI * t).sin();
        let mut h = [[0.0; 3]; 3];
        h[0][0] = 0.05 * back;
        h[0][1] = 0.12 * t;
        h[1][0] = -0.04 * t;
        h[2][1] = 0.06 * back * t;
        h
    };
    for (word, keys, hardened) in laws {
        for (rate_word, rate) in rates {
            for thermal in [false, true] {
                let mut parameters = elastic().with("hardening_law", Parameter::Word(word.into()));
                if word == "table" {
                    let rows = [[0.0, 0.3], [0.01, 0.4], [0.05, 0.5]].map(|r| r.to_vec());
                    parameters.set("table", Parameter::Rows(rows.to_vec()));
                } else {
                    parameters.set("yield_stress", Parameter::Number(0.3));
                }
                for (key, x) in keys {
                    parameters.set(key, Parameter::Number(*x));
                }
                let sensitivity = 0.02;
                if rate_word != "none" {
                    parameters.set("rate_law", Parameter::Word(rate_word.into()));
                    parameters.set("rate_sensitivity", Parameter::Number(sensitivity));
                    parameters.set("reference_rate", Parameter::Number(0.5));
                }
                if thermal {
                    for (key, x) in [
                        ("melting_temperature", 1000.0),
                        ("reference_temperature", 300.0),
                        ("thermal_exponent", 1.3),
                        ("heat_capacity", 2e-4),
                    ] {
                        parameters.set(key, Parameter::Number(x));
                    }
                }
                let law = made(3, parameters).unwrap();
                let steps = 400;
                let mut before: Past<3> = ([[[0.0; 3]; 3]; 2], [0.0; 11]);
                let (mut flowed, mut worst, mut rises): (usize, f64, f64) = (0, 0.0, 0.0);
                for past in along(&law, steps, dt, path) {
                    let more = past.1[STRAIN] - before.1[STRAIN];
                    let soft = if thermal {
                        1.0 - (before.1[RISE] / 700.0).powf(1.3)
                    } else {
                        1.0
                    };
                    let limit =
                        soft * hardened(past.1[STRAIN]) * rate(more / dt / 0.5, sensitivity);
                    // differences of strains are known to round-off of strains; powers of them feel it
                    if more > 1e-7 {
                        flowed += 1;
                        worst = worst.max((mises(&past) / limit - 1.0).abs());
                    }
                    assert!(
                        past.1[PLASTIC_WORK] - before.1[PLASTIC_WORK] > -1e-6,
                        "{word}"
                    );
                    rises = past.1[RISE];
                    before = past;
                }
                assert!(flowed > 50, "{word} {rate_word}: {flowed}");
                assert!(worst < 1e-9, "{word} {rate_word} {thermal}: {worst}");
                if thermal {
                    // ρ c ΔT = β w_p
                    let expected = 0.9 * before.1[PLASTIC_WORK] / (DENSITY * 2e-4);
                    assert!((rises / expected - 1.0).abs() < 1e-13);
                    assert!(rises > 20.0, "{rises}");
                }
            }
        }
    }
}

/// Drucker and Prager: the surface `q + a p = σ_y`, dilation `b` times the plastic strain, and the apex.
#[test]
fn pressure_holds_and_the_apex_is_found() {
    let (y, h, a, b) = (0.3, 1.0, 0.6, 0.25);
    let law = law(
        &[
            ("yield_stress", y),
            ("hardening", h),
            ("friction", a),
            ("dilatancy", b),
        ],
        &[],
    );
    // shear under pressure: p is that of the elastic dilation less what flow adds
    let squeezed = |t: f64| {
        let mut m = [[0.0; 3]; 3];
        (0..3).for_each(|k| m[k][k] = -0.003 * t);
        m[0][1] = 0.06 * t;
        m
    };
    let all = along(&law, 200, 0.0, squeezed);
    let past = all.last().unwrap();
    let (q, p, e) = (mises(past), past.1[MEAN], past.1[STRAIN]);
    assert!(e > 0.02 && p < 0.0);
    assert!((q + a * p - (y + h * e)).abs() < 1e-13);
    // ∫ tr Δε = ln J, of which bε̄ is plastic
    let j = |t: f64| {
        let m = squeezed(t);
        ((1.0 + m[0][0]) * (1.0 + m[1][1]) - m[0][1] * m[1][0]) * (1.0 + m[2][2])
    };
    let elastic = BULK * (j(1.0).ln() - b * e);
    assert!((p - elastic).abs() < 1e-5 * elastic.abs(), "{p} {elastic}");
    // pulled from all sides it can take σ_y/a
    let pulled = |t: f64| {
        let mut m = [[0.0; 3]; 3];
        (0..3).for_each(|k| m[k][k] = 0.02 * t);
        m[0][1] = 0.002 * t;
        m
    };
    let past = *along(&law, 200, 0.0, pulled).last().unwrap();
    assert!(mises(&past) < 1e-12, "{}", mises(&past));
    let limit = (y + h * past.1[STRAIN]) / a;
    assert!(
        (past.1[MEAN] / limit - 1.0).abs() < 1e-3,
        "{} {limit}",
        past.1[MEAN]
    );
    assert!(past.1[PLASTIC_WORK] > 0.0);
}

/// In the plane it is what it is in space without strain across.
#[test]
fn the_plane_is_strained() {
    let more = [
        ("yield_stress", 0.3),
        ("hardening", 0.5),
        ("friction", 0.2),
        ("dilatancy", 0.1),
    ];
    let law = law(&more, &[]);
    let h = |t: f64| [[0.03 * t, 0.05 * t], [-0.02 * t * t, -0.04 * t]];
    let plane = along(&law, 50, 0.0, h);
    let space = along(&law, 50, 0.0, |t| {
        let [[xx, xy], [yx, yy]] = h(t);
        [[xx, xy, 0.0], [yx, yy, 0.0], [0.0; 3]]
    });
    for (plane, space) in plane.iter().zip(&space) {
        for r in 0..2 {
            for c in 0..2 {
                assert!((plane.0[1][r][c] - space.0[1][r][c]).abs() < 1e-13);
            }
        }
        for k in 0..9 {
            assert!((plane.1[k] - space.1[k]).abs() < 1e-13, "{k}");
        }
        assert!((mises(plane) - mises(space)).abs() < 1e-13);
    }
    assert!(plane[49].1[STRAIN] > 0.01);
}

/// What is stored is elastic: the work less what was dissipated is that of Hooke for small strains, and both are of second order.
#[test]
fn work_is_stored_or_dissipated() {
    let law = law(&[("yield_stress", 0.003), ("hardening", 5.0)], &[]);
    let path = |t: f64| {
        [
            [4e-4 * t, 3e-4 * t * t, 0.0],
            [0.0, -1e-4 * t, 0.0],
            [2e-4 * t * t, 0.0, 0.0],
        ]
    };
    let errors = [50usize, 100, 200].map(|n| {
        let past = along(&law, n, 0.0, path)[n - 1];
        let (q, p) = (mises(&past), past.1[MEAN]);
        let hooke = q * q / (6.0 * MU) + p * p / (2.0 * BULK);
        ((past.1[WORK] - past.1[PLASTIC_WORK]) / hooke - 1.0).abs()
    });
    // strains of 4e-4 leave that much between Hooke and a rate
    assert!(errors[2] < 2e-3, "{errors:?}");
    let gain = (errors[0] - errors[1]) / (errors[1] - errors[2]);
    assert!(gain > 2.5, "{errors:?}");
}

/// Damage of a constant triaxiality is the plastic strain by that at fracture.
#[test]
fn damage_grows_as_johnson_and_cook_say() {
    let d = [0.05, 3.4, -2.1, 0.002, 0.6];
    let parameters = elastic()
        .with("yield_stress", Parameter::Number(0.3))
        .with("reference_rate", Parameter::Number(2.0))
        .with("melting_temperature", Parameter::Number(1000.0))
        .with("reference_temperature", Parameter::Number(300.0))
        .with("damage", Parameter::List(d.to_vec()));
    let law = made(3, parameters).unwrap();
    let dt = 1e-4;
    let all = along(&law, 100, dt, uniaxial(0.02));
    let mut expected = 0.0;
    let mut before = 0.0;
    for past in &all {
        let more = past.1[STRAIN] - before;
        before = past.1[STRAIN];
        if more > 0.0 {
            let triaxiality = past.1[MEAN] / mises(past);
            let quick = 1.0 + d[3] * (more / dt / 2.0).max(1.0).ln();
            // without a heat capacity it stays cold
            expected += more / ((d[0] + d[1] * (d[2] * triaxiality).exp()) * quick);
        }
    }
    let found = all[99].1[DAMAGE];
    assert!(
        found > 0.02 && (found / expected - 1.0).abs() < 1e-12,
        "{found} {expected}"
    );
}

/// A step of no length changes nothing: the answers of before are those of after.
#[test]
fn time_may_stand_still() {
    for rate in ["none", "johnson_cook", "power"] {
        let mut more = vec![("yield_stress", 0.3), ("hardening", 0.5)];
        if rate != "none" {
            more.extend([("rate_sensitivity", 0.05), ("reference_rate", 1e-3)]);
        }
        let law = law(&more, &[("rate_law", rate)]);
        let end = uniaxial(0.05)(1.0);
        let past = *along(&law, 50, 1e-3, uniaxial(0.05)).last().unwrap();
        let still = law.stress(&Classical::<3>::constants(&law, 0, 0.0), &past, &end, &SEEN);
        let same = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(
            (0..3).all(|k| same(still.past.0[1][k][k], past.0[1][k][k])),
            "{rate}"
        );
        assert!(same(still.past.1[STRAIN], past.1[STRAIN]));
        assert!(same(still.energy, past.1[WORK] - past.1[PLASTIC_WORK]));
    }
}

/// Constants that cannot be are refused, with the reason.
#[test]
fn what_cannot_be_is_refused() {
    let number = |key: &'static str, x| move |p: &mut Parameters| p.set(key, Parameter::Number(x));
    let word = |key: &'static str, w: &'static str| {
        move |p: &mut Parameters| p.set(key, Parameter::Word(w.into()))
    };
    let rows = |rows: &[[f64; 2]]| {
        let rows: Vec<Vec<f64>> = rows.iter().map(|r| r.to_vec()).collect();
        Parameter::Rows(rows)
    };
    type Change = Box<dyn Fn(&mut Parameters)>;
    let cases: Vec<(Vec<Change>, &str)> = vec![
        (vec![], "linear needs `yield_stress`"),
        (vec![Box::new(number("yield_stress", -1.0))], "yield_stress"),
        (
            vec![
                Box::new(number("yield_stress", 1.0)),
                Box::new(word("hardening_law", "ludwik")),
            ],
            "ludwik needs `exponent`",
        ),
        (
            vec![
                Box::new(number("yield_stress", 1.0)),
                Box::new(number("exponent", 0.3)),
            ],
            "`exponent` says nothing where linear stands",
        ),
        (
            vec![
                Box::new(number("yield_stress", 1.0)),
                Box::new(word("rate_law", "power")),
            ],
            "power needs `rate_sensitivity`",
        ),
        (
            vec![
                Box::new(number("yield_stress", 1.0)),
                Box::new(number("dilatancy", 0.1)),
            ],
            "would give energy away",
        ),
        (
            vec![
                Box::new(word("hardening_law", "table")),
                Box::new({
                    let rows = rows(&[[0.0, 2.0], [0.1, 1.0]]);
                    move |p: &mut Parameters| p.set("table", rows.clone())
                }),
            ],
            "softens",
        ),
        (
            vec![
                Box::new(word("hardening_law", "table")),
                Box::new({
                    let rows = rows(&[[0.1, 2.0], [0.2, 3.0]]);
                    move |p: &mut Parameters| p.set("table", rows.clone())
                }),
            ],
            "expected 0",
        ),
        (
            vec![
                Box::new(number("yield_stress", 1.0)),
                Box::new(number("melting_temperature", 300.0)),
                Box::new(number("reference_temperature", 300.0)),
            ],
            "not above",
        ),
        (
            vec![
                Box::new(number("yield_stress", 1.0)),
                Box::new(|p: &mut Parameters| {
                    p.set("damage", Parameter::List(vec![0.1, 0.1, 0.0, 0.5, 0.0]));
                }),
            ],
            "reference_rate",
        ),
    ];
    for (changes, expected) in cases {
        let mut parameters = elastic();
        changes.iter().for_each(|change| change(&mut parameters));
        let refused = made(3, parameters).err().unwrap_or_default();
        assert!(
            refused.contains(expected),
            "{refused:?}, expected {expected:?}"
        );
    }
}

/// A bar held at its ends and pulled to a third more: all but the little that is elastic is dissipated. A control that stays elastic
/// takes several times as much work.
#[test]
fn a_held_bar_holds_its_flow_stress() {
    held_bar("control", Parameter::Number(0.5));
}

/// Gradients of bonds need none, and do not lock.
#[test]
fn a_held_bar_of_bonds_holds_its_flow_stress() {
    held_bar("gradient", Parameter::Word("bond".into()));
}

fn held_bar(key: &str, value: Parameter) {
    let mut quarters = vec![];
    for z in 0..5 {
        for y in 0..5 {
            for x in 0..15 {
                quarters.push([4 * x, 4 * y, 4 * z]);
            }
        }
    }
    let body = BodySpec::Sites {
        kind: LatticeKind::Cubic,
        spacing: 1.0,
        origin: [0.0; 3],
        quarters,
        volume: None,
    };
    let metal = Parameters::numbers(&[
        ("young", 400.0),
        ("poisson", 0.3),
        ("yield_stress", 1.0),
        ("hardening", 1.0),
    ])
    .with(key, value);
    let mut spec = Spec::new(3, body, 1.0, LawSpec::named("hypoelastic_plastic", metal));
    spec.bonds.horizon = Horizon::Ratio(2);
    for (name, at, sign) in [("low", 1.5, 1.0), ("high", 12.5, -1.0)] {
        spec.sets.push(SetSpec {
            name: name.into(),
            members: Members::Region(Region::HalfSpace {
                point: [at, 0.0, 0.0],
                normal: [sign, 0.0, 0.0],
            }),
        });
        let speed = Expression::parse(if sign > 0.0 { "-0.1" } else { "0.1" }, &[]).unwrap();
        spec.loading.conditions.push(ConditionSpec {
            set: name.into(),
            kind: ConditionKind::Velocity([Some(speed), None, None]),
        });
    }
    spec.run.schedule.time_step = TimeStep::Fixed(0.02);
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    // 5 of 15 spacings
    for _ in 0..1250 {
        sim.step().unwrap();
    }
    let ledger = sim.ledger().unwrap();
    let ratio = ledger.work_boundary_conditions / ledger.dissipated;
    println!(
        "{key}: work over dissipation {ratio}, residual {:e}",
        ledger.residual()
    );
    assert!(ledger.dissipated > 50.0, "{}", ledger.dissipated);
    assert!((1.0..1.25).contains(&ratio), "{ratio}");
}
