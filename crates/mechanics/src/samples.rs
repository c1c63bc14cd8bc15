//! Bodies for tests.

use crate::body::Body;
use crate::execute::simd::Simd;
use crate::family::stencil::Stencil;
use crate::interaction::stencil::{StencilInteraction, StencilParts};
use crate::interaction::{Interaction, PointConstants, Toughness};
use crate::law::solid::bond_based::BondBased;
use crate::space::lattice::{Lattice, LatticeKind};
use crate::spec::Horizon;

/// First basis sites of all cells in a box that pass a test, as quarters.
pub fn sites(cells: [i32; 3], keep: impl Fn([i32; 3]) -> bool) -> Vec<[i32; 3]> {
    let mut quarters = vec![];
    for z in 0..cells[2] {
        for y in 0..cells[1] {
            for x in 0..cells[0] {
                if keep([x, y, z]) {
                    quarters.push([4 * x, 4 * y, 4 * z]);
                }
            }
        }
    }
    quarters
}

/// A bond-based body on these sites, that never breaks.
pub fn lattice<const D: usize>(
    kind: LatticeKind,
    quarters: &[[i32; 3]],
    spacing: f64,
    ratio: u32,
    periodic: [bool; D],
) -> (Body<D>, Box<dyn Interaction<D>>) {
    let stencil = Stencil::new(kind, spacing, Horizon::Ratio(ratio));
    let lattice = Lattice {
        kind,
        spacing,
        origin: [0.0; 3],
    };
    let volume = kind.site_volume() * spacing.powi(D as i32);
    let body = Body::<D>::on_lattice(lattice, quarters, stencil.reach, periodic, volume).unwrap();
    let interaction = StencilInteraction::new(StencilParts {
        body: &body,
        stencil: &stencil,
        law: BondBased { c: 1.0 },
        weight: &|_, _| 1.0,
        point_constants: PointConstants::None,
        toughness: vec![Toughness {
            s00: f64::INFINITY,
            alpha: 0.0,
        }],
        repulsion: None,
        simd: Simd::detect(),
    });
    let interaction = Box::new(interaction);
    (body, interaction)
}

/// Numbers in −1..1, the same every time.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
