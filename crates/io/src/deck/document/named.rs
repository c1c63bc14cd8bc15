//! Laws of the shelf in a deck: their keys are those of their descriptors.

use super::Law;
use crate::deck::form;
use crate::deck::value::{At, Number, Written};
use peridyne::law::descriptor::{Descriptor, Key, Need, Value};
use peridyne::run::Shelf;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{StrDeserializer, StringDeserializer};
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error, MapAccess, VariantAccess,
    Visitor,
};
use serde_json::json;
use std::borrow::Cow;
use std::fmt;

/// Any law: one with keys of its own, or one of the shelf.
#[derive(Debug)]
pub struct AnyLaw(pub Law);

/// A law of the shelf as written.
#[derive(Debug)]
pub struct NamedLaw {
    pub name: String,
    pub given: Vec<(String, Given)>,
}

#[derive(Debug)]
pub enum Given {
    Number(Number),
    Rows(At<Vec<Vec<Number>>>),
    Word(At<String>),
}

impl<'de> Deserialize<'de> for AnyLaw {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct LawVisitor;
        impl<'de> Visitor<'de> for LawVisitor {
            type Value = AnyLaw;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a law such as { lps = { … } }")
            }
            fn visit_str<E: Error>(self, v: &str) -> Result<AnyLaw, E> {
                Law::deserialize(StrDeserializer::new(v)).map(AnyLaw)
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<AnyLaw, A::Error> {
                let Some(name) = map.next_key::<String>()? else {
                    return Err(A::Error::custom("a law has a name: { lps = { … } }"));
                };
                let shelf = Shelf::standard();
                let law = match shelf.descriptor(&name) {
                    Some(descriptor) => {
                        let given = map.next_value_seed(Constants(descriptor))?;
                        Law::Named(NamedLaw {
                            name: name.clone(),
                            given,
                        })
                    }
                    None if form::is_law(&name) => Law::deserialize(Tagged {
                        name: name.clone(),
                        map: &mut map,
                    })?,
                    None => {
                        let shelved = shelf.descriptors().map(|d| d.name.to_string());
                        let known = form::laws().map(str::to_string).chain(shelved);
                        let known: Vec<String> = known.map(|n| format!("`{n}`")).collect();
                        return Err(A::Error::custom(format!(
                            "unknown variant `{name}`, expected one of {}",
                            known.join(", ")
                        )));
                    }
                };
                match map.next_key::<String>()? {
                    None => Ok(AnyLaw(law)),
                    Some(more) => Err(A::Error::custom(format!(
                        "a material has one law, this has `{name}` and `{more}`"
                    ))),
                }
            }
        }
        deserializer.deserialize_any(LawVisitor)
    }
}

/// The constants of a law.
struct Constants<'a>(&'a Descriptor);

impl<'de> DeserializeSeed<'de> for Constants<'_> {
    type Value = Vec<(String, Given)>;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Constants<'_> {
    type Value = Vec<(String, Given)>;
    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "the constants of the law, {}", self.0.example)
    }
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut all: Vec<(String, Given)> = vec![];
        while let Some(name) = map.next_key::<String>()? {
            let Some(key) = self.0.key(&name) else {
                let known: Vec<String> = self
                    .0
                    .keys
                    .iter()
                    .map(|k| format!("`{}`", k.name))
                    .collect();
                return Err(A::Error::custom(format!(
                    "unknown field `{name}`, expected one of {}",
                    known.join(", ")
                )));
            };
            let given = match key.value {
                Value::Number(..) => Given::Number(map.next_value()?),
                Value::Rows(_) => Given::Rows(map.next_value()?),
                Value::Word(words) => {
                    let word: At<String> = map.next_value()?;
                    if !words.iter().any(|(w, _)| *w == word.value) {
                        let known: Vec<String> =
                            words.iter().map(|(w, _)| format!("`{w}`")).collect();
                        return Err(A::Error::custom(format!(
                            "unknown variant `{}`, expected one of {}",
                            word.value,
                            known.join(", ")
                        )));
                    }
                    Given::Word(word)
                }
            };
            all.push((name, given));
        }
        let missing = |k: &&Key| k.need == Need::Given && all.iter().all(|(n, _)| n != k.name);
        match self.0.keys.iter().find(missing) {
            None => Ok(all),
            Some(key) => Err(A::Error::custom(format!("missing field `{}`", key.name))),
        }
    }
}

/// A map of one entry as an enum.
struct Tagged<'a, A> {
    name: String,
    map: &'a mut A,
}

impl<'de, A: MapAccess<'de>> Deserializer<'de> for Tagged<'_, A> {
    type Error = A::Error;
    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, A::Error> {
        visitor.visit_enum(self)
    }
    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

impl<'de, 'a, A: MapAccess<'de>> EnumAccess<'de> for Tagged<'a, A> {
    type Error = A::Error;
    type Variant = Content<'a, A>;
    fn variant_seed<V: DeserializeSeed<'de>>(
        self,
        seed: V,
    ) -> Result<(V::Value, Content<'a, A>), A::Error> {
        let variant = seed.deserialize(StringDeserializer::new(self.name))?;
        Ok((variant, Content(self.map)))
    }
}

struct Content<'a, A>(&'a mut A);

impl<'de, A: MapAccess<'de>> VariantAccess<'de> for Content<'_, A> {
    type Error = A::Error;
    fn unit_variant(self) -> Result<(), A::Error> {
        Err(A::Error::custom(
            "this law has no constants: write its name alone",
        ))
    }
    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, A::Error> {
        self.0.next_value_seed(seed)
    }
    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, A::Error> {
        Err(A::Error::custom("the constants of a law are a table"))
    }
    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, A::Error> {
        Err(A::Error::custom("the constants of a law are a table"))
    }
}

impl JsonSchema for AnyLaw {
    fn schema_name() -> Cow<'static, str> {
        "Law".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = generator.subschema_for::<Written>();
        let mut schema = Law::json_schema(generator);
        let shelf = Shelf::standard();
        let laws = shelf.descriptors().map(|d| {
            let key = |k: &Key| {
                let mut value = match k.value {
                    Value::Number(..) => number.clone().to_value(),
                    Value::Rows(_) => json!({
                        "type": "array",
                        "items": { "type": "array", "items": number.clone().to_value() },
                    }),
                    Value::Word(words) => {
                        let words: Vec<&str> = words.iter().map(|(w, _)| *w).collect();
                        json!({ "type": "string", "enum": words })
                    }
                };
                value["description"] = json!(k.doc);
                (k.name.to_string(), value)
            };
            let needed = d.keys.iter().filter(|k| k.need == Need::Given);
            let needed: Vec<&str> = needed.map(|k| k.name).collect();
            let keys: serde_json::Map<String, serde_json::Value> = d.keys.iter().map(key).collect();
            json!({
                "type": "object",
                "description": format!("{} ({})", d.doc, d.source),
                "properties": { &*d.name: {
                    "type": "object",
                    "properties": keys,
                    "required": needed,
                    "additionalProperties": false,
                } },
                "required": [d.name],
                "additionalProperties": false,
            })
        });
        let laws: Vec<serde_json::Value> = laws.collect();
        if let Some(all) = schema
            .get_mut("oneOf")
            .and_then(serde_json::Value::as_array_mut)
        {
            all.extend(laws);
            return schema;
        }
        json_schema!({ "anyOf": laws })
    }
}
