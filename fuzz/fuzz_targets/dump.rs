#![no_main]
//! LAMMPS dump files; the first number is the step that is looked for.

use libfuzzer_sys::fuzz_target;
use peridyne_lammps::read_frame;
use std::io::Cursor;

fuzz_target!(|input: (u8, &[u8])| {
    let (step, bytes) = input;
    let columns = [vec!["x".to_string(), "xu".to_string()], vec!["vz".to_string()]];
    let _ = read_frame(Cursor::new(bytes), "fuzz", step.into(), &columns);
});
