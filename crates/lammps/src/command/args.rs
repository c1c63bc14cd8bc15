//! Arguments of a command.

use crate::error::{Problem, Result, suggestion};
use crate::fix::Input;
use crate::text::Word;
use crate::variable::is_name;

/// The words after a command's name, taken one by one.
pub struct Args<'a> {
    pub command: &'a Word,
    words: &'a [Word],
    at: usize,
}

impl<'a> Args<'a> {
    pub fn new(command: &'a Word, words: &'a [Word]) -> Self {
        Args {
            command,
            words,
            at: 0,
        }
    }

    pub fn left(&self) -> usize {
        self.words.len() - self.at
    }

    pub fn peek(&self) -> Option<&'a str> {
        self.words.get(self.at).map(Word::as_str)
    }

    /// The third word from here: the style of `fix ID GROUP STYLE`.
    pub fn third(&self) -> Option<&'a str> {
        self.words.get(self.at + 2).map(Word::as_str)
    }

    /// Takes the next word if it is this one.
    pub fn eat(&mut self, word: &str) -> bool {
        let found = self.peek() == Some(word);
        self.at += usize::from(found);
        found
    }

    /// Puts the last word back.
    pub fn back(&mut self) {
        self.at = self.at.saturating_sub(1);
    }

    /// The next word if there is one.
    pub fn optional(&mut self) -> Option<&'a Word> {
        let word = self.words.get(self.at)?;
        self.at += 1;
        Some(word)
    }

    /// The next word.
    ///
    /// # Errors
    /// There is none; `what` was expected.
    pub fn next(&mut self, what: &str) -> Result<&'a Word> {
        match self.optional() {
            Some(word) => Ok(word),
            None => {
                let end = self.words.last().unwrap_or(self.command).span.1;
                Err(Problem::at(
                    (end, end),
                    format!("`{}` ends here, expected {what}", self.command.as_str()),
                ))
            }
        }
    }

    /// All words that are left as one, joined with blanks.
    ///
    /// # Errors
    /// There is none; `what` was expected.
    pub fn rest(&mut self, what: &str) -> Result<Word> {
        let mut joined = self.next(what)?.clone();
        while let Some(word) = self.optional() {
            joined.text.append(" ", &word.text);
            joined.span.1 = word.span.1;
        }
        Ok(joined)
    }

    /// A finite number.
    ///
    /// # Errors
    /// It is missing or no number.
    pub fn number(&mut self, what: &str) -> Result<f64> {
        let word = self.next(what)?;
        match word.as_str().parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => Err(self.not(word, &format!("{what} (a number)"))),
        }
    }

    /// A positive number.
    ///
    /// # Errors
    /// It is missing, no number or not positive.
    pub fn positive(&mut self, what: &str) -> Result<f64> {
        let x = self.number(what)?;
        if x > 0.0 {
            return Ok(x);
        }
        self.back();
        let word = self.next(what)?;
        Err(Problem::at(
            word.span,
            format!("{what} must be positive, found {x}"),
        ))
    }

    /// A whole number.
    ///
    /// # Errors
    /// It is missing or no whole number.
    pub fn integer(&mut self, what: &str) -> Result<i64> {
        let word = self.next(what)?;
        word.as_str()
            .parse()
            .map_err(|_| self.not(word, &format!("{what} (a whole number)")))
    }

    /// A count from `least` on.
    ///
    /// # Errors
    /// It is missing, no whole number or too small.
    pub fn count(&mut self, what: &str, least: u64) -> Result<u64> {
        let word = self.next(what)?;
        match word.as_str().parse::<u64>() {
            Ok(n) if n >= least => Ok(n),
            _ => Err(self.not(word, &format!("{what} (a whole number from {least})"))),
        }
    }

    /// A number or `v_name`.
    ///
    /// # Errors
    /// It is missing or neither.
    pub fn input(&mut self, what: &str) -> Result<Input> {
        if let Some(name) = self
            .peek()
            .and_then(|w| w.strip_prefix("v_"))
            .filter(|n| is_name(n))
        {
            self.at += 1;
            return Ok(Input::Variable(name.to_string()));
        }
        self.number(what)
            .map(Input::Number)
            .map_err(|p| p.help("or a variable: v_name"))
    }

    /// `yes` or `no` (`on`, `off`, `true`, `false`).
    ///
    /// # Errors
    /// It is missing or neither.
    pub fn yes(&mut self, what: &str) -> Result<bool> {
        let word = self.next(what)?;
        match word.as_str() {
            "yes" | "on" | "true" => Ok(true),
            "no" | "off" | "false" => Ok(false),
            _ => Err(self.not(word, &format!("{what} (yes or no)"))),
        }
    }

    /// A seed of random numbers.
    ///
    /// # Errors
    /// It is missing or no seed.
    pub fn seed(&mut self) -> Result<i64> {
        let word = self.next("a seed")?;
        let seed = word.as_str().parse::<i64>().ok();
        seed.filter(|s| (1..=2_147_483_646).contains(s))
            .ok_or_else(|| self.not(word, "a seed (a whole number from 1 to 2147483646)"))
    }

    /// `x`, `y` or `z`.
    ///
    /// # Errors
    /// It is missing or none of them.
    pub fn axis(&mut self) -> Result<usize> {
        let word = self.next("the axis x, y or z")?;
        let found = ["x", "y", "z"].iter().position(|a| *a == word.as_str());
        found.ok_or_else(|| self.unknown(word, "the axis", ["x", "y", "z"]))
    }

    /// `box` (false) or `lattice` (true).
    ///
    /// # Errors
    /// It is missing or neither.
    pub fn units(&mut self) -> Result<bool> {
        let word = self.next("`box` or `lattice`")?;
        match word.as_str() {
            "lattice" => Ok(true),
            "box" => Ok(false),
            _ => Err(self.not(word, "`box` or `lattice`")),
        }
    }

    fn not(&self, word: &Word, what: &str) -> Box<Problem> {
        Problem::at(
            word.span,
            format!(
                "`{}`: expected {what}, found `{}`",
                self.command.as_str(),
                word.as_str()
            ),
        )
    }

    /// An error for a word that is none of `known`.
    pub fn unknown<'k>(
        &self,
        word: &Word,
        what: &str,
        known: impl IntoIterator<Item = &'k str>,
    ) -> Box<Problem> {
        let text = word.as_str();
        Problem::at(
            word.span,
            format!(
                "`{}`: {what} `{text}` is not supported",
                self.command.as_str()
            ),
        )
        .help(suggestion(text, known))
    }

    /// Nothing may be left.
    ///
    /// # Errors
    /// Something is left.
    pub fn finish(&self) -> Result<()> {
        match self.words.get(self.at) {
            None => Ok(()),
            Some(word) => Err(Problem::at(
                word.span,
                format!(
                    "`{}`: unexpected argument `{}`",
                    self.command.as_str(),
                    word.as_str()
                ),
            )
            .help("take it away; every option that is supported is understood before this point")),
        }
    }
}
