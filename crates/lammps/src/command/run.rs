//! `run`: builds the model and steps it.

use std::time::Instant;

use peridyne::error::size;
use peridyne_io::write::space::free;

use super::Args;
use crate::atoms::Atoms;
use crate::error::{Problem, Result};
use crate::host::{RunStart, Setup, Style};
use crate::printf::general;
use crate::script::Script;
use crate::session::{PairState, Session, Store};
use crate::text::{Text, Word, words};

/// What a `run` command asks for.
pub struct RunPlan {
    pub steps: u64,
    pub setup: bool,
    pub report: bool,
    /// Commands after every so many steps.
    pub every: Option<(u64, Vec<Word>)>,
}

impl Session<'_> {
    /// Reads `N [upto] [pre yes|no] [post yes|no] [every M "command" ...]`.
    ///
    /// # Errors
    /// Wrong arguments.
    pub fn run_plan(&self, args: &mut Args) -> Result<RunPlan> {
        self.space.domain()?;
        let mut plan = RunPlan {
            steps: args.count("the number of steps", 0)?,
            setup: true,
            report: true,
            every: None,
        };
        while let Some(word) = args.optional() {
            match word.as_str() {
                "upto" => {
                    plan.steps = plan.steps.checked_sub(self.progress.step).ok_or_else(|| {
                        Problem::at(
                            word.span,
                            format!(
                                "step {} has passed: now is step {}",
                                plan.steps, self.progress.step
                            ),
                        )
                    })?;
                }
                "pre" => plan.setup = args.yes("pre")?,
                "post" => plan.report = args.yes("post")?,
                "every" => {
                    let every = args.count("the number of steps", 1)?;
                    let mut commands = Vec::new();
                    while let Some(word) = args.optional() {
                        commands.push(word.clone());
                    }
                    commands.retain(|c| c.as_str() != "NULL");
                    plan.every = Some((every, commands));
                }
                _ => {
                    return Err(args.unknown(word, "the option", ["upto", "pre", "post", "every"]));
                }
            }
        }
        Ok(plan)
    }

    /// Makes the engine at the first run.
    ///
    /// # Errors
    /// Something is missing, or the host refuses.
    pub fn build(&mut self) -> Result<()> {
        if let Store::Engine(_) = self.population.store {
            return Ok(());
        }
        if self.population.count() == 0 {
            return Err(Problem::new("there are no atoms")
                .help("write `create_atoms` or `read_data` before"));
        }
        let Some(PairState { style, values }) = &self.pairs.state else {
            return Err(Problem::new("there is no pair style").help(format!(
                "write `pair_style` with one of {}, and `pair_coeff`, before `run`",
                Style::ALL.map(Style::name).join(", ")
            )));
        };
        let pair = style.pair(self.population.types, values);
        let pair = pair.ok_or_else(|| {
            let missing = self.pairs_missing();
            Problem::new(format!(
                "some pairs of atom types have no coefficients: {missing}"
            ))
            .help("nothing is mixed, as in LAMMPS: write `pair_coeff I J ...` for each pair, or `pair_coeff * * ...`, before `run`")
        })?;
        let lattice = self.space.lattice.as_ref().ok_or_else(|| {
            Problem::new("the pair styles peri/* need the lattice constant")
                .help("write `lattice sc CONSTANT` before `run`")
        })?;
        let lattice_constant = lattice.constant;
        let domain = *self.space.domain()?;
        let atoms = std::mem::take(self.population.atoms()?);
        let setup = Setup {
            title: self.title.clone(),
            dimension: self.space.dimension,
            units: self.space.units,
            domain,
            lattice_constant,
            time_step: self.progress.time_step,
            steps: self.progress.end - self.progress.begin,
            atoms,
            pair,
        };
        self.population.store = Store::Atoms(Atoms::default());
        let types = self.population.types;
        self.population.store = Store::Engine(self.host.build(setup).map_err(|e| {
            let place = e
                .pair
                .and_then(|(i, j)| self.pairs.places.get((i - 1) * types + j - 1).cloned());
            let mut problem = Box::<Problem>::from(e);
            problem.place = place.unwrap_or(problem.place);
            problem
        })?);
        Ok(())
    }

    /// Builds the model of a script that goes on, as its first `run` did.
    ///
    /// # Errors
    /// As [`Session::build`].
    pub fn build_first(&mut self, plan: &RunPlan) -> Result<()> {
        let steps = match &plan.every {
            Some((every, _)) => plan.steps.min(*every),
            None => plan.steps,
        };
        self.progress.begin = self.progress.step;
        self.progress.end = self.progress.step + steps;
        self.nobody_twice()?;
        self.rebuild()?;
        self.count_atoms();
        self.build()
    }

    /// Does a command again whose variables have their values.
    ///
    /// # Errors
    /// Those of the command.
    pub fn repeat(&mut self, line: &Text) -> Result<()> {
        let mut words = words(line)?;
        self.without_suffix(&mut words);
        match words.split_first() {
            Some((command, rest)) => self.command(Args::new(command, rest)),
            None => Ok(()),
        }
    }

    /// Has the disk room for the dumps of so many steps?
    fn room_for_dumps(&self, steps: u64) -> Result<()> {
        let atoms = self.population.count();
        for dump in &self.watch.dumps {
            let path = self.folder.path(&dump.file)?;
            let (bytes, left) = (
                dump.bytes(steps, atoms),
                free(path.parent().unwrap_or(&path)),
            );
            if let Some(left) = left.filter(|left| bytes > *left) {
                return Err(Problem::new(format!(
                    "{steps} steps would write about {} into the dump `{}`, {}; the disk has {} left",
                    size(bytes),
                    dump.id,
                    path.display(),
                    size(left)
                ))
                .help("write more steps between snapshots, fewer columns or atoms, or give --out on another disk"));
            }
        }
        Ok(())
    }

    /// Start of a run: bonds, forces, first output.
    ///
    /// # Errors
    /// Something is missing, or the state is bad.
    pub fn start_run(&mut self, plan: &RunPlan) -> Result<()> {
        self.progress.begin = self.progress.step;
        self.progress.end = self.progress.step + plan.steps;
        self.nobody_twice()?;
        self.room_for_dumps(plan.steps)?;
        // forces have to be known once, whatever `pre` says
        let setup = plan.setup || self.progress.started.is_none();
        if setup {
            // atoms outside are lost before there are bonds
            self.rebuild()?;
            self.count_atoms();
        }
        self.build()?;
        if self.moving().is_none() && plan.steps > 0 {
            self.console.note("no `fix nve`: the atoms will not move");
        }
        if setup {
            self.print("Setting up Verlet run ...");
            self.print(&format!("  Unit style    : {}", self.space.units.name()));
            self.print(&format!("  Current step  : {}", self.progress.step));
            let dt = general(self.progress.time_step, 6, false);
            self.print(&format!("  Time step     : {dt}"));
            let mut conditions = std::mem::take(&mut self.fixes.acting);
            self.conditions(&mut conditions)?;
            let start = RunStart {
                step: self.progress.step,
                steps: plan.steps,
                time_step: self.progress.time_step,
                moving: self.moving(),
                kinematic: self.kinematic(),
                domain: *self.space.domain()?,
            };
            let atoms = self.population.count();
            let wanted = self.pressure_wanted();
            let stress = self.stress_wanted();
            let engine = self.population.engine()?;
            if wanted {
                engine.expect_virial();
            }
            if stress {
                engine.expect_virials();
            }
            engine.setup(&start, &conditions)?;
            self.fixes.acting = conditions;
            let engine = self.population.engine()?;
            let (bonds, bytes) = (engine.directed_bonds(), engine.memory_bytes());
            for note in engine.notes() {
                self.console.note(&note);
            }
            if self.progress.steps_done == 0 && self.progress.started.is_none() {
                let mean = general(bonds as f64 / atoms.max(1) as f64, 6, false);
                self.print(&format!(
                    "Peridynamic bonds:\n  total # of bonds = {bonds}\n  bonds/atom = {mean}"
                ));
            }
            let mib = general(bytes as f64 / (1u64 << 20) as f64, 4, false);
            self.print(&format!(
                "Per MPI rank memory allocation (min/avg/max) = {mib} | {mib} | {mib} Mbytes"
            ));
        }
        self.progress.started = Some(Instant::now());
        Ok(())
    }

    /// The atoms that temperatures count until the next set-up.
    fn count_atoms(&mut self) {
        let all = self.population.count();
        self.progress.counted = Some(all);
        for compute in &mut self.watch.computes {
            compute.counted = Some(compute.members.count(all));
        }
    }

    /// Output at the start of a run.
    ///
    /// # Errors
    /// A value or a file is not there.
    pub fn first_output(&mut self) -> Result<()> {
        self.thermo_header();
        self.write_dumps(true)?;
        self.thermo_line()
    }

    fn print(&mut self, line: &str) {
        self.console.print(line);
    }

    /// The line after a run.
    pub fn end_run(&mut self, report: bool, seconds: f64) {
        self.thermo_footer();
        let steps = self.progress.step - self.progress.begin;
        let seconds = general(seconds, 6, false);
        let atoms = self.population.count();
        self.print(&format!(
            "Loop time of {seconds} on 1 procs for {steps} steps with {atoms} atoms"
        ));
        if report {
            self.print("");
        }
        self.progress.begin = self.progress.step;
        self.progress.end = self.progress.step;
    }
}

impl Session<'_> {
    /// One step: atoms go on, some may be lost, and forces are those of the step's end.
    ///
    /// # Errors
    /// The state went bad; a value is not there.
    fn step(&mut self, output: bool, virial: bool) -> Result<()> {
        let running = |e| {
            let mut problem = Box::<Problem>::from(e);
            problem.while_running = true;
            problem
        };
        let mut told = std::mem::take(&mut self.fixes.told);
        self.carry(&mut told)?;
        let stress = self.stress_wanted();
        let engine = self.population.engine()?;
        if output {
            engine.expect_output();
        }
        if virial {
            engine.expect_virial();
        }
        if output && stress {
            engine.expect_virials();
        }
        let path = engine.depart(&told).map_err(running)?;
        self.fixes.told = told;
        self.reflect()?;
        self.rebuild_if_due(path)?;
        // conditions hold at the end of the step, where the atoms are now
        let mut conditions = std::mem::take(&mut self.fixes.acting);
        self.conditions(&mut conditions)?;
        self.population
            .engine()?
            .arrive(&conditions)
            .map_err(running)?;
        self.fixes.acting = conditions;
        Ok(())
    }
}

impl Script<'_> {
    /// Steps until step `end`, with output on the way and at the end of the run, which reports or not.
    ///
    /// # Errors
    /// The state went bad; a value or a file is not there.
    pub fn steps_until(&mut self, end: u64, report: bool) -> Result<()> {
        let mut start = Instant::now();
        let wanted = self.session.pressure_wanted();
        while self.session.progress.step < end {
            let s = &mut self.session;
            s.progress.step += 1;
            let now = s.progress.step;
            let last = now == s.progress.end;
            let thermo =
                last || (s.watch.thermo.every > 0 && now.is_multiple_of(s.watch.thermo.every));
            let looked = s.fixes_look(now);
            let output = thermo || looked || s.dumps_due(now)?;
            if let Err(p) = s.step(output, wanted && (thermo || looked)) {
                s.progress.step -= 1;
                return Err(p);
            }
            s.progress.steps_done += 1;
            let p = &s.progress;
            s.console.progress(now - p.begin, p.end - p.begin);
            self.end_of_step(false)?;
            let s = &mut self.session;
            s.write_dumps(false)?;
            if thermo {
                s.thermo_line()?;
            }
            s.progress.stepping_seconds += start.elapsed().as_secs_f64();
            start = Instant::now();
            self.look_for_wish(Some((end, report)))?;
        }
        Ok(())
    }
}
