//! Bodies: reference points, volumes, densities, marks, and where each point's numbers are stored.
//!
//! Fields live in *slots*. On a lattice the slots are the cells of a box (so that a neighbour is a fixed number of
//! slots away); in a cloud they are the points in an order that keeps neighbours close in memory.

pub mod build;
pub mod cut;
pub mod exchange;
pub mod field;
pub mod grid;
mod points;
mod runs;
pub mod several;
pub mod subdomain;
mod together;
pub mod values;

pub use exchange::Exchange;
pub use field::{Column, Field, FieldView, FieldViewMut, view, view_mut, zeros};
pub use grid::Grid;
pub use runs::RunsOfIds;
pub use several::Piece;
pub use subdomain::Subdomain;
pub use values::Values;

use crate::space::Point;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Displacement of absent sites, in spacings: so far that no test of nearness or breaking can ever hold.
pub const FAR: f64 = 1e20;

#[derive(Debug, Clone)]
pub enum Layout<const D: usize> {
    Grid(Grid<D>),
    /// Reference coordinates per slot.
    Cloud([Vec<f64>; D]),
    /// Bodies side by side, each with slots of its own.
    Several(Vec<Piece<D>>),
}

/// Reference configuration of a body in D dimensions.
#[derive(Debug, Clone)]
pub struct Body<const D: usize> {
    /// Interactions are made for a body, and refuse others.
    pub(crate) identity: Identity,
    pub(crate) layout: Layout<D>,
    /// Slot of each point, in order of id.
    pub(crate) slots: Vec<u32>,
    /// Number of slots, guards included; a multiple of the tile where it matters.
    pub(crate) len: usize,
    /// Typical distance of nearest points (length).
    pub(crate) spacing: f64,
    /// Volume per point (length^D × section).
    pub(crate) volume: Values,
    /// Mass density per point.
    pub(crate) density: Values,
    /// Period per axis, if periodic.
    pub(crate) period: [Option<f64>; D],
    /// Material per slot; empty when there is one.
    pub(crate) material: Vec<u8>,
    /// Horizon per slot (length), where points have their own; else empty.
    pub(crate) horizon: Vec<f64>,
    /// Mark per point, in order of id; empty: all 0.
    pub(crate) mark: Vec<i32>,
    /// Which slots are copies of others.
    pub(crate) exchange: Exchange,
    /// What it is a part of; `None`: it is whole.
    pub(crate) subdomain: Option<Arc<Subdomain>>,
    /// Of each of several bodies copies of points that are bonded to another one; empty: there are none.
    beside: Vec<Piece<D>>,
}

/// Which body it is: the number of slots and who is in them. Copies of a body are the same one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Identity(u64);

impl Identity {
    /// Another body than all before.
    pub(crate) fn new() -> Identity {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Identity(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

impl<const D: usize> Body<D> {
    pub fn layout(&self) -> &Layout<D> {
        &self.layout
    }

    /// Of a lattice body, which a stencil is made for.
    ///
    /// # Panics
    /// If it is another body.
    pub(crate) fn grid(&self) -> &Grid<D> {
        match &self.layout {
            Layout::Grid(grid) => grid,
            Layout::Cloud(_) | Layout::Several(_) => unreachable!("stencils live on grids"),
        }
    }

    /// Slot of each point, in order of id.
    pub fn slots(&self) -> &[u32] {
        &self.slots
    }

    /// Which slots are copies of others, and how they are filled.
    pub fn exchange(&self) -> &Exchange {
        &self.exchange
    }

    /// What this body is a part of; `None`: it is whole.
    pub fn subdomain(&self) -> Option<&Subdomain> {
        self.subdomain.as_deref()
    }

    /// Number of slots, guards included: the length of its fields.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Typical distance of nearest points (length).
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Volume per point (length^D × section).
    pub fn volume(&self) -> &Values {
        &self.volume
    }

    /// Mass density per point.
    pub fn density(&self) -> &Values {
        &self.density
    }

    /// Period per axis, if periodic.
    pub fn period(&self) -> [Option<f64>; D] {
        self.period
    }

    /// Horizon per slot (length), where points have their own; else empty.
    pub fn horizons(&self) -> &[f64] {
        &self.horizon
    }

    /// Mark per point, in order of id; empty: all 0.
    pub fn marks(&self) -> &[i32] {
        &self.mark
    }

    /// Never: a body has points.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Gives all points the same density.
    pub fn set_density(&mut self, density: f64) {
        self.density = Values::Uniform(density);
    }

    /// Gives each point its density, in order of id, and their copies theirs.
    ///
    /// # Panics
    /// If there are not as many as points.
    pub fn set_densities(&mut self, density: &[f64]) {
        assert_eq!(density.len(), self.points(), "a density for each point");
        let (low, high) = self.ends(density.iter().copied());
        self.density = match low == high {
            true => Values::Uniform(low),
            false => {
                let mut all = vec![1.0; self.len];
                { density.iter().zip(&self.slots) }.for_each(|(x, s)| all[*s as usize] = *x);
                self.exchange.fill(&mut all);
                Values::PerSlot(all)
            }
        };
    }

    /// Gives each slot its volume.
    ///
    /// # Panics
    /// If there are not as many as slots.
    pub fn set_volumes(&mut self, volume: Vec<f64>) {
        assert_eq!(volume.len(), self.len, "a volume for each slot");
        self.volume = Values::PerSlot(volume);
    }

    /// Gives each slot a horizon of its own (length). Interactions are made afterwards.
    ///
    /// # Panics
    /// If there are not as many as slots.
    pub fn set_horizons(&mut self, horizon: Vec<f64>) {
        assert_eq!(horizon.len(), self.len, "a horizon for each slot");
        self.horizon = horizon;
    }

    /// Gives each point its mark, in order of id.
    ///
    /// # Panics
    /// If there are not as many as points.
    pub fn set_marks(&mut self, mark: Vec<i32>) {
        assert_eq!(mark.len(), self.points(), "a mark for each point");
        self.mark = mark;
    }

    /// Loses points, by their ids in order, of those of all ranks; ids of the others move up, and slots stay where they are.
    pub fn remove(&mut self, gone: &[u32]) {
        let of_all: Vec<u32> = { 0..self.points() }
            .map(|id| self.id_of_all(id) as u32)
            .collect();
        let mut id = of_all.iter();
        let mut keep = || id.next().is_some_and(|id| gone.binary_search(id).is_err());
        let stays: Vec<bool> = self.slots.iter().map(|_| keep()).collect();
        let mut each = stays.iter();
        self.mark.retain(|_| each.next() == Some(&true));
        let mut each = stays.iter();
        self.slots.retain(|_| each.next() == Some(&true));
        if let Some(of) = &self.subdomain {
            self.subdomain = Some(Arc::new(of.without(gone)));
        }
    }

    /// Gives each point its material, in order of id, and their copies theirs.
    ///
    /// # Panics
    /// If there are fewer than points.
    pub fn give_materials(&mut self, mut of_points: impl Iterator<Item = u8>) {
        self.material = vec![0; self.len];
        for s in &self.slots {
            self.material[*s as usize] = of_points.next().expect("a material for each point");
        }
        self.exchange.fill(&mut self.material);
    }

    /// Gives each slot its material.
    ///
    /// # Panics
    /// If there are not as many as slots.
    pub fn set_materials(&mut self, material: Vec<u8>) {
        assert_eq!(material.len(), self.len, "a material for each slot");
        self.material = material;
    }

    /// Reference coordinates of the slots of a cloud, by axis; `None`: it is no cloud. Interactions are made afterwards.
    pub fn coordinates_mut(&mut self) -> Option<[&mut [f64]; D]> {
        self.identity = Identity::new();
        match &mut self.layout {
            Layout::Cloud(x) => Some(x.each_mut().map(Vec::as_mut_slice)),
            Layout::Grid(_) | Layout::Several(_) => None,
        }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.slots.len()
    }

    /// Reference position of a slot, padded to three components.
    pub fn position(&self, slot: usize) -> Point {
        match &self.layout {
            Layout::Grid(g) => g.position(slot),
            Layout::Cloud(x) => crate::array::from_fn(|a| if a < D { x[a][slot] } else { 0.0 }),
            Layout::Several(_) => {
                let p = self.piece_at(slot);
                p.body.position(slot - p.first)
            }
        }
    }

    /// Reference coordinate `a` of points from id `first` on.
    pub fn coordinates(&self, first: usize, a: usize, out: &mut [f64]) {
        let slots = &self.slots[first..];
        match &self.layout {
            Layout::Grid(g) => g.coordinates(slots, a, out),
            Layout::Cloud(x) => {
                for (out, &slot) in out.iter_mut().zip(slots) {
                    *out = if a < D { x[a][slot as usize] } else { 0.0 };
                }
            }
            Layout::Several(_) => {
                for (out, &slot) in out.iter_mut().zip(slots) {
                    *out = self.position(slot as usize)[a];
                }
            }
        }
    }

    pub fn material_of(&self, slot: usize) -> usize {
        self.material.get(slot).map_or(0, |&m| m as usize)
    }

    /// A displacement field at rest: 0 on points, far away on absent sites.
    pub fn at_rest(&self) -> Field<D> {
        let mut u: Field<D> = field::filled(self.len, FAR * self.spacing);
        self.set_vectors(&mut u, |_, _| [0.0; D]);
        u
    }

    /// Mass of the body, of all ranks.
    pub fn mass(&self) -> f64 {
        let slots = self.slots.iter().map(|s| *s as usize);
        self.sum(slots.map(|s| self.volume.at(s) * self.density.at(s)))
    }

    /// Bytes held by the body.
    pub fn bytes(&self) -> usize {
        let layout = match &self.layout {
            Layout::Grid(g) => g.present.len(),
            Layout::Cloud(x) => x.iter().map(|c| c.len() * 8).sum(),
            Layout::Several(pieces) => pieces.iter().map(|p| p.body.bytes()).sum(),
        };
        layout
            + self.slots.len() * 4
            + self.volume.bytes()
            + self.density.bytes()
            + self.material.len()
            + self.mark.len() * 4
            + self.exchange.bytes()
    }
}
