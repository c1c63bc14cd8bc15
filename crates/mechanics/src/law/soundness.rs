//! What a linear body does: force, and how far it is from what an elastic one must be.

use crate::spec::LinearBody;

/// How far a body is from what an elastic one must be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Soundness {
    /// Largest `|V_i C_ij − V_j C_jiᵀ|` over the largest `|V_i C_ij|`: 0 where action is reaction.
    pub asymmetry: f64,
    /// Largest force density under a rigid rotation (per radian) over the largest `Σ_j |C_ij||ξ|`: 0 for free bodies, about the
    /// reference without stress.
    pub rotation: f64,
}

/// Largest component.
fn largest<const D: usize>(c: &[[f64; D]; D]) -> f64 {
    c.iter().flatten().fold(0.0, |m, x| x.abs().max(m))
}

impl<const D: usize> LinearBody<D> {
    /// Its symmetric part, `V_i C_ij` and the transpose of `V_j C_ji` to their mean: of a body whose forces have no resultant its own diagonal, too.
    pub fn symmetric(mut self) -> Self {
        for i in 0..self.points() {
            for k in self.start[i]..self.start[i + 1] {
                let j = self.partner[k] as usize;
                let row = &self.partner[self.start[j]..self.start[j + 1]];
                let Ok(back) = row.binary_search(&(i as u32)) else {
                    continue;
                };
                if j < i {
                    continue;
                }
                let back = self.start[j] + back;
                for a in 0..D {
                    for b in 0..D {
                        let here = self.volume[i] * self.block[k][a][b];
                        let there = self.volume[j] * self.block[back][b][a];
                        let mean = 0.5 * (here + there);
                        self.block[k][a][b] = mean / self.volume[i];
                        self.block[back][b][a] = mean / self.volume[j];
                    }
                }
            }
        }
        self
    }

    /// Force density on point `i` at displacements `u`.
    #[inline]
    pub fn force(&self, u: &[[f64; D]], i: usize) -> [f64; D] {
        let (partners, blocks) = self.row(i);
        let mut f = [0.0; D];
        for (&j, c) in partners.iter().zip(blocks) {
            for b in 0..D {
                let eta = u[j as usize][b] - u[i][b];
                for a in 0..D {
                    f[a] += c[a][b] * eta;
                }
            }
        }
        f
    }

    /// Is action reaction, and is a rotation free of force?
    pub fn soundness(&self) -> Soundness {
        let (mut most, mut apart, mut torque, mut scale) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
        for i in 0..self.points() {
            let (partners, blocks) = self.row(i);
            let mut turned = [[[0.0; D]; D]; D];
            let mut sum = 0.0;
            for (&j, c) in partners.iter().zip(blocks) {
                let j = j as usize;
                let back = self.micromodulus(j, i);
                for a in 0..D {
                    for b in 0..D {
                        let here = self.volume[i] * c[a][b];
                        let there = back.map_or(0.0, |back| self.volume[j] * back[b][a]);
                        most = most.max(here.abs());
                        apart = apart.max((here - there).abs());
                    }
                }
                let xi = self.xi(i, j);
                sum += largest(c) * xi.iter().map(|x| x * x).sum::<f64>().sqrt();
                // spin in the plane of axes m < n: η = (−ξ_n, ξ_m)
                for m in 0..D {
                    for n in m + 1..D {
                        for a in 0..D {
                            turned[m][n][a] += c[a][n] * xi[m] - c[a][m] * xi[n];
                        }
                    }
                }
            }
            scale = scale.max(sum);
            torque = torque.max(turned.iter().flatten().map(|f| norm(f)).fold(0.0, f64::max));
        }
        let over = |x: f64, y: f64| if y > 0.0 { x / y } else { 0.0 };
        Soundness {
            asymmetry: over(apart, most),
            rotation: over(torque, scale),
        }
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three points of a chain, springs 1 and 2 between them.
    fn chain() -> LinearBody<1> {
        LinearBody {
            position: vec![[0.0], [1.0], [3.0]],
            volume: vec![1.0, 2.0, 1.0],
            density: vec![1.0; 3],
            period: [None],
            start: vec![0, 1, 3, 4],
            partner: vec![1, 0, 2, 1],
            block: [1.0, 0.5, 1.0, 2.0].map(|c| [[c]]).to_vec(),
            load_map: None,
            mass: None,
        }
    }

    #[test]
    fn forces_are_those_of_springs() {
        let body = chain();
        let f = [0, 1, 2].map(|i| body.force(&[[0.0], [0.1], [0.4]], i));
        let expected = [0.1, -0.05 + 0.3, -0.6];
        assert!(
            f.iter()
                .zip(expected)
                .all(|(f, e)| (f[0] - e).abs() < 1e-15),
            "{f:?}"
        );
        assert_eq!(body.range(), 2.0);
        assert_eq!(
            body.soundness(),
            Soundness {
                asymmetry: 0.0,
                rotation: 0.0
            }
        );
        let mut unlike = chain();
        unlike.block[0][0][0] = 1.5;
        assert_eq!(unlike.soundness().asymmetry, 0.25);
    }

    #[test]
    fn a_rotation_needs_central_bonds() {
        // two points along x: a bond that resists shear alone turns against a rotation
        let bond = |c: [[f64; 2]; 2]| LinearBody::<2> {
            position: vec![[0.0, 0.0], [1.0, 0.0]],
            volume: vec![1.0; 2],
            density: vec![1.0; 2],
            period: [None; 2],
            start: vec![0, 1, 2],
            partner: vec![1, 0],
            block: vec![c; 2],
            load_map: None,
            mass: None,
        };
        assert_eq!(bond([[3.0, 0.0], [0.0, 0.0]]).soundness().rotation, 0.0);
        assert_eq!(bond([[3.0, 0.0], [0.0, 3.0]]).soundness().rotation, 1.0);
    }
}
