//! Which bonds break, what their points lose with them, and the next critical stretch.

use super::family::{Family, Moved, Slots, put};
use super::store::OwnRows;
use super::sweeps::EnergyOf;
use super::view::{BLOCK, Drift, View, grown, save};
use crate::body::{Body, FieldView};
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE, elementary};
use crate::execute::simd::Kernel;
use crate::interaction::bond::relative_square_stretch;
use crate::interaction::criterion::{Criteria, Measure};
use crate::interaction::{Tally, Toughness, history};
use crate::law::material::fibres::{Fibres, of_kind};
use crate::law::material::{Kin, Material, Numbers, Partner, part_of};

/// Most numbers that a form has.
const FORM: usize = 32;

/// Which bonds are beyond their critical stretch or work, between points whose mean damage has reached 1, or worn out; they break later.
/// Knows nothing of laws.
pub struct Test<'a, const D: usize, F> {
    pub family: &'a F,
    pub moved: Moved<'a, D>,
    pub body: &'a Body<D>,
    pub alive: &'a [u8],
    pub critical: &'a [f64],
    /// Empty: stretches alone decide.
    pub damage: &'a [f64],
    /// Strain by temperature or swelling per slot; empty: none.
    pub expansion: &'a [f64],
    pub next: Shared,
    pub toughness: &'a [Toughness],
    pub criteria: &'a Criteria,
    /// Per material; empty: all bonds of one are alike.
    pub fibres: &'a [Fibres<D>],
    /// Are stretches of points all that counts, without rates and fibres?
    pub plain: bool,
    /// Work done on each directed bond; empty: it does not matter.
    pub work: &'a [f64],
    /// What is left of the life of each; empty: none wears.
    pub life: &'a [f64],
    /// Velocities, for rates.
    pub v: FieldView<'a, D>,
    /// Do points without whole bonds keep the critical stretch that they had?
    pub keeps: bool,
    /// A bit for every bond that breaks, and a mark for every group that has any.
    pub breaks: Shared<u8>,
    pub torn: Shared<u8>,
}

impl<const D: usize, F: Family<D>> Kernel for Test<'_, D, F> {
    type Out = ();

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let f = self.family;
        for group in block * BLOCK..((block + 1) * BLOCK).min(f.groups()) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let rows = f.rows(group);
                let place = f.place::<L>(rows);
                let u = F::displacement::<L>(&self.moved, rows);
                let own = rows.one::<L>(self.critical.as_ptr());
                let fails = !self.damage.is_empty();
                let damaged = match fails {
                    true => rows.one::<L>(self.damage.as_ptr()),
                    false => L::splat(0.0),
                };
                let mut lowest = L::splat(f64::INFINITY);
                let mut torn = 0;
                for k in 0..f.bonds(group) {
                    let byte = f.byte(group, k);
                    let alive = *self.alive.get_unchecked(byte);
                    let dead = L::dead(alive);
                    let ends = f.ends(group, k);
                    let mut eta = F::displacement::<L>(&self.moved, ends);
                    for a in 0..D {
                        eta[a] = (eta[a] - u[a]).zero_if(dead);
                    }
                    let r = f.reference::<L>(group, k, &place, ends, dead);
                    if !self.expansion.is_empty() {
                        let [strain, per_length] = grown(self.expansion, rows, ends);
                        for a in 0..D {
                            eta[a] = ((eta[a] - strain * r.xi[a]) * per_length).zero_if(dead);
                        }
                    }
                    let e = relative_square_stretch(eta, r.xi, r.two_by_square).nan_if(dead);
                    lowest = e.min(lowest);
                    let other = ends.one::<L>(self.critical.as_ptr());
                    let mut breaks = if !self.work.is_empty() {
                        let work = L::load(self.work.as_ptr().add(f.own(group, k, 0, 1)));
                        // a bond that is shorter than in the reference is not torn
                        let longer = L::bits(L::splat(0.0).lt(e)) as u8;
                        L::bits(history::limit(other, own).lt(work)) as u8 & longer
                    } else if self.plain {
                        L::bits(history::limit(other, own).lt(e)) as u8
                    } else if !self.fibres.is_empty() {
                        let own = self.stronger(own, rows, &r.xi);
                        let other = self.stronger(other, ends, &r.xi);
                        L::bits(history::limit(other, own).lt(e)) as u8
                    } else {
                        let mut opening = L::splat(0.0);
                        for a in 0..D {
                            let column = self.v[a].as_ptr();
                            let rate = ends.one::<L>(column) - rows.one::<L>(column);
                            opening = (r.xi[a] + eta[a]).fma(rate.zero_if(dead), opening);
                        }
                        // ṡ = (ξ+η)·η̇/(|ξ+η| |ξ|)
                        let current = r.length * (L::splat(1.0) + e.zero_if(dead)).sqrt();
                        let mut speed = opening.div(current * r.length);
                        if !self.expansion.is_empty() {
                            let [_, per_length] = grown(self.expansion, rows, ends);
                            speed = speed * per_length;
                        }
                        let own = self.quicker(own, rows, speed);
                        let other = self.quicker(other, ends, speed);
                        L::bits(history::limit(other, own).lt(e)) as u8
                    };
                    if !self.life.is_empty() {
                        let life = L::load(self.life.as_ptr().add(f.own(group, k, 0, 1)));
                        let spent = L::bits(L::splat(0.0).ge(life)) as u8 & alive;
                        breaks |= spent & !(L::bits(history::spared(other, own)) as u8);
                    }
                    if fails {
                        let both = damaged + ends.one::<L>(self.damage.as_ptr());
                        let fail = L::bits(both.ge(L::splat(2.0))) as u8 & alive;
                        breaks |= fail & !(L::bits(history::spared(other, own)) as u8);
                    }
                    *self.breaks.at(byte) = breaks;
                    torn |= breaks;
                }
                *self.torn.at(group) = torn;
                let material = |l: usize| self.body.material_of(rows.slot(l));
                let alone = if self.keeps {
                    own
                } else {
                    L::splat(f64::INFINITY)
                };
                let next = match &self.criteria.measure {
                    Measure::Work(limit) => {
                        let of: [f64; TILE] = std::array::from_fn(|l| limit[material(l)]);
                        L::load(of.as_ptr())
                    }
                    Measure::Stretch | Measure::VonMises(_) | Measure::PlasticStrain(_) => {
                        history::next_critical(self.toughness, material, lowest, alone)
                    }
                };
                put(next, self.next, rows);
            }
        }
    }
}

impl<const D: usize, F: Family<D>> Test<'_, D, F> {
    /// The critical `e` of points for their bonds ξ, some of which are fibres.
    #[inline(always)]
    fn stronger<L: Lane>(&self, critical: L, slots: F::Slots, xi: &[L; D]) -> L {
        if let [one] = self.fibres {
            // no `map`: it would not be inlined
            let mut direction = *xi;
            for a in 0..D {
                direction[a] = L::splat(one.direction[a]);
            }
            return fibre_limit(&direction, L::splat(one.critical), critical, xi);
        }
        let (mut direction, mut of_fibre) = ([[0.0; TILE]; D], [0.0; TILE]);
        for l in 0..L::N {
            let fibres = &self.fibres[self.body.material_of(slots.slot(l))];
            of_fibre[l] = fibres.critical;
            for a in 0..D {
                direction[a][l] = fibres.direction[a];
            }
        }
        let mut of = *xi;
        for a in 0..D {
            // SAFETY, both: a number per lane
            of[a] = unsafe { L::load(direction[a].as_ptr()) };
        }
        let of_fibre = unsafe { L::load(of_fibre.as_ptr()) };
        fibre_limit(&of, of_fibre, critical, xi)
    }

    /// The critical `e` of points where a bond is stretched at this rate.
    #[inline(always)]
    fn quicker<L: Lane>(&self, critical: L, slots: F::Slots, speed: L) -> L {
        let rate = |l: usize| {
            let material = self.body.material_of(slots.slot(l));
            self.criteria.rate.get(material).copied().flatten()
        };
        let (mut coefficient, mut reference) = ([0.0; TILE], [1.0; TILE]);
        for l in 0..L::N {
            if let Some(rate) = rate(l) {
                (coefficient[l], reference[l]) = (rate.coefficient, rate.reference);
            }
        }
        // SAFETY, both: a number per lane
        let coefficient = unsafe { L::load(coefficient.as_ptr()) };
        let reference = unsafe { L::load(reference.as_ptr()) };
        let one = L::splat(1.0);
        let beyond = elementary::ln(speed.div(reference).max(one));
        let factor = coefficient.fma(beyond, one);
        // ∞ and never are left alone
        let known = critical.lt(L::splat(1e100));
        let s0 = history::stretch(L::select(known, critical, one));
        L::select(known, history::critical(s0 * factor), critical)
    }
}

/// The critical `e` of a bond ξ at an end with these fibres, that of the point unless it is one of them.
#[inline(always)]
pub fn fibre_limit<L: Lane, const D: usize>(
    direction: &[L; D],
    critical: L,
    of_point: L,
    xi: &[L; D],
) -> L {
    // ∞ and never are left alone
    let known = of_point.lt(L::splat(1e100));
    let of_fibre = L::select(known, history::critical(critical), of_point);
    of_kind(direction, xi, of_fibre, of_point)
}

/// How much shorter the shortest whole bond of a block is than in the reference: the most `1 − r²/r0²`, or 0.
pub struct Shortest<'a, const D: usize, F> {
    pub family: &'a F,
    pub moved: Moved<'a, D>,
    pub alive: &'a [u8],
}

impl<const D: usize, F: Family<D>> Kernel for Shortest<'_, D, F> {
    type Out = [f64; 2];

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 2] {
        let f = self.family;
        let mut most = L::splat(0.0);
        for group in block * BLOCK..((block + 1) * BLOCK).min(f.groups()) {
            // SAFETY: groups of the family
            unsafe {
                let rows = f.rows(group);
                let place = f.place::<L>(rows);
                let u = F::displacement::<L>(&self.moved, rows);
                for k in 0..f.bonds(group) {
                    let dead = L::dead(*self.alive.get_unchecked(f.byte(group, k)));
                    let ends = f.ends(group, k);
                    let mut eta = F::displacement::<L>(&self.moved, ends);
                    for a in 0..D {
                        eta[a] = (eta[a] - u[a]).zero_if(dead);
                    }
                    let r = f.reference::<L>(group, k, &place, ends, dead);
                    let e = relative_square_stretch(eta, r.xi, r.two_by_square).nan_if(dead);
                    most = (L::splat(0.0) - e).max(most);
                }
            }
        }
        [most.to_array().into_iter().fold(0.0, f64::max), 0.0]
    }
}

/// Break them. What points lose is the energy of their bonds before less that of those that they keep, the mean of here and a step
/// away (see [`Tear::drift`]): so the balance of energy is of second order in the step.
///
/// A family whose form is that of its whole bonds (a deformation gradient, weights) may be strained more without a bond than with it, and store
/// more: `W′ > W`. Breaking can only dissipate (Silling & Lehoucq 2010, the free energy at a fixed deformation falls with damage), so that
/// of such a point is `W/W′` of what it would be from then on, and so are its force states: its integrity, 1 at first.
pub struct Tear<'a, const D: usize, F, M> {
    /// With the constants of the step.
    pub view: View<'a, D, F, M>,
    /// Constants of a step of no length.
    pub still: &'a [f64],
    pub body: &'a Body<D>,
    /// Marks of groups with bonds that break.
    pub torn: &'a [u8],
    /// Bits of bonds that break; then of those that are left.
    pub breaks: Shared<u8>,
    /// Bits of whole bonds, forms of families and integrities, to be written.
    pub alive: Shared<u8>,
    pub form: OwnRows,
    /// `None`: the form is that of the family as it was.
    pub integrity: Option<Shared>,
    pub v: FieldView<'a, D>,
    /// Time to where a bond was last with its points (negative: it lets go at once and the kick of the half step that ends here misses
    /// it), or will be (it pulls once more).
    pub drift: f64,
}

impl<const D: usize, F: Family<D>, M: Material<D>> Kernel for Tear<'_, D, F, M> {
    type Out = Tally;
    const SELDOM: bool = true;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Tally {
        let v = &self.view;
        let mut tally = Tally::default();
        for group in v.block(block) {
            if self.torn[group] == 0 {
                continue;
            }
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let first = v.family.byte(group, 0);
                let bonds = v.family.bonds(group);
                let before = v.bits(group);
                let after = std::slice::from_raw_parts_mut(self.breaks.at(first), bonds);
                for (left, whole) in after.iter_mut().zip(before) {
                    *left = whole & !*left;
                }
                let after = &*after;
                let mut at = v.group::<L>(group, 0);
                let old = at.rows.load::<L, M::Form<L>>(v.form);
                let new = if M::FORM_OF_WHOLE {
                    v.forms::<L>(group, after, self.body)
                } else {
                    old
                };
                let still = View {
                    constants: self.still,
                    ..*v
                };
                let away = Drift {
                    v: self.v,
                    time: self.drift,
                };
                let mut energies = [L::splat(0.0); 2];
                for (view, drift) in [(v, None), (&still, Some(away))] {
                    at.constants = view.constants_at::<L>(at.rows);
                    for (n, (bits, form)) in [(before, &old), (after, &new)].into_iter().enumerate()
                    {
                        let energy = L::apart(EnergyOf::<L, D, F, M> {
                            view,
                            at: &at,
                            bits,
                            drift,
                            form,
                        });
                        energies[n] = L::splat(0.5).fma(energy, energies[n]);
                    }
                }
                let energies = energies.map(|e| e.to_array());
                for l in 0..TILE {
                    let of = before.iter().zip(after);
                    let broken = of.filter(|(b, a)| (*b ^ *a) >> l & 1 == 1).count();
                    if broken > 0 {
                        let slot = at.rows.slot(l);
                        let [before, mut after] = energies.map(|e| e[l]);
                        if let Some(integrity) = &self.integrity {
                            let left = kept(before, after);
                            *integrity.at(slot) *= left;
                            after = part_of(left, after);
                        }
                        tally.broken += broken as u64;
                        tally
                            .released
                            .book((before - after) * self.body.volume.at(slot));
                    }
                }
                for (k, bits) in after.iter().enumerate() {
                    *self.alive.at(first + k) = *bits;
                }
                if M::FORM_OF_WHOLE {
                    save(self.form, at.rows, &new);
                }
            }
        }
        tally
    }
}

/// The part of the energy `after` that a point keeps which had `before`; where that was none, all or nothing, whichever is less. Nothing where what is
/// left of the family is turned over, so that its law has no answer.
fn kept(before: f64, after: f64) -> f64 {
    if after <= before || before.is_nan() || (after <= 0.0 && before <= 0.0) {
        1.0
    } else if before > 0.0 && after.is_finite() {
        before / after
    } else {
        0.0
    }
}

impl<const D: usize, F: Family<D>, M: Material<D>> View<'_, D, F, M> {
    /// What the points of a group know of a family with these bonds.
    #[inline(always)]
    fn forms<L: Lane>(&self, group: usize, bits: &[u8], body: &Body<D>) -> M::Form<L> {
        let count = <M::Form<L> as Numbers<L>>::COUNT;
        let mut out = <M::Form<L> as Numbers<L>>::constant(0.0);
        const { assert!(<M::Form<f64> as Numbers<f64>>::COUNT <= FORM) };
        let mut all = [[0.0; TILE]; FORM];
        for l in (0..TILE).filter(|l| self.family.is_point(group, *l)) {
            let form = self.form_of(group, bits, l, body);
            for (n, all) in all.iter_mut().enumerate().take(count) {
                all[l] = form.get(n);
            }
        }
        for (n, all) in all.iter().enumerate().take(count) {
            // SAFETY: a number per lane
            out.set(n, unsafe { L::load(all.as_ptr()) });
        }
        out
    }

    /// Of one point.
    pub fn form_of(&self, group: usize, bits: &[u8], l: usize, body: &Body<D>) -> M::Form<f64> {
        let slot = self.family.rows(group).from(l).slot(0);
        self.of_family(group, bits, l, |kin| {
            self.law.form(body.material_of(slot), kin)
        })
    }

    /// Something of the family of one point.
    pub fn of_family<T>(
        &self,
        group: usize,
        bits: &[u8],
        l: usize,
        what: impl FnOnce(Kin<D>) -> T,
    ) -> T {
        let each = |visit: &mut dyn FnMut(&Partner<D>)| {
            for (k, bits) in bits.iter().enumerate() {
                if bits >> l & 1 == 0 {
                    continue;
                }
                let r = self.family.plain(group, k, l);
                visit(&Partner {
                    xi: r.xi,
                    omega: r.omega,
                    volume: r.weight,
                });
            }
        };
        let slot = self.family.rows(group).from(l).slot(0);
        let lost = |(k, bits): (usize, &u8)| self.family.is_bond(group, k, l) && bits >> l & 1 == 0;
        let torn = bits.iter().enumerate().any(lost);
        what(Kin::new(&each).within(self.family.reach(slot)).torn(torn))
    }
}
