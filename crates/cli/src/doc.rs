//! `peridyne doc`: what a key, a table, a law or a field of a deck means; and the same as pages of the guide.

mod book;

use crate::failure::{Failure, say};
use peridyne::observe::observables;
use peridyne_io::deck::reference::{Key, Page, pages};
use peridyne_io::deck::{Dim, UnitSystem, law_schema, named, schema};
use std::fmt::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct DocArguments {
    /// A key (`time_step` or `run.time_step`), a table (`material.fracture`), a law (`lps`) or a field (`stress`); without it all tables
    /// are listed.
    pub key: Option<String>,
    /// Write the deck reference of the guide, a page for each table, into this folder.
    #[arg(long, value_name = "FOLDER", conflicts_with = "key")]
    pub book: Option<PathBuf>,
    /// With --book: take examples from the decks in this folder.
    #[arg(long, value_name = "FOLDER", requires = "book")]
    pub decks: Option<PathBuf>,
}

/// The two kinds of deck, with what the top of each is called.
fn all() -> [(&'static str, Vec<Page>); 2] {
    [
        ("deck", pages(&schema())),
        ("conservation_law", pages(&law_schema())),
    ]
}

/// `[body]`, `[[probe]]`, `[sets.NAME]`.
fn header(top: &str, page: &Page) -> String {
    match page {
        p if p.path.is_empty() => format!("top of a {}", top.replace('_', " ")),
        p if p.named => format!("[{}.NAME]", p.path),
        p if p.repeated => format!("[[{}]]", p.path),
        p => format!("[{}]", p.path),
    }
}

/// A dimension with the units that plain numbers have.
fn measured(dimension: &str) -> String {
    let Some(dim) = named(dimension) else {
        return dimension.to_string();
    };
    let [si, metal] =
        [UnitSystem::Si, UnitSystem::Metal(Default::default())].map(|s| s.plain_unit(dim));
    match (dim == Dim::NUMBER, si == metal) {
        (true, _) => dimension.to_string(),
        (false, true) => format!("{dimension} ({si})"),
        (false, false) => format!("{dimension} ({si}; in metal {metal})"),
    }
}

/// What a key says of itself.
fn explain(top: &str, page: &Page, key: &Key) -> String {
    let place = match &*page.path {
        "" => key.name.clone(),
        path => format!("{path}.{}", key.name),
    };
    let mut text = format!("{place}    in {}\n  {}\n", header(top, page), key.doc);
    let mut line = |name: &str, said: &str| {
        if !said.is_empty() {
            let _ = writeln!(text, "  {name:<11}{said}");
        }
    };
    line("takes", &key.takes);
    line("measures", &measured(&key.dimension));
    line("bounds", &key.bounds);
    line(
        "left out",
        if key.must {
            "must be given"
        } else {
            &key.default
        },
    );
    line("", &key.need);
    for (word, said) in &key.words {
        line("", format!("\"{word}\"  {said}").trim_end());
    }
    for table in &key.tables {
        if *table != place {
            line("", &format!("keys as in {table}"));
        }
    }
    text
}

/// A table with its keys, one line for each.
fn list(top: &str, page: &Page) -> String {
    let mut text = format!("{}\n", header(top, page));
    for said in [&page.doc, &page.source] {
        if !said.is_empty() {
            let _ = writeln!(text, "  {said}");
        }
    }
    if !page.example.is_empty() {
        let _ = writeln!(text, "  example: {}", page.example);
    }
    if !page.also.is_empty() {
        let _ = writeln!(text, "  the same in: {}", page.also.join(", "));
    }
    if page.one_of {
        let _ = writeln!(text, "  one of these:");
    }
    for key in &page.keys {
        let must = if key.must { " (must be given)" } else { "" };
        let _ = writeln!(text, "  {:<17} {}{must}", key.name, key.doc);
    }
    text
}

pub fn doc(arguments: &DocArguments) -> Result<(), Failure> {
    let all = all();
    if let Some(folder) = &arguments.book {
        return book::write(folder, arguments.decks.as_deref(), &all);
    }
    let Some(asked) = &arguments.key else {
        let mut text =
            String::from("peridyne doc KEY explains a key, a table, a law or a field; tables:\n");
        for (top, pages) in &all {
            for page in pages {
                let first = page.doc.split(". ").next().unwrap_or_default();
                let _ = writeln!(text, "  {:<34}{first}", header(top, page));
            }
        }
        say(text.trim_end());
        return Ok(());
    };
    let found = find(&all, asked.trim_matches(['[', ']']));
    if found.is_empty() {
        return Err(Failure::input(unknown(&all, asked)));
    }
    say(found.join("\n").trim_end());
    Ok(())
}

/// Everything of this name: whole paths first, else what ends so.
fn find(all: &[(&str, Vec<Page>)], asked: &str) -> Vec<String> {
    let mut exact = vec![];
    let mut ending = vec![];
    for (top, pages) in all {
        for page in pages {
            if page.path == asked || (page.path.is_empty() && *top == asked) {
                exact.push(list(top, page));
            } else if page.path.ends_with(&format!(".{asked}")) {
                ending.push(list(top, page));
            }
            for key in &page.keys {
                let path = format!("{}.{}", page.path, key.name);
                let own = path.trim_start_matches('.');
                // a key that is nothing but a table has its page
                if key.takes == "a table" && pages.iter().any(|p| p.path == own) {
                    continue;
                }
                if own == asked {
                    exact.push(explain(top, page, key));
                } else if path.ends_with(&format!(".{asked}")) {
                    ending.push(explain(top, page, key));
                }
            }
        }
    }
    let fields = observables::ALL
        .iter()
        .filter(|o| o.declaration.name == asked);
    ending.extend(fields.map(|o| {
        let d = &o.declaration;
        format!(
            "{}    a field of points (output.fields), {}\n  {} {}\n",
            d.name, d.dimension, d.doc, o.equation
        )
    }));
    match exact.is_empty() {
        true => ending,
        false => exact,
    }
}

fn unknown(all: &[(&str, Vec<Page>)], asked: &str) -> String {
    let mut names: Vec<&str> = vec![];
    for (_, pages) in all {
        names.extend(pages.iter().map(|p| &*p.path));
        names.extend(pages.iter().flat_map(|p| &p.keys).map(|k| &*k.name));
    }
    names.extend(observables::ALL.iter().map(|o| &*o.declaration.name));
    let last = asked.rsplit('.').next().unwrap_or(asked);
    let near = names
        .iter()
        .map(|n| (strsim::damerau_levenshtein(last, n), n));
    match near.min() {
        Some((distance, near)) if distance <= 1 + last.len() / 4 => {
            format!("there is no `{asked}`; did you mean `{near}`?")
        }
        _ => format!(
            "there is no `{asked}`; `peridyne doc` lists the tables, `peridyne laws` laws and fields"
        ),
    }
}
