//! A lattice of atoms about its reference.

use super::coupling::Coupling;

/// A directed bond, from a site of cell 0 to a site of this or another cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bond<const D: usize> {
    pub from: usize,
    pub to: usize,
    /// Reference vector (length).
    pub xi: [f64; D],
    /// `V′(r)/r` (force / length).
    pub tension: f64,
    /// `V″(r)` (force / length).
    pub stiffness: f64,
    /// `f′(r)`: what the extension adds to the point scalar of `from`.
    pub share: f64,
}

impl<const D: usize> Bond<D> {
    pub fn length(&self) -> f64 {
        self.xi.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    /// Unit vector.
    pub fn direction(&self) -> [f64; D] {
        let r = self.length();
        self.xi.map(|x| x / r)
    }

    /// What it adds to the stress of a volume `v`.
    pub(crate) fn add_stress(&self, stress: &mut [[f64; D]; D], v: f64) {
        for i in 0..D {
            for j in 0..D {
                stress[i][j] += 0.5 * self.tension * self.xi[i] * self.xi[j] / v;
            }
        }
    }

    /// `tension (1 − n⊗n) + stiffness n⊗n` (force / length).
    pub fn force_constants(&self) -> [[f64; D]; D] {
        let n = self.direction();
        let mut c = [[0.0; D]; D];
        for a in 0..D {
            for b in 0..D {
                c[a][b] = (self.stiffness - self.tension) * n[a] * n[b];
            }
            c[a][a] += self.tension;
        }
        c
    }
}

/// Lattice vectors, sites and bonds.
#[derive(Debug, Clone, PartialEq)]
pub struct Crystal<const D: usize> {
    /// Rows: lattice vectors (length).
    pub cell: [[f64; D]; D],
    /// Positions of the sites in the cell (length).
    pub basis: Vec<[f64; D]>,
    /// `[site]`
    pub mass: Vec<f64>,
    /// Every directed bond of every site of the cell.
    pub bonds: Vec<Bond<D>>,
    /// `[site]` F″ of the point scalar; 0 for pair laws.
    pub curvature: Vec<f64>,
    /// Of many-body potentials: extensions that answer to one another.
    pub couplings: Vec<Coupling<D>>,
}

impl<const D: usize> Crystal<D> {
    /// Volume (area, length) of the cell.
    pub fn volume(&self) -> f64 {
        super::cells::determinant(&self.cell).abs()
    }

    /// Mass per volume (area, length) of the D dimensions.
    pub fn density(&self) -> f64 {
        self.mass.iter().sum::<f64>() / self.volume()
    }

    /// Rows: reciprocal vectors, `a_i · b_j = 2π δ_ij`.
    pub fn reciprocal(&self) -> [[f64; D]; D] {
        super::cells::reciprocal(&self.cell)
    }

    /// Stress of the reference `σ = (1/V) ½ Σ tension ξ⊗ξ` (force / area, in 2-D per thickness); −pressure if isotropic.
    pub fn stress(&self) -> [[f64; D]; D] {
        let v = self.volume();
        let mut s = [[0.0; D]; D];
        for b in &self.bonds {
            b.add_stress(&mut s, v);
        }
        s
    }

    /// Pressure of the reference.
    pub fn pressure(&self) -> f64 {
        let s = self.stress();
        -(0..D).map(|i| s[i][i]).sum::<f64>() / D as f64
    }

    /// Largest net force on a site of the reference: 0 in equilibrium.
    pub fn residual(&self) -> f64 {
        let mut force = vec![[0.0; D]; self.basis.len()];
        for b in &self.bonds {
            for a in 0..D {
                force[b.from][a] += b.tension * b.xi[a];
            }
        }
        force
            .iter()
            .map(|f| f.iter().map(|x| x * x).sum::<f64>().sqrt())
            .fold(0.0, f64::max)
    }

    /// The same crystal turned by an orthogonal matrix, `x → R x`.
    pub fn rotated(&self, r: [[f64; D]; D]) -> Crystal<D> {
        let turn = |x: [f64; D]| -> [f64; D] {
            std::array::from_fn(|i| (0..D).map(|j| r[i][j] * x[j]).sum())
        };
        Crystal {
            cell: self.cell.map(turn),
            basis: self.basis.iter().map(|x| turn(*x)).collect(),
            bonds: self
                .bonds
                .iter()
                .map(|b| Bond {
                    xi: turn(b.xi),
                    ..*b
                })
                .collect(),
            couplings: self.couplings.iter().map(|c| c.turned(turn)).collect(),
            ..self.clone()
        }
    }

    /// The same sites with what another crystal of them says besides.
    pub(crate) fn plus(mut self, other: Crystal<D>) -> Crystal<D> {
        self.bonds.extend(other.bonds);
        self.couplings.extend(other.couplings);
        for (c, more) in self.curvature.iter_mut().zip(other.curvature) {
            *c += more;
        }
        self
    }
}

/// A chain of two unlike atoms per cell, of the lowest symmetry: for tests.
#[cfg(test)]
pub(crate) fn dimer() -> Crystal<1> {
    let bond = |from, to, x: f64, tension, stiffness, share| Bond {
        from,
        to,
        xi: [x],
        tension,
        stiffness,
        share,
    };
    Crystal {
        cell: [[1.0]],
        basis: vec![[0.0], [0.4]],
        mass: vec![1.0, 1.7],
        bonds: vec![
            bond(0, 1, 0.4, 0.3, 2.0, 0.8),
            bond(0, 1, -0.6, 0.2, 1.1, 0.3),
            bond(1, 0, -0.4, 0.3, 2.0, 0.5),
            bond(1, 0, 0.6, 0.2, 1.1, 0.2),
            bond(0, 0, 1.0, -0.1, 0.4, 0.15),
            bond(0, 0, -1.0, -0.1, 0.4, 0.15),
        ],
        curvature: vec![0.9, 1.3],
        couplings: vec![],
    }
}
