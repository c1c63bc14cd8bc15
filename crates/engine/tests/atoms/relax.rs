//! Crystals left to themselves.

use super::sample::{atoms, potentials};
use peridyne::expression::Expression;
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind::{Fcc, Triangular};
use peridyne::space::region::Region;
use peridyne::spec::*;

/// A crystal without the site nearest to its middle.
fn with_vacancy(mut spec: Spec) -> Spec {
    let BodySpec::Sites { quarters, .. } = &mut spec.body else {
        panic!("no sites")
    };
    let far = quarters.iter().flatten().fold(0, |m, q| (*q).max(m));
    let off = |q: &[i32; 3]| -> i32 {
        let d = spec.space.dimension;
        q[..d].iter().map(|q| (2 * q - far).pow(2)).sum()
    };
    let least = quarters.iter().map(off).min().unwrap();
    let vacant = quarters.iter().position(|q| off(q) == least).unwrap();
    quarters.remove(vacant);
    spec
}

fn check<const D: usize>(name: &str, spec: &Spec) {
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    let mut model = build(spec, options).unwrap();
    let largest = |f: &[[f64; 3]]| f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let sites = model.displacements();
    let before = largest(&model.forces_under(&sites));
    let solved = model.relax(1e-10).unwrap_or_else(|e| panic!("{name}: {e}"));
    let u = model.displacements();
    let after = largest(&model.forces_under(&u));
    assert!(
        after < 1e-9 * before && before > 0.0,
        "{name}: {before:e} to {after:e}"
    );
    assert!(solved.iterations > 1, "{name}: {solved:?}");
    // the relaxed crystal, if it is free, may turn without force, about where its atoms are now
    let mut body: LinearBody<D> = model.linear_body().of().unwrap();
    let about_sites = body.soundness().rotation;
    for (x, u) in body.position.iter_mut().zip(&u) {
        for a in 0..D {
            x[a] += u[a];
        }
    }
    let rotation = body.soundness().rotation;
    let turns = spec.space.periodic.iter().all(Option::is_none);
    assert!(
        !turns || rotation < 1e-9 && about_sites > 1e-6,
        "{name}: {rotation:e}, {about_sites:e}"
    );
    // again: nothing is left to do
    assert!(model.relax(1e-8).unwrap().iterations == 0, "{name}");
}

#[test]
fn crystals_with_a_vacancy_relax() {
    // ends that jump have no state nearby to relax to
    let smooth = ["lj, shifted force", "morse, shifted force"];
    for (name, potential) in potentials() {
        for family in [FamilyChoice::Stencil, FamilyChoice::Neighbours] {
            let name = format!("{name}, {family:?}");
            if smooth.iter().any(|s| name.starts_with(s)) {
                let spec = atoms(Triangular, 6, &potential, family, false);
                check::<2>(&name, &with_vacancy(spec));
            }
            // on small free blocks of embedded atoms Newton's method does not converge: their corners move far
            let embedded = name.starts_with("eam, closed form");
            if smooth.iter().any(|s| name.starts_with(s)) || embedded {
                let spec = atoms(Fcc, 3, &potential, family, embedded);
                check::<3>(&name, &with_vacancy(spec));
            }
        }
    }
}

/// Thirteen Lennard-Jones atoms have their least energy, −44.326801 ε, as an icosahedron (M. R. Hoare and P. Pal 1971, Adv. Phys. 20, 161;
/// D. J. Wales and J. P. K. Doye 1997, J. Phys. Chem. A 101, 5111). A cuboctahedron, which fcc has, is no minimum: it turns into that.
#[test]
fn thirteen_atoms_become_an_icosahedron() {
    let nearest = 2f64.powf(1.0 / 6.0);
    let lj = PotentialSpec::of(LennardJones {
        epsilon: 1.0,
        sigma: 1.0,
    });
    let ball = Region::Sphere {
        center: [0.0; 3],
        radius: 1.1 * nearest,
    };
    let body = BodySpec::Lattice {
        kind: Fcc,
        spacing: nearest * 2f64.sqrt(),
        origin: [0.0; 3],
        region: ball,
        perturb: None,
    };
    let mut spec = Spec::new(3, body, 1.0, LawSpec::Atoms(lj.ended(10.0, End::Truncated)));
    spec.bonds.horizon = Horizon::Length(10.0);
    let bent = |e: &str| Some(Expression::parse(e, &[]).unwrap());
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [bent("0.02*y*z"), bent("0.03*sin(3*x)*z"), bent("0.01*x")],
        velocity: [None, None, None],
    }];
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Fire,
        tolerance: 1e-8,
        ..Statics::default()
    });
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    spec.run.schedule.steps = 1;
    for family in [FamilyChoice::Neighbours, FamilyChoice::Reference] {
        spec.bonds.family = family;
        let mut model = build(&spec, Options::default()).unwrap();
        assert_eq!(model.info().points, 13);
        model.start(true);
        model.step().unwrap();
        let energy = model.ledger().unwrap().strain;
        assert!((energy + 44.326801).abs() < 1e-5, "{family:?}: {energy}");
        // the nearest twelve are at one distance from the middle, and each of these has five among them
        let x = model.vectors("position");
        let distance =
            |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
        let bonds = (0..13).flat_map(|i| (0..i).map(move |j| (i, j)));
        let near = bonds.filter(|(i, j)| distance(&x[*i], &x[*j]) < 1.3);
        assert_eq!(near.count(), 42);
    }
}
