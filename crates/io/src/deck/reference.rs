//! What every key of a deck means, read from its schema: pages for people.

use serde_json::{Map, Value as Json};

/// A table of the deck.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// Where it stands, `material.fracture`; empty: the deck itself.
    pub path: String,
    /// Where else.
    pub also: Vec<String>,
    /// Written as `[[path]]`, several times; as `[path.NAME]`.
    pub repeated: bool,
    pub named: bool,
    pub doc: String,
    /// Of laws.
    pub source: String,
    pub example: String,
    /// Is just one of its keys given?
    pub one_of: bool,
    pub keys: Vec<Key>,
}

/// A key of a table.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Key {
    pub name: String,
    pub doc: String,
    /// In words: `a number`, `a list of texts`.
    pub takes: String,
    /// What it measures, `a length`.
    pub dimension: String,
    /// `positive`, `from 0 to 7`.
    pub bounds: String,
    pub must: bool,
    /// Where other keys matter: `one of these is given`.
    pub need: String,
    /// When left out.
    pub default: String,
    /// Words that it takes, with their meaning.
    pub words: Vec<(String, String)>,
    /// Paths of the tables that it takes.
    pub tables: Vec<String>,
}

/// What a deck begins with; the rest follows by name. What stands in several tables is explained in the first of these.
const FIRST: [&str; 6] = ["kind", "title", "units", "body", "sets", "material"];

/// Pages of a [schema](super::schema()), the deck's own first.
pub fn pages(schema: &Json) -> Vec<Page> {
    let mut reader = Reader {
        defs: schema["$defs"].as_object().cloned().unwrap_or_default(),
        known: vec![],
        waiting: vec![],
        pages: vec![],
    };
    let deck = Place {
        path: String::new(),
        repeated: false,
        named: false,
    };
    reader.page(&deck, schema);
    // in the order in which they are met: what stands high comes first
    let mut next = 0;
    while next < reader.waiting.len() {
        let (place, table) = reader.waiting[next].clone();
        reader.page(&place, &table);
        next += 1;
    }
    reader.pages
}

/// Where a table stands, and how it is written.
#[derive(Debug, Clone)]
struct Place {
    path: String,
    repeated: bool,
    named: bool,
}

struct Reader {
    defs: Map<String, Json>,
    /// Names of definitions with the paths of their pages.
    known: Vec<(String, String)>,
    waiting: Vec<(Place, Json)>,
    pages: Vec<Page>,
}

/// Values that are written in more than one way and known by one name.
fn plain(definition: &str) -> Option<&'static str> {
    Some(match definition {
        "Number" => "a number",
        "Vector" => "a vector",
        "Components" => "components",
        _ => return None,
    })
}

fn text(json: &Json) -> String {
    let text = json.as_str().unwrap_or_default().replace('\n', " ");
    text.trim().to_string()
}

/// As it is written in a deck.
fn written(json: &Json) -> String {
    match json {
        Json::Null => String::new(),
        Json::String(word) => format!("\"{word}\""),
        other => other.to_string(),
    }
}

impl Reader {
    fn page(&mut self, place: &Place, table: &Json) {
        let mut page = Page {
            path: place.path.clone(),
            also: vec![],
            repeated: place.repeated,
            named: place.named,
            doc: text(&table["description"]),
            source: text(&table["source"]),
            example: text(&table["example"]),
            one_of: false,
            keys: vec![],
        };
        if let Some(forms) = table["oneOf"].as_array() {
            // words that stand alone, or a table with one key
            page.one_of = true;
            for form in forms {
                page.keys.extend(self.form(place, form));
            }
        } else {
            let required = table["required"].as_array();
            let must = |name: &str| required.is_some_and(|r| r.iter().any(|k| k == name));
            let mut keys: Vec<(&String, &Json)> = table["properties"]
                .as_object()
                .into_iter()
                .flatten()
                .collect();
            if place.path.is_empty() {
                let rank =
                    |name: &str| FIRST.iter().position(|f| *f == name).unwrap_or(FIRST.len());
                keys.sort_by_key(|(name, _)| rank(name));
            }
            for (name, value) in keys {
                let mut key = self.key(&page.path, name, value);
                key.must = must(name);
                page.keys.push(key);
            }
        }
        self.pages.push(page);
    }

    /// What one form of a table of forms says.
    fn form(&mut self, place: &Place, form: &Json) -> Vec<Key> {
        let doc = text(&form["description"]);
        if let Some(properties) = form["properties"].as_object() {
            let keys = properties.iter().map(|(name, value)| {
                let mut value = value.clone();
                for said in ["description", "source", "example"] {
                    if value.get(said).is_none() && form.get(said).is_some() {
                        value[said] = form[said].clone();
                    }
                }
                let mut key = self.key(&place.path, name, &value);
                key.doc = doc.clone();
                key
            });
            return keys.collect();
        }
        let words = form["enum"].as_array().map_or(&[][..], Vec::as_slice);
        let words = words.iter().chain(form.get("const"));
        words
            .filter_map(Json::as_str)
            .map(|word| Key {
                name: word.into(),
                doc: doc.clone(),
                takes: "the word alone".into(),
                ..Key::default()
            })
            .collect()
    }

    fn key(&mut self, path: &str, name: &str, value: &Json) -> Key {
        let mut key = Key {
            name: name.into(),
            doc: text(&value["description"]),
            dimension: text(&value["dimension"]),
            bounds: text(&value["bounds"]),
            need: text(&value["need"]),
            default: match &value["default"] {
                Json::Object(_) | Json::Array(_) => String::new(),
                other => written(other),
            },
            ..Key::default()
        };
        if let Some(words) = value["words"].as_array() {
            let pair = |w: &Json| (text(&w[0]), text(&w[1]));
            key.words = words.iter().map(pair).collect();
        }
        let place = Place {
            path: match path {
                "" => name.to_string(),
                path => format!("{path}.{name}"),
            },
            repeated: false,
            named: false,
        };
        let mut takes = vec![];
        self.takes(&place, value, &mut key, &mut takes);
        takes.dedup();
        key.takes = takes.join(", or ");
        if key.bounds.is_empty() && value["maximum"].is_number() {
            key.bounds = format!("{} to {}", value["minimum"], value["maximum"]);
        }
        key
    }

    /// Adds what a value may be.
    fn takes(&mut self, place: &Place, value: &Json, key: &mut Key, takes: &mut Vec<String>) {
        if let Some(name) = value["$ref"].as_str().and_then(|r| r.rsplit('/').next()) {
            let name = name.to_string();
            return self.definition(place, &name, key, takes);
        }
        let either = value.get("anyOf").or(value.get("oneOf"));
        if let Some(ways) = either.and_then(Json::as_array) {
            for way in ways.clone() {
                self.takes(place, &way, key, takes);
            }
            return;
        }
        if let Some(word) = value["const"].as_str() {
            key.words.push((word.into(), text(&value["description"])));
            return takes.push("a word".into());
        }
        if let Some(words) = value["enum"].as_array() {
            let new = words.iter().filter_map(Json::as_str);
            let new: Vec<&str> = new
                .filter(|w| key.words.iter().all(|k| k.0 != *w))
                .collect();
            key.words
                .extend(new.into_iter().map(|w| (w.to_string(), String::new())));
            return takes.push("a word".into());
        }
        let types = match &value["type"] {
            Json::Array(types) => types.clone(),
            one => vec![one.clone()],
        };
        for kind in types.iter().filter_map(Json::as_str) {
            match kind {
                "boolean" => takes.push("true or false".into()),
                "integer" => takes.push("a whole number".into()),
                "number" => takes.push("a number".into()),
                "string" => takes.push("a text".into()),
                "array" => self.list(place, value, key, takes),
                "object" => self.table(place, value, key, takes),
                _ => {}
            }
        }
    }

    fn definition(&mut self, place: &Place, name: &str, key: &mut Key, takes: &mut Vec<String>) {
        if let Some(plain) = plain(name) {
            return takes.push(plain.into());
        }
        let Some(table) = self.defs.get(name).cloned() else {
            return;
        };
        let ways = table["oneOf"].as_array();
        let has_table = |w: &Json| w.get("properties").is_some();
        if has_table(&table) || ways.is_some_and(|w| w.iter().any(has_table)) {
            takes.push("a table".into());
            let path = self.canonical(name, place, table);
            key.tables.push(path);
        } else {
            self.takes(place, &table, key, takes);
        }
    }

    /// The page of a definition, which is made where it is met first.
    fn canonical(&mut self, name: &str, place: &Place, table: Json) -> String {
        if let Some((_, path)) = self.known.iter().find(|(n, _)| n == name) {
            let path = path.clone();
            for page in &mut self.pages {
                if page.path == path && page.path != place.path && !page.also.contains(&place.path)
                {
                    page.also.push(place.path.clone());
                }
            }
            return path;
        }
        self.known.push((name.into(), place.path.clone()));
        self.waiting.push((place.clone(), table));
        place.path.clone()
    }

    fn list(&mut self, place: &Place, value: &Json, key: &mut Key, takes: &mut Vec<String>) {
        let inner = Place {
            repeated: true,
            ..place.clone()
        };
        let mut each = vec![];
        self.takes(&inner, &value["items"], key, &mut each);
        each.dedup();
        let count = match (value["minItems"].as_u64(), value["maxItems"].as_u64()) {
            (Some(least), Some(most)) if least == most => format!("a list of {least}, each "),
            _ => "a list, each ".into(),
        };
        takes.push(format!("{count}{}", each.join(", or ")));
    }

    fn table(&mut self, place: &Place, value: &Json, key: &mut Key, takes: &mut Vec<String>) {
        if value.get("properties").is_some() {
            takes.push("a table".into());
            key.tables.push(place.path.clone());
            return self.waiting.push((place.clone(), value.clone()));
        }
        let inner = Place {
            named: true,
            ..place.clone()
        };
        let mut each = vec![];
        self.takes(&inner, &value["additionalProperties"], key, &mut each);
        takes.push(format!("names, each {}", each.join(", or ")));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deck::{law_schema, schema};

    #[test]
    fn every_key_is_explained_and_every_number_measures_something() {
        let mut keys = 0;
        for schema in [schema(), law_schema()] {
            let pages = pages(&schema);
            for page in &pages {
                for key in &page.keys {
                    keys += 1;
                    let here = format!("{}.{}", page.path, key.name);
                    assert!(!key.doc.is_empty(), "{here} says nothing of itself");
                    assert!(!key.takes.is_empty(), "{here} takes nothing");
                    let numbers = ["a number", "a vector", "components"];
                    let number = numbers.iter().any(|n| key.takes.contains(n));
                    // names stand for numbers of any dimension, rows for several
                    let any = ["constants", "special"].contains(&&*key.name)
                        || key.takes.contains("each a list");
                    assert!(
                        !number || !key.dimension.is_empty() || any,
                        "{here} takes numbers of what dimension?"
                    );
                    for table in &key.tables {
                        let there = pages.iter().filter(|p| p.path == *table).count();
                        assert_eq!(there, 1, "{here} leads to {table}");
                    }
                }
            }
        }
        assert!(keys > 250, "{keys}");
    }

    /// What a key of a deck is on its page.
    fn check(table: &toml::Table, path: &str, pages: &[Page], met: &mut usize) {
        let Some(page) = pages
            .iter()
            .find(|p| p.path == path || p.also.iter().any(|a| a == path))
        else {
            panic!("no page for [{path}]");
        };
        for (name, value) in table {
            let key = page.keys.iter().find(|k| k.name == *name);
            let key = key.unwrap_or_else(|| panic!("[{path}] has no {name}"));
            *met += 1;
            let inner = match (&key.tables[..], value) {
                ([], _) => continue,
                (_, toml::Value::Table(inner)) => vec![inner],
                (_, toml::Value::Array(all)) => {
                    all.iter().filter_map(toml::Value::as_table).collect()
                }
                _ => continue,
            };
            for inner in inner {
                // a table of names, or the table itself
                let known = |p: &str| {
                    let page = pages.iter().find(|q| q.path == p);
                    page.is_some_and(|q| inner.keys().all(|n| q.keys.iter().any(|k| k.name == *n)))
                };
                match key.tables.iter().find(|p| known(p)) {
                    Some(path) => check(inner, path, pages, met),
                    None => {
                        for named in inner.values().filter_map(toml::Value::as_table) {
                            check(named, &key.tables[0], pages, met);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn every_key_of_the_good_decks_has_its_page() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
        let mut met = 0;
        for (folder, schema) in [
            (root.clone(), schema()),
            (root.join("conservation"), law_schema()),
        ] {
            let pages = pages(&schema);
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.extension().is_some_and(|e| e == "toml") {
                    let text = std::fs::read_to_string(path).unwrap();
                    check(&text.parse().unwrap(), "", &pages, &mut met);
                }
            }
        }
        assert!(met > 1000, "{met}");
    }
}
