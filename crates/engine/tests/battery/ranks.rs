//! Ranks that share a body: the same bits as one that has all of it.

use crate::own_law::Stiffening;
use crate::sample::*;
use peridyne::body::Body;
use peridyne::columns::On;
use peridyne::error::RunError;
use peridyne::execute::simd::Simd;
use peridyne::law::material::bonds::Bonds;
use peridyne::observe::{Column, Ledger, StateHash, Values};
use peridyne::run::ranks::{AllRanks, RankModel, shared};
use peridyne::run::{Info, Options, Shelf, Simulation, build_in};
use peridyne::space::lattice::{Lattice, LatticeKind};
use peridyne::space::rigid::RigidShape;
use peridyne::spec::*;
use peridyne_comm::on_threads;
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

/// What a model says of itself, in words.
#[derive(Debug, PartialEq)]
struct Said {
    hash: StateHash,
    /// Energies, the initial one last.
    ledger: [u64; 10],
    broken: u64,
    fragments: u64,
    time: u64,
    columns: BTreeMap<String, Vec<u64>>,
    bonds: Vec<(u32, u32)>,
    measured: Vec<u64>,
}

/// Numbers, as words.
fn words(values: &Values) -> Vec<u64> {
    let each = (0..values.len()).flat_map(|i| {
        let numbers = values.shape().numbers();
        (0..numbers).map(move |c| values.at(i, c).to_bits())
    });
    each.collect()
}

/// Walks over bonds from one end: not of ranks yet.
const WALKS: [&str; 2] = ["displacement_gradient", "strain"];

/// After some steps.
fn said(sim: &mut dyn Simulation) -> Said {
    sim.start(true);
    (0..STEPS).for_each(|_| sim.step().unwrap());
    let ledger = sim.ledger().unwrap();
    let declared = sim.columns().into_iter().filter(|c| c.on == On::Points);
    let known: Vec<String> = { declared.map(|c| c.name.to_string()) }
        .filter(|name| !WALKS.contains(&&**name))
        .collect();
    let fields: Vec<&str> = known.iter().map(|n| &**n).collect();
    let snapshot = sim.snapshot(&fields, true);
    let columns = snapshot.columns.iter();
    let column = |c: &Column| (c.declaration.name.to_string(), words(&c.values));
    let mut columns: BTreeMap<_, _> = columns.map(column).collect();
    let reference = Values::Vectors(snapshot.reference);
    columns.insert("places".into(), words(&reference));
    let mut bonds = snapshot.bonds.unwrap();
    bonds.sort_unstable();
    let Ledger {
        kinetic,
        strain,
        contact,
        released,
        made,
        dissipated,
        numerical,
        work_conditions,
        work_indenter,
        initial,
    } = ledger;
    let energies = [
        kinetic,
        strain,
        contact,
        released,
        made,
        dissipated,
        numerical,
        work_conditions,
        work_indenter,
        initial,
    ];
    Said {
        hash: sim.state_hash(),
        ledger: energies.map(f64::to_bits),
        broken: sim.broken(),
        fragments: sim.fragments(),
        time: sim.time().to_bits(),
        columns,
        bonds,
        measured: sim.measure().into_iter().map(f64::to_bits).collect(),
    }
}

fn shelf() -> Shelf {
    Shelf::standard().with::<Bonds<Stiffening, 1>>()
}

fn options(simd: Option<Simd>) -> Options {
    Options {
        simd,
        trust_time_step: false,
    }
}

/// The same of ranks.
fn among<const D: usize>(spec: &Spec, ranks: usize, simd: Option<Simd>) -> (Info, Said) {
    let all = on_threads(ranks, |comm| {
        let comm = Arc::new(comm);
        let own = RankModel::<D>::new(spec, options(simd), &shelf(), &comm).unwrap();
        if comm.rank() > 0 {
            own.follow();
            return None;
        }
        let mut sim = AllRanks::new(own);
        let said = said(&mut sim);
        Some((sim.info().clone(), said))
    });
    all.into_iter().flatten().next().unwrap()
}

/// The same bits on so many ranks. Whether something broke.
fn same<const D: usize>(spec: &Spec, ranks: &[usize], simd: Option<Simd>) -> bool {
    shared(spec).unwrap();
    let name = &spec.title;
    let mut sim = build_in::<D>(spec, options(None), &shelf()).unwrap();
    let one = said(&mut sim);
    for n in ranks {
        let (info, all) = among::<D>(spec, *n, simd);
        let whole = Info {
            // copies are counted, too; what is told of gaps and torn points is of whole bodies
            bytes: info.bytes,
            warnings: info.warnings.clone(),
            simd: info.simd,
            ..sim.info().clone()
        };
        assert_eq!(info, whole, "{name}, {n} ranks");
        for (column, wanted) in &one.columns {
            let off = { wanted.iter().zip(&all.columns[column]) }.position(|(a, b)| a != b);
            assert_eq!(off, None, "{name}, {n} ranks: {column}");
        }
        assert_eq!(one.ledger, all.ledger, "{name}, {n} ranks");
        let off = one.bonds.iter().zip(&all.bonds).position(|(a, b)| a != b);
        let counts = (one.bonds.len(), all.bonds.len());
        assert!(
            one.bonds == all.bonds,
            "{name}, {n} ranks: {off:?} {counts:?}"
        );
        let whole = |said: &Said| (said.broken, said.fragments, said.time, said.hash);
        assert_eq!(whole(&one), whole(&all), "{name}, {n} ranks");
        assert_eq!(one.measured, all.measured, "{name}, {n} ranks");
        assert!(one == all, "{name}, {n} ranks");
    }
    one.broken > 0
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

/// All that acts on a body of which ranks have parts, at the step that follows from it.
fn acted(case: &Case) -> Spec {
    let mut spec = case.spec();
    breaking(&mut spec, 0.02);
    let d = case.d();
    let last = [d - 1];
    // across the axis along which ranks have their parts, but for the last set, which is of the first part
    let axis = ["x", "y", "z"][last[0]];
    let along = case.place.kind.edges()[last[0]] * H;
    let far = (case.place.cells[last[0]] as f64 - 1.5) * along;
    let set = |name: &str, text: String| SetSpec {
        name: name.into(),
        members: Members::Where(e(&text)),
    };
    spec.sets.extend([
        set("side", "x < 0.3".into()),
        set("end", format!("{axis} > {far}")),
        set("begin", format!("{axis} < {}", 1.5 * along)),
    ]);
    let only = |a: usize, text: &str| {
        let mut all = [const { None }; 3];
        all[a] = Some(e(text));
        all
    };
    let on = |set: &str, kind| ConditionSpec {
        set: set.into(),
        kind,
    };
    spec.loading.conditions = vec![
        on("all", ConditionKind::BodyForce(only(0, "0.05*cos(x)*t"))),
        on("all", ConditionKind::Damping(e("0.1"))),
        on("begin", ConditionKind::Displacement(only(last[0], "0"))),
        on("end", ConditionKind::Velocity(only(last[0], "0.02*cos(x)"))),
        on(
            "side",
            ConditionKind::Traction {
                value: only(0, "0.01 + 0.01*t"),
                area: (d > 1 && case.place.kind.basis().len() > 1).then_some(7.0),
            },
        ),
    ];
    if d > 1 {
        let set = on("begin", ConditionKind::SetForce(only(0, "0.001")));
        spec.loading.conditions.push(set);
    }
    let middle = 0.5 * along * case.place.cells[last[0]] as f64;
    let mut center = [2.0 * H; 3];
    center[last[0]] = middle;
    let place = center.map(|x| e(&x.to_string()));
    spec.loading.indenters = vec![IndenterSpec {
        name: String::new(),
        stiffness: 3.0,
        shape: RigidShape::Sphere { radius: 2.3 * H },
        motion: IndenterMotion::Kinematic(place),
        turn: None,
        friction: None,
        cohesion: None,
    }];
    let crack = |kind, at: f64| PrecrackSpec {
        kind,
        shape: match d {
            1 => CrackShape::Point { x: at },
            2 => CrackShape::Segment {
                from: [-H, at, 0.0],
                to: [8.2 * H, at + 3.3 * H, 0.0],
            },
            _ => CrackShape::Disk {
                center: [0.0, 0.0, at],
                normal: [0.1, 0.0, (0.99f64).sqrt()],
                radius: 4.1 * H,
            },
        },
    };
    spec.damage.precracks = vec![
        crack(CrackKind::Absent, 0.7 * middle + 0.13),
        crack(CrackKind::Broken, 1.3 * middle + 0.17),
    ];
    let probe = |name: &str, set: &str, measure| ProbeSpec {
        name: name.into(),
        set: set.into(),
        measure,
    };
    let over = |fold, of: &str| Measure::Over {
        fold,
        of: of.into(),
        part: Part::All,
    };
    spec.run.probes = vec![
        probe("pull", "end", Measure::Reaction),
        probe("energies", "all", Measure::Energy),
        probe("mean", "side", over(Fold::Mean, "velocity")),
        probe("least", "all", over(Fold::Min, "damage")),
        probe("most", "all", over(Fold::Max, "force_density")),
        probe(
            "there",
            "all",
            Measure::Value {
                at: [middle; 3],
                of: "displacement".into(),
                part: Part::Magnitude,
            },
        ),
    ];
    if d > 1 {
        let moment = Measure::Moment { about: [1.0; 3] };
        spec.run.probes.push(probe("moment", "begin", moment));
    }
    spec.run.schedule.time_step = TimeStep::Auto;
    spec
}

#[test]
fn what_acts_and_the_stable_step_are_those_of_the_whole_body() {
    let kinds = [
        LatticeKind::Chain,
        LatticeKind::Square,
        LatticeKind::Triangular,
        LatticeKind::Cubic,
        LatticeKind::Bcc,
    ];
    let mut torn = 0;
    for (n, kind) in kinds.into_iter().enumerate() {
        let mut place = place(kind);
        if kind.basis().len() > 1 && kind.dimension() == 3 {
            (place.ratio, place.cells) = (1, [7, 9, 23]);
        }
        for (k, name) in ["pmb", "lps", "elastic-plastic"].into_iter().enumerate() {
            let spec = acted(&Case::of(name, place));
            let ranks = [1 + (n + k) % 4];
            torn += u32::from(match kind.dimension() {
                1 => same::<1>(&spec, &ranks, None),
                2 => same::<2>(&spec, &ranks, None),
                _ => same::<3>(&spec, &ranks, None),
            });
        }
    }
    assert!(torn > 0);
}

/// Goes as far as one model does, and says the same of what was too fast there.
#[test]
fn a_run_that_goes_bad_does_so_on_all_ranks() {
    let mut spec = torn(&Case::of("pmb", place(LatticeKind::Cubic)), false);
    spec.loading.initial[0].velocity[2] = Some(e("if(z > 9, 40*(z - 9), 0)"));
    spec.run.schedule.time_step = TimeStep::Fixed(0.05 * H);
    fn end(sim: &mut dyn Simulation) -> (RunError, StateHash, u64) {
        sim.start(true);
        let error = (0..1000).find_map(|_| sim.step().err()).unwrap();
        (error, sim.state_hash(), sim.step_number())
    }
    let mut sim = build_in::<3>(&spec, options(None), &shelf()).unwrap();
    let one = end(&mut sim);
    assert!(matches!(one.0, RunError::TooFast { .. }));
    // what is left is the state before
    let mut before = build_in::<3>(&spec, options(None), &shelf()).unwrap();
    before.start(true);
    (0..one.2).for_each(|_| before.step().unwrap());
    let [sim, before]: [&mut dyn Simulation; 2] = [&mut sim, &mut before];
    for name in ["displacement", "velocity"] {
        let both = sim.vectors(name).into_iter().zip(before.vectors(name));
        let off = both
            .flat_map(|(x, y)| (0..3).map(move |a| (x[a] - y[a]).abs()))
            .fold(0.0, f64::max);
        assert!(off < 1e-12, "{name}: {off}");
    }
    let all = on_threads(3, |comm| {
        let comm = Arc::new(comm);
        let own = RankModel::<3>::new(&spec, options(None), &shelf(), &comm).unwrap();
        match comm.rank() {
            0 => Some(end(&mut AllRanks::new(own))),
            _ => {
                own.follow();
                None
            }
        }
    });
    assert_eq!(all[0], Some(one));
}

/// A mistake that lies where one rank has its points is told once.
#[test]
fn a_mistake_of_one_rank_is_known_to_all() {
    let mut spec = Case::of("pmb", place(LatticeKind::Square)).spec();
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [const { None }; 3],
        velocity: [Some(e("1/max(20 - y, 0)")), None, None],
    }];
    let ends = on_threads(3, |comm| {
        let made = RankModel::<2>::new(&spec, options(None), &shelf(), &Arc::new(comm));
        made.err().map(|e| e.kind)
    });
    use peridyne::error::BuildErrorKind::{Elsewhere, Invalid};
    assert_eq!(ends, [Some(Elsewhere), Some(Elsewhere), Some(Invalid)]);
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
    let named = |s: &mut Spec| {
        s.loading.conditions = vec![ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::Force(ForceSpec::default()),
        }];
    };
    assert_eq!(refused(&named), of("conditions"));
    let strains = |s: &mut Spec| s.run.fields = Some(vec!["strain".into()]);
    assert_eq!(refused(&strains), of("output.fields"));
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
