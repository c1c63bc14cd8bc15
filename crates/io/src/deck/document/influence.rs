//! `influence`: a word or an expression.

use super::names::InfluenceName;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::StrDeserializer;
use serde::de::{Deserialize, Deserializer};
use std::borrow::Cow;

/// An influence function: one with a name, or an expression.
#[derive(Debug, Clone)]
pub enum InfluenceWritten {
    Named(InfluenceName),
    Formula(String),
}

impl<'de> Deserialize<'de> for InfluenceWritten {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let word = StrDeserializer::<D::Error>::new(&text);
        Ok(match InfluenceName::deserialize(word) {
            Ok(name) => InfluenceWritten::Named(name),
            Err(_) => InfluenceWritten::Formula(text),
        })
    }
}

impl JsonSchema for InfluenceWritten {
    fn schema_name() -> Cow<'static, str> {
        "Influence".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let names = generator.subschema_for::<InfluenceName>();
        json_schema!({
            "description": "An influence function by its name, or an expression of r = |ξ|, the horizon delta and, of directions, the components xi_x, xi_y, xi_z of ξ: \"r^-2\", \"r*(1 - r/delta)\". It is 0 or positive on every bond. One that knows directions weighs a bond of lps, and of other laws that a family normalises, by ω(ξ) at one end and by ω(−ξ) at the other, and a bond of all other laws by the mean of both.",
            "anyOf": [names, { "type": "string" }]
        })
    }
}
