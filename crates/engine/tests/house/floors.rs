//! Folders of the engine import downwards only.

use crate::imports::Sources;
use crate::reading::engine;

/// Folders of the engine, from the ground up; those of one line do not know each other.
const FLOORS: &[&[&str]] = &[
    &["array"],
    &["quantity"],
    &["error"],
    &["execute"],
    &["state"],
    &["space", "columns", "expression"],
    &["spec"],
    &["body"],
    &["family"],
    &["law"],
    &["interaction"],
    &["fracture"],
    &["boundary_condition"],
    &["observe"],
    &["constitutive"],
    &["dynamics", "statics"],
    &["diffusion"],
    &["run"],
];

#[test]
fn folders_of_the_engine_import_downwards() {
    let modules = engine();
    let floor = |folder: &str| FLOORS.iter().position(|f| f.contains(&folder));
    let mut wrong = vec![];
    for (module, all) in Sources::of(&modules).imports(false) {
        let Some(folder) = module.first() else {
            continue;
        };
        let here = floor(folder).unwrap_or_else(|| panic!("the floor of {folder} is not known"));
        for other in all
            .iter()
            .filter_map(|m| m.first())
            .filter(|o| *o != folder)
        {
            if floor(other).is_none_or(|there| there >= here) {
                wrong.push(format!("{} imports from {other}", module.join("/")));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
