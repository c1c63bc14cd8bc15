//! Kinds of atoms of a potential, and which of them the species of a frame are.

use crate::read::Atoms;

/// A kind of atom of a potential.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Kind {
    /// What it is called: a material, the set of one.
    pub names: Vec<String>,
    /// The element that it is made for, where its file or the user says so.
    pub element: Option<String>,
    /// Mass of its atoms in the user's units, where its file or deck says so.
    pub mass: Option<f64>,
}

/// In words, of several kinds.
fn listed(kinds: &[Kind]) -> String {
    let name = |(n, kind): (usize, &Kind)| {
        let own = kind.element.as_ref().or(kind.names.first());
        own.cloned().unwrap_or_else(|| (n + 1).to_string())
    };
    let all: Vec<String> = kinds.iter().enumerate().map(name).collect();
    all.join(", ")
}

/// The kind of each species of a frame, in the order of [`Atoms::species`]; 0 of those without atoms.
///
/// A species is the kind of its name, then of its element; a number is the place of a type among the kinds.
///
/// # Errors
/// In words: a species that no kind is, or that could be several.
pub fn kinds_of(kinds: &[Kind], potential: &str, atoms: &Atoms) -> Result<Vec<u32>, String> {
    let mut used = vec![false; atoms.species.len()];
    atoms.kind.iter().for_each(|k| used[*k as usize] = true);
    let names = || {
        let all = atoms.species.iter().zip(&used).filter(|(_, used)| **used);
        all.map(|(s, _)| &*s.name).collect::<Vec<_>>()
    };
    let only = names().len() == 1;
    if kinds.len() == 1 && !only {
        let all = names();
        return Err(format!(
            "the frame has {} kinds of atoms, {}: {potential} knows one; name the elements of a file in order of types (--element A,B), or \
             a deck with [material.NAME] of each kind (--model DECK)",
            all.len(),
            all.join(", "),
        ));
    }
    let of = |(species, used): (&crate::read::Species, &bool)| match used {
        true => one(kinds, potential, &species.name, only),
        false => Ok(0),
    };
    atoms.species.iter().zip(&used).map(of).collect()
}

fn one(kinds: &[Kind], potential: &str, name: &str, only: bool) -> Result<u32, String> {
    let place = |of: &dyn Fn(&Kind) -> bool| {
        let all = kinds.iter().enumerate().filter(|(_, kind)| of(kind));
        all.map(|(n, _)| n as u32).collect::<Vec<u32>>()
    };
    if let [found] = place(&|kind| kind.names.iter().any(|own| own == name))[..] {
        return Ok(found);
    }
    let number = name.parse::<usize>().ok();
    if let [kind] = kinds
        && only
        && (number.is_some() || kind.element.is_none())
    {
        return Ok(0);
    }
    if let Some(number) = number {
        // sets of a data file are called after types
        let numbered = |kind: &Kind| kind.names.iter().any(|n| n.parse::<u32>().is_ok());
        return match (1..=kinds.len()).contains(&number) && !kinds.iter().any(numbered) {
            true => Ok(number as u32 - 1),
            false => Err(format!(
                "the frame has atoms of type {name}, which {potential} does not know: its kinds are {}",
                listed(kinds)
            )),
        };
    }
    match place(&|kind| kind.element.as_deref() == Some(name))[..] {
        [found] => Ok(found),
        [first, ..] if kinds.iter().all(|kind| kind.names.is_empty()) => Ok(first),
        [] => Err(format!(
            "the frame has {name}, which {potential} does not know: it is of {}",
            listed(kinds)
        )),
        [..] => Err(format!(
            "the frame has {name}, which could be several materials of {potential}: name the species of the frame as the materials"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::Species;

    fn atoms(names: &[&str]) -> Atoms {
        let species = names.iter().map(|name| Species {
            name: name.to_string(),
            mass: None,
        });
        Atoms {
            species: species.collect(),
            kind: (0..names.len() as u32).collect(),
            ..Atoms::default()
        }
    }

    fn element(name: &str) -> Kind {
        Kind {
            element: Some(name.into()),
            ..Kind::default()
        }
    }

    #[test]
    fn species_are_found_by_name_element_and_type() {
        let alloy = [element("Ni"), element("Al")];
        let of = |kinds: &[Kind], names: &[&str]| kinds_of(kinds, "P", &atoms(names));
        assert_eq!(of(&alloy, &["Al", "Ni"]), Ok(vec![1, 0]));
        assert_eq!(of(&alloy, &["2", "1"]), Ok(vec![1, 0]));
        assert_eq!(of(&alloy, &["2"]), Ok(vec![1]));
        // two types of one element
        let twice = [element("Ni"), element("Ni"), element("Al")];
        assert_eq!(of(&twice, &["3", "2", "1"]), Ok(vec![2, 1, 0]));
        assert_eq!(of(&twice, &["Ni", "Al"]), Ok(vec![0, 2]));
        // materials by their names, and by sets that are types
        let named = |names: &[&str]| Kind {
            names: names.iter().map(|n| n.to_string()).collect(),
            element: Some("Cu".into()),
            mass: None,
        };
        let materials = [named(&["hot", "2"]), named(&["cold", "1"])];
        assert_eq!(of(&materials, &["cold", "hot"]), Ok(vec![1, 0]));
        assert_eq!(of(&materials, &["1", "2"]), Ok(vec![1, 0]));
        // one kind of anything
        assert_eq!(of(&[Kind::default()], &["Ar"]), Ok(vec![0]));
        assert_eq!(of(&[element("Cu")], &["7"]), Ok(vec![0]));
        for (kinds, names, part) in [
            (
                &alloy[..],
                &["Fe"][..],
                "the frame has Fe, which P does not know: it is of Ni, Al",
            ),
            (
                &alloy,
                &["3"],
                "type 3, which P does not know: its kinds are Ni, Al",
            ),
            (&materials, &["3"], "type 3"),
            (&materials, &["Cu"], "could be several materials"),
            (&[element("Cu")], &["Ni"], "the frame has Ni"),
            (
                &[Kind::default()],
                &["Ni", "Cu"],
                "2 kinds of atoms, Ni, Cu: P knows one",
            ),
        ] {
            let error = of(kinds, names).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }
}
