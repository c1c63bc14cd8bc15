//! `dump`, `undump`, `dump_modify`, `write_dump`, `write_data`.

use super::Args;
use super::thermo::number_format;
use crate::compute::Source;
use crate::dump::{Dump, DumpColumn, DumpSource, DumpStyle};
use crate::error::{Problem, Result, suggestion};
use crate::fix::Input;
use crate::printf::Format;
use crate::session::Session;
use crate::variable::ast::Op;

const COLUMNS: [&str; 24] = [
    "id", "type", "element", "mass", "proc", "x", "y", "z", "xs", "ys", "zs", "xu", "yu", "zu",
    "ix", "iy", "iz", "vx", "vy", "vz", "fx", "c_ID", "c_ID[i]", "v_name",
];
const OPTIONS: [&str; 13] = [
    "append", "element", "every", "first", "flush", "format", "image", "pad", "scale", "sort",
    "thresh", "time", "units",
];
const STYLES: [&str; 4] = ["custom", "atom", "xyz", "image"];

impl Session<'_> {
    pub(super) fn add_dump(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let id = args.next("a dump ID")?;
        if self.watch.dumps.iter().any(|d| d.id == id.as_str()) {
            return Err(Problem::at(
                id.span,
                format!("there is a dump `{}` already", id.as_str()),
            ));
        }
        let dump = self.read_dump_shape(args, id.as_str(), true)?;
        args.finish()?;
        self.folder.path(&dump.file)?;
        if let Some(other) = self.watch.dumps.iter().find(|d| d.file == dump.file) {
            return Err(Problem::new(format!(
                "the dumps `{}` and `{}` are one file, {}",
                other.id, dump.id, dump.file
            ))
            .help("give each its own file"));
        }
        self.watch.dumps.push(dump);
        Ok(())
    }

    /// `GROUP STYLE [N] FILE columns...`
    fn read_dump_shape(&mut self, args: &mut Args, id: &str, with_every: bool) -> Result<Dump> {
        let word = args.next("a group ID")?;
        let members = self
            .population
            .group(word.as_str())
            .map_err(|p| p.or_at(word.span))?;
        let word = args.next("custom, atom, xyz or image")?;
        let style = match word.as_str() {
            "custom" => DumpStyle::Custom,
            "atom" => DumpStyle::Atom,
            "xyz" => DumpStyle::Xyz,
            "image" => DumpStyle::Image,
            _ => return Err(args.unknown(word, "the dump style", STYLES)),
        };
        let every = if with_every {
            args.count("the number of steps between snapshots", 1)?
        } else {
            1
        };
        let file = args.next("a file name")?;
        if file.as_str().contains('%')
            || [".gz", ".bz2", ".zst", ".bin"]
                .iter()
                .any(|e| file.as_str().ends_with(e))
        {
            return Err(Problem::at(
                file.span,
                "only one plain text file per snapshot is supported",
            )
            .help("use a name without `%`, .gz, .bz2, .zst and .bin"));
        }
        let mut dump = Dump::new(id, members, every, file.as_str());
        dump.style = style;
        match style {
            DumpStyle::Custom => {}
            DumpStyle::Atom => {
                dump.atom_columns();
                return Ok(dump);
            }
            DumpStyle::Xyz => {
                dump.xyz_columns();
                return Ok(dump);
            }
            DumpStyle::Image => {
                let (stem, end) = file
                    .as_str()
                    .rsplit_once('.')
                    .unwrap_or((file.as_str(), ""));
                if !["png", "jpg", "jpeg", "ppm"].contains(&end) {
                    return Err(Problem::at(
                        file.span,
                        "a picture needs a name that ends in .png",
                    ));
                }
                if end != "png" {
                    self.console
                        .note(&format!("pictures are PNG: {stem}.png is written"));
                }
                dump.file = format!("{stem}.png");
                self.console.note("`dump image` draws peridyne's own picture, of all points and their damage: colours, views and zoom of the script have no effect");
                while args.peek().is_some_and(|w| with_every || w != "modify") {
                    args.optional();
                }
                return Ok(dump);
            }
        }
        while let Some(word) = args.optional() {
            if word.as_str() == "modify" && !with_every {
                args.back();
                break;
            }
            let source = match word.as_str() {
                "element" => DumpSource::Element,
                text => {
                    let source = Source::parse(text)
                        .ok_or_else(|| args.unknown(word, "the column", COLUMNS))?;
                    self.check_source(&source).map_err(|p| p.or_at(word.span))?;
                    DumpSource::Values(source)
                }
            };
            dump.columns.push(DumpColumn {
                heading: word.as_str().to_string(),
                source,
            });
        }
        if dump.columns.is_empty() {
            args.next("a column")?;
        }
        Ok(dump)
    }

    pub(super) fn dump_modify(&mut self, args: &mut Args) -> Result<()> {
        let id = args.next("a dump ID")?;
        let Some(at) = self.watch.dumps.iter().position(|d| d.id == id.as_str()) else {
            return Err(
                Problem::at(id.span, format!("there is no dump `{}`", id.as_str())).help(
                    suggestion(id.as_str(), self.watch.dumps.iter().map(|d| d.id.as_str())),
                ),
            );
        };
        if args.left() == 0 {
            args.next("an option")?;
        }
        let mut dump = self.watch.dumps.remove(at);
        let result = self.modify(args, &mut dump);
        self.watch.dumps.insert(at, dump);
        result
    }

    fn modify(&mut self, args: &mut Args, dump: &mut Dump) -> Result<()> {
        while let Some(word) = args.optional() {
            match word.as_str() {
                "append" => dump.append = args.yes("append")?,
                "element" => {
                    dump.elements.clear();
                    for _ in 0..self.population.types {
                        dump.elements
                            .push(args.next("a name for each atom type")?.as_str().to_string());
                    }
                }
                "every" => match args.input("the number of steps, or a variable")? {
                    Input::Variable(name) => {
                        self.variable_exists(&name)?;
                        dump.every_variable = Some((name, None));
                    }
                    Input::Number(_) => {
                        args.back();
                        dump.every_variable = None;
                        dump.every = args.count("the number of steps", 1)?;
                    }
                },
                "thresh" => self.threshold(args, dump)?,
                "first" => dump.first = args.yes("first")?,
                "flush" => {
                    args.yes("flush")?;
                }
                "format" => format_option(args, dump)?,
                "pad" => dump.pad = args.count("the number of digits", 0)?.min(30) as usize,
                "time" => dump.time = args.yes("time")?,
                "units" => dump.units = args.yes("units")?,
                "image" | "scale" if dump.style == DumpStyle::Atom => {
                    let on = args.yes(word.as_str())?;
                    *(if word.as_str() == "image" {
                        &mut dump.image
                    } else {
                        &mut dump.scale
                    }) = on;
                    dump.atom_columns();
                }
                "sort" => {
                    let how = args.next("id, off or a column number")?;
                    let column = how.as_str().parse::<i64>().ok();
                    let place = column.map_or(0, |c| c.unsigned_abs() as usize);
                    dump.sort = match column {
                        // unsorted atoms are in order of id here
                        None if ["id", "off"].contains(&how.as_str()) => (None, false),
                        Some(c) if (1..=dump.columns.len()).contains(&place) => {
                            (Some(place - 1), c < 0)
                        }
                        _ => {
                            let known = ["id", "off", "a column number"];
                            return Err(args.unknown(how, "sorting by", known));
                        }
                    };
                }
                _ => {
                    return Err(args.unknown(word, "the option", OPTIONS));
                }
            }
        }
        Ok(())
    }

    pub(super) fn remove_dump(&mut self, args: &mut Args) -> Result<()> {
        let id = args.next("a dump ID")?;
        args.finish()?;
        let before = self.watch.dumps.len();
        self.watch.dumps.retain(|d| d.id != id.as_str());
        if self.watch.dumps.len() == before {
            return Err(
                Problem::at(id.span, format!("there is no dump `{}`", id.as_str())).help(
                    suggestion(id.as_str(), self.watch.dumps.iter().map(|d| d.id.as_str())),
                ),
            );
        }
        Ok(())
    }

    pub(super) fn write_dump(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let mut dump = self.read_dump_shape(args, "write_dump", false)?;
        if args.eat("modify") {
            self.modify(args, &mut dump)?;
        }
        args.finish()?;
        self.write_snapshot(&mut dump)
    }

    pub(super) fn write_data_command(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let file = args.next("a file name")?;
        while let Some(word) = args.optional() {
            match word.as_str() {
                "nocoeff" => {} // coefficients are never written
                _ => return Err(args.unknown(word, "the option", ["nocoeff"])),
            }
        }
        let name = file.as_str().replace('*', &self.progress.step.to_string());
        self.write_data(&name)
    }
}

impl Session<'_> {
    /// `thresh ATTRIBUTE OPERATOR VALUE`, or `none`.
    fn threshold(&mut self, args: &mut Args, dump: &mut Dump) -> Result<()> {
        let word = args.next("an attribute, or none")?;
        if word.as_str() == "none" {
            dump.thresholds.clear();
            return Ok(());
        }
        let source = Source::parse(word.as_str());
        let source = source.ok_or_else(|| args.unknown(word, "the attribute", COLUMNS))?;
        self.check_source(&source).map_err(|p| p.or_at(word.span))?;
        const KNOWN: [&str; 7] = ["<", "<=", ">", ">=", "==", "!=", "|^"];
        let word = args.next("an operator")?;
        let op = Op::SPELLING
            .into_iter()
            .find(|(s, _)| KNOWN.contains(s) && *s == word.as_str());
        let (_, op) = op.ok_or_else(|| args.unknown(word, "the operator", KNOWN))?;
        let limit = args.number("a value")?;
        dump.thresholds.push((source, op, limit));
        Ok(())
    }
}

fn format_option(args: &mut Args, dump: &mut Dump) -> Result<()> {
    let what = args.next("line, int, float, a column or none")?;
    match (what.as_str(), what.as_str().parse::<usize>().ok()) {
        ("none", _) => {
            (dump.line, dump.integer, dump.float) = (None, None, None);
            dump.single.clear();
        }
        ("int", _) => dump.integer = Some(number_format(args.next("a format")?)?),
        ("float", _) => dump.float = Some(number_format(args.next("a format")?)?),
        ("line", _) => {
            let word = args.next("a format")?;
            let formats =
                Format::parse_line(word.as_str()).map_err(|e| Problem::at(word.span, e))?;
            if formats.len() != dump.columns.len() {
                return Err(Problem::at(
                    word.span,
                    format!(
                        "{} formats for {} columns of dump `{}`",
                        formats.len(),
                        dump.columns.len(),
                        dump.id
                    ),
                ));
            }
            dump.line = Some(
                formats
                    .into_iter()
                    .map(Format::without_following_blank)
                    .collect(),
            );
        }
        (_, Some(k)) if (1..=dump.columns.len()).contains(&k) => {
            let word = args.next("a format")?;
            let format = Format::parse(word.as_str()).map_err(|e| Problem::at(word.span, e))?;
            dump.single.push((k - 1, format));
        }
        _ => {
            return Err(args.unknown(
                what,
                "the format of",
                ["line", "int", "float", "none", "a column number"],
            ));
        }
    }
    Ok(())
}
