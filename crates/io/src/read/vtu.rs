//! Frames of points as [`write::vtu`](crate::write::vtu) writes them: raw appended data, little-endian, 64-bit lengths. No reader of
//! VTU files in general.

use std::cell::RefCell;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use super::error::ReadError;

/// A frame: its file, and where the arrays stand in it.
#[derive(Debug)]
pub struct Frame<F = File> {
    pub step: u64,
    pub time: f64,
    pub points: usize,
    pub arrays: Vec<Array>,
    file: RefCell<F>,
}

/// An array over the points.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    pub name: String,
    pub components: usize,
    /// What the components of a tensor are called; none of others.
    pub names: Vec<String>,
    pub kind: Number,
    /// First byte of the numbers.
    start: u64,
}

/// How numbers stand in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    Float64,
    Int64,
    Int32,
    UInt32,
}

impl Number {
    fn named(name: &str) -> Option<Number> {
        match name {
            "Float64" => Some(Number::Float64),
            "Int64" => Some(Number::Int64),
            "Int32" => Some(Number::Int32),
            "UInt32" => Some(Number::UInt32),
            _ => None,
        }
    }

    fn bytes(self) -> usize {
        match self {
            Number::Float64 | Number::Int64 => 8,
            Number::Int32 | Number::UInt32 => 4,
        }
    }

    fn number(self, b: &[u8]) -> f64 {
        match self {
            Number::Float64 => f64::from_le_bytes(fixed(b)),
            Number::Int64 => i64::from_le_bytes(fixed(b)) as f64,
            Number::Int32 => i32::from_le_bytes(fixed(b)).into(),
            Number::UInt32 => u32::from_le_bytes(fixed(b)).into(),
        }
    }

    /// Counts things.
    pub fn is_whole(self) -> bool {
        self != Number::Float64
    }
}

/// What the appended data begin with.
const MARK: &[u8] = b"<AppendedData encoding=\"raw\">\n_";

impl Frame {
    /// # Errors
    /// The operating system's, or what is missing in the file.
    pub fn open(path: &Path) -> Result<Frame, ReadError> {
        let file = super::source::open(path).map_err(|e| ReadError::file(path, e.to_string()))?;
        Frame::of(file).map_err(|what| ReadError::file(path, what))
    }
}

impl<F: Read + Seek> Frame<F> {
    fn of(mut file: F) -> Result<Frame<F>, String> {
        let head = head(&mut file).map_err(|e| e.to_string())?;
        let head = head.ok_or("no raw appended data: not a frame of peridyne")?;
        let start = head.len() as u64;
        let head = String::from_utf8(head).map_err(|e| e.to_string())?;
        let points = head
            .split_once("<Piece ")
            .and_then(|(_, piece)| attribute(piece, "NumberOfPoints"))
            .and_then(|n| n.parse().ok())
            .ok_or("no number of points")?;
        let (mut step, mut time, mut arrays) = (0, 0.0, vec![]);
        for tag in head.split("<DataArray ").skip(1) {
            let name = attribute(tag, "Name").ok_or("an array without a name")?;
            let text = || Some(tag.split_once('>')?.1.split_once('<')?.0.trim());
            match name {
                "TimeValue" => time = text().and_then(|t| t.parse().ok()).unwrap_or(0.0),
                "step" => step = text().and_then(|t| t.parse().ok()).unwrap_or(0),
                // cells are the points themselves
                "connectivity" | "offsets" | "types" => {}
                name => arrays.push(array(name, tag, &mut file, start, points)?),
            }
        }
        Ok(Frame {
            step,
            time,
            points,
            arrays,
            file: RefCell::new(file),
        })
    }

    pub fn array(&self, name: &str) -> Option<&Array> {
        self.arrays.iter().find(|a| a.name == name)
    }

    /// All numbers of an array, point after point.
    ///
    /// # Errors
    /// The operating system's.
    pub fn numbers(&self, array: &Array) -> io::Result<Vec<f64>> {
        let size = array.kind.bytes();
        let mut file = self.file.borrow_mut();
        file.seek(SeekFrom::Start(array.start))?;
        let mut left = self.points * array.components;
        let mut all = Vec::with_capacity(left);
        let mut bytes = vec![0; size * left.min(PIECE)];
        while left > 0 {
            let piece = &mut bytes[..size * left.min(PIECE)];
            file.read_exact(piece)?;
            all.extend(piece.chunks_exact(size).map(|b| array.kind.number(b)));
            left -= left.min(PIECE);
        }
        Ok(all)
    }
}

/// Numbers that are read at once.
const PIECE: usize = 1 << 14;

/// All up to the appended data; `None`: there are none.
fn head(file: &mut impl Read) -> io::Result<Option<Vec<u8>>> {
    let mut all = vec![];
    let mut piece = [0; 4096];
    loop {
        let read = file.read(&mut piece)?;
        if read == 0 {
            return Ok(None);
        }
        let before = all.len().saturating_sub(MARK.len());
        all.extend(&piece[..read]);
        let found = all[before..].windows(MARK.len()).position(|w| w == MARK);
        if let Some(at) = found {
            all.truncate(before + at + MARK.len());
            return Ok(Some(all));
        }
    }
}

fn fixed<const N: usize>(bytes: &[u8]) -> [u8; N] {
    std::array::from_fn(|i| bytes[i])
}

/// The value of an attribute of the tag that `text` begins in.
fn attribute<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let tag = &text[..text.find('>')?];
    let (_, rest) = tag.split_once(&format!("{key}=\""))?;
    Some(rest.split_once('"')?.0)
}

fn array(
    name: &str,
    tag: &str,
    file: &mut (impl Read + Seek),
    start: u64,
    points: usize,
) -> Result<Array, String> {
    let wrong = |what: &str| format!("{name}: {what}");
    let number = |key| attribute(tag, key).and_then(|n| n.parse::<usize>().ok());
    let kind = attribute(tag, "type").and_then(Number::named);
    let kind = kind.ok_or_else(|| wrong("numbers of an unknown type"))?;
    let components = number("NumberOfComponents").ok_or_else(|| wrong("no components"))?;
    let offset = number("offset").ok_or_else(|| wrong("no offset"))?;
    let begin = start + offset as u64;
    let expected = (kind.bytes() * points * components) as u64;
    let mut length = || -> io::Result<[u64; 2]> {
        let end = file.seek(SeekFrom::End(0))?;
        file.seek(SeekFrom::Start(begin))?;
        let mut length = [0; 8];
        file.read_exact(&mut length)?;
        Ok([u64::from_le_bytes(length), end])
    };
    match length() {
        Ok([length, end]) if length == expected && end >= begin + 8 + expected => {}
        _ => return Err(wrong("cut short")),
    }
    let names = (0..components).map_while(|c| attribute(tag, &format!("ComponentName{c}")));
    Ok(Array {
        name: name.to_string(),
        components,
        names: names.map(String::from).collect(),
        kind,
        start: begin + 8,
    })
}

/// Times and files that a collection (`.pvd`) lists.
///
/// # Errors
/// It cannot be read.
pub fn collection(path: &Path) -> Result<Vec<(f64, String)>, ReadError> {
    let (text, _) = super::text_of(path)?;
    let all = collected(&text);
    all.ok_or_else(|| ReadError::file(path, "an entry without time or file".into()))
}

/// The same of its text; `None` where an entry has no time or file.
pub fn collected(text: &str) -> Option<Vec<(f64, String)>> {
    let entries = text.split("<DataSet ").skip(1).map(|tag| {
        let time = attribute(tag, "timestep")?.parse().ok()?;
        let file = attribute(tag, "file")?;
        let file = file.replace("&lt;", "<").replace("&quot;", "\"");
        Some((time, file.replace("&amp;", "&")))
    });
    entries.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deck::UnitSystem;
    use crate::write::fields::tests::{put, small};
    use crate::write::vtu::write_points;
    use peridyne::observe::Values;
    use std::io::Cursor;

    fn written() -> Vec<u8> {
        let mut s = small();
        let rows = vec![[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]; 3];
        put(&mut s, "stress", Values::Symmetric(rows));
        let mut file = vec![];
        write_points(&mut file, &s, UnitSystem::Si).unwrap();
        file
    }

    #[test]
    fn what_is_written_is_read() {
        let frame = Frame::of(Cursor::new(written())).unwrap();
        assert_eq!((frame.step, frame.time, frame.points), (7, 1.5e-7, 3));
        let all = |name: &str| -> Vec<f64> { frame.numbers(frame.array(name).unwrap()).unwrap() };
        let s = small();
        assert_eq!(all("displacement"), s.displacement().concat());
        assert_eq!(all("damage"), s.damage());
        assert_eq!(all("block"), [-1.0, 0.0, 4.0]);
        assert_eq!(all("fragment"), [0.0, 0.0, 1.0]);
        assert_eq!(all("id"), [1.0, 2.0, 3.0]);
        assert_eq!(all("stress")[..6], [1.0, 2.0, 3.0, 4.0, 6.0, 5.0]);
        let stress = frame.array("stress").unwrap();
        assert_eq!(stress.names, ["xx", "yy", "zz", "xy", "yz", "xz"]);
        assert!(frame.array("block").unwrap().kind.is_whole());
        assert!(frame.array("connectivity").is_none());
    }

    #[test]
    fn what_is_cut_short_is_told() {
        let file = written();
        let short = file[..file.len() - 60].to_vec();
        assert!(Frame::of(Cursor::new(short)).is_ok(), "cells are not read");
        for length in [0, 100, 2500] {
            let text = Frame::of(Cursor::new(file[..length].to_vec())).unwrap_err();
            assert!(
                text.contains("cut short") || text.contains("not a frame"),
                "{text}"
            );
        }
    }
}
