//! Heat through contact: of flat faces, of bodies warm throughout, in series, while bodies meet and part.

use crate::sample::*;
use peridyne::run::Simulation;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

/// Two blocks on top of each other along the last axis, `apart` more than their faces need to meet; the upper one begins at 1.
#[derive(Clone)]
struct Two {
    d: usize,
    spacing: [f64; 2],
    /// Along the last axis, and across it.
    length: [f64; 2],
    width: [f64; 2],
    apart: f64,
    /// Of the upper one, across; the lower one begins at 0.
    shift: f64,
    conductivity: [f64; 2],
    conductance: f64,
    method: DiffusionMethod,
    dt: f64,
}

const SECTION: f64 = 0.3;

impl Two {
    /// Blocks of one lattice, as wide as each other, which hardly conduct.
    fn blocks(d: usize) -> Two {
        Two {
            d,
            spacing: [0.1; 2],
            length: [0.5, 0.3],
            width: [0.7; 2],
            apart: 0.0,
            shift: 0.0,
            conductivity: [1e-3; 2],
            conductance: 2.0,
            method: EXPLICIT,
            dt: 1e-6,
        }
    }

    /// The lower one is a plate that reaches half a width further on either side.
    fn on_a_plate(mut self) -> Two {
        self.width[0] *= 2.0;
        self.shift += 0.5 * self.width[1];
        self
    }

    /// Area of the upper face.
    fn area(&self) -> f64 {
        let section = if self.d == 3 { 1.0 } else { SECTION };
        section * self.width[1].powi(self.d as i32 - 1)
    }

    fn spec(&self) -> Spec {
        let names = ["lower", "upper"];
        let pieces = [0, 1].map(|n| {
            let low: [f64; 3] = std::array::from_fn(|a| match (n, a + 1 == self.d) {
                (0, _) => 0.0,
                (_, true) => self.length[0] + self.apart,
                (_, false) => self.shift,
            });
            let high = std::array::from_fn(|a| {
                low[a]
                    + if a + 1 == self.d {
                        self.length[n]
                    } else {
                        self.width[n]
                    }
            });
            let mut body = cells(self.d, self.spacing[n], low, high);
            if let BodySpec::Lattice { origin, .. } = &mut body {
                for (x, low) in origin.iter_mut().zip(low).take(self.d) {
                    *x += low;
                }
            }
            PieceSpec::new(names[n], body)
        });
        let mut heat = heat(self.method);
        heat.materials = (self.conductivity)
            .map(|conductivity| DiffusionMaterial {
                conductivity,
                ..heat.materials[0]
            })
            .to_vec();
        heat.initial = vec![("upper".into(), text("1"))];
        let mut spec = still(self.d, BodySpec::Several(pieces.to_vec()), 2, self.dt, heat);
        spec.space.section = if self.d == 3 { 1.0 } else { SECTION };
        spec.sets = names
            .map(|name| SetSpec {
                name: name.into(),
                members: Members::Within {
                    body: name.into(),
                    members: Box::new(Members::All),
                },
            })
            .to_vec();
        spec.materials = names
            .map(|name| MaterialSpec {
                name: name.into(),
                set: name.into(),
                ..spec.materials[0].clone()
            })
            .to_vec();
        spec.interactions.contact = Some(ContactSpec {
            bonded: 0.9,
            free: 1.35,
            stiffness: ContactStiffness::Laws,
            friction: None,
            cohesion: None,
            conductance: Some(self.conductance),
        });
        spec
    }

    /// What crosses in one step, over `h_c A ΔT` of it.
    fn part(&self) -> f64 {
        let mut sim = built(&self.spec());
        run(&mut *sim, 1);
        crossed(&*sim) / (self.conductance * self.area() * self.dt)
    }
}

fn crossed(sim: &dyn Simulation) -> f64 {
    sim.diffusions()[0].1.through_contact.unwrap()
}

/// Means of the lower and the upper body.
fn means(sim: &mut dyn Simulation) -> [f64; 2] {
    let t = temperature(sim);
    let lower = sim.info().bodies[0].1 as usize;
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    [mean(&t[..lower]), mean(&t[lower..])]
}

/// Points face to face, at any place on the lattice of a wider plate, in every dimension: `h_c A ΔT` to the last digits.
#[test]
fn faces_of_one_lattice_exchange_by_their_area() {
    for d in 1..=3 {
        let off = Two::blocks(d).part() - 1.0;
        assert!(off.abs() < 1e-12, "{d}-D: {off:e}");
    }
    for d in 2..=3 {
        for shift in [0.0, 0.01, 0.025, 0.04, 0.05] {
            let mut two = Two::blocks(d).on_a_plate();
            two.shift += shift;
            let off = two.part() - 1.0;
            assert!(off.abs() < 1e-12, "{d}-D shifted by {shift}: {off:e}");
        }
    }
}

/// Of cells that are no cubes the faces are guessed, and it is said.
#[test]
fn faces_that_are_not_those_of_cubes_are_warned_of() {
    let warns = |kind: Option<LatticeKind>| {
        let mut spec = Two::blocks(3).spec();
        let BodySpec::Several(pieces) = &mut spec.body else {
            unreachable!()
        };
        if let (BodySpec::Lattice { kind: of, .. }, Some(kind)) = (&mut pieces[0].body, kind) {
            *of = kind;
        }
        let sim = built(&spec);
        let all = &sim.info().warnings;
        all.iter().any(|w| w.contains("volume over the spacing"))
    };
    assert!(!warns(None));
    assert!(warns(Some(LatticeKind::Fcc)));
}

/// Half of a spacing hangs over: what meets is that much less.
#[test]
fn what_hangs_over_does_not_count() {
    let mut two = Two::blocks(2);
    two.shift = 0.05;
    let off = two.part() - 6.5 / 7.0;
    assert!(off.abs() < 1e-12, "{off:e}");
}

/// Lattices that do not match share their faces to some percent, wherever they stand.
#[test]
fn faces_of_unlike_lattices_exchange_by_their_area() {
    // all go into 0.7 a whole number of times
    let spacings = [
        [0.1, 0.07],
        [0.07, 0.1],
        [0.1, 0.05],
        [0.1, 0.035],
        [0.1, 0.0875],
        [0.0875, 0.1],
        [0.1, 0.14],
    ];
    for (d, bound) in [(2, 0.03), (3, 0.05)] {
        // a fine lattice in space is left out: slow
        let few = spacings.iter().filter(|s| d == 2 || s[1] > 0.04);
        for (spacing, shift) in few.flat_map(|s| [0.0, 0.013, 0.037].map(|x| (*s, x))) {
            let mut two = Two::blocks(d).on_a_plate();
            (two.spacing, two.length) = (spacing, [0.7; 2]);
            two.shift += shift;
            let off = two.part() - 1.0;
            assert!(
                off.abs() < bound,
                "{d}-D, {spacing:?} shifted by {shift}: {off:e}"
            );
        }
    }
}

/// Contact that opens does not switch: all that there is up to 1.1 spacings, less and less up to 1.35, none from there on.
#[test]
fn what_opens_conducts_less_and_less() {
    let part = |apart: f64| {
        let mut two = Two::blocks(2);
        two.apart = apart;
        two.part()
    };
    assert!((part(0.0099) - 1.0).abs() < 1e-12);
    assert_eq!([part(0.0351), part(0.1)], [0.0, 0.0]);
    let steps = 400;
    let gap = |n: usize| 0.01 + 0.025 * n as f64 / steps as f64;
    let all: Vec<f64> = (0..=steps).map(|n| part(gap(n))).collect();
    assert!(
        all.windows(2)
            .all(|p| p[1] <= p[0] + 1e-12 && p[0] - p[1] < 0.02)
    );
    assert!(all[0] > 0.99 && all[steps] < 1e-4);
}

/// Bodies that met from afar are held apart at 1.35 spacings by contact: they touch there.
#[test]
fn what_repels_touches() {
    let mut two = Two::blocks(2);
    two.apart = 0.3;
    let mut spec = two.spec();
    for (gap, expected) in [(0.034, 1.0), (0.08, 0.0)] {
        spec.loading.initial = vec![InitialSpec {
            set: "upper".into(),
            displacement: [None, Some(text(&format!("{}", gap - 0.3))), None],
            velocity: [None, None, None],
        }];
        let mut sim = built(&spec);
        run(&mut *sim, 1);
        let part = crossed(&*sim) / (two.conductance * two.area() * two.dt);
        assert!((part - expected).abs() < 1e-12, "{gap}: {part}");
    }
}

/// Both sides of a foil of one layer conduct all that they have.
#[test]
fn a_foil_has_two_sides() {
    let mut two = Two::blocks(2);
    two.length[0] = 0.1;
    let mut spec = two.spec();
    let BodySpec::Several(pieces) = &mut spec.body else {
        unreachable!()
    };
    let mut below = pieces[1].clone();
    below.name = "below".into();
    if let BodySpec::Lattice { origin, region, .. } = &mut below.body {
        origin[1] = -0.25;
        *region = peridyne::space::region::Region::Block {
            low: [0.0, -0.3, 0.0],
            high: [0.7, 0.0, 0.0],
        };
    }
    pieces.push(below);
    spec.sets.push(SetSpec {
        name: "below".into(),
        members: Members::Within {
            body: "below".into(),
            members: Box::new(Members::All),
        },
    });
    spec.materials.truncate(1);
    spec.materials[0].set = "all".into();
    spec.interactions.diffusions[0].materials.truncate(1);
    spec.interactions.diffusions[0]
        .initial
        .push(("below".into(), text("1")));
    let mut sim = built(&spec);
    run(&mut *sim, 1);
    let part = crossed(&*sim) / (two.conductance * two.area() * two.dt);
    assert!((part - 2.0).abs() < 1e-12, "{part}");
}

/// Two bodies, warm throughout: ΔT falls as `exp(−h_c A (1/C₁ + 1/C₂) t)`; no heat is lost, and all that one lost went through the contact.
#[test]
fn small_bodies_even_out_exponentially() {
    let even_out = |two: &Two, steps: u64| {
        let mut sim = built(&two.spec());
        run(&mut *sim, steps);
        let [lower, upper] = means(&mut *sim);
        let rate = two.conductance * (1.0 / two.length[0] + 1.0 / two.length[1]);
        let exact = (-rate * sim.time()).exp();
        assert!(exact < 0.7);
        let off = (upper - lower) / exact - 1.0;
        assert!(off.abs() < 1e-3, "{}-D {:?}: {off:e}", two.d, two.spacing);
        let account = sim.diffusions()[0].1;
        assert!(account.residual().abs() < 1e-11 * account.initial);
        let lost = (1.0 - upper) * two.area() * two.length[1];
        assert!((crossed(&*sim) / lost - 1.0).abs() < 1e-10);
    };
    for d in 1..=2 {
        let mut two = Two::blocks(d);
        two.conductivity = [1.0; 2];
        (two.conductance, two.dt) = (1e-3, 1.0);
        even_out(&two, 100);
        two.conductivity = [1e4; 2];
        (two.conductance, two.dt, two.method) = (1.0, 5e-3, CRANK_NICOLSON);
        even_out(&two, 40);
        two.spacing[1] = 0.05;
        even_out(&two, 40);
    }
}

/// Held far ends, steady: the jump is `q/h_c` and the flux `ΔT/(L₁/k₁ + 1/h_c + L₂/k₂)`, to first order in the spacing.
#[test]
fn bars_in_series_resist_one_after_the_other() {
    let (k, h, length) = ([1.0, 4.0], 3.0, [1.0, 0.5]);
    let exact = 1.0 / (length[0] / k[0] + 1.0 / h + length[1] / k[1]);
    let flux = |n: usize| {
        let spacing = 1.0 / n as f64;
        let more = 6.0 * spacing;
        let mut two = Two::blocks(1);
        // begins at 0, its held part among it
        (two.length, two.spacing) = (length.map(|l| l + more), [spacing; 2]);
        (two.conductivity, two.conductance) = (k, h);
        (two.method, two.dt) = (EULER, 1e6);
        let mut spec = two.spec();
        let [low, high] = [more, more + length[0] + length[1]];
        spec.sets
            .extend([beyond("cold", low, -1.0), beyond("hot", high, 1.0)]);
        // lines of the exact slope, which stand for what is beyond the ends
        let cold = format!("{:e} * (x - {low:e})", exact / k[0]);
        let hot = format!("1 + {:e} * (x - {high:e})", exact / k[1]);
        spec.interactions.diffusions[0].conditions = vec![
            on("cold", DiffusionKind::Value(text(&cold))),
            on("hot", DiffusionKind::Value(text(&hot))),
        ];
        let mut sim = built(&spec);
        run(&mut *sim, 2);
        let t = temperature(&mut *sim);
        let lower = n + 6;
        let jump = t[lower] - t[lower - 1];
        // what goes through the middle of the lower bar, where the profile is straight
        let slope = (t[6 + n / 2 + 1] - t[6 + n / 2]) / spacing;
        let off = k[0] * slope / (h * jump) - 1.0;
        // 40 spacings from either end the profile feels nothing of them any more
        assert!(n < 80 || off.abs() < 1e-6, "{n}: {off:e}");
        h * jump
    };
    let errors = [20, 40, 80].map(|n| (flux(n) / exact - 1.0).abs());
    let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
    assert!(
        orders.iter().all(|o| (o - 1.0).abs() < 0.15),
        "{errors:?} {orders:?}"
    );
    assert!(errors[2] < 0.02, "{errors:?}");
}

/// A conductance that alone would allow only shorter steps makes no new extremes.
#[test]
fn steps_know_the_contact() {
    let mut two = Two::blocks(2);
    two.spacing[1] = 0.07;
    (two.conductance, two.dt) = (1e3, 1e-2);
    let spec = two.spec();
    let mut sim = built(&spec);
    let told = sim.info().diffusions[0].stable_step;
    assert!(told < 1e-4, "{told:e}");
    for _ in 0..20 {
        run(&mut *sim, 1);
        let t = temperature(&mut *sim);
        assert!(t.iter().all(|t| (-1e-12..=1.0 + 1e-12).contains(t)));
    }
    assert!(crossed(&*sim) > 0.0);
}

/// A block that flies against a plate and back.
fn thrown(method: DiffusionMethod) -> Spec {
    let mut two = Two::blocks(2).on_a_plate();
    (two.apart, two.method) = (0.2, method);
    (two.conductivity, two.conductance) = ([1.0; 2], 50.0);
    let mut spec = two.spec();
    spec.run.schedule.stepper = Stepper::Verlet;
    spec.run.schedule.time_step = TimeStep::Auto;
    for m in &mut spec.materials {
        m.law = LawSpec::Pmb(PmbStiffness::Young(1.0));
    }
    spec.loading.initial = vec![InitialSpec {
        set: "upper".into(),
        displacement: [None, None, None],
        velocity: [None, Some(text("-0.1")), None],
    }];
    spec
}

/// None before it is there, none after it has gone; in between, and over all, what one body gets the other gives.
#[test]
fn heat_is_kept_while_a_block_comes_and_goes() {
    for (method, bound) in [(EXPLICIT, 1e-13), (EULER, 1e-11)] {
        let mut sim = built(&thrown(method));
        let mut history = vec![];
        while sim.time() < 12.0 {
            run(&mut *sim, 1);
            history.push(crossed(&*sim));
            let account = sim.diffusions()[0].1;
            let off = account.content / account.initial - 1.0;
            assert!(off.abs() < bound, "{method:?} at {}: {off:e}", sim.time());
        }
        let last = history[history.len() - 1];
        assert_eq!(history[0], 0.0);
        assert!(last > 0.0 && history.is_sorted());
        let met = history.iter().filter(|x| **x > 0.0 && **x < last).count();
        let gone = history
            .iter()
            .filter(|x| x.to_bits() == last.to_bits())
            .count();
        assert!(met > 20 && gone > 20, "{met} {gone}");
    }
}

#[test]
fn threads_do_not_show_in_contact() {
    for method in [EXPLICIT, CRANK_NICOLSON] {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| {
                let mut spec = thrown(method);
                let BodySpec::Several(pieces) = &mut spec.body else {
                    unreachable!()
                };
                // more points than a piece of work has
                for (piece, low) in pieces.iter_mut().zip([[0.0, 0.0], [0.35, 0.52]]) {
                    if let BodySpec::Lattice {
                        spacing, origin, ..
                    } = &mut piece.body
                    {
                        *spacing = 0.0125;
                        *origin = [low[0] + 0.00625, low[1] + 0.00625, 0.0];
                    }
                }
                if let BodySpec::Lattice { region, .. } = &mut pieces[1].body {
                    *region = peridyne::space::region::Region::Block {
                        low: [0.35, 0.52, 0.0],
                        high: [1.05, 0.82, 0.0],
                    };
                }
                let mut sim = built(&spec);
                run(&mut *sim, 30);
                let mut all = temperature(&mut *sim);
                assert!(all.len() > 5000 && crossed(&*sim) > 0.0);
                all.push(crossed(&*sim));
                all.iter().map(|t| t.to_bits()).collect::<Vec<_>>()
            })
        };
        assert!(on(1) == on(3), "{method:?}");
    }
}

/// Bodies apart are as bodies without conductance, to the last bit.
#[test]
fn what_is_apart_exchanges_nothing() {
    let mut two = Two::blocks(2);
    (two.apart, two.conductance) = (0.04, 1e6);
    let mut spec = two.spec();
    let mut sim = built(&spec);
    run(&mut *sim, 3);
    assert_eq!(crossed(&*sim), 0.0);
    spec.interactions.contact.as_mut().unwrap().conductance = None;
    let mut without = built(&spec);
    run(&mut *without, 3);
    assert_eq!(without.diffusions()[0].1.through_contact, None);
    let bits = |sim: &mut dyn Simulation| -> Vec<u64> {
        temperature(sim).iter().map(|t| t.to_bits()).collect()
    };
    assert!(bits(&mut *sim) == bits(&mut *without));
    let told = |sim: &dyn Simulation| sim.info().diffusions[0].stable_step;
    assert_eq!(told(&*sim), told(&*without));
}

/// Faces that a pre-crack cut exchange nothing, on families that know their cut bonds and on those that forget them.
#[test]
fn faces_of_a_crack_exchange_nothing() {
    for (family, kind) in [FamilyChoice::Stencil, FamilyChoice::List]
        .into_iter()
        .flat_map(|f| [(f, CrackKind::Excluded), (f, CrackKind::Broken)])
    {
        let mut heat = heat(EXPLICIT);
        heat.initial = vec![("right".into(), text("1"))];
        let mut spec = still(2, cells(2, 0.1, [0.0; 3], [1.0, 0.4, 0.0]), 3, 1e-4, heat);
        spec.bonds.family = family;
        spec.sets = vec![beyond("right", 0.5, 1.0)];
        spec.damage.precracks = vec![PrecrackSpec {
            shape: CrackShape::Segment {
                from: [0.5, -1.0, 0.0],
                to: [0.5, 1.0, 0.0],
            },
            kind,
        }];
        spec.interactions.contact = Two::blocks(2).spec().interactions.contact;
        let mut sim = built(&spec);
        run(&mut *sim, 3);
        assert_eq!(crossed(&*sim), 0.0, "{family:?} {kind:?}");
    }
}

/// Points that stand conduct as points that are held in implicit steps, and in increments of a load.
#[test]
fn implicit_steps_and_increments_conduct_alike() {
    let mut two = Two::blocks(1);
    (two.conductance, two.dt, two.conductivity) = (1e-3, 1.0, [1.0; 2]);
    let stands = two.spec();
    let hold = |spec: &mut Spec, set: &str| {
        spec.loading.conditions = vec![ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Displacement([Some(text("0")), None, None]),
        }];
    };
    let mut steps = stands.clone();
    hold(&mut steps, "all");
    steps.run.schedule.steps = 50;
    steps.run.schedule.stepper = Stepper::Newmark(Newmark::default());
    // the point in the middle of the lower bar is free, and pulled at by nobody
    let mut increments = stands.clone();
    increments.sets.push(SetSpec {
        name: "held".into(),
        members: Members::Where(text("abs(x - 0.25) > 0.01")),
    });
    hold(&mut increments, "held");
    increments.run.schedule.steps = 50;
    increments.run.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Relaxation,
        ..Statics::default()
    });
    let after = |spec: &Spec| {
        let mut sim = built(spec);
        run(&mut *sim, 50);
        (crossed(&*sim), temperature(&mut *sim))
    };
    let (exact, of_points) = after(&stands);
    assert!(exact > 1e-3, "{exact}");
    for spec in [steps, increments] {
        let (found, of_these) = after(&spec);
        assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
        for (a, b) in of_these.iter().zip(&of_points) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }
}
