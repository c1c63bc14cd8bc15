//! The columns of a law: declared by it, read and written by name.

use super::family::Family;
use super::state::{Before, BondState};
use super::store::Store;
use super::walks::Walks;
use crate::body::{Body, Column};
use crate::columns::{Declaration, Dimension, On, Shape};
use crate::interaction::history;
use crate::law::material::Columns;
use crate::state::{Archive, Bonds};

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
        let rows = self.rows_by_id(body);
        let bonds = archive.bonds("bonds", body.whose(), self.counts_of(&rows));
        self.archive_bits(archive, body, (&rows, &bonds));
        let remembered = self.law.memory;
        let of_bonds = [
            ("memory", &mut self.memory, remembered),
            ("work", &mut self.work, 1),
            ("life", &mut self.life, 1),
        ];
        for (name, values, each) in of_bonds {
            let places = places_of(&self.family, &self.counted, &rows, each);
            archive.rows(name, body.whose(), (&bonds, each), (values, places));
        }
        for (name, store) in [("past", &mut self.past), ("points", &mut self.point)] {
            let layout = store.layout;
            let numbers = (&mut store.data[..], layout.numbers);
            body.archive_points(archive, name, numbers, |slot, n| layout.at(n, slot));
        }
        let [whole, now] = &mut self.stiffness;
        for (name, column) in [
            ("critical", &mut self.critical[..]),
            ("damage", &mut self.damage),
            ("integrity", &mut self.integrity),
            ("stiffness", whole),
            ("stiffness_now", now),
        ] {
            body.archive_points(archive, name, (column, 1), |slot, _| slot);
        }
        strains(archive, body, &mut self.expansion);
        let records = self.workspace.records.len();
        let before = || Before::zeros(body.len, records);
        // a rank without bonds keeps nothing
        if body.exchange.any(self.before.is_some()) {
            self.before.get_or_insert_with(before);
        }
        archive.option("before", &mut self.before, before, |before, archive| {
            body.archive_field(archive, "displacement", &mut before.u);
            let records = (&mut before.records[..], 4);
            body.archive_points(archive, "records", records, |slot, n| 4 * slot + n);
            strains(archive, body, &mut before.expansion);
        });
        // sweeps write work without looking
        let has_bonds = self.directed().next().is_some();
        if has_bonds && self.work.is_empty() && self.before.take().is_some() {
            archive.refuse("before");
        }
        archive.one("step", &mut self.step);
        if archive.loads() {
            self.restored(body);
        }
    }
}

/// Of each point by id, its group and place in it; `None`: it has no bonds.
type RowsById = [Option<(usize, usize)>];

/// Where `each` numbers of every bond of some points are remembered.
fn places_of<const D: usize, F: Family<D>>(
    family: &F,
    counted: &[u8],
    rows: &RowsById,
    each: usize,
) -> impl Iterator<Item = usize> {
    let rows = rows.iter().flatten().copied();
    rows.flat_map(move |(group, l)| {
        let bonds = 0..family.bonds(group);
        let bonds = bonds.filter(move |k| family.counts(counted, (group, *k, l)));
        bonds.flat_map(move |k| (0..each).map(move |n| family.own(group, k, n, each) + l))
    })
}

impl<const D: usize, F: Family<D>> BondState<D, F> {
    fn rows_by_id(&self, body: &Body<D>) -> Vec<Option<(usize, usize)>> {
        let mut at = vec![None; body.len];
        for (group, l, slot) in self.family.points() {
            at[slot] = Some((group, l));
        }
        body.by_id(|slot| at[slot])
    }

    fn bonds_of_row(&self, (group, l): (usize, usize)) -> impl Iterator<Item = usize> {
        let bonds = 0..self.family.bonds(group);
        bonds.filter(move |k| self.is_counted(group, *k, l))
    }

    fn counts_of(&self, rows: &RowsById) -> Vec<u32> {
        let count = |row| self.bonds_of_row(row).count() as u32;
        rows.iter().map(|row| row.map_or(0, count)).collect()
    }

    /// Bits of whole bonds.
    fn archive_bits(
        &mut self,
        archive: &mut Archive<'_>,
        body: &Body<D>,
        (rows, bonds): (&RowsById, &Bonds),
    ) {
        let mut bytes = vec![];
        for (group, l) in rows.iter().flatten().copied() {
            let begin = bytes.len();
            for (n, k) in self.bonds_of_row((group, l)).enumerate() {
                if n % 8 == 0 {
                    bytes.push(0);
                }
                bytes[begin + n / 8] |= u8::from(self.is_whole(group, k, l)) << (n % 8);
            }
        }
        archive.bits("whole", body.whose(), bonds, &mut bytes);
        if !archive.loads() {
            return;
        }
        let mut next = 0;
        for (group, l) in rows.iter().flatten().copied() {
            let bonds: Vec<usize> = self.bonds_of_row((group, l)).collect();
            for (n, k) in bonds.iter().enumerate() {
                let bit = bytes[next + n / 8] >> (n % 8) & 1;
                let byte = &mut self.alive[self.family.byte(group, *k)];
                *byte = *byte & !(1 << l) | bit << l;
            }
            next += bonds.len().div_ceil(8);
        }
    }

    /// What follows from a state that was read.
    fn restored(&mut self, body: &Body<D>) {
        let exchange = &body.exchange;
        self.fill_memory(body);
        for store in [&mut self.past, &mut self.point] {
            store.fill(exchange);
        }
        for column in [&mut self.critical, &mut self.damage, &mut self.expansion] {
            if !column.is_empty() {
                exchange.fill(column);
            }
        }
        if let Some(before) = &mut self.before {
            exchange.fill_field(&mut before.u);
            if !before.records.is_empty() {
                exchange.fill_numbers(&mut before.records, 4, |slot, n| 4 * slot + n);
            }
            if !before.expansion.is_empty() {
                exchange.fill(&mut before.expansion);
            }
        }
        self.look_integrity(body);
        self.find_stiffened();
        self.look_forms(body);
    }
}

/// A strain for each point, or none.
fn strains<const D: usize>(archive: &mut Archive<'_>, body: &Body<D>, strain: &mut Column) {
    let mut there = body.exchange.any(!strain.is_empty());
    archive.one("strained", &mut there);
    if archive.loads() && there == strain.is_empty() {
        strain.renew(if there { body.len } else { 0 });
    }
    body.archive_points(archive, "expansion", (strain, 1), |slot, _| slot);
}
