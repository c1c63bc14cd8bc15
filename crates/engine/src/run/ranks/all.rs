//! The model of all ranks, as the first has it: it tells the others what to do with theirs.

use super::model::RankModel;
use crate::columns::Declaration;
use crate::condition::carried::Motion;
use crate::condition::driven::Drive;
use crate::condition::reaction::Reaction;
use crate::error::{BuildError, RunError, SolveError};
use crate::observe::{Column, Ledger, Observed, PointForce, ProbeColumn, Snapshot, StateHash};
use crate::run::agreed::agreed_among;
use crate::run::examined::{linear_of_all, modes_of_all};
use crate::run::feasible::possible;
use crate::run::{
    AtomBond, Examined, Families, Info, ModeShape, Options, Prescription, Seen, Shelf, Simulation,
    Steered, Summary, Wall, Watched,
};
use crate::space::Point;
use crate::spec::{AnyLinearBody, ConditionSpec, IndenterSpec, Spec};
use crate::state::{Archive, Owner};
use crate::statics::Solved;
use peridyne_comm::Comm;
use std::sync::Arc;

/// What all ranks do at once.
enum Ask<'a> {
    Start(bool),
    Step,
    Ledger,
    Summary,
    Fragments,
    Observed,
    Forces,
    LinearBody,
    Modes(usize),
    Hash,
    Measure,
    Watch(Watched),
    Watched(Watched),
    Columns,
    Column(&'a str),
    Snapshot(Vec<&'a str>, bool),
    Members(&'a str),
    Read(&'a str, usize),
    Write(&'a str, usize, usize, &'a [f64]),
    Save,
    /// Within parts of this path.
    Load(&'a str),
    /// Nobody asks any more.
    Leave,
}

impl<'a> Ask<'a> {
    /// A line of words, and numbers after it.
    fn to_bytes(&self) -> Vec<u8> {
        let line = match self {
            Ask::Start(bonds) => format!("start {bonds}"),
            Ask::Step => "step".into(),
            Ask::Ledger => "ledger".into(),
            Ask::Summary => "summary".into(),
            Ask::Fragments => "fragments".into(),
            Ask::Observed => "observed".into(),
            Ask::Forces => "forces".into(),
            Ask::LinearBody => "linear_body".into(),
            Ask::Modes(count) => format!("modes {count}"),
            Ask::Hash => "hash".into(),
            Ask::Measure => "measure".into(),
            Ask::Watch(what) => format!("watch {what:?}"),
            Ask::Watched(what) => format!("watched {what:?}"),
            Ask::Columns => "columns".into(),
            Ask::Column(name) => format!("column {name}"),
            Ask::Snapshot(fields, bonds) => format!("snapshot {bonds} {}", fields.join(" ")),
            Ask::Members(set) => format!("members {set}"),
            Ask::Read(name, component) => format!("read {name} {component}"),
            Ask::Write(name, component, first, _) => format!("write {name} {component} {first}"),
            Ask::Save => "save".into(),
            Ask::Load(path) => format!("load {path}"),
            Ask::Leave => "leave".into(),
        };
        let mut bytes = line.into_bytes();
        if let Ask::Write(_, _, _, values) = self {
            bytes.push(b'\n');
            bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes
    }

    /// `None`: no rank of this program says so.
    fn of(bytes: &'a [u8], values: &'a mut Vec<f64>) -> Option<Ask<'a>> {
        let end = bytes
            .iter()
            .position(|b| *b == b'\n')
            .unwrap_or(bytes.len());
        let line = std::str::from_utf8(&bytes[..end]).ok()?;
        let numbers = bytes.get(end + 1..).unwrap_or_default().chunks_exact(8);
        values.extend(numbers.map(|x| f64::from_le_bytes(x.try_into().expect("eight bytes"))));
        let (what, of) = line.split_once(' ').unwrap_or((line, ""));
        let mut words = of.split(' ');
        Some(match what {
            "start" => Ask::Start(of == "true"),
            "step" => Ask::Step,
            "ledger" => Ask::Ledger,
            "summary" => Ask::Summary,
            "fragments" => Ask::Fragments,
            "observed" => Ask::Observed,
            "forces" => Ask::Forces,
            "linear_body" => Ask::LinearBody,
            "modes" => Ask::Modes(of.parse().ok()?),
            "hash" => Ask::Hash,
            "measure" => Ask::Measure,
            "watch" => Ask::Watch(watched(of)?),
            "watched" => Ask::Watched(watched(of)?),
            "columns" => Ask::Columns,
            "column" => Ask::Column(of),
            "snapshot" => {
                let bonds = words.next()? == "true";
                Ask::Snapshot(words.filter(|w| !w.is_empty()).collect(), bonds)
            }
            // names of sets may have spaces
            "members" => Ask::Members(of),
            "read" => Ask::Read(words.next()?, words.next()?.parse().ok()?),
            "write" => {
                let name = words.next()?;
                let [component, first] = [words.next()?, words.next()?].map(|n| n.parse().ok());
                Ask::Write(name, component?, first?, values)
            }
            "save" => Ask::Save,
            "load" => Ask::Load(of),
            "leave" => Ask::Leave,
            _ => return None,
        })
    }
}

/// By its name.
fn watched(name: &str) -> Option<Watched> {
    let all = [Watched::Energies, Watched::Virial, Watched::Virials];
    all.into_iter().find(|what| format!("{what:?}") == name)
}

/// Hears what the first rank says, whoever says it.
fn heard(comm: &Comm, said: &[u8]) -> Vec<u8> {
    let all = comm.all(said).unwrap_or_else(|failure| comm.end(failure));
    all.into_iter().next().expect("there is a first rank")
}

impl<const D: usize> RankModel<D> {
    /// Does what the first rank asks of all, until it leaves.
    ///
    /// # Panics
    /// This is the first rank, or the first one is another program.
    pub fn follow(mut self) {
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
                Ask::Summary => drop(self.model.summary()),
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
                Ask::Leave => return,
            }
        }
    }
}

/// The model of all ranks, on the first of them. The others [follow](RankModel::follow) until it is dropped.
///
/// Columns, snapshots and states are gathered here. Not shared yet, and answered by a panic, is what [`Steered`] and [`Examined`] ask.
pub struct AllRanks<const D: usize> {
    own: RankModel<D>,
}

impl<const D: usize> AllRanks<D> {
    /// # Panics
    /// This is not the first rank.
    pub fn new(own: RankModel<D>) -> AllRanks<D> {
        assert_eq!(own.subdomain().comm().rank(), 0, "the first rank leads");
        AllRanks { own }
    }

    fn ask(&self, ask: &Ask<'_>) {
        heard(self.own.subdomain().comm(), &ask.to_bytes());
    }
}

impl<const D: usize> Drop for AllRanks<D> {
    fn drop(&mut self) {
        // who has ended already hears nothing
        let _ = self.own.subdomain().comm().all(&Ask::Leave.to_bytes());
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

    fn step_number(&self) -> u64 {
        self.own.model.step_number()
    }

    fn time(&self) -> f64 {
        self.own.model.time()
    }

    fn clock(&self) -> f64 {
        self.own.model.clock()
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

    fn state_hash(&mut self) -> StateHash {
        self.ask(&Ask::Hash);
        self.own.state_hash().expect("this rank gathers")
    }

    fn set_column(&mut self, _: &str, _: &[f64]) -> bool {
        false
    }

    fn read(&mut self, name: &str, component: usize, first: usize, out: &mut [f64]) -> bool {
        self.ask(&Ask::Read(name, component));
        let Some(all) = self.own.read(name, component) else {
            return false;
        };
        out.copy_from_slice(&all[first..first + out.len()]);
        true
    }

    fn write(&mut self, name: &str, component: usize, first: usize, values: &[f64]) -> bool {
        self.ask(&Ask::Write(name, component, first, values));
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
        self.own.model.summary()
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

impl<const D: usize> Steered for AllRanks<D> {
    fn depart(&mut self, _: &[Motion]) -> Result<f64, RunError> {
        not_shared("halves of steps")
    }

    fn arrive(&mut self) -> Result<(), RunError> {
        not_shared("halves of steps")
    }

    fn reflect(&mut self, _: &Wall, _: Option<&[u32]>) {
        not_shared("walls")
    }

    fn prescribe(&mut self, _: Prescription, _: &[u32]) {
        not_shared("motion from outside")
    }

    fn remove(&mut self, _: &[u32]) {
        not_shared("points that are taken away")
    }

    fn set_time(&mut self, _: u64, _: f64) {
        not_shared("times from outside")
    }

    fn set_time_step(&mut self, _: f64) {
        not_shared("steps from outside")
    }

    fn set_conditions(
        &mut self,
        _: &[ConditionSpec],
        _: &[(String, Vec<u32>)],
        _: &[IndenterSpec],
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

    fn set_driven(&mut self, _: &[(Drive, Option<Vec<u32>>)]) {
        not_shared("values from outside")
    }

    fn exchange(&mut self, _: usize, _: Option<&Drive>) -> Option<Reaction> {
        not_shared("values from outside")
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
/// All ranks come here at once.
///
/// # Errors
/// As of [`RankModel::new`].
pub fn build(
    spec: &Spec,
    options: Options,
    comm: &Arc<Comm>,
) -> Result<Option<Box<dyn Simulation>>, BuildError> {
    agreed_among(comm, possible(spec, options.simd))?;
    match spec.space.dimension {
        1 => built::<1>(spec, options, comm),
        2 => built::<2>(spec, options, comm),
        _ => built::<3>(spec, options, comm),
    }
}

fn built<const D: usize>(
    spec: &Spec,
    options: Options,
    comm: &Arc<Comm>,
) -> Result<Option<Box<dyn Simulation>>, BuildError> {
    let own = RankModel::<D>::new(spec, options, &Shelf::standard(), comm);
    let own = agreed_among(comm, own)?;
    if comm.rank() == 0 {
        return Ok(Some(Box::new(AllRanks::new(own))));
    }
    own.follow();
    Ok(None)
}
