//! What a deck names of the registry, the law of a material or a force on points: a name, and its keys by its descriptor.

use crate::deck::value::{At, Number, Written};
use peridyne::columns::Dimension;
use peridyne::law::descriptor::{Descriptor, Key, Need, Value};
use peridyne::run::Registry;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error, MapAccess, Visitor};
use serde_json::json;
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// One of a list of the registry.
pub trait Listed {
    /// `"law"`, the key that takes it.
    const WHAT: &'static str;
    /// Who has one of them.
    const OF: &'static str;
    const SCHEMA: &'static str;
    /// What the list is, for its page.
    const DOC: &'static str;
    fn all(registry: &Registry) -> Vec<&Descriptor>;
}

#[derive(Debug)]
pub struct OfMaterials;

impl Listed for OfMaterials {
    const WHAT: &'static str = "law";
    const OF: &'static str = "a material";
    const SCHEMA: &'static str = "Law";
    const DOC: &'static str = "The law of a material, `law = { NAME = { … } }`: peridynamic solids, then potentials of atoms.";
    fn all(registry: &Registry) -> Vec<&Descriptor> {
        registry.descriptors().collect()
    }
}

#[derive(Debug)]
pub struct OnPoints;

impl Listed for OnPoints {
    const WHAT: &'static str = "force";
    const OF: &'static str = "a condition";
    const SCHEMA: &'static str = "Force";
    const DOC: &'static str = "A force on the points of the set, `force = { NAME = { … } }`.";
    fn all(registry: &Registry) -> Vec<&Descriptor> {
        registry.forces().collect()
    }
}

/// A law of a material as written.
pub type Law = OfShelf<OfMaterials>;
/// A force on points as written.
pub type Force = OfShelf<OnPoints>;

/// What is named of a list, with its constants.
#[derive(Debug)]
pub struct OfShelf<L> {
    pub name: String,
    pub given: Vec<(String, Given)>,
    list: PhantomData<L>,
}

#[derive(Debug)]
pub enum Given {
    Number(Number),
    List(At<Vec<Number>>),
    Rows(At<Vec<Vec<Number>>>),
    Word(At<String>),
}

impl<L: Listed> OfShelf<L> {
    fn new(name: &str, given: Vec<(String, Given)>) -> Self {
        OfShelf {
            name: name.into(),
            given,
            list: PhantomData,
        }
    }

    /// What the registry says of one of these names.
    pub fn descriptor<'a>(registry: &'a Registry, name: &str) -> Option<&'a Descriptor> {
        L::all(registry).into_iter().find(|d| d.name == name)
    }

    fn unknown<E: Error>(registry: &Registry, name: &str) -> E {
        let known = L::all(registry)
            .into_iter()
            .map(|d| format!("`{}`", d.name));
        let known: Vec<String> = known.collect();
        E::custom(format!(
            "unknown variant `{name}`, expected one of {}",
            known.join(", ")
        ))
    }

    /// The word that a key has.
    pub fn word(&self, key: &str) -> Option<&At<String>> {
        self.given.iter().find_map(|(name, given)| match given {
            Given::Word(word) if name == key => Some(word),
            _ => None,
        })
    }
}

/// A law without keys is its name alone.
fn plain(descriptor: &Descriptor) -> bool {
    descriptor.keys.is_empty()
}

impl<'de, L: Listed> Deserialize<'de> for OfShelf<L> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OfShelfVisitor<L>(PhantomData<L>);
        impl<'de, L: Listed> Visitor<'de> for OfShelfVisitor<L> {
            type Value = OfShelf<L>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                let registry = Registry::standard();
                let all = L::all(&registry);
                let name = all.iter().map(|d| &*d.name).find(|n| *n == "lps");
                let name = name.or(all.first().map(|d| &*d.name)).unwrap_or("name");
                write!(f, "a {} such as {{ {name} = {{ … }} }}", L::WHAT)
            }
            fn visit_str<E: Error>(self, name: &str) -> Result<OfShelf<L>, E> {
                let registry = Registry::standard();
                match OfShelf::<L>::descriptor(&registry, name) {
                    Some(descriptor) if plain(descriptor) => Ok(OfShelf::new(name, vec![])),
                    Some(_) => {
                        let what = L::WHAT;
                        Err(E::custom(format!("the {what} {name} needs its constants")))
                    }
                    None => Err(OfShelf::<L>::unknown(&registry, name)),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<OfShelf<L>, A::Error> {
                let what = L::WHAT;
                let Some(name) = map.next_key::<String>()? else {
                    let message = format!("a {what} has a name: {{ NAME = {{ … }} }}");
                    return Err(A::Error::custom(message));
                };
                let registry = Registry::standard();
                let given = match OfShelf::<L>::descriptor(&registry, &name) {
                    Some(descriptor) if plain(descriptor) => {
                        return Err(A::Error::custom(format!(
                            "this {what} has no constants: write its name alone"
                        )));
                    }
                    Some(descriptor) => map.next_value_seed(Constants(descriptor))?,
                    None => return Err(OfShelf::<L>::unknown(&registry, &name)),
                };
                match map.next_key::<String>()? {
                    None => Ok(OfShelf::new(&name, given)),
                    Some(more) => Err(A::Error::custom(format!(
                        "{} has one {what}, this has `{name}` and `{more}`",
                        L::OF
                    ))),
                }
            }
        }
        deserializer.deserialize_any(OfShelfVisitor(PhantomData))
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
        write!(f, "its constants, {}", self.0.example)
    }
    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut all: Vec<(String, Given)> = vec![];
        while let Some(name) = map.next_key::<String>()? {
            let Some(key) = self.0.key(&name) else {
                let known: Vec<String> = self.0.taken().map(|k| format!("`{}`", k.name)).collect();
                return Err(A::Error::custom(format!(
                    "unknown field `{name}`, expected one of {}",
                    known.join(", ")
                )));
            };
            if key.need == Need::Refused {
                return Err(A::Error::custom(format!("{} {}", self.0.name, key.doc)));
            }
            let given = match key.value {
                Value::Number(..) => Given::Number(map.next_value()?),
                Value::List(..) | Value::Direction => Given::List(map.next_value()?),
                Value::Rows(_) => Given::Rows(map.next_value()?),
                Value::Name | Value::Formula(..) | Value::Table | Value::Entries(_) => {
                    Given::Word(map.next_value()?)
                }
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

impl<L: Listed> JsonSchema for OfShelf<L> {
    fn schema_name() -> Cow<'static, str> {
        L::SCHEMA.into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = generator.subschema_for::<Written>();
        let registry = Registry::standard();
        let laws = L::all(&registry).into_iter().map(|d| {
            let description = d.doc.trim();
            if plain(d) {
                let source = &d.source;
                return json!({ "type": "string", "const": d.name, "description": description, "source": source });
            }
            let key = |k: &Key| {
                let mut value = match k.value {
                    Value::Number(..) => number.clone().to_value(),
                    Value::List(..) | Value::Direction => json!({
                        "type": "array",
                        "items": number.clone().to_value(),
                    }),
                    Value::Rows(_) => json!({
                        "type": "array",
                        "items": { "type": "array", "items": number.clone().to_value() },
                    }),
                    Value::Word(words) => {
                        let words: Vec<&str> = words.iter().map(|(w, _)| *w).collect();
                        json!({ "type": "string", "enum": words })
                    }
                    Value::Name | Value::Formula(..) | Value::Table | Value::Entries(_) => {
                        json!({ "type": "string" })
                    }
                };
                value["description"] = json!(k.doc);
                let (dimension, bounds) = match k.value {
                    Value::Number(d, b) | Value::List(_, d, b) => (Some(d), b.words()),
                    Value::Formula(variables, d) => {
                        (d, format!("an expression of {}", variables.join(", ")))
                    }
                    Value::Direction => (
                        Some(Dimension::NUMBER),
                        "three, numbers or expressions of x, y, z".into(),
                    ),
                    Value::Rows(_) | Value::Word(_) | Value::Name => (None, String::new()),
                    Value::Table | Value::Entries(_) => (None, String::new()),
                };
                if let Some(dimension) = dimension {
                    value["dimension"] = json!(dimension.to_string());
                }
                if dimension.is_some() || !bounds.is_empty() {
                    value["bounds"] = json!(bounds);
                }
                if let Value::Word(words) = k.value {
                    value["words"] = json!(words);
                }
                match k.need {
                    Need::Default(x) => value["default"] = json!(x),
                    Need::Word(word) => value["default"] = json!(word),
                    Need::OneOf => value["need"] = json!("one of these is given"),
                    Need::TwoOf => value["need"] = json!("two of these are given"),
                    Need::Given | Need::Optional | Need::Refused => {}
                }
                (k.name.to_string(), value)
            };
            let needed = d.keys.iter().filter(|k| k.need == Need::Given);
            let needed: Vec<&str> = needed.map(|k| k.name).collect();
            let keys: serde_json::Map<String, serde_json::Value> = d.taken().map(key).collect();
            json!({
                "type": "object",
                "description": description,
                "source": d.source,
                "example": d.example,
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
        json_schema!({ "description": L::DOC, "oneOf": laws })
    }
}
