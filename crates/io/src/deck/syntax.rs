//! What serde finds wrong in a deck, in words for people.

use super::error::{DeckError, nearest};
use super::source::Source;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

const WHOLE: &str = "expected a whole number from 0";

/// serde's names of types in words of a deck.
const TYPES: [(&str, &str); 11] = [
    ("invalid value: ", "invalid type: "),
    ("expected u64", WHOLE),
    ("expected usize", WHOLE),
    ("expected u32", WHOLE),
    ("expected i32", "expected a whole number"),
    ("expected a sequence", "expected a list"),
    ("expected a boolean", "expected true or false"),
    ("type: map", "type: a table"),
    ("type: sequence", "type: a list"),
    ("type: floating point ", "type: the number "),
    ("type: integer ", "type: the number "),
];

/// At `span`, serde says `message`.
pub(super) fn mistake(source: &Source, span: Option<Range<usize>>, message: &str) -> DeckError {
    let message = TYPES.iter().fold(message.to_string(), |m, (serde, ours)| {
        m.replace(serde, ours)
    });
    let mut message = &*message;
    // "expected struct Run" tells a user nothing
    let table;
    if let Some((before, _)) = message.split_once("expected struct ") {
        table = format!("{before}expected a table of keys, such as {{ key = value }}");
        message = &table;
    }
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    let known = || quoted.iter().skip(1).copied();
    let span = match message.strip_prefix("unknown field `").and(quoted.first()) {
        Some(name) => span.map(|table| key_of(source, &table, name).unwrap_or(table)),
        None => span,
    };
    let (message, help) =
        if let Some(name) = message.strip_prefix("unknown field `").and(quoted.first()) {
            (
                format!("unknown key `{name}`"),
                Some(suggest(name, known())),
            )
        } else if let Some(name) = message
            .strip_prefix("unknown variant `")
            .and(quoted.first())
        {
            (
                format!("`{name}` is not known here"),
                Some(suggest(name, known())),
            )
        } else if let Some(name) = message.strip_prefix("missing field `").and(quoted.first()) {
            (format!("the key `{name}` is missing"), None)
        } else if let Some(rest) = message.strip_prefix("invalid type: ") {
            match rest.split_once(", expected ") {
                Some((found, expected)) => {
                    let written = span.as_ref().map_or("", |s| source.slice(s));
                    let help = whole_number(written)
                        .filter(|_| expected.starts_with("a whole number"))
                        .map(|n| format!("write {n}"));
                    (format!("expected {expected}, found {found}"), help)
                }
                None => (message.to_string(), None),
            }
        } else if let Some(rest) = message.strip_prefix("invalid length ") {
            match rest.split_once(", expected ") {
                Some((found, expected)) => {
                    let expected = expected.replace("an array of length", "a list of");
                    (format!("expected {expected}, found {found}"), None)
                }
                None => (message.to_string(), None),
            }
        } else if message.starts_with("wanted exactly 1 element") {
            (
                "expected a table with exactly one entry, which says the kind".into(),
                None,
            )
        } else {
            (message.trim().replace('\n', ", "), None)
        };
    source.error(span, message, help)
}

/// Where the key `name` of the table at `span` is written: laws are read by their descriptors, which tell of the whole table.
fn key_of(source: &Source, span: &Range<usize>, name: &str) -> Option<Range<usize>> {
    fn within(table: &DeTable, span: &Range<usize>, name: &str) -> Option<Range<usize>> {
        table.values().find_map(|value| match value.get_ref() {
            DeValue::Table(inner) if value.span() == *span => {
                inner.get_key_value(name).map(|(key, _)| key.span())
            }
            DeValue::Table(inner) => within(inner, span, name),
            DeValue::Array(items) => items.iter().find_map(|item| match item.get_ref() {
                DeValue::Table(inner) => within(inner, span, name),
                _ => None,
            }),
            _ => None,
        })
    }
    within(source.tree().ok()?.get_ref(), span, name)
}

/// `1e4` and `100.0` without exponent and point.
fn whole_number(written: &str) -> Option<u64> {
    let value: f64 = written.trim().trim_matches('"').parse().ok()?;
    (0.0..1e15).contains(&value).then(|| value.round() as u64)
}

fn suggest<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    match nearest(name, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("known here: {}", known.collect::<Vec<_>>().join(", ")),
    }
}
