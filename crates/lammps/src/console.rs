//! What a script prints: on the screen, and into the file of its `log` command.

use super::error::{Problem, Result};
use super::files::Sink;
use super::host::Console;

pub struct Output<'a> {
    screen: &'a mut dyn Console,
    log: Option<Sink>,
    /// Why the log could not be written.
    failed: Option<Box<Problem>>,
}

impl<'a> Output<'a> {
    pub fn new(screen: &'a mut dyn Console) -> Self {
        Output {
            screen,
            log: None,
            failed: None,
        }
    }

    /// Lines go into this file, too, from now on.
    pub fn log(&mut self, log: Option<Sink>) {
        self.log = log;
    }

    /// A line of LAMMPS's screen output.
    pub fn print(&mut self, line: &str) {
        self.screen.print(line);
        self.write(line);
    }

    /// Something worth knowing that is no error.
    pub fn note(&mut self, line: &str) {
        self.screen.note(line);
        self.write(&format!("note: {line}"));
    }

    pub fn progress(&mut self, done: u64, of: u64) {
        self.screen.progress(done, of);
    }

    /// Did somebody ask for the end?
    pub fn ended(&mut self) -> bool {
        self.screen.ended()
    }

    fn write(&mut self, line: &str) {
        if let Some(log) = &mut self.log
            && let Err(p) = log.line(line).and_then(|()| log.flush())
        {
            self.log = None;
            self.failed = Some(p);
        }
    }

    /// Was everything written so far?
    ///
    /// # Errors
    /// The log could not be written.
    pub fn check(&mut self) -> Result<()> {
        self.failed.take().map_or(Ok(()), Err)
    }
}
