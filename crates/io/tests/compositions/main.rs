//! What goes together: every law in every family with every feature. Each cell is built, run for a few steps and asked what must hold of all, and for one
//! number that shows that the feature acted; or it is refused with a reason. The table is a page of the guide.

mod bodies;
mod breaking;
mod case;
mod laws;
mod loads;

use case::{Answer, Case, Stop};
use laws::{LAWS, LEFT_OUT, Law};
use peridyne::run::Registry;
use rayon::prelude::*;
use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

struct Feature {
    name: &'static str,
    try_it: fn(&Case) -> Answer,
}

const fn feature(name: &'static str, try_it: fn(&Case) -> Answer) -> Feature {
    Feature { name, try_it }
}

const BREAKING: &[Feature] = &[
    feature("critical stretch", breaking::stretch),
    feature("fracture energy", breaking::energy),
    feature("work of bonds", breaking::bond_energy),
    feature("von Mises stress", breaking::von_mises),
    feature("plastic strain", breaking::plastic_strain),
    feature("rate", breaking::rate),
    feature("`alpha`", breaking::alpha),
    feature("toughness by place", breaking::toughness_of_places),
    feature("pre-crack", breaking::precrack),
    feature("healing", breaking::healing),
    feature("fatigue", breaking::fatigue),
];

const LOADS: &[Feature] = &[
    feature("explicit steps", loads::motion),
    feature("Newmark", loads::newmark),
    feature("HHT", loads::hht),
    feature("statics: Newton", loads::newton),
    feature("statics: relaxation", loads::relaxation),
    feature("linear statics", loads::linear),
    feature("statics before motion", loads::preload),
    feature("modes", loads::modes),
    feature("arc length", loads::arc_length),
    feature("bond after bond", loads::breaking),
    feature("opening", loads::opening),
    feature("heat", loads::heat),
    feature("expansion", loads::expansion),
];

const BODIES: &[Feature] = &[
    feature("bond factors", bodies::bond_factor),
    feature("`surface = \"exact\"`", bodies::exact_surface),
    feature("two materials", bodies::two_materials),
    feature("bodies in contact", bodies::contact),
    feature("interface of bonds", bodies::interface),
    feature("`variable_horizon`", bodies::variable_horizon),
    feature("directed influence", bodies::directed),
    feature("periodic", bodies::periodic),
];

const TABLES: &[(&str, &[Feature])] = &[
    ("Bonds that end", BREAKING),
    ("Steps, equilibria, heat", LOADS),
    ("Bodies", BODIES),
];

const HEAD: &str = "\
# What goes together

Every law with every feature, tried: a body of some dozen points is built and run for some steps, all numbers are finite, momentum is kept (supports
balance), energy is accounted for to the order of the steps, and the feature did what it is there for. `✓` is that in every family that the law can have;
a number is the reason for which it is refused, below. Where a lattice (a stencil) and a list of bonds differ, both are said in this order. Potentials have `family = \"reference\"`.

<!-- PERIDYNE_RENEW_TABLE=1 cargo test -p peridyne-io --test compositions writes this page anew. -->
";

/// A cell of the table, in the order of the families of its law.
struct Row {
    law: &'static Law,
    cells: Vec<Vec<Answer>>,
}

fn tried(law: &'static Law, feature: &Feature) -> Vec<Answer> {
    let one = |family: &&'static str| {
        let case = Case { law, family };
        let answer = catch_unwind(AssertUnwindSafe(|| (feature.try_it)(&case)));
        answer.unwrap_or_else(|panic| {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or(panic.downcast_ref::<&str>().map(|s| s.to_string()));
            Err(Stop::Wrong(format!("panics: {}", text.unwrap_or_default())))
        })
    };
    law.place.families.iter().map(one).collect()
}

fn rows(features: &[Feature]) -> Vec<Row> {
    let row = |law: &'static Law| Row {
        law,
        cells: features.par_iter().map(|f| tried(law, f)).collect(),
    };
    LAWS.par_iter().map(row).collect()
}

/// The reasons so far, numbered from 1.
#[derive(Default)]
struct Reasons(Vec<String>);

impl Reasons {
    fn number(&mut self, reason: &str) -> String {
        let known = self.0.iter().position(|r| r == reason);
        let at = known.unwrap_or_else(|| {
            self.0.push(reason.to_string());
            self.0.len() - 1
        });
        (at + 1).to_string()
    }

    fn cell(&mut self, answers: &[Answer]) -> String {
        let all: Vec<String> = { answers.iter() }
            .map(|answer| match answer {
                Ok(()) => "✓".to_string(),
                Err(Stop::Refused(reason)) => self.number(reason),
                Err(Stop::Wrong(_)) => "?".to_string(),
            })
            .collect();
        match &all[..] {
            [a, b] if a != b => format!("{a} / {b}"),
            all => all[0].clone(),
        }
    }
}

fn page(tables: &[(&str, &[Feature], Vec<Row>)]) -> String {
    let mut text = HEAD.to_string();
    let mut reasons = Reasons::default();
    for (title, features, rows) in tables {
        let names: Vec<&str> = features.iter().map(|f| f.name).collect();
        let _ = write!(text, "\n## {title}\n\n| | {} |\n", names.join(" | "));
        let _ = writeln!(text, "|---{}|", "|:-:".repeat(names.len()));
        for row in rows {
            let cells: Vec<String> = row.cells.iter().map(|c| reasons.cell(c)).collect();
            let _ = writeln!(text, "| `{}` | {} |", row.law.name, cells.join(" | "));
        }
    }
    text += "\n## Why not\n\n";
    for (n, reason) in reasons.0.iter().enumerate() {
        let _ = writeln!(text, "{}. {}", n + 1, reason.replace('|', "\\|"));
    }
    text
}

/// Cells that neither hold nor are refused with a reason, and features that no law has, which is a mistake of their decks.
fn failures(tables: &[(&str, &[Feature], Vec<Row>)]) -> Vec<String> {
    let mut all = vec![];
    for (_, features, rows) in tables {
        for (n, feature) in features.iter().enumerate() {
            let cells = rows.iter().map(|row| (row.law, &row.cells[n]));
            let mut runs = 0;
            for (law, answers) in cells {
                for (family, answer) in law.place.families.iter().zip(answers) {
                    let why = match answer {
                        Ok(()) => {
                            runs += 1;
                            continue;
                        }
                        Err(Stop::Refused(reason)) if !reason.trim().is_empty() => continue,
                        Err(Stop::Refused(_)) => "is refused without a reason",
                        Err(Stop::Wrong(why)) => why,
                    };
                    all.push(format!("{} × {family} × {}: {why}", law.name, feature.name));
                }
            }
            if runs == 0 {
                all.push(format!("{}: no law has it", feature.name));
            }
        }
    }
    all
}

fn guide() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/book/src/together.md")
}

#[test]
fn every_law_is_in_the_table() {
    let registry = Registry::standard();
    let listed = |name: &str| LAWS.iter().any(|law| law.name == name);
    for name in registry.descriptors().map(|d| &*d.name) {
        assert!(
            listed(name) != LEFT_OUT.contains(&name),
            "`{name}` has no line in tests/compositions/laws.rs"
        );
    }
}

#[test]
fn what_goes_together_runs_and_what_does_not_says_why() {
    let tables: Vec<(&str, &[Feature], Vec<Row>)> = { TABLES.iter() }
        .map(|(title, features)| (*title, *features, rows(features)))
        .collect();
    let failures = failures(&tables);
    let page = page(&tables);
    if std::env::var_os("PERIDYNE_RENEW_TABLE").is_some() {
        std::fs::write(guide(), &page).unwrap();
    }
    assert!(
        failures.is_empty(),
        "{} cells fail:\n{}",
        failures.len(),
        failures.join("\n")
    );
    let written = std::fs::read_to_string(guide()).unwrap();
    let wrong: Vec<&str> = { page.lines() }
        .filter(|line| !written.lines().any(|other| other == *line))
        .collect();
    assert!(
        written == page,
        "{} is not what was found; PERIDYNE_RENEW_TABLE=1 writes it anew. Lines that it has not:\n{}",
        guide().display(),
        wrong.join("\n")
    );
}
