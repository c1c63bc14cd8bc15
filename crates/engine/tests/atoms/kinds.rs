//! Several kinds of atoms: energies against sums over all pairs, forces and tangents against differences, the same bits on any number
//! of threads and any width, and what is refused.

use crate::sample::Noise;
use peridyne::execute::simd::Simd;
use peridyne::expression::Expression;
use peridyne::law::potential::Potential;
use peridyne::law::potential::buckingham::Buckingham;
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::law::potential::morse::Morse;
use peridyne::law::potential::no_potential::NoPotential;
use peridyne::law::potential::tabulated::{Eam, Tabulated};
use peridyne::law::terms::Near;
use peridyne::run::{Options, Registry, Simulation, build};
use peridyne::space::Point;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;
use std::sync::Arc;

const CELLS: usize = 5;
const PERIOD: f64 = 1.1 * CELLS as f64;

fn lj(epsilon: f64, sigma: f64, cutoff: f64) -> PotentialSpec {
    PotentialSpec::of(LennardJones { epsilon, sigma }).ended(cutoff, End::Truncated)
}

/// A shaken cubic crystal in a periodic box, whose atoms have these potentials with their own, and unlike masses.
fn mixed(own: &[PotentialSpec], potentials: Vec<ActingSpec>, mixing: Option<Mixing>) -> Spec {
    let mut noise = Noise(11);
    let (mut position, mut mark) = (vec![], vec![]);
    for n in 0..CELLS.pow(3) {
        let site = [n % CELLS, n / CELLS % CELLS, n / CELLS / CELLS];
        position.push(site.map(|c| 1.1 * c as f64 + 0.12 * noise.next()));
        mark.push(((noise.next() + 0.5) * own.len() as f64) as i32);
    }
    let cloud = Cloud {
        volume: vec![0.5; position.len()],
        position,
        mark,
        ..Cloud::default()
    };
    let law = LawSpec::Atoms(own[0].clone());
    let mut spec = Spec::new(3, BodySpec::Cloud(cloud), 1.0, law);
    spec.space.periodic = [Some(PERIOD); 3];
    spec.materials.clear();
    for (n, potential) in own.iter().enumerate() {
        let name = format!("k{n}");
        spec.sets.push(SetSpec {
            name: name.clone(),
            members: Members::Mark(n as i32),
        });
        spec.materials.push(MaterialSpec {
            set: name.clone(),
            name,
            density: 1.0 + n as f64,
            law: LawSpec::Atoms(potential.clone()),
            fracture: None,
        });
    }
    spec.interactions.potentials = potentials;
    spec.interactions.mixing = mixing;
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    spec.run.schedule.force_unstable = true;
    spec
}

fn between(i: usize, j: usize, potential: PotentialSpec) -> ActingSpec {
    ActingSpec {
        potential,
        on: Acting::Between([i, j]),
    }
}

/// Positions and kinds.
fn atoms_of(spec: &Spec) -> (Vec<Point>, Vec<usize>) {
    let BodySpec::Cloud(cloud) = &spec.body else {
        panic!()
    };
    let kind = cloud.mark.iter().map(|m| *m as usize).collect();
    (cloud.position.clone(), kind)
}

/// From one to another, the nearest image.
fn vector(x: Point, y: Point) -> Point {
    std::array::from_fn(|a| {
        let d = y[a] - x[a];
        d - PERIOD * (d / PERIOD).round()
    })
}

fn square(y: Point) -> f64 {
    y.iter().map(|c| c * c).sum()
}

/// Σ over pairs of what `phi` says of kinds and squared distance.
fn pairs(spec: &Spec, phi: impl Fn(usize, usize, f64) -> f64) -> f64 {
    let (x, kind) = atoms_of(spec);
    let mut sum = 0.0;
    for i in 0..x.len() {
        for j in 0..i {
            sum += phi(
                kind[i].min(kind[j]),
                kind[i].max(kind[j]),
                square(vector(x[i], x[j])),
            );
        }
    }
    sum
}

fn untrusted() -> Options {
    Options {
        trust_time_step: true,
        ..Options::default()
    }
}

fn started(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = build(spec, untrusted()).unwrap_or_else(|e| panic!("{e}: {:?}", e.help));
    sim.start(true);
    sim
}

/// Forces are −∂energy, the sum of forces is nothing, the virial is the trace of Σ x f, and tangents are slopes of forces.
fn consistent(name: &str, spec: &Spec) {
    let mut sim = started(spec);
    let (f, v) = (sim.vectors("force_density"), sim.scalars("volume"));
    let size = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    for a in 0..3 {
        let total: f64 = f.iter().zip(&v).map(|(f, v)| f[a] * v).sum();
        assert!(total.abs() < 1e-11 * size, "{name}: momentum {total}");
    }
    let n = f.len();
    let mut energy = |u: &[Point]| {
        sim.set_displacements(u);
        sim.start(true);
        sim.ledger().unwrap().strain
    };
    for i in [0, 3, n / 2, n - 1] {
        for a in 0..3 {
            let mut at = |h: f64| {
                let mut u = vec![[0.0; 3]; n];
                u[i][a] = h;
                energy(&u)
            };
            let h = 1e-4;
            let slope = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
            let exact = -f[i][a] * v[i];
            assert!(
                (slope - exact).abs() < 2e-7 * size,
                "{name}: atom {i}: {slope} is not {exact}"
            );
        }
    }
    let mut model = started(spec);
    let body = model.linear_body().of::<3>().unwrap();
    assert!(body.soundness().asymmetry < 1e-11, "{name}");
    let mut noise = Noise(5);
    let change: Vec<Point> = (0..n)
        .map(|_| std::array::from_fn(|_| noise.next()))
        .collect();
    let mut at = |s: f64| {
        let u: Vec<Point> = change.iter().map(|c| c.map(|c| s * 1e-5 * c)).collect();
        model.forces_under(&u)
    };
    let (plus, minus) = (at(1.0), at(-1.0));
    let (mut worst, mut most) = (0.0f64, 0.0f64);
    for i in 0..n {
        let exact = body.force(&change, i);
        for a in 0..3 {
            let slope = (plus[i][a] - minus[i][a]) / 2e-5;
            worst = worst.max((slope - exact[a]).abs());
            most = most.max(exact[a].abs());
        }
    }
    assert!(worst < 3e-6 * most, "{name}: {worst:e} of {most:e}");
}

/// The energy of all terms of all sites is that of the body.
fn sites_agree(name: &str, spec: &Spec, energy: f64) {
    let sites = Registry::standard().sites_of(spec).unwrap();
    let (x, kind) = atoms_of(spec);
    let mut sum = 0.0;
    for i in 0..x.len() {
        let near: Vec<Near> = { (0..x.len()).filter(|j| *j != i) }
            .map(|j| Near {
                kind: kind[j] as u32,
                y: vector(x[i], x[j]),
            })
            .filter(|n| n.square() < sites.reach().powi(2))
            .collect();
        sites.terms(kind[i] as u32, &near, &mut |t| {
            assert!(t.part < sites.parts().len());
            sum += t.energy;
        });
    }
    assert!(
        (sum - energy).abs() < 1e-11 * energy.abs(),
        "{name}: {sum} is not {energy}"
    );
}

/// Ends without a jump, so that differences mean something.
fn smooth(potential: PotentialSpec, cutoff: f64) -> PotentialSpec {
    potential.ended(cutoff, End::ShiftedForce)
}

#[test]
fn a_mixture_by_a_rule_with_an_explicit_pair() {
    let own = [lj(1.0, 0.9, 2.2), lj(0.4, 1.1, 2.6), lj(0.7, 1.0, 2.0)];
    let explicit = lj(1.7, 0.95, 1.9);
    let acting = vec![between(2, 0, explicit)];
    let spec = mixed(&own, acting, Some(Mixing::Arithmetic));
    let found = started(&spec).ledger().unwrap().strain;
    let constants = [(1.0, 0.9, 2.2), (0.4, 1.1, 2.6), (0.7, 1.0, 2.0)];
    let exact = pairs(&spec, |i, j, q| {
        let ((e, s, c), (f, t, d)) = (constants[i], constants[j]);
        let (epsilon, sigma, cutoff) = match (i, j) {
            (0, 2) => (1.7, 0.95, 1.9),
            _ => (f64::sqrt(e * f), 0.5 * (s + t), 0.5 * (c + d)),
        };
        match q < cutoff * cutoff {
            true => LennardJones { epsilon, sigma }.pair(q),
            false => 0.0,
        }
    });
    assert!(
        (found - exact).abs() < 1e-12 * exact.abs(),
        "{found} {exact}"
    );
    sites_agree("mixture", &spec, found);
    let shifted = |epsilon, sigma, c| smooth(PotentialSpec::of(LennardJones { epsilon, sigma }), c);
    let own = [shifted(1.0, 0.9, 2.2), shifted(0.4, 1.1, 2.6)];
    consistent("mixture", &mixed(&own, vec![], Some(Mixing::SixthPower)));
}

#[test]
fn potentials_of_one_body_are_added() {
    let (depth, alpha, distance) = (0.6, 4.0, 1.0);
    let morse = Morse {
        depth,
        alpha,
        distance,
    };
    let salt = Buckingham {
        strength: 300.0,
        range: 0.2,
        dispersion: 0.8,
    };
    let own = [
        smooth(PotentialSpec::of(morse), 2.0),
        PotentialSpec::of(NoPotential),
        lj(0.8, 1.0, 2.0).ended(2.0, End::ShiftedForce),
    ];
    let acting = vec![
        between(0, 1, smooth(PotentialSpec::of(salt), 1.8)),
        between(0, 2, PotentialSpec::of(NoPotential)),
        between(1, 2, lj(0.3, 1.0, 2.4).ended(2.4, End::ShiftedForce)),
        // on top of its own
        between(0, 0, lj(0.2, 0.9, 2.3).ended(2.3, End::ShiftedForce)),
        between(2, 2, lj(0.5, 0.8, 1.9).ended(1.9, End::ShiftedForce)),
    ];
    let spec = mixed(&own, acting, None);
    let sum = pairs(&spec, |i, j, q| {
        use peridyne::law::potential::cut::{Cut, Ends};
        let end = |cutoff| Ends {
            cutoff,
            end: End::ShiftedForce,
        };
        let within = |c: f64, e: f64| if q < c * c { e } else { 0.0 };
        let lj = |epsilon, sigma, c| {
            within(c, Cut::new(LennardJones { epsilon, sigma }, end(c)).pair(q))
        };
        match (i, j) {
            (0, 0) => within(2.0, Cut::new(morse, end(2.0)).pair(q)) + lj(0.2, 0.9, 2.3),
            (0, 1) => within(1.8, Cut::new(salt, end(1.8)).pair(q)),
            (1, 2) => lj(0.3, 1.0, 2.4),
            (2, 2) => lj(0.8, 1.0, 2.0) + lj(0.5, 0.8, 1.9),
            _ => 0.0,
        }
    });
    let mut sim = started(&spec);
    let found = sim.ledger().unwrap().strain;
    assert!((found - sum).abs() < 1e-12 * sum.abs(), "{found} {sum}");
    // a pair is one bond, however many potentials it has
    let reach = |i, j| match (i, j) {
        (0, 0) => 2.3,
        (0, 1) => 1.8,
        (1, 2) => 2.4,
        (2, 2) => 2.0,
        _ => 0.0f64,
    };
    let bonds = pairs(&spec, |i, j, q| {
        f64::from(u8::from(q < reach(i, j) * reach(i, j)))
    });
    assert_eq!(sim.info().directed_bonds, 2 * bonds as u64);
    let sizes: u64 = sim.families().size.iter().map(|n| *n as u64).sum();
    assert_eq!(sizes, 2 * bonds as u64);
    sites_agree("sum", &spec, found);
    consistent("sum", &spec);
}

/// Of bonded pairs all potentials between their kinds are left out in the same part, whatever these are.
#[test]
fn molecules_of_several_kinds_and_potentials() {
    use peridyne::law::potential::cut::{Cut, Ends};
    let own = [
        smooth(lj(1.0, 0.9, 2.2), 2.2),
        smooth(lj(0.4, 1.1, 2.0), 2.0),
    ];
    let more = vec![
        between(0, 0, smooth(lj(0.2, 0.8, 1.9), 1.9)),
        between(0, 1, smooth(lj(0.7, 1.0, 2.1), 2.1)),
    ];
    let mut spec = mixed(&own, more, None);
    let bonds: Vec<[usize; 2]> = (0..CELLS.pow(3))
        .filter(|n| matches!(n % CELLS, 0 | 2))
        .map(|n| [n, n + 1])
        .collect();
    let (stiffness, length, left) = (20.0, 1.05, 0.3);
    spec.interactions.bonded = Some(Arc::new(BondedSpec {
        forms: vec![Form::HarmonicBond { stiffness, length }],
        terms: { bonds.iter() }
            .map(|[a, b]| BondedTerm {
                form: 0,
                points: [*a as u32, *b as u32, 0, 0],
            })
            .collect(),
        special: [left, 0.0, 0.0],
    }));
    let phi = |i: usize, j: usize, q: f64| {
        let lj = |epsilon, sigma, cutoff: f64| {
            let end = Ends {
                cutoff,
                end: End::ShiftedForce,
            };
            match q < cutoff * cutoff {
                true => Cut::new(LennardJones { epsilon, sigma }, end).pair(q),
                false => 0.0,
            }
        };
        match (i, j) {
            (0, 0) => lj(1.0, 0.9, 2.2) + lj(0.2, 0.8, 1.9),
            (0, 1) => lj(0.7, 1.0, 2.1),
            _ => lj(0.4, 1.1, 2.0),
        }
    };
    let (x, kind) = atoms_of(&spec);
    let mut exact = pairs(&spec, phi);
    let mut seen = [false; 3];
    for [a, b] in bonds {
        let q = square(vector(x[a], x[b]));
        seen[kind[a] + kind[b]] = true;
        exact += stiffness * (q.sqrt() - length).powi(2);
        exact -= (1.0 - left) * phi(kind[a].min(kind[b]), kind[a].max(kind[b]), q);
    }
    assert_eq!(seen, [true; 3]);
    let found = started(&spec).ledger().unwrap().strain;
    assert!(
        (found - exact).abs() < 1e-11 * exact.abs(),
        "{found} {exact}"
    );
    consistent("molecules", &spec);
}

/// The work on a bond is that of all potentials between its ends: parts of one break what the whole of it breaks, also where each part knows some
/// pairs of kinds alone.
#[test]
fn bonds_of_several_potentials_break_by_the_work_of_all() {
    let whole = |part: f64| smooth(lj(part, 1.0, 1.7), 1.7);
    let nothing = PotentialSpec::of(NoPotential);
    let halves = ["x + y < 4", "x + y >= 4"];
    let spec = |own: &[PotentialSpec], more: Vec<ActingSpec>, energy: f64| {
        let mut spec = mixed(own, more, None);
        spec.space.periodic = [None; 3];
        let high = [5.9, 4.8, 3.7];
        let block = Region::Block {
            low: [-0.1; 3],
            high,
        };
        spec.body = BodySpec::lattice(LatticeKind::Cubic, 1.1, block);
        for (set, text) in spec.sets.iter_mut().zip(halves) {
            set.members = match own.len() {
                1 => Members::Where(Expression::parse("x > -1", &[]).unwrap()),
                _ => Members::Where(Expression::parse(text, &[]).unwrap()),
            };
        }
        for m in &mut spec.materials {
            m.density = 1.0;
            m.fracture = Some(FractureSpec::new(Criterion::BondEnergy(energy)));
        }
        spec.bonds.horizon = Horizon::Length(1.7);
        spec.bonds.family = FamilyChoice::Reference;
        spec.loading.initial = vec![InitialSpec {
            set: "all".into(),
            displacement: [None, None, None],
            velocity: ["1.5*(x - 2.7)", "0.3*sin(y)", "0.2*cos(3*x)"]
                .map(|v| Some(Expression::parse(v, &[]).unwrap())),
        }];
        spec
    };
    let run = |spec: &Spec| {
        let mut sim = started(spec);
        for _ in 0..300 {
            sim.step().unwrap();
        }
        (sim.broken(), sim.displacements(), sim.info().directed_bonds)
    };
    let energy = 0.7;
    let (broken, u, bonds) = run(&spec(&[whole(1.0)], vec![], energy));
    assert!(broken > 0);
    let parts = [
        spec(&[whole(0.6)], vec![between(0, 0, whole(0.4))], energy),
        spec(
            &[whole(0.7), nothing],
            vec![
                between(0, 0, whole(0.3)),
                between(0, 1, whole(1.0)),
                between(1, 1, whole(0.25)),
                between(1, 1, whole(0.75)),
            ],
            energy,
        ),
    ];
    for spec in &parts {
        let (found, v, directed) = run(spec);
        assert_eq!((found, directed), (broken, bonds));
        for (a, b) in u.iter().flatten().zip(v.iter().flatten()) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
    }
    // a part that breaks by its own work alone would break later
    let (fewer, ..) = run(&spec(&[whole(1.0)], vec![], 1e3 * energy));
    assert_eq!(fewer, 0);
}

/// Two elements whose densities depend on both ends, as eam/fs has them.
fn tables() -> [TableSpec; 2] {
    let (n, cutoff) = (600, 2.1);
    let step = cutoff / (n - 1) as f64;
    let fade = |r: f64| (1.0 - (r / cutoff).powi(2)).powi(4);
    let table = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        (0..n)
            .map(|m| f(step * m as f64) * fade(step * m as f64))
            .collect()
    };
    let pair = |a: f64| table(&|r| a * (-3.0 * (r - 1.0)).exp() * (r + 0.1));
    let density = |b: f64, decay: f64| table(&|r| b * (-decay * (r - 1.0)).exp());
    let embedding =
        |c: f64| -> Vec<f64> { (0..n).map(|m| -c * (0.01 * m as f64).sqrt()).collect() };
    let one = |name: &str, other: &str, [a, own, from, c]: [f64; 4]| TableSpec {
        density_step: 0.01,
        embedding: embedding(c),
        step,
        density: density(own, 2.0),
        pair: pair(a),
        cutoff,
        element: name.into(),
        partners: vec![PartnerTable {
            element: other.into(),
            density: density(from, 2.5),
            pair: pair(0.31),
        }],
    };
    [
        one("Aa", "Bb", [0.4, 0.2, 0.35, 1.3]),
        one("Bb", "Aa", [0.25, 0.3, 0.15, 0.8]),
    ]
}

#[test]
fn an_alloy_whose_densities_know_both_ends() {
    let tables = tables();
    let own = tables.clone().map(|t| PotentialSpec::of(Eam::new(t)));
    let spec = mixed(&own, vec![], None);
    let made: Vec<Tabulated> = tables.iter().map(Tabulated::new).collect();
    let across = [[0, 1], [1, 0]].map(|[a, b]| Tabulated::between(&tables[a], &tables[b]).unwrap());
    let (x, kind) = atoms_of(&spec);
    let limit = tables[0].cutoff.powi(2);
    let mut exact = 0.0;
    for i in 0..x.len() {
        let mut density = 0.0;
        for j in (0..x.len()).filter(|j| *j != i) {
            let q = square(vector(x[i], x[j]));
            if q < limit {
                let p = match kind[i] == kind[j] {
                    true => &made[kind[i]],
                    false => &across[kind[i]],
                };
                density += p.density(q);
                exact += 0.5 * p.pair(q);
            }
        }
        exact += made[kind[i]].embedding(density);
    }
    let found = started(&spec).ledger().unwrap().strain;
    assert!(
        (found - exact).abs() < 1e-12 * exact.abs(),
        "{found} {exact}"
    );
    sites_agree("alloy", &spec, found);
    consistent("alloy", &spec);
    // a third kind that is no metal
    let mut own = own.to_vec();
    own.push(smooth(lj(0.2, 1.0, 2.0), 2.0));
    let acting = vec![
        between(0, 2, smooth(lj(0.3, 0.9, 2.2), 2.2)),
        between(1, 2, smooth(lj(0.1, 0.9, 2.2), 2.2)),
        between(0, 1, smooth(lj(0.05, 0.9, 2.0), 2.0)),
    ];
    let spec = mixed(&own, acting, None);
    let found = started(&spec).ledger().unwrap().strain;
    sites_agree("alloy in a gas", &spec, found);
    consistent("alloy in a gas", &spec);
}

/// Kinds that are told apart and have the same constants are one.
#[test]
fn kinds_of_the_same_constants_are_one() {
    let one = lj(0.9, 1.0, 2.3);
    let own = vec![one.clone(); 3];
    let alike = mixed(&own, vec![], None);
    let apart = mixed(&own, vec![], Some(Mixing::Geometric));
    let told = { (0..3).flat_map(|i| (0..i).map(move |j| (i, j))) }
        .map(|(i, j)| between(i, j, one.clone()))
        .collect();
    let told = mixed(&own, told, None);
    let [mut a, mut b] = [&alike, &told].map(started);
    for _ in 0..50 {
        a.step().unwrap();
        b.step().unwrap();
    }
    for (x, y) in a
        .displacements()
        .iter()
        .flatten()
        .zip(b.displacements().iter().flatten())
    {
        assert!((x - y).abs() < 1e-12, "{x} {y}");
    }
    let [a, b] = [&alike, &apart].map(|s| started(s).vectors("force_density"));
    assert_eq!(a, b, "a rule that mixes nothing");
}

#[test]
fn threads_and_widths_do_not_show() {
    let own = tables().map(|t| PotentialSpec::of(Eam::new(t))).to_vec();
    let metal = mixed(&own, vec![], None);
    let mixture = mixed(
        &[lj(1.0, 0.9, 2.2), lj(0.4, 1.1, 2.6)],
        vec![between(0, 0, lj(0.1, 1.0, 2.0))],
        Some(Mixing::Arithmetic),
    );
    let anyhow = ["x*y + z > 2", "x*y + z <= 2"];
    let crystal = fixed(metal.clone(), LatticeKind::Cubic, &anyhow);
    for spec in [metal, mixture, crystal] {
        let trace = |threads: usize, simd: Simd| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| {
                let options = Options {
                    simd: Some(simd),
                    ..untrusted()
                };
                let mut sim = build(&spec, options).unwrap();
                sim.start(true);
                for _ in 0..40 {
                    sim.step().unwrap();
                }
                let bits = |x: Vec<Point>| x.into_iter().flatten().map(f64::to_bits);
                let mut all: Vec<u64> = bits(sim.displacements()).collect();
                all.extend(bits(sim.vectors("force_density")));
                all.extend(sim.virial().map(f64::to_bits));
                all.push(sim.ledger().unwrap().strain.to_bits());
                all
            })
        };
        let first = trace(1, Simd::detect());
        for simd in Simd::available() {
            for threads in [1, 3] {
                assert!(trace(threads, simd) == first, "{threads} {}", simd.name());
            }
        }
    }
}

/// The same atoms on sites of a lattice, kind by kind as an expression says, on fixed neighbours two spacings away.
fn fixed(mut spec: Spec, kind: LatticeKind, which: &[&str]) -> Spec {
    let edge = 1.1 * (CELLS - 1) as f64 + 0.1;
    let cells = Region::Block {
        low: [-0.1; 3],
        high: [edge + 0.55; 3],
    };
    spec.body = BodySpec::lattice(kind, 1.1, cells);
    for (set, text) in spec.sets.iter_mut().zip(which) {
        set.members = Members::Where(Expression::parse(text, &[]).unwrap());
    }
    spec.bonds.horizon = Horizon::Ratio(2);
    spec.bonds.family = FamilyChoice::Stencil;
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    spec
}

/// While nobody changes partners, fixed neighbours are those that are near.
#[test]
fn fixed_neighbours_of_several_kinds() {
    let anyhow = [
        "sin(12.9*x + 78.2*y + 37.7*z) > 0",
        "sin(12.9*x + 78.2*y + 37.7*z) <= 0",
    ];
    let metals = tables().map(|t| PotentialSpec::of(Eam::new(t))).to_vec();
    let gases = [
        smooth(lj(1.0, 0.9, 2.05), 2.05),
        smooth(lj(0.4, 1.1, 1.8), 1.8),
    ];
    let half = PotentialSpec::of(NoPotential);
    let morse = PotentialSpec::of(Morse {
        depth: 0.6,
        alpha: 4.0,
        distance: 1.0,
    });
    let several = vec![
        between(0, 1, smooth(morse, 2.0)),
        between(0, 0, smooth(lj(0.2, 0.9, 2.0), 2.0)),
    ];
    for (name, spec) in [
        ("gases", mixed(&gases, vec![], Some(Mixing::Arithmetic))),
        ("alloy", mixed(&metals, vec![], None)),
        (
            "nothing between",
            mixed(&gases, vec![between(0, 1, half)], None),
        ),
        ("sum", mixed(&gases, several, None)),
    ] {
        let spec = fixed(spec, LatticeKind::Cubic, &anyhow);
        let mut near = spec.clone();
        near.bonds.family = FamilyChoice::Neighbours;
        near.bonds.horizon = Horizon::Length(2.1);
        let (mut a, mut b) = (started(&spec), started(&near));
        assert_eq!(a.info().points as usize, CELLS.pow(3));
        let mut noise = Noise(3);
        let u: Vec<Point> = (0..CELLS.pow(3))
            .map(|_| std::array::from_fn(|_| 0.03 * noise.next()))
            .collect();
        for sim in [&mut a, &mut b] {
            sim.set_displacements(&u);
            sim.start(true);
        }
        let of = |sim: &mut dyn Simulation| {
            let mut all = sim.vectors("force_density");
            all.push([sim.ledger().unwrap().strain, 0.0, 0.0]);
            all
        };
        let (a, b) = (of(a.as_mut()), of(b.as_mut()));
        let most = b.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        for (x, y) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!((x - y).abs() < 1e-12 * most, "{name}: {x} {y}");
        }
        consistent(name, &spec);
    }
}

#[test]
fn what_is_missing_is_named() {
    let own = [lj(1.0, 1.0, 2.2), lj(0.4, 1.1, 2.2)];
    let told = |spec: &Spec| {
        let error = build(spec, untrusted()).err().expect("refused");
        format!(
            "{}: {} {}",
            error.path,
            error.message,
            error.help.unwrap_or_default()
        )
    };
    let message = told(&mixed(&own, vec![], None));
    assert!(
        message.contains("no potential is given between atoms of `k0` and of `k1`"),
        "{message}"
    );
    assert!(message.contains("mixing = "), "{message}");
    let [alloy, other] = tables().map(|t| PotentialSpec::of(Eam::new(t)));
    let message = told(&mixed(
        &[alloy.clone(), own[0].clone()],
        vec![],
        Some(Mixing::Geometric),
    ));
    assert!(
        message.contains("no potential is given between"),
        "{message}"
    );
    let message = told(&mixed(
        &[alloy.clone(), own[0].clone()],
        vec![between(0, 1, other.clone())],
        None,
    ));
    assert!(message.contains("no sum over pairs"), "{message}");
    let mut stranger = tables()[1].clone();
    stranger.partners.clear();
    let message = told(&mixed(
        &[alloy, PotentialSpec::of(Eam::new(stranger))],
        vec![],
        None,
    ));
    assert!(message.contains("say nothing of each other"), "{message}");
    let ends = [own[0].clone(), smooth(own[1].clone(), 2.2)];
    let message = told(&mixed(&ends, vec![], Some(Mixing::Geometric)));
    assert!(message.contains("end in different ways"), "{message}");
    let nothing = PotentialSpec::of(NoPotential);
    let acting = vec![between(0, 1, nothing.clone())];
    let message = told(&mixed(&[nothing.clone(), nothing], acting, None));
    assert!(message.contains("no potential acts"), "{message}");
}
