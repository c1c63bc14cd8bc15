//! Energies and dilatations of points, as an observing sweep finds them.

use crate::body::Body;
use crate::execute::blocks::Shared;
use crate::law::Law;
use std::ops::Range;

/// Energies and dilatation of all points, per slot.
#[derive(Debug, Clone, Default)]
pub struct PointEnergies {
    /// Strain energy density of bonds (energy / volume).
    pub strain: Vec<f64>,
    /// Energy density of repulsion inside the family (energy / volume).
    pub repulsion: Vec<f64>,
    /// Dilatation θ (–).
    pub dilatation: Vec<f64>,
    /// `Σ k r0²` over intact bonds, of peridynamic laws: over the weighted volume m where there is one (–).
    pub whole: Vec<f64>,
}

impl PointEnergies {
    /// Room for a body of so many slots, to write: whatever stands there is overwritten.
    pub fn for_slots(&mut self, len: usize) -> PointEnergiesMut<'_> {
        let PointEnergies {
            strain,
            repulsion,
            dilatation,
            whole,
        } = self;
        for column in [&mut *strain, repulsion, dilatation, whole] {
            column.resize(len, 0.0);
        }
        PointEnergiesMut {
            strain,
            repulsion,
            dilatation,
            whole,
        }
    }
}

/// [`PointEnergies`] of a body, or of a range of its slots, to write.
#[derive(Debug)]
pub struct PointEnergiesMut<'a> {
    /// Strain energy density of bonds (energy / volume).
    pub strain: &'a mut [f64],
    /// Energy density of repulsion inside the family (energy / volume).
    pub repulsion: &'a mut [f64],
    /// Dilatation θ (–).
    pub dilatation: &'a mut [f64],
    /// [`PointEnergies::whole`] (–).
    pub whole: &'a mut [f64],
}

impl PointEnergiesMut<'_> {
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

    /// Are they those of so many slots? Whoever writes without looking asks here first.
    ///
    /// # Panics
    /// If not.
    pub fn check(&self, len: usize) {
        let columns = [&self.strain, &self.repulsion, &self.dilatation, &self.whole];
        if let Some(column) = { columns }.into_iter().find(|c| c.len() != len) {
            panic!(
                "energies of {} slots, the body has {len}: they come from `for_slots(body.len())`",
                column.len()
            );
        }
    }

    /// All zero.
    ///
    /// # Panics
    /// As for [`check`](PointEnergiesMut::check).
    pub fn zeros(&mut self, len: usize) {
        self.check(len);
        self.strain.fill(0.0);
        self.repulsion.fill(0.0);
        self.dilatation.fill(0.0);
        self.whole.fill(0.0);
    }

    /// Those of a range of slots.
    pub(super) fn part(&mut self, slots: Range<usize>) -> PointEnergiesMut<'_> {
        PointEnergiesMut {
            strain: &mut self.strain[slots.clone()],
            repulsion: &mut self.repulsion[slots.clone()],
            dilatation: &mut self.dilatation[slots.clone()],
            whole: &mut self.whole[slots],
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
    pub fn of(out: &mut PointEnergiesMut, len: usize) -> Self {
        out.zeros(len);
        EnergyFields {
            strain: Shared(out.strain.as_mut_ptr()),
            repulsion: Shared(out.repulsion.as_mut_ptr()),
            share: Shared(out.dilatation.as_mut_ptr()),
            weight: Shared(out.whole.as_mut_ptr()),
        }
    }
}
