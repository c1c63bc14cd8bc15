//! Linear bonds on a lattice: `f_i = Σ_j C_ij (u_j − u_i)` with the same D×D micromoduli at every point.
//!
//! Springs are `C = c ω ν V_j ξ⊗ξ/|ξ|³`, the bond-based solid linearised about the reference (seleson2009 (A.2)); they pull
//! along their reference direction and may go through each other.

use super::{BondState, BondTangent, Interaction, PointEnergies, Sweep, Tally};
use crate::body::{Body, Field, Layout};
use crate::execute::blocks::{Shared, for_each_block};
use crate::execute::lane::Lane;
use crate::execute::simd::{Kernel, Simd};
use crate::family::links::Links;

/// Tiles per block of work.
const BLOCK: usize = 64;

/// Micromoduli on a lattice.
pub struct LinearInteraction<const D: usize> {
    simd: Simd,
    links: Links<D>,
    /// Per sublattice and bond: `C` (force density / length).
    stiffness: Vec<Vec<[[f64; D]; D]>>,
    unit: Vec<()>,
    sums: Vec<f64>,
}

impl<const D: usize> LinearInteraction<D> {
    /// `modulus` gives `C` from ξ (force density / length).
    pub fn new(links: Links<D>, simd: Simd, modulus: impl Fn([f64; D]) -> [[f64; D]; D]) -> Self {
        let blocks = links.tiles.len().div_ceil(BLOCK);
        LinearInteraction {
            simd,
            stiffness: links
                .links
                .iter()
                .map(|list| list.iter().map(|l| modulus(l.xi)).collect())
                .collect(),
            links,
            unit: vec![(); blocks],
            sums: vec![0.0; blocks],
        }
    }

    fn energies(&self, body: &Body<D>, u: &Field<D>, out: Shared, sums: &mut [f64]) {
        let kernel = Energies {
            view: self.view(body, u),
            out,
        };
        for_each_block(self.simd, &kernel, sums);
    }

    fn view<'a>(&'a self, body: &'a Body<D>, u: &'a Field<D>) -> View<'a, D> {
        View {
            links: &self.links,
            stiffness: &self.stiffness,
            body,
            u,
        }
    }
}

struct View<'a, const D: usize> {
    links: &'a Links<D>,
    stiffness: &'a [Vec<[[f64; D]; D]>],
    body: &'a Body<D>,
    u: &'a Field<D>,
}

impl<const D: usize> View<'_, D> {
    fn block(&self, block: usize) -> std::ops::Range<usize> {
        block * BLOCK..((block + 1) * BLOCK).min(self.links.tiles.len())
    }

    /// First slot, sublattice and bits of the points of tile `n`.
    #[inline(always)]
    fn tile(&self, n: usize) -> (usize, usize, u8) {
        let Layout::Grid(grid) = &self.body.layout else {
            unreachable!("stencils live on grids")
        };
        let t = self.links.tiles[n] as usize;
        (grid.tile_slot(t), grid.tile_sublattice(t), grid.owned[t])
    }

    /// `Σ C η` and, if asked for, `Σ η·C η` of a tile.
    #[inline(always)]
    fn sum<L: Lane, const FULL: bool, const ENERGY: bool>(
        &self,
        first: usize,
        sub: usize,
        bits: &[u8],
        i: &[L; D],
    ) -> ([L; D], L) {
        let mut force = [L::splat(0.0); D];
        let mut energy = L::splat(0.0);
        let bonds = self.links.links[sub].iter().zip(&self.stiffness[sub]);
        for (k, (link, c)) in bonds.enumerate() {
            let mut eta = *i;
            for a in 0..D {
                // SAFETY: offsets stay inside the arrays
                let j = unsafe { L::load(self.u[a].as_ptr().add(first).offset(link.shift)) };
                eta[a] = j - i[a];
                if !FULL {
                    eta[a] = eta[a].zero_if(L::dead(bits[k]));
                }
            }
            for a in 0..D {
                let mut pull = L::splat(c[a][0]) * eta[0];
                for b in 1..D {
                    pull = L::splat(c[a][b]).fma(eta[b], pull);
                }
                force[a] = force[a] + pull;
                if ENERGY {
                    energy = pull.fma(eta[a], energy);
                }
            }
        }
        (force, energy)
    }

    #[inline(always)]
    fn both<L: Lane, const ENERGY: bool>(&self, n: usize) -> (usize, [L; D], L) {
        let (first, sub, owned) = self.tile(n);
        let mut i = [L::splat(0.0); D];
        for a in 0..D {
            // SAFETY: tiles lie inside the arrays
            i[a] = unsafe { L::load(self.u[a].as_ptr().add(first)) };
        }
        let (mut force, energy) = match self.links.bits(n, sub) {
            None => self.sum::<L, true, ENERGY>(first, sub, &[], &i),
            Some(bits) => self.sum::<L, false, ENERGY>(first, sub, bits, &i),
        };
        let dead = L::dead(owned);
        for f in &mut force {
            *f = f.zero_if(dead);
        }
        (first, force, energy.zero_if(dead))
    }
}

struct Forces<'a, const D: usize> {
    view: View<'a, D>,
    f: [Shared; D],
}

impl<const D: usize> Kernel for Forces<'_, D> {
    type Out = ();
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        for n in self.view.block(block) {
            let (first, force, _) = self.view.both::<L, false>(n);
            for a in 0..D {
                // SAFETY: tiles are disjoint
                unsafe { force[a].store(self.f[a].at(first)) };
            }
        }
    }
}

struct Energies<'a, const D: usize> {
    view: View<'a, D>,
    /// Energy density per slot, if asked for.
    out: Shared,
}

impl<const D: usize> Kernel for Energies<'_, D> {
    type Out = f64;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> f64 {
        let mut sum = 0.0;
        for n in self.view.block(block) {
            let (first, _, energy) = self.view.both::<L, true>(n);
            let energy = energy * L::splat(0.25);
            if !self.out.0.is_null() {
                // SAFETY: tiles are disjoint
                unsafe { energy.store(self.out.at(first)) };
            }
            sum += energy.to_array().iter().sum::<f64>();
        }
        sum
    }
}

impl<const D: usize> Interaction<D> for LinearInteraction<D> {
    fn family(&self) -> &'static str {
        "stencil"
    }

    fn forces(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        f: &mut Field<D>,
        _: Sweep<D>,
        seen: Option<&mut PointEnergies>,
    ) -> Tally {
        if let Some(seen) = seen {
            self.observe(body, u, seen);
        }
        let mut unit = std::mem::take(&mut self.unit);
        let kernel = Forces {
            view: self.view(body, u),
            f: std::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
        };
        for_each_block(self.simd, &kernel, &mut unit);
        self.unit = unit;
        Tally::default()
    }

    fn energy(&mut self, body: &Body<D>, u: &Field<D>) -> [f64; 2] {
        let mut sums = std::mem::take(&mut self.sums);
        self.energies(body, u, Shared::NULL, &mut sums);
        let total: f64 = sums.iter().sum();
        self.sums = sums;
        [total * body.volume.uniform().unwrap_or(0.0), 0.0]
    }

    fn observe(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies) {
        out.zeros(body.len);
        let strain = Shared(out.strain.as_mut_ptr());
        self.energies(body, u, strain, &mut vec![0.0; self.sums.len()]);
    }

    fn tangents(
        &mut self,
        body: &Body<D>,
        _: &Field<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        self.links.each_directed(body, &mut |i, j, k, sub| {
            visit(BondTangent::direct(i, j.original, self.stiffness[sub][k]))
        });
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D], BondState)) {
        self.links
            .each(body, &mut |i, j, xi| visit(i, j, xi, BondState::Whole));
    }

    /// Of the linear forces, along the reference distances.
    fn virial(&mut self, body: &Body<D>, u: &Field<D>) -> Option<[f64; 6]> {
        let volume = body.volume.uniform().unwrap_or(0.0);
        let Layout::Grid(grid) = &body.layout else {
            return None;
        };
        let mut sum = [0.0; 6];
        for &s in &body.slots {
            let i = s as usize;
            let (_, sub) = grid.cell(i);
            for (link, c) in self.links.links[sub].iter().zip(&self.stiffness[sub]) {
                let Some(j) = link.partner(grid, i) else {
                    continue;
                };
                let pull: [f64; D] =
                    std::array::from_fn(|a| (0..D).map(|b| c[a][b] * (u[b][j] - u[b][i])).sum());
                super::add_virial(&mut sum, &pull, &link.xi, -0.5 * volume);
            }
        }
        Some(sum)
    }

    fn directed_bonds(&self) -> u64 {
        self.links.directed()
    }

    fn family_size(&self, body: &Body<D>, slot: usize) -> usize {
        self.links.family_size(body, slot)
    }

    fn bytes(&self) -> usize {
        self.links.bytes()
            + self
                .stiffness
                .iter()
                .map(|s| 8 * D * D * s.len())
                .sum::<usize>()
    }
}
