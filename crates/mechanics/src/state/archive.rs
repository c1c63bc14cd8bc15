//! The stream of a state: named arrays, one after the other.

use super::ranks::Ranks;
use super::words::Word;
use peridyne_comm::Comm;
use std::fmt;
use std::io::{self, Read, Write};
use std::ops::DerefMut;
use std::sync::Arc;

/// Has numbers that cannot be found again.
pub trait Owner {
    /// Passes them through an archive, always in the same order; after reading, what follows from them is found anew.
    fn archive(&mut self, archive: &mut Archive<'_>);
}

/// Bytes that are turned into numbers at a time: no length that a file states asks for more room than it has numbers.
const PIECE: usize = 1 << 16;
/// Longest name of an array with the parts that it is in.
const NAME: usize = 255;

/// Why a state cannot be read, or written.
#[derive(Debug)]
pub enum StateError {
    /// The stream ended, or did not take what was written.
    Stream(io::Error),
    /// Another array than the model has at this place.
    Other { expected: String, found: String },
    /// An array of another size or kind than the model's.
    Size {
        name: String,
        expected: String,
        found: String,
    },
    /// Numbers that no model of this kind has.
    Invalid { name: String },
    /// What is there and what is not does not fit the model.
    Choice { name: String, found: bool },
    /// Ranks have other numbers where all have the same.
    Apart { name: String },
    /// Another rank says what is wrong.
    Elsewhere(String),
}

impl fmt::Display for StateError {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StateError::Stream(e) if e.kind() == io::ErrorKind::UnexpectedEof => {
                write!(to, "the state ends too early")
            }
            StateError::Stream(e) => write!(to, "{e}"),
            StateError::Other { expected, found } => write!(
                to,
                "the state has `{found}` where this model has `{expected}`"
            ),
            StateError::Size {
                name,
                expected,
                found,
            } => write!(
                to,
                "`{name}` of the state has {found}, this model has {expected}"
            ),
            StateError::Invalid { name } => write!(
                to,
                "`{name}` of the state names what is not there: the state is damaged"
            ),
            StateError::Choice { name, found } => match found {
                true => write!(to, "the state has `{name}`, this model does not"),
                false => write!(to, "the state has no `{name}`, this model does"),
            },
            StateError::Apart { name } => write!(
                to,
                "`{name}` of the state is not the same on all ranks: a fault of this program"
            ),
            StateError::Elsewhere(what) => write!(to, "{what}"),
        }
    }
}

impl std::error::Error for StateError {}

enum Way<'a> {
    Save(&'a mut dyn Write),
    Load(&'a mut dyn Read),
    /// Of ranks that the first writes for, and reads for.
    SaveThere,
    LoadThere,
}

/// A state that is written down, or read back: every call passes an array of the model through it. After the first error nothing
/// more is done; [`Archive::done`] tells it.
///
/// Ranks that share a model pass theirs through archives [of all](Archive::among) at once. What is written is what one rank would write that had all: what
/// all have alike once, [points](Archive::points), [rows of them](Archive::rows) and [entries](Archive::entries) by their ids, and [sums](Archive::sum)
/// added up. So any number of ranks reads it.
pub struct Archive<'a> {
    way: Way<'a>,
    /// The parts that the next array is in, each with a dot behind it.
    pub(super) path: String,
    pub(super) error: Option<StateError>,
    /// Who shares the model, while all do what is done here.
    pub(super) ranks: Option<Ranks>,
}

impl<'a> Archive<'a> {
    pub fn save(to: &'a mut dyn Write) -> Archive<'a> {
        Archive::new(Way::Save(to))
    }

    pub fn load(from: &'a mut dyn Read) -> Archive<'a> {
        Archive::new(Way::Load(from))
    }

    fn new(way: Way<'a>) -> Archive<'a> {
        Archive {
            way,
            path: String::new(),
            error: None,
            ranks: None,
        }
    }

    /// What `work` passes through is of all ranks, which all do the same; this is the first of them.
    pub fn among(&mut self, comm: &Arc<Comm>, work: impl FnOnce(&mut Self)) {
        self.ranks = Some(Ranks::new(comm));
        work(self);
        self.agree();
        self.same_on_all();
        self.ranks = None;
    }

    /// Passes a state through that the first rank writes, or reads: `work` is what it does [among](Archive::among) all, within parts of this `path`. What is
    /// wrong on any rank the first one knows.
    pub fn there(comm: &Arc<Comm>, load: bool, path: &str, work: impl FnOnce(&mut Self)) {
        let mut archive = Archive::new(match load {
            true => Way::LoadThere,
            false => Way::SaveThere,
        });
        archive.path = path.into();
        archive.among(comm, work);
    }

    /// The parts that the next array is in, each with a dot behind it.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Are numbers read, well or not?
    pub fn is_load(&self) -> bool {
        matches!(self.way, Way::Load(_) | Way::LoadThere)
    }

    /// Are numbers read, and all of them well so far, on all ranks? Whoever derives something from them looks again then.
    pub fn loads(&mut self) -> bool {
        self.agree();
        self.is_load() && self.error.is_none()
    }

    /// # Errors
    /// The first that happened; a model that was read into is of no use then.
    pub fn done(self) -> Result<(), StateError> {
        self.error.map_or(Ok(()), Err)
    }

    /// Something that owns a part of the state.
    pub fn part(&mut self, name: &str, owner: &mut (impl Owner + ?Sized)) {
        self.within(name, |archive| owner.archive(archive));
    }

    /// What `work` passes through is called by names in this part.
    pub fn within(&mut self, name: &str, work: impl FnOnce(&mut Self)) {
        let before = self.path.len();
        self.path.push_str(name);
        self.path.push('.');
        work(self);
        self.path.truncate(before);
    }

    /// One number.
    pub fn one<T: Word>(&mut self, name: &str, x: &mut T) {
        self.all(name, std::slice::from_mut(x));
    }

    /// An array as long as the model says.
    pub fn all<T: Word>(&mut self, name: &str, x: &mut [T]) {
        self.try_to(|archive| {
            if !archive.is_load() {
                archive.alike(name, x);
            }
            match archive.header(name, x.len(), T::BYTES)? {
                None => return archive.put(x),
                Some(length) if length == x.len() as u64 => {}
                Some(length) => {
                    return Err(archive.size(name, x.len().to_string(), length.to_string()));
                }
            }
            let mut at = 0;
            archive.take(x.len(), &mut |value| {
                x[at] = value;
                at += 1;
            })
        });
    }

    /// Columns of the model, one after the other.
    pub fn columns<C: DerefMut<Target = [f64]>>(&mut self, name: &str, columns: &mut [C]) {
        columns.iter_mut().for_each(|c| self.all(name, c));
    }

    /// An array as long as the state says.
    pub fn list<T: Word>(&mut self, name: &str, x: &mut Vec<T>) {
        self.try_to(|archive| {
            if !archive.is_load() {
                archive.alike(name, x);
            }
            let Some(length) = archive.header(name, x.len(), T::BYTES)? else {
                return archive.put(x);
            };
            x.clear();
            archive.take(length as usize, &mut |value| x.push(value))
        });
    }

    /// A list of lists.
    pub fn lists<T: Word>(&mut self, name: &str, x: &mut Vec<Vec<T>>) {
        self.items(name, x, Vec::new, |list, archive| {
            archive.list("list", list);
        });
    }

    /// A text.
    pub fn text(&mut self, name: &str, x: &mut String) {
        let mut bytes = std::mem::take(x).into_bytes();
        self.list(name, &mut bytes);
        match String::from_utf8(bytes) {
            Ok(text) => *x = text,
            Err(_) => self.refuse(name),
        }
    }

    /// As many things as the state says; `make` makes those that the model has not.
    pub fn items<T>(
        &mut self,
        name: &str,
        x: &mut Vec<T>,
        mut make: impl FnMut() -> T,
        mut pass: impl FnMut(&mut T, &mut Self),
    ) {
        self.within(name, |archive| {
            let mut count = x.len() as u64;
            archive.one("count", &mut count);
            if !archive.loads() {
                return x.iter_mut().for_each(|x| pass(x, archive));
            }
            x.clear();
            for _ in 0..count {
                let mut item = make();
                pass(&mut item, archive);
                if !archive.loads() {
                    return;
                }
                x.push(item);
            }
        });
    }

    /// Owners, as many as the model has.
    pub fn parts<T: Owner>(&mut self, name: &str, owners: &mut [T]) {
        self.each(name, owners, |owner, archive| owner.archive(archive));
    }

    /// As many things as the model has.
    pub fn each<T>(&mut self, name: &str, all: &mut [T], mut pass: impl FnMut(&mut T, &mut Self)) {
        let mut count = all.len() as u64;
        self.same(name, &mut count);
        for one in all {
            self.within(name, |archive| pass(one, archive));
        }
    }

    /// A number that must be the model's.
    pub fn same<T: Word + PartialEq + fmt::Debug>(&mut self, name: &str, x: &mut T) {
        let mine = *x;
        self.one(name, x);
        if self.loads() && *x != mine {
            self.error = Some(self.size(name, format!("{mine:?}"), format!("{:?}", *x)));
        }
    }

    /// Something that is there now or not; `make` makes it where the state has it and the model has not. It is taken away where the
    /// state has none.
    pub fn option<T>(
        &mut self,
        name: &str,
        x: &mut Option<T>,
        make: impl FnOnce() -> T,
        pass: impl FnOnce(&mut T, &mut Self),
    ) {
        let mut there = x.is_some();
        self.one(name, &mut there);
        if self.loads() {
            match there {
                true if x.is_none() => *x = Some(make()),
                true => {}
                false => *x = None,
            }
        }
        if let (true, Some(x)) = (there && self.error.is_none(), x.as_mut()) {
            self.within(name, |archive| pass(x, archive));
        }
    }

    /// Something that the specification gives a model or not: the state must have it where the model does.
    pub fn given<T>(
        &mut self,
        name: &str,
        x: &mut Option<T>,
        pass: impl FnOnce(&mut T, &mut Self),
    ) {
        let mut there = x.is_some();
        self.one(name, &mut there);
        if self.loads() && there != x.is_some() {
            self.error = Some(StateError::Choice {
                name: format!("{}{name}", self.path),
                found: there,
            });
        }
        if let (None, Some(x)) = (&self.error, x.as_mut()) {
            self.within(name, |archive| pass(x, archive));
        }
    }

    /// What was read names what is not there.
    pub fn refuse(&mut self, name: &str) {
        let error = self.invalid(name);
        self.error.get_or_insert(error);
    }

    pub(super) fn invalid(&self, name: &str) -> StateError {
        StateError::Invalid {
            name: format!("{}{name}", self.path),
        }
    }

    pub(super) fn size(&self, name: &str, expected: String, found: String) -> StateError {
        StateError::Size {
            name: format!("{}{name}", self.path),
            expected,
            found,
        }
    }

    pub(super) fn try_to(&mut self, work: impl FnOnce(&mut Self) -> Result<(), StateError>) {
        self.agree();
        if self.error.is_none()
            && let Err(error) = work(self)
        {
            self.error = Some(error);
        }
    }

    /// Name, bytes of an element, and number of elements: written, or compared with what stands there, whose number is answered.
    pub(super) fn header(
        &mut self,
        name: &str,
        length: usize,
        each: usize,
    ) -> Result<Option<u64>, StateError> {
        let name = format!("{}{name}", self.path);
        assert!(name.len() <= NAME, "{name}: names are at most {NAME} bytes");
        match &mut self.way {
            Way::Save(to) => {
                let mut head = vec![name.len() as u8];
                head.extend_from_slice(name.as_bytes());
                head.extend_from_slice(&(each as u32).to_le_bytes());
                head.extend_from_slice(&(length as u64).to_le_bytes());
                to.write_all(&head).map_err(StateError::Stream)?;
                Ok(None)
            }
            Way::SaveThere => Ok(None),
            Way::Load(_) | Way::LoadThere => {
                let mut long = [0];
                self.read(&mut long)?;
                let mut head = vec![0; usize::from(long[0]) + 12];
                self.read(&mut head)?;
                let (found, rest) = head.split_at(usize::from(long[0]));
                if found != name.as_bytes() {
                    return Err(StateError::Other {
                        expected: name,
                        found: String::from_utf8_lossy(found).into_owned(),
                    });
                }
                let bytes = u32::take(rest);
                if bytes as usize != each {
                    return Err(StateError::Size {
                        name,
                        expected: format!("{} bytes for each number", each),
                        found: bytes.to_string(),
                    });
                }
                Ok(Some(u64::take(&rest[4..])))
            }
        }
    }

    /// Reads as many bytes; those of the first rank, on all.
    fn read(&mut self, bytes: &mut [u8]) -> Result<(), StateError> {
        let own = match &mut self.way {
            Way::Load(from) => from.read_exact(bytes).map_err(StateError::Stream),
            Way::Save(_) | Way::SaveThere | Way::LoadThere => Ok(()),
        };
        match &self.ranks {
            None => own,
            Some(ranks) if ranks.hear(own.is_ok(), bytes) => Ok(()),
            Some(_) => own.and(Err(StateError::Elsewhere(String::new()))),
        }
    }

    pub(super) fn put<T: Word>(&mut self, x: &[T]) -> Result<(), StateError> {
        self.put_each(&mut x.iter().copied())
    }

    /// In pieces: no column is there twice.
    pub(super) fn put_each<T: Word>(
        &mut self,
        words: &mut dyn Iterator<Item = T>,
    ) -> Result<(), StateError> {
        let Way::Save(to) = &mut self.way else {
            return Ok(());
        };
        let mut workspace = vec![];
        for word in words {
            let at = workspace.len();
            workspace.resize(at + T::BYTES, 0);
            word.put(&mut workspace[at..]);
            if workspace.len() >= PIECE {
                to.write_all(&workspace).map_err(StateError::Stream)?;
                workspace.clear();
            }
        }
        to.write_all(&workspace).map_err(StateError::Stream)
    }

    pub(super) fn take<T: Word>(
        &mut self,
        length: usize,
        to: &mut dyn FnMut(T),
    ) -> Result<(), StateError> {
        let each = (PIECE / T::BYTES.max(1)).max(1);
        let mut workspace = vec![0; each.min(length) * T::BYTES];
        let mut left = length;
        while left > 0 {
            let now = each.min(left);
            let bytes = &mut workspace[..now * T::BYTES];
            self.read(bytes)?;
            bytes.chunks(T::BYTES).for_each(|x| to(T::take(x)));
            left -= now;
        }
        Ok(())
    }
}

impl fmt::Debug for Archive<'_> {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.debug_struct("Archive")
            .field("path", &self.path)
            .field("error", &self.error)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Default, PartialEq)]
    struct Some2 {
        numbers: Vec<f64>,
        bits: [u8; 5],
        next: Option<Vec<u32>>,
        rows: Vec<Vec<u64>>,
        given: Option<f64>,
    }

    impl Owner for Some2 {
        fn archive(&mut self, a: &mut Archive<'_>) {
            a.list("numbers", &mut self.numbers);
            a.all("bits", &mut self.bits);
            a.option("next", &mut self.next, Vec::new, |x, a| a.list("ids", x));
            a.lists("rows", &mut self.rows);
            a.given("given", &mut self.given, |x, a| a.one("value", x));
        }
    }

    fn made() -> Some2 {
        Some2 {
            numbers: (0..20_000).map(|n| 1.0 / f64::from(n)).collect(),
            bits: [1, 2, 3, 255, 0],
            next: Some(vec![3, 1]),
            rows: vec![vec![1], vec![], vec![u64::MAX; 3]],
            given: Some(0.25),
        }
    }

    fn bytes(of: &mut Some2) -> Vec<u8> {
        let mut to = vec![];
        let mut archive = Archive::save(&mut to);
        archive.part("it", of);
        archive.done().unwrap();
        to
    }

    fn read(mut bytes: &[u8], into: &mut Some2) -> Result<(), StateError> {
        let mut archive = Archive::load(&mut bytes);
        archive.part("it", into);
        archive.done()
    }

    #[test]
    fn what_was_saved_is_loaded() {
        let mut to = Some2 {
            given: Some(1.0),
            ..Some2::default()
        };
        read(&bytes(&mut made()), &mut to).unwrap();
        assert_eq!(to, made());
        // what the state has not is taken away
        let none = bytes(&mut Some2 {
            next: None,
            ..made()
        });
        read(&none, &mut to).unwrap();
        assert_eq!(to.next, None);
    }

    #[test]
    fn what_differs_on_ranks_where_it_must_not_is_named() {
        let saved = |off: bool| {
            let all = peridyne_comm::on_threads(2, |comm| {
                let comm = Arc::new(comm);
                let mut of = made();
                if off && comm.rank() == 1 {
                    of.rows[2][1] = 0;
                }
                if comm.rank() == 1 {
                    Archive::there(&comm, false, "", |a| a.part("it", &mut of));
                    return None;
                }
                let mut to = vec![];
                let mut archive = Archive::save(&mut to);
                archive.among(&comm, |a| a.part("it", &mut of));
                let done = archive.done().map_err(|e| e.to_string());
                Some(done.map(|()| to))
            });
            all.into_iter().flatten().next().unwrap()
        };
        assert_eq!(saved(false), Ok(bytes(&mut made())));
        let said = saved(true).unwrap_err();
        assert!(said.contains("`it.rows.list`"), "{said}");
    }

    #[test]
    fn every_cut_and_every_other_model_is_an_error() {
        let all = bytes(&mut Some2 {
            numbers: vec![1.0; 3],
            ..made()
        });
        for end in 0..all.len() {
            let mut to = made();
            let error = read(&all[..end], &mut to).unwrap_err();
            assert!(matches!(error, StateError::Stream(_)), "{end}: {error}");
        }
        let mut other = Some2::default();
        let error = read(&all, &mut other).unwrap_err().to_string();
        assert_eq!(error, "the state has `it.given`, this model does not");
        let mut broken = all.clone();
        broken[5] ^= 4;
        let error = read(&broken, &mut made()).unwrap_err().to_string();
        assert!(
            error.contains("where this model has `it.numbers`"),
            "{error}"
        );
        // a length beyond what is there asks for no room
        let mut long = all;
        let at = 1 + "it.numbers".len() + 4;
        long[at..at + 8].copy_from_slice(&(u64::MAX / 16).to_le_bytes());
        let error = read(&long, &mut made()).unwrap_err();
        assert!(matches!(error, StateError::Stream(_)), "{error}");
    }
}
