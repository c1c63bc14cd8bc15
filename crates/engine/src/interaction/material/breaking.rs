//! Which bonds break, what their points lose with them, and the next critical stretch.

use super::family::{Family, Slots, put};
use super::sweeps::EnergyOf;
use super::view::{Drift, GroupOf, View};
use crate::body::{Body, Field};
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::family::stencil::MOST;
use crate::interaction::bond::relative_square_stretch;
use crate::interaction::{Tally, Toughness, history};
use crate::law::material::{Material, Numbers};

/// Test and break. What points lose is the energy of their bonds before less that of those that they keep, the mean of here and a step
/// away (see [`Break::drift`]): so the balance of energy is of second order in the step.
pub struct Break<'a, const D: usize, F, M> {
    /// With the constants of the step.
    pub view: View<'a, D, F, M>,
    /// Constants of a step of no length.
    pub still: &'a [f64],
    pub body: &'a Body<D>,
    pub critical: &'a [f64],
    pub next: Shared,
    pub toughness: &'a [Toughness],
    pub v: &'a Field<D>,
    /// Time to where a bond was last with its points (negative: it lets go at once and the kick of the half step that ends here misses
    /// it), or will be (it pulls once more).
    pub drift: f64,
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for Break<'_, D, F, M> {
    type Out = Tally;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Tally {
        let v = &self.view;
        let mut tally = Tally::default();
        for group in v.block(block) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.group::<L>(group, 0);
                let own = at.rows.one::<L>(self.critical.as_ptr());
                let mut lowest = L::splat(f64::INFINITY);
                let mut torn = false;
                for k in 0..v.family.bonds(group) {
                    let ends = v.family.ends(group, k);
                    let e = v.strain::<L>(&at, k, ends, v.dead(&at, k));
                    lowest = e.min(lowest);
                    let other = ends.one::<L>(self.critical.as_ptr());
                    torn |= L::any(other.min(own).lt(e));
                }
                let material = |l: usize| self.body.material_of(at.rows.slot(l));
                let alone = if M::PASSES > 0 {
                    own
                } else {
                    L::splat(f64::INFINITY)
                };
                let next = history::next_critical(self.toughness, material, lowest, alone);
                put(next, self.next, at.rows);
                if torn {
                    L::apart(Torn::<L, D, F, M> {
                        pass: self,
                        group,
                        tally: &mut tally,
                        own,
                    });
                }
            }
        }
        tally
    }
}

struct Torn<'a, 'b, L, const D: usize, F, M> {
    pass: &'a Break<'b, D, F, M>,
    group: usize,
    tally: &'a mut Tally,
    own: L,
}

impl<L: Lane, const D: usize, F: Family<D>, M: Material<D>> crate::execute::lane::Piece
    for Torn<'_, '_, L, D, F, M>
{
    type Out = ();

    #[inline(always)]
    fn run(self) {
        let (pass, group) = (self.pass, self.group);
        let v = &pass.view;
        // SAFETY: as in the pass
        unsafe {
            let mut at = v.group::<L>(group, 0);
            let bonds = v.family.bonds(group);
            let mut before = [0u8; MOST];
            let mut after = [0u8; MOST];
            let mut broken = [0u32; TILE];
            // families of clouds may be larger than any stencil
            let (mut many_before, mut many_after) = (vec![], vec![]);
            let (before, after) = if bonds <= MOST {
                (&mut before[..bonds], &mut after[..bonds])
            } else {
                many_before.resize(bonds, 0);
                many_after.resize(bonds, 0);
                (&mut many_before[..], &mut many_after[..])
            };
            for k in 0..bonds {
                let bits = v.alive.at(v.family.byte(group, k));
                before[k] = *bits;
                let ends = v.family.ends(group, k);
                let e = v.strain::<L>(&at, k, ends, L::dead(*bits));
                let other = ends.one::<L>(pass.critical.as_ptr());
                let which = L::bits(other.min(self.own).lt(e)) as u8;
                after[k] = before[k] & !which;
                *bits = after[k];
                self.tally.broken += u64::from(which.count_ones());
                for (l, count) in broken.iter_mut().enumerate() {
                    *count += u32::from(which >> l & 1);
                }
            }
            let old = at.rows.load::<L, M::Form<L>>(v.form);
            let new = if M::FORM_OF_WHOLE {
                v.forms::<L>(group, after, pass.body)
            } else {
                old
            };
            let still = View {
                constants: pass.still,
                ..*v
            };
            let away = Drift {
                v: pass.v,
                time: pass.drift,
            };
            let mut lost = L::splat(0.0);
            for (view, drift) in [(v, None), (&still, Some(away))] {
                at.constants = view.constants_at::<L>(at.rows);
                let mut one = L::splat(0.5);
                for (bits, form) in [(&*before, &old), (&*after, &new)] {
                    let energy = L::apart(EnergyOf::<L, D, F, M> {
                        view,
                        at: &at,
                        bits,
                        drift,
                        form,
                    });
                    lost = one.fma(energy, lost);
                    one = L::splat(-0.5);
                }
            }
            let lost = lost.to_array();
            for l in 0..TILE {
                if broken[l] > 0 {
                    self.tally.released += lost[l] * pass.body.volume.at(at.rows.slot(l));
                }
            }
            if M::FORM_OF_WHOLE {
                super::view::save(v.form, at.rows, &new);
            }
        }
    }
}

impl<const D: usize, F: Family<D>, M: Material<D>> View<'_, D, F, M> {
    /// `e` of a group's bonds; not a number in lanes without one.
    ///
    /// # Safety
    /// A bond of the group, and its ends.
    #[inline(always)]
    unsafe fn strain<L: Lane>(
        &self,
        at: &GroupOf<L, D, F, M>,
        k: usize,
        ends: F::Slots,
        dead: L::Mask,
    ) -> L {
        // SAFETY: the caller's promise
        unsafe {
            let eta = self.apart::<L>(at, ends, dead);
            let r = self
                .family
                .reference::<L>(at.number, k, &at.place, ends, dead);
            relative_square_stretch(eta, r.xi, r.two_by_square).nan_if(dead)
        }
    }

    /// What the points of a group know of a family with these bonds.
    pub fn forms<L: Lane>(&self, group: usize, bits: &[u8], body: &Body<D>) -> M::Form<L> {
        let count = <M::Form<L> as Numbers<L>>::COUNT;
        let mut out = <M::Form<L> as Numbers<L>>::constant(0.0);
        let mut all = [[0.0; TILE]; 64];
        for l in (0..TILE).filter(|l| self.family.is_point(group, *l)) {
            let form = self.form_of(group, bits, l, body);
            for n in 0..count {
                all[n][l] = form.get(n);
            }
        }
        for n in 0..count {
            // SAFETY: a number per lane
            out.set(n, unsafe { L::load(all[n].as_ptr()) });
        }
        out
    }

    /// Of one point.
    pub fn form_of(&self, group: usize, bits: &[u8], l: usize, body: &Body<D>) -> M::Form<f64> {
        let mut shape = [[0.0; D]; D];
        let at = self.family.rows(group).from(l);
        for (k, bits) in bits.iter().enumerate() {
            if bits >> l & 1 == 0 {
                continue;
            }
            // SAFETY: a whole bond of the group
            let r = unsafe {
                let place = self.family.place::<f64>(at);
                let ends = self.family.ends(group, k).from(l);
                self.family
                    .reference::<f64>(group, k, &place, ends, f64::dead(1))
            };
            let weight = r.omega * r.weight;
            for a in 0..D {
                for b in 0..D {
                    shape[a][b] += weight * r.xi[a] * r.xi[b];
                }
            }
        }
        self.law.form(body.material_of(at.slot(0)), shape)
    }
}
