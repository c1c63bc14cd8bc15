//! Values of a deck that remember where they stand.

use super::reader::{AT, OR};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;

/// A value and its place.
#[derive(Debug, Clone)]
pub struct At<T> {
    pub value: T,
    pub span: Range<usize>,
}

/// The next of what a reader tells.
fn next<'de, A: SeqAccess<'de>, T: Deserialize<'de>>(told: &mut A) -> Result<T, A::Error> {
    let told = told.next_element()?;
    told.ok_or_else(|| A::Error::invalid_length(0, &"a value of a deck"))
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for At<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AtVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for AtVisitor<T> {
            type Value = At<T>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a value and its place")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut told: A) -> Result<At<T>, A::Error> {
                Ok(At {
                    span: next(&mut told)?..next(&mut told)?,
                    value: next(&mut told)?,
                })
            }
        }
        deserializer.deserialize_tuple_struct(AT, 3, AtVisitor(PhantomData))
    }
}

/// That of the value itself, made once.
impl<T: JsonSchema> JsonSchema for At<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }
    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// A number as written: plain, with a unit, or an expression.
#[derive(Debug, Clone)]
pub enum Written {
    Plain(f64),
    Text(String),
}

pub type Number = At<Written>;

impl<'de> Deserialize<'de> for Written {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct WrittenVisitor;
        impl Visitor<'_> for WrittenVisitor {
            type Value = Written;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, or a text such as \"0.5 mm\"")
            }
            fn visit_i64<E: Error>(self, v: i64) -> Result<Written, E> {
                Ok(Written::Plain(v as f64))
            }
            fn visit_u64<E: Error>(self, v: u64) -> Result<Written, E> {
                Ok(Written::Plain(v as f64))
            }
            fn visit_f64<E: Error>(self, v: f64) -> Result<Written, E> {
                Ok(Written::Plain(v))
            }
            fn visit_str<E: Error>(self, v: &str) -> Result<Written, E> {
                Ok(Written::Text(v.to_string()))
            }
        }
        deserializer.deserialize_any(WrittenVisitor)
    }
}

impl JsonSchema for Written {
    fn schema_name() -> Cow<'static, str> {
        "Number".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A number in the deck's units, a number with a unit (\"0.5 mm\"), or an expression of constants (where it says so, of x, y, z, t) in which numbers may carry units: \"12 MPa * t / 10 us\". Where a unit is written, dimensions are checked. A number without unit is in the deck's units and of the kind of its place: beside + and < that of the other side, as a divisor of x, y, z, t (t / 1e-5) theirs, and beside a quantity as a factor a pure number. In statics t is a number from 0 to 1.",
            "anyOf": [{ "type": "number" }, { "type": "string" }]
        })
    }
}

/// One to three components.
fn list<'de, A: SeqAccess<'de>>(mut seq: A) -> Result<Vec<Number>, A::Error> {
    let mut items = Vec::new();
    while let Some(item) = seq.next_element()? {
        items.push(item);
    }
    match items.len() {
        1..=3 => Ok(items),
        n => Err(A::Error::invalid_length(n, &"1 to 3 components")),
    }
}

/// A vector: a list of numbers, or one number in 1-D.
pub type Vector = At<Numbers>;

#[derive(Debug, Clone)]
pub struct Numbers(pub Vec<Number>);

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumbersVisitor;
        impl<'de> Visitor<'de> for NumbersVisitor {
            type Value = Numbers;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a list of numbers such as [0, \"0.5 mm\"]")
            }
            fn visit_i64<E: Error>(self, v: i64) -> Result<Numbers, E> {
                Ok(Numbers(vec![At {
                    value: Written::Plain(v as f64),
                    span: 0..0,
                }]))
            }
            fn visit_f64<E: Error>(self, v: f64) -> Result<Numbers, E> {
                Ok(Numbers(vec![At {
                    value: Written::Plain(v),
                    span: 0..0,
                }]))
            }
            fn visit_str<E: Error>(self, v: &str) -> Result<Numbers, E> {
                Ok(Numbers(vec![At {
                    value: Written::Text(v.to_string()),
                    span: 0..0,
                }]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Numbers, A::Error> {
                list(seq).map(Numbers)
            }
        }
        deserializer.deserialize_any(NumbersVisitor)
    }
}

impl JsonSchema for Numbers {
    fn schema_name() -> Cow<'static, str> {
        "Vector".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = generator.subschema_for::<Written>();
        json_schema!({ "anyOf": [number, { "type": "array", "items": number, "minItems": 1, "maxItems": 3 }] })
    }
}

/// Components: a list as long as the dimension (`"free"` leaves one alone), or a table of some of x, y, z.
pub type Components = At<ComponentsWritten>;

#[derive(Debug, Clone)]
pub enum ComponentsWritten {
    List(Vec<Number>),
    Axes([Option<Number>; 3]),
}

#[derive(Debug, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Axes {
    x: Option<Number>,
    y: Option<Number>,
    z: Option<Number>,
}

impl<'de> Deserialize<'de> for ComponentsWritten {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ComponentsVisitor;
        impl<'de> Visitor<'de> for ComponentsVisitor {
            type Value = ComponentsWritten;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("components such as { x = \"1 mm\" } or [\"1 mm\", \"free\"]")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                list(seq).map(ComponentsWritten::List)
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let axes = Axes::deserialize(MapAccessDeserializer::new(map))?;
                Ok(ComponentsWritten::Axes([axes.x, axes.y, axes.z]))
            }
        }
        deserializer.deserialize_any(ComponentsVisitor)
    }
}

impl JsonSchema for ComponentsWritten {
    fn schema_name() -> Cow<'static, str> {
        "Components".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = generator.subschema_for::<Written>();
        let axes = generator.subschema_for::<Axes>();
        json_schema!({ "anyOf": [axes, { "type": "array", "items": number, "minItems": 1, "maxItems": 3 }] })
    }
}

/// A bare value or a table.
#[derive(Debug, Clone)]
pub enum Or<A, T> {
    Bare(A),
    Table(T),
}

impl<'de, A: Deserialize<'de>, T: Deserialize<'de>> Deserialize<'de> for Or<A, T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OrVisitor<A, T>(PhantomData<(A, T)>);
        impl<'de, A: Deserialize<'de>, T: Deserialize<'de>> Visitor<'de> for OrVisitor<A, T> {
            type Value = Or<A, T>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a value or a table")
            }
            fn visit_seq<S: SeqAccess<'de>>(self, mut told: S) -> Result<Self::Value, S::Error> {
                match next::<S, usize>(&mut told)? {
                    0 => next(&mut told).map(Or::Bare),
                    _ => next(&mut told).map(Or::Table),
                }
            }
        }
        deserializer.deserialize_tuple_struct(OR, 2, OrVisitor(PhantomData))
    }
}

impl<A: JsonSchema, T: JsonSchema> JsonSchema for Or<A, T> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("{}Or{}", A::schema_name(), T::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (bare, table) = (
            generator.subschema_for::<A>(),
            generator.subschema_for::<T>(),
        );
        json_schema!({ "anyOf": [bare, table] })
    }
}

/// The schema of one or more things with names.
pub struct Named<T>(PhantomData<T>);

impl<T: JsonSchema> JsonSchema for Named<T> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        format!("Named{}", T::schema_name()).into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<T>();
        json_schema!({ "type": "object", "additionalProperties": one, "minProperties": 1 })
    }
}
