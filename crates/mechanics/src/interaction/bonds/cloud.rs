//! The horizon list of a cloud: groups are slices of eight rows, partners are gathered from records.

use super::abroad::{Abroad, ways_back};
use super::family::{Family, Moved, Reference, Slots};
use super::store::{Layout, Rows};
use crate::body::{Body, Exchange};
use crate::execute::blocks::Seen;
use crate::execute::lane::{self, Lane, TILE};
use crate::family::horizon::HorizonList;
use crate::interaction::weight::BondWeight;
use crate::law::material::Numbers;
use crate::law::solid::dual_horizon::part_within;
use std::ops::Range;
use std::sync::Arc;

/// Eight slots that are listed.
#[derive(Clone, Copy)]
pub struct Listed(*const u32);

impl Slots for Listed {
    #[inline(always)]
    fn slot(self, l: usize) -> usize {
        // SAFETY: made from eight listed slots
        unsafe { *self.0.add(l) as usize }
    }
    #[inline(always)]
    fn from(self, l: usize) -> Self {
        // SAFETY: made from eight listed slots
        Listed(unsafe { self.0.add(l) })
    }
    #[inline(always)]
    unsafe fn one<L: Lane>(self, column: *const f64) -> L {
        let mut all = [0.0; TILE];
        for l in 0..L::N {
            // SAFETY: the caller's promise
            all[l] = unsafe { *column.add(self.slot(l)) };
        }
        // SAFETY: a number per lane
        unsafe { L::load(all.as_ptr()) }
    }
    #[inline(always)]
    unsafe fn load<L: Lane, N: Numbers<L>>(self, rows: Rows) -> N {
        let mut out = N::constant(0.0);
        let mut n = 0;
        while n < N::COUNT {
            // SAFETY: the caller's promise
            let four = unsafe { L::gather4(rows.data.at(n / 4 * rows.layout.stride), self.0) };
            for c in 0..4 {
                if n + c < N::COUNT {
                    out.set(n + c, four[c]);
                }
            }
            n += 4;
        }
        out
    }
}

/// All bonds of a cloud.
#[derive(Debug, Clone)]
pub struct CloudFamily<const D: usize> {
    pub list: HorizonList,
    pub weight: BondWeight,
    /// `[slots]` δ of points with horizons of their own; empty: they have one.
    own: Vec<f64>,
    /// The same horizons over that of the body; empty: they have one.
    reach: Vec<f64>,
    /// 1/h
    rate: f64,
    /// `[slots]`: micromodulus over that at the longest horizon, where points have their own and bonds the stiffness; else empty.
    stiff: Vec<f64>,
    /// Are bonds of these the same from both ends?
    alike: bool,
    /// `[slots][4]`: x, y, z, volume.
    pub reference: Vec<f64>,
    /// `[lines][8]`: place of the bond that leads back; empty: nobody asks.
    back: Vec<u32>,
    /// Bonds of other ranks among them.
    abroad: Option<Arc<Abroad>>,
    /// 0 on free axes.
    pub period: [f64; D],
    pub inv_period: [f64; D],
    slots: usize,
    /// Slots that have rows.
    rows: Range<usize>,
}

impl<const D: usize> CloudFamily<D> {
    /// `horizon`: the longest of all points. `remembers`: does the law have memory of bonds? Points with horizons of their own (`h`: the spacing) weigh a bond by the part of a cell that is within
    /// them, `ω ν` with ν as of [`DualHorizon`](crate::law::solid::dual_horizon::DualHorizon).
    pub fn new(
        body: &Body<D>,
        horizon: f64,
        list: HorizonList,
        weight: BondWeight,
        remembers: bool,
    ) -> Self {
        // slots without a point have one, too
        let of = |d: &f64| if *d > 0.0 { *d } else { horizon };
        let own = body.horizon.iter().map(of).collect();
        let (back, abroad) = match remembers {
            true => ways_back(&list, body),
            false => (vec![], None),
        };
        CloudFamily {
            own,
            reach: body.horizon.iter().map(|d| d / horizon).collect(),
            back,
            abroad: abroad.map(Arc::new),
            ..Self::plain(body, list, weight)
        }
    }

    /// Of points that have one horizon, and a law without memory of bonds.
    pub fn plain(body: &Body<D>, list: HorizonList, weight: BondWeight) -> Self {
        let mut reference = vec![0.0; 4 * body.len];
        for (slot, record) in reference.chunks_mut(4).enumerate() {
            record[..3].copy_from_slice(&body.position(slot));
            record[3] = body.volume.at(slot);
        }
        CloudFamily {
            list,
            weight,
            own: vec![],
            reach: vec![],
            rate: body.spacing.recip(),
            stiff: vec![],
            alike: false,
            reference,
            back: vec![],
            abroad: None,
            period: body.period.map(|p| p.unwrap_or(0.0)),
            inv_period: body.period.map(|p| p.map_or(0.0, f64::recip)),
            slots: body.len,
            rows: body.own_slots(),
        }
    }

    pub fn is_periodic(&self) -> bool {
        self.period.iter().any(|p| *p > 0.0)
    }

    /// Of bonds that make the stiffness: micromoduli over that of the law, by slot. Each end weighs by its own, or both by the mean where bonds are `alike` at both.
    pub fn of_bonds(self, stiff: Vec<f64>, alike: bool) -> Self {
        CloudFamily {
            stiff,
            alike,
            ..self
        }
    }

    /// What part of a cell at this distance is within a horizon.
    #[inline(always)]
    fn part<L: Lane>(&self, horizon: L, length: L) -> L {
        let reach = L::splat(0.5) + horizon * L::splat(self.rate);
        part_within(length, reach, self.rate)
    }

    fn line(&self, group: usize, k: usize) -> usize {
        self.list.start[group] + k
    }
}

impl<const D: usize> Family<D> for CloudFamily<D> {
    type Slots = Listed;
    /// x, y, z, volume, δ of points with horizons of their own, and their stiffness
    type Place<L: Lane> = [L; 6];

    fn groups(&self) -> usize {
        self.list.slices()
    }
    #[inline(always)]
    fn rows(&self, group: usize) -> Listed {
        Listed(self.list.rows[group * TILE..].as_ptr())
    }
    #[inline(always)]
    fn bonds(&self, group: usize) -> usize {
        self.list.start[group + 1] - self.list.start[group]
    }
    #[inline(always)]
    fn ends(&self, group: usize, k: usize) -> Listed {
        Listed(self.list.partner[self.line(group, k) * TILE..].as_ptr())
    }
    #[inline(always)]
    fn byte(&self, group: usize, k: usize) -> usize {
        self.line(group, k)
    }
    fn bytes_of_bits(&self) -> usize {
        self.list.line_count()
    }
    fn is_point(&self, group: usize, l: usize) -> bool {
        (self.rows(group).slot(l)) < self.slots
    }
    fn is_bond(&self, group: usize, k: usize, l: usize) -> bool {
        // a row's own slot: there is no bond
        self.list.partner[self.line(group, k) * TILE + l] != self.list.rows[group * TILE + l]
    }

    #[inline(always)]
    unsafe fn place<L: Lane>(&self, rows: Listed) -> [L; 6] {
        // SAFETY: a record per slot, and a number where there are any
        unsafe {
            let [x, y, z, volume] = L::gather4(self.reference.as_ptr(), rows.0);
            let own = match self.own.is_empty() {
                true => L::splat(0.0),
                false => rows.one::<L>(self.own.as_ptr()),
            };
            let stiff = match self.stiff.is_empty() {
                true => L::splat(1.0),
                false => rows.one::<L>(self.stiff.as_ptr()),
            };
            [x, y, z, volume, own, stiff]
        }
    }
    #[inline(always)]
    unsafe fn reference<L: Lane>(
        &self,
        _: usize,
        _: usize,
        at: &[L; 6],
        ends: Listed,
        dead: L::Mask,
    ) -> Reference<L, D> {
        // SAFETY: a record per slot
        let x = unsafe { L::gather4(self.reference.as_ptr(), ends.0) };
        let mut xi = [L::splat(0.0); D];
        let mut square = L::splat(0.0);
        for a in 0..D {
            let mut d = x[a] - at[a];
            let turns = (d * L::splat(self.inv_period[a])).round();
            d = turns.fma(L::splat(-self.period[a]), d);
            xi[a] = d;
            square = if a == 0 { d * d } else { d.fma(d, square) };
        }
        // padding has no length
        square = L::select(L::splat(0.0).lt(square), square, L::splat(1.0));
        let inv_length = lane::inv_sqrt(square);
        let length = square * inv_length;
        let [omega, omega_back] = match self.own.is_empty() {
            true => self.weight.influence(&xi, length, inv_length),
            false => {
                // SAFETY: a number per slot
                let there = unsafe { ends.one::<L>(self.own.as_ptr()) };
                let both = [at[4], there];
                let [own, back] = (self.weight).influence_within(&xi, length, inv_length, both);
                let own = own * self.part(at[4], length);
                let back = back * self.part(there, length);
                match self.stiff.is_empty() {
                    true => [own, back],
                    false => {
                        // SAFETY: a number per slot
                        let stiff = unsafe { ends.one::<L>(self.stiff.as_ptr()) };
                        match self.alike {
                            true => [L::splat(0.5) * (own * at[5] + back * stiff); 2],
                            false => [own * at[5], back * stiff],
                        }
                    }
                }
            }
        };
        Reference {
            xi,
            length,
            inv_length,
            two_by_square: (inv_length + inv_length) * inv_length,
            omega,
            omega_back,
            weight: (self.weight.volume_fraction(length) * x[3]).zero_if(dead),
        }
    }
    #[inline(always)]
    unsafe fn displacement<L: Lane>(moved: &Moved<D>, slots: Listed) -> [L; D] {
        // SAFETY: a record per slot
        let four = unsafe { L::gather4(moved.records.as_ptr(), slots.0) };
        let mut u = [L::splat(0.0); D];
        for a in 0..D {
            u[a] = four[a];
        }
        u
    }

    fn reach(&self, slot: usize) -> f64 {
        self.reach.get(slot).copied().unwrap_or(1.0)
    }

    fn layout(&self, numbers: usize) -> Layout {
        Layout::records(numbers, self.slots)
    }
    fn memory(&self) -> usize {
        self.list.partner.len() + self.abroad.as_ref().map_or(0, |a| a.workspace())
    }
    #[inline(always)]
    fn own(&self, group: usize, k: usize, n: usize, count: usize) -> usize {
        (self.line(group, k) * count + n) * TILE
    }
    #[inline(always)]
    unsafe fn back<L: Lane>(
        &self,
        memory: Seen,
        group: usize,
        k: usize,
        part: usize,
        n: usize,
        count: usize,
    ) -> L {
        let first = self.line(group, k) * TILE + part;
        let mut all = [0.0; TILE];
        for l in 0..L::N {
            // SAFETY: a way back for every bond
            unsafe {
                let place = *self.back.get_unchecked(first + l) as usize;
                all[l] = *memory.at((place / TILE * count + n) * TILE + place % TILE);
            }
        }
        // SAFETY: a number per lane
        unsafe { L::load(all.as_ptr()) }
    }
    fn fill_memory(&self, _: &Exchange, memory: &mut [f64], count: usize) {
        if let Some(abroad) = &self.abroad {
            abroad.fill(memory, count);
        }
    }

    fn find(&self, slot: usize) -> Option<(usize, usize)> {
        self.rows.contains(&slot).then(|| {
            let row = self.list.row(slot);
            (row / TILE, row % TILE)
        })
    }

    fn bytes(&self) -> usize {
        self.list.bytes()
            + 8 * (self.reference.len() + 2 * self.own.len() + self.stiff.len())
            + 4 * self.back.len()
    }
}

// SAFETY: a pointer into a list that is only read
unsafe impl Send for Listed {}
unsafe impl Sync for Listed {}
