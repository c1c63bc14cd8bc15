//! The sweeps of a law: sums of each pass, answers of bonds, what is remembered, energies.

use super::family::{Family, Slots, put};
use super::store::OwnRows;
use super::view::{Drift, GroupOf, View, mirrored, save};
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, Piece, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::material::repulsion::Pushed;
use crate::interaction::{EnergyFields, Tally};
use crate::law::material::{Bond, End, ForceState, Material, Numbers, Site, part_of};

/// A pass: sums over bonds, and what the points make of them.
pub struct Sums<'a, const D: usize, F, M> {
    pub view: View<'a, D, F, M>,
    pub pass: usize,
    pub out: OwnRows,
    /// Marks of the groups that are meant; empty: all.
    pub only: &'a [u8],
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for Sums<'_, D, F, M> {
    type Out = ();

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let (v, pass) = (&self.view, self.pass);
        for group in v.block(block) {
            if !self.only.is_empty() && self.only[group] == 0 {
                continue;
            }
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.group::<L>(group, 0);
                let mut point = <M::Point<L> as Numbers<L>>::constant(0.0);
                if pass > 0 {
                    point = v.point::<L>(at.rows);
                }
                let sum = v.sum::<L>(pass, &at, &point);
                v.settle::<L>(pass, &at, sum, &mut point);
                save(self.out, at.rows, &point);
            }
        }
    }
}

/// Force pass.
pub struct Forces<'a, const D: usize, F, M> {
    pub view: View<'a, D, F, M>,
    pub f: [Shared; D],
    pub pushed: Option<Pushed<'a, D>>,
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for Forces<'_, D, F, M> {
    type Out = ();

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let v = &self.view;
        for group in v.block(block) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.group::<L>(group, 0);
                let point = v.point::<L>(at.rows);
                let mut acc = [L::splat(0.0); D];
                for k in 0..v.family.bonds(group) {
                    let pull = pull::<L, D, F, M>(v, &at, &point, k, 0);
                    for a in 0..D {
                        acc[a] = acc[a] + pull[a];
                    }
                }
                if let Some(pushed) = &self.pushed {
                    pushed.add::<L, F>(v.family, &v.moved, group, &mut acc);
                }
                for a in 0..D {
                    put(acc[a], self.f[a], at.rows);
                }
            }
        }
    }
}

/// What the points of a group get from their bond `k` (force / volume).
///
/// # Safety
/// A bond of the group; `part` as of the group.
#[inline(always)]
pub unsafe fn pull<L: Lane, const D: usize, F: Family<D>, M: Material<D>>(
    v: &View<D, F, M>,
    at: &GroupOf<L, D, F, M>,
    point: &M::Point<L>,
    k: usize,
    part: usize,
) -> [L; D] {
    // SAFETY: the caller's promise
    unsafe {
        let (mut pull, _, weight) = pull_of::<L, D, F, M>(v, at, point, k, part);
        for a in 0..D {
            pull[a] = weight * pull[a];
        }
        if !v.expansion.is_empty() {
            let ends = v.family.ends(at.number, k).from(part);
            let per_length = v.per_length::<L>(at, ends);
            for a in 0..D {
                pull[a] = per_length * pull[a];
            }
        }
        pull
    }
}

/// `T_i⟨ξ⟩ − T_j⟨−ξ⟩` of bond `k` of a group (force / volume²), the bond, and `ν V_j`.
///
/// # Safety
/// As of [`pull`].
#[inline(always)]
pub unsafe fn pull_of<L: Lane, const D: usize, F: Family<D>, M: Material<D>>(
    v: &View<D, F, M>,
    at: &GroupOf<L, D, F, M>,
    point: &M::Point<L>,
    k: usize,
    part: usize,
) -> ([L; D], Bond<L, D>, L) {
    // SAFETY: the caller's promise
    unsafe {
        let ends = v.family.ends(at.number, k).from(part);
        let dead = L::dead_in_part(*v.alive.at(v.family.byte(at.number, k)), part);
        let (bond, weight) = v.bond::<L>(at, k, ends, dead);
        let memory = v.memory::<L>(at.number, k, part);
        let end = End {
            constants: &at.constants,
            point,
            memory: &memory,
        };
        let mut own = v.law.answer(&bond, &end);
        let mut other = if M::ALIKE && v.alike {
            own.mirrored()
        } else {
            let back = if M::ALIKE {
                memory
            } else {
                v.memory_back::<L>(at.number, k, part)
            };
            let partner = v.point::<L>(ends);
            let constants = if v.alike || !M::READS {
                at.constants
            } else {
                v.constants_at::<L>(ends)
            };
            v.law.answer(
                &mirrored(&bond),
                &End {
                    constants: &constants,
                    point: &partner,
                    memory: &back,
                },
            )
        };
        if M::FORM_OF_WHOLE && !v.integrity.is_empty() {
            own = own.times(v.integrity::<L>(at.rows));
            other = other.times(v.integrity::<L>(ends));
        }
        (own.pull(other, &bond), bond, weight)
    }
}

/// The force state of the group's end of its bond `k`.
///
/// # Safety
/// As of [`pull`].
#[inline(always)]
pub unsafe fn answers<L: Lane, const D: usize, F: Family<D>, M: Material<D>>(
    v: &View<D, F, M>,
    at: &GroupOf<L, D, F, M>,
    point: &M::Point<L>,
    k: usize,
    part: usize,
    bond: &Bond<L, D>,
) -> M::State<L> {
    // SAFETY: the caller's promise
    let (memory, left) = unsafe { (v.memory::<L>(at.number, k, part), v.integrity::<L>(at.rows)) };
    let end = End {
        constants: &at.constants,
        point,
        memory: &memory,
    };
    v.law.answer(bond, &end).times(left)
}

/// What of it is the point's own force state; `pull` has the rest.
///
/// # Safety
/// As of [`pull`].
#[inline(always)]
pub unsafe fn own_pull<L: Lane, const D: usize, F: Family<D>, M: Material<D>>(
    v: &View<D, F, M>,
    at: &GroupOf<L, D, F, M>,
    point: &M::Point<L>,
    k: usize,
    part: usize,
) -> [L; D] {
    // SAFETY: the caller's promise
    unsafe {
        let ends = v.family.ends(at.number, k).from(part);
        let dead = L::dead_in_part(*v.alive.at(v.family.byte(at.number, k)), part);
        let (bond, weight) = v.bond::<L>(at, k, ends, dead);
        let mut own = answers::<L, D, F, M>(v, at, point, k, part, &bond).alone(&bond);
        let weight = weight * v.per_length::<L>(at, ends);
        for own in &mut own {
            *own = weight * *own;
        }
        own
    }
}

/// What bonds and points remember at the end of a step.
pub struct Remember<'a, const D: usize, F, M> {
    pub view: View<'a, D, F, M>,
    pub past: OwnRows,
    /// What bonds remember, to be written.
    pub memory: Shared,
    /// Volume per slot.
    pub volume: &'a crate::body::Values,
    /// As of [`Sums`].
    pub only: &'a [u8],
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for Remember<'_, D, F, M> {
    type Out = Tally;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Tally {
        let v = &self.view;
        let mut tally = Tally::default();
        for group in v.block(block) {
            if !self.only.is_empty() && self.only[group] == 0 {
                continue;
            }
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.group::<L>(group, 0);
                let point = v.point::<L>(at.rows);
                if !v.law.moves::<L>(&point) {
                    continue;
                }
                let form = at.rows.load::<L, M::Form<L>>(v.form);
                let before = at.rows.load::<L, M::Past<L>>(v.past);
                let (mut lost, mut past) = (L::splat(0.0), before);
                if M::GATHERS {
                    past = <M::Past<L> as Numbers<L>>::constant(0.0);
                }
                let count = <M::Memory<L> as Numbers<L>>::COUNT;
                if count > 0 {
                    for k in 0..v.family.bonds(group) {
                        let dead = v.dead(&at, k);
                        let ends = v.family.ends(group, k);
                        let (bond, weight) = v.bond::<L>(&at, k, ends, dead);
                        let old = v.memory::<L>(group, k, 0);
                        let end = End {
                            constants: &at.constants,
                            point: &point,
                            memory: &old,
                        };
                        let mut new = old;
                        lost = weight.fma(v.law.advance(&bond, &end, &mut new), lost);
                        if M::GATHERS {
                            past = past.plus(weight, v.law.gathered(&bond, &end, &new));
                        }
                        for n in 0..count {
                            let (old, new) = (old.get(n), new.get(n));
                            // a line that did not change is not written
                            if L::any(old.lt(new)) || L::any(new.lt(old)) {
                                let x = L::select(dead, old, new);
                                x.store(self.memory.at(v.family.own(group, k, n, count)));
                            }
                        }
                    }
                }
                let site = Site {
                    constants: &at.constants,
                    form: &form,
                    past: &before,
                    around: v.around::<L>(at.rows),
                };
                lost = lost + v.law.remember(&site, &point, &mut past);
                lost = part_of(v.integrity::<L>(at.rows), lost);
                save(self.past, at.rows, &past);
                for (l, x) in lost.to_array().iter().enumerate() {
                    if v.family.is_point(group, l) {
                        tally.dissipated += x * self.volume.at(at.rows.slot(l));
                    }
                }
            }
        }
        tally
    }
}

/// Strain energy density of a group, with all passes of its own.
pub struct EnergyOf<'a, 'b, L: Lane, const D: usize, F: Family<D>, M: Material<D>> {
    pub view: &'a View<'b, D, F, M>,
    pub at: &'a GroupOf<L, D, F, M>,
    /// A byte per bond: these are whole.
    pub bits: &'a [u8],
    /// Of displacements that are away.
    pub drift: Option<Drift<'a, D>>,
    pub form: &'a M::Form<L>,
}

impl<L: Lane, const D: usize, F: Family<D>, M: Material<D>> EnergyOf<'_, '_, L, D, F, M> {
    /// # Safety
    /// A bond of the group.
    #[inline(always)]
    unsafe fn bond(&self, k: usize) -> (Bond<L, D>, L) {
        let (v, at, dead) = (self.view, self.at, L::dead(self.bits[k]));
        let ends = v.family.ends(at.number, k);
        // SAFETY: the caller's promise
        unsafe {
            let mut eta = v.apart::<L>(at, ends, dead);
            if let Some(drift) = &self.drift {
                for a in 0..D {
                    let column = drift.v[a].as_ptr();
                    let rate = ends.one::<L>(column) - at.rows.one::<L>(column);
                    eta[a] = rate.fma(L::splat(drift.time), eta[a]).zero_if(dead);
                }
            }
            v.deformed(at, k, ends, dead, eta)
        }
    }
}

impl<L: Lane, const D: usize, F: Family<D>, M: Material<D>> Piece for EnergyOf<'_, '_, L, D, F, M> {
    type Out = L;

    #[inline(always)]
    fn run(self) -> L {
        let (v, at) = (self.view, self.at);
        // SAFETY: a group of the family
        unsafe {
            let past = at.rows.load::<L, M::Past<L>>(v.past);
            let site = Site {
                constants: &at.constants,
                form: self.form,
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
                for k in 0..v.family.bonds(at.number) {
                    let (bond, weight) = self.bond(k);
                    let memory = v.memory::<L>(at.number, k, 0);
                    let end = End {
                        constants: &at.constants,
                        point: &point,
                        memory: &memory,
                    };
                    if last {
                        energy = weight.fma(v.law.energy(&bond, &end), energy);
                    } else {
                        sum = sum.plus(weight, v.law.share(pass, &bond, &end));
                    }
                }
                if !last {
                    v.law.settle(pass, &site, sum, &mut point);
                }
            }
            part_of(v.integrity::<L>(at.rows), energy)
        }
    }
}

/// Energy pass: strain and repulsion energy densities, `Σ ω ν V |ξ|² s` and `Σ ω ν V |ξ|²` over whole bonds.
pub struct Energies<'a, const D: usize, F, M> {
    pub view: View<'a, D, F, M>,
    /// What a section stores that is held, per material; empty: nothing ([`MaterialInteraction::held_energies`](super::MaterialInteraction)).
    pub held: &'a [f64],
    pub pushed: Option<Pushed<'a, D>>,
    pub volume: &'a crate::body::Values,
    pub fields: Option<EnergyFields>,
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for Energies<'_, D, F, M> {
    type Out = [f64; 2];
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 2] {
        let v = &self.view;
        let mut sums = [0.0; 2];
        for group in v.block(block) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.group::<L>(group, 0);
                let bits = v.bits(group);
                let form = at.rows.load::<L, M::Form<L>>(v.form);
                let strain = L::apart(EnergyOf::<L, D, F, M> {
                    view: v,
                    at: &at,
                    bits,
                    drift: None,
                    form: &form,
                });
                let repulsion = match &self.pushed {
                    Some(pushed) => pushed.energy::<L, F>(v.family, &v.moved, group),
                    None => [0.0; TILE],
                };
                let mut all = strain.to_array();
                for l in 0..TILE {
                    if v.family.is_point(group, l) {
                        if !self.held.is_empty() {
                            let slot = at.rows.slot(l);
                            let material = v.material.get(slot).map_or(0, |m| usize::from(*m));
                            all[l] += self.held[material] * v.expansion[slot].powi(2);
                        }
                        let volume = self.volume.at(at.rows.slot(l));
                        sums[0] += all[l] * volume;
                        sums[1] += repulsion[l] * volume;
                    }
                }
                let Some(out) = self.fields else { continue };
                let (mut share, mut weight) = (L::splat(0.0), L::splat(0.0));
                for k in 0..v.family.bonds(group) {
                    let ends = v.family.ends(group, k);
                    let (bond, w) = v.bond::<L>(&at, k, ends, L::dead(bits[k]));
                    let part = w * bond.omega * bond.length * bond.length;
                    share = part.fma(bond.stretch, share);
                    weight = weight + part;
                }
                put(L::load(all.as_ptr()), out.strain, at.rows);
                for l in 0..TILE {
                    *out.repulsion.at(at.rows.slot(l)) = repulsion[l];
                }
                put(share, out.share, at.rows);
                put(weight, out.weight, at.rows);
            }
        }
        sums
    }
}
