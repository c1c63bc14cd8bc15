//! Rigid motion, objectivity, momentum, and force as the derivative of energy.

use crate::sample::*;
use peridyne::run::Simulation;
use peridyne::space::Point;
use peridyne::spec::*;
use std::collections::BTreeMap;

/// Force density that a strain of order one would make.
const STIFF: f64 = 3.0 / H;

#[test]
fn rigid_translation_gives_exactly_no_force() {
    for case in cases() {
        for mut spec in [case.spec(), case.periodic()] {
            spec.interactions.contact = Some(CONTACT);
            let mut sim = at_rest(&spec);
            let n = sim.vectors("reference").len();
            for shift in [0.0, 1e-3, 17.3] {
                let u = vec![std::array::from_fn(|a| if a < case.d() { shift } else { 0.0 }); n];
                let f = sim.forces_under(&u);
                assert!(
                    f.iter().flatten().all(|c| *c == 0.0),
                    "{}: {}",
                    case.name(),
                    largest(&f)
                );
            }
        }
    }
}

#[test]
fn rigid_rotation_gives_no_force() {
    let mut worst: f64 = 0.0;
    for case in cases() {
        let mut sim = at_rest(&case.spec());
        let r = rotation(case.d());
        let u: Vec<Point> = sim
            .vectors("reference")
            .iter()
            .map(|x| {
                let y = times(&r, x);
                std::array::from_fn(|a| y[a] - x[a])
            })
            .collect();
        assert!(largest(&u) > H);
        let f = largest(&sim.forces_under(&u)) / STIFF;
        worst = worst.max(f);
        assert!(f < 1e-12, "{}: {f:e}", case.name());
    }
    println!("rotation by 2.3: largest force / (E/h) = {worst:.1e}");
}

/// Displacements so large that series and closed forms, breaking and repulsion are all visited.
const LARGE: f64 = 0.12 * H;

/// A body with broken bonds, repulsion and memories, and displacements for it.
fn worn(case: &Case, mut spec: Spec) -> (Box<dyn Simulation>, Vec<Point>) {
    breaking(&mut spec, 0.06);
    spec.interactions.contact = Some(CONTACT);
    let mut sim = at_rest(&spec);
    let n = sim.vectors("reference").len();
    let mut random = Random(7);
    sim.set_displacements(&random.vectors(n, case.d(), LARGE));
    // the first sweep learns the critical stretches, the second breaks
    sim.start(true);
    sim.start(true);
    // laws with memory remember
    steps(sim.as_mut(), 2);
    let broken = sim.broken();
    assert!(
        broken > 0 && broken < sim.info().directed_bonds,
        "{}: {broken} of {} broken",
        case.name(),
        sim.info().directed_bonds
    );
    assert_eq!(broken % 2, 0, "{}", case.name());
    (sim, random.vectors(n, case.d(), LARGE))
}

#[test]
fn forces_turn_with_the_body() {
    let mut worst: f64 = 0.0;
    for case in cases() {
        let (mut sim, u) = worn(&case, case.spec());
        let f = sim.forces_under(&u);
        let r = rotation(case.d());
        let turned: Vec<Point> = sim
            .vectors("reference")
            .iter()
            .zip(&u)
            .map(|(x, u)| {
                let y = times(&r, &std::array::from_fn(|a| x[a] + u[a]));
                std::array::from_fn(|a| y[a] - x[a])
            })
            .collect();
        let expected: Vec<Point> = f.iter().map(|f| times(&r, f)).collect();
        let off = distance(&sim.forces_under(&turned), &expected) / largest(&f);
        worst = worst.max(off);
        assert!(off < 1e-12, "{}: {off:e}", case.name());
    }
    println!("f(R y) = R f(y) to {worst:.1e}");
}

#[test]
fn momentum_and_angular_momentum_are_kept() {
    let mut worst: [f64; 2] = [0.0; 2];
    let all = cases();
    let bodies = all
        .iter()
        .flat_map(|c| [(c, c.spec(), true), (c, c.periodic(), false)]);
    for (case, spec, free) in bodies {
        let (mut sim, u) = worn(case, spec);
        let f = sim.forces_under(&u);
        let (x, v) = (sim.vectors("reference"), sim.scalars("volume"));
        let (mut linear, mut angular) = ([0.0; 3], [0.0; 3]);
        let (mut force, mut moment) = (0.0, 0.0);
        for i in 0..f.len() {
            let y: Point = std::array::from_fn(|a| x[i][a] + u[i][a]);
            for a in 0..3 {
                let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                linear[a] += v[i] * f[i][a];
                angular[a] += v[i] * (y[b] * f[i][c] - y[c] * f[i][b]);
            }
            force += v[i] * dot(&f[i], &f[i]).sqrt();
            moment += v[i] * (dot(&f[i], &f[i]) * dot(&y, &y)).sqrt();
        }
        let off = [largest(&[linear]) / force, largest(&[angular]) / moment];
        // through a periodic face a moment gets an arm of a period
        for k in 0..if free { 2 } else { 1 } {
            worst[k] = worst[k].max(off[k]);
            assert!(off[k] < 1e-13, "{}: {off:?}", case.name());
        }
    }
    println!(
        "Σ V f = 0 to {:.1e}, Σ V y × f = 0 to {:.1e}",
        worst[0], worst[1]
    );
}

/// Bond by bond, forces add up to those of points, and what a bond does to one of its ends it does against the other.
#[test]
fn forces_of_bonds_are_those_of_points() {
    let mut worst: [f64; 2] = [0.0; 2];
    for case in cases() {
        for family in [FamilyChoice::Stencil, FamilyChoice::List] {
            let mut spec = case.spec();
            spec.bonds.family = family;
            breaking(&mut spec, 0.06);
            let mut sim = at_rest(&spec);
            let volumes = sim.scalars("volume");
            let n = volumes.len();
            let mut random = Random(7);
            sim.set_displacements(&random.vectors(n, case.d(), LARGE));
            sim.start(true);
            sim.start(true);
            steps(sim.as_mut(), 2);
            assert!(sim.broken() > 0, "{}", case.name());
            let u = random.vectors(n, case.d(), LARGE);
            let f = sim.forces_under(&u);
            sim.set_displacements(&u);
            let mut sum = vec![[0.0; 3]; n];
            let mut pairs = BTreeMap::<[usize; 2], Point>::new();
            let known = sim.each_force(&mut |bond| {
                let (i, j) = (bond.id, bond.partner);
                let pair = pairs.entry([i.min(j), i.max(j)]).or_default();
                for a in 0..3 {
                    sum[i][a] += bond.force[a];
                    pair[a] += volumes[i] * bond.force[a];
                }
            });
            assert!(known, "{}", case.name());
            let pairs: Vec<Point> = pairs.into_values().collect();
            let off = [
                distance(&sum, &f) / largest(&f),
                largest(&pairs) / (volumes[0] * largest(&f)),
            ];
            for k in 0..2 {
                worst[k] = worst[k].max(off[k]);
                assert!(off[k] < 1e-12, "{} {family:?}: {off:?}", case.name());
            }
        }
    }
    println!(
        "Σ f_ij = f_i to {:.1e}, V_i f_ij + V_j f_ji = 0 to {:.1e}",
        worst[0], worst[1]
    );
}

/// Central difference of `energy` along `way` at `u`, extrapolated from two steps.
fn slope(u: &[Point], way: &[Point], mut energy: impl FnMut(&[Point]) -> f64) -> f64 {
    let mut central = |h: f64| {
        let mut at = |s: f64| {
            let moved: Vec<Point> = u
                .iter()
                .zip(way)
                .map(|(u, w)| std::array::from_fn(|a| u[a] + s * w[a]))
                .collect();
            energy(&moved)
        };
        (at(h) - at(-h)) / (2.0 * h)
    };
    let h = 2e-5 * H;
    (4.0 * central(0.5 * h) - central(h)) / 3.0
}

fn power(f: &[Point], volumes: &[f64], way: &[Point]) -> f64 {
    f.iter()
        .zip(volumes)
        .zip(way)
        .map(|((f, v), w)| v * dot(f, w))
        .sum()
}

#[test]
fn force_is_the_derivative_of_energy() {
    let mut worst: f64 = 0.0;
    for case in cases().into_iter().filter(|c| c.material.potential) {
        let n = at_rest(&case.spec()).vectors("reference").len();
        let whole = (at_rest(&case.spec()), Random(5).vectors(n, case.d(), LARGE));
        let periodic = worn(&case, case.periodic());
        for (mut sim, u) in [whole, worn(&case, case.spec()), periodic] {
            let v = sim.scalars("volume");
            let f = sim.forces_under(&u);
            let top = largest(&f);
            // against the force and across it: along it alone, errors across would not show
            let random = Random(3).vectors(n, case.d(), top);
            let along: Vec<Point> = f
                .iter()
                .zip(&random)
                .map(|(f, r)| std::array::from_fn(|a| (f[a] + r[a]) / top))
                .collect();
            let falls = -slope(&u, &along, |u| {
                sim.set_displacements(u);
                sim.scalars("energy_density")
                    .iter()
                    .zip(&v)
                    .map(|(w, v)| w * v)
                    .sum()
            });
            let given = power(&f, &v, &along);
            let off = (falls - given).abs() / given.abs();
            worst = worst.max(off);
            assert!(
                off < 1e-7,
                "{}: {falls} is not {given}: {off:e}",
                case.name()
            );
        }
    }
    println!("f = −∂W/∂u to {worst:.1e}, whole, broken and repelling");
}

/// What is set is what is seen, through periodic faces too.
#[test]
fn energies_see_displacements_that_were_just_set() {
    for case in cases() {
        let mut case = case.clone();
        case.place.cells = case.place.cells.map(|c| if c > 1 { 7 } else { 1 });
        let mut spec = case.periodic();
        let mut sims = [FamilyChoice::Stencil, FamilyChoice::List].map(|family| {
            spec.bonds.family = family;
            at_rest(&spec)
        });
        let u = Random(61).vectors(sims[0].vectors("reference").len(), case.d(), 0.05 * H);
        let [a, b] = [0, 1].map(|k| {
            sims[k].set_displacements(&u);
            (
                sims[k].scalars("dilatation"),
                sims[k].scalars("energy_density"),
            )
        });
        let close = |a: &[f64], b: &[f64]| {
            let top = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12 * top)
        };
        assert!(close(&a.0, &b.0) && close(&a.1, &b.1), "{}", case.name());
    }
}

/// Two blocks pressed into each other: all forces, contact included, against the ledger.
#[test]
fn contact_force_is_the_derivative_of_contact_energy() {
    for name in ["pmb", "lps"] {
        for place in places().into_iter().filter(|p| p.kind.dimension() > 1) {
            let case = Case::of(name, place);
            for family in [FamilyChoice::Stencil, FamilyChoice::List] {
                let mut spec = case.spec();
                spec.bonds.family = family;
                spec.interactions.contact = Some(CONTACT);
                let BodySpec::Sites { quarters, .. } = &mut spec.body else {
                    unreachable!("samples are sites")
                };
                // the same block again, a good gap above
                let gap = 4 * (place.cells[1] as i32 + place.ratio as i32 + 2);
                let above: Vec<_> = quarters.iter().map(|q| [q[0], q[1] + gap, q[2]]).collect();
                let n = quarters.len();
                quarters.extend(above);
                let mut sim = at_rest(&spec);
                assert_eq!(sim.fragments(), 2);
                let mut u = Random(11).vectors(2 * n, case.d(), 0.02 * H);
                let down = 0.25 * H * place.kind.edges()[1] * (gap as f64)
                    - H * place.kind.edges()[1] * (place.cells[1] as f64 - 0.6);
                u[n..].iter_mut().for_each(|u| u[1] -= down);
                // contact is found where points were put, before a run begins there, too
                sim.start(true);
                sim.set_displacements(&u);
                assert!(sim.ledger().unwrap().contact > 0.0, "{}", case.name());
                sim.start(true);
                let (f, v) = (sim.vectors("force_density"), sim.scalars("volume"));
                assert!(sim.ledger().unwrap().contact > 0.0, "{}", case.name());
                let scale = largest(&f);
                let way: Vec<Point> = f.iter().map(|f| f.map(|c| c / scale)).collect();
                let falls = -slope(&u, &way, |u| {
                    sim.set_displacements(u);
                    sim.start(true);
                    let l = sim.ledger().unwrap();
                    l.strain + l.contact
                });
                let given = power(&f, &v, &way);
                let off = (falls - given).abs() / given.abs();
                assert!(
                    off < 1e-6,
                    "{}: {falls} is not {given}: {off:e}",
                    case.name()
                );
            }
        }
    }
}
