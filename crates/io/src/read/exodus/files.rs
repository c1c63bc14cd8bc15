//! Files that other programs have written: `verify/output/exodus_layouts.py`.

use super::tests::{bytes, cubes};
use super::*;
use proptest::prelude::*;
use std::io::Read;

macro_rules! files {
    ($($name:literal),*) => {
        [$(($name, include_bytes!(concat!("../../../tests/data/exodus/", $name, ".gz")).as_slice())),*]
    };
}

const FILES: [(&str, &[u8]); 10] = files![
    "cubit_netcdf4.g",
    "cubit_netcdf4_classic.g",
    "cubit_netcdf3_64bit_data.g",
    "cubit_netcdf3_64bit_offset.g",
    "cubit_netcdf3_classic.g",
    "meshio.e",
    "meshio_without_sets.e",
    "plain.g",
    "absurd.g",
    "elsewhere.g"
];

/// The bytes of a file.
pub fn given(name: &str) -> Vec<u8> {
    let (_, packed) = FILES.iter().find(|file| file.0 == name).expect(name);
    let mut all = vec![];
    flate2::read::GzDecoder::new(*packed)
        .read_to_end(&mut all)
        .unwrap();
    all
}

fn told(bytes: Vec<u8>) -> String {
    parse_exodus(bytes, "f").unwrap_err().to_string()
}

#[test]
fn every_format_makes_the_same_body() {
    // what it is, other tests say number by number
    let wanted = parse_exodus(bytes(&cubes()), "f").unwrap();
    for (name, _) in &FILES[..5] {
        let points = parse_exodus(given(name), "f").unwrap();
        assert_eq!(points, wanted, "{name}");
    }
}

#[test]
fn blocks_and_sets_of_meshio_are_those_of_the_mesh() {
    for (name, count) in [("meshio.e", 4), ("meshio_without_sets.e", 2)] {
        let points = parse_exodus(given(name), "f").unwrap();
        assert_eq!(points.dimension, Some(3));
        let wanted = [([0.5; 3], 1.0), ([5.0 / 3.0, 1.0 / 3.0, 0.5], 0.5)];
        assert_eq!(points.cloud.position.len(), 2);
        for (i, (x, volume)) in wanted.into_iter().enumerate() {
            assert!((points.cloud.volume[i] - volume).abs() < 1e-15);
            for a in 0..3 {
                assert!((points.cloud.position[i][a] - x[a]).abs() < 1e-15);
            }
        }
        // meshio counts its blocks from 0
        let names = [(0, "block_0".to_string()), (1, "block_1".to_string())];
        assert_eq!(points.cloud.names, names);
        let sets: Vec<(&str, &[u32])> = { points.cloud.sets.iter() }
            .map(|(n, s)| (&**n, &**s))
            .collect();
        let wanted: [(&str, &[u32]); 4] = [
            ("block_0", &[0]),
            ("block_1", &[1]),
            ("left", &[0]),
            ("right", &[1]),
        ];
        assert_eq!(sets, wanted[..count]);
    }
}

#[test]
fn what_is_no_mesh_is_told() {
    let plain = told(given("plain.g"));
    assert!(plain.ends_with("it is no Exodus mesh"), "{plain}");
    let none = told(b"solid of another kind".to_vec());
    assert!(none.contains("it is no netCDF file"), "{none}");
    // 2^40 nodes in a few kB, none of which was written
    let absurd = told(given("absurd.g"));
    assert!(
        absurd.contains("coordx would have 8.796 TB, more than a file of this size can hold"),
        "{absurd}"
    );
    // numbers that lie in another file
    let elsewhere = told(given("elsewhere.g"));
    assert!(elsewhere.contains("external"), "{elsewhere}");
}

#[test]
fn netcdf4_that_is_cut_short_is_refused() {
    let whole = given("meshio.e");
    for length in (0..whole.len()).step_by(7) {
        let told = told(whole[..length].to_vec());
        let known = ["cut short", "no netCDF file"];
        assert!(known.iter().any(|k| told.contains(k)), "{length}: {told}");
    }
}

proptest! {
    #[test]
    fn damaged_netcdf4_is_read_or_refused(
        of in 0usize..2,
        places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut damaged = given(["meshio.e", "cubit_netcdf4.g"][of]);
        for (place, byte) in places {
            let at = place.index(damaged.len());
            damaged[at] = byte;
        }
        if let Err(told) = parse_exodus(damaged, "f") {
            prop_assert!(!told.message.is_empty());
        }
    }
}
