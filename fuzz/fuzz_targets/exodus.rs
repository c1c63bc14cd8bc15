#![no_main]
//! Exodus II meshes.

use libfuzzer_sys::fuzz_target;
use peridyne_io::read::exodus::parse_exodus;

fuzz_target!(|bytes: &[u8]| {
    if let Err(error) = parse_exodus(bytes.to_vec(), "fuzz") {
        assert!(!error.message.is_empty());
    }
});
