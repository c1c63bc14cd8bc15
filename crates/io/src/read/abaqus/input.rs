//! The lines of a file and of those that it includes, as blocks of a keyword and its data.

use super::super::error::ReadError;

use super::super::text_of;
use super::keyword::{Keyword, Label, split};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Files that include each other.
const DEPTH: usize = 20;
/// Files that are included, the same one as often as it is.
const INCLUDES: usize = 1000;
/// Lines in all.
const LINES: usize = 1 << 27;

struct File<'a> {
    name: String,
    text: Cow<'a, str>,
}

/// A line: its file, its number from 1, its bytes.
struct Line {
    file: u32,
    number: u32,
    start: usize,
    end: usize,
}

/// All lines, in the order in which they are read.
pub(super) struct Deck<'a> {
    files: Vec<File<'a>>,
    lines: Vec<Line>,
    includes: usize,
}

/// Does a line begin a block?
fn is_keyword(line: &str) -> bool {
    line.starts_with('*') && !line.starts_with("**")
}

/// What is shown of a long text.
pub(super) fn short(text: &str) -> Cow<'_, str> {
    match text.char_indices().nth(40) {
        Some((end, _)) => Cow::Owned(format!("{}…", &text[..end])),
        None => Cow::Borrowed(text),
    }
}

impl<'a> Deck<'a> {
    /// `folder` is where files that it includes are looked for; a text without one includes none.
    pub fn new(text: &'a str, name: &str, folder: Option<&Path>) -> Result<Self, ReadError> {
        let mut deck = Deck {
            files: vec![File {
                name: name.to_string(),
                text: Cow::Borrowed(text),
            }],
            lines: Vec::new(),
            includes: 0,
        };
        deck.take(0, folder, &mut Vec::new())?;
        Ok(deck)
    }

    /// The lines of a file, with what it includes.
    fn take(
        &mut self,
        file: usize,
        folder: Option<&Path>,
        open: &mut Vec<PathBuf>,
    ) -> Result<(), ReadError> {
        let (mut from, mut number) = (0, 0);
        // the first line of a keyword line that may go on
        let mut header: Option<usize> = None;
        loop {
            let text = &self.files[file].text;
            let start = match from {
                // a mark of the byte order
                0 if text.starts_with('\u{feff}') => '\u{feff}'.len_utf8(),
                from => from,
            };
            let done = start >= text.len();
            let line = text.get(start..).unwrap_or("").split('\n').next();
            let line = line.unwrap_or("");
            let (end, trimmed) = (start + line.len(), line.trim());
            let (blank, begins) = (
                trimmed.is_empty() || trimmed.starts_with("**"),
                is_keyword(trimmed),
            );
            let goes_on = trimmed.ends_with(',');
            if let Some(first) = header
                && (done || begins)
            {
                header = None;
                self.include(first, folder, open)?;
            }
            if done {
                return Ok(());
            }
            number += 1;
            self.lines.push(Line {
                file: file as u32,
                number,
                start,
                end,
            });
            if self.lines.len() > LINES {
                return Err(self.error(self.lines.len() - 1, "the file has too many lines"));
            }
            from = end + 1;
            if begins {
                header = Some(self.lines.len() - 1);
            }
            if let Some(first) = header
                && !blank
                && !goes_on
            {
                header = None;
                self.include(first, folder, open)?;
            }
        }
    }

    /// Reads what the keyword line that begins there includes.
    fn include(
        &mut self,
        first: usize,
        folder: Option<&Path>,
        open: &mut Vec<PathBuf>,
    ) -> Result<(), ReadError> {
        let keyword = self.keyword(first).0;
        let input = keyword.value("INPUT").map(|v| v.trim_matches('"'));
        let alone = keyword.name == "INCLUDE";
        let data = input.is_some() && matches!(&*keyword.name, "NODE" | "ELEMENT");
        if !(alone || data) {
            return Ok(());
        }
        let refuse = |message: String| Err(self.error(first, message));
        let Some(input) = input else {
            return refuse("*INCLUDE needs INPUT=".into());
        };
        if let Some(other) = keyword.other(&["INPUT"]).filter(|_| alone) {
            return refuse(format!("*INCLUDE with {other} is not read"));
        }
        let Some(folder) = folder else {
            return refuse(format!("{} includes a file: put it in", keyword.shown));
        };
        let path = folder.join(input);
        if !std::fs::metadata(&path).is_ok_and(|m| m.is_file()) {
            let file = short(input);
            return refuse(format!(
                "cannot read the included file {file}: it is looked for beside {}",
                self.files[0].name
            ));
        }
        let real = std::fs::canonicalize(&path).unwrap_or_else(|_| path.clone());
        if open.contains(&real) || open.len() >= DEPTH {
            return refuse(format!(
                "{} is included by itself, or in more than {DEPTH} levels",
                short(input)
            ));
        }
        if self.includes == INCLUDES {
            return refuse(format!("more than {INCLUDES} files are included"));
        }
        self.includes += 1;
        let name = path.display().to_string();
        let known = self.files.iter().position(|f| f.name == name);
        let file = match known {
            Some(file) => file,
            None => {
                let (text, name) = text_of(&path)?;
                self.files.push(File {
                    name,
                    text: Cow::Owned(text),
                });
                self.files.len() - 1
            }
        };
        if alone {
            // what it includes stands in its place, data of a block too
            self.lines.truncate(first);
        }
        open.push(real);
        self.take(file, Some(folder), open)?;
        open.pop();
        Ok(())
    }

    fn text(&self, line: usize) -> &str {
        let line = &self.lines[line];
        self.files[line.file as usize].text[line.start..line.end].trim()
    }

    /// A keyword line, and the line after it and those that go on with it.
    fn keyword(&self, first: usize) -> (Keyword, usize) {
        let mut header = self.text(first).to_string();
        let mut next = first + 1;
        while header.ends_with(',') && next < self.lines.len() {
            let line = self.text(next);
            if is_keyword(line) {
                break;
            }
            if !line.starts_with("**") {
                header.push_str(line);
            }
            next += 1;
        }
        (Keyword::new(&header), next)
    }

    /// Calls for each block.
    pub fn blocks(
        &self,
        mut each: impl FnMut(&Block) -> Result<(), ReadError>,
    ) -> Result<(), ReadError> {
        let mut line = 0;
        while line < self.lines.len() {
            let text = self.text(line);
            if text.is_empty() || text.starts_with("**") {
                line += 1;
                continue;
            }
            if !is_keyword(text) {
                let found = short(text);
                return Err(self.error(line, format!("expected a keyword, found `{found}`")));
            }
            let (keyword, data) = self.keyword(line);
            let after = (data..self.lines.len()).find(|l| is_keyword(self.text(*l)));
            let block = Block {
                deck: self,
                keyword,
                at: line,
                data,
                end: after.unwrap_or(self.lines.len()),
            };
            each(&block)?;
            line = block.end;
        }
        Ok(())
    }

    pub fn error(&self, line: usize, message: impl Into<String>) -> ReadError {
        let line = &self.lines[line];
        ReadError {
            file: self.files[line.file as usize].name.clone(),
            line: Some(line.number as usize),
            message: message.into(),
        }
    }

    /// The same error, whose line is the place of a line among all, from 1.
    pub fn located(&self, error: ReadError) -> ReadError {
        match error.line {
            Some(line) => self.error(line - 1, error.message),
            None => error,
        }
    }

    /// The number of a line in the file itself; 0 in files that it includes.
    pub fn number(&self, line: usize) -> usize {
        let line = &self.lines[line];
        if line.file == 0 {
            line.number as usize
        } else {
            0
        }
    }
}

/// A keyword and its data lines.
pub(super) struct Block<'a> {
    deck: &'a Deck<'a>,
    pub keyword: Keyword,
    /// Its line among all.
    pub at: usize,
    data: usize,
    end: usize,
}

impl<'a> Block<'a> {
    pub fn rows(&self) -> Rows<'a> {
        Rows {
            deck: self.deck,
            at: self.at,
            next: self.data,
            end: self.end,
            fields: Vec::new(),
            goes_on: false,
        }
    }

    pub fn error(&self, message: impl Into<String>) -> ReadError {
        self.deck.error(self.at, message)
    }

    /// Refuses options that are none of these.
    pub fn only(&self, known: &[&str]) -> Result<(), ReadError> {
        match self.keyword.other(known) {
            None => Ok(()),
            Some(other) => Err(self.error(format!(
                "{} with {} is not read; known are {}",
                self.keyword.shown,
                short(other),
                known.join(", ")
            ))),
        }
    }

    pub fn label(&self, option: &str) -> Option<Label> {
        let label = self.keyword.value(option).map(Label::new);
        label.filter(|l| !l.key.is_empty())
    }

    pub fn needed(&self, option: &str) -> Result<&str, ReadError> {
        let value = self.keyword.value(option).filter(|v| !v.is_empty());
        value.ok_or_else(|| self.error(format!("{} needs {option}=", self.keyword.shown)))
    }
}

/// Data lines, one at a time; blank ones and comments are left out.
pub(super) struct Rows<'a> {
    deck: &'a Deck<'a>,
    /// The line among all; that of the keyword before the first.
    pub at: usize,
    next: usize,
    end: usize,
    pub fields: Vec<&'a str>,
    /// The line ends with a comma.
    pub goes_on: bool,
}

impl<'a> Rows<'a> {
    /// The next line, if there is one.
    pub fn next(&mut self) -> bool {
        self.fields.clear();
        let found = self.more();
        if found {
            self.at = self.next - 1;
        }
        found
    }

    /// The fields of the next line, after those that are there.
    pub fn more(&mut self) -> bool {
        while self.next < self.end {
            let line = self.deck.text(self.next);
            self.next += 1;
            if line.is_empty() || line.starts_with("**") {
                continue;
            }
            split(line, ',', &mut self.fields);
            self.goes_on = line.ends_with(',');
            if self.goes_on {
                self.fields.pop();
            }
            return true;
        }
        false
    }

    /// A field that is there and not blank.
    pub fn field(&self, k: usize) -> Option<&'a str> {
        self.fields.get(k).copied().filter(|f| !f.is_empty())
    }

    pub fn error(&self, message: impl Into<String>) -> ReadError {
        self.deck.error(self.at, message)
    }

    fn parse<T: FromStr>(&self, text: &str, what: &str) -> Result<T, ReadError> {
        let message = || self.error(format!("expected {what}, found `{}`", short(text)));
        text.parse().map_err(|_| message())
    }

    /// A whole number; `None` where the field is blank.
    pub fn whole<T: FromStr>(&self, k: usize, what: &str) -> Result<Option<T>, ReadError> {
        self.field(k).map(|text| self.parse(text, what)).transpose()
    }

    /// The number of a node or an element, from 1.
    pub fn number(&self, k: usize, what: &str) -> Result<u64, ReadError> {
        let number = self.whole(k, what)?;
        let number = number.ok_or_else(|| self.error(format!("expected {what}, the line ends")))?;
        self.allowed(number, what)
    }

    /// Abaqus's limits of the numbers of nodes and elements.
    pub fn allowed(&self, number: u64, what: &str) -> Result<u64, ReadError> {
        if (1..=LARGEST).contains(&number) {
            return Ok(number);
        }
        Err(self.error(format!(
            "{what} is {number}: numbers go from 1 to {LARGEST}"
        )))
    }

    /// A number; blank is 0. Exponents may be written with D.
    pub fn real(&self, k: usize, what: &str) -> Result<f64, ReadError> {
        let Some(text) = self.field(k) else {
            return Ok(0.0);
        };
        let value: f64 = match text.parse() {
            Ok(value) => value,
            Err(_) => match text.replace(['d', 'D'], "e").parse() {
                Ok(value) => value,
                Err(_) => self.parse(text, what)?,
            },
        };
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.error(format!("{what} is {value}")))
    }

    pub fn point(&self, from: usize) -> Result<[f64; 3], ReadError> {
        Ok([
            self.real(from, "x")?,
            self.real(from + 1, "y")?,
            self.real(from + 2, "z")?,
        ])
    }

    /// Is any of these fields there?
    pub fn any(&self, fields: std::ops::Range<usize>) -> bool {
        fields.into_iter().any(|k| self.field(k).is_some())
    }
}

/// The largest number of a node or element.
pub(super) const LARGEST: u64 = 999_999_999;
