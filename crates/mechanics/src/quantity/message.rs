//! Sentences for readers.

use std::fmt;
use std::ops::{Deref, Range};

use super::number::{Quantity, rounded};

use super::Dimension;

/// Digits of numbers where nobody knows units.
const DIGITS: usize = 4;

/// A sentence whose numbers know what they measure. It reads as a text with plain numbers; [`Message::with`] writes them with units.
///
/// ```
/// use peridyne_mechanics::message;
/// use peridyne_mechanics::quantity::Dimension;
///
/// let told = message!["the period is ", Dimension::LENGTH.of(0.003), " long"];
/// assert_eq!(&*told, "the period is 0.003 long");
/// assert_eq!(told.with(|q| format!("{} mm", 1e3 * q.value)), "the period is 3 mm long");
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Message {
    text: String,
    /// Where numbers stand in the text.
    quantities: Vec<(Range<usize>, Quantity)>,
}

impl Message {
    /// The sentence with its numbers as `write` says.
    pub fn with(&self, write: impl Fn(Quantity) -> String) -> String {
        let mut out = String::new();
        let mut at = 0;
        for (range, quantity) in &self.quantities {
            out += &self.text[at..range.start];
            out += &write(*quantity);
            at = range.end;
        }
        out + &self.text[at..]
    }

    pub fn add(&mut self, part: impl Part) {
        part.join(self);
    }
}

/// What a sentence is made of.
pub trait Part {
    fn join(self, message: &mut Message);
}

impl Part for &str {
    fn join(self, message: &mut Message) {
        message.text += self;
    }
}

impl Part for String {
    fn join(self, message: &mut Message) {
        message.text += &self;
    }
}

impl Part for &String {
    fn join(self, message: &mut Message) {
        message.text += self;
    }
}

impl Part for Quantity {
    fn join(self, message: &mut Message) {
        let start = message.text.len();
        message.text += &rounded(self.value, DIGITS);
        message.quantities.push((start..message.text.len(), self));
    }
}

impl Part for Message {
    fn join(self, message: &mut Message) {
        let start = message.text.len();
        message.text += &self.text;
        let moved = self.quantities.into_iter();
        let moved = moved.map(|(r, q)| (start + r.start..start + r.end, q));
        message.quantities.extend(moved);
    }
}

impl Part for &Message {
    fn join(self, message: &mut Message) {
        self.clone().join(message);
    }
}

/// A [`Message`](crate::quantity::Message) of texts and quantities, one after the other.
#[macro_export]
macro_rules! message {
    ($($part:expr),* $(,)?) => {{
        let mut message = $crate::quantity::Message::default();
        $(message.add($part);)*
        message
    }};
}

/// A place: `(1 mm, 2 mm)`.
pub fn place(x: &[f64]) -> Message {
    let mut message = Message::from("(");
    for (n, c) in x.iter().enumerate() {
        message.add(if n > 0 { ", " } else { "" });
        message.add(Dimension::LENGTH.of(*c));
    }
    message.add(")");
    message
}

impl Deref for Message {
    type Target = str;
    fn deref(&self) -> &str {
        &self.text
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl From<String> for Message {
    fn from(text: String) -> Message {
        Message {
            text,
            quantities: vec![],
        }
    }
}

impl From<&str> for Message {
    fn from(text: &str) -> Message {
        text.to_string().into()
    }
}

impl From<&String> for Message {
    fn from(text: &String) -> Message {
        text.clone().into()
    }
}

impl From<Message> for String {
    fn from(message: Message) -> String {
        message.text
    }
}

/// What a user should know of a model that runs all the same.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Warnings(Vec<Message>);

impl Warnings {
    pub fn push(&mut self, message: impl Into<Message>) {
        self.0.push(message.into());
    }
}

impl<M: Into<Message>> Extend<M> for Warnings {
    fn extend<I: IntoIterator<Item = M>>(&mut self, messages: I) {
        self.0.extend(messages.into_iter().map(Into::into));
    }
}

impl Deref for Warnings {
    type Target = [Message];
    fn deref(&self) -> &[Message] {
        &self.0
    }
}

impl<'a> IntoIterator for &'a Warnings {
    type Item = &'a Message;
    type IntoIter = std::slice::Iter<'a, Message>;
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_get_units_where_they_stand() {
        let inner = message!["body `a`: ", Dimension::TIME.of(2e-7)];
        let told = message![inner, " of ", place(&[0.5, -1e-9]), format!(", {}", 3)];
        assert_eq!(&*told, "body `a`: 2e-7 of (0.5, -1e-9), 3");
        let unit = |q: Quantity| match q.dimension {
            Dimension::TIME => format!("{} µs", rounded(1e6 * q.value, 4)),
            _ => format!("{} m", q.value),
        };
        let text = told.with(unit);
        assert_eq!(text, "body `a`: 0.2 µs of (0.5 m, -0.000000001 m), 3");
        assert_eq!(Message::from("x").with(unit), "x");
    }

    #[test]
    fn numbers_without_units_have_few_digits() {
        assert_eq!(rounded(5.72, 4), "5.72");
        assert_eq!(rounded(1.0 / 3.0, 4), "0.3333");
        assert_eq!(rounded(-1.23456e-7, 4), "-1.235e-7");
        assert_eq!(rounded(f64::INFINITY, 4), "inf");
    }
}
