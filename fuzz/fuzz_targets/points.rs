#![no_main]
//! Files of points; the first byte chooses the format.

use libfuzzer_sys::fuzz_target;
use peridyne_io::read::parse;

fuzz_target!(|input: (u8, &str)| {
    let (kind, text) = input;
    let extension = ["txt", "inp", "msh", "data", "extxyz", "lammpstrj"][kind as usize % 6];
    if let Err(error) = parse(text, "fuzz", extension) {
        assert!(!error.message.is_empty());
    }
});
