//! The text of a deck with its overrides, as one tree whose spans say which text they are in.
//!
//! An override is parsed as a line that stands behind the deck's end: its spans start where the texts before it
//! end, so one number tells the place in all of them.

use super::error::DeckError;
use super::renamed::Renames;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeString, DeTable, DeValue};

/// Tables that a deck has several of.
pub(super) const SEVERAL: [&str; 8] = [
    "probe",
    "fields",
    "boundary_condition",
    "initial",
    "precrack",
    "rigid_body",
    "bond_stiffness",
    "toughness",
];

/// A deck's text and its overrides.
#[derive(Debug, Clone)]
pub struct Source {
    file: String,
    text: String,
    overrides: Vec<Override>,
}

/// A key of a deck with its value, and what said so (`--spacing`).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Flag {
    pub name: String,
    pub key: String,
    /// TOML, or a bare word.
    pub value: String,
}

#[derive(Debug, Clone)]
struct Override {
    /// What it is called in errors.
    name: String,
    line: String,
    /// The line behind as many blanks as there are bytes before it.
    padded: String,
}

pub(super) type Tree<'a> = Spanned<DeTable<'a>>;

impl Source {
    pub fn new(text: &str, file: &str, overrides: &[(String, String)]) -> Self {
        let flag = |(key, value): &(String, String)| Flag {
            name: format!("--set {key}"),
            key: key.clone(),
            value: value.clone(),
        };
        Self::with_flags(text, file, overrides.iter().map(flag))
    }

    pub fn with_flags(text: &str, file: &str, flags: impl Iterator<Item = Flag>) -> Self {
        let mut start = text.len() + 1;
        let mut lines = Vec::new();
        for flag in flags {
            let line = line(&flag.key, &flag.value);
            let padded = format!("{}{line}", " ".repeat(start));
            start = padded.len() + 1;
            lines.push(Override {
                name: flag.name,
                line,
                padded,
            });
        }
        Source {
            file: file.to_string(),
            text: text.to_string(),
            overrides: lines,
        }
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    pub fn file(&self) -> &str {
        &self.file
    }

    /// The text that a place lies in: its name, itself and where it starts.
    fn part(&self, at: usize) -> (String, &str, usize) {
        let over = self
            .overrides
            .iter()
            .find(|o| at > self.text.len() && at <= o.padded.len());
        match over {
            Some(o) => (o.name.clone(), &o.line, o.padded.len() - o.line.len()),
            None => (self.file.clone(), &self.text, 0),
        }
    }

    /// An error at a span of the whole.
    pub(super) fn error(
        &self,
        span: Option<Range<usize>>,
        message: impl Into<String>,
        help: Option<String>,
    ) -> DeckError {
        let (file, text, start) = self.part(span.as_ref().map_or(0, |s| s.start));
        let span = span.map(|s| s.start.saturating_sub(start)..s.end.saturating_sub(start));
        DeckError::new(&file, text, span, message.into(), help)
    }

    /// What a reader should know of a place: `deck.toml:7: …`.
    pub(super) fn remark(&self, span: &Range<usize>, text: &str) -> String {
        let place = self.error(Some(span.clone()), "", None);
        let line = place.line.map_or(String::new(), |l| format!(":{l}"));
        format!("{}{line}: {text}", place.file)
    }

    /// What a user should know of keys by older names.
    pub(super) fn notes(&self, renames: &Renames) -> Vec<String> {
        let mut all: Vec<_> = renames.all().collect();
        all.sort_by_key(|(span, _)| span.start);
        let each = all.into_iter();
        each.map(|(span, text)| self.remark(span, text)).collect()
    }

    /// The text at a span.
    pub(super) fn slice(&self, span: &Range<usize>) -> &str {
        let (_, text, start) = self.part(span.start);
        text.get(span.start.saturating_sub(start)..span.end.saturating_sub(start))
            .unwrap_or("")
    }

    /// The key whose value begins at this place: what stands before the last `=`.
    pub(super) fn key(&self, at: usize) -> Option<&str> {
        let (_, text, start) = self.part(at);
        let before = text.get(..at.checked_sub(start)?)?.rsplit_once('=')?.0;
        let word = |c: char| !(c.is_alphanumeric() || c == '_' || c == '-');
        before.trim_end().rsplit(word).next()
    }

    /// Parses everything and lays the overrides over the deck, all by the names that keys have today.
    pub(super) fn tree(&self) -> Result<Tree<'_>, DeckError> {
        self.tree_and_renames().map(|(tree, _)| tree)
    }

    /// The same, and what was written by an older name.
    pub(super) fn tree_and_renames(&self) -> Result<(Tree<'_>, Renames), DeckError> {
        let mut renames = Renames::default();
        let mut today = |tree: &mut Tree| {
            renames.give(tree.get_mut()).map_err(|twice| {
                let (old, new) = (twice.old, twice.new);
                let message = format!("`{old}` is an older name of `{new}`, which is there, too");
                let help = format!("write {new} everywhere");
                self.error(Some(twice.span), message, Some(help))
            })
        };
        let mut tree =
            DeTable::parse(&self.text).map_err(|e| self.error(e.span(), e.message(), None))?;
        today(&mut tree)?;
        for over in &self.overrides {
            let help = || Some("an override is written KEY.PATH=VALUE".to_string());
            let mut top = DeTable::parse(&over.padded)
                .map_err(|e| self.error(e.span(), e.message(), help()))?;
            today(&mut top)?;
            let whole = |at: &Range<usize>| over.padded[at.clone()].starts_with('{');
            merge(tree.get_mut(), top.into_inner(), "the deck", &whole)
                .map_err(|lost| self.error(Some(lost.span), lost.message, Some(lost.help)))?;
        }
        Ok((tree, renames))
    }
}

/// What an override is for is not there.
struct Lost {
    span: Range<usize>,
    message: String,
    help: String,
}

/// Keys that are numbers are entries of a list.
fn number(key: &Spanned<DeString>) -> Option<usize> {
    AsRef::<str>::as_ref(key.get_ref()).parse().ok()
}

/// Is what stands here a value that takes the place of another (`{ … }`), and no key on the way to one?
type Whole<'f> = &'f dyn Fn(&Range<usize>) -> bool;

/// Lays `over` over a table that is called `name`; a table of numbered keys goes over the entries of a list.
fn merge<'a>(
    into: &mut DeTable<'a>,
    over: DeTable<'a>,
    name: &str,
    whole: Whole,
) -> Result<(), Lost> {
    for (key, value) in over {
        let called = key.get_ref().to_string();
        let on = !whole(&value.span());
        match (into.get_mut(&key).map(Spanned::get_mut), value.get_ref()) {
            (Some(old @ (DeValue::Table(_) | DeValue::Array(_))), DeValue::Table(_)) if on => {
                merge_value(old, value, &called, whole)?;
            }
            (None, DeValue::Table(over))
                if SEVERAL.contains(&&*called) && over.keys().any(|key| number(key).is_some()) =>
            {
                return Err(Lost {
                    span: key.span(),
                    message: format!("{name} has no `{called}`: there is no entry to change"),
                    help: format!("add [[{called}]] to the deck, or leave this out"),
                });
            }
            _ => {
                // the old key goes too: its place is in the deck
                into.remove(&key);
                into.insert(key, value);
            }
        }
    }
    Ok(())
}

fn merge_value<'a>(
    old: &mut DeValue<'a>,
    value: Spanned<DeValue<'a>>,
    name: &str,
    whole: Whole,
) -> Result<(), Lost> {
    match (old, value.into_inner()) {
        (DeValue::Table(table), DeValue::Table(over)) => merge(table, over, name, whole),
        (DeValue::Array(items), DeValue::Table(over)) => over
            .into_iter()
            .try_for_each(|(key, value)| merge_entry(items, key, value, name, whole)),
        (old, value) => {
            *old = value;
            Ok(())
        }
    }
}

/// Over the entry of a list that `key` numbers.
fn merge_entry<'a>(
    items: &mut DeArray<'a>,
    key: Spanned<DeString<'a>>,
    value: Spanned<DeValue<'a>>,
    name: &str,
    whole: Whole,
) -> Result<(), Lost> {
    let count = items.len();
    let lost = |message: String| {
        let range = match count {
            0 | 1 => "0 is the first and only one".to_string(),
            n => format!("they are numbered 0 to {}", n - 1),
        };
        Err(Lost {
            span: key.span(),
            message,
            help: format!("write the number of an entry, as in {name}.0: {range}"),
        })
    };
    let Some(n) = number(&key) else {
        return lost(format!(
            "`{name}` is a list, and {} is no entry of it",
            key.get_ref()
        ));
    };
    let Some(item) = items.get_mut(n) else {
        return lost(format!(
            "there is no entry {n} of `{name}`: it has {count} {}",
            if count == 1 { "entry" } else { "entries" }
        ));
    };
    match (item.get_ref(), value.get_ref()) {
        (DeValue::Table(_) | DeValue::Array(_), DeValue::Table(_)) if !whole(&value.span()) => {
            merge_value(item.get_mut(), value, name, whole)
        }
        _ => {
            *item = value;
            Ok(())
        }
    }
}

/// `key = value`, the value quoted if it is no TOML value by itself.
fn line(key: &str, value: &str) -> String {
    if DeValue::parse(value).is_ok() {
        format!("{key} = {value}")
    } else {
        format!("{key} = {}", toml::Value::from(value))
    }
}
