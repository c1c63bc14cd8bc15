//! Masses that couple points: the inertia of a body whose points carry others with them.
//!
//! Force on i at accelerations a: `F_i = Σ_j M_ij a_j`, the point itself included. Of a coarsened body `M = Sᵀ M⁰ S`, with the shapes S
//! in which retained points carry removed ones (Guyan 1965, Reduction of stiffness and mass matrices, AIAA J. 3 (2), 380).

use super::rows::rows;

/// How far `|M_ij − M_jiᵀ|`, and the sum of all from the masses of the points, may be from 0, relative.
const ROUND_OFF: f64 = 1e-9;

/// A symmetric matrix of D×D blocks in rows.
#[derive(Debug, Clone, PartialEq)]
pub struct MassMatrix<const D: usize> {
    /// `[N + 1]`: where each point's partners begin.
    pub start: Vec<usize>,
    /// Partners of each point, in ascending order, itself among them.
    pub partner: Vec<u32>,
    /// `M_ij` (mass) per partner.
    pub block: Vec<[[f64; D]; D]>,
}

impl<const D: usize> MassMatrix<D> {
    /// Partners and masses of point `i`.
    pub fn row(&self, i: usize) -> (&[u32], &[[[f64; D]; D]]) {
        let row = self.start[i]..self.start[i + 1];
        (&self.partner[row.clone()], &self.block[row])
    }

    /// `M_ij`, if i knows j.
    pub fn between(&self, i: usize, j: usize) -> Option<&[[f64; D]; D]> {
        let (partners, blocks) = self.row(i);
        let k = partners.binary_search(&(j as u32)).ok()?;
        Some(&blocks[k])
    }

    /// Is it a symmetric matrix of points with these masses?
    ///
    /// # Errors
    /// What does not fit.
    pub fn check(&self, mass: &[f64]) -> Result<(), String> {
        let n = mass.len();
        rows(&self.start, n, &self.partner, n)?;
        if self.partner.len() != self.block.len() {
            let (blocks, partners) = (self.block.len(), self.partner.len());
            return Err(format!("{blocks} masses of {partners} partners"));
        }
        let largest = self.block.as_flattened().as_flattened().iter();
        let largest = largest.fold(0.0f64, |m, x| m.max(x.abs()));
        let mut sum = [[0.0; D]; D];
        for i in 0..n {
            let (partners, blocks) = self.row(i);
            if !partners.is_sorted_by(|a, b| a < b) || self.between(i, i).is_none() {
                return Err(format!(
                    "the masses of point {i} are not in ascending order of its partners, itself among them"
                ));
            }
            for (&j, here) in partners.iter().zip(blocks) {
                let there = self.between(j as usize, i);
                for a in 0..D {
                    for b in 0..D {
                        sum[a][b] += here[a][b];
                        let off = there.map_or(f64::INFINITY, |m| (here[a][b] - m[b][a]).abs());
                        if !(off <= ROUND_OFF * largest) {
                            return Err(format!(
                                "the masses between points {i} and {j} are not the same from both ends"
                            ));
                        }
                    }
                }
            }
        }
        let total: f64 = mass.iter().sum();
        for a in 0..D {
            for b in 0..D {
                let whole = if a == b { total } else { 0.0 };
                if !((sum[a][b] - whole).abs() <= ROUND_OFF * total) {
                    return Err(format!(
                        "the sum of all masses is {}, and the points have {whole} together",
                        sum[a][b]
                    ));
                }
            }
        }
        Ok(())
    }

    pub fn bytes(&self) -> usize {
        8 * self.start.len() + 4 * self.partner.len() + 8 * D * D * self.block.len()
    }
}
