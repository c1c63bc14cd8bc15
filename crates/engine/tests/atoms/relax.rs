//! Crystals left to themselves.

use super::sample::{atoms, potentials};
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind::{Fcc, Triangular};
use peridyne::spec::{BodySpec, FamilyChoice, LinearBody, Spec};

/// A crystal without the site nearest to its middle.
fn with_vacancy(mut spec: Spec) -> Spec {
    let BodySpec::Sites { quarters, .. } = &mut spec.body else {
        panic!("no sites")
    };
    let far = quarters.iter().flatten().fold(0, |m, q| (*q).max(m));
    let off = |q: &[i32; 3]| -> i32 {
        let d = spec.dimension;
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
    let turns = spec.periodic.iter().all(Option::is_none);
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
