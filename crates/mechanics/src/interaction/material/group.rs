//! What a law says of the bonds of one group, for those that know no law.

use super::view::{Drift, GroupOf, View, mirrored};
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::bonds::family::{Family, Slots};
use crate::law::material::{Bond, End, ForceState, Material, Numbers, Site, part_of};

/// Most numbers that a form has.
pub const FORM: usize = 32;

/// Forms of the points of a group, eight of each number side by side.
pub type Form = [[f64; TILE]; FORM];

/// Bonds that points keep.
#[derive(Clone, Copy)]
pub struct Kept<'a, const D: usize> {
    /// A byte per bond: these are whole.
    pub bits: &'a [u8],
    /// What points know of these families; `None`: what the bonds say.
    pub form: Option<&'a Form>,
    /// Of displacements that are away.
    pub drift: Option<Drift<'a, D>>,
}

/// Strain energy densities of the points of a group, with all passes of their own.
pub struct GroupEnergy<'a, const D: usize, F, M> {
    pub view: View<'a, D, F, M>,
    pub of: Kept<'a, D>,
}

impl<const D: usize, F: Family<D>, M: Material<D>> GroupEnergy<'_, D, F, M> {
    /// # Safety
    /// A bond of the group.
    #[inline(always)]
    unsafe fn bond<L: Lane>(&self, at: &GroupOf<L, D, F, M>, k: usize) -> (Bond<L, D>, L) {
        let (v, dead) = (&self.view, L::dead(self.of.bits[k]));
        let ends = v.family.ends(at.number, k);
        // SAFETY: the caller's promise
        unsafe {
            let mut eta = v.relative_displacement::<L>(at, ends, dead);
            if let Some(drift) = &self.of.drift {
                for a in 0..D {
                    let column = drift.v[a].as_ptr();
                    let rate = ends.one::<L>(column) - at.rows.one::<L>(column);
                    eta[a] = rate.fma(L::splat(drift.time), eta[a]).zero_if(dead);
                }
            }
            v.deformed(at, k, ends, dead, eta)
        }
    }

    /// # Safety
    /// Rows of the family.
    #[inline(always)]
    unsafe fn form<L: Lane>(&self, rows: F::Slots) -> M::Form<L> {
        const { assert!(<M::Form<f64> as Numbers<f64>>::COUNT <= FORM) };
        let Some(all) = self.of.form else {
            // SAFETY: the caller's promise
            return unsafe { rows.load::<L, M::Form<L>>(self.view.form) };
        };
        let mut out = <M::Form<L> as Numbers<L>>::constant(0.0);
        for n in 0..<M::Form<L> as Numbers<L>>::COUNT {
            // SAFETY: a number per lane
            out.set(n, unsafe { L::load(all[n].as_ptr()) });
        }
        out
    }
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for GroupEnergy<'_, D, F, M> {
    type Out = [f64; TILE];
    type Home = M;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, group: usize) -> [f64; TILE] {
        let v = &self.view;
        // SAFETY: a group of the family
        unsafe {
            let at = v.group::<L>(group);
            let form = self.form::<L>(at.rows);
            let past = at.rows.load::<L, M::Past<L>>(v.past);
            let site = Site {
                constants: &at.constants,
                form: &form,
                past: &past,
                around: v.around::<L>(at.rows),
            };
            let mut point = <M::Point<L> as Numbers<L>>::constant(0.0);
            let mut sum = <M::Sum<L> as Numbers<L>>::constant(0.0);
            let mut energy = L::splat(0.0);
            // the last round is that of energies
            for pass in 0..=M::PASSES {
                let last = pass == M::PASSES;
                if last {
                    energy = v.law.point_energy(&site, sum, &point);
                }
                sum = <M::Sum<L> as Numbers<L>>::constant(0.0);
                for k in 0..v.family.bonds(group) {
                    let (bond, weight) = self.bond::<L>(&at, k);
                    let memory = v.memory::<L>(group, k);
                    let constants = match last {
                        true => v.constants_to::<L>(&at, v.family.ends(group, k)),
                        false => at.constants,
                    };
                    let end = End {
                        constants: &constants,
                        point: &point,
                        memory: &memory,
                    };
                    if last {
                        energy = weight.fma(v.law.energy(&bond, &end), energy);
                    } else {
                        sum = sum.plus(weight, v.law.pair_pass(pass, &bond, &end));
                    }
                }
                if !last {
                    v.law.point_update(pass, &site, sum, &mut point);
                }
            }
            part_of(v.integrity::<L>(at.rows), energy).to_array()
        }
    }
}

/// Force states on the bonds of a group that has settled, eight of each bond side by side for each axis; and the stress across the section of its points,
/// of laws that say it.
pub struct GroupForces<'a, const D: usize, F, M> {
    pub view: View<'a, D, F, M>,
    /// `T_i⟨ξ⟩` alone, or `T_i⟨ξ⟩ − T_j⟨−ξ⟩` (force / volume²)?
    pub alone: bool,
    /// `[bonds][D][8]`
    pub out: Shared,
}

impl<const D: usize, F: Family<D>, M: Material<D>> GroupForces<'_, D, F, M> {
    /// What [`pull_of`](super::sweeps::pull_of) says of a bond, or its own end alone. One answer in a loop over ends: these are seldom asked for, and
    /// what is compiled for a law is half as much.
    ///
    /// # Safety
    /// A bond of the group.
    #[inline(always)]
    unsafe fn force<L: Lane>(
        &self,
        at: &GroupOf<L, D, F, M>,
        point: &M::Point<L>,
        k: usize,
    ) -> [L; D] {
        let v = &self.view;
        // SAFETY: the caller's promise
        unsafe {
            let ends = v.family.ends(at.number, k);
            let (bond, _) = v.bond::<L>(at, k, ends, v.dead::<L>(at.number, k));
            let mut seen = bond;
            let mut constants = v.constants_to::<L>(at, ends);
            let mut memory = v.memory::<L>(at.number, k);
            let mut point = *point;
            let mut states = [None, None];
            let count = if self.alone || (M::ALIKE && v.alike) {
                1
            } else {
                2
            };
            for n in 0..count {
                if n == 1 {
                    seen = mirrored(&bond);
                    if !M::ALIKE {
                        memory = v.memory_back::<L>(at.number, k);
                    }
                    point = v.point::<L>(ends);
                    constants = if v.alike || !M::READS {
                        at.constants
                    } else {
                        let other = v.constants_at::<L>(ends);
                        v.law.between(other, &at.constants)
                    };
                }
                let end = End {
                    constants: &constants,
                    point: &point,
                    memory: &memory,
                };
                states[n] = Some(v.law.force_state(&seen, &end));
            }
            let [Some(mut own), other] = states else {
                return [L::splat(0.0); D];
            };
            if self.alone {
                return own.times(v.integrity::<L>(at.rows)).alone(&bond);
            }
            let mut other = other.unwrap_or(own.mirrored());
            if M::FORM_OF_WHOLE && !v.integrity.is_empty() {
                own = own.times(v.integrity::<L>(at.rows));
                other = other.times(v.integrity::<L>(ends));
            }
            own.pull(other, &bond)
        }
    }
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for GroupForces<'_, D, F, M> {
    type Out = [f64; TILE];
    type Home = M;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, group: usize) -> [f64; TILE] {
        let v = &self.view;
        // SAFETY: a group of the family, and room for its bonds
        unsafe {
            let at = v.group::<L>(group);
            let point = v.point::<L>(at.rows);
            for k in 0..v.family.bonds(group) {
                let force = self.force::<L>(&at, &point, k);
                for a in 0..D {
                    force[a].store(self.out.at((k * D + a) * TILE));
                }
            }
            match D == 2 && M::ACROSS && self.alone {
                true => v.across::<L>(&at, &point).to_array(),
                false => [0.0; TILE],
            }
        }
    }
}
