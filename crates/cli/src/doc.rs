//! `peridyne doc`: what a key, a table, a law or a field of a deck means; and the same as pages of the guide.

mod book;

use crate::failure::{Failure, say};
use crate::keys::{all, measured, paths};
use crate::laws::one;
use crate::pager::Paged;
use peridyne::observe::observables;
use peridyne::run::Registry;
use peridyne_io::deck::reference::{Key, Page};
use peridyne_io::deck::renamed;
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
    /// Print all keys as `--set` takes them, one a line; completions of shells read them.
    #[arg(long, conflicts_with_all = ["key", "book"])]
    pub keys: bool,
    #[command(flatten)]
    pub paged: Paged,
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
        "default",
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
    if arguments.keys {
        say(&paths().join("\n"));
        return Ok(());
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
        arguments.paged.show(&text);
        return Ok(());
    };
    explained(asked, arguments.paged)
}

/// Prints what is known of a name.
///
/// # Errors
/// There is nothing of this name.
pub fn explained(asked: &str, paged: Paged) -> Result<(), Failure> {
    let asked = asked.trim_matches(['[', ']']);
    let mut found = find(&all(), asked);
    if found.is_empty()
        && let Some(new) = renamed(asked)
    {
        found = find(&all(), &new);
        found.insert(0, format!("`{asked}` is called `{new}` now\n"));
    }
    if found.is_empty() {
        return Err(Failure::input(unknown(asked)));
    }
    paged.show(&found.join("\n"));
    Ok(())
}

/// Everything of this name: whole paths first, else what ends so.
fn find(all: &[(&str, Vec<Page>)], asked: &str) -> Vec<String> {
    let mut exact = vec![];
    let mut ending = vec![];
    let registry = Registry::standard();
    for (top, pages) in all {
        for page in pages {
            // a law says more of itself
            let law = || page.path.rsplit('.').next().unwrap_or_default();
            let law = one::named(&registry, law()).into_iter();
            let law = { law }.find(|(place, d)| page.path == format!("{place}.{}", d.name));
            let list = || match law {
                Some((place, law)) => one::told(place, law, &registry),
                None => list(top, page),
            };
            if page.path == asked || (page.path.is_empty() && *top == asked) {
                exact.push(list());
            } else if page.path.ends_with(&format!(".{asked}")) {
                ending.push(list());
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

/// There is nothing of this name.
pub fn unknown(asked: &str) -> String {
    let all = all();
    let mut names: Vec<&str> = vec![];
    for (_, pages) in &all {
        names.extend(pages.iter().map(|p| &*p.path));
        names.extend(pages.iter().flat_map(|p| &p.keys).map(|k| &*k.name));
    }
    let registry = Registry::standard();
    let laws = registry.descriptors().chain(registry.forces());
    names.extend(laws.map(|d| &*d.name));
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
