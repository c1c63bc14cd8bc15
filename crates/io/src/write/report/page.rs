//! The page: its parts in one file, texts as HTML.

use std::fmt::Write as _;
use std::io;

use base64::display::Base64Display;
use base64::engine::general_purpose::STANDARD;

const PAGE: &str = include_str!("../../../assets/report/page.html");
const STYLE: &str = include_str!("../../../assets/report/style.css");
const SCRIPTS: [&str; 8] = [
    include_str!("../../../assets/report/numbers.js"),
    include_str!("../../../assets/report/data.js"),
    include_str!("../../../assets/report/colours.js"),
    include_str!("../../../assets/report/render.js"),
    include_str!("../../../assets/report/bodies.js"),
    include_str!("../../../assets/report/plots.js"),
    include_str!("../../../assets/report/viewer.js"),
    include_str!("../../../assets/report/page.js"),
];

/// What a page is made of.
pub struct Texts<'a> {
    pub title: &'a str,
    pub understood: &'a str,
    pub deck: &'a str,
    /// JSON.
    pub meta: &'a str,
}

/// Bytes of everything but blocks.
pub fn length(texts: &Texts) -> usize {
    let mut counted = Counted::new(io::sink());
    // nothing can go wrong there
    let _ = page(&mut counted, texts, &[]);
    counted.bytes
}

/// Writes the whole file; blocks become base 64.
///
/// # Errors
/// The operating system's.
pub fn page(mut out: impl io::Write, texts: &Texts, blocks: &[Vec<u8>]) -> io::Result<()> {
    let mut rest = PAGE;
    while let Some((before, after)) = rest.split_once("{{") {
        out.write_all(before.as_bytes())?;
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        match name {
            "title" => write!(out, "{}", escaped(texts.title))?,
            "style" => write!(out, "{STYLE}")?,
            "understood" => write!(out, "{}", terms(texts.understood, texts.title))?,
            "deck" => write!(out, "{}", deck(texts.deck))?,
            // a string may hold what ends a script
            "meta" => write!(out, "{}", texts.meta.replace('<', "\\u003c"))?,
            "blocks" => {
                for (n, block) in blocks.iter().enumerate() {
                    let block = Base64Display::new(block, &STANDARD);
                    writeln!(
                        out,
                        "<script type=\"text/plain\" id=\"b{n}\">{block}</script>"
                    )?;
                }
            }
            _ => SCRIPTS.iter().try_for_each(|s| write!(out, "{s}"))?,
        }
        rest = after;
    }
    out.write_all(rest.as_bytes())
}

/// Counts what is written.
pub struct Counted<W> {
    out: W,
    pub bytes: usize,
}

impl<W: io::Write> Counted<W> {
    pub fn new(out: W) -> Counted<W> {
        Counted { out, bytes: 0 }
    }
}

impl<W: io::Write> io::Write for Counted<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.bytes += written;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// Lines of a word, blanks and a text; a line that begins with blanks goes on.
fn terms(text: &str, title: &str) -> String {
    let mut all: Vec<(String, String)> = vec![];
    for line in text.lines().filter(|l| !l.is_empty() && *l != title) {
        match (line.split_once("  "), all.last_mut()) {
            (Some(("", more)), Some((_, last))) => *last += &format!("\n{}", more.trim()),
            (Some((word, rest)), _) => all.push((word.into(), rest.trim().into())),
            (None, _) => all.push((String::new(), line.into())),
        }
    }
    if all.is_empty() {
        return "<p class=\"quiet\">The folder does not say: it is of an older version.</p>".into();
    }
    let mut out = String::from("<dl class=\"terms\">\n");
    let mut last = String::new();
    for (word, text) in all {
        let text = escaped(&text).replace('\n', "<br>");
        if word == last && !word.is_empty() {
            let _ = writeln!(out, "<dd>{text}</dd>");
        } else {
            let word = if word.is_empty() {
                "and".into()
            } else {
                word.clone()
            };
            let _ = writeln!(out, "<dt>{}</dt><dd>{text}</dd>", escaped(&word));
        }
        last = word;
    }
    out + "</dl>"
}

/// TOML with its parts marked.
fn deck(text: &str) -> String {
    if text.is_empty() {
        return "<p class=\"quiet\">The folder does not have it: it is of an older version.</p>"
            .into();
    }
    let mut out = String::from(
        "<div role=\"region\" aria-label=\"Text of the deck\" tabindex=\"0\"><pre><code>",
    );
    for line in text.lines() {
        let trimmed = line.trim_start();
        if trimmed.starts_with('[') && !trimmed.contains('=') {
            let (head, remark) = split(line, '#');
            let _ = write!(out, "<span class=\"h\">{}</span>", escaped(head));
            out += &marked(remark);
        } else if let Some((key, value)) = line
            .split_once('=')
            .filter(|(k, _)| !k.contains(['"', '#', '\'', '{', '[']))
        {
            let _ = write!(out, "<span class=\"k\">{}</span>=", escaped(key));
            out += &marked(value);
        } else {
            out += &marked(line);
        }
        out += "\n";
    }
    out + "</code></pre></div>"
}

fn split(line: &str, at: char) -> (&str, &str) {
    line.split_at(line.find(at).unwrap_or(line.len()))
}

/// Strings and remarks of a line.
fn marked(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some(at) = rest.find(['"', '\'', '#']) {
        out += &escaped(&rest[..at]);
        let mark = rest[at..].chars().next().unwrap_or('#');
        if mark == '#' {
            let _ = write!(out, "<span class=\"r\">{}</span>", escaped(&rest[at..]));
            return out;
        }
        let end = rest[at + 1..].find(mark).map_or(rest.len(), |e| at + e + 2);
        let _ = write!(out, "<span class=\"s\">{}</span>", escaped(&rest[at..end]));
        rest = &rest[end..];
    }
    out + &escaped(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_cannot_leave_their_places() {
        let texts = Texts {
            title: "<b>{{deck}}</b>",
            understood: "body      </dl><script>",
            deck: "a = \"</code>\" # <i>",
            meta: "{\"x\": \"</script>\"}",
        };
        let mut page = vec![];
        super::page(&mut page, &texts, &[vec![0; 3]]).unwrap();
        assert_eq!(
            page.len(),
            length(&texts) + "<script type=\"text/plain\" id=\"b0\">AAAA</script>\n".len()
        );
        let page = String::from_utf8(page).unwrap();
        assert!(page.contains("<title>&lt;b&gt;{{deck}}&lt;/b&gt;</title>"));
        assert!(page.contains("<dt>body</dt><dd>&lt;/dl&gt;&lt;script&gt;</dd>"));
        assert!(page.contains("<span class=\"s\">&quot;&lt;/code&gt;&quot;</span> <span class=\"r\"># &lt;i&gt;</span>"));
        assert!(page.contains("\\u003c/script>"));
        assert!(page.contains("id=\"b0\">AAAA</script>"));
    }

    #[test]
    fn lines_become_terms() {
        let text = "Title\nbody       2 bodies\n           a: one\nmaterial   x\nmaterial   y";
        let html = terms(text, "Title");
        assert!(
            html.contains("<dt>body</dt><dd>2 bodies<br>a: one</dd>"),
            "{html}"
        );
        assert!(
            html.contains("<dt>material</dt><dd>x</dd>\n<dd>y</dd>"),
            "{html}"
        );
        assert!(!html.contains("Title"));
    }
}
