//! What a script prints: on the screen, and into the file of its `log` command.

use super::error::{Problem, Result};
use super::files::{Folder, Sink};
use super::host::{Console, Wish};
use peridyne::state::{Archive, Owner};

pub struct Output<'a> {
    /// `None` while it is asked for something else.
    screen: Option<&'a mut dyn Console>,
    /// What is repeated is not said again.
    pub quiet: bool,
    log: Option<Sink>,
    /// Why the log could not be written.
    failed: Option<Box<Problem>>,
}

impl<'a> Output<'a> {
    pub fn new(screen: &'a mut dyn Console) -> Self {
        Output {
            screen: Some(screen),
            quiet: false,
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
        if let Some(screen) = self.screen.as_mut().filter(|_| !self.quiet) {
            screen.print(line);
            self.write(line);
        }
    }

    /// Something worth knowing that is no error.
    pub fn note(&mut self, line: &str) {
        if let Some(screen) = self.screen.as_mut().filter(|_| !self.quiet) {
            screen.note(line);
            self.write(&format!("note: {line}"));
        }
    }

    /// Something about the state: on the screen alone, as files know of no states.
    pub fn tell(&mut self, line: &str) {
        if let Some(screen) = &mut self.screen {
            screen.note(line);
        }
    }

    pub fn progress(&mut self, done: u64, of: u64) {
        if let Some(screen) = &mut self.screen {
            screen.progress(done, of);
        }
    }

    /// Did somebody ask for the end?
    pub fn ended(&mut self) -> bool {
        self.screen.as_mut().is_some_and(|screen| screen.ended())
    }

    /// What is wanted of the state after so many steps?
    pub fn wish(&mut self, steps: u64) -> Wish {
        match &mut self.screen {
            Some(screen) => screen.wish(steps),
            None => Wish::Nothing,
        }
    }

    /// Whoever keeps states; [`Output::give_back`] ends the loan.
    pub fn lend(&mut self) -> Option<&'a mut dyn Console> {
        self.screen.take()
    }

    pub fn give_back(&mut self, screen: &'a mut dyn Console) {
        self.screen = Some(screen);
    }

    /// The file of `log`.
    pub fn archive(&mut self, folder: &Folder, archive: &mut Archive<'_>) {
        archive.option(
            "log",
            &mut self.log,
            || folder.waiting(),
            |log, a| log.archive(a),
        );
    }

    /// Goes on with it.
    ///
    /// # Errors
    /// It is not as it was.
    pub fn go_on(&mut self) -> Result<()> {
        self.quiet = false;
        self.log.as_mut().map_or(Ok(()), Sink::go_on)
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
