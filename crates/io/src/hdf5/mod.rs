//! HDF5 as far as files that grow frame by frame need it, written: superblock 0, object headers of version 1 with links in them, datasets
//! in one piece or in chunks, whose places B-trees of version 1 hold.
//!
//! Names and numbers are those of the HDF5 file format specification, version 3. Nothing here has a checksum in the file: numbers that change
//! as a file grows (lengths, counts, addresses) are eight bytes each, which can be written over where they stand.

mod tree;

pub use tree::{Chunks, NOWHERE, Tree};

/// Length of the superblock, the first of a file.
pub const SUPERBLOCK: u64 = 96;

/// What a number is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    F64,
    I64,
    I32,
    U32,
    U8,
}

impl Number {
    /// Bytes.
    pub fn size(self) -> u64 {
        match self {
            Number::F64 | Number::I64 => 8,
            Number::I32 | Number::U32 => 4,
            Number::U8 => 1,
        }
    }

    fn datatype(self) -> Vec<u8> {
        let whole = |signed: bool| {
            let size = self.size();
            let mut bytes = vec![0x10, u8::from(signed) << 3, 0, 0];
            bytes.extend((size as u32).to_le_bytes());
            bytes.extend(0u16.to_le_bytes());
            bytes.extend((8 * size as u16).to_le_bytes());
            bytes
        };
        match self {
            // IEEE double, least byte first: sign bit 63, exponent of 11 bits from 52 on, mantissa below with its first bit implied
            Number::F64 => vec![
                0x11, 0x20, 63, 0, 8, 0, 0, 0, 0, 0, 64, 0, 52, 11, 0, 52, 255, 3, 0, 0,
            ],
            Number::I64 | Number::I32 => whole(true),
            Number::U32 | Number::U8 => whole(false),
        }
    }
}

/// Value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute<'a> {
    /// ASCII.
    Text(&'a str),
    One(i64),
    Many(&'a [i64]),
}

impl Attribute<'_> {
    fn datatype(&self) -> Vec<u8> {
        match self {
            // a string padded with zeros
            Attribute::Text(text) => {
                let length = (text.len() as u32).to_le_bytes();
                [&[0x13, 1, 0, 0][..], &length].concat()
            }
            Attribute::One(_) | Attribute::Many(_) => Number::I64.datatype(),
        }
    }

    fn dataspace(&self) -> Vec<u8> {
        match self {
            Attribute::Text(_) | Attribute::One(_) => dataspace(&[], false),
            Attribute::Many(all) => dataspace(&[all.len() as u64], false),
        }
    }

    fn bytes(&self) -> Vec<u8> {
        match self {
            Attribute::Text(text) => text.as_bytes().to_vec(),
            Attribute::One(x) => x.to_le_bytes().into(),
            Attribute::Many(all) => all.iter().flat_map(|x| x.to_le_bytes()).collect(),
        }
    }
}

/// Where the numbers of a dataset are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// In one piece at this address.
    Piece(u64),
    /// In chunks of so many rows, whose places the tree at this address holds; the first dimension has no end.
    Chunks { rows: u64, tree: u64 },
    /// Nowhere: all are this number. The first dimension has no end.
    All(i64),
}

/// A dataset.
#[derive(Debug, Clone, Copy)]
pub struct Dataset<'a> {
    pub number: Number,
    pub dimensions: &'a [u64],
    pub storage: Storage,
    pub attributes: &'a [(&'a str, Attribute<'a>)],
    /// How many names it has.
    pub links: u32,
}

/// The first bytes of a file: superblock and object headers, which keep their places whatever the numbers in them are.
#[derive(Debug, Default)]
pub struct Head {
    bytes: Vec<u8>,
}

impl Head {
    pub fn new() -> Head {
        Head {
            bytes: vec![0; SUPERBLOCK as usize],
        }
    }

    /// Adds the header of a dataset; its address.
    pub fn dataset(&mut self, of: &Dataset) -> u64 {
        let mut messages = vec![
            (DATASPACE, dataspace(of.dimensions, of.grows())),
            (DATATYPE, of.number.datatype()),
            (FILL, of.fill()),
            (LAYOUT, of.layout()),
        ];
        messages.extend(of.attributes.iter().map(attribute));
        self.object(of.links, &messages)
    }

    /// Adds the header of a group with what is in it, by name and address; its own address. A group has one name.
    pub fn group(&mut self, attributes: &[(&str, Attribute)], children: &[(&str, u64)]) -> u64 {
        let nowhere = NOWHERE.to_le_bytes();
        let mut messages = vec![
            (LINK_INFO, [&[0, 0][..], &nowhere, &nowhere].concat()),
            (GROUP_INFO, vec![0, 0]),
        ];
        messages.extend(attributes.iter().map(attribute));
        for (name, address) in children {
            // a hard link; one byte says how long the name is, as no name is longer than that
            let head = [1, 0, name.len() as u8];
            let link = [&head[..], name.as_bytes(), &address.to_le_bytes()].concat();
            messages.push((LINK, link));
        }
        self.object(1, &messages)
    }

    /// What comes next begins at a multiple of so many bytes.
    pub fn align(&mut self, to: usize) {
        self.bytes.resize(self.bytes.len().next_multiple_of(to), 0);
    }

    fn object(&mut self, links: u32, messages: &[(u16, Vec<u8>)]) -> u64 {
        let address = self.bytes.len() as u64;
        let length = |m: &Vec<u8>| m.len().next_multiple_of(8);
        let all: usize = messages.iter().map(|(_, m)| 8 + length(m)).sum();
        let w = &mut self.bytes;
        w.extend([1, 0]);
        w.extend((messages.len() as u16).to_le_bytes());
        w.extend(links.to_le_bytes());
        w.extend((all as u32).to_le_bytes());
        w.extend([0; 4]);
        for (kind, message) in messages {
            w.extend(kind.to_le_bytes());
            w.extend((length(message) as u16).to_le_bytes());
            w.extend([0; 4]);
            w.extend(message);
            w.resize(w.len().next_multiple_of(8), 0);
        }
        address
    }

    /// The bytes of a file of this length, whose root group is at `root`.
    pub fn finish(mut self, root: u64, length: u64) -> Vec<u8> {
        let mut w = b"\x89HDF\r\n\x1a\n".to_vec();
        // versions of the superblock, of free space, of the root's entry and of shared messages; bytes of addresses and lengths
        w.extend([0, 0, 0, 0, 0, 8, 8, 0]);
        // halves of a node of the trees of groups, of which there are none
        w.extend([4, 0, 16, 0, 0, 0, 0, 0]);
        for address in [0, NOWHERE, length, NOWHERE, 0, root] {
            w.extend(address.to_le_bytes());
        }
        // nothing of the root is kept in its entry
        w.extend([0; 24]);
        self.bytes[..SUPERBLOCK as usize].copy_from_slice(&w);
        self.bytes
    }
}

const DATASPACE: u16 = 1;
const LINK_INFO: u16 = 2;
const DATATYPE: u16 = 3;
const FILL: u16 = 5;
const LINK: u16 = 6;
const LAYOUT: u16 = 8;
const GROUP_INFO: u16 = 10;
const ATTRIBUTE: u16 = 12;

/// A dataspace; with `grows` the first dimension has no end.
fn dataspace(dimensions: &[u64], grows: bool) -> Vec<u8> {
    let mut bytes = vec![1, dimensions.len() as u8, u8::from(grows), 0, 0, 0, 0, 0];
    let lengths = |all: &[u64]| -> Vec<u8> { all.iter().flat_map(|n| n.to_le_bytes()).collect() };
    bytes.extend(lengths(dimensions));
    if grows {
        bytes.extend(lengths(&[NOWHERE]));
        bytes.extend(lengths(&dimensions[1..]));
    }
    bytes
}

fn attribute((name, value): &(&str, Attribute)) -> (u16, Vec<u8>) {
    let parts = [
        [name.as_bytes(), &[0]].concat(),
        value.datatype(),
        value.dataspace(),
    ];
    let mut bytes = vec![1, 0];
    for part in &parts {
        bytes.extend((part.len() as u16).to_le_bytes());
    }
    for part in parts {
        bytes.extend(part);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
    }
    bytes.extend(value.bytes());
    (ATTRIBUTE, bytes)
}

impl Dataset<'_> {
    fn grows(&self) -> bool {
        match self.storage {
            Storage::Piece(_) => false,
            Storage::Chunks { .. } | Storage::All(_) => true,
        }
    }

    fn fill(&self) -> Vec<u8> {
        // room is made early, or when something is written; nothing is filled in
        let early = if self.grows() { 3 } else { 1 };
        let value = match self.storage {
            Storage::All(number) => number,
            Storage::Piece(_) | Storage::Chunks { .. } => 0,
        };
        let size = self.number.size() as usize;
        let value = &value.to_le_bytes()[..size];
        [&[2, early, 2, 1][..], &(size as u32).to_le_bytes(), value].concat()
    }

    fn layout(&self) -> Vec<u8> {
        let size = self.number.size();
        let (rows, tree) = match self.storage {
            Storage::Piece(address) => {
                let bytes = size * self.dimensions.iter().product::<u64>();
                return [&[3, 1][..], &address.to_le_bytes(), &bytes.to_le_bytes()].concat();
            }
            Storage::Chunks { rows, tree } => (rows, tree),
            Storage::All(_) => (64, NOWHERE),
        };
        let mut bytes = vec![3, 2, self.dimensions.len() as u8 + 1];
        bytes.extend(tree.to_le_bytes());
        let each = [rows]
            .into_iter()
            .chain(self.dimensions[1..].iter().copied());
        for n in each.chain([size]) {
            bytes.extend((n as u32).to_le_bytes());
        }
        bytes
    }
}

#[cfg(test)]
mod tests;
