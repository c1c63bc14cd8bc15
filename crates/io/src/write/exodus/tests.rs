use super::*;
use crate::netcdf::Reader;
use crate::read::exodus::parse_exodus;
use crate::write::fields::tests::{put, small, with};
use peridyne::observe::Values;

fn layout() -> Layout {
    Layout {
        title: "three points".into(),
        blocks: vec![("glass".into(), vec![0, 2]), ("steel".into(), vec![1])],
        sets: vec![("left".into(), vec![1, 2])],
        volume: vec![0.5, 0.25, 1.0],
        globals: vec![
            Variable::new("step", ""),
            Variable::new("kinetic_energy", "J"),
        ],
        units: UnitSystem::Si,
        time_unit: "s".into(),
    }
}

fn rich() -> Snapshot {
    let mut s = small();
    let rows = vec![[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]; 3];
    put(&mut s, "stress", Values::Symmetric(rows));
    s
}

fn later() -> Snapshot {
    Snapshot {
        step: 12,
        time: 2e-7,
        ..with(rich(), "damage", Values::Scalars(vec![0.5; 3]))
    }
}

fn written(path: &Path) -> Vec<u8> {
    let mut file = Exodus::create(path, &layout(), &rich()).unwrap();
    file.push(&rich(), &[7.0, 1.5]).unwrap();
    file.push(&later(), &[12.0, 2.5]).unwrap();
    file.finish().unwrap();
    std::fs::read(path).unwrap()
}

/// A nodal variable in a frame.
fn nodal(bytes: &[u8], name: &str, frame: usize) -> Vec<f64> {
    let reader = Reader::new(bytes.to_vec()).unwrap();
    let names = reader.texts("name_nod_var").unwrap().unwrap();
    let at = names.iter().position(|n| n == name).expect(name) + 1;
    reader.record(&format!("vals_nod_var{at}"), frame)
}

/// Frames that a reader sees.
fn frames(bytes: &[u8]) -> u64 {
    Reader::new(bytes.to_vec())
        .unwrap()
        .length("time_step")
        .unwrap()
}

#[test]
fn frames_come_back() {
    let dir = tempfile::tempdir().unwrap();
    let bytes = written(&dir.path().join("a.e"));
    let reader = Reader::new(bytes.clone()).unwrap();
    assert_eq!(frames(&bytes), 2);
    assert_eq!(reader.record("time_whole", 0), [1.5e-7]);
    assert_eq!(reader.record("time_whole", 1), [2e-7]);
    assert_eq!(reader.record("vals_glo_var", 1), [12.0, 2.5]);
    let s = rich();
    for (a, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let column: Vec<f64> = s.displacement().iter().map(|u| u[a]).collect();
        assert_eq!(nodal(&bytes, &format!("displ_{axis}"), 0), column);
        let reference: Vec<f64> = s.reference.iter().map(|x| x[a]).collect();
        let coordinates = reader.floats(&format!("coord{axis}"));
        assert_eq!(coordinates.unwrap().unwrap(), reference);
    }
    assert_eq!(nodal(&bytes, "damage", 0), [0.0, 0.25, 1.0]);
    assert_eq!(nodal(&bytes, "damage", 1), [0.5; 3]);
    assert_eq!(nodal(&bytes, "block", 1), [-1.0, 0.0, 4.0]);
    assert_eq!(nodal(&bytes, "fragment", 1), [0.0, 0.0, 1.0]);
    assert_eq!(nodal(&bytes, "stress_xz", 0), [5.0; 3]);
    let map = reader.wholes("elem_num_map");
    assert_eq!(map, Ok(Some(vec![1, 3, 2])));
}

#[test]
fn variables_have_units() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.e");
    let mut s = small();
    let velocity = s.columns.iter_mut().find(|c| c.name() == "velocity");
    velocity.unwrap().declaration.dimension = Dim::VELOCITY;
    Exodus::create(&path, &layout(), &s).unwrap();
    let reader = Reader::new(std::fs::read(&path).unwrap()).unwrap();
    let unit = |name: &str| reader.attribute(name, "units").unwrap_or_default();
    let nodal = reader.texts("name_nod_var").unwrap().unwrap();
    let of = |name: &str| nodal.iter().position(|n| n == name).unwrap() + 1;
    assert_eq!(unit(&format!("vals_nod_var{}", of("velocity_z"))), "m/s");
    assert_eq!(unit(&format!("vals_nod_var{}", of("damage"))), "");
    assert_eq!(
        (unit("coordy"), unit("time_whole")),
        ("m".into(), "s".into())
    );
    let lines = reader.texts("info_records").unwrap().unwrap();
    let axes = ["x", "y", "z"].map(|axis| format!("velocity_{axis} [m/s]"));
    assert_eq!(lines[..3], axes);
    assert_eq!(lines[3..], ["kinetic_energy [J]"]);
}

#[test]
fn the_mesh_of_a_result_is_a_body_again() {
    let dir = tempfile::tempdir().unwrap();
    let points = parse_exodus(written(&dir.path().join("a.e")), "a.e").unwrap();
    let s = small();
    let order = [0, 2, 1].map(|i: usize| s.reference[i]);
    assert_eq!(points.cloud.position, order);
    assert_eq!(points.cloud.volume, [0.5, 1.0, 0.25]);
    assert_eq!(points.cloud.mark, [1, 1, 2]);
    let sets: Vec<(&str, &[u32])> = { points.cloud.sets.iter() }
        .map(|(n, s)| (&**n, &**s))
        .collect();
    let wanted: [(&str, &[u32]); 3] = [("glass", &[0, 1]), ("steel", &[2]), ("left", &[1, 2])];
    assert_eq!(sets, wanted);
}

#[test]
fn a_frame_that_was_cut_off_is_not_counted_and_is_written_over() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.e");
    let whole = written(&path);
    let mut file = Exodus::create(&path, &layout(), &rich()).unwrap();
    assert_eq!(frames(&std::fs::read(&path).unwrap()), 0);
    file.push(&rich(), &[7.0, 1.5]).unwrap();
    // a run that was killed in the next frame
    let end = file.start + file.record;
    let mut half = &file.file;
    half.seek(SeekFrom::Start(end)).unwrap();
    half.write_all(&[7; 40]).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!(frames(&bytes), 1);
    assert_eq!(nodal(&bytes, "damage", 0), [0.0, 0.25, 1.0]);
    file.push(&later(), &[12.0, 2.5]).unwrap();
    // the same step again is the same frame
    file.push(&later(), &[12.0, 2.5]).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), whole);
}

#[test]
fn a_frame_that_fails_leaves_those_before() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.e");
    let mut file = Exodus::create(&path, &layout(), &rich()).unwrap();
    file.push(&rich(), &[7.0, 1.5]).unwrap();
    let before = std::fs::read(&path).unwrap();
    let told = |e: WriteError| e.to_string();
    let other = Snapshot {
        step: 12,
        ..small()
    };
    let text = told(file.push(&other, &[12.0, 2.5]).unwrap_err());
    assert!(text.contains("other fields than the first"), "{text}");
    let text = told(file.push(&later(), &[12.0]).unwrap_err());
    assert!(text.contains("a.e"), "{text}");
    assert_eq!(std::fs::read(&path).unwrap(), before);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_with_path_and_reason() {
    let dir = tempfile::tempdir().unwrap();
    let mut file = Exodus::create(&dir.path().join("a.e"), &layout(), &rich()).unwrap();
    file.file = File::options().write(true).open("/dev/full").unwrap();
    let text = file.push(&rich(), &[7.0, 1.5]).unwrap_err().to_string();
    assert!(
        text.contains("a.e") && text.contains("No space left"),
        "{text}"
    );
}

#[test]
fn layouts_of_other_points_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.e");
    let wrong: [fn(&mut Layout); 4] = [
        |l| l.blocks[0].1.push(1),
        |l| l.blocks.truncate(1),
        |l| l.sets[0].1.push(3),
        |l| l.volume.truncate(2),
    ];
    for change in wrong {
        let mut layout = layout();
        change(&mut layout);
        assert!(Exodus::create(&path, &layout, &rich()).is_err());
        assert!(!path.exists());
    }
}

#[test]
fn long_names_and_titles_fit() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.e");
    let mut layout = layout();
    layout.title = "ä".repeat(60);
    layout.sets[0].0 = "a".repeat(70);
    Exodus::create(&path, &layout, &rich()).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let reader = Reader::new(bytes).unwrap();
    assert_eq!(reader.texts("ns_names"), Ok(Some(vec!["a".repeat(70)])));
    assert_eq!(reader.global("title").as_string(), Some("ä".repeat(40)));
    let width = reader.global("maximum_name_length");
    assert_eq!(width.as_f64(), Some(70.0));
}

#[test]
fn a_file_goes_back_to_a_state_and_one_with_a_changed_frame_does_not() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.e");
    let mut file = Exodus::create(&path, &layout(), &rich()).unwrap();
    file.push(&rich(), &[7.0, 1.5]).unwrap();
    let mut state = vec![];
    let mut archive = Archive::save(&mut state);
    archive.part("file", &mut file);
    archive.done().unwrap();
    let then = std::fs::read(&path).unwrap();
    file.push(&later(), &[12.0, 2.5]).unwrap();
    file.finish().unwrap();
    let whole = std::fs::read(&path).unwrap();
    let again = || {
        let mut file = Exodus::reopen(&path, &layout(), &rich()).unwrap();
        let mut from = state.as_slice();
        let mut archive = Archive::load(&mut from);
        archive.part("file", &mut file);
        archive.done().unwrap();
        file
    };
    // of the mesh and of the frame, but not of what came after
    for at in [200, then.len() - 1] {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        std::fs::write(&path, &bytes).unwrap();
        let text = again().rewind().unwrap_err().to_string();
        assert!(
            text.contains("a.e") && text.contains("it is not as the run left it"),
            "{text}"
        );
        assert_eq!(std::fs::read(&path).unwrap(), bytes);
    }
    let mut bytes = whole.clone();
    bytes[then.len()] ^= 1;
    std::fs::write(&path, &bytes).unwrap();
    let mut file = again();
    file.rewind().unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), then);
    file.push(&later(), &[12.0, 2.5]).unwrap();
    file.finish().unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), whole);
}
