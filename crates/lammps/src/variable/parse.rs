//! Text to [`Expr`].

use super::ast::{ATOM_VALUES, Expr, Op, Prefix};
use super::functions;
use crate::error::suggestion;
use crate::thermo::keyword;

/// A formula that cannot be read: what and at which byte.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaError {
    pub at: usize,
    pub message: String,
    pub help: Option<String>,
}

const DEEPEST: usize = 200;

/// Parses a whole formula.
///
/// # Errors
/// The first mistake.
pub fn parse(text: &str) -> Result<Expr, FormulaError> {
    let mut parser = Parser {
        text,
        at: 0,
        depth: 0,
    };
    let expr = parser.binary(1)?;
    match parser.peek() {
        None => Ok(expr),
        Some(c) => Err(parser.fail(format!("unexpected `{c}` in the formula"))),
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

type Parsed<T> = Result<T, FormulaError>;

impl<'a> Parser<'a> {
    fn fail(&self, message: impl Into<String>) -> FormulaError {
        self.fail_at(self.at, message)
    }

    fn fail_at(&self, at: usize, message: impl Into<String>) -> FormulaError {
        FormulaError {
            at,
            message: message.into(),
            help: None,
        }
    }

    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn eat(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        if found {
            self.at += c.len_utf8();
        }
        found
    }

    fn expect(&mut self, c: char) -> Parsed<()> {
        if self.eat(c) {
            return Ok(());
        }
        Err(match self.peek() {
            Some(found) => self.fail(format!("expected `{c}`, found `{found}`")),
            None => self.fail(format!("the formula ends where `{c}` is expected")),
        })
    }

    fn operator(&mut self) -> Option<(&'static str, Op)> {
        self.peek()?;
        let rest = &self.text[self.at..];
        Op::SPELLING.into_iter().find(|(s, _)| rest.starts_with(s))
    }

    /// Operators of at least this precedence.
    fn binary(&mut self, least: u8) -> Parsed<Expr> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.fail("the formula is nested too deeply"));
        }
        let left = self.prefix()?;
        let mut chain = Vec::new();
        while let Some((spelling, op)) = self.operator() {
            if op.precedence() < least {
                break;
            }
            self.at += spelling.len();
            chain.push((op, self.binary(op.precedence() + 1)?));
        }
        self.depth -= 1;
        Ok(if chain.is_empty() {
            left
        } else {
            Expr::Chain(Box::new(left), chain)
        })
    }

    fn prefix(&mut self) -> Parsed<Expr> {
        let prefix = match self.peek() {
            Some('-') => Prefix::Minus,
            Some('!') => Prefix::Not,
            _ => return self.primary(),
        };
        self.at += 1;
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.fail("the formula is nested too deeply"));
        }
        let inner = self.prefix()?;
        self.depth -= 1;
        Ok(Expr::Prefix(prefix, Box::new(inner)))
    }

    fn primary(&mut self) -> Parsed<Expr> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                let inner = self.binary(1)?;
                self.expect(')')?;
                Ok(inner)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_ascii_alphabetic() => self.named(),
            Some('$') => Err(FormulaError {
                help: Some(
                    "inside quotes write v_name, or take the quotes away so that $ is substituted"
                        .into(),
                ),
                ..self.fail("`$` is not substituted inside quotes")
            }),
            Some(c) => Err(self.fail(format!("expected a number, a name or `(`, found `{c}`"))),
            None => Err(self.fail("the formula ends where a number, a name or `(` is expected")),
        }
    }

    fn number(&mut self) -> Parsed<Expr> {
        let bytes = self.text.as_bytes();
        let start = self.at;
        let mut end = start;
        while bytes
            .get(end)
            .is_some_and(|b| b.is_ascii_digit() || *b == b'.')
        {
            end += 1;
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            if bytes.get(end + 1 + sign).is_some_and(u8::is_ascii_digit) {
                end += 1 + sign;
                while bytes.get(end).is_some_and(u8::is_ascii_digit) {
                    end += 1;
                }
            }
        }
        let text = &self.text[start..end];
        self.at = end;
        match text.parse() {
            Ok(x) => Ok(Expr::Number(x)),
            Err(_) => Err(self.fail_at(start, format!("`{text}` is not a number"))),
        }
    }

    fn word(&mut self) -> &'a str {
        let rest = &self.text[self.at..];
        let end = rest
            .find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
            .unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    fn bracketed(&mut self) -> Parsed<Option<Expr>> {
        if !self.text[self.at..].starts_with('[') {
            return Ok(None);
        }
        self.at += 1;
        let inner = self.binary(1)?;
        self.expect(']')?;
        Ok(Some(inner))
    }

    fn named(&mut self) -> Parsed<Expr> {
        let start = self.at;
        let name = self.word();
        if let Some((kind @ ("v" | "c" | "f"), id)) = name.split_once('_') {
            let mut index = Vec::new();
            while let Some(i) = self.bracketed()? {
                index.push(i);
            }
            let most = if kind == "v" { 1 } else { 2 };
            if index.len() > most {
                return Err(self.fail_at(start, format!("too many [ ] after {name}")));
            }
            let id = id.to_string();
            return Ok(match kind {
                "v" => Expr::Variable(id, index.pop().map(Box::new)),
                "c" => Expr::Compute(id, index),
                _ => Expr::Fix(id, index),
            });
        }
        if self.peek() == Some('(') {
            return self.function(start, name);
        }
        if let Some(value) = ATOM_VALUES.into_iter().find(|v| *v == name) {
            return Ok(match self.bracketed()? {
                Some(id) => Expr::AtomAt(value, Box::new(id)),
                None => Expr::Atom(value),
            });
        }
        if let Some(x) = functions::constant(name) {
            return Ok(Expr::Number(x));
        }
        if let Some(k) = keyword::find(name) {
            return Ok(Expr::Keyword(k));
        }
        let known = ATOM_VALUES
            .into_iter()
            .chain(keyword::names())
            .chain(functions::CONSTANTS);
        Err(FormulaError {
            help: Some(format!(
                "{}; a variable is written v_{name}",
                suggestion(name, known)
            )),
            ..self.fail_at(start, format!("`{name}` is not a value that formulas know"))
        })
    }

    fn function(&mut self, start: usize, name: &str) -> Parsed<Expr> {
        self.expect('(')?;
        if let Some(group) = functions::GROUP.into_iter().find(|g| *g == name) {
            return Ok(Expr::Group(group, self.plain_arguments()?));
        }
        if name == "is_defined" {
            let mut arguments = self.plain_arguments()?;
            return match (arguments.pop(), arguments.pop(), arguments.len()) {
                (Some(id), Some(category), 0) => Ok(Expr::IsDefined(category, id)),
                _ => Err(self.fail_at(start, "is_defined needs a category and a name")),
            };
        }
        let mut arguments = Vec::new();
        if self.peek() != Some(')') {
            loop {
                arguments.push(self.binary(1)?);
                if !self.eat(',') {
                    break;
                }
            }
        }
        self.expect(')')?;
        let wrong = |p: &Self, n: &str, found: usize| {
            p.fail_at(
                start,
                format!("{name}() takes {n} arguments, found {found}"),
            )
        };
        if matches!(name, "random" | "normal") {
            let found = arguments.len();
            let arguments: [Expr; 3] = arguments.try_into().map_err(|_| wrong(self, "3", found))?;
            return Ok(Expr::Random {
                normal: name == "normal",
                arguments: Box::new(arguments),
            });
        }
        match functions::NAMES.into_iter().find(|(n, _)| *n == name) {
            Some((_, n)) if n != arguments.len() => {
                Err(wrong(self, &n.to_string(), arguments.len()))
            }
            Some((n, _)) => Ok(Expr::Call(n, arguments)),
            None => {
                let known = functions::NAMES
                    .iter()
                    .map(|(n, _)| *n)
                    .chain(["random", "normal"])
                    .chain(functions::GROUP);
                Err(FormulaError {
                    help: Some(suggestion(name, known)),
                    ..self.fail_at(
                        start,
                        format!("`{name}` is not a function that formulas know"),
                    )
                })
            }
        }
    }

    /// Words separated by commas up to `)`.
    fn plain_arguments(&mut self) -> Parsed<Vec<String>> {
        let rest = &self.text[self.at..];
        let Some(end) = rest.find(')') else {
            return Err(self.fail("the formula ends where `)` is expected"));
        };
        self.at += end + 1;
        Ok(rest[..end]
            .split(',')
            .map(|w| w.trim().to_string())
            .collect())
    }
}
