//! Heat through contact: of flat faces, of bodies warm throughout, while bodies part.

use crate::sample::*;
use peridyne::run::Simulation;
use peridyne::spec::*;

/// Two blocks of 0.7 by 0.7 face to face in y, the mean of both spacings between their first layers of points; the upper one has another spacing. Thickness 0.3.
fn pressed(upper: f64, conductivity: f64, conductance: f64, dt: f64) -> Spec {
    let body = |h: f64, low: [f64; 3], high: [f64; 3]| {
        let mut body = cells(2, h, low, high);
        if let BodySpec::Lattice { origin, .. } = &mut body {
            *origin = [low[0] + 0.5 * h, low[1] + 0.5 * h, 0.0];
        }
        body
    };
    let low = 0.65 + 0.5 * (0.1 + upper) - 0.5 * upper;
    let pieces = vec![
        PieceSpec::new("lower", body(0.1, [0.0; 3], [0.7, 0.7, 0.0])),
        PieceSpec::new("upper", body(upper, [0.0, low, 0.0], [0.7, low + 0.7, 0.0])),
    ];
    let mut heat = heat(EXPLICIT);
    heat.materials[0].conductivity = conductivity;
    heat.initial = vec![("upper".into(), text("1"))];
    let mut spec = still(2, BodySpec::Several(pieces), 2, dt, heat);
    spec.section = 0.3;
    spec.horizon = Horizon::Length(0.21);
    spec.sets = vec![SetSpec {
        name: "upper".into(),
        members: Members::Within {
            body: "upper".into(),
            members: Box::new(Members::All),
        },
    }];
    spec.contact = Some(ContactSpec {
        bonded: 0.9,
        free: 1.35,
        stiffness: ContactStiffness::Laws,
        friction: None,
        conductance: Some(conductance),
    });
    spec
}

fn crossed(sim: &dyn Simulation) -> f64 {
    sim.transfers()[0].1.through_contact
}

/// `h_c A ΔT` to the last digits, whether points stand face to face or their lattices do not match.
#[test]
fn flat_faces_exchange_by_their_area() {
    for upper in [0.1, 0.07] {
        let dt = 1e-6;
        let mut sim = built(&pressed(upper, 1e-3, 2.0, dt));
        run(&mut *sim, 1);
        let expected = 2.0 * (0.7 * 0.3) * dt;
        let off = crossed(&*sim) / expected - 1.0;
        assert!(off.abs() < 1e-12, "{upper}: {off:e}");
    }
}

/// Two bodies, warm throughout: ΔT falls as `exp(−h_c A (1/C₁ + 1/C₂) t)`, within the Biot number `h_c L/k`; no heat is lost.
#[test]
fn small_bodies_even_out_exponentially() {
    for upper in [0.1, 0.07] {
        let mut sim = built(&pressed(upper, 40.0, 0.4, 0.02));
        run(&mut *sim, 20);
        let t = temperature(&mut *sim);
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let difference = mean(&t[49..]) - mean(&t[..49]);
        let rate = 0.4 * 2.0 / 0.7;
        let exact = (-rate * sim.time()).exp();
        assert!(exact < 0.7);
        let biot = 0.4 * 0.7 / 40.0;
        let off = difference / exact - 1.0;
        assert!(off.abs() < biot, "{upper}: {off:e}, Biot {biot:e}");
        let account = sim.transfers()[0].1;
        assert!(account.residual().abs() < 1e-13 * account.initial);
        // all that the upper one lost
        let lost = (1.0 - mean(&t[49..])) * 0.7 * 0.7 * 0.3;
        assert!((account.through_contact / lost - 1.0).abs() < 1e-10);
    }
}

/// A conductance that alone would allow only shorter steps makes no new extremes.
#[test]
fn steps_know_the_contact() {
    let mut sim = built(&pressed(0.07, 1e-3, 1e3, 1e-2));
    for _ in 0..20 {
        run(&mut *sim, 1);
        let t = temperature(&mut *sim);
        assert!(t.iter().all(|t| (-1e-12..=1.0 + 1e-12).contains(t)));
    }
    assert!(crossed(&*sim) > 0.0);
}

#[test]
fn threads_do_not_show_in_contact() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            // more points than a piece of work has
            let mut spec = pressed(0.0125, 1.0, 2.0, 1e-5);
            spec.horizon = Horizon::Length(0.11);
            let mut sim = built(&spec);
            run(&mut *sim, 3);
            let all = temperature(&mut *sim);
            assert!(all.len() > 3000 && crossed(&*sim) > 0.0);
            all.iter().map(|t| t.to_bits()).collect::<Vec<_>>()
        })
    };
    assert!(on(1) == on(3) && on(2) == on(4));
}

/// A body that flies away takes heat along until it is out of reach, and none after that.
#[test]
fn what_is_apart_exchanges_nothing() {
    let mut spec = pressed(0.1, 1.0, 5.0, 1e-3);
    spec.schedule.stepper = Stepper::Verlet;
    spec.initial = vec![InitialSpec {
        set: "upper".into(),
        displacement: [None, None, None],
        velocity: [None, Some(text("1")), None],
    }];
    let mut sim = built(&spec);
    run(&mut *sim, 20);
    let near = crossed(&*sim);
    assert!(near > 0.0);
    run(&mut *sim, 20);
    let gone = crossed(&*sim);
    assert!(gone > near);
    run(&mut *sim, 40);
    assert_eq!(crossed(&*sim).to_bits(), gone.to_bits());
    let account = sim.transfers()[0].1;
    assert!(account.residual().abs() < 1e-13 * account.initial);
}
