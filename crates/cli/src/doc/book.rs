//! The deck reference as pages of the guide, in Markdown.

use super::header;
use crate::failure::{Failure, say};
use crate::keys::measured;
use peridyne::observe::observables;
use peridyne::space::lattice::LatticeKind;
use peridyne_io::deck::reference::{Key, Page};
use peridyne_io::deck::{UnitSystem, example, known, usual};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// Longest example that is shown in a row.
const LONGEST: usize = 90;

/// Where keys of the decks are used: path → deck and value.
type Examples = BTreeMap<String, (String, String)>;

pub fn write(
    folder: &Path,
    decks: Option<&Path>,
    all: &[(&str, Vec<Page>)],
) -> Result<(), Failure> {
    let failed =
        |e: std::io::Error| Failure::Run(format!("{} cannot be written: {e}", folder.display()));
    std::fs::create_dir_all(folder).map_err(failed)?;
    let mut index = String::from(
        "# Deck reference\n\nMade by `peridyne doc --book` from the program's own descriptions of its keys; `peridyne doc KEY` prints one of them, \
         `peridyne schema` the JSON schema for editors. Units of plain numbers: [units](units.md); fields of points: [fields](fields_of_points.md).\n",
    );
    let mut count = 3;
    for (top, pages) in all {
        let examples = decks.map_or_else(Examples::new, |d| examples(d, top, pages));
        for page in pages {
            let mut text = text(top, page, pages, &examples);
            if (*top, &*page.path) == ("deck", "units") {
                text.push_str(&units());
            }
            std::fs::write(folder.join(file(top, page)), text).map_err(failed)?;
            count += 1;
        }
    }
    for group in GROUPS {
        let _ = write!(index, "\n## {group}\n\n| table | what it is |\n|---|---|\n");
        let every = { all.iter() }.flat_map(|(top, pages)| pages.iter().map(move |p| (*top, p)));
        let mut here: Vec<(&str, &Page)> = every
            .filter(|(top, page)| self::group(top, page) == group)
            .collect();
        // laws as their list has them
        if group != LAWS {
            here.sort_by_key(|(_, page)| &page.path);
        }
        for (top, page) in here {
            let first = page.doc.split(". ").next().unwrap_or_default();
            let _ = writeln!(
                index,
                "| [`{}`]({}) | {} |",
                header(top, page),
                file(top, page),
                cell(first.trim_end_matches('.'))
            );
        }
        let lists: &[(&str, &str)] = match group {
            BODY => &[("Lattices", "lattices.md")],
            OUTPUT => &[("Fields of points", "fields_of_points.md")],
            _ => &[],
        };
        for (name, file) in lists {
            let _ = writeln!(index, "| [{name}]({file}) | Their names |");
        }
    }
    std::fs::write(folder.join("index.md"), index).map_err(failed)?;
    std::fs::write(folder.join("fields_of_points.md"), fields()).map_err(failed)?;
    std::fs::write(folder.join("lattices.md"), lattices()).map_err(failed)?;
    say(&format!("wrote {count} pages to {}", folder.display()));
    Ok(())
}

const BODY: &str = "Body";
const LAWS: &str = "Laws of solids and fluids";
const OUTPUT: &str = "Output and measurement";
const CONSERVATION: &str = "Conservation laws";
/// What the index and the guide's menu are divided into.
const GROUPS: [&str; 9] = [
    "Deck and units",
    BODY,
    "Material and fracture",
    LAWS,
    "Loads, contact, initial cracks",
    "Run: motion and statics",
    OUTPUT,
    "Atoms",
    CONSERVATION,
];

/// Where a page belongs; a table that is new and named nowhere here is the deck's.
fn group(top: &str, page: &Page) -> &'static str {
    if top != "deck" {
        return CONSERVATION;
    }
    if page.doc.starts_with("Atoms:") {
        return "Atoms";
    }
    match page.path.split('.').next().unwrap_or_default() {
        "body" | "sets" | "horizon" | "periodic" | "bond_stiffness" | "interface" => BODY,
        "material" if page.path.starts_with("material.law.") => LAWS,
        "material" | "toughness" | "healing" => "Material and fracture",
        "boundary_condition" | "initial" | "rigid_body" | "contact" | "precrack" | "heat"
        | "species" => "Loads, contact, initial cracks",
        "run" | "statics" => "Run: motion and statics",
        "output" | "probe" | "fields" => OUTPUT,
        "pair" | "molecules" | "smooth" | "initial_velocities" => "Atoms",
        _ => "Deck and units",
    }
}

/// `material.fracture.md`; pages of laws keep apart from those of bodies.
fn file(top: &str, page: &Page) -> String {
    match (top, &*page.path) {
        (top, "") => format!("{top}.md"),
        ("deck", path) => format!("{path}.md"),
        (top, path) => format!("{top}.{path}.md"),
    }
}

/// Text in a table: bars would end it, and angles begin a tag.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
        .replace('<', "&lt;")
        .replace('\n', " ")
}

/// Code in a table: all but bars stands as it is.
fn code(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

fn text(top: &str, page: &Page, pages: &[Page], examples: &Examples) -> String {
    let mut text = format!("# `{}`\n\n", header(top, page));
    for said in [&page.doc, &page.source] {
        if !said.is_empty() {
            let _ = write!(text, "{}\n\n", said.replace('<', "&lt;"));
        }
    }
    if !page.example.is_empty() {
        let name = page.path.rsplit('.').next().unwrap_or_default();
        let _ = write!(
            text,
            "```toml\nlaw = {{ {name} = {} }}\n```\n\n",
            page.example
        );
    }
    if !page.also.is_empty() {
        let also: Vec<String> = page.also.iter().map(|a| format!("`{a}`")).collect();
        let _ = write!(text, "The same stands in {}.\n\n", also.join(", "));
    }
    if page.one_of {
        text.push_str("One of these is given.\n\n");
    }
    text.push_str("| key | meaning | takes | default |\n|---|---|---|---|\n");
    for key in &page.keys {
        let _ = writeln!(text, "{}", row(top, page, key, pages, examples));
    }
    text
}

fn row(top: &str, page: &Page, key: &Key, pages: &[Page], examples: &Examples) -> String {
    let place = match &*page.path {
        "" => key.name.clone(),
        path => format!("{path}.{}", key.name),
    };
    let mut what = cell(&key.doc);
    if !key.words.is_empty() {
        what.push_str("<ul>");
        for (word, said) in &key.words {
            let colon = if said.is_empty() { "" } else { ": " };
            let _ = write!(what, "<li>`{word}`{colon}{}</li>", cell(said));
        }
        what.push_str("</ul>");
    }
    if let Some((deck, value)) = examples.get(&place) {
        let _ = write!(
            what,
            "{}Example: `{} = {}` ({deck})",
            if key.words.is_empty() { "<br>" } else { "" },
            key.name,
            code(value)
        );
    }
    let mut takes = cell(&key.takes);
    for table in &key.tables {
        if let Some(page) = pages.iter().find(|p| p.path == *table) {
            let _ = write!(takes, " [`{}`]({})", header(top, page), file(top, page));
        }
    }
    let dimension = match &*key.dimension {
        "a plain number" => String::new(),
        dimension => measured(dimension),
    };
    for (before, said) in [(": ", &dimension), (", ", &key.bounds)] {
        if !said.is_empty() {
            let _ = write!(takes, "{before}{}", cell(said));
        }
    }
    let default = match (key.must, &*key.default) {
        (true, _) => "*required*".to_string(),
        (false, "") => cell(&key.need),
        // words, or what would be written
        (false, default)
            if default.contains([' ', ',']) && !default.starts_with(['"', '{', '[']) =>
        {
            cell(default)
        }
        (false, default) => format!("`{}`", code(default)),
    };
    format!(
        "| <a id=\"{name}\"></a>`{name}` | {what} | {takes} | {default} |",
        name = key.name
    )
}

/// First uses of keys in decks, in order of their names; short values only.
fn examples(folder: &Path, top: &str, pages: &[Page]) -> Examples {
    let inside = match top {
        "deck" => folder.to_path_buf(),
        _ => folder.join("conservation"),
    };
    let mut files: Vec<_> = std::fs::read_dir(inside)
        .map(|all| all.filter_map(|e| e.ok().map(|e| e.path())).collect())
        .unwrap_or_default();
    files.sort();
    let mut examples = Examples::new();
    for file in files {
        let deck = std::fs::read_to_string(&file).ok();
        let table = deck.and_then(|text| text.parse::<toml::Table>().ok());
        if let (Some(table), Some(name)) = (table, file.file_name()) {
            gather(&table, "", &name.to_string_lossy(), pages, &mut examples);
        }
    }
    examples
}

fn gather(table: &toml::Table, path: &str, deck: &str, pages: &[Page], examples: &mut Examples) {
    let Some(page) = pages.iter().find(|p| p.path == path) else {
        return;
    };
    for (name, value) in table {
        let Some(key) = page.keys.iter().find(|k| k.name == *name) else {
            continue;
        };
        let place = match path {
            "" => name.clone(),
            path => format!("{path}.{name}"),
        };
        let shown = value.to_string();
        if shown.len() <= LONGEST && !shown.contains('\n') {
            examples.entry(place).or_insert((deck.into(), shown));
        }
        let inner: Vec<&toml::Table> = match value {
            toml::Value::Table(inner) => vec![inner],
            toml::Value::Array(all) => all.iter().filter_map(toml::Value::as_table).collect(),
            _ => vec![],
        };
        for inner in inner {
            for table in &key.tables {
                gather(inner, table, deck, pages, examples);
                // names, each with a table
                for named in inner.values().filter_map(toml::Value::as_table) {
                    gather(named, table, deck, pages, examples);
                }
            }
        }
    }
}

fn units() -> String {
    let mut text = format!(
        "\n## Units of numbers\n\nA number without unit is in the unit of its system (`units`); with one (`\"0.5 mm\"`) it is converted, and its dimension checked. \
         Known are {}. Products, quotients and powers: `\"7800 kg/m^3\"`, `\"45 W/(m K)\"`, `\"12e-6 1/K\"`; each `/` divides by what follows it. \
         In `lj` and `none` numbers carry no unit.\n\n\
         `\"20 degC\"` (also °C) is 293.15 K where it is the whole of a temperature; expressions, constants and differences are written in K. As a factor \
         it is the kelvin: `\"25 W/m^2/degC\"`. Beside it `heat.reference` must be given: its default is 0 K. Angles are radians, `\"30 deg\"` too; angular \
         velocities radians per time. A fracture toughness K is given as the energy K²/E: `\"(0.75 MPa)^2 * 1 m / 72 GPa\"`.\n\n\
         | | si | metal | as one would write it |\n|---|---|---|---|\n",
        known()
    );
    for dim in usual() {
        let [si, metal] =
            [UnitSystem::Si, UnitSystem::Metal(Default::default())].map(|s| s.plain_unit(dim));
        let example = example(dim).unwrap_or_default();
        let _ = writeln!(text, "| {dim} | {si} | {metal} | {example} |");
    }
    text
}

fn fields() -> String {
    let mut text = String::from(
        "# Fields of points\n\nNames for `output.fields` and for `of` of probes; history-dependent laws add their own ([laws](material.law.md)).\n\n\
         | field | what it is | components | measures |\n|---|---|---|---|\n",
    );
    for o in observables::ALL {
        let d = &o.declaration;
        let mut what = cell(&d.doc);
        for said in [o.equation, o.source] {
            if !said.is_empty() {
                let _ = write!(what, " {}", cell(said));
            }
        }
        let components = d.shape.components().join(" ");
        let _ = writeln!(
            text,
            "| <a id=\"{0}\"></a>`{0}` | {what} | {components} | {1} |",
            d.name, d.dimension
        );
    }
    text
}

fn lattices() -> String {
    let mut text = String::from(
        "# Lattices\n\nNames for `body.lattice`; `spacing` is the edge of the cell (triangular: the distance of nearest neighbours).\n\n\
         | lattice | dimensions | sites of a cell | nearest neighbours [spacings] |\n|---|---:|---:|---:|\n",
    );
    for kind in LatticeKind::ALL {
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {:.4} |",
            kind.name(),
            kind.dimension(),
            kind.basis().len(),
            kind.nearest()
        );
    }
    text
}
