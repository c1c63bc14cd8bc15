//! Particles that are bonded to each other whatever moves.

/// What some bonded particles say, with its constants. Energies as LAMMPS's styles of the same name have them, without halves.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// `K (r − r₀)²`.
    HarmonicBond { stiffness: f64, length: f64 },
    /// `K (θ − θ₀)²` (radians); its force has no direction where the angle is straight or 0, and is taken as 0 there.
    HarmonicAngle { stiffness: f64, angle: f64 },
    /// `K (1 + cos θ)`.
    CosineAngle { stiffness: f64 },
    /// `K (cos θ − cos θ₀)²`.
    CosineSquaredAngle { stiffness: f64, cosine: f64 },
    /// `Σ_n C_n cosⁿ φ`; φ is 0 where the ends are on the same side. OPLS, Ryckaert–Bellemans and Fourier's with phases 0 and π are such
    /// sums.
    Dihedral { powers: Vec<f64> },
    /// `K (χ − χ₀)²` (radians), χ from 0 to π the angle between the planes of the first three and of the last three, 0 where the first and
    /// the last are on the same side. Where χ is 0 or π and χ₀ is neither, its force has no direction and is taken as 0.
    HarmonicImproper { stiffness: f64, angle: f64 },
}

/// Some particles and what they say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BondedTerm {
    /// Place of its form.
    pub form: u32,
    /// Places of its points in the cloud, as many as the form has; the rest is 0.
    pub points: [u32; 4],
}

/// Topology and constants of molecules.
#[derive(Debug, Clone, PartialEq)]
pub struct BondedSpec {
    pub forms: Vec<Form>,
    pub terms: Vec<BondedTerm>,
    /// What is left of the potential between points that are one, two and three bonds apart (LAMMPS's `special_bonds lj`).
    pub special: [f64; 3],
}
