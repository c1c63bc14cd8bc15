//! Atoms through the program: LAMMPS dumps and data files in and out, and what is left of a run that stops.

use peridyne_io::read::{Atoms, Frame, data::data, dump::dump, extxyz::extxyz};
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

fn good(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks/good")
        .join(name)
}

/// `peridyne run DECK --out OUT …`: exit code and messages.
fn run(deck: &Path, out: &Path, more: &[&str]) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("run")
        .arg(deck)
        .arg("--out")
        .arg(out)
        .args(more)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), text)
}

/// Largest difference of the coordinates, less whole periods.
fn apart(a: &Atoms, b: &[[f64; 3]], wrapped: bool) -> f64 {
    let mut worst = 0.0f64;
    for (x, y) in a.position.iter().zip(b) {
        for c in 0..3 {
            let period = a.high[c] - a.low[c];
            let d = x[c] - y[c];
            let whole = if wrapped {
                (d / period).round() * period
            } else {
                0.0
            };
            worst = worst.max((d - whole).abs());
        }
    }
    worst
}

/// The dump begins with atoms that have left their box; LAMMPS wrote its next frame 100 steps later.
#[test]
fn a_frame_of_a_lammps_dump_goes_on_as_lammps_did() {
    let dir = TempDir::new().unwrap();
    let (code, text) = run(&good("liquid_from_dump.toml"), dir.path(), &[]);
    assert_eq!(code, Some(0), "{text}");
    let file = good("liquid.lammpstrj");
    let before = dump(&file, Frame::Step(2000)).unwrap();
    let after = dump(&file, Frame::Step(2100)).unwrap();
    let trajectory = dir.path().join("liquid.extxyz");
    assert_eq!(
        extxyz(&trajectory, Frame::Step(0)).unwrap().position,
        before.position
    );
    let last = extxyz(&trajectory, Frame::Last).unwrap();
    assert_eq!((last.step, last.low), (Some(100), after.low));
    assert_eq!(last.periodic, [true; 3]);
    let moved = apart(&after, &before.position, false);
    assert!(moved > 0.5, "{moved}");
    let worst = apart(&after, &last.position, false);
    assert!(worst < 1e-9, "{worst}");
    let (v, w) = (after.velocity.unwrap(), last.velocity.clone().unwrap());
    for (v, w) in v.iter().flatten().zip(w.iter().flatten()) {
        assert!((v - w).abs() < 1e-8, "{v} {w}");
    }

    // the same state as a data file: in the box
    let path = dir.path().join("last.data");
    let file = data(&path).unwrap();
    assert_eq!(file.species[0].mass, Some(1.0));
    assert_eq!(file.velocity, last.velocity);
    assert!(apart(&last, &file.position, true) < 1e-14);
    for x in &file.position {
        assert!((0..3).all(|a| (file.low[a]..file.high[a]).contains(&x[a])));
    }

    // and 50 steps from there are those of a run that was not cut
    let deck = dir.path().join("more.toml");
    let text = std::fs::read_to_string(good("liquid_from_dump.toml")).unwrap();
    let text = text.replace(
        "body = { file = \"liquid.lammpstrj\", file_step = 2000 }",
        "body = { file = \"last.data\" }\nperiodic = [\"x\", \"y\", \"z\"]",
    );
    std::fs::write(&deck, text).unwrap();
    let more = dir.path().join("more");
    let (code, text) = run(&deck, &more, &["--set", "run.steps=50"]);
    assert_eq!(code, Some(0), "{text}");
    let straight = dir.path().join("straight");
    let (code, text) = run(
        &good("liquid_from_dump.toml"),
        &straight,
        &["--set", "run.steps=150"],
    );
    assert_eq!(code, Some(0), "{text}");
    let [more, straight] =
        [more, straight].map(|d| extxyz(&d.join("liquid.extxyz"), Frame::Last).unwrap());
    let worst = apart(&straight, &more.position, true);
    assert!(worst < 1e-9, "{worst}");
}

/// Kinds and masses of a mixture in all files, and a run that goes on from them.
#[test]
fn a_mixture_keeps_its_kinds_in_every_file() {
    let dir = TempDir::new().unwrap();
    let deck = good("mixture.toml");
    for (name, out) in [
        ("m.lammpstrj", dir.path().join("dumped")),
        ("m.extxyz", dir.path().join("written")),
    ] {
        let trajectory = format!("output.trajectory=\"{name}\"");
        let more = ["--set", "run.steps=4", "--set", &trajectory];
        let (code, text) = run(&deck, &out, &more);
        assert_eq!(code, Some(0), "{text}");
        for file in [name, "last.data"] {
            std::fs::copy(out.join(file), dir.path().join(file)).unwrap();
        }
    }
    let xyz = extxyz(&dir.path().join("m.extxyz"), Frame::Last).unwrap();
    let dumped = dump(&dir.path().join("m.lammpstrj"), Frame::Last).unwrap();
    let last = data(&dir.path().join("last.data")).unwrap();
    for file in [&xyz, &dumped, &last] {
        let heavy = (0..file.len()).filter(|i| file.name(*i) == "heavy").count();
        assert_eq!((file.len(), heavy), (500, 150));
        for species in &file.species {
            let mass = if species.name == "heavy" { 2.5 } else { 1.0 };
            assert_eq!(species.mass, Some(mass), "{}", species.name);
        }
        let names = |f: &Atoms| -> Vec<String> { (0..f.len()).map(|i| f.name(i).into()).collect() };
        assert_eq!(names(file), names(&xyz));
    }
    let text = std::fs::read_to_string(&deck).unwrap();
    let text = text
        .replace(
            "body = { lattice = \"fcc\", spacing = 1.63, cells = [5, 5, 5] }",
            "body = { file = \"FILE\" }",
        )
        .replace(
            "initial_velocities = { temperature = 1.2, seed = 87287 }\n",
            "",
        )
        .replace("[sets.heavy]\nrandom = { part = 0.3, seed = 5 }\n", "")
        .replace("mass = 2.5\n", "")
        .replace("mass = 1\n", "");
    let mut ends = vec![];
    for (n, file) in ["m.extxyz", "m.lammpstrj", "last.data"]
        .into_iter()
        .enumerate()
    {
        let deck = dir.path().join("more.toml");
        std::fs::write(&deck, text.replace("FILE", file)).unwrap();
        let out = dir.path().join(format!("more{n}"));
        let (code, text) = run(&deck, &out, &["--set", "run.steps=5"]);
        assert_eq!(code, Some(0), "{file}: {text}");
        ends.push(extxyz(&out.join("mixture.extxyz"), Frame::Last).unwrap());
    }
    for end in &ends[1..] {
        assert!(apart(&ends[0], &end.position, true) < 1e-12);
    }
}

/// A table in metal units: the mass comes back as it was read, and a chain's box has lengths along all axes.
#[test]
fn data_files_have_the_units_of_the_deck() {
    let dir = TempDir::new().unwrap();
    let table = good("copper.eam.alloy").canonicalize().unwrap();
    let copper = format!(
        "units = \"metal\"\nperiodic = [\"x\", \"y\", \"z\"]\n\
         body = {{ lattice = \"fcc\", spacing = 3.615, origin = [1, 2, 3], cells = [4, 4, 4] }}\n\
         material.law = {{ eam = {{ file = {table:?} }} }}\n\
         run = {{ steps = 2, time_step = 0.001 }}\noutput = {{ data = \"last.data\", vtu = false }}\n"
    );
    let chain = "units = \"lj\"\nbody = { lattice = \"chain\", spacing = 1.1, cells = [10] }\n\
         material = { mass = 2, law = { lennard_jones = { epsilon = 1, sigma = 1, cutoff = 2.5 } } }\n\
         run = { steps = 2, time_step = 0.001 }\noutput = { data = \"last.data\", vtu = false }\n";
    for (text, mass, name, length) in [
        (copper.as_str(), 63.546, "Cu", 4.0 * 3.615),
        (chain, 2.0, "X", 1.0),
    ] {
        let deck = dir.path().join("deck.toml");
        std::fs::write(&deck, text).unwrap();
        let (code, text) = run(&deck, dir.path(), &[]);
        assert_eq!(code, Some(0), "{text}");
        let file = data(&dir.path().join("last.data")).unwrap();
        assert_eq!(file.species[0].mass, Some(mass));
        assert_eq!(file.name(0), name);
        assert!((file.high[2] - file.low[2] - length).abs() < 1e-12);
    }
}

#[test]
fn a_run_that_stops_keeps_the_last_good_frame() {
    let dir = TempDir::new().unwrap();
    let deck = dir.path().join("deck.toml");
    let text = "units = \"lj\"\nfamily = \"stencil\"\nhorizon = { m_ratio = 1 }\n\
        body = { lattice = \"chain\", spacing = 1.1, cells = [10] }\n\
        material = { mass = 1, law = { lennard_jones = { epsilon = 1, sigma = 1 } } }\n\
        initial = [{ velocity = [\"-100*(x-5)\"] }]\n\
        run = { steps = 50, time_step = 0.001 }\n\
        output = { trajectory = \"t.xyz\", data = \"last.data\", vtu = false }\n";
    std::fs::write(&deck, text).unwrap();
    let (code, text) = run(&deck, dir.path(), &[]);
    assert_eq!(code, Some(1), "{text}");
    let last = extxyz(&dir.path().join("t.xyz"), Frame::Last).unwrap();
    let step = last.step.unwrap();
    assert!(step > 0 && step < 50, "{step}");
    assert!(text.contains(&format!("step {step}")), "{text}");
    assert!(data(&dir.path().join("last.data")).is_ok());

    // a frame of it begins another run, whatever its ending is
    let text = std::fs::read_to_string(&deck).unwrap();
    let text = text
        .replace(
            "family = \"stencil\"\nhorizon = { m_ratio = 1 }\n",
            "dimension = 1\n",
        )
        .replace(
            "body = { lattice = \"chain\", spacing = 1.1, cells = [10] }",
            "body = { file = \"t.xyz\", file_step = 0 }",
        )
        .replace("sigma = 1 }", "sigma = 1, cutoff = 2.5 }")
        .replace("steps = 50", "steps = 1")
        .replace("trajectory = \"t.xyz\"", "trajectory = \"again.xyz\"");
    std::fs::write(&deck, text).unwrap();
    let (code, text) = run(&deck, dir.path(), &[]);
    assert_eq!(code, Some(0), "{text}");
    let again = extxyz(&dir.path().join("again.xyz"), Frame::Step(0)).unwrap();
    assert!((again.position[9][0] - 9.9).abs() < 1e-12);
}

/// `output.dump` has the name, the box, the velocities and the forces, and is the system itself: it goes on from there.
#[test]
fn a_dump_of_atoms_is_the_system() {
    let dir = TempDir::new().unwrap();
    let table = good("copper.eam.alloy").canonicalize().unwrap();
    let copper = format!(
        "units = \"metal\"\nperiodic = [\"x\", \"y\", \"z\"]\n\
         body = {{ lattice = \"fcc\", spacing = 3.615, origin = [1, 2, 3], cells = [4, 4, 4] }}\n\
         material.law = {{ eam = {{ file = {table:?} }} }}\ninitial_velocities = {{ temperature = 300, seed = 4 }}\n\
         run = {{ steps = 20, time_step = 0.002 }}\n\
         output = {{ dump = \"given.dump\", trajectory = \"t.extxyz\", vtu = false, history = 20 }}\n"
    );
    let deck = dir.path().join("deck.toml");
    std::fs::write(&deck, &copper).unwrap();
    let first = dir.path().join("first");
    let (code, text) = run(&deck, &first, &[]);
    assert_eq!(code, Some(0), "{text}");
    let path = first.join("given.dump");
    let text = std::fs::read_to_string(&path).unwrap();
    let heads: Vec<&str> = text.lines().filter(|l| l.starts_with("ITEM: ")).collect();
    assert_eq!(heads.len(), 2 * 5, "{heads:?}");
    assert!(heads.contains(&"ITEM: BOX BOUNDS pp pp pp"));
    assert!(heads.contains(&"ITEM: ATOMS id type x y z vx vy vz fx fy fz c_pe"));
    let (dumped, framed) = (
        dump(&path, Frame::Last).unwrap(),
        extxyz(&first.join("t.extxyz"), Frame::Last).unwrap(),
    );
    assert_eq!(dumped.low, [1.0, 2.0, 3.0]);
    assert!((0..3).all(|a| (dumped.high[a] - dumped.low[a] - 14.46).abs() < 1e-12));
    assert_eq!(
        (
            &dumped.position,
            &dumped.velocity,
            &dumped.force,
            dumped.periodic
        ),
        (
            &framed.position,
            &framed.velocity,
            &framed.force,
            framed.periodic
        )
    );
    assert_eq!(framed.species[0].mass, Some(63.546));

    // momenta are in ASE's units, Å/10.18 fs and g/mol
    let text = std::fs::read_to_string(first.join("t.extxyz")).unwrap();
    assert!(text.contains("species:S:1:pos:R:3:masses:R:1:velo:R:3:momenta:R:3:forces:R:3"));
    let row: Vec<f64> = text
        .lines()
        .nth(2)
        .unwrap()
        .split_whitespace()
        .skip(1)
        .map(|w| w.parse().unwrap())
        .collect();
    // ase.units.fs, per fs and not per ps
    let wanted = row[4] * 63.546 * 1e-3 / 0.098_226_947_884_640_63;
    assert!(
        (row[7] - wanted).abs() < 1e-7 * wanted.abs(),
        "{} {wanted}",
        row[7]
    );

    // what is read goes on with the same energies, from the dump and from momenta alone
    let bare = text.replace(":velo:R:3", ":old:R:3");
    std::fs::write(dir.path().join("bare.extxyz"), bare).unwrap();
    let energies = |folder: &Path, row: usize| -> Vec<f64> {
        let table = std::fs::read_to_string(folder.join("history.csv")).unwrap();
        let row = table.lines().nth(row).unwrap();
        row.split(',')
            .skip(2)
            .take(2)
            .map(|c| c.parse().unwrap())
            .collect()
    };
    let last = energies(&first, 2);
    for (n, (file, near)) in [("first/given.dump", 1e-12), ("bare.extxyz", 1e-8)]
        .iter()
        .enumerate()
    {
        let again = copper
            .replace(
                "lattice = \"fcc\", spacing = 3.615, origin = [1, 2, 3], cells = [4, 4, 4]",
                &format!("file = \"{file}\""),
            )
            .replace("periodic = [\"x\", \"y\", \"z\"]\n", "")
            .replace("initial_velocities = { temperature = 300, seed = 4 }\n", "");
        std::fs::write(&deck, again).unwrap();
        let out = dir.path().join(format!("again{n}"));
        let (code, text) = run(&deck, &out, &["--set", "run.steps=1"]);
        assert_eq!(code, Some(0), "{text}");
        for (a, b) in energies(&out, 1).iter().zip(&last) {
            assert!((a - b).abs() < near * b.abs(), "{file}: {a} {b}");
        }
    }
}
