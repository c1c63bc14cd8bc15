//! What of a state is of points, of their bonds, or a sum over them: written in the order of ids, whoever has which, and read by whoever has them now.

use super::archive::{Archive, Owner, StateError};
use super::ranks::Ranks;
use super::words::Word;
use crate::execute::exact::Exact;

/// Whose numbers an owner has.
#[derive(Debug, Clone, Copy)]
pub struct Whose<'a> {
    /// Ids of the points that are here, in their order; `None`: all are, on every rank.
    pub ids: Option<&'a [u32]>,
    /// Points of all ranks.
    pub points: usize,
}

impl Whose<'_> {
    /// Points that are here.
    fn here(&self) -> usize {
        self.ids.map_or(self.points, <[u32]>::len)
    }

    fn id(&self, n: usize) -> u32 {
        self.ids.map_or(n as u32, |ids| ids[n])
    }

    /// The place here of one by its id.
    pub fn place(&self, id: u32) -> Option<usize> {
        match self.ids {
            None => Some(id as usize).filter(|id| *id < self.points),
            Some(ids) => ids.binary_search(&id).ok(),
        }
    }
}

/// How many bonds each point here has, and where rows of them begin in a state, as numbers and as bits.
#[derive(Debug, Clone)]
pub struct Bonds {
    counts: Vec<u32>,
    begin: Vec<[usize; 2]>,
    /// In the whole state.
    all: [usize; 2],
}

/// Numbers of a row, and bytes of its bits.
fn both(count: u32) -> [usize; 2] {
    [count as usize, count.div_ceil(8) as usize]
}

/// What of a list of words that is written once goes where: where each row here begins among all, and its length.
struct Rows<'a> {
    whose: Whose<'a>,
    begin: &'a dyn Fn(usize) -> usize,
    length: &'a dyn Fn(usize) -> usize,
    all: usize,
}

impl Archive<'_> {
    /// One error is all's.
    pub(super) fn agree(&mut self) {
        let Some(ranks) = &mut self.ranks else {
            return;
        };
        if ranks.over {
            return;
        }
        let own = self.error.as_ref().map(ToString::to_string);
        let told = ranks.all(own.unwrap_or_default().as_bytes());
        let told = told.into_iter().find(|text| !text.is_empty());
        if let Some(text) = told {
            ranks.over = true;
            let text = String::from_utf8_lossy(&text).into_owned();
            self.error.get_or_insert(StateError::Elsewhere(text));
        }
    }

    /// These are the same on all ranks, or [`Archive::same_on_all`] says that they are not.
    pub(super) fn alike<T: Word>(&mut self, name: &str, x: &[T]) {
        let Some(ranks) = &mut self.ranks else {
            return;
        };
        let name = format!("{}{name}", self.path);
        ranks.digest(name, &bytes_of(&mut x.iter().copied()));
    }

    pub(super) fn same_on_all(&mut self) {
        let difference = self.shared().and_then(Ranks::difference);
        if let Some(name) = difference {
            self.error.get_or_insert(StateError::Apart { name });
        }
    }

    /// `each` words of every point that is here, or none of any: those at these places among the values, in the order of ids.
    pub fn points<T: Word>(
        &mut self,
        name: &str,
        whose: Whose<'_>,
        each: usize,
        words: (&mut [T], impl Iterator<Item = usize>),
    ) {
        let each = if self.any(!words.0.is_empty()) {
            each
        } else {
            0
        };
        let rows = Rows {
            whose,
            begin: &|n| each * whose.id(n) as usize,
            length: &|_| each,
            all: each * whose.points,
        };
        self.part_of(name, &rows, words);
    }

    /// How many bonds each point here has; the state says the same.
    pub fn bonds(&mut self, name: &str, whose: Whose<'_>, counts: Vec<u32>) -> Bonds {
        let (mut id, mut found, mut begin, mut next) = (0, vec![], vec![], [0; 2]);
        let rows = Rows {
            whose,
            begin: &|n| whose.id(n) as usize,
            length: &|_| 1,
            all: whose.points,
        };
        let mut pass = |count: u32| {
            if found.len() < whose.here() && whose.id(found.len()) == id {
                found.push(count);
                begin.push(next);
            }
            id += 1;
            next = std::array::from_fn(|k| next[k] + both(count)[k]);
        };
        // every count, of others' points too
        self.part_with(name, &rows, &mut counts.iter().copied(), &mut pass);
        if !self.is_load() {
            counts.iter().for_each(|count| pass(*count));
        } else if found != counts {
            self.refuse(name);
        }
        Bonds {
            counts,
            begin,
            all: next,
        }
    }

    /// Those who share the model, as long as all is well.
    fn shared(&self) -> Option<&Ranks> {
        self.ranks.as_ref().filter(|ranks| !ranks.over)
    }

    /// Is it so on any rank?
    fn any(&self, here: bool) -> bool {
        match self.shared() {
            None => here,
            Some(ranks) => ranks.all(&[u8::from(here)]).concat().contains(&1),
        }
    }

    /// `each` words of every bond of the points that are here, in their order, or none of any: those at these places among the values.
    pub fn rows<T: Word>(
        &mut self,
        name: &str,
        whose: Whose<'_>,
        (bonds, each): (&Bonds, usize),
        words: (&mut [T], impl Iterator<Item = usize>),
    ) {
        let each = if self.any(!words.0.is_empty()) {
            each
        } else {
            0
        };
        self.of_bonds(name, whose, (bonds, [each, 0]), words);
    }

    /// A bit of every bond, those of a point in whole bytes.
    pub fn bits(&mut self, name: &str, whose: Whose<'_>, bonds: &Bonds, bytes: &mut [u8]) {
        let places = 0..bytes.len();
        self.of_bonds(name, whose, (bonds, [0, 1]), (bytes, places));
    }

    /// So many words for each number of a row, and for each byte of its bits.
    fn of_bonds<T: Word>(
        &mut self,
        name: &str,
        whose: Whose<'_>,
        (bonds, each): (&Bonds, [usize; 2]),
        words: (&mut [T], impl Iterator<Item = usize>),
    ) {
        let of = |[numbers, bytes]: [usize; 2]| each[0] * numbers + each[1] * bytes;
        let rows = Rows {
            whose,
            begin: &|n| bonds.begin.get(n).map_or(0, |begin| of(*begin)),
            length: &|n| of(both(bonds.counts[n])),
            all: of(bonds.all),
        };
        self.part_of(name, &rows, words);
    }

    fn part_of<T: Word>(
        &mut self,
        name: &str,
        rows: &Rows<'_>,
        (values, places): (&mut [T], impl Iterator<Item = usize>),
    ) {
        // what has no words has no places
        let mut places = places.filter(|_| rows.all > 0);
        if !self.is_load() {
            let mut words = places.map(|place| values[place]);
            return self.part_with(name, rows, &mut words, &mut |_| {});
        }
        let (mut n, mut at) = (0, 0);
        self.part_with(name, rows, &mut std::iter::empty(), &mut |word| {
            while n < rows.whose.here() && at >= (rows.begin)(n) + (rows.length)(n) {
                n += 1;
            }
            if n < rows.whose.here()
                && at >= (rows.begin)(n)
                && let Some(place) = places.next()
            {
                values[place] = word;
            }
            at += 1;
        });
    }

    /// Rows of all ranks, one after the other by id: written, or each word heard.
    fn part_with<T: Word>(
        &mut self,
        name: &str,
        rows: &Rows<'_>,
        words: &mut dyn Iterator<Item = T>,
        hear: &mut dyn FnMut(T),
    ) {
        self.try_to(|archive| {
            if archive.is_load() {
                let length = archive.header(name, rows.all, T::BYTES)?.unwrap_or(0);
                if length != rows.all as u64 {
                    return Err(archive.size(name, rows.all.to_string(), length.to_string()));
                }
                return archive.take(rows.all, hear);
            }
            let ranks = archive.ranks.as_ref();
            let Some(ranks) = ranks.filter(|_| rows.whose.ids.is_some()) else {
                return archive.put_alike(name, rows.all, words);
            };
            let here = rows.whose.here();
            let ids: Vec<u32> = (0..here).map(|n| rows.whose.id(n)).collect();
            let lengths: Vec<u32> = (0..here).map(|n| (rows.length)(n) as u32).collect();
            let merged = ranks.merged(&ids, &lengths, (T::BYTES, bytes_of(words)));
            archive.put_merged::<T>(name, merged)
        });
    }

    /// So many words that every rank has.
    fn put_alike<T: Word>(
        &mut self,
        name: &str,
        count: usize,
        words: &mut dyn Iterator<Item = T>,
    ) -> Result<(), StateError> {
        self.header(name, count, T::BYTES)?;
        if self.ranks.is_none() {
            return self.put_each(words);
        }
        let words: Vec<T> = words.collect();
        self.alike(name, &words);
        self.put(&words)
    }

    /// Words of all ranks, which the first one has.
    fn put_merged<T: Word>(&mut self, name: &str, all: Option<Vec<u8>>) -> Result<(), StateError> {
        let Some(all) = all else { return Ok(()) };
        self.header(name, all.len() / T::BYTES, T::BYTES)?;
        self.put_each(&mut all.chunks(T::BYTES).map(T::take))
    }

    /// A list that the first rank has.
    pub fn list_of_first<T: Word>(&mut self, name: &str, x: &mut Vec<T>) {
        let first = self.shared().is_none_or(Ranks::is_first);
        self.try_to(|archive| {
            let Some(length) = archive.header(name, x.len(), T::BYTES)? else {
                return archive.put(x);
            };
            x.clear();
            archive.take(length as usize, &mut |value| {
                if first {
                    x.push(value);
                }
            })
        });
    }

    /// What some points have, by their ids: each may have any number of them. They come back in the order of ids.
    pub fn entries<T: Word>(&mut self, name: &str, whose: Whose<'_>, x: &mut Vec<(u32, T)>) {
        x.sort_by_key(|(id, _)| *id);
        self.try_to(|archive| {
            let each = <(u32, T)>::BYTES;
            if archive.is_load() {
                let length = archive.header(name, 0, each)?.unwrap_or(0);
                let mut known = true;
                x.clear();
                archive.take(length as usize, &mut |entry: (u32, T)| {
                    known &= (entry.0 as usize) < whose.points;
                    if whose.place(entry.0).is_some() {
                        x.push(entry);
                    }
                })?;
                return match known {
                    true => Ok(()),
                    false => Err(archive.invalid(name)),
                };
            }
            let ranks = archive.ranks.as_ref();
            let Some(ranks) = ranks.filter(|_| whose.ids.is_some()) else {
                return archive.put_alike(name, x.len(), &mut x.iter().copied());
            };
            let ids: Vec<u32> = x.iter().map(|(id, _)| *id).collect();
            let ones = vec![1; x.len()];
            let merged = ranks.merged(&ids, &ones, (each, bytes_of(&mut x.iter().copied())));
            archive.put_merged::<(u32, T)>(name, merged)
        });
    }

    /// A sum of which every rank has its part; one of those that go on has all of it.
    pub fn sum(&mut self, name: &str, x: &mut Exact) {
        let mut parts = vec![];
        if !self.is_load() {
            match self.shared() {
                None => parts = x.parts(),
                Some(ranks) => {
                    let mut whole = [x.clone()];
                    Exact::of_all(&mut whole, ranks.comm());
                    parts = whole[0].parts();
                }
            }
        }
        self.list(name, &mut parts);
        if self.loads() {
            *x = match &self.ranks {
                Some(ranks) if !ranks.is_first() => Exact::ZERO,
                Some(_) | None => parts.into_iter().collect(),
            };
        }
    }

    /// A count of which every rank has its part.
    pub fn count(&mut self, name: &str, x: &mut u64) {
        let mut whole = *x;
        if let (Some(ranks), false) = (self.shared(), self.is_load()) {
            let all = ranks.all(&x.to_le_bytes());
            whole = all.iter().map(|x| u64::take(x)).sum();
        }
        self.one(name, &mut whole);
        if self.loads() {
            *x = match &self.ranks {
                Some(ranks) if !ranks.is_first() => 0,
                Some(_) | None => whole,
            };
        }
    }

    /// The most of any rank.
    pub fn most(&mut self, name: &str, x: &mut f64) {
        if let (Some(ranks), false) = (self.shared(), self.is_load()) {
            let all = ranks.all(&x.to_le_bytes());
            *x = all.iter().map(|x| f64::take(x)).fold(*x, f64::max);
        }
        self.one(name, x);
    }
}

impl Owner for Exact {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.sum("parts", self);
    }
}

fn bytes_of<T: Word>(words: &mut dyn Iterator<Item = T>) -> Vec<u8> {
    let mut bytes = vec![];
    for word in words {
        let end = bytes.len();
        bytes.resize(end + T::BYTES, 0);
        word.put(&mut bytes[end..]);
    }
    bytes
}
