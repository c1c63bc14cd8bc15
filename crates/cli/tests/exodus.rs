//! Exodus files as a user meets them: a mesh with blocks and sets, results of a run, and a body made of these.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

fn good(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    path.join(name).to_str().unwrap().into()
}

/// Exit code, what is printed, and what is said beside it.
fn peridyne(arguments: &[&str]) -> (Option<i32>, Vec<u8>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), output.stdout, said)
}

/// Runs the plate for four steps; its results.
fn plate(dir: &TempDir) -> PathBuf {
    let out = dir.path().join("out");
    let (code, _, said) = peridyne(&[
        "run",
        &good("exodus_plate.toml"),
        "--out",
        out.to_str().unwrap(),
        "--set",
        "run.steps=4",
        "--set",
        "output.every=2",
    ]);
    assert_eq!(code, Some(0), "{said}");
    out
}

#[test]
fn blocks_are_materials_and_results_are_a_body_again() {
    let dir = TempDir::new().unwrap();
    let out = plate(&dir);
    // the count of records stands after the mark
    let bytes = fs::read(out.join("plate.e")).unwrap();
    assert_eq!(bytes[..8], [b'C', b'D', b'F', 2, 0, 0, 0, 3]);
    let report: Value = serde_json::from_slice(&fs::read(out.join("run.json")).unwrap()).unwrap();
    let files = report["setting"]["files"].as_array().unwrap();
    assert!(files.iter().any(|f| f == "plate.e"), "{files:?}");
    let deck = dir.path().join("again.toml");
    let text = "horizon = \"16 mm\"\nbody = { file = \"out/plate.e\" }\n\
        [material.glass]\ndensity = 2440\nlaw = { pmb = { young = \"72 GPa\" } }\n\
        [material.steel]\ndensity = 7850\nlaw = { pmb = { young = \"200 GPa\" } }\n\
        [[boundary_condition]]\nset = \"left\"\ndisplacement = { x = 0 }\n[run]\nsteps = 1\n";
    fs::write(&deck, text).unwrap();
    let (code, found, said) = peridyne(&["check", deck.to_str().unwrap(), "--json"]);
    assert_eq!(code, Some(0), "{said}");
    let found: Value = serde_json::from_slice(&found).unwrap();
    assert_eq!(found["particles"], 192);
    // 192 cells of 5 mm, half of each material
    let mass = 96.0 * 1.25e-7 * (2440.0 + 7850.0);
    assert!((found["mass"].as_f64().unwrap() / mass - 1.0).abs() < 1e-12);
}

#[test]
fn files_stay_in_the_folder_and_a_mesh_is_no_deck() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("out");
    let set = "output.exodus=\"../plate.e\"";
    let run = ["run", &good("exodus_plate.toml"), "--set", set, "--out"];
    let (code, _, said) = peridyne(&[&run[..], &[out.to_str().unwrap()]].concat());
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("leads out of the folder"), "{said}");
    assert!(!dir.path().join("plate.e").exists());
    let (code, _, said) = peridyne(&["run", &good("exodus_plate.g")]);
    assert_eq!(code, Some(2), "{said}");
    let words = said.split_whitespace().filter(|w| *w != "│");
    let said = words.collect::<Vec<_>>().join(" ");
    assert!(said.contains("this is an Exodus mesh"), "{said}");
}

/// A file that verify/output/exodus_layouts.py made.
fn layout(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../io/tests/data/exodus");
    let packed = fs::File::open(folder.join(format!("{name}.gz"))).unwrap();
    let mut all = vec![];
    std::io::Read::read_to_end(&mut flate2::read::GzDecoder::new(packed), &mut all).unwrap();
    all
}

#[test]
fn netcdf4_is_read_like_netcdf3_and_what_is_damaged_is_an_error_of_input() {
    let dir = TempDir::new().unwrap();
    let (mesh, deck) = (dir.path().join("mesh.e"), dir.path().join("deck.toml"));
    let text = "horizon = 3\nbody = { file = \"mesh.e\" }\n\
        material = { density = 2440, law = { pmb = { young = \"72 GPa\" } } }\nrun = { steps = 4 }\n\
        output = { picture = false, report = false }\n\
        initial = [{ velocity = { x = \"1 m/s * x / 1 m\" } }]\n";
    fs::write(&deck, text).unwrap();
    let run = |bytes: &[u8]| {
        fs::write(&mesh, bytes).unwrap();
        let out = dir.path().join("out");
        let (deck, out) = (deck.to_str().unwrap(), out.to_str().unwrap());
        peridyne(&["run", deck, "--out", out])
    };
    let hash = |name: &str| {
        let (code, _, said) = run(&layout(name));
        assert_eq!(code, Some(0), "{name}: {said}");
        let report = fs::read(dir.path().join("out/run.json")).unwrap();
        let report: Value = serde_json::from_slice(&report).unwrap();
        report["state_hash"].as_str().unwrap().to_string()
    };
    let wanted = hash("cubit_netcdf3_classic.g");
    for name in ["cubit_netcdf4.g", "cubit_netcdf4_classic.g", "meshio.e"] {
        assert_eq!(hash(name), wanted, "{name}");
    }
    let whole = layout("cubit_netcdf4.g");
    for (bytes, told) in [
        (
            &whole[..whole.len() / 2],
            "the file is cut short or damaged",
        ),
        (&layout("plain.g")[..], "it is no Exodus mesh"),
        (&b"neither of them"[..], "it is no netCDF file"),
        (
            &layout("absurd.g")[..],
            "more than a file of this size can hold",
        ),
    ] {
        let (code, _, said) = run(bytes);
        assert_eq!(code, Some(2), "{said}");
        let words = said.split_whitespace().filter(|w| *w != "│");
        let said = words.collect::<Vec<_>>().join(" ");
        assert!(said.contains(told) && said.contains("mesh.e"), "{said}");
    }
}

#[test]
fn frames_have_volumes_whatever_fields_are_asked_for() {
    let dir = TempDir::new().unwrap();
    let deck = dir.path().join("deck.toml");
    // 1 mm × 1 mm × 2 mm
    let text = "horizon = { m_ratio = 3 }\nthickness = \"2 mm\"\nplane = \"stress\"\n\
        body = { lattice = \"square\", spacing = \"1 mm\", cells = [4, 3] }\n\
        material = { density = 2440, law = { pmb = { young = \"72 GPa\" } } }\nrun = { steps = 1 }\n\
        output = { fields = [\"damage\"], bonds = true, picture = false, report = false }\n";
    fs::write(&deck, text).unwrap();
    let out = dir.path().join("out");
    let (code, _, said) = peridyne(&[
        "run",
        deck.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(code, Some(0), "{said}");
    for name in [
        "points_00000000.vtu",
        "points_00000001.vtu",
        "bonds_00000001.vtu",
    ] {
        let frame = peridyne_io::read::vtu::Frame::open(&out.join(name)).unwrap();
        let volume = frame.numbers(frame.array("volume").unwrap()).unwrap();
        assert_eq!(volume.len(), 12, "{name}");
        assert!(
            volume.iter().all(|v| (v / 2e-9 - 1.0).abs() < 1e-12),
            "{name}"
        );
    }
}
