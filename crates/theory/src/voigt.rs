//! Stiffness tensors in Voigt's notation, and the moduli that an isotropic solid like them would have.

use peridyne::spec::{Moduli, Plane};

/// Voigt components of D dimensions: 1, 3 (xx yy xy) or 6 (xx yy zz yz zx xy).
pub const fn components(dimension: usize) -> usize {
    dimension * (dimension + 1) / 2
}

/// The axes of Voigt component `c`.
pub fn axes(dimension: usize, c: usize) -> (usize, usize) {
    match (dimension, c) {
        (2, 2) => (0, 1),
        (3, 3) => (1, 2),
        (3, 4) => (2, 0),
        (3, 5) => (0, 1),
        _ => (c, c),
    }
}

/// Symmetric stiffness `C[I][J]` (pressure) with engineering shears: `W = ½ Σ C_IJ ε_I ε_J`.
#[derive(Debug, Clone, PartialEq)]
pub struct Stiffness {
    pub dimension: usize,
    pub c: [[f64; 6]; 6],
}

/// Moduli of the D-dimensional solid: in 2-D those of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneModuli {
    pub bulk: f64,
    pub shear: f64,
}

/// What bars that are cut along the axes would have, their sides free, and shears in the planes of axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Directional {
    /// `[D]` Young's modulus `1/S_aa` (pressure) along each axis; 0 where nothing resists.
    pub young: Vec<f64>,
    /// `[D][D]` Poisson's ratio `−S_ba/S_aa`: what a bar along a loses along b. NaN on the diagonal and where nothing resists.
    pub poisson: Vec<Vec<f64>>,
    /// Shear modulus per plane, in Voigt's order (2-D xy; 3-D yz, zx, xy).
    pub shear: Vec<f64>,
}

/// How far Young's moduli along the axes may be apart (relative) for a mean to mean something.
const EVEN: f64 = 0.05;

/// How far from isotropic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Anisotropy {
    /// Zener ratio `2 C44 / (C11 − C12)` (2-D: C66), 1 if isotropic, from the means over the axes.
    pub zener: f64,
    /// Universal index: Ranganathan & Ostoja-Starzewski 2008, `5 G_V/G_R + K_V/K_R − 6`; in 2-D Li et al. 2020,
    /// `√((K_V/K_R − 1)² + 2 (G_V/G_R − 1)²)`; 0 if isotropic. `None`: the tensor is not positive definite.
    pub universal: Option<f64>,
}

impl Stiffness {
    fn n(&self) -> usize {
        components(self.dimension)
    }

    /// Mean over axes of the diagonal, the off-diagonal of the normal block, and the shears.
    fn means(&self) -> [f64; 3] {
        let d = self.dimension;
        let normal = (0..d).map(|i| self.c[i][i]).sum::<f64>() / d as f64;
        let pairs = (d * (d - 1) / 2) as f64;
        let cross = (0..d)
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .map(|(i, j)| self.c[i][j])
            .sum::<f64>();
        let shear = (d..self.n()).map(|i| self.c[i][i]).sum::<f64>();
        if d == 1 {
            [normal, 0.0, 0.0]
        } else {
            [normal, cross / pairs, shear / pairs]
        }
    }

    /// Voigt's average (of stiffness, an upper bound).
    pub fn voigt(&self) -> PlaneModuli {
        let d = self.dimension as f64;
        let [a, b, s] = self.means();
        let bulk = (a + (d - 1.0) * b) / d;
        let shear = match self.dimension {
            1 => 0.0,
            2 => 0.25 * (a - b) + 0.5 * s,
            _ => 0.2 * (a - b) + 0.6 * s,
        };
        PlaneModuli { bulk, shear }
    }

    /// Reuss's average (of compliance, a lower bound); `None` if there is no positive definite compliance.
    pub fn reuss(&self) -> Option<PlaneModuli> {
        let inverse = Stiffness {
            dimension: self.dimension,
            c: self.inverse()?,
        };
        let d = self.dimension as f64;
        let [a, b, s] = inverse.means();
        let bulk = 1.0 / (d * (a + (d - 1.0) * b));
        let shear = match self.dimension {
            1 => 0.0,
            2 => 1.0 / ((a - b) + 0.5 * s),
            _ => 1.0 / (0.8 * (a - b) + 0.6 * s),
        };
        Some(PlaneModuli { bulk, shear })
    }

    /// Hill's average of the two; Voigt's where there is no other.
    pub fn hill(&self) -> PlaneModuli {
        let v = self.voigt();
        self.reuss().map_or(v, |r| PlaneModuli {
            bulk: 0.5 * (v.bulk + r.bulk),
            shear: 0.5 * (v.shear + r.shear),
        })
    }

    /// Young's modulus of the D-dimensional solid along each axis, `1/S_ii`; 0 along one that nothing resists.
    pub fn young_along(&self) -> Option<Vec<f64>> {
        Some(self.directional()?.young)
    }

    /// Moduli along the axes. Strains that nothing resists, as those across a sheet of one layer, take part in nothing. `None`: the
    /// rest is not positive definite.
    pub fn directional(&self) -> Option<Directional> {
        let (d, n) = (self.dimension, self.n());
        let largest = (0..n).map(|i| self.c[i][i]).fold(0.0, f64::max);
        let stiff: Vec<usize> = (0..n).filter(|i| self.c[*i][*i] > 1e-9 * largest).collect();
        let inverse = self.inverse_among(&stiff)?;
        let place = |i: usize| stiff.iter().position(|s| *s == i);
        let s = |a: usize, b: usize| Some(inverse[place(a)?][place(b)?]);
        let young = |a: usize| s(a, a).map_or(0.0, |s| 1.0 / s);
        let poisson = |a: usize, b: usize| match (a == b, s(b, a), s(a, a)) {
            (false, Some(across), Some(along)) => -across / along,
            _ => f64::NAN,
        };
        Some(Directional {
            young: (0..d).map(young).collect(),
            poisson: (0..d)
                .map(|a| (0..d).map(|b| poisson(a, b)).collect())
                .collect(),
            shear: (d..n).map(young).collect(),
        })
    }

    /// Do bars along all axes have about the same modulus, so that an isotropic mean stands for them?
    pub fn is_even(&self) -> bool {
        self.young_along().is_some_and(|young| {
            let least = young.iter().copied().fold(f64::INFINITY, f64::min);
            young.iter().all(|e| *e <= least * (1.0 + EVEN))
        })
    }

    /// The same solid with the sides across some axes free: stiffness against strains of the others (pressure).
    pub fn freed(&self, across: &[bool]) -> Stiffness {
        let mut c = self.c;
        for k in (0..self.dimension).filter(|k| across[*k]) {
            let pivot = c[k][k];
            let row = c[k];
            for i in 0..self.n() {
                for j in 0..self.n() {
                    if pivot > 0.0 {
                        c[i][j] -= row[i] * row[j] / pivot;
                    }
                }
            }
            for i in 0..self.n() {
                c[i][k] = 0.0;
                c[k][i] = 0.0;
            }
        }
        Stiffness {
            dimension: self.dimension,
            c,
        }
    }

    /// `None` in 1-D.
    pub fn anisotropy(&self) -> Option<Anisotropy> {
        if self.dimension == 1 {
            return None;
        }
        let [a, b, s] = self.means();
        let v = self.voigt();
        let universal = self.reuss().map(|r| {
            let (k, g) = (v.bulk / r.bulk - 1.0, v.shear / r.shear - 1.0);
            if self.dimension == 2 {
                (k * k + 2.0 * g * g).sqrt()
            } else {
                5.0 * g + k
            }
        });
        Some(Anisotropy {
            zener: 2.0 * s / (a - b),
            universal,
        })
    }

    /// Inverse by Cholesky's decomposition; `None` if not positive definite to round-off.
    fn inverse(&self) -> Option<[[f64; 6]; 6]> {
        self.inverse_among(&(0..self.n()).collect::<Vec<_>>())
    }

    /// The same of the rows and columns of some components.
    fn inverse_among(&self, some: &[usize]) -> Option<[[f64; 6]; 6]> {
        let n = some.len();
        let largest = some.iter().map(|i| self.c[*i][*i]).fold(0.0, f64::max);
        let mut l = [[0.0; 6]; 6];
        for i in 0..n {
            for j in 0..=i {
                let sum = self.c[some[i]][some[j]] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
                if i == j {
                    if sum.is_nan() || sum <= 1e-9 * largest {
                        return None;
                    }
                    l[i][i] = sum.sqrt();
                } else {
                    l[i][j] = sum / l[j][j];
                }
            }
        }
        let mut inverse = [[0.0; 6]; 6];
        for column in 0..n {
            let mut y = [0.0; 6];
            for i in 0..n {
                let e = if i == column { 1.0 } else { 0.0 };
                y[i] = (e - (0..i).map(|k| l[i][k] * y[k]).sum::<f64>()) / l[i][i];
            }
            for i in (0..n).rev() {
                let known: f64 = (i + 1..n).map(|k| l[k][i] * inverse[k][column]).sum();
                inverse[i][column] = (y[i] - known) / l[i][i];
            }
        }
        Some(inverse)
    }
}

impl PlaneModuli {
    /// Young's modulus and Poisson's ratio of the three-dimensional solid of which this is the body: in 2-D a sheet
    /// in plane stress or a slice in plane strain, in 1-D a bar, whose Poisson ratio is unknown (NaN).
    pub fn solid(self, dimension: usize, plane: Plane) -> Moduli {
        let PlaneModuli { bulk: k, shear: g } = self;
        match (dimension, plane) {
            (1, _) => Moduli {
                young: k,
                poisson: f64::NAN,
            },
            (2, plane) => {
                let (e, nu) = (4.0 * k * g / (k + g), (k - g) / (k + g));
                match plane {
                    Plane::Stress => Moduli {
                        young: e,
                        poisson: nu,
                    },
                    Plane::Strain => {
                        let poisson = nu / (1.0 + nu);
                        Moduli {
                            young: e * (1.0 - poisson * poisson),
                            poisson,
                        }
                    }
                }
            }
            _ => Moduli::from_bulk_shear(k, g),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn isotropic(dimension: usize, lambda: f64, g: f64) -> Stiffness {
        let mut c = [[0.0; 6]; 6];
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

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-12 * b.abs().max(1e-3), "{a} is not {b}");
    }

    #[test]
    fn averages_of_an_isotropic_solid_are_its_moduli() {
        let (lambda, g) = (3.0, 2.0);
        for d in [2, 3] {
            let c = isotropic(d, lambda, g);
            for m in [c.voigt(), c.reuss().unwrap(), c.hill()] {
                close(m.bulk, lambda + 2.0 * g / d as f64);
                close(m.shear, g);
            }
            let a = c.anisotropy().unwrap();
            close(a.zener, 1.0);
            assert!(a.universal.unwrap().abs() < 1e-12);
        }
        let m = isotropic(3, lambda, g).hill().solid(3, Plane::Stress);
        close(m.young, g * (3.0 * lambda + 2.0 * g) / (lambda + g));
        close(isotropic(3, lambda, g).young_along().unwrap()[1], m.young);
        // a slice in plane strain is the solid itself
        let slice = isotropic(2, lambda, g).hill().solid(2, Plane::Strain);
        close(slice.young, m.young);
        close(slice.poisson, m.poisson);
        // a sheet has λ replaced by 2λG/(λ + 2G)
        let sheet = isotropic(2, 2.0 * lambda * g / (lambda + 2.0 * g), g);
        let sheet = sheet.hill().solid(2, Plane::Stress);
        close(sheet.young, m.young);
        close(sheet.poisson, m.poisson);
    }

    #[test]
    fn copper_is_as_anisotropic_as_published() {
        // C11, C12, C44 = 168.4, 121.4, 75.4 GPa: A = 3.21, A^U = 1.82
        let mut c = isotropic(3, 121.4, 23.5);
        for i in 3..6 {
            c.c[i][i] = 75.4;
        }
        let a = c.anisotropy().unwrap();
        assert!((a.zener - 3.21).abs() < 0.01, "{}", a.zener);
        assert!((a.universal.unwrap() - 1.82).abs() < 0.02, "{a:?}");
    }

    #[test]
    fn a_sheet_without_stiffness_across_has_moduli_in_its_plane() {
        // 2-D moduli λ = 3, G = 2 in the plane of x and y, nothing along z
        let mut c = isotropic(3, 3.0, 2.0);
        for i in [2, 3, 4] {
            c.c[i] = [0.0; 6];
            c.c.iter_mut().for_each(|r| r[i] = 0.0);
        }
        let found = c.directional().unwrap();
        // E = 4 G (λ + G)/(λ + 2G), ν = λ/(λ + 2G)
        close(found.young[0], 40.0 / 7.0);
        close(found.young[1], 40.0 / 7.0);
        assert_eq!(found.young[2], 0.0);
        close(found.poisson[0][1], 3.0 / 7.0);
        assert!(found.poisson[0][2].is_nan() && found.poisson[2][0].is_nan());
        assert_eq!(found.shear[..2], [0.0; 2]);
        close(found.shear[2], 2.0);
        assert!(!c.is_even() && isotropic(3, 3.0, 2.0).is_even());
        // a plate of a solid: C_xx − C_xz²/C_zz
        let plate = isotropic(3, 3.0, 2.0).freed(&[false, false, true]);
        close(plate.c[0][0], 7.0 - 9.0 / 7.0);
        close(plate.directional().unwrap().young[0], 2.0 * 13.0 / 5.0);
    }

    #[test]
    fn a_tensor_without_compliance_has_no_reuss_average() {
        assert_eq!(isotropic(3, -2.0, 1.0).reuss(), None);
        assert_eq!(isotropic(2, 1.0, 0.0).young_along(), None);
    }
}
