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
use super::spin::Families;
use super::{BondTangent, EachTangent, Evaluation, Interaction};
use crate::body::{Body, Field, zeros};
use crate::space::{cross, full};
use crate::spec::FrictionSpec;
use crate::state::{Archive, Owner, words};
use std::iter::Peekable;
use std::slice::Iter;

/// The elastic path ξ of two that touch.
#[derive(Debug, Clone, Copy)]
struct Spring<const D: usize> {
    ends: [u32; 2],
    way: [f64; D],
    /// `d − r` (length).
    depth: f64,
    /// ξ over what it would be if nothing slipped: 1 of what sticks.
    kept: f64,
}

words!([const D: usize] Spring<D> { ends: [u32; 2], way: [f64; D], depth: f64, kept: f64 });

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
    /// Work done on the bodies (energy), and what it was when the step began.
    pub work: f64,
    kept: f64,
    /// Who touches now.
    touching: Vec<Touch<D>>,
    families: Families<D>,
    /// How often the contact had found its pairs when families were found.
    found: u64,
    /// What springs hold (energy): `−work − energy` is dissipated.
    pub energy: f64,
}

impl<const D: usize> Owner for Friction<D> {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.columns("force", &mut self.force);
        archive.list("before", &mut self.before);
        archive.list("springs", &mut self.now);
        archive.list("pressed", &mut self.pressed);
        archive.one("work", &mut self.work);
        archive.one("stored", &mut self.energy);
        let slots = self.force[0].len();
        let departure = || Departure {
            u: zeros(slots),
            force: zeros(slots),
            pressed: Pressed::Now,
        };
        archive.option("departure", &mut self.from, departure, |from, archive| {
            archive.columns("displacement", &mut from.u);
            archive.columns("force", &mut from.force);
            let mut held = from.pressed == Pressed::Held;
            archive.one("held", &mut held);
            from.pressed = if held { Pressed::Held } else { Pressed::Now };
        });
        if archive.loads() {
            // found again with the pairs of the contact
            self.touching.clear();
            self.families = Families::default();
            self.found = 0;
        }
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
            work: 0.0,
            kept: 0.0,
            touching: vec![],
            families: Families::default(),
            found: 0,
            energy: 0.0,
        }
    }

    /// A step begins from what is now. Half of the work of the old force; `v` is the velocity of the middle of the step that ends now.
    pub fn begin(&mut self, body: &Body<D>, v: &Field<D>, dt: f64) {
        std::mem::swap(&mut self.before, &mut self.now);
        self.kept = self.work;
        self.half_path(body, v, dt);
    }

    /// An increment of statics or an implicit step begins, from these displacements.
    pub fn depart(&mut self, u: &Field<D>, pressed: Pressed) {
        std::mem::swap(&mut self.before, &mut self.now);
        self.kept = self.work;
        self.from = Some(Departure {
            u: u.clone(),
            force: self.force.clone(),
            pressed,
        });
    }

    /// In statics what rubs is pressed as it is at this call, until the next: between calls friction has a potential.
    pub fn press(&mut self) {
        self.pressed.clone_from(&self.now);
    }

    /// Does anything touch?
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
            self.work += 0.5 * body.volume.at(i) * work.sum::<f64>();
        }
    }

    /// Back to before the last [`Friction::begin`] or [`Friction::depart`].
    pub fn retreat(&mut self) {
        std::mem::swap(&mut self.before, &mut self.now);
        self.work = self.kept;
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
        self.energy = 0.0;
        self.force.iter_mut().for_each(|c| c.fill(0.0));
        self.touching.clear();
        contact.each_contact(u, |touch| self.touching.push(touch));
        let outside = self.touching.len();
        self.families.begin();
        interaction.each_broken(body, &mut |i, j, xi| {
            self.touching
                .extend(contact.touch_inside(body, u, [i, j], xi));
            self.families.tear(i, j, &xi);
        });
        if self.touching.len() > outside {
            self.touching.sort_unstable_by_key(|t| [t.i, t.j]);
        }
        self.find_families(contact, interaction, body);
        let from = at.since(&self.from);
        // all in order of their ends
        let mut before = self.before.iter().peekable();
        let mut pressed = self.pressed.iter().peekable();
        for touch in &self.touching {
            let &Touch { i, j, y, r, d, .. } = touch;
            if r == 0.0 {
                continue;
            }
            let ends = [i as u32, j as u32];
            let before = find(&mut before, ends);
            let depth = match from {
                Some(from) if from.pressed == Pressed::Held => {
                    find(&mut pressed, ends).map_or(0.0, |s| s.depth)
                }
                Some(_) | None => d - r,
            };
            let normal = y.map(|c| c / r);
            let then = from.map(|from| &from.u);
            let together = self.families.together(body, [u, v], then, [i, j]);
            // what both turn by together is no sliding
            let [turn, turned] = together.map_or([[0.0; D]; 2], |t| {
                t.turns.map(|omega| {
                    let moved = cross(&omega, &full(&y));
                    crate::array::from_fn(|a| moved[a])
                })
            });
            let straight: [f64; D] = crate::array::from_fn(|a| v[a][j] - v[a][i]);
            let relative = crate::array::from_fn(|a| straight[a] - turn[a]);
            let speeds = length(&turn) + length::<D>(&crate::array::from_fn(|a| v[a][i]));
            let w = sliding(&normal, &relative, speeds);
            let most = law.at(length(&w)) * depth / TANGENTIAL;
            let sticks = before.is_some_and(|s| s.way != [0.0; D]);
            let (way, kept) = match at {
                Evaluation::Start { .. } if !sticks => (begun(&w, most), 1.0),
                Evaluation::Start { .. }
                | Evaluation::StepEnd { .. }
                | Evaluation::Trial { .. } => {
                    let path = match then {
                        Some(from) => crate::array::from_fn(|a| {
                            (u[a][j] - from[a][j]) - (u[a][i] - from[a][i]) - turned[a]
                        }),
                        None => w.map(|c| at.ended() * c),
                    };
                    slipped(before.map_or(&[0.0; D], |s| &s.way), &normal, &path, most)
                }
            };
            let stiffness = TANGENTIAL * touch.stiffness;
            let [vi, vj] = [i, j].map(|s| body.volume.at(s));
            for a in 0..D {
                self.force[a][i] += stiffness * vj * way[a];
                self.force[a][j] -= stiffness * vi * way[a];
            }
            if let Some(together) = &together {
                let couple = cross(&full(&y), &full(&way));
                let couple = couple.map(|c| stiffness * vi * vj * c);
                self.families.turn(together, [i, j], &couple);
            }
            let square: f64 = way.iter().map(|c| c * c).sum();
            self.energy += 0.5 * stiffness * square * vi * vj;
            self.now.push(Spring {
                ends,
                way,
                depth: d - r,
                kept,
            });
        }
        if !self.now.is_empty() {
            self.families.add(body, u, &mut self.force);
        }
        for a in 0..D {
            for (f, own) in f[a].iter_mut().zip(self.force[a].iter()) {
                *f += own;
            }
        }
        if let Evaluation::StepEnd { dt } = at {
            self.half_path(body, v, dt);
        }
    }

    /// Finds the families of all that may touch before pairs are found anew, where one is missing.
    fn find_families(
        &mut self,
        contact: &Contact<D>,
        interaction: &dyn Interaction<D>,
        body: &Body<D>,
    ) {
        let missing = |t: &Touch<D>| [t.i, t.j].iter().any(|s| !self.families.knows(*s));
        if !self.touching.iter().any(missing) {
            return;
        }
        let touching = self.touching.iter().flat_map(|t| [t.i, t.j]);
        let mut slots: Vec<u32> = touching.map(|s| s as u32).collect();
        contact.each_listed(|ends| slots.extend(ends.map(|s| s as u32)));
        // faces of a crack are not listed
        if self.found == contact.builds() {
            slots.extend(self.families.slots());
        }
        self.found = contact.builds();
        self.families.learn(interaction, body, slots);
    }

    /// The tangents of the last evaluation. What pressure and couples do to them is left out: a couple reaches whole families, and is small beside
    /// what presses. Newton's steps are shorter by that, not wrong.
    pub fn tangents(&self, body: &Body<D>, visit: &mut EachTangent<D>) {
        let touching = self.touching.iter().filter(|t| t.r > 0.0);
        for (touch, spring) in touching.zip(&self.now) {
            let normal = touch.y.map(|c| c / touch.r);
            let block = follows(&normal, &spring.way, spring.kept);
            let stiffness = TANGENTIAL * touch.stiffness;
            for (i, j, way) in [(touch.i, touch.j, 1.0), (touch.j, touch.i, -1.0)] {
                let per = stiffness * body.volume.at(j);
                let block = block.map(|row| row.map(|c| per * c));
                visit(BondTangent::direct(i, j, touch.y.map(|c| way * c), block));
            }
        }
    }

    fn half_path(&mut self, body: &Body<D>, v: &Field<D>, dt: f64) {
        for &s in &body.slots {
            let i = s as usize;
            let power: f64 = (0..D).map(|a| self.force[a][i] * v[a][i]).sum();
            self.work += 0.5 * dt * power * body.volume.at(i);
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let springs = self.before.capacity() + self.now.capacity() + self.pressed.capacity();
        let fields = if self.from.is_some() { 3 } else { 1 };
        8 * D * fields * self.force[0].len()
            + size_of::<Spring<D>>() * springs
            + size_of::<Touch<D>>() * self.touching.capacity()
            + self.families.bytes()
    }
}
