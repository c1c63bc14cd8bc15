//! One half of `verify/output/atoms_ase.py`: reads what ASE wrote into the directory `PERIDYNE_ASE` and writes it again.

use peridyne_io::read::{Frame, data, extxyz};
use peridyne_io::write::data::write_data;
use peridyne_io::write::trajectory::{Format, write_atoms};
use std::path::PathBuf;

#[test]
fn files_of_ase_are_read() {
    let Some(directory) = std::env::var_os("PERIDYNE_ASE").map(PathBuf::from) else {
        eprintln!("skipped: see verify/output/atoms_ase.py");
        return;
    };
    let atoms = extxyz::extxyz(&directory.join("ase.xyz"), Frame::Last).unwrap();
    assert_eq!(atoms.len(), 48);
    assert_eq!(atoms.periodic, [true, true, false]);
    assert!(atoms.velocity.is_some() && atoms.force.is_some());
    let plain = data::data(&directory.join("ase.data")).unwrap();
    for (a, b) in atoms.position.iter().zip(&plain.position) {
        assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-6), "{a:?} {b:?}");
    }
    let frames = [atoms.clone(), atoms.clone()];
    write_atoms(&directory.join("peridyne.xyz"), Format::Extxyz, &frames).unwrap();
    write_atoms(&directory.join("peridyne.lammpstrj"), Format::Dump, &frames).unwrap();
    write_data(&directory.join("peridyne.data"), &atoms).unwrap();
}
