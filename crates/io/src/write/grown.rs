//! Files that grow record by record: a record is whole or not there.
//!
//! What of a record did not fit (disk full) is cut off again, and the file can be read at any time between records. It knows its length
//! and a checksum of all that is in it, so that a run which goes on can tell whether what it finds is what it wrote, and cut it back to
//! where it was.

use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crc32fast::Hasher;
use peridyne::state::{Archive, Owner};

use super::atomic::{WriteError, open_to_append, write_file};

/// What is in a file, in short.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Seal {
    /// Bytes.
    pub length: u64,
    /// CRC-32 of them.
    pub sum: u32,
}

impl Seal {
    /// Of the first bytes of a file.
    ///
    /// # Errors
    /// The operating system's; there are not so many.
    pub fn of(file: &mut File, length: u64) -> io::Result<Seal> {
        let sum = sum_of(file, length)?;
        Ok(Seal { length, sum })
    }

    /// Opens a file that begins with this, to append to it, and cuts off what came after.
    ///
    /// # Errors
    /// It does not, or the operating system's.
    pub fn cut_back(self, path: &Path) -> Result<File, WriteError> {
        let failed = |e| WriteError::at("go on with", path)(e);
        let mut file = File::open(path).map_err(failed)?;
        let there = file.metadata().map_err(failed)?.len();
        if there < self.length || Seal::of(&mut file, self.length).map_err(failed)? != self {
            return Err(changed(path));
        }
        let file = open_to_append(path)?;
        file.set_len(self.length).map_err(failed)?;
        Ok(file)
    }

    /// Is this still in the file?
    ///
    /// # Errors
    /// It is not, or the operating system's.
    pub fn holds(self, path: &Path) -> Result<(), WriteError> {
        let failed = |e| WriteError::at("go on with", path)(e);
        let mut file = File::open(path).map_err(failed)?;
        let there = file.metadata().map_err(failed)?.len();
        match there == self.length && sum_of(&mut file, there).map_err(failed)? == self.sum {
            true => Ok(()),
            false => Err(changed(path)),
        }
    }
}

impl Owner for Seal {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.one("length", &mut self.length);
        archive.one("checksum", &mut self.sum);
    }
}

/// Writes a file like [`write_file`], and says what is in it.
///
/// # Errors
/// As [`write_file`].
pub fn write_sealed(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<&mut dyn Write>) -> io::Result<()>,
) -> Result<Seal, WriteError> {
    let mut seal = Seal::default();
    write_file(path, |w| {
        let mut summed = Summed::new(w);
        let to: &mut dyn Write = &mut summed;
        let mut room = BufWriter::with_capacity(1 << 18, to);
        fill(&mut room)?;
        room.flush()?;
        drop(room);
        seal = summed.seal();
        Ok(())
    })?;
    Ok(seal)
}

/// A writer that counts and sums what goes through it.
pub struct Summed<W> {
    to: W,
    pub(super) length: u64,
    pub(super) sum: Hasher,
}

impl<W: Write> Summed<W> {
    pub fn new(to: W) -> Self {
        Summed {
            to,
            length: 0,
            sum: Hasher::new(),
        }
    }

    /// The same behind what is there already.
    pub fn after(to: W, there: Seal) -> Self {
        Summed {
            to,
            length: there.length,
            sum: Hasher::new_with_initial_len(there.sum, there.length),
        }
    }

    /// Where it goes to.
    pub fn inner(&self) -> &W {
        &self.to
    }

    /// What has gone through, behind what was there.
    pub fn seal(&self) -> Seal {
        Seal {
            length: self.length,
            sum: self.sum.clone().finalize(),
        }
    }
}

impl<W: Write> Write for Summed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.to.write(bytes)?;
        self.sum.update(&bytes[..count]);
        self.length += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

/// The checksum of the first bytes of a file.
///
/// # Errors
/// The operating system's; there are not so many.
pub(super) fn sum_of(file: &mut File, length: u64) -> io::Result<u32> {
    file.seek(SeekFrom::Start(0))?;
    let mut sum = Hasher::new();
    let (mut left, mut room) = (length, vec![0; 1 << 18]);
    while left > 0 {
        let now = room.len().min(usize::try_from(left).unwrap_or(usize::MAX));
        file.read_exact(&mut room[..now])?;
        sum.update(&room[..now]);
        left -= now as u64;
    }
    Ok(sum.finalize())
}

/// What is said of a file that is not as a run left it.
pub(super) fn changed(path: &Path) -> WriteError {
    let why = "it is not as the run left it: what is there was changed since the state was saved";
    WriteError::at("go on with", path)(io::Error::other(why))
}

/// A file that grows.
#[derive(Debug)]
pub struct Grown {
    path: PathBuf,
    file: File,
    /// Whole records only.
    length: u64,
    sum: u32,
}

impl Grown {
    /// Begins with what `head` writes; an older file is replaced.
    pub fn create(path: &Path, head: &[u8]) -> Result<Grown, WriteError> {
        write_file(path, |w| w.write_all(head))?;
        let mut sum = Hasher::new();
        sum.update(head);
        Ok(Grown {
            path: path.to_path_buf(),
            file: open_to_append(path)?,
            length: head.len() as u64,
            sum: sum.finalize(),
        })
    }

    /// Opens a file that is there.
    pub fn open(path: &Path) -> Result<Grown, WriteError> {
        let file = open_to_append(path)?;
        let length = file.metadata().map_err(WriteError::at("append to", path))?;
        Ok(Grown {
            path: path.to_path_buf(),
            length: length.len(),
            file,
            sum: 0,
        })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends what `write` writes, or nothing; it is in the file when this returns.
    pub fn push(
        &mut self,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), WriteError> {
        let mut w = Summed::new(BufWriter::with_capacity(1 << 18, &self.file));
        let done = write(&mut w).and_then(|()| w.flush());
        let (length, sum) = (w.length, w.sum);
        // what is buffered of a failed record must not follow when the writer is dropped
        drop(w.to.into_parts());
        if let Err(error) = done {
            self.cut();
            return Err(WriteError::at("append to", &self.path)(error));
        }
        self.length += length;
        let mut all = Hasher::new_with_initial_len(self.sum, self.length - length);
        all.combine(&sum);
        self.sum = all.finalize();
        Ok(())
    }

    /// A torn record is worse than a missing one. If cutting it off fails too, the error of the record tells more.
    fn cut(&self) {
        let _ = self.file.set_len(self.length);
    }

    /// Cuts off what came after the state that was read.
    ///
    /// # Errors
    /// The operating system's; what is left is not what was written.
    pub fn rewind(&mut self) -> Result<(), WriteError> {
        let failed = |e| WriteError::at("go on with", &self.path)(e);
        let mut file = File::open(&self.path).map_err(failed)?;
        let there = file.metadata().map_err(failed)?.len();
        if there < self.length || sum_of(&mut file, self.length).map_err(failed)? != self.sum {
            return Err(changed(&self.path));
        }
        self.file.set_len(self.length).map_err(failed)
    }

    /// Waits until all records are on the disk.
    pub fn finish(self) -> Result<(), WriteError> {
        self.file
            .sync_all()
            .map_err(WriteError::at("write", &self.path))
    }
}

impl Owner for Grown {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.one("length", &mut self.length);
        archive.one("checksum", &mut self.sum);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(of: &mut Grown) -> Vec<u8> {
        let mut to = vec![];
        let mut archive = Archive::save(&mut to);
        archive.part("file", of);
        archive.done().unwrap();
        to
    }

    fn load(of: &mut Grown, mut state: &[u8]) {
        let mut archive = Archive::load(&mut state);
        archive.part("file", of);
        archive.done().unwrap();
    }

    #[test]
    fn a_record_that_fails_is_cut_off() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.csv");
        let mut file = Grown::create(&path, b"head\n").unwrap();
        file.push(|w| w.write_all(b"1\n")).unwrap();
        let failed = file.push(|w| {
            w.write_all(&[b'2'; 1 << 19])?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert!(failed.is_err());
        file.push(|w| w.write_all(b"3\n")).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"head\n1\n3\n");
        let sum = sum_of(&mut File::open(&path).unwrap(), 9).unwrap();
        assert_eq!((file.length, file.sum), (9, sum));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_told_with_path_and_reason() {
        let mut file = Grown::open(Path::new("/dev/full")).unwrap();
        let text = file.push(|w| w.write_all(b"1\n")).unwrap_err().to_string();
        assert!(
            text.starts_with("cannot append to `/dev/full`: No space left on device"),
            "{text}"
        );
    }

    #[test]
    fn a_file_goes_back_to_a_state_and_a_changed_one_does_not() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.csv");
        let mut file = Grown::create(&path, b"head\n").unwrap();
        file.push(|w| w.write_all(b"1\n")).unwrap();
        let then = state(&mut file);
        file.push(|w| w.write_all(b"2\n")).unwrap();
        drop(file);
        let mut again = Grown::open(&path).unwrap();
        load(&mut again, &then);
        again.rewind().unwrap();
        again.push(|w| w.write_all(b"3\n")).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"head\n1\n3\n");
        for other in ["head\n2\n3\n", "head\n"] {
            std::fs::write(&path, other).unwrap();
            let mut again = Grown::open(&path).unwrap();
            load(&mut again, &then);
            let text = again.rewind().unwrap_err().to_string();
            assert!(text.contains("it is not as the run left it"), "{text}");
            assert_eq!(std::fs::read_to_string(&path).unwrap(), other);
        }
    }
}
