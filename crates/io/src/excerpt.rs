//! What a terminal is shown of texts that somebody else wrote: characters that would steer it stand as `\u{1b}`, of a long line there is
//! what lies about the place, and long quotations are cut.

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use std::borrow::Cow;
use std::ops::Range;

/// Characters of a line that are shown.
const WIDE: usize = 160;
/// Of them before the place.
const BEFORE: usize = 60;
/// Lines of a place; of a longer one the first is shown.
const LINES: usize = 8;
/// Characters of a quotation in a message, and those kept of its end.
const QUOTED: usize = 100;
const TAIL: usize = 20;
/// Characters of a line of a message, and lines of a message.
const MESSAGE: usize = 1500;
const MANY: usize = 50;
/// Characters of the name of a text.
const NAME: usize = 300;

/// Does a character steer a terminal, or turn the order in which letters are shown?
pub fn steers(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns
}

fn shown(out: &mut String, c: char, kept: &[char]) {
    match steers(c) && !kept.contains(&c) {
        true => out.extend(c.escape_unicode()),
        false => out.push(c),
    }
}

/// A text whose lines and tabs are its own and nothing else steers a terminal.
pub fn plain(text: &str) -> Cow<'_, str> {
    let kept = ['\n', '\t'];
    if !text.chars().any(|c| steers(c) && !kept.contains(&c)) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    text.chars().for_each(|c| shown(&mut out, c, &kept));
    Cow::Owned(out)
}

/// The same of a name or a title, which has one line.
pub fn one_line(text: &str) -> Cow<'_, str> {
    match text.contains(['\n', '\t']) {
        true => Cow::Owned(text.chars().fold(String::new(), |mut out, c| {
            shown(&mut out, c, &[]);
            out
        })),
        false => plain(text),
    }
}

/// A message, plain; what it quotes at length is cut.
pub fn brief(message: &str) -> String {
    let plain = plain(message);
    let mut lines: Vec<Cow<str>> = plain.split('\n').take(MANY + 1).map(short).collect();
    if lines.len() > MANY {
        lines[MANY] = "…".into();
    }
    lines.join("\n")
}

fn short(line: &str) -> Cow<'_, str> {
    if line.len() <= QUOTED {
        return Cow::Borrowed(line);
    }
    let parts: Vec<&str> = line.split('`').collect();
    // what stands between two of them is a quotation
    let last = parts.len() - 1;
    let each = parts.iter().enumerate().map(|(n, part)| {
        let quoted = n % 2 == 1 && n < last;
        match quoted && part.chars().count() > QUOTED {
            true => cut(part, QUOTED),
            false => part.to_string(),
        }
    });
    let mut line = each.collect::<Vec<_>>().join("`");
    if let Some((end, _)) = line.char_indices().nth(MESSAGE) {
        line.truncate(end);
        line.push('…');
    }
    Cow::Owned(line)
}

/// Beginning and end of a text of more characters.
fn cut(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_string();
    }
    let tail: Vec<char> = text.chars().rev().take(TAIL).collect();
    let head = text.chars().take(most - TAIL);
    head.chain(['…']).chain(tail.into_iter().rev()).collect()
}

/// A place of a text and the lines about it, for `miette`.
#[derive(Debug, Clone)]
pub struct Excerpt {
    name: String,
    text: String,
    /// Lines of the whole text that are left out before it.
    before: usize,
    /// Characters of the line before the place.
    column: usize,
    span: Range<usize>,
}

impl Excerpt {
    /// The place `span` (bytes) of `text`, which is called `name`.
    pub fn new(name: &str, text: &str, span: Range<usize>) -> Excerpt {
        let start = boundary(text, span.start);
        let end = boundary(text, span.end.max(start));
        // the end of a line is no part of a place
        let end = start + text[start..end].trim_end_matches(['\r', '\n']).len();
        let first = text[..start].rfind('\n').map_or(0, |n| n + 1);
        let end = match text[start..end].matches('\n').count() < LINES {
            true => end,
            false => text[start..].find('\n').map_or(end, |n| start + n),
        };
        let mut out = Excerpt {
            name: cut(&one_line(name), NAME),
            text: String::new(),
            before: text[..first].matches('\n').count(),
            column: text[first..start].chars().count(),
            span: 0..0,
        };
        if let Some(before) = text[..first].strip_suffix('\n') {
            out.before -= 1;
            out.line(before.rsplit('\n').next().unwrap_or(""), 0..0);
        }
        let mut at = first;
        for line in text[first..].split('\n') {
            if at > end && at == text.len() {
                break;
            }
            let (low, high) = (start.max(at) - at, end.clamp(at, at + line.len()) - at);
            let place = out.line(line, low.min(high)..high);
            if at <= start {
                out.span.start = place.start;
            }
            if at > end {
                break;
            }
            out.span.end = place.end;
            at += line.len() + 1;
        }
        out
    }

    /// A whole line, of which only its number (from 1) is known.
    pub fn of_line(name: &str, number: usize, line: &str) -> Excerpt {
        let line = line.trim_end_matches(['\r', '\n']);
        Excerpt {
            before: number.saturating_sub(1),
            ..Excerpt::new(name, line, 0..line.len())
        }
    }

    /// Where the place is in what is shown.
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Adds what is shown of a line about `at`; where that stands now.
    fn line(&mut self, line: &str, at: Range<usize>) -> Range<usize> {
        let line = line.strip_suffix('\r').unwrap_or(line);
        let at = at.start.min(line.len())..at.end.min(line.len());
        let all = line.chars().count();
        let before = line[..at.start].chars().count();
        let from = match all > WIDE {
            true => before.saturating_sub(BEFORE).min(all - WIDE),
            false => 0,
        };
        if from > 0 {
            self.text.push('…');
        }
        let (mut low, mut high) = (None, None);
        for (n, c) in line.char_indices().skip(from).take(WIDE) {
            let here = self.text.len();
            if n >= at.start {
                low.get_or_insert(here);
            }
            if n >= at.end {
                high.get_or_insert(here);
            }
            shown(&mut self.text, c, &['\t']);
        }
        let end = self.text.len();
        if from + WIDE < all {
            self.text.push('…');
        }
        self.text.push('\n');
        low.unwrap_or(end)..high.unwrap_or(end)
    }
}

/// The character of `text` that `at` lies in begins here.
fn boundary(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let inner = self.text.read_span(span, before, after)?;
        // without context it is asked where the place is
        let column = match before {
            0 => self.column,
            _ => inner.column(),
        };
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            inner.data(),
            *inner.span(),
            self.before + inner.line(),
            column,
            inner.line_count(),
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The excerpt, and what its place marks.
    fn of(text: &str, part: &str) -> (String, String) {
        let start = text.find(part).unwrap();
        let excerpt = Excerpt::new("d.toml", text, start..start + part.len());
        let marked = excerpt.text[excerpt.span()].to_string();
        (excerpt.text, marked)
    }

    #[test]
    fn short_lines_stand_as_they_are_with_their_neighbours() {
        let (text, marked) = of("a\nb\r\nc here d\nd\ne\n", "here");
        assert_eq!(text, "b\nc here d\nd\n");
        assert_eq!(marked, "here");
        let (text, marked) = of("x = [\n 1,\n 2\n]\nlast", "[\n 1,\n 2\n]");
        assert_eq!(text, "x = [\n 1,\n 2\n]\nlast\n");
        assert_eq!(marked, "[\n 1,\n 2\n]");
    }

    #[test]
    fn a_long_line_is_cut_about_its_place() {
        let wide = format!(
            "first\n{}here{}\nlast",
            "ä ".repeat(40_000),
            "z".repeat(900)
        );
        let (text, marked) = of(&wide, "here");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!((lines[0], lines[2]), ("first", "last"));
        assert_eq!(lines[1].chars().count(), WIDE + 2);
        assert!(lines[1].starts_with('…') && lines[1].ends_with("z…"));
        assert_eq!(marked, "here");
        // a place that is long itself ends where the line does
        let (text, marked) = of(&wide, &wide[6..]);
        assert!(text.lines().all(|l| l.chars().count() <= WIDE + 2));
        assert!(marked.starts_with("ä ä"));
        // the column is that of the file
        let at = wide.find("here").unwrap();
        let excerpt = Excerpt::new("d.toml", &wide, at..at + 4);
        let span = SourceSpan::from((excerpt.span.start, 4));
        let found = excerpt.read_span(&span, 0, 0).unwrap();
        assert_eq!((found.line(), found.column()), (1, 80_000));
    }

    #[test]
    fn a_place_of_many_lines_is_shown_by_its_first() {
        let many = format!("t = [\n{}]\n", "1,\n".repeat(5000));
        let (text, marked) = of(&many, &many[4..]);
        assert_eq!(text, "t = [\n1,\n");
        assert_eq!(marked, "[");
    }

    #[test]
    fn places_at_the_ends_are_shown() {
        for text in ["", "a", "a\n", "ä\r\n"] {
            for start in 0..=text.len() {
                let excerpt = Excerpt::new("d", text, start..text.len() + 3);
                let span = excerpt.span();
                assert!(excerpt.text.get(span.clone()).is_some(), "{text:?} {start}");
                let place = SourceSpan::from((span.start, span.len()));
                assert!(excerpt.read_span(&place, 1, 1).is_ok(), "{text:?} {start}");
            }
        }
        let line = Excerpt::of_line("d", 7, "abc\r\n");
        let found = line.read_span(&(0, 3).into(), 1, 1).unwrap();
        assert_eq!((found.line(), &line.text[line.span()]), (6, "abc"));
    }

    #[test]
    fn what_steers_a_terminal_is_written_out() {
        assert_eq!(plain("one\n\ttwo ä→"), "one\n\ttwo ä→");
        assert_eq!(
            plain("\u{1b}]0;x\u{7}\r\u{9b}\u{7f}\u{202e}"),
            "\\u{1b}]0;x\\u{7}\\u{d}\\u{9b}\\u{7f}\\u{202e}"
        );
        assert_eq!(one_line("a\nwarning: b"), "a\\u{a}warning: b");
        let (text, marked) = of("a\u{1b}[31m = 1 # \u{8}\r\n", "\u{1b}[31m");
        assert_eq!(text, "a\\u{1b}[31m = 1 # \\u{8}\n");
        assert_eq!(marked, "\\u{1b}[31m");
    }

    #[test]
    fn long_quotations_are_cut() {
        let long = format!(
            "expected x, found `1e-9{}2`, {}",
            "1".repeat(9000),
            "y".repeat(300)
        );
        let told = brief(&long);
        assert!(told.starts_with("expected x, found `1e-911") && told.contains("…1111"));
        assert!(told.contains("2`, yyy") && told.ends_with("yy"));
        // but e, -, 9 and 2
        assert_eq!(told.chars().filter(|c| *c == '1').count(), QUOTED - 4);
        let sentence = "no quotation ".repeat(80);
        assert_eq!(brief(&sentence), sentence);
        assert_eq!(brief(&"x".repeat(5000)).chars().count(), MESSAGE + 1);
        // what stands for a character that steers is longer than it
        assert_eq!(brief(&"\u{0}".repeat(5000)).chars().count(), MESSAGE + 1);
        assert_eq!(brief(&"a\n".repeat(5000)).lines().count(), MANY + 1);
        assert_eq!(brief("one\ntwo"), "one\ntwo");
        let named = Excerpt::new(&"n".repeat(70_000), "text", 0..4);
        assert_eq!(named.name.chars().count(), NAME + 1);
    }
}
