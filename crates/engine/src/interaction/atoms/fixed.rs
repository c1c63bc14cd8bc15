//! A potential on a lattice whose neighbours stay neighbours: chains of seleson2009 (5.1), upscaled models of
//! seleson2014 (3.4). Distances are the current ones.

use super::{Faults, bad_density, embed, find_fault};
use crate::body::{Body, Column, FAR, Field, Identity, Layout, field};
use crate::execute::blocks::{PerBlock, Shared};
use crate::execute::lane::Lane;
use crate::execute::simd::{Kernel, Simd};
use crate::family::links::{Link, Links, Tile, Tiles};
use crate::interaction::tangent::curvature;
use crate::interaction::{
    BondForce, BondState, BondTangent, Fault, Interaction, PointEnergies, Sweep, Tally,
};
use crate::law::number::Dual;
use crate::law::potential::Potential;

/// A potential on a stencil.
pub struct FixedAtoms<const D: usize, P> {
    body: Identity,
    simd: Simd,
    potential: P,
    links: Links<D>,
    /// Distances beyond this do not count (length).
    limit: f64,
    /// F′ per slot; empty without embedding.
    slope: Column,
    /// F″ per slot, of the last tangent.
    curvature: Vec<f64>,
    volume: f64,
    /// The link of a chain to its next neighbour.
    next: Option<usize>,
    faults: Faults,
    sums: PerBlock<[f64; 1]>,
}

impl<const D: usize, P: Potential> FixedAtoms<D, P> {
    pub fn new(body: &Body<D>, links: Links<D>, potential: P, simd: Simd) -> Self {
        FixedAtoms {
            body: body.identity,
            simd,
            // displacements of absent sites are farther than this
            limit: potential.cutoff().min(0.5 * FAR * body.spacing),
            slope: if P::EMBEDDED {
                Column::new(body.len, 0.0, field::line(3))
            } else {
                Column::default()
            },
            curvature: vec![],
            volume: body.volume.uniform().unwrap_or(1.0),
            potential,
            next: next_of_chain(&links),
            faults: PerBlock::new(links.blocks(), None),
            sums: PerBlock::sums(links.blocks()),
            links,
        }
    }

    fn view<'a>(&'a self, body: &'a Body<D>, u: &'a Field<D>) -> View<'a, D, P> {
        View {
            tiles: Tiles::new(&self.links, body, u),
            potential: &self.potential,
            limit: self.limit * self.limit,
        }
    }

    /// Energy, and energy densities per slot where asked for.
    fn energies(&self, body: &Body<D>, u: &Field<D>, out: Shared) -> f64 {
        let kernel = Energies {
            view: self.view(body, u),
            out,
            inverse: 1.0 / self.volume,
        };
        let [sum] = self.sums.sum(self.simd, &kernel);
        sum
    }

    /// F′ everywhere, images included, or why not.
    fn embed(&mut self, body: &Body<D>, u: &Field<D>) -> Tally {
        let slope = Shared(self.slope.as_mut_ptr());
        let kernel = Density {
            view: self.view(body, u),
            slope,
        };
        let tally = find_fault(&self.faults, self.simd, &kernel);
        body.fill_images(&mut self.slope);
        tally
    }
}

/// The shortest link forward, in one dimension.
fn next_of_chain<const D: usize>(links: &Links<D>) -> Option<usize> {
    let links = links.links.first().filter(|_| D == 1)?;
    let forward = links.iter().enumerate().filter(|(_, l)| l.xi[0] > 0.0);
    let next = forward.min_by(|a, b| a.1.xi[0].total_cmp(&b.1.xi[0]))?;
    Some(next.0)
}

struct View<'a, const D: usize, P> {
    tiles: Tiles<'a, D>,
    potential: &'a P,
    /// Squared length.
    limit: f64,
}

impl<const D: usize, P: Potential> View<'_, D, P> {
    /// Current vector to the partners along a bond, and its square; `i` are the tile's own displacements.
    #[inline(always)]
    fn vector<L: Lane>(&self, tile: &Tile<D>, link: &Link<D>, i: &[L; D]) -> ([L; D], L) {
        let j = self.tiles.partners::<L>(tile, link);
        let mut y = *i;
        let mut q = L::splat(0.0);
        for a in 0..D {
            y[a] = L::splat(link.xi[a]) + (j[a] - i[a]);
            q = y[a].fma(y[a], q);
        }
        (y, q)
    }

    /// Lanes whose partners at bond `k` are beyond the cut-off or not there.
    #[inline(always)]
    fn out<L: Lane>(&self, q: L, tile: &Tile<D>, k: usize) -> L::Mask {
        let far = q.ge(L::splat(self.limit));
        match tile.bits {
            None => far,
            Some(bits) => L::or(far, L::dead(bits[k])),
        }
    }

    /// Σ f of a tile.
    #[inline(always)]
    fn density<L: Lane>(&self, tile: &Tile<D>, i: &[L; D]) -> L {
        let mut density = L::splat(0.0);
        for (k, link) in tile.links.iter().enumerate() {
            let (_, q) = self.vector(tile, link, i);
            let f = self.potential.density(Dual::variable(q)).value;
            density = density + f.zero_if(self.out(q, tile, k));
        }
        density
    }

    /// The first of a tile's points that went through its partner at bond `k` of a chain.
    #[inline(always)]
    fn crossed<L: Lane>(&self, tile: &Tile<D>, k: usize, i: &[L; D]) -> Option<Fault> {
        let (y, _) = self.vector(tile, &tile.links[k], i);
        let there = tile.bits.map_or(tile.owned, |bits| bits[k]);
        let crossed = L::bits(L::splat(0.0).ge(y[0])) as u8 & there;
        if crossed == 0 {
            return None;
        }
        let i = tile.first + crossed.trailing_zeros() as usize;
        let j = i.wrapping_add_signed(tile.links[k].shift);
        Some(Fault::Crossing { i, j })
    }
}

struct Density<'a, const D: usize, P> {
    view: View<'a, D, P>,
    slope: Shared,
}

impl<const D: usize, P: Potential> Kernel for Density<'_, D, P> {
    type Out = Option<Fault>;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Option<Fault> {
        let view = &self.view;
        let mut fault = None;
        for tile in view.tiles.block(block) {
            let density = view.density::<L>(&tile, &view.tiles.own(&tile));
            let [_, slope] = embed(view.potential, density);
            // SAFETY: tiles are disjoint
            unsafe {
                slope
                    .zero_if(L::dead(tile.owned))
                    .store(self.slope.at(tile.first))
            };
            if fault.is_none()
                && let Some((l, density)) =
                    bad_density(view.potential, density.to_array(), tile.owned)
            {
                fault = Some(Fault::Density {
                    slot: tile.first + l,
                    density,
                });
            }
        }
        fault
    }
}

struct Forces<'a, const D: usize, P> {
    view: View<'a, D, P>,
    slope: &'a Column,
    f: [Shared; D],
    /// 2 / volume
    scale: f64,
    /// The bond of a chain that must not turn over.
    next: Option<usize>,
}

impl<const D: usize, P: Potential> Kernel for Forces<'_, D, P> {
    type Out = Option<Fault>;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Option<Fault> {
        let view = &self.view;
        let mut fault = None;
        for tile in view.tiles.block(block) {
            let i = view.tiles.own::<L>(&tile);
            let mut own = L::splat(0.0);
            if P::EMBEDDED {
                // SAFETY: as the displacements
                own = unsafe { L::load(self.slope.as_ptr().add(tile.first)) };
            }
            let mut force = [L::splat(0.0); D];
            for (k, link) in tile.links.iter().enumerate() {
                let (y, q) = view.vector(&tile, link, &i);
                let mut pull = view.potential.pair(Dual::variable(q)).slope;
                if P::EMBEDDED {
                    // SAFETY: as the displacements
                    let other =
                        unsafe { L::load(self.slope.as_ptr().add(tile.first).offset(link.shift)) };
                    let f = view.potential.density(Dual::variable(q)).slope;
                    pull = f.fma(own + other, pull);
                }
                let pull = pull.zero_if(view.out(q, &tile, k));
                for a in 0..D {
                    force[a] = pull.fma(y[a], force[a]);
                }
            }
            let dead = L::dead(tile.owned);
            for a in 0..D {
                let f = force[a] * L::splat(self.scale);
                // SAFETY: tiles are disjoint
                unsafe { f.zero_if(dead).store(self.f[a].at(tile.first)) };
            }
            if D == 1
                && fault.is_none()
                && let Some(k) = self.next
            {
                fault = view.crossed(&tile, k, &i);
            }
        }
        fault
    }
}

struct Energies<'a, const D: usize, P> {
    view: View<'a, D, P>,
    /// Energy density per slot, if asked for.
    out: Shared,
    /// 1 / volume
    inverse: f64,
}

impl<const D: usize, P: Potential> Kernel for Energies<'_, D, P> {
    type Out = [f64; 1];
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 1] {
        let view = &self.view;
        let mut sum = 0.0;
        for tile in view.tiles.block(block) {
            let i = view.tiles.own::<L>(&tile);
            let mut energy = L::splat(0.0);
            for (k, link) in tile.links.iter().enumerate() {
                let (_, q) = view.vector(&tile, link, &i);
                let pair = view.potential.pair(Dual::variable(q)).value;
                energy = energy + pair.zero_if(view.out(q, &tile, k));
            }
            energy = energy * L::splat(0.5);
            if P::EMBEDDED {
                let [f, _] = embed(view.potential, view.density(&tile, &i));
                energy = energy + f;
            }
            let energy = energy.zero_if(L::dead(tile.owned));
            if !self.out.0.is_null() {
                // SAFETY: tiles are disjoint
                unsafe { (energy * L::splat(self.inverse)).store(self.out.at(tile.first)) };
            }
            sum += energy.to_array().iter().sum::<f64>();
        }
        [sum]
    }
}

impl<const D: usize, P: Potential> Interaction<D> for FixedAtoms<D, P> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        "stencil"
    }

    unsafe fn forces_unchecked(
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
        let mut tally = Tally::default();
        if P::EMBEDDED {
            tally = self.embed(body, u);
        }
        let kernel = Forces {
            view: self.view(body, u),
            slope: &self.slope,
            f: std::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            scale: 2.0 / self.volume,
            next: self.next,
        };
        // a density without meaning comes of neighbours that crossed
        let mut first = find_fault(&self.faults, self.simd, &kernel);
        first += tally;
        first
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: &Field<D>) -> [f64; 2] {
        [self.energies(body, u, Shared::NULL), 0.0]
    }

    unsafe fn observe_unchecked(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies) {
        out.zeros(body.len);
        self.energies(body, u, Shared(out.strain.as_mut_ptr()));
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        if P::EMBEDDED {
            self.embed(body, u);
        }
        let slope = |s: usize| self.slope.get(s).copied().unwrap_or(0.0);
        let mut density = vec![0.0; if P::EMBEDDED { body.len } else { 0 }];
        let Layout::Grid(grid) = &body.layout else {
            return;
        };
        let original = body.originals();
        self.links.each_directed(grid, |i, j, sub, k| {
            let xi = self.links.links[sub][k].xi;
            let y: [f64; D] = std::array::from_fn(|a| xi[a] + (u[a][j] - u[a][i]));
            let q: f64 = y.iter().map(|c| c * c).sum();
            if q >= self.limit * self.limit {
                return;
            }
            if P::EMBEDDED {
                density[i] += self.potential.density(q);
            }
            visit(BondTangent::of_potential(
                &self.potential,
                [i, original(j)],
                y,
                slope(i) + slope(j),
                2.0 / self.volume,
            ));
        });
        self.curvature = density
            .iter()
            .map(|d| curvature(&self.potential, *d))
            .collect();
    }

    fn each_force(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        visit: &mut dyn FnMut(BondForce<D>),
    ) -> bool {
        self.tangents(body, u, &mut |bond| visit(bond.force()));
        true
    }

    fn is_potential(&self) -> bool {
        true
    }

    fn gain(&self, slot: usize) -> f64 {
        self.curvature.get(slot).copied().unwrap_or(0.0)
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D], BondState)) {
        self.links
            .each(body, &mut |i, j, xi| visit(i, j, xi, BondState::Whole));
    }

    fn directed_bonds(&self) -> u64 {
        self.links.directed()
    }

    fn family_size(&self, body: &Body<D>, slot: usize) -> usize {
        self.links.family_size(body, slot)
    }

    fn bytes(&self) -> usize {
        self.links.bytes() + 8 * self.slope.len()
    }
}
