//! What points lose with their bonds.

use super::group::{FORM, Form, Kept};
use super::law::LawView;
use super::view::Drift;
use crate::body::Body;
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::BlockTally;
use crate::interaction::bonds::family::{Family, Slots};
use crate::interaction::bonds::store::OwnRows;
use crate::interaction::bonds::view::BondView;
use crate::law::material::part_of;

/// Break them. What points lose is the energy of their bonds before less that of those that they keep, the mean of here and a step
/// away (see [`Breaking::drift`]): so the balance of energy is of second order in the step.
///
/// A family whose form is that of its whole bonds (a deformation gradient, weights) may be strained more without a bond than with it, and store
/// more: `W′ > W`. Breaking can only dissipate (Silling & Lehoucq 2010, the free energy at a fixed deformation falls with damage), so that
/// of such a point is `W/W′` of what it would be from then on, and so are its force states: its integrity, 1 at first.
pub struct BreakBonds<'a, const D: usize, F> {
    /// With the constants of the step.
    pub law: LawView<'a, D, F>,
    /// How many numbers of a form follow from what is left of a family; 0: forms stay.
    pub forms: usize,
    pub damaged: Breaking<'a, D>,
}

/// Where bonds break, and what is written there.
#[derive(Clone, Copy)]
pub struct Breaking<'a, const D: usize> {
    /// Constants of a step of no length.
    pub still: &'a [f64],
    pub body: &'a Body<D>,
    /// Marks of groups with bonds that break.
    pub groups: &'a [u8],
    /// Bits of bonds that break; then of those that are left.
    pub breaks: Shared<u8>,
    /// Bits of whole bonds, forms of families and integrities, to be written.
    pub alive: Shared<u8>,
    pub form: OwnRows,
    /// `None`: the form is that of the family as it was.
    pub integrity: Option<Shared>,
    /// Time to where a bond was last with its points (negative: it lets go at once and the kick of the half step that ends here misses
    /// it), or will be (it pulls once more).
    pub drift: Drift<'a, D>,
}

impl<const D: usize, F: Family<D>> Kernel for BreakBonds<'_, D, F> {
    type Out = BlockTally;
    type Home = Self;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> BlockTally {
        let (v, damaged) = (&self.law.bonds, &self.damaged);
        let mut tally = BlockTally::default();
        for group in v.block(block) {
            if damaged.groups[group] == 0 {
                continue;
            }
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let first = v.family.byte(group, 0);
                let bonds = v.family.bonds(group);
                let before = v.bits(group);
                let after = std::slice::from_raw_parts_mut(damaged.breaks.at(first), bonds);
                for (left, whole) in after.iter_mut().zip(before) {
                    *left = whole & !*left;
                }
                let (after, rows) = (&*after, v.family.rows(group));
                let new = (self.forms > 0).then(|| self.new_forms(group, after));
                let energies = self.energies::<L>(group, before, (after, new.as_ref()));
                for l in 0..TILE {
                    let of = before.iter().zip(after);
                    let broken = of.filter(|(b, a)| (*b ^ *a) >> l & 1 == 1).count();
                    if broken > 0 {
                        let slot = rows.slot(l);
                        let [before, mut after] = energies.map(|e| e[l]);
                        if let Some(integrity) = &damaged.integrity {
                            let left = kept(before, after);
                            *integrity.at(slot) *= left;
                            after = part_of(left, after);
                        }
                        tally.broken += broken as u64;
                        tally
                            .released
                            .book((before - after) * damaged.body.volume.at(slot));
                    }
                }
                for (k, bits) in after.iter().enumerate() {
                    *damaged.alive.at(first + k) = *bits;
                }
                for (n, all) in new.iter().flatten().enumerate().take(self.forms) {
                    for l in 0..TILE {
                        *damaged
                            .form
                            .data
                            .at(damaged.form.layout.at(n, rows.slot(l))) = all[l];
                    }
                }
            }
        }
        tally
    }
}

impl<const D: usize, F: Family<D>> BreakBonds<'_, D, F> {
    /// Energies of a group's points before and after, the means of here and away.
    #[inline(always)]
    fn energies<L: Lane>(
        &self,
        group: usize,
        before: &[u8],
        (after, form): (&[u8], Option<&Form>),
    ) -> [[f64; TILE]; 2] {
        let still = LawView {
            bonds: BondView {
                constants: self.damaged.still,
                ..self.law.bonds
            },
            ..self.law
        };
        let mut energies = [L::splat(0.0); 2];
        for (law, drift) in [(&self.law, None), (&still, Some(self.damaged.drift))] {
            for (n, (bits, form)) in [(before, None), (after, form)].into_iter().enumerate() {
                let of = law.energy(group, Kept { bits, form, drift });
                // SAFETY: a number per lane
                let energy = unsafe { L::load(of.as_ptr()) };
                energies[n] = L::splat(0.5).fma(energy, energies[n]);
            }
        }
        // `map` of arrays is not inlined
        crate::array::from_fn(|n| energies[n].to_array())
    }

    /// What the points of a group know of a family with these bonds.
    fn new_forms(&self, group: usize, bits: &[u8]) -> Form {
        let family = self.law.bonds.family;
        let (mut all, mut numbers) = ([[0.0; TILE]; FORM], [0.0; FORM]);
        let numbers = &mut numbers[..self.forms];
        for l in (0..TILE).filter(|l| family.is_point(group, *l)) {
            let material = self.damaged.body.material_of(family.rows(group).slot(l));
            let law = self.law.law;
            family.reference_family(group, bits, l, &mut |reference| {
                law.form(material, reference, numbers)
            });
            for (all, x) in all.iter_mut().zip(&*numbers) {
                all[l] = *x;
            }
        }
        all
    }
}

/// The part of the energy `after` that a point keeps which had `before`; where that was none, all or nothing, whichever is less. Nothing where what is
/// left of the family is turned over, so that its law has no force state.
fn kept(before: f64, after: f64) -> f64 {
    if after <= before || before.is_nan() || (after <= 0.0 && before <= 0.0) {
        1.0
    } else if before > 0.0 && after.is_finite() {
        before / after
    } else {
        0.0
    }
}
