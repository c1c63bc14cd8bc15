//! Units, dimension, boundaries, time step; commands without effect here.

use super::Args;
use crate::domain::Face;
use crate::error::{Problem, Result};
use crate::fix::{Fix, FixKind};
use crate::session::{Session, Store};
use crate::text::Word;
use crate::units::Units;

impl Session<'_> {
    fn before_box(&self, args: &Args) -> Result<()> {
        match self.space.domain {
            None => Ok(()),
            Some(_) => Err(Problem::new(format!(
                "`{}` must come before the simulation box",
                args.command.as_str()
            ))
            .help("move it above `create_box` or `read_data`")),
        }
    }

    pub(super) fn set_units(&mut self, args: &mut Args) -> Result<()> {
        let word = args.next("a system of units")?;
        let found = Units::ALL.iter().find(|(n, _)| *n == word.as_str());
        let names = Units::ALL.iter().map(|(n, _)| *n);
        self.space.units = found
            .ok_or_else(|| args.unknown(word, "the system of units", names))?
            .1;
        self.before_box(args)?;
        self.progress.time_step = self.space.units.time_step();
        self.neighbors.skin = self.space.units.skin();
        args.finish()
    }

    pub(super) fn set_dimension(&mut self, args: &mut Args) -> Result<()> {
        let word = args.next("2 or 3")?;
        self.space.dimension = match word.as_str() {
            "2" => 2,
            "3" => 3,
            _ => return Err(args.unknown(word, "the dimension", ["2", "3"])),
        };
        self.before_box(args)?;
        args.finish()
    }

    pub(super) fn set_boundary(&mut self, args: &mut Args) -> Result<()> {
        for a in 0..3 {
            let word = args.next("three of p, f, s, m (or pairs like fs)")?;
            let faces: Option<Vec<Face>> = word.as_str().chars().map(Face::parse).collect();
            self.space.faces[a] = match faces.as_deref() {
                Some([f]) => [*f, *f],
                Some([low, high]) if (*low == Face::Periodic) == (*high == Face::Periodic) => {
                    [*low, *high]
                }
                _ => {
                    return Err(args.unknown(
                        word,
                        "the boundary",
                        ["p", "f", "s", "m", "fs", "fm", "sf", "sm", "mf", "ms"],
                    ));
                }
            };
        }
        self.before_box(args)?;
        args.finish()
    }

    pub(super) fn set_atom_style(&mut self, args: &mut Args) -> Result<()> {
        let word = args.next("`peri`")?;
        if word.as_str() != "peri" {
            return Err(args.unknown(word, "the atom style", ["peri"]));
        }
        self.before_box(args)?;
        self.space.atom_style = true;
        args.finish()
    }

    pub(super) fn set_timestep(&mut self, args: &mut Args) -> Result<()> {
        let step = args.positive("the time step")?;
        args.finish()?;
        // time counts on from here with the new step
        self.progress.time_base = (self.progress.step, self.progress.time());
        self.progress.time_step = step;
        Ok(())
    }

    pub(super) fn reset_timestep(&mut self, args: &mut Args) -> Result<()> {
        let step = args.count("the new step", 0)?;
        // forwards, the time goes on with the steps
        let forwards = step.checked_sub(self.progress.step);
        let counted = match forwards {
            Some(n) => self.progress.time() + n as f64 * self.progress.time_step,
            None => step as f64 * self.progress.time_step,
        };
        let time = if args.eat("time") {
            args.number("the new time")?
        } else {
            counted
        };
        args.finish()?;
        let counts =
            |f: &&std::rc::Rc<Fix>| matches!(f.kind, FixKind::Average(_) | FixKind::Move { .. });
        if let Some(fix) = self.fixes.all.iter().find(counts) {
            return Err(Problem::new(format!(
                "fix `{}` counts steps: they cannot be set anew",
                fix.id
            ))
            .help("`unfix` it before, and define it again afterwards"));
        }
        self.progress.step = step;
        self.progress.time_base = (step, time);
        for dump in &mut self.watch.dumps {
            dump.last_written = None;
        }
        Ok(())
    }

    pub(super) fn set_neighbor(&mut self, args: &mut Args) -> Result<()> {
        self.neighbors.skin = args.number("the skin")?;
        if self.neighbors.skin < 0.0 {
            return Err(Problem::new("the skin must not be negative"));
        }
        let word = args.next("`bin`, `nsq` or `multi`")?;
        if !["bin", "nsq", "multi"].contains(&word.as_str()) {
            return Err(args.unknown(word, "the style", ["bin", "nsq", "multi"]));
        }
        args.finish()
    }

    /// `neigh_modify`: when lists are rebuilt decides when atoms are lost, and when the box follows them.
    pub(super) fn neigh_modify(&mut self, args: &mut Args) -> Result<()> {
        args.next("an option")?;
        args.back();
        while let Some(word) = args.optional() {
            match word.as_str() {
                "every" => self.neighbors.schedule.every = args.count("the number of steps", 1)?,
                "delay" => self.neighbors.schedule.delay = args.count("the number of steps", 0)?,
                "check" => self.neighbors.schedule.check = args.yes("check")?,
                "once" => self.neighbors.schedule.once = args.yes("once")?,
                // how lists are stored
                "one" | "page" | "binsize" | "cluster" | "include" => {
                    args.next("a value")?;
                }
                "exclude" => {
                    return Err(Problem::at(
                        word.span,
                        "`neigh_modify exclude` would change the forces, it is not supported",
                    ));
                }
                _ => {
                    let known = ["every", "delay", "check", "once", "one", "page", "binsize"];
                    return Err(args.unknown(word, "the option", known));
                }
            }
        }
        self.console
            .note("`neigh_modify` decides only when the box follows the atoms, and when atoms outside fixed faces are lost");
        Ok(())
    }

    /// `log NAME [append]`, `log none`: what is printed goes into a file, too.
    pub(super) fn set_log(&mut self, args: &mut Args) -> Result<()> {
        let name = args.next("a file name, or none")?;
        let append = args.eat("append");
        args.finish()?;
        // the one before ends, also if it goes on in the same file
        self.console.log(None);
        let log = match name.as_str() {
            "none" => None,
            file => {
                let opened = self.folder.open(file, append);
                Some(opened.map_err(|p| p.or_at(name.span))?)
            }
        };
        self.console.log(log);
        Ok(())
    }

    /// Takes `/omp`, `/opt` and the like off a style: they say how LAMMPS computes, not what.
    pub fn without_suffix(&mut self, words: &mut [Word]) {
        let place = match words.first().map(Word::as_str) {
            Some("pair_style" | "atom_style" | "run_style") => 1,
            Some("fix" | "compute") => 3,
            _ => return,
        };
        let Some(word) = words.get_mut(place) else {
            return;
        };
        let text = word.as_str();
        let known = [
            "/omp",
            "/opt",
            "/kk",
            "/kk/host",
            "/kk/device",
            "/gpu",
            "/intel",
        ];
        let Some(plain) = known.iter().find_map(|s| text.strip_suffix(s)) else {
            return;
        };
        let (length, note) = (plain.len(), format!("`{text}` is taken as `{plain}`"));
        word.text = word.text.slice(0, length);
        self.console.note(&note);
    }

    /// Commands about how LAMMPS computes, not what.
    pub(super) fn without_effect(&mut self, args: &mut Args) -> Result<()> {
        let name = args.command.as_str();
        args.next("an argument")?;
        if name == "run_style" {
            args.back();
            let style = args.next("`verlet`")?;
            if style.as_str() != "verlet" {
                return Err(args.unknown(style, "the run style", ["verlet"]));
            }
        }
        if name != "run_style" {
            args.back();
        }
        while args.optional().is_some() {}
        self.console.note(&format!("`{name}` has no effect here"));
        Ok(())
    }

    pub(super) fn info(&mut self) -> Result<()> {
        let held = match &self.population.store {
            Store::Atoms(_) => "not built yet".to_string(),
            Store::Engine(e) => format!(
                "{} directed bonds, {} bytes",
                e.directed_bonds(),
                e.memory_bytes()
            ),
        };
        let lines = [
            format!("Units = {}", self.space.units.name()),
            format!("Dimension = {}", self.space.dimension),
            format!(
                "Atoms = {}, types = {}",
                self.population.count(),
                self.population.types
            ),
            format!(
                "Box = {}",
                self.space
                    .domain
                    .as_ref()
                    .map_or("none".into(), |d| d.describe())
            ),
            format!("Model = {held}"),
        ];
        for line in lines {
            self.console.print(&line);
        }
        Ok(())
    }
}
