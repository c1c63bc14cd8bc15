//! Text to program: a precedence-climbing parser that emits operations as it goes.

use super::error::{ExpressionError, STACK};
use super::measure::PLACE;
use super::op::{Binary, FUNCTIONS, Function, Op, Ternary, Unary};
use super::{Measure, Misfit};
use std::ops::Range;

/// Deepest nesting of brackets, signs and powers; keeps the parser's own stack small.
const NESTING: usize = 64;

pub(super) fn program<M: Measure>(
    source: &str,
    constants: &[(&str, f64)],
    measure: &M,
) -> Result<(Vec<Op>, M::Kind), ExpressionError> {
    let mut parser = Parser {
        source,
        constants,
        measure,
        kinds: Vec::new(),
        at: 0,
        nesting: 0,
        program: Vec::new(),
        height: 0,
    };
    parser.choice()?;
    match parser.peek() {
        None => {
            let kind = parser.kinds.pop().unwrap_or_else(|| measure.pure());
            Ok((parser.program, kind))
        }
        Some((span, Token::Symbol(",")))
            if source[..span.start].ends_with(|c: char| c.is_ascii_digit())
                && source[span.end..].starts_with(|c: char| c.is_ascii_digit()) =>
        {
            let mut error = parser.error(span.clone(), "a number has a decimal point, not a comma");
            let written = format!("{}.{}", &source[..span.start], &source[span.end..]);
            error.help = Some(format!("write {written}"));
            Err(error)
        }
        Some((span, Token::Symbol(")"))) => Err(parser.error(span, "this bracket closes nothing")),
        Some((span, token)) => {
            let help = match token {
                Token::Number(_) | Token::Name(_) | Token::Symbol("(") => {
                    Some("multiplication is written with `*`")
                }
                Token::Symbol("=") => Some("equality is written `==`"),
                _ => None,
            };
            let mut error = parser.error(span, "expected an operator or the end of the expression");
            error.help = help.map(str::to_string);
            Err(error)
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Token<'a> {
    Number(f64),
    Name(&'a str),
    Symbol(&'a str),
    /// A character that starts nothing.
    Stray,
}

struct Parser<'a, M: Measure> {
    source: &'a str,
    constants: &'a [(&'a str, f64)],
    measure: &'a M,
    /// Of the numbers on the stack.
    kinds: Vec<M::Kind>,
    at: usize,
    nesting: usize,
    program: Vec<Op>,
    /// Numbers on the stack after what was emitted so far.
    height: usize,
}

/// Binary operators by rising precedence.
const LEVELS: &[&[(&str, Binary)]] = &[
    &[("||", Binary::Or)],
    &[("&&", Binary::And)],
    &[
        ("<", Binary::Less),
        ("<=", Binary::LessEqual),
        (">", Binary::Greater),
        (">=", Binary::GreaterEqual),
        ("==", Binary::Equal),
        ("!=", Binary::NotEqual),
    ],
    &[("+", Binary::Add), ("-", Binary::Subtract)],
    &[("*", Binary::Multiply), ("/", Binary::Divide)],
];
const COMPARISON: usize = 2;

impl<'a, M: Measure> Parser<'a, M> {
    fn error(&self, span: Range<usize>, message: impl Into<String>) -> ExpressionError {
        ExpressionError {
            message: message.into(),
            span,
            help: None,
            source: self.source.to_string(),
        }
    }

    /// The next token and its place, without consuming it.
    fn peek(&self) -> Option<(Range<usize>, Token<'a>)> {
        let rest = self.source[self.at..].trim_start();
        let start = self.source.len() - rest.len();
        let first = rest.chars().next()?;
        let (length, token) = if first.is_ascii_digit() || first == '.' {
            let length = number_length(rest);
            match rest[..length].parse() {
                Ok(value) => (length, Token::Number(value)),
                Err(_) => (length, Token::Stray),
            }
        } else if first.is_ascii_alphabetic() || first == '_' {
            let length = rest
                .find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
                .unwrap_or(rest.len());
            (length, Token::Name(&rest[..length]))
        } else {
            let two = ["<=", ">=", "==", "!=", "&&", "||", "**"]
                .into_iter()
                .find(|s| rest.starts_with(s));
            let one = "+-*/^<>!?:(),="
                .contains(first)
                .then(|| &rest[..first.len_utf8()]);
            match two.or(one) {
                Some(symbol) => (symbol.len(), Token::Symbol(symbol)),
                None => (first.len_utf8(), Token::Stray),
            }
        };
        Some((start..start + length, token))
    }

    fn take_symbol(&mut self, symbol: &str) -> Option<Range<usize>> {
        match self.peek() {
            Some((span, Token::Symbol(found))) if found == symbol => {
                self.at = span.end;
                Some(span)
            }
            _ => None,
        }
    }

    fn expect(&mut self, symbol: &str, why: &str) -> Result<(), ExpressionError> {
        if self.take_symbol(symbol).is_some() {
            return Ok(());
        }
        let span = self
            .peek()
            .map_or(self.source.len()..self.source.len(), |(span, _)| span);
        Err(self.error(span, format!("expected `{symbol}` {why}")))
    }

    fn misfit(&self, span: Range<usize>, misfit: Misfit) -> ExpressionError {
        ExpressionError {
            help: misfit.help,
            ..self.error(span, misfit.message)
        }
    }

    /// Appends what takes no arguments.
    fn leaf(&mut self, op: Op, kind: M::Kind) -> Result<(), ExpressionError> {
        self.kinds.push(kind);
        self.append(op)
    }

    /// Appends an operation; `span` is where it stands, and its name.
    fn emit(&mut self, op: Op, span: Range<usize>) -> Result<(), ExpressionError> {
        if let Some((count, rule)) = op.rule() {
            let exponent = match self.program.last() {
                Some(Op::Push(value)) => Some(*value),
                _ => None,
            };
            let name = self.source[span.clone()].split('(').next().unwrap_or("");
            let of = self.kinds.len().saturating_sub(count);
            let kind = self
                .measure
                .combine(name, rule, &self.kinds[of..], exponent)
                .map_err(|misfit| self.misfit(span, misfit))?;
            self.kinds.truncate(of);
            self.kinds.push(kind);
        }
        self.append(op)
    }

    /// Appends an operation, folding it at once when its arguments are numbers.
    fn append(&mut self, op: Op) -> Result<(), ExpressionError> {
        self.program.push(op);
        let folded = match self.program[..] {
            [.., Op::Push(a), Op::One(f)] => Some((2, f.apply(a))),
            [.., Op::Push(a), Op::Push(b), Op::Two(f)] => Some((3, f.apply(a, b))),
            [.., Op::Push(a), Op::Push(b), Op::Push(c), Op::Three(f)] => {
                Some((4, f.apply(a, b, c)))
            }
            _ => None,
        };
        if let Some((used, value)) = folded {
            self.program.truncate(self.program.len() - used);
            self.program.push(Op::Push(value));
        }
        match op {
            Op::Push(_) | Op::Coordinate(_) | Op::Time => self.height += 1,
            Op::One(_) => {}
            Op::Two(_) => self.height -= 1,
            Op::Three(_) => self.height -= 2,
        }
        if self.height > STACK {
            let mut error = self.error(
                0..self.at,
                format!("more than {STACK} numbers wait for their operator"),
            );
            error.help = Some("name parts of it as constants, or nest less".into());
            return Err(error);
        }
        Ok(())
    }

    fn nested<T>(
        &mut self,
        inner: impl FnOnce(&mut Self) -> Result<T, ExpressionError>,
    ) -> Result<T, ExpressionError> {
        self.nesting += 1;
        if self.nesting > NESTING {
            return Err(self.error(0..self.at, format!("nested more than {NESTING} deep")));
        }
        let result = inner(self);
        self.nesting -= 1;
        result
    }

    /// `a ? b : c`, right associative.
    fn choice(&mut self) -> Result<(), ExpressionError> {
        self.nested(|p| {
            p.binary(0)?;
            if let Some(span) = p.take_symbol("?") {
                p.choice()?;
                p.expect(":", "between the two sides of `? :`")?;
                p.choice()?;
                p.emit(Op::Three(Ternary::Select), span)?;
            }
            Ok(())
        })
    }

    fn binary(&mut self, level: usize) -> Result<(), ExpressionError> {
        let Some(operators) = LEVELS.get(level) else {
            return self.sign();
        };
        self.binary(level + 1)?;
        let mut compared = false;
        while let Some((span, Token::Symbol(symbol))) = self.peek() {
            if symbol == "**" {
                let mut error = self.error(span, "`**` is not an operator");
                error.help = Some("powers are written with `^`".into());
                return Err(error);
            }
            let Some(&(_, operator)) = operators.iter().find(|(s, _)| *s == symbol) else {
                break;
            };
            if level == COMPARISON && compared {
                let mut error = self.error(span, "comparisons do not chain");
                error.help = Some("write `a < b && b < c`".into());
                return Err(error);
            }
            compared = true;
            self.at = span.end;
            self.binary(level + 1)?;
            self.emit(Op::Two(operator), span)?;
        }
        Ok(())
    }

    fn sign(&mut self) -> Result<(), ExpressionError> {
        for (symbol, operator) in [
            ("-", Some(Unary::Negate)),
            ("!", Some(Unary::Not)),
            ("+", None),
        ] {
            if let Some(span) = self.take_symbol(symbol) {
                self.nested(Self::sign)?;
                return operator.map_or(Ok(()), |f| self.emit(Op::One(f), span));
            }
        }
        self.primary()?;
        if let Some(span) = self.take_symbol("^") {
            self.nested(Self::sign)?;
            self.emit(Op::Two(Binary::Power), span)?;
        }
        Ok(())
    }

    fn primary(&mut self) -> Result<(), ExpressionError> {
        let Some((span, token)) = self.peek() else {
            let end = self.source.len();
            let message = if self.source.trim().is_empty() {
                "the expression is empty"
            } else {
                "the expression ends too early"
            };
            return Err(self.error(end..end, message));
        };
        self.at = span.end;
        match token {
            Token::Number(value) => self.number(value),
            Token::Symbol("(") => {
                self.choice()?;
                self.expect(")", "to close the bracket")
            }
            Token::Name(name) => self.name(name, span),
            Token::Symbol(symbol) => Err(self.error(
                span,
                format!("expected a number, a name or `(`, found `{symbol}`"),
            )),
            Token::Stray => {
                let text = &self.source[span.clone()];
                let message = if text.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
                    format!("`{text}` is not a number")
                } else {
                    format!("unexpected character `{text}`")
                };
                Err(self.error(span, message))
            }
        }
    }

    /// A number, with the unit behind it if there is one.
    fn number(&mut self, value: f64) -> Result<(), ExpressionError> {
        let rest = &self.source[self.at..];
        match self.measure.quantity(value, rest) {
            Ok(None) => self.leaf(Op::Push(value), self.measure.number(value)),
            Ok(Some((length, value, kind))) => {
                self.at += length;
                self.leaf(Op::Push(value), kind)
            }
            Err((span, misfit)) => {
                let span = self.at + span.start..self.at + span.end;
                Err(self.misfit(span, misfit))
            }
        }
    }

    fn name(&mut self, name: &str, span: Range<usize>) -> Result<(), ExpressionError> {
        if let Some(&(_, function)) = FUNCTIONS.iter().find(|(f, _)| *f == name) {
            return self.call(name, function, span);
        }
        let variables = self.measure.variables();
        if let Some(axis) = variables.iter().position(|v| *v == name) {
            return self.leaf(Op::Coordinate(axis), self.measure.coordinate());
        }
        let timed = variables == PLACE;
        if timed && name == "t" {
            return self.leaf(Op::Time, self.measure.time());
        }
        if let Some(index) = self.constants.iter().position(|(c, _)| *c == name) {
            let value = self.constants[index].1;
            return self.leaf(Op::Push(value), self.measure.constant(index));
        }
        let number = match name {
            "pi" => Some(std::f64::consts::PI),
            "e" => Some(std::f64::consts::E),
            _ => None,
        };
        if let Some(value) = number {
            return self.leaf(Op::Push(value), self.measure.pure());
        }
        let mut error = self.error(span, format!("unknown name \"{name}\""));
        let constants: Vec<&str> = self.constants.iter().map(|(c, _)| *c).collect();
        let mut own = variables.to_vec();
        if timed {
            own.push("t");
        }
        // a single letter is near everything
        let long = variables.iter().copied().filter(|v| v.len() > 1);
        let known = FUNCTIONS
            .iter()
            .map(|(f, _)| *f)
            .chain(long)
            .chain(constants.iter().copied())
            .chain(["pi"]);
        error.help = Some(match nearest(name, known) {
            Some(known) => format!("did you mean \"{known}\"?"),
            None => {
                own.extend(["pi", "e"]);
                own.extend(constants);
                format!("known names: {} and the functions", own.join(", "))
            }
        });
        Err(error)
    }

    fn call(
        &mut self,
        name: &str,
        function: Function,
        span: Range<usize>,
    ) -> Result<(), ExpressionError> {
        self.expect("(", &format!("after the function {name}"))?;
        let mut given = 0;
        if self.take_symbol(")").is_none() {
            loop {
                self.choice()?;
                given += 1;
                if let Function::Fold(f) = function
                    && given > 1
                {
                    self.emit(Op::Two(f), span.start..self.at)?;
                }
                if self.take_symbol(",").is_none() {
                    break;
                }
            }
            self.expect(")", &format!("to close the arguments of {name}"))?;
        }
        let (wanted, op) = match function {
            Function::One(f) => (1, Some(Op::One(f))),
            Function::Two(f) => (2, Some(Op::Two(f))),
            Function::Three(f) => (3, Some(Op::Three(f))),
            Function::Fold(_) => (given.max(2), None),
        };
        if given != wanted {
            let more = if matches!(function, Function::Fold(_)) {
                " or more"
            } else {
                ""
            };
            let plural = if wanted == 1 { "argument" } else { "arguments" };
            let message = format!("{name} takes {wanted}{more} {plural}, not {given}");
            return Err(self.error(span.start..self.at, message));
        }
        op.map_or(Ok(()), |op| self.emit(op, span.start..self.at))
    }
}

/// Bytes of the number that `text` starts with; what follows an `e` is taken only when it is an exponent.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| {
        text.as_bytes()[from..]
            .iter()
            .take_while(|b| b.is_ascii_digit())
            .count()
    };
    let mut n = digits(0);
    if text[n..].starts_with('.') {
        n += 1;
        n += digits(n);
    }
    if text[n..].starts_with(['e', 'E']) {
        let sign = usize::from(text[n + 1..].starts_with(['+', '-']));
        let exponent = digits(n + 1 + sign);
        if exponent > 0 {
            n += 1 + sign + exponent;
        }
    }
    n
}

/// The candidate within an edit distance of 2 (1 for short names), if any.
pub fn nearest<'b>(name: &str, candidates: impl Iterator<Item = &'b str>) -> Option<&'b str> {
    let limit = if name.len() <= 3 { 1 } else { 2 };
    candidates
        .map(|candidate| (edits(name.as_bytes(), candidate.as_bytes()), candidate))
        .filter(|(distance, _)| *distance <= limit)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// Levenshtein distance.
fn edits(a: &[u8], b: &[u8]) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let substitute = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = substitute.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
