#![no_main]
//! LAMMPS scripts up to their first run.

use libfuzzer_sys::fuzz_target;
use peridyne_lammps::host::{Console, Engine, Host, HostError, Setup};
use peridyne_lammps::{Options, run_text};

struct Nothing;

impl Host for Nothing {
    fn build(&mut self, _: Setup) -> Result<Box<dyn Engine>, HostError> {
        Err(HostError::new("the fuzzer runs nothing"))
    }
}

impl Console for Nothing {
    fn print(&mut self, _: &str) {}
    fn note(&mut self, _: &str) {}
}

fuzz_target!(|text: &str| {
    // nothing outside is read or written, and a jump back would loop for ever, as written
    let forbidden = ["jump", "include", "file", "append", "read_", "write_", "dump", "log", "shell"];
    // two lattices of very different constants ask for 10^8 atoms in a few words: slow, as written
    let small = text.matches("lattice").count() <= 1;
    if small && !forbidden.iter().any(|word| text.contains(word)) {
        let options = Options {
            dry: true,
            ..Options::default()
        };
        let _ = run_text("fuzz", text, &options, &mut Nothing, &mut Nothing);
    }
});
