//! Any law on a horizon list: bonds of an arbitrary cloud. A bond is a partner and a bit; its geometry and constant
//! are computed anew from two records whenever it is met, so that nothing else is stored.

mod images;
mod kernel;

use super::history;
use super::pairs::BondTable;
use super::weight::BondWeight;
use super::{
    BondForce, BondState, BondTangent, EnergyFields, Interaction, Motion, PointConstants,
    PointEnergies, Repulsion, Sweep, Tally, Toughness, along, laws_fields,
};
use crate::body::{Body, Field, Identity, zeros};
use crate::columns::Declaration;
use crate::execute::blocks::{PerBlock, Shared, run_blocks};
use crate::execute::lane::TILE;
use crate::execute::simd::Simd;
use crate::family::horizon::HorizonList;
use crate::law::BondFactors;
use crate::law::Law;
use crate::spec::CrackKind;
use images::Images;
use kernel::{BLOCK, Energies, Forces, Pack, Share, View};
use std::ops::AddAssign;
use std::sync::Arc;

/// A law on a horizon list.
pub struct ListInteraction<const D: usize, W: Law> {
    body: Identity,
    law: W,
    simd: Simd,
    weight: BondWeight,
    /// Its `present` bits are the family that damage counts: without absent bonds.
    list: HorizonList,
    /// `[lines]`: bits of whole bonds.
    alive: Vec<u8>,
    /// `[slots][4]`: x, y, z, volume.
    reference: Vec<f64>,
    /// `[slots][4]`: displacement and critical `e`, written before every sweep.
    moved: Vec<f64>,
    /// `[slots][2]`: point fields of the law (empty where unused).
    fields: Vec<f64>,
    /// Pressure factors per slot where materials differ; else the law's own.
    pressure: Vec<f64>,
    point_constants: PointConstants,
    toughness: Vec<Toughness>,
    repulsion: Option<Repulsion>,
    /// `[slots]`, where repulsion or the law depends on it; else empty.
    materials: Vec<u8>,
    /// Constants of bonds of pairs of materials, if the law is that of unit constants; else empty.
    pairs: Arc<BondTable>,
    /// Critical `e` per slot, now and next.
    critical: Vec<f64>,
    next: Vec<f64>,
    period: [f64; D],
    inv_period: [f64; D],
    tallies: PerBlock<Tally>,
    sums: PerBlock<[f64; 2]>,
}

/// Everything a list interaction is made of.
pub struct ListParts<'a, const D: usize, W> {
    pub body: &'a Body<D>,
    /// All pairs of this body within the horizon.
    pub list: HorizonList,
    pub law: W,
    /// `ω ν` of a bond.
    pub weight: BondWeight,
    pub point_constants: PointConstants,
    pub toughness: Vec<Toughness>,
    pub repulsion: Option<Repulsion>,
    pub simd: Simd,
}

impl<const D: usize, W: Law> ListInteraction<D, W> {
    pub fn new(parts: ListParts<D, W>) -> Self {
        Self::of_pairs(parts, Arc::default())
    }

    /// With constants of pairs of materials; the law is that of unit constants, `c = 1`, or `n = 3, κ = β = 1`.
    ///
    /// # Panics
    /// If the list is that of another body, or a material has no constants.
    pub fn of_pairs(parts: ListParts<D, W>, pairs: Arc<BondTable>) -> Self {
        laws_fields::<W>();
        let ListParts {
            body,
            list,
            law,
            weight,
            point_constants,
            toughness,
            repulsion,
            simd,
        } = parts;
        assert!(
            list.body == body.identity,
            "the list of another body: make one for this body"
        );
        let mut reference = vec![0.0; 4 * body.len];
        for (slot, record) in reference.chunks_mut(4).enumerate() {
            record[..3].copy_from_slice(&body.position(slot));
            record[3] = body.volume.at(slot);
        }
        let remembers = repulsion.is_some() || toughness.iter().any(|t| t.s00.is_finite());
        let critical = if remembers {
            vec![f64::INFINITY; body.len]
        } else {
            vec![]
        };
        let paired = pairs.materials() > 0;
        let alike = |r: &Repulsion| r.stiffness.one().is_some();
        let materials: Vec<u8> = match !paired && repulsion.as_ref().is_none_or(alike) {
            true => vec![],
            false => (0..body.len).map(|s| body.material_of(s) as u8).collect(),
        };
        if paired {
            let known = |m: &u8| (*m as usize) < pairs.materials();
            assert!(materials.iter().all(known), "constants of every material");
        }
        let blocks = list.slices().div_ceil(BLOCK);
        ListInteraction {
            body: body.identity,
            law,
            simd,
            weight,
            alive: list.present.clone(),
            list,
            reference,
            moved: vec![0.0; 4 * body.len],
            fields: vec![0.0; if W::FIELDS > 0 { 2 * body.len } else { 0 }],
            pressure: vec![],
            point_constants,
            toughness,
            repulsion,
            materials,
            pairs,
            next: critical.clone(),
            critical,
            period: body.period.map(|p| p.unwrap_or(0.0)),
            inv_period: body.period.map(|p| p.map_or(0.0, f64::recip)),
            tallies: PerBlock::new(blocks, Tally::default()),
            sums: PerBlock::sums(blocks),
        }
    }

    /// For kernels that only read.
    fn view<'a>(&'a self, moved: &'a [f64]) -> View<'a, D, W> {
        let alive = Shared(self.alive.as_ptr().cast_mut());
        let fields = Shared(self.fields.as_ptr().cast_mut());
        self.view_of(moved, alive, fields)
    }

    fn view_of<'a>(
        &'a self,
        moved: &'a [f64],
        alive: Shared<u8>,
        fields: Shared,
    ) -> View<'a, D, W> {
        View {
            law: self.law,
            weight: self.weight,
            list: &self.list,
            alive,
            reference: &self.reference,
            moved,
            fields,
            pressure: &self.pressure,
            period: self.period,
            inv_period: self.inv_period,
            repulsion: self.repulsion.as_ref(),
            materials: &self.materials,
            periodic: self.is_periodic(),
            paired: self.pairs.materials() > 0,
            pairs: &self.pairs,
        }
    }

    /// Write displacements and critical stretches into the records.
    fn pack(&self, u: &Field<D>, moved: &mut [f64]) {
        let kernel = Pack::<D> {
            u: std::array::from_fn(|a| &*u[a]),
            critical: &self.critical,
            moved: Shared(moved.as_mut_ptr()),
        };
        run_blocks(self.simd, &kernel, self.sums.blocks());
    }

    fn share(&mut self) {
        let alive = Shared(self.alive.as_mut_ptr());
        let fields = Shared(self.fields.as_mut_ptr());
        let kernel = Share::<D, W> {
            view: self.view_of(&self.moved, alive, fields),
        };
        run_blocks(self.simd, &kernel, self.sums.blocks());
    }

    fn sweep<const FULL: bool>(
        &mut self,
        body: &Body<D>,
        f: &mut Field<D>,
        motion: Option<Motion<D>>,
    ) -> Tally {
        let alive = Shared(self.alive.as_mut_ptr());
        let fields = Shared(self.fields.as_mut_ptr());
        let next = Shared(self.next.as_mut_ptr());
        let kernel = Forces::<D, W, FULL> {
            view: self.view_of(&self.moved, alive, fields),
            f: std::array::from_fn(|a| Shared(f[a].as_mut_ptr())),
            next,
            toughness: &self.toughness,
            material: &body.material,
            motion,
        };
        self.tallies.fold(self.simd, &kernel, Tally::add_assign)
    }

    fn is_periodic(&self) -> bool {
        self.period.iter().any(|p| *p > 0.0)
    }

    /// n and 1/m at a slot, from `β/m`.
    fn per_weight(&self, body: &Body<D>, slot: usize) -> [f64; 2] {
        match &self.point_constants {
            PointConstants::Solid(s) => {
                let s = s[body.material_of(slot)];
                [s.n, self.fields[2 * slot + 1] / s.beta]
            }
            PointConstants::None | PointConstants::PerMaterial(_) => [0.0; 2],
        }
    }

    /// Σ over the bonds of a row whose bit is set in `bits`, in the row's order.
    fn sum(&self, row: usize, bits: &[u8], of: impl Fn(usize) -> f64) -> f64 {
        self.list
            .partners(row)
            .filter(|(line, _)| bits[*line] >> (row % TILE) & 1 == 1)
            .map(|(_, j)| of(j))
            .sum()
    }

    /// Energies of all points, with `Σ k r0² s` in place of the dilatation and `Σ k r0²` of what is whole.
    fn sums(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies) {
        let mut moved = vec![0.0; 4 * body.len];
        self.pack(u, &mut moved);
        self.sums_of(body, self.view(&moved), out);
    }

    /// The same of what a view shows.
    fn sums_of(&self, body: &Body<D>, view: View<D, W>, out: &mut PointEnergies) {
        out.zeros(body.len);
        let kernel = Energies {
            view,
            fields: Some(EnergyFields {
                strain: Shared(out.strain.as_mut_ptr()),
                repulsion: Shared(out.repulsion.as_mut_ptr()),
                share: Shared(out.dilatation.as_mut_ptr()),
                weight: Shared(out.whole.as_mut_ptr()),
            }),
        };
        self.sums.sum(self.simd, &kernel);
    }

    /// `P / Σ k r0² s` at a slot.
    fn pressure_factor(&self, i: usize) -> f64 {
        match self.pressure.get(i) {
            Some(q) => *q,
            None => self.law.pressure_factor(self.fields[2 * i + 1]),
        }
    }
}

impl<const D: usize, W: Law> Interaction<D> for ListInteraction<D, W> {
    fn made_for(&self) -> Identity {
        self.body
    }

    fn family(&self) -> &'static str {
        "list"
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        f: &mut Field<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergies>,
    ) -> Tally {
        let mut moved = std::mem::take(&mut self.moved);
        self.pack(u, &mut moved);
        self.moved = moved;
        if let Some(seen) = seen {
            self.sums(body, u, seen);
            if W::SHARES {
                for &slot in &body.slots {
                    let i = slot as usize;
                    self.fields[2 * i] = self.pressure_factor(i) * seen.dilatation[i];
                }
            }
            seen.dilate::<W, D>(body, |i| self.per_weight(body, i));
        } else if W::SHARES {
            self.share();
        }
        let motion = sweep.motion();
        let total = if self.critical.is_empty() {
            self.sweep::<false>(body, f, motion)
        } else {
            self.sweep::<true>(body, f, motion)
        };
        if motion.is_some() && !self.critical.is_empty() {
            std::mem::swap(&mut self.critical, &mut self.next);
        }
        total
    }

    unsafe fn energy_unchecked(&mut self, _: &Body<D>, u: &Field<D>) -> [f64; 2] {
        let mut moved = std::mem::take(&mut self.moved);
        self.pack(u, &mut moved);
        self.moved = moved;
        let kernel = Energies {
            view: self.view(&self.moved),
            fields: None,
        };
        self.sums.sum(self.simd, &kernel)
    }

    unsafe fn observe_unchecked(&self, body: &Body<D>, u: &Field<D>, out: &mut PointEnergies) {
        self.sums(body, u, out);
        out.dilate::<W, D>(body, |i| self.per_weight(body, i));
    }

    fn observe_gradient(&self, body: &Body<D>, gradient: &[[f64; D]; D], out: &mut PointEnergies) {
        self.check(body, &[]);
        let images = Images::new(self);
        let mut moved = vec![0.0; images.reference.len()];
        for (u, x) in moved.chunks_mut(4).zip(images.reference.chunks(4)) {
            u[..D].copy_from_slice(&along(gradient, x));
        }
        self.sums_of(body, images.view(self, &moved), out);
        out.dilate::<W, D>(body, |i| self.per_weight(body, i));
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        if W::SHARES {
            // the pressures of this state
            self.forces(body, u, &mut zeros(body.len), Sweep::Hold, None);
        }
        let view = self.view(&self.moved);
        let field = |n: usize, slot: usize| self.fields.get(2 * slot + n).copied().unwrap_or(0.0);
        for (row, &i) in self.list.rows.iter().enumerate() {
            let i = i as usize;
            for (line, j) in self.list.partners(row) {
                if self.alive[line] >> (row % TILE) & 1 == 0 {
                    continue;
                }
                let (xi, share) = view.constant(i, j);
                let mut k = share / xi.iter().map(|x| x * x).sum::<f64>();
                let mut fields = [i, j].map(|s| [field(0, s), field(1, s)]);
                if view.paired {
                    let pair = self.pairs.get(body.material_of(i), body.material_of(j));
                    k *= pair.stiffness;
                    fields.iter_mut().for_each(|f| f[0] *= pair.ratio());
                }
                let mut tangent = BondTangent::of_law(
                    self.law,
                    [i, j],
                    k,
                    BondFactors::ONE,
                    xi,
                    std::array::from_fn(|a| u[a][j] - u[a][i]),
                    fields,
                );
                if view.paired && W::SHARES {
                    // the scalar is that of unit constants
                    let pair = self.pairs.get(body.material_of(i), body.material_of(j));
                    tangent.share = tangent.share.map(|x| x / pair.stiffness);
                    tangent.pull = tangent.pull.map(|p| p.map(|x| x * pair.ratio()));
                }
                visit(tangent);
            }
        }
    }

    fn gain(&self, slot: usize) -> f64 {
        if W::SHARES {
            self.pressure_factor(slot)
        } else {
            0.0
        }
    }

    fn each_force(
        &mut self,
        body: &Body<D>,
        u: &Field<D>,
        visit: &mut dyn FnMut(BondForce<D>),
    ) -> bool {
        self.check(body, &[u]);
        let mut moved = std::mem::take(&mut self.moved);
        self.pack(u, &mut moved);
        self.moved = moved;
        if W::SHARES {
            self.share();
        }
        let view = self.view(&self.moved);
        for (row, &i) in self.list.rows.iter().enumerate() {
            let i = i as usize;
            for (line, j) in self.list.partners(row) {
                let alive = self.alive[line] >> (row % TILE) & 1 == 1;
                let (pull, y) = view.pull_of(i, j, alive);
                if pull != 0.0 {
                    let force = y.map(|c| pull * c);
                    visit(BondForce { i, j, y, force });
                }
            }
        }
        true
    }

    fn each_bond(&self, _: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D], BondState)) {
        let view = self.view(&self.moved);
        for (row, &i) in self.list.rows.iter().enumerate() {
            for (line, j) in self.list.partners(row).filter(|(_, j)| i as usize <= *j) {
                let state = if self.alive[line] >> (row % TILE) & 1 == 1 {
                    BondState::Whole
                } else {
                    BondState::Broken
                };
                visit(i as usize, j, view.constant(i as usize, j).0, state);
            }
        }
    }

    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        for (row, &i) in self.list.rows.iter().enumerate() {
            let volume = |j| body.volume.at(j);
            let family = self.sum(row, &self.list.present, volume);
            let whole = self.sum(row, &self.alive, volume);
            out[i as usize] = if family == 0.0 {
                0.0
            } else {
                1.0 - whole / family
            };
        }
    }

    fn cut(
        &mut self,
        body: &Body<D>,
        kind: CrackKind,
        crosses: &(dyn Fn([f64; D], [f64; D]) -> bool + Sync),
    ) -> u64 {
        let mut cut = vec![];
        let view = self.view(&self.moved);
        for (row, &i) in self.list.rows.iter().enumerate() {
            let x = body.position(i as usize);
            let from: [f64; D] = std::array::from_fn(|a| x[a]);
            for (line, j) in self.list.partners(row) {
                if self.alive[line] >> (row % TILE) & 1 == 0 {
                    continue;
                }
                let (xi, _) = view.constant(i as usize, j);
                let to = body.position(j);
                let to: [f64; D] = std::array::from_fn(|a| to[a]);
                // a bond through a periodic face is in two places; either end must see the same
                if crosses(from, std::array::from_fn(|a| from[a] + xi[a]))
                    || (self.is_periodic() && crosses(std::array::from_fn(|a| to[a] - xi[a]), to))
                {
                    cut.push((line, 1u8 << (row % TILE)));
                }
            }
        }
        for (line, bit) in &cut {
            self.alive[*line] &= !bit;
            if kind == CrackKind::Absent {
                self.list.present[*line] &= !bit;
            }
        }
        if kind == CrackKind::Absent {
            self.list.directed -= cut.len() as u64;
        }
        cut.len() as u64
    }

    fn prepare(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        match &self.point_constants {
            PointConstants::None => {}
            PointConstants::PerMaterial(c) => {
                for (slot, field) in self.fields.chunks_mut(2).enumerate() {
                    field[0] = c[body.material_of(slot)];
                }
            }
            PointConstants::Solid(solids) => {
                let of = |s: usize| solids[body.material_of(s)];
                let view = self.view(&self.moved);
                let mut per_m = vec![0.0; body.len];
                for (row, &i) in self.list.rows.iter().enumerate() {
                    let i = i as usize;
                    let m = self.sum(row, &self.alive, |j| view.constant(i, j).1);
                    if m > 0.0 {
                        per_m[i] = of(i).beta / m;
                    }
                }
                let mixed = solids.iter().any(|s| s.ratio() != solids[0].ratio());
                let ratio = |(s, b): (usize, &f64)| of(s).ratio() * b * b;
                if mixed {
                    self.pressure = per_m.iter().enumerate().map(ratio).collect();
                }
                for (field, b) in self.fields.chunks_mut(2).zip(per_m) {
                    field.copy_from_slice(&[0.0, b]);
                }
            }
        }
    }

    fn directed_bonds(&self) -> u64 {
        self.list.directed
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        let row = self.list.row(slot);
        self.sum(row, &self.list.present, |_| 1.0) as usize
    }

    fn near_horizon(&self) -> u64 {
        self.list.near_horizon
    }

    fn point_field(&self, field: usize, slot: usize) -> f64 {
        self.fields.get(2 * slot + field).copied().unwrap_or(0.0)
    }

    fn in_family(&self, _: &Body<D>, i: usize, j: usize) -> bool {
        self.list.partners(self.list.row(i)).any(|(_, k)| k == j)
    }

    fn columns(&self) -> Vec<Declaration> {
        history::columns(!self.critical.is_empty())
    }

    fn read_column(&self, body: &Body<D>, _: &Field<D>, name: &str, out: &mut Vec<f64>) -> bool {
        match name {
            history::WHOLE => {
                out.clear();
                for row in 0..self.list.rows.len() {
                    let bit = |line: usize| f64::from(self.alive[line] >> (row % TILE) & 1);
                    out.extend(self.list.partners(row).map(|(line, _)| bit(line)));
                }
                true
            }
            _ => history::read_critical(body, &self.critical, name, out),
        }
    }

    fn write_column(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        if name != history::WHOLE {
            return history::write_critical(body, &mut self.critical, name, values);
        }
        let bonds = (0..self.list.rows.len()).flat_map(|row| {
            self.list
                .partners(row)
                .map(move |(line, _)| (line, row % TILE))
        });
        let bonds: Vec<_> = bonds.collect();
        if bonds.len() != values.len() {
            return false;
        }
        for ((line, lane), value) in bonds.into_iter().zip(values) {
            let bit = 1 << lane;
            match *value != 0.0 && self.list.present[line] & bit != 0 {
                true => self.alive[line] |= bit,
                false => self.alive[line] &= !bit,
            }
        }
        true
    }

    fn memory(&self) -> (&[u8], &[f64]) {
        (&self.alive, &self.critical)
    }

    fn bytes(&self) -> usize {
        let words = self.reference.len()
            + self.moved.len()
            + self.fields.len()
            + self.pressure.len()
            + self.critical.len()
            + self.next.len();
        self.list.bytes() + self.alive.len() + self.materials.len() + self.pairs.bytes() + 8 * words
    }
}
