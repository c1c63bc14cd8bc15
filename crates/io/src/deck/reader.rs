//! Documents are made of a deck's tree by one reader, so that each is compiled once.
//!
//! Every list is read to its last item, and a table is never written as a list of its values; serde alone takes both.

use super::error::DeckError;
use super::source::{Source, Tree};
use super::syntax;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error, Expected, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::vec::IntoIter;
use toml::Spanned;
use toml::de::{DeArray, DeInteger, DeTable, DeValue};
use toml::value::Datetime;

/// Name of what is read as a list of where it starts, where it ends and what it is.
pub(super) const AT: &str = "$at";
/// Name of what is read as a list of whether it is a table, 0 or 1, and what it is.
pub(super) const OR: &str = "$or";
/// toml's key of a date: to serde it is a table of this one text.
const DATE: &str = "$__toml_private_datetime";

/// The document that a deck's tree is.
///
/// # Errors
/// The first thing that is of another form, with its place.
pub(super) fn read<T: DeserializeOwned>(source: &Source, tree: &Tree) -> Result<T, DeckError> {
    let root = Reader {
        item: Item::Table(tree.get_ref()),
        span: tree.span(),
        bare: false,
    };
    T::deserialize(root).map_err(|e| syntax::mistake(source, e.span, &e.message))
}

/// What is wrong, and where as soon as that is known.
#[derive(Debug)]
struct Mistake {
    message: String,
    span: Option<Range<usize>>,
}

impl Mistake {
    fn at(mut self, span: Range<usize>) -> Self {
        self.span.get_or_insert(span);
        self
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Mistake {}

impl Error for Mistake {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Mistake {
            message: message.to_string(),
            span: None,
        }
    }
}

/// What is written at a place of a deck.
enum Item<'t> {
    Bool(bool),
    Signed(i64),
    Unsigned(u64),
    /// A whole number that no field holds, in words.
    Huge(String),
    /// A number that is none, and why.
    Lost(&'static str),
    Float(f64),
    Text(Cow<'t, str>),
    List(&'t DeArray<'t>),
    Table(&'t DeTable<'t>),
    Date(&'t Datetime),
}

impl<'t> Item<'t> {
    fn of(value: &'t DeValue<'t>) -> Self {
        match value {
            DeValue::String(text) => Item::Text(Cow::Borrowed(text)),
            DeValue::Integer(number) => Self::integer(number),
            DeValue::Float(number) => match number.as_str().parse::<f64>() {
                Ok(x) if x.is_finite() || x.is_nan() || number.as_str().contains("inf") => {
                    Item::Float(x)
                }
                _ => Item::Lost("floating-point number overflowed"),
            },
            DeValue::Boolean(value) => Item::Bool(*value),
            DeValue::Datetime(date) => Item::Date(date),
            DeValue::Array(items) => Item::List(items),
            DeValue::Table(table) => Item::Table(table),
        }
    }

    fn integer(number: &DeInteger) -> Self {
        let (digits, radix) = (number.as_str(), number.radix());
        if let Ok(n) = i64::from_str_radix(digits, radix) {
            Item::Signed(n)
        } else if let Ok(n) = u64::from_str_radix(digits, radix) {
            Item::Unsigned(n)
        } else if let Ok(n) = i128::from_str_radix(digits, radix) {
            Item::Huge(format!("integer `{n}` as i128"))
        } else if let Ok(n) = u128::from_str_radix(digits, radix) {
            Item::Huge(format!("integer `{n}` as u128"))
        } else {
            Item::Lost("integer number overflowed")
        }
    }
}

/// Reads one item.
struct Reader<'t> {
    item: Item<'t>,
    span: Range<usize>,
    /// Is it a value that could have been a table?
    bare: bool,
}

impl<'t> Reader<'t> {
    fn of(value: &'t Spanned<DeValue<'t>>) -> Self {
        Self::new(Item::of(value.get_ref()), value.span())
    }

    fn new(item: Item<'t>, span: Range<usize>) -> Self {
        Reader {
            item,
            span,
            bare: false,
        }
    }

    fn mistake<T>(&self, message: impl Into<String>) -> Result<T, Mistake> {
        Err(Mistake {
            message: message.into(),
            span: Some(self.span.clone()),
        })
    }

    /// It is not what is expected.
    fn wrong<T>(&self, expected: &dyn Expected) -> Result<T, Mistake> {
        let found = match &self.item {
            Item::Bool(value) => Unexpected::Bool(*value),
            Item::Signed(n) => Unexpected::Signed(*n),
            Item::Unsigned(n) => Unexpected::Unsigned(*n),
            Item::Huge(words) => Unexpected::Other(words),
            Item::Lost(why) => return self.mistake(*why),
            Item::Float(x) => Unexpected::Float(*x),
            Item::Text(text) => Unexpected::Str(text),
            Item::List(_) => Unexpected::Seq,
            Item::Table(_) | Item::Date(_) => Unexpected::Map,
        };
        Err(Mistake::invalid_type(found, expected).at(self.span.clone()))
    }

    fn float(&self, expected: &dyn Expected) -> Result<f64, Mistake> {
        match self.item {
            Item::Float(x) => Ok(x),
            Item::Signed(n) => Ok(n as f64),
            Item::Unsigned(n) => Ok(n as f64),
            _ => self.wrong(expected),
        }
    }

    fn text(&self, expected: &dyn Expected) -> Result<&str, Mistake> {
        match &self.item {
            Item::Text(text) => Ok(text),
            _ => self.wrong(expected),
        }
    }

    fn list(&self, expected: &dyn Expected) -> Result<IntoIter<Reader<'t>>, Mistake> {
        match self.item {
            Item::List(items) => Ok(items.iter().map(Reader::of).collect::<Vec<_>>().into_iter()),
            _ => self.wrong(expected),
        }
    }

    /// Keys, each with its value after it.
    fn table(&self, expected: &dyn Expected) -> Result<IntoIter<Reader<'t>>, Mistake> {
        let text = |text, span| Reader::new(Item::Text(text), span);
        let all: Vec<_> = match self.item {
            Item::Table(table) => table
                .iter()
                .flat_map(|(key, value)| {
                    let name = Cow::Borrowed(&**key.get_ref());
                    [text(name, key.span()), Reader::of(value)]
                })
                .collect(),
            Item::Date(date) => [DATE.into(), date.to_string().into()]
                .map(|part| text(part, self.span.clone()))
                .into(),
            _ => return self.wrong(expected),
        };
        Ok(all.into_iter())
    }

    /// It itself after what else is told of it under the `name`.
    fn told(self, name: &str, expected: &dyn Expected) -> Result<IntoIter<Self>, Mistake> {
        let number = |n: usize| Reader::new(Item::Unsigned(n as u64), self.span.clone());
        let told = match (name, &self.item) {
            (AT, _) => vec![number(self.span.start), number(self.span.end)],
            (OR, Item::Unsigned(_) | Item::Huge(_) | Item::Lost(_)) => return self.wrong(expected),
            (OR, Item::Table(_) | Item::Date(_)) => vec![number(1)],
            (OR, _) => vec![number(0)],
            _ => return self.list(expected),
        };
        let bare = name == OR;
        let all = told.into_iter().chain([Reader { bare, ..self }]);
        Ok(all.collect::<Vec<_>>().into_iter())
    }

    /// The name of a variant, and what is in it if it is a table.
    fn variant(self, expected: &dyn Expected) -> Result<IntoIter<Self>, Mistake> {
        match self.item {
            Item::Text(_) => Ok(vec![self].into_iter()),
            Item::Table(table) => match table.len() {
                0 => self.mistake("wanted exactly 1 element, found 0 elements"),
                1 => self.table(expected),
                _ => self.mistake("wanted exactly 1 element, more than 1 element"),
            },
            _ if self.bare => self.wrong(expected),
            _ => self.mistake("wanted string or table"),
        }
    }

    /// Nothing is in a variant that has no fields.
    fn empty(&self) -> Result<(), Mistake> {
        let found = match self.item {
            Item::List(items) if items.is_empty() => return Ok(()),
            Item::Table(table) if table.is_empty() => return Ok(()),
            Item::List(_) => return self.mistake("expected empty array"),
            Item::Table(_) => return self.mistake("expected empty table"),
            Item::Bool(_) => "boolean",
            Item::Signed(_) | Item::Unsigned(_) | Item::Huge(_) => "integer",
            Item::Lost(why) if why.starts_with("integer") => "integer",
            Item::Float(_) | Item::Lost(_) => "float",
            Item::Text(_) => "string",
            Item::Date(_) => "datetime",
        };
        self.mistake(format!("expected table, found {found}"))
    }

    /// Has a variant with `fields` no other keys?
    fn known(&self, fields: &[&str]) -> Result<(), Mistake> {
        let Item::Table(table) = self.item else {
            return Ok(());
        };
        let extra = table.keys().filter(|k| !fields.contains(&&**k.get_ref()));
        let extra: Vec<_> = extra.collect();
        let Some(first) = extra.first() else {
            return Ok(());
        };
        let names: Vec<&str> = extra.iter().map(|key| &**key.get_ref()).collect();
        Err(Mistake::custom(format!(
            "unexpected keys in table: {}, available keys: {}",
            names.join(", "),
            fields.join(", "),
        ))
        .at(first.span()))
    }
}

/// A list is over.
fn ended(items: &IntoIter<Reader>, all: usize, expected: &str) -> Result<(), Mistake> {
    match items.len() {
        0 => Ok(()),
        _ => Err(Mistake::invalid_length(all, &expected)),
    }
}

macro_rules! whole {
    ($($method:ident)*) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
            match self.item {
                Item::Signed(n) => visitor.visit_i64(n),
                Item::Unsigned(n) => visitor.visit_u64(n),
                _ => return self.wrong(&visitor),
            }
            .map_err(|e: Mistake| e.at(self.span))
        })*
    };
}

macro_rules! text {
    ($($method:ident)*) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
            let text = self.text(&visitor)?;
            visitor.visit_str(text).map_err(|e: Mistake| e.at(self.span))
        })*
    };
}

/// Each kind of visitor is shown only what it takes.
impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = Mistake;

    whole! {
        deserialize_i8 deserialize_i16 deserialize_i32 deserialize_i64 deserialize_u8 deserialize_u16 deserialize_u32 deserialize_u64
    }
    text! { deserialize_char deserialize_str deserialize_string deserialize_identifier }
    forward_to_deserialize_any! { bytes byte_buf unit unit_struct }

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
        match self.item {
            Item::Bool(value) => visitor.visit_bool(value),
            Item::Signed(n) => visitor.visit_i64(n),
            Item::Unsigned(n) => visitor.visit_u64(n),
            Item::Float(x) => visitor.visit_f64(x),
            Item::Text(ref text) => visitor.visit_str(text),
            Item::List(_) => return self.deserialize_seq(visitor),
            Item::Table(_) | Item::Date(_) => return self.deserialize_map(visitor),
            Item::Huge(_) | Item::Lost(_) => return self.wrong(&visitor),
        }
        .map_err(|e: Mistake| e.at(self.span))
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
        match self.item {
            Item::Bool(value) => visitor.visit_bool(value),
            _ => self.wrong(&visitor),
        }
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
        self.deserialize_f64(visitor)
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
        let x = self.float(&visitor)?;
        visitor.visit_f64(x)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
        let mut items = self.list(&visitor)?;
        let (all, expected) = (items.len(), (&visitor as &dyn Expected).to_string());
        let value = visitor.visit_seq(Parts(&mut items));
        { value.and_then(|value| ended(&items, all, &expected).map(|()| value)) }
            .map_err(|e: Mistake| e.at(self.span))
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Mistake> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        let span = self.span.clone();
        let mut told = self.told(name, &visitor)?;
        let value = visitor.visit_seq(Parts(&mut told));
        // a place is known to what stands around it
        value.map_err(|e: Mistake| if name == AT { e } else { e.at(span) })
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
        let mut entries = self.table(&visitor)?;
        { visitor.visit_map(Parts(&mut entries)) }.map_err(|e| e.at(self.span))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        self.deserialize_map(visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        let span = self.span.clone();
        let mut parts = self.variant(&visitor)?;
        { visitor.visit_enum(Parts(&mut parts)) }.map_err(|e| e.at(span))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
        let span = self.span.clone();
        visitor.visit_some(self).map_err(|e| e.at(span))
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        let span = self.span.clone();
        visitor.visit_newtype_struct(self).map_err(|e| e.at(span))
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Mistake> {
        visitor.visit_unit()
    }
}

/// What is left of a list, of a table (keys, each with its value after it), or of a variant (its name and what is in it).
struct Parts<'p, 't>(&'p mut IntoIter<Reader<'t>>);

impl<'t> Parts<'_, 't> {
    /// What is in a variant that is not its name alone.
    fn content(self, expected: &str) -> Result<Reader<'t>, Mistake> {
        let alone = || Mistake::invalid_type(Unexpected::UnitVariant, &expected);
        self.0.next().ok_or_else(alone)
    }
}

impl<'de> SeqAccess<'de> for Parts<'_, '_> {
    type Error = Mistake;

    fn next_element_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, Mistake> {
        self.0.next().map(|item| seed.deserialize(item)).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

impl<'de> MapAccess<'de> for Parts<'_, '_> {
    type Error = Mistake;

    fn next_key_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, Mistake> {
        match self.0.len() {
            0 => Ok(None),
            _ => self.next_value_seed(seed).map(Some),
        }
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Mistake> {
        let Some(part) = self.0.next() else {
            return Err(Mistake::custom("a key has no value"));
        };
        let span = part.span.clone();
        seed.deserialize(part).map_err(|e| e.at(span))
    }
}

impl<'de> EnumAccess<'de> for Parts<'_, '_> {
    type Error = Mistake;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'de>>(
        mut self,
        seed: S,
    ) -> Result<(S::Value, Self), Mistake> {
        let name = self.next_value_seed(seed)?;
        Ok((name, self))
    }
}

impl<'de> VariantAccess<'de> for Parts<'_, '_> {
    type Error = Mistake;

    fn unit_variant(self) -> Result<(), Mistake> {
        self.0.next().map_or(Ok(()), |content| content.empty())
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, Mistake> {
        seed.deserialize(self.content("newtype variant")?)
    }

    fn tuple_variant<V: Visitor<'de>>(
        self,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        { self.content("tuple variant")? }.deserialize_tuple(length, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Mistake> {
        let content = self.content("struct variant")?;
        content.known(fields)?;
        content.deserialize_map(visitor)
    }
}
