//! What is wrong in a deck, with the place.

use crate::excerpt::Excerpt;
use miette::{Diagnostic, LabeledSpan, SourceCode};
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
    excerpt: Box<Excerpt>,
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
        let excerpt = Box::new(Excerpt::new(file, text, span.clone().unwrap_or(0..0)));
        DeckError {
            message,
            help,
            file: file.to_string(),
            line,
            span,
            excerpt,
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
        { self.span.as_ref() }.map(|_| &*self.excerpt as &dyn SourceCode)
    }
    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.span.as_ref()?;
        let place = LabeledSpan::underline(self.excerpt.span());
        Some(Box::new(std::iter::once(place)))
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
