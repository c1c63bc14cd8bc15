//! The sweeps over a horizon list: lanes run over the points of a slice, bonds in a fixed order. No closure touches a
//! lane (see the stencil's kernel).

mod energies;
mod forces;
mod share;

use crate::execute::blocks::{Seen, Shared};
use crate::execute::lane::series::{Extension, Function};
use crate::execute::lane::{self, Lane, TILE};
use crate::family::horizon::HorizonList;
use crate::interaction::Repulsion;
use crate::interaction::bond::relative_square_stretch;
use crate::interaction::bonds::view::BLOCK;
use crate::interaction::pairs::{BondLanes, BondTable};
use crate::interaction::weight::BondWeight;
use crate::law::{BondFactors, Law};
pub use energies::Energies;
pub use forces::Forces;
pub use share::Share;

/// What all kernels read. Records keep what one bond needs of its partner together.
pub struct View<'a, const D: usize, W> {
    pub law: W,
    pub weight: BondWeight,
    pub list: &'a HorizonList,
    /// `[lines]`: bits of whole bonds.
    pub alive: Seen<u8>,
    /// `[lines][8]`: factors of bonds; empty: all are 1.
    pub scale: &'a [f64],
    /// `[slots][4]`: x, y, z, volume.
    pub reference: &'a [f64],
    /// `[slots][4]`: displacement and critical `e`.
    pub moved: &'a [f64],
    /// `[slots][2]`: point fields of the law; empty where it has none.
    pub fields: Seen,
    /// Pressure factors per slot where materials differ; else the law's own.
    pub pressure: &'a [f64],
    /// 0 on free axes.
    pub period: [f64; D],
    pub inv_period: [f64; D],
    pub repulsion: Option<&'a Repulsion>,
    /// `[slots]`, where repulsion or the law depends on it.
    pub materials: &'a [u8],
    pub periodic: bool,
    /// Is the law that of unit constants, and those of a bond are in `pairs`?
    pub paired: bool,
    pub pairs: &'a BondTable,
}

/// One end of a bond.
#[derive(Clone, Copy)]
pub struct End<L, const D: usize> {
    x: [L; D],
    volume: L,
    u: [L; D],
    critical: L,
    field: [L; 2],
}

/// A bond from its two ends.
struct Bond<L, const D: usize> {
    xi: [L; D],
    /// `ξ+η`
    y: [L; D],
    /// `|ξ+η|²/|ξ|² − 1`
    e: L,
    r0_squared: L,
    r0: L,
    inv_r0: L,
    /// The law's constant.
    k: L,
    /// Number of the pair of materials, where they matter.
    pair: [u32; TILE],
}

impl<const D: usize, W: Law> View<'_, D, W> {
    pub fn block(&self, block: usize) -> std::ops::Range<usize> {
        block * BLOCK..((block + 1) * BLOCK).min(self.list.slices())
    }

    /// Rows of a slice.
    #[inline(always)]
    unsafe fn rows(&self, slice: usize) -> *const u32 {
        // SAFETY: there are eight rows per slice
        unsafe { self.list.rows.as_ptr().add(slice * TILE) }
    }

    /// Partners in a line.
    #[inline(always)]
    unsafe fn partners(&self, line: usize) -> *const u32 {
        // SAFETY: there are eight partners per line
        unsafe { self.list.partner.as_ptr().add(line * TILE) }
    }

    /// `FIELDS`: with the point fields, if the law has any.
    #[inline(always)]
    unsafe fn end<L: Lane, const FIELDS: bool>(&self, slot: *const u32) -> End<L, D> {
        // SAFETY: rows and partners are slots, and there is a record for each
        unsafe {
            let x = L::gather4(self.reference.as_ptr(), slot);
            let u = L::gather4(self.moved.as_ptr(), slot);
            let zero = L::splat(0.0);
            let field = if FIELDS && W::FIELDS > 0 {
                L::gather2(self.fields.0, slot)
            } else {
                [zero; 2]
            };
            let mut end = End {
                x: [zero; D],
                volume: x[3],
                u: [zero; D],
                critical: u[3],
                field,
            };
            for a in 0..D {
                end.x[a] = x[a];
                end.u[a] = u[a];
            }
            end
        }
    }

    /// `ξ` from i to the nearest image of j.
    #[inline(always)]
    fn reference<L: Lane>(&self, i: &[L; D], j: &[L; D]) -> [L; D] {
        let mut xi = *j;
        for a in 0..D {
            xi[a] = j[a] - i[a];
            if self.periodic {
                let turns = (xi[a] * L::splat(self.inv_period[a])).round();
                xi[a] = turns.fma(L::splat(-self.period[a]), xi[a]);
            }
        }
        xi
    }

    /// The bond of rows to partners.
    #[inline(always)]
    unsafe fn bond<L: Lane>(
        &self,
        i: &End<L, D>,
        j: &End<L, D>,
        rows: *const u32,
        partners: *const u32,
    ) -> Bond<L, D> {
        let xi = self.reference::<L>(&i.x, &j.x);
        let mut r0_squared = xi[0] * xi[0];
        for a in 1..D {
            r0_squared = xi[a].fma(xi[a], r0_squared);
        }
        let inv_r0 = lane::inv_sqrt(r0_squared);
        let r0 = r0_squared * inv_r0;
        let mut pair = [0; TILE];
        let weight = if self.paired {
            // SAFETY: rows and partners are slots
            let ends = unsafe {
                pair = self.pairs.numbers::<L>(self.materials, rows, partners);
                let horizon = match self.weight.knows_horizon() {
                    true => self.pairs.horizon::<L>(&pair),
                    false => r0,
                };
                [horizon, self.pairs.law::<L>(&pair).cut]
            };
            self.weight.within(&xi, r0, inv_r0, ends) * j.volume
        } else {
            self.weight.at(&xi, r0, inv_r0) * j.volume
        };
        let mut eta = j.u;
        for a in 0..D {
            eta[a] = j.u[a] - i.u[a];
        }
        let e = relative_square_stretch(eta, xi, (inv_r0 + inv_r0) * inv_r0);
        let mut y = eta;
        for a in 0..D {
            y[a] = eta[a] + xi[a];
        }
        Bond {
            xi,
            y,
            e,
            r0_squared,
            r0,
            inv_r0,
            k: self.law.constant(r0, inv_r0, weight),
            pair,
        }
    }

    /// A bond's constant and its ends' fields as they pull: times those of the pair.
    #[inline(always)]
    unsafe fn acting<L: Lane>(&self, b: &Bond<L, D>, i: [L; 2], j: [L; 2]) -> (L, [L; 2], [L; 2]) {
        if !self.paired {
            return (self.law.between_ends(b.k, &b.xi, b.r0, i, j), i, j);
        }
        // SAFETY: of this table
        let BondLanes {
            stiffness, ratio, ..
        } = unsafe { self.pairs.law::<L>(&b.pair) };
        (b.k * stiffness, [i[0] * ratio, i[1]], [j[0] * ratio, j[1]])
    }

    /// A bond's constant times the factors of a line.
    #[inline(always)]
    unsafe fn scaled<L: Lane>(&self, k: L, line: usize) -> L {
        match self.scale.is_empty() {
            true => k,
            // SAFETY: eight factors per line
            false => k * unsafe { L::load(self.scale.as_ptr().add(line * TILE)) },
        }
    }

    /// κ by which the scalar of eight rows stores energy, where the law is that of unit constants.
    #[inline(always)]
    unsafe fn volume<L: Lane>(&self, rows: *const u32) -> L {
        if self.paired {
            // SAFETY: rows are slots
            unsafe {
                let own = self.pairs.numbers::<L>(self.materials, rows, rows);
                self.pairs.law::<L>(&own).volume
            }
        } else {
            L::splat(1.0)
        }
    }

    /// `k r0²` of the bond between two slots, and ξ.
    pub fn constant(&self, i: usize, j: usize) -> ([f64; D], f64) {
        let (row, partner) = (i as u32, j as u32);
        // SAFETY: both are slots
        unsafe {
            let (i, j) = (
                self.end::<f64, false>(&row),
                self.end::<f64, false>(&partner),
            );
            let b = self.bond::<f64>(&i, &j, &row, &partner);
            (self.reference::<f64>(&i.x, &j.x), b.k * b.r0_squared)
        }
    }

    /// Which lanes of really there bonds are closer than repulsion allows, given that `e` may be low enough.
    #[inline(always)]
    fn close<L: Lane>(&self, c: &Repulsion, b: &Bond<L, D>) -> (L::Mask, L) {
        let d = (b.r0 * L::splat(c.bonded)).min(L::splat(c.range.at(0, 0)));
        let limit = (d * b.inv_r0) * (d * b.inv_r0) - L::splat(1.0);
        // padding has length 0
        let real = L::select(L::splat(0.0).lt(b.r0_squared), b.e, L::splat(f64::NAN));
        (real.lt(limit), d)
    }

    /// Coefficient of `ξ+η` at row i that its directed bond to slot j has as a whole one, with repulsion where there is
    /// any, and the two vectors; `alive`: its factor, if it is whole. Plain numbers.
    pub fn pull_of(&self, i: usize, j: usize, alive: Option<f64>) -> ([f64; 2], [f64; D]) {
        let (row, partner) = (i as u32, j as u32);
        // SAFETY: both are slots
        unsafe {
            let (i, j) = (self.end::<f64, true>(&row), self.end::<f64, true>(&partner));
            let b = self.bond::<f64>(&i, &j, &row, &partner);
            let (rows, partners) = ([row; TILE], [partner; TILE]);
            let repulsion = self.repel(&b, j.volume, rows.as_ptr(), partners.as_ptr());
            let mut pull = [repulsion.0, 0.5 * repulsion.0];
            if let Some(factor) = alive {
                let (k, own, other) = self.acting(&b, i.field, j.field);
                let k = k * factor;
                let g = Extension::exact(b.e);
                pull[0] += self.law.pull(k, g, own, other);
                pull[1] += self.law.own_pull(k, g, own, other, BondFactors::ONE);
            }
            (pull, b.y)
        }
    }

    /// Coefficient of `ξ+η` from repulsion and its energy density, of bonds between these slots.
    #[inline(always)]
    unsafe fn repel<L: Lane>(
        &self,
        b: &Bond<L, D>,
        volume: L,
        rows: *const u32,
        partners: *const u32,
    ) -> (L, L) {
        let zero = L::splat(0.0);
        let Some(c) = self.repulsion else {
            return (zero, zero);
        };
        let (close, d) = self.close(c, b);
        if !L::any(close) {
            return (zero, zero);
        }
        let r = (b.r0_squared * (L::splat(1.0) + b.e)).sqrt();
        let mut material = [[0u8; TILE]; 2];
        if !self.materials.is_empty() {
            for l in 0..TILE {
                // SAFETY: a slot per lane
                let ends = unsafe { [*rows.add(l), *partners.add(l)] };
                material[0][l] = self.materials[ends[0] as usize];
                material[1][l] = self.materials[ends[1] as usize];
            }
        }
        let stiffness = match c.own.is_empty() {
            true => c.lanes::<L>(material[0], material[1]),
            false => {
                let mut all = [0.0; TILE];
                for (l, all) in all.iter_mut().enumerate().take(L::N) {
                    // SAFETY: a slot per lane
                    let ends = unsafe { [*rows.add(l), *partners.add(l)] };
                    *all = c.between([0; 2], ends.map(|s| s as usize));
                }
                // SAFETY: a number per lane
                unsafe { L::load(all.as_ptr()) }
            }
        };
        let stiffness = stiffness * volume;
        let pull = (stiffness * (r - d)).div(r);
        let energy = L::splat(0.25) * stiffness * (r - d) * (r - d);
        (L::select(close, pull, zero), L::select(close, energy, zero))
    }

    /// No repulsion in a bond whose `e` is at least this: `(d/r0)² ≤ bonded²`.
    fn contact_e(&self) -> f64 {
        self.repulsion.map_or(-1.0, |c| c.bonded * c.bonded - 1.0)
    }

    /// Pressure factors of eight rows from their own fields.
    #[inline(always)]
    unsafe fn pressure_factor<L: Lane>(&self, rows: *const u32, own: L) -> L {
        if self.pressure.is_empty() {
            self.law.pressure_factor(own)
        } else {
            // SAFETY: rows are slots, one per lane
            let q: [f64; TILE] =
                crate::array::from_fn(|l| unsafe { self.pressure[*rows.add(l) as usize] });
            // SAFETY: a number per lane
            unsafe { L::load(q.as_ptr()) }
        }
    }
}

/// Write one number of each of eight rows, `step` apart.
#[inline(always)]
unsafe fn scatter<L: Lane>(value: L, out: Shared, rows: *const u32, step: usize) {
    let all = value.to_array();
    for (l, x) in all.iter().enumerate() {
        // SAFETY: rows are slots of the caller's field, and every slot is the row of one slice
        unsafe { *out.at(*rows.add(l) as usize * step) = *x };
    }
}
