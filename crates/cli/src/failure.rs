//! How the program ends badly: 1 when a run failed, 2 when the input was wrong.

use std::io::Write;
use std::process::ExitCode;

pub enum Failure {
    /// The input is wrong; nothing was run or written.
    Input(miette::Report),
    /// The run, or writing its results, failed.
    Run(String),
}

impl Failure {
    pub fn input(message: impl Into<String>) -> Failure {
        Failure::Input(miette::Report::msg(message.into()))
    }

    pub fn report(self) -> ExitCode {
        match self {
            Failure::Input(report) => {
                eprintln!("{report:?}");
                ExitCode::from(2)
            }
            Failure::Run(message) => {
                eprintln!("error: {message}");
                ExitCode::from(1)
            }
        }
    }
}

/// Print a line; a reader that went away (`| head`) ends the program quietly.
pub fn say(text: &str) {
    if writeln!(std::io::stdout().lock(), "{text}").is_err() {
        std::process::exit(0);
    }
}
