//! Bodies that are exact at their surface, as decks: uniform stresses by plain tractions, constant gradients of temperature by plain
//! fluxes.

use peridyne::run::{Options, Simulation, build};
use peridyne_io::deck::Deck;

const H: f64 = 0.1;

fn model(text: &str) -> Box<dyn Simulation> {
    let deck = Deck::parse(text, "exact.toml", &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let options = Options {
        trust_time_step: true,
        simd: None,
    };
    let mut sim = build(&deck.spec, options).unwrap_or_else(|e| panic!("{e}\n{text}"));
    sim.start(true);
    sim
}

/// A box of so many points between 0 and its far corner, and its faces: `low0`, `high0`, `low1`, …
fn body(n: &[usize], m: u32, head: &str, law: &str) -> String {
    let d = n.len();
    let lattice = ["chain", "square", "cubic"][d - 1];
    let far: Vec<String> = n
        .iter()
        .map(|n| format!("{}", (n - 1) as f64 * H))
        .collect();
    let mut text = format!(
        "units = \"none\"\n{head}\nhorizon = {{ m_ratio = {m} }}\ninfluence = \"constant\"\nsurface = \"exact\"\n\
         body = {{ lattice = \"{lattice}\", spacing = {H}, origin = {:?}, region = {{ block = {{ low = {:?}, high = [{}] }} }} }}\n\
         material = {{ density = 1, {law} }}\n",
        vec![0.0; d],
        vec![0.0; d],
        far.join(", ")
    );
    for (a, (axis, far)) in ["x", "y", "z"].iter().zip(&far).enumerate() {
        text += &format!(
            "[sets.low{a}]\nwhere = \"{axis} < {0}\"\n[sets.high{a}]\nwhere = \"{axis} > {far} - {0}\"\n",
            0.3 * H
        );
    }
    text
}

/// Outward area of a point of the box: that of the faces through it, halved at their edges, quartered at corners.
fn area(x: &[f64; 3], n: &[usize], section: f64) -> [f64; 3] {
    let d = n.len();
    let place: Vec<usize> = x[..d].iter().map(|x| (x / H).round() as usize).collect();
    let end = |a: usize| place[a] == 0 || place[a] == n[a] - 1;
    std::array::from_fn(|a| {
        if a >= d || !end(a) {
            return 0.0;
        }
        let shared = (0..d).filter(|b| *b != a && end(*b)).count() as i32;
        let sign = if place[a] == 0 { -1.0 } else { 1.0 };
        sign * section * H.powi(d as i32 - 1) * 0.5f64.powi(shared)
    })
}

/// All symmetric unit stresses.
fn stresses(d: usize) -> Vec<[[f64; 3]; 3]> {
    let pairs = (0..d).flat_map(|a| (a..d).map(move |b| (a, b)));
    let unit = |(a, b): (usize, usize)| {
        let mut s = [[0.0; 3]; 3];
        (s[a][b], s[b][a]) = (1.0, 1.0);
        s
    };
    pairs.map(unit).collect()
}

/// What a body under the tractions of one stress, left to itself, misses: its displacements those of a uniform strain (of the largest), its forces
/// the exact tractions times the areas (of the largest).
fn missed(text: &str, n: &[usize], section: f64, sigma: &[[f64; 3]; 3]) -> [f64; 2] {
    let d = n.len();
    // so small that nothing but what is linear shows
    let small = 1e-14;
    let mut text = text.to_string();
    for (a, row) in sigma.iter().enumerate().take(d) {
        for (end, sign) in [("low", -1.0), ("high", 1.0)] {
            let t = row.iter().zip(["x", "y", "z"]).filter(|(s, _)| **s != 0.0);
            let t: Vec<String> = t
                .map(|(s, b)| format!("{b} = {:e}", sign * small * s))
                .collect();
            if !t.is_empty() {
                let t = t.join(", ");
                text +=
                    &format!("[[boundary_condition]]\nset = \"{end}{a}\"\ntraction = {{ {t} }}\n");
            }
        }
    }
    // as few components as hold a rigid body, which need no force then: of the first point, and of those at the ends of its edges
    let axes = &["x", "y", "z"][..d];
    for (edge, held) in [
        (None, axes),
        (Some(0), &axes[1..]),
        (Some(1), &axes[d.min(2)..]),
    ] {
        if held.is_empty() {
            continue;
        }
        let at = |(a, axis): (usize, &&str)| match edge == Some(a) {
            true => format!("{axis} > {}", (n[a] as f64 - 1.3) * H),
            false => format!("{axis} < {}", 0.3 * H),
        };
        let at: Vec<String> = axes.iter().enumerate().map(at).collect();
        let held: Vec<String> = held.iter().map(|axis| format!("{axis} = 0")).collect();
        let name = edge.map_or("first".to_string(), |a| format!("end{a}"));
        text += &format!(
            "[sets.{name}]\nwhere = \"{}\"\n[[boundary_condition]]\nset = \"{name}\"\ndisplacement = {{ {} }}\n",
            at.join(" && "),
            held.join(", ")
        );
    }
    text += "[statics]\nmethod = \"linear\"\ntolerance = 1e-14\n";
    let mut sim = model(&text);
    sim.step().unwrap();
    let (u, x) = (sim.displacements(), sim.vectors("reference"));
    let v = sim.scalars("volume");
    // the gradient between the first point and the others of its edges
    let at = |to: [f64; 3]| {
        let near = |x: &&[f64; 3]| (0..3).all(|a| (x[a] - to[a]).abs() < 0.1 * H);
        let k = x.iter().position(|x| near(&x)).unwrap();
        u[k]
    };
    let origin = at([0.0; 3]);
    let gradient: Vec<[f64; 3]> = (0..d)
        .map(|b| {
            let mut to = [0.0; 3];
            to[b] = (n[b] - 1) as f64 * H;
            let there = at(to);
            std::array::from_fn(|a| (there[a] - origin[a]) / to[b])
        })
        .collect();
    let mut worst = [0.0f64; 2];
    let mut largest = [0.0f64; 2];
    let f = sim.forces_under(&u);
    for k in 0..u.len() {
        let area = area(&x[k], n, section);
        for a in 0..d {
            let affine: f64 = origin[a] + (0..d).map(|b| gradient[b][a] * x[k][b]).sum::<f64>();
            let traction: f64 = (0..d).map(|b| small * sigma[a][b] * area[b]).sum();
            for (n, (found, exact)) in [(u[k][a], affine), (-f[k][a] * v[k], traction)]
                .into_iter()
                .enumerate()
            {
                worst[n] = worst[n].max((found - exact).abs());
                largest[n] = largest[n].max(exact.abs());
            }
        }
    }
    [worst[0] / largest[0], worst[1] / largest[1]]
}

const PMB: &str = "law = { pmb = { young = 3 } }";
const SPRINGS: &str = "law = { springs = { young = 3 } }";
const LPS: &str = "law = { lps = { young = 3, poisson = 0.15 } }";

/// The load cases of docs/decisions/0003-surface.md: every stress of bars, plates and blocks.
#[test]
fn plain_tractions_make_uniform_strains() {
    let (bar, plate, block) = (&[30usize][..], &[17, 14][..], &[9, 11, 10][..]);
    let mut cases = 0;
    for (law, n, m) in [
        (PMB, bar, 3),
        (SPRINGS, bar, 2),
        (SPRINGS, bar, 4),
        (PMB, plate, 2),
        (PMB, plate, 3),
        (PMB, plate, 4),
        (PMB, block, 2),
        (PMB, block, 3),
        (LPS, bar, 2),
        (LPS, plate, 2),
        (LPS, plate, 3),
        (LPS, plate, 4),
        (LPS, block, 2),
        (LPS, block, 3),
    ] {
        let (head, section) = match n.len() {
            1 => ("area = 0.25", 0.25),
            2 => ("plane = \"stress\"\nthickness = 0.25", 0.25),
            _ => ("", 1.0),
        };
        let text = body(n, m, head, law);
        for sigma in stresses(n.len()) {
            let [u, f] = missed(&text, n, section, &sigma);
            println!("{law} {n:?}, horizon {m}, {sigma:?}: {u:.1e}, {f:.1e}");
            assert!(
                u < 1e-12 && f < 1e-12,
                "{law} {n:?}, horizon {m}, {sigma:?}: {u:e}, {f:e}"
            );
            cases += 1;
        }
    }
    assert_eq!(cases, 46);
}

/// A unit flux through one end of a box of unit conductivity, the other held at 0: the temperature is the distance from there.
#[test]
fn plain_fluxes_make_constant_gradients() {
    for (law, n, m) in [
        (PMB, &[30usize][..], 3),
        (PMB, &[17, 14][..], 2),
        (PMB, &[17, 14][..], 3),
        (SPRINGS, &[17, 14][..], 4),
        (LPS, &[17, 14][..], 3),
        (PMB, &[9, 11, 10][..], 2),
        (PMB, &[13, 13, 14][..], 3),
        (LPS, &[9, 8, 10][..], 3),
    ] {
        let head = match n.len() {
            1 => "area = 0.25",
            2 => "plane = \"stress\"\nthickness = 0.25",
            _ => "",
        };
        let law = format!("{law}, heat = {{ conductivity = 1, capacity = 1 }}");
        for along in 0..n.len() {
            let text = body(
                n,
                m,
                &format!("{head}\nheat = {{ method = \"steady\", tolerance = 1e-14 }}"),
                &law,
            ) + &format!(
                "[[boundary_condition]]\nset = \"low{along}\"\ntemperature = 0\n[[boundary_condition]]\nset = \"high{along}\"\nheat_flux = 1\n\
                     [run]\nintegrator = \"none\"\nsteps = 1\ntime_step = 1\n"
            );
            let mut sim = model(&text);
            sim.step().unwrap();
            let far = (n[along] - 1) as f64 * H;
            let x = sim.vectors("reference");
            let t = sim.scalars("temperature");
            let off = t.iter().zip(&x).map(|(t, x)| (t - x[along]).abs());
            let off = off.fold(0.0, f64::max) / far;
            println!("{law} {n:?}, horizon {m}, along {along}: {off:.1e}");
            assert!(
                off < 1e-11,
                "{law} {n:?}, horizon {m}, along {along}: {off:e}"
            );
        }
    }
}

/// Plates of unlike spacing, each exact at its own surface, beside one that is not: a unit flux through one end of each of the first two, the other held at 0.
#[test]
fn each_of_several_bodies_is_exact_at_its_surface() {
    for law in [PMB, LPS] {
        let plate = |name: &str, h: f64, low: f64| {
            let high = low + 1.6;
            format!(
                "[[body]]\nname = \"{name}\"\nlattice = \"square\"\nspacing = {h}\n\
                 region = {{ block = {{ low = [{low}, 0], high = [{high}, 1.2] }} }}\n"
            )
        };
        let mut text = format!(
            "units = \"none\"\nplane = \"stress\"\nthickness = 0.25\nhorizon = {{ m_ratio = 3 }}\ninfluence = \"constant\"\n\
             surface = \"exact\"\ncontact = false\nheat = {{ method = \"steady\", tolerance = 1e-14 }}\n\
             material = {{ density = 1, {law}, heat = {{ conductivity = 1, capacity = 1 }} }}\n"
        );
        text += &plate("coarse", 0.1, 0.0);
        text += &plate("fine", 0.05, 10.0);
        text += &(plate("plain", 0.2, 20.0) + "surface = \"none\"\n");
        for (name, h, low) in [("coarse", 0.1, 0.0), ("fine", 0.05, 10.0)] {
            for (end, at) in [("low", low), ("high", low + 1.6)] {
                let near = 0.3 * h;
                text += &format!("[sets.{name}_{end}]\nwhere = \"abs(x - {at}) < {near}\"\n");
            }
            text += &format!(
                "[[boundary_condition]]\nset = \"{name}_low\"\ntemperature = 0\n[[boundary_condition]]\nset = \"{name}_high\"\nheat_flux = 1\n"
            );
        }
        text += "[[boundary_condition]]\nset = \"plain\"\ntemperature = 0\n\
                 [run]\nintegrator = \"none\"\nsteps = 1\ntime_step = 1\n";
        let mut sim = model(&text);
        sim.step().unwrap();
        // the first two end at their outermost points, the third half a spacing outside
        let volume = 2.0 * 1.6 * 1.2 * 0.25 + 8.0 * 6.0 * 0.04 * 0.25;
        assert!((sim.info().volume / volume - 1.0).abs() < 1e-12);
        let x = sim.vectors("reference");
        let t = sim.scalars("temperature");
        for (x, t) in x.iter().zip(&t).filter(|(x, _)| x[0] < 15.0) {
            let from = if x[0] < 5.0 { x[0] } else { x[0] - 10.0 };
            assert!((t - from).abs() < 1e-11, "{law} at {x:?}: {t}");
        }
    }
}
