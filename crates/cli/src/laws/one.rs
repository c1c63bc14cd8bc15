//! One law: its keys, a deck that runs it, and the fields that it brings along.

use crate::keys::measured;
use peridyne::columns::{Declaration, Dimension, On};
use peridyne::law::descriptor::{Bounds, Descriptor, Key, Need, Value};
use peridyne::run::{Options, Registry, build};
use peridyne_io::deck::Deck;
use std::fmt::Write;

/// What a law is called in decks: `material.law`, or `condition.force`.
pub const LAW: &str = "material.law";
pub const FORCE: &str = "boundary_condition.force";

/// A deck for laws, its cells, and as few of them as show what a model has.
type Frame = (&'static str, &'static str, &'static str);

/// A material of law `LAW` about its reference, in two, three and one dimensions; atoms of it in a crystal, in units of metal and reduced.
const SOLIDS: [Frame; 3] = [
    (
        r#"body = { lattice = "square", spacing = "1 mm", cells = CELLS }
horizon = { m_ratio = 3 }
material.density = "2500 kg/m^3"
material.law = LAW
run = { steps = 10 }
"#,
        "[20, 20]",
        "[8, 8]",
    ),
    (
        r#"body = { lattice = "cubic", spacing = "1 mm", cells = CELLS }
horizon = { m_ratio = 2 }
material.density = "2500 kg/m^3"
material.law = LAW
run = { steps = 10 }
"#,
        "[8, 8, 8]",
        "[5, 5, 5]",
    ),
    (
        r#"body = { lattice = "chain", spacing = "1 mm", cells = CELLS }
horizon = { m_ratio = 3 }
material.density = "2500 kg/m^3"
material.law = LAW
run = { steps = 10 }
"#,
        "[50]",
        "[12]",
    ),
];
const ATOMS: [Frame; 2] = [
    (
        r#"units = "metal"
body = { lattice = "fcc", spacing = "4 Å", cells = CELLS }
periodic = ["x", "y", "z"]
material.mass = "60 g/mol"
material.law = LAW
run = { steps = 10 }
"#,
        "[6, 6, 6]",
        "[5, 5, 5]",
    ),
    (
        r#"units = "lj"
body = { lattice = "fcc", spacing = 1.6, cells = CELLS }
periodic = ["x", "y", "z"]
material.mass = 1
material.law = LAW
run = { steps = 10 }
"#,
        "[6, 6, 6]",
        "[5, 5, 5]",
    ),
];
/// Added to laws that cannot do without, and where it is asked what breaking bonds bring along.
const BREAKS: &str = "material.fracture = { critical_stretch = 0.01 }\n";

/// `{ lps = { young = "72 GPa", poisson = 0.22 } }`.
fn written(law: &Descriptor) -> String {
    match &*law.example {
        "" => format!("{{ {} = {{}} }}", law.name),
        example => format!("{{ {} = {example} }}", law.name),
    }
}

fn columns(deck: &str) -> Option<Vec<Declaration>> {
    let deck = Deck::parse(deck, "deck.toml", &[]).ok()?;
    let made = build(&deck.spec, Options::default()).ok();
    Some(made?.columns())
}

/// The shortest deck that runs a law, and one of fewer points that is built at once, with its columns; `None` where it needs a file,
/// or more than its example says.
fn decks(law: &Descriptor, registry: &Registry) -> Option<(String, String, Vec<Declaration>)> {
    let files = |k: &Key| matches!(k.value, Value::Table);
    if law.keys.iter().any(files) || law.example.contains('…') {
        return None;
    }
    let frames: &[Frame] = match registry.is_potential(&law.name) {
        true => &ATOMS,
        false => &SOLIDS,
    };
    let breaks = ["", BREAKS];
    let mut tried = frames.iter().flat_map(|f| breaks.map(|breaks| (f, breaks)));
    tried.find_map(|((frame, cells, few), breaks)| {
        let frame = frame.replace("LAW", &written(law)) + breaks;
        let [deck, small] = [cells, few].map(|cells| frame.replace("CELLS", cells));
        columns(&small).map(|columns| (deck, small, columns))
    })
}

/// Fields of points that a law brings along, beside those of every body, and whether only where bonds break.
pub fn fields(law: &Descriptor, registry: &Registry) -> Vec<(Declaration, bool)> {
    let Some((_, small, own)) = decks(law, registry) else {
        return vec![];
    };
    let broken = match small.ends_with(BREAKS) {
        true => vec![],
        false => columns(&format!("{small}{BREAKS}")).unwrap_or_default(),
    };
    let usual = |c: &Declaration| registry.observable(&c.name).is_some();
    let wanted = |c: &Declaration| c.on == On::Points && !usual(c);
    let mut all: Vec<(Declaration, bool)> =
        own.into_iter().filter(wanted).map(|c| (c, false)).collect();
    for column in broken.into_iter().filter(wanted) {
        if all.iter().all(|(c, _)| c.name != column.name) {
            all.push((column, true));
        }
    }
    all
}

/// A field of points in a line: `  stress   a pressure (Pa; in metal bar) (xx yy …); …`.
pub fn field_line(column: &Declaration) -> String {
    let shape = match column.shape.components() {
        [] => String::new(),
        components => format!(" ({})", components.join(" ")),
    };
    let measured = measured(&column.dimension.to_string());
    format!("  {:<26} {measured}{shape}; {}", column.name, column.doc)
}

/// `young: Young's modulus E. — a pressure (Pa; in metal bar), positive; one of these is given`.
pub fn explain(key: &Key) -> String {
    let measured = |dimension: Dimension| measured(&dimension.to_string());
    let number = |dimension: Dimension, bounds: &Bounds| match bounds {
        b if *b == Bounds::ANY => measured(dimension),
        b => format!("{}, {}", measured(dimension), b.words()),
    };
    let value = match key.value {
        Value::Number(dimension, bounds) => number(dimension, &bounds),
        Value::List(count, dimension, bounds) => {
            format!("{count} numbers, each {}", number(dimension, &bounds))
        }
        Value::Rows(columns) => {
            let each = columns
                .iter()
                .map(|(name, d, b)| format!("{name} ({})", number(*d, b)));
            format!("rows of {}", each.collect::<Vec<_>>().join(", "))
        }
        Value::Direction => "three numbers or expressions of x, y, z".into(),
        Value::Word(words) => {
            let words: Vec<&str> = words.iter().map(|(w, _)| *w).collect();
            format!("one of {}", words.join(", "))
        }
        Value::Name => "a name".into(),
        Value::Formula(variables, dimension) => {
            let measures = dimension
                .map(|d| format!(", {}", measured(d)))
                .unwrap_or_default();
            format!("an expression of {}{measures}", variables.join(", "))
        }
        Value::Table | Value::Entries(_) => "a file".into(),
    };
    let need = match key.need {
        Need::Given | Need::Refused => String::new(),
        Need::Default(x) => format!("; default: {x}"),
        Need::Word(word) => format!("; default: {word}"),
        Need::Optional => "; optional".into(),
        Need::OneOf => "; one of these is given".into(),
        Need::TwoOf => "; two of these are given".into(),
    };
    format!("{}: {} — {value}{need}", key.name, key.doc)
}

/// The fields of a law, a line each.
pub fn field_lines(law: &Descriptor, registry: &Registry) -> String {
    let mut text = String::new();
    for (column, breaks) in fields(law, registry) {
        let breaks = if breaks { " (with fracture)" } else { "" };
        let _ = writeln!(text, "{}{breaks}", field_line(&column));
    }
    text
}

/// All that is known of a law or a force.
pub fn told(place: &str, law: &Descriptor, registry: &Registry) -> String {
    let mut text = format!("[{place}.{}]\n  {}\n", law.name, law.doc);
    if !law.source.is_empty() {
        let _ = writeln!(text, "  source: {}", law.source);
    }
    let mut keys = law.taken().peekable();
    if keys.peek().is_some() {
        let _ = writeln!(text, "keys");
    }
    for key in keys {
        let _ = writeln!(text, "  {}", explain(key));
        if let Value::Word(words) = key.value {
            for (word, said) in words {
                let _ = writeln!(text, "    {word}: {said}");
            }
        }
    }
    if place == FORCE {
        let _ = writeln!(
            text,
            "a part of a deck\n  [[boundary_condition]]\n  set = \"end\"\n  force = {}",
            written(law)
        );
        return text;
    }
    let own = field_lines(law, registry);
    if !own.is_empty() {
        let _ = write!(text, "fields of its own (output.fields)\n{own}");
    }
    match decks(law, registry) {
        Some((deck, ..)) => {
            let _ = writeln!(text, "a deck");
            for line in deck.lines() {
                let _ = writeln!(text, "  {line}");
            }
        }
        None => {
            let _ = writeln!(text, "a part of a deck\n  material.law = {}", written(law));
        }
    }
    text
}

/// Descriptors of this name with their places.
pub fn named<'a>(registry: &'a Registry, name: &str) -> Vec<(&'static str, &'a Descriptor)> {
    let laws = registry.descriptors().map(|d| (LAW, d));
    let all = laws.chain(registry.forces().map(|d| (FORCE, d)));
    all.filter(|(_, d)| d.name == name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What needs a file, a body of its own, or more constants than fit a line.
    const WITHOUT: [&str; 7] = [
        "micromoduli",
        "eam",
        "eam_form",
        "no_potential",
        "stillinger_weber",
        "tersoff",
        "embedded_solid",
    ];

    #[test]
    fn every_law_has_a_deck_that_builds() {
        let registry = Registry::standard();
        let none: Vec<&str> = { registry.descriptors() }
            .filter(|law| decks(law, &registry).is_none())
            .map(|law| &*law.name)
            .collect();
        assert_eq!(none, WITHOUT);
    }

    #[test]
    fn laws_say_which_fields_they_bring_along() {
        let registry = Registry::standard();
        let of = |name: &str| {
            let law = registry.descriptor(name).unwrap();
            let all = fields(law, &registry);
            let names = all.iter().map(|(c, breaks)| (c.name.to_string(), *breaks));
            names.collect::<Vec<_>>()
        };
        assert!(
            of("elastic_plastic")
                .iter()
                .any(|(n, b)| n.contains("plastic") && !b)
        );
        assert!(of("lps").iter().all(|(name, _)| name != "displacement"));
    }
}
