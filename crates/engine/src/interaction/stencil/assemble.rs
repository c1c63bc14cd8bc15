//! A stencil interaction from a body, a stencil and a law.

use super::StencilInteraction;
use super::kernel::{BLOCK, Bond, MOST, Partner};
use crate::body::{Body, Column, Grid, Layout, field};
use crate::execute::blocks::PerBlock;
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::family::offsets::OffsetSet;
use crate::family::stencil::{Offset, Stencil};
use crate::interaction::scale::Scale;
use crate::interaction::{PointConstants, Repulsion, Tally, Toughness, history, laws_fields};
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
                std::array::from_fn(|a| h * edges[a] * (-o.quarter[a] as f64 / 4.0));
            let r0_squared = h * h * (o.squared as f64 / 16.0);
            let r0 = r0_squared.sqrt();
            // the range is that of the body, whatever the materials
            let d = repulsion.as_ref().map_or(0.0, |c| c.distance(r0, [0, 0]));
            let cell: [i32; D] = std::array::from_fn(|a| o.cell[a]);
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
        let (bonds, partners): (Vec<Vec<Bond<D>>>, Vec<Vec<Partner<D>>>) = stencil
            .offsets
            .iter()
            .enumerate()
            .map(|(from, list)| list.iter().enumerate().map(|(k, o)| of(from, k, o)).unzip())
            .unzip();
        let contact_e = bonds.iter().flatten().map(|b| b.contact_e);
        let most_contact = contact_e.fold(-1.0, f64::max);
        let width = stencil.bonds();
        assert!(width <= MOST, "checked when the horizon was read");
        let tiles: Vec<u32> = (0..grid.tiles())
            .filter(|t| grid.owned[*t] != 0)
            .map(|t| t as u32)
            .collect();
        let families = Families::of(grid, &tiles, &partners, width);
        let remembers = history::remembers(repulsion.as_ref(), &toughness);
        let critical = if remembers {
            Column::new(body.len, f64::INFINITY, field::line(3))
        } else {
            Column::default()
        };
        let next = vec![0.0; if remembers { tiles.len() * TILE } else { 0 }];
        let blocks = tiles.len().div_ceil(BLOCK);
        let mut made = StencilInteraction {
            body: body.identity,
            law,
            simd,
            offsets: OffsetSet::new(grid, &partners, |b| (b.cell, b.to)),
            bonds,
            partners,
            width,
            alive: families.alive,
            state: vec![0; tiles.len()],
            tiles,
            reach: families.reach,
            reaches: families.reaches,
            scale: Scale::default(),
            family: families.family,
            directed: families.directed,
            fields: std::array::from_fn(|n| match n < W::FIELDS {
                true => Column::new(body.len, 0.0, field::line(4 + n)),
                false => Column::default(),
            }),
            pressure: Column::default(),
            point_constants,
            toughness,
            repulsion,
            next,
            critical,
            least_critical: f64::INFINITY,
            settled: false,
            most_contact,
            volume,
            guard: grid.guard,
            tallies: PerBlock::new(blocks, Tally::default()),
            sums: PerBlock::sums(blocks),
        };
        made.look(grid);
        made
    }
}

/// Which bonds of the stencil the points of tiles have.
struct Families {
    /// `[tile, bond]`, a bit for each lane.
    alive: Vec<u8>,
    /// Of each tile, its bonds' number among `reaches`.
    reach: Vec<u32>,
    /// Bits of the bonds that any lane has, of all unlike tiles.
    reaches: Vec<u64>,
    /// Bonds of each lane.
    family: Vec<u16>,
    directed: u64,
}

impl Families {
    fn of<const D: usize>(
        grid: &Grid<D>,
        tiles: &[u32],
        partners: &[Vec<Partner<D>>],
        width: usize,
    ) -> Families {
        let words = width.div_ceil(64);
        let mut all = Families {
            alive: vec![0; tiles.len() * width],
            reach: vec![0; tiles.len()],
            reaches: vec![],
            family: vec![0; tiles.len() * TILE],
            directed: 0,
        };
        let mut known: HashMap<Vec<u64>, u32> = HashMap::new();
        for (n, &t) in tiles.iter().enumerate() {
            let first = grid.tile_slot(t as usize);
            let sub = grid.tile_sublattice(t as usize);
            let mut leads = vec![0u64; words];
            for l in 0..TILE {
                if !grid.is_owned(first + l) {
                    continue;
                }
                for (k, b) in partners[sub].iter().enumerate() {
                    if grid.neighbour(first + l, b.cell, b.to).is_some() {
                        all.alive[n * width + k] |= 1 << l;
                        leads[k / 64] |= 1 << (k % 64);
                        all.family[n * TILE + l] += 1;
                        all.directed += 1;
                    }
                }
            }
            let new = known.len() as u32;
            all.reach[n] = *known.entry(leads).or_insert_with_key(|leads| {
                all.reaches.extend_from_slice(leads);
                new
            });
        }
        all
    }
}
