//! Long text, page by page where somebody sits at a terminal.

use crate::failure::{note, say};
use peridyne_io::excerpt::plain;
use std::io::{IsTerminal, Write};
use std::process::{Command, Stdio};

/// What is run where `PAGER` says nothing: `less`, which ends at once if the text fits, keeps colours and leaves it on the screen.
const USUAL: [&str; 2] = ["less", "-FRX"];

/// How a long text is shown.
#[derive(clap::Args, Debug, Clone, Copy, Default)]
pub struct Paged {
    /// Print all at once at a terminal, too; so does the environment variable NO_PAGER. Else $PAGER shows it, or less.
    #[arg(long)]
    pub no_pager: bool,
}

impl Paged {
    /// Prints a text; at a terminal through a pager.
    pub fn show(self, text: &str) {
        let text = text.trim_end();
        let set = |name: &str| std::env::var(name).ok();
        let asked = !self.no_pager && set("NO_PAGER").is_none_or(|no| no.is_empty());
        if !asked || !std::io::stdout().is_terminal() {
            return say(text);
        }
        let pager = set("PAGER");
        let words: Vec<&str> = match &pager {
            Some(pager) => pager.split_whitespace().collect(),
            None => USUAL.to_vec(),
        };
        // an empty PAGER is none, as man and git have it
        let shown = words
            .split_first()
            .is_some_and(|(program, rest)| through(program, rest, text, pager.is_some()));
        if !shown {
            say(text);
        }
    }
}

/// Did this program show the text? One that was asked for by name and is not there is told.
fn through(program: &str, words: &[&str], text: &str, named: bool) -> bool {
    let mut command = Command::new(program);
    command.args(words).stdin(Stdio::piped());
    if std::env::var_os("LESS").is_none() {
        command.env("LESS", "FRX");
    }
    let mut pager = match command.spawn() {
        Ok(pager) => pager,
        Err(e) => {
            if named {
                note(&format!("PAGER={program} cannot be started: {e}"));
            }
            return false;
        }
    };
    if let Some(mut into) = pager.stdin.take() {
        // who has seen enough leaves before the end
        let _ = writeln!(into, "{}", plain(text));
    }
    // it holds the terminal until its reader leaves
    let _ = pager.wait();
    true
}
