//! Atoms as files of molecular dynamics hold them: extended XYZ, LAMMPS data files and dumps.

use std::collections::HashMap;

/// A kind of atom.
#[derive(Debug, Clone, PartialEq)]
pub struct Species {
    /// "Cu"; the number of the type where a file has no names.
    pub name: String,
    /// Where the file says it, and says the same of all its atoms.
    pub mass: Option<f64>,
}

/// Atoms in a box, in the file's units and in the order of the file (extended XYZ) or of the ids (LAMMPS).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Atoms {
    pub species: Vec<Species>,
    /// Place of each atom's kind in `species`.
    pub kind: Vec<u32>,
    /// As in the file: wrapped into the box or not.
    pub position: Vec<[f64; 3]>,
    /// Of each atom, where those of a species differ (isotopes).
    pub mass: Option<Vec<f64>>,
    pub velocity: Option<Vec<[f64; 3]>>,
    pub force: Option<Vec<[f64; 3]>>,
    /// The velocities come from momenta over masses: they are in Å, eV and g/mol, as ASE has them, whatever the units of others.
    pub from_momenta: bool,
    /// Potential energy of each atom.
    pub energy: Option<Vec<f64>>,
    /// Other numbers of a dump, by the names of their columns.
    pub columns: Vec<(String, Vec<f64>)>,
    /// Corners of the box.
    pub low: [f64; 3],
    pub high: [f64; 3],
    pub periodic: [bool; 3],
    /// Does the file have bonds, angles, dihedrals or impropers ([`molecules`](super::molecules))?
    pub bonded: bool,
    /// Edges of a box that is not along the axes, one per row, from the corner `low`; `high` is then no more than a bound.
    pub edges: Option<[[f64; 3]; 3]>,
    /// Units that the file says it is in, by LAMMPS's names.
    pub units: Option<String>,
    /// Of the frame, where the file says it.
    pub step: Option<u64>,
    pub time: Option<f64>,
}

impl Atoms {
    pub fn len(&self) -> usize {
        self.position.len()
    }

    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Takes masses of single atoms: a species has one if all of its atoms have it.
    pub(super) fn take_masses(&mut self, masses: Vec<f64>) {
        let mut alike = vec![true; self.species.len()];
        for (kind, mass) in self.kind.iter().zip(&masses) {
            let known = self.species[*kind as usize].mass.get_or_insert(*mass);
            alike[*kind as usize] &= *known == *mass;
        }
        let unlike = { self.species.iter_mut().zip(&alike) }.filter(|(_, alike)| !**alike);
        unlike.for_each(|(species, _)| species.mass = None);
        self.mass = alike.contains(&false).then_some(masses);
    }

    /// Name of the atom's species.
    pub fn name(&self, i: usize) -> &str {
        &self.species[self.kind[i] as usize].name
    }

    /// Moves every atom into the box along periodic axes.
    pub fn wrap(&mut self) {
        for x in &mut self.position {
            for (a, c) in x.iter_mut().enumerate() {
                let (low, length) = (self.low[a], self.high[a] - self.low[a]);
                if self.periodic[a] && length > 0.0 {
                    let wrapped = low + (*c - low).rem_euclid(length);
                    // round-off of a tiny negative distance gives the upper face, which is the lower one
                    *c = if wrapped < self.high[a] { wrapped } else { low };
                }
            }
        }
    }

    /// The smallest box around the atoms.
    pub fn bounds(position: &[[f64; 3]]) -> [[f64; 3]; 2] {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for x in position {
            for a in 0..3 {
                bounds[0][a] = bounds[0][a].min(x[a]);
                bounds[1][a] = bounds[1][a].max(x[a]);
            }
        }
        if position.is_empty() {
            bounds = [[0.0; 3]; 2];
        }
        bounds
    }
}

/// Names as they come, each with its place.
#[derive(Default)]
pub(super) struct Names {
    places: HashMap<String, u32>,
    pub species: Vec<Species>,
}

impl Names {
    pub fn place(&mut self, name: &str) -> u32 {
        if let Some(place) = self.places.get(name) {
            return *place;
        }
        let place = self.species.len() as u32;
        self.places.insert(name.to_string(), place);
        self.species.push(Species {
            name: name.to_string(),
            mass: None,
        });
        place
    }
}

/// Boxes whose edges are not along the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tilted {
    Refused,
    Taken,
}

/// Which frame of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// From 0.
    Index(usize),
    /// Of this time step: `ITEM: TIMESTEP` of a dump, `step=` in extended XYZ.
    Step(u64),
    Last,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn atoms_are_wrapped_along_periodic_axes_only() {
        let mut atoms = Atoms {
            position: vec![[-0.5, -0.5, 3.0], [3.0, 0.0, -1e-30]],
            low: [-1.0, 0.0, 0.0],
            high: [1.0, 2.0, 3.0],
            periodic: [true, false, true],
            ..Atoms::default()
        };
        atoms.wrap();
        assert_eq!(atoms.position, [[-0.5, -0.5, 0.0], [-1.0, 0.0, 0.0]]);
    }
}
