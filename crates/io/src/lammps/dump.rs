//! `dump`, `write_dump`: snapshots in LAMMPS's text format.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;
use std::sync::Arc;

use super::atoms::Members;
use super::compute::Source;
use super::error::{Problem, Result};
use super::host::{BLOCK, Quantity};
use super::particles::Field;
use super::printf::{Format, Value};
use super::session::Session;
use super::variable::tree::Tree;

/// A column of a snapshot.
#[derive(Debug, Clone, PartialEq)]
pub struct DumpColumn {
    pub heading: String,
    pub source: DumpSource,
}

#[derive(Debug, Clone, PartialEq)]
pub enum DumpSource {
    Values(Source),
    /// Name of the atom's type.
    Element,
}

#[derive(Debug)]
pub struct Dump {
    pub id: String,
    pub members: Arc<Members>,
    pub every: u64,
    /// As written; `*` stands for the step.
    pub file: String,
    pub columns: Vec<DumpColumn>,
    /// `dump atom`: columns follow from `scale` and `image`.
    pub atom_style: bool,
    pub scale: bool,
    pub image: bool,
    pub first: bool,
    pub append: bool,
    /// Digits of the step in file names.
    pub pad: usize,
    pub units: bool,
    pub time: bool,
    pub line: Option<Vec<Format>>,
    pub integer: Option<Format>,
    pub float: Option<Format>,
    pub single: Vec<(usize, Format)>,
    pub elements: Vec<String>,
    pub last_written: Option<u64>,
    pub writer: Option<BufWriter<File>>,
}

impl Dump {
    pub fn new(id: &str, members: Arc<Members>, every: u64, file: &str) -> Dump {
        Dump {
            id: id.to_string(),
            members,
            every,
            file: file.to_string(),
            columns: Vec::new(),
            atom_style: false,
            scale: true,
            image: false,
            first: false,
            append: false,
            pad: 0,
            units: false,
            time: false,
            line: None,
            integer: None,
            float: None,
            single: Vec::new(),
            elements: Vec::new(),
            last_written: None,
            writer: None,
        }
    }

    /// Columns of `dump atom`.
    pub fn atom_columns(&mut self) {
        let field = |heading: &str| DumpColumn {
            heading: heading.to_string(),
            source: DumpSource::Values(Source::Field(Field::parse(heading).unwrap_or(Field::Id))),
        };
        let place = if self.scale {
            ["xs", "ys", "zs"]
        } else {
            ["x", "y", "z"]
        };
        let image: &[&str] = if self.image { &["ix", "iy", "iz"] } else { &[] };
        self.columns = ["id", "type"]
            .iter()
            .chain(&place)
            .chain(image)
            .map(|h| field(h))
            .collect();
    }

    fn path_name(&self, step: u64) -> String {
        self.file
            .replace('*', &format!("{step:0>w$}", w = self.pad))
    }

    /// Format of column `index`.
    fn format(&self, index: usize, integer: bool, text: bool) -> Option<Format> {
        if let Some((_, f)) = self.single.iter().rev().find(|(k, _)| *k == index) {
            return Some(f.clone());
        }
        if let Some(line) = &self.line {
            return line.get(index).cloned();
        }
        let user = if integer { &self.integer } else { &self.float };
        let fallback = if text {
            "%s"
        } else if integer {
            "%d"
        } else {
            "%g"
        };
        user.clone()
            .filter(|_| !text)
            .or_else(|| Format::parse(fallback).ok())
    }
}

fn failed(path: &std::path::Path, error: &std::io::Error) -> Box<Problem> {
    Problem::new(format!("cannot write {}: {error}", path.display()))
}

impl Session<'_> {
    /// Writes the dumps that are due at this step.
    ///
    /// # Errors
    /// A value does not exist; a file cannot be written.
    pub fn write_dumps(&mut self, at_start: bool) -> Result<()> {
        for k in 0..self.dumps.len() {
            let step = self.progress.step;
            let dump = &self.dumps[k];
            let due = step.is_multiple_of(dump.every)
                || (at_start && dump.first && dump.last_written.is_none());
            if due && dump.last_written != Some(step) {
                self.shrink_box()?;
                let mut dump = self.dumps.remove(k);
                let result = self.write_snapshot(&mut dump);
                self.dumps.insert(k, dump);
                result?;
            }
        }
        Ok(())
    }

    /// Writes one snapshot.
    ///
    /// # Errors
    /// A value does not exist; the file cannot be written.
    pub fn write_snapshot(&mut self, dump: &mut Dump) -> Result<()> {
        let step = self.progress.step;
        let path: PathBuf = self.output_path(&dump.path_name(step));
        let mut writer = match dump.writer.take() {
            Some(w) => w,
            None => {
                let file = if dump.append {
                    File::options().append(true).create(true).open(&path)
                } else {
                    File::create(&path)
                };
                BufWriter::new(file.map_err(|e| failed(&path, &e))?)
            }
        };
        let mut trees = Vec::new();
        for column in &dump.columns {
            trees.push(match &column.source {
                DumpSource::Element => Tree::Field(Field::Raw(Quantity::Type)),
                DumpSource::Values(source) => self.source_tree(source)?,
            });
        }
        self.snapshot_text(dump, &trees, &mut writer, &path)?;
        writer.flush().map_err(|e| failed(&path, &e))?;
        dump.last_written = Some(step);
        if !dump.file.contains('*') {
            dump.writer = Some(writer);
        }
        Ok(())
    }

    fn snapshot_text(
        &self,
        dump: &Dump,
        trees: &[Tree],
        out: &mut dyn Write,
        path: &std::path::Path,
    ) -> Result<()> {
        let io = |e: std::io::Error| failed(path, &e);
        let (domain, n) = (self.domain()?, self.count());
        let mut head = String::new();
        if dump.units && dump.last_written.is_none() {
            head += &format!("ITEM: UNITS\n{}\n", self.units.name());
        }
        if dump.time {
            let time = Format::parse("%.16g")
                .map(|f| f.print(Value::Float(self.time())))
                .unwrap_or_default();
            head += &format!("ITEM: TIME\n{time}\n");
        }
        head += &format!(
            "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\n",
            self.progress.step,
            dump.members.count(n)
        );
        let faces = domain
            .faces
            .map(|[a, b]| format!("{}{}", a.letter(), b.letter()))
            .join(" ");
        head += &format!("ITEM: BOX BOUNDS {faces}\n");
        let bound = Format::parse("%.16e").map_err(Problem::new)?;
        for a in 0..3 {
            let [low, high] = [domain.low[a], domain.high[a]].map(|x| bound.print(Value::Float(x)));
            head += &format!("{low} {high}\n");
        }
        let headings: Vec<&str> = dump.columns.iter().map(|c| c.heading.as_str()).collect();
        head += &format!("ITEM: ATOMS {}\n", headings.join(" "));
        out.write_all(head.as_bytes()).map_err(io)?;

        struct Cell {
            format: Format,
            integer: bool,
            element: bool,
        }
        let mut cells = Vec::new();
        for (k, column) in dump.columns.iter().enumerate() {
            let element = column.source == DumpSource::Element;
            let integer =
                matches!(&column.source, DumpSource::Values(Source::Field(f)) if f.is_integer());
            let format = dump.format(k, integer, element);
            let format = format.ok_or_else(|| {
                Problem::new(format!(
                    "dump `{}`: no format for column {}",
                    dump.id,
                    k + 1
                ))
            })?;
            cells.push(Cell {
                format,
                integer,
                element,
            });
        }
        let (view, clock) = (self.view()?, self.clock());
        let mut values = vec![vec![0.0; BLOCK]; trees.len()];
        let mut text = String::new();
        for first in (0..n).step_by(BLOCK) {
            let m = BLOCK.min(n - first);
            for (tree, column) in trees.iter().zip(&mut values) {
                tree.fill(&view, &clock, first, &mut column[..m])?;
            }
            text.clear();
            for i in (0..m).filter(|i| dump.members.contains(first + i)) {
                for (k, (cell, column)) in cells.iter().zip(&values).enumerate() {
                    if k > 0 {
                        text.push(' ');
                    }
                    let x = column[i];
                    let value = if cell.element {
                        Value::Text(
                            dump.elements
                                .get((x as usize).wrapping_sub(1))
                                .map_or("C", String::as_str),
                        )
                    } else if cell.integer {
                        Value::Integer(x as i64)
                    } else {
                        Value::Float(x)
                    };
                    text.push_str(&cell.format.print(value));
                }
                text.push('\n');
            }
            out.write_all(text.as_bytes()).map_err(io)?;
        }
        Ok(())
    }
}
