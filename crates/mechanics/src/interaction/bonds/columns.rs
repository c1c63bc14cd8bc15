//! The columns of a law: declared by it, read and written by name.

use super::family::Family;
use super::state::{Before, BondState, all_whole};
use super::store::Store;
use super::walks::Walks;
use crate::body::{Body, Column};
use crate::columns::{Declaration, Dimension, On, Shape};
use crate::interaction::history;
use crate::law::material::Columns;
use crate::state::Archive;

/// Columns of criteria.
const LIFE: &str = "remaining_life";
/// What breaking has left of points.
const INTEGRITY: &str = "integrity";

/// Where a column lies among the numbers of a law.
enum Place {
    Memory(usize),
    Past(usize),
    Point(usize),
    Reference(usize),
}

impl<const D: usize, F: Family<D>> BondState<D, F> {
    /// Where a number of points of this name is among what the law remembers of them.
    pub(super) fn past_of(&self, name: &str) -> Option<usize> {
        match self.place(name) {
            Some((_, Place::Past(n))) => Some(n),
            Some((_, Place::Memory(_) | Place::Point(_) | Place::Reference(_))) | None => None,
        }
    }

    /// What a directed bond has beside the law's memory.
    fn beside(&self, name: &str) -> Option<&Vec<f64>> {
        let found = match name {
            history::DONE => &self.work,
            LIFE => &self.life,
            _ => return None,
        };
        Some(found).filter(|x| !x.is_empty())
    }

    /// A column by its name, and its first number.
    fn place(&self, name: &str) -> Option<(Declaration, Place)> {
        let Columns {
            memory,
            past,
            point,
            places,
        } = &self.law.columns;
        let found = |all: &[Declaration]| {
            let mut first = 0;
            for d in all {
                if d.name == name {
                    return Some((d.clone(), first));
                }
                first += d.shape.stored(D);
            }
            None
        };
        let memory = found(memory).map(|(d, n)| (d, Place::Memory(n)));
        let past = || found(past).map(|(d, n)| (d, Place::Past(n)));
        let point = || found(point).map(|(d, n)| (d, Place::Point(n)));
        let places = || found(places).map(|(d, n)| (d, Place::Reference(n)));
        memory.or_else(past).or_else(point).or_else(places)
    }

    /// Where the bits of [directed](BondState::directed) bonds are: byte and lane.
    fn bits(&self) -> impl Iterator<Item = (usize, usize)> {
        self.directed()
            .map(|(group, k, l)| (self.family.byte(group, k), l))
    }

    /// Places of what they remember.
    fn memory_of(&self, first: usize, numbers: usize) -> impl Iterator<Item = usize> {
        self.places_of(first, numbers, self.law.memory)
    }

    /// The same of `count` numbers for each.
    fn places_of(&self, first: usize, numbers: usize, count: usize) -> impl Iterator<Item = usize> {
        self.directed().flat_map(move |(group, k, l)| {
            (0..numbers).map(move |n| self.family.own(group, k, first + n, count) + l)
        })
    }
}

/// All that who knows neither law nor family asks of bonds: which there are, and their columns, as [`Interaction`](crate::interaction::Interaction) has them.
pub trait AnyBonds<const D: usize>: Walks<D> {
    fn declared(&self) -> Vec<Declaration>;
    fn read_named(&self, body: &Body<D>, name: &str, out: &mut Vec<f64>) -> bool;
    fn write_named(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool;
    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>);
}

impl<const D: usize, F: Family<D>> AnyBonds<D> for BondState<D, F> {
    fn declared(&self) -> Vec<Declaration> {
        let Columns {
            memory,
            past,
            point,
            places,
        } = self.law.columns.clone();
        let mut breaks = history::columns(!self.critical.is_empty() && self.work.is_empty());
        if !self.work.is_empty() {
            breaks.extend(history::of_work());
        }
        if !self.life.is_empty() {
            breaks.push(Declaration::of_bonds(
                LIFE,
                Dimension::NUMBER,
                "What cycles of load have left of the life of a bond, 1 at first (Silling & Askari 2014).",
            ));
        }
        if !self.integrity.is_empty() {
            breaks.push(Declaration::of_points(
                INTEGRITY,
                Shape::Scalar,
                Dimension::NUMBER,
                "What is left of the energy and the force states of a point, 1 at first: what its family would store more without the bonds that broke is taken away.",
            ));
        }
        [breaks, memory, past, point, places].concat()
    }

    fn read_named(&self, body: &Body<D>, name: &str, out: &mut Vec<f64>) -> bool {
        out.clear();
        if name == history::WHOLE {
            let bit = |(at, l): (usize, usize)| f64::from(self.alive[at] >> l & 1);
            out.extend(self.bits().map(bit));
            return true;
        }
        if let Some(values) = self.beside(name) {
            out.extend(self.places_of(0, 1, 1).map(|at| values[at]));
            return true;
        }
        if name == INTEGRITY && !self.integrity.is_empty() {
            out.extend_from_slice(&self.integrity);
            return true;
        }
        let Some((declaration, place)) = self.place(name) else {
            if (name == history::WORK) == self.work.is_empty() {
                return false;
            }
            return history::read_critical(body, &self.critical, name, out);
        };
        let numbers = declaration.shape.stored(D);
        let of = |store: &Store, first: usize, out: &mut Vec<f64>| {
            out.resize(body.len * numbers, 0.0);
            for &s in &body.slots {
                for n in 0..numbers {
                    out[s as usize * numbers + n] = store.get(first + n, s as usize);
                }
            }
        };
        match place {
            Place::Past(first) => of(&self.past, first, out),
            Place::Point(first) => of(&self.point, first, out),
            Place::Reference(first) => {
                out.resize(body.len * numbers, 0.0);
                for slot in body.slots.iter().map(|s| *s as usize) {
                    let all = self
                        .law
                        .asked
                        .at_place(body.material_of(slot), &body.position(slot));
                    let own = &mut out[slot * numbers..][..numbers];
                    own.copy_from_slice(&all[first..first + numbers]);
                }
            }
            Place::Memory(first) => {
                let places = self.memory_of(first, numbers);
                out.extend(places.map(|at| self.memory[at]));
            }
        }
        true
    }

    fn write_named(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        if name == history::WHOLE {
            let bits: Vec<_> = self.bits().collect();
            if bits.len() != values.len() {
                return false;
            }
            for ((at, l), value) in bits.into_iter().zip(values) {
                match *value != 0.0 {
                    true => self.alive[at] |= 1 << l,
                    false => self.alive[at] &= !(1 << l),
                }
            }
            if self.prepared {
                self.look(body);
            }
            return true;
        }
        if self.beside(name).is_some() {
            let places: Vec<_> = self.places_of(0, 1, 1).collect();
            if values.len() != places.len() {
                return false;
            }
            let into = match name {
                LIFE => &mut self.life,
                _ => {
                    // work is counted from the next sweep on
                    self.before = None;
                    &mut self.work
                }
            };
            for (at, x) in places.into_iter().zip(values) {
                into[at] = *x;
            }
            return true;
        }
        if name == INTEGRITY && !self.integrity.is_empty() {
            if values.len() != self.integrity.len() {
                return false;
            }
            self.integrity.copy_from_slice(values);
            self.look_integrity(body);
            self.look_stiffness(body, true);
            return true;
        }
        let Some((declaration, place)) = self.place(name) else {
            if (name == history::WORK) == self.work.is_empty() {
                return false;
            }
            let known = history::write_critical(body, &mut self.critical, name, values);
            if known {
                body.exchange.fill(&mut self.critical);
            }
            return known;
        };
        let numbers = declaration.shape.stored(D);
        match (place, declaration.on) {
            (Place::Past(first), On::Points) if values.len() == body.len * numbers => {
                for &s in &body.slots {
                    for n in 0..numbers {
                        let x = values[s as usize * numbers + n];
                        self.past.set(first + n, s as usize, x);
                    }
                }
                true
            }
            (Place::Memory(first), On::Bonds) => {
                let places: Vec<_> = self.memory_of(first, numbers).collect();
                if values.len() != places.len() {
                    return false;
                }
                for (at, x) in places.into_iter().zip(values) {
                    self.memory[at] = *x;
                }
                self.fill_memory(body);
                true
            }
            (Place::Past(_) | Place::Point(_) | Place::Reference(_), _)
            | (Place::Memory(_), On::Points) => false,
        }
    }

    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        archive.all("whole", &mut self.alive);
        archive.all("past", &mut self.past.data);
        archive.all("points", &mut self.point.data);
        archive.all("memory", &mut self.memory);
        archive.all("critical", &mut self.critical);
        archive.all("damage", &mut self.damage);
        archive.all("work", &mut self.work);
        archive.all("life", &mut self.life);
        archive.all("integrity", &mut self.integrity);
        strains(archive, body.len, &mut self.expansion);
        let records = self.room.records.len();
        let before = || Before::zeros(body.len, records);
        archive.option("before", &mut self.before, before, |before, archive| {
            archive.columns("displacement", &mut before.u);
            archive.all("records", &mut before.records);
            strains(archive, body.len, &mut before.expansion);
        });
        if self.work.is_empty() && self.before.take().is_some() {
            archive.refuse("before");
        }
        archive.one("step", &mut self.step);
        archive.one("degraded", &mut self.degraded);
        for each in &mut self.stiffness {
            archive.list("stiffness", each);
        }
        archive.one("stiffened", &mut self.stiffened);
        if archive.loads() {
            // kernels follow every bit
            let there = match self.counted.is_empty() {
                true => &all_whole(&self.family).0,
                false => &self.counted,
            };
            self.alive.iter_mut().zip(there).for_each(|(a, t)| *a &= t);
            self.look_forms(body);
        }
    }
}

/// A strain for each of so many slots, or none: kernels read them without looking.
fn strains(archive: &mut Archive<'_>, slots: usize, strain: &mut Column) {
    archive.part("expansion", strain);
    if !strain.is_empty() && strain.len() != slots {
        *strain = Column::default();
        archive.refuse("expansion");
    }
}
