//! Coulomb friction of points that touch, with a memory of sticking (Cundall & Strack 1979): a spring along the faces that slips.
//!
//! A pair has an elastic part ξ of the path of j along i. It grows by what j moves against i across n, the direction from i to j, turns
//! with n, and is cut to the length at which `κ |ξ| = μ K (d − r)`, with K (d − r) what the pair repels with and `κ = 2/7 K`
//! ([`TANGENTIAL`]). The force density on i is `κ V_j ξ`, that on j the opposite. μ may depend on the speed of sliding and on time
//! ([`FrictionSpec`]). What touches and slides when a run begins has slid before. So what sticks holds a force without creeping; momentum
//! is kept; what slips is dissipated; and the rest, `½ κ ξ² V_i V_j`, is energy of the contact until the pair parts.
//!
//! The force acts at the place of contact, midway between the points; at one of them that is alone: with y from i to j the couple
//! `V_i V_j κ y × ξ` acts on both besides ([`Families`]). Dual to it the path of j along i is that of the points less what they turn by together,
//! `u_j − u_i − ω × y`. So angular momentum is kept, what turns as one does not rub, and what rolls does not either. Between two points that
//! are both alone there is no couple, and angular momentum is not kept.

use super::contact::{Contact, Touch};
use super::coulomb::{Coefficients, TANGENTIAL, begun, follows, length, sliding, slipped};

use super::spin::{Families, Spin, in_order};
use super::{BondTangent, EachTangent, Evaluation, Interaction};
use crate::body::{Body, Field, zeros};
use crate::execute::exact::Exact;
use crate::space::{cross, full};
use crate::spec::FrictionSpec;
use crate::state::{Archive, words};
use bytemuck::{Pod, Zeroable};
use std::iter::Peekable;
use std::slice::Iter;

/// The elastic path ξ of two that touch.
#[derive(Debug, Clone, Copy)]
struct Spring<const D: usize> {
    /// Ids, the lower first.
    ends: [u32; 2],
    way: [f64; D],
    /// `d − r` (length).
    depth: f64,
    /// ξ over what it would be if nothing slipped: 1 of what sticks.
    kept: f64,
    volumes: [f64; 2],
}

words!([const D: usize] Spring<D> { ends: [u32; 2], way: [f64; D], depth: f64, kept: f64, volumes: [f64; 2] });

/// Two that touch, from the one with the lower id to the other.
#[derive(Debug, Clone, Copy)]
struct Pair<const D: usize> {
    ids: [u32; 2],
    /// [What they are called](Body::id_of).
    touch: Touch<D>,
}

/// What friction sees of a point.
#[derive(Debug, Clone, Copy)]
struct End<const D: usize> {
    volume: f64,
    /// Displacement, that where the step began, and velocity.
    u: [f64; D],
    from: [f64; D],
    v: [f64; D],
    spin: Spin,
}

/// The same, as ranks tell each other.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
struct ExternalValues {
    id: u64,
    volume: f64,
    moved: [[f64; 3]; 3],
    takes: [[f64; 3]; 3],
    turns: [[f64; 3]; 2],
}

// SAFETY, both: numbers without gaps between them, and all bits are some
unsafe impl Zeroable for ExternalValues {}
unsafe impl Pod for ExternalValues {}

/// By what those that touch are pressed while an increment or an implicit step looks for its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pressed {
    /// As at the last call of `press`: friction has a potential then.
    Held,
    /// As they are.
    Now,
}

/// Where an increment or an implicit step began.
#[derive(Debug, Clone)]
struct Departure<const D: usize> {
    u: Field<D>,
    /// Force density there.
    force: Field<D>,
    pressed: Pressed,
}

/// Friction of points that touch, outside the families and over broken bonds, and what it has dissipated.
#[derive(Debug, Clone)]
pub struct Friction<const D: usize> {
    law: FrictionSpec,
    /// Force density of the last evaluation.
    force: Field<D>,
    /// Of an increment of statics or an implicit step.
    from: Option<Departure<D>>,
    /// Of all that touch, by their ends: as they were when the step began, and as they are.
    before: Vec<Spring<D>>,
    now: Vec<Spring<D>>,
    /// How deep they were at the last [`Friction::press`], in statics.
    pressed: Vec<Spring<D>>,
    /// Work done on the points of this rank (energy), and what it was when the step began.
    pub work: Exact,
    kept: Exact,
    /// Who is in each slot, copies too; empty: not looked up yet.
    ids: Vec<u32>,
    /// Who touches now, of pairs with a point of this rank.
    touching: Vec<Pair<D>>,
    families: Families<D>,
    /// How often the contact had found its pairs when families were found.
    found: u64,
    /// What springs hold (energy), of those that this rank counts: `−work − energy` is dissipated.
    pub energy: Exact,
}

/// Passes springs through an archive, those of two ranks once.
fn archive_springs<const D: usize>(
    body: &Body<D>,
    archive: &mut Archive<'_>,
    name: &str,
    all: &mut Vec<Spring<D>>,
) {
    let whose = body.whose();
    let is_here = |id: u32| whose.place(id).is_some();
    let of = |n: usize| -> Vec<(u32, Spring<D>)> {
        let own = all.iter().filter(|s| is_here(s.ends[n]));
        own.map(|s| (s.ends[n], *s)).collect()
    };
    // either end goes on from it
    let [mut first, mut second] = [0, 1].map(of);
    archive.within(name, |archive| {
        archive.entries("first", whose, &mut first);
        archive.entries("second", whose, &mut second);
    });
    if archive.loads() {
        second.retain(|(_, s)| !is_here(s.ends[0]));
        *all = first.into_iter().chain(second).map(|(_, s)| s).collect();
        all.sort_by_key(|s| s.ends);
    }
}

/// Who is in each slot; nobody where a point was taken away.
fn ids_by_slot<const D: usize>(body: &Body<D>) -> Vec<u32> {
    if body.exchange.is_shared() {
        return body.ids_of_all().into_owned();
    }
    let mut ids = vec![u32::MAX; body.len];
    (0..)
        .zip(&body.slots)
        .for_each(|(id, slot)| ids[*slot as usize] = id);
    body.exchange.fill(&mut ids);
    ids
}

/// The id of who is [called](Body::id_of) so, by those of all slots.
fn called(ids: &[u32], n: usize) -> u32 {
    match n.checked_sub(ids.len()) {
        None => ids[n],
        Some(id) => id as u32,
    }
}

/// The spring of two, in a list that is gone through in order of the ends.
fn find<'a, const D: usize>(
    all: &mut Peekable<Iter<'a, Spring<D>>>,
    ends: [u32; 2],
) -> Option<&'a Spring<D>> {
    while all.next_if(|s| s.ends < ends).is_some() {}
    all.next_if(|s| s.ends == ends)
}

impl<const D: usize> Friction<D> {
    pub fn new(law: FrictionSpec, body: &Body<D>) -> Self {
        Friction {
            law,
            force: zeros(body.len),
            from: None,
            before: vec![],
            now: vec![],
            pressed: vec![],
            work: Exact::ZERO,
            kept: Exact::ZERO,
            ids: vec![],
            touching: vec![],
            families: Families::default(),
            found: 0,
            energy: Exact::ZERO,
        }
    }

    /// Passes what it remembers through an archive.
    pub fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        body.archive_field(archive, "force", &mut self.force);
        archive_springs(body, archive, "before", &mut self.before);
        archive_springs(body, archive, "springs", &mut self.now);
        archive_springs(body, archive, "pressed", &mut self.pressed);
        archive.part("work", &mut self.work);
        archive.part("stored", &mut self.energy);
        let slots = body.len;
        let departure = || Departure {
            u: zeros(slots),
            force: zeros(slots),
            pressed: Pressed::Now,
        };
        archive.option("departure", &mut self.from, departure, |from, archive| {
            body.archive_field(archive, "displacement", &mut from.u);
            body.archive_field(archive, "force", &mut from.force);
            let mut held = from.pressed == Pressed::Held;
            archive.one("held", &mut held);
            from.pressed = if held { Pressed::Held } else { Pressed::Now };
        });
        if archive.loads() {
            if let Some(from) = &mut self.from {
                body.exchange.fill_field(&mut from.u);
            }
            // found again with the pairs of the contact
            self.touching.clear();
            self.families = Families::default();
            self.found = 0;
        }
    }

    /// A step begins from what is now. Half of the work of the old force; `v` is the velocity of the middle of the step that ends now.
    pub fn begin(&mut self, body: &Body<D>, v: &Field<D>, dt: f64) {
        std::mem::swap(&mut self.before, &mut self.now);
        self.kept.clone_from(&self.work);
        self.half_path(body, v, dt);
    }

    /// An increment of statics or an implicit step begins, from these displacements.
    pub fn depart(&mut self, body: &Body<D>, u: &Field<D>, pressed: Pressed) {
        std::mem::swap(&mut self.before, &mut self.now);
        self.kept.clone_from(&self.work);
        let mut u = u.clone();
        body.exchange.fill_field(&mut u);
        self.from = Some(Departure {
            u,
            force: self.force.clone(),
            pressed,
        });
    }

    /// In statics what rubs is pressed as it is at this call, until the next: between calls friction has a potential.
    pub fn press(&mut self) {
        self.pressed.clone_from(&self.now);
    }

    /// Does anything touch a point of this rank?
    pub fn rubs(&self) -> bool {
        !self.now.is_empty()
    }

    /// It has ended: its work, by the trapezoidal rule.
    pub fn arrive(&mut self, body: &Body<D>, u: &Field<D>) {
        let Some(from) = &self.from else {
            return;
        };
        for &s in &body.slots {
            let i = s as usize;
            let force = |a: usize| from.force[a][i] + self.force[a][i];
            let work = (0..D).map(|a| force(a) * (u[a][i] - from.u[a][i]));
            self.work.add(0.5 * body.volume.at(i) * work.sum::<f64>());
        }
    }

    /// Back to before the last [`Friction::begin`] or [`Friction::depart`].
    pub fn retreat(&mut self) {
        std::mem::swap(&mut self.before, &mut self.now);
        self.work.clone_from(&self.kept);
    }

    /// Points have these ids now, in the order of those that they had; what is gone touches nobody any more.
    pub fn renumber(&mut self, moved: &dyn Fn(u32) -> Option<u32>) {
        for all in [&mut self.before, &mut self.now, &mut self.pressed] {
            all.retain_mut(|spring| {
                let ends = spring.ends.map(moved);
                let [Some(one), Some(other)] = ends else {
                    return false;
                };
                spring.ends = [one, other];
                true
            });
        }
        self.ids.clear();
        self.touching.clear();
        self.families = Families::default();
        self.found = 0;
    }

    /// What it took so far is in the past: nothing is dissipated from here on.
    pub fn forget(&mut self) {
        self.work = Exact::ZERO;
        self.energy.parts().iter().for_each(|x| self.work.take(*x));
    }

    /// Adds the force density at time `t`, at the displacements of the contact's last update, to `f`.
    pub fn add(
        &mut self,
        contact: &Contact<D>,
        interaction: &dyn Interaction<D>,
        body: &Body<D>,
        [u, v]: [&Field<D>; 2],
        f: &mut Field<D>,
        (t, at): (f64, Evaluation),
    ) {
        let law = Coefficients::new(&self.law, t);
        let at = at.of(self.from.is_some());
        if let Evaluation::Start { .. } = at {
            std::mem::swap(&mut self.before, &mut self.now);
        }
        self.now.clear();
        self.energy = Exact::ZERO;
        self.force.iter_mut().for_each(|c| c.fill(0.0));
        self.look(contact, interaction, body, u);
        let departed = self.from.take();
        let from = at.since(&departed);
        let ends = self.ends(body, [u, v], from.map(|from| &from.u));
        let whose = body.whose();
        let is_here = |id: u32| whose.place(id).is_some();
        // all in order of their ends
        let mut before = self.before.iter().peekable();
        let mut pressed = self.pressed.iter().peekable();
        for pair in &self.touching {
            let Touch { i, j, y, r, d, .. } = pair.touch;
            if r == 0.0 {
                continue;
            }
            let before = find(&mut before, pair.ids);
            let depth = match from {
                Some(from) if from.pressed == Pressed::Held => {
                    find(&mut pressed, pair.ids).map_or(0.0, |s| s.depth)
                }
                Some(_) | None => d - r,
            };
            let normal = y.map(|c| c / r);
            let [one, other] = pair.ids.map(|id| {
                let place = ends.binary_search_by_key(&id, |(id, _)| *id);
                &ends[place.expect("who touches is known")].1
            });
            let together = Spin::together([&one.spin, &other.spin]);
            // what both turn by together is no sliding
            let [turn, turned] = together.map_or([[0.0; D]; 2], |t| {
                t.turns.map(|omega| {
                    let moved = cross(&omega, &full(&y));
                    crate::array::from_fn(|a| moved[a])
                })
            });
            let straight: [f64; D] = crate::array::from_fn(|a| other.v[a] - one.v[a]);
            let relative = crate::array::from_fn(|a| straight[a] - turn[a]);
            let speeds = length(&turn) + length(&one.v);
            let w = sliding(&normal, &relative, speeds);
            let most = law.at(length(&w)) * depth / TANGENTIAL;
            let sticks = before.is_some_and(|s| s.way != [0.0; D]);
            let (way, kept) = match at {
                Evaluation::Start { .. } if !sticks => (begun(&w, most), 1.0),
                Evaluation::Start { .. }
                | Evaluation::StepEnd { .. }
                | Evaluation::Trial { .. } => {
                    let path = match from {
                        Some(_) => crate::array::from_fn(|a| {
                            (other.u[a] - other.from[a]) - (one.u[a] - one.from[a]) - turned[a]
                        }),
                        None => w.map(|c| at.ended() * c),
                    };
                    slipped(before.map_or(&[0.0; D], |s| &s.way), &normal, &path, most)
                }
            };
            let stiffness = TANGENTIAL * pair.touch.stiffness;
            let [vi, vj] = [one.volume, other.volume];
            for a in 0..D {
                if is_here(pair.ids[0]) {
                    self.force[a][i] += stiffness * vj * way[a];
                }
                if is_here(pair.ids[1]) {
                    self.force[a][j] -= stiffness * vi * way[a];
                }
            }
            if let Some(together) = &together {
                let couple = cross(&full(&y), &full(&way));
                let couple = couple.map(|c| stiffness * vi * vj * c);
                self.families.turn(together, pair.ids, &couple);
            }
            // of two ranks one counts a pair across their border
            if is_here(pair.ids[0]) {
                let square: f64 = way.iter().map(|c| c * c).sum();
                self.energy.add(0.5 * stiffness * square * vi * vj);
            }
            self.now.push(Spring {
                ends: pair.ids,
                way,
                depth: d - r,
                kept,
                volumes: [vi, vj],
            });
        }
        self.from = departed;
        self.families.add(body, u, &mut self.force);
        for a in 0..D {
            for (f, own) in f[a].iter_mut().zip(self.force[a].iter()) {
                *f += own;
            }
        }
        if let Evaluation::StepEnd { dt } = at {
            self.half_path(body, v, dt);
        }
    }

    /// Who touches now, in order of ids, and which bonds are broken.
    fn look(
        &mut self,
        contact: &Contact<D>,
        interaction: &dyn Interaction<D>,
        body: &Body<D>,
        u: &Field<D>,
    ) {
        if self.ids.is_empty() {
            self.ids = ids_by_slot(body);
        }
        let (ids, whose) = (&self.ids, body.whose());
        let id = |n: usize| called(ids, n);
        let touching = &mut self.touching;
        touching.clear();
        let mut push = |mut touch: Touch<D>| {
            let mut ids = [touch.i, touch.j].map(id);
            if ids[0] > ids[1] {
                ids.swap(0, 1);
                std::mem::swap(&mut touch.i, &mut touch.j);
                touch.y = touch.y.map(|c| -c);
            }
            touching.push(Pair { ids, touch });
        };
        contact.each_contact(u, |touch| push(contact.called(body, touch)));
        self.families.begin();
        let families = &mut self.families;
        interaction.each_broken(body, &mut |i, j, xi| {
            let ids = [i, j].map(id);
            families.tear((i, ids[0]), ids[1], &xi);
            // the other end says it, too, where it is here
            if ids[0] <= ids[1] || whose.place(ids[1]).is_none() {
                contact
                    .touch_inside(body, u, [i, j], xi)
                    .into_iter()
                    .for_each(&mut push);
            }
        });
        // two may touch more than once, by their images: in one order, whichever of them is here
        let by_image = |a: &Pair<D>, b: &Pair<D>| in_order(&a.touch.y, &b.touch.y);
        self.touching
            .sort_by(|a, b| a.ids.cmp(&b.ids).then_with(|| by_image(a, b)));
        self.find_families(contact, interaction, body);
    }

    /// What there is to see of all that touch, in the order of ids. All ranks come here at once.
    fn ends(
        &mut self,
        body: &Body<D>,
        [u, v]: [&Field<D>; 2],
        from: Option<&Field<D>>,
    ) -> Vec<(u32, End<D>)> {
        let whose = body.whose();
        let mut ids: Vec<u32> = self.touching.iter().flat_map(|pair| pair.ids).collect();
        ids.sort_unstable();
        ids.dedup();
        let shared = body.exchange.is_shared();
        let (mut ends, mut own) = (Vec::with_capacity(ids.len()), vec![]);
        for &id in &ids {
            let Some(n) = whose.place(id) else {
                continue;
            };
            let slot = body.slots[n] as usize;
            let of = |field: &Field<D>| crate::array::from_fn(|a| field[a][slot]);
            let end = End {
                volume: body.volume.at(slot),
                u: of(u),
                from: from.map_or([0.0; D], of),
                v: of(v),
                spin: self.families.spin(body, [u, v], from, id),
            };
            if shared {
                own.push(ExternalValues {
                    id: u64::from(id),
                    volume: end.volume,
                    moved: [end.u, end.from, end.v].map(|x| full(&x)),
                    takes: end.spin.takes,
                    turns: end.spin.turns,
                });
            }
            ends.push((id, end));
        }
        if !shared {
            return ends;
        }
        let is_other = |told: &ExternalValues| {
            let id = told.id as u32;
            whose.place(id).is_none() && ids.binary_search(&id).is_ok()
        };
        let others = body.all_of(&own).concat().into_iter().filter(is_other);
        ends.extend(others.map(|told| {
            let of = |n: usize| crate::array::from_fn(|a| told.moved[n][a]);
            let end = End {
                volume: told.volume,
                u: of(0),
                from: of(1),
                v: of(2),
                spin: Spin {
                    takes: told.takes,
                    turns: told.turns,
                },
            };
            (told.id as u32, end)
        }));
        ends.sort_unstable_by_key(|(id, _)| *id);
        ends
    }

    /// Finds the families of all that may touch before pairs are found anew, where one is missing.
    fn find_families(
        &mut self,
        contact: &Contact<D>,
        interaction: &dyn Interaction<D>,
        body: &Body<D>,
    ) {
        let touching = self.touching.iter().flat_map(|pair| pair.ids);
        let mut ids: Vec<u32> = touching.collect();
        // those of other ranks may have points of this one in their families
        if body.exchange.is_shared() {
            ids = body.all_of(&ids).concat();
        }
        if ids.iter().all(|id| self.families.knows(*id)) {
            return;
        }
        contact.each_listed(|ends| {
            ids.extend(ends.map(|n| called(&self.ids, contact.called_end(body, n))));
        });
        // faces of a crack are not listed
        if self.found == contact.builds() {
            ids.extend(self.families.ids());
        }
        self.found = contact.builds();
        self.families.learn(interaction, body, &self.ids, ids);
    }

    /// The tangents of the last evaluation. What pressure and couples do to them is left out: a couple reaches whole families, and is small beside
    /// what presses. Newton's steps are shorter by that, not wrong.
    pub fn tangents(&self, body: &Body<D>, visit: &mut EachTangent<D>) {
        let whose = body.whose();
        let touching = self.touching.iter().filter(|pair| pair.touch.r > 0.0);
        for (pair, spring) in touching.zip(&self.now) {
            let touch = &pair.touch;
            let normal = touch.y.map(|c| c / touch.r);
            let block = follows(&normal, &spring.way, spring.kept);
            let stiffness = TANGENTIAL * touch.stiffness;
            let ends = [(touch.i, touch.j, 1.0), (touch.j, touch.i, -1.0)];
            for (n, (i, j, way)) in ends.into_iter().enumerate() {
                if whose.place(pair.ids[n]).is_none() {
                    continue;
                }
                let per = stiffness * spring.volumes[1 - n];
                let block = block.map(|row| row.map(|c| per * c));
                visit(BondTangent::direct(i, j, touch.y.map(|c| way * c), block));
            }
        }
    }

    fn half_path(&mut self, body: &Body<D>, v: &Field<D>, dt: f64) {
        for &s in &body.slots {
            let i = s as usize;
            let power: f64 = (0..D).map(|a| self.force[a][i] * v[a][i]).sum();
            self.work.add(0.5 * dt * power * body.volume.at(i));
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let springs = self.before.capacity() + self.now.capacity() + self.pressed.capacity();
        let fields = if self.from.is_some() { 3 } else { 1 };
        8 * D * fields * self.force[0].len()
            + size_of::<Spring<D>>() * springs
            + 4 * self.ids.capacity()
            + size_of::<Pair<D>>() * self.touching.capacity()
            + self.families.bytes()
    }
}
