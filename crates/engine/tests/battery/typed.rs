//! Solids with constants as typed: what lps does with the moduli that answer alike in as many dimensions.

use crate::sample::*;
use peridyne::run::{Options, Simulation};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;
use std::f64::consts::PI;

const K: f64 = 2.0;
const G: f64 = 1.0;
const HORIZON: f64 = 3.0;

/// The same constants, κ = K − 5G/3 and β = 15 G, under three names.
fn typed() -> [LawSpec; 2] {
    [
        LawSpec::Lps3d { bulk: K, shear: G },
        LawSpec::EamLike {
            pair: 30.0 * G,
            volume: 3.0 * K - 5.0 * G,
        },
    ]
}

/// The lps of the same energy: `κ (3/D)² = λ − G′` and `β = D(D+2) G′`, in plane strain.
fn twin(d: usize) -> LawSpec {
    let n = d as f64;
    let shear = 15.0 * G / (n * (n + 2.0));
    let lame = (K - 5.0 / 3.0 * G) * (3.0 / n).powi(2) + shear;
    LawSpec::Lps(Moduli {
        young: shear * (3.0 * lame + 2.0 * shear) / (lame + shear),
        poisson: 0.5 * lame / (lame + shear),
    })
}

fn block(d: usize, law: LawSpec) -> Spec {
    let body = BodySpec::Lattice {
        kind: [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic][d - 1],
        spacing: 1.0,
        origin: std::array::from_fn(|a| if a < d { 0.5 } else { 0.0 }),
        region: Region::Block {
            low: [0.0; 3],
            high: std::array::from_fn(|a| if a < d { [10.0, 6.0, 5.0][a] } else { 0.0 }),
        },
        perturb: None,
    };
    let mut spec = Spec::new(d, body, 1.0, law);
    spec.space.plane = Plane::Strain;
    spec.bonds.horizon = Horizon::Ratio(HORIZON as u32);
    spec.bonds.influence = Influence::Inverse;
    spec.bonds.calibration = Calibration::Continuum;
    let velocity = ["0.03*(x - 5) + 0.02*sin(5*x)", "0.01*cos(2*x)", "0.01*y"];
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [None, None, None],
        velocity: std::array::from_fn(|a| (a < d).then(|| e(velocity[a]))),
    }];
    spec.run.schedule.time_step = TimeStep::Fraction(0.5);
    spec
}

fn moved(spec: &Spec, n: usize) -> Box<dyn Simulation> {
    let mut sim = build(spec, Options::default()).unwrap_or_else(|e| panic!("{e}"));
    sim.start(true);
    steps(&mut *sim, n);
    sim
}

/// Bonds of both break by work, by stress and by a stretch that grows with the rate where those of lps do.
#[test]
fn solids_as_typed_break_by_what_lps_breaks_by() {
    let rate = Some(RateSpec {
        coefficient: 0.1,
        reference: 1e-3,
    });
    let criteria = [
        FractureSpec::new(Criterion::BondEnergy(1e-3)),
        FractureSpec::new(Criterion::VonMises(0.1)),
        FractureSpec {
            rate,
            ..FractureSpec::new(Criterion::Stretch(0.02))
        },
    ];
    for d in 2..=3 {
        for fracture in criteria {
            let run = |law: LawSpec| {
                let mut spec = block(d, law);
                spec.materials[0].fracture = Some(fracture);
                moved(&spec, 40)
            };
            let mut expected = run(twin(d));
            assert!(expected.broken() > 0, "{d}-D {fracture:?}");
            let u = expected.displacements();
            for law in typed() {
                let mut found = run(law.clone());
                assert_eq!(
                    found.broken(),
                    expected.broken(),
                    "{d}-D {law:?} {fracture:?}"
                );
                let off = distance(&found.displacements(), &u);
                assert!(
                    off < 1e-9 * largest(&u),
                    "{d}-D {law:?} {fracture:?}: {off:e}"
                );
            }
        }
    }
}

/// The law that remembers is that of the kernel that does not, in every dimension, also where the formulas are those of another.
#[test]
fn solids_as_typed_are_the_same_where_they_remember() {
    for d in 1..=3 {
        for law in typed() {
            let run = |fracture| {
                let mut spec = block(d, law.clone());
                spec.materials[0].fracture = fracture;
                moved(&spec, 40).displacements()
            };
            let never = FractureSpec::new(Criterion::BondEnergy(1e9));
            let (u, v) = (run(None), run(Some(never)));
            let off = distance(&u, &v);
            assert!(off < 1e-11 * largest(&u), "{d}-D {law:?}: {off:e}");
        }
    }
}

/// `G0/s²` of ω = 1/r: on a line E δ/4 with E = 9κ + β; bonds ½⟨|n|⟩ β M3/m with M3/m = ¾δ and ⅘δ, ⟨|n|⟩ = 2/π and ½; the volume
/// 16 κ (3/2)²/(9π²) δ of a plane and (¾)⁴ κ δ of a solid (Madenci & Oterkus 2014).
#[test]
fn solids_as_typed_have_the_stretch_of_a_fracture_energy() {
    let (kappa, beta) = (K - 5.0 / 3.0 * G, 15.0 * G);
    let expected = [
        (9.0 * kappa + beta) / 4.0,
        0.75 * beta / PI + 4.0 * kappa / PI.powi(2),
        0.2 * beta + 0.75f64.powi(4) * kappa,
    ];
    let energy = 1e-3;
    for (d, of) in (1..=3).zip(expected) {
        let stretch = |law| {
            let mut spec = block(d, law);
            spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Energy(energy)));
            moved(&spec, 0).info().critical_stretch[0]
        };
        let expected = (energy / (of * HORIZON)).sqrt();
        for law in typed() {
            let found = stretch(law.clone());
            assert!(
                (found / expected - 1.0).abs() < 1e-12,
                "{d}-D {law:?}: {found} {expected}"
            );
        }
        if d > 1 {
            let found = stretch(twin(d));
            assert!(
                (found / expected - 1.0).abs() < 1e-12,
                "{d}-D lps: {found} {expected}"
            );
        }
    }
}

/// Both ends of a bond weigh it as the family of each does, and points may have horizons of their own.
#[test]
fn solids_as_typed_know_directions_and_horizons_of_points() {
    let formula = Influence::Formula(Formula::parse("1 + 0.5*xi_x/r", &[]).unwrap());
    for d in 2..=3 {
        for own in [false, true] {
            let run = |law: LawSpec| {
                let mut spec = block(d, law);
                match own {
                    true => {
                        spec.bonds.family = FamilyChoice::List;
                        spec.bonds.partial_volume_correction = true;
                        spec.bonds.variable_horizon = Some(e("2 + 0.1*x"));
                    }
                    false => spec.bonds.influence = formula,
                }
                moved(&spec, 40).displacements()
            };
            let u = run(twin(d));
            for law in typed() {
                let off = distance(&run(law.clone()), &u);
                assert!(off < 1e-10 * largest(&u), "{d}-D {own} {law:?}: {off:e}");
            }
        }
    }
}
