//! What bonds are measured by that break by more than their stretch: the work on them, and the stress of their points.

use super::law::LawView;
use crate::body::Body;
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::bonds::family::{Family, Slots, put};
use crate::interaction::bonds::view::BondView;

/// The force on bond `k` of a group.
#[inline(always)]
fn force<L: Lane, const D: usize>(all: &[f64], k: usize) -> [L; D] {
    let of_bond = &all[k * D * TILE..][..D * TILE];
    let mut force = [L::splat(0.0); D];
    for a in 0..D {
        // SAFETY: eight numbers of each axis
        force[a] = unsafe { L::load(of_bond.as_ptr().add(a * TILE)) };
    }
    force
}

/// Half of the work of a step on bonds, by the forces at one of its ends: `½ (T_i − T_j)·Δη`.
pub struct Work<'a, const D: usize, F> {
    /// Where the forces are.
    pub law: LawView<'a, D, F>,
    /// The other end of the step.
    pub other: BondView<'a, D, F>,
    /// ½ towards the other end, −½ away from it.
    pub part: f64,
    /// A number for every directed bond.
    pub work: Shared,
}

impl<const D: usize, F: Family<D>> Kernel for Work<'_, D, F> {
    type Out = ();
    type Home = Self;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let v = &self.law.bonds;
        let mut forces = vec![];
        for group in v.block(block) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.points::<L>(group);
                let there = self.other.points::<L>(group);
                self.law.bond_forces(group, false, &mut forces);
                for k in 0..v.family.bonds(group) {
                    let dead = v.dead::<L>(group, k);
                    let pull = force::<L, D>(&forces, k);
                    let (_, eta) = v.stretched::<L>(&at, k, dead);
                    let (_, other) = self.other.stretched::<L>(&there, k, dead);
                    let mut done = pull[0] * (other[0] - eta[0]);
                    for a in 1..D {
                        done = pull[a].fma(other[a] - eta[a], done);
                    }
                    let place = self.work.at(v.family.own(group, k, 0, 1));
                    let sum = L::splat(self.part).fma(done, L::load(place));
                    L::select(dead, L::load(place), sum).store(place);
                }
            }
        }
    }
}

/// Von Mises stress of points over its limit, of the stress `Σ ν V_j T⟨ξ⟩⊗(ξ+η)` (per reference volume), whose mean over both orders of
/// indices is taken.
pub struct VonMises<'a, const D: usize, F> {
    pub law: LawView<'a, D, F>,
    /// Does the law say the stress across a body in plane strain?
    pub says_across: bool,
    pub limits: Limits<'a, D>,
}

/// What stresses are compared with, per material, and where the ratio of each slot is written.
#[derive(Clone, Copy)]
pub struct Limits<'a, const D: usize> {
    pub body: &'a Body<D>,
    pub limit: &'a [f64],
    /// In plane strain, and empty else: σ_zz over σ_xx + σ_yy, and what it is less by the strain that temperature gives.
    pub across: &'a [[f64; 2]],
    pub out: Shared,
}

impl<const D: usize, F: Family<D>> Kernel for VonMises<'_, D, F> {
    type Out = ();
    type Home = Self;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let v = &self.law.bonds;
        let mut forces = vec![];
        for group in v.block(block) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.points::<L>(group);
                let across = self.law.bond_forces(group, true, &mut forces);
                let mut stress = [[L::splat(0.0); D]; D];
                for k in 0..v.family.bonds(group) {
                    let own = force::<L, D>(&forces, k);
                    let (bond, eta) = v.stretched::<L>(&at, k, v.dead::<L>(group, k));
                    for r in 0..D {
                        let force = bond.weight * own[r];
                        for c in 0..D {
                            stress[r][c] = force.fma(bond.xi[c] + eta[c], stress[r][c]);
                        }
                    }
                }
                let half = L::splat(0.5);
                let (mut trace, mut square) = (L::splat(0.0), L::splat(0.0));
                for r in 0..D {
                    trace = trace + stress[r][r];
                    for c in 0..D {
                        let mean = half * (stress[r][c] + stress[c][r]);
                        square = mean.fma(mean, square);
                    }
                }
                let per = |of: &dyn Fn(usize) -> f64| -> [f64; TILE] {
                    crate::array::from_fn(|l| of(self.limits.body.material_of(at.rows.slot(l))))
                };
                if D == 2 && !self.limits.across.is_empty() {
                    let across = if self.says_across {
                        L::load(across.as_ptr())
                    } else {
                        let poisson = per(&|m: usize| self.limits.across[m][0]);
                        let mut across = L::load(poisson.as_ptr()) * trace;
                        if !v.expansion.is_empty() {
                            let stiff = per(&|m: usize| self.limits.across[m][1]);
                            let grown = at.rows.one::<L>(v.expansion.as_ptr());
                            let left = match v.integrity.is_empty() {
                                true => L::splat(1.0),
                                false => at.rows.one::<L>(v.integrity.as_ptr()),
                            };
                            across = across - left * L::load(stiff.as_ptr()) * grown;
                        }
                        across
                    };
                    trace = trace + across;
                    square = across.fma(across, square);
                }
                // 3/2 s:s = 3/2 σ:σ − 1/2 tr²σ
                let mises = L::splat(1.5) * square - half * trace * trace;
                let limit = L::load(per(&|m: usize| self.limits.limit[m]).as_ptr());
                put(
                    mises.max(L::splat(0.0)).sqrt().div(limit),
                    self.limits.out,
                    at.rows,
                );
            }
        }
    }
}
