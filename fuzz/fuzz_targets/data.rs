#![no_main]
//! LAMMPS data files.

use libfuzzer_sys::fuzz_target;
use peridyne_io::read::lammps::read_data;
use std::io::Cursor;

fuzz_target!(|bytes: &[u8]| {
    let _ = read_data(Cursor::new(bytes), "fuzz");
});
