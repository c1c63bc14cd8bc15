//! The bond that leads back: a place for each listed bond, and what many-body potentials say of its end.

use crate::execute::blocks::{Shared, run_blocks};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::{Kernel, Simd};
use crate::family::neighbours::near::NearList;

/// No place.
pub(super) const NONE: u32 = u32::MAX;
/// A bond that is beyond the cut-off now.
pub(super) const FAR: u16 = u16::MAX;

/// Of the bonds of a list: bond l of line n of a tile has place `8 (first line of the tile + n) + l`. Place 0 is nobody's.
pub(super) struct Back {
    /// First line of each tile.
    first: Vec<u32>,
    /// Place of the bond that leads back, or [`NONE`].
    back: Vec<u32>,
    /// By how many lines the force on the end of a bond comes before its place, or [`FAR`].
    before: Vec<u16>,
    /// Forces on ends: those of a tile's current bonds, one after the other from its first line on.
    force: Vec<[f64; 4]>,
}

impl Back {
    pub fn of(list: &NearList<3>, simd: Simd) -> Back {
        let mut first = vec![];
        // the first line is nobody's
        let mut lines = 1;
        for (_, own) in (0..list.blocks()).flat_map(|b| list.tiles(b)) {
            first.push(lines as u32);
            lines += own.len();
        }
        let mut made = Back {
            first,
            back: vec![NONE; lines * TILE],
            before: vec![FAR; lines * TILE],
            force: vec![[0.0; 4]; lines * TILE],
        };
        let kernel = Find {
            list,
            first: &made.first,
            back: Shared(made.back.as_mut_ptr()),
        };
        run_blocks(simd, &kernel, list.blocks());
        made
    }

    /// Place of the first line of a tile.
    #[inline(always)]
    pub fn place(&self, tile: usize) -> usize {
        self.first[tile] as usize * TILE
    }

    /// Places of the bonds that lead back, from a place on.
    #[inline(always)]
    pub fn back(&self, place: usize) -> &[u32] {
        &self.back[place..place + TILE]
    }

    /// By how many lines forces come before.
    #[inline(always)]
    pub fn before(&self) -> &[u16] {
        &self.before
    }

    /// To write what tiles say: both are written tile by tile, while nobody reads them.
    pub fn ends(&mut self) -> Ends {
        Ends {
            before: Shared(self.before.as_mut_ptr()),
            force: Shared(self.force.as_mut_ptr()),
        }
    }

    #[inline(always)]
    pub fn forces(&self) -> &[[f64; 4]] {
        &self.force
    }

    /// `T_i − T_j` (force) of the bond at a place: what its partner's fan says of its atom, less what its atom's fan says of its end.
    pub fn pull(&self, place: usize) -> [f64; 3] {
        let of = |place: u32| match self.before[place as usize] {
            FAR => [0.0; 4],
            lines => self.force[place as usize - TILE * usize::from(lines)],
        };
        let own = of(place as u32);
        let other = match self.back[place] {
            NONE => [0.0; 4],
            back => of(back),
        };
        crate::array::from_fn(|a| other[a] - own[a])
    }

    pub fn bytes(&self) -> usize {
        4 * self.first.capacity()
            + 4 * self.back.capacity()
            + 2 * self.before.capacity()
            + 32 * self.force.capacity()
    }
}

/// Where tiles write what they say of the ends of their bonds.
#[derive(Clone, Copy)]
pub(super) struct Ends {
    pub before: Shared<u16>,
    pub force: Shared<[f64; 4]>,
}

struct Find<'a> {
    list: &'a NearList<3>,
    first: &'a [u32],
    back: Shared<u32>,
}

impl Kernel for Find<'_> {
    type Out = ();
    type Home = Self;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let at = self.list.positions();
        for (t, lines) in self.list.tiles(block) {
            for (n, line) in lines.iter().enumerate() {
                for l in 0..self.list.lanes(t) {
                    let i = t * TILE + l;
                    let home = self.list.home(line[l] as usize);
                    let Some(j) = home.filter(|j| self.list.has_list(*j)) else {
                        continue;
                    };
                    let y: [f64; 3] = crate::array::from_fn(|a| at[line[l] as usize][a] - at[i][a]);
                    let other = self.list.lines(j / TILE);
                    // an atom that is no image is listed as itself
                    let found = match j == line[l] as usize {
                        true => other.iter().position(|o| o[j % TILE] as usize == i),
                        false => self.opposite(other, j, i, &y),
                    };
                    if let Some(m) = found {
                        let place = (self.first[j / TILE] as usize + m) * TILE + j % TILE;
                        let own = (self.first[t] as usize + n) * TILE + l;
                        // SAFETY: every tile has its own places
                        unsafe { *self.back.at(own) = place as u32 };
                    }
                }
            }
        }
    }
}

impl Find<'_> {
    /// The line in which `j` has an image of `i` at −y.
    fn opposite(&self, lines: &[[u32; TILE]], j: usize, i: usize, y: &[f64; 3]) -> Option<usize> {
        let at = self.list.positions();
        let off = |o: &[u32; TILE]| -> f64 {
            let image = at[o[j % TILE] as usize];
            (0..3).map(|a| (image[a] - at[j][a] + y[a]).powi(2)).sum()
        };
        let all = lines.iter().enumerate();
        let images = all.filter(|(_, o)| self.list.home(o[j % TILE] as usize) == Some(i));
        let nearest = images.min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
        nearest.map(|(m, _)| m)
    }
}
