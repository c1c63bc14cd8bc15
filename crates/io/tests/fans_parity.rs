//! Silicon, silicon carbide, hexane and isobutane of `verify/lammps/many_body`, from LAMMPS's data files, against the numbers that LAMMPS computed for them.

mod golden;

use peridyne::law::many_body::tersoff::{COLUMNS, Tersoff};
use peridyne::run::{Options, build};
use peridyne::spec::{BodySpec, LawSpec, Members, PotentialSpec, SetSpec};
use peridyne_io::deck::{Deck, Dim};
use peridyne_io::read::entries;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../verify/lammps/fans")
}

fn deck(data: &str, law: &str) -> Deck {
    let text = format!(
        "units = {{ system = \"metal\", constants = \"lammps\" }}\nrun = {{ steps = 100, time_step = 0.001 }}\n\
         periodic = [\"x\", \"y\", \"z\"]\nbody.file = \"{data}\"\nmaterial.law = {law}\n"
    );
    parsed(&text)
}

fn parsed(text: &str) -> Deck {
    let file = folder().join("deck.toml");
    Deck::parse(text, file.to_str().unwrap(), &[]).unwrap_or_else(|e| panic!("{e:?}"))
}

fn compare(name: &str, law: &str) {
    compare_deck(name, &deck(&format!("{name}.data"), law));
}

fn compare_deck(name: &str, deck: &Deck) {
    let mut sim = build(&deck.spec, Options::default()).unwrap();
    let bar = 1.0 / deck.units.plain_factor(Dim::PRESSURE);
    let golden = golden::read(&folder().join(format!("{name}.golden")));
    golden::compare(sim.as_mut(), &golden, bar);
}

#[test]
fn silicon_of_stillinger_and_weber_is_that_of_lammps() {
    compare("sw_silicon", "{ stillinger_weber = { file = \"Si.sw\" } }");
}

/// With λ₃, and constants as keys.
#[test]
fn silicon_of_tersoff_is_that_of_lammps() {
    compare("tersoff_silicon", "{ tersoff = { file = \"Si.tersoff\" } }");
    compare(
        "tersoff_silicon",
        "{ tersoff = { m = 3, gamma = 1, lambda3 = 1.3258, c = 4.8381, d = 2.0417, cos_theta0 = 0, n = 22.956, beta = 0.33675, \
         lambda2 = 1.3258, B = 95.373, R = 3.0, D = 0.2, lambda1 = 3.2394, A = 3264.7 } }",
    );
}

/// Bonds, angles and dihedrals beside a pair potential that leaves out pairs.
#[test]
fn hexane_is_that_of_lammps() {
    let kcal = 0.0433641153;
    let text = format!(
        "units = {{ system = \"metal\", constants = \"lammps\" }}\nrun = {{ steps = 100, time_step = 0.0005 }}\n\
         periodic = [\"x\", \"y\", \"z\"]\nbody.file = \"hexane.data\"\nmolecules = {{ special = [0, 0, 0.5] }}\n\
         material.law = {{ lennard_jones = {{ epsilon = {:?}, sigma = 3.905, cutoff = 9 }} }}\n",
        0.118 * kcal
    );
    compare_deck("hexane", &parsed(&text));
}

/// Impropers, and `atom_style full` whose charges are 0.
#[test]
fn isobutane_is_that_of_lammps() {
    let kcal = 0.0433641153;
    let text = format!(
        "units = {{ system = \"metal\", constants = \"lammps\" }}\nrun = {{ steps = 100, time_step = 0.0005 }}\n\
         periodic = [\"x\", \"y\", \"z\"]\nbody.file = \"isobutane.data\"\nmolecules = {{ special = [0, 0, 0] }}\n\
         material.law = {{ lennard_jones = {{ epsilon = {:?}, sigma = 3.91, cutoff = 9 }} }}\n",
        0.16 * kcal
    );
    compare_deck("isobutane", &parsed(&text));
}

/// Two kinds of atom, each a material of the deck.
#[test]
fn silicon_carbide_of_a_deck_is_that_of_lammps() {
    let text = r#"
units = { system = "metal", constants = "lammps" }
run = { steps = 100, time_step = 0.001 }
periodic = ["x", "y", "z"]
body.file = "tersoff_carbide.data"
material.Si = { set = "1", law = { tersoff = { file = "SiC.tersoff", element = "Si" } } }
material.C = { set = "2", law = { tersoff = { file = "SiC.tersoff", element = "C" } } }
"#;
    compare_deck("tersoff_carbide", &parsed(text));
}

/// Two kinds of atom.
#[test]
fn silicon_carbide_of_tersoff_is_that_of_lammps() {
    let mut made = deck(
        "tersoff_silicon.data",
        "{ tersoff = { file = \"Si.tersoff\" } }",
    );
    let data = std::fs::read_to_string(folder().join("tersoff_carbide.data")).unwrap();
    let after = |head: &str| {
        let rows = data.split(head).nth(1).unwrap().trim_start().lines();
        let rows = rows.take_while(|l| !l.is_empty());
        let numbers = |l: &str| l.split_whitespace().map(|w| w.parse().unwrap()).collect();
        rows.map(numbers).collect::<Vec<Vec<f64>>>()
    };
    let (atoms, velocities) = (after("Atoms # atomic\n\n"), after("Velocities\n\n"));
    let (length, unit) = (3.0 * 4.32, made.units.plain_factor(Dim::MASS));
    made.spec.space.periodic = [Some(length); 3];
    let BodySpec::Cloud(cloud) = &mut made.spec.body else {
        panic!("atoms of a file are a cloud");
    };
    assert_eq!(cloud.position.len(), atoms.len());
    let volume = length.powi(3) / atoms.len() as f64;
    for (n, (x, v)) in atoms.iter().zip(&velocities).enumerate() {
        cloud.position[n] = [x[2], x[3], x[4]];
        cloud.velocity[n] = [v[1], v[2], v[3]];
        cloud.volume[n] = volume;
    }
    cloud.mark = atoms.iter().map(|a| a[1] as i32).collect();
    let names: Vec<&str> = COLUMNS.iter().map(|c| c.name).collect();
    let all = entries::entries(&folder().join("SiC.tersoff"), &names).unwrap();
    let rows = entries::rows(&all, &["Si", "C"]);
    let law = LawSpec::Atoms(PotentialSpec::of_entries::<Tersoff>(rows).unwrap());
    let first = made.spec.materials[0].clone();
    made.spec.materials.clear();
    for (mark, name, mass) in [(1, "silicon", 28.0855), (2, "carbon", 12.011)] {
        made.spec.sets.push(SetSpec {
            name: name.into(),
            members: Members::Mark(mark),
        });
        let mut material = first.clone();
        material.name = name.into();
        material.set = name.into();
        material.density = mass * unit / volume;
        material.law = law.clone();
        made.spec.materials.push(material);
    }
    let mut sim = build(&made.spec, Options::default()).unwrap();
    let bar = 1.0 / made.units.plain_factor(Dim::PRESSURE);
    let golden = golden::read(&folder().join("tersoff_carbide.golden"));
    golden::compare(sim.as_mut(), &golden, bar);
}
