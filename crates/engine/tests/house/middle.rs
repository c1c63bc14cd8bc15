//! The middle of the house only shrinks, and no function is long.

use crate::reading::{crates, files, functions, modules, own, within};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;

/// What the middle of the house is made of, and where it stands: fields, inherent methods and the files that these are in, as many as there
/// are, which may only become fewer. None but `System` has more than 16 fields.
const MIDDLE: &[(&str, &str, [usize; 3])] = &[
    ("model.rs", "impl<const D: usize> Model<D> {", [6, 16, 7]),
    (
        "system/mod.rs",
        "impl<const D: usize> System<D> {",
        [22, 104, 25],
    ),
    ("names.rs", "impl<const D: usize> Names<D> {", [5, 4, 2]),
    ("stages.rs", "impl<const D: usize> Stages<D> {", [3, 4, 1]),
    (
        "equilibrium/problem.rs",
        "impl<const D: usize> Problem<'_, D> {",
        // sums over the points of all ranks, and what the first one solves for all
        [2, 46, 11],
    ),
];
/// Methods of `Simulation`, `CoSimulation` and `Examined`.
// what acts from outside may begin with a motion that follows statics
const ASKED: [usize; 3] = [19, 15, 9];
/// Lines of a function.
const LONG: usize = 120;

/// A block of the source from the line that begins with this on.
fn block<'a>(text: &'a str, begin: &str) -> &'a str {
    let at = text.find(begin).unwrap_or_else(|| panic!("{begin}"));
    let end = text[at..].find("\n}").unwrap_or(text.len() - at);
    &text[at..at + end]
}

/// Methods of the contract that check what they are given and ask another, and the sum over [`Interaction::each_force`](peridyne::interaction::Interaction::each_force);
/// and those of who holds bonds itself.
const FOLLOW: [&str; 10] = [
    "bonds",
    "bonds_mut",
    "check",
    "energy",
    "forces",
    "look_bits",
    "look_critical",
    "observe",
    "tangents",
    "virial",
];

/// What one body answers by default, several must ask each of them.
#[test]
fn several_bodies_answer_no_default() {
    let folder = own("../mechanics/src/interaction");
    let of = |file: &str, begin: &str| -> BTreeSet<String> {
        let text = fs::read_to_string(folder.join(file)).unwrap();
        let all = functions(block(&text, begin)).into_iter();
        all.filter(|f| f.1 == 4).map(|f| f.0).collect()
    };
    let asked = of("contract.rs", "pub trait Interaction");
    let each = of(
        "several.rs",
        "impl<const D: usize> Interaction<D> for MultiBodyInteraction<D>",
    );
    let left: Vec<&str> = asked.difference(&each).map(String::as_str).collect();
    assert_eq!(left, FOLLOW);
}

#[test]
fn the_middle_of_the_house_only_shrinks() {
    let run = own("src/run");
    let texts = files(&run).into_iter().map(fs::read_to_string);
    let texts: Vec<String> = texts.map(Result::unwrap).collect();
    let found = MIDDLE.iter().map(|(file, begin, _)| {
        let name = begin.split_once("> ").unwrap().1.split('<').next().unwrap();
        let text = fs::read_to_string(run.join(file)).unwrap();
        let fields = block(&text, &format!("struct {name}<")).lines().skip(1);
        let fields = fields.filter(|l| {
            let code = l.trim_start();
            l.starts_with("    ") && !code.starts_with("//") && code.contains(": ")
        });
        let methods = texts.iter().map(|text| {
            let begin = format!("\n{begin}");
            let blocks = text.split(&begin).skip(1);
            let methods = blocks.map(|b| {
                let end = b.find("\n}").unwrap_or(b.len());
                functions(&b[..end]).iter().filter(|f| f.1 == 4).count()
            });
            methods.sum::<usize>()
        });
        let methods: Vec<usize> = methods.filter(|n| *n > 0).collect();
        (name, [fields.count(), methods.iter().sum(), methods.len()])
    });
    let found: Vec<_> = found.collect();
    let asked = fs::read_to_string(run.join("mod.rs")).unwrap();
    let asked = ["Simulation", "CoSimulation", "Examined"].map(|name| {
        let text = block(&asked, &format!("pub trait {name}"));
        functions(text).iter().filter(|f| f.1 == 4).count()
    });
    for ((name, found), (.., said)) in found.iter().zip(MIDDLE) {
        assert_eq!(
            found, said,
            "fields, methods and files of {name}: the numbers of today stand here"
        );
        assert!(found[0] <= 16 || *name == "System", "{name} is too much");
    }
    assert_eq!(
        asked, ASKED,
        "methods of Simulation, CoSimulation, Examined"
    );
}

#[test]
fn no_function_is_long() {
    let mut long = vec![];
    for root in crates() {
        for file in files(&root) {
            let text = fs::read_to_string(&file).unwrap();
            let all = functions(&text).into_iter().filter(|f| f.2 > LONG);
            let name = within(&file, root.parent().unwrap().parent().unwrap());
            long.extend(all.map(|f| (name.clone(), f.0, f.2)));
        }
    }
    assert!(long.is_empty(), "functions over {LONG} lines: {long:#?}");
}

/// Files whose methods of one structure may call each other in a circle.
const CIRCLE: usize = 6;

/// Files of methods of a structure that can be reached from each other by calls.
#[test]
fn no_large_circle_of_methods() {
    let run = own("src/run");
    let texts: Vec<(PathBuf, String)> = modules(&run)
        .into_values()
        .map(|file| (file.clone(), fs::read_to_string(&file).unwrap()))
        .collect();
    for (_, begin, _) in MIDDLE {
        // the methods of each file, as text
        let own = texts.iter().filter_map(|(file, text)| {
            let begin = format!("\n{begin}");
            let blocks = text.split(&begin).skip(1);
            let text: String = blocks
                .map(|b| &b[..b.find("\n}").unwrap_or(b.len())])
                .collect();
            (!text.is_empty()).then_some((file, text))
        });
        let own: Vec<_> = own.collect();
        let names = own.iter().enumerate().flat_map(|(n, (_, text))| {
            let all = functions(text).into_iter().filter(|f| f.1 == 4);
            all.map(move |f| (f.0, n))
        });
        let home: BTreeMap<String, usize> = names.collect();
        let calls = |text: &str| -> BTreeSet<usize> {
            let own = |at: &usize| ["self", "system"].iter().any(|r| text[..*at].ends_with(r));
            let dots = text.match_indices('.').map(|(at, _)| at).filter(own);
            let words = dots.map(|at| {
                let rest = &text[at + 1..];
                let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
                rest.split_at(end.unwrap_or(rest.len()))
            });
            let called = words.filter(|(_, after)| after.starts_with('('));
            called
                .filter_map(|(name, _)| home.get(name))
                .copied()
                .collect()
        };
        let next: Vec<_> = own.iter().map(|(_, text)| calls(text)).collect();
        let reached = |from: usize| {
            let (mut all, mut open) = (BTreeSet::new(), vec![from]);
            while let Some(n) = open.pop() {
                open.extend(next[n].iter().filter(|m| all.insert(**m)));
            }
            all
        };
        let ways: Vec<BTreeSet<usize>> = (0..own.len()).map(reached).collect();
        for (n, way) in ways.iter().enumerate() {
            let circle = way.iter().filter(|m| ways[**m].contains(&n));
            let circle: Vec<_> = circle.map(|m| own[*m].0).collect();
            assert!(circle.len() <= CIRCLE, "{begin} {circle:#?}");
        }
    }
}
