//! What spreads through the bonds of the reference: heat, a species.

use crate::expression::Expression;

/// What spreads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Heat (energy); its column is `temperature`.
    Heat,
    /// A species (amount, a plain number); its column is `concentration` (amount / volume).
    Species,
}

impl Quantity {
    /// As decks and messages call it.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Heat => "heat",
            Quantity::Species => "species",
        }
    }

    /// Name of its column.
    pub fn column(self) -> &'static str {
        match self {
            Quantity::Heat => "temperature",
            Quantity::Species => "concentration",
        }
    }
}

/// A scalar T that bonds conduct: `C_i dT_i/dt = Σ_j g_ij (T_j − T_i) + P_i` with the capacities C and conductances g of
/// the `diffusion` of `peridyne`.
#[derive(Debug, Clone)]
pub struct DiffusionSpec {
    pub quantity: Quantity,
    pub method: DiffusionMethod,
    /// Value at which bonds have their reference lengths.
    pub reference: f64,
    /// Do bonds that break in the run go on conducting? Those that a pre-crack cut never do.
    pub across_broken: bool,
    /// Is heat made and taken by deformation, `−T α tr σ̇` per volume at a temperature held (Thomson 1857)? T from absolute zero, capacities
    /// at constant strain; not where points stand still.
    pub deformation: bool,
    /// In the order of the materials of the spec.
    pub materials: Vec<DiffusionMaterial>,
    /// Values at t = 0 on sets, in order; `reference` where none says.
    pub initial: Vec<(String, Expression)>,
    pub conditions: Vec<DiffusionCondition>,
}

impl DiffusionSpec {
    /// Does any material expand by it?
    pub fn expands(&self) -> bool {
        self.materials.iter().any(|m| m.expansion != 0.0)
    }
}

/// What a material conducts, holds, and how it expands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiffusionMaterial {
    /// Thermal conductivity (power / length / temperature); of a species its diffusivity (length² / time).
    pub conductivity: f64,
    /// Of heat: capacity per mass (energy / mass / temperature); a species has 1 per volume, whatever this is.
    pub capacity: f64,
    /// Linear strain per unit of the quantity's column (1 / temperature; volume / amount).
    pub expansion: f64,
}

/// How values go on in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DiffusionMethod {
    /// Forward Euler in as many equal parts of a step as its own stable step asks for; `safety`: part of that.
    Explicit { safety: f64 },
    /// `C (T₁ − T₀) = Δt (θ P(T₁, t₁) + (1 − θ) P(T₀, t₀))`: backward Euler for θ = 1, Crank and Nicolson for θ = ½.
    Implicit { theta: f64, tolerance: f64 },
    /// At the end of every step the values that no longer change.
    Steady { tolerance: f64 },
}

/// What is done to a set; expressions of reference x, y, z and t.
#[derive(Debug, Clone)]
pub struct DiffusionCondition {
    pub set: String,
    pub kind: DiffusionKind,
}

/// Area (length²) of the surface of a set; `None`: that of the face that it stands for, as of a traction. What comes in through it
/// is spread over the points of the set by volume.
pub type Area = Option<f64>;

#[derive(Debug, Clone)]
pub enum DiffusionKind {
    /// Held at this value.
    Value(Expression),
    /// Into the body per area and time.
    Flux { value: Expression, area: Area },
    /// Into the body per volume and time.
    Source(Expression),
    /// Through the surface, by the value at the points of the set.
    Exchange { law: Exchange, area: Area },
}

impl DiffusionKind {
    pub fn depends_on_time(&self) -> bool {
        match self {
            DiffusionKind::Value(e)
            | DiffusionKind::Flux { value: e, .. }
            | DiffusionKind::Source(e) => e.depends_on_time(),
            DiffusionKind::Exchange { law, .. } => match law {
                Exchange::Convection {
                    coefficient,
                    ambient,
                }
                | Exchange::Radiation {
                    coefficient,
                    ambient,
                } => coefficient.depends_on_time() || ambient.depends_on_time(),
            },
        }
    }
}

#[derive(Debug, Clone)]
pub enum Exchange {
    /// `h (T_∞ − T)` per area and time.
    Convection {
        coefficient: Expression,
        ambient: Expression,
    },
    /// `c (T_∞⁴ − T⁴)` per area and time, `c` emissivity times the constant of Stefan and Boltzmann; T from absolute zero.
    Radiation {
        coefficient: Expression,
        ambient: Expression,
    },
}
