//! Elastic constants of a crystal, from its bonds: second derivatives of the energy by Lagrangian strain, with sites
//! free to relax.
//!
//! With `r² = ξ·(1 + 2E)·ξ` and rigid sites
//! `C_ijkl = (1/2V) Σ_bonds (stiffness − tension)/r² ξ_i ξ_j ξ_k ξ_l + (1/V) Σ_s F″_s (Σ share ξ_i ξ_j/r)(Σ share ξ_k ξ_l/r)`.
//! Sites that are not equivalent move along: `C −= Λᵀ Φ⁻¹ Λ / V`, Φ the force constants of sites against each other, Λ the
//! forces on sites per strain.
//!
//! If the reference is under stress σ, three tensors differ (Wallace 1970; Barron & Klein 1965):
//! - `C` above, of the energy,
//! - `B_ijkl = C_ijkl + ½(δ_ik σ_jl + δ_jk σ_il + δ_il σ_jk + δ_jl σ_ik) − σ_ij δ_kl` of stress against strain: under pressure P
//!   B11 = C11 − P, B12 = C12 + P, B44 = C44 − P; it decides stability,
//! - `A_ijkl = C_ijkl + δ_ik σ_jl` of waves: `ρ ω² u_i = A_ijkl k_j k_l u_k`.

use crate::crystal::Crystal;
use crate::dispersion::hermitian::{Matrix, eigen};
use crate::stiffness::{Stiffness, axes, components};
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
    let (g, l) = (moduli.shear(), moduli.lame());
    let mut c = [[0.0; 6]; 6];
    if dimension == 1 {
        c[0][0] = moduli.young;
        return Stiffness { dimension, c };
    }
    let lambda = match (dimension, plane) {
        (2, Plane::Stress) => 2.0 * l * g / (l + 2.0 * g),
        _ => l,
    };
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
        let v = self.volume();
        let n = components(D);
        let mut c = [[0.0; 6]; 6];
        let mut shares = vec![[0.0; 6]; self.basis.len()];
        for bond in &self.bonds {
            let r = bond.length();
            let pair = |c: usize| {
                let (a, b) = axes(D, c);
                bond.xi[a] * bond.xi[b]
            };
            for i in 0..n {
                for j in 0..n {
                    let k = (bond.stiffness - bond.tension) / (r * r);
                    c[i][j] += 0.5 * k * pair(i) * pair(j) / v;
                }
                shares[bond.from][i] += bond.share * pair(i) / r;
            }
        }
        for (g, curvature) in shares.iter().zip(&self.curvature) {
            for i in 0..n {
                for j in 0..n {
                    c[i][j] += curvature * g[i] * g[j] / v;
                }
            }
        }
        Stiffness { dimension: D, c }
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
        let mut b = self.elastic_constants()?;
        let s = self.stress();
        let d = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        for v in 0..components(D) {
            for w in 0..components(D) {
                let ((i, j), (k, l)) = (axes(D, v), axes(D, w));
                b.c[v][w] += 0.5
                    * (d(i, k) * s[j][l]
                        + d(j, k) * s[i][l]
                        + d(i, l) * s[j][k]
                        + d(j, l) * s[i][k])
                    - s[i][j] * d(k, l);
            }
        }
        Some(b)
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
mod tests {
    use super::*;
    use crate::crystal::{LatticeSolid, Reach, dimer};
    use peridyne::law::number::Number;
    use peridyne::law::potential::Potential;
    use peridyne::law::potential::lennard_jones::LennardJones;
    use peridyne::law::solid::eam_like::Solid;
    use peridyne::space::lattice::LatticeKind;
    use peridyne::spec::{Calibration, Horizon, LawSpec, PmbStiffness};

    /// f = e^{−βr}, F = −√ρ, φ = A e^{−αr}.
    struct Metal;
    impl Potential for Metal {
        const EMBEDDED: bool = true;
        fn cutoff(&self) -> f64 {
            f64::INFINITY
        }
        fn pair<N: Number>(&self, q: N) -> N {
            q.sqrt().times(-4.0).exp().times(3.0)
        }
        fn density<N: Number>(&self, q: N) -> N {
            q.sqrt().times(-1.7).exp()
        }
        fn embedding<N: Number>(&self, density: N) -> N {
            N::constant(0.0) - density.sqrt()
        }
    }

    const LJ: LennardJones = LennardJones {
        epsilon: 1.0,
        sigma: 1.0,
    };

    fn of(p: &impl Potential, kind: LatticeKind, a: f64, shells: u32) -> Crystal<3> {
        Crystal::of_potential(p, kind, a, 1.3, Reach::Shells(shells))
            .unwrap()
            .0
    }

    /// Sound from the elastic constants is the slope of the dispersion, whatever the stress.
    fn sound_is_the_slope(crystal: &Crystal<3>) {
        for n in [
            [1.0, 0.0, 0.0],
            [0.6, 0.8, 0.0],
            [2.0 / 3.0, 1.0 / 3.0, -2.0 / 3.0],
        ] {
            let sound = crystal.sound(n).unwrap();
            let k = 1e-3;
            let squares = crystal.squares(n.map(|x| x * k));
            for (v, w) in sound.iter().zip(&squares) {
                let scale = sound[2].abs();
                assert!((w / (k * k) - v).abs() < 1e-5 * scale, "{n:?}: {w} {v}");
            }
        }
    }

    #[test]
    fn long_waves_travel_with_the_elastic_constants() {
        for a in [1.4, 1.5536, 1.65] {
            sound_is_the_slope(&of(&LJ, LatticeKind::Fcc, a, 5));
            sound_is_the_slope(&of(&Metal, LatticeKind::Fcc, a, 3));
        }
        sound_is_the_slope(&of(&Metal, LatticeKind::Bcc, 1.3, 3));
        let body = LatticeSolid::new(LatticeKind::Diamond, 1.0, Horizon::Ratio(1));
        sound_is_the_slope(&body.bond_based(1.0).unwrap());
        sound_is_the_slope(&body.state_based(Solid::lps(3, 4.0, 1.0)).unwrap());
        let mut cubic = body;
        cubic.kind = LatticeKind::Cubic;
        cubic.horizon = Horizon::Ratio(3);
        sound_is_the_slope(&cubic.state_based(Solid::lps(3, 4.0, 1.0)).unwrap());
    }

    #[test]
    fn sites_of_a_chain_with_two_atoms_relax() {
        let crystal = dimer();
        assert!(crystal.residual() < 1e-15);
        let sound = crystal.sound([1.0]).unwrap()[0];
        let k = 1e-3;
        assert!((crystal.squares([k])[0] / (k * k) / sound - 1.0).abs() < 1e-6);
        let rigid = crystal.rigid_elastic_constants().c[0][0];
        assert!(crystal.elastic_constants().unwrap().c[0][0] < 0.99 * rigid);
    }

    #[test]
    fn sites_of_diamond_relax() {
        let body = LatticeSolid::new(LatticeKind::Diamond, 1.0, Horizon::Ratio(1));
        let crystal = body.bond_based::<3>(1.0).unwrap();
        let rigid = crystal.rigid_elastic_constants().cubic(1e-12).unwrap();
        let free = crystal.elastic_constants().unwrap().cubic(1e-12).unwrap();
        assert!((free.c11 - rigid.c11).abs() < 1e-12 * rigid.c11);
        assert!(free.c44 < 0.999 * rigid.c44);
        assert!(rigid.cauchy().abs() < 1e-12 * rigid.c11 && free.cauchy() > 0.0);
    }

    #[test]
    fn constants_are_second_derivatives_of_the_energy() {
        // isotropic strain: V d²E/dV² from finite differences of the energy per atom, at pressure
        let a = 1.48;
        let energy = |a: f64| {
            let reach = Reach::Shells(4);
            Crystal::<3>::of_potential(&Metal, LatticeKind::Fcc, a, 1.0, reach)
                .unwrap()
                .1
        };
        let v = |a: f64| a * a * a / 4.0;
        let h = 1e-4;
        let slope = (energy(a + h).pressure - energy(a - h).pressure) / (v(a + h) - v(a - h));
        let bulk = -v(a) * slope;
        let b = of(&Metal, LatticeKind::Fcc, a, 4).stress_strain().unwrap();
        let cubic = b.cubic(1e-12).unwrap();
        assert!(
            (cubic.bulk(3) / bulk - 1.0).abs() < 1e-6,
            "{} {bulk}",
            cubic.bulk(3)
        );
        let c = of(&Metal, LatticeKind::Fcc, a, 4)
            .elastic_constants()
            .unwrap()
            .cubic(1e-12)
            .unwrap();
        let p = energy(a).pressure;
        assert!(p.abs() > 0.01);
        let close = |x: f64, y: f64| assert!((x - y).abs() < 1e-12 * c.c11.abs(), "{x} {y}");
        close(cubic.c11, c.c11 - p);
        close(cubic.c12, c.c12 + p);
        close(cubic.c44, c.c44 - p);
    }

    #[test]
    fn pair_laws_obey_cauchy_and_embedding_breaks_it() {
        let pair = of(&LJ, LatticeKind::Fcc, 1.5, 5)
            .elastic_constants()
            .unwrap();
        assert!(pair.cubic(1e-12).unwrap().cauchy().abs() < 1e-11 * pair.c[0][0]);
        let metal = of(&Metal, LatticeKind::Fcc, 1.5, 3)
            .elastic_constants()
            .unwrap();
        assert!(metal.cubic(1e-12).unwrap().cauchy() > 0.01 * metal.c[0][0]);
    }

    #[test]
    fn peridynamic_lattices_tend_to_their_continuum() {
        // the mean over directions of a calibrated lattice is the continuum, its anisotropy goes
        let moduli = Moduli {
            young: 2.5,
            poisson: 0.25,
        };
        let law = LawSpec::Pmb(PmbStiffness::Young(2.5));
        let limit = continuum(3, Plane::Strain, moduli).voigt();
        let mut zener = vec![];
        for m in [1, 3, 10] {
            let body = LatticeSolid::new(LatticeKind::Cubic, 1.0, Horizon::Ratio(m));
            let c: Crystal<3> = body
                .of_law(law, Plane::Strain, Calibration::Discrete)
                .unwrap();
            let c = c.elastic_constants().unwrap();
            let mean = c.voigt();
            assert!((mean.bulk / limit.bulk - 1.0).abs() < 1e-12);
            assert!((mean.shear / limit.shear - 1.0).abs() < 1e-12);
            zener.push(c.cubic(1e-10).unwrap().zener());
        }
        // nearest neighbours alone do not resist shear
        assert_eq!(zener[0], 0.0);
        assert!((zener[1] - 1.0).abs() < 0.25, "{zener:?}");
        assert!((zener[2] - 1.0).abs() < 0.02, "{zener:?}");
        // LPS has its bulk modulus on any lattice, and any Poisson ratio
        for poisson in [0.1, 0.4] {
            let moduli = Moduli {
                young: 2.0,
                poisson,
            };
            let body = LatticeSolid::new(LatticeKind::Fcc, 1.0, Horizon::Ratio(2));
            let c: Crystal<3> = body
                .of_law(LawSpec::Lps(moduli), Plane::Strain, Calibration::Discrete)
                .unwrap();
            let c = c.elastic_constants().unwrap();
            assert!((c.voigt().bulk / moduli.bulk() - 1.0).abs() < 1e-12);
            assert!((c.voigt().shear / moduli.shear() - 1.0).abs() < 1e-12);
        }
        let bar = LatticeSolid::new(LatticeKind::Chain, 0.1, Horizon::Ratio(4));
        let law = LawSpec::Pmb(PmbStiffness::Young(7.0));
        let c: Crystal<1> = bar
            .of_law(law, Plane::Stress, Calibration::Discrete)
            .unwrap();
        assert!((c.elastic_constants().unwrap().c[0][0] - 7.0).abs() < 1e-13);
        // the continuum's constant is 1 + 1/m too stiff on a chain
        let c: Crystal<1> = bar
            .of_law(law, Plane::Stress, Calibration::Continuum)
            .unwrap();
        assert!((c.elastic_constants().unwrap().c[0][0] - 7.0 * 1.25).abs() < 1e-12);
    }

    #[test]
    fn turned_crystals_have_turned_constants() {
        let crystal = of(&Metal, LatticeKind::Fcc, 1.5, 3);
        let (c, s) = (0.6, 0.8);
        let turned = crystal.rotated([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]);
        let (a, b) = (
            crystal.elastic_constants().unwrap(),
            turned.elastic_constants().unwrap(),
        );
        assert!(b.cubic(1e-3).is_none());
        let close = |x: f64, y: f64| (x / y - 1.0).abs() < 1e-12;
        assert!(close(a.voigt().bulk, b.voigt().bulk));
        // c'11 = c11 − 2 (c11 − c12 − 2 c44) c²s²
        let k = a.cubic(1e-12).unwrap();
        let expected = k.c11 - 2.0 * (k.c11 - k.c12 - 2.0 * k.c44) * c * c * s * s;
        assert!(close(b.c[0][0], expected));
    }
}
