//! A potential on a lattice whose neighbours stay neighbours: chains of seleson2009 (5.1), upscaled models of
//! seleson2014 (3.4). Distances are the current ones.

use super::{bad_density, embed, faults};
use crate::body::{Body, Column, FAR, Field, Layout, field};
use crate::execute::blocks::{Shared, for_each_block};
use crate::execute::lane::Lane;
use crate::execute::simd::{Kernel, Simd};
use crate::family::links::Links;
use crate::interaction::tangent::curvature;
use crate::interaction::{BondState, BondTangent, Fault, Interaction, PointEnergies, Sweep, Tally, add_virial};
use crate::law::number::Dual;
use crate::law::potential::Potential;

/// Tiles per block of work.
const BLOCK: usize = 64;

/// A potential on a stencil.
pub struct FixedAtoms<const D: usize, P> {
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
    faults: Vec<Option<Fault>>,
    sums: Vec<f64>,
}

impl<const D: usize, P: Potential> FixedAtoms<D, P> {
    pub fn new(body: &Body<D>, links: Links<D>, potential: P, simd: Simd) -> Self {
        let blocks = links.tiles.len().div_ceil(BLOCK);
        FixedAtoms {
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
            links,
            faults: vec![None; blocks],
            sums: vec![0.0; blocks],
        }
    }

    fn view<'a>(&'a self, body: &'a Body<D>, u: &'a Field<D>) -> View<'a, D, P> {
        View {
            links: &self.links,
            potential: &self.potential,
            limit: self.limit * self.limit,
            body,
            u,
        }
    }

    fn energies(&self, body: &Body<D>, u: &Field<D>, out: Shared, sums: &mut [f64]) {
        let kernel = Energies {
            view: self.view(body, u),
            out,
            inverse: 1.0 / self.volume,
        };
        for_each_block(self.simd, &kernel, sums);
    }

    /// F′ everywhere, images included, or why not.
    fn embed(&mut self, body: &Body<D>, u: &Field<D>) -> Tally {
        let (mut found, mut slope) = (
            std::mem::take(&mut self.faults),
            std::mem::take(&mut self.slope),
        );
        let kernel = Density {
            view: self.view(body, u),
            slope: Shared(slope.as_mut_ptr()),
        };
        for_each_block(self.simd, &kernel, &mut found);
        let tally = faults(&found);
        (self.faults, self.slope) = (found, slope);
        body.fill_images(&mut self.slope);
        tally
    }

    /// Neighbours of a chain that went through each other.
    fn crossed(&self, body: &Body<D>, u: &Field<D>) -> Option<Fault> {
        let Layout::Grid(grid) = &body.layout else {
            return None;
        };
        if D != 1 {
            return None;
        }
        let step = self.links.links[0].iter().filter(|l| l.xi[0] > 0.0);
        let next = step.min_by(|a, b| a.xi[0].total_cmp(&b.xi[0]))?;
        body.slots.iter().find_map(|&s| {
            let i = s as usize;
            let j = next.partner(grid, i)?;
            let crossed = next.xi[0] + (u[0][j] - u[0][i]) <= 0.0;
            crossed.then_some(Fault::Crossing { i, j })
        })
    }
}

struct View<'a, const D: usize, P> {
    links: &'a Links<D>,
    potential: &'a P,
    /// Squared length.
    limit: f64,
    body: &'a Body<D>,
    u: &'a Field<D>,
}

impl<const D: usize, P: Potential> View<'_, D, P> {
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

    #[inline(always)]
    fn here<L: Lane>(&self, first: usize) -> [L; D] {
        let mut i = [L::splat(0.0); D];
        for a in 0..D {
            // SAFETY: tiles lie inside the arrays
            i[a] = unsafe { L::load(self.u[a].as_ptr().add(first)) };
        }
        i
    }

    /// Current vector to the partners at an offset, and its square.
    #[inline(always)]
    fn vector<L: Lane>(
        &self,
        first: usize,
        shift: isize,
        xi: &[f64; D],
        i: &[L; D],
    ) -> ([L; D], L) {
        let mut y = *i;
        let mut q = L::splat(0.0);
        for a in 0..D {
            // SAFETY: offsets stay inside the arrays
            let j = unsafe { L::load(self.u[a].as_ptr().add(first).offset(shift)) };
            y[a] = L::splat(xi[a]) + (j - i[a]);
            q = y[a].fma(y[a], q);
        }
        (y, q)
    }

    /// Lanes whose partners at bond `k` are beyond the cut-off or not there.
    #[inline(always)]
    fn out<L: Lane>(&self, q: L, bits: Option<&[u8]>, k: usize) -> L::Mask {
        let far = q.ge(L::splat(self.limit));
        match bits {
            None => far,
            Some(bits) => L::or(far, L::dead(bits[k])),
        }
    }

    /// Σ f of a tile.
    #[inline(always)]
    fn density<L: Lane>(&self, n: usize, first: usize, sub: usize, i: &[L; D]) -> L {
        let mut density = L::splat(0.0);
        let bits = self.links.bits(n, sub);
        for (k, link) in self.links.links[sub].iter().enumerate() {
            let (_, q) = self.vector(first, link.shift, &link.xi, i);
            let f = self.potential.density(Dual::variable(q)).value;
            density = density + f.zero_if(self.out(q, bits, k));
        }
        density
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
        for n in view.block(block) {
            let (first, sub, owned) = view.tile(n);
            let density = view.density::<L>(n, first, sub, &view.here(first));
            let [_, slope] = embed(view.potential, density);
            // SAFETY: tiles are disjoint
            unsafe { slope.zero_if(L::dead(owned)).store(self.slope.at(first)) };
            if fault.is_none()
                && let Some((l, density)) = bad_density(view.potential, density.to_array(), owned)
            {
                fault = Some(Fault::Density {
                    slot: first + l,
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
}

impl<const D: usize, P: Potential> Kernel for Forces<'_, D, P> {
    type Out = ();
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let view = &self.view;
        for n in view.block(block) {
            let (first, sub, owned) = view.tile(n);
            let i = view.here::<L>(first);
            let mut own = L::splat(0.0);
            if P::EMBEDDED {
                // SAFETY: as the displacements
                own = unsafe { L::load(self.slope.as_ptr().add(first)) };
            }
            let mut force = [L::splat(0.0); D];
            let bits = view.links.bits(n, sub);
            for (k, link) in view.links.links[sub].iter().enumerate() {
                let (y, q) = view.vector(first, link.shift, &link.xi, &i);
                let mut pull = view.potential.pair(Dual::variable(q)).slope;
                if P::EMBEDDED {
                    // SAFETY: as the displacements
                    let other =
                        unsafe { L::load(self.slope.as_ptr().add(first).offset(link.shift)) };
                    let f = view.potential.density(Dual::variable(q)).slope;
                    pull = f.fma(own + other, pull);
                }
                let pull = pull.zero_if(view.out(q, bits, k));
                for a in 0..D {
                    force[a] = pull.fma(y[a], force[a]);
                }
            }
            let dead = L::dead(owned);
            for a in 0..D {
                let f = force[a] * L::splat(self.scale);
                // SAFETY: tiles are disjoint
                unsafe { f.zero_if(dead).store(self.f[a].at(first)) };
            }
        }
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
    type Out = f64;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> f64 {
        let view = &self.view;
        let mut sum = 0.0;
        for n in view.block(block) {
            let (first, sub, owned) = view.tile(n);
            let i = view.here::<L>(first);
            let mut energy = L::splat(0.0);
            let bits = view.links.bits(n, sub);
            for (k, link) in view.links.links[sub].iter().enumerate() {
                let (_, q) = view.vector(first, link.shift, &link.xi, &i);
                let pair = view.potential.pair(Dual::variable(q)).value;
                energy = energy + pair.zero_if(view.out(q, bits, k));
            }
            energy = energy * L::splat(0.5);
            if P::EMBEDDED {
                let density = view.density::<L>(n, first, sub, &i);
                let [f, _] = embed(view.potential, density);
                energy = energy + f;
            }
            let energy = energy.zero_if(L::dead(owned));
            if !self.out.0.is_null() {
                // SAFETY: tiles are disjoint
                unsafe { (energy * L::splat(self.inverse)).store(self.out.at(first)) };
            }
            sum += energy.to_array().iter().sum::<f64>();
        }
        sum
    }
}

impl<const D: usize, P: Potential> Interaction<D> for FixedAtoms<D, P> {
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
        let mut tally = Tally {
            fault: self.crossed(body, u),
            ..Tally::default()
        };
        if P::EMBEDDED {
            tally += self.embed(body, u);
        }
        let kernel = Forces {
            view: self.view(body, u),
            slope: &self.slope,
            f: std::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            scale: 2.0 / self.volume,
        };
        let blocks = self.sums.len();
        for_each_block(self.simd, &kernel, &mut vec![(); blocks]);
        tally
    }

    fn energy(&mut self, body: &Body<D>, u: &Field<D>) -> [f64; 2] {
        let mut sums = std::mem::take(&mut self.sums);
        self.energies(body, u, Shared::NULL, &mut sums);
        let total = sums.iter().sum();
        self.sums = sums;
        [total, 0.0]
    }

    fn observe(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies) {
        out.zeros(body.len);
        let strain = Shared(out.strain.as_mut_ptr());
        self.energies(body, u, strain, &mut vec![0.0; self.sums.len()]);
    }

    fn tangents(
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
        self.links.each_directed(body, &mut |i, j, k, sub| {
            let xi = self.links.links[sub][k].xi;
            let y: [f64; D] = std::array::from_fn(|a| xi[a] + (u[a][j.slot] - u[a][i]));
            let q: f64 = y.iter().map(|c| c * c).sum();
            if q >= self.limit * self.limit {
                return;
            }
            if P::EMBEDDED {
                density[i] += self.potential.density(q);
            }
            visit(BondTangent::of_potential(
                &self.potential,
                [i, j.original],
                y,
                slope(i) + slope(j.slot),
                2.0 / self.volume,
            ));
        });
        self.curvature = density.iter().map(|d| curvature(&self.potential, *d)).collect();
    }

    fn gain(&self, slot: usize) -> f64 {
        self.curvature.get(slot).copied().unwrap_or(0.0)
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D], BondState)) {
        self.links
            .each(body, &mut |i, j, xi| visit(i, j, xi, BondState::Whole));
    }

    fn virial(&mut self, body: &Body<D>, u: &Field<D>) -> Option<[f64; 6]> {
        if P::EMBEDDED {
            self.embed(body, u);
        }
        let Layout::Grid(grid) = &body.layout else {
            return None;
        };
        let mut sum = [0.0; 6];
        for &s in &body.slots {
            let i = s as usize;
            let (_, sub) = grid.cell(i);
            for link in &self.links.links[sub] {
                let Some(j) = link.partner(grid, i) else {
                    continue;
                };
                let y: [f64; D] = std::array::from_fn(|a| link.xi[a] + (u[a][j] - u[a][i]));
                let q: f64 = y.iter().map(|c| c * c).sum();
                if q >= self.limit * self.limit {
                    continue;
                }
                let mut pull = self.potential.pair(Dual::variable(q)).slope;
                if P::EMBEDDED {
                    let f = self.potential.density(Dual::variable(q)).slope;
                    pull += f * (self.slope[i] + self.slope[j]);
                }
                add_virial(&mut sum, &y, &y, -pull);
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
        self.links.bytes() + 8 * self.slope.len()
    }
}
