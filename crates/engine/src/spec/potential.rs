//! Interatomic potentials as data: form, constants, cut-off. What they do stands in [`law::potential`](crate::law::potential).

use std::sync::Arc;

/// A potential of one kind of atom.
#[derive(Debug, Clone, PartialEq)]
pub struct PotentialSpec {
    pub form: Form,
    /// Cut-off of pair potentials (length), and how they end there; ∞: none.
    pub cutoff: f64,
    pub end: End,
}

/// All forms of potentials; adding one adds a variant here and an arm in [`PotentialSpec::apply`].
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    LennardJones(LennardJones),
    Morse(Morse),
    Buckingham(Buckingham),
    /// Embedded-atom model in closed form.
    Mei(Box<MeiSpec>),
    /// Embedded-atom model from tables.
    Tabulated(Arc<TableSpec>),
}

/// How a potential ends at its cut-off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// Energy and force jump to 0.
    Truncated,
    /// The energy goes to 0, the force jumps: `φ(r) − φ(rc)`.
    Shifted,
    /// Energy and force go to 0: `φ(r) − φ(rc) − (r − rc) φ′(rc)` (shifted force).
    ShiftedForce,
    /// Times `g((r − rn)/(rc − rn))`, `g = (1 − x)³ (1 + 3x + 6x²)`, from the distance rn (length) on: two derivatives are
    /// smooth (seleson2014 (3.9)).
    Smooth(f64),
}

/// `φ = 4ε [(σ/r)¹² − (σ/r)⁶]` (Jones 1924; seleson2009 (5.1)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LennardJones {
    /// Depth ε (energy).
    pub epsilon: f64,
    /// Distance σ of zero energy (length).
    pub sigma: f64,
}

/// `φ = D [e^(−2α(r−r0)) − 2 e^(−α(r−r0))]` (Morse 1929).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Morse {
    /// Depth D (energy).
    pub depth: f64,
    /// Stiffness α of the well (1 / length).
    pub alpha: f64,
    /// Distance r0 of least energy (length).
    pub distance: f64,
}

/// `φ = A e^(−r/ρ) − C / r⁶` (Buckingham 1938).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Buckingham {
    /// Strength A of the repulsion (energy).
    pub strength: f64,
    /// Its range ρ (length).
    pub range: f64,
    /// Dispersion constant C (energy · length⁶).
    pub dispersion: f64,
}

/// The embedded-atom model in closed form of Mei, Davenport & Fernando (1991); distances in any unit of length, energies in any unit of energy.
#[derive(Debug, Clone, PartialEq)]
pub struct MeiSpec {
    /// Cohesive energy Ec (energy).
    pub cohesive: f64,
    /// Energy φe of the pair term (energy).
    pub pair: f64,
    pub alpha: f64,
    pub beta: f64,
    pub gamma: f64,
    pub lambda: f64,
    /// c_0 … c_5.
    pub density: [f64; 6],
    /// fe/ρe: densities are in units of ρe.
    pub density_scale: f64,
    /// μ of the pair term (length).
    pub pair_length: f64,
    /// μf of the density (length).
    pub density_length: f64,
    /// r_n and r_c (length): where g begins to fall, and is 0.
    pub near: f64,
    pub cutoff: f64,
    /// Shells of the crystal that F is made for: number of atoms s_m and distance p_m in units of `nearest`.
    pub shells: Vec<(f64, f64)>,
    /// Nearest distance of the crystal at equilibrium (length).
    pub nearest: f64,
    /// p_m is multiplied by this where it is not a distance.
    pub shell_scale: f64,
}

/// An embedded-atom model from tables, as eam/alloy and eam files hold them (one element): values at `m Δρ` (F) and `m Δr` (f and
/// r φ), m = 0, 1, …, at least five each.
#[derive(Debug, Clone, PartialEq)]
pub struct TableSpec {
    /// Δρ.
    pub density_step: f64,
    /// F (energy).
    pub embedding: Vec<f64>,
    /// Δr (length).
    pub step: f64,
    /// f.
    pub density: Vec<f64>,
    /// r φ (energy · length).
    pub pair: Vec<f64>,
    /// Distance beyond which there is nothing (length).
    pub cutoff: f64,
}

impl TableSpec {
    /// Can splines be laid through it?
    ///
    /// # Errors
    /// What cannot.
    pub fn check(&self) -> Result<(), String> {
        for (name, values) in [
            ("the embedding energy", &self.embedding),
            ("the density", &self.density),
            ("the pair term", &self.pair),
        ] {
            if values.len() < 5 || values.iter().any(|v| !v.is_finite()) {
                return Err(format!(
                    "{name} needs a table of five or more finite values"
                ));
            }
        }
        if self.density.len() != self.pair.len() {
            return Err("density and pair term need tables of one length".into());
        }
        let positive = |x: f64| x > 0.0 && x.is_finite();
        match [self.density_step, self.step, self.cutoff]
            .into_iter()
            .all(positive)
        {
            true => Ok(()),
            false => Err("steps and cut-off must be positive".into()),
        }
    }

    /// The same model with lengths times `length` and energies times `energy`.
    pub fn scaled(&self, length: f64, energy: f64) -> TableSpec {
        let times = |values: &[f64], x: f64| values.iter().map(|v| v * x).collect();
        TableSpec {
            density_step: self.density_step,
            embedding: times(&self.embedding, energy),
            step: self.step * length,
            density: self.density.clone(),
            pair: times(&self.pair, energy * length),
            cutoff: self.cutoff * length,
        }
    }
}
