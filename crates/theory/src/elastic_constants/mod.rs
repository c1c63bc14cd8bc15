//! Elastic constants of a crystal, from its bonds: second derivatives of the energy by Lagrangian strain, with sites
//! free to relax.
//!
//! With `r² = ξ·(1 + 2E)·ξ` and rigid sites
//! `C_ijkl = (1/2V) Σ_bonds (stiffness − tension)/r² ξ_i ξ_j ξ_k ξ_l + (1/V) Σ_s F″_s (Σ share ξ_i ξ_j/r)(Σ share ξ_k ξ_l/r)`.
//! Spans of many-body potentials add `(1/V) Σ_pq k_pq y_i y_j y_k y_l`, the first two of p and the others of q: d²/2 is linear in E.
//! Sites that are not equivalent move along: `C −= Λᵀ Φ⁻¹ Λ / V`, Φ the force constants of sites against each other, Λ the
//! forces on sites per strain.
//!
//! If the reference is under stress σ, three tensors differ (Wallace 1970; Barron & Klein 1965):
//! - `C` above, of the energy,
//! - `B_ijkl = C_ijkl + ½(δ_ik σ_jl + δ_jk σ_il + δ_il σ_jk + δ_jl σ_ik) − σ_ij δ_kl` of stress against strain: under pressure P
//!   B11 = C11 − P, B12 = C12 + P, B44 = C44 − P; it decides stability,
//! - `A_ijkl = C_ijkl + δ_ik σ_jl` of waves: `ρ ω² u_i = A_ijkl k_j k_l u_k`.

use crate::crystal::{Bond, Crystal};
use crate::dispersion::hermitian::{Matrix, eigen};
use crate::voigt::{Stiffness, axes, components};
use peridyne::spec::{Moduli, Plane};

/// Constants of the three axes of a square or cubic crystal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic {
    pub c11: f64,
    pub c12: f64,
    pub c44: f64,
}

impl Cubic {
    /// Bulk modulus in `dimension` dimensions.
    pub fn bulk(&self, dimension: usize) -> f64 {
        (self.c11 + (dimension as f64 - 1.0) * self.c12) / dimension as f64
    }

    /// Zener's ratio `2 c44/(c11 − c12)`: 1 if isotropic.
    pub fn zener(&self) -> f64 {
        2.0 * self.c44 / (self.c11 - self.c12)
    }

    /// Cauchy's relation: c12 − c44 is 0 for pair laws whose sites are centres of symmetry, without stress.
    pub fn cauchy(&self) -> f64 {
        self.c12 - self.c44
    }
}

impl Stiffness {
    /// What a directed bond adds to `C` of sites carried along, in the volume `v`, and to the strain of its site's scalar.
    pub(crate) fn add_bond<const D: usize>(
        &mut self,
        bond: &Bond<D>,
        share: &mut [f64; 6],
        v: f64,
    ) {
        let n = components(D);
        let r = bond.length();
        let pair = |c: usize| {
            let (a, b) = axes(D, c);
            bond.xi[a] * bond.xi[b]
        };
        for i in 0..n {
            for j in 0..n {
                let k = (bond.stiffness - bond.tension) / (r * r);
                self.c[i][j] += 0.5 * k * pair(i) * pair(j) / v;
            }
            share[i] += bond.share * pair(i) / r;
        }
    }

    /// What a site's scalar adds to `C`, all its bonds seen.
    pub(crate) fn add_site(&mut self, share: &[f64; 6], curvature: f64, v: f64) {
        let n = components(self.dimension);
        for i in 0..n {
            for j in 0..n {
                self.c[i][j] += curvature * share[i] * share[j] / v;
            }
        }
    }

    /// From `C`, of the energy, to `B`, of stress against strain, under the stress `s`.
    pub(crate) fn under_stress<const D: usize>(mut self, s: &[[f64; D]; D]) -> Stiffness {
        let d = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        for v in 0..components(D) {
            for w in 0..components(D) {
                let ((i, j), (k, l)) = (axes(D, v), axes(D, w));
                self.c[v][w] += 0.5
                    * (d(i, k) * s[j][l]
                        + d(j, k) * s[i][l]
                        + d(i, l) * s[j][k]
                        + d(j, l) * s[i][k])
                    - s[i][j] * d(k, l);
            }
        }
        self
    }

    /// `C` from how a body of equal points under the stress `s` answers long waves (Born & Huang 1954): brackets
    /// `[ik,jl] = (1/2V) Σ_bonds K_ik ξ_j ξ_l`, given as `[i][j][k][l]`, are `½ (C_ijkl + C_ilkj) + δ_ik σ_jl`, so that with `{ik,jl}` = those less the last term
    /// `C_ijkl = {ik,jl} + {jk,il} − {ij,kl}`. What is not symmetric in the pairs ij and kl, as no energy has it, is left out.
    pub(crate) fn of_waves<const D: usize>(bracket: &[f64], s: &[[f64; D]; D]) -> Stiffness {
        let brace = |i: usize, k: usize, j: usize, l: usize| {
            let own = if i == k { s[j][l] } else { 0.0 };
            bracket[((i * D + j) * D + k) * D + l] - own
        };
        let at = |v: usize, w: usize| {
            let ((i, j), (k, l)) = (axes(D, v), axes(D, w));
            brace(i, k, j, l) + brace(j, k, i, l) - brace(i, j, k, l)
        };
        let mut c = [[0.0; 6]; 6];
        for v in 0..components(D) {
            for w in 0..components(D) {
                c[v][w] = 0.5 * (at(v, w) + at(w, v));
            }
        }
        Stiffness { dimension: D, c }
    }

    /// The three constants of a square or cubic crystal along its axes, or `None` if some component differs by more than
    /// `tolerance` of the largest.
    pub fn cubic(&self, tolerance: f64) -> Option<Cubic> {
        let d = self.dimension;
        let n = components(d);
        let found = Cubic {
            c11: self.c[0][0],
            c12: if d > 1 { self.c[0][1] } else { 0.0 },
            c44: if d > 1 { self.c[d][d] } else { 0.0 },
        };
        let limit = tolerance * (0..n).map(|i| self.c[i][i].abs()).fold(0.0, f64::max);
        let fits = (0..n).all(|i| {
            (0..n).all(|j| {
                let expected = match (i < d, j < d) {
                    (true, true) if i == j => found.c11,
                    (true, true) => found.c12,
                    _ if i == j => found.c44,
                    _ => 0.0,
                };
                (self.c[i][j] - expected).abs() <= limit
            })
        });
        fits.then_some(found)
    }
}

/// Stiffness of the isotropic continuum of these moduli in `dimension` dimensions (per thickness in 2-D): what LPS and PMB
/// stand for, to compare with a lattice's.
pub fn continuum(dimension: usize, plane: Plane, moduli: Moduli) -> Stiffness {
    let g = moduli.shear();
    let mut c = [[0.0; 6]; 6];
    if dimension == 1 {
        c[0][0] = moduli.young;
        return Stiffness { dimension, c };
    }
    let lambda = moduli.lame_of(dimension, plane);
    for i in 0..dimension {
        for j in 0..dimension {
            c[i][j] = lambda + if i == j { 2.0 * g } else { 0.0 };
        }
    }
    for i in dimension..components(dimension) {
        c[i][i] = g;
    }
    Stiffness { dimension, c }
}

impl<const D: usize> Crystal<D> {
    /// `C` in Voigt's notation (energy / volume of D dimensions), sites relaxed; `None` if the sites are unstable against
    /// each other.
    pub fn elastic_constants(&self) -> Option<Stiffness> {
        let rigid = self.rigid_elastic_constants();
        let sites = self.basis.len();
        if sites == 1 {
            return Some(rigid);
        }
        let coupling = self.coupling();
        let inverse = self.relaxation()?;
        let v = self.volume();
        let n = components(D);
        let mut c = rigid.c;
        for i in 0..n {
            for j in 0..n {
                for (mode, compliance) in &inverse {
                    let force = |v: usize| -> f64 {
                        mode.iter().zip(&coupling).map(|(m, f)| m * f[v]).sum()
                    };
                    c[i][j] -= force(i) * force(j) * compliance / v;
                }
            }
        }
        Some(Stiffness { dimension: D, c })
    }

    /// `C` with all sites carried along by the strain.
    pub fn rigid_elastic_constants(&self) -> Stiffness {
        let mut stiffness = Stiffness {
            dimension: D,
            c: [[0.0; 6]; 6],
        };
        let mut shares = vec![[0.0; 6]; self.basis.len()];
        for bond in &self.bonds {
            stiffness.add_bond(bond, &mut shares[bond.from], self.volume());
        }
        for (share, curvature) in shares.iter().zip(&self.curvature) {
            stiffness.add_site(share, *curvature, self.volume());
        }
        let v = self.volume();
        for coupling in &self.couplings {
            for (span, pull) in coupling.spans.iter().zip(coupling.pulls()) {
                for (row, x) in stiffness.c.iter_mut().zip(span.by_strain()) {
                    row.iter_mut().zip(pull).for_each(|(c, p)| *c += x * p / v);
                }
            }
        }
        stiffness
    }

    /// `[site·D + axis][Voigt]`: `∂²(energy per cell)/∂w ∂E`, w the displacement of a site beyond the strain's, where no net force acts on sites
    /// ([`Crystal::residual`]).
    fn coupling(&self) -> Vec<[f64; 6]> {
        let n = components(D);
        let mut force = vec![[0.0; 6]; self.basis.len() * D];
        let mut shares = vec![[0.0; 6]; self.basis.len()];
        for bond in &self.bonds {
            let r = bond.length();
            for i in 0..n {
                let (a, b) = axes(D, i);
                let pair = bond.xi[a] * bond.xi[b];
                shares[bond.from][i] += bond.share * pair / r;
                for axis in 0..D {
                    // ½ per directed bond; tensions add the net force on a site, which is 0
                    let along = (bond.stiffness - bond.tension) / (r * r) * bond.xi[axis] * pair;
                    force[bond.to * D + axis][i] += 0.5 * along;
                    force[bond.from * D + axis][i] -= 0.5 * along;
                }
            }
        }
        for bond in &self.bonds {
            let n_bond = bond.direction();
            let f = self.curvature[bond.from] * bond.share;
            for i in 0..n {
                for axis in 0..D {
                    let x = f * n_bond[axis] * shares[bond.from][i];
                    force[bond.to * D + axis][i] += x;
                    force[bond.from * D + axis][i] -= x;
                }
            }
        }
        for coupling in &self.couplings {
            for (span, pull) in coupling.spans.iter().zip(coupling.pulls()) {
                let y = span.vector();
                for axis in 0..D {
                    for i in 0..n {
                        force[span.sites[1] * D + axis][i] += y[axis] * pull[i];
                        force[span.sites[0] * D + axis][i] -= y[axis] * pull[i];
                    }
                }
            }
        }
        force
    }

    /// Modes and compliances of sites against each other: all of the force constants' spectrum but the D translations.
    fn relaxation(&self) -> Option<Vec<(Vec<f64>, f64)>> {
        let dynamical = self.dynamical_matrix([0.0; D]);
        let n = dynamical.size();
        let mut constants = Matrix::zero(n);
        for i in 0..n {
            for j in 0..n {
                let m = (self.mass[i / D] * self.mass[j / D]).sqrt();
                constants.add(i, j, dynamical.get(i, j) * m);
            }
        }
        let (values, vectors) = eigen(&constants);
        let top = values.last()?.abs();
        let translations = values.iter().filter(|x| x.abs() <= 1e-10 * top).count();
        if values[0] < -1e-10 * top || translations != D {
            return None;
        }
        Some(
            values
                .into_iter()
                .zip(vectors)
                .skip(D)
                // real and symmetric: so are its vectors, as no rotation brought in a phase
                .map(|(x, v)| (v.iter().map(|c| c.re).collect(), 1.0 / x))
                .collect(),
        )
    }

    /// `B`: stress against strain about the stressed reference. Symmetric if the stress is a pressure.
    pub fn stress_strain(&self) -> Option<Stiffness> {
        Some(self.elastic_constants()?.under_stress(&self.stress()))
    }

    /// The long-wave (acoustic) tensor `A_ijkl n_j n_l` of a unit direction (energy / volume); its eigenvalues are ρv².
    pub fn acoustic_tensor(&self, n: [f64; D]) -> Option<[[f64; D]; D]> {
        let c = self.elastic_constants()?;
        let s = self.stress();
        let voigt = |i: usize, j: usize| {
            (0..components(D))
                .find(|v| {
                    let (a, b) = axes(D, *v);
                    (a, b) == (i, j) || (b, a) == (i, j)
                })
                .unwrap_or(0)
        };
        let pull: f64 = (0..D)
            .flat_map(|j| (0..D).map(move |l| (j, l)))
            .map(|(j, l)| s[j][l] * n[j] * n[l])
            .sum();
        Some(std::array::from_fn(|i| {
            std::array::from_fn(|k| {
                let mut sum = if i == k { pull } else { 0.0 };
                for j in 0..D {
                    for l in 0..D {
                        sum += c.c[voigt(i, j)][voigt(k, l)] * n[j] * n[l];
                    }
                }
                sum
            })
        }))
    }

    /// Speeds of long waves along a unit direction, squared, rising.
    pub fn sound(&self, n: [f64; D]) -> Option<Vec<f64>> {
        let tensor = self.acoustic_tensor(n)?;
        let mut m = Matrix::zero(D);
        for i in 0..D {
            for j in 0..D {
                m.add(i, j, (tensor[i][j] / self.density()).into());
            }
        }
        Some(eigen(&m).0)
    }
}

#[cfg(test)]
mod tests;
