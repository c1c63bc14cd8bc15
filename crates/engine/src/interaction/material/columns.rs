//! The columns of a law: declared by it, read and written by name.

use super::MaterialInteraction;
use super::family::{Family, Slots};
use super::store::Store;
use crate::body::{Body, Field};
use crate::columns::{Declaration, On};
use crate::execute::lane::TILE;
use crate::law::material::{Columns, Material, Numbers};

/// Where a column lies among the numbers of a law.
enum Place {
    Memory(usize),
    Past(usize),
    Point(usize),
}

impl<const D: usize, F: Family<D>, M: Material<D>> MaterialInteraction<D, F, M> {
    pub(super) fn declared(&self) -> Vec<Declaration> {
        let Columns {
            memory,
            past,
            point,
        } = self.law.columns();
        [memory, past, point].concat()
    }

    /// A column by its name, and its first number.
    fn place(&self, name: &str) -> Option<(Declaration, Place)> {
        let Columns {
            memory,
            past,
            point,
        } = self.law.columns();
        let found = |all: Vec<Declaration>| {
            let mut first = 0;
            for d in all {
                if d.name == name {
                    return Some((d, first));
                }
                first += d.shape.stored(D);
            }
            None
        };
        let memory = found(memory).map(|(d, n)| (d, Place::Memory(n)));
        let past = || found(past).map(|(d, n)| (d, Place::Past(n)));
        let point = || found(point).map(|(d, n)| (d, Place::Point(n)));
        memory.or_else(past).or_else(point)
    }

    pub(super) fn read_named(
        &self,
        body: &Body<D>,
        _: &Field<D>,
        name: &str,
        out: &mut Vec<f64>,
    ) -> bool {
        out.clear();
        let Some((declaration, place)) = self.place(name) else {
            return false;
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
            Place::Memory(first) => {
                for at in self.memory_of(first, numbers) {
                    out.push(self.memory[at]);
                }
            }
        }
        true
    }

    pub(super) fn write_named(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        let Some((declaration, place)) = self.place(name) else {
            return false;
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
                let places = self.memory_of(first, numbers);
                if values.len() != places.len() {
                    return false;
                }
                for (at, x) in places.into_iter().zip(values) {
                    self.memory[at] = *x;
                }
                let count = <M::Memory<f64> as Numbers<f64>>::COUNT;
                self.family
                    .fill_images(&body.images, &mut self.memory, count);
                true
            }
            (Place::Past(_) | Place::Point(_), _) | (Place::Memory(_), On::Points) => false,
        }
    }

    /// Places of what the directed bonds of the reference family remember, in order of slots.
    fn memory_of(&self, first: usize, numbers: usize) -> Vec<usize> {
        let count = <M::Memory<f64> as Numbers<f64>>::COUNT;
        let mut rows = vec![];
        for group in 0..self.family.groups() {
            for l in (0..TILE).filter(|l| self.family.is_point(group, *l)) {
                rows.push((self.family.rows(group).slot(l), group, l));
            }
        }
        rows.sort_unstable();
        let mut all = vec![];
        for (_, group, l) in rows {
            for k in 0..self.family.bonds(group) {
                if self.counted[self.family.byte(group, k)] >> l & 1 == 1 {
                    let at = |n| self.family.own(group, k, first + n, count) + l;
                    all.extend((0..numbers).map(at));
                }
            }
        }
        all
    }
}
