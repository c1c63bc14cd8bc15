//! Scripts that go on: from the end of a step of a `run` that is a command of its own, or from between two commands.
//!
//! A script that goes on is read anew up to its first `run`, which builds the model and does not step; nothing is written and
//! printed. What has been defined since is defined again by the commands that did it, with the values that their variables had. Then
//! the state is read: the model, and all that has a history. Files are cut back to it.

use std::path::Path;

use peridyne::state::{Archive, Owner};

use crate::command::RunPlan;
use crate::error::{Problem, Result};
use crate::host::Wish;
use crate::input;
use crate::script::{Script, Source};
use crate::session::{Session, Store};
use crate::text::Text;

/// Commands since the first `run` that a script has at most, if it is to go on.
const MOST: usize = 1 << 20;

/// Commands that leave nothing but what is in the state, or in files.
const PASSING: [&str; 11] = [
    "delete_atoms",
    "displace_atoms",
    "info",
    "read_dump",
    "reset_timestep",
    "set",
    "timestep",
    "velocity",
    "write_data",
    "write_dump",
    "log",
];

/// Where a script is.
#[derive(Default)]
pub struct Position {
    /// Files that are being read, the innermost last, and the next line of each.
    sources: Vec<(String, usize)>,
    skip_jump: bool,
    /// The step at which the `run` ends that was left, and whether it reports.
    within: Option<(u64, bool)>,
}

impl Owner for Position {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let none = || (String::new(), 0);
        archive.items("sources", &mut self.sources, none, |(path, next), a| {
            a.text("path", path);
            a.one("next", next);
        });
        archive.one("skip_jump", &mut self.skip_jump);
        archive.one("within", &mut self.within);
    }
}

/// The model, and what is drawn after it.
fn pass_model(session: &mut Session<'_>, archive: &mut Archive<'_>) {
    match &mut session.population.store {
        Store::Engine(engine) => engine.archive(archive),
        Store::Atoms(_) => archive.refuse("model"),
    }
    session.archive_random(archive);
}

impl Session<'_> {
    /// Notes a command that has been done, for a script that goes on.
    pub fn note_command(&mut self, name: &str, line: &str) {
        if self.from.is_some() || self.console.quiet || PASSING.contains(&name) {
            return;
        }
        if let Store::Engine(_) = self.population.store {
            match self.commands.len() < MOST {
                true => self.commands.push(line.to_string()),
                false => self.lasting = Some("after more than a million commands"),
            }
        }
    }
}

impl Script<'_> {
    /// Can the script not go on from here, and why? That of `lasting` stays so.
    fn refused(&self) -> Option<&'static str> {
        let nested = self.depth > 1;
        let inside = [
            (self.session.progress.whole.is_some(), "inside `run every`"),
            (nested, "inside a command of `if`"),
        ];
        let inside = inside.into_iter().find(|(is, _)| *is);
        self.session.lasting.or(inside.map(|(_, why)| why))
    }

    /// After a step, of a `run` to `within` that reports or not, or after a command: is the state wanted, and the end?
    ///
    /// # Errors
    /// The script ends here.
    pub fn look_for_wish(&mut self, within: Option<(u64, bool)>) -> Result<()> {
        let s = &mut self.session;
        if !matches!(s.population.store, Store::Engine(_)) {
            return Ok(());
        }
        let ended = within.is_some() && s.console.ended();
        let refused = self.refused();
        let s = &mut self.session;
        // what is asked for waits for the next place, unless none will come
        let wish = match (ended, refused, s.lasting) {
            (true, _, _) => Wish::End,
            (false, Some(_), None) => Wish::Nothing,
            (false, _, _) => s.console.wish(s.progress.steps_done),
        };
        if wish == Wish::Nothing {
            return Ok(());
        }
        match refused {
            Some(why) => {
                let said = match wish {
                    Wish::End => "the script cannot go on from here",
                    Wish::Nothing | Wish::State => "no state to go on from is written",
                };
                // of states that are asked for again and again, once
                if wish == Wish::End || !std::mem::replace(&mut s.told, true) {
                    s.console.tell(&format!("cannot stop {why}: {said}"));
                }
            }
            None => self.keep(within),
        }
        match wish {
            Wish::End => {
                self.session.ended = true;
                Err(Problem::new("ended from outside"))
            }
            Wish::Nothing | Wish::State => Ok(()),
        }
    }

    /// Hands the state to whoever keeps it.
    fn keep(&mut self, within: Option<(u64, bool)>) {
        let mut position = Position {
            sources: self.open.iter().map(|s| (s.path.clone(), s.next)).collect(),
            skip_jump: self.skip_jump,
            within,
        };
        let s = &mut self.session;
        let Some(screen) = s.console.lend() else {
            return;
        };
        let mut commands = std::mem::take(&mut s.commands);
        screen.keep(s.progress.steps_done, &mut |archive| {
            archive.items("commands", &mut commands, String::new, |line, a| {
                a.text("line", line);
            });
            s.archive(archive);
            pass_model(s, archive);
            archive.part("position", &mut position);
        });
        s.commands = commands;
        s.console.give_back(screen);
    }

    /// At the first `run` of a script that goes on. That it has come to where it was is an "error", which leads out of the commands that
    /// were repeated.
    ///
    /// # Errors
    /// Always; [`Session::from`] is then none, and [`Session::went_on`] says whether all went well.
    pub fn go_on(&mut self, plan: &RunPlan) -> Result<()> {
        let Some(from) = self.session.from.take() else {
            return Ok(());
        };
        let wrong = |e: peridyne_io::write::checkpoint::ResumeError| Problem::new(e.to_string());
        self.session.build_first(plan)?;
        let mut commands = vec![];
        from.load(|archive| {
            archive.items("commands", &mut commands, String::new, |line, a| {
                a.text("line", line);
            });
        })
        .map_err(wrong)?;
        for command in &commands {
            let mut line = Text::default();
            line.push_str(command, 0);
            self.session.repeat(&line)?;
        }
        let s = &mut self.session;
        from.load(|archive| s.archive(archive)).map_err(wrong)?;
        s.await_state()?;
        let mut position = Position::default();
        from.load(|archive| {
            pass_model(s, archive);
            archive.part("position", &mut position);
        })
        .map_err(wrong)?;
        s.take_up()?;
        s.commands = commands;
        self.skip_jump = position.skip_jump;
        self.within = position.within;
        self.open = self.reopened(&position.sources)?;
        self.session.went_on = true;
        Err(Problem::new("the script goes on from its state"))
    }

    fn reopened(&self, sources: &[(String, usize)]) -> Result<Vec<Source>> {
        let mut all = vec![];
        for (path, next) in sources {
            let known = self.open.iter().find(|s| s.path == *path);
            let text = match known {
                Some(source) => source.text.to_string(),
                None => input::text(Path::new(path), path)?,
            };
            let mut source = Source::new(path, &text);
            source.next = *next;
            all.push(source);
        }
        Ok(all)
    }

    /// What is left of the `run` that was left.
    ///
    /// # Errors
    /// As for a `run`.
    pub fn finish_run(&mut self) -> Result<()> {
        let Some((end, report)) = self.within.take() else {
            return Ok(());
        };
        self.depth += 1;
        let done = self.run_until(end, report);
        self.depth -= 1;
        done
    }
}
