use super::*;
use crate::write::fields::positions;
use crate::write::fields::tests::{put, small, with};
use hdf5_reader::{H5Type, Hdf5File};
use peridyne::observe::Values;

/// A frame with every kind of numbers.
fn frame(step: u64) -> Snapshot {
    let by = step as f64;
    let mut s = Snapshot {
        step,
        time: 1e-7 * by - 1.0 / 3.0,
        ..with(small(), "damage", Values::Scalars(vec![0.0, by, f64::NAN]))
    };
    let six = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|x| x + by);
    put(&mut s, "stress", Values::Symmetric(vec![six; 3]));
    let nine = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, by];
    put(&mut s, "gradient", Values::Tensors(vec![nine; 3]));
    put(&mut s, "block", Values::Integers(vec![-1, 0, step as i32]));
    let moved = s.displacement().iter().map(|u| u.map(|x| x + by)).collect();
    put(&mut s, "displacement", Values::Vectors(moved));
    s
}

fn list<T: H5Type>(file: &Hdf5File, name: &str) -> Vec<T> {
    let dataset = file.dataset(&format!("VTKHDF/{name}")).unwrap();
    let values = dataset.read_array::<T>().unwrap();
    values.into_iter().collect()
}

/// Rows of a dataset from one on, bit by bit.
fn rows(file: &Hdf5File, name: &str, from: i64, rows: usize) -> Vec<u8> {
    let dataset = file.dataset(&format!("VTKHDF/{name}")).unwrap();
    let all = dataset.read_raw_bytes().unwrap();
    let width = all.len() / dataset.shape()[0] as usize;
    all[from as usize * width..][..rows * width].to_vec()
}

/// The file holds these frames and no others.
fn holds(bytes: &[u8], frames: &[Snapshot]) {
    let file = Hdf5File::from_bytes(bytes).unwrap();
    let grid = file.group("VTKHDF").unwrap();
    let kind = grid.attribute("Type").unwrap().read_string().unwrap();
    assert_eq!(kind, "UnstructuredGrid");
    let version = grid.attribute("Version").unwrap();
    assert_eq!(version.read_1d::<i64>().unwrap(), [2, 6]);
    let steps = file
        .group("VTKHDF/Steps")
        .unwrap()
        .attribute("NSteps")
        .unwrap();
    assert_eq!(steps.read_scalar::<i64>().unwrap(), frames.len() as i64);
    for name in ["NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"] {
        assert_eq!(list::<i64>(&file, name), [3], "{name}");
    }
    assert_eq!(list::<i64>(&file, "Connectivity"), [0, 1, 2]);
    assert_eq!(list::<i64>(&file, "Offsets"), [0, 1, 2, 3]);
    assert_eq!(list::<u8>(&file, "Types"), [1, 1, 1]);
    assert_eq!(list::<i64>(&file, "PointData/id"), [1, 2, 3]);
    if frames.is_empty() {
        return;
    }
    // VTK has room for as many times as there are steps
    let times = list::<f64>(&file, "Steps/Values");
    assert_eq!(times.len(), frames.len());
    let numbers = list::<i64>(&file, "FieldData/step");
    let points = list::<i64>(&file, "Steps/PointOffsets");
    for (k, s) in frames.iter().enumerate() {
        assert_eq!(times[k], s.time);
        let field = list::<i64>(&file, "Steps/FieldDataOffsets/step")[k];
        assert_eq!(numbers[field as usize], s.step as i64);
        let places: Vec<u8> = { positions(s).flatten() }
            .flat_map(f64::to_le_bytes)
            .collect();
        assert_eq!(rows(&file, "Points", points[k], 3), places, "frame {k}");
        for column in fields(s).unwrap() {
            let name = column.name();
            let at = list::<i64>(&file, &format!("Steps/PointDataOffsets/{name}"))[k];
            let wanted: Vec<u8> = match &column.values {
                Values::Scalars(v) => v.iter().flat_map(|x| x.to_le_bytes()).collect(),
                Values::Vectors(v) => v.iter().flatten().flat_map(|x| x.to_le_bytes()).collect(),
                Values::Symmetric(v) => {
                    let vtk = v.iter().flat_map(|t| [t[0], t[1], t[2], t[3], t[5], t[4]]);
                    vtk.flat_map(f64::to_le_bytes).collect()
                }
                Values::Tensors(v) => v.iter().flatten().flat_map(|x| x.to_le_bytes()).collect(),
                Values::Integers(v) => v.iter().flat_map(|x| x.to_le_bytes()).collect(),
                Values::Counts(v) => v.iter().flat_map(|x| x.to_le_bytes()).collect(),
            };
            let found = rows(&file, &format!("PointData/{name}"), at, 3);
            assert_eq!(found, wanted, "{name} of frame {k}");
        }
    }
    for name in [
        "PartOffsets",
        "CellOffsets",
        "ConnectivityIdOffsets",
        "PointDataOffsets/id",
    ] {
        let zeros = list::<i64>(&file, &format!("Steps/{name}"));
        assert!(
            zeros.len() >= frames.len() && zeros.iter().all(|x| *x == 0),
            "{name}"
        );
    }
    assert!(
        list::<i64>(&file, "Steps/NumberOfParts")
            .iter()
            .all(|x| *x == 1)
    );
    let sizes = file.dataset("VTKHDF/Steps/FieldDataSizes/step").unwrap();
    assert_eq!(sizes.shape()[1], 2);
}

/// A file of so many frames, with chunks of at most so many bytes.
fn written(path: &Path, frames: u64, largest: u64) -> Vec<u8> {
    let mut file = VtkHdf::made(path, &frame(0), largest, true).unwrap();
    for step in 0..frames {
        file.push(&frame(step)).unwrap();
        // the same step again is the same frame
        file.push(&frame(step)).unwrap();
    }
    file.finish().unwrap();
    std::fs::read(path).unwrap()
}

fn frames(count: u64) -> Vec<Snapshot> {
    (0..count).map(frame).collect()
}

#[test]
fn frames_come_back_in_chunks_of_any_size() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.vtkhdf");
    // a tensor of three points is 216 bytes: one chunk; two, of which the second is not full; three
    for largest in [LARGEST, 150, 72] {
        for count in [0, 1, 2, 67] {
            holds(&written(&path, count, largest), &frames(count));
        }
    }
}

fn state(of: &mut VtkHdf) -> Vec<u8> {
    let mut to = vec![];
    let mut archive = Archive::save(&mut to);
    archive.part("file", of);
    archive.done().unwrap();
    to
}

/// Opens a file for a run that goes on from this state.
fn again(path: &Path, mut state: &[u8]) -> VtkHdf {
    let mut file = VtkHdf::made(path, &frame(0), 150, false).unwrap();
    let mut archive = Archive::load(&mut state);
    archive.part("file", &mut file);
    archive.done().unwrap();
    file
}

#[test]
fn a_file_goes_back_to_a_state_and_becomes_what_it_would_have_been() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.vtkhdf");
    // leaves end with frames 32 and 64, and so do numbers of frames
    for (then, killed, all) in [
        (0, 1, 3),
        (2, 5, 5),
        (31, 33, 66),
        (32, 66, 67),
        (64, 65, 65),
    ] {
        let whole = written(&path, all, 150);
        let mut file = VtkHdf::made(&path, &frame(0), 150, true).unwrap();
        (0..then).for_each(|step| file.push(&frame(step)).unwrap());
        let saved = state(&mut file);
        let there = std::fs::read(&path).unwrap();
        (then..killed).for_each(|step| file.push(&frame(step)).unwrap());
        drop(file);
        let mut file = again(&path, &saved);
        file.rewind().unwrap();
        assert_eq!(
            std::fs::read(&path).unwrap(),
            there,
            "back at {then} of {killed}"
        );
        (then..all).for_each(|step| file.push(&frame(step)).unwrap());
        assert_eq!(std::fs::read(&path).unwrap(), whole, "on from {then}");
    }
}

#[test]
fn a_changed_file_is_not_gone_on_with() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.vtkhdf");
    let mut file = VtkHdf::made(&path, &frame(0), 150, true).unwrap();
    (0..3).for_each(|step| file.push(&frame(step)).unwrap());
    let saved = state(&mut file);
    let end = file.places.end as usize;
    let last = file.places.frame[2] as usize;
    drop(file);
    let whole = std::fs::read(&path).unwrap();
    let mut other = whole.clone();
    other[last + 5] ^= 1;
    for bytes in [&other[..], &whole[..end - 1]] {
        std::fs::write(&path, bytes).unwrap();
        let text = again(&path, &saved).rewind().unwrap_err().to_string();
        assert!(text.contains("it is not as the run left it"), "{text}");
        assert_eq!(std::fs::read(&path).unwrap(), bytes);
    }
}

#[test]
fn whatever_part_of_a_frame_is_there_the_file_holds_those_before() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.vtkhdf");
    // the second frame of a file, and those with which leaves and numbers of frames are full
    for count in [1, 32, 64] {
        let mut file = VtkHdf::made(&path, &frame(0), 150, true).unwrap();
        (0..count).for_each(|step| file.push(&frame(step)).unwrap());
        let before = std::fs::read(&path).unwrap();
        let end = file.places.end as usize;
        file.push(&frame(count)).unwrap();
        let after = std::fs::read(&path).unwrap();
        let head = file.fixed[0] as usize;
        // numbers alone
        let numbers = [&before[..], &after[end..]].concat();
        holds(&numbers, &frames(count));
        // nodes, too
        let found = [&before[..head], &after[head..]].concat();
        holds(&found, &frames(count));
        // lengths, too; half of the head comes first
        file.tell([count + 1, count]).unwrap();
        let told = std::fs::read(&path).unwrap();
        holds(&told, &frames(count));
        for cut in (0..head).step_by(512) {
            holds(&[&told[..cut], &found[cut..]].concat(), &frames(count));
        }
        holds(&after, &frames(count + 1));
        let other = |k: &usize| told[*k] != after[*k];
        let others: Vec<usize> = (0..told.len()).filter(other).collect();
        let [first, last] = [others[0], others[others.len() - 1]];
        assert_eq!(first / layout::SECTOR, last / layout::SECTOR);
        assert_eq!(others.len(), 2);
    }
}

#[test]
fn a_frame_that_fails_leaves_those_before() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("a.vtkhdf");
    let mut file = VtkHdf::create(&path, &frame(0)).unwrap();
    file.push(&frame(0)).unwrap();
    let before = std::fs::read(&path).unwrap();
    let other = Snapshot { step: 1, ..small() };
    let fewer = Snapshot {
        reference: frame(1).reference[..2].to_vec(),
        bonds: None,
        ..frame(1)
    };
    for (wrong, why) in [
        (other, "other points or fields than the first"),
        (fewer, "2 points"),
    ] {
        let text = file.push(&wrong).unwrap_err().to_string();
        assert!(text.contains("a.vtkhdf") && text.contains(why), "{text}");
        assert_eq!(std::fs::read(&path).unwrap(), before);
    }
    file.push(&frame(1)).unwrap();
    holds(&std::fs::read(&path).unwrap(), &frames(2));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_with_path_and_reason() {
    let dir = tempfile::tempdir().unwrap();
    let mut file = VtkHdf::create(&dir.path().join("a.vtkhdf"), &frame(0)).unwrap();
    let real = std::mem::replace(
        &mut file.file,
        File::options().write(true).open("/dev/full").unwrap(),
    );
    let text = file.push(&frame(0)).unwrap_err().to_string();
    assert!(
        text.contains("a.vtkhdf") && text.contains("No space left"),
        "{text}"
    );
    // when there is room again
    file.file = real;
    file.push(&frame(0)).unwrap();
    holds(&std::fs::read(&file.path).unwrap(), &frames(1));
}
