//! VTKHDF files as a user meets them: all frames of the series of VTU in one file, of a run that was ended and went on, too.

use hdf5_reader::{H5Type, Hdf5File};
use peridyne_io::read::vtu::{Frame, Number, collection};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};
use tempfile::TempDir;

fn good(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    path.join(name).to_str().unwrap().into()
}

/// A few points on a line.
const CHAIN: &str = r#"horizon = { m_ratio = 2 }
[body]
lattice = "chain"
spacing = "1 mm"
cells = [7]
[material]
density = 1000
law = { pmb = { young = "1 GPa" } }
[[initial]]
velocity = { x = "sin(400 * x)" }
[run]
steps = 4000
[output]
every = 40
picture = false
report = false
vtkhdf = "a.vtkhdf"
"#;

/// Exit code, and what is said.
fn peridyne(arguments: &[&str]) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), said)
}

fn run(deck: &str, out: &Path, sets: &[&str]) {
    let mut arguments = vec!["run", deck, "--out", out.to_str().unwrap()];
    for set in sets {
        arguments.extend(["--set", set]);
    }
    let (code, said) = peridyne(&arguments);
    assert_eq!(code, Some(0), "{said}");
}

fn list<T: H5Type>(file: &Hdf5File, name: &str) -> Vec<T> {
    let dataset = file.dataset(&format!("VTKHDF/{name}")).expect(name);
    let values = dataset.read_array::<T>().expect(name);
    values.into_iter().collect()
}

/// A dataset's numbers, and how many there are in a row.
fn numbers(file: &Hdf5File, name: &str, kind: Number) -> (Vec<f64>, usize) {
    let values = match kind {
        Number::Float64 => list::<f64>(file, name),
        Number::Int64 => { list::<i64>(file, name).into_iter() }
            .map(|x| x as f64)
            .collect(),
        Number::Int32 => { list::<i32>(file, name).into_iter() }
            .map(f64::from)
            .collect(),
        Number::UInt32 => { list::<u32>(file, name).into_iter() }
            .map(f64::from)
            .collect(),
    };
    let dataset = file.dataset(&format!("VTKHDF/{name}")).unwrap();
    let width = dataset.shape()[1..].iter().product::<u64>() as usize;
    (values, width)
}

/// Every number of every frame of the series is in the file; steps and arrays of a frame.
fn same_as_series(out: &Path, name: &str) -> (usize, Vec<String>) {
    let file = Hdf5File::open(out.join(name)).unwrap();
    let steps = file.group("VTKHDF/Steps").unwrap();
    let count = steps.attribute("NSteps").unwrap();
    let series = collection(&out.join("points.pvd")).unwrap();
    assert_eq!(count.read_scalar::<i64>().unwrap(), series.len() as i64);
    let times: Vec<f64> = series.iter().map(|(time, _)| *time).collect();
    assert_eq!(list::<f64>(&file, "Steps/Values"), times);
    let points = list::<i64>(&file, "Steps/PointOffsets");
    let mut arrays = vec![];
    for (k, (_, frame)) in series.iter().enumerate() {
        let frame = Frame::open(&out.join(frame)).unwrap();
        assert_eq!(list::<i64>(&file, "NumberOfPoints"), [frame.points as i64]);
        assert_eq!(list::<i64>(&file, "FieldData/step")[k], frame.step as i64);
        arrays.clear();
        for array in &frame.arrays {
            let (name, at) = match &*array.name {
                "position" => ("Points".to_string(), points[k]),
                name => {
                    let offsets = format!("Steps/PointDataOffsets/{name}");
                    let at = list::<i64>(&file, &offsets)[k];
                    (format!("PointData/{name}"), at)
                }
            };
            let (found, width) = numbers(&file, &name, array.kind);
            assert_eq!(width, array.components, "{name}");
            let bits = |all: &[f64]| all.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            let found = &found[at as usize * width..][..frame.points * width];
            let wanted = frame.numbers(array).unwrap();
            assert_eq!(bits(found), bits(&wanted), "{name} of frame {k}");
            arrays.push(array.name.clone());
        }
    }
    let (groups, data) = file
        .group("VTKHDF/PointData")
        .unwrap()
        .member_names()
        .unwrap();
    assert!(
        groups.is_empty() && data.len() + 1 == arrays.len(),
        "{data:?}"
    );
    (series.len(), arrays)
}

#[test]
fn the_file_holds_the_series_bit_for_bit() {
    let dir = TempDir::new().unwrap();
    let quick = ["output.picture=false", "output.report=false"];
    // two bodies in the plane, with tensors
    let out = dir.path().join("blocks");
    run(&good("vtkhdf_blocks.toml"), &out, &quick);
    let (steps, arrays) = same_as_series(&out, "blocks.vtkhdf");
    assert_eq!(steps, 21);
    for name in [
        "position",
        "stress",
        "displacement_gradient",
        "body",
        "block",
    ] {
        assert!(arrays.iter().any(|a| a == name), "{name}: {arrays:?}");
    }
    let report: Value = serde_json::from_slice(&fs::read(out.join("run.json")).unwrap()).unwrap();
    let files = report["setting"]["files"].as_array().unwrap();
    assert!(files.iter().any(|f| f == "blocks.vtkhdf"), "{files:?}");
    // a body in space, and a line with more frames than a node of a tree has places
    let space = dir.path().join("space");
    let more = [
        "output.vtkhdf=\"a.vtkhdf\"",
        "output.every=2",
        "run.steps=4",
    ];
    run(
        &good("two_bodies.toml"),
        &space,
        &[&quick[..], &more].concat(),
    );
    assert_eq!(same_as_series(&space, "a.vtkhdf").0, 3);
    let (deck, line) = (dir.path().join("chain.toml"), dir.path().join("line"));
    fs::write(&deck, CHAIN).unwrap();
    let short = ["run.steps=70", "output.every=1"];
    run(deck.to_str().unwrap(), &line, &short);
    assert_eq!(same_as_series(&line, "a.vtkhdf").0, 71);
    // without the series it is the same
    let alone = dir.path().join("alone");
    let set = [&quick[..], &["output.vtu=false"]].concat();
    run(&good("vtkhdf_blocks.toml"), &alone, &set);
    assert!(!alone.join("points.pvd").exists());
    let [a, b] = [&out, &alone].map(|out| fs::read(out.join("blocks.vtkhdf")).unwrap());
    assert_eq!(a, b);
}

#[cfg(unix)]
#[test]
fn a_run_that_was_ended_leaves_its_frames_and_goes_on_in_the_same_file() {
    const NAME: &str = "a.vtkhdf";
    let dir = TempDir::new().unwrap();
    let (whole, cut) = (dir.path().join("whole"), dir.path().join("cut"));
    let deck = dir.path().join("chain.toml");
    fs::write(&deck, CHAIN).unwrap();
    let deck = deck.to_str().unwrap();
    // frames far enough apart that the run is not over when it is ended
    let set = ["run.steps=400000", "output.every=4000"];
    let mut child = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(["run", deck, "--out", cut.to_str().unwrap()])
        .args(set.iter().flat_map(|set| ["--set", set]))
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let until = Instant::now() + Duration::from_secs(60);
    // a frame of the series is written before the next one begins
    let frame = |name: &std::ffi::OsStr| Path::new(name).extension().is_some_and(|e| e == "vtu");
    let frames = || {
        let all = fs::read_dir(&cut).into_iter().flatten().flatten();
        all.filter(|entry| frame(&entry.file_name())).count()
    };
    while frames() < 4 {
        assert!(Instant::now() < until, "there are no frames");
        std::thread::sleep(Duration::from_millis(5));
    }
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-TERM", &id])
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(child.wait().unwrap().code(), Some(143));
    let (steps, _) = same_as_series(&cut, NAME);
    assert!((3..101).contains(&steps), "{steps}");
    let (code, said) = peridyne(&["resume", cut.to_str().unwrap()]);
    assert_eq!(code, Some(0), "{said}");
    run(deck, &whole, &set);
    let [a, b]: [PathBuf; 2] = [whole.join(NAME), cut.join(NAME)];
    assert_eq!(same_as_series(&whole, NAME).0, 101);
    assert_eq!(fs::read(a).unwrap(), fs::read(b).unwrap());
}

#[test]
fn files_stay_in_the_folder() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("out");
    let set = "output.vtkhdf=\"../a.vtkhdf\"";
    let deck = good("vtkhdf_blocks.toml");
    let (code, said) = peridyne(&["run", &deck, "--set", set, "--out", out.to_str().unwrap()]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("leads out of the folder"), "{said}");
    assert!(!dir.path().join("a.vtkhdf").exists());
}
