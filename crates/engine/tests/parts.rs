//! Steps in parts: bonds of laws of deformation gradients are the stiffer the shorter they are.

use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn text(e: &str) -> Expression {
    Expression::parse(e, &[]).unwrap()
}

fn rows(low: f64, high: f64) -> Members {
    Members::Region(Region::Block {
        low: [f64::NEG_INFINITY, f64::NEG_INFINITY, low],
        high: [f64::INFINITY, f64::INFINITY, high],
    })
}

/// A cube of rubber or metal of 5 × 5 × 5 points, whose lid comes down by half of the height and more.
fn squeezed(law: &str, gradient: &str, depth: f64) -> Spec {
    let body = BodySpec::Lattice {
        kind: LatticeKind::Cubic,
        spacing: 1.0,
        origin: [0.0; 3],
        region: Region::Block {
            low: [0.0; 3],
            high: [4.0; 3],
        },
        perturb: None,
    };
    let mut numbers = Parameters::numbers(&[("young", 1.0), ("poisson", 0.3)])
        .with("gradient", Parameter::Word(gradient.into()));
    match law {
        "correspondence" => numbers.set("stress", Parameter::Word("neo_hookean".into())),
        _ => numbers.set("yield_stress", Parameter::Number(0.05)),
    }
    let mut spec = Spec::new(3, body, 1.0, LawSpec::named(law, numbers));
    spec.bonds.horizon = Horizon::Ratio(2);
    spec.sets = [("foot", rows(-0.5, 0.5)), ("lid", rows(3.5, 4.5))]
        .map(|(name, members)| SetSpec {
            name: name.into(),
            members,
        })
        .to_vec();
    let held = |set: &str, u: &str| ConditionSpec {
        set: set.into(),
        kind: ConditionKind::Displacement([None, None, Some(text(u))]),
    };
    spec.loading.conditions = vec![
        held("foot", "0"),
        held("lid", &format!("-{depth}*min(t/40, 1)^2")),
    ];
    spec
}

/// Just before the lid stops.
const LATE: f64 = 36.0;

/// A run to a time: the part of the work that the balance misses, in how many parts steps were done.
fn end(spec: &Spec, until: f64) -> (f64, u32, Box<dyn Simulation>) {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    while sim.time() < until {
        sim.step().unwrap();
    }
    let l = sim.ledger().unwrap();
    let parts = sim.info().parts;
    (l.residual().abs() / l.work_boundary_conditions, parts, sim)
}

fn apart(a: &mut dyn Simulation, b: &mut dyn Simulation) -> f64 {
    let (a, b) = (a.displacements(), b.displacements());
    let both = a.iter().flatten().zip(b.iter().flatten());
    both.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

const CASES: [(&str, &str, f64); 3] = [
    ("hypoelastic_plastic", "bond", 2.5),
    ("correspondence", "bond", 2.5),
    ("correspondence", "family", 2.5),
];

/// The balance is kept in parts, step after step, and the state is that of short whole steps at the same time.
#[test]
fn a_block_that_is_squeezed_keeps_its_balance() {
    for (law, gradient, depth) in CASES {
        let spec = squeezed(law, gradient, depth);
        let (missed, parts, mut sim) = end(&spec, LATE);
        assert!(parts >= 2, "{law} {gradient}: {parts}");
        let mut short = spec.clone();
        // whole numbers of short steps: both end at the same time
        short.run.schedule.time_step = TimeStep::Fixed(sim.info().time_step / 8.0);
        let (fine, whole, mut reference) = end(&short, sim.time() - 1e-9);
        assert_eq!(whole, 1);
        assert!(
            (sim.time() - reference.time()).abs() < 1e-9,
            "{law} {gradient}"
        );
        let off = apart(sim.as_mut(), reference.as_mut());
        println!(
            "{law} {gradient}: {parts} parts, misses {missed:.1e}, whole short steps {fine:.1e}, {off:.1e} apart"
        );
        assert!(missed < 1e-3, "{law} {gradient}: {missed}");
        assert!(off < 0.02, "{law} {gradient}: {off}");
    }
}

/// Longer steps are done in more parts, and the balance holds with each.
#[test]
fn any_fraction_of_the_stable_step_holds() {
    let missed = [0.8, 0.4, 0.2].map(|fraction| {
        let mut spec = squeezed("correspondence", "bond", 3.0);
        spec.run.schedule.time_step = TimeStep::Fraction(fraction);
        let (missed, parts, sim) = end(&spec, LATE);
        println!(
            "{fraction}: {parts} parts, misses {missed:.2e} at {}",
            sim.time()
        );
        (missed, parts)
    });
    assert!(missed[0].1 > 2 && missed[1].1 > 1, "{missed:?}");
    assert!(missed.iter().all(|m| m.0 < 1e-3), "{missed:?}");
    assert!(missed[2].0 < missed[0].0, "{missed:?}");
}

/// Where nothing becomes shorter no bit is another, and parts have the same bits on any number of threads.
#[test]
fn parts_are_seen_where_they_are_needed_alone() {
    let little = squeezed("correspondence", "bond", 0.2);
    let mut given = little.clone();
    let (_, parts, mut sim) = end(&little, LATE);
    assert_eq!(parts, 1);
    given.run.schedule.time_step = TimeStep::Fixed(sim.info().time_step);
    assert_eq!(sim.displacements(), end(&given, LATE).2.displacements());
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new();
        let pool = pool.num_threads(threads).build().unwrap();
        pool.install(|| {
            let (_, parts, mut sim) = end(&squeezed("correspondence", "bond", 2.5), LATE);
            assert!(parts > 1);
            (sim.displacements(), sim.velocities(), sim.time())
        })
    };
    assert_eq!(run(1), run(3));
}
