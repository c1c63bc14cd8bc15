//! Surface-exact bodies in the engine: uniform strains, energy, momentum, breaking, threads.

use peridyne::execute::simd::Simd;
use peridyne::family::volume_fraction;
use peridyne::law::influence::influence;
use peridyne::law::solid::eam_like::Solid;
use peridyne::observe::Ledger;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::Point;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::AnyLinearBody;
use peridyne::spec::*;
use peridyne_theory::homogenize::surface::{correct, renew};

const H: f64 = 0.5;
/// So small that forces are linear to round-off.
const STRAIN: f64 = 1e-14;

fn points(n: [i32; 3]) -> Vec<[i32; 3]> {
    let mut all = vec![];
    for z in 0..n[2] {
        for y in 0..n[1] {
            for x in 0..n[0] {
                all.push([x, y, z]);
            }
        }
    }
    all
}

/// A plate or block of `points`, its corner at the origin.
fn body(d: usize, points: &[[i32; 3]], m: u32) -> Spec {
    let kind = [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic][d - 1];
    let body = BodySpec::Sites {
        kind,
        spacing: H,
        origin: [0.0; 3],
        quarters: points.iter().map(|p| p.map(|c| 4 * c)).collect(),
        volume: None,
    };
    let mut spec = Spec::new(d, body, 2.0, LawSpec::Pmb(PmbStiffness::Young(3.0)));
    spec.space.section = if d == 3 { 1.0 } else { 0.25 };
    spec.bonds.horizon = Horizon::Ratio(m);
    spec
}

fn with(mut spec: Spec, method: SurfaceMethod) -> Spec {
    spec.bonds.surface = Some(correct(&spec, method).unwrap().0);
    spec
}

fn at_rest(spec: &Spec, simd: Option<Simd>) -> Box<dyn Simulation> {
    let options = Options {
        simd,
        trust_time_step: true,
    };
    let mut spec = spec.clone();
    if !matches!(spec.run.schedule.time_step, TimeStep::Fixed(_)) {
        spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    }
    let mut sim = build(&spec, options).unwrap();
    sim.start(true);
    sim
}

/// All symmetric unit strains.
fn strains(d: usize) -> Vec<[[f64; 3]; 3]> {
    let mut all = vec![];
    for a in 0..d {
        for b in a..d {
            let mut e = [[0.0; 3]; 3];
            (e[a][b], e[b][a]) = (1.0, 1.0);
            all.push(e);
        }
    }
    all
}

/// Stress at a strain: `½ Σ t V r n⊗n` over a full family, `t` the force per volumes of a bond.
fn stress(spec: &Spec, m: u32, strain: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let (d, m) = (spec.space.dimension, m as i32);
    let horizon = f64::from(m) * H;
    let side = 2 * m + 1;
    let mut bonds = vec![];
    for k in 0..side.pow(d as u32) {
        let o: [f64; 3] = std::array::from_fn(|a| {
            if a < d {
                f64::from(k / side.pow(a as u32) % side - m) * H
            } else {
                0.0
            }
        });
        let r = o.iter().map(|x| x * x).sum::<f64>().sqrt();
        if r == 0.0 || r > horizon * (1.0 + 1e-12) {
            continue;
        }
        let nu = if spec.bonds.partial_volume_correction {
            volume_fraction(r, horizon, H)
        } else {
            1.0
        };
        let weight = nu
            * influence(spec.bonds.influence, &o, r, horizon)
            * H.powi(d as i32)
            * spec.space.section;
        bonds.push((r, o.map(|x| x / r), weight));
    }
    let tension: Box<dyn Fn(f64, f64) -> f64> =
        match Solid::of_law(d, spec.space.plane, &spec.materials[0].law) {
            Some(solid) => {
                let m: f64 = bonds.iter().map(|(r, _, w)| w * r * r).sum();
                let theta: f64 = (0..3).map(|a| strain[a][a]).sum();
                let pressure = solid.n * solid.kappa * theta / m;
                Box::new(move |r, stretch| 2.0 * r * (pressure + solid.beta / m * stretch))
            }
            None => {
                let mut pmb = spec.clone();
                pmb.materials[0].law = LawSpec::Pmb(PmbStiffness::Young(3.0));
                let c = at_rest(&pmb, None).info().micromodulus[0];
                Box::new(move |_, stretch| c * stretch)
            }
        };
    let mut sigma = [[0.0; 3]; 3];
    for (r, n, weight) in bonds {
        let mut stretch = 0.0;
        for a in 0..3 {
            for b in 0..3 {
                stretch += n[a] * strain[a][b] * n[b];
            }
        }
        for a in 0..3 {
            for b in 0..3 {
                sigma[a][b] += 0.5 * tension(r, stretch) * weight * r * n[a] * n[b];
            }
        }
    }
    sigma
}

fn displaced(sim: &mut dyn Simulation, e: &[[f64; 3]; 3], by: f64) -> Vec<Point> {
    sim.vectors("reference")
        .iter()
        .map(|x| std::array::from_fn(|a| by * (0..3).map(|b| e[a][b] * x[b]).sum::<f64>()))
        .collect()
}

/// Largest difference of the forces under all strains from those of the exact tractions, over the largest of these.
fn misfit(spec: &Spec, m: u32, n: [i32; 3]) -> f64 {
    let d = spec.space.dimension;
    let mut sim = at_rest(spec, None);
    let volumes = sim.scalars("volume");
    let face = H.powi(d as i32 - 1) * spec.space.section;
    let mut worst = 0.0f64;
    for e in strains(d) {
        let sigma = stress(spec, m, &e);
        let u = displaced(sim.as_mut(), &e, STRAIN);
        let f = sim.forces_under(&u);
        let (mut difference, mut largest) = (0.0f64, 0.0f64);
        for ((f, v), x) in f.iter().zip(&volumes).zip(sim.vectors("reference")) {
            let c = x.map(|x| (x / H).round() as i32);
            let half = |a: usize| c[a] == 0 || c[a] == n[a] - 1;
            // outward area: that of the faces through the point, halved at their edges, quartered at corners
            let area: Point = std::array::from_fn(|a| {
                if a >= d || !half(a) {
                    return 0.0;
                }
                let shared = (0..d).filter(|b| *b != a && half(*b)).count() as i32;
                let sign = if c[a] == 0 { -1.0 } else { 1.0 };
                sign * face * 0.5f64.powi(shared)
            });
            for a in 0..d {
                let traction: f64 = (0..d).map(|b| sigma[a][b] * area[b]).sum();
                difference = difference.max((f[a] * v / STRAIN + traction).abs());
                largest = largest.max(traction.abs());
            }
        }
        worst = worst.max(difference / largest);
    }
    worst
}

#[test]
fn uniform_strains_are_exact_on_plates_and_blocks() {
    let (plate, block) = ([17, 14, 1], [13, 15, 14]);
    for (d, n, m) in [
        (1, [30, 1, 1], 3),
        (2, plate, 2),
        (2, plate, 3),
        (2, plate, 4),
        (3, block, 2),
        (3, block, 3),
    ] {
        for scaling in [false, true] {
            let mut plain = body(d, &points(n), m);
            plain.bonds.partial_volume_correction = scaling;
            let exact = misfit(&with(plain.clone(), SurfaceMethod::Exact), m, n);
            let without = misfit(&plain, m, n);
            println!("{d}-D, horizon {m}, scaling {scaling}: {exact:.1e}, without {without:.2}");
            assert!(exact < 1e-12, "{d}-D, horizon {m}: {exact:e}");
            assert!(without > 0.1);
        }
    }
}

#[test]
fn springs_and_influence_functions_are_exact_too() {
    let n = [16, 12, 1];
    let mut spec = body(2, &points(n), 3);
    spec.bonds.influence = Influence::Linear;
    assert!(misfit(&with(spec.clone(), SurfaceMethod::Exact), 3, n) < 1e-12);
    spec.materials[0].law = LawSpec::Springs(PmbStiffness::Young(3.0));
    assert!(misfit(&with(spec, SurfaceMethod::Exact), 3, n) < 1e-12);
}

const LPS: LawSpec = LawSpec::Lps(Moduli {
    young: 3.0,
    poisson: 0.15,
});

#[test]
fn state_based_solids_are_exact_in_every_strain() {
    for (d, n, m) in [
        (1, [30, 1, 1], 2),
        (2, [17, 14, 1], 2),
        (2, [17, 14, 1], 3),
        (3, [9, 11, 10], 2),
        (3, [13, 13, 14], 3),
    ] {
        for kind in [Influence::Constant, Influence::Inverse] {
            let mut plain = body(d, &points(n), m);
            plain.materials[0].law = LPS;
            (plain.bonds.influence, plain.bonds.partial_volume_correction) = (kind, true);
            let exact = misfit(&with(plain.clone(), SurfaceMethod::Exact), m, n);
            let without = misfit(&plain, m, n);
            println!("{d}-D, horizon {m}, {kind:?}: {exact:.1e}, without {without:.2}");
            assert!(exact < 1e-11, "{d}-D, horizon {m}: {exact:e}");
            assert!(without > 0.1);
        }
    }
}

/// Residual at inner points and resultants of the surface, for bodies whose areas are not written out here.
fn residual_inside(spec: &Spec) -> f64 {
    let mut sim = at_rest(spec, None);
    let (v, x) = (sim.scalars("volume"), sim.vectors("reference"));
    let whole = H.powi(spec.space.dimension as i32) * spec.space.section;
    let mut worst = 0.0f64;
    for e in strains(spec.space.dimension) {
        let u = displaced(sim.as_mut(), &e, STRAIN);
        let f = sim.forces_under(&u);
        let size = |f: &Point| f.iter().fold(0.0f64, |m, c| m.max(c.abs()));
        let largest = f
            .iter()
            .zip(&v)
            .map(|(f, v)| size(f) * v)
            .fold(0.0, f64::max);
        for ((f, v), x) in f.iter().zip(&v).zip(&x) {
            assert!(*v <= whole, "{x:?}");
            if *v == whole {
                worst = worst.max(size(f) * v / largest);
            }
        }
    }
    worst
}

#[test]
fn holes_and_steps() {
    let hole = |p: &[i32; 3]| (2 * p[0] - 23).pow(2) + (2 * p[1] - 23).pow(2) >= 120;
    let step = |p: &[i32; 3]| p[0] < 9 || p[1] < 9;
    let mut kept: Vec<(&str, Vec<[i32; 3]>)> = vec![];
    kept.push((
        "hole",
        points([24, 24, 1]).into_iter().filter(hole).collect(),
    ));
    kept.push((
        "step",
        points([18, 18, 1]).into_iter().filter(step).collect(),
    ));
    for (name, points) in kept {
        for m in [2, 3] {
            let spec = body(2, &points, m);
            let (factors, report) = correct(&spec, SurfaceMethod::Exact).unwrap();
            let report = report.unwrap();
            println!("{name}, horizon {m}: {report:?}");
            let mut spec = spec;
            spec.bonds.surface = Some(factors);
            if report.exact {
                let worst = residual_inside(&spec);
                assert!(worst < 1e-11, "{name}, horizon {m}: {worst:e}");
            } else {
                assert!(spec.bonds.surface.unwrap().warning.is_some());
            }
        }
    }
}

fn total(l: &Ledger) -> f64 {
    l.kinetic + l.strain + l.contact + l.released
}

/// A plate and a block with factors, cracks, contact; and displacements that break some bonds and bring points close.
fn worn() -> Vec<(Spec, Vec<Point>)> {
    let pmb = LawSpec::Pmb(PmbStiffness::Young(3.0));
    let (plate, block) = ((2, [21, 13, 1]), (3, [11, 8, 9]));
    [
        (plate, pmb.clone()),
        (block, pmb),
        (plate, LPS),
        (block, LPS),
    ]
    .into_iter()
    .map(|((d, n), law)| {
        let mut spec = body(d, &points(n), 2);
        spec.materials[0].law = law;
        let mut spec = with(spec, SurfaceMethod::Exact);
        spec.materials[0].fracture = Some(FractureSpec {
            criterion: Criterion::Stretch(0.06),
            alpha: 0.25,
            rate: None,
            fatigue: None,
        });
        spec.interactions.contact = Some(ContactSpec {
            bonded: 0.9,
            free: 1.35,
            stiffness: ContactStiffness::Laws,
            friction: None,
            cohesion: None,
            conductance: None,
        });
        let mut seed = 7u64;
        let mut random = move || {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (seed >> 33) as f64 / (1u64 << 31) as f64 - 0.5
        };
        let count = n.iter().product::<i32>() as usize;
        let u = (0..count)
            .map(|_| std::array::from_fn(|a| if a < d { 0.2 * H * random() } else { 0.0 }))
            .collect();
        (spec, u)
    })
    .collect()
}

#[test]
fn force_is_the_derivative_of_energy_and_momentum_is_kept() {
    for (spec, mut u) in worn() {
        let mut sim = at_rest(&spec, None);
        let volumes = sim.scalars("volume");
        let f = sim.forces_under(&u);
        let size = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let sum: Point =
            std::array::from_fn(|a| f.iter().zip(&volumes).map(|(f, v)| f[a] * v).sum());
        let total: f64 = volumes.iter().sum();
        assert!(
            sum.iter().all(|s| s.abs() < 1e-13 * size * total),
            "{sum:?}"
        );
        let mut energy = |u: &[Point]| {
            sim.set_displacements(u);
            let density = sim.scalars("energy_density");
            density
                .iter()
                .zip(&volumes)
                .map(|(w, v)| w * v)
                .sum::<f64>()
        };
        let step = 1e-5 * H;
        for i in (0..u.len()).step_by(37) {
            for a in 0..spec.space.dimension {
                let mut at = |x: f64| {
                    u[i][a] += x;
                    let w = energy(&u);
                    u[i][a] -= x;
                    w
                };
                let slope = (at(step) - at(-step)) / (2.0 * step);
                let force = f[i][a] * volumes[i];
                assert!(
                    (slope + force).abs() < 1e-6 * size * volumes[i].max(total / u.len() as f64),
                    "point {i}: {slope} against {force}"
                );
            }
        }
    }
}

#[test]
fn breaking_keeps_the_balance_and_all_widths_and_threads_agree_bitwise() {
    for (spec, u) in worn() {
        let mut first: Option<Vec<Point>> = None;
        let widths = Simd::available().into_iter().map(|simd| (simd, 1));
        for (simd, threads) in widths.chain([(Simd::detect(), 3)]) {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let mut spec = spec.clone();
            spec.run.schedule.time_step = TimeStep::Fixed(2e-3);
            let mut sim = at_rest(&spec, Some(simd));
            let small: Vec<Point> = u.iter().map(|u| u.map(|c| 0.7 * c)).collect();
            sim.set_displacements(&small);
            sim.start(true);
            let before = total(&sim.ledger().unwrap());
            pool.install(|| (0..40).for_each(|_| sim.step().unwrap()));
            assert!(sim.broken() > 0);
            let after = sim.ledger().unwrap();
            let change = (total(&after) - before).abs() / before.abs();
            assert!(change < 0.02, "{}: {change}", simd.name());
            let state = sim.displacements();
            match &first {
                None => first = Some(state),
                Some(first) => assert!(*first == state, "{}", simd.name()),
            }
        }
    }
}

#[test]
fn mass_and_volume_are_those_between_the_outermost_points() {
    let spec = with(body(3, &points([11, 7, 8]), 2), SurfaceMethod::Exact);
    let sim = at_rest(&spec, None);
    let volume = 10.0 * 6.0 * 7.0 * H.powi(3);
    assert!((sim.info().volume - volume).abs() < 1e-12 * volume);
    assert!((sim.info().mass - 2.0 * volume).abs() < 1e-12 * volume);
}

#[test]
fn the_stable_step_of_a_large_plate_is_that_of_its_corners() {
    // the smaller body is probed whole, the larger on a block that is folded together
    let step = |n: [i32; 3]| {
        let spec = with(body(2, &points(n), 3), SurfaceMethod::Exact);
        build(&spec, Options::default()).unwrap().info().stable_step
    };
    let (small, large) = (step([60, 50, 1]), step([160, 130, 1]));
    assert!((small / large - 1.0).abs() < 0.01, "{small} {large}");
}

#[test]
fn other_bodies_get_their_own_factors() {
    let mut spec = body(2, &points([12, 12, 1]), 2);
    spec.body = BodySpec::Lattice {
        kind: LatticeKind::Square,
        spacing: H,
        origin: [0.0; 3],
        region: Region::Block {
            low: [0.0; 3],
            high: [8.0, 6.0, 0.0],
        },
        perturb: None,
    };
    let mut spec = with(spec, SurfaceMethod::Volume);
    assert_eq!(spec.bonds.surface.as_ref().unwrap().row.len(), 17 * 13);
    if let BodySpec::Lattice { spacing, .. } = &mut spec.body {
        *spacing = 0.5 * H;
    }
    let stale = build(&spec, Options::default()).err().unwrap();
    assert!(stale.message.contains("do not fit this body"), "{stale}");
    renew(&mut spec).unwrap();
    assert_eq!(spec.bonds.surface.as_ref().unwrap().row.len(), 33 * 25);
    assert!(build(&spec, Options::default()).is_ok());
}

#[test]
fn tangents_are_differences_of_forces() {
    for (mut spec, u) in worn() {
        spec.materials[0].fracture = None;
        spec.interactions.contact = None;
        let mut sim = at_rest(&spec, None);
        let u: Vec<Point> = u.iter().map(|u| u.map(|c| 0.5 * c)).collect();
        sim.set_displacements(&u);
        let direction = |k: usize| -> Point {
            std::array::from_fn(|a| match a < spec.space.dimension {
                true => ((3 * k + a) as f64 * 1.7).sin(),
                false => 0.0,
            })
        };
        let linear = |sim: &mut dyn Simulation| -> Vec<Point> {
            let all: Vec<Point> = (0..u.len()).map(direction).collect();
            match sim.linear_body() {
                AnyLinearBody::One(_) => unreachable!("plates and blocks"),
                AnyLinearBody::Two(body) => {
                    let d: Vec<[f64; 2]> = all.iter().map(|d| [d[0], d[1]]).collect();
                    let of = |i| body.force(&d, i);
                    (0..d.len()).map(of).map(|f| [f[0], f[1], 0.0]).collect()
                }
                AnyLinearBody::Three(body) => (0..all.len()).map(|i| body.force(&all, i)).collect(),
            }
        };
        let answer = linear(sim.as_mut());
        let step = 1e-6 * H;
        let mut moved = |by: f64| {
            let x: Vec<Point> = (u.iter().enumerate())
                .map(|(k, u)| std::array::from_fn(|a| u[a] + by * direction(k)[a]))
                .collect();
            sim.forces_under(&x)
        };
        let (more, less) = (moved(step), moved(-step));
        let size = answer.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        for ((t, a), b) in answer.iter().zip(&more).zip(&less) {
            for k in 0..3 {
                let slope = (a[k] - b[k]) / (2.0 * step);
                assert!((slope - t[k]).abs() < 1e-7 * size, "{slope} {}", t[k]);
            }
        }
    }
}
