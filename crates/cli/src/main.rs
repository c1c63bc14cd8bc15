//! The peridyne program.

use std::process::ExitCode;

fn main() -> ExitCode {
    peridyne_cli::program(std::env::args_os())
}
