//! Progress: a live bar on a terminal, plain lines in a pipe.

use crate::early::Early;
use crate::failure::note;
use crate::signals;
use indicatif::{ProgressBar, ProgressStyle};
use peridyne::observe::Ledger;
use peridyne_io::deck::{Dim, UnitSystem};
use peridyne_io::drive::Progress;
use peridyne_io::excerpt::brief;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Between plain lines.
const INTERVAL: Duration = Duration::from_secs(5);

pub struct Terminal {
    bar: Option<ProgressBar>,
    bonds: u64,
    begun: Instant,
    spoken: Instant,
    broken: u64,
    /// What time is counted in; `None`: it is a part of the load.
    units: Option<UnitSystem>,
    /// Time and energy of the last row of the history.
    state: String,
    done: u64,
    early: Early,
}

impl Terminal {
    /// `units` of the times of steps; `None` in statics, where t is a part of the load.
    pub fn new(steps: u64, bonds: u64, units: Option<UnitSystem>) -> Terminal {
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = "{bar:30.cyan} {pos}/{len} steps  {per_sec}  {eta} left  {msg}";
            let bar = ProgressBar::new(steps);
            bar.set_style(
                ProgressStyle::with_template(style)
                    .unwrap_or_else(|_| ProgressStyle::default_bar()),
            );
            bar
        });
        Terminal {
            bar,
            bonds,
            begun: Instant::now(),
            spoken: Instant::now(),
            broken: 0,
            units,
            state: String::new(),
            done: 0,
            early: Early::default(),
        }
    }

    /// The same of a run that ends early; `done` steps were done before.
    #[must_use]
    pub fn ending(mut self, early: Early, done: u64) -> Terminal {
        (self.early, self.done) = (early, done);
        self
    }

    pub fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Progress for Terminal {
    fn step(&mut self, done: u64, total: u64, stepping: Duration) {
        self.done = done;
        let per_step = stepping.as_secs_f64() / done as f64;
        if let Some(bar) = &self.bar {
            bar.set_position(done);
            if done.is_multiple_of(16) {
                let ns = per_step * 1e9 / self.bonds.max(1) as f64;
                bar.set_message(format!(
                    "{}{} bonds broken, {ns:.2} ns per bond",
                    self.state, self.broken
                ));
            }
        } else if self.spoken.elapsed() >= INTERVAL {
            self.spoken = Instant::now();
            // frames and fields take time, too
            let per_step = self.begun.elapsed().as_secs_f64() / done as f64;
            let left = per_step * (total - done) as f64;
            note(&format!(
                "step {done} of {total}, {}{} bonds broken, {:.1} steps/s, {left:.0} s left",
                self.state,
                self.broken,
                1.0 / per_step
            ));
        }
    }

    fn row(&mut self, _step: u64, time: f64, ledger: &Ledger, broken: u64) {
        self.broken = broken;
        let Some(units) = self.units else {
            self.state = format!("{:.0} % of the load, ", 100.0 * time);
            return;
        };
        let work = ledger.work_boundary_conditions.abs() + ledger.work_rigid_bodies.abs();
        let given = work + ledger.initial.abs();
        let time = units.show(time, Dim::TIME);
        self.state = match given > 0.0 {
            true => {
                // + 0.0: no negative zeros
                let off = (1e4 * ledger.residual() / given).round() / 100.0 + 0.0;
                format!("t = {time}, energy off by {off:.2} %, ")
            }
            false => format!("t = {time}, "),
        };
    }

    fn phase(&mut self, what: &str) {
        match &self.bar {
            Some(bar) => bar.set_message(format!("making {what}")),
            None if self.spoken.elapsed() >= INTERVAL => {
                self.spoken = Instant::now();
                note(&format!("making {what}"));
            }
            None => {}
        }
    }

    fn warning(&mut self, message: &str) {
        let line = format!("warning: {message}");
        match &self.bar {
            Some(bar) => bar.println(brief(&line)),
            None => note(&line),
        }
    }

    fn ended(&mut self) -> Option<String> {
        let signal = signals::received().map(|s| s.to_string());
        signal.or_else(|| self.early.reached(self.done, self.begun))
    }

    fn wants_checkpoint(&mut self) -> bool {
        signals::asked_for_checkpoint()
    }
}
