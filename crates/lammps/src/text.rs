//! Script text that remembers where it came from, and its division into lines and words.

use super::error::{Problem, Result, Span};

/// Text whose every byte knows its offset in the script (substituted text points at the `$`).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Text {
    text: String,
    origin: Vec<usize>,
}

impl Text {
    pub fn push(&mut self, c: char, origin: usize) {
        self.text.push(c);
        self.origin
            .extend(std::iter::repeat_n(origin, c.len_utf8()));
    }
    pub fn push_str(&mut self, s: &str, origin: usize) {
        self.text.push_str(s);
        self.origin.extend(std::iter::repeat_n(origin, s.len()));
    }
    /// Adds `other` after `joint`.
    pub fn append(&mut self, joint: &str, other: &Text) {
        let at = self.origin.last().map_or(0, |o| o + 1);
        self.push_str(joint, at);
        self.text.push_str(&other.text);
        self.origin.extend(&other.origin);
    }
    pub fn as_str(&self) -> &str {
        &self.text
    }
    /// Bytes `from..to` (character boundaries).
    pub fn slice(&self, from: usize, to: usize) -> Text {
        Text {
            text: self.text[from..to].to_string(),
            origin: self.origin[from..to].to_vec(),
        }
    }
    /// Where bytes `from..to` came from.
    pub fn span(&self, from: usize, to: usize) -> Span {
        let start = self
            .origin
            .get(from)
            .or(self.origin.last())
            .copied()
            .unwrap_or(0);
        let end = to
            .checked_sub(1)
            .and_then(|t| self.origin.get(t))
            .map_or(start, |e| e + 1);
        (start, end.max(start))
    }
    pub fn whole(&self) -> Span {
        self.span(0, self.text.len())
    }
}

/// One argument of a command.
#[derive(Debug, Clone, PartialEq)]
pub struct Word {
    pub text: Text,
    pub span: Span,
}

impl Word {
    pub fn as_str(&self) -> &str {
        self.text.as_str()
    }
}

/// Joins the physical lines of a script (`&` at the end of a line, open triple quotes).
pub fn logical_lines(source: &str) -> Vec<Text> {
    let mut lines = Vec::new();
    let mut current = Text::default();
    let mut open = false; // the line before asked for this one
    let mut offset = 0;
    for physical in source.split_inclusive('\n') {
        let body = physical.trim_end_matches(['\n', '\r']);
        let joined = body.trim_end().strip_suffix('&');
        for (k, c) in joined.unwrap_or(body).char_indices() {
            current.push(c, offset + k);
        }
        open = joined.is_some();
        if !open && current.as_str().matches("\"\"\"").count() % 2 == 1 {
            current.push('\n', offset + body.len());
            open = true;
        }
        if !open {
            lines.push(std::mem::take(&mut current));
        }
        offset += physical.len();
    }
    if open {
        lines.push(current);
    }
    lines
}

/// A scanner that knows whether it is inside quotes: `'…'`, `"…"` or `"""…"""`.
#[derive(Debug, Default)]
pub struct Quotes(Option<&'static str>);

impl Quotes {
    pub fn inside(&self) -> bool {
        self.0.is_some()
    }
    /// Looks at `rest`; the length of the quote mark that opens or closes here, or 0.
    pub fn mark(&mut self, rest: &str) -> usize {
        const MARKS: [&str; 3] = ["\"\"\"", "\"", "'"];
        match self.0 {
            Some(q) if rest.starts_with(q) => {
                self.0 = None;
                q.len()
            }
            Some(_) => 0,
            None => match MARKS.iter().find(|q| rest.starts_with(**q)) {
                Some(q) => {
                    self.0 = Some(q);
                    q.len()
                }
                None => 0,
            },
        }
    }
}

/// The text before a `#` outside quotes.
pub fn without_comment(line: &Text) -> Text {
    let text = line.as_str();
    let mut quotes = Quotes::default();
    let mut k = 0;
    while k < text.len() {
        let skip = quotes.mark(&text[k..]);
        if skip == 0 && !quotes.inside() && text[k..].starts_with('#') {
            return line.slice(0, k);
        }
        k += if skip > 0 {
            skip
        } else {
            text[k..].chars().next().map_or(1, char::len_utf8)
        };
    }
    line.clone()
}

/// Splits at white space; quotes around a word are taken off.
///
/// # Errors
/// A quote that is not closed, or closed in the middle of a word.
pub fn words(line: &Text) -> Result<Vec<Word>> {
    let text = line.as_str();
    let mut out = Vec::new();
    let mut k = 0;
    while let Some(skip) = text[k..].find(|c: char| !c.is_whitespace()) {
        k += skip;
        let rest = &text[k..];
        let quote = ["\"\"\"", "\"", "'"]
            .into_iter()
            .find(|q| rest.starts_with(q));
        if let Some(q) = quote {
            let Some(end) = rest[q.len()..].find(q) else {
                return Err(Problem::at(
                    line.span(k, text.len()),
                    format!("the quote {q} is not closed"),
                )
                .help(format!(
                    "close it with {q}; a text over several lines needs \"\"\" around it"
                )));
            };
            let (from, to) = (k + q.len(), k + q.len() + end);
            let after = to + q.len();
            if text[after..].starts_with(|c: char| !c.is_whitespace()) {
                return Err(Problem::at(
                    line.span(k, after + 1),
                    "a closing quote must be followed by a space",
                ));
            }
            out.push(Word {
                text: line.slice(from, to),
                span: line.span(k, after),
            });
            k = after;
        } else {
            let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
            out.push(Word {
                text: line.slice(k, k + end),
                span: line.span(k, k + end),
            });
            k += end;
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(source: &str) -> Vec<Vec<String>> {
        logical_lines(source)
            .iter()
            .map(|l| {
                words(&without_comment(l))
                    .unwrap()
                    .iter()
                    .map(|w| w.as_str().to_string())
                    .collect()
            })
            .collect()
    }

    #[test]
    fn lines_words_quotes_comments() {
        assert_eq!(split("units  si # a 'b\n"), [["units", "si"]]);
        assert_eq!(split("a b&\nc &\n d"), [["a", "bc", "d"]]);
        assert_eq!(
            split("print \"a # 'b\" 'c \"d'"),
            [["print", "a # 'b", "c \"d"]]
        );
        assert_eq!(
            split("print \"\"\"x\n\"y\" z\"\"\"\nrun 1"),
            [vec!["print", "x\n\"y\" z"], vec!["run", "1"]]
        );
        assert_eq!(split("\n \n# x"), [Vec::<&str>::new(), vec![], vec![]]);
    }

    #[test]
    fn spans_point_into_the_source() {
        let lines = logical_lines("units si\npair_style &\n  lj/cut");
        assert_eq!(words(&lines[1]).unwrap()[1].span, (24, 30));
    }

    #[test]
    fn open_quotes_are_errors() {
        assert!(words(&logical_lines("print 'a")[0]).is_err());
        assert!(words(&logical_lines("print 'a'b")[0]).is_err());
    }
}
