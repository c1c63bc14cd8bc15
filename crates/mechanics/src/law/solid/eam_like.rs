//! The EAM-like solid with a quadratic volume energy: the linear peridynamic solid (LPS) and related laws.
//!
//! `W_i = ½ κ θ_i² + (β / 2 m_i) Σ_j ω ν V_j e²`, `θ_i = (n/m_i) Σ_j ω r0 ν V_j e`, `m_i = Σ_j ω r0² ν V_j`,
//! `e = |ξ+η| − |ξ|`. This is seleson2014 (A.9)–(A.13) with the pair term (A.14) and the volume term (A.16); the
//! force density on i is `Σ_j [(P_i + P_j) ω r0 + (β/m_i + β/m_j) ω e] ν V_j (ξ+η)/|ξ+η|`, `P = n κ θ / m`.
//!
//! LPS in three dimensions (Silling et al. 2007; sandia2010 (3.0.3)): n = 3, κ = K − 5G/3, β = 15 G. In D dimensions
//! isotropy of the family gives n = D, β = D(D+2) G, κ = λ − G with the plane's λ (see [`Solid::lps`]).
//! The energy is the one whose derivative is the force, also after bonds broke.

use crate::execute::lane::Lane;
use crate::law::{BondFactors, Law};
use crate::spec::{LawSpec, Plane};

/// Field 0: pressure `P`; field 1: `B = β/m`. Bond constant `k = ω ν V_j`.
#[derive(Debug, Clone, Copy)]
pub struct EamLike {
    /// `n² κ / β²`, so that `P = ratio · B² · Σ k r0² s`.
    pub ratio: f64,
}

impl Law for EamLike {
    const SHARES: bool = true;
    const FIELDS: usize = 2;

    #[inline(always)]
    fn constant<L: Lane>(self, _r0: L, _inv_r0: L, weight: L) -> L {
        weight
    }
    #[inline(always)]
    fn pull<L: Lane>(self, k: L, g: L, i: [L; 2], j: [L; 2]) -> L {
        // r0/r = 1 − g and e/r = g
        let p = i[0] + j[0];
        k * g.fma((i[1] + j[1]) - p, p)
    }
    #[inline(always)]
    fn scaled_pull<L: Lane>(self, k: L, g: L, i: [L; 2], j: [L; 2], f: BondFactors<L>) -> L {
        let end = |x: [L; 2], pressure: L| [x[0] * pressure, x[1] * f.pair];
        self.pull(k, g, end(i, f.own), end(j, f.other))
    }
    #[inline(always)]
    fn pair_energy<L: Lane>(self, x: L, i: [L; 2], _: [L; 2]) -> L {
        L::splat(0.5) * i[1] * x
    }
    #[inline(always)]
    fn pressure_factor<L: Lane>(self, b: L) -> L {
        L::splat(self.ratio) * b * b
    }
}

/// Constants of one material in the shape above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// Dilatation normalisation n.
    pub n: f64,
    /// Volume stiffness κ.
    pub kappa: f64,
    /// Pair stiffness β.
    pub beta: f64,
}

impl Solid {
    /// LPS in `d` dimensions from the shear modulus G and the Lamé constant λ that acts in those dimensions
    /// (plane strain and 3-D: λ; plane stress: 2λG/(λ+2G); 1-D: E − 2G).
    ///
    /// From `⟨(n·ε·n)²⟩ = (tr²ε + 2 ε:ε)/(D(D+2))` over an isotropic family.
    pub fn lps(d: usize, lambda: f64, shear: f64) -> Solid {
        let n = d as f64;
        Solid {
            n,
            kappa: lambda - shear,
            beta: n * (n + 2.0) * shear,
        }
    }

    /// Of a state-based law of a spec; `None`: it is none.
    pub fn of_law(d: usize, plane: Plane, law: &LawSpec) -> Option<Solid> {
        match law {
            LawSpec::Lps(moduli) => Some(Solid::lps(d, moduli.lame_of(d, plane), moduli.shear())),
            LawSpec::Lps3d { bulk, shear } => Some(Solid {
                n: 3.0,
                kappa: bulk - 5.0 / 3.0 * shear,
                beta: 15.0 * shear,
            }),
            LawSpec::EamLike { pair, volume } => Some(Solid {
                n: 3.0,
                kappa: volume / 3.0,
                beta: 0.5 * pair,
            }),
            LawSpec::Pmb(_)
            | LawSpec::Springs(_)
            | LawSpec::Atoms(_)
            | LawSpec::Micromoduli(_)
            | LawSpec::Named(_) => None,
        }
    }

    /// Young's modulus of a line of it: `n² κ + β`.
    pub fn along_a_line(&self) -> f64 {
        self.n * self.n * self.kappa + self.beta
    }

    /// `n² κ / β²`.
    pub fn ratio(&self) -> f64 {
        self.n * self.n * self.kappa / (self.beta * self.beta)
    }
}
