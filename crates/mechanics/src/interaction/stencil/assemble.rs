//! A stencil interaction from a body, a stencil and a law.

use super::kernel::{Bond, MOST, Partner};
use super::{Apart, StencilInteraction};
use crate::body::{Body, Column, Grid, Layout, field};
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::family::stencil::{Offset, Stencil};
use crate::interaction::bonds::family::Family;
use crate::interaction::bonds::law::LawProperties;
use crate::interaction::bonds::state::BondParts;
use crate::interaction::bonds::store::Store;
use crate::interaction::bonds::{BondState, LatticeFamily};
use crate::interaction::criterion::Criteria;
use crate::interaction::scale::Scale;
use crate::interaction::{PointConstants, Repulsion, Toughness, laws_fields};
use crate::law::Law;
use std::collections::HashMap;

/// Everything a stencil interaction is made of.
pub struct StencilParts<'a, const D: usize, W> {
    /// A lattice body, made for bonds as long as these.
    pub body: &'a Body<D>,
    pub stencil: &'a Stencil,
    pub law: W,
    /// `ω ν` of a bond ξ of a length.
    pub weight: &'a dyn Fn(&[f64; D], f64) -> f64,
    pub point_constants: PointConstants,
    pub toughness: Vec<Toughness>,
    pub repulsion: Option<Repulsion>,
    pub simd: Simd,
}

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    /// # Panics
    /// If the body is no lattice, has unlike volumes, or was made for shorter bonds.
    pub fn new(parts: StencilParts<D, W>) -> Self {
        let StencilParts {
            body,
            stencil,
            law,
            weight,
            point_constants,
            toughness,
            repulsion,
            simd,
        } = parts;
        laws_fields::<W>();
        let Layout::Grid(grid) = &body.layout else {
            panic!("a stencil needs a lattice body, this is a cloud of points: take a list")
        };
        assert_eq!(
            stencil.kind, grid.lattice.kind,
            "the stencil of another lattice"
        );
        let volume = body
            .volume
            .uniform()
            .expect("a lattice body has one volume");
        let h = grid.lattice.spacing;
        let edges = grid.lattice.kind.edges();
        let of = |from: usize, number: usize, o: &Offset| {
            let back: [f64; D] =
                crate::array::from_fn(|a| h * edges[a] * (-o.quarter[a] as f64 / 4.0));
            let r0_squared = h * h * (o.squared as f64 / 16.0);
            let r0 = r0_squared.sqrt();
            // the range is that of the body, whatever the materials
            let d = repulsion.as_ref().map_or(0.0, |c| c.distance(r0, [0, 0]));
            let cell: [i32; D] = crate::array::from_fn(|a| o.cell[a]);
            let k = law.constant(r0, 1.0 / r0, weight(&back.map(|x| -x), r0) * volume);
            assert!(
                grid.holds(cell),
                "the body was made for shorter bonds: give `on_lattice` the reach of this stencil"
            );
            let shift = grid.shift(cell.map(i64::from), o.to as i64 - from as i64);
            let bond = Bond {
                shift: i32::try_from(shift).expect("bonds span fewer than 2^31 slots"),
                number: number as u32,
                back,
                two_by_r0_squared: 2.0 / r0_squared,
                k,
                contact_e: d * d / r0_squared - 1.0,
                share: k * r0_squared,
            };
            let partner = Partner {
                cell,
                to: o.to,
                r0_squared,
                contact_distance: d,
            };
            (bond, partner)
        };
        let (all, partners): (Vec<Vec<Bond<D>>>, Vec<Vec<Partner<D>>>) = stencil
            .offsets
            .iter()
            .enumerate()
            .map(|(from, list)| list.iter().enumerate().map(|(k, o)| of(from, k, o)).unzip())
            .unzip();
        let contact_e = all.iter().flatten().map(|b| b.contact_e);
        let most_contact = contact_e.fold(-1.0, f64::max);
        let width = stencil.bonds();
        assert!(width <= MOST, "checked when the horizon was read");
        let family = LatticeFamily::new(body, grid, stencil, &|xi, length| {
            let of = weight(xi, length);
            [of, of, 1.0]
        });
        let parts = BondParts {
            body,
            near_horizon: 0,
            family,
            kind: "stencil",
            toughness,
            criteria: Criteria::default(),
            repulsion,
            held: vec![],
            simd,
        };
        let numbers = Store::zeros(parts.family.layout(0));
        let mut bonds = BondState::new(parts, LawProperties::fused(), numbers);
        // sweeps ask the body, and write what comes next tile by tile
        (bonds.material, bonds.next) = (vec![], Column::default());
        let tiles = bonds.family.groups();
        let next = match bonds.critical.is_empty() {
            true => vec![],
            false => vec![0.0; tiles * TILE],
        };
        let (reach, reaches) = reaches(&bonds);
        let mut made = StencilInteraction {
            bonds,
            law,
            stencil: all,
            partners,
            state: vec![0; tiles],
            reach,
            reaches,
            scale: Scale::default(),
            fields: crate::array::from_fn(|n| match n < W::FIELDS {
                true => Column::new(body.len, 0.0, field::line(4 + n)),
                false => Column::default(),
            }),
            pressure: Column::default(),
            point_constants,
            next,
            least_critical: f64::INFINITY,
            settled: false,
            most_contact,
            volume,
            out_of_line: Apart::default(),
        };
        made.out_of_line.blocks = made.by_partners(body, grid);
        made.look();
        made
    }
}

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    /// Blocks whose points have all their partners here, and the others.
    fn by_partners(&self, body: &Body<D>, grid: &Grid<D>) -> Option<[Vec<u32>; 2]> {
        if !body.exchange.is_shared() {
            return None;
        }
        // of how many slots before each one others have the points
        let mut before = vec![0u32; body.len + 1];
        { body.exchange.received() }.for_each(|slot| before[slot + 1] = 1);
        (0..body.len).for_each(|slot| before[slot + 1] += before[slot]);
        let family = &self.bonds.family;
        let abroad = |n: usize| {
            let tile = family.tiles()[n] as usize;
            let i = grid.tile_slot(tile);
            let bonds = &self.stencil[grid.tile_sublattice(tile)];
            let mut leads = bonds.iter().map(|b| b.to(i));
            leads.any(|to| before[to + TILE] > before[to])
        };
        let blocks = 0..family.blocks() as u32;
        let (others, own) = blocks.partition(|b| family.block(*b as usize).any(abroad));
        Some([own, others])
    }
}

/// Of each tile which row of bits it has, and the bits of the bonds that any of its points has, of all unlike tiles.
fn reaches<const D: usize>(bonds: &BondState<D, LatticeFamily<D>>) -> (Vec<u32>, Vec<u64>) {
    let family = &bonds.family;
    let (mut reach, mut reaches) = (vec![], vec![]);
    let mut known: HashMap<Vec<u64>, u32> = HashMap::new();
    for n in 0..family.groups() {
        let mut leads = vec![0u64; family.width.div_ceil(64)];
        for (k, bits) in family.bits(&bonds.alive, n).iter().enumerate() {
            leads[k / 64] |= u64::from(*bits != 0) << (k % 64);
        }
        let new = known.len() as u32;
        reach.push(*known.entry(leads).or_insert_with_key(|leads| {
            reaches.extend_from_slice(leads);
            new
        }));
    }
    (reach, reaches)
}
