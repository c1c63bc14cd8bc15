//! What a script has come to, for one that goes on: all that its commands since the first `run` do not say again.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

use peridyne::state::{Archive, Owner};

use super::Session;
use super::progress::Progress;
use crate::atoms::Members;
use crate::compute::ComputeKind;
use crate::dump::Dump;
use crate::error::Result;
use crate::files::{Folder, archive_path};
use crate::fix::average::Average;
use crate::fix::{FixKind, Start};
use crate::host::RunStart;
use crate::random::Ranmar;
use crate::rebuild::Rebuild;
use crate::record::{Record, Row};
use crate::variable::{Kind, Variables};
use peridyne_io::write::run_json::RigidNote;

/// Members of a group or of who has its own.
fn members(archive: &mut Archive<'_>, of: &mut Arc<Members>) {
    let mut some = match of.as_ref() {
        Members::All => None,
        Members::Some(bits) => Some(bits.clone()),
    };
    archive.option("members", &mut some, Vec::new, |bits, a| {
        a.list("bits", bits);
    });
    if archive.loads() {
        *of = Arc::new(some.map_or(Members::All, Members::Some));
    }
}

/// A name that must be that of the commands.
fn same(archive: &mut Archive<'_>, name: &str, mine: &str) {
    let mut text = mine.to_string();
    archive.text(name, &mut text);
    if archive.loads() && text != mine {
        archive.refuse(name);
    }
}

fn start(archive: &mut Archive<'_>, of: &mut Rc<Start>) {
    let mut start = of.as_ref().clone();
    archive.one("step", &mut start.step);
    archive.list("places", &mut start.places);
    archive.list("ids", &mut start.ids);
    *of = Rc::new(start);
}

/// Texts and numbers that are variables' own; formulas come of their commands.
fn kind(archive: &mut Archive<'_>, kind: &mut Kind) {
    let texts = |archive: &mut Archive<'_>, values: &mut Vec<String>| {
        archive.items("values", values, String::new, |text, a| {
            a.text("text", text);
        });
    };
    match kind {
        Kind::Index { values, at } => {
            texts(archive, values);
            archive.one("at", at);
        }
        Kind::File { values, at } => {
            let mut lines = values.to_vec();
            texts(archive, &mut lines);
            *values = lines.into();
            archive.one("at", at);
        }
        Kind::Loop {
            first,
            last,
            at,
            width,
        } => {
            for number in [first, last, at] {
                let mut bits = number.cast_unsigned();
                archive.one("number", &mut bits);
                *number = bits.cast_signed();
            }
            archive.one("width", width);
        }
        Kind::Text(text) => archive.text("text", text),
        Kind::Internal(number) => archive.one("number", number),
        Kind::Equal(_) | Kind::Atom(_) | Kind::Environment(_) | Kind::Format { .. } => {}
    }
}

/// A variable of a style, before its values are read; `None`: its command makes it.
fn empty(style: &str) -> Option<Kind> {
    Some(match style {
        "index" => Kind::Index {
            values: vec![],
            at: 0,
        },
        "file" => Kind::File {
            values: Rc::from([]),
            at: 0,
        },
        "loop" => Kind::Loop {
            first: 0,
            last: 0,
            at: 0,
            width: 0,
        },
        "string" => Kind::Text(String::new()),
        "internal" => Kind::Internal(0.0),
        _ => return None,
    })
}

impl Owner for Variables {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let names: Vec<String> = self.names().map(str::to_string).collect();
        let style = |name: &String| self.get(name).map_or("", Kind::style).to_string();
        let mut named: Vec<(String, String)> =
            names.iter().map(|n| (n.clone(), style(n))).collect();
        let none = || (String::new(), String::new());
        archive.items("names", &mut named, none, |(name, style), a| {
            a.text("name", name);
            a.text("style", style);
        });
        for name in names.iter().filter(|n| !named.iter().any(|(m, _)| m == *n)) {
            self.delete(name);
        }
        for (name, style) in named {
            if archive.loads()
                && let Some(kind) = empty(&style)
            {
                self.set(&name, kind);
            }
            match self.get_mut(&name).filter(|k| k.style() == style) {
                Some(found) => kind(archive, found),
                None => archive.refuse("variable"),
            }
        }
    }
}

impl Owner for Rebuild {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.list("held", &mut self.held);
        archive.one("ago", &mut self.ago);
        archive.one("farthest", &mut self.farthest);
        archive.one("path", &mut self.path);
        archive.one("lost", &mut self.lost);
        let mut example = self.example.map(|(id, axis, place)| ((id, axis), place));
        archive.one("example", &mut example);
        self.example = example.map(|((id, axis), place)| (id, axis, place));
    }
}

impl Owner for Average {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.one("next", &mut self.next);
        archive.one("taken", &mut self.taken);
        archive.lists("sum", &mut self.sum);
        archive.lists("total", &mut self.total);
        archive.one("outputs", &mut self.outputs);
        let mut window = Vec::from(std::mem::take(&mut self.window));
        archive.items("window", &mut window, Vec::new, |rows, a| {
            a.lists("rows", rows);
        });
        self.window = window.into();
        archive.lists("result", &mut self.result);
        archive.given("file", &mut self.file, |file, a| file.archive(a));
    }
}

impl Owner for Progress {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.one("step", &mut self.step);
        archive.one("begin", &mut self.begin);
        archive.one("end", &mut self.end);
        archive.one("first", &mut self.first);
        archive.one("time_step", &mut self.time_step);
        archive.one("time_base", &mut self.time_base);
        archive.one("seconds", &mut self.stepping_seconds);
        archive.one("steps", &mut self.steps_done);
        archive.one("counted", &mut self.counted);
        self.whole = None;
        self.started.get_or_insert_with(Instant::now);
    }
}

impl Owner for Record {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.items("columns", &mut self.columns, String::new, |name, a| {
            a.text("name", name);
        });
        let none = || Row {
            step: 0,
            time: 0.0,
            values: vec![],
        };
        archive.items("rows", &mut self.rows, none, |row, a| {
            a.one("step", &mut row.step);
            a.one("time", &mut row.time);
            a.list("values", &mut row.values);
        });
        let known = Record::FIELDS;
        let none = || (String::new(), known[0]);
        archive.items("fields", &mut self.fields, none, |(heading, field), a| {
            a.text("heading", heading);
            let mut name = (*field).to_string();
            a.text("field", &mut name);
            match known.into_iter().find(|k| *k == name) {
                Some(found) => *field = found,
                None => a.refuse("field"),
            }
        });
        archive.items("notes", &mut self.notes, RigidNote::default, |note, a| {
            note.archive(a);
        });
    }
}

/// Of a dump, what its commands do not say.
fn dump(archive: &mut Archive<'_>, dump: &mut Dump, folder: &Folder) {
    same(archive, "dump", &dump.id);
    members(archive, &mut dump.members);
    if let Some((_, next)) = &mut dump.every_variable {
        archive.one("next", next);
    }
    archive.one("last", &mut dump.last_written);
    archive.option(
        "file",
        &mut dump.writer,
        || folder.waiting(),
        |file, a| {
            file.archive(a);
        },
    );
}

impl Session<'_> {
    /// Passes everything but the model, and the numbers that are drawn after it.
    pub fn archive(&mut self, archive: &mut Archive<'_>) {
        self.archive_atoms(archive);
        archive.part("progress", &mut self.progress);
        if let Some(domain) = &mut self.space.domain {
            archive.all("low", &mut domain.low);
            archive.all("high", &mut domain.high);
        }
        let all = || (String::new(), Arc::new(Members::All));
        archive.items("groups", &mut self.population.groups, all, |group, a| {
            a.text("name", &mut group.0);
            members(a, &mut group.1);
        });
        archive.part("neighbors", &mut self.neighbors.rebuild);
        archive.part("variables", &mut self.formulas.variables);
        archive.part("folder", &mut self.folder);
        self.archive_fixes(archive);
        let mut count = self.watch.computes.len();
        archive.same("computes", &mut count);
        for compute in &mut self.watch.computes {
            same(archive, "compute", &compute.id);
            members(archive, &mut compute.members);
            archive.one("counted", &mut compute.counted);
            if let ComputeKind::Displace { start: from } = &mut compute.kind {
                start(archive, from);
            }
        }
        let mut count = self.watch.dumps.len();
        archive.same("dumps", &mut count);
        for each in &mut self.watch.dumps {
            dump(archive, each, &self.folder);
        }
        archive.part("record", &mut self.watch.record);
        let (dumps, home) = (&mut self.watch.record.dumps, &self.folder.output);
        archive.items("written", dumps, Default::default, |path, a| {
            archive_path(a, home, path);
        });
        self.console.archive(&self.folder, archive);
    }

    /// Which atoms are left; those that were lost since the first `run` go.
    fn archive_atoms(&mut self, archive: &mut Archive<'_>) {
        let count = self.population.count();
        let all: Vec<u64> = (0..count).map(|i| self.population.ids.get(i)).collect();
        let mut left = all.clone();
        archive.list("atoms", &mut left);
        if !archive.loads() || left == all {
            return;
        }
        let lost = |i: &u32| left.binary_search(&all[*i as usize]).is_err();
        let gone: Vec<u32> = (0..count as u32).filter(lost).collect();
        if self.remove(&gone).is_err() || self.population.count() != left.len() {
            archive.refuse("atoms");
        }
    }

    fn archive_fixes(&mut self, archive: &mut Archive<'_>) {
        let mut count = self.fixes.all.len();
        archive.same("fixes", &mut count);
        for fix in &mut self.fixes.all {
            same(archive, "fix", &fix.id);
            let mut now = fix.as_ref().clone();
            members(archive, &mut now.members);
            match &mut now.kind {
                FixKind::Move { start: from, .. } => start(archive, from),
                FixKind::Print { file, .. } => archive.given("file", file, |file, a| {
                    file.borrow_mut().archive(a);
                }),
                FixKind::Average(average) => average.borrow_mut().archive(archive),
                FixKind::Nve
                | FixKind::Indent { .. }
                | FixKind::SetForce { .. }
                | FixKind::AddForce { .. }
                | FixKind::Viscous(_)
                | FixKind::Enforce2d
                | FixKind::Reflect(_)
                | FixKind::Momentum { .. } => {}
            }
            if archive.loads() {
                *fix = Rc::new(now);
            }
        }
    }

    /// The numbers that formulas draw.
    pub fn archive_random(&mut self, archive: &mut Archive<'_>) {
        for generator in &mut self.formulas.random {
            let made = || Rc::new(RefCell::new(Ranmar::default()));
            archive.option("random", generator, made, |generator, a| {
                generator.borrow_mut().archive(a);
            });
        }
    }

    /// The model is about to read the state of a run that has this one's fixes.
    ///
    /// # Errors
    /// A value is not there; the model has no states.
    pub fn await_state(&mut self) -> Result<()> {
        let mut conditions = vec![];
        self.conditions(&mut conditions)?;
        let start = RunStart {
            step: self.progress.begin,
            steps: self.progress.end - self.progress.begin,
            time_step: self.progress.time_step,
            moving: self.moving(),
            kinematic: self.kinematic(),
            domain: *self.space.domain()?,
        };
        Ok(self.population.engine()?.await_state(&start, &conditions)?)
    }

    /// All files go on, and what acts is what acted.
    ///
    /// # Errors
    /// A file is not as it was; a value is not there.
    pub fn take_up(&mut self) -> Result<()> {
        self.folder.dry = false;
        self.folder.cut_back();
        self.console.go_on()?;
        for file in self
            .watch
            .dumps
            .iter_mut()
            .filter_map(|d| d.writer.as_mut())
        {
            file.go_on()?;
        }
        for fix in &self.fixes.all {
            match &fix.kind {
                FixKind::Print {
                    file: Some(file), ..
                } => file.borrow_mut().go_on()?,
                FixKind::Average(average) => {
                    if let Some(file) = &mut average.borrow_mut().file {
                        file.go_on()?;
                    }
                }
                FixKind::Print { file: None, .. }
                | FixKind::Nve
                | FixKind::Indent { .. }
                | FixKind::SetForce { .. }
                | FixKind::AddForce { .. }
                | FixKind::Viscous(_)
                | FixKind::Enforce2d
                | FixKind::Move { .. }
                | FixKind::Reflect(_)
                | FixKind::Momentum { .. } => {}
            }
        }
        let mut acting = vec![];
        self.conditions(&mut acting)?;
        self.watch.record.stand(&acting);
        self.fixes.acting = acting;
        Ok(())
    }
}
