//! What every law on every family can do: the contract between bonds and those who move, load and watch a body.

use super::bond::sum_of_virials;
use super::bonds::AnyBonds;
use super::{
    BondFatigue, BondStatus, Crosses, EachBond, EachForce, EachPair, EachTangent, FactorsOf,
    Gradient, Heals, PointEnergiesMut, Sweep, Tally, add_virial, along, history,
};
use crate::body::{Body, FieldView, FieldViewMut, Identity, view};
use crate::columns::{Declaration, On};
use crate::error::BuildError;
use crate::law::BondFactors;
use crate::spec::{CrackKind, Cycles};
use crate::state::Archive;

/// A law on a family, made for one body.
///
/// What kernels read and write without looking is checked here, once for each sweep: methods that take a body refuse another one
/// than that of [`made_for`](Interaction::made_for), and fields of another length.
pub trait Interaction<const D: usize>: Send + Sync {
    /// The body that it was made for.
    fn made_for(&self) -> Identity;

    /// Its bonds, where they are those of any law: what is asked of bonds below they answer, unless the interaction does. Else it has none but
    /// those that it says itself.
    fn bonds(&self) -> Option<&dyn AnyBonds<D>> {
        None
    }

    /// The same, to be changed.
    fn bonds_mut(&mut self) -> Option<&mut dyn AnyBonds<D>> {
        None
    }

    /// Bonds are whole that were not, or the other way round.
    fn look_bits(&mut self) {}

    /// Critical values are others.
    fn look_critical(&mut self, _body: &Body<D>) {}

    /// Does a sweep over this body with these fields stay inside what was made?
    ///
    /// # Panics
    /// If the body is another one, or a field has another length than it.
    fn check(&self, body: &Body<D>, fields: &[FieldView<D>]) {
        assert!(
            body.identity == self.made_for(),
            "an interaction made for another body: make one for this body"
        );
        let columns = fields.iter().flat_map(|f| f.iter());
        if let Some(column) = { columns }.find(|c| c.len() != body.len) {
            panic!(
                "a field of {} slots, the body has {}: fields come from `at_rest` or `zeros(body.len())`",
                column.len(),
                body.len
            );
        }
    }

    /// Write the force density of all bonds (and repulsion inside the family) into `f`, slot by slot; advance the
    /// bonds' memory if asked to. Images of `u` must be fresh. What is `seen` are the energies of the bonds that are
    /// whole before any breaks, with the memory that they have afterwards, as [observe](Interaction::observe) gives them, at less cost.
    ///
    /// # Panics
    /// If the body is another one than that of [`made_for`](Interaction::made_for), or a field or what is seen does not have its length.
    fn forces(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        self.check(body, &[u, view(&f)]);
        if let Sweep::Evolve { v, .. } = sweep {
            self.check(body, &[v]);
        }
        if let Some(seen) = &seen {
            seen.check(body.len);
        }
        // SAFETY: just checked
        unsafe { self.forces_unchecked(body, u, f, sweep, seen) }
    }

    /// [`forces`](Interaction::forces).
    ///
    /// # Safety
    /// The body and all fields pass [`check`](Interaction::check), and what is seen [its own](PointEnergiesMut::check).
    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally;

    /// What the next [`forces`](Interaction::forces) with the same arguments can do before the copies of other ranks' points are there: it leaves that out. By
    /// itself nothing.
    ///
    /// # Panics
    /// As for [`forces`](Interaction::forces).
    fn begin_forces(&mut self, _: &Body<D>, _u: FieldView<D>, _f: FieldViewMut<D>, _: Sweep<D>) {}

    /// What is on its way while it works ([`begin_forces`](Interaction::begin_forces)): messages of a sweep in which bonds break, and bytes of each copy.
    fn meanwhile(&self) -> [usize; 2] {
        [0; 2]
    }

    /// Strain energy of bonds and energy of repulsion inside the family at `u` (energy), without allocating.
    ///
    /// # Panics
    /// As for [`forces`](Interaction::forces).
    fn energy(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        self.check(body, &[u]);
        // SAFETY: just checked
        unsafe { self.energy_unchecked(body, u) }
    }

    /// [`energy`](Interaction::energy).
    ///
    /// # Safety
    /// The body and the field pass [`check`](Interaction::check).
    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2];

    /// Energy densities and dilatation of all points at `u`.
    ///
    /// # Panics
    /// As for [`forces`](Interaction::forces).
    fn observe(&self, body: &Body<D>, u: FieldView<D>, out: &mut PointEnergiesMut) {
        self.check(body, &[u]);
        out.check(body.len);
        // SAFETY: just checked
        unsafe { self.observe_unchecked(body, u, out) }
    }

    /// [`observe`](Interaction::observe).
    ///
    /// # Safety
    /// The body and the field pass [`check`](Interaction::check), and `out` [its own](PointEnergiesMut::check).
    unsafe fn observe_unchecked(&self, body: &Body<D>, u: FieldView<D>, out: &mut PointEnergiesMut);

    /// Energy densities and dilatation of all points under a homogeneous displacement gradient `∂u_a/∂x_b`, so small that
    /// nobody gets other neighbours; periodic images move like everything else.
    fn observe_gradient(&self, body: &Body<D>, gradient: &Gradient<D>, out: &mut PointEnergiesMut) {
        // copies have displacements of their own
        let mut u = body.at_rest();
        let points = body.slots.iter().map(|s| *s as usize);
        for s in points.chain(body.exchange.copies()) {
            let moved = along(gradient, &body.position(s));
            (0..D).for_each(|a| u[a][s] = moved[a]);
        }
        self.observe(body, view(&u), out);
    }

    /// Is it a potential between atoms, per atom and not per volume?
    fn is_potential(&self) -> bool {
        false
    }

    /// Does it have terms of more than two atoms, so that the tangents of its pairs are not along them?
    fn has_many_body(&self) -> bool {
        false
    }

    /// Every directed bond that is whole with its tangent at `u`, images of which are fresh, in order of slots. Repulsion inside
    /// the family is left out. The scalars' gains are in [`Interaction::gain`] afterwards.
    ///
    /// # Panics
    /// As for [`forces`](Interaction::forces).
    fn tangents(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachTangent<D>) {
        self.check(body, &[u]);
        // SAFETY: just checked
        unsafe { self.tangents_unchecked(body, u, visit) }
    }

    /// [`tangents`](Interaction::tangents).
    ///
    /// # Safety
    /// The body and the field pass [`check`](Interaction::check).
    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut EachTangent<D>,
    );

    /// `∂p_i / ∂(Σ share)` of a slot, since the last call of [`Interaction::tangents`].
    fn gain(&self, _slot: usize) -> f64 {
        0.0
    }

    /// Critical values of `e` (see [`history`](super::history)) of bonds between bodies, by slot for each interface; NaN where it has no point.
    fn criticals_between(&self) -> Vec<Vec<f64>> {
        vec![]
    }

    /// Every undirected bond that the reference family ever had once: slots i < j (images resolved), reference vector ξ.
    fn each_bond(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        if let Some(bonds) = self.bonds() {
            bonds.each_bond(body, visit);
        }
    }

    /// The bonds of [`each_bond`](Interaction::each_bond), seen from each of their points that are here: slots of the point and of its partner, reference vector
    /// ξ. The partners of a point come in the same order on any number of ranks.
    fn each_partner(&self, body: &Body<D>, visit: &mut EachBond<D>) {
        match self.bonds() {
            Some(bonds) => bonds.each_partner(body, visit),
            None => self.each_bond(body, &mut |i, j, xi, status| {
                visit(i, j, xi, status);
                visit(j, i, xi.map(|x| -x), status);
            }),
        }
    }

    /// Of [`each_partner`](Interaction::each_partner) those that are not whole and whose points repel inside the family: not those of interfaces. One from a point to its
    /// own image may be visited once.
    fn each_broken(&self, body: &Body<D>, visit: &mut EachPair<D>) {
        if let Some(bonds) = self.bonds() {
            return bonds.each_broken(body, visit);
        }
        self.each_partner(body, &mut |i, j, xi, state| {
            if state != BondStatus::Whole {
                visit(i, j, xi);
            }
        });
    }

    /// Broken bonds become whole again, as they were in the reference, where `heals` of their ends and their `e` (see [`history`](super::history)) at `u`,
    /// images of which are fresh; it must say the same of both directions. They remember nothing. Those of absent cracks do not. How many directed ones; `None`: what
    /// they break by is of points, or there are none.
    fn mend(&mut self, body: &Body<D>, u: FieldView<D>, heals: &Heals) -> Option<u64> {
        self.check(body, &[u]);
        let mended = self.bonds_mut()?.mend(body, u, heals)?;
        if mended > 0 {
            self.look_bits();
        }
        Some(mended)
    }

    /// Critical `e` of the bond ξ between two slots, from those of its ends; ∞: it never breaks.
    fn bond_limit(&self, _ends: [usize; 2], _xi: &[f64; D], critical: [f64; 2]) -> f64 {
        history::limit(critical[0], critical[1])
    }

    /// Von Mises stress of points over what their materials bear, by slot, where bonds break when its mean of both ends reaches 1; `None`: they break
    /// by something else. NaN of points whose body has none.
    fn stress_borne(&mut self, _body: &Body<D>, _u: FieldView<D>) -> Option<Vec<f64>> {
        None
    }

    /// Of every undirected whole bond that breaks by the work on it, `visit(i, j, ξ, part)` of the work that its force has done at `u` from rest, `½ (T_i − T_j)·η`
    /// as of a linear body, over what it bears. False: no bonds do.
    fn work_borne(
        &mut self,
        _body: &Body<D>,
        _u: FieldView<D>,
        _visit: &mut dyn FnMut(usize, usize, [f64; D], f64),
    ) -> bool {
        false
    }

    /// What enumerates the bonds: `"stencil"`, `"list"`, `"neighbours"` or `"reference"`.
    fn family(&self) -> &'static str {
        self.bonds().map_or("none", |bonds| bonds.kind())
    }

    /// Σ over pairs, of all ranks, of distance times force, xx yy zz xy xz yz (energy), positive where pairs repel; `None`: the law has no forces
    /// of single bonds.
    fn virial(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<[f64; 6]> {
        let mut points = vec![[0.0; 6]; body.len];
        let known = self.each_force(body, u, &mut |bond| {
            let factor = -0.5 * body.volume.at(bond.i);
            add_virial(&mut points[bond.i], &bond.force, &bond.y, factor);
        });
        known.then(|| sum_of_virials(body, &points))
    }

    /// Damage `1 − Σ V_j (whole) / Σ V_j (family)` per slot; 0 for points without a family.
    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        match self.bonds() {
            Some(bonds) => bonds.damage(body, out),
            None => out.fill(0.0),
        }
    }

    /// A stable step is found for the body as it is now.
    fn begin_steps(&mut self, _body: &Body<D>) {}

    /// What the stable step is of that of the body as [`begin_steps`](Interaction::begin_steps) saw it, at most 1: the least length of a whole bond over that in the reference, of laws
    /// whose bonds are the stiffer the shorter they are, and the root of the stiffness of damaged points; 1 of all others. Images of `u` must be fresh.
    ///
    /// # Panics
    /// As for [`forces`](Interaction::forces).
    fn shortest(&mut self, _body: &Body<D>, _u: FieldView<D>) -> f64 {
        1.0
    }

    /// Cut bonds whose end points satisfy `crosses`. Returns directed bonds cut. Call before the first sweep.
    fn cut(&mut self, body: &Body<D>, kind: CrackKind, crosses: &Crosses<D>) -> u64 {
        let cut = self.bonds_mut().map(|b| b.cut(body, kind, crosses));
        self.look_bits();
        cut.unwrap_or(0)
    }

    /// Multiply the parts of the force density at slot i, of its bond to slot j (an image, maybe) `cell` cells away, by
    /// `factors(i, j, cell)`; energies, and what breaking releases, follow. Weighted volumes become those of full families,
    /// critical stretches stay. Factors of several calls are multiplied. Call before the first sweep.
    fn scale_bonds(&mut self, _body: &Body<D>, _factors: &FactorsOf<D>) -> Result<(), BuildError> {
        Err(BuildError::unsupported(
            "bonds",
            "bond stiffness scaling and surface corrections are for pmb, springs, lps, lps_3d and eam_like on a lattice, and pmb in a cloud or an interface: the bonds of this body are others",
        )
        .help("take one of these on a lattice, or leave both out"))
    }

    /// Volume with which the bond along ξ acts on slot i, and its factors, where there are any.
    fn reached(
        &self,
        _body: &Body<D>,
        _i: usize,
        _xi: [f64; D],
    ) -> Option<(f64, BondFactors<f64>)> {
        None
    }

    /// Compute what depends on the family (weighted volumes); after all `Absent` cuts, before the first sweep.
    fn prepare(&mut self, _body: &Body<D>) {}

    /// How far action is from reaction, as `Soundness::asymmetry` of a linear body; given micromoduli need not be
    /// symmetric, and then there is no energy whose slope the forces are.
    fn asymmetry(&self) -> f64 {
        0.0
    }

    /// From now on bonds have the length of the reference times `1 + ε`, ε the mean of the strains of both ends, where they pull at nothing:
    /// the law answers to `(ξ + η)/(1 + ε)` in place of `ξ + η`, and its energy to nothing else. A strain for each slot, images
    /// too. False: the law knows of none, and nothing is changed.
    ///
    /// # Panics
    /// If the body is another one, or the number of strains is not that of its slots.
    fn expand(&mut self, _body: &Body<D>, _strain: &[f64]) -> bool {
        false
    }

    /// Adds the stress across a body in plane strain to `σ_xx + σ_yy` of every slot (force / area), at displacements whose images are fresh;
    /// nothing where the section is free. False: the law does not say it.
    ///
    /// # Panics
    /// If the body is another one, or the number of stresses is not that of its slots.
    fn add_stress_across(&mut self, _body: &Body<D>, _u: FieldView<D>, _trace: &mut [f64]) -> bool {
        false
    }

    /// Points have these temperatures above those of reference now, of laws that know one; a number for each slot. False: no law does.
    ///
    /// # Panics
    /// If the body is another one, or the number of temperatures is not that of its slots.
    fn warm(&mut self, _body: &Body<D>, _above: &[f64]) -> bool {
        false
    }

    /// What those temperatures are after a step that began with them, in place of the numbers of points whose law knows one.
    ///
    /// # Panics
    /// As for [`warm`](Interaction::warm).
    fn read_warmth(&self, _body: &Body<D>, _above: &mut [f64]) {}

    /// The next step lasts so long (time): forces, energies and tangents are those at its end, and the memory goes there in the next
    /// [`Sweep::Evolve`], after which time stands still again; 0: it does.
    fn last(&mut self, _step: f64) {}

    /// What is left of the lives of all directed bonds that are whole, in order of slots, and what a cycle of a load takes, under which the
    /// displacements are `u`, images of which are fresh, and whose least is a part of it. `None`: none of them wears.
    ///
    /// # Panics
    /// As for [`forces`](Interaction::forces).
    fn fatigue_of_bonds(
        &self,
        _body: &Body<D>,
        _u: FieldView<D>,
        _load: &Cycles,
    ) -> Option<Vec<BondFatigue>> {
        None
    }

    /// So many cycles pass: takes from these, which begin with those of [`fatigue_of_bonds`](Interaction::fatigue_of_bonds), one for each of its bonds. Those that are worn
    /// out break in the next sweep.
    fn accumulate_fatigue(&mut self, _bonds: &mut dyn Iterator<Item = BondFatigue>, _cycles: f64) {}

    /// Directed bonds of the reference family.
    fn directed_bonds(&self) -> u64 {
        self.bonds().map_or(0, |bonds| bonds.directed_bonds())
    }

    /// Size of the family of every slot.
    fn family_size(&self, _body: &Body<D>, slot: usize) -> usize {
        self.bonds().map_or(0, |bonds| bonds.family_size(slot))
    }

    /// Directed pairs whose distance is within round-off of the horizon, in or out, where that was counted.
    fn near_horizon(&self) -> u64 {
        self.bonds().map_or(0, |bonds| bonds.near_horizon())
    }

    /// Is the pair bonded or repelled inside the family (so that contact outside must leave it alone)?
    fn in_family(&self, body: &Body<D>, i: usize, j: usize) -> bool {
        self.bonds().is_some_and(|bonds| bonds.joins(body, i, j))
    }

    /// Columns that the law has of points and of bonds: what it remembers ([`Life::Persistent`](crate::columns::Life)) and what it
    /// answers at the displacements of now ([`Life::Derived`](crate::columns::Life)). Names are those of the field, none twice.
    fn columns(&self) -> Vec<Declaration> {
        self.bonds().map_or(vec![], |bonds| bonds.declared())
    }

    /// Writes the values of one of its [columns](Interaction::columns) into `out`: [`stored`](crate::columns::Shape::stored)
    /// numbers, of points for each slot of the body (0 where there is no point), of bonds for each directed bond of the reference
    /// family in order of slots, broken ones too. Images of `u` must be fresh. False: there is no such column, and `out` is empty.
    fn read_column(
        &self,
        body: &Body<D>,
        _u: FieldView<D>,
        name: &str,
        out: &mut Vec<f64>,
    ) -> bool {
        out.clear();
        self.bonds()
            .is_some_and(|bonds| bonds.read_named(body, name, out))
    }

    /// Sets a persistent column to values in the order in which [`read_column`](Interaction::read_column) gives them, after
    /// [`prepare`](Interaction::prepare). False: there is no such column, it follows from others, or the number of values is
    /// another; then nothing is changed.
    fn write_column(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        self.check(body, &[]);
        let bonds = self.bonds_mut();
        let known = bonds.is_some_and(|bonds| bonds.write_named(body, name, values));
        if known {
            self.look_critical(body);
            self.look_bits();
        }
        known
    }

    /// Every directed bond of one of its columns of bonds, in the order in which [`read_column`](Interaction::read_column) gives their values: the slot of its
    /// point, that of its partner (which an image is resolved to), and ξ. What has columns of bonds says it itself.
    fn each_directed(&self, body: &Body<D>, name: &str, visit: &mut EachPair<D>) {
        if let Some(bonds) = self.bonds() {
            return bonds.each_directed(body, visit);
        }
        let columns = self.columns();
        let known = columns.iter().any(|c| c.name == name && c.on == On::Bonds);
        assert!(!known, "{name} is a column of bonds that nobody enumerates");
    }

    /// Every directed bond that pulls or pushes at `u`, in order of slots, with the force density that its point gets from it: their
    /// sum is that of [`forces`](Interaction::forces) without breaking. Repulsion inside the family counts. Images of `u` must be
    /// fresh. False: the law has no forces of single bonds, and nothing is visited. Unless it says them itself they are those of its tangents, along the bond.
    fn each_force(&mut self, body: &Body<D>, u: FieldView<D>, visit: &mut EachForce<D>) -> bool {
        self.tangents(body, u, &mut |bond| visit(bond.force()));
        true
    }

    /// Passes what bonds and points remember through an archive; after reading, what follows from it is found anew.
    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        if let Some(bonds) = self.bonds_mut() {
            bonds.archive(body, archive);
        }
        if archive.loads() {
            self.look_critical(body);
            self.look_bits();
        }
    }

    /// The memory of bonds, as it is laid out: bits of whole bonds and critical values of `e`.
    fn memory(&self) -> (&[u8], &[f64]) {
        self.bonds().map_or((&[], &[]), |bonds| bonds.memory())
    }

    /// Bytes held.
    fn bytes(&self) -> usize;
}
