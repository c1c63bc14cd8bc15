//! Any law on a lattice stencil: tiles of eight points walk the offsets together; one bit per bond is all that is
//! stored.

mod assemble;
mod bonds;
mod kernel;
mod weights;

use super::bonds::family::Family;
use super::bonds::{AnyBonds, BondState, LatticeFamily};
use super::point_constants::pressure_factor;
use super::scale::Scale;
use super::{
    BondTangent, EachForce, EachPair, EachTangent, EnergyFields, FactorsOf, Interaction, Motion,
    PointConstants, PointEnergiesMut, Sweep, Tally,
};
use crate::body::{Body, Column, FieldView, FieldViewMut, Identity, view};
use crate::error::BuildError;
use crate::execute::blocks::{Seen, Shared, Which};
use crate::law::{BondFactors, Law};
pub use assemble::StencilParts;
pub use kernel::MOST;
use kernel::{Bond, Energies, Forces, Partner, Remember, Share, View, WHOLE};

/// A law on a stencil.
pub struct StencilInteraction<const D: usize, W: Law> {
    bonds: BondState<D, LatticeFamily<D>>,
    law: W,
    /// Bonds as sweeps read them, per sublattice.
    stencil: Vec<Vec<Bond<D>>>,
    partners: Vec<Vec<Partner<D>>>,
    /// `[tiles]`: are all bonds whole, and their ends alike? See the kernel's `WHOLE` and `ALIKE`.
    state: Vec<u8>,
    /// `[tiles]`: which row of `reaches`.
    reach: Vec<u32>,
    /// `[different][words]`: a bit per offset that any point of a tile has a partner at.
    reaches: Vec<u64>,
    /// Factors of bonds.
    scale: Scale,
    /// Point fields of the law, per slot (empty where unused).
    fields: [Column; 2],
    /// Pressure factors per slot where materials differ; else the law's own.
    pressure: Column,
    point_constants: PointConstants,
    /// `[tiles][8]`: the next critical values, which sweeps write tile by tile.
    next: Vec<f64>,
    /// The lowest critical value.
    least_critical: f64,
    /// No critical stretch changes any more: none depends on the strain, and the first are known.
    settled: bool,
    /// The highest `e` at which any bond repels.
    most_contact: f64,
    /// Of a whole cell.
    volume: f64,
    out_of_line: Apart,
}

/// Blocks of a part of a body by who has the partners of their points.
#[derive(Debug, Default)]
struct Apart {
    /// This rank has all of them, or others have some; `None`: there are no others.
    blocks: Option<[Vec<u32>; 2]>,
    /// Was the first half done while the copies for the second were on their way?
    begun: bool,
}

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    /// For kernels that only read.
    fn view<'a>(&'a self, body: &'a Body<D>, u: FieldView<'a, D>) -> View<'a, D, W> {
        let alive = Seen(self.bonds.alive.as_ptr());
        let state = Seen(self.state.as_ptr());
        self.view_of(body, u, alive, state, &self.fields[0])
    }

    fn view_of<'a>(
        &'a self,
        body: &'a Body<D>,
        u: FieldView<'a, D>,
        alive: Seen<u8>,
        state: Seen<u8>,
        own: &'a [f64],
    ) -> View<'a, D, W> {
        let family = &self.bonds.family;
        View {
            law: self.law,
            grid: body.grid(),
            body,
            bonds: &self.stencil,
            partners: &self.partners,
            family,
            width: family.width,
            tiles: family.tiles(),
            alive,
            state,
            reach: &self.reach,
            reaches: &self.reaches,
            scale: &self.scale,
            u,
            fields: [own, &self.fields[1]],
            pressure: &self.pressure,
            repulsion: self.bonds.repulsion.as_ref(),
            most_contact: self.most_contact,
        }
    }

    /// The lowest critical `e` of any point from now on, too.
    fn sweep(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        motion: Option<Motion<D>>,
        which: Which<'_>,
    ) -> (Tally, f64) {
        match self.bonds.critical.is_empty() {
            true => self.sweep_of::<false>(body, u, f, motion, which),
            false => self.sweep_of::<true>(body, u, f, motion, which),
        }
    }

    fn sweep_of<const FULL: bool>(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        motion: Option<Motion<D>>,
        which: Which<'_>,
    ) -> (Tally, f64) {
        let alive = Shared(self.bonds.alive.as_mut_ptr());
        let state = Shared(self.state.as_mut_ptr());
        let next = Shared(self.next.as_mut_ptr());
        let next = (!self.settled).then_some(next);
        let kernel = Forces::<D, W, FULL> {
            view: self.view_of(body, u, alive.seen(), state.seen(), &self.fields[0]),
            alive,
            state,
            f: crate::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            critical: &self.bonds.critical,
            next,
            toughness: &self.bonds.toughness,
            lower: self.most_contact,
            upper: self.least_critical,
            motion,
        };
        self.bonds.blocks.tally_of(&kernel, which)
    }

    /// Pressures of points.
    fn share(&mut self, body: &Body<D>, u: FieldView<D>, which: Which<'_>) {
        // it stays where it is: a law that panics must not leave sweeps without
        let out = Shared(self.fields[0].as_mut_ptr());
        let [alive, state] = [&self.bonds.alive, &self.state].map(|all| Seen(all.as_ptr()));
        let view = self.view_of(body, u, alive, state, &[]);
        self.bonds.blocks.run_of(&Share { view, out }, which);
    }

    /// A bond breaks by both of its ends, of which one may be another rank's.
    fn look_least(&mut self, body: &Body<D>) {
        let copies = body.exchange.is_shared().then(|| body.exchange.copies());
        let critical = copies
            .into_iter()
            .flatten()
            .map(|s| self.bonds.critical.get(s));
        self.least_critical = critical
            .flatten()
            .copied()
            .fold(self.least_critical, f64::min);
    }

    /// n and 1/m at a slot.
    fn per_weight(&self, body: &Body<D>, slot: usize) -> [f64; 2] {
        let by_weight = || self.fields[1][slot];
        self.point_constants
            .per_weight(body.material_of(slot), by_weight)
    }

    /// Energies of all points, with `Σ k r0² s` in place of the dilatation and `Σ k r0²` of what is whole.
    fn sums(&self, body: &Body<D>, u: FieldView<D>, out: &mut PointEnergiesMut) {
        let kernel = Energies {
            view: self.view(body, u),
            fields: Some(EnergyFields::of(out, body.len)),
        };
        self.bonds.blocks.sum(&kernel);
    }

    /// `P / Σ k r0² s` at a slot.
    fn pressure_factor(&self, i: usize) -> f64 {
        pressure_factor(self.law, &self.pressure, i, || self.fields[1][i])
    }
}

impl<const D: usize, W: Law> Interaction<D> for StencilInteraction<D, W> {
    fn made_for(&self) -> Identity {
        self.bonds.body
    }

    fn bonds(&self) -> Option<&dyn AnyBonds<D>> {
        Some(&self.bonds)
    }

    fn bonds_mut(&mut self) -> Option<&mut dyn AnyBonds<D>> {
        Some(&mut self.bonds)
    }

    fn look_bits(&mut self) {
        // a bond that is there again has a point that knows no limit
        self.settled = false;
        self.look();
    }

    fn look_critical(&mut self, body: &Body<D>) {
        let critical = &mut self.bonds.critical;
        if !critical.is_empty() {
            body.exchange.fill(critical);
        }
        let known = body.slots.iter().map(|s| critical.get(*s as usize));
        let known = known.flatten().copied();
        self.least_critical = known.fold(f64::INFINITY, f64::min);
        self.look_least(body);
        self.settled = false;
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        let motion = sweep.motion();
        let out_of_line = std::mem::take(&mut self.out_of_line);
        let rest = match &out_of_line.blocks {
            Some([_, rest]) if out_of_line.begun => Which::These(rest),
            _ => Which::All,
        };
        if let Some(seen) = seen {
            self.sums(body, u, seen);
            if W::SHARES {
                for &slot in &body.slots {
                    let i = slot as usize;
                    self.fields[0][i] = self.pressure_factor(i) * seen.dilatation[i];
                }
            }
            seen.dilate::<W, D>(body, |i| self.per_weight(body, i));
        } else if W::SHARES {
            self.share(body, u, rest);
        }
        let (total, least_critical) = match &out_of_line.blocks {
            Some([inside, others]) if W::SHARES => {
                let mut both = (&mut *self, f);
                body.exchange.fill_during(
                    &mut both,
                    |(all, _), fill| fill(&mut all.fields[0]),
                    |(all, f)| {
                        let f = f.each_mut().map(|column| &mut **column);
                        all.sweep(body, u, f, motion, Which::These(inside));
                    },
                );
                let (all, f) = both;
                all.sweep(body, u, f, motion, Which::These(others))
            }
            _ => {
                if W::SHARES {
                    body.exchange.fill(&mut self.fields[0]);
                }
                self.sweep(body, u, f, motion, rest)
            }
        };
        self.out_of_line.blocks = out_of_line.blocks;
        if motion.is_some() && !self.bonds.critical.is_empty() && !self.settled {
            let mut critical = std::mem::take(&mut self.bonds.critical);
            let kernel = Remember {
                view: self.view(body, u),
                next: &self.next,
                critical: Shared(critical.as_mut_ptr()),
            };
            self.bonds.blocks.run(&kernel);
            self.bonds.critical = critical;
            body.exchange.fill(&mut self.bonds.critical);
            self.least_critical = least_critical;
            self.look_least(body);
            // what breaks elsewhere is not known here
            let alone = !body.exchange.is_shared();
            self.settled = alone && self.bonds.toughness.iter().all(|t| t.alpha == 0.0);
        }
        // a point may have lost its last bond
        self.settled &= total.broken == 0;
        total
    }

    fn begin_forces(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        sweep: Sweep<D>,
    ) {
        self.check(body, &[u, view(&f)]);
        let motion = sweep.motion();
        if let Some(motion) = &motion {
            self.check(body, &[motion.v]);
        }
        let Apart { blocks, .. } = std::mem::take(&mut self.out_of_line);
        if let Some([inside, _]) = &blocks {
            match W::SHARES {
                true => self.share(body, u, Which::These(inside)),
                false => {
                    self.sweep(body, u, f, motion, Which::These(inside));
                }
            }
            self.out_of_line.begun = true;
        }
        self.out_of_line.blocks = blocks;
    }

    fn meanwhile(&self) -> [usize; 2] {
        // displacements and velocities, then pressures
        let shares = usize::from(W::SHARES);
        match self.out_of_line.blocks {
            Some(_) => [1 + shares, 8 * (2 * D + shares)],
            None => [0; 2],
        }
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        let kernel = Energies {
            view: self.view(body, u),
            fields: None,
        };
        self.bonds.blocks.sum(&kernel)
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        self.sums(body, u, out);
        out.dilate::<W, D>(body, |i| self.per_weight(body, i));
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        self.update_pressures(body, u);
        let family = &self.bonds.family;
        for (n, l, i) in family.points() {
            for (k, b) in self.stencil[family.sublattice(n)].iter().enumerate() {
                if !self.bonds.is_whole(n, k, l) {
                    continue;
                }
                let j = b.to(i);
                visit(BondTangent::of_law(
                    self.law,
                    [i, body.exchange.original(j)],
                    b.k,
                    self.scale.of(n, k, l),
                    b.back.map(|x| -x),
                    crate::array::from_fn(|a| u[a][j] - u[a][i]),
                    [i, j].map(|s| self.field(s)),
                ));
            }
        }
    }

    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        self.update_pressures(body, u);
        self.pulls_of(body, u, 0..self.tiles(), visit);
        true
    }

    fn virial(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<[f64; 6]> {
        self.check(body, &[u]);
        Some(self.virial_of_pulls(body, u))
    }

    fn gain(&self, slot: usize) -> f64 {
        if W::SHARES {
            self.pressure_factor(slot)
        } else {
            0.0
        }
    }

    fn each_broken(&self, body: &Body<D>, visit: &mut EachPair<D>) {
        let damaged = |n: usize| self.state[n] & WHOLE == 0;
        self.bonds.each_broken_of(body, damaged, visit);
    }

    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        // all points of a lattice are alike
        self.bonds.damage_of(body, |_| 1.0, out);
    }

    fn scale_bonds(&mut self, _: &Body<D>, factors: &FactorsOf<D>) -> Result<(), BuildError> {
        self.multiply_factors(factors);
        Ok(())
    }

    fn reached(&self, _: &Body<D>, i: usize, xi: [f64; D]) -> Option<(f64, BondFactors<f64>)> {
        self.reach(i, xi)
    }

    fn prepare(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        self.weigh(body);
    }

    fn bytes(&self) -> usize {
        let words =
            self.fields[0].len() + self.fields[1].len() + self.pressure.len() + self.next.len();
        self.bonds.bytes()
            + self.state.len()
            + self.scale.bytes()
            + 4 * self.reach.len()
            + 8 * self.reaches.len()
            + 8 * words
    }
}
