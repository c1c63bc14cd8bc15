//! What a program without unsafe code can hand to the engine: wrong lengths, wrong bodies, wrong numbers. Each ends in an error
//! or in a panic that says what was wrong, never in memory that is not its own.
#![forbid(unsafe_code)]

use peridyne::body::{Body, Column, Field, view, view_mut, zeros};
use peridyne::execute::lane::Lane;
use peridyne::execute::simd::Simd;
use peridyne::family::horizon::HorizonList;
use peridyne::family::stencil::Stencil;
use peridyne::interaction::list::{ListInteraction, ListParts};
use peridyne::interaction::stencil::{StencilInteraction, StencilParts};
use peridyne::interaction::weight::BondWeight;
use peridyne::interaction::{
    Interaction, MultiBodyInteraction, PointConstants, PointEnergies, Sweep, Toughness,
};
use peridyne::law::Law;
use peridyne::law::solid::bond_based::BondBased;
use peridyne::law::solid::eam_like::{EamLike, Solid};
use peridyne::law::spline::{Spline, Twin};
use peridyne::run::{Options, build};
use peridyne::space::lattice::{Lattice, LatticeKind};
use peridyne::spec::*;
use proptest::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};

const TOUGH: Toughness = Toughness {
    s00: f64::INFINITY,
    alpha: 0.0,
};

/// The message of the panic that this ends in.
fn refused<T>(what: impl FnOnce() -> T) -> String {
    let Err(panic) = catch_unwind(AssertUnwindSafe(what)) else {
        panic!("this was not refused");
    };
    match panic.downcast::<String>() {
        Ok(message) => *message,
        Err(panic) => panic.downcast_ref::<&str>().copied().unwrap_or("").into(),
    }
}

fn sites(n: i32) -> Vec<[i32; 3]> {
    (0..n * n).map(|k| [4 * (k % n), 4 * (k / n), 0]).collect()
}

fn lattice(n: i32, reach: usize) -> Body<2> {
    let lattice = Lattice {
        kind: LatticeKind::Square,
        spacing: 1.0,
        origin: [0.0; 3],
    };
    Body::on_lattice(lattice, &sites(n), reach, [false; 2], 1.0).unwrap()
}

fn stencil_of<W: Law>(
    body: &Body<2>,
    ratio: u32,
    law: W,
    constants: PointConstants,
) -> StencilInteraction<2, W> {
    let mut made = StencilInteraction::new(StencilParts {
        body,
        stencil: &Stencil::new(LatticeKind::Square, 1.0, Horizon::Ratio(ratio)),
        law,
        weight: &|_, _| 1.0,
        point_constants: constants,
        toughness: vec![TOUGH],
        repulsion: None,
        simd: Simd::detect(),
    });
    made.prepare(body);
    made
}

fn list_of<W: Law>(
    body: &Body<2>,
    list: HorizonList,
    law: W,
    constants: PointConstants,
) -> ListInteraction<2, W> {
    let mut made = ListInteraction::new(ListParts {
        body,
        list,
        law,
        weight: BondWeight::new(Influence::Constant, 2.0, None),
        point_constants: constants,
        toughness: vec![TOUGH],
        repulsion: None,
        simd: Simd::detect(),
    });
    made.prepare(body);
    made
}

const PMB: BondBased = BondBased { c: 1.0 };

fn lps() -> (EamLike, PointConstants) {
    let solid = Solid::lps(2, 1.0, 1.0);
    let law = EamLike {
        ratio: solid.ratio(),
    };
    (law, PointConstants::Solid(vec![solid]))
}

/// Bonds of both laws on both families, each with its body.
fn all() -> Vec<(Body<2>, Box<dyn Interaction<2>>)> {
    let grid = lattice(9, 2);
    let cloud = grid.to_cloud().unwrap();
    let list = || HorizonList::new(&cloud, 2.1).unwrap();
    let (law, constants) = lps();
    vec![
        (
            grid.clone(),
            Box::new(stencil_of(&grid, 2, PMB, PointConstants::None)),
        ),
        (
            grid.clone(),
            Box::new(stencil_of(&grid, 2, law, constants.clone())),
        ),
        (
            cloud.clone(),
            Box::new(list_of(&cloud, list(), PMB, PointConstants::None)),
        ),
        (
            cloud.clone(),
            Box::new(list_of(&cloud, list(), law, constants)),
        ),
    ]
}

/// Every way to sweep over a body, and what it says.
fn sweeps(
    it: &mut dyn Interaction<2>,
    body: &Body<2>,
    u: &Field<2>,
    fine: &Field<2>,
) -> Vec<String> {
    let mut f = fine.clone();
    let mut short = u.clone();
    let (mut whole, mut out) = (fine.clone(), PointEnergies::default());
    let moving = Sweep::Evolve {
        v: view(u),
        steps: [0.1; 2],
        breakage: Breakage::BeforeForce,
    };
    vec![
        refused(|| it.forces(body, view(u), view_mut(&mut f), Sweep::Hold, None)),
        refused(|| it.forces(body, view(fine), view_mut(&mut short), Sweep::Hold, None)),
        refused(|| it.forces(body, view(fine), view_mut(&mut f), moving, None)),
        refused(|| it.energy(body, view(u))),
        refused(|| {
            let seen = Some(&mut out.for_slots(u[0].len()));
            it.forces(body, view(fine), view_mut(&mut whole), Sweep::Hold, seen)
        }),
        refused(|| it.observe(body, view(u), &mut out.for_slots(body.len()))),
        refused(|| it.observe(body, view(fine), &mut out.for_slots(u[0].len()))),
        refused(|| it.observe_gradient(body, &[[0.0; 2]; 2], &mut out.for_slots(u[0].len()))),
        refused(|| it.tangents(body, view(u), &mut |_| {})),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn fields_of_another_length_are_refused(x in 0usize..400, y in 0usize..400) {
        for (body, mut it) in all() {
            prop_assume!(x != body.len());
            let fine = body.at_rest();
            let wrong = [Column::new(x, 0.0, 0), Column::new(y, 0.0, 9)];
            for said in sweeps(it.as_mut(), &body, &wrong, &fine) {
                prop_assert!(said.contains("slots, the body has"), "{said}");
            }
            // and nothing is left behind
            it.forces(&body, view(&fine), view_mut(&mut zeros(body.len())), Sweep::Hold, None);
        }
    }

    /// Whatever its argument, a table answers from its own entries.
    #[test]
    fn tables_answer_anywhere(x in prop::num::f64::ANY, step in prop::num::f64::ANY, first in prop::num::f64::ANY) {
        let values: Vec<f64> = (0..9).map(f64::from).collect();
        if !(step > 0.0 && step.is_finite() && first.is_finite()) {
            let said = refused(|| Spline::new(first, step, &values, true));
            prop_assert!(said.contains("a positive step"), "{said}");
            return Ok(());
        }
        let table = Spline::new(first, step, &values, true);
        let (_, _) = (table.at(x), table.lanes(x));
        let twin = Twin::new(&table, &table);
        let _ = (twin.lanes(x), twin.lanes_of(1, x));
    }

    /// Linear bodies whose lists do not belong to each other.
    #[test]
    fn linear_bodies_are_read_before_they_are_believed(
        start in prop::collection::vec(0usize..12, 0..6),
        partner in prop::collection::vec(0u32..6, 0..8),
        volumes in 0usize..6,
        blocks in 0usize..8,
    ) {
        let body = LinearBody::<1> {
            position: (0..4).map(|i| [f64::from(i)]).collect(),
            volume: vec![1.0; volumes],
            density: vec![1.0; 4],
            period: [None],
            start,
            partner,
            block: vec![[[1.0]]; blocks],
            load_map: None,
            mass: None,
        };
        let cloud = Cloud {
            position: body.position.iter().map(|x| [x[0], 0.0, 0.0]).collect(),
            volume: vec![1.0; 4],
            ..Cloud::default()
        };
        let fits = body.check();
        let linear = AnyLinearBody::new(body).unwrap();
        let law = LawSpec::Micromoduli(std::sync::Arc::new(linear));
        let mut spec = Spec::new(1, BodySpec::Cloud(cloud), 1.0, law);
        spec.bonds.horizon = Horizon::Length(1.5);
        spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
        spec.run.schedule.force_unstable = true;
        match (build(&spec, Options::default()), fits) {
            (Ok(mut sim), Ok(())) => {
                sim.start(true);
                let _ = sim.step();
            }
            (Err(e), Err(message)) => prop_assert_eq!(&*e.message, &*message),
            (Err(_), Ok(())) => {}
            (Ok(_), Err(message)) => panic!("it was built although {message}"),
        }
    }

    /// Blocks of points that there are not.
    #[test]
    fn points_that_there_are_not(first in 0usize..200, count in 0usize..200) {
        let spec = plate();
        let mut sim = build(&spec, Options::default()).unwrap();
        let n = sim.info().points as usize;
        let mut out = vec![0.0; count];
        for (field, component) in [("displacement", 0), ("reference", 1), ("volume", 0)] {
            let read =
                catch_unwind(AssertUnwindSafe(|| sim.read(field, component, first, &mut out)));
            prop_assert!(read.is_ok() || first + count > n);
        }
        let wrote = catch_unwind(AssertUnwindSafe(|| {
            sim.write("displacement", 0, first, &out);
        }));
        prop_assert!(wrote.is_ok() || first + count > n);
        let _ = catch_unwind(AssertUnwindSafe(|| sim.forces_under(&vec![[0.0; 3]; count])));
        let _ = catch_unwind(AssertUnwindSafe(|| sim.set_displacements(&vec![[0.0; 3]; count])));
        sim.start(true);
        let _ = sim.step();
    }
}

fn plate() -> Spec {
    let body = BodySpec::Sites {
        kind: LatticeKind::Square,
        spacing: 1.0,
        origin: [0.0; 3],
        quarters: sites(9),
        volume: None,
    };
    let mut spec = Spec::new(2, body, 1.0, LawSpec::Pmb(PmbStiffness::Young(1.0)));
    spec.bonds.horizon = Horizon::Ratio(2);
    spec.run.schedule.time_step = TimeStep::Fixed(1e-2);
    spec
}

#[test]
fn another_body_is_refused() {
    // of the same number of slots
    let (one, other) = (lattice(9, 2), lattice(9, 2));
    let mut it = stencil_of(&one, 2, PMB, PointConstants::None);
    let (u, mut f) = (one.at_rest(), zeros(one.len()));
    let said = refused(|| it.forces(&other, view(&u), view_mut(&mut f), Sweep::Hold, None));
    assert!(said.contains("another body"), "{said}");
    let said = refused(|| it.prepare(&other));
    assert!(said.contains("another body"), "{said}");
    // a copy is the same body
    it.forces(&one.clone(), view(&u), view_mut(&mut f), Sweep::Hold, None);
    let (cloud, moved) = (one.to_cloud().unwrap(), other.to_cloud().unwrap());
    let list = HorizonList::new(&moved, 2.1).unwrap();
    let said = refused(|| list_of(&cloud, list, PMB, PointConstants::None));
    assert!(said.contains("another body"), "{said}");
    let mut cloud = cloud;
    let list = HorizonList::new(&cloud, 2.1).unwrap();
    cloud.coordinates_mut().unwrap()[0][0] = 1e9;
    let said = refused(|| list_of(&cloud, list, PMB, PointConstants::None));
    assert!(said.contains("another body"), "{said}");
}

#[test]
fn a_stencil_fits_its_body() {
    let said = refused(|| stencil_of(&lattice(9, 1), 3, PMB, PointConstants::None));
    assert!(said.contains("shorter bonds"), "{said}");
    let cloud = lattice(9, 2).to_cloud().unwrap();
    let said = refused(|| stencil_of(&cloud, 2, PMB, PointConstants::None));
    assert!(said.contains("lattice"), "{said}");
    let mut body = lattice(9, 2);
    let said = refused(|| body.set_materials(vec![0; 3]));
    assert!(said.contains("each slot"), "{said}");
}

/// A law that shares a scalar, and says that it needs no room for it.
#[derive(Clone, Copy)]
struct Roomless;

impl Law for Roomless {
    const SHARES: bool = true;
    const FIELDS: usize = 0;

    fn constant<L: Lane>(self, _: L, _: L, weight: L) -> L {
        weight
    }
    fn pull<L: Lane>(self, k: L, g: L, i: [L; 2], j: [L; 2]) -> L {
        k * g * (i[0] + j[1])
    }
    fn pair_energy<L: Lane>(self, x: L, _: [L; 2], _: [L; 2]) -> L {
        x
    }
    fn pressure_factor<L: Lane>(self, own: L) -> L {
        own
    }
}

#[test]
fn a_law_has_room_for_what_it_shares() {
    let body = lattice(9, 2);
    let said = refused(|| stencil_of(&body, 2, Roomless, PointConstants::None));
    assert!(said.contains("two point fields"), "{said}");
    let cloud = body.to_cloud().unwrap();
    let list = HorizonList::new(&cloud, 2.1).unwrap();
    let said = refused(|| list_of(&cloud, list, Roomless, PointConstants::None));
    assert!(said.contains("two point fields"), "{said}");
}

/// What a body is given has its length, and what it was given after its interactions were made stays in it.
#[test]
fn a_body_is_changed_within_its_slots() {
    let mut body = lattice(9, 2);
    type Change = fn(&mut Body<2>);
    for (change, said) in [
        (
            (|b| b.set_densities(&[1.0])) as Change,
            "a density for each point",
        ),
        (|b| b.set_volumes(vec![1.0]), "a volume for each slot"),
        (|b| b.set_horizons(vec![2.0]), "a horizon for each slot"),
        (|b| b.set_marks(vec![3]), "a mark for each point"),
        (
            |b| b.give_materials([1].into_iter()),
            "a material for each point",
        ),
    ] {
        let message = refused(|| change(&mut body));
        assert!(message.contains(said), "{message}");
    }
    let mut body = lattice(9, 2);
    let (law, constants) = lps();
    let mut it = stencil_of(&body, 2, law, constants);
    let gone: Vec<u32> = (0..body.points() as u32).filter(|id| id % 2 == 1).collect();
    body.remove(&gone);
    body.set_volumes(vec![0.5; body.len()]);
    body.set_horizons(vec![1.0; body.len()]);
    it.energy(&body, view(&body.at_rest()));
    let mut f = zeros(body.len());
    it.forces(
        &body,
        view(&body.at_rest()),
        view_mut(&mut f),
        Sweep::Hold,
        None,
    );
    assert!(f.iter().flat_map(|c| c.iter()).all(|f| f.is_finite()));
}

/// A body among several is the one that its bonds were made for.
#[test]
fn a_body_among_several_keeps_its_slots() {
    let mut both = Body::several(vec![lattice(9, 2), lattice(9, 2)]);
    let said = refused(|| both.clone().change_piece(0, |b| *b = lattice(8, 2)));
    assert!(said.contains("keeps its slots"), "{said}");
    assert_eq!(both.change_piece(2, |_| ()), None);
    let (law, constants) = lps();
    let bonds = stencil_of(&both.pieces()[0].body, 2, law, constants);
    let mut it = MultiBodyInteraction::new(&both, vec![Some(Box::new(bonds)), None], vec![]);
    it.energy(&both, view(&both.at_rest()));
    both.change_piece(0, |b| *b = lattice(9, 2));
    let said = refused(|| it.energy(&both, view(&both.at_rest())));
    assert!(said.contains("another body"), "{said}");
}

/// Sweeps before anything was prepared find zeros.
#[test]
fn nothing_need_be_prepared() {
    let body = lattice(9, 2);
    let (law, point_constants) = lps();
    let mut it = StencilInteraction::new(StencilParts {
        body: &body,
        stencil: &Stencil::new(LatticeKind::Square, 1.0, Horizon::Ratio(2)),
        law,
        weight: &|_, _| 1.0,
        point_constants,
        toughness: vec![TOUGH],
        repulsion: None,
        simd: Simd::detect(),
    });
    let mut f = zeros(body.len());
    it.forces(
        &body,
        view(&body.at_rest()),
        view_mut(&mut f),
        Sweep::Hold,
        None,
    );
    assert!(body.slots().iter().all(|s| f[0][*s as usize] == 0.0));
}

#[test]
fn twins_are_two() {
    let table = Spline::new(0.0, 1.0, &[0.0; 5], false);
    let twin = Twin::new(&table, &table);
    for n in [2, 3, usize::MAX] {
        let said = refused(|| twin.lanes_of(n, 1.0));
        assert!(said.contains("twins"), "{said}");
    }
}

/// A table that no spline goes through.
#[test]
fn tables_are_read_before_they_are_believed() {
    let fine = TableSpec {
        density_step: 0.1,
        embedding: vec![0.0; 6],
        step: 0.2,
        density: vec![0.0; 6],
        pair: vec![0.0; 6],
        cutoff: 1.1,
        element: "X".into(),
        partners: vec![],
    };
    assert_eq!(fine.check(), Ok(()));
    let with = |change: fn(&mut TableSpec)| {
        let mut table = fine.clone();
        change(&mut table);
        let mut spec = plate();
        let eam = peridyne::law::potential::tabulated::Eam::new(table);
        spec.materials[0].law = LawSpec::Atoms(PotentialSpec::of(eam));
        build(&spec, Options::default()).err().map(|e| e.message)
    };
    for (change, said) in [
        (
            (|t| t.pair.truncate(3)) as fn(&mut TableSpec),
            "five or more",
        ),
        (|t| t.pair.truncate(5), "one length"),
        (|t| t.step = 0.0, "must be positive"),
        (|t| t.embedding[2] = f64::NAN, "finite"),
    ] {
        let error = with(change).unwrap();
        assert!(error.contains(said), "{error}");
    }
}
