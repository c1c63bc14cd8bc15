//! `thermo`, `thermo_style`, `thermo_modify`.

use super::Args;
use crate::error::{Problem, Result};
use crate::printf::Format;
use crate::session::Session;
use crate::text::Word;
use crate::thermo::columns::{self, Column};
use crate::thermo::{Line, Lost, Thermo};

/// One conversion, which must suit a number.
pub(super) fn number_format(word: &Word) -> Result<Format> {
    match Format::parse(word.as_str()) {
        Ok(f) if f.is_text() => Err(Problem::at(word.span, "a number cannot be printed with %s")),
        Ok(f) => Ok(f),
        Err(e) => Err(Problem::at(word.span, e)),
    }
}

impl Session<'_> {
    pub(super) fn set_thermo(&mut self, args: &mut Args) -> Result<()> {
        self.watch.thermo.every = args.count("the number of steps between lines", 0)?;
        args.finish()
    }

    pub(super) fn thermo_style(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let style = args.next("one, multi, yaml or custom")?;
        let columns = match style.as_str() {
            "one" => columns::one(),
            "multi" => columns::multi(),
            "yaml" => columns::yaml(),
            "custom" => {
                let mut columns = Vec::new();
                while let Some(word) = args.optional() {
                    let column = Column::parse(word.as_str()).map_err(|p| p.or_at(word.span))?;
                    self.check_column(&column).map_err(|p| p.or_at(word.span))?;
                    columns.push(column);
                }
                if columns.is_empty() {
                    args.next("a keyword")?;
                }
                columns
            }
            _ => {
                let known = ["one", "multi", "yaml", "custom"];
                return Err(args.unknown(style, "the style", known));
            }
        };
        args.finish()?;
        let old = &self.watch.thermo;
        if old.integer.is_some()
            || old.float.is_some()
            || !old.single.is_empty()
            || old.lost != Lost::Error
        {
            self.console
                .note("a new thermo_style drops earlier thermo_modify settings");
        }
        self.watch.thermo = Thermo {
            columns,
            add_volume: style.as_str() != "custom",
            line: match style.as_str() {
                "multi" => Line::Multi,
                "yaml" => Line::Yaml,
                _ => Line::One,
            },
            every: self.watch.thermo.every,
            ..Thermo::default()
        };
        Ok(())
    }

    pub(super) fn thermo_modify(&mut self, args: &mut Args) -> Result<()> {
        if args.left() == 0 {
            args.next("an option")?;
        }
        while let Some(word) = args.optional() {
            match word.as_str() {
                "lost" => {
                    let how = args.next("error, warn or ignore")?;
                    self.watch.thermo.lost = match how.as_str() {
                        "error" => Lost::Error,
                        "warn" => Lost::Warn,
                        "ignore" => Lost::Ignore,
                        _ => {
                            return Err(args.unknown(
                                how,
                                "the value",
                                ["error", "warn", "ignore"],
                            ));
                        }
                    };
                }
                "norm" => self.watch.thermo.normalize = Some(args.yes("norm")?),
                "flush" => {
                    args.yes("flush")?;
                }
                "line" => {
                    let how = args.next("one, multi or yaml")?;
                    self.watch.thermo.line = match how.as_str() {
                        "one" => Line::One,
                        "multi" => Line::Multi,
                        "yaml" => Line::Yaml,
                        _ => return Err(args.unknown(how, "the value", ["one", "multi", "yaml"])),
                    };
                }
                "format" => self.thermo_format(args)?,
                _ => {
                    return Err(args.unknown(
                        word,
                        "the option",
                        ["format", "line", "lost", "norm", "flush"],
                    ));
                }
            }
        }
        Ok(())
    }

    fn thermo_format(&mut self, args: &mut Args) -> Result<()> {
        let what = args.next("line, int, float, a column or none")?;
        let column = what.as_str().parse::<usize>().ok();
        match what.as_str() {
            "none" => {
                self.watch.thermo.integer = None;
                self.watch.thermo.float = None;
                self.watch.thermo.single.clear();
            }
            "int" => self.watch.thermo.integer = Some(number_format(args.next("a format")?)?),
            "float" => self.watch.thermo.float = Some(number_format(args.next("a format")?)?),
            "line" => {
                let word = args.next("a format")?;
                let formats =
                    Format::parse_line(word.as_str()).map_err(|e| Problem::at(word.span, e))?;
                let columns = self.watch.thermo.columns.len();
                if formats.len() < columns {
                    return Err(Problem::at(
                        word.span,
                        format!("{} formats for {columns} thermo columns", formats.len()),
                    ));
                }
                // the text between the conversions takes the place of the blank that joins columns
                let trimmed = formats.into_iter().map(Format::without_following_blank);
                self.watch.thermo.single.extend(trimmed.enumerate());
            }
            _ => match column {
                Some(k) if (1..=self.watch.thermo.columns.len()).contains(&k) => {
                    let format = number_format(args.next("a format")?)?;
                    self.watch.thermo.single.push((k - 1, format));
                }
                _ => {
                    let known = ["line", "int", "float", "none", "a column number"];
                    return Err(args.unknown(what, "the format of", known));
                }
            },
        }
        Ok(())
    }
}
