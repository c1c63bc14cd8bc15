//! The peridyne program.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(peridyne_cli::program(std::env::args_os()))
}
