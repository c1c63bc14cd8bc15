//! Words of the deck that stand for one of several.

use schemars::JsonSchema;
use serde::Deserialize;

macro_rules! names {
    ($($(#[$doc:meta])* $name:ident { $($(#[$each:meta])* $variant:ident),+ $(,)? })+) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
        #[serde(rename_all = "snake_case")]
        pub enum $name { $($(#[$each])* $variant),+ }
    )+};
}

names! {
    PlaneName { Stress, Strain }
    /// What a fracture energy is made of.
    CriterionName {
        /// A critical stretch, the same for all bonds.
        Stretch,
        /// A critical work, the same for all bonds: a bond breaks where the force states of both ends have done that work on it (Foster, Silling & Chen 2011).
        BondEnergy,
    }
    LatticeName { Chain, Square, Triangular, Cubic, Bcc, Fcc, Diamond }
    AxisName { X, Y, Z }
    MixingName {
        /// σ = ½(σ_i + σ_j), ε = √(ε_i ε_j).
        Arithmetic,
        /// σ = √(σ_i σ_j), ε = √(ε_i ε_j).
        Geometric,
        /// σ⁶ = ½(σ_i⁶ + σ_j⁶), ε = 2 √(ε_i ε_j) σ_i³ σ_j³ / (σ_i⁶ + σ_j⁶).
        Sixthpower,
    }
    KernelName {
        /// c (1 − r²/S²)ⁿ, n the smoothness.
        Polynomial,
        /// Cubic spline that ends at S.
        Bspline,
        /// Quartic spline that ends at S.
        Quartic,
        /// c exp(−r²/(2 S²)), to 8 S.
        Gaussian,
        /// c for r < S.
        Step,
        /// c in a cube of edge S.
        Cell,
    }
    PartitionName {
        /// All of a term to its centre, a pair's in halves to its ends.
        Site,
        /// In equal parts to all atoms of a term.
        Equal,
    }
    PairForceName {
        /// Along the lines between particles: stress is symmetric.
        Distances,
        /// From the star of a term's centre.
        Differences,
    }
    BondMixingName {
        /// Harmonic mean: the two half bonds in series.
        Harmonic,
        /// Arithmetic mean: the two half bonds in parallel.
        Arithmetic,
        /// The weaker of both, as LAMMPS does.
        Minimum,
    }
    InfluenceName {
        /// 1
        Constant,
        /// 1/ξ
        Inverse,
        /// 1 − ξ/δ
        Linear,
        /// exp(−(2ξ/δ)²)
        Gaussian,
        /// Cubic B-spline with support δ, 1 at ξ = 0.
        CubicSpline,
    }
    CalibrationName {
        /// Constants from the integrals over the full ball.
        Continuum,
        /// Constants from the sums over a full family of this body.
        Discrete,
    }
    SurfaceName {
        None,
        /// Every uniform strain is an equilibrium under its uniform traction.
        Exact,
        /// By the volume of the families.
        Volume,
        /// By the strain energy under uniaxial stretch.
        Energy,
        /// By the stiffness of a point while the others are fixed.
        Force,
    }
    FamilyName {
        /// Stencil on lattices, list of a cloud, current neighbours of atoms.
        Auto,
        /// Offsets of a lattice, nothing stored per bond.
        Stencil,
        /// Stored bonds of the reference.
        List,
        /// Atoms within the cut-off now.
        Neighbours,
        /// Atoms within `horizon` in the reference, for ever: a potential as a peridynamic material.
        Reference,
    }
    /// What says how far an increment goes.
    ControlName {
        /// t, of which loads are functions.
        Load,
        /// The next bond (sequentially linear analysis): loads are proportional to t, an increment goes to where a bond is at its critical stretch, however little t is
        /// there, and the next one begins without it.
        SequentiallyLinear,
        /// How far bonds open, `opening`: loads are proportional to t, the load factor, which may rise and fall (indirect displacement control).
        IndirectDisplacement,
        /// How far points go, `arc_length`: the same, of bodies that snap through or buckle.
        ArcLength,
    }
    /// Of a deck with [statics] and [run].
    StageName {
        /// While the body is loaded.
        Statics,
        /// From its last equilibrium on.
        Dynamics,
    }
    /// How diffusion is integrated in time.
    DiffusionName {
        /// Forward Euler, in as many equal parts of a step as its own stable step asks for.
        Explicit,
        /// Backward Euler: first order in the step, stable at any.
        Implicit,
        /// Crank and Nicolson: second order in the step, stable at any; steps that are too long ring.
        CrankNicolson,
        /// At the end of every step what no longer changes.
        Steady,
    }
    MeasureName {
        /// Force that constraints exert on the set, per axis.
        Reaction,
        /// Moment of that force about a fixed point.
        Moment,
        /// Kinetic, strain and repulsion energy of the set.
        Energy,
        /// Mean of a field over the points of the set.
        Mean,
        /// Smallest value.
        Min,
        /// Largest value.
        Max,
        /// Sum over the points.
        Sum,
        /// A field at the point of the set that is nearest to a place.
        Value,
        /// Force on a rigid body, torque, centre, velocity, rotation, angular velocity, kinetic energy and what its friction took.
        RigidBody,
        /// J-integral and stress intensity K of a crack tip (2-D statics), by a rectangle around it.
        JIntegral,
        /// Where a crack ends, its length, its speed (in motion), and its branches.
        CrackTip,
        /// How much farther two points are apart than in the reference, and how far they have moved apart along each axis.
        Opening,
        /// Number of fragments, the mass of the one with the most points, and that of all others.
        Fragments,
    }
    CrackName {
        /// Excluded from the families.
        Excluded,
        /// Broken at the start: they count as damage.
        Broken,
    }
}

impl MeasureName {
    /// As it is written.
    pub fn title(self) -> &'static str {
        match self {
            MeasureName::Reaction => "reaction",
            MeasureName::Moment => "moment",
            MeasureName::Energy => "energy",
            MeasureName::Mean => "mean",
            MeasureName::Min => "min",
            MeasureName::Max => "max",
            MeasureName::Sum => "sum",
            MeasureName::Value => "value",
            MeasureName::RigidBody => "rigid_body",
            MeasureName::JIntegral => "j_integral",
            MeasureName::CrackTip => "crack_tip",
            MeasureName::Opening => "opening",
            MeasureName::Fragments => "fragments",
        }
    }
}
