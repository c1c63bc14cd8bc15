//! No law knows the unit of length: a body of another size has the same strains.

use crate::sample::*;
use peridyne::run::Simulation;
use peridyne::space::Point;
use peridyne::spec::*;

/// A power of four, so that products and roots of it are exact.
const SIZE: f64 = 1048576.0;

/// The same body so many times as large, of the same moduli, in the same time.
fn larger(case: &Case, size: f64) -> Spec {
    let mut spec = case.spec();
    let BodySpec::Sites { spacing, .. } = &mut spec.body else {
        panic!("a body of sites");
    };
    *spacing *= size;
    spec.space.section *= size.powi(3 - case.d() as i32);
    for m in &mut spec.materials {
        m.density /= size * size;
    }
    for set in &mut spec.sets {
        if let Members::Region(peridyne::space::region::Region::HalfSpace { point, .. }) =
            &mut set.members
        {
            *point = point.map(|x| x * size);
        }
    }
    breaking(&mut spec, 0.06);
    spec.interactions.contact = Some(CONTACT);
    spec
}

/// Forces (times length over modulus) of a body that broke and touches itself, bonds that broke, stiffness of its contact.
fn answer(case: &Case, size: f64) -> (Vec<Point>, u64, Vec<f64>) {
    let mut sim: Box<dyn Simulation> = at_rest(&larger(case, size));
    let n = sim.vectors("reference").len();
    let mut random = Random(7);
    let mut large = || {
        let u = random.vectors(n, case.d(), 0.12 * H);
        u.into_iter()
            .map(|u| u.map(|x| x * size))
            .collect::<Vec<_>>()
    };
    sim.set_displacements(&large());
    sim.start(true);
    sim.start(true);
    let forces = sim.forces_under(&large()).into_iter();
    let contact = sim.info().contact_stiffness.iter();
    (
        forces.map(|f| f.map(|x| x * size)).collect(),
        sim.broken(),
        contact.map(|k| k * size.powi(5)).collect(),
    )
}

#[test]
fn a_larger_body_has_the_same_strains() {
    for case in cases() {
        // fibres that follow the place know lengths
        if case.material.name == "wound" {
            continue;
        }
        let (small, broken, contact) = answer(&case, 1.0);
        let (large, more, harder) = answer(&case, SIZE);
        assert!(broken > 0, "{}", case.name());
        assert_eq!(broken, more, "{}", case.name());
        let off = distance(&small, &large) / largest(&small);
        assert!(off < 1e-9, "{}: {off:e}", case.name());
        for (a, b) in contact.iter().zip(&harder) {
            assert!((a / b - 1.0).abs() < 1e-9, "{}: {a} {b}", case.name());
        }
    }
}

#[test]
fn contact_is_that_of_bonds_of_the_same_bulk_modulus_whatever_the_influence() {
    for influence in [
        Influence::Constant,
        Influence::Linear,
        Influence::Inverse,
        Influence::Gaussian,
    ] {
        for place in places().into_iter().filter(|p| p.plane == Plane::Strain) {
            let case = Case::of("pmb", place);
            let stiffness = |law: LawSpec| {
                let mut spec = case.spec();
                spec.materials[0].law = law;
                spec.bonds.influence = influence;
                spec.bonds.calibration = Calibration::Continuum;
                spec.interactions.contact = Some(CONTACT);
                made(&spec).info().contact_stiffness[0]
            };
            let bonds = stiffness(LawSpec::Pmb(PmbStiffness::Young(3.0)));
            let solid = stiffness(LawSpec::Lps(Moduli {
                young: 3.0,
                poisson: 0.25,
            }));
            // 48 E/(5π t δ³) · 15/δ of a full disk
            let horizon: f64 = made(&case.spec()).info().horizon;
            let closed =
                48.0 * 3.0 / (5.0 * std::f64::consts::PI * 0.25 * horizon.powi(3)) * 15.0 / horizon;
            for k in [bonds, solid] {
                assert!(
                    (k / closed - 1.0).abs() < 1e-12,
                    "{influence:?}: {k} {closed}"
                );
            }
        }
    }
}
