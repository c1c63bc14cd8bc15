//! An absorbing layer against the wave equation in it.

use peridyne::expression::Expression;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;
use std::f64::consts::PI;

const LONG: usize = 1200;
const WAVE: f64 = 40.0;
/// Of the packet.
const WIDTH: f64 = 1.5 * WAVE;

struct Layer {
    reflection: f64,
    exponent: f64,
    thick: f64,
}

impl Layer {
    /// Puts it at the end of a body of so many spacings along x, whose waves have speed 1.
    fn put(&self, spec: &mut Spec, long: usize) {
        let begin = long as f64 - 0.5 - self.thick;
        spec.sets = vec![SetSpec {
            name: "layer".into(),
            members: Members::Region(Region::HalfSpace {
                point: [begin, 0.0, 0.0],
                normal: [-1.0, 0.0, 0.0],
            }),
        }];
        let numbers = [
            ("speed", 1.0),
            ("reflection", self.reflection),
            ("exponent", self.exponent),
        ];
        let toward = Parameter::Word("x+".into());
        let constants = Parameters::numbers(&numbers).with("toward", toward);
        spec.loading.conditions = vec![ConditionSpec {
            set: "layer".into(),
            kind: ConditionKind::force("absorbing_layer", constants),
        }];
    }
}

fn text(e: String) -> Option<Expression> {
    Some(Expression::parse(&e, &[]).unwrap())
}

/// The part of the energy that is left after a time, of waves of this frequency (1 / time, times 2π).
fn left_after(spec: &Spec, time: f64, frequency: f64, step: f64) -> f64 {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    let start = sim.ledger().unwrap();
    for _ in 0..(time / step) as usize {
        sim.step().unwrap();
    }
    let end = sim.ledger().unwrap();
    let before = start.kinetic + start.strain;
    // what is gone was taken by the layer, but for (ωΔt)²/8 by which a wave's energy is another one in velocity Verlet
    let missing = 1.2 * (frequency * step).powi(2) / 8.0;
    assert!(end.residual().abs() < missing * before, "{end:?}");
    (end.kinetic + end.strain) / before
}

/// The part of the energy of a packet that is left when it has met the layer: a chain of unit masses and springs.
fn left(layer: &Layer, stepper: Stepper, step: f64) -> f64 {
    let high = [LONG as f64 - 1.0, 0.0, 0.0];
    let bar = Region::Block {
        low: [0.0; 3],
        high,
    };
    let body = BodySpec::lattice(LatticeKind::Chain, 1.0, bar);
    let law = LawSpec::Springs(PmbStiffness::Micromodulus(1.0));
    let mut spec = Spec::new(1, body, 1.0, law);
    layer.put(&mut spec, LONG);
    let k = 2.0 * PI / WAVE;
    // as fast as a chain carries waves of this length
    let speed = 2.0 * (0.5 * k).sin() / k;
    let shape = format!("exp(-((x-500)/{WIDTH})^2)");
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [text(format!("{shape}*cos({k}*(x-500))")), None, None],
        velocity: [
            text(format!(
                "{speed}*{shape}*(2*(x-500)/{WIDTH}^2*cos({k}*(x-500)) + {k}*sin({k}*(x-500)))"
            )),
            None,
            None,
        ],
    }];
    spec.run.schedule.stepper = stepper;
    spec.run.schedule.time_step = TimeStep::Fixed(step);
    left_after(&spec, 1500.0, k, step)
}

/// A square lattice of unit masses, so many across the period, each pulled back to its neighbours with 1 along every axis: every component is
/// a scalar that obeys the wave equation.
fn membrane(long: usize, rows: usize) -> LinearBody<2> {
    let mut body = LinearBody {
        period: [None, Some(rows as f64)],
        ..LinearBody::nothing()
    };
    for n in 0..long * rows {
        let (i, j) = (n / rows, n % rows);
        body.position.push([i as f64, j as f64]);
        body.volume.push(1.0);
        body.density.push(1.0);
        let across = [(j + 1) % rows, (j + rows - 1) % rows].map(|j| i * rows + j);
        let along = [i.checked_sub(1), (i + 1 < long).then_some(i + 1)];
        let along = along.into_iter().flatten().map(|i| i * rows + j);
        let mut partners: Vec<u32> = along.chain(across).map(|n| n as u32).collect();
        partners.sort_unstable();
        body.block
            .extend(partners.iter().map(|_| [[1.0, 0.0], [0.0, 1.0]]));
        body.partner.extend(partners);
        body.start.push(body.partner.len());
    }
    body
}

/// The same as [`left`] of waves that go obliquely, one wave length across the period, and once along [`WAVE`].
fn oblique(layer: &Layer, rows: usize) -> f64 {
    let long = 800;
    let mut spec = Spec::of_linear(&membrane(long, rows));
    if let BodySpec::Cloud(cloud) = &mut spec.body {
        cloud.spacing = Some(1.0);
    }
    layer.put(&mut spec, long);
    let [k, across] = [WAVE, rows as f64].map(|length| 2.0 * PI / length);
    // frequency and speed of groups of the lattice
    let frequency = 2.0 * (0.5 * k).sin().hypot((0.5 * across).sin());
    let speed = k.sin() / frequency;
    let shape = format!("exp(-((x-300)/{WIDTH})^2)");
    let phase = format!("({k}*(x-300) + {across}*y)");
    let moves =
        format!("{shape}*({speed}*2*(x-300)/{WIDTH}^2*cos({phase}) + {frequency}*sin({phase}))");
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [None, text(format!("{shape}*cos({phase})")), None],
        velocity: [None, text(moves), None],
    }];
    let step = 0.4;
    spec.run.schedule.time_step = TimeStep::Fixed(step);
    let time = 950.0 * k.hypot(across) / k;
    left_after(&spec, time, frequency, step)
}

/// The same of the wave equation `u″ + (k² + i ω c(d)) u = 0` in the layer, whose end is free, for every k of the packet: `r = (ik − y)/(ik + y)`
/// with `y = u′/u` where the layer begins; `ω² = k² + k_y²` where waves go with k_y along the layer, too.
fn reflected(layer: &Layer, across: f64) -> f64 {
    let Layer {
        reflection,
        exponent,
        thick,
    } = *layer;
    let most = (exponent + 1.0) * (1.0 / reflection).ln() / thick;
    let k0 = 2.0 * PI / WAVE;
    let [mut sum, mut all] = [0.0; 2];
    for n in 0..121 {
        let k = k0 + 6.0 / WIDTH * (f64::from(n) / 60.0 - 1.0);
        let frequency = k.hypot(across);
        // (u, u′), real and imaginary parts, from the end inward
        let slope = |d: f64, z: [f64; 4]| {
            let c = frequency * most * (d.max(0.0) / thick).powf(exponent);
            [
                z[2],
                z[3],
                -k * k * z[0] + c * z[1],
                -k * k * z[1] - c * z[0],
            ]
        };
        let steps = 4000;
        let h = thick / f64::from(steps);
        let mut z = [1.0, 0.0, 0.0, 0.0];
        for m in 0..steps {
            let d = thick - h * f64::from(m);
            let at = |by: f64, s: [f64; 4]| std::array::from_fn(|a| z[a] - by * s[a]);
            let first = slope(d, z);
            let second = slope(d - 0.5 * h, at(0.5 * h, first));
            let third = slope(d - 0.5 * h, at(0.5 * h, second));
            let fourth = slope(d - h, at(h, third));
            z = std::array::from_fn(|a| {
                z[a] - h / 6.0 * (first[a] + 2.0 * (second[a] + third[a]) + fourth[a])
            });
        }
        // |ik u − u′|² / |ik u + u′|²
        let size = |sign: f64| (sign * z[2] - k * z[1]).powi(2) + (sign * z[3] + k * z[0]).powi(2);
        let part = size(-1.0) / size(1.0);
        let weight = (frequency * (-((k - k0) * WIDTH / 2.0).powi(2)).exp()).powi(2);
        sum += weight * part;
        all += weight;
    }
    sum / all
}

#[test]
fn what_comes_back_is_what_the_wave_equation_says_and_nearly_what_was_asked_for() {
    let layers = [(0.1, 2.0, 200.0), (0.03, 3.0, 200.0), (0.1, 1.0, 40.0)];
    for (reflection, exponent, thick) in layers {
        let layer = Layer {
            reflection,
            exponent,
            thick,
        };
        let exact = reflected(&layer, 0.0);
        let explicit = left(&layer, Stepper::Verlet, 0.25);
        println!(
            "R = {reflection}, n = {exponent}, {thick} spacings: {explicit:.3e} of the energy, by the wave equation {exact:.3e}"
        );
        assert!((explicit / exact - 1.0).abs() < 0.03, "{explicit} {exact}");
        // thick layers do what the profile was made for
        if thick > 2.0 * WAVE {
            let asked = reflection * reflection;
            assert!((explicit / asked - 1.0).abs() < 0.1, "{explicit} {asked}");
        }
    }
}

/// A wave that goes obliquely stays longer in the layer: of what is long before it comes out, `R^(1/cos θ)` is left.
#[test]
fn oblique_waves_are_absorbed_as_the_wave_equation_says() {
    for (reflection, exponent, thick, rows) in [
        (0.1, 2.0, 200.0, 40),
        (0.3, 2.0, 200.0, 24),
        (0.1, 1.0, 40.0, 40),
    ] {
        let layer = Layer {
            reflection,
            exponent,
            thick,
        };
        let [k, across] = [WAVE, rows as f64].map(|length| 2.0 * PI / length);
        let exact = reflected(&layer, across);
        let found = oblique(&layer, rows);
        println!(
            "R = {reflection}, n = {exponent}, {thick} spacings, {rows} rows: {found:.3e} of the energy, by the wave equation {exact:.3e}"
        );
        assert!((found / exact - 1.0).abs() < 0.03, "{found} {exact}");
        if thick > 2.0 * WAVE {
            let asked = reflection.powf(2.0 * k.hypot(across) / k);
            assert!((found / asked - 1.0).abs() < 0.1, "{found} {asked}");
        }
    }
}

#[test]
fn implicit_steps_absorb_as_explicit_ones() {
    let layer = Layer {
        reflection: 0.1,
        exponent: 2.0,
        thick: 200.0,
    };
    let implicit = left(&layer, Stepper::Newmark(Newmark::default()), 1.0);
    let exact = reflected(&layer, 0.0);
    assert!((implicit / exact - 1.0).abs() < 0.05, "{implicit} {exact}");
}

#[test]
fn a_layer_says_what_does_not_fit() {
    let bar = Region::Block {
        low: [0.0; 3],
        high: [9.0, 0.0, 0.0],
    };
    let body = BodySpec::lattice(LatticeKind::Chain, 1.0, bar);
    let law = LawSpec::Springs(PmbStiffness::Micromodulus(1.0));
    let mut spec = Spec::new(1, body, 1.0, law);
    let word = |w: &str| Parameter::Word(w.into());
    let tries = [
        (Parameters::numbers(&[("speed", 1.0)]), "toward", "needs"),
        (
            Parameters::numbers(&[("speed", 1.0)]).with("toward", word("y+")),
            "toward",
            "dimension of the body is 1",
        ),
        (
            Parameters::numbers(&[("speed", -1.0)]).with("toward", word("x+")),
            "speed",
            "positive",
        ),
        (
            Parameters::numbers(&[("speed", 1.0), ("reflection", 1.0)]).with("toward", word("x+")),
            "reflection",
            "below 1",
        ),
    ];
    for (constants, key, message) in tries {
        spec.loading.conditions = vec![ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::force("absorbing_layer", constants),
        }];
        let error = build(&spec, Options::default()).err().unwrap();
        assert_eq!(error.path, format!("conditions[0].{key}"));
        assert!(error.message.contains(message), "{error}");
    }
}
