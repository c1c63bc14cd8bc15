//! Keys of decks: their pages, their paths, and what they measure.

use peridyne_io::deck::reference::{Page, pages};
use peridyne_io::deck::{Dim, UnitSystem, law_schema, named, schema};

/// The two kinds of deck, with what the top of each is called.
pub fn all() -> [(&'static str, Vec<Page>); 2] {
    [
        ("deck", pages(&schema())),
        ("conservation_law", pages(&law_schema())),
    ]
}

/// A dimension with the units that plain numbers have.
pub fn measured(dimension: &str) -> String {
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

/// All keys of decks as `--set` takes them, entries of lists with the number of the first.
pub fn paths() -> Vec<String> {
    let mut keys = vec![];
    for (_, pages) in all() {
        // of bodies most decks have one, whose keys need no number
        let lists: Vec<&str> = { pages.iter() }
            .filter(|p| p.repeated && p.path != "body")
            .map(|p| &*p.path)
            .collect();
        let names: Vec<&str> = pages.iter().filter(|p| p.named).map(|p| &*p.path).collect();
        for page in &pages {
            for path in std::iter::once(&page.path).chain(&page.also) {
                let inside = |p: &&str| path == p || path.starts_with(&format!("{p}."));
                if names.iter().any(&inside) {
                    continue;
                }
                let path = lists
                    .iter()
                    .filter(|p| inside(p))
                    .fold(path.clone(), |path, list| {
                        path.replacen(list, &format!("{list}.0"), 1)
                    });
                // a table has keys of its own
                let own = page.keys.iter().filter(|k| k.takes != "a table");
                keys.extend(own.map(|k| match &*path {
                    "" => k.name.clone(),
                    path => format!("{path}.{}", k.name),
                }));
            }
        }
    }
    keys.sort();
    keys.dedup();
    keys
}
