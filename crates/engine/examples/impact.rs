//! Algorithm 7 through the library: `cargo run --release --example impact [steps] [pmb|lps]`.
use peridyne::expression::Expression;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

fn main() {
    let steps: u64 = std::env::args().nth(1).map_or(200, |s| s.parse().unwrap());
    let lps = std::env::args().nth(2).is_some_and(|m| m == "lps");
    let mut quarters = vec![];
    for z in -74..=74i32 {
        for y in -5..=0 {
            for x in -74..=74i32 {
                // the eight points that round-off drops in LAMMPS
                if x * x + z * z <= 74 * 74 && ![(24, 70), (70, 24)].contains(&(x.abs(), z.abs())) {
                    quarters.push([4 * x, 4 * y, 4 * z]);
                }
            }
        }
    }
    let e = |s: &str| Expression::parse(s, &[]).unwrap();
    let spec = Spec {
        title: "impact".into(),
        space: SpaceSpec::default(),
        body: BodySpec::Sites {
            kind: LatticeKind::Cubic,
            spacing: 0.0005,
            origin: [0.0; 3],
            quarters,
            volume: Some(1.25e-10),
        },
        sets: vec![],
        materials: vec![MaterialSpec {
            name: "glass".into(),
            set: "all".into(),
            density: 2200.0,
            law: if lps {
                LawSpec::Lps3d {
                    bulk: 14.9e9,
                    shear: 6e9,
                }
            } else {
                LawSpec::Pmb(PmbStiffness::Micromodulus(1.6863e22))
            },
            fracture: Some(FractureSpec {
                criterion: Criterion::Stretch(0.0005),
                alpha: 0.25,
                rate: None,
                fatigue: None,
            }),
        }],
        bonds: BondsSpec {
            horizon: Horizon::Length(0.0015001),
            partial_volume_correction: true,
            calibration: Calibration::Continuum,
            influence: if lps {
                Influence::Inverse
            } else {
                Influence::Constant
            },
            ..BondsSpec::default()
        },
        interactions: InteractionsSpec {
            contact: Some(ContactSpec {
                bonded: 0.9,
                free: 1.35,
                stiffness: ContactStiffness::Laws,
                friction: None,
                cohesion: None,
                conductance: None,
            }),
            ..InteractionsSpec::default()
        },
        damage: DamageSpec {
            breakage: Breakage::AfterForce,
            ..DamageSpec::default()
        },
        loading: LoadingSpec {
            rigid_bodies: vec![RigidBodySpec::sphere(
                1e17,
                0.005,
                RigidBodyMotion::Kinematic([e("0"), e("0.0051-100*t"), e("0")]),
            )],
            ..LoadingSpec::default()
        },
        run: RunSpec {
            schedule: Schedule {
                steps,
                time_step: TimeStep::Fixed(1e-7),
                ..Schedule::default()
            },
            ..RunSpec::default()
        },
    };
    let t = std::time::Instant::now();
    let mut sim = build(&spec, Options::default()).unwrap();
    println!("{:#?} built in {:?}", sim.info(), t.elapsed());
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(std::env::args().nth(3).map_or(1, |n| n.parse().unwrap()))
        .build()
        .unwrap();
    pool.install(|| {
        sim.start(true);
        let t = std::time::Instant::now();
        for n in 1..=steps {
            if let Err(e) = sim.step() {
                println!("{e}");
                break;
            }
            if n % (steps / 10).max(1) == 0 {
                let l = sim.ledger().unwrap();
                println!("{n} broken {} kinetic {:.6e} strain {:.6e} released {:.6e} work {:.6e} residual {:.3e} {:.1} ms/step", sim.broken(), l.kinetic, l.strain, l.released, l.work_rigid_bodies, l.residual(), t.elapsed().as_secs_f64() * 1e3 / n as f64);
            }
        }
    });
}
