//! Times and expressions of both programs.

use peridyne::expression::Expression;

/// How the time of the other deck follows from ours: `start + scale t`.
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    pub start: f64,
    pub scale: f64,
}

impl Clock {
    /// An expression with our t in it.
    ///
    /// # Errors
    /// It is none, with the reason.
    pub fn expression(self, given: &str) -> Result<String, String> {
        let text = plain(given);
        if text.contains(['{', ';']) {
            return Err("a program is no expression: write it as a ? b : c".into());
        }
        // PeriLab's time since the start
        let text = put(&text, "st", &format!("(t - {:?})", self.start));
        Expression::parse(&text, &[]).map_err(|e| format!("no expression: {}", e.message))?;
        if self.start == 0.0 && self.scale == 1.0 {
            return Ok(text);
        }
        let time = match (self.start == 0.0, self.scale == 1.0) {
            (true, _) => format!("({:?}*t)", self.scale),
            (_, true) => format!("({:?} + t)", self.start),
            _ => format!("({:?} + {:?}*t)", self.start, self.scale),
        };
        Ok(put(&text, "t", &time))
    }

    /// The same at a time of the other program, as an expression of the place.
    ///
    /// # Errors
    /// As [`Self::expression`].
    pub fn at(self, given: &str, time: f64) -> Result<String, String> {
        let there = Clock {
            start: 0.0,
            scale: 1.0,
        };
        Ok(put(&there.expression(given)?, "t", &format!("({time:?})")))
    }
}

/// Without what the other programs write around and into an expression: `value = …;`, and dots before operators of Julia.
fn plain(given: &str) -> String {
    let text = given.trim().trim_end_matches(';').trim();
    let text = match text.strip_prefix("value") {
        Some(rest) if rest.trim_start().starts_with('=') => {
            rest.trim_start().trim_start_matches('=').trim()
        }
        _ => text,
    };
    let mut text = text.to_string();
    for operator in ["*", "/", "+", "-", "^"] {
        text = text.replace(&format!(".{operator}"), operator);
    }
    text
}

/// Places of a word that stands alone.
fn words<'a>(text: &'a str, word: &'a str) -> impl Iterator<Item = usize> + 'a {
    let letter = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    text.match_indices(word)
        .map(|(at, _)| at)
        .filter(move |at| {
            let before = text[..*at].chars().next_back();
            let after = text[at + word.len()..].chars().next();
            !before.is_some_and(letter) && !after.is_some_and(letter)
        })
}

/// `by` in place of a word that stands alone.
fn put(text: &str, word: &str, by: &str) -> String {
    let (mut out, mut from) = (String::new(), 0);
    for at in words(text, word) {
        out += &text[from..at];
        out += by;
        from = at + word.len();
    }
    out + &text[from..]
}
