//! Given micromoduli: `f_i = Σ_j C_ij (u_j − u_i)`, a block for every directed bond. Coarsened bodies, composites, defects.

use super::{
    BondStatus, BondTangent, EachBond, EachForce, EachTangent, Gradient, Interaction,
    PointEnergiesMut, Sweep, Tally,
};
use crate::body::{Body, FieldView, FieldViewMut, Identity, Subdomain};
use crate::execute::blocks::{PerBlock, Shared, run_blocks};
use crate::execute::lane::Lane;
use crate::execute::simd::{Kernel, Simd};
use crate::spec::LinearBody;

/// Rows per block of work.
const BLOCK: usize = 256;

/// Micromoduli of a cloud.
pub struct MicromoduliInteraction<const D: usize> {
    body: Identity,
    simd: Simd,
    /// `[rows]` slots, ascending.
    slots: Vec<u32>,
    /// Row of every slot.
    row: Vec<u32>,
    start: Vec<usize>,
    /// Partners' slots.
    partner: Vec<u32>,
    /// Does the partner not know the bond?
    alone: Vec<bool>,
    block: Vec<[[f64; D]; D]>,
    /// `[partners]` reference vectors (length).
    xi: Vec<[f64; D]>,
    sums: PerBlock<[f64; 1]>,
    asymmetry: f64,
}

impl<const D: usize> MicromoduliInteraction<D> {
    /// `linear` in order of the ids of `body`, of those of all ranks where it is a part: it has copies of all partners.
    pub fn new(body: &Body<D>, linear: &LinearBody<D>, simd: Simd) -> Self {
        let mut ids: Vec<usize> = (0..body.points()).collect();
        ids.sort_by_key(|id| body.slots[*id]);
        let mut made = MicromoduliInteraction {
            body: body.identity,
            simd,
            slots: ids.iter().map(|id| body.slots[*id]).collect(),
            row: vec![0; body.len],
            start: vec![0],
            partner: vec![],
            alone: vec![],
            block: vec![],
            xi: vec![],
            sums: PerBlock::sums(ids.len().div_ceil(BLOCK))
                .among(body.subdomain().map(Subdomain::comm)),
            asymmetry: linear.soundness().asymmetry,
        };
        let slots = body.slots_of_ids();
        for (row, &id) in ids.iter().enumerate() {
            made.row[body.slots[id] as usize] = row as u32;
            let id = body.id_of_all(id);
            let (partners, blocks) = linear.row(id);
            for (&j, block) in partners.iter().zip(blocks) {
                made.partner.push(slots[j as usize]);
                made.alone
                    .push(linear.micromodulus(j as usize, id).is_none());
                made.block.push(*block);
                made.xi.push(linear.xi(id, j as usize));
            }
            made.start.push(made.partner.len());
        }
        made
    }

    fn bonds(&self, row: usize) -> impl Iterator<Item = (usize, &[[f64; D]; D], &[f64; D])> {
        let bonds = self.start[row]..self.start[row + 1];
        bonds.map(|k| (self.partner[k] as usize, &self.block[k], &self.xi[k]))
    }

    /// Force density on a row's point, and the energy density of its bonds.
    #[inline(always)]
    fn pull(&self, u: FieldView<D>, row: usize) -> ([f64; D], f64) {
        let i = self.slots[row] as usize;
        let (mut f, mut energy) = ([0.0; D], 0.0);
        for (j, c, _) in self.bonds(row) {
            let mut eta = [0.0; D];
            for a in 0..D {
                eta[a] = u[a][j] - u[a][i];
            }
            for a in 0..D {
                let mut pull = 0.0;
                for b in 0..D {
                    pull += c[a][b] * eta[b];
                }
                f[a] += pull;
                energy += 0.25 * pull * eta[a];
            }
        }
        (f, energy)
    }

    /// Energy, and energy densities per slot where asked for.
    fn energies(&self, body: &Body<D>, u: FieldView<D>, out: Shared) -> f64 {
        let kernel = Energies {
            law: self,
            body,
            u,
            out,
        };
        let [sum] = self.sums.sum(self.simd, &kernel);
        sum
    }
}

fn rows(block: usize, all: usize) -> std::ops::Range<usize> {
    block * BLOCK..((block + 1) * BLOCK).min(all)
}

struct Forces<'a, const D: usize> {
    law: &'a MicromoduliInteraction<D>,
    u: FieldView<'a, D>,
    f: [Shared; D],
}

impl<const D: usize> Kernel for Forces<'_, D> {
    type Out = ();
    type Home = Self;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        for row in rows(block, self.law.slots.len()) {
            let (f, _) = self.law.pull(self.u, row);
            for a in 0..D {
                // SAFETY: every slot belongs to one row
                unsafe { *self.f[a].at(self.law.slots[row] as usize) = f[a] };
            }
        }
    }
}

struct Energies<'a, const D: usize> {
    law: &'a MicromoduliInteraction<D>,
    body: &'a Body<D>,
    u: FieldView<'a, D>,
    /// Energy density per slot, if asked for.
    out: Shared,
}

impl<const D: usize> Kernel for Energies<'_, D> {
    type Out = [f64; 1];
    type Home = Self;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 1] {
        let mut sum = 0.0;
        for row in rows(block, self.law.slots.len()) {
            let (_, energy) = self.law.pull(self.u, row);
            let slot = self.law.slots[row] as usize;
            if !self.out.0.is_null() {
                // SAFETY: every slot belongs to one row
                unsafe { *self.out.at(slot) = energy };
            }
            sum += energy * self.body.volume.at(slot);
        }
        [sum]
    }
}

impl<const D: usize> Interaction<D> for MicromoduliInteraction<D> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        "list"
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
            law: self,
            u,
            f: crate::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
        };
        run_blocks(self.simd, &kernel, self.sums.blocks());
        Tally::default()
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

    fn observe_gradient(&self, body: &Body<D>, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        self.check(body, &[]);
        out.zeros(body.len);
        for (row, &slot) in self.slots.iter().enumerate() {
            for (_, c, xi) in self.bonds(row) {
                let eta = super::along(gradient, xi);
                let pull = super::along(c, &eta);
                let work: f64 = pull.iter().zip(&eta).map(|(f, e)| f * e).sum();
                out.strain[slot as usize] += 0.25 * work;
            }
        }
    }

    unsafe fn tangents_unchecked(
        &mut self,
        _: &Body<D>,
        _: FieldView<D>,
        visit: &mut EachTangent<D>,
    ) {
        for (row, &slot) in self.slots.iter().enumerate() {
            for (j, c, xi) in self.bonds(row) {
                visit(BondTangent::direct(slot as usize, j, *xi, *c));
            }
        }
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        let id = body.id_of();
        for (row, &slot) in self.slots.iter().enumerate() {
            let i = slot as usize;
            let alone = &self.alone[self.start[row]..];
            for ((j, _, xi), alone) in self.bonds(row).zip(alone) {
                // a bond that only its other end knows is visited there
                if id(i) < id(j) || *alone {
                    visit(i, j, *xi, BondStatus::Whole);
                }
            }
        }
    }

    /// Of those that a point knows itself.
    fn each_partner(&self, _: &Body<D>, visit: &mut EachBond<D>) {
        for (row, &slot) in self.slots.iter().enumerate() {
            for (j, _, xi) in self.bonds(row) {
                visit(slot as usize, j, *xi, BondStatus::Whole);
            }
        }
    }

    /// Of the linear forces, along the reference distances.
    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        self.tangents(body, u, &mut |bond| visit(bond.linear_force(u)));
        true
    }

    fn asymmetry(&self) -> f64 {
        self.asymmetry
    }

    fn directed_bonds(&self) -> u64 {
        self.partner.len() as u64
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        let row = self.row[slot] as usize;
        self.start[row + 1] - self.start[row]
    }

    fn bytes(&self) -> usize {
        4 * (self.slots.len() + self.row.len() + self.partner.len())
            + self.alone.len()
            + 8 * self.start.len()
            + 8 * D * (D + 1) * self.block.len()
    }
}
