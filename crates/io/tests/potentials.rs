//! The potential files that come with LAMMPS, where they are: `PERIDYNE_POTENTIALS` names their directory.

use peridyne_io::read::eam::{funcfl, setfl};
use std::path::PathBuf;

fn directory() -> Option<PathBuf> {
    let directory = std::env::var_os("PERIDYNE_POTENTIALS").map(PathBuf::from);
    if directory.is_none() {
        eprintln!("skipped: set PERIDYNE_POTENTIALS to LAMMPS's directory of potentials");
    }
    directory
}

#[test]
fn files_of_lammps_are_read() {
    let Some(directory) = directory() else { return };
    let mut read = 0;
    for entry in std::fs::read_dir(&directory).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().to_string();
        let file = if name.ends_with(".eam.alloy") {
            setfl(&path)
        } else if name.ends_with(".eam") {
            funcfl(&[&path])
        } else {
            continue;
        };
        let file = file.unwrap_or_else(|e| panic!("{e}"));
        let first = &file.elements[0];
        eprintln!(
            "{name}: {} … cutoff {}, {} values",
            first.name,
            file.cutoff,
            file.pair[0].len()
        );
        // no pull without neighbours: the last values are those at the cutoff
        let last = file.density[0].last().unwrap().abs();
        let largest = file.density[0].iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!(last < 1e-2 * largest, "{name}: {last} of {largest}");
        read += 1;
    }
    assert!(
        read > 0,
        "no .eam and .eam.alloy files in {}",
        directory.display()
    );
}

#[test]
fn copper_of_foiles_has_its_first_values() {
    let Some(directory) = directory() else { return };
    let file = funcfl(&[directory.join("Cu_u3.eam")]).unwrap();
    assert_eq!(file.element("Cu").unwrap(), 0);
    assert_eq!(
        (file.dr, file.cutoff),
        (1.0000000000000009e-02, 4.949_999_999_999_989)
    );
    assert_eq!((file.pair[0].len(), file.embedding[0].len()), (499, 499));
    assert!((file.embedding[0][1] + 3.156_163_690_342_435e-1).abs() < 1e-15);
}
