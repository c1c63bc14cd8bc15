//! No files import each other in a circle.

use crate::imports::Sources;
use crate::reading::{Modules, crates, modules, own};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;

/// Files of the engine that still import each other in a circle, faces that hold code among them: they may only become fewer.
const IN_CIRCLES: &[&str] = &[
    "body",
    "body/several",
    "boundary_condition/rigid_body",
    "boundary_condition/rigid_body/rub",
    "constitutive/registry",
    "constitutive/registry/atoms",
    "constitutive/registry/materials",
    "execute/lane",
    "execute/lane/avx2",
    "execute/lane/avx512",
    "execute/lane/eight",
    "execute/lane/neon",
    "execute/lane/pair",
    "family/neighbours/near",
    "family/neighbours/near/build",
    "interaction/list",
    "interaction/list/assemble",
    "interaction/list/images",
    "interaction/list/kernel",
    "interaction/list/kernel/energies",
    "interaction/list/kernel/forces",
    "interaction/list/kernel/share",
    "interaction/stencil",
    "interaction/stencil/assemble",
    "interaction/stencil/kernel",
    "interaction/stencil/kernel/chunk",
    "interaction/stencil/kernel/energies",
    "interaction/stencil/kernel/forces",
    "interaction/stencil/kernel/offsets",
    "interaction/stencil/kernel/share",
    "law/many_body",
    "law/many_body/bulk",
    "law/many_body/described",
    "law/many_body/sites",
    "law/many_body/tangent",
    "law/jet",
    "law/material",
    "law/material/bonds",
    "law/material/non_ordinary",
    "law/material/non_ordinary/bond",
    "law/material/non_ordinary/family",
    "law/material/thermoelastic",
    "law/material/thermoelastic_solid",
    "law/potential",
    "law/potential/bulk",
    "law/potential/cut",
    "law/potential/described",
    "law/potential/mixture",
    "law/slopes",
    "law/terms",
    "observe/observables",
    "observe/observables/temperature",
    "run",
    "run/atoms",
    "run/build",
    "run/build/bodies",
    "run/build/bonds",
    "run/build/made",
    "run/conditions",
    "run/equilibrium",
    "run/equilibrium/problem",
    "run/equilibrium/tried",
    "run/sanity",
    "run/gaps",
    "run/implicit",
    "run/model",
    "run/observation",
    "run/preload",
    "run/sets",
    "run/stages",
    "run/state_hash",
    "run/stepper",
    "run/stepper/increments",
    "run/stepper/newmark",
    "run/stepper/rest",
    "run/stepper/verlet",
    "run/system",
    "run/system/watch",
    "run/time_step",
    "run/overloaded",
    "run/traits",
    "run/traits/system",
    "run/diffusions/make",
    "space/membership",
    "space/membership/compile",
];

/// Files that can be reached from each other. What the face of a folder (`mod.rs`, or the file of its name) says of the
/// folder's own files, their declaration and what is handed on, ties nothing, unless it holds code of its own.
fn circles(modules: &Modules) -> Vec<Vec<String>> {
    let sources = Sources::of(modules);
    let imports = sources.imports(true);
    let plain: BTreeSet<_> = modules
        .keys()
        .filter(|m| sources.is_plain_face(m))
        .collect();
    let reached = |from: &Vec<String>| {
        let mut all: BTreeSet<&Vec<String>> = BTreeSet::new();
        let mut next = vec![from];
        while let Some(module) = next.pop() {
            for other in &imports[module] {
                let own = other.len() > module.len() && other.starts_with(module);
                if !(own && plain.contains(module)) && all.insert(other) {
                    next.push(other);
                }
            }
        }
        all
    };
    let all: BTreeMap<_, _> = modules.keys().map(|m| (m, reached(m))).collect();
    let mut found: BTreeSet<Vec<String>> = BTreeSet::new();
    for (module, ways) in &all {
        if ways.contains(module) {
            let back = ways.iter().filter(|w| all[**w].contains(module));
            found.insert(back.map(|m| m.join("/")).collect());
        }
    }
    found.into_iter().collect()
}

#[test]
fn no_circle_of_files() {
    let (mut wrong, mut left) = (vec![], BTreeSet::new());
    for root in crates() {
        let engine = ["engine", "mechanics"]
            .map(|name| own(&format!("../{name}/src")))
            .contains(&root);
        for circle in circles(&modules(&root)) {
            let known = |file: &String| engine && IN_CIRCLES.contains(&&**file);
            match circle.iter().all(known) {
                true => left.extend(circle),
                false => wrong.push(format!("{}: {}", root.display(), circle.join(", "))),
            }
        }
    }
    assert!(wrong.is_empty(), "files import each other: {wrong:#?}");
    let gone: Vec<_> = IN_CIRCLES.iter().filter(|f| !left.contains(**f)).collect();
    assert!(gone.is_empty(), "out of the circles: {gone:#?}");
}

#[test]
fn a_circle_is_seen() {
    let folder = std::env::temp_dir().join(format!("peridyne-house-{}", std::process::id()));
    for part in ["part", "face"] {
        fs::create_dir_all(folder.join(part)).unwrap();
    }
    let files = [
        ("lib.rs", "mod a;\nmod part;\n"),
        ("a.rs", "use crate::part::{b::B, c};\n"),
        ("part/mod.rs", "pub mod b;\npub use b::B;\npub use d::*;\n"),
        ("part/b.rs", "// use crate::a;\npub struct B;\n"),
        ("part/c.rs", "fn f() -> crate::a::A { super::B }\n"),
        // by what the face hands on
        ("part/d.rs", "use super::e::E;\npub struct D;\n"),
        ("part/e.rs", "use super::D;\npub struct E;\n"),
        // a face with code
        ("face/mod.rs", "mod g;\npub use g::G;\npub fn f() {}\n"),
        (
            "face/g.rs",
            "pub(in crate::face) struct G;\nfn g() { super::f() }\n",
        ),
    ];
    for (name, text) in files {
        fs::write(folder.join(name), text).unwrap();
    }
    let found = circles(&modules(&folder));
    fs::remove_dir_all(&folder).unwrap();
    assert_eq!(
        found,
        [["a", "part/c"], ["face", "face/g"], ["part/d", "part/e"]]
    );
}
