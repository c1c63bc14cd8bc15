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
    /// When left out: as it is written, or in words.
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

/// What a key is, and what it is by default, where its description says so: `Range; 2 by default.` is `Range.` and `2`.
fn split_default(doc: &str) -> (String, String) {
    const MARK: &str = " by default";
    /// What is longer is an explanation.
    const LONGEST: usize = 70;
    let Some((before, after)) = doc.split_once(MARK) else {
        return (doc.into(), String::new());
    };
    let begin = ["; ", ". ", ": "]
        .iter()
        .filter_map(|end| before.rfind(end).map(|at| at + end.len()));
    let begin = begin.max().unwrap_or(0);
    let default = &before[begin..];
    // `; by default, …` is said after it
    let ends = after.is_empty() || after.starts_with(['.', ';', ',', ':']);
    if default.is_empty() || default.ends_with(';') || default.len() > LONGEST || !ends {
        return (doc.into(), String::new());
    }
    let kept = before[..begin].trim_end_matches([' ', ';']);
    // what is said of the default, or of all of it, stays with it
    let alone = !kept.ends_with(':') && !after.starts_with([',', ':']);
    let rest = match after.strip_prefix(';') {
        Some(rest) => sentence(rest.trim_start()),
        None => after.trim_start_matches(['.', ' ']).to_string(),
    };
    let doc = match (alone, kept.is_empty(), rest.is_empty()) {
        (false, ..) | (true, true, true) => doc.into(),
        (true, true, false) => rest,
        (true, false, true) => format!("{}.", kept.trim_end_matches('.')),
        (true, false, false) => format!("{}. {}", kept.trim_end_matches('.'), rest),
    };
    (doc, default.into())
}

/// With a great letter, where it does not begin with a word of decks.
fn sentence(text: &str) -> String {
    let word = text.split(' ').next().unwrap_or_default();
    let mut letters = text.chars();
    match letters.next() {
        Some(first) if word.chars().all(|c| c.is_ascii_lowercase()) => {
            first.to_uppercase().chain(letters).collect()
        }
        _ => text.into(),
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
        let (doc, said) = split_default(&text(&value["description"]));
        let default = match &value["default"] {
            Json::Object(_) | Json::Array(_) | Json::Null => said,
            other => written(other),
        };
        let mut key = Key {
            name: name.into(),
            doc,
            dimension: of_numbers(value, "dimension"),
            bounds: of_numbers(value, "bounds"),
            need: text(&value["need"]),
            default,
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
        key.tables.dedup();
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

/// What a schema says of its numbers, which may be those of a list or one of several forms.
fn of_numbers(schema: &Json, what: &str) -> String {
    let forms = schema["anyOf"].as_array().map_or(&[][..], Vec::as_slice);
    let mut each = forms.iter().chain(schema.get("items"));
    match &schema[what] {
        Json::String(said) => said.clone(),
        _ => (each.find_map(|form| Some(of_numbers(form, what)).filter(|s| !s.is_empty())))
            .unwrap_or_default(),
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

    #[test]
    fn defaults_are_told_apart() {
        let is = |doc: &str, key: &str, default: &str| {
            assert_eq!(split_default(doc), (key.into(), default.into()), "{doc}");
        };
        is(
            "Range in spacings; 1.35 by default.",
            "Range in spacings.",
            "1.35",
        );
        is("Range.", "Range.", "");
        is("constant by default.", "constant by default.", "constant");
        let doc = "All cores by default; results do not depend on it.";
        is(doc, "Results do not depend on it.", "All cores");
        let doc = "verlet by default. newmark and hht are implicit. still: nothing.";
        is(
            doc,
            "newmark and hht are implicit. still: nothing.",
            "verlet",
        );
        let doc = "newmark: 1/2 by default; more damps.";
        is(doc, doc, "1/2");
        let doc = "auto by default, factors of small systems.";
        is(doc, doc, "auto");
        let doc = "Its file; by default, that of the deck.";
        is(doc, doc, "");
        let doc = "The unit; the deck's by default. Densities are in it.";
        is(doc, "The unit. Densities are in it.", "the deck's");
    }

    /// Every table says what it is: a page without a sentence is a riddle.
    #[test]
    fn every_table_is_explained() {
        for schema in [schema(), law_schema()] {
            let silent: Vec<String> = { pages(&schema).into_iter() }
                .filter(|page| page.doc.is_empty())
                .map(|page| page.path)
                .collect();
            assert_eq!(silent, Vec::<String>::new());
        }
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

    /// A key that a table of a deck leaves out: its page, its name, its dotted path and its default as TOML.
    struct LeftOut {
        page: String,
        name: String,
        path: String,
        default: String,
    }

    /// The default of a key that could be written in a deck: a number, a switch, a word of those that it takes.
    fn literal(key: &Key) -> Option<String> {
        let default = &key.default;
        let plain = default.trim_matches('"').replace(',', "");
        let word = |c: char| c.is_ascii_lowercase() || c == '_';
        match (plain.parse::<f64>(), &*plain) {
            (Ok(_), _) | (_, "true" | "false") => Some(plain),
            // what takes any text has its default in prose
            _ if key.takes != "a text" && !plain.is_empty() && plain.chars().all(word) => {
                Some(format!("{plain:?}"))
            }
            _ => None,
        }
    }

    /// All keys with such defaults that a table leaves out, and those of its tables.
    fn left_out(table: &toml::Table, (page, path): (&str, &str), pages: &[Page]) -> Vec<LeftOut> {
        let Some(page) = pages.iter().find(|p| p.path == page) else {
            return vec![];
        };
        let dotted = |name: &str| match path {
            "" => name.to_string(),
            path => format!("{path}.{name}"),
        };
        let mut all = vec![];
        for key in &page.keys {
            // a law is handed what the deck has, and has the defaults in its descriptor
            if matches!(&*key.name, "law" | "force") {
                continue;
            }
            match (table.get(&key.name), literal(key)) {
                (None, Some(default)) => all.push(LeftOut {
                    page: page.path.clone(),
                    name: key.name.clone(),
                    path: dotted(&key.name),
                    default,
                }),
                (Some(toml::Value::Table(inner)), _) => {
                    for inside in &key.tables {
                        let there = dotted(&key.name);
                        all.extend(left_out(inner, (inside, &there), pages));
                    }
                }
                (Some(toml::Value::Array(each)), _) => {
                    let inside = each.iter().filter_map(toml::Value::as_table).enumerate();
                    for (n, inner) in inside {
                        let there = dotted(&format!("{}.{n}", key.name));
                        for page in &key.tables {
                            all.extend(left_out(inner, (page, &there), pages));
                        }
                    }
                }
                _ => {}
            }
        }
        all
    }

    /// A key that is written with its default is as one that is left out.
    #[test]
    fn defaults_are_true() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
        let pages = pages(&schema());
        let said = |deck: &crate::deck::Deck| {
            format!(
                "{:?}",
                (
                    &deck.spec,
                    &deck.output,
                    &deck.fields,
                    deck.threads,
                    deck.duration
                )
            )
        };
        let (mut met, mut wrong) = (std::collections::BTreeSet::new(), vec![]);
        let mut decks: Vec<_> = { std::fs::read_dir(folder).unwrap() }
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|e| e == "toml"))
            .collect();
        decks.sort();
        for path in decks {
            let text = std::fs::read_to_string(&path).unwrap();
            let name = path.display().to_string();
            let table: toml::Table = text.parse().unwrap();
            let mut plain = None;
            for key in left_out(&table, ("", ""), &pages) {
                if met.contains(&(key.page.clone(), key.name.clone())) {
                    continue;
                }
                let set = [(key.path.clone(), key.default.clone())];
                // a key of another method, or prose that looks like a word
                let Ok(with) = crate::deck::Deck::parse(&text, &name, &set) else {
                    continue;
                };
                let plain = plain.get_or_insert_with(|| {
                    said(&crate::deck::Deck::parse(&text, &name, &[]).unwrap())
                });
                if said(&with) != *plain {
                    wrong.push(format!("{name}: {} = {}", key.path, key.default));
                }
                met.insert((key.page, key.name));
            }
        }
        assert!(wrong.is_empty(), "{wrong:#?}");
        assert!(met.len() > 40, "{met:?}");
    }
}
