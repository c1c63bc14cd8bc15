//! Numbers of points that bonds of a law need: from constants of materials and the weighted volume of each point.

use crate::law::Law;
use crate::law::solid::eam_like::Solid;

/// How the point fields of a law follow from the weighted volume of each point.
#[derive(Debug, Clone)]
pub enum PointConstants {
    /// No fields.
    None,
    /// Field 0 is a constant per material.
    PerMaterial(Vec<f64>),
    /// Both fields per slot.
    PerPoint(Vec<[f64; 2]>),
    /// EAM-like: per material `(n, κ, β)`.
    Solid(Vec<Solid>),
}

impl PointConstants {
    /// Both fields of a slot with this weighted volume, and its pressure factor where those differ.
    pub(super) fn fields(&self, slot: usize, material: usize, m: f64) -> ([f64; 2], Option<f64>) {
        match self {
            PointConstants::None => ([0.0; 2], None),
            PointConstants::PerMaterial(c) => ([c[material], 0.0], None),
            PointConstants::PerPoint(all) => (all[slot], None),
            PointConstants::Solid(solids) => {
                let of = &solids[material];
                let b = if m > 0.0 { of.beta / m } else { 0.0 };
                let q = unlike(solids).then(|| of.ratio() * b * b);
                ([0.0, b], q)
            }
        }
    }

    /// n and 1/m of a point, from its `β/m`; 0 of laws without.
    #[inline]
    pub(super) fn per_weight(&self, material: usize, by_weight: impl Fn() -> f64) -> [f64; 2] {
        match self {
            PointConstants::Solid(s) => [s[material].n, by_weight() / s[material].beta],
            PointConstants::None | PointConstants::PerMaterial(_) | PointConstants::PerPoint(_) => {
                [0.0; 2]
            }
        }
    }
}

/// Pressure factors differ from the law's own where materials with unlike `κ/β²` meet.
fn unlike(solids: &[Solid]) -> bool {
    solids.iter().any(|s| s.ratio() != solids[0].ratio())
}

/// `P / Σ k r0² s` at a slot: its own of `pressure`, else the law's, from `β/m`.
#[inline]
pub(super) fn pressure_factor<W: Law>(
    law: W,
    pressure: &[f64],
    slot: usize,
    by_weight: impl Fn() -> f64,
) -> f64 {
    match pressure.get(slot) {
        Some(q) => *q,
        None => law.pressure_factor(by_weight()),
    }
}

/// Kernels have two point fields, and laws that share a scalar keep it and the weighted volume there.
///
/// # Panics
/// If the law says otherwise.
pub(super) fn laws_fields<W: Law>() {
    assert!(
        W::FIELDS <= 2 && (!W::SHARES || W::FIELDS == 2),
        "a law has at most two point fields, and two if it shares a scalar"
    );
}
