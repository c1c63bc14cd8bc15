//! Bonds with two stiffnesses: what the battery of all laws does not ask.

use crate::sample::*;
use peridyne::space::Point;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;
use peridyne_algebra::symmetric_eigen;

fn law(poisson: f64) -> LawSpec {
    let moduli = Parameters::numbers(&[("young", 3.0), ("poisson", poisson)]);
    LawSpec::named("bond_rotation", moduli)
}

fn with(place: Place, law: LawSpec) -> Case {
    let mut case = Case::of("bond rotation", place);
    case.material.laws = vec![law];
    case
}

/// Poisson's ratio at which nothing acts across bonds.
fn most(case: &Case) -> f64 {
    match (case.d(), case.place.plane) {
        (2, Plane::Stress) => 1.0 / 3.0,
        _ => 0.25,
    }
}

fn solids() -> impl Iterator<Item = Place> {
    places().into_iter().filter(|p| p.kind.dimension() > 1)
}

#[test]
fn without_a_stiffness_across_it_is_pmb() {
    for place in solids() {
        let pmb = with(place, LawSpec::Pmb(PmbStiffness::Young(3.0)));
        let case = with(place, law(most(&pmb)));
        let mut sims = [pmb.spec(), case.spec()].map(|s| at_rest(&s));
        let n = sims[0].vectors("reference").len();
        let u = Random(11).vectors(n, case.d(), 0.1 * H);
        let [a, b] = sims.each_mut().map(|s| s.forces_under(&u));
        let off = distance(&a, &b) / largest(&a);
        assert!(off < 1e-12, "{}: {off:e}", case.name());
    }
}

#[test]
fn ratios_that_ask_for_less_than_none_are_refused() {
    for place in solids() {
        for beyond in [1e-3, 0.1] {
            let mut case = with(place, law(0.1));
            case.material.laws = vec![law(most(&case) + beyond)];
            let refused = build(&case.spec(), Default::default()).err();
            let message = refused.expect("not stable").message.to_string();
            assert!(message.contains("it is at most"), "{message}");
        }
    }
}

/// A sheet of triangles, periodic along x and y, that is pulled along x and free to give way: E and ν themselves, from the energy of
/// uniform strains. `W_xx = ½ (λ + 2G)`, and with strains (1, b) it is least at `b = −λ/(λ + 2G)`.
#[test]
fn the_moduli_asked_for_are_the_moduli_had() {
    let s = 1e-6;
    for (plane, ratios) in [
        (Plane::Stress, [-0.5, 0.0, 0.1, 0.3]),
        (Plane::Strain, [-0.5, 0.0, 0.1, 0.25]),
    ] {
        for poisson in ratios {
            let place = Place {
                kind: LatticeKind::Triangular,
                plane,
                ratio: 3,
                cells: [7, 4, 1],
            };
            let sim = at_rest(&with(place, law(poisson)).periodic());
            let w = |x: f64, y: f64| {
                let strain = [[s * x, 0.0, 0.0], [0.0, s * y, 0.0], [0.0; 3]];
                sim.energy_under_strain(strain)[0] / (s * s)
            };
            let (xx, yy) = (2.0 * w(1.0, 0.0), 2.0 * w(0.0, 1.0));
            let xy = w(1.0, 1.0) - w(1.0, 0.0) - w(0.0, 1.0);
            assert!((xx / yy - 1.0).abs() < 1e-5, "{xx} {yy}");
            // in the plane: ν = xy/xx, E = xx (1 − ν²); of plane strain they are ν/(1 − ν) and E/(1 − ν²)
            let (nu, e) = (xy / xx, xx - xy * xy / xx);
            let (nu, e) = match plane {
                Plane::Stress => (nu, e),
                Plane::Strain => (nu / (1.0 + nu), e * (1.0 - (nu / (1.0 + nu)).powi(2))),
            };
            assert!((nu - poisson).abs() < 1e-5, "{plane:?}: {nu} not {poisson}");
            assert!((e / 3.0 - 1.0).abs() < 1e-5, "{plane:?} {poisson}: {e}");
        }
    }
}

/// Long waves along x: λ + 2G of the longitudinal, G of the transverse one; `⟨u, −f⟩/⟨u, u⟩ = ρΩ²` of a standing wave is of second order in
/// its wave number, so from two lengths the speed follows.
#[test]
fn long_waves_have_the_moduli_of_the_solid() {
    for poisson in [-0.3, 0.1, 0.3] {
        let rayleigh = |cells: usize, way: Point| {
            let place = Place {
                kind: LatticeKind::Triangular,
                plane: Plane::Stress,
                ratio: 3,
                cells: [cells, 4, 1],
            };
            let mut sim = at_rest(&with(place, law(poisson)).periodic());
            let x = sim.vectors("reference");
            let k = 2.0 * std::f64::consts::PI / (cells as f64 * H);
            let shape: Vec<f64> = x.iter().map(|x| (k * x[0]).cos()).collect();
            let u: Vec<Point> = shape
                .iter()
                .map(|c| way.map(|w| 1e-9 * H * w * c))
                .collect();
            let f = sim.forces_under(&u);
            let work: f64 = f.iter().zip(&u).map(|(f, u)| -dot(f, u)).sum();
            work / u.iter().map(|u| dot(u, u)).sum::<f64>() / (k * k)
        };
        let g = 3.0 / (2.0 * (1.0 + poisson));
        let lambda = 3.0 * poisson / (1.0 - poisson * poisson);
        for (way, modulus) in [([1.0, 0.0, 0.0], lambda + 2.0 * g), ([0.0, 1.0, 0.0], g)] {
            let off = [80, 160].map(|n| rayleigh(n, way) / modulus - 1.0);
            println!("ν = {poisson}, along {way:?}: ρc² off by {off:?}");
            assert!(off[1].abs() < 2e-2, "{poisson} {way:?}: {off:?}");
            let limit = (4.0 * off[1] - off[0]) / 3.0;
            assert!(limit.abs() < 1e-4, "{poisson} {way:?}: {limit:e}");
        }
    }
}

/// The stiffness of a body of which random bonds are broken has no negative eigenvalue.
#[test]
fn torn_families_are_stable() {
    for place in solids() {
        for poisson in [-0.5, 0.0, 0.2] {
            let mut spec = with(place, law(poisson)).spec();
            breaking(&mut spec, 0.03);
            let mut sim = at_rest(&spec);
            let d = place.kind.dimension();
            let n = sim.vectors("reference").len();
            sim.set_displacements(&Random(7).vectors(n, d, 0.12 * H));
            sim.start(true);
            sim.start(true);
            let (broken, bonds) = (sim.broken(), sim.info().directed_bonds);
            assert!(broken > bonds / 10 && broken < bonds, "{broken} of {bonds}");
            let volume = sim.scalars("volume");
            let small = 1e-7 * H;
            let mut stiffness = vec![vec![0.0; n * d]; n * d];
            for (c, column) in stiffness.iter_mut().enumerate() {
                let mut u = vec![[0.0; 3]; n];
                u[c / d][c % d] = small;
                let f = sim.forces_under(&u);
                for (r, x) in column.iter_mut().enumerate() {
                    *x = -volume[r / d] * f[r / d][r % d] / small;
                }
            }
            let entry = |r: usize, c: usize| 0.5 * (stiffness[r][c] + stiffness[c][r]);
            let (values, _) = symmetric_eigen(n * d, entry).unwrap();
            let [least, most] = [values[0], values[n * d - 1]];
            // differences of forces lose as much
            assert!(
                least > -1e-6 * most,
                "{place:?} {poisson}: {least:e} of {most:e}"
            );
        }
    }
}

/// A body that flies, turns by more than a right angle, and shakes: momentum and angular momentum to round-off, energy to second order.
#[test]
fn a_turning_body_keeps_its_momenta_and_energy() {
    for place in solids().filter(|p| matches!(p.kind, LatticeKind::Square | LatticeKind::Cubic)) {
        let case = with(place, law(0.0));
        let d = case.d();
        let mut drift = vec![];
        for fraction in [0.4, 0.2] {
            let mut spec = case.spec();
            spec.run.schedule.time_step = TimeStep::Fraction(fraction);
            let mut sim = made(&spec);
            let x = sim.vectors("reference");
            let (volume, density) = (sim.scalars("volume"), RHO);
            let shake = Random(5).vectors(x.len(), d, 0.02);
            let v: Vec<Point> = x
                .iter()
                .zip(&shake)
                .map(|(x, s)| [0.1 - 0.15 * x[1] + s[0], 0.15 * x[0] + s[1], s[2]])
                .collect();
            sim.set_velocities(&v);
            sim.start(true);
            let momenta = |sim: &mut dyn peridyne::run::Simulation| {
                let (u, v) = (sim.displacements(), sim.velocities());
                let mut all = [[0.0; 3]; 2];
                for i in 0..u.len() {
                    let m = density * volume[i];
                    let y: Point = std::array::from_fn(|a| x[i][a] + u[i][a]);
                    for a in 0..3 {
                        let (b, c) = ((a + 1) % 3, (a + 2) % 3);
                        all[0][a] += m * v[i][a];
                        all[1][a] += m * (y[b] * v[i][c] - y[c] * v[i][b]);
                    }
                }
                all
            };
            let energy = |sim: &mut dyn peridyne::run::Simulation| {
                let v = sim.velocities();
                let w = sim.scalars("energy_density");
                let each = v.iter().zip(&w).zip(&volume);
                each.map(|((v, w), o)| o * (0.5 * density * dot(v, v) + w))
                    .sum::<f64>()
            };
            let (before, start) = (momenta(sim.as_mut()), energy(sim.as_mut()));
            let mut worst: f64 = 0.0;
            while sim.time() < 14.0 {
                sim.step().unwrap();
                worst = worst.max((energy(sim.as_mut()) / start - 1.0).abs());
            }
            let off = distance(&before, &momenta(sim.as_mut()));
            assert!(off < 1e-11 * largest(&before), "{}: {off:e}", case.name());
            drift.push(worst);
        }
        println!("{}: energy off by {drift:?}", case.name());
        assert!(drift[1] < 1e-2 && drift[1] < 0.35 * drift[0], "{drift:?}");
    }
}
