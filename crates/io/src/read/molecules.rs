//! What bonds the atoms of a LAMMPS data file: its sections `Bonds`, `Angles`, `Dihedrals`, `Impropers` and their coefficients, the styles of which stand
//! behind a `#` (`Bond Coeffs # harmonic`), as `write_data` writes them.

mod forms;

use super::error::ReadError;
use super::lines::Lines;
use peridyne::spec::{BondedSpec, BondedTerm, Form};
use std::collections::HashMap;
use std::path::Path;

/// A list of bonded atoms.
struct Kind {
    /// Heads of its section and of its coefficients.
    section: &'static str,
    coefficients: &'static str,
    atoms: usize,
}

/// In the order of the parts of bonded terms.
const KINDS: [Kind; 4] = [
    Kind {
        section: "Bonds",
        coefficients: "Bond Coeffs",
        atoms: 2,
    },
    Kind {
        section: "Angles",
        coefficients: "Angle Coeffs",
        atoms: 3,
    },
    Kind {
        section: "Dihedrals",
        coefficients: "Dihedral Coeffs",
        atoms: 4,
    },
    Kind {
        section: "Impropers",
        coefficients: "Improper Coeffs",
        atoms: 4,
    },
];

/// One row of a list: line, type and ids.
type Row = (usize, usize, Vec<u32>);

/// Reads what bonds the atoms of a file, whose lengths and energies are multiplied by these. `special` is what is left of the potential
/// between atoms that are one, two and three bonds apart.
///
/// # Errors
/// File and line: a list or coefficients that are not whole, a style that is not known, an atom or a type that is not there.
pub fn molecules(
    path: &Path,
    special: [f64; 3],
    length: f64,
    energy: f64,
) -> Result<BondedSpec, ReadError> {
    let (text, name) = super::whole::titled(path, 1)?;
    parse_molecules(&text, &name, special, length, energy)
}

/// The same from a text; `name` is for messages.
pub fn parse_molecules(
    text: &str,
    name: &str,
    special: [f64; 3],
    length: f64,
    energy: f64,
) -> Result<BondedSpec, ReadError> {
    let mut lines = Lines::new(text, name);
    let mut ids: Vec<u32> = vec![];
    let mut lists: [Vec<Row>; 4] = Default::default();
    let mut forms: [HashMap<usize, Form>; 4] = Default::default();
    let mut section = String::new();
    let mut style = String::new();
    // the first line is a title
    lines.next_raw();
    while let Some(line) = lines.next() {
        let (line, comment) = line.split_once('#').unwrap_or((line, ""));
        let line = line.trim();
        if line.is_empty() {
            continue;
        }
        if line.starts_with(|c: char| c.is_ascii_uppercase()) {
            section = line.to_string();
            style = comment.trim().to_string();
            continue;
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        if section == "Atoms" {
            ids.push(lines.parse(words.first().copied(), "the id of an atom")?);
        }
        for (n, kind) in KINDS.iter().enumerate() {
            if section == kind.section {
                if words.len() != 2 + kind.atoms {
                    return Err(lines.error(format!(
                        "a row of `{section}` has an id, a type and {} atoms, found {} words",
                        kind.atoms,
                        words.len()
                    )));
                }
                let whole = |w: &&str| lines.parse(Some(w), "the id of an atom");
                let atoms = words[2..].iter().map(whole).collect::<Result<_, _>>()?;
                let of = lines.parse(Some(words[1]), "a type")?;
                lists[n].push((lines.number, of, atoms));
            } else if section == kind.coefficients {
                let of: usize = lines.parse(Some(words[0]), "a type")?;
                let form = forms::form(&lines, n, &style, &words[1..], length, energy)?;
                if forms[n].insert(of, form).is_some() {
                    return Err(lines.error(format!("type {of} has coefficients twice")));
                }
            }
        }
    }
    ids.sort_unstable();
    let mut made = BondedSpec {
        forms: vec![],
        terms: vec![],
        special,
    };
    for ((list, forms), kind) in lists.iter().zip(&forms).zip(&KINDS) {
        let mut place = HashMap::new();
        for (line, of, atoms) in list {
            let Some(form) = forms.get(of) else {
                return Err(lines.error_at(
                    *line,
                    format!(
                        "type {of} has no coefficients: add the section `{} # STYLE`",
                        kind.coefficients
                    ),
                ));
            };
            let form = *place.entry(*of).or_insert_with(|| {
                made.forms.push(form.clone());
                made.forms.len() as u32 - 1
            });
            let mut points = [0; 4];
            for (point, id) in points.iter_mut().zip(atoms) {
                let found = ids.binary_search(id);
                let missing = |_| lines.error_at(*line, format!("there is no atom with id {id}"));
                *point = found.map_err(missing)? as u32;
            }
            made.terms.push(BondedTerm { form, points });
        }
    }
    Ok(made)
}

#[cfg(test)]
mod tests;
