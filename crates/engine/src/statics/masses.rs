//! Masses that couple points, as an operator that is factored like a stiffness: `M x` is the force of bonds `C_ij = −M_ij/V_i` and of
//! what stands on the diagonal besides, `Σ_j M_ij`.

use super::direct::Direct;
use super::operator::{Assembled, LinearOperator, Shifted};
use super::support::Support;
use super::vectors::{Block, dot};
use crate::error::SolveError;
use crate::spec::{LinearBody, MassMatrix, add_alike};

/// The masses of a body.
#[derive(Debug, Clone)]
pub struct Masses<const D: usize> {
    matrix: MassMatrix<D>,
    /// `−M_ij/V_i` between different points.
    bonds: LinearBody<D>,
    /// `[N]` sums of rows (mass).
    own: Vec<Block<D>>,
}

impl<const D: usize> Masses<D> {
    /// `None`: every point has a mass of its own alone.
    pub fn of(body: &LinearBody<D>) -> Option<Masses<D>> {
        let matrix = body.mass.clone()?;
        let mut bonds = LinearBody {
            position: body.position.clone(),
            volume: body.volume.clone(),
            density: body.density.clone(),
            period: body.period,
            ..LinearBody::nothing()
        };
        let mut own = vec![[[0.0; D]; D]; body.points()];
        for (i, own) in own.iter_mut().enumerate() {
            let (partners, blocks) = matrix.row(i);
            for (&j, m) in partners.iter().zip(blocks) {
                for a in 0..D {
                    for b in 0..D {
                        own[a][b] += m[a][b];
                    }
                }
                if j as usize != i {
                    bonds.partner.push(j);
                    bonds
                        .block
                        .push(m.map(|row| row.map(|m| -m / body.volume[i])));
                }
            }
            bonds.start.push(bonds.partner.len());
        }
        Some(Masses { matrix, bonds, own })
    }

    pub fn matrix(&self) -> &MassMatrix<D> {
        &self.matrix
    }

    pub fn bytes(&self) -> usize {
        self.matrix.bytes() + self.bonds.bytes() + 8 * D * D * self.own.len()
    }

    /// `M x`
    pub fn times(&self, x: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut product = vec![[0.0; D]; x.len()];
        let mut operator = Assembled(&self.bonds);
        let operator = &mut operator;
        let added = &self.own;
        Shifted { operator, added }.apply(x, &mut product);
        product
    }

    /// `x · M y`
    pub fn dot(&self, x: &[[f64; D]], y: &[[f64; D]]) -> f64 {
        dot(x, &self.times(y))
    }

    /// Factors on the free components.
    ///
    /// # Errors
    /// Nothing is free; the masses are not positive definite; no memory.
    pub fn factors(&self, support: &Support<D>) -> Result<Direct<D>, SolveError> {
        Direct::against(&self.bonds, support, &self.own)
    }

    /// Solves `M a = F` for the free components; held ones keep their `a`, and free ones begin at 0. Masses are well conditioned: what a solution misses is round-off.
    pub fn accelerate(
        &self,
        factors: &Direct<D>,
        support: &Support<D>,
        force: &[[f64; D]],
        a: &mut [[f64; D]],
    ) {
        let found = match a.as_flattened().iter().all(|a| *a == 0.0) {
            true => factors.solve(force),
            false => {
                let mut left = self.times(a);
                for (left, f) in left.iter_mut().zip(force) {
                    *left = crate::array::from_fn(|k| f[k] - left[k]);
                }
                factors.solve(&left)
            }
        };
        for ((a, found), free) in a.iter_mut().zip(&found).zip(&support.free) {
            for k in (0..D).filter(|k| free[*k]) {
                a[k] = found[k];
            }
        }
    }

    /// A body with `K + s M` as its stiffness: bonds, and what stands on the diagonal besides.
    pub fn with(&self, body: &LinearBody<D>, s: f64) -> (LinearBody<D>, Vec<Block<D>>) {
        let mut sum = LinearBody {
            start: vec![0],
            partner: vec![],
            block: vec![],
            load_map: None,
            mass: None,
            ..body.clone()
        };
        for i in 0..body.points() {
            let both = [(body, 1.0), (&self.bonds, s)];
            let rows = both.into_iter().flat_map(|(of, s)| {
                let (partners, blocks) = of.row(i);
                let each = partners.iter().copied().zip(blocks);
                each.map(move |(j, c)| (j, c.map(|row| row.map(|c| s * c))))
            });
            let mut row: Vec<(u32, Block<D>)> = rows.collect();
            add_alike(&mut row);
            for (j, c) in row {
                sum.partner.push(j);
                sum.block.push(c);
            }
            sum.start.push(sum.partner.len());
        }
        let own = self.own.iter().map(|m| m.map(|row| row.map(|m| s * m)));
        (sum, own.collect())
    }
}
