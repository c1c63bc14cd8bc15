//! Bodies of which no rank lists the points: several lattices, and lattices whose points are moved or have lists.

use super::{among, mistakes, place, same};
use crate::sample::*;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

/// A lattice that fills so many cells from here on.
fn filled(kind: LatticeKind, spacing: f64, low: [f64; 3], cells: [usize; 3]) -> BodySpec {
    let (d, edges) = (kind.dimension(), kind.edges());
    let high = std::array::from_fn(|a| match a < d {
        true => low[a] + (cells[a] as f64 - 0.1) * edges[a] * spacing,
        false => 0.0,
    });
    BodySpec::Lattice {
        kind,
        spacing,
        origin: low,
        region: Region::Block { low, high },
        perturb: None,
    }
}

fn moved(mut body: BodySpec, amplitude: f64, seed: u64) -> BodySpec {
    if let BodySpec::Lattice { perturb, .. } = &mut body {
        *perturb = Some(Perturbation { amplitude, seed });
    }
    body
}

/// A block, and above it a finer one, one whose points were moved and has lists, and loose points that were moved: all come down.
fn stacked(name: &str, kind: LatticeKind, periodic: bool) -> Spec {
    let case = Case::of(name, place(kind));
    let (mut spec, d) = (case.spec(), case.d());
    let last = d - 1;
    let wide = [23, if d == 2 { 29 } else { 9 }, 11];
    let mut low = [0.0; 3];
    let mut next = |layers: usize, spacing: f64, apart: f64| {
        let begin = low;
        low[last] += (layers as f64 - 1.0) * kind.edges()[last] * spacing + apart;
        let mut cells: [usize; 3] = std::array::from_fn(|a| match a < last {
            true => (wide[a] as f64 * H / spacing).round() as usize,
            false => 1,
        });
        cells[last] = layers;
        filled(kind, spacing, begin, cells)
    };
    let block = next(wide[last], H, 0.9 * H);
    let fine = next(if d == 2 { 25 } else { 9 }, 0.5 * H, 0.8 * H);
    let rough = moved(next(12, H, 1.3 * H), 0.2 * H, 7);
    let powder = moved(next(7, H, H), 0.3 * H, 8);
    spec.body = BodySpec::Several(vec![
        PieceSpec::new("block", block),
        PieceSpec::new("fine", fine),
        PieceSpec {
            horizon: Some(Horizon::Length(2.2 * H)),
            ..PieceSpec::new("rough", rough)
        },
        PieceSpec {
            family: Some(FamilyChoice::List),
            ..PieceSpec::new("listed", next(9, H, 1.2 * H))
        },
        PieceSpec {
            bonded: false,
            ..PieceSpec::new("powder", powder)
        },
    ]);
    breaking(&mut spec, 0.01);
    spec.interactions.contact = Some(CONTACT);
    if periodic {
        spec.space.periodic[0] = Some(wide[0] as f64 * H);
    }
    let axis = ["x", "y", "z"][last];
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [const { None }; 3],
        velocity: std::array::from_fn(|a| {
            (a == last).then(|| e(&format!("0.2 - 0.012*{axis} + 0.1*sin(2*x)")))
        }),
    }];
    spec.run.schedule.time_step = TimeStep::Fraction(0.5);
    spec
}

/// Another material in a part of one body, and in all of another.
fn of_two(spec: &mut Spec, axis: &str) {
    let mut other = spec.materials[0].clone();
    (other.name, other.set) = ("other".into(), "other".into());
    other.density *= 2.0;
    spec.materials[0].set = "first".into();
    spec.materials.push(other);
    let within = |body: &str, members| Members::Within {
        body: body.into(),
        members: Box::new(members),
    };
    let set = |name: &str, members| SetSpec {
        name: name.into(),
        members,
    };
    spec.sets.extend([
        set(
            "drawn",
            within("block", Members::Random { part: 0.3, seed: 5 }),
        ),
        set("fine", within("fine", Members::All)),
        set(
            "low",
            within("rough", Members::Where(e(&format!("sin(3*{axis}) > 0")))),
        ),
        set("first", Members::Outside(vec!["other".into()])),
    ]);
    let fine = match &spec.body {
        BodySpec::Several(pieces) => pieces[1].body.clone(),
        _ => panic!("several bodies"),
    };
    let BodySpec::Lattice { region, .. } = fine else {
        panic!("a lattice");
    };
    spec.sets.push(set("other", Members::Region(region)));
}

fn shares(spec: &Spec, ranks: &[usize]) -> bool {
    let broke = same(spec, ranks);
    // and what is told of it is that, too, in another order perhaps
    let one = build(spec, Options::default()).unwrap();
    let (all, _) = among(spec, ranks[0], None, None);
    let [one, all] = [one.info(), &all].map(|info| {
        let told = info.warnings.iter().map(|message| message.to_string());
        let mut told: Vec<String> = told.collect();
        told.sort();
        told
    });
    assert_eq!(all, one, "{}", spec.title);
    broke
}

#[test]
fn several_lattices_have_the_same_bits_on_any_number_of_ranks() {
    let mut torn = 0;
    for (n, name) in ["pmb", "lps"].into_iter().enumerate() {
        let mut spec = stacked(name, LatticeKind::Square, n == 0);
        if n == 1 {
            of_two(&mut spec, "y");
        }
        torn += u32::from(shares(&spec, &[[2, 5], [8, 3]][n]));
    }
    let spec = stacked("pmb", LatticeKind::Cubic, true);
    torn += u32::from(shares(&spec, &[3]));
    assert!(torn == 3, "{torn}");
}

/// Lattices that interfaces join: which points they bond no rank finds alone.
#[test]
fn glued_lattices_have_the_same_bits_on_any_number_of_ranks() {
    let mut torn = 0;
    for (periodic, ranks) in [(false, &[2, 5][..]), (true, &[4][..])] {
        let mut spec = stacked("pmb", LatticeKind::Square, periodic);
        let law = spec.materials[0].law.clone();
        let glue = |bodies: [&str; 2]| InterfaceSpec {
            name: format!("glue of {}", bodies[1]),
            bodies: bodies.map(String::from),
            law: law.clone(),
            horizon: Horizon::Length(2.6 * H),
            influence: Influence::Constant,
            fracture: Some(FractureSpec::new(Criterion::Stretch(0.002))),
        };
        spec.interactions.interfaces = [["block", "fine"], ["rough", "fine"], ["powder", "listed"]]
            .map(glue)
            .to_vec();
        of_two(&mut spec, "y");
        torn += u32::from(shares(&spec, ranks));
    }
    assert_eq!(torn, 2);
}

/// Loads act on the faces of each of several bodies, of points that were moved, too.
#[test]
fn faces_of_several_lattices_are_those_of_the_whole() {
    for periodic in [false, true] {
        let mut spec = stacked("pmb", LatticeKind::Square, periodic);
        let BodySpec::Several(pieces) = &spec.body else {
            panic!("several bodies");
        };
        let tops = pieces.iter().take(4).map(|p| {
            let BodySpec::Lattice { region, .. } = &p.body else {
                panic!("a lattice");
            };
            let Region::Block { high, .. } = region else {
                panic!("a block");
            };
            let last = Members::Where(e(&format!("y > {}", high[1] - 1.3 * H)));
            (p.name.clone(), last)
        });
        let tops: Vec<_> = tops.collect();
        for (name, members) in tops {
            // the finer one has two layers there
            let members = match name == "fine" {
                true => continue,
                false => members,
            };
            let set = format!("top of {name}");
            spec.sets.push(SetSpec {
                name: set.clone(),
                members: Members::Within {
                    body: name,
                    members: Box::new(members),
                },
            });
            spec.loading.conditions.push(ConditionSpec {
                set,
                kind: ConditionKind::Traction {
                    value: [None, Some(e("0.01 + 0.01*t")), None],
                    area: None,
                },
            });
        }
        let sim = build(&spec, Options::default()).unwrap();
        let areas = sim.info().loads.iter().map(|load| load.area.unwrap());
        assert_eq!(areas.len(), 3);
        for area in areas {
            // the thickness is a quarter
            assert!((area / (0.25 * 23.0 * H) - 1.0).abs() < 1e-9, "{area}");
        }
        shares(&spec, &[2, 4]);
    }
}

/// A lattice whose points were moved, or that has lists of bonds.
#[test]
fn lattices_as_clouds_have_the_same_bits_on_any_number_of_ranks() {
    for (n, kind) in [
        LatticeKind::Chain,
        LatticeKind::Triangular,
        LatticeKind::Square,
        LatticeKind::Cubic,
        LatticeKind::Bcc,
    ]
    .into_iter()
    .enumerate()
    {
        let mut place = place(kind);
        if kind == LatticeKind::Bcc {
            (place.ratio, place.cells) = (1, [7, 9, 23]);
        }
        for by in [0.0, 0.2] {
            let mut spec = super::torn(&Case::of(["pmb", "lps"][n % 2], place), false);
            spec.body = filled(kind, H, [0.0; 3], place.cells);
            spec.bonds.family = FamilyChoice::List;
            if by > 0.0 {
                spec.body = moved(spec.body, by * H, 3);
                spec.bonds.family = FamilyChoice::Auto;
            }
            if n % 2 == 0 {
                spec.space.periodic[0] = Some(place.cells[0] as f64 * kind.edges()[0] * H);
            }
            if n == 2 && by > 0.0 {
                let longest = spec.bonds.horizon.length(H);
                spec.bonds.calibration = Calibration::Continuum;
                spec.bonds.variable_horizon = Some(e(&format!("{longest}*(0.8 + 0.2*cos(x)^2)")));
            }
            let ranks = &[[2, 7], [3, 5]][n % 2];
            shares(&spec, ranks);
        }
    }
}

/// What is wrong with one of several bodies all ranks say alike.
#[test]
fn mistakes_of_several_lattices_are_those_of_one_process() {
    let wrong = |change: &dyn Fn(&mut PieceSpec)| {
        let mut spec = stacked("pmb", LatticeKind::Square, false);
        let BodySpec::Several(pieces) = &mut spec.body else {
            panic!("several bodies");
        };
        change(&mut pieces[2]);
        let one = build(&spec, Options::default()).err().unwrap();
        for said in mistakes(&spec).into_iter().flatten() {
            assert_eq!(
                (said.path.as_str(), said.message.to_string()),
                (one.path.as_str(), one.message.to_string())
            );
        }
        one.path
    };
    let body = |change: fn(&mut BodySpec)| wrong(&|piece: &mut PieceSpec| change(&mut piece.body));
    let far = body(|body| *body = moved(body.clone(), 0.6 * H, 1));
    assert_eq!(far, "body[2].perturb");
    let none = body(|body| {
        if let BodySpec::Lattice { region, .. } = body {
            *region = Region::Block {
                low: [0.3 * H, 0.3 * H, 0.0],
                high: [0.4 * H, 0.4 * H, 0.0],
            };
        }
    });
    assert_eq!(none, "body[2].region");
    let flat = body(|body| {
        if let BodySpec::Lattice { spacing, .. } = body {
            *spacing = 0.0;
        }
    });
    assert_eq!(flat, "body[2].spacing");
    let short = wrong(&|piece: &mut PieceSpec| piece.horizon = Some(Horizon::Length(0.5 * H)));
    assert_eq!(short, "horizon");
}
