//! Heat in a bar: series, steady profiles, fluxes, convection, radiation.

use crate::sample::*;
use peridyne::spec::*;
use std::f64::consts::PI;

const ALL: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn order(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

/// Ends held at 0: `Σ b_n sin(nπx) exp(−n²π² t)` of the series of x (1 − x), 8/(nπ)³ of odd n. Beyond the ends the series goes on, odd.
#[test]
fn a_bar_cools_as_fourier_says() {
    let term = |n: u32| {
        let k = f64::from(n) * PI;
        format!("{:e}*sin({k:e}*x)*exp(-{:e}*t)", 8.0 / k.powi(3), k * k)
    };
    let series: Vec<String> = [1, 3, 5, 7, 9, 11].map(term).to_vec();
    let series = series.join(" + ");
    let of_time = text(&series);
    let at = 0.05;
    let error = |n: usize| {
        let h = 1.0 / n as f64;
        let wide = 6.0 * h;
        // steps so short that the spacing alone shows
        let mut heat = heat(DiffusionMethod::Explicit { safety: 0.1 });
        heat.initial = vec![("all".into(), of_time.clone())];
        heat.conditions = ["left", "right"]
            .map(|set| on(set, DiffusionKind::Value(of_time.clone())))
            .to_vec();
        let body = cells(1, h, [-wide; 3], [1.0 + wide; 3]);
        let steps = 4;
        let mut spec = still(1, body, 3, at / f64::from(steps), heat);
        spec.sets = vec![beyond("left", 0.0, -1.0), beyond("right", 1.0, 1.0)];
        let mut sim = built(&spec);
        run(&mut *sim, u64::from(steps as u32));
        off(&mut *sim, [0.0, 1.0], |x| of_time.eval(&[x, 0.0, 0.0], at))
    };
    let errors = [20, 40, 80].map(error);
    let orders = order(&errors);
    assert!(
        orders.iter().all(|o| (o - 2.0).abs() < 0.1),
        "{errors:?} {orders:?}"
    );
    assert!(errors[2] < 1e-4, "{errors:?}");
}

/// Free ends let nothing through: `cos πx` decays as in the continuum, and its mean stays.
#[test]
fn a_bar_without_neighbours_keeps_its_heat() {
    let at = 0.05;
    let error = |n: usize| {
        let mut heat = heat(EXPLICIT);
        heat.initial = vec![("all".into(), text("1 + cos(pi*x)"))];
        let mut sim = built(&still(
            1,
            cells(1, 1.0 / n as f64, [0.0; 3], [1.0; 3]),
            3,
            at,
            heat,
        ));
        run(&mut *sim, 1);
        off(&mut *sim, ALL, |x| {
            1.0 + (PI * x).cos() * (-PI * PI * at).exp()
        })
    };
    let errors = [20, 40, 80].map(error);
    let orders = order(&errors);
    assert!(orders.iter().all(|o| *o > 1.7), "{errors:?} {orders:?}");
}

/// A linear profile is steady, however it is held from two horizons beyond the ends on, on a lattice of any dimension.
#[test]
fn linear_profiles_are_steady() {
    for d in 1..=3 {
        let mut heat = heat(STEADY);
        heat.conditions = ["left", "right"]
            .map(|set| on(set, DiffusionKind::Value(text("5 - 3*x"))))
            .to_vec();
        let body = cells(d, 0.1, [-0.6, 0.0, 0.0], [1.6, 0.5, 0.4]);
        let mut spec = still(d, body, 3, 1.0, heat);
        spec.sets = vec![beyond("left", 0.0, -1.0), beyond("right", 1.0, 1.0)];
        let mut sim = built(&spec);
        run(&mut *sim, 1);
        let off = off(&mut *sim, ALL, |x| 5.0 - 3.0 * x);
        assert!(off < 1e-11, "{d}-D: {off:e}");
    }
}

/// What goes in at one end goes through: the slope in the middle is q/k, in each of two materials their own.
#[test]
fn a_flux_makes_its_slope() {
    // of the distance to ends and faces 38 spacings, the profile feels nothing any more
    for method in [STEADY, EULER] {
        let mut heat = heat(method);
        heat.materials.push(DiffusionMaterial {
            conductivity: 4.0,
            capacity: 1.0,
            expansion: 0.0,
        });
        let value = text("7");
        heat.conditions = vec![
            on("in", DiffusionKind::Flux { value, area: None }),
            on("out", DiffusionKind::Value(text("0"))),
        ];
        let mut spec = still(1, cells(1, 0.025, [0.0; 3], [4.0; 3]), 3, 1e7, heat);
        spec.space.section = 0.3;
        spec.sets = vec![
            beyond("in", 0.025, -1.0),
            beyond("out", 3.9, 1.0),
            beyond("first", 2.0, -1.0),
            beyond("second", 2.0, 1.0),
        ];
        spec.materials = ["first", "second"]
            .map(|set| MaterialSpec {
                name: set.into(),
                set: set.into(),
                ..spec.materials[0].clone()
            })
            .to_vec();
        let mut sim = built(&spec);
        run(&mut *sim, 2);
        let (x, t) = (places(&mut *sim), temperature(&mut *sim));
        let slope = |at: f64| {
            let n = x.iter().position(|x| *x > at).unwrap();
            (t[n + 1] - t[n]) / (x[n + 1] - x[n])
        };
        for (at, k) in [(1.0, 1.0), (3.0, 4.0)] {
            let off = slope(at) * k / -7.0 - 1.0;
            assert!(off.abs() < 1e-8, "{method:?} at {at}: {off:e}");
        }
    }
}

/// A slab between two flows (Carslaw & Jaeger 1959, 3.11; half of it, Bi = h L/k): `Σ 4 sin ζ/(2ζ + sin 2ζ) exp(−ζ² Fo) cos(ζ x)`,
/// `ζ tan ζ = Bi`. The surface is half a spacing beyond the points that give their heat away: the error is of first order.
#[test]
fn a_slab_cools_by_convection_as_biot_says() {
    let (biot, at) = (1.0, 0.4);
    let root = |n: f64| {
        let (mut low, mut high) = (n * PI, n * PI + 0.5 * PI);
        for _ in 0..200 {
            let z: f64 = 0.5 * (low + high);
            match z * z.tan() < biot {
                true => low = z,
                false => high = z,
            }
        }
        0.5 * (low + high)
    };
    let exact = |x: f64| {
        let term = |n: u32| {
            let z = root(f64::from(n));
            4.0 * z.sin() / (2.0 * z + (2.0 * z).sin()) * (-z * z * at).exp() * (z * x).cos()
        };
        (0..8).map(term).sum::<f64>()
    };
    // tables: 0.860333589 (Carslaw & Jaeger, appendix IV)
    assert!((root(0.0) - 0.860_333_589).abs() < 1e-8, "{}", root(0.0));
    let error = |n: usize| {
        let h = 1.0 / n as f64;
        let mut heat = heat(CRANK_NICOLSON);
        heat.initial = vec![("all".into(), text("1"))];
        let law = Exchange::Convection {
            coefficient: text(&format!("{biot}")),
            ambient: text("0"),
        };
        heat.conditions = vec![on("skin", DiffusionKind::Exchange { law, area: None })];
        let mut spec = still(1, cells(1, h, [-1.0; 3], [1.0; 3]), 3, 0.4 / 400.0, heat);
        spec.sets = vec![SetSpec {
            name: "skin".into(),
            members: Members::Where(text(&format!("abs(x) > {}", 1.0 - h))),
        }];
        let mut sim = built(&spec);
        run(&mut *sim, 400);
        off(&mut *sim, ALL, exact)
    };
    let errors = [20, 40, 80].map(error);
    let orders = order(&errors);
    assert!(orders.iter().all(|o| *o > 0.9), "{errors:?} {orders:?}");
    assert!(errors[2] < 0.01, "{errors:?}");
}

/// A small body that radiates into nothing: `dT/dt = −κ T⁴`, `T = T0 (1 + 3 κ T0³ t)^(−1/3)` with `κ = c A/(ρ c V)`.
#[test]
fn a_small_body_radiates_as_stefan_says() {
    let error = |method: DiffusionMethod, steps: u32| {
        let mut heat = heat(method);
        heat.initial = vec![("all".into(), text("2"))];
        let law = Exchange::Radiation {
            coefficient: text("0.5"),
            ambient: text("0"),
        };
        heat.conditions = vec![on(
            "all",
            DiffusionKind::Exchange {
                law,
                area: Some(3.0),
            },
        )];
        // one surface of 3 for a volume of 2
        let mut spec = still(
            1,
            cells(1, 1.0, [0.0; 3], [2.0; 3]),
            1,
            0.5 / f64::from(steps),
            heat,
        );
        spec.space.section = 1.0;
        let mut sim = built(&spec);
        run(&mut *sim, u64::from(steps));
        let kappa = 0.5 * 3.0 / 2.0;
        let exact = 2.0 * (1.0f64 + 3.0 * kappa * 8.0 * 0.5).powf(-1.0 / 3.0);
        off(&mut *sim, ALL, |_| exact) / exact
    };
    for (method, expected) in [(EXPLICIT, 1.0), (EULER, 1.0), (CRANK_NICOLSON, 2.0)] {
        let errors = [250, 500, 1000].map(|n| error(method, n));
        for o in order(&errors) {
            assert!((o - expected).abs() < 0.05, "{method:?}: {errors:?}");
        }
    }
}

/// Every method against steps so short that they no longer matter.
#[test]
fn implicit_steps_have_their_order() {
    let case = |method: DiffusionMethod, steps: u32| {
        let mut heat = heat(method);
        heat.initial = vec![("all".into(), text("cos(pi*x)"))];
        let source = text("sin(5*t)*(1 + x)");
        heat.conditions = vec![
            on("all", DiffusionKind::Source(source)),
            on("left", DiffusionKind::Value(text("1 + t^2"))),
        ];
        let body = cells(1, 0.05, [0.0; 3], [1.0; 3]);
        let mut spec = still(1, body, 3, 0.5 / f64::from(steps), heat);
        spec.sets = vec![beyond("left", 0.1, -1.0)];
        let mut sim = built(&spec);
        run(&mut *sim, u64::from(steps));
        temperature(&mut *sim)
    };
    let fine = case(CRANK_NICOLSON, 3200);
    let from = |t: Vec<f64>| {
        let each = t.iter().zip(&fine).map(|(a, b)| (a - b).abs());
        each.fold(0.0, f64::max)
    };
    for (method, expected) in [(EXPLICIT, 1.0), (EULER, 1.0), (CRANK_NICOLSON, 2.0)] {
        let errors = [200, 400, 800].map(|n| from(case(method, n)));
        for o in order(&errors) {
            assert!((o - expected).abs() < 0.15, "{method:?}: {errors:?}");
        }
    }
}

/// A bar of points with horizons of their own.
fn of_horizons(
    (spacing, end): (f64, f64),
    (longest, own): (f64, Option<&str>),
    heat: DiffusionSpec,
    dt: f64,
) -> Spec {
    let mut spec = still(1, cells(1, spacing, [0.0; 3], [end; 3]), 1, dt, heat);
    spec.bonds.horizon = Horizon::Length(longest);
    spec.bonds.family = FamilyChoice::List;
    spec.bonds.calibration = Calibration::Continuum;
    spec.bonds.partial_volume_correction = true;
    spec.bonds.variable_horizon = own.map(text);
    spec
}

/// Points conduct within their own horizons: as a body of that one where all have it; and where horizons are graded, the profile of a steady bar
/// is off from Fourier's by what `g_ij = k ω (1/m_i + 1/m_j) V_i V_j`, ω the mean of both ends' and m its moment, comes to in NumPy.
#[test]
fn points_conduct_within_their_variable_horizons() {
    let mut warm = heat(EXPLICIT);
    warm.initial = vec![("all".into(), text("sin(0.3*x) + 0.1*x"))];
    let after = |longest: f64, own: Option<&str>| {
        let mut sim = built(&of_horizons((1.0, 30.0), (longest, own), warm.clone(), 0.2));
        run(&mut *sim, 30);
        temperature(&mut *sim)
    };
    let one = after(2.3, None);
    for longest in [2.3, 4.4] {
        for (a, b) in one.iter().zip(after(longest, Some("2.3"))) {
            assert!((a - b).abs() < 1e-12, "{longest}: {a} {b}");
        }
    }
    let mut held = heat(STEADY);
    held.conditions = ["cold", "hot"]
        .map(|set| on(set, DiffusionKind::Value(text("x/40"))))
        .to_vec();
    for (grown, expected) in [(1.0, 3.12628e-3), (0.5, 1.33560e-3)] {
        let graded = format!("2.3 + {grown}*clamp((x - 12)/14, 0, 1)");
        let own = (2.3 + grown, Some(&*graded));
        let mut spec = of_horizons((0.5, 40.0), own, held.clone(), 1.0);
        // deeper than twice the longest horizon: ends are not felt
        spec.sets = vec![beyond("cold", 8.0, -1.0), beyond("hot", 32.0, 1.0)];
        let mut sim = built(&spec);
        run(&mut *sim, 1);
        let off = off(&mut *sim, [0.0, 40.0], |x| x / 40.0);
        assert!((off - expected).abs() < 1e-6, "{grown}: {off:e}");
    }
}
