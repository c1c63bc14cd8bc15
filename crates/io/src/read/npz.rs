//! Arrays of NumPy archives (`.npz`), whose headers are not trusted with memory: what they promise must be there.

use super::source::{self, room};
use ndarray::{ArrayBase, Dimension, OwnedRepr};
use ndarray_npy::{ReadNpyExt, ReadableElement};
use peridyne::error::size;
use std::fs::File;
use std::io::{BufReader, Cursor, Read};
use std::path::Path;
use zip::ZipArchive;

/// An open archive.
pub(crate) struct Npz(ZipArchive<BufReader<File>>);

/// Bytes of the header of an array.
const LONGEST_HEADER: usize = 1 << 16;
/// What an array begins with, before the length of its header.
const MAGIC: &[u8] = b"\x93NUMPY";

impl Npz {
    /// # Errors
    /// It cannot be read, or is no archive.
    pub fn open(path: &Path) -> Result<Npz, String> {
        let file = source::open(path).map_err(|e| format!("cannot read it: {e}"))?;
        let archive = ZipArchive::new(BufReader::new(file));
        Ok(Npz(
            archive.map_err(|e| format!("it is no .npz archive: {e}"))?
        ))
    }

    pub fn has(&self, name: &str) -> bool {
        self.0.index_for_name(&format!("{name}.npy")).is_some()
    }

    /// An array by its name, without `.npy`.
    ///
    /// # Errors
    /// There is none; it is of another type or shape; it is shorter than its header says, or larger than memory.
    pub fn array<T: ReadableElement, D: Dimension>(
        &mut self,
        name: &str,
    ) -> Result<ArrayBase<OwnedRepr<T>, D>, String> {
        let wrong = |e: &dyn std::fmt::Display| format!("the array `{name}` cannot be read: {e}");
        let mut member = { self.0.by_name(&format!("{name}.npy")) }.map_err(|e| wrong(&e))?;
        let head = head(&mut member).map_err(|e| wrong(&e))?;
        let shape = shape(&head).ok_or_else(|| wrong(&"its header has no shape"))?;
        let bytes = shape.iter().fold(size_of::<T>() as f64, |all, n| all * n);
        let there = member.size().saturating_sub(head.len() as u64);
        if bytes > there as f64 {
            let counts: Vec<String> = shape.iter().map(f64::to_string).collect();
            return Err(wrong(&format!(
                "its header says {} numbers, {}, and {there} bytes are there",
                counts.join(" × "),
                size(bytes)
            )));
        }
        room(&format!("the array `{name}`"), bytes).map_err(|e| e.to_string())?;
        let whole = Cursor::new(head).chain(member);
        ArrayBase::read_npy(whole).map_err(|e| wrong(&e))
    }
}

/// The header with what stands before it.
fn head(member: &mut impl Read) -> Result<Vec<u8>, String> {
    let told = |e: std::io::Error| e.to_string();
    let mut all = vec![0; MAGIC.len() + 2];
    member.read_exact(&mut all).map_err(told)?;
    if !all.starts_with(MAGIC) {
        return Err("it is no array of NumPy".into());
    }
    // of the first version in two bytes, then in four
    let width = if all[MAGIC.len()] == 1 { 2 } else { 4 };
    let mut length = [0; 4];
    member.read_exact(&mut length[..width]).map_err(told)?;
    let count = u32::from_le_bytes(length) as usize;
    if count > LONGEST_HEADER {
        return Err(format!("its header is said to have {count} bytes"));
    }
    all.extend(&length[..width]);
    let begin = all.len();
    all.resize(begin + count, 0);
    member.read_exact(&mut all[begin..]).map_err(told)?;
    Ok(all)
}

/// Counts along the axes, as the header says them: `'shape': (3, 2), `.
fn shape(head: &[u8]) -> Option<Vec<f64>> {
    let text = String::from_utf8_lossy(head);
    let (_, rest) = text.split_once("shape")?;
    let (_, rest) = rest.split_once('(')?;
    let counts = rest.split_once(')')?.0.split(',').map(str::trim);
    let counts = counts.filter(|n| !n.is_empty());
    // a whole number of Python 2 ends with L
    counts
        .map(|n| n.trim_end_matches('L').parse().ok())
        .collect()
}
