//! VTKHDF (`.vtkhdf`), one file of all frames: ParaView, VTK, pyvista, and whatever reads HDF5.
//!
//! What [`vtu`](super::vtu) says of the points of a frame, for all times: an unstructured grid of vertices at current positions, fields by
//! name, `id`, and the number of the step as field data. What stays (cells, ids) is there once; positions and fields of a frame are a
//! chunk each, and frames follow one another.
//!
//! A frame is appended: its numbers first, then the nodes of the trees that find them, lengths of datasets, and when all of that is on the disk
//! the number of steps with that of times, in one sector. A run that is killed leaves a file of its whole frames, which can be read at any time. All that is not a number of a
//! frame follows from how many frames there are and when, so that a run which goes on writes the bytes of one that was never cut off.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use peridyne::observe::Snapshot;
use peridyne::state::{Archive, Owner};

use super::atomic::{WriteError, write_file};
use super::fields::{fields, invalid, write_positions, write_values};
use super::grown::{Seal, Summed, changed};
use layout::{COUNTED, Column, Frame, LARGEST, PART, PARTS, Places, head, write_fixed};

mod layout;

/// A file of frames, open to more.
#[derive(Debug)]
pub struct VtkHdf {
    path: PathBuf,
    file: File,
    frame: Frame,
    /// Where what stays begins, and where it ends.
    fixed: [u64; 2],
    places: Places,
    /// Of each frame.
    times: Vec<f64>,
    steps: Vec<u64>,
    /// Of what stays and of the frames.
    seal: Seal,
}

impl Owner for VtkHdf {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.same("start", &mut self.fixed[1]);
        archive.list("times", &mut self.times);
        archive.list("steps", &mut self.steps);
        archive.part("frames", &mut self.seal);
    }
}

impl VtkHdf {
    /// Starts a file without frames, whose fields are the columns of this snapshot; an older file is replaced.
    ///
    /// # Errors
    /// The operating system's; `InvalidInput` for a snapshot that is none.
    pub fn create(path: &Path, first: &Snapshot) -> Result<VtkHdf, WriteError> {
        VtkHdf::made(path, first, LARGEST, true)
    }

    /// The file of a run that goes on, which has columns like these; its state must be read, and [`rewind`](VtkHdf::rewind) called, before
    /// a frame comes.
    ///
    /// # Errors
    /// As [`create`](VtkHdf::create).
    pub fn reopen(path: &Path, now: &Snapshot) -> Result<VtkHdf, WriteError> {
        VtkHdf::made(path, now, LARGEST, false)
    }

    fn made(path: &Path, like: &Snapshot, largest: u64, new: bool) -> Result<VtkHdf, WriteError> {
        let failed = |e: io::Error| WriteError::at("write", path)(e);
        let frame = Frame::of(like, largest).map_err(failed)?;
        let start = head(&frame, &Places::default(), 0, [0, 0]).len() as u64;
        let places = Places {
            end: start + layout::fixed(frame.points),
            ..Places::default()
        };
        let mut seal = Seal::default();
        if new {
            write_file(path, |w| {
                w.write_all(&head(&frame, &places, start, [0, 0]))?;
                let mut summed = Summed::new(w);
                write_fixed(&mut summed, frame.points)?;
                seal = summed.seal();
                Ok(())
            })?;
        }
        let file = File::options().read(true).write(true).open(path);
        Ok(VtkHdf {
            path: path.to_path_buf(),
            file: file.map_err(failed)?,
            frame,
            fixed: [start, places.end],
            places,
            times: vec![],
            steps: vec![],
            seal,
        })
    }

    /// Takes away the frames that came after the state that was read, and writes anew what finds those before.
    ///
    /// # Errors
    /// The operating system's; frames are not as they were, or there are fewer.
    pub fn rewind(&mut self) -> Result<(), WriteError> {
        let mut places = Places {
            end: self.fixed[1],
            ..Places::default()
        };
        self.times.iter().for_each(|_| places.grow(&self.frame));
        self.places = places;
        let failed = |e| WriteError::at("go on with", &self.path)(e);
        let there = self.file.metadata().map_err(failed)?.len();
        if there < self.places.end || self.sealed().map_err(failed)? != self.seal {
            return Err(changed(&self.path));
        }
        self.told_back(0).map_err(failed)
    }

    /// What is in the file of what stays and of frames.
    fn sealed(&self) -> io::Result<Seal> {
        let [start, end] = self.fixed;
        let bytes = self.frame.all_bytes();
        let frames = self.places.frame.iter().map(|at| (*at, bytes));
        let mut seal = Seal::default();
        let mut summed = Summed::new(io::sink());
        for (at, length) in [(start, end - start)].into_iter().chain(frames) {
            let mut file = &self.file;
            file.seek(SeekFrom::Start(at))?;
            let mut part = BufReader::with_capacity(1 << 18, file.take(length));
            if io::copy(&mut part, &mut summed)? != length {
                return Ok(seal);
            }
        }
        seal = summed.seal();
        Ok(seal)
    }

    /// Adds a frame, or nothing; one of the step of the last frame is passed over.
    ///
    /// # Errors
    /// The operating system's, and `InvalidInput` when points or fields are not those of the first frame; the file then ends with the
    /// frame before.
    pub fn push(&mut self, s: &Snapshot) -> Result<(), WriteError> {
        if self.steps.last() == Some(&s.step) {
            return Ok(());
        }
        let before = self.places.clone();
        match self.frame(s) {
            Ok(seal) => self.seal = seal,
            Err(error) => {
                self.places = before;
                self.times.truncate(self.places.frame.len());
                self.steps.truncate(self.places.frame.len());
                // if this fails too, the error of the frame tells more
                let _ = self.told_back(self.chunks());
                return Err(WriteError::at("append to", &self.path)(error));
            }
        }
        Ok(())
    }

    /// Chunks of a column.
    fn chunks(&self) -> u64 {
        self.places.frame.len() as u64 * self.frame.chunks
    }

    fn frame(&mut self, s: &Snapshot) -> io::Result<Seal> {
        let all = fields(s)?;
        let columns = all.iter().map(|c| Column::of(c.name(), &c.values));
        if s.reference.len() as u64 != self.frame.points
            || !columns.eq(self.frame.fields().iter().cloned())
        {
            let message = "the frame has other points or fields than the first";
            return Err(invalid(message.into()));
        }
        let since = self.chunks();
        self.places.grow(&self.frame);
        self.times.push(s.time);
        self.steps.push(s.step);
        let mut file = &self.file;
        let at = self.places.frame.last().copied().unwrap_or_default();
        file.seek(SeekFrom::Start(at))?;
        let to = BufWriter::with_capacity(1 << 18, file);
        let mut w = Summed::after(to, self.seal);
        let frame = &self.frame;
        let values = all.iter().map(|c| Some(&c.values));
        for (column, values) in frame.columns.iter().zip([None].into_iter().chain(values)) {
            match values {
                None => write_positions(&mut w, s)?,
                Some(values) => write_values(&mut w, values)?,
            }
            let rest = frame.bytes(column) - frame.points * column.width();
            (0..rest).try_for_each(|_| w.write_all(&[0]))?;
        }
        w.flush()?;
        let seal = w.seal();
        drop(w);
        self.find(since)?;
        // what is told must not reach the disk before what it tells of
        self.file.sync_data()?;
        let frames = self.times.len() as u64;
        self.tell([frames, frames - 1])?;
        self.file.sync_data()?;
        self.tell([frames; 2])?;
        Ok(seal)
    }

    /// Writes the nodes that find frames, and the numbers of frames, as far as they changed since there were so many chunks.
    fn find(&self, since: u64) -> io::Result<()> {
        let (frame, places) = (&self.frame, &self.places);
        for node in places.frames.changed(since) {
            let (mut behind, mut offset) = (0, 0);
            for column in &frame.columns {
                let chunks = frame.chunks_of(column);
                let place = |chunk: u64| {
                    let at = places.frame[(chunk / frame.chunks) as usize];
                    at + offset + chunk % frame.chunks * chunks.bytes
                };
                self.put(places.frames.node(node, &chunks, behind, place))?;
                behind += chunks.node();
                offset += frame.bytes(column);
            }
        }
        let since = (since / frame.chunks).saturating_sub(1) / PART;
        for node in places.parts.changed(since) {
            for k in 0..COUNTED {
                let place = |part: u64| places.part[part as usize] + k * PARTS.bytes;
                let tree = &places.parts;
                self.put(tree.node(node, &PARTS, k * PARTS.node(), place))?;
            }
        }
        for part in since as usize..places.part.len() {
            let frames = (part * PART as usize..self.times.len()).take(PART as usize);
            let numbers = |of: &dyn Fn(usize) -> [u8; 8]| {
                let mut bytes: Vec<u8> = frames.clone().flat_map(of).collect();
                bytes.resize(PARTS.bytes as usize, 0);
                bytes
            };
            let rows = frame.all_rows();
            let all = [
                numbers(&|k| (k as u64 * rows).to_le_bytes()),
                numbers(&|k| (k as u64).to_le_bytes()),
                numbers(&|k| self.steps[k].to_le_bytes()),
                numbers(&|k| self.times[k].to_le_bytes()),
            ];
            self.put((places.part[part], all.concat()))?;
        }
        Ok(())
    }

    /// Says how many frames there are, and how many of these are steps.
    fn tell(&self, frames: [u64; 2]) -> io::Result<()> {
        self.put((0, head(&self.frame, &self.places, self.fixed[0], frames)))
    }

    /// Says that there are no more frames than are known, and cuts off what else is there; nodes are as they were since there were so many chunks.
    fn told_back(&self, since: u64) -> io::Result<()> {
        self.tell([self.times.len() as u64; 2])?;
        self.file.sync_data()?;
        self.find(since)?;
        self.file.set_len(self.places.end)
    }

    fn put(&self, (at, bytes): (u64, Vec<u8>)) -> io::Result<()> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(at))?;
        file.write_all(&bytes)
    }

    /// Waits until all frames are on the disk.
    ///
    /// # Errors
    /// The operating system's.
    pub fn finish(self) -> Result<(), WriteError> {
        self.file
            .sync_all()
            .map_err(WriteError::at("write", &self.path))
    }
}

#[cfg(test)]
mod tests;
