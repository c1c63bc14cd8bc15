//! JSON schema of the deck, for editors.

use super::conservation::LawDocument;
use super::document::Document;

/// JSON schema (2020-12) of a deck.
///
/// It knows the form: keys, types, names, and how many of a list. What keys mean together (one of young and bulk), units and
/// expressions are known to the reader only.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Document).to_value()
}

/// JSON schema of a deck of a conservation law.
pub fn law_schema() -> serde_json::Value {
    schemars::schema_for!(LawDocument).to_value()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deck::source::Source;
    use crate::deck::{locate, reader};
    use serde_json::{Value, json};
    use std::path::{Path, PathBuf};

    /// Decks of a folder that are TOML, as JSON.
    fn decks(folder: &str) -> Vec<(PathBuf, Value)> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../..")
            .join(folder);
        let mut decks = Vec::new();
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                continue;
            }
            let deck = std::fs::read_to_string(&path)
                .ok()
                .filter(|_| path.extension().is_some_and(|e| e == "toml"))
                .and_then(|text| text.parse::<toml::Table>().ok());
            if let Some(deck) = deck {
                decks.push((path, value(&toml::Value::Table(deck))));
            }
        }
        decks.sort_by(|a, b| a.0.cmp(&b.0));
        decks
    }

    fn value(toml: &toml::Value) -> Value {
        match toml {
            // JSON has no infinity
            toml::Value::Float(x) if !x.is_finite() => json!(1e300),
            // nor a difference between 10000.0 and 10000, which TOML makes
            toml::Value::Float(x) if x.fract() == 0.0 => json!(x + 0.25),
            toml::Value::Array(items) => items.iter().map(value).collect(),
            toml::Value::Table(table) => {
                let pairs = table.iter().map(|(k, v)| (k.clone(), value(v)));
                Value::Object(pairs.collect())
            }
            other => serde_json::to_value(other).unwrap(),
        }
    }

    /// Whether the reader takes the form of a deck: keys and types.
    fn read(deck: &Value) -> bool {
        let text = toml::to_string(deck).unwrap();
        let source = Source::new(&text, "deck.toml", &[]);
        let mut tree = source.tree().unwrap();
        locate::name_material(tree.get_mut());
        locate::first_body(tree.get_mut());
        reader::read::<Document>(&source, &tree).is_ok()
    }

    /// All decks with one fault: an unknown key in a table, a value of another type, a key left out.
    fn faults(deck: &Value) -> Vec<Value> {
        fn visit(here: &Value, put: &mut dyn FnMut(Value)) {
            match here {
                Value::Object(table) => {
                    let mut more = table.clone();
                    more.insert("zzz".into(), json!(1));
                    put(Value::Object(more));
                    for (key, inner) in table {
                        let mut less = table.clone();
                        less.remove(key);
                        put(Value::Object(less));
                        visit(inner, &mut |new| {
                            let mut other = table.clone();
                            other.insert(key.clone(), new);
                            put(Value::Object(other));
                        });
                    }
                }
                Value::Array(items) => {
                    for (k, inner) in items.iter().enumerate() {
                        visit(inner, &mut |new| {
                            let mut other = items.clone();
                            other[k] = new;
                            put(Value::Array(other));
                        });
                    }
                    // an item more, and one less
                    let last = items.last().cloned();
                    put({ items.iter().cloned() }.chain(last).collect());
                    put(items.iter().skip(1).cloned().collect());
                    put(json!(1.5));
                }
                _ => {}
            }
            for new in [
                json!(true),
                json!(-1),
                json!("zzz"),
                json!({ "zzz": 1 }),
                json!([[true]]),
            ] {
                put(new);
            }
        }
        let mut all = Vec::new();
        visit(deck, &mut |new| {
            if new.is_object() {
                all.push(new);
            }
        });
        all
    }

    /// Good decks of a folder pass their schema, faults of form do not, and neither do bad decks that are not read.
    fn compare(
        schema: &Value,
        good: &str,
        bad: &[&str],
        read: impl Fn(&Value) -> bool,
    ) -> (usize, usize) {
        assert!(jsonschema::meta::is_valid(schema));
        let validator = jsonschema::validator_for(schema).unwrap();
        let (mut wrong, mut refused) = (Vec::new(), 0);
        let good = decks(good);
        for (path, deck) in &good {
            if let Some(error) = validator.iter_errors(deck).next() {
                wrong.push(format!("{}: {error}", path.display()));
            }
            for fault in faults(deck) {
                if read(&fault) != validator.is_valid(&fault) {
                    let what = if read(&fault) { "refused" } else { "passed" };
                    wrong.push(format!("{} {what}: {fault}", path.display()));
                }
                refused += usize::from(!read(&fault));
            }
        }
        for folder in bad {
            for (path, deck) in decks(folder) {
                if !read(&deck) && validator.is_valid(&deck) {
                    wrong.push(format!("{} passed", path.display()));
                }
            }
        }
        assert!(
            wrong.is_empty(),
            "{}:\n{}",
            wrong.len(),
            wrong[..wrong.len().min(12)].join("\n")
        );
        (good.len(), refused)
    }

    #[test]
    fn decks_of_laws_pass_and_faults_of_form_do_not() {
        let read = |deck: &Value| {
            let text = toml::to_string(deck).unwrap();
            let source = Source::new(&text, "deck.toml", &[]);
            let tree = source.tree().unwrap();
            reader::read::<LawDocument>(&source, &tree).is_ok()
        };
        let good = "decks/good/conservation";
        let (decks, refused) = compare(&law_schema(), good, &["decks/bad/conservation"], read);
        assert!(decks >= 5 && refused > 500, "{decks} {refused}");
    }

    #[test]
    fn good_decks_pass_and_faults_of_form_do_not() {
        let bad = ["decks/bad", "decks/bad/build"];
        let (decks, refused) = compare(&schema(), "decks/good", &bad, read);
        assert!(decks >= 23);
        assert!(refused > 2000, "{refused}");
    }
}
