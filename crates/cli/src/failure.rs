//! How the program ends badly, and how it prints.
//!
//! Exit codes: 0 done; 1 a run, or writing or printing its results, failed; 2 the input was wrong; 129, 130 and 143 a run was
//! ended by SIGHUP, SIGINT or SIGTERM. A reader that leaves (`| head -1`) has what it wanted: the work goes on, its files are
//! written, and the code is that of the work. Any other failure of standard output (`> /dev/full`) loses what somebody
//! asked for: the work goes on, too, and the code is 1.

use crate::signals::Signal;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;
use std::sync::Mutex;

pub enum Failure {
    /// The input is wrong; nothing was run or written.
    Input(miette::Report),
    /// The run, or writing its results, failed.
    Run(String),
    /// A signal ended the run; its last state is written.
    Ended(Signal),
}

impl Failure {
    pub fn input(message: impl Into<String>) -> Failure {
        Failure::Input(miette::Report::msg(message.into()))
    }

    pub fn report(self) -> ExitCode {
        match self {
            Failure::Input(report) => {
                note(&format!("{report:?}"));
                ExitCode::from(2)
            }
            Failure::Run(message) => {
                note(&format!("error: {message}"));
                ExitCode::from(1)
            }
            Failure::Ended(signal) => ExitCode::from(signal.exit_code()),
        }
    }
}

/// What has become of standard output.
enum Screen {
    Open,
    /// The reader has left.
    Closed,
    /// What the operating system said when a line did not get out.
    Lost(String),
}

static SCREEN: Mutex<Screen> = Mutex::new(Screen::Open);

/// Print a line. After the first that does not get out nothing more is printed; [`printed`] says why.
pub fn say(text: &str) {
    let mut screen = SCREEN.lock().unwrap_or_else(|e| e.into_inner());
    if !matches!(*screen, Screen::Open) {
        return;
    }
    let mut out = std::io::stdout().lock();
    let Err(error) = writeln!(out, "{text}").and_then(|()| out.flush()) else {
        return;
    };
    *screen = match error.kind() {
        ErrorKind::BrokenPipe => Screen::Closed,
        _ => Screen::Lost(error.to_string()),
    };
}

/// Print a line on standard error; there is nobody to tell when that fails.
pub fn note(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Did all that was said get out, as far as somebody listened?
pub fn printed() -> Result<(), Failure> {
    match &*SCREEN.lock().unwrap_or_else(|e| e.into_inner()) {
        Screen::Open | Screen::Closed => Ok(()),
        Screen::Lost(why) => Err(Failure::Run(format!(
            "standard output cannot be written: {why}; files are as they would be without it"
        ))),
    }
}
