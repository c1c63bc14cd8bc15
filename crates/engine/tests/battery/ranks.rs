//! Ranks that share a body: the same bits as one that has all of it.

use crate::own_law::Stiffening;
use crate::sample::*;
use peridyne::body::Body;
use peridyne::columns::{Declaration, Life, On};
use peridyne::execute::simd::Simd;
use peridyne::law::material::bonds::Bonds;
use peridyne::observe::Values;
use peridyne::run::ranks::{RankModel, shared};
use peridyne::run::{Options, Shelf, Simulation, build_in};
use peridyne::space::lattice::{Lattice, LatticeKind};
use peridyne::spec::*;
use peridyne_comm::on_threads;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Bodies of several blocks of 512 points, whose borders lie within layers.
fn place(kind: LatticeKind) -> Place {
    Place {
        kind,
        plane: Plane::Stress,
        ratio: if kind.dimension() == 3 { 2 } else { 3 },
        cells: match kind.dimension() {
            1 => [2200, 1, 1],
            2 => [45, 49, 1],
            _ => [11, 9, 21],
        },
    }
}

/// A body that is thrown apart, with a hole where several ranks have points.
fn torn(case: &Case, periodic: bool) -> Spec {
    let mut spec = if periodic {
        case.periodic()
    } else {
        case.spec()
    };
    if let BodySpec::Sites { quarters, .. } = &mut spec.body {
        let middle = case.place.cells.map(|n| 2 * n as i32);
        quarters.retain(|q| (0..3).any(|a| (q[a] - middle[a]).abs() > 12));
    }
    breaking(&mut spec, 0.02);
    let around = "0.3*sin(1.1*x)*cos(0.9*y + 1.3*z)";
    let along = "0.2*cos(1.2*x + 1.7*y)";
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [const { None }; 3],
        velocity: match case.d() {
            1 => [Some(e(&around.replace(['y', 'z'], "0"))), None, None],
            2 => [Some(e(&around.replace('z', "0"))), Some(e(along)), None],
            _ => [Some(e(around)), Some(e(along)), Some(e(around))],
        },
    }];
    spec.run.schedule.time_step = TimeStep::Fixed(0.05 * H);
    spec
}

const STEPS: usize = 6;

/// What points have, by column: the words of each, in the order of ids.
type Columns = BTreeMap<String, Vec<Vec<u64>>>;

/// Of each point its numbers, as words.
fn words(values: Values) -> Vec<Vec<u64>> {
    fn of<const N: usize>(all: Vec<[f64; N]>) -> Vec<Vec<u64>> {
        all.iter().map(|x| x.map(f64::to_bits).to_vec()).collect()
    }
    match values {
        Values::Scalars(all) => all.iter().map(|x| vec![x.to_bits()]).collect(),
        Values::Vectors(all) => of(all),
        Values::Symmetric(all) => of(all),
        Values::Tensors(all) => of(all),
        Values::Integers(all) => all.iter().map(|x| vec![*x as u64]).collect(),
        Values::Counts(all) => all.iter().map(|x| vec![u64::from(*x)]).collect(),
    }
}

fn options(simd: Option<Simd>) -> Options {
    Options {
        simd,
        trust_time_step: true,
    }
}

fn shelf() -> Shelf {
    Shelf::standard().with::<Bonds<Stiffening, 1>>()
}

/// Columns of points after some steps, strain energy, and how many bonds broke.
fn alone<const D: usize>(spec: &Spec) -> (Columns, f64, u64) {
    let mut sim = build_in::<D>(spec, options(None), &shelf()).unwrap();
    sim.start(true);
    (0..STEPS).for_each(|_| sim.step().unwrap());
    let state = |c: &Declaration| c.on == On::Points && c.life == Life::Persistent;
    let names = sim.columns().into_iter().filter(state);
    let names: Vec<_> = names.map(|c| c.name).collect();
    let column = |name: &Cow<str>| (name.to_string(), words(sim.column(name).unwrap().values));
    let columns = names.iter().map(column).collect();
    (columns, sim.ledger().unwrap().strain, sim.summary().broken)
}

/// The same of ranks.
fn among<const D: usize>(spec: &Spec, ranks: usize, simd: Option<Simd>) -> (Columns, f64) {
    let all = on_threads(ranks, |comm| {
        let comm = Arc::new(comm);
        let mut sim = RankModel::<D>::new(spec, options(simd), &shelf(), &comm).unwrap();
        sim.start();
        (0..STEPS).for_each(|_| sim.step().unwrap());
        let names: Vec<_> = sim.columns().into_iter().map(|c| c.name).collect();
        let columns: Vec<_> = { names.iter() }
            .map(|name| (name.to_string(), words(sim.column(name).unwrap().values)))
            .collect();
        let energy = sim.energy()[0];
        (sim.ids().to_vec(), sim.points(), columns, energy)
    });
    let points = all[0].1;
    let mut joined = Columns::new();
    for (ids, _, columns, energy) in &all {
        assert_eq!(energy.to_bits(), all[0].3.to_bits());
        for (name, values) in columns {
            let whole = { joined.entry(name.clone()) }.or_insert_with(|| vec![vec![]; points]);
            assert_eq!(ids.len(), values.len(), "{name}");
            for (id, value) in ids.iter().zip(values) {
                let old = std::mem::replace(&mut whole[*id as usize], value.clone());
                assert!(old.is_empty(), "two ranks have point {id}");
            }
        }
    }
    (joined, all[0].3)
}

/// The same bits on so many ranks, if anybody can share it. Whether something broke.
fn same<const D: usize>(spec: &Spec, ranks: &[usize], simd: Option<Simd>) -> bool {
    shared(spec).unwrap();
    let name = &spec.title;
    let (columns, energy, broken) = alone::<D>(spec);
    assert!(
        ["displacement", "velocity"]
            .iter()
            .all(|name| columns.contains_key(*name))
    );
    for n in ranks {
        let (found, of_ranks) = among::<D>(spec, *n, simd);
        assert!(columns.keys().eq(found.keys()), "{name}");
        for (column, wanted) in &columns {
            let off = { wanted.iter().zip(&found[column]) }.position(|(a, b)| a != b);
            assert_eq!(off, None, "{name}, {n} ranks: {column} of a point");
        }
        assert_eq!(energy.to_bits(), of_ranks.to_bits(), "{name}, {n} ranks");
    }
    broken > 0
}

fn same_of(case: &Case, periodic: bool, ranks: &[usize], simd: Option<Simd>) -> bool {
    let spec = torn(case, periodic);
    match case.d() {
        1 => same::<1>(&spec, ranks, simd),
        2 => same::<2>(&spec, ranks, simd),
        _ => same::<3>(&spec, ranks, simd),
    }
}

#[test]
fn every_material_has_the_same_bits_on_any_number_of_ranks() {
    let kinds = [
        LatticeKind::Chain,
        LatticeKind::Square,
        LatticeKind::Triangular,
        LatticeKind::Cubic,
    ];
    let mut torn = 0;
    let mut tried = 0;
    for (n, material) in materials().into_iter().enumerate() {
        // each on a lattice of its own dimension, in turn
        let lives = |kind: &&LatticeKind| (material.lives)(kind.dimension(), Plane::Stress);
        let kinds: Vec<_> = kinds.iter().filter(lives).collect();
        let Some(kind) = kinds.get(n % kinds.len().max(1)) else {
            continue;
        };
        let case = Case {
            place: place(**kind),
            material,
        };
        tried += 1;
        torn += u32::from(same_of(&case, n % 2 == 0, &[2 + n % 2], None));
    }
    assert!(tried > 35 && torn > 30, "{tried} {torn}");
}

#[test]
fn every_lattice_has_the_same_bits_on_ranks_of_any_width() {
    let kinds = [
        LatticeKind::Chain,
        LatticeKind::Square,
        LatticeKind::Triangular,
        LatticeKind::Cubic,
        LatticeKind::Bcc,
        LatticeKind::Fcc,
        LatticeKind::Diamond,
    ];
    let mut widths = Simd::available().into_iter().cycle();
    for (n, kind) in kinds.into_iter().enumerate() {
        let mut place = place(kind);
        if kind.basis().len() > 1 && kind.dimension() == 3 {
            (place.ratio, place.cells) = (1, [7, 9, 23]);
        }
        for (k, name) in ["pmb", "lps", "elastic-plastic"].into_iter().enumerate() {
            let case = Case::of(name, place);
            let ranks = [1, 2 + (n + k) % 3];
            same_of(&case, (n + k) % 2 == 0, &ranks, widths.next());
        }
    }
}

/// A bond that bears more than any point of its rank allows breaks by its other end.
#[test]
fn bonds_break_by_the_weaker_end_whoever_has_it() {
    let place = Place {
        kind: LatticeKind::Cubic,
        plane: Plane::Stress,
        ratio: 3,
        cells: [24, 24, 24],
    };
    for name in ["pmb", "lps"] {
        let mut spec = torn(&Case::of(name, place), false);
        for m in &mut spec.materials {
            m.fracture.as_mut().unwrap().alpha = 0.25;
        }
        spec.run.schedule.time_step = TimeStep::Fixed(0.1 * H);
        assert!(same::<3>(&spec, &[4, 5, 9], None));
    }
}

/// Displacements and velocities once a step, what points share and their critical stretches where the law has any, eight bytes each: of every copy, and
/// copies are the cells within reach of the border, in whole tiles.
#[test]
fn what_is_sent_is_what_the_law_says_of_the_copies() {
    for (name, fractures, numbers) in [("pmb", false, 4), ("lps", false, 5), ("lps", true, 6)] {
        let case = Case::of(name, place(LatticeKind::Square));
        let mut spec = case.spec();
        spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
        if fractures {
            breaking(&mut spec, 0.5);
        }
        let halos = on_threads(3, |comm| {
            let comm = Arc::new(comm);
            let mut sim = RankModel::<2>::new(&spec, options(None), &shelf(), &comm).unwrap();
            sim.start();
            let (before, _) = sim.halo();
            (0..STEPS).for_each(|_| sim.step().unwrap());
            let (after, copies) = sim.halo();
            (comm.rank(), after - before, copies)
        });
        let [wide, reach] = [case.place.cells[0], case.place.ratio as usize];
        let near = (reach * wide + reach).next_multiple_of(8);
        for (rank, sent, copies) in halos {
            let sides = if rank == 1 { 2 } else { 1 };
            assert_eq!(copies, sides * near, "{name}");
            // as many here as there: both sides of a border are alike
            assert_eq!(sent, (STEPS * sides * near * numbers * 8) as u64, "{name}");
        }
    }
}

#[test]
fn what_ranks_do_not_share_is_named() {
    let spec = Case::of("pmb", place(LatticeKind::Square)).spec();
    let refused = |change: &dyn Fn(&mut Spec)| {
        let mut spec = spec.clone();
        spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
        change(&mut spec);
        shared(&spec).err().map(|e| e.path)
    };
    assert_eq!(refused(&|_| ()), None);
    let of = |path: &str| Some(path.to_string());
    assert_eq!(shared(&spec).unwrap_err().path, "run.schedule.time_step");
    assert_eq!(
        refused(&|s| s.interactions.contact = Some(CONTACT)),
        of("interactions")
    );
    assert_eq!(
        refused(&|s| s.bonds.family = FamilyChoice::List),
        of("bonds.family")
    );
    let worked = |s: &mut Spec| {
        breaking(s, 0.02);
        s.materials[0].fracture.as_mut().unwrap().criterion = Criterion::BondEnergy(1.0);
    };
    assert_eq!(refused(&worked), of("materials"));
    let damping = |s: &mut Spec| {
        s.loading.conditions = vec![ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::Damping(e("0.01")),
        }];
    };
    assert_eq!(refused(&damping), of("loading"));
    // more ranks than blocks: all of them hear of it
    let mut small = Case::of(
        "pmb",
        Place {
            cells: [30, 20, 1],
            ..place(LatticeKind::Square)
        },
    )
    .spec();
    small.run.schedule.time_step = TimeStep::Fixed(1e-3);
    let ends = on_threads(4, |comm| {
        let made = RankModel::<2>::new(&small, options(None), &shelf(), &Arc::new(comm));
        made.err().map(|e| e.message.to_string())
    });
    for end in ends {
        assert!(end.is_some_and(|e| e.contains("4 ranks for a body of 3 blocks")));
    }
}

#[test]
fn a_part_of_a_body_is_neither_joined_nor_a_cloud() {
    let sites: Vec<[i32; 3]> = (0..600).map(|x| [4 * x, 0, 0]).collect();
    let lattice = Lattice {
        kind: LatticeKind::Chain,
        spacing: H,
        origin: [0.0; 3],
    };
    let whole = Body::<1>::on_lattice(lattice, &sites, 3, [false], H).unwrap();
    on_threads(2, |comm| {
        let part = whole.subdomain_of(&Arc::new(comm)).unwrap();
        assert_eq!(part.to_cloud().unwrap_err().path, "ranks");
        assert!(std::panic::catch_unwind(|| Body::several(vec![part, whole.clone()])).is_err());
    });
}
