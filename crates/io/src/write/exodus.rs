//! Exodus II results (`.e`), one file of all frames, as Peridigm and PeriLab write them: ParaView, VTK, meshio, SEACAS.
//!
//! Points are nodes at their reference positions and SPHERE elements with the attributes radius (of a sphere of their volume) and
//! volume, a block for each material and body. Fields are nodal variables, displacements `displ_x`, …; the row of the history is the
//! global variables. Names of variables are those of the Exodus library, numbers netCDF's (64-bit offset; CDF-5 where that is too
//! small). Exodus has no place for units: they are attributes `units` of what is of one unit, as netCDF's conventions have it, and
//! lines of its information records.
//!
//! A frame is a record at the end of the file. The header counts records, and is told of one when it is on the disk: a run that is
//! killed leaves a file of its whole frames, and it can be read at any time.

use std::f64::consts::PI;
use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crc32fast::Hasher;
use peridyne::observe::{Column, Snapshot};
use peridyne::state::{Archive, Owner};

use super::atomic::WriteError;
use super::fields::{fields, invalid};
use super::grown::{Seal, Summed, changed, write_sealed};
use super::history::Column as Variable;
use crate::deck::{Dim, UnitSystem};
use crate::netcdf::{Attribute, Header, Type, Version, lay_out};

/// What a file says of its points besides frames.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Layout {
    pub title: String,
    /// Name and points of each block; every point is in one.
    pub blocks: Vec<(String, Vec<u32>)>,
    /// Name and points of each node set.
    pub sets: Vec<(String, Vec<u32>)>,
    /// Of the points.
    pub volume: Vec<f64>,
    /// Global variables.
    pub globals: Vec<Variable>,
    /// Of the numbers.
    pub units: UnitSystem,
    pub time_unit: String,
}

/// A file of frames, open to more.
#[derive(Debug)]
pub struct Exodus {
    path: PathBuf,
    file: File,
    header: Header,
    /// Length of the file without records, and of a record.
    start: u64,
    record: u64,
    /// Names of nodal variables.
    nodal: Vec<String>,
    globals: usize,
    /// Of the last frame.
    step: Option<u64>,
    /// Checksum of all, as if no records were counted.
    sum: u32,
}

/// The library's width of names, with the zero at the end.
const NAME: usize = 33;
/// Longest title.
const TITLE: usize = 80;
/// The library's width of a line of information, with the zero at the end.
const LINE: usize = 81;

/// Names of the variables that a column becomes.
fn names_of(column: &Column) -> Vec<String> {
    let name = match column.name() {
        "displacement" => "displ",
        other => other,
    };
    match column.values.shape().components() {
        [] => vec![name.to_string()],
        components => components.iter().map(|c| format!("{name}_{c}")).collect(),
    }
}

/// The same with their units.
fn variables_of(column: &Column, units: UnitSystem) -> impl Iterator<Item = Variable> {
    let unit = units.unit(column.declaration.dimension);
    let names = names_of(column).into_iter();
    names.map(move |name| Variable::new(name, unit.clone()))
}

/// Numbers of a variable that has one value.
enum Numbers {
    Text(Vec<String>, usize),
    Ints(Vec<i32>),
    Doubles(Vec<f64>),
}

impl Numbers {
    fn write<W: Write>(&self, w: &mut W) -> io::Result<()> {
        match self {
            Numbers::Text(all, width) => {
                for text in all {
                    let mut field = text.as_bytes().to_vec();
                    field.resize(*width, 0);
                    w.write_all(&field)?;
                }
                let bytes = all.len() * width;
                w.write_all(&[0; 4][..bytes.next_multiple_of(4) - bytes])
            }
            Numbers::Ints(all) => all.iter().try_for_each(|x| w.write_all(&x.to_be_bytes())),
            Numbers::Doubles(all) => all.iter().try_for_each(|x| w.write_all(&x.to_be_bytes())),
        }
    }
}

/// The header and what follows it.
struct Start {
    header: Header,
    fixed: Vec<Numbers>,
    /// Letters of a name, and the dimension of that length.
    width: usize,
    names: usize,
    /// Dimensions of texts of fixed length, of records, of nodes.
    string: usize,
    time: usize,
    nodes: usize,
}

impl Start {
    fn new(version: Version, width: usize, points: usize) -> Self {
        let mut header = Header::new(version);
        Start {
            string: header.dimension("len_string", NAME),
            time: header.dimension("time_step", 0),
            names: header.dimension("len_name", width),
            nodes: header.dimension("num_nodes", points),
            header,
            fixed: vec![],
            width,
        }
    }

    fn ints(&mut self, name: &str, dimensions: &[usize], values: Vec<i32>) {
        self.header.variable(name, Type::Int, dimensions);
        self.fixed.push(Numbers::Ints(values));
    }

    fn doubles(&mut self, name: &str, dimensions: &[usize], values: Vec<f64>) {
        self.header.variable(name, Type::Double, dimensions);
        self.fixed.push(Numbers::Doubles(values));
    }

    fn texts(&mut self, name: &str, dimension: usize, all: Vec<String>) {
        self.header
            .variable(name, Type::Char, &[dimension, self.names]);
        self.fixed.push(Numbers::Text(all, self.width));
    }

    /// The unit of the last variable, where it has one.
    fn unit(&mut self, unit: &str) {
        if !unit.is_empty() {
            self.mark("units", unit);
        }
    }

    fn mark(&mut self, attribute: &str, text: &str) {
        if let Some(v) = self.header.variables.last_mut() {
            let value = Attribute::Text(text.into());
            v.attributes.push((attribute.into(), value));
        }
    }

    /// Status, ids and names of blocks or sets.
    fn entities(&mut self, prefix: &str, dimension: usize, names: Vec<String>) {
        let count = names.len();
        self.ints(&format!("{prefix}_status"), &[dimension], vec![1; count]);
        let ids = (1..=count as i32).collect();
        self.ints(&format!("{prefix}_prop1"), &[dimension], ids);
        self.mark("name", "ID");
        self.texts(&format!("{prefix}_names"), dimension, names);
    }

    fn all(&mut self, layout: &Layout, reference: &[[f64; 3]]) {
        let points = reference.len();
        let header = &mut self.header;
        let title = layout.title.char_indices();
        let title = title.take_while(|(at, c)| at + c.len_utf8() <= TITLE);
        header.attributes = vec![
            ("api_version".into(), Attribute::Floats(vec![5.26])),
            ("version".into(), Attribute::Floats(vec![5.26])),
            ("floating_point_word_size".into(), Attribute::Ints(vec![8])),
            ("file_size".into(), Attribute::Ints(vec![1])),
            (
                "maximum_name_length".into(),
                Attribute::Ints(vec![self.width as i32 - 1]),
            ),
            ("int64_status".into(), Attribute::Ints(vec![0])),
            (
                "title".into(),
                Attribute::Text(title.map(|(_, c)| c).collect()),
            ),
        ];
        let axes = header.dimension("num_dim", 3);
        let elements = header.dimension("num_elem", points);
        let records = header.dimension("num_qa_rec", 1);
        let four = header.dimension("four", 4);
        let program = ["peridyne", env!("CARGO_PKG_VERSION"), "", ""].map(String::from);
        header.variable("qa_records", Type::Char, &[records, four, self.string]);
        self.fixed.push(Numbers::Text(program.into(), NAME));
        let blocks = self.header.dimension("num_el_blk", layout.blocks.len());
        let names = layout.blocks.iter().map(|b| b.0.clone()).collect();
        self.entities("eb", blocks, names);
        for (n, (_, points)) in layout.blocks.iter().enumerate() {
            self.block(n + 1, points, &layout.volume);
        }
        if !layout.sets.is_empty() {
            let sets = self.header.dimension("num_node_sets", layout.sets.len());
            let names = layout.sets.iter().map(|s| s.0.clone()).collect();
            self.entities("ns", sets, names);
        }
        for (n, (_, points)) in layout.sets.iter().enumerate() {
            let length = format!("num_nod_ns{}", n + 1);
            let length = self.header.dimension(&length, points.len());
            self.ints(&format!("node_ns{}", n + 1), &[length], numbers(points));
        }
        for (a, axis) in ["coordx", "coordy", "coordz"].into_iter().enumerate() {
            let column = reference.iter().map(|x| x[a]).collect();
            self.doubles(axis, &[self.nodes], column);
            self.unit(&layout.units.unit(Dim::LENGTH));
        }
        self.texts("coor_names", axes, ["x", "y", "z"].map(String::from).into());
        let identity = (1..=points as i32).collect();
        self.ints("node_num_map", &[self.nodes], identity);
        // elements are counted block by block; their numbers are those of the points
        let order = layout.blocks.iter().flat_map(|(_, points)| numbers(points));
        self.ints("elem_num_map", &[elements], order.collect());
    }

    fn block(&mut self, n: usize, points: &[u32], volume: &[f64]) {
        let length = format!("num_el_in_blk{n}");
        let length = self.header.dimension(&length, points.len());
        let each = self.header.dimension(&format!("num_nod_per_el{n}"), 1);
        let attributes = self.header.dimension(&format!("num_att_in_blk{n}"), 2);
        self.ints(&format!("connect{n}"), &[length, each], numbers(points));
        self.mark("elem_type", "SPHERE");
        let pair = |p: &u32| {
            let volume = volume[*p as usize];
            [libm::cbrt(0.75 * volume / PI), volume]
        };
        let values = points.iter().flat_map(pair).collect();
        self.doubles(&format!("attrib{n}"), &[length, attributes], values);
        let names = ["radius", "volume"].map(String::from).into();
        self.texts(&format!("attrib_name{n}"), attributes, names);
    }

    /// A file without records.
    fn write(&self, path: &Path) -> Result<Seal, WriteError> {
        write_sealed(path, |w| {
            self.header.write(w)?;
            self.fixed.iter().try_for_each(|numbers| numbers.write(w))
        })
    }

    /// Names with their units in lines of information.
    fn information(&mut self, layout: &Layout, nodal: &[Variable]) {
        let all = nodal.iter().chain(&layout.globals);
        let with = all.filter(|v| !v.unit.is_empty());
        let mut lines: Vec<String> = with.map(Variable::header).collect();
        // a line that is cut says less than none
        lines.retain(|line| line.len() < LINE);
        if lines.is_empty() {
            return;
        }
        let count = self.header.dimension("num_info", lines.len());
        let width = self.header.dimension("len_line", LINE);
        self.header
            .variable("info_records", Type::Char, &[count, width]);
        self.fixed.push(Numbers::Text(lines, LINE));
    }

    /// What is recorded: time, global and nodal variables.
    fn recorded(&mut self, layout: &Layout, nodal: &[Variable]) {
        let (time, nodes) = (self.time, self.nodes);
        self.header.variable("time_whole", Type::Double, &[time]);
        self.unit(&layout.time_unit);
        let globals = &layout.globals;
        if !globals.is_empty() {
            let count = self.header.dimension("num_glo_var", globals.len());
            let names = globals.iter().map(|v| v.name.clone()).collect();
            self.texts("name_glo_var", count, names);
            self.header
                .variable("vals_glo_var", Type::Double, &[time, count]);
        }
        if nodal.is_empty() {
            return;
        }
        let count = self.header.dimension("num_nod_var", nodal.len());
        let names = nodal.iter().map(|v| v.name.clone()).collect();
        self.texts("name_nod_var", count, names);
        for (n, variable) in nodal.iter().enumerate() {
            let name = format!("vals_nod_var{}", n + 1);
            self.header.variable(&name, Type::Double, &[time, nodes]);
            self.unit(&variable.unit);
        }
    }
}

/// Points as numbers of nodes, from 1.
fn numbers(points: &[u32]) -> Vec<i32> {
    points.iter().map(|p| *p as i32 + 1).collect()
}

/// Writes a mesh of points without results.
///
/// # Errors
/// Those of [`Exodus::create`].
pub fn write_mesh(path: &Path, layout: &Layout, at: &[[f64; 3]]) -> Result<(), WriteError> {
    begun(path, layout, at, &[])?.0.write(path)?;
    Ok(())
}

/// What is not recorded, and its length.
fn begun(
    path: &Path,
    layout: &Layout,
    reference: &[[f64; 3]],
    nodal: &[Variable],
) -> Result<(Start, u64), WriteError> {
    let failed = |e: io::Error| WriteError::at("write", path)(e);
    let points = reference.len();
    let mut in_block = vec![0u8; points];
    let listed = layout.blocks.iter().chain(&layout.sets);
    if points >= i32::MAX as usize
        || layout.volume.len() != points
        || listed.flat_map(|b| &b.1).any(|p| *p as usize >= points)
    {
        let error = invalid(format!("blocks and sets are not those of {points} points"));
        return Err(failed(error));
    }
    for p in layout.blocks.iter().flat_map(|b| &b.1) {
        in_block[*p as usize] = in_block[*p as usize].saturating_add(1);
    }
    if in_block.iter().any(|n| *n != 1) {
        return Err(failed(invalid("a point is not in one block".into())));
    }
    let named = layout.blocks.iter().chain(&layout.sets).map(|b| &b.0);
    let variables = nodal.iter().chain(&layout.globals).map(|v| &v.name);
    let longest = named.chain(variables).map(String::len);
    let width = longest.max().unwrap_or(0).max(NAME - 1) + 1;
    let start = |version| {
        let mut start = Start::new(version, width, points);
        start.all(layout, reference);
        start.information(layout, nodal);
        start.recorded(layout, nodal);
        lay_out(&mut start.header).map(|length| (start, length))
    };
    start(Version::Offset64)
        .or_else(|_| start(Version::Data64))
        .map_err(failed)
}

impl Owner for Exodus {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.same("start", &mut self.start);
        archive.same("record", &mut self.record);
        archive.one("records", &mut self.header.records);
        archive.one("step", &mut self.step);
        archive.one("checksum", &mut self.sum);
    }
}

impl Exodus {
    /// Starts a file without frames, whose variables are the columns of this snapshot; an older file is replaced.
    ///
    /// # Errors
    /// The operating system's; `InvalidInput` when the layout is not that of the points, or there are more than the format can count.
    pub fn create(path: &Path, layout: &Layout, first: &Snapshot) -> Result<Self, WriteError> {
        Exodus::made(path, layout, first, |start| start.write(path))
    }

    /// The file of a run that goes on, which has columns like these; its state must be read, and [`rewind`](Exodus::rewind) called,
    /// before a frame comes.
    ///
    /// # Errors
    /// As [`create`](Exodus::create).
    pub fn reopen(path: &Path, layout: &Layout, now: &Snapshot) -> Result<Self, WriteError> {
        Exodus::made(path, layout, now, |_| Ok(Seal::default()))
    }

    fn made(
        path: &Path,
        layout: &Layout,
        like: &Snapshot,
        write: impl FnOnce(&Start) -> Result<Seal, WriteError>,
    ) -> Result<Self, WriteError> {
        let failed = |e: io::Error| WriteError::at("write", path)(e);
        let columns = fields(like).map_err(failed)?;
        let nodal = { columns.iter() }.flat_map(|c| variables_of(c, layout.units));
        let nodal: Vec<Variable> = nodal.collect();
        let (begun, start) = begun(path, layout, &like.reference, &nodal)?;
        let sum = write(&begun)?.sum;
        let header = begun.header;
        let file = File::options().read(true).write(true).open(path);
        Ok(Exodus {
            path: path.to_path_buf(),
            file: file.map_err(failed)?,
            record: header.record_bytes().unwrap_or(u64::MAX),
            header,
            start,
            nodal: nodal.into_iter().map(|v| v.name).collect(),
            globals: layout.globals.len(),
            step: None,
            sum,
        })
    }

    /// Takes away the frames that came after the state that was read: first they are not counted any more, then they are cut off.
    ///
    /// # Errors
    /// The operating system's; frames are not as they were, or there are fewer.
    pub fn rewind(&mut self) -> Result<(), WriteError> {
        let failed = |e| WriteError::at("go on with", &self.path)(e);
        let end = self.start + self.header.records * self.record;
        let there = self.file.metadata().map_err(failed)?.len();
        if there < end || self.sum_to(end).map_err(failed)? != self.sum {
            return Err(changed(&self.path));
        }
        self.count(self.header.records)
            .and_then(|()| self.file.sync_data())
            .and_then(|()| self.file.set_len(end))
            .map_err(failed)
    }

    /// The checksum of the first bytes, as if no records were counted.
    fn sum_to(&self, end: u64) -> io::Result<u32> {
        let (at, none) = self.header.records_mark(0);
        let mut file = &self.file;
        file.seek(SeekFrom::Start(0))?;
        let mut head = vec![0; at as usize + none.len()];
        file.read_exact(&mut head)?;
        head[at as usize..].copy_from_slice(&none);
        let mut sum = Hasher::new();
        sum.update(&head);
        let (mut left, mut room) = (end - head.len() as u64, vec![0; 1 << 18]);
        while left > 0 {
            let now = room.len().min(usize::try_from(left).unwrap_or(usize::MAX));
            file.read_exact(&mut room[..now])?;
            sum.update(&room[..now]);
            left -= now as u64;
        }
        Ok(sum.finalize())
    }

    /// Adds a frame, or nothing; one of the step of the last frame is passed over.
    ///
    /// # Errors
    /// The operating system's, and `InvalidInput` when the columns are not those of the first frame; the file then ends with the frame
    /// before.
    pub fn push(&mut self, s: &Snapshot, globals: &[f64]) -> Result<(), WriteError> {
        if self.step == Some(s.step) {
            return Ok(());
        }
        let end = self.start + self.header.records * self.record;
        let frame = match self.frame(s, globals, end) {
            Ok(frame) => frame,
            Err(error) => {
                // if cutting fails too, the error of the frame tells more
                let _ = self.count(self.header.records);
                let _ = self.file.set_len(end);
                return Err(WriteError::at("append to", &self.path)(error));
            }
        };
        let mut all = Hasher::new_with_initial_len(self.sum, end);
        all.combine(&frame);
        self.sum = all.finalize();
        self.header.records += 1;
        self.step = Some(s.step);
        Ok(())
    }

    fn frame(&self, s: &Snapshot, globals: &[f64], end: u64) -> io::Result<Hasher> {
        let columns = fields(s)?;
        let names = columns.iter().flat_map(|c| names_of(c));
        if !names.eq(self.nodal.iter().cloned()) || globals.len() != self.globals {
            let message = "the frame has other fields than the first";
            return Err(invalid(message.into()));
        }
        let mut file = &self.file;
        file.seek(SeekFrom::Start(end))?;
        let mut w = BufWriter::with_capacity(1 << 18, Summed::new(file));
        w.write_all(&s.time.to_be_bytes())?;
        globals
            .iter()
            .try_for_each(|x| w.write_all(&x.to_be_bytes()))?;
        for column in columns {
            for c in 0..column.values.shape().components().len().max(1) {
                for i in 0..s.reference.len() {
                    w.write_all(&column.values.at(i, c).to_be_bytes())?;
                }
            }
        }
        w.flush()?;
        let sum = w.get_ref().sum.clone();
        drop(w);
        // the count must not reach the disk before what it counts
        self.file.sync_data()?;
        self.count(self.header.records + 1)?;
        Ok(sum)
    }

    /// Says how many frames there are.
    fn count(&self, records: u64) -> io::Result<()> {
        let (at, count) = self.header.records_mark(records);
        let mut file = &self.file;
        file.seek(SeekFrom::Start(at))?;
        file.write_all(&count)
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
