//! What the first rank tells the others to do, as bytes.

use crate::boundary_condition::driven::Drive;
use crate::run::{Prescription, Wall, Watched};

/// What all ranks do at once.
pub(super) enum Ask<'a> {
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
    /// Motions in [numbers](motions).
    Depart(&'a [f64]),
    Arrive,
    /// The axis, 1 of a wall above, its position; then ids, of all points where there is nothing.
    Reflect([f64; 3], Option<&'a [f64]>),
    Prescribe(Prescription, &'a [f64]),
    Remove(&'a [f64]),
    SetClock(Option<(u64, f64)>, Option<f64>),
    /// Of each one the number of its points, −1 of all, their ids and its numbers.
    SetDriven(&'a [f64]),
    Drive(usize, &'a [f64]),
    Reaction(usize),
    /// Fields, and what is asked of whoever writes.
    Shares(Vec<&'a str>, &'a str),
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
    pub fn to_bytes(&self) -> Vec<u8> {
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
            Ask::Depart(_) => "depart".into(),
            Ask::Arrive => "arrive".into(),
            Ask::Reflect([axis, above, position], ids) => {
                format!("reflect {axis} {above} {position:e} {}", ids.is_some())
            }
            Ask::Prescribe(way, _) => format!("prescribe {way:?}"),
            Ask::Remove(_) => "remove".into(),
            Ask::SetClock(now, time_step) => {
                let now = now.map(|(step, time)| format!("{step}/{time:e}"));
                let time_step = time_step.map(|dt| format!("{dt:e}"));
                let [now, time_step] = [now, time_step].map(|x| x.unwrap_or("-".into()));
                format!("set_clock {now} {time_step}")
            }
            Ask::SetDriven(_) => "set_driven".into(),
            Ask::Drive(index, _) => format!("drive {index}"),
            Ask::Reaction(index) => format!("reaction {index}"),
            Ask::Shares(fields, asked) => format!("shares {} {asked}", fields.join(",")),
            Ask::Members(set) => format!("members {set}"),
            Ask::Read(name, component) => format!("read {name} {component}"),
            Ask::Write(name, component, first, _) => format!("write {name} {component} {first}"),
            Ask::Save => "save".into(),
            Ask::Load(path) => format!("load {path}"),
            Ask::Leave => "leave".into(),
        };
        let mut bytes = line.into_bytes();
        if let Ask::Write(_, _, _, values)
        | Ask::Depart(values)
        | Ask::Reflect(_, Some(values))
        | Ask::Prescribe(_, values)
        | Ask::Remove(values)
        | Ask::SetDriven(values)
        | Ask::Drive(_, values) = self
        {
            bytes.push(b'\n');
            bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes
    }

    /// `None`: no rank of this program says so.
    pub fn of(bytes: &'a [u8], values: &'a mut Vec<f64>) -> Option<Ask<'a>> {
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
            "depart" => Ask::Depart(values),
            "arrive" => Ask::Arrive,
            "reflect" => {
                let mut number = || words.next()?.parse().ok();
                let wall = [number()?, number()?, number()?];
                Ask::Reflect(wall, (words.next()? == "true").then_some(values))
            }
            "prescribe" => {
                let all = [Prescription::Still, Prescription::KinematicPoints];
                let way = all.into_iter().find(|way| format!("{way:?}") == of)?;
                Ask::Prescribe(way, values)
            }
            "remove" => Ask::Remove(values),
            "set_clock" => {
                let now = match words.next()?.split_once('/') {
                    Some((step, time)) => Some((step.parse().ok()?, time.parse().ok()?)),
                    None => None,
                };
                let time_step = match words.next()? {
                    "-" => None,
                    dt => Some(dt.parse().ok()?),
                };
                Ask::SetClock(now, time_step)
            }
            "set_driven" => Ask::SetDriven(values),
            "drive" => Ask::Drive(of.parse().ok()?, values),
            "reaction" => Ask::Reaction(of.parse().ok()?),
            // names of files may have spaces
            "shares" => {
                let (fields, asked) = of.split_once(' ')?;
                Ask::Shares(fields.split(',').filter(|f| !f.is_empty()).collect(), asked)
            }
            // names of sets, too
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

/// Ids as numbers.
pub(super) fn of_ids(ids: &[u32]) -> Vec<f64> {
    ids.iter().map(|id| f64::from(*id)).collect()
}

/// The ids of numbers.
pub(super) fn ids(numbers: &[f64]) -> Vec<u32> {
    numbers.iter().map(|x| *x as u32).collect()
}

pub(super) fn numbers_of_driven(all: &[(Drive, Option<Vec<u32>>)]) -> Vec<f64> {
    let each = all.iter().flat_map(|(drive, ids)| {
        let count = ids.as_ref().map_or(-1.0, |ids| ids.len() as f64);
        let ids = of_ids(ids.as_deref().unwrap_or_default());
        [vec![count], ids, drive.numbers()].concat()
    });
    each.collect()
}

/// `None`: these are no such numbers.
pub(super) fn driven_of_numbers(mut numbers: &[f64]) -> Option<Vec<(Drive, Option<Vec<u32>>)>> {
    let mut all = vec![];
    while let Some((count, rest)) = numbers.split_first() {
        let (own, rest) = rest.split_at_checked(count.max(0.0) as usize)?;
        numbers = rest;
        let ids = (*count >= 0.0).then(|| ids(own));
        all.push((Drive::of(&mut numbers)?, ids));
    }
    Some(all)
}

pub(super) fn wall([axis, above, position]: [f64; 3]) -> Wall {
    Wall {
        axis: axis as usize,
        above: above == 1.0,
        position,
    }
}
