//! Atoms of `verify/lammps/atoms`, from LAMMPS's data files, against the numbers that LAMMPS computed for them.

use peridyne::observe::Values;
use peridyne::run::{Options, build};
use peridyne_io::deck::{Deck, Dim};
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../verify/lammps/atoms")
}

/// Rows of numbers between lines of `#`.
fn golden(name: &str) -> Vec<Vec<Vec<f64>>> {
    let text = std::fs::read_to_string(folder().join(format!("{name}.golden"))).unwrap();
    let mut parts = vec![];
    for line in text.lines() {
        if line.starts_with('#') {
            parts.push(vec![]);
        } else {
            let row = line.split_whitespace().map(|w| w.parse().unwrap());
            parts.last_mut().unwrap().push(row.collect());
        }
    }
    parts
}

/// What LAMMPS takes for 1 g/mol in eV ps²/Å², for 1 eV/Å³ in bar and for kelvin in eV.
const LAMMPS_MASS: f64 = 1.0364269e-4;
const LAMMPS_BAR: f64 = 1.6021765e6;
const LAMMPS_BOLTZMANN: f64 = 8.617343e-5;

/// `mass` takes the place of the deck's.
fn compare(name: &str, law: &str, extra: &str, mass: Option<f64>) {
    let material = format!("material.law = {law}\n");
    compare_kinds(
        name,
        &material,
        extra,
        mass.as_ref().map(std::slice::from_ref),
    );
}

/// Of several materials.
fn compare_kinds(name: &str, materials: &str, extra: &str, masses: Option<&[f64]>) {
    let text = format!(
        "{extra}\nperiodic = [\"x\", \"y\", \"z\"]\nbody.file = \"{name}.data\"\n{materials}"
    );
    let file = folder().join("deck.toml");
    let mut deck =
        Deck::parse(&text, file.to_str().unwrap(), &[]).unwrap_or_else(|e| panic!("{e:?}"));
    let volume = match &deck.spec.body {
        peridyne::spec::BodySpec::Cloud(c) => c.volume[0],
        _ => panic!(),
    };
    for (material, mass) in deck.spec.materials.iter_mut().zip(masses.unwrap_or(&[])) {
        // the file's, but for products and quotients
        assert!(
            (material.density * volume / mass - 1.0).abs() < 1e-14
                || masses.is_some_and(|m| m.len() == 1)
        );
        material.density = mass / volume;
    }
    let mass: Vec<f64> = { deck.spec.materials.iter() }
        .map(|m| m.density * volume)
        .collect();
    let pressure = 1.0 / deck.units.plain_factor(Dim::PRESSURE);
    let mut sim = build(&deck.spec, Options::default()).unwrap_or_else(|e| panic!("{e}"));
    let golden = golden(name);
    sim.start(true);
    let first = &golden[0][0];
    let n = sim.info().points as f64;
    let energy = sim.ledger().unwrap().strain;
    assert!(
        ((energy - first[0]) / n).abs() < 1e-10,
        "{name}: energy {energy} is not {}",
        first[0]
    );
    let kind = match sim.column("material").map(|c| c.values) {
        Some(Values::Counts(kind)) => kind,
        _ => panic!(),
    };
    // kinetic part and virial, over the box
    let (v, volumes) = (sim.velocities(), sim.scalars("volume"));
    let box_volume: f64 = volumes.iter().sum();
    let virial = sim.virial();
    for (k, (a, b)) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
        .into_iter()
        .enumerate()
    {
        let each = v.iter().zip(&kind);
        let kinetic: f64 = each.map(|(v, k)| mass[*k as usize] * v[a] * v[b]).sum();
        let p = (kinetic + virial[k]) / box_volume * pressure;
        let scale = first[1].abs().max(first[2].abs());
        assert!(
            (p - first[1 + k]).abs() < 1e-9 * scale,
            "{name}: pressure {k}: {p} is not {}",
            first[1 + k]
        );
    }
    let forces = sim.vectors("force_density");
    let largest = golden[1]
        .iter()
        .flatten()
        .fold(0.0f64, |m, f| m.max(f.abs()));
    for (i, exact) in golden[1].iter().enumerate() {
        for a in 0..3 {
            let f = forces[i][a] * volumes[i];
            assert!(
                (f - exact[a]).abs() < 1e-9 * largest,
                "{name}: force on {i}: {f} is not {}",
                exact[a]
            );
        }
    }
    for _ in 0..100 {
        sim.step().unwrap();
    }
    let ledger = sim.ledger().unwrap();
    for (what, found, exact) in [
        ("energy", ledger.strain, golden[2][0][0]),
        ("kinetic energy", ledger.kinetic, golden[2][0][1]),
    ] {
        assert!(
            ((found - exact) / n).abs() < 1e-9,
            "{name}: {what} after 100 steps: {found} is not {exact}"
        );
    }
    let (x, u) = (sim.vectors("reference"), sim.displacements());
    for (i, exact) in golden[3].iter().enumerate() {
        for a in 0..3 {
            let y = x[i][a] + u[i][a];
            assert!(
                (y - exact[a]).abs() < 1e-9,
                "{name}: atom {i}: {y} is not {}",
                exact[a]
            );
        }
    }
}

#[test]
fn a_lennard_jones_crystal_is_that_of_lammps() {
    compare(
        "lj_crystal",
        "{ lennard_jones = { epsilon = 1, sigma = 1, cutoff = 2.5 } }",
        "units = \"lj\"\nrun = { steps = 100, time_step = 0.003 }",
        Some(1.0),
    );
}

#[test]
fn a_lennard_jones_liquid_is_that_of_lammps() {
    compare(
        "lj_liquid",
        "{ lennard_jones = { epsilon = 1, sigma = 1, cutoff = 2.5, end = \"shifted\" } }",
        "units = \"lj\"\nrun = { steps = 100, time_step = 0.003 }",
        Some(1.0),
    );
}

#[test]
fn a_copper_block_is_that_of_lammps() {
    compare(
        "copper",
        "{ eam = { file = \"copper.eam.alloy\" } }",
        "units = { system = \"metal\", constants = \"lammps\" }\nrun = { steps = 100, time_step = 0.002 }",
        None,
    );
}

#[test]
fn a_lennard_jones_mixture_is_that_of_lammps() {
    compare_kinds(
        "lj_mixture",
        r#"
[material.1]
law = { lennard_jones = { epsilon = 1, sigma = 1, cutoff = 2.5 } }
[material.b]
set = "2"
law = { lennard_jones = { epsilon = 0.5, sigma = 0.88, cutoff = 2.2 } }
[material.c]
mass = 0.4
law = { lennard_jones = { epsilon = 0.7, sigma = 0.94, cutoff = 2.3 } }
[[pair]]
between = ["c", "1"]
law = { lennard_jones = { epsilon = 1.3, sigma = 0.9, cutoff = 2.1 } }
"#,
        "units = \"lj\"\nrun = { steps = 100, time_step = 0.002 }\nmixing = \"arithmetic\"",
        Some(&[1.0, 2.5, 0.4]),
    );
}

#[test]
fn a_sum_of_potentials_is_that_of_lammps() {
    compare_kinds(
        "overlay",
        r#"
[material.one]
set = "1"
law = { lennard_jones = { epsilon = 0.8, sigma = 1, cutoff = 2.5 } }
[material.two]
set = "2"
law = { morse = { depth = 0.9, alpha = 5, distance = 1.1, cutoff = 2.4 } }
[[pair]]
between = ["one", "one"]
law = { morse = { depth = 0.3, alpha = 4, distance = 1.1, cutoff = 2.0 } }
[[pair]]
between = ["one", "two"]
law = { buckingham = { strength = 400, range = 0.18, dispersion = 0.9, cutoff = 2.3 } }
"#,
        "units = \"lj\"\nrun = { steps = 100, time_step = 0.002 }",
        Some(&[1.0, 3.0]),
    );
}

const METAL: &str = "units = { system = \"metal\", constants = \"lammps\" }\nrun = { steps = 100, time_step = 0.002 }";

#[test]
fn alloys_are_those_of_lammps() {
    for (name, file) in [("alloy", "alloy.eam.alloy"), ("alloy_fs", "alloy.eam.fs")] {
        let material = |element| {
            format!(
                "material.{element}.law.eam = {{ file = \"{file}\", element = \"{element}\" }}\n"
            )
        };
        compare_kinds(name, &(material("Aa") + &material("Bb")), METAL, None);
    }
}

#[test]
fn two_metals_of_a_file_each_are_those_of_lammps() {
    let material = |element| format!("material.{element}.law.eam.file = \"{element}.eam\"\n");
    compare_kinds(
        "two_metals",
        &(material("Na") + &material("Mg")),
        METAL,
        None,
    );
}

/// A deck may be computed with the constants of LAMMPS, and says which it has.
#[test]
fn physical_constants_are_chosen_and_named() {
    let path = folder().join("deck.toml");
    let deck = |units: &str| {
        let text = format!(
            "units = {units}\nperiodic = [\"x\", \"y\", \"z\"]\nbody.file = \"copper.data\"\n\
             run = {{ steps = 1 }}\nmaterial.law = {{ eam = {{ file = \"copper.eam.alloy\" }} }}\n"
        );
        Deck::parse(&text, path.to_str().unwrap(), &[]).unwrap_or_else(|e| panic!("{e:?}"))
    };
    let lammps = deck("{ system = \"metal\", constants = \"lammps\" }");
    assert_eq!(lammps.units.plain_factor(Dim::MASS), LAMMPS_MASS);
    assert_eq!(lammps.boltzmann(), LAMMPS_BOLTZMANN);
    let bar = 1.0 / lammps.units.plain_factor(Dim::PRESSURE);
    assert!((bar / LAMMPS_BAR - 1.0).abs() < 1e-15);
    assert!(
        lammps
            .describe()
            .contains("physical constants: those of LAMMPS")
    );
    for newer in ["\"metal\"", "{ system = \"metal\" }"] {
        let newer = deck(newer);
        assert!(newer.describe().contains("CODATA 2018"));
        let mass = lammps.spec.materials[0].density / newer.spec.materials[0].density;
        assert!((mass - 1.0 + 6.4e-8).abs() < 1e-9, "{mass}");
        let kelvin = lammps.boltzmann() / newer.boltzmann();
        assert!(
            (kelvin - 1.0).abs() > 5e-7 && (kelvin - 1.0).abs() < 2e-6,
            "{kelvin}"
        );
    }
}
