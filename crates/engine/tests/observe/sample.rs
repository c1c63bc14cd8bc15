//! Bodies that are looked at.

use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

pub fn text(e: &str) -> Option<Expression> {
    Some(Expression::parse(e, &[]).unwrap())
}

pub const PMB: LawSpec = LawSpec::Pmb(PmbStiffness::Young(2.0));
pub const LPS: LawSpec = LawSpec::Lps(Moduli {
    young: 2.0,
    poisson: 0.2,
});

/// Whole spacings `h` from 0 to `n` along each axis; the ends along x are the sets "low" and "high".
pub fn block(n: [u32; 3], d: usize, h: f64, law: LawSpec) -> Spec {
    let kind = [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic][d - 1];
    let body = BodySpec::Lattice {
        kind,
        spacing: h,
        origin: [0.0; 3],
        region: Region::Block {
            low: [0.0; 3],
            high: std::array::from_fn(|a| if a < d { h * f64::from(n[a]) } else { 0.0 }),
        },
        perturb: None,
    };
    let mut spec = Spec::new(d, body, 3.0, law);
    let end = |name: &str, sign: f64, x: f64| SetSpec {
        name: name.into(),
        members: Members::Region(Region::HalfSpace {
            point: [x, 0.0, 0.0],
            normal: [sign, 0.0, 0.0],
        }),
    };
    spec.sets = vec![
        end("low", 1.0, 0.1 * h),
        end("high", -1.0, h * f64::from(n[0]) - 0.1 * h),
    ];
    spec.bonds.horizon = Horizon::Ratio(if d == 3 { 2 } else { 3 });
    spec
}

pub fn statics(spec: &mut Spec, method: Method) {
    spec.run.schedule = Schedule {
        steps: 1,
        time_step: TimeStep::Fixed(1.0),
        force_unstable: false,
        stepper: Stepper::Statics(Statics {
            method,
            ..Statics::default()
        }),
    };
}

pub fn hold(spec: &mut Spec, set: &str, u: [Option<Expression>; 3]) {
    spec.loading.conditions.push(ConditionSpec {
        set: set.into(),
        kind: ConditionKind::Displacement(u),
    });
}

pub fn push(spec: &mut Spec, set: &str, force: [Option<Expression>; 3]) {
    spec.loading.conditions.push(ConditionSpec {
        set: set.into(),
        kind: ConditionKind::BodyForce(force),
    });
}

pub fn probe(spec: &mut Spec, name: &str, set: &str, measure: Measure) {
    spec.run.probes.push(ProbeSpec {
        name: name.into(),
        set: set.into(),
        measure,
    });
}

pub fn made(spec: &Spec) -> Box<dyn Simulation> {
    let options = Options {
        trust_time_step: matches!(spec.run.schedule.time_step, TimeStep::Fixed(_)),
        ..Options::default()
    };
    let mut sim = build(spec, options).unwrap();
    sim.start(true);
    sim
}

pub fn run(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = made(spec);
    for _ in 0..spec.run.schedule.steps {
        sim.step().unwrap();
    }
    sim
}

/// What a probe's column shows now.
pub fn shown(sim: &mut dyn Simulation, column: &str) -> f64 {
    let columns = sim.probe_columns();
    let place = columns.iter().position(|c| c.name == column);
    sim.measure()[place.unwrap_or_else(|| panic!("{column} in {columns:?}"))]
}
