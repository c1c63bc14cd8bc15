//! Stiffness of anisotropic solids in Voigt's order, 11, 22, 33, 23, 13, 12 with shears `2E₂₃, 2E₁₃, 2E₁₂`: from engineering constants, turned, of a
//! plane, its mean (Ting 1996, section 2.3; Jones 1999, sections 2.2 to 2.6).

use crate::law::material::tensor;
use crate::spec::{Moduli, Plane};

/// Stiffness in Voigt's order (pressure); symmetric.
pub type Stiffness = [[f64; 6]; 6];

/// The pairs of axes in Voigt's order.
pub const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [1, 2], [0, 2], [0, 1]];
/// Those of a plane, and those across.
pub const PLANE: [usize; 3] = [0, 1, 5];
pub const ACROSS: [usize; 3] = [2, 3, 4];

/// Stiffness of an orthotropic solid about its own axes (pressure): Young's moduli along them, ν₁₂, ν₁₃, ν₂₃ (contraction along the
/// second under a stress along the first), G₁₂, G₁₃, G₂₃.
///
/// # Errors
/// No stable solid has them.
pub fn orthotropic(
    young: [f64; 3],
    poisson: [f64; 3],
    shear: [f64; 3],
) -> Result<Stiffness, String> {
    let [n12, n13, n23] = poisson;
    let compliance = [
        [1.0 / young[0], -n12 / young[0], -n13 / young[0]],
        [-n12 / young[0], 1.0 / young[1], -n23 / young[1]],
        [-n13 / young[0], -n23 / young[1], 1.0 / young[2]],
    ];
    let unstable = |why: String| {
        Err(format!(
            "no stable solid has these constants: {why}; ν12 is the contraction along 2 under a stress along 1"
        ))
    };
    for (nu, [i, j]) in poisson.into_iter().zip([[0, 1], [0, 2], [1, 2]]) {
        let most = (young[i] / young[j]).sqrt();
        if !(nu.abs() < most) {
            let of = format!("{}{}", i + 1, j + 1);
            return unstable(format!(
                "ν{of} is {nu}, expected below √(E{}/E{}) = {most:.4} in size",
                i + 1,
                j + 1
            ));
        }
    }
    let determinant = tensor::determinant(&compliance);
    if !(determinant > 0.0) {
        let scaled = determinant * young[0] * young[1] * young[2];
        return unstable(format!(
            "1 − ν12ν21 − ν13ν31 − ν23ν32 − 2ν21ν32ν13 is {scaled:.4}, expected above 0"
        ));
    }
    // C = S⁻¹ is the transposed matrix of cofactors over the determinant, and symmetric
    let cofactors = tensor::cofactor(&compliance);
    let mut c = [[0.0; 6]; 6];
    for r in 0..3 {
        for s in 0..3 {
            c[r][s] = cofactors[r][s] / determinant;
        }
    }
    let [g12, g13, g23] = shear;
    [c[3][3], c[4][4], c[5][5]] = [g23, g13, g12];
    Ok(c)
}

/// The stiffness whose upper triangle is given line by line.
pub fn symmetric(upper: &[f64]) -> Stiffness {
    let mut c = [[0.0; 6]; 6];
    let mut all = upper.iter();
    for r in 0..6 {
        for s in r..6 {
            let x = *all.next().unwrap_or(&f64::NAN);
            (c[r][s], c[s][r]) = (x, x);
        }
    }
    c
}

/// The same about axes e₁, e₂, e₃ given in those of the body: `C_ijkl = Q_ia Q_jb Q_kc Q_ld C_abcd`, `Q_ia = e_a · i`.
pub fn turned(c: &Stiffness, axes: &[[f64; 3]; 3]) -> Stiffness {
    // the strain of the body's frame about the solid's axes, ε′ = K ε in Voigt's order; C = Kᵀ C′ K
    let mut k = [[0.0; 6]; 6];
    for (r, [a, b]) in PAIRS.into_iter().enumerate() {
        let engineering = if a == b { 1.0 } else { 2.0 };
        for (s, [i, j]) in PAIRS.into_iter().enumerate() {
            let both = axes[a][i] * axes[b][j] + axes[a][j] * axes[b][i];
            // ε_ij is ½γ_ij, and comes twice
            k[r][s] = engineering * 0.5 * both;
        }
    }
    let mut out = [[0.0; 6]; 6];
    for r in 0..6 {
        for s in 0..6 {
            for a in 0..6 {
                for b in 0..6 {
                    out[r][s] += k[a][r] * c[a][b] * k[b][s];
                }
            }
        }
    }
    out
}

/// Is it that of a stable solid? By the triangle of `C = L Lᵀ`.
pub fn is_positive(c: &Stiffness) -> bool {
    let mut l = [[0.0; 6]; 6];
    for r in 0..6 {
        for s in 0..=r {
            let rest = c[r][s] - (0..s).map(|k| l[r][k] * l[s][k]).sum::<f64>();
            if r > s {
                l[r][s] = rest / l[s][s];
            } else if rest > 1e-14 * c[r][r].abs() {
                l[r][r] = rest.sqrt();
            } else {
                return false;
            }
        }
    }
    true
}

/// Of 11, 22, 12 in the plane.
pub fn in_plane(c: &Stiffness, plane: Plane) -> [[f64; 3]; 3] {
    let part = |rows: [usize; 3], columns: [usize; 3]| rows.map(|r| columns.map(|s| c[r][s]));
    let mut q = part(PLANE, PLANE);
    if plane == Plane::Stress {
        let [across, both] = [part(ACROSS, ACROSS), part(PLANE, ACROSS)];
        let (cofactors, determinant) = (tensor::cofactor(&across), tensor::determinant(&across));
        for r in 0..3 {
            for s in 0..3 {
                for a in 0..3 {
                    for b in 0..3 {
                        q[r][s] -= both[r][a] * cofactors[a][b] / determinant * both[s][b];
                    }
                }
            }
        }
    }
    q
}

/// The isotropic solid nearest to it in Voigt's sense: of the mean stress at given strains (Voigt 1928).
pub fn mean(c: &Stiffness) -> Moduli {
    let along = c[0][0] + c[1][1] + c[2][2];
    let across = c[0][1] + c[0][2] + c[1][2];
    let shear = c[3][3] + c[4][4] + c[5][5];
    Moduli::from_bulk_shear(
        (along + 2.0 * across) / 9.0,
        (along - across + 3.0 * shear) / 15.0,
    )
}
