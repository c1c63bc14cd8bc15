//! Ranks that pass their states through archives, all the same parts at once.

use super::words::Word;
use bytemuck::{cast_slice, pod_read_unaligned};
use peridyne_comm::Comm;
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
    pub fn apart(&self) -> Option<String> {
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
        let mut rows = vec![];
        for (rank, said) in all.iter().enumerate() {
            let count = u64::take(said) as usize;
            let numbers = |n: usize| {
                let bytes = said[8 + 4 * n * count..][..4 * count].chunks_exact(4);
                bytes.map(pod_read_unaligned::<u32>)
            };
            let mut begin = 8 + 8 * count;
            for (id, length) in numbers(0).zip(numbers(1)) {
                let end = begin + each * length as usize;
                // nothing of any: no rank has it
                let end = end.min(said.len());
                rows.push((id, rank, begin..end));
                begin = end;
            }
        }
        // of one rank in their order
        rows.sort_by_key(|(id, _, _)| *id);
        let mut whole = Vec::with_capacity(rows.iter().map(|(_, _, row)| row.len()).sum());
        for (_, rank, row) in rows {
            whole.extend_from_slice(&all[rank][row]);
        }
        Some(whole)
    }
}
