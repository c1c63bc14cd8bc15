//! A mistake in an expression.

use std::fmt;
use std::ops::Range;

/// Most numbers an expression may have waiting at once while it is evaluated.
pub(crate) const STACK: usize = 32;

/// Why a text is not an expression.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpressionError {
    pub message: String,
    /// Bytes of the source that are to blame; may be empty at its end.
    pub span: Range<usize>,
    pub help: Option<String>,
    /// The text that was parsed.
    pub source: String,
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let start = self.source[..self.span.start]
            .rfind('\n')
            .map_or(0, |i| i + 1);
        let end = self.source[start..]
            .find('\n')
            .map_or(self.source.len(), |i| start + i);
        let before = self.source[start..self.span.start].chars().count();
        let marked = self.source[self.span.start..self.span.end.min(end).max(self.span.start)]
            .chars()
            .count();
        writeln!(f, "{}", self.message)?;
        writeln!(f, "  {}", &self.source[start..end])?;
        write!(f, "  {}{}", " ".repeat(before), "^".repeat(marked.max(1)))?;
        match &self.help {
            Some(help) => write!(f, "\nhelp: {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for ExpressionError {}
