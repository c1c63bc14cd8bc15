//! The state of a script between commands.

mod parts;
mod population;
mod progress;
mod space;
mod state;

use std::rc::Rc;
use std::sync::Arc;

use super::console::Output;
use super::error::{Result, Span};
use super::files::Folder;
use super::host::{BLOCK, Console, Host, Quantity};
use super::particles::{Field, View};
use super::variable::tree::Tree;
pub use parts::PairState;
use parts::{Fixes, Formulas, Neighbors, Pairs, Watch};
use peridyne_io::write::checkpoint::Checkpoint;
use population::Population;
pub use population::Store;
use progress::Progress;
use space::Space;

/// What a script has said so far, by concept.
pub struct Session<'a> {
    pub host: &'a mut dyn Host,
    pub console: Output<'a>,
    /// Where files are written.
    pub folder: Folder,
    pub title: String,
    /// File, text and command being executed.
    pub here: (String, Rc<str>, Span),
    /// [`Console::ended`] said so; errors then only lead out of the script.
    pub ended: bool,
    pub space: Space,
    pub population: Population,
    pub neighbors: Neighbors,
    pub pairs: Pairs,
    pub fixes: Fixes,
    pub watch: Watch,
    pub formulas: Formulas,
    pub progress: Progress,
    /// The state that the script goes on from, until its first `run`.
    pub from: Option<&'a mut Checkpoint>,
    /// Has it come to that state?
    pub went_on: bool,
    /// Commands since the first `run` that define something, with the values of their variables.
    pub commands: Vec<String>,
    /// Why the script cannot go on from any later place.
    pub lasting: Option<&'static str>,
    /// Was it told?
    pub told: bool,
}

impl<'a> Session<'a> {
    pub fn new(
        host: &'a mut dyn Host,
        console: &'a mut dyn Console,
        folder: Folder,
        title: String,
    ) -> Self {
        Session {
            host,
            console: Output::new(console),
            folder,
            title,
            here: (String::new(), "".into(), (0, 0)),
            ended: false,
            space: Space::default(),
            population: Population::default(),
            neighbors: Neighbors::default(),
            pairs: Pairs::default(),
            fixes: Fixes::default(),
            watch: Watch::default(),
            formulas: Formulas::default(),
            progress: Progress::default(),
            from: None,
            went_on: false,
            commands: vec![],
            lasting: None,
            told: false,
        }
    }

    /// Everything as it was before the first command, but variables, the log and the wall clock.
    pub fn clear(&mut self) {
        if let Store::Engine(_) = self.population.store {
            self.lasting = Some("after `clear`");
        }
        self.space = Space::default();
        self.population = Population::default();
        self.neighbors = Neighbors::default();
        self.pairs = Pairs::default();
        self.fixes = Fixes::default();
        self.watch = Watch::default();
        self.formulas.random = [None, None];
        self.progress = Progress {
            // what was done stays done
            stepping_seconds: self.progress.stepping_seconds,
            steps_done: self.progress.steps_done,
            ..Progress::default()
        };
    }

    pub fn view(&self) -> Result<View<'_>> {
        Ok(View {
            particles: self.population.store.particles(),
            ids: &self.population.ids,
            domain: self.space.domain()?,
            units: self.space.units,
        })
    }

    /// Calls `with` for each block of values of `field`.
    ///
    /// # Errors
    /// The field does not exist (yet).
    pub fn scan(&self, field: Field, mut with: impl FnMut(usize, &[f64])) -> Result<()> {
        let view = self.view()?;
        let mut buffer = [0.0; BLOCK];
        for first in (0..self.population.count()).step_by(BLOCK) {
            let block = &mut buffer[..BLOCK.min(self.population.count() - first)];
            view.read(field, first, block)?;
            with(first, block);
        }
        Ok(())
    }

    /// Positions of all atoms in the box, `[N][3]`.
    ///
    /// # Errors
    /// There is no box.
    pub fn positions(&self) -> Result<Vec<[f64; 3]>> {
        let mut x = vec![[0.0; 3]; self.population.count()];
        for a in 0..3 {
            self.scan(Field::Wrapped(a), |first, block| {
                x[first..]
                    .iter_mut()
                    .zip(block)
                    .for_each(|(p, v)| p[a] = *v);
            })?;
        }
        Ok(x)
    }

    /// Lets `s` and `m` faces follow the atoms.
    ///
    /// # Errors
    /// There is no box.
    pub fn shrink_box(&mut self) -> Result<()> {
        let mut domain = *self.space.domain()?;
        if !domain.moves() || self.population.count() == 0 {
            return Ok(());
        }
        for a in 0..3 {
            let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
            self.scan(Field::Raw(Quantity::Position(a)), |_, block| {
                for x in block {
                    least = least.min(*x);
                    greatest = greatest.max(*x);
                }
            })?;
            domain.follow(a, least, greatest);
        }
        self.space.domain = Some(domain);
        Ok(())
    }

    /// Values of a formula for all atoms.
    ///
    /// # Errors
    /// They do not exist (yet).
    pub fn values(&self, tree: &Tree) -> Result<Vec<f64>> {
        let (view, clock) = (self.view()?, self.progress.clock());
        let mut values = vec![0.0; self.population.count()];
        for (b, block) in values.chunks_mut(BLOCK).enumerate() {
            tree.fill(&view, &clock, b * BLOCK, block)?;
        }
        Ok(values)
    }

    /// Only the atoms at these places are left: groups, and what was made of them.
    pub fn forget(&mut self, places: &[usize]) {
        for (_, members) in &mut self.population.groups {
            *members = Arc::new(members.only(places));
        }
        for fix in &mut self.fixes.all {
            let mut new = fix.as_ref().clone();
            new.members = Arc::new(new.members.only(places));
            *fix = Rc::new(new);
        }
        for compute in &mut self.watch.computes {
            compute.members = Arc::new(compute.members.only(places));
        }
        for dump in &mut self.watch.dumps {
            dump.members = Arc::new(dump.members.only(places));
        }
    }
}
