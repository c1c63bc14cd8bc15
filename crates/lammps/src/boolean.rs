//! Conditions of `if`: numbers and words compared, joined by `&&`, `||`, `|^`, `!`.

use super::variable::ast::Op;

/// Value of a condition.
///
/// # Errors
/// A sentence about what is wrong.
pub fn evaluate(text: &str) -> Result<bool, String> {
    let mut parser = Parser {
        text,
        at: 0,
        depth: 0,
    };
    let value = parser.binary(1)?;
    if parser.rest().is_empty() {
        truth(&value)
    } else {
        Err(parser.fail("an operator"))
    }
}

#[derive(Debug, Clone, PartialEq)]
enum Value {
    Number(f64),
    Word(String),
}

fn truth(value: &Value) -> Result<bool, String> {
    match value {
        Value::Number(x) => Ok(*x != 0.0),
        Value::Word(w) => Err(format!(
            "`{w}` is a word, a number or a comparison is needed in the condition"
        )),
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl<'a> Parser<'a> {
    fn rest(&mut self) -> &'a str {
        let rest = &self.text[self.at..];
        let trimmed = rest.trim_start();
        self.at += rest.len() - trimmed.len();
        trimmed
    }

    fn fail(&mut self, expected: &str) -> String {
        match self.rest() {
            "" => format!(
                "the condition `{}` ends where {expected} is expected",
                self.text
            ),
            rest => format!(
                "expected {expected} at `{rest}` in the condition `{}`",
                self.text
            ),
        }
    }

    fn binary(&mut self, least: u8) -> Result<Value, String> {
        self.depth += 1;
        if self.depth > 100 {
            return Err("the condition is nested too deeply".to_string());
        }
        let mut left = self.primary()?;
        loop {
            let rest = self.rest();
            let found = Op::SPELLING.into_iter().find(|(s, _)| rest.starts_with(s));
            let Some((spelling, op)) = found.filter(|(_, op)| op.precedence() <= 4) else {
                break;
            };
            if op.precedence() < least {
                break;
            }
            self.at += spelling.len();
            let right = self.binary(op.precedence() + 1)?;
            left = Value::Number(match (&left, &right, op) {
                (Value::Word(a), Value::Word(b), Op::Eq) => f64::from(u8::from(a == b)),
                (Value::Word(a), Value::Word(b), Op::Ne) => f64::from(u8::from(a != b)),
                (Value::Number(a), Value::Number(b), _) => op.apply(*a, *b)?,
                _ => {
                    return Err(format!(
                        "`{spelling}` cannot compare {} in the condition",
                        describe(&left, &right)
                    ));
                }
            });
        }
        self.depth -= 1;
        Ok(left)
    }

    fn primary(&mut self) -> Result<Value, String> {
        let rest = self.rest();
        if rest.starts_with('!') {
            self.at += 1;
            self.depth += 1;
            if self.depth > 100 {
                return Err("the condition is nested too deeply".to_string());
            }
            let value = self.primary()?;
            self.depth -= 1;
            return Ok(Value::Number(f64::from(u8::from(!truth(&value)?))));
        }
        if rest.starts_with('(') {
            self.at += 1;
            let value = self.binary(1)?;
            if !self.rest().starts_with(')') {
                return Err(self.fail("`)`"));
            }
            self.at += 1;
            return Ok(value);
        }
        if let Some(quote) = rest.chars().next().filter(|c| ['"', '\''].contains(c)) {
            let end = rest[1..]
                .find(quote)
                .ok_or_else(|| self.fail("a closing quote"))?;
            self.at += end + 2;
            return Ok(Value::Word(rest[1..=end].to_string()));
        }
        let end = rest
            .find(|c: char| c.is_whitespace() || "()<>=!&|".contains(c))
            .unwrap_or(rest.len());
        if end == 0 {
            return Err(self.fail("a number or a word"));
        }
        self.at += end;
        let word = &rest[..end];
        let numeric = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        match word.parse() {
            Ok(x) if numeric => Ok(Value::Number(x)),
            _ => Ok(Value::Word(word.to_string())),
        }
    }
}

fn describe(a: &Value, b: &Value) -> String {
    let one = |v: &Value| match v {
        Value::Number(x) => format!("the number {x}"),
        Value::Word(w) => format!("the word `{w}`"),
    };
    format!("{} with {}", one(a), one(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions() {
        for (text, value) in [
            ("pmb == pmb", true),
            ("pmb==lps", false),
            ("a != b", true),
            ("1.23456 > 1 && (1 == 2 || 3 <= 3)", true),
            ("!(1 == 2)", true),
            ("1 |^ 0", true),
            ("1 |^ 1", false),
            ("1 || 0 && 0", true),
            ("-1 < 0", true),
            ("0", false),
            ("'a b' == 'a b'", true),
        ] {
            assert_eq!(evaluate(text), Ok(value), "{text}");
        }
        for text in ["", "a", "1 <", "(1", "a < b", "1 == a", "1 2", "'a"] {
            assert!(evaluate(text).is_err(), "{text}");
        }
    }
}
