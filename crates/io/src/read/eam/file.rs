//! Potentials of a file, element by element.

use crate::read::error::ReadError;

/// An element of a file of potentials.
#[derive(Debug, Clone, PartialEq)]
pub struct EamElement {
    pub name: String,
    /// Atomic number; some files have any number here.
    pub number: u32,
    /// g/mol.
    pub mass: f64,
    /// Å.
    pub lattice_constant: f64,
    /// "FCC", "BCC", …; may be empty.
    pub lattice: String,
}

/// Tables of an embedded-atom potential.
#[derive(Debug, Clone, PartialEq)]
pub struct EamFile {
    /// Where it was read from, for messages.
    pub source: String,
    /// Comment lines at the head.
    pub comments: Vec<String>,
    pub elements: Vec<EamElement>,
    /// Step of the electron density.
    pub drho: f64,
    /// Step of the distance (Å).
    pub dr: f64,
    /// Å; at most one and a half steps beyond the last knot, where the last value stays.
    pub cutoff: f64,
    /// `[element][m]`: F(m drho) (eV).
    pub embedding: Vec<Vec<f64>>,
    /// `[element][m]`: electron density that an atom of this element makes at the distance m dr.
    pub density: Vec<Vec<f64>>,
    /// `[element][at][m]`: the same at an atom of another element, where that matters (`eam/fs`); else empty.
    pub density_at: Vec<Vec<Vec<f64>>>,
    /// `[pair][m]`: r φ(r) at r = m dr (eV Å); pairs in the order of [`EamFile::pair_index`].
    pub pair: Vec<Vec<f64>>,
}

impl EamFile {
    /// Place of the pair `i`, `j` (in any order): (0,0), (1,0), (1,1), (2,0), …
    pub fn pair_index(i: usize, j: usize) -> usize {
        let (high, low) = (i.max(j), i.min(j));
        high * (high + 1) / 2 + low
    }

    /// Electron density that an atom of element `of` makes at one of element `at`.
    pub fn density_of(&self, of: usize, at: usize) -> &[f64] {
        match self.density_at.get(of) {
            Some(each) => &each[at],
            None => &self.density[of],
        }
    }

    /// Place of an element by its name, exactly as written in the file.
    ///
    /// # Errors
    /// The file has no such element: names those that it has, and the closest.
    pub fn element(&self, name: &str) -> Result<usize, ReadError> {
        let found = self.elements.iter().position(|e| e.name == name);
        found.ok_or_else(|| {
            let names: Vec<&str> = self.elements.iter().map(|e| e.name.as_str()).collect();
            // "cu" is nearer to "Cu" than to "Cd"
            let near = names.iter().max_by(|a, b| {
                let likeness = |n: &str| strsim::jaro(&n.to_lowercase(), &name.to_lowercase());
                likeness(a).total_cmp(&likeness(b))
            });
            let advice = match near {
                Some(near) if names.len() > 1 => format!("; did you mean {near}?"),
                Some(near) => format!("; write {near}"),
                None => String::new(),
            };
            let message = format!(
                "no element `{name}` in this file; it has {}{advice}",
                names.join(", ")
            );
            failure(&self.source, None, message)
        })
    }
}

pub(super) fn failure(file: &str, line: Option<usize>, message: impl Into<String>) -> ReadError {
    ReadError {
        file: file.to_string(),
        line,
        message: message.into(),
    }
}
