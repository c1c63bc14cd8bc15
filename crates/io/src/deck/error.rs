//! What is wrong in a deck, with the place.

use super::source::Source;
use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};
use std::fmt;
use std::ops::Range;

/// A mistake in a deck or in an override of it.
#[derive(Debug, Clone)]
pub struct DeckError {
    pub message: String,
    /// What to write instead.
    pub help: Option<String>,
    /// File name, or the override (`--set body.spacing`, `--spacing`).
    pub file: String,
    /// Line (1-based) in the file; `None` for an override or when no place is to blame.
    pub line: Option<usize>,
    span: Option<Range<usize>>,
    text: Box<NamedSource<String>>,
}

impl DeckError {
    /// A mistake at `span` (bytes) of `text`.
    pub(super) fn new(
        file: &str,
        text: &str,
        span: Option<Range<usize>>,
        message: String,
        help: Option<String>,
    ) -> Self {
        let span = span.map(|s| s.start.min(text.len())..s.end.min(text.len()));
        let is_override = file.starts_with("--");
        let line = span
            .as_ref()
            .filter(|_| !is_override)
            .map(|s| 1 + text[..s.start].matches('\n').count());
        let text = Box::new(NamedSource::new(file, text.to_string()).with_language("toml"));
        DeckError {
            message,
            help,
            file: file.to_string(),
            line,
            span,
            text,
        }
    }

    pub fn span(&self) -> Option<Range<usize>> {
        self.span.clone()
    }
}

impl fmt::Display for DeckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for DeckError {}

impl Diagnostic for DeckError {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.help
            .as_ref()
            .map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }
    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.span.as_ref().map(|_| &*self.text as &dyn SourceCode)
    }
    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.span.clone()?;
        Some(Box::new(std::iter::once(LabeledSpan::underline(span))))
    }
}

/// The candidate most like `name`, if one is like it at all.
pub(super) fn nearest<'a>(
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    candidates
        .into_iter()
        .map(|candidate| {
            (
                strsim::damerau_levenshtein(&name.to_lowercase(), &candidate.to_lowercase()),
                candidate,
            )
        })
        .filter(|(distance, candidate)| *distance <= 1 + candidate.len() / 4)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

const WHOLE: &str = "expected a whole number from 0";

/// serde's names of types in words of a deck.
const TYPES: [(&str, &str); 11] = [
    ("invalid value: ", "invalid type: "),
    ("expected u64", WHOLE),
    ("expected usize", WHOLE),
    ("expected u32", WHOLE),
    ("expected i32", "expected a whole number"),
    ("expected a sequence", "expected a list"),
    ("expected a boolean", "expected true or false"),
    ("type: map", "type: a table"),
    ("type: sequence", "type: a list"),
    ("type: floating point ", "type: the number "),
    ("type: integer ", "type: the number "),
];

/// Says what serde found wrong in words for people.
pub(super) fn from_toml(source: &Source, span: Option<Range<usize>>, message: &str) -> DeckError {
    let message = TYPES.iter().fold(message.to_string(), |m, (serde, ours)| {
        m.replace(serde, ours)
    });
    let mut message = &*message;
    // "expected struct Run" tells a user nothing
    let table;
    if let Some((before, _)) = message.split_once("expected struct ") {
        table = format!("{before}expected a table of keys, such as {{ key = value }}");
        message = &table;
    }
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let known = || quoted.iter().skip(1).copied();
    let (message, help) =
        if let Some(name) = message.strip_prefix("unknown field `").and(quoted.first()) {
            (
                format!("unknown key `{name}`"),
                Some(suggest(name, known())),
            )
        } else if let Some(name) = message
            .strip_prefix("unknown variant `")
            .and(quoted.first())
        {
            (
                format!("`{name}` is not known here"),
                Some(suggest(name, known())),
            )
        } else if let Some(name) = message.strip_prefix("missing field `").and(quoted.first()) {
            (format!("the key `{name}` is missing"), None)
        } else if let Some(rest) = message.strip_prefix("invalid type: ") {
            match rest.split_once(", expected ") {
                Some((found, expected)) => {
                    let written = span.as_ref().map_or("", |s| source.slice(s));
                    let help = whole_number(written)
                        .filter(|_| expected.starts_with("a whole number"))
                        .map(|n| format!("write {n}"));
                    (format!("expected {expected}, found {found}"), help)
                }
                None => (message.to_string(), None),
            }
        } else if message.starts_with("wanted exactly 1 element") {
            (
                "expected a table with exactly one entry, which says the kind".into(),
                None,
            )
        } else {
            (message.trim().replace('\n', ", "), None)
        };
    source.error(span, message, help)
}

/// `1e4` and `100.0` without exponent and point.
fn whole_number(written: &str) -> Option<u64> {
    let value: f64 = written.trim().trim_matches('"').parse().ok()?;
    (0.0..1e15).contains(&value).then(|| value.round() as u64)
}

fn suggest<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    match nearest(name, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("known here: {}", known.collect::<Vec<_>>().join(", ")),
    }
}
