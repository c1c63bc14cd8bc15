//! Ranks that pass their states through archives, all the same parts at once.

use super::words::Word;
use bytemuck::{cast_slice, pod_read_unaligned};
use peridyne_comm::Comm;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;
use twox_hash::XxHash3_64;

/// Ranks that do the same with their archives.
pub(super) struct Ranks {
    comm: Arc<Comm>,
    /// Names and digests of all that must be the same on them.
    alike: Vec<(String, u64)>,
    /// All know of an error.
    pub over: bool,
}

impl Ranks {
    pub fn new(comm: &Arc<Comm>) -> Ranks {
        Ranks {
            comm: comm.clone(),
            alike: vec![],
            over: false,
        }
    }

    pub fn is_first(&self) -> bool {
        self.comm.rank() == 0
    }

    pub fn all(&self, own: &[u8]) -> Vec<Vec<u8>> {
        let all = self.comm.all(own);
        all.unwrap_or_else(|failure| self.comm.end(failure))
    }

    /// The bytes that the first rank has read, on all; false: it could not.
    pub fn hear(&self, read: bool, bytes: &mut [u8]) -> bool {
        let said = match (read, self.is_first()) {
            (true, true) => [&[1], &*bytes].concat(),
            (false, true) => vec![0],
            (_, false) => vec![],
        };
        let heard = self.all(&said);
        let [1, heard @ ..] = &heard[0][..] else {
            return false;
        };
        bytes.copy_from_slice(heard);
        true
    }

    /// These bytes are the same on all.
    pub fn digest(&mut self, name: String, bytes: &[u8]) {
        self.alike.push((name, XxHash3_64::oneshot(bytes)));
    }

    /// The first that was not.
    pub fn difference(&self) -> Option<String> {
        let own = self
            .alike
            .iter()
            .flat_map(|(_, digest)| digest.to_le_bytes());
        let all = self.all(&own.collect::<Vec<u8>>());
        let off = |other: &Vec<u8>| {
            let both = other.chunks(8).zip(all[0].chunks(8));
            let off = { both }.position(|(a, b)| a != b);
            off.or((other.len() != all[0].len()).then(|| other.len().min(all[0].len()) / 8))
        };
        let first = all.iter().filter_map(off).min()?;
        let name = { self.alike.get(first).or(self.alike.last()) }.map(|(name, _)| name.clone());
        Some(name.unwrap_or_default())
    }

    pub fn comm(&self) -> &Comm {
        &self.comm
    }

    /// Rows of so many words each, of all ranks, one after the other by id, on the first.
    pub fn merged(
        &self,
        ids: &[u32],
        lengths: &[u32],
        (each, own): (usize, Vec<u8>),
    ) -> Option<Vec<u8>> {
        let mut said = (ids.len() as u64).to_le_bytes().to_vec();
        said.extend_from_slice(cast_slice(ids));
        said.extend_from_slice(cast_slice(lengths));
        said.extend(own);
        let all = self.comm.first(said);
        let all = all.unwrap_or_else(|failure| self.comm.end(failure))?;
        let mut parts: Vec<Rows> = all.iter().map(|said| Rows::new(said, each)).collect();
        let mut whole = Vec::with_capacity(parts.iter().map(|part| part.rows.len()).sum());
        // each has its ids in order: one after the other, as long as no other rank's come between
        let first = |(rank, part): (usize, &Rows)| Some(Reverse((part.id()?, rank)));
        let mut next: BinaryHeap<_> = parts.iter().enumerate().filter_map(first).collect();
        while let Some(Reverse((_, rank))) = next.pop() {
            let part = &mut parts[rank];
            let other = next.peek().map_or(u32::MAX, |Reverse((id, _))| *id);
            while part.id().is_some_and(|id| id <= other) {
                whole.extend_from_slice(part.take());
            }
            next.extend(part.id().map(|id| Reverse((id, rank))));
        }
        Some(whole)
    }
}

/// What one rank says of its points, row by row.
struct Rows<'a> {
    ids: &'a [u8],
    lengths: &'a [u8],
    rows: &'a [u8],
    /// Bytes of a word.
    each: usize,
}

impl<'a> Rows<'a> {
    fn new(said: &'a [u8], each: usize) -> Rows<'a> {
        let (count, said) = said.split_at(8);
        let (ids, said) = said.split_at(4 * u64::take(count) as usize);
        let (lengths, rows) = said.split_at(ids.len());
        Rows {
            ids,
            lengths,
            rows,
            each,
        }
    }

    /// Whose row is next.
    fn id(&self) -> Option<u32> {
        Some(pod_read_unaligned(self.ids.get(..4)?))
    }

    fn take(&mut self) -> &'a [u8] {
        let words = pod_read_unaligned::<u32>(&self.lengths[..4]) as usize;
        // nothing of any: no rank has it
        let (row, rest) = self.rows.split_at((self.each * words).min(self.rows.len()));
        (self.ids, self.lengths, self.rows) = (&self.ids[4..], &self.lengths[4..], rest);
        row
    }
}
