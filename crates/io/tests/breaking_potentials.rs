//! Potentials on families of the reference whose bonds break: by their stretch, by the work on them, by cracks that are there from the start.

mod crystals;

use crystals::{
    EDGE, HORIZON, Random, argon, copper, deck, heat, largest, model, silicon, tersoff,
};
use peridyne::execute::simd::Simd;
use peridyne::run::{Options, Simulation, build};
use peridyne_io::deck::Deck;

/// The same deck with a fracture of its material.
fn fracture(text: &str, of: &str) -> String {
    text.replacen(
        "material = { ",
        &format!("material = {{ fracture = {{ {of} }}, "),
        1,
    )
}

fn energy(sim: &mut dyn Simulation) -> f64 {
    let volume = sim.scalars("volume");
    let seen = sim.observed().strain;
    seen.iter().zip(&volume).map(|(w, v)| w * v).sum()
}

/// Stillinger & Weber (1985) (2.3)–(2.6) with the constants of silicon of the file beside the decks.
struct Weber;

impl Weber {
    const EPSILON: f64 = 2.1683;
    const SIGMA: f64 = 2.0951;
    const REACH: f64 = 1.8 * Self::SIGMA;

    fn pair(r: f64) -> f64 {
        let (a, b) = (7.049556277, 0.6022245584);
        let x = Self::SIGMA / r;
        a * Self::EPSILON * (b * x.powi(4) - 1.0) * (Self::SIGMA / (r - Self::REACH)).exp()
    }

    fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let (r, s) = (dot(a, a).sqrt(), dot(b, b).sqrt());
        let off = dot(a, b) / (r * s) + 1.0 / 3.0;
        let decay = |r: f64| (1.2 * Self::SIGMA / (r - Self::REACH)).exp();
        21.0 * Self::EPSILON * off * off * decay(r) * decay(s)
    }
}

fn between(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| b[k] - a[k])
}

fn length(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Three atoms, one of whose bonds goes: what is left are two bonds and the angle between them.
#[test]
fn a_trimer_without_a_bond_is_two_bonds_and_their_angle() {
    let dir = tempfile::tempdir().unwrap();
    let rest = [[0.0, 0.0, 0.0], [2.4, 0.0, 0.0], [1.2, 2.0, 0.0]];
    let rows: Vec<String> = { rest.iter() }
        .map(|x| format!("{} {} {} 20\n", x[0], x[1], x[2]))
        .collect();
    let file = dir.path().join("three.txt");
    std::fs::write(&file, rows.concat()).unwrap();
    let text = format!(
        "units = \"metal\"\nfamily = \"reference\"\nhorizon = 3.7\nbody = {{ file = {:?} }}\n\
         material = {{ mass = 28.0855, fracture = {{ critical_stretch = 0.2 }}, law = {{ stillinger_weber = {{ file = \"Si.sw\" }} }} }}\n\
         run = {{ steps = 1, time_step = 1e-9 }}\n",
        file
    );
    let mut sim = model(&text);
    let u = [[-0.3, 0.0, 0.0], [0.3, 0.0, 0.0], [0.0, 0.0, 0.0]];
    let at: Vec<[f64; 3]> = { rest.iter().zip(&u) }
        .map(|(x, u)| std::array::from_fn(|a| x[a] + u[a]))
        .collect();
    sim.set_displacements(&u);
    sim.start(true);
    let pair = |i: usize, j: usize| Weber::pair(length(between(at[i], at[j])));
    let angle =
        |c: usize, i: usize, j: usize| Weber::angle(between(at[c], at[i]), between(at[c], at[j]));
    let whole =
        pair(0, 1) + pair(0, 2) + pair(1, 2) + angle(0, 1, 2) + angle(1, 0, 2) + angle(2, 0, 1);
    let left = pair(0, 2) + pair(1, 2) + angle(2, 0, 1);
    let first = energy(sim.as_mut());
    assert!((first / whole - 1.0).abs() < 1e-9, "{first} {whole}");
    sim.step().unwrap();
    let after = energy(sim.as_mut());
    assert!((after / left - 1.0).abs() < 1e-9, "{after} {left}");
    // from both ends
    assert_eq!(sim.broken(), 2);
    assert_eq!(sim.scalars("damage"), [0.5, 0.5, 0.0]);
    let ledger = sim.ledger().unwrap();
    // the pair held less than nothing
    let made = ledger.made - ledger.released;
    assert!(
        (made - (left - whole)).abs() < 1e-9 * (left - whole).abs(),
        "{made}"
    );

    // forces are slopes of that energy
    let mut random = Random(3);
    let force = sim.forces_under(&u);
    let volume = sim.scalars("volume");
    let w = random.vectors(3, 1.0);
    let mut moved = |step: f64| {
        let u: Vec<[f64; 3]> = { u.iter().zip(&w) }
            .map(|(u, w)| std::array::from_fn(|a| u[a] + step * w[a]))
            .collect();
        sim.set_displacements(&u);
        energy(sim.as_mut())
    };
    let h = 1e-3;
    let slope = (8.0 * (moved(h) - moved(-h)) - (moved(2.0 * h) - moved(-2.0 * h))) / (12.0 * h);
    let power: f64 = (0..3)
        .map(|i| volume[i] * (0..3).map(|a| force[i][a] * w[i][a]).sum::<f64>())
        .sum();
    assert!(
        (slope + power).abs() < 1e-8 * power.abs(),
        "{slope} {power}"
    );
}

/// `Σ ∫ (T_i − T_j)·dη` over all bonds is what the energy has grown by, of pairs, densities, angles and bond orders; the trapezoidal
/// rule is of second order.
#[test]
fn the_work_on_all_bonds_is_the_energy_that_they_gained() {
    let (cold, warm) = (heat(30.0), heat(900.0));
    let cases = [
        argon(&format!("family = \"reference\"\nhorizon = 6\n{cold}")),
        copper(&format!("family = \"reference\"\nhorizon = 5.3\n{warm}")),
        silicon("[3, 3, 3]", &format!("{HORIZON}{warm}")),
        tersoff(&format!("family = \"reference\"\nhorizon = 4.5\n{warm}")),
    ];
    for text in cases {
        let text = fracture(&text, "energy = 1e6, criterion = \"bond_energy\"");
        let off = |steps: usize, time_step: &str| {
            let text = text.replace("time_step = 0.0005", &format!("time_step = {time_step}"));
            let mut sim = model(&text);
            let first = energy(sim.as_mut());
            sim.start(true);
            for _ in 0..steps {
                sim.step().unwrap();
            }
            let volume = sim.scalars("volume")[0];
            let work: f64 = sim.scalars("bond_work").iter().sum();
            let work = 0.5 * work * volume * volume;
            let gained = energy(sim.as_mut()) - first;
            assert_eq!(sim.broken(), 0);
            assert!(gained > 0.01);
            (work - gained) / gained
        };
        let [long, short] = [off(20, "0.002"), off(40, "0.001")];
        println!("{long:e} {short:e}");
        assert!(
            long.abs() < 2e-3 && (short / long).abs() < 0.3,
            "{long} {short}"
        );
    }
}

/// Two atoms that fly apart let each other go where φ has risen by the critical work.
#[test]
fn a_pair_lets_go_where_its_work_is_the_critical_one() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("two.txt");
    std::fs::write(&file, "0 0 0 40\n3.9 0 0 40\n").unwrap();
    let text = format!(
        "units = \"metal\"\nfamily = \"reference\"\nhorizon = 6\nbody = {{ file = {:?} }}\n\
         material = {{ mass = 39.95, fracture = {{ energy = 0.002, criterion = \"bond_energy\" }}, law = {{ lennard_jones = {{ epsilon = 0.0104, sigma = 3.4, cutoff = 9 }} }} }}\n\
         initial = [{{ velocity = [\"x > 1 ? 3 : -3\", 0, 0] }}]\n\
         run = {{ steps = 1, time_step = 0.001 }}\n",
        file
    );
    let mut sim = model(&text);
    let volume = sim.scalars("volume");
    let phi = |r: f64| {
        let x = (3.4 / r).powi(6);
        4.0 * 0.0104 * (x * x - x)
    };
    sim.start(true);
    let critical = sim.scalars("critical_bond_work")[0] * volume[0] * volume[1];
    let most = -phi(3.9);
    assert!(
        critical > 0.1 * most && critical < 0.9 * most,
        "{critical} of {most}"
    );
    let gap = |sim: &mut dyn Simulation| {
        let at = sim.vectors("position");
        at[1][0] - at[0][0]
    };
    let mut before = 3.9;
    while sim.broken() == 0 {
        before = gap(sim.as_mut());
        sim.step().unwrap();
    }
    let after = gap(sim.as_mut());
    let work = |r: f64| phi(r) - phi(3.9);
    assert!(
        work(before) < critical * (1.0 + 1e-4),
        "{} {critical}",
        work(before)
    );
    assert!(
        work(after) > critical * (1.0 - 1e-4),
        "{} {critical}",
        work(after)
    );
    // free from now on
    let v = sim.velocities();
    for _ in 0..20 {
        sim.step().unwrap();
    }
    assert!(largest(&between(v[1], sim.velocities()[1])) < 1e-12);
}

/// What a plane crack cuts is what a plane crosses, and halves that it parts know nothing of each other, of every potential.
#[test]
fn a_crack_through_the_body_parts_it() {
    let open = |text: String| text.replace("[\"x\", \"y\", \"z\"]", "[\"y\", \"z\"]");
    let crack = |x: f64| {
        format!(
            "precrack = [{{ segment = {{ from = [{x}, -99, 0], to = [{x}, 99, 0] }}, kind = \"broken\" }}]\n"
        )
    };
    let cases = [
        (
            open(silicon("[4, 2, 2]", &format!("{HORIZON}{}", crack(10.3)))),
            10.3,
            5.2,
        ),
        (
            open(tersoff(&format!(
                "family = \"reference\"\nhorizon = 4.5\n{}",
                crack(7.9)
            ))),
            7.9,
            4.5,
        ),
        (
            open(copper(&format!(
                "family = \"reference\"\nhorizon = 5.3\n{}",
                crack(6.3)
            ))),
            6.3,
            5.3,
        ),
        (
            open(argon(&format!(
                "family = \"stencil\"\nhorizon = 6\n{}",
                crack(9.4)
            ))),
            9.4,
            6.0,
        ),
    ];
    for (text, at, horizon) in cases {
        let mut sim = model(&text);
        let reference = sim.vectors("reference");
        let period = deck(&text).spec.space.periodic;
        let mut crossed = 0;
        for a in &reference {
            for b in &reference {
                let d: [f64; 3] = std::array::from_fn(|k| {
                    let d = b[k] - a[k];
                    d - period[k].map_or(0.0, |p| p * (d / p).round())
                });
                let apart = (a[0] - at) * (b[0] - at) < 0.0;
                crossed += u64::from(apart && length(d) <= horizon * (1.0 + 1e-9));
            }
        }
        assert_eq!(sim.info().cut, crossed);
        sim.start(true);
        assert_eq!(sim.fragments(), 2);
        let rest = energy(sim.as_mut());
        let far: Vec<[f64; 3]> = { reference.iter() }
            .map(|x| {
                if x[0] > at {
                    [0.7, 0.4, -0.3]
                } else {
                    [0.0; 3]
                }
            })
            .collect();
        let (a, b) = (
            sim.forces_under(&far),
            sim.forces_under(&vec![[0.0; 3]; reference.len()]),
        );
        let size = largest(&b.concat());
        let off = { a.iter().flatten().zip(b.iter().flatten()) }.map(|(a, b)| a - b);
        assert!(largest(&off.collect::<Vec<_>>()) < 1e-9 * size.max(1e-3));
        sim.set_displacements(&far);
        let moved = energy(sim.as_mut());
        assert!((moved / rest - 1.0).abs() < 1e-11, "{moved} {rest}");
        assert!(sim.scalars("damage").iter().any(|d| *d > 0.2));
    }
}

/// A bar that is torn by its ends.
fn torn(material: &str, more: &str) -> String {
    format!(
        "units = \"metal\"\nperiodic = [\"y\", \"z\"]\nfamily = \"reference\"\nhorizon = 5.2\n\
         body = {{ lattice = \"diamond\", spacing = {EDGE}, cells = [6, 2, 2] }}\n\
         material = {{ mass = 28.0855, {material} }}\n\
         initial = [{{ velocity = [\"x > 16 ? 20 : -20\", 0, 0] }}]\n\
         run = {{ steps = 1, time_step = 0.001 }}\n{more}"
    )
}

const SILICON: &str = "law = { stillinger_weber = { file = \"Si.sw\" } }";

/// Bits depend neither on threads nor on the width of registers, and what bonds let go is booked.
#[test]
fn a_torn_bar_has_the_same_bits_everywhere_and_its_energy_is_booked() {
    // bonds beyond the cut-off bear no work, and would never break by it
    let cases = [
        ("critical_stretch = 0.12", "5.2"),
        ("energy = 0.01, criterion = \"bond_energy\"", "3.77"),
    ];
    for (criterion, horizon) in cases {
        let text = torn(&format!("fracture = {{ {criterion} }}, {SILICON}"), "");
        let text = text.replace("horizon = 5.2", &format!("horizon = {horizon}"));
        let run = |simd: Simd, threads: usize, steps: usize, time_step: f64| {
            let text = text.replace("time_step = 0.001", &format!("time_step = {time_step}"));
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                let options = Options {
                    simd: Some(simd),
                    ..Options::default()
                };
                let mut sim = build(&deck(&text).spec, options).unwrap();
                sim.start(true);
                for _ in 0..steps {
                    sim.step().unwrap();
                }
                let ledger = sim.ledger().unwrap();
                (
                    sim.broken(),
                    sim.fragments(),
                    sim.vectors("position"),
                    ledger,
                )
            })
        };
        let mut all: Vec<_> = { Simd::available().into_iter() }
            .flat_map(|simd| [1, 2].map(|threads| run(simd, threads, 400, 0.001)))
            .collect();
        let first = all.remove(0);
        // 16 bonds cross a plane
        assert!(first.0 >= 32 && first.1 >= 2, "{} {}", first.0, first.1);
        for other in &all {
            assert!(other.0 == first.0 && other.2 == first.2);
        }
        let drift = |time_step: f64| {
            let steps = (0.4 / time_step).round() as usize;
            let (_, _, _, l) = run(Simd::detect(), 2, steps, time_step);
            ((l.base() - l.initial) / (l.released + l.made)).abs()
        };
        let [long, short] = [drift(0.001), drift(0.0005)];
        println!("{criterion}: {} bonds, drift {long:e} {short:e}", first.0);
        assert!(long < 1e-2 && short < 0.5 * long, "{long} {short}");
    }
}

/// Healed bonds pull again; factors of places make some hold.
#[test]
fn bonds_heal_and_bear_what_their_places_say() {
    let weak = "fracture = { critical_stretch = 0.12 }, ";
    let counts = |more: &str, steps: usize| {
        let mut sim = model(&torn(&format!("{weak}{SILICON}"), more));
        sim.start(true);
        for _ in 0..steps {
            sim.step().unwrap();
        }
        (sim.broken(), largest(&sim.scalars("damage")))
    };
    let (plain, damage) = counts("", 60);
    assert!(plain > 0 && damage > 0.1);
    let (spared, whole) = counts("toughness = [{ set = \"all\", no_failure = true }]\n", 60);
    assert_eq!((spared, whole), (0, 0.0));
    // a crack that is closed heals before the first step
    let crack = "precrack = [{ segment = { from = [16.3, -99, 0], to = [16.3, 99, 0] }, kind = \"broken\" }]\n";
    let still = |more: &str| {
        let text = torn(&format!("{weak}{SILICON}"), &format!("{crack}{more}"));
        let text = text.replace("16 ? 20 : -20", "16 ? 0 : 0");
        let mut sim = model(&text);
        sim.start(true);
        sim.step().unwrap();
        (largest(&sim.scalars("damage")), energy(sim.as_mut()))
    };
    let (open, parted) = still("");
    let (closed, healed) = still("healing = { below = 0.05 }\n");
    let whole = energy(model(&torn(SILICON, "")).as_mut());
    assert!(open > 0.2 && closed == 0.0, "{open} {closed}");
    assert!(
        (healed / whole - 1.0).abs() < 1e-12 && parted > 0.99 * whole,
        "{healed} {whole} {parted}"
    );
}

/// Nodes carry atoms whose bonds break.
#[test]
fn smoothed_silicon_breaks() {
    let text = format!(
        "units = \"metal\"\nperiodic = [\"y\", \"z\"]\nfamily = \"reference\"\nhorizon = 5.2\n\
         smooth = {{ kernel = \"polynomial\", smoothness = 5, width = 12, spacing = {EDGE} }}\n\
         body = {{ lattice = \"diamond\", spacing = {EDGE}, cells = [10, 2, 2] }}\n\
         material = {{ mass = 28.0855, fracture = {{ critical_stretch = 0.12 }}, {SILICON} }}\n\
         initial = [{{ velocity = [\"x > 27 ? 15 : -15\", 0, 0] }}]\n\
         run = {{ steps = 1, time_step = 0.002 }}\n"
    );
    let mut sim = model(&text);
    sim.start(true);
    for _ in 0..400 {
        sim.step().unwrap();
    }
    let damage = sim.scalars("damage");
    println!("{} broken, damage {}", sim.broken(), largest(&damage));
    assert!(sim.broken() > 100);
    assert!(damage.iter().all(|d| (0.0..=1.0).contains(d)) && largest(&damage) > 0.5);
    let l = sim.ledger().unwrap();
    let drift = ((l.base() - l.initial) / (l.released + l.made)).abs();
    assert!(drift < 1e-2, "{drift}");
}

/// A sum of potentials breaks as one: twice half a Lennard-Jones is a whole.
#[test]
fn a_sum_of_potentials_breaks_as_one() {
    let law = |epsilon: f64| {
        format!("lennard_jones = {{ epsilon = {epsilon}, sigma = 3.4, cutoff = 8.5 }}")
    };
    let text = |law: &str, more: &str| {
        format!(
            "units = \"metal\"\nperiodic = [\"y\", \"z\"]\nfamily = \"reference\"\nhorizon = 6\n\
             body = {{ lattice = \"fcc\", spacing = 5.3, cells = [6, 3, 3] }}\n\
             material = {{ argon = {{ mass = 39.95, fracture = {{ critical_stretch = 0.1 }}, law = {{ {law} }} }} }}\n{more}\
             initial = [{{ velocity = [\"x > 15 ? 3 : -3\", 0, 0] }}]\n\
             run = {{ steps = 1, time_step = 0.002 }}\n"
        )
    };
    let run = |text: String| {
        let mut sim = model(&text);
        sim.start(true);
        for _ in 0..400 {
            sim.step().unwrap();
        }
        (sim.broken(), sim.scalars("damage"), sim.vectors("position"))
    };
    let one = run(text(&law(0.0104), ""));
    let two = run(text(
        &law(0.0052),
        &format!(
            "pair = [{{ between = [\"argon\", \"argon\"], law = {{ {} }} }}]\n",
            law(0.0052)
        ),
    ));
    assert!(one.0 > 20);
    assert_eq!((one.0, &one.1), (two.0, &two.1));
    let off = { one.2.iter().flatten().zip(two.2.iter().flatten()) }.map(|(a, b)| a - b);
    assert!(largest(&off.collect::<Vec<_>>()) < 1e-9);
}

/// Combinations that have no meaning say why.
#[test]
fn what_cannot_break_says_why() {
    let refused = |text: &str| -> String {
        match Deck::parse(text, "test.toml", &[]) {
            Err(e) => e.to_string(),
            Ok(deck) => match build(&deck.spec, Options::default()) {
                Err(e) => e.to_string(),
                Ok(_) => panic!("{text}"),
            },
        }
    };
    let said = refused(&fracture(&argon(""), "critical_stretch = 0.1"));
    assert!(
        said.contains("who comes near again is a neighbour again"),
        "{said}"
    );
    let held = argon("family = \"reference\"\nhorizon = 6\n");
    let said = refused(&fracture(&held, "energy = 1"));
    assert!(said.contains("no square of its stretch"), "{said}");
    let said = refused(&fracture(
        &held,
        "critical_stretch = 0.1, rate = { coefficient = 0.1, reference = 1 }",
    ));
    assert!(said.contains("no stress, rate or age"), "{said}");
}
