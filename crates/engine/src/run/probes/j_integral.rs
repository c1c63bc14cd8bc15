//! The J-integral of a peridynamic body in two dimensions, and the stress intensity that follows.
//!
//! Energy that flows into a region R that moves with the crack in direction n, per advance and thickness h (Hu, Ha, Bobaru,
//! Silling 2012, *The formulation and computation of the nonlocal J-integral in bond-based peridynamics*; Silling, Lehoucq 2010):
//!
//! `J h = ∮ W n·ds − ½ Σ_{i∈R} Σ_{j∉R} V_i V_j f_ij · (g_i + g_j)`,
//!
//! with `f_ij` the force density per volume on i from j and `g = ∂u/∂x · n`. It does not depend on R as long as the tip is in it,
//! the crack runs along n through it, and it is in equilibrium without loads. Averaged over the regions between two rectangles,
//! with q from 1 inside the inner to 0 outside the outer one, it becomes a sum over the points in between,
//!
//! `J h = −Σ_i V_i W_i ∂q/∂n − ¼ Σ_i Σ_j V_i V_j (q_i − q_j) f_ij · (g_i + g_j)`,
//!
//! in which no quantity at the tip is needed (as in the equivalent domain integral of classical mechanics: Li, Shih, Needleman
//! 1985). State-based laws give a bond's energy to its ends in unequal halves; what that changes is of the order of the gradient
//! of pressure over the horizon, and is left out. `g` is the [displacement gradient](crate::observe::observables) of each point.

use super::rectangle::JIntegral;
use crate::error::BuildError;
use crate::execute::exact::Exact;
use crate::message;
use crate::observe::Values;
use crate::quantity::Dimension;
use crate::run::model::Model;
use crate::run::record;
use crate::run::system::System;
use crate::spec::JIntegralSpec;

/// Strain at which stiffness is measured: small enough to be linear, and computed without cancellation.
const SMALL: f64 = 1e-8;
/// A rectangle reaches so many horizons from its middle, at least.
const REACH: f64 = 3.0;

impl<const D: usize> System<D> {
    /// A contour that can be integrated.
    pub(in crate::run) fn j_integral_of(
        &mut self,
        spec: &JIntegralSpec,
        path: &str,
    ) -> Result<JIntegral, BuildError> {
        let at = |key: &str| format!("{path}.{key}");
        if D != 2 {
            return Err(BuildError::unsupported(
                path,
                format!("a contour is one in two dimensions, this body has {D}"),
            ));
        }
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for &s in self.body.slots() {
            let x = self.body.position(s as usize);
            for (b, x) in bounds.iter_mut().zip(x) {
                *b = [b[0].min(x), b[1].max(x)];
            }
        }
        let bounds = bounds.map(|[low, high]| [self.body.least(low), self.body.most(high)]);
        let (horizon, half_cell) = (self.info.horizon, 0.5 * self.body.spacing());
        for a in 0..2 {
            let (low, high) = (spec.low[a], spec.high[a]);
            if !(high - low >= 2.0 * REACH * horizon) {
                let message = message![
                    "the rectangle is ",
                    Dimension::LENGTH.of(high - low),
                    format!(" wide and needs {REACH} horizons on either side of the tip: "),
                    Dimension::LENGTH.of(2.0 * REACH * horizon),
                ];
                return Err(
                    BuildError::conflict(at("corners"), message).help("move the corners apart")
                );
            }
            if low < bounds[a][0] - half_cell || high > bounds[a][1] + half_cell {
                let message = "the rectangle leaves the body, whose surface would have to be part of the contour";
                return Err(BuildError::conflict(at("corners"), message)
                    .help("move the corners into the body"));
            }
        }
        let inside = |s: usize| {
            let x = self.body.position(s);
            (0..2).all(|a| x[a] > spec.low[a] && x[a] < spec.high[a])
        };
        let mut held = vec![];
        let mut hold = |slot, _| held.push(slot);
        self.prescribed.all().for_each(|p| p.each_held(&mut hold));
        let loaded = self
            .applied
            .loads
            .iter()
            .flat_map(|l| l.slots().iter().map(|s| *s as usize));
        let held = held.into_iter().chain(loaded).any(inside);
        if self.body.exchange().any(held) {
            let message = "points inside the rectangle are held or loaded, and what that does would count as energy of the crack";
            return Err(BuildError::conflict(at("corners"), message)
                .help("move the corners away from them"));
        }
        Ok(JIntegral {
            modulus: self.plane_modulus(spec),
            spec: *spec,
            section: self.info.section,
        })
    }

    /// `E′` of the points in a rectangle: the median, which a crack and surfaces do not change.
    fn plane_modulus(&self, spec: &JIntegralSpec) -> f64 {
        let strained = |xx: f64, yy: f64| {
            let mut strain = [[0.0; 3]; 3];
            (strain[0][0], strain[1][1]) = (SMALL * xx, SMALL * yy);
            let energy = record::strained(self, strain);
            energy
                .into_iter()
                .map(|w| w / (SMALL * SMALL))
                .collect::<Vec<f64>>()
        };
        let (along, both) = (strained(1.0, 0.0), strained(1.0, 1.0));
        let mut moduli: Vec<f64> = vec![];
        for (id, &s) in self.body.slots().iter().enumerate() {
            let x = self.body.position(s as usize);
            if (0..2).all(|a| x[a] > spec.low[a] && x[a] < spec.high[a]) {
                // W = ½ C₁₁ and C₁₁ + C₁₂
                let c11 = 2.0 * along[id];
                let c12 = both[id] - c11;
                moduli.push(c11 - c12 * c12 / c11);
            }
        }
        let mut moduli = self.body.all_of(&moduli).concat();
        moduli.sort_by(f64::total_cmp);
        moduli.get(moduli.len() / 2).copied().unwrap_or(0.0)
    }
}

impl<const D: usize> Model<D> {
    /// J and K now.
    pub(in crate::run) fn integral(&mut self, j_integral: &JIntegral) -> [f64; 2] {
        let n = j_integral.spec.direction;
        let columns =
            self.columns_of(["strain_energy_density", "displacement_gradient"].into_iter());
        let [energy, gradient] = &columns[..] else {
            unreachable!("solids have both")
        };
        let (Values::Scalars(energy), Values::Tensors(gradient)) =
            (&energy.values, &gradient.values)
        else {
            unreachable!("by their declarations")
        };
        let body = &self.system.body;
        // by slot, of copies too
        let (mut q, mut slope) = (vec![0.0; body.len()], vec![[0.0; 2]; body.len()]);
        let mut g = vec![[0.0; 2]; body.len()];
        for (&s, h) in body.slots().iter().zip(gradient) {
            let s = s as usize;
            let x = body.position(s);
            (q[s], slope[s]) = j_integral.q([x[0], x[1]]);
            g[s] = [h[0] * n[0] + h[1] * n[1], h[3] * n[0] + h[4] * n[1]];
        }
        body.exchange().fill(&mut q);
        body.exchange().fill(&mut g);
        // contact may be with points that have no copy here
        let touched = self.system.contact.is_some() && body.exchange().is_shared();
        let [q_there, g_there] = match touched {
            true => [
                body.everywhere(body.by_id(|s| [q[s], 0.0])),
                body.everywhere(body.by_id(|s| g[s])),
            ],
            false => [vec![], vec![]],
        };
        let slots = body.len();
        let of = |n: usize| match n.checked_sub(slots) {
            None => (q[n], g[n]),
            Some(id) => (q_there[id][0], g_there[id]),
        };
        let volume = body.volume().clone();
        let each = body.slots().iter().zip(energy).map(|(&s, energy)| {
            let along = slope[s as usize][0] * n[0] + slope[s as usize][1] * n[1];
            -(volume.at(s as usize) * energy * along)
        });
        let mut sum: Exact = each.collect();
        self.system.each_pair_force(&mut |bond| {
            let (i, j) = (bond.i, bond.j);
            let (there, slope) = of(j);
            let across = q[i] - there;
            let power: f64 = (0..2).map(|a| bond.force[a] * (g[i][a] + slope[a])).sum();
            sum.take(0.25 * volume.at(i) * across * power);
        });
        let j = self.system.body.sums([sum])[0] / j_integral.section;
        // closed by pressure: no intensity
        [j, (j.max(0.0) * j_integral.modulus).sqrt()]
    }
}
