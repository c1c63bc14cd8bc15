//! The same bits for any number of threads and every instruction set; no allocation per step.

use crate::allocations;
use crate::sample::*;
use peridyne::execute::simd::Simd;
use peridyne::run::{Options, Simulation};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

/// A breaking, touching body under everything that may act, with several blocks of work.
fn busy(name: &str, kind: LatticeKind, family: FamilyChoice) -> Spec {
    let place = match kind.dimension() {
        1 => Place {
            kind,
            plane: Plane::Stress,
            ratio: 3,
            cells: [600, 1, 1],
        },
        2 => Place {
            kind,
            plane: Plane::Stress,
            ratio: 3,
            cells: [36, 24, 1],
        },
        _ => Place {
            kind,
            plane: Plane::Stress,
            ratio: 2,
            cells: [12, 10, 8],
        },
    };
    let case = Case::of(name, place);
    let mut spec = case.spec();
    spec.bonds.family = family;
    breaking(&mut spec, 0.02);
    spec.interactions.contact = Some(CONTACT);
    spec.run.schedule.time_step = TimeStep::Fixed(0.05 * H);
    // on a line it comes from the end
    let (x, y) = match kind.dimension() {
        1 => ("-0.8+0.1*t".to_string(), "0.2"),
        _ => (format!("{}", 0.5 * H * place.cells[0] as f64), "-0.9+0.5*t"),
    };
    spec.loading.rigid_bodies = vec![RigidBodySpec::sphere(
        100.0,
        2.0 * H,
        RigidBodyMotion::Kinematic([e(&x), e(y), e("0.3")]),
    )];
    spec.loading.conditions = vec![
        ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::Damping(e("0.01")),
        },
        ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::BodyForce([Some(e("0.1*sin(t+x)")), None, None]),
        },
    ];
    spec
}

fn state(sim: &mut dyn Simulation) -> Vec<u64> {
    let l = sim.ledger().unwrap();
    let numbers = [
        l.kinetic,
        l.strain,
        l.contact,
        l.released,
        l.dissipated,
        l.work_boundary_conditions,
        l.work_rigid_bodies,
    ];
    let mut bits: Vec<u64> = numbers.iter().map(|x| x.to_bits()).collect();
    for field in [
        sim.displacements(),
        sim.velocities(),
        sim.vectors("force_density"),
    ] {
        bits.extend(field.iter().flatten().map(|c| c.to_bits()));
    }
    for field in [
        sim.scalars("damage"),
        sim.scalars("critical_stretch"),
        sim.scalars("energy_density"),
    ] {
        bits.extend(field.iter().map(|c| c.to_bits()));
    }
    let hash = sim.state_hash();
    bits.extend([sim.broken(), sim.fragments(), hash.state]);
    bits.extend(hash.ledger);
    bits
}

/// Laws of every kind of loop that live on a lattice.
fn names(kind: LatticeKind) -> Vec<&'static str> {
    let mut names = vec![
        "pmb",
        "pmb mixed",
        "lps",
        "lps mixed",
        "viscoelastic mixed",
        "softening",
    ];
    if kind != LatticeKind::Chain {
        names.extend(["correspondence", "neo-hookean mixed", "laminae"]);
    }
    if kind == LatticeKind::Cubic {
        names.extend([
            "elastic-plastic",
            "plastic mixed",
            "hypoelastic",
            "metal and soil",
        ]);
    }
    names
}

#[test]
fn the_same_bits_on_any_number_of_threads_and_in_every_width() {
    for kind in [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic] {
        for name in names(kind) {
            for family in [FamilyChoice::Stencil, FamilyChoice::List] {
                let spec = busy(name, kind, family);
                let run = |threads: usize, simd: Simd| {
                    let pool = rayon::ThreadPoolBuilder::new()
                        .num_threads(threads)
                        .build()
                        .unwrap();
                    pool.install(|| {
                        let options = Options {
                            simd: Some(simd),
                            trust_time_step: true,
                        };
                        let mut sim = build(&spec, options).unwrap();
                        let n = sim.vectors("reference").len();
                        // waves on a line come together less
                        let speed = if spec.space.dimension == 1 { 0.4 } else { 0.1 };
                        let v = Random(47).vectors(n, spec.space.dimension, speed);
                        sim.set_velocities(&v);
                        sim.start(true);
                        steps(sim.as_mut(), 25);
                        assert!(sim.broken() > 0 && sim.broken() < sim.info().directed_bonds);
                        let l = sim.ledger().unwrap();
                        assert!(
                            l.contact > 0.0 && l.work_rigid_bodies != 0.0,
                            "{name} {kind:?}: {l:?}"
                        );
                        state(sim.as_mut())
                    })
                };
                let widest = Simd::detect();
                let first = run(1, widest);
                for threads in [2, 3, 7] {
                    assert!(
                        run(threads, widest) == first,
                        "{name} {kind:?} {family:?}: {threads} threads"
                    );
                }
                for simd in Simd::available() {
                    assert!(
                        run(1, simd) == first,
                        "{name} {kind:?} {family:?}: {}",
                        simd.name()
                    );
                }
            }
        }
    }
}

#[test]
fn a_step_allocates_nothing() {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    for kind in [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic] {
        for name in names(kind) {
            for family in [FamilyChoice::Stencil, FamilyChoice::List] {
                let mut spec = busy(name, kind, family);
                // the rigid_body rests in the body: what it touches does not grow
                let x = e(if kind.dimension() == 1 { "-0.7" } else { "1.3" });
                spec.loading.rigid_bodies[0].motion =
                    RigidBodyMotion::Kinematic([x, e("-0.2"), e("0.3")]);
                pool.install(|| {
                    let mut sim = at_rest(&spec);
                    // an energy with a pole at no volume ends with an error once a family is pushed flat
                    let pole = name.starts_with("neo") && kind == LatticeKind::Square;
                    sim.set_time_step(if pole { 0.028 } else { 0.05 } * H);
                    let n = sim.vectors("reference").len();
                    let v = Random(47).vectors(n, spec.space.dimension, 0.05);
                    sim.set_velocities(&v);
                    sim.start(true);
                    // lists of what is near grow to their size
                    steps(sim.as_mut(), 100);
                    let broken = sim.broken();
                    let before = allocations();
                    steps(sim.as_mut(), 40);
                    let count = allocations() - before;
                    assert_eq!(count, 0, "{name} {kind:?} {family:?}");
                    assert!(sim.broken() > broken, "{name} {kind:?}: nothing happened");
                    assert!(sim.ledger().unwrap().work_rigid_bodies != 0.0);
                    // the count is of this very thread
                    let before = allocations();
                    std::hint::black_box(sim.displacements());
                    assert!(allocations() > before);
                });
            }
        }
    }
}
