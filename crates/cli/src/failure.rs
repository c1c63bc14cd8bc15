//! How the program ends badly, and how it prints.
//!
//! Exit codes: 0 done; 1 a run, or writing or printing its results, failed; 2 the input was wrong; 129, 130 and 143 a run was
//! ended by SIGHUP, SIGINT or SIGTERM. A reader that leaves (`| head -1`) has what it wanted: the work goes on, its files are
//! written, and the code is that of the work. Any other failure of standard output (`> /dev/full`) loses what somebody
//! asked for: the work goes on, too, and the code is 1.
//!
//! Titles, names and files are somebody else's: all that is printed goes through here, and nothing in it steers the terminal
//! ([`peridyne_io::excerpt`]).

use crate::signals::Signal;
use miette::{Diagnostic, LabeledSpan, SourceCode};
use peridyne_io::excerpt::{brief, plain, steers};
use std::fmt;
use std::io::{ErrorKind, Write};
use std::sync::Mutex;

pub enum Failure {
    /// The input is wrong; nothing was run or written.
    Input(miette::Report),
    /// The run, or writing its results, failed.
    Run(String),
    /// A signal ended the run; its last state is written.
    Ended(Signal),
    /// Another rank says what is wrong with the input.
    Elsewhere,
}

impl Failure {
    pub fn input(message: impl Into<String>) -> Failure {
        Failure::Input(miette::Report::msg(message.into()))
    }

    /// What went wrong, in one line.
    pub fn words(&self) -> String {
        match self {
            Failure::Input(report) => {
                let help = report.help().map(|help| format!(" ({help})"));
                format!("{report}{}", help.unwrap_or_default())
            }
            Failure::Run(message) => message.clone(),
            Failure::Ended(signal) => signal.to_string(),
            Failure::Elsewhere => "another rank says why".into(),
        }
    }

    pub fn report(self) -> u8 {
        match self {
            Failure::Input(report) => {
                // its colours are ours
                written(&format!("{:?}", miette::Report::new(Brief::of(report))));
                2
            }
            Failure::Run(message) => {
                note(&format!("error: {message}"));
                1
            }
            Failure::Elsewhere => 2,
            Failure::Ended(signal) => signal.exit_code(),
        }
    }
}

/// A mistake of the input in words that are safe to print; its source is an excerpt, which is so.
#[derive(Debug)]
struct Brief {
    message: String,
    help: Option<String>,
    report: miette::Report,
}

impl Brief {
    fn of(report: miette::Report) -> Brief {
        Brief {
            message: brief(&report.to_string()),
            help: report.help().map(|help| brief(&help.to_string())),
            report,
        }
    }
}

impl fmt::Display for Brief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Brief {}

impl Diagnostic for Brief {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let help = self.help.as_ref()?;
        Some(Box::new(help))
    }
    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.report.source_code()
    }
    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.report.labels()
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

/// JSON, which has its own way to write a character out.
pub fn json_text(value: &serde_json::Value) -> String {
    let mut out = String::new();
    for c in format!("{value:#}").chars() {
        match c != '\n' && steers(c) {
            true => out += &format!("\\u{:04x}", u32::from(c)),
            false => out.push(c),
        }
    }
    out
}

/// Print a line. After the first that does not get out nothing more is printed; [`printed`] says why.
pub fn say(text: &str) {
    let text = plain(text);
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

/// Print a line on standard error.
pub fn note(text: &str) {
    written(&brief(text));
}

/// There is nobody to tell when this fails.
fn written(text: &str) {
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
