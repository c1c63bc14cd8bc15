//! Where the chunks of datasets are: B-trees of version 1 that grow to the right alone, so that all nodes but the last of each level are
//! full, and what is in a node follows from how many chunks there are.

/// An address of nothing.
pub const NOWHERE: u64 = u64::MAX;

/// Children of a full node: twice the K that a superblock of version 0 means.
const FULL: u64 = 64;

/// Chunks of a dataset, which follow one another along its first dimension.
#[derive(Debug, Clone, Copy)]
pub struct Chunks {
    /// Dimensions.
    pub rank: u64,
    /// Rows and bytes of a chunk.
    pub rows: u64,
    pub bytes: u64,
}

impl Chunks {
    /// Length of a node.
    pub fn node(&self) -> u64 {
        24 + (FULL + 1) * self.key() + FULL * 8
    }

    /// Length of a key: bytes of a chunk, filters that it has not, and where it begins; the size of a number counts as a dimension.
    fn key(&self) -> u64 {
        8 + 8 * (self.rank + 1)
    }
}

/// Addresses of the nodes of a tree, or of the first of several trees that have nodes side by side, for datasets with equally many chunks.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Tree {
    /// From the leaves up.
    levels: Vec<Vec<u64>>,
    /// Chunks.
    count: u64,
}

/// Chunks below a node of this level.
fn reach(level: usize) -> u64 {
    FULL.saturating_pow(level as u32 + 1)
}

impl Tree {
    /// So many chunks come; `room` gives places for the nodes that come with them.
    pub fn grow(&mut self, chunks: u64, mut room: impl FnMut() -> u64) {
        self.count += chunks;
        let mut level = 0;
        loop {
            if self.levels.len() == level {
                self.levels.push(vec![]);
            }
            let nodes = self.count.div_ceil(reach(level));
            while (self.levels[level].len() as u64) < nodes {
                self.levels[level].push(room());
            }
            if nodes <= 1 {
                return;
            }
            level += 1;
        }
    }

    /// Address of the root, as many bytes behind that of the first tree; [`NOWHERE`] while there are no chunks.
    pub fn root(&self, behind: u64) -> u64 {
        let top = self.levels.last().and_then(|nodes| nodes.first());
        top.map_or(NOWHERE, |address| address + behind)
    }

    /// Level and number of the nodes in which something changed since there were so many chunks.
    pub fn changed(&self, since: u64) -> Vec<(usize, usize)> {
        let mut all = vec![];
        for (level, nodes) in self.levels.iter().enumerate() {
            // the last node of then, too: it may have a neighbour now
            let first = (since.max(1) - 1) / reach(level);
            all.extend((first as usize..nodes.len()).map(|n| (level, n)));
        }
        all
    }

    /// Address and bytes of a node of a dataset of these chunks, as many bytes behind the first tree's; `place` says where a chunk is.
    pub fn node(
        &self,
        (level, n): (usize, usize),
        chunks: &Chunks,
        behind: u64,
        place: impl Fn(u64) -> u64,
    ) -> (u64, Vec<u8>) {
        let nodes = &self.levels[level];
        let at = |n: Option<usize>| {
            let address = n.and_then(|n| nodes.get(n));
            address.map_or(NOWHERE, |address| address + behind)
        };
        let below = reach(level) / FULL;
        let first = n as u64 * FULL;
        let children = self.count.div_ceil(below).min(first + FULL) - first;
        let mut w = b"TREE".to_vec();
        w.extend([1, level as u8]);
        w.extend((children as u16).to_le_bytes());
        w.extend(at(n.checked_sub(1)).to_le_bytes());
        w.extend(at(Some(n + 1)).to_le_bytes());
        let key = |w: &mut Vec<u8>, chunk: u64| {
            w.extend((chunks.bytes as u32).to_le_bytes());
            w.extend([0; 4]);
            w.extend((chunk * chunks.rows).to_le_bytes());
            w.resize(w.len() + 8 * chunks.rank as usize, 0);
        };
        for child in first..first + children {
            key(&mut w, child * below);
            let address = match level {
                0 => place(child),
                _ => self.levels[level - 1][child as usize] + behind,
            };
            w.extend(address.to_le_bytes());
        }
        key(&mut w, ((first + children) * below).min(self.count));
        w.resize(chunks.node() as usize, 0);
        (nodes[n] + behind, w)
    }
}
