//! Arrays of NumPy archives (`.npz`), whose headers are not trusted with memory: what they promise must be there.

use super::source::{self, room};
use ndarray::{ArrayBase, Dimension, IxDyn, OwnedRepr};
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

/// Numbers of arrays of a file that [`write_npz`](crate::write::npz::write_npz) wrote, the last index fastest.
///
/// # Errors
/// As for reading the file and each of its arrays.
pub fn read_npz<const N: usize>(path: &Path, names: [&str; N]) -> Result<[Vec<f64>; N], String> {
    let mut file = Npz::open(path)?;
    let mut all = [const { vec![] }; N];
    for (numbers, name) in all.iter_mut().zip(names) {
        let array = file.array::<f64, IxDyn>(name)?;
        numbers.extend(array.iter());
    }
    Ok(all)
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

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{Array1, Array2, array};
    use ndarray_npy::{NpzWriter, WriteNpyExt};
    use std::io::Write;
    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    #[test]
    fn a_header_promises_what_is_there() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.npz");
        let told = |rows: &str| {
            let mut text = vec![];
            let two = array![[1.0, 2.0], [3.0, 4.0]];
            two.write_npy(&mut text).unwrap();
            // blanks at the end of the header make room
            let at = text.windows(2).position(|w| w == b"(2").unwrap();
            let end = text.windows(2).rposition(|w| w == b" \n").unwrap();
            text.drain(end + 2 - rows.len()..=end);
            text.splice(at + 1..at + 2, rows.bytes());
            let file = File::create(&path).unwrap();
            let mut zip = ZipWriter::new(file);
            let stored = zip::CompressionMethod::Stored;
            let options = SimpleFileOptions::default().compression_method(stored);
            zip.start_file("x.npy", options).unwrap();
            zip.write_all(&text).unwrap();
            zip.finish().unwrap();
            Npz::open(&path).unwrap().array::<f64, ndarray::Ix2>("x")
        };
        let said = told("1000000000000").unwrap_err();
        assert!(said.contains("1000000000000 × 2"), "{said}");
        assert!(said.contains("32 bytes are there"), "{said}");
    }

    #[test]
    fn arrays_of_all_shapes_are_read() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.npz");
        let mut all = NpzWriter::new_compressed(File::create(&path).unwrap());
        let (one, two) = (
            array![1i64, 2, 3],
            array![[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]],
        );
        all.add_array("one", &one).unwrap();
        all.add_array("two", &two).unwrap();
        all.finish().unwrap();
        let mut npz = Npz::open(&path).unwrap();
        assert!(npz.has("one") && !npz.has("three"));
        let read: Array1<i64> = npz.array("one").unwrap();
        assert_eq!(read, one);
        let read: Array2<f64> = npz.array("two").unwrap();
        assert_eq!(read, two);
    }
}
