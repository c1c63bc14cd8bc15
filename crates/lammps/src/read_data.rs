//! `read_data` for `atom_style peri`.

use crate::atoms::{Atoms, Column, Ids, Reference};
use crate::domain::SimBox;
use crate::error::{Problem, Result};
use crate::session::{Session, Store};
use peridyne_io::read::lammps::{DataAtoms, DataFile, Style};

impl From<DataAtoms> for Atoms {
    fn from(data: DataAtoms) -> Atoms {
        fn column<T: Copy + PartialEq>(values: Vec<T>, empty: T) -> Column<T> {
            match values.first() {
                None => Column::Uniform(empty),
                Some(v) if values.iter().all(|x| x == v) => Column::Uniform(*v),
                Some(_) => Column::Each(values),
            }
        }
        let sequence = data.ids.iter().enumerate();
        let sequence = sequence.fold(true, |s, (k, id)| s && *id as usize == k + 1);
        Atoms {
            ids: match sequence {
                true => Ids::Count(data.ids.len()),
                false => Ids::List(data.ids),
            },
            types: column(data.types, 1),
            volume: column(data.volume, 1.0),
            density: column(data.density, 1.0),
            reference: Reference::Points(data.position),
            moved: None,
            velocity: data
                .velocity
                .map_or(Column::Uniform([0.0; 3]), Column::Each),
        }
    }
}

impl Session<'_> {
    /// Takes a data file as box and atoms.
    ///
    /// # Errors
    /// Another atom style; atoms outside the box.
    pub fn take_data(&mut self, mut data: DataFile, path: &str) -> Result<()> {
        if data.style != Style::Peri {
            return Err(Problem::new(format!(
                "{path}: the file is of atom_style atomic, without volumes and densities"
            ))
            .help("atom_style peri: id type volume density x y z [ix iy iz]"));
        }
        let domain = SimBox::new(data.low, data.high, self.space.faces);
        let n = data.atoms.len();
        if data.had_images {
            self.console.note(&format!(
                "{path}: image flags are read as 0; bonds use the nearest periodic image"
            ));
        }
        for i in 0..n {
            for (a, x) in data.atoms.position[i].iter_mut().enumerate() {
                *x = domain.wrap(a, *x).0;
                if *x < domain.low[a] || *x > domain.high[a] {
                    let axis = ["x", "y", "z"][a];
                    return Err(Problem::new(format!(
                        "{path}: the atom with id {} lies outside the box: {axis} = {x}",
                        data.atoms.ids[i]
                    ))
                    .help(format!("enlarge `{axis}lo {axis}hi` in the file")));
                }
            }
        }
        self.population
            .take_types(data.types)
            .map_err(|p| Problem::new(format!("{path}: {}", p.message)))?;
        let atoms = Atoms::from(data.atoms);
        self.population.ids = atoms.ids.clone();
        self.space.domain = Some(domain);
        self.population.store = Store::Atoms(atoms);
        // faces that follow the atoms do so at once
        self.shrink_box()
    }
}
