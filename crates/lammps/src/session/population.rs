//! The atoms, who holds them, and their groups.

use std::sync::Arc;

use crate::atoms::{Atoms, Ids, Members};
use crate::error::{Problem, Result, suggestion};
use crate::host::{BLOCK, Engine, Particles, Quantity};

/// Atom types at most.
const MOST_TYPES: usize = 1000;

/// Who holds the atoms.
pub enum Store {
    /// Before the first `run`.
    Atoms(Atoms),
    Engine(Box<dyn Engine>),
}

impl Store {
    pub fn particles(&self) -> &dyn Particles {
        match self {
            Store::Atoms(a) => a,
            Store::Engine(e) => e.as_ref(),
        }
    }
    pub fn particles_mut(&mut self) -> &mut dyn Particles {
        match self {
            Store::Atoms(a) => a,
            Store::Engine(e) => e.as_mut(),
        }
    }
}

pub struct Population {
    /// Number of atom types.
    pub types: usize,
    pub store: Store,
    pub ids: Ids,
    pub groups: Vec<(String, Arc<Members>)>,
}

impl Default for Population {
    fn default() -> Self {
        Population {
            types: 0,
            store: Store::Atoms(Atoms::default()),
            ids: Ids::Count(0),
            groups: vec![("all".into(), Arc::new(Members::All))],
        }
    }
}

impl Population {
    /// So many types, from a box or a file.
    ///
    /// # Errors
    /// They are too many: every pair of them has its place.
    pub fn take_types(&mut self, types: usize) -> Result<()> {
        if types > MOST_TYPES {
            let wrong = format!("{types} atom types: more than {MOST_TYPES} are not supported");
            return Err(Problem::new(wrong).help("write the number of types that occur"));
        }
        self.types = types;
        Ok(())
    }

    pub fn count(&self) -> usize {
        self.store.particles().count()
    }

    /// The engine.
    ///
    /// # Errors
    /// There was no `run` yet.
    pub fn engine(&mut self) -> Result<&mut dyn Engine> {
        match &mut self.store {
            Store::Engine(e) => Ok(e.as_mut()),
            Store::Atoms(_) => Err(Problem::new(
                "forces and energies do not exist before the first `run`",
            )
            .help("write `run 0` before")),
        }
    }

    /// Atoms that may still be changed freely.
    ///
    /// # Errors
    /// The first `run` has been.
    pub fn atoms(&mut self) -> Result<&mut Atoms> {
        match &mut self.store {
            Store::Atoms(a) => Ok(a),
            Store::Engine(_) => Err(Problem::new(
                "the atoms are fixed since the first `run`, which built their bonds",
            )
            .help("move this command before the first `run`")),
        }
    }

    pub fn group(&self, name: &str) -> Result<Arc<Members>> {
        self.groups
            .iter()
            .find(|(n, _)| n == name)
            .map(|(_, m)| m.clone())
            .ok_or_else(|| {
                Problem::new(format!("there is no group `{name}`")).help(suggestion(
                    name,
                    self.groups.iter().map(|(n, _)| n.as_str()),
                ))
            })
    }

    /// One quantity of all atoms.
    ///
    /// # Errors
    /// It does not exist (yet).
    pub fn raw(&self, quantity: Quantity) -> Result<Vec<f64>> {
        let mut values = vec![0.0; self.count()];
        for (b, block) in values.chunks_mut(BLOCK).enumerate() {
            self.store.particles().read(quantity, b * BLOCK, block)?;
        }
        Ok(values)
    }

    /// One quantity of one atom.
    ///
    /// # Errors
    /// It does not exist (yet).
    pub fn one(&self, quantity: Quantity, atom: usize) -> Result<f64> {
        let mut value = [0.0];
        self.store.particles().read(quantity, atom, &mut value)?;
        Ok(value[0])
    }

    /// Positions of all atoms, not wrapped into a periodic box, `[N][3]`.
    ///
    /// # Errors
    /// They cannot be read.
    pub fn unwrapped(&self) -> Result<Vec<[f64; 3]>> {
        let axes = [0, 1, 2].map(|a| self.raw(Quantity::Position(a)));
        let [x, y, z] = axes;
        let (x, y, z) = (x?, y?, z?);
        Ok((0..x.len()).map(|i| [x[i], y[i], z[i]]).collect())
    }
}
