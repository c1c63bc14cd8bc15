//! JSON schema of the deck, for editors.

use super::document::Document;

/// JSON schema (2020-12) of a deck.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Document).to_value()
}
