//! `lattice`: the grid that atoms are created on and the unit of `units lattice`.

use peridyne::execute::memory;
use peridyne::quantity::rounded;

use super::atoms::SiteLattice;

/// A square or simple cubic lattice along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// Edge of the cell (length).
    pub constant: f64,
    /// Position of site (0,0,0) in cells, each in [0, 1).
    pub origin: [f64; 3],
    /// `lattice none`: only a unit of length, no atoms can be created on it.
    pub sites: bool,
}

impl Lattice {
    pub fn site_lattice(&self) -> SiteLattice {
        SiteLattice {
            spacing: self.constant,
            offset: self.origin.map(|o| self.constant * o),
        }
    }

    /// Range of site numbers along `axis` that covers `low..high` with a cell to spare.
    fn range(&self, axis: usize, low: f64, high: f64) -> (f64, f64) {
        let cell = |x: f64| x / self.constant - self.origin[axis];
        (cell(low).floor() - 1.0, cell(high).ceil() + 1.0)
    }

    /// Sites inside `low..high` that `accept` takes, in LAMMPS's order (x fastest, then y, then z).
    ///
    /// # Errors
    /// A sentence if there are too many to count.
    pub fn sites_in(
        &self,
        dimension: usize,
        low: [f64; 3],
        high: [f64; 3],
        mut accept: impl FnMut([f64; 3]) -> bool,
    ) -> Result<Vec<[i32; 3]>, String> {
        let mut range = [(0, 0); 3];
        let mut total = 1.0f64;
        for a in 0..dimension {
            let (first, last) = self.range(a, low[a], high[a]);
            if !(first.abs() < 1e9 && last.abs() < 1e9) {
                return Err(format!(
                    "the box is {} lattice cells long",
                    rounded((high[a] - low[a]) / self.constant, 4)
                ));
            }
            total *= last - first + 1.0;
            range[a] = (first as i32, last as i32);
        }
        if total > 4e9 {
            return Err(format!(
                "the box holds {} lattice sites, more than 4e9",
                rounded(total, 4)
            ));
        }
        let lattice = self.site_lattice();
        let mut sites = Vec::new();
        // an atom takes this and more before it moves (bytes)
        let most = memory::available().map_or(f64::INFINITY, |left| left / 120.0);
        for k in range[2].0..=range[2].1 {
            if sites.len() as f64 > most {
                return Err(format!(
                    "more than {} atoms do not fit into the memory that is left; the box holds {} lattice sites: check the lattice constant and the region",
                    rounded(most, 2),
                    rounded(total, 2)
                ));
            }
            for j in range[1].0..=range[1].1 {
                for i in range[0].0..=range[0].1 {
                    if accept(lattice.position([i, j, k])) {
                        sites.push([i, j, k]);
                    }
                }
            }
        }
        Ok(sites)
    }
}
