//! Values of a deck that remember where they stand.

use super::quantity::{Measure, Pure};
use super::reader::{AT, OR};
use peridyne::law::descriptor::Bounds;
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

/// Where something stands that may be left out.
pub fn span<T>(at: &Option<At<T>>) -> Option<Range<usize>> {
    at.as_ref().map(|at| at.span.clone())
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

/// A number as written, of a measure.
#[derive(Debug)]
pub struct Measured<K> {
    pub written: Written,
    measure: PhantomData<K>,
}

impl<K> Clone for Measured<K> {
    fn clone(&self) -> Self {
        Measured {
            written: self.written.clone(),
            measure: PhantomData,
        }
    }
}

/// A number of a measure, and its place.
pub type Quantity<K = Pure> = At<Measured<K>>;

impl<K> Quantity<K> {
    /// The number alone.
    pub fn number(&self) -> Number {
        At {
            value: self.value.written.clone(),
            span: self.span.clone(),
        }
    }
}

impl<K> From<Number> for Quantity<K> {
    fn from(number: Number) -> Self {
        let value = Measured {
            written: number.value,
            measure: PhantomData,
        };
        At {
            value,
            span: number.span,
        }
    }
}

impl<'de, K> Deserialize<'de> for Measured<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Measured {
            written: Written::deserialize(deserializer)?,
            measure: PhantomData,
        })
    }
}

/// The schema of a form whose numbers are of a measure.
fn of<K: Measure>(mut form: Schema) -> Schema {
    form.insert("dimension".into(), K::DIM.to_string().into());
    if K::BOUNDS != Bounds::ANY {
        form.insert("bounds".into(), K::BOUNDS.words().into());
    }
    form
}

impl<K: Measure> JsonSchema for Measured<K> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "Measured".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        of::<K>(generator.subschema_for::<Written>())
    }
}

/// One to three components.
fn list<'de, K, A: SeqAccess<'de>>(mut seq: A) -> Result<Vec<Quantity<K>>, A::Error> {
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
pub type Vector<K = Pure> = At<Numbers<K>>;

#[derive(Debug, Clone)]
pub struct Numbers<K>(pub Vec<Quantity<K>>);

impl<K> Numbers<K> {
    /// Of one component; where it stands is where the vector does.
    fn one(written: Written) -> Self {
        let value = Measured {
            written,
            measure: PhantomData,
        };
        Numbers(vec![At { value, span: 0..0 }])
    }
}

impl<'de, K> Deserialize<'de> for Numbers<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumbersVisitor<K>(PhantomData<K>);
        impl<'de, K> Visitor<'de> for NumbersVisitor<K> {
            type Value = Numbers<K>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a list of numbers such as [0, \"0.5 mm\"]")
            }
            fn visit_i64<E: Error>(self, v: i64) -> Result<Self::Value, E> {
                Ok(Numbers::one(Written::Plain(v as f64)))
            }
            fn visit_f64<E: Error>(self, v: f64) -> Result<Self::Value, E> {
                Ok(Numbers::one(Written::Plain(v)))
            }
            fn visit_str<E: Error>(self, v: &str) -> Result<Self::Value, E> {
                Ok(Numbers::one(Written::Text(v.to_string())))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                list(seq).map(Numbers)
            }
        }
        deserializer.deserialize_any(NumbersVisitor(PhantomData))
    }
}

/// The schema of a list of components, or of another form.
fn components(generator: &mut SchemaGenerator, other: Schema) -> Schema {
    let number = generator.subschema_for::<Written>();
    json_schema!({ "anyOf": [other, { "type": "array", "items": number, "minItems": 1, "maxItems": 3 }] })
}

/// A number in 1-D, or a list of components.
struct VectorForm;

impl JsonSchema for VectorForm {
    fn schema_name() -> Cow<'static, str> {
        "Vector".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = generator.subschema_for::<Written>();
        components(generator, number)
    }
}

impl<K: Measure> JsonSchema for Numbers<K> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "Numbers".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        of::<K>(generator.subschema_for::<VectorForm>())
    }
}

/// Components: a list as long as the dimension (`"free"` leaves one alone), or a table of some of x, y, z.
pub type Components<K> = At<ComponentsWritten<K>>;

#[derive(Debug, Clone)]
pub enum ComponentsWritten<K> {
    List(Vec<Quantity<K>>),
    Axes([Option<Quantity<K>>; 3]),
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields, bound = "")]
struct Axes<K> {
    x: Option<Quantity<K>>,
    y: Option<Quantity<K>>,
    z: Option<Quantity<K>>,
}

impl<'de, K> Deserialize<'de> for ComponentsWritten<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ComponentsVisitor<K>(PhantomData<K>);
        impl<'de, K> Visitor<'de> for ComponentsVisitor<K> {
            type Value = ComponentsWritten<K>;
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
        deserializer.deserialize_any(ComponentsVisitor(PhantomData))
    }
}

/// A table of axes, or a list of components.
struct ComponentsForm;

impl JsonSchema for ComponentsForm {
    fn schema_name() -> Cow<'static, str> {
        "Components".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = generator.subschema_for::<Written>();
        let axes = json_schema!({
            "type": "object",
            "properties": { "x": number, "y": number, "z": number },
            "additionalProperties": false
        });
        components(generator, axes)
    }
}

impl<K: Measure> JsonSchema for ComponentsWritten<K> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "ComponentsWritten".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        of::<K>(generator.subschema_for::<ComponentsForm>())
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
