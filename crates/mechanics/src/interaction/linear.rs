//! Linear bonds on a lattice: `f_i = Σ_j C_ij (u_j − u_i)` with the same D×D micromoduli at every point.
//!
//! Springs are `C = c ω ν V_j ξ⊗ξ/|ξ|³`, the bond-based solid linearised about the reference (seleson2009 (A.2)); they pull
//! along their reference direction and may go through each other. One that temperature or swelling makes longer by ε, the mean of both ends, answers to
//! what is beyond that, `f_i = Σ_j C_ij (u_j − u_i − ε ξ)`.

use super::scale::{Scale, TileFactors};
use super::{
    BondStatus, BondTangent, EachBond, EachForce, EachTangent, FactorsOf, Interaction,
    PointEnergiesMut, Sweep, Tally,
};
use crate::body::{
    Body, Column, Field, FieldView, FieldViewMut, Grid, Identity, Subdomain, Values, zeros,
};
use crate::error::BuildError;
use crate::execute::blocks::{PerBlock, Shared, run_blocks};
use crate::execute::exact::Exact;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::{Kernel, Simd};
use crate::family::links::{Links, Tile, Tiles};
use crate::law::BondFactors;
use crate::state::Archive;

/// Micromoduli on a lattice.
pub struct LinearInteraction<const D: usize> {
    body: Identity,
    simd: Simd,
    links: Links<D>,
    /// Per sublattice and bond: `C` (force density / length).
    stiffness: Vec<Vec<[[f64; D]; D]>>,
    /// Factors of bonds.
    scale: Scale,
    /// What bonds grow by per strain of temperature or swelling: 1 + ν of a slice that is held, where all of them have ν = ¼.
    grows: f64,
    /// Strain by temperature or swelling per slot, and `Σ C εξ` (force density); empty: none.
    expansion: Vec<f64>,
    pull: Field<D>,
    sums: PerBlock<[f64; 1]>,
}

impl<const D: usize> LinearInteraction<D> {
    /// `modulus` gives `C` from ξ (force density / length); `held`: is the body in plane strain?
    pub fn new(
        body: &Body<D>,
        links: Links<D>,
        simd: Simd,
        held: bool,
        modulus: impl Fn([f64; D]) -> [[f64; D]; D],
    ) -> Self {
        LinearInteraction {
            body: links.body,
            simd,
            stiffness: links
                .links
                .iter()
                .map(|list| list.iter().map(|l| modulus(l.xi)).collect())
                .collect(),
            sums: PerBlock::sums(links.blocks()).among(body.subdomain().map(Subdomain::comm)),
            scale: Scale::default(),
            grows: if held { 1.25 } else { 1.0 },
            expansion: vec![],
            pull: crate::array::from_fn(|_| Column::default()),
            links,
        }
    }

    /// Visits every directed bond that grows: its point, the other end, εξ and `C εξ`.
    fn each_growth(&self, body: &Body<D>, mut visit: impl FnMut(usize, usize, [f64; D], [f64; D])) {
        if self.expansion.is_empty() {
            return;
        }
        let grid = body.grid();
        self.links.each_directed(grid, |i, j, sub, k| {
            let strain = 0.5 * (self.expansion[i] + self.expansion[j]);
            let grown = self.links.links[sub][k].xi.map(|x| strain * x);
            let factor = self.factor(grid, i, k);
            let pull = self.stiffness[sub][k]
                .map(|row| factor * row.iter().zip(&grown).map(|(c, x)| c * x).sum::<f64>());
            visit(i, j, grown, pull);
        });
    }

    /// Finds what growth pulls.
    fn look(&mut self, body: &Body<D>) {
        if self.expansion.is_empty() {
            return;
        }
        let mut pull = zeros(body.len);
        self.each_growth(body, |i, _, _, of| {
            for a in 0..D {
                pull[a][i] += of[a];
            }
        });
        self.pull = pull;
    }

    /// `¼ (εξ·C εξ − 2 η·C εξ)` of every bond that grows: what the energy density of its point is more than without.
    fn each_growth_energy(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        mut visit: impl FnMut(usize, f64),
    ) {
        self.each_growth(body, |i, j, grown, pull| {
            let beyond = |a: usize| grown[a] - 2.0 * (u[a][j] - u[a][i]);
            let energy: f64 = (0..D).map(|a| beyond(a) * pull[a]).sum();
            visit(i, 0.25 * energy);
        });
    }

    /// Factor of bond `k` of a slot's point.
    fn factor(&self, grid: &Grid<D>, slot: usize, k: usize) -> f64 {
        let at = slot - grid.guard;
        match self.links.tiles.binary_search(&((at / TILE) as u32)) {
            Ok(n) => self.scale.of(n, k, at % TILE).pair,
            Err(_) => 1.0,
        }
    }

    /// Energy, and energy densities per slot where asked for.
    fn energies(&self, body: &Body<D>, u: FieldView<D>, out: Shared) -> f64 {
        let kernel = Energies {
            view: self.view(body, u),
            volume: &body.volume,
            out,
        };
        let [sum] = self.sums.sum(self.simd, &kernel);
        sum
    }

    fn view<'a>(&'a self, body: &'a Body<D>, u: FieldView<'a, D>) -> View<'a, D> {
        View {
            tiles: Tiles::new(&self.links, body, u),
            stiffness: &self.stiffness,
            scale: &self.scale,
        }
    }
}

struct View<'a, const D: usize> {
    tiles: Tiles<'a, D>,
    stiffness: &'a [Vec<[[f64; D]; D]>],
    scale: &'a Scale,
}

impl<const D: usize> View<'_, D> {
    /// `Σ C η` and, if asked for, `Σ η·C η` of a tile.
    #[inline(always)]
    fn sum<L: Lane, const FULL: bool, const ENERGY: bool, const SCALED: bool>(
        &self,
        tile: &Tile<D>,
        bits: &[u8],
        scale: TileFactors,
    ) -> ([L; D], L) {
        let i = self.tiles.own::<L>(tile);
        let mut force = [L::splat(0.0); D];
        let mut energy = L::splat(0.0);
        let bonds = tile.links.iter().zip(&self.stiffness[tile.sublattice]);
        for (k, (link, c)) in bonds.enumerate() {
            let j = self.tiles.partners::<L>(tile, link);
            let mut eta = i;
            for a in 0..D {
                eta[a] = j[a] - i[a];
                if !FULL {
                    eta[a] = eta[a].zero_if(L::dead(bits[k]));
                }
            }
            // SAFETY: eight numbers per bond
            let factor: L = match SCALED {
                true => unsafe { scale.pair(k) },
                false => L::splat(1.0),
            };
            for a in 0..D {
                let mut pull = L::splat(c[a][0]) * eta[0];
                for b in 1..D {
                    pull = L::splat(c[a][b]).fma(eta[b], pull);
                }
                if SCALED {
                    pull = pull * factor;
                }
                force[a] = force[a] + pull;
                if ENERGY {
                    energy = pull.fma(eta[a], energy);
                }
            }
        }
        (force, energy)
    }

    /// The same, 0 where there is no point.
    #[inline(always)]
    fn both<L: Lane, const ENERGY: bool>(&self, tile: &Tile<D>) -> ([L; D], L) {
        let scaled = self.scale.is_scaled(tile.number);
        let scale = match scaled {
            true => self.scale.tile(tile.number),
            false => TileFactors::NONE,
        };
        let (mut force, energy) = match (tile.bits, scaled) {
            (None, false) => self.sum::<L, true, ENERGY, false>(tile, &[], scale),
            (Some(bits), false) => self.sum::<L, false, ENERGY, false>(tile, bits, scale),
            (None, true) => self.sum::<L, true, ENERGY, true>(tile, &[], scale),
            (Some(bits), true) => self.sum::<L, false, ENERGY, true>(tile, bits, scale),
        };
        let dead = L::dead(tile.owned);
        for f in &mut force {
            *f = f.zero_if(dead);
        }
        (force, energy.zero_if(dead))
    }
}

struct Forces<'a, const D: usize> {
    view: View<'a, D>,
    f: [Shared; D],
}

impl<const D: usize> Kernel for Forces<'_, D> {
    type Out = ();
    type Home = Self;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        for tile in self.view.tiles.block(block) {
            let (force, _) = self.view.both::<L, false>(&tile);
            for a in 0..D {
                // SAFETY: tiles are disjoint
                unsafe { force[a].store(self.f[a].at(tile.first)) };
            }
        }
    }
}

struct Energies<'a, const D: usize> {
    view: View<'a, D>,
    volume: &'a Values,
    /// Energy density per slot, if asked for.
    out: Shared,
}

impl<const D: usize> Kernel for Energies<'_, D> {
    type Out = [f64; 1];
    type Home = Self;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 1] {
        let mut sum = 0.0;
        for tile in self.view.tiles.block(block) {
            let (_, energy) = self.view.both::<L, true>(&tile);
            let energy = energy * L::splat(0.25);
            if !self.out.0.is_null() {
                // SAFETY: tiles are disjoint
                unsafe { energy.store(self.out.at(tile.first)) };
            }
            let energies = energy.to_array().into_iter().enumerate();
            let volume = |l: usize| self.volume.at(tile.first + l);
            sum += energies.map(|(l, e)| e * volume(l)).sum::<f64>();
        }
        [sum]
    }
}

impl<const D: usize> Interaction<D> for LinearInteraction<D> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        "stencil"
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        _: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        if let Some(seen) = seen {
            self.observe(body, u, seen);
        }
        let kernel = Forces {
            view: self.view(body, u),
            f: crate::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
        };
        run_blocks(self.simd, &kernel, self.links.blocks());
        if !self.expansion.is_empty() {
            for (f, pull) in f.into_iter().zip(&self.pull) {
                for s in body.slots.iter().map(|s| *s as usize) {
                    f[s] -= pull[s];
                }
            }
        }
        Tally::default()
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        let mut growth = Exact::ZERO;
        self.each_growth_energy(body, u, |i, energy| {
            growth.add(body.volume.at(i) * energy);
        });
        let [growth] = body.sums([growth]);
        [self.energies(body, u, Shared::NULL) + growth, 0.0]
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        out.zeros(body.len);
        self.energies(body, u, Shared(out.strain.as_mut_ptr()));
        self.each_growth_energy(body, u, |i, energy| out.strain[i] += energy);
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        _: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        let grid = body.grid();
        self.links.each_directed(grid, |i, j, sub, k| {
            let factor = self.factor(grid, i, k);
            let stiffness = self.stiffness[sub][k].map(|row| row.map(|c| factor * c));
            visit(BondTangent::direct(
                i,
                body.exchange.original(j),
                self.links.links[sub][k].xi,
                stiffness,
            ))
        });
    }

    /// Of the linear forces, along the reference distances.
    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        let strain = std::mem::take(&mut self.expansion);
        self.tangents(body, u, &mut |bond| {
            let mut force = bond.linear_force(u);
            if !strain.is_empty() {
                let grown = 0.5 * (strain[bond.i] + strain[bond.j]);
                let pull = bond.stiffness.map(|row| -> f64 {
                    row.iter().zip(&bond.y).map(|(c, x)| c * (grown * x)).sum()
                });
                force.force = crate::array::from_fn(|a| force.force[a] - pull[a]);
                force.own = Some(force.force.map(|f| 0.5 * f));
            }
            visit(force);
        });
        self.expansion = strain;
        true
    }

    fn expand(&mut self, body: &Body<D>, strain: &[f64]) -> bool {
        self.check(body, &[]);
        assert_eq!(strain.len(), body.len, "a strain for each slot");
        self.expansion = strain.iter().map(|x| self.grows * x).collect();
        self.look(body);
        true
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        self.links
            .each(body, &mut |i, j, xi| visit(i, j, xi, BondStatus::Whole));
    }

    fn each_partner(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        self.links.each_directed(body.grid(), |i, j, sub, k| {
            let j = body.exchange.original(j);
            visit(i, j, self.links.links[sub][k].xi, BondStatus::Whole);
        });
    }

    fn scale_bonds(&mut self, body: &Body<D>, factors: &FactorsOf<D>) -> Result<(), BuildError> {
        let grid = body.grid();
        let links = &self.links;
        let old = std::mem::take(&mut self.scale);
        let width = links.links.iter().map(Vec::len).max().unwrap_or(0);
        self.scale = Scale::new(links.tiles.len(), width, false, |n, k, l| {
            let tile = links.tile(grid, n);
            let here = tile.bits.is_none_or(|bits| bits[k] >> l & 1 == 1);
            let link = tile.links.get(k).filter(|_| here);
            let ends = link.and_then(|b| Some((b.cell, b.partner(grid, tile.first + l)?)));
            ends.map_or(BondFactors::ONE, |(cell, j)| {
                old.of(n, k, l).times(factors(tile.first + l, j, cell))
            })
        });
        self.look(body);
        Ok(())
    }

    fn directed_bonds(&self) -> u64 {
        self.links.directed()
    }

    fn family_size(&self, body: &Body<D>, slot: usize) -> usize {
        self.links.family_size(body, slot)
    }

    /// Nothing is remembered but how long bonds are.
    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        body.archive_points(archive, "expansion", (&mut self.expansion, 1), |slot, _| {
            slot
        });
        if archive.loads() && !self.expansion.is_empty() {
            body.exchange.fill(&mut self.expansion);
        }
        if archive.loads() {
            self.look(body);
        }
    }

    fn bytes(&self) -> usize {
        self.links.bytes()
            + self.scale.bytes()
            + 8 * (D + 1) * self.expansion.len()
            + self
                .stiffness
                .iter()
                .map(|s| 8 * D * D * s.len())
                .sum::<usize>()
    }
}
