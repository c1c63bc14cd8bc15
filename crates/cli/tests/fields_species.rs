//! `peridyne fields` on frames of several kinds of atoms, against what LAMMPS computed for them, and what it says where kinds do not fit.

use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../verify/lammps")
}

fn fields(arguments: &[String]) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("fields")
        .args(arguments)
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr).replace("\n  │ ", " ");
    let error = error.split_whitespace().collect::<Vec<_>>().join(" ");
    (output.status.code(), error)
}

fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_string).collect()
}

/// Rows of numbers between lines of `#`.
fn golden(path: &Path) -> Vec<Vec<Vec<f64>>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut parts: Vec<Vec<Vec<f64>>> = vec![];
    for line in text.lines() {
        match line.starts_with('#') {
            true => parts.push(vec![]),
            false => {
                let row = line.split_whitespace().map(|w| w.parse().unwrap());
                parts.last_mut().unwrap().push(row.collect());
            }
        }
    }
    parts
}

/// Rows of a section of a data file.
fn section(text: &str, head: &str) -> Vec<Vec<f64>> {
    let rows = text
        .split(head)
        .nth(1)
        .unwrap()
        .trim_start_matches(|c| c != '\n')
        .trim_start();
    let rows = rows.lines().take_while(|l| !l.is_empty());
    let number = |w: &str| w.parse().unwrap();
    rows.map(|l| {
        l.split('#')
            .next()
            .unwrap()
            .split_whitespace()
            .map(number)
            .collect()
    })
    .collect()
}

/// LAMMPS's virial over the volume (its unit of pressure), xx yy zz xy xz yz: the pressure less what moves.
fn virial(name: &str, energy_unit: f64, pressure_unit: f64) -> [f64; 6] {
    let text = std::fs::read_to_string(folder().join(format!("{name}.data"))).unwrap();
    let golden = golden(&folder().join(format!("{name}.golden")));
    let (mass, atoms) = (section(&text, "Masses"), section(&text, "Atoms #"));
    // id [molecule] type
    let place = if text.contains("Atoms # molecular") {
        2
    } else {
        1
    };
    let kind: std::collections::HashMap<u64, usize> = { atoms.iter() }
        .map(|a| (a[0] as u64, a[place] as usize))
        .collect();
    let edges = text.lines().filter(|l| l.ends_with("hi")).map(|l| {
        let ends: Vec<f64> = l
            .split_whitespace()
            .take(2)
            .map(|w| w.parse().unwrap())
            .collect();
        ends[1] - ends[0]
    });
    let volume: f64 = edges.product();
    let mut all: [f64; 6] = std::array::from_fn(|k| golden[0][0][1 + k] / pressure_unit);
    for row in section(&text, "Velocities") {
        let m = mass[kind[&(row[0] as u64)] - 1][1] * energy_unit;
        for (k, (a, b)) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
            .into_iter()
            .enumerate()
        {
            all[k] -= m * row[1 + a] * row[1 + b] / volume;
        }
    }
    all
}

/// LAMMPS's 1 g/mol in eV ps²/Å², and 1 eV/Å³ in bar.
const METAL: [f64; 2] = [1.0364269e-4, 1.6021765e6];

/// Energy to 1e-10 per atom, virial to 1e-9 (as in the engine's parity tests: the constants of pressure have so many digits), forces to
/// 1e-9; and cells that fill the box have the virial as their mean stress.
fn compare(name: &str, potential: &str, cell: Option<(f64, usize)>, [mass, bar]: [f64; 2]) {
    let dir = TempDir::new().unwrap();
    let data = folder().join(format!("{name}.data"));
    let out = dir.path().join("out");
    let mut arguments = words(potential);
    let kernel = match cell {
        Some((edge, n)) => format!(
            "--kernel cell --width {:?} --grid {n},{n},{n}",
            edge / n as f64
        ),
        None => "--kernel polynomial --width 5 --grid 2,2,2".into(),
    };
    arguments.extend(words(&kernel));
    let place = |p: &Path| p.to_string_lossy().into_owned();
    arguments.extend(["--frames".into(), place(&data), "--out".into(), place(&out)]);
    let (code, error) = fields(&arguments);
    assert_eq!(code, Some(0), "{name}: {error}");
    let text = std::fs::read_to_string(out.join("fields.json")).unwrap();
    let about: serde_json::Value = serde_json::from_str(&text).unwrap();
    let frame = &about["each_frame"][0];
    let golden = golden(&folder().join(format!("{name}.golden")));
    let energy = frame["potential_energy"].as_f64().unwrap();
    let atoms = frame["atoms"].as_f64().unwrap();
    assert!(
        ((energy - golden[0][0][0]) / atoms).abs() < 1e-10,
        "{name}: energy {energy} is not {}",
        golden[0][0][0]
    );
    let exact = virial(name, mass, bar);
    let size = exact.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for (k, n) in [0, 4, 8, 1, 2, 5].into_iter().enumerate() {
        let stress = frame["virial_stress"][n].as_f64().unwrap();
        assert!(
            (stress + exact[k]).abs() < 1e-9 * size,
            "{name}: {stress} is not {}",
            -exact[k]
        );
    }
    if cell.is_some() {
        let off = frame["mean_stress_against_virial"].as_f64().unwrap();
        assert!(off < 1e-10, "{name}: {off}");
    }
}

fn metal(name: &str, potential: &str, edge: f64) {
    let folder = folder();
    let potential = potential.replace("HERE", &folder.to_string_lossy());
    let whole = format!("--units metal {potential}");
    compare(name, &whole, Some((edge, 3)), METAL);
}

#[test]
fn alloys_are_those_of_lammps() {
    let of = "--potential setfl --element Aa,Bb --file HERE/atoms";
    metal("atoms/alloy", &format!("{of}/alloy.eam.alloy"), 11.7);
    metal("atoms/alloy_fs", &format!("{of}/alloy.eam.fs"), 11.7);
    // an element for each file
    let of = "--potential funcfl --file HERE/atoms/Na.eam --file HERE/atoms/Mg.eam";
    metal("atoms/two_metals", of, 11.7);
}

#[test]
fn silicon_and_its_carbide_are_those_of_lammps() {
    let of = "--potential tersoff --element Si,C --file HERE/fans/SiC.tersoff";
    metal("fans/tersoff_carbide", of, 12.96);
    let of = "--potential stillinger_weber --file HERE/fans/Si.sw";
    metal("fans/sw_silicon", of, 16.293);
}

/// Pairs of a mixture stand in a deck, which needs no body.
const MIXTURE: &str = r#"
units = "lj"
mixing = "arithmetic"
[material.a]
law = { lennard_jones = { epsilon = 1, sigma = 1, cutoff = 2.5 } }
[material.b]
law = { lennard_jones = { epsilon = 0.5, sigma = 0.88, cutoff = 2.2 } }
[material.c]
mass = 0.4
law = { lennard_jones = { epsilon = 0.7, sigma = 0.94, cutoff = 2.3 } }
[[pair]]
between = ["c", "a"]
law = { lennard_jones = { epsilon = 1.3, sigma = 0.9, cutoff = 2.1 } }
"#;

#[test]
fn a_mixture_of_a_deck_is_that_of_lammps() {
    let dir = TempDir::new().unwrap();
    let deck = dir.path().join("mixture.toml");
    std::fs::write(&deck, MIXTURE).unwrap();
    let model = format!("--model {}", deck.display());
    compare(
        "atoms/lj_mixture",
        &model,
        Some((6.459101660542804, 2)),
        [1.0; 2],
    );
}

/// Bonds, angles and dihedrals beside pairs that are left out in part: by flags, and by the deck of a run.
#[test]
fn hexane_is_that_of_lammps() {
    let epsilon = 0.118 * 0.0433641153;
    let data = folder().join("fans/hexane.data");
    let flags = format!(
        "--units metal --potential lj --with epsilon={epsilon:?} --with sigma=3.905 --with cutoff=9 --molecules {} --special 0,0,0.5",
        data.display()
    );
    compare("fans/hexane", &flags, None, METAL);
    let dir = TempDir::new().unwrap();
    let deck = dir.path().join("hexane.toml");
    let text = format!(
        "units = \"metal\"\nrun = {{ steps = 1, time_step = 0.0005 }}\nperiodic = [\"x\", \"y\", \"z\"]\nbody.file = {data:?}\n\
         molecules = {{ special = [0, 0, 0.5] }}\n\
         material.law = {{ lennard_jones = {{ epsilon = {epsilon:?}, sigma = 3.905, cutoff = 9 }} }}\n"
    );
    std::fs::write(&deck, text).unwrap();
    compare(
        "fans/hexane",
        &format!("--model {}", deck.display()),
        None,
        METAL,
    );
}

/// The trajectory of a deck's run and the deck.
#[test]
fn the_deck_of_a_run_knows_its_frames() {
    let dir = TempDir::new().unwrap();
    let decks = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    for name in ["alloy.toml", "alloy.eam.alloy"] {
        std::fs::copy(decks.join(name), dir.path().join(name)).unwrap();
    }
    let run = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(["run", "alloy.toml", "--out", "run"])
        .current_dir(dir.path())
        .output()
        .unwrap();
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    let at = |name: &str| dir.path().join(name).display().to_string();
    let out = at("fields");
    let arguments = format!(
        "--model {} --frames {} --kernel polynomial --width 5 --grid 2,2,3 --out {out}",
        at("alloy.toml"),
        at("run/alloy.extxyz")
    );
    let (code, error) = fields(&words(&arguments));
    assert_eq!(code, Some(0), "{error}");
    let text = std::fs::read_to_string(dir.path().join("fields/fields.json")).unwrap();
    let about: serde_json::Value = serde_json::from_str(&text).unwrap();
    // the trajectory has the forces of the engine
    for frame in about["each_frame"].as_array().unwrap() {
        assert!(
            frame["forces_against_file"].as_f64().unwrap() < 1e-6,
            "{frame}"
        );
    }
    assert!(
        about["residuals"]["energy_extrapolated"].as_f64().unwrap() < 1e-3,
        "{about}"
    );
}

#[test]
fn kinds_that_do_not_fit_are_named() {
    let dir = TempDir::new().unwrap();
    let at = |name: &str, text: &str| {
        let path = dir.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let frame = |names: [&str; 2]| {
        let head = "2\nLattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3\n";
        format!("{head}{} 0 0 0\n{} 2 2 2\n", names[0], names[1])
    };
    let (alloy, iron) = (
        at("alloy.xyz", &frame(["Aa", "Bb"])),
        at("iron.xyz", &frame(["Aa", "Fe"])),
    );
    let third = at("third.xyz", &frame(["1", "3"]));
    let unsaid = at(
        "unsaid.toml",
        &MIXTURE.replace("mixing = \"arithmetic\"\n", ""),
    );
    let wrong = at(
        "wrong.toml",
        &MIXTURE.replace("sigma = 0.88", "sigmo = 0.88"),
    );
    let solid = at(
        "solid.toml",
        "horizon = { m_ratio = 3 }\n[material]\ndensity = 1\nlaw = { pmb = { young = 1 } }\n",
    );
    let mixture = at("mixture.toml", MIXTURE);
    let table = folder().join("atoms/alloy.eam.alloy").display().to_string();
    let carbide = folder().join("fans/SiC.tersoff").display().to_string();
    let metal = format!("--units metal --potential setfl --file {table}");
    let cases = [
        (
            format!("{metal} --element Aa,Bb --frames {iron}"),
            "the frame has Fe, which setfl does not know: it is of Aa, Bb",
        ),
        (
            format!("{metal} --element Aa,Bb --frames {third}"),
            "atoms of type 3, which setfl does not know: its kinds are Aa, Bb",
        ),
        (
            format!("{metal} --element Aa --frames {alloy}"),
            "--element A,B",
        ),
        (
            format!("{metal} --element Aa,Cc --frames {alloy}"),
            "no element `Cc`",
        ),
        (
            format!("{metal} --frames {alloy}"),
            "has several elements: Aa, Bb",
        ),
        (
            format!("{metal} --file {table} --file {table} --element Aa,Bb --frames {alloy}"),
            "3 files and 2 elements",
        ),
        (
            format!(
                "--units metal --potential tersoff --file {carbide} --element Si,Ge --frames {alloy}"
            ),
            "no element `Ge`",
        ),
        (
            format!(
                "--units lj --potential lj --with epsilon=1 --with sigma=1 --with cutoff=2 --element A,B --frames {alloy}"
            ),
            "2 elements need a file",
        ),
        (
            format!("--model {unsaid} --frames {alloy}"),
            "no potential is given between atoms of",
        ),
        (format!("--model {wrong} --frames {alloy}"), "sigmo"),
        (
            format!("--model {solid} --frames {alloy}"),
            "its materials are no atoms",
        ),
        (
            format!("--model {mixture} --frames {alloy}"),
            "the frame has Aa",
        ),
        (
            format!("--model {mixture} --units metal --frames {alloy}"),
            "is in lj",
        ),
        (
            format!("--model nowhere.toml --frames {alloy}"),
            "nowhere.toml: cannot read it",
        ),
    ];
    for (arguments, part) in cases {
        let out = dir.path().join("out").display().to_string();
        let rest = format!("--kernel gaussian --width 1 --grid 2,2,2 --out {out}");
        let (code, error) = fields(&words(&format!("{arguments} {rest}")));
        assert_eq!(code, Some(2), "{arguments}: {error}");
        assert!(error.contains(part), "{part}: {error}");
        assert!(!dir.path().join("out").exists(), "{part}");
    }
}

/// A file of two isotopes of argon, which are one species: `--mass` overrides the masses of the file.
const ISOTOPES: &str = "4\nLattice=\"30 0 0 0 30 0 0 0 30\" Properties=species:S:1:pos:R:3:velo:R:3:masses:R:1 pbc=\"F F F\"\n\
Ar 10 10 10 1 0 0 36\nAr 14 10 10 -1 2 0 40\nAr 10 14 10 0 -1 3 38\nAr 10 10 14 2 0 -1 40\n";

/// Columns of `points.csv` by their names, the first point.
fn at_first(out: &Path, names: &[&str]) -> Vec<f64> {
    let text = std::fs::read_to_string(out.join("points.csv")).unwrap();
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row: Vec<&str> = lines.next().unwrap().split(',').collect();
    let of = |n: &&str| head.iter().position(|h| h == n).unwrap();
    names.iter().map(|n| row[of(n)].parse().unwrap()).collect()
}

#[test]
fn every_atom_has_its_own_mass() {
    let dir = TempDir::new().unwrap();
    let at = |name: &str, text: &str| {
        let path = dir.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let points = at("points.txt", "11 11 11\n");
    let dump = "ITEM: UNITS\nmetal\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4\nITEM: BOX BOUNDS ff ff ff\n0 30\n0 30\n0 30\n\
ITEM: ATOMS id type mass x y z vx vy vz\n4 1 40 10 10 14 2 0 -1\n1 1 36 10 10 10 1 0 0\n3 1 38 10 14 10 0 -1 3\n2 1 40 14 10 10 -1 2 0\n";
    let columns = ["rho", "px", "py", "pz", "T", "qK_x"];
    let measured = |frames: &str, more: &str| {
        let out = dir.path().join("out");
        let all = format!(
            "--frames {frames} --potential lj --with epsilon=0.01 --with sigma=3.4 --with cutoff=8 --units metal --kernel step --width 9 \
             --points {points} --residuals 0 --out {} {more}",
            out.display()
        );
        let (code, error) = fields(&words(&all));
        assert_eq!(code, Some(0), "{error}");
        at_first(&out, &columns)
    };
    let xyz = at("isotopes.xyz", ISOTOPES);
    let found = measured(&xyz, "");
    // all four are within the step: sums over its volume
    let volume = 4.0 / 3.0 * std::f64::consts::PI * 729.0;
    let sums = [154.0, 36.0 - 40.0 + 80.0, 80.0 - 38.0, 114.0 - 40.0];
    for (a, b) in found.iter().zip(sums) {
        assert!((a * volume - b).abs() < 1e-9 * 154.0, "{found:?}");
    }
    let dumped = measured(&at("isotopes.dump", dump), "");
    for (a, b) in found.iter().zip(&dumped) {
        assert!((a - b).abs() <= 1e-9 * b.abs(), "{found:?} {dumped:?}");
    }
    // what is said of the species is said of all its atoms
    let alike = measured(&xyz, "--mass Ar=39");
    assert!((alike[0] * volume - 156.0).abs() < 1e-9, "{alike:?}");
}

#[test]
fn what_says_nothing_of_these_frames_is_refused() {
    let dir = TempDir::new().unwrap();
    let at = |name: &str, text: &str| {
        let path = dir.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let xyz = at("isotopes.xyz", ISOTOPES);
    let bare = at(
        "bare.xyz",
        &ISOTOPES
            .replace(":masses:R:1", "")
            .replace(" 36\n", "\n")
            .replace(" 40\n", "\n")
            .replace(" 38\n", "\n"),
    );
    let real = at(
        "real.dump",
        "ITEM: UNITS\nreal\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 9\n0 9\n0 9\nITEM: ATOMS id type x y z\n1 1 1 1 1\n",
    );
    let data = at(
        "real.data",
        "LAMMPS data file via write_data, version 22 Jul 2025, timestep = 0, units = real\n\n1 atoms\n1 atom types\n\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\nMasses\n\n1 40\n\nAtoms # atomic\n\n1 1 1 1 1\n",
    );
    let mixture = at("mixture.toml", MIXTURE);
    let lj = "--potential lj --with epsilon=0.01 --with sigma=3.4 --with cutoff=8";
    for (arguments, part) in [
        (
            format!("{lj} --units metal --mass Xe=131 --frames {xyz}"),
            "there is no Xe; the frame has Ar",
        ),
        (
            format!("{lj} --units none --frames {bare}"),
            "Ar has no mass",
        ),
        (
            format!("{lj} --units metal --frames {real} --mass 1=4"),
            "says that it is in real units",
        ),
        (
            format!("{lj} --units metal --frames {data}"),
            "says that it is in real units",
        ),
        (
            format!("--model {mixture} --with cutoff=3 --frames {xyz}"),
            "--with",
        ),
        (
            format!("--model {mixture} --element Ar --frames {xyz}"),
            "--element",
        ),
        (
            format!("{lj} --units metal --special 0,0,1 --frames {xyz}"),
            "--molecules",
        ),
    ] {
        let out = dir.path().join("out").display().to_string();
        let all = format!("{arguments} --kernel gaussian --width 1 --grid 2,2,2 --out {out}");
        let (code, error) = fields(&words(&all));
        assert_eq!(code, Some(2), "{arguments}: {error}");
        assert!(error.contains(part), "{arguments}: {error}");
    }
    // reduced by the mass of an atom, which is said
    let out = dir.path().join("lj").display().to_string();
    let all = format!(
        "{lj} --units lj --frames {bare} --kernel gaussian --width 1 --grid 2,2,2 --out {out}"
    );
    let (code, error) = fields(&words(&all));
    assert!(
        code == Some(0) && error.contains("the mass of Ar: it is taken as 1"),
        "{error}"
    );
}

const CARBON: &str = "3\nProperties=species:S:1:pos:R:3:velo:R:3 pbc=\"F F F\"\nC 0 0 0 0 0 0\nC 1.5 0 0 0 0 0\nC 4.0 0 0 0 0 0\n";

/// An element may stand twice, and types that are one element are one: fields by types are those by names.
#[test]
fn an_element_may_stand_twice() {
    let dir = TempDir::new().unwrap();
    let at = |name: &str, text: &str| {
        let path = dir.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let head = "4\nProperties=species:S:1:pos:R:3 pbc=\"F F F\"\n";
    let places = ["0 0 0", "1.8 0 0", "0.2 2.3 0", "1.9 1.5 0.3"];
    let frame = |names: [&str; 4]| {
        let rows: Vec<String> = { names.iter().zip(places) }
            .map(|(n, x)| format!("{n} {x}\n"))
            .collect();
        head.to_string() + &rows.concat()
    };
    let points = at("points.txt", "0.5 0.5 0.1\n");
    let folder = folder();
    let carbide = folder.join("fans/SiC.tersoff").display().to_string();
    let out = dir.path().join("out");
    let stress = |frames: &str, elements: &str| {
        let all = format!(
            "--frames {frames} --potential tersoff --file {carbide} --element {elements} --units metal --kernel gaussian --width 1 \
             --points {points} --residuals 0 --out {}",
            out.display()
        );
        let (code, error) = fields(&words(&all));
        assert_eq!(code, Some(0), "{error}");
        at_first(&out, &["e_pot", "sU_xx", "sU_xy", "sU_zz"])
    };
    let named = stress(&at("named.xyz", &frame(["Si", "C", "Si", "C"])), "C,Si");
    let typed = stress(&at("typed.xyz", &frame(["2", "1", "2", "3"])), "C,Si,C");
    let other = stress(&at("other.xyz", &frame(["1", "3", "2", "3"])), "Si,Si,C");
    assert!(named[0].abs() > 1e-3);
    for (a, b) in named.iter().zip(&typed).chain(named.iter().zip(&other)) {
        assert!(
            (a - b).abs() <= 1e-12 * a.abs(),
            "{named:?} {typed:?} {other:?}"
        );
    }
    // one element, several times
    let carbon = at("carbon.xyz", CARBON);
    assert_eq!(stress(&carbon, "C"), stress(&carbon, "C,C"));
}

/// A bond that nobody else weakens is one of two atoms, whatever other elements of the file reach: parts of its energy are for these two,
/// and fields are the same with and without the other elements.
#[test]
fn parts_are_of_those_that_a_bond_depends_on() {
    let dir = TempDir::new().unwrap();
    let at = |name: &str, text: &str| {
        let path = dir.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let frames = at("carbon.xyz", CARBON);
    // at each atom, φ of which reaches no other
    let points = at("points.txt", "0 0 0\n1.5 0 0\n4 0 0\n");
    let carbide = folder().join("fans/SiC.tersoff").display().to_string();
    let out = dir.path().join("out");
    let energies = |element: &str, partition: &str| {
        let all = format!(
            "--frames {frames} --potential tersoff --file {carbide} --element {element} --units metal --kernel polynomial --width 1.2 \
             --points {points} --residuals 0 --partition {partition} --out {}",
            out.display()
        );
        let (code, error) = fields(&words(&all));
        assert_eq!(code, Some(0), "{error}");
        let text = std::fs::read_to_string(out.join("points.csv")).unwrap();
        let mut rows = text.lines().map(|l| l.split(',').collect::<Vec<_>>());
        let head = rows.next().unwrap();
        let column = head.iter().position(|h| *h == "e_pot").unwrap();
        rows.map(|row| row[column].parse().unwrap())
            .collect::<Vec<f64>>()
    };
    for partition in ["site", "equal", "centre:0.25"] {
        let alone = energies("C", partition);
        assert!(
            alone[0] < -0.1 && (alone[0] - alone[1]).abs() < 1e-12,
            "{alone:?}"
        );
        assert_eq!(alone[2], 0.0, "{partition}");
        let with = energies("Si,C", partition);
        assert!(
            with.iter().zip(&alone).all(|(a, b)| (a - b).abs() < 1e-12),
            "{partition}: {with:?} {alone:?}"
        );
    }
}
