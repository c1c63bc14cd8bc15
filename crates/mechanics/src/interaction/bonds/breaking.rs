//! Which bonds break, and the next critical stretch.

use super::family::{Family, Moved, Slots, put};
use super::state::{BondState, Workspace};
use super::view::{BondView, grown};
use crate::body::{Body, FieldView};
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE, elementary};
use crate::execute::simd::Kernel;
use crate::interaction::bond::relative_square_stretch;
use crate::interaction::criterion::{Criteria, Measure};
use crate::interaction::{Toughness, history};
use crate::law::material::fibres::{Fibres, of_kind};

/// The column of laws that flow.
pub(crate) const PLASTIC_STRAIN: &str = "plastic_strain";

/// Which bonds are beyond their critical stretch or work, between points whose mean damage has reached 1, or worn out; they break later.
/// Knows nothing of laws.
pub struct Test<'a, const D: usize, F> {
    pub view: BondView<'a, D, F>,
    pub body: &'a Body<D>,
    pub critical: &'a [f64],
    /// Empty: stretches alone decide.
    pub damage: &'a [f64],
    pub next: Shared,
    pub toughness: &'a [Toughness],
    pub criteria: &'a Criteria,
    /// Per material; empty: all bonds of one are alike.
    pub fibres: &'a [Fibres<D>],
    /// Are stretches of points all that counts, without rates and fibres?
    pub plain: bool,
    /// Work done on each directed bond; empty: it does not matter.
    pub work: &'a [f64],
    /// What is left of the life of each; empty: there is no fatigue.
    pub life: &'a [f64],
    /// Velocities, for rates.
    pub v: FieldView<'a, D>,
    /// Do points without whole bonds keep the critical stretch that they had?
    pub keeps: bool,
    /// A bit for every bond that breaks, and a mark for every group that has any.
    pub breaks: Shared<u8>,
    pub damaged: Shared<u8>,
}

impl<const D: usize, F: Family<D>> Kernel for Test<'_, D, F> {
    type Out = ();
    type Home = Self;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let (v, f) = (&self.view, self.view.family);
        for group in v.block(block) {
            // SAFETY: groups of the family; each is written by one block
            unsafe {
                let at = v.points::<L>(group);
                let rows = at.rows;
                let own = rows.one::<L>(self.critical.as_ptr());
                let fails = !self.damage.is_empty();
                let damaged = match fails {
                    true => rows.one::<L>(self.damage.as_ptr()),
                    false => L::splat(0.0),
                };
                let mut lowest = L::splat(f64::INFINITY);
                let mut broken = 0;
                for k in 0..f.bonds(group) {
                    let byte = f.byte(group, k);
                    let alive = *v.alive.at(byte);
                    let dead = L::dead(alive);
                    let ends = f.ends(group, k);
                    let (r, eta) = v.stretched::<L>(&at, k, dead);
                    let e = relative_square_stretch(eta, r.xi, r.two_by_square).nan_if(dead);
                    lowest = e.min(lowest);
                    let other = ends.one::<L>(self.critical.as_ptr());
                    let mut breaks = if !self.work.is_empty() {
                        let work = L::load(self.work.as_ptr().add(f.own(group, k, 0, 1)));
                        // a bond that is shorter than in the reference is not broken
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
                        if !v.expansion.is_empty() {
                            let [_, per_length] = grown(v.expansion, rows, ends);
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
                    broken |= breaks;
                }
                *self.damaged.at(group) = broken;
                let material = |l: usize| self.body.material_of(rows.slot(l));
                let alone = if self.keeps {
                    own
                } else {
                    L::splat(f64::INFINITY)
                };
                let next = match &self.criteria.measure {
                    Measure::Work(limit) => {
                        let of: [f64; TILE] = crate::array::from_fn(|l| limit[material(l)]);
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
    type Home = Self;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 2] {
        let f = self.family;
        let mut most = L::splat(0.0);
        for group in f.block(block) {
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

impl<const D: usize, F: Family<D>> BondState<D, F> {
    /// Marks the bonds that break, and finds the next critical stretch. False: none does, on any rank.
    pub fn find_breaking(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        workspace: &Workspace,
        v: FieldView<D>,
    ) -> bool {
        self.look_damage(body);
        let next = Shared(self.next.as_mut_ptr());
        let breaks = Shared(self.breaks.as_mut_ptr());
        let damaged = Shared(self.damaged.as_mut_ptr());
        let test = Test {
            view: self.view(u, workspace),
            body,
            critical: &self.critical,
            damage: &self.damage,
            next,
            toughness: &self.toughness,
            criteria: &self.criteria,
            fibres: &self.law.fibres,
            plain: self.criteria.rate.is_empty() && self.law.fibres.is_empty(),
            work: &self.work,
            life: &self.life,
            v,
            keeps: self.law.passes > 0,
            breaks,
            damaged,
        };
        self.blocks.run(&test);
        body.exchange.any(self.damaged.iter().any(|t| *t != 0))
    }

    /// Damage as the points remember it.
    fn look_damage(&mut self, body: &Body<D>) {
        if let Measure::PlasticStrain(limit) = &self.criteria.measure {
            let Some(n) = self.past_of(PLASTIC_STRAIN) else {
                return;
            };
            body.set_points(&mut self.damage, |slot| {
                self.past.get(n, slot) / limit[body.material_of(slot)]
            });
        } else if let Some(n) = self.law.failure {
            body.set_points(&mut self.damage, |slot| self.past.get(n, slot));
        }
    }

    /// After integrities have changed.
    pub fn look_integrity(&mut self, body: &Body<D>) {
        if self.integrity.is_empty() {
            return;
        }
        body.exchange.fill(&mut self.integrity);
        self.degraded = self.integrity.iter().any(|x| *x < 1.0);
    }

    pub fn next_critical(&mut self, body: &Body<D>) {
        std::mem::swap(&mut self.critical, &mut self.next);
        body.exchange.fill(&mut self.critical);
    }

    /// How much shorter the shortest whole bond is than in the reference: the most `1 − r²/r0²`, or 0.
    pub fn shortest(&mut self, u: FieldView<D>) -> f64 {
        let workspace = self.take_workspace(u);
        let kernel = Shortest {
            family: &self.family,
            moved: Moved {
                columns: u,
                records: &workspace.records,
            },
            alive: &self.alive,
        };
        let most = self.blocks.most(&kernel);
        self.workspace = workspace;
        most
    }

    /// How stiff some points are now by their families, of damaged ones or of `all`, and the most of all beside the body as it was prepared.
    pub fn look_stiffness(&mut self, body: &Body<D>, all: bool) {
        let [whole, mut now] = std::mem::take(&mut self.stiffness);
        if now.is_empty() {
            return;
        }
        let (family, law) = (&self.family, &self.law.asked);
        for (group, l, slot) in family.points().filter(|p| all || self.damaged[p.0] != 0) {
            let material = body.material_of(slot);
            let bits = family.bits(&self.alive, group);
            let mut of = 0.0;
            family.reference_family(group, bits, l, &mut |reference| {
                of = law.stiffness(material, reference)
            });
            now[slot] = self.integrity_at(slot) * of;
        }
        self.stiffness = [whole, now];
        self.find_stiffened();
    }

    /// How much stiffer the stiffest damaged point is than it was.
    pub fn find_stiffened(&mut self) {
        let [whole, now] = &self.stiffness;
        let stiffened = |(whole, now): (&f64, &f64)| if *whole > 0.0 { now / whole } else { 1.0 };
        self.stiffened = whole.iter().zip(now).map(stiffened).fold(1.0, f64::max);
    }

    /// What [`BondState::look_stiffness`] compares with.
    pub fn begin_stiffness(&mut self, body: &Body<D>) {
        if !self.law.stiffens_damaged || self.critical.is_empty() {
            return;
        }
        self.stiffness = [vec![0.0; body.len], vec![0.0; body.len]];
        self.look_stiffness(body, true);
        self.stiffness[0] = self.stiffness[1].clone();
        self.stiffened = 1.0;
    }

    /// What points know of their families, from the bonds that are whole now.
    pub fn look(&mut self, body: &Body<D>) {
        self.look_stiffness(body, true);
        self.look_forms(body);
    }

    /// Forms of points by their families.
    pub fn look_forms(&mut self, body: &Body<D>) {
        let count = self.law.form;
        if count == 0 {
            return;
        }
        let bits = match self.law.form_of_whole {
            true => &self.alive,
            false => &self.counted,
        };
        let (family, law) = (&self.family, &self.law.asked);
        let mut numbers = vec![0.0; count];
        for (group, l, slot) in family.points() {
            let (material, bits) = (body.material_of(slot), family.bits(bits, group));
            family.reference_family(group, bits, l, &mut |reference| {
                law.form(material, reference, &mut numbers)
            });
            for (n, x) in numbers.iter().enumerate() {
                self.form.set(n, slot, *x);
            }
        }
    }
}
