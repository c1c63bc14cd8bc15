//! A potential on a lattice whose neighbours stay neighbours: chains of seleson2009 (5.1), upscaled models of
//! seleson2014 (3.4). Distances are the current ones.

mod kernel;

use super::{Curvatures, Faults, find_fault};
use crate::body::{Body, Column, FAR, FieldView, FieldViewMut, Identity, Subdomain, field};
use crate::execute::blocks::{PerBlock, Shared};
use crate::execute::simd::Simd;
use crate::family::links::{Links, Tiles};
use crate::interaction::{
    BondStatus, BondTangent, EachBond, EachForce, EachTangent, Interaction, PointEnergiesMut,
    Sweep, Tally,
};
use crate::law::potential::Potential;
use crate::law::potential::mixture::Mixture;
use kernel::{Density, Energies, Forces, View};

/// A potential on a stencil.
pub struct FixedAtoms<const D: usize, P> {
    body: Identity,
    simd: Simd,
    potential: Mixture<P>,
    links: Links<D>,
    /// Squared distances beyond which pairs of kinds do not count.
    limits: Vec<f64>,
    /// Kind per slot; empty: there is one.
    kind: Column,
    /// F′ per slot; empty without embedding.
    slope: Column,
    curvatures: Curvatures,
    volume: f64,
    /// The link of a chain to its next neighbour.
    next: Option<usize>,
    faults: Faults,
    sums: PerBlock<[f64; 1]>,
}

impl<const D: usize, P: Potential> FixedAtoms<D, P> {
    /// The kinds of the potential are the materials of the body, or there is one.
    pub fn new(body: &Body<D>, links: Links<D>, potential: Mixture<P>, simd: Simd) -> Self {
        FixedAtoms {
            body: body.identity,
            simd,
            // displacements of absent sites are farther than this
            limits: potential.limits(0.5 * FAR * body.spacing),
            kind: match potential.kinds() {
                1 => Column::default(),
                _ => kinds_of(body),
            },
            slope: if P::EMBEDDED {
                Column::new(body.len, 0.0, field::line(3))
            } else {
                Column::default()
            },
            curvatures: Curvatures::default(),
            volume: body.volume.uniform().unwrap_or(1.0),
            potential,
            next: next_of_chain(&links),
            faults: PerBlock::new(links.blocks(), None),
            sums: PerBlock::sums(links.blocks()).among(body.subdomain().map(Subdomain::comm)),
            links,
        }
    }

    fn view<'a>(&'a self, body: &'a Body<D>, u: FieldView<'a, D>) -> View<'a, D, P> {
        View {
            tiles: Tiles::new(&self.links, body, u),
            potential: &self.potential,
            limits: &self.limits,
            kind: &self.kind,
            slope: &self.slope,
        }
    }

    fn kind(&self, slot: usize) -> usize {
        self.kind.get(slot).map_or(0, |k| *k as usize)
    }

    /// Energy, and energy densities per slot where asked for.
    fn energies(&self, body: &Body<D>, u: FieldView<D>, out: Shared) -> f64 {
        let kernel = Energies {
            view: self.view(body, u),
            out,
            inverse: 1.0 / self.volume,
        };
        let [sum] = self.sums.sum(self.simd, &kernel);
        sum
    }

    /// F′ everywhere, images included, or why not.
    fn embed(&mut self, body: &Body<D>, u: FieldView<D>) -> Tally {
        let slope = Shared(self.slope.as_mut_ptr());
        let kernel = Density {
            view: self.view(body, u),
            slope,
        };
        let tally = find_fault(&self.faults, self.simd, &kernel);
        body.exchange.fill(&mut self.slope);
        tally
    }
}

/// Materials of all slots, images too.
fn kinds_of<const D: usize>(body: &Body<D>) -> Column {
    let mut kind = Column::new(body.len, 0.0, field::line(4));
    body.set_points(&mut kind, |slot| body.material_of(slot) as f64);
    kind
}

/// The shortest link forward, in one dimension.
fn next_of_chain<const D: usize>(links: &Links<D>) -> Option<usize> {
    let links = links.links.first().filter(|_| D == 1)?;
    let forward = links.iter().enumerate().filter(|(_, l)| l.xi[0] > 0.0);
    let next = forward.min_by(|a, b| a.1.xi[0].total_cmp(&b.1.xi[0]))?;
    Some(next.0)
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
        u: FieldView<D>,
        f: FieldViewMut<D>,
        _: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
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
            f: crate::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            scale: 2.0 / self.volume,
            next: self.next,
        };
        // a density without meaning comes of neighbours that crossed
        let mut first = find_fault(&self.faults, self.simd, &kernel);
        first += tally;
        first
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        [self.energies(body, u, Shared::NULL), 0.0]
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        out.zeros(body.len);
        self.energies(body, u, Shared(out.strain.as_mut_ptr()));
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        if P::EMBEDDED {
            self.embed(body, u);
        }
        let slope = |s: usize| self.slope.get(s).copied().unwrap_or(0.0);
        let mut density = vec![0.0; if P::EMBEDDED { body.len } else { 0 }];
        let grid = body.grid();
        self.links.each_directed(grid, |i, j, sub, k| {
            let xi = self.links.links[sub][k].xi;
            let y: [f64; D] = crate::array::from_fn(|a| xi[a] + (u[a][j] - u[a][i]));
            let q: f64 = y.iter().map(|c| c * c).sum();
            let j = body.exchange.original(j);
            let [own, other] = [i, j].map(|s| self.kind(s));
            let limit = self.limits[own * self.potential.kinds() + other];
            let Some(potential) = self.potential.of(own, other).filter(|_| q < limit) else {
                return;
            };
            if P::EMBEDDED {
                density[i] += potential.density(q);
            }
            visit(BondTangent::of_potential(
                potential,
                [i, j],
                y,
                [slope(i), slope(j)],
                2.0 / self.volume,
                own != other,
            ));
        });
        let of = |(slot, d): (usize, &f64)| (self.potential.own(self.kind(slot)), *d);
        self.curvatures = Curvatures::of(density.iter().enumerate().map(of));
    }

    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        if self.potential.kinds() > 1 {
            self.tangents(body, u, &mut |bond| visit(bond.force()));
            return true;
        }
        if P::EMBEDDED {
            self.check(body, &[u]);
            self.embed(body, u);
        }
        let slope = self.slope.clone();
        let slope = |s: usize| slope.get(s).copied().unwrap_or(0.0);
        self.tangents(body, u, &mut |bond| {
            let ends = [bond.i, bond.j].map(slope);
            visit(bond.force_of_potential(ends));
        });
        true
    }

    fn is_potential(&self) -> bool {
        true
    }

    fn gain(&self, slot: usize) -> f64 {
        self.curvatures.at(slot)
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
