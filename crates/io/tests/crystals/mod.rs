//! Atoms that several tests look at, as decks.
#![allow(dead_code)]

use peridyne::run::{Options, Simulation, build};
use peridyne_io::deck::Deck;
use std::path::Path;

/// Edge of silicon's cell (Å), and a horizon with room to move.
pub const EDGE: f64 = 5.43094978;
pub const HORIZON: &str = "family = \"reference\"\nhorizon = 5.2\n";

/// A pair potential of hexane.
pub const WEAK: &str =
    "{ lennard_jones = { epsilon = 0.0051, sigma = 3.905, cutoff = 9, end = \"shifted\" } }";

/// The deck of a text; files are those beside the good decks.
pub fn deck(text: &str) -> Deck {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/test.toml");
    Deck::parse(text, file.to_str().unwrap(), &[]).unwrap()
}

pub fn model(text: &str) -> Box<dyn Simulation> {
    build(&deck(text).spec, Options::default()).unwrap()
}

/// Atoms in periods, in units of metals.
pub fn atoms(body: &str, material: &str, more: &str) -> String {
    format!(
        "units = \"metal\"\nperiodic = [\"x\", \"y\", \"z\"]\n{more}\nbody = {body}\nmaterial = {material}\n\
         run = {{ steps = 1, time_step = 0.0005 }}\n"
    )
}

pub fn silicon(cells: &str, more: &str) -> String {
    let body = format!("{{ lattice = \"diamond\", spacing = {EDGE}, cells = {cells} }}");
    let law = "{ mass = 28.0855, law = { stillinger_weber = { file = \"Si.sw\" } } }";
    atoms(&body, law, more)
}

pub fn tersoff(more: &str) -> String {
    let law =
        "{ mass = 28.0855, law = { tersoff = { file = \"SiC.tersoff\", element = \"Si\" } } }";
    atoms(
        "{ lattice = \"diamond\", spacing = 5.43, cells = [3, 3, 3] }",
        law,
        more,
    )
}

pub fn copper(more: &str) -> String {
    let law = "{ law = { eam = { file = \"copper.eam.alloy\" } } }";
    atoms(
        "{ lattice = \"fcc\", spacing = 3.6147, cells = [4, 4, 4] }",
        law,
        more,
    )
}

pub fn argon(more: &str) -> String {
    let law =
        "{ mass = 39.95, law = { lennard_jones = { epsilon = 0.0104, sigma = 3.4, cutoff = 6 } } }";
    atoms(
        "{ lattice = \"fcc\", spacing = 5.3, cells = [4, 4, 4] }",
        law,
        more,
    )
}

pub fn hexane(law: &str, more: &str) -> String {
    atoms(
        "{ file = \"hexane.data\" }",
        &format!("{{ law = {law} }}"),
        &format!("molecules = {{ special = [0, 0, 0.5] }}\n{more}"),
    )
}

pub fn heat(kelvin: f64) -> String {
    format!("initial_velocities = {{ temperature = {kelvin}, seed = 3 }}\n")
}

/// Positions after so many steps.
pub fn run(text: &str, steps: usize) -> Vec<[f64; 3]> {
    let mut sim = model(text);
    sim.start(true);
    for _ in 0..steps {
        sim.step().unwrap();
    }
    sim.vectors("position")
}

pub fn farthest(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let off = a.iter().flatten().zip(b.iter().flatten());
    off.fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

pub struct Random(pub u64);

impl Random {
    /// From −1 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vectors(&mut self, count: usize, size: f64) -> Vec<[f64; 3]> {
        let mut vector = || std::array::from_fn(|_| size * self.next());
        (0..count).map(|_| vector()).collect()
    }
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| m.max(x.abs()))
}
