//! Snapshots of dumps, written when they are due.

use super::{Dump, DumpColumn, DumpSource, DumpStyle};
use crate::compute::{ComputeKind, Source};
use crate::error::{Problem, Result};
use crate::files::Sink;
use crate::host::{BLOCK, Quantity};
use crate::particles::Field;
use crate::printf::{Format, Value};
use crate::session::Session;
use crate::variable::tree::Tree;
use peridyne_io::write::picture::shown::About;
use peridyne_io::write::picture::{self, PictureOptions};

impl Session<'_> {
    /// Is a dump due at this step?
    ///
    /// # Errors
    /// A variable cannot be evaluated.
    pub fn dumps_due(&mut self, step: u64) -> Result<bool> {
        Ok(self.watch.dumps.iter().any(|d| d.due(step)))
    }

    /// Writes the dumps that are due at this step.
    ///
    /// # Errors
    /// A value does not exist; a file cannot be written.
    pub fn write_dumps(&mut self, at_start: bool) -> Result<()> {
        for k in 0..self.watch.dumps.len() {
            let step = self.progress.step;
            let dump = &self.watch.dumps[k];
            let due = dump.due(step) || (at_start && dump.first && dump.last_written.is_none());
            let write = due && dump.last_written != Some(step);
            if let Some((name, next)) = &dump.every_variable
                && (due || (at_start && next.is_none_or(|n| n <= step)))
            {
                let name = name.clone();
                let next = self.variable_number(&name)?;
                if !(next > step as f64) {
                    return Err(Problem::new(format!(
                        "variable `{name}` of `dump_modify every` gives step {next}, which is not after step {step}"
                    )));
                }
                self.watch.dumps[k].every_variable = Some((name, Some(next as u64)));
            }
            if write {
                let mut dump = self.watch.dumps.remove(k);
                let result = self.write_snapshot(&mut dump);
                self.watch.dumps.insert(k, dump);
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
        let mut writer = match dump.writer.take() {
            Some(w) => w,
            None => self.folder.open(&dump.path_name(step), dump.append)?,
        };
        if dump.style == DumpStyle::Image {
            self.picture(&mut writer)?;
        } else {
            let mut trees = Vec::new();
            for column in &dump.columns {
                trees.push(match &column.source {
                    DumpSource::Element => Tree::Field(Field::Raw(Quantity::Type)),
                    DumpSource::Values(source) => self.source_tree(source)?,
                });
            }
            let rows = self.rows(dump, &trees)?;
            self.snapshot_text(dump, &trees, rows.as_deref(), &mut writer)?;
            self.watch.record.snapshot(writer.path());
            self.note_fields(&dump.columns);
        }
        writer.flush()?;
        dump.last_written = Some(step);
        if !dump.file.contains('*') {
            dump.writer = Some(writer);
        }
        Ok(())
    }

    /// Which columns are fields of the model.
    fn note_fields(&mut self, columns: &[DumpColumn]) {
        for column in columns {
            let DumpSource::Values(Source::Compute(id, None)) = &column.source else {
                continue;
            };
            let compute = self.watch.computes.iter().find(|c| c.id == *id);
            let field = match compute.map(|c| &c.kind) {
                Some(ComputeKind::Atoms(fields)) => match fields[..] {
                    [Field::Raw(Quantity::Damage)] => "damage",
                    [Field::Raw(Quantity::Dilatation)] => "dilatation",
                    _ => continue,
                },
                _ => continue,
            };
            self.watch.record.field(&column.heading, field);
        }
    }

    /// The atoms of a snapshot in their order; `None`: all members in order of id.
    fn rows(&mut self, dump: &Dump, trees: &[Tree]) -> Result<Option<Vec<u32>>> {
        if dump.thresholds.is_empty() && dump.sort == (None, false) {
            return Ok(None);
        }
        let n = self.population.count();
        let mut rows: Vec<u32> = (0..n as u32)
            .filter(|i| dump.members.contains(*i as usize))
            .collect();
        for (source, op, limit) in &dump.thresholds {
            let tree = self.source_tree(source)?;
            let values = self.values(&tree)?;
            let holds = |i: u32| op.apply(values[i as usize], *limit).is_ok_and(|t| t != 0.0);
            rows.retain(|i| holds(*i));
        }
        if let (Some(column), _) = dump.sort {
            let values = self.values(&trees[column])?;
            rows.sort_by(|a, b| values[*a as usize].total_cmp(&values[*b as usize]));
        }
        if dump.sort.1 {
            rows.reverse();
        }
        Ok(Some(rows))
    }

    /// Our own picture of the damage.
    fn picture(&mut self, out: &mut Sink) -> Result<()> {
        let (length_unit, time_unit) = self.space.units.labels();
        let title = self.title.clone();
        let Some(snapshot) = self.population.engine()?.snapshot() else {
            return Err(Problem::new("there is no picture of this model"));
        };
        let options = PictureOptions {
            title,
            length_unit: length_unit.to_string(),
            time_unit: time_unit.to_string(),
            ..PictureOptions::default()
        };
        let mut bytes = Vec::new();
        picture::picture(&snapshot, &[], &options, About::Fracture)
            .and_then(|image| image.write_png(&mut bytes))
            .map_err(|e| Problem::new(format!("the picture cannot be drawn: {e}")))?;
        out.write_bytes(&bytes)
    }

    /// The head of a snapshot.
    fn head(&self, dump: &Dump, atoms: usize) -> Result<String> {
        let step = self.progress.step;
        if dump.style == DumpStyle::Xyz {
            return Ok(format!("{atoms}\n Atoms. Timestep: {step}\n"));
        }
        let domain = self.space.domain()?;
        let mut head = String::new();
        if dump.units && dump.last_written.is_none() {
            head += &format!("ITEM: UNITS\n{}\n", self.space.units.name());
        }
        if dump.time {
            let time = Format::parse("%.16g")
                .map(|f| f.print(Value::Float(self.progress.time())))
                .unwrap_or_default();
            head += &format!("ITEM: TIME\n{time}\n");
        }
        head += &format!("ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n{atoms}\n");
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
        Ok(head)
    }

    fn snapshot_text(
        &self,
        dump: &Dump,
        trees: &[Tree],
        rows: Option<&[u32]>,
        out: &mut Sink,
    ) -> Result<()> {
        let n = self.population.count();
        let atoms = rows.map_or_else(|| dump.members.count(n), <[u32]>::len);
        out.write(&self.head(dump, atoms)?)?;
        let cells = cells(dump)?;
        let mut text = String::new();
        if let Some(rows) = rows {
            let columns = trees.iter().map(|t| self.values(t));
            let columns = columns.collect::<Result<Vec<_>>>()?;
            for block in rows.chunks(BLOCK) {
                text.clear();
                for i in block {
                    print_row(dump, &cells, &columns, *i as usize, &mut text);
                }
                out.write(&text)?;
            }
            return Ok(());
        }
        let (view, clock) = (self.view()?, self.progress.clock());
        let mut values = vec![vec![0.0; BLOCK]; trees.len()];
        for first in (0..n).step_by(BLOCK) {
            let m = BLOCK.min(n - first);
            for (tree, column) in trees.iter().zip(&mut values) {
                tree.fill(&view, &clock, first, &mut column[..m])?;
            }
            text.clear();
            for i in (0..m).filter(|i| dump.members.contains(first + i)) {
                print_row(dump, &cells, &values, i, &mut text);
            }
            out.write(&text)?;
        }
        Ok(())
    }
}

/// How a column is printed.
struct Cell {
    format: Format,
    integer: bool,
    element: bool,
}

fn cells(dump: &Dump) -> Result<Vec<Cell>> {
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
    Ok(cells)
}

fn print_row(dump: &Dump, cells: &[Cell], columns: &[Vec<f64>], row: usize, text: &mut String) {
    for (k, (cell, column)) in cells.iter().zip(columns).enumerate() {
        if k > 0 {
            text.push(' ');
        }
        let x = column[row];
        if cell.element {
            let name = dump.elements.get((x as usize).wrapping_sub(1));
            let unnamed = match dump.style {
                DumpStyle::Xyz => format!("{x}"),
                DumpStyle::Custom | DumpStyle::Atom | DumpStyle::Image => "C".to_string(),
            };
            let name = name.map_or(unnamed.as_str(), String::as_str);
            text.push_str(&cell.format.print(Value::Text(name)));
            continue;
        }
        let value = match cell.integer {
            true => Value::Integer(x as i64),
            false => Value::Float(x),
        };
        text.push_str(&cell.format.print(value));
    }
    text.push('\n');
}
