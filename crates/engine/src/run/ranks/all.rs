//! The model of all ranks, as the first has it: it tells the others what to do with theirs.

use super::ask::{Ask, driven_of_numbers, ids, numbers_of_driven, of_ids, wall};
use super::model::{RankModel, WriteShare};
use crate::boundary_condition::driven::Drive;
use crate::boundary_condition::kinematic::{Motion, motions, numbers};
use crate::boundary_condition::reaction::Reaction;
use crate::columns::Declaration;
use crate::error::{BuildError, RunError, SolveError};
use crate::observe::{Column, Ledger, Observed, PointForce, ProbeColumn, Snapshot, StateHash};
use crate::run::agreed::agreed_among;
use crate::run::examined::{linear_of_all, modes_of_all};
use crate::run::initial::InitialState;
use crate::run::sanity::possible;
use crate::run::{
    AtomBond, CoSimulation, Examined, Families, Given, Info, ModeShape, Now, Options, Prescription,
    Registry, Seen, Simulation, Summary, Wall, Watched,
};
use crate::space::Point;
use crate::spec::{AnyLinearBody, ConditionSpec, RigidBodySpec, Spec};
use crate::state::{Archive, Owner};
use crate::statics::Solved;
use peridyne_comm::Comm;
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

/// Hears what the first rank says, whoever says it.
fn heard(comm: &Comm, said: &[u8]) -> Vec<u8> {
    let all = comm.all(said).unwrap_or_else(|failure| comm.end(failure));
    all.into_iter().next().expect("there is a first rank")
}

impl<const D: usize> RankModel<D> {
    /// Does what the first rank asks of all, until it leaves; the model is as that leaves it.
    ///
    /// # Panics
    /// This is the first rank, or the first one is another program.
    pub fn follow(mut self, write: WriteShare) -> RankModel<D> {
        let comm = self.subdomain().comm().clone();
        assert!(comm.rank() > 0, "the first rank follows nobody");
        loop {
            let (bytes, mut values) = (heard(&comm, &[]), vec![]);
            let ask = Ask::of(&bytes, &mut values).expect("ranks are of one program");
            match ask {
                // what comes of it the first rank has, too
                Ask::Start(bonds) => self.model.start(bonds),
                Ask::Step => drop(self.step()),
                Ask::Ledger => drop(self.model.ledger()),
                Ask::Summary => drop(self.summary()),
                Ask::Fragments => _ = self.fragments(),
                Ask::Observed => drop(self.observed()),
                Ask::Forces => drop(self.forces()),
                Ask::LinearBody => drop(linear_of_all(&mut self.model)),
                Ask::Modes(count) => drop(modes_of_all(&mut self.model, count)),
                Ask::Hash => drop(self.state_hash()),
                Ask::Measure => drop(self.model.measure()),
                Ask::Watch(what) => self.model.watch(what),
                Ask::Watched(what) => drop(self.watched(what)),
                Ask::Columns => drop(self.columns()),
                Ask::Column(name) => drop(self.column(name)),
                Ask::Snapshot(fields, bonds) => drop(self.snapshot(&fields, bonds)),
                Ask::Depart(numbers) => drop(self.depart(&motions(numbers))),
                Ask::Arrive => drop(self.model.arrive()),
                Ask::Reflect(of, points) => self.reflect(&wall(of), points.map(ids).as_deref()),
                Ask::Prescribe(way, points) => self.prescribe(way, &ids(points)),
                Ask::Remove(points) => self.remove(&ids(points)),
                Ask::SetClock(now, time_step) => self.model.set_clock(now, time_step),
                Ask::SetDriven(numbers) => {
                    let driven = driven_of_numbers(numbers);
                    self.set_driven(&driven.expect("ranks are of one program"));
                }
                Ask::Drive(index, mut numbers) => {
                    let value = Drive::of(&mut numbers);
                    _ = self.drive(index, &value.expect("ranks are of one program"));
                }
                Ask::Reaction(index) => _ = self.reaction(index),
                Ask::Shares(fields, asked) => drop(self.shares(&fields, (write, asked))),
                Ask::Members(set) => drop(self.members(set)),
                Ask::Read(name, component) => drop(self.read(name, component)),
                Ask::Write(name, component, first, values) => {
                    self.write(name, component, first, values);
                }
                Ask::Save => Archive::there(&comm, false, "", |archive| {
                    self.model.archive(archive);
                }),
                Ask::Load(path) => Archive::there(&comm, true, path, |archive| {
                    self.model.archive(archive);
                }),
                Ask::Leave => return self,
            }
        }
    }
}

/// The model of all ranks, on the first of them. The others [follow](RankModel::follow) until it is dropped.
///
/// Columns, snapshots and states are gathered here; shares of frames are written by all ranks. Not shared yet, and answered by a panic: other conditions than a spec has
/// ([`CoSimulation::set_conditions`]) and most of what [`Examined`] asks.
pub struct AllRanks<const D: usize> {
    own: RankModel<D>,
    _leads: Leads,
    write: WriteShare,
    /// Components of columns that were read since something changed.
    read: RefCell<HashMap<(String, usize), Vec<f64>>>,
}

/// As long as it is there, others follow.
struct Leads(Arc<Comm>);

impl Drop for Leads {
    fn drop(&mut self) {
        // who has ended already hears nothing
        let _ = self.0.all(&Ask::Leave.to_bytes());
    }
}

impl<const D: usize> AllRanks<D> {
    /// # Panics
    /// This is not the first rank.
    pub fn new(own: RankModel<D>, write: WriteShare) -> AllRanks<D> {
        let comm = own.subdomain().comm().clone();
        assert_eq!(comm.rank(), 0, "the first rank leads");
        AllRanks {
            _leads: Leads(comm),
            own,
            write,
            read: RefCell::default(),
        }
    }

    fn ask(&self, ask: &Ask<'_>) {
        if !matches!(ask, Ask::Read(..) | Ask::Write(..)) {
            self.read.borrow_mut().clear();
        }
        heard(self.own.subdomain().comm(), &ask.to_bytes());
    }
}

fn not_shared(what: &str) -> ! {
    panic!("ranks do not share {what} yet")
}

impl<const D: usize> Owner for AllRanks<D> {
    /// As one model that has all points, which may go on from it, too.
    fn archive(&mut self, archive: &mut Archive<'_>) {
        self.ask(&match archive.is_load() {
            true => Ask::Load(archive.path()),
            false => Ask::Save,
        });
        let comm = self.own.subdomain().comm().clone();
        archive.among(&comm, |archive| self.own.model.archive(archive));
    }
}

impl<const D: usize> Simulation for AllRanks<D> {
    fn info(&self) -> &Info {
        self.own.model.info()
    }

    fn start(&mut self, bonds: bool) {
        self.ask(&Ask::Start(bonds));
        self.own.model.start(bonds);
    }

    fn step(&mut self) -> Result<(), RunError> {
        self.ask(&Ask::Step);
        self.own.step()
    }

    fn stop_when(&mut self, stop: fn() -> bool) {
        self.own.model.stop_when(stop);
    }

    fn now(&self) -> Now {
        self.own.model.now()
    }

    fn ledger(&mut self) -> Result<Ledger, RunError> {
        self.ask(&Ask::Ledger);
        self.own.model.ledger()
    }

    fn columns(&mut self) -> Vec<Declaration> {
        self.ask(&Ask::Columns);
        self.own.columns()
    }

    fn column(&mut self, name: &str) -> Option<Column> {
        self.ask(&Ask::Column(name));
        self.own.column(name)
    }

    fn snapshot(&mut self, fields: &[&str], bonds: bool) -> Snapshot {
        self.ask(&Ask::Snapshot(fields.to_vec(), bonds));
        let snapshot = self.own.snapshot(fields, bonds);
        snapshot.expect("this rank gathers")
    }

    fn shares(&mut self, fields: &[&str], asked: &str) -> Option<Vec<Vec<u8>>> {
        self.ask(&Ask::Shares(fields.to_vec(), asked));
        self.own.shares(fields, (self.write, asked))
    }

    fn state_hash(&mut self) -> StateHash {
        self.ask(&Ask::Hash);
        self.own.state_hash().expect("this rank gathers")
    }

    fn set_column(&mut self, _: &str, _: &[f64]) -> bool {
        false
    }

    fn read(&mut self, name: &str, component: usize, first: usize, out: &mut [f64]) -> bool {
        let key = (name.to_string(), component);
        if !self.read.borrow().contains_key(&key) {
            self.ask(&Ask::Read(name, component));
            let Some(all) = self.own.read(name, component) else {
                return false;
            };
            self.read.borrow_mut().insert(key.clone(), all);
        }
        out.copy_from_slice(&self.read.borrow()[&key][first..first + out.len()]);
        true
    }

    fn write(&mut self, name: &str, component: usize, first: usize, values: &[f64]) -> bool {
        self.ask(&Ask::Write(name, component, first, values));
        if let Some(all) = { self.read.get_mut() }.get_mut(&(name.to_string(), component)) {
            all[first..first + values.len()].copy_from_slice(values);
        }
        self.own.write(name, component, first, values)
    }

    fn probe_columns(&self) -> Vec<ProbeColumn> {
        self.own.model.probe_columns()
    }

    fn measure(&mut self) -> Vec<f64> {
        self.ask(&Ask::Measure);
        self.own.model.measure()
    }

    fn summary(&self) -> Summary {
        self.ask(&Ask::Summary);
        self.own.summary()
    }

    fn fragments(&self) -> u64 {
        self.ask(&Ask::Fragments);
        self.own.fragments()
    }

    fn members(&self, set: &str) -> Option<Vec<u32>> {
        self.ask(&Ask::Members(set));
        self.own.members(set)
    }
}

impl<const D: usize> CoSimulation for AllRanks<D> {
    fn begin_motion(&mut self) -> Result<bool, RunError> {
        not_shared("the beginning of a motion")
    }

    fn depart(&mut self, kinematic: &[Motion]) -> Result<f64, RunError> {
        self.ask(&Ask::Depart(&numbers(kinematic)));
        self.own.depart(kinematic)
    }

    fn arrive(&mut self) -> Result<(), RunError> {
        self.ask(&Ask::Arrive);
        self.own.model.arrive()
    }

    fn turn_back(&mut self) {
        not_shared("the way back from half a step")
    }

    fn give(&mut self, _: &[u32], _: Given) -> Result<(), BuildError> {
        not_shared("conditions from outside")
    }

    fn reflect(&mut self, wall: &Wall, ids: Option<&[u32]>) {
        let above = f64::from(wall.above);
        let points = ids.map(of_ids);
        let of = [wall.axis as f64, above, wall.position];
        self.ask(&Ask::Reflect(of, points.as_deref()));
        self.own.reflect(wall, ids);
    }

    fn prescribe(&mut self, way: Prescription, ids: &[u32]) {
        self.ask(&Ask::Prescribe(way, &of_ids(ids)));
        self.own.prescribe(way, ids);
    }

    fn remove(&mut self, ids: &[u32]) {
        self.ask(&Ask::Remove(&of_ids(ids)));
        self.own.remove(ids);
    }

    fn set_clock(&mut self, now: Option<(u64, f64)>, time_step: Option<f64>) {
        self.ask(&Ask::SetClock(now, time_step));
        self.own.model.set_clock(now, time_step);
    }

    fn set_conditions(
        &mut self,
        _: &[ConditionSpec],
        _: &[(String, Vec<u32>)],
        _: &[RigidBodySpec],
    ) -> Result<(), BuildError> {
        not_shared("conditions from outside")
    }

    fn watch(&mut self, what: Watched) {
        self.ask(&Ask::Watch(what));
        self.own.model.watch(what);
    }

    fn watched(&mut self, what: Watched) -> Option<Seen> {
        self.ask(&Ask::Watched(what));
        self.own.watched(what)
    }

    fn set_driven(&mut self, driven: &[(Drive, Option<Vec<u32>>)]) {
        self.ask(&Ask::SetDriven(&numbers_of_driven(driven)));
        self.own.set_driven(driven);
    }

    fn drive(&mut self, index: usize, value: &Drive) -> bool {
        self.ask(&Ask::Drive(index, &value.numbers()));
        self.own.drive(index, value)
    }

    fn reaction(&mut self, index: usize) -> Option<Reaction> {
        self.ask(&Ask::Reaction(index));
        self.own.reaction(index)
    }
}

impl<const D: usize> Examined for AllRanks<D> {
    fn families(&self) -> Families {
        not_shared("families")
    }

    fn energy_under_strain(&self, _: [[f64; 3]; 3]) -> Vec<f64> {
        not_shared("energies under a strain")
    }

    fn bonds_of_atoms(&mut self, _: &mut dyn FnMut(AtomBond)) -> Option<Vec<f64>> {
        not_shared("bonds of atoms")
    }

    fn forces_under(&mut self, _: &[Point]) -> Vec<Point> {
        not_shared("forces under displacements")
    }

    fn observed(&mut self) -> Observed {
        self.ask(&Ask::Observed);
        self.own.observed().expect("this rank gathers")
    }

    fn each_force(&mut self, visit: &mut dyn FnMut(PointForce)) -> bool {
        self.ask(&Ask::Forces);
        let Some(all) = self.own.forces() else {
            return false;
        };
        all.into_iter().for_each(visit);
        true
    }

    fn relax(&mut self, _: f64) -> Result<Solved, RunError> {
        not_shared("equilibria")
    }

    fn linear_body(&mut self) -> AnyLinearBody {
        self.ask(&Ask::LinearBody);
        self.own.model.linear_body()
    }

    fn modes(&mut self, count: usize) -> Result<Vec<ModeShape>, SolveError> {
        self.ask(&Ask::Modes(count));
        self.own.model.modes(count)
    }
}

/// Builds the model of a spec whose body ranks share. The first rank has it; the others follow that one here until it is gone, and have nothing then.
/// All ranks come here at once. `write` is how each writes its share of frames ([`Simulation::shares`]).
///
/// # Errors
/// As of [`join`](super::join).
pub fn build(
    spec: &Spec,
    options: Options,
    comm: &Arc<Comm>,
    write: WriteShare,
) -> Result<Option<Box<dyn Simulation>>, BuildError> {
    build_from(None, spec, options, comm, write)
}

/// A spec, and what brings its model to a state.
pub type Before<'a> = (
    &'a Spec,
    &'a mut dyn FnMut(&mut dyn Simulation) -> Result<(), BuildError>,
);

/// The same, in the state of an earlier run that the first rank brings the model of another spec to.
///
/// # Errors
/// As of [`build`] of both, of that state, and of [`InitialState::give`].
pub fn build_from(
    before: Option<Before<'_>>,
    spec: &Spec,
    options: Options,
    comm: &Arc<Comm>,
    write: WriteShare,
) -> Result<Option<Box<dyn Simulation>>, BuildError> {
    agreed_among(comm, possible(spec, options.simd))?;
    match spec.space.dimension {
        1 => built::<1>(before, spec, options, comm, write),
        2 => built::<2>(before, spec, options, comm, write),
        _ => built::<3>(before, spec, options, comm, write),
    }
}

fn built<const D: usize>(
    before: Option<Before<'_>>,
    spec: &Spec,
    options: Options,
    comm: &Arc<Comm>,
    write: WriteShare,
) -> Result<Option<Box<dyn Simulation>>, BuildError> {
    let state = match before {
        Some(before) => Some(state_of::<D>(before, options, comm, write)?),
        None => None,
    };
    let own = RankModel::<D>::new(spec, options, &Registry::standard(), comm);
    let mut own = agreed_among(comm, own)?;
    if let Some(state) = state {
        agreed_among(comm, state.give(&mut own.model))?;
    }
    if comm.rank() == 0 {
        return Ok(Some(Box::new(AllRanks::new(own, write))));
    }
    own.follow(write);
    Ok(None)
}

/// This rank's part of a state.
fn state_of<const D: usize>(
    (spec, bring): Before<'_>,
    options: Options,
    comm: &Arc<Comm>,
    write: WriteShare,
) -> Result<InitialState, BuildError> {
    let other = spec.space.dimension != D;
    let same = match other {
        true => Err(BuildError::invalid(
            "space",
            "the initial state is that of a body of other dimensions",
        )),
        false => Ok(()),
    };
    agreed_among(comm, same)?;
    let own = RankModel::<D>::new(spec, options, &Registry::standard(), comm);
    let own = agreed_among(comm, own)?;
    let (mut own, brought) = match comm.rank() {
        0 => {
            let mut all = AllRanks::new(own, write);
            let brought = bring(&mut all);
            let AllRanks { own, .. } = all;
            (own, brought)
        }
        _ => (own.follow(write), Ok(())),
    };
    agreed_among(comm, brought)?;
    Ok(InitialState::of(&mut own.model))
}
