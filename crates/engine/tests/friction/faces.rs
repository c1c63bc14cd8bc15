//! Friction of the faces of a crack, in motion.

use super::{square, text};
use peridyne::run::{Options, build};
use peridyne::space::region::Region;
use peridyne::spec::*;

/// A block that is cut across, whose upper half is thrown at its lower one and along it.
fn halves(law: LawSpec, friction: Option<FrictionSpec>, family: FamilyChoice) -> Spec {
    let mut spec = Spec::new(2, square(1.0, [0.5, 0.5, 0.0], [8.6, 7.6, 0.0]), 1.0, law);
    spec.bonds.family = family;
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.interactions.contact = Some(ContactSpec {
        bonded: 0.9,
        free: 1.35,
        stiffness: ContactStiffness::Laws,
        friction,
        cohesion: None,
        conductance: None,
    });
    spec.damage.precracks.push(PrecrackSpec {
        shape: CrackShape::Segment {
            from: [-1.0, 4.0, 0.0],
            to: [10.0, 4.0, 0.0],
        },
        kind: CrackKind::Broken,
    });
    spec.sets.push(SetSpec {
        name: "upper".into(),
        members: Members::Region(Region::HalfSpace {
            point: [0.0, 4.0, 0.0],
            normal: [0.0, -1.0, 0.0],
        }),
    });
    spec.loading.initial = vec![InitialSpec {
        set: "upper".into(),
        // faces that just touch
        displacement: [None, text("-0.0999"), None],
        velocity: [text("0.1"), text("-0.4"), None],
    }];
    spec.run.schedule.time_step = TimeStep::Fraction(0.1);
    spec
}

/// Momentum over mass of the upper half and of all, energies, and what was rubbed off.
fn run(spec: &Spec) -> ([[f64; 2]; 2], f64, f64) {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    let initial = sim.ledger().unwrap().initial;
    while sim.time() < 0.2 {
        sim.step().unwrap();
        let l = sim.ledger().unwrap();
        assert!(l.residual().abs() < 2e-3 * initial, "{l:?}");
    }
    let v = sim.velocities();
    let upper = sim.members("upper").unwrap();
    let mean = |ids: &[u32]| {
        let sum = |a: usize| ids.iter().map(|i| v[*i as usize][a]).sum::<f64>();
        [0, 1].map(|a| sum(a) / ids.len() as f64)
    };
    let all: Vec<u32> = (0..v.len() as u32).collect();
    let dissipated = sim.ledger().unwrap().dissipated;
    ([mean(&upper), mean(&all)], dissipated, initial)
}

fn laws() -> [(LawSpec, FamilyChoice); 4] {
    let pmb = || LawSpec::Pmb(PmbStiffness::Young(1e4));
    let lps = || {
        LawSpec::Lps(Moduli {
            young: 1e4,
            poisson: 0.25,
        })
    };
    [
        (pmb(), FamilyChoice::Auto),
        (pmb(), FamilyChoice::List),
        (lps(), FamilyChoice::Auto),
        (lps(), FamilyChoice::List),
    ]
}

#[test]
fn faces_of_a_crack_slow_each_other() {
    for (law, family) in laws() {
        let free = run(&halves(law.clone(), None, family));
        let rubbed = run(&halves(law, Some(FrictionSpec::constant(0.1)), family));
        println!("{free:?}\n{rubbed:?}");
        for ([_, all], ..) in [&free, &rubbed] {
            // the half goes with the whole: momentum is kept
            assert!((all[0] - 0.05).abs() < 1e-14, "{all:?}");
            assert!((all[1] + 0.2).abs() < 1e-14, "{all:?}");
        }
        assert_eq!(free.1, 0.0);
        let initial = rubbed.2;
        assert!(rubbed.1 > 1e-4 * initial, "{rubbed:?}");
        // it loses at most μ of the impulse that turned it back
        let [[vx, vy], _] = rubbed.0;
        let [[wx, _], _] = free.0;
        let most = 0.1 * (vy + 0.4);
        assert!(
            wx - vx > 0.7 * most && wx - vx < 1.1 * most,
            "{wx} {vx} {most}"
        );
    }
}

#[test]
fn faces_rub_with_the_same_bits_on_any_number_of_threads() {
    let (law, family) = laws()[2].clone();
    let spec = halves(law, Some(FrictionSpec::constant(0.1)), family);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new();
        pool.num_threads(threads)
            .build()
            .unwrap()
            .install(|| run(&spec))
    };
    assert_eq!(on(1), on(3));
}
