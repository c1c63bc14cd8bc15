//! The state of a script between commands.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

use super::atoms::{Atoms, Ids, Members};
use super::compute::Compute;
use super::console::Output;
use super::domain::{Face, SimBox};
use super::dump::Dump;
use super::error::{Place, Problem, Result, Span, suggestion};
use super::files::Folder;
use super::fix::Fix;
use super::host::{BLOCK, Condition, Console, Engine, Host, Motion, Particles, Quantity, Style};
use super::lattice::Lattice;
use super::particles::{Field, View};
use super::random::Ranmar;
use super::rebuild::{Rebuild, Schedule};
use super::region::Definition;
use super::thermo::Thermo;
use super::units::Units;
use super::variable::Variables;
use super::variable::functions::Clock;
use super::variable::tree::Tree;

/// Who holds the atoms.
pub enum Store {
    /// Before the first `run`.
    Atoms(Atoms),
    Engine(Box<dyn Engine>),
}

impl Store {
    pub fn particles(&self) -> &dyn Particles {
        match self {
            Store::Atoms(a) => a,
            Store::Engine(e) => e.as_ref(),
        }
    }
    pub fn particles_mut(&mut self) -> &mut dyn Particles {
        match self {
            Store::Atoms(a) => a,
            Store::Engine(e) => e.as_mut(),
        }
    }
}

/// `pair_style` with the numbers that `pair_coeff` gave so far, `[types²]`.
#[derive(Debug, Clone, PartialEq)]
pub struct PairState {
    pub style: Style,
    pub values: Vec<Option<Vec<f64>>>,
}

/// Simulation time and steps.
#[derive(Debug, Clone)]
pub struct Progress {
    pub step: u64,
    /// First and last step of the current run.
    pub begin: u64,
    pub end: u64,
    /// First and last step of a `run ... every`, for functions of the step.
    pub whole: Option<(u64, u64)>,
    /// First step of the chain of runs (`elaplong`).
    pub first: u64,
    pub time_step: f64,
    /// Time at step `time_base.0`.
    pub time_base: (u64, f64),
    /// Wall clock at the start of the run, `None` before the first.
    pub started: Option<Instant>,
    /// Seconds in the time loops of all runs.
    pub stepping_seconds: f64,
    pub steps_done: u64,
}

impl Default for Progress {
    fn default() -> Self {
        Progress {
            step: 0,
            begin: 0,
            end: 0,
            whole: None,
            first: 0,
            time_step: Units::Lj.time_step(),
            time_base: (0, 0.0),
            started: None,
            stepping_seconds: 0.0,
            steps_done: 0,
        }
    }
}

pub struct Session<'a> {
    pub host: &'a mut dyn Host,
    pub console: Output<'a>,
    /// Where files are written.
    pub folder: Folder,
    pub title: String,
    pub units: Units,
    pub dimension: usize,
    pub faces: [[Face; 2]; 3],
    pub atom_style: bool,
    pub lattice: Option<Lattice>,
    pub regions: Vec<(String, Rc<Definition>)>,
    pub domain: Option<SimBox>,
    /// Number of atom types.
    pub types: usize,
    pub store: Store,
    pub ids: Ids,
    pub groups: Vec<(String, Arc<Members>)>,
    pub skin: f64,
    pub neighbors: Schedule,
    pub rebuild: Rebuild,
    pub pair: Option<PairState>,
    /// Where each pair of types got its coefficients, `[types²]`.
    pub pair_places: Vec<Place>,
    /// File, text and command being executed.
    pub here: (String, Rc<str>, Span),
    pub fixes: Vec<Rc<Fix>>,
    /// Values of the fixes at this step: kept so that a step allocates nothing.
    pub acting: Vec<Condition>,
    pub told: Vec<Motion>,
    pub computes: Vec<Compute>,
    pub dumps: Vec<Dump>,
    pub variables: Variables,
    pub random: [Option<Rc<RefCell<Ranmar>>>; 2],
    pub thermo: Thermo,
    pub progress: Progress,
    /// [`Console::ended`] said so; errors then only lead out of the script.
    pub ended: bool,
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
            units: Units::Lj,
            dimension: 3,
            faces: [[Face::Periodic; 2]; 3],
            atom_style: false,
            lattice: None,
            regions: Vec::new(),
            domain: None,
            types: 0,
            store: Store::Atoms(Atoms::default()),
            ids: Ids::Count(0),
            groups: vec![("all".into(), Arc::new(Members::All))],
            skin: Units::Lj.skin(),
            neighbors: Schedule::default(),
            rebuild: Rebuild::default(),
            pair: None,
            pair_places: Vec::new(),
            here: (String::new(), "".into(), (0, 0)),
            fixes: Vec::new(),
            acting: Vec::new(),
            told: Vec::new(),
            computes: Vec::new(),
            dumps: Vec::new(),
            variables: Variables::default(),
            random: [None, None],
            thermo: Thermo::default(),
            progress: Progress::default(),
            ended: false,
        }
    }

    pub fn count(&self) -> usize {
        self.store.particles().count()
    }

    /// The box.
    ///
    /// # Errors
    /// There is none yet.
    pub fn domain(&self) -> Result<&SimBox> {
        self.domain.as_ref().ok_or_else(no_box)
    }

    pub fn view(&self) -> Result<View<'_>> {
        Ok(View {
            particles: self.store.particles(),
            ids: &self.ids,
            domain: self.domain()?,
            units: self.units,
        })
    }

    /// The engine.
    ///
    /// # Errors
    /// There was no `run` yet.
    pub fn engine(&mut self) -> Result<&mut dyn Engine> {
        match &mut self.store {
            Store::Engine(e) => Ok(e.as_mut()),
            Store::Atoms(_) => Err(Problem::new(
                "forces and energies do not exist before the first `run`",
            )
            .help("write `run 0` before")),
        }
    }

    /// Atoms that may still be changed freely.
    ///
    /// # Errors
    /// The first `run` has been.
    pub fn atoms(&mut self) -> Result<&mut Atoms> {
        match &mut self.store {
            Store::Atoms(a) => Ok(a),
            Store::Engine(_) => Err(Problem::new(
                "the atoms are fixed since the first `run`, which built their bonds",
            )
            .help("move this command before the first `run`")),
        }
    }

    pub fn group(&self, name: &str) -> Result<Arc<Members>> {
        self.groups
            .iter()
            .find(|(n, _)| n == name)
            .map(|(_, m)| m.clone())
            .ok_or_else(|| {
                Problem::new(format!("there is no group `{name}`")).help(suggestion(
                    name,
                    self.groups.iter().map(|(n, _)| n.as_str()),
                ))
            })
    }

    /// Length of `units lattice` (true) or `units box`.
    ///
    /// # Errors
    /// Lattice units without a lattice.
    pub fn length_unit(&self, in_lattice: bool) -> Result<f64> {
        match (in_lattice, &self.lattice) {
            (false, _) => Ok(1.0),
            (true, Some(l)) => Ok(l.constant),
            (true, None) => Err(Problem::new("lattice units need a `lattice`")
                .help("write a `lattice` command before, or add `units box`")),
        }
    }

    pub fn clock(&self) -> Clock {
        let p = &self.progress;
        let (begin, end) = p.whole.unwrap_or((p.begin, p.end));
        Clock {
            step: p.step,
            begin,
            end,
            time_step: p.time_step,
        }
    }

    /// Simulated time.
    pub fn time(&self) -> f64 {
        let p = &self.progress;
        p.time_base.1 + (p.step - p.time_base.0.min(p.step)) as f64 * p.time_step
    }

    /// Calls `with` for each block of values of `field`.
    ///
    /// # Errors
    /// The field does not exist (yet).
    pub fn scan(&self, field: Field, mut with: impl FnMut(usize, &[f64])) -> Result<()> {
        let view = self.view()?;
        let mut buffer = [0.0; BLOCK];
        for first in (0..self.count()).step_by(BLOCK) {
            let block = &mut buffer[..BLOCK.min(self.count() - first)];
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
        let mut x = vec![[0.0; 3]; self.count()];
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
        let mut domain = *self.domain()?;
        if !domain.moves() || self.count() == 0 {
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
        self.domain = Some(domain);
        Ok(())
    }

    /// One quantity of all atoms.
    ///
    /// # Errors
    /// It does not exist (yet).
    pub fn raw(&self, quantity: Quantity) -> Result<Vec<f64>> {
        let mut values = vec![0.0; self.count()];
        for (b, block) in values.chunks_mut(BLOCK).enumerate() {
            self.store.particles().read(quantity, b * BLOCK, block)?;
        }
        Ok(values)
    }

    /// One quantity of one atom.
    ///
    /// # Errors
    /// It does not exist (yet).
    pub fn one(&self, quantity: Quantity, atom: usize) -> Result<f64> {
        let mut value = [0.0];
        self.store.particles().read(quantity, atom, &mut value)?;
        Ok(value[0])
    }

    /// Positions of all atoms, not wrapped into a periodic box, `[N][3]`.
    ///
    /// # Errors
    /// They cannot be read.
    pub fn unwrapped(&self) -> Result<Vec<[f64; 3]>> {
        let axes = [0, 1, 2].map(|a| self.raw(Quantity::Position(a)));
        let [x, y, z] = axes;
        let (x, y, z) = (x?, y?, z?);
        Ok((0..x.len()).map(|i| [x[i], y[i], z[i]]).collect())
    }

    /// Values of a formula for all atoms.
    ///
    /// # Errors
    /// They do not exist (yet).
    pub fn values(&self, tree: &Tree) -> Result<Vec<f64>> {
        let (view, clock) = (self.view()?, self.clock());
        let mut values = vec![0.0; self.count()];
        for (b, block) in values.chunks_mut(BLOCK).enumerate() {
            tree.fill(&view, &clock, b * BLOCK, block)?;
        }
        Ok(values)
    }

    /// Only the atoms at these places are left: groups, and what was made of them.
    pub fn forget(&mut self, places: &[usize]) {
        for (_, members) in &mut self.groups {
            *members = Arc::new(members.only(places));
        }
        for fix in &mut self.fixes {
            let mut new = fix.as_ref().clone();
            new.members = Arc::new(new.members.only(places));
            *fix = Rc::new(new);
        }
        for compute in &mut self.computes {
            compute.members = Arc::new(compute.members.only(places));
        }
        for dump in &mut self.dumps {
            dump.members = Arc::new(dump.members.only(places));
        }
    }

    /// Everything as it was before the first command, but variables, the log and the wall clock.
    pub fn clear(&mut self) {
        self.units = Units::Lj;
        self.dimension = 3;
        self.faces = [[Face::Periodic; 2]; 3];
        self.atom_style = false;
        self.lattice = None;
        self.regions.clear();
        self.domain = None;
        self.types = 0;
        self.store = Store::Atoms(Atoms::default());
        self.ids = Ids::Count(0);
        self.groups = vec![("all".into(), Arc::new(Members::All))];
        self.skin = Units::Lj.skin();
        self.neighbors = Schedule::default();
        self.rebuild = Rebuild::default();
        self.pair = None;
        self.pair_places.clear();
        self.fixes.clear();
        self.acting.clear();
        self.told.clear();
        self.computes.clear();
        self.dumps.clear();
        self.random = [None, None];
        self.thermo = Thermo::default();
        self.progress = Progress {
            // what was done stays done
            stepping_seconds: self.progress.stepping_seconds,
            steps_done: self.progress.steps_done,
            ..Progress::default()
        };
    }
}

pub fn no_box() -> Box<Problem> {
    Problem::new("there is no simulation box yet").help("write `create_box` or `read_data` before")
}
