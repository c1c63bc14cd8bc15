//! `variable`.

use std::rc::Rc;

use super::Args;
use crate::error::{Problem, Result, suggestion};
use crate::input;
use crate::printf::Format;
use crate::session::Session;
use crate::text::Word;
use crate::variable::parse::parse;
use crate::variable::{Formula, Kind, is_name};

const STYLES: [&str; 10] = [
    "index", "loop", "string", "file", "getenv", "equal", "atom", "internal", "format", "delete",
];

impl Session<'_> {
    pub(super) fn set_variable(&mut self, args: &mut Args) -> Result<()> {
        let word = args.next("a name")?;
        let name = word.as_str();
        if !is_name(name) {
            return Err(Problem::at(
                word.span,
                format!("`{name}` is not a name: use letters, digits and _"),
            ));
        }
        let style = args.next("a style")?;
        let defined = self.formulas.variables.get(name).map(Kind::style);
        let kind = match style.as_str() {
            "delete" => {
                self.formulas.variables.delete(name);
                return args.finish();
            }
            "index" => {
                let mut values = vec![args.next("a value")?.as_str().to_string()];
                while let Some(value) = args.optional() {
                    values.push(value.as_str().to_string());
                }
                Kind::Index { values, at: 0 }
            }
            "loop" => self.loop_kind(args)?,
            "file" => self.file_kind(args)?,
            "getenv" => {
                let of = args.next("the name of a variable of the environment")?;
                if std::env::var(of.as_str()).is_err() {
                    return Err(Problem::at(
                        of.span,
                        format!("the environment has no variable `{}`", of.as_str()),
                    )
                    .help(format!(
                        "set it before: {}=VALUE peridyne run ...",
                        of.as_str()
                    )));
                }
                Kind::Environment(of.as_str().to_string())
            }
            "string" => Kind::Text(args.next("a text")?.as_str().to_string()),
            "equal" => Kind::Equal(Rc::new(read_formula(&args.rest("a formula")?)?)),
            "atom" => Kind::Atom(Rc::new(read_formula(&args.rest("a formula")?)?)),
            "internal" => Kind::Internal(args.number("a value")?),
            "format" => {
                let of = args.next("the name of a variable")?;
                self.variable_exists(of.as_str())
                    .map_err(|p| p.or_at(of.span))?;
                let format = super::thermo::number_format(args.next("a format")?)?;
                Kind::Format {
                    of: of.as_str().to_string(),
                    format,
                }
            }
            _ => return Err(args.unknown(style, "the variable style", STYLES)),
        };
        args.finish()
            .map_err(|p| p.help("put a formula or text with blanks into quotes"))?;
        match defined {
            // these keep their first definition, so that the command line and loops can set them
            Some("index" | "loop" | "file")
                if matches!(
                    kind,
                    Kind::Index { .. } | Kind::Loop { .. } | Kind::File { .. }
                ) =>
            {
                Ok(())
            }
            Some(old) if old != kind.style() => Err(Problem::at(
                style.span,
                format!("variable `{name}` has the style {old} already"),
            )
            .help(format!(
                "write `variable {name} delete` before to define it anew"
            ))),
            _ => {
                self.formulas.variables.set(name, kind);
                Ok(())
            }
        }
    }

    /// The lines of a file beside the script, without comments and empty lines.
    fn file_kind(&mut self, args: &mut Args) -> Result<Kind> {
        let word = args.next("a file name")?;
        let path = self.input_path(word.as_str());
        self.folder.inside(&path).map_err(|p| p.or_at(word.span))?;
        let text = input::text(&path, word.as_str()).map_err(|p| p.or_at(word.span))?;
        let plain = |line: &str| line.split('#').next().unwrap_or("").trim().to_string();
        let values: Vec<String> = text
            .lines()
            .map(plain)
            .filter(|line| !line.is_empty())
            .collect();
        if values.is_empty() {
            return Err(Problem::at(word.span, "the file holds no values"));
        }
        Ok(Kind::File {
            values: values.into(),
            at: 0,
        })
    }

    fn loop_kind(&mut self, args: &mut Args) -> Result<Kind> {
        let a = args.integer("a number")?;
        let (first, last) = match args.peek() {
            None | Some("pad") => (1, a),
            Some(_) => (a, args.integer("the last number")?),
        };
        let pad = args.eat("pad");
        if first > last || first < 0 {
            return Err(Problem::new(format!(
                "the loop from {first} to {last} is empty or starts below 0"
            )));
        }
        let width = if pad { last.to_string().len() } else { 0 };
        Ok(Kind::Loop {
            first,
            last,
            at: first,
            width,
        })
    }
}

fn read_formula(word: &Word) -> Result<Formula> {
    let text = word.as_str().to_string();
    match parse(&text) {
        Ok(expr) => Ok(Formula { text, expr }),
        Err(e) => {
            let at = e.at.min(text.len());
            let end = text[at..]
                .char_indices()
                .nth(1)
                .map_or(text.len(), |(k, _)| at + k);
            let place = if at < text.len() {
                word.text.span(at, end)
            } else {
                (word.span.1, word.span.1)
            };
            let p = Problem::at(place, format!("{} (in the formula `{text}`)", e.message));
            Err(match e.help {
                Some(h) => p.help(h),
                None => p,
            })
        }
    }
}

impl Session<'_> {
    /// Defines an index variable, as the command line does.
    ///
    /// # Errors
    /// The name is not valid or there are no values.
    pub fn define(&mut self, name: &str, values: &[String]) -> Result<()> {
        if !is_name(name) || values.is_empty() {
            return Err(Problem::new(format!(
                "`--var {name}`: expected NAME=VALUE with letters, digits and _"
            ))
            .help(suggestion(name, [])));
        }
        self.formulas.variables.set(
            name,
            Kind::Index {
                values: values.to_vec(),
                at: 0,
            },
        );
        Ok(())
    }

    /// `${name:%format}` is not a variable's name.
    pub fn check_format(text: &str) -> Result<Format> {
        Format::parse(text).map_err(Problem::new).and_then(|f| {
            if f.is_text() {
                Err(Problem::new("a number cannot be printed with %s"))
            } else {
                Ok(f)
            }
        })
    }
}
