//! A linear body from a file as one of several bodies of a deck.

use peridyne::run::{Options, Simulation, build};
use peridyne::spec::LinearBody;
use peridyne_io::deck::Deck;
use peridyne_io::write::linear::write_linear;
use std::path::Path;

/// Ten points, each tied to the next by 0.7 force / volume² / length.
fn rod(period: Option<f64>, density: impl Fn(usize) -> f64) -> LinearBody<1> {
    let near = |i: usize| [i.checked_sub(1), (i < 9).then_some(i + 1)];
    let partners = |i: usize| near(i).into_iter().flatten();
    let mut start = vec![0];
    (0..10).for_each(|i| start.push(start[i] + partners(i).count()));
    LinearBody {
        position: (0..10).map(|i| [i as f64]).collect(),
        volume: vec![1.0; 10],
        density: (0..10).map(density).collect(),
        period: [period],
        block: vec![[[0.7]]; start[10]],
        partner: (0..10).flat_map(partners).map(|j| j as u32).collect(),
        start,
        load_map: None,
        mass: None,
    }
}

/// A deck in a folder.
fn deck(folder: &Path, name: &str, text: &str) -> Result<Deck, String> {
    let path = folder.join(name);
    Deck::parse(text, path.to_str().unwrap(), &[]).map_err(|e| e.to_string())
}

fn after(folder: &Path, name: &str, text: &str) -> Box<dyn Simulation> {
    let deck = deck(folder, name, text).unwrap_or_else(|e| panic!("{e}"));
    let mut sim = build(&deck.spec, Options::default()).unwrap_or_else(|e| panic!("{e}"));
    sim.start(true);
    for _ in 0..40 {
        sim.step().unwrap();
    }
    sim
}

const HEAD: &str = "units = \"none\"\n";
const ROD: &str = "density = 2\nlaw = \"micromoduli\"\n";
const REST: &str = "[[initial]]\nset = \"all\"\ndisplacement = { x = \"0.01*sin(x)\" }\n[run]\nsteps = 40\ntime_step = 0.1\n";

/// The rod, and a chain beside it.
fn beside(more: &str) -> String {
    format!(
        "{HEAD}horizon = {{ m_ratio = 2 }}\ncontact = false\n\
         [[body]]\nname = \"rod\"\nmaterial = \"rod\"\nfile = \"rod.npz\"\n\
         [[body]]\nname = \"chain\"\nmaterial = \"chain\"\nlattice = \"chain\"\nspacing = 1\norigin = [10]\ncells = [8]\n{more}\
         [material.rod]\n{ROD}[material.chain]\ndensity = 1\nlaw = {{ pmb = {{ young = 1 }} }}\n{REST}"
    )
}

#[test]
fn a_linear_body_is_one_of_several() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_linear(&folder.join("rod.npz"), &rod(None, |_| 2.0)).unwrap();
    let alone = format!("{HEAD}[body]\nfile = \"rod.npz\"\n[material]\n{ROD}{REST}");
    let u = after(folder, "alone.toml", &alone).displacements();
    let mut both = after(folder, "both.toml", &beside(""));
    assert_eq!(both.info().points, 18);
    assert!(both.displacements()[..10] == u);
    // glued to the chain, which is nearer than two spacings: momentum and energy stay
    let glue = "[[interface]]\nbodies = [\"chain\", \"rod\"]\nlaw = { pmb = { young = 1 } }\n";
    let mut glued = after(folder, "glued.toml", &beside(glue));
    assert!(glued.displacements()[..10] != u);
    let density = glued.scalars("density");
    let momentum = glued.velocities();
    let momentum = momentum.iter().zip(&density).map(|(v, rho)| v[0] * rho);
    let [sum, size] = momentum.fold([0.0; 2], |[sum, size], p: f64| [sum + p, size + p.abs()]);
    assert!(sum.abs() < 1e-13 * size, "{sum:e} of {size:e}");
    let l = glued.ledger().unwrap();
    assert!(l.residual().abs() < 3e-2 * l.initial, "{l:?}");
}

#[test]
fn what_is_that_of_a_whole_deck_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (body, says) in [
        (rod(Some(10.0), |_| 2.0), "periods of a linear body"),
        (rod(None, |i| 1.0 + i as f64), "differ in density"),
    ] {
        write_linear(&folder.join("rod.npz"), &body).unwrap();
        let error = deck(folder, "both.toml", &beside("")).err().unwrap();
        assert!(error.contains(says), "{error}");
    }
}
