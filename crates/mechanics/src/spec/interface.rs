//! What joins two bodies.

use super::{FractureSpec, Horizon, Influence, LawSpec, MaterialSpec};

/// Bonds between the points of two bodies that are within a horizon of each other in the reference, by a law of their own.
#[derive(Debug, Clone)]
pub struct InterfaceSpec {
    /// For messages.
    pub name: String,
    /// Names of the two.
    pub bodies: [String; 2],
    /// A bond-based law. Moduli are those of a full family of the first body at this horizon.
    pub law: LawSpec,
    /// In spacings of the first body, or a length.
    pub horizon: Horizon,
    pub influence: Influence,
    /// `None`: its bonds never break.
    pub fracture: Option<FractureSpec>,
}

impl InterfaceSpec {
    /// What its bonds are made of, as of a body; they have no mass.
    pub fn material(&self) -> MaterialSpec {
        MaterialSpec {
            name: self.name.clone(),
            set: "all".into(),
            density: 1.0,
            law: self.law.clone(),
            fracture: self.fracture,
        }
    }
}
