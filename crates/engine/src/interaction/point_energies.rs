//! Energies and dilatations of points, as an observing sweep finds them.

use crate::body::Body;
use crate::execute::blocks::Shared;
use crate::law::Law;

/// Energies and dilatation of all points, per slot.
#[derive(Debug, Clone, Default)]
pub struct PointEnergies {
    /// Strain energy density of bonds (energy / volume).
    pub strain: Vec<f64>,
    /// Energy density of repulsion inside the family (energy / volume).
    pub repulsion: Vec<f64>,
    /// Dilatation θ (–).
    pub dilatation: Vec<f64>,
    /// `Σ k r0²` over whole bonds, of peridynamic laws: over the weighted volume m where there is one (–).
    pub whole: Vec<f64>,
}

impl PointEnergies {
    /// Make dilatations of `Σ k r0² s`: times `n/m` for laws that share, else `D Σ k r0² s / Σ k r0²`. `factors` of a
    /// slot are n and 1/m.
    pub(super) fn dilate<W: Law, const D: usize>(
        &mut self,
        body: &Body<D>,
        factors: impl Fn(usize) -> [f64; 2],
    ) {
        for &slot in &body.slots {
            let i = slot as usize;
            let share = self.dilatation[i];
            if W::SHARES {
                let [n, per_m] = factors(i);
                self.dilatation[i] = n * per_m * share;
                self.whole[i] *= per_m;
            } else if self.whole[i] > 0.0 {
                self.dilatation[i] = D as f64 * share / self.whole[i];
            }
        }
    }

    /// All zero, for so many slots.
    pub fn zeros(&mut self, len: usize) {
        for field in [
            &mut self.strain,
            &mut self.repulsion,
            &mut self.dilatation,
            &mut self.whole,
        ] {
            field.clear();
            field.resize(len, 0.0);
        }
    }
}

/// Where an energy pass writes, per slot.
#[derive(Clone, Copy)]
pub(super) struct EnergyFields {
    pub strain: Shared,
    pub repulsion: Shared,
    /// `Σ k r0² s`, where the dilatation will be.
    pub share: Shared,
    /// `Σ k r0²` of what is whole.
    pub weight: Shared,
}

impl EnergyFields {
    /// Into `out`, for a body of so many slots, all zero before.
    pub fn of(out: &mut PointEnergies, len: usize) -> Self {
        out.zeros(len);
        EnergyFields {
            strain: Shared(out.strain.as_mut_ptr()),
            repulsion: Shared(out.repulsion.as_mut_ptr()),
            share: Shared(out.dilatation.as_mut_ptr()),
            weight: Shared(out.whole.as_mut_ptr()),
        }
    }
}
