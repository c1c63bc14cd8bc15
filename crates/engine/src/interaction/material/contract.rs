//! What every [`Interaction`] answers.

use super::MaterialInteraction;
use super::tangents::Tangents;
use crate::body::{Body, FieldView, FieldViewMut, Identity};
use crate::columns::Declaration;
use crate::error::BuildError;
use crate::interaction::bonds::family::Family;
use crate::interaction::{
    BondForce, BondStatus, BondTangent, Interaction, PointEnergiesMut, Sweep, Tally, Wearing,
};
use crate::law::BondFactors;
use crate::spec::{CrackKind, Cycles};
use crate::state::Archive;

impl<const D: usize, F: Family<D>> Interaction<D> for MaterialInteraction<D, F> {
    fn made_for(&self) -> Identity {
        self.bonds.body
    }

    fn family(&self) -> &'static str {
        self.bonds.kind
    }

    unsafe fn forces_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        f: FieldViewMut<D>,
        sweep: Sweep<D>,
        seen: Option<&mut PointEnergiesMut>,
    ) -> Tally {
        self.evolve(body, u, f, sweep.motion(), seen)
    }

    /// How stiff its points are then.
    fn begin_steps(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        self.bonds.begin_stiffness(body, &*self.law);
    }

    fn shortest(&mut self, body: &Body<D>, u: FieldView<D>) -> f64 {
        self.check(body, &[u]);
        // of the largest frequency, which goes with the root of the stiffness
        let torn = self.bonds.stiffened.sqrt().recip();
        match self.bonds.law.stiffens {
            true => torn * (1.0 - self.bonds.shortest(u)).max(0.0).sqrt(),
            false => torn,
        }
    }

    unsafe fn energy_unchecked(&mut self, body: &Body<D>, u: FieldView<D>) -> [f64; 2] {
        let room = self.take_room(u, self.bonds.step);
        let sums = self.energies(body, u, &room, None);
        self.bonds.room = room;
        sums
    }

    unsafe fn observe_unchecked(
        &self,
        body: &Body<D>,
        u: FieldView<D>,
        out: &mut PointEnergiesMut,
    ) {
        self.seen(body, u, &self.look_room(u), out);
    }

    fn observe_gradient(
        &self,
        body: &Body<D>,
        gradient: &[[f64; D]; D],
        out: &mut PointEnergiesMut,
    ) {
        self.check(body, &[]);
        self.strained(body, gradient, out);
    }

    unsafe fn tangents_unchecked(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        let tangents = Tangents {
            law: &*self.law,
            bonds: &self.bonds,
            constants: &self.constants().constants,
            u,
        };
        tangents.each(body, visit);
    }

    fn each_bond(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D], BondStatus)) {
        self.bonds.each_bond(body, visit);
    }

    fn each_broken(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        self.bonds.each_broken(body, visit);
    }

    fn each_gone(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        self.bonds.each_broken(body, visit);
    }

    fn stress_borne(&mut self, body: &Body<D>, u: FieldView<D>) -> Option<Vec<f64>> {
        self.check(body, &[u]);
        self.stress(body, u)
    }

    fn mend(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        heals: &dyn Fn(usize, usize, f64) -> bool,
    ) -> Option<u64> {
        self.check(body, &[u]);
        let new = self.bonds.ends_by_bonds();
        new.then(|| self.bonds.mend(body, u, heals, &*self.law))
    }

    fn work_borne(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(usize, usize, [f64; D], f64),
    ) -> bool {
        self.check(body, &[u]);
        self.works(body, u, visit)
    }

    fn bond_limit(&self, ends: [usize; 2], xi: &[f64; D], critical: [f64; 2]) -> f64 {
        self.bonds.bond_limit(ends, xi, critical)
    }

    fn each_force(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(BondForce<D>),
    ) -> bool {
        self.check(body, &[u]);
        self.each_pull(body, u, visit);
        true
    }

    fn damage(&self, body: &Body<D>, out: &mut [f64]) {
        self.bonds.damage(body, out);
    }

    fn cut(
        &mut self,
        body: &Body<D>,
        kind: CrackKind,
        crosses: &(dyn Fn([f64; D], [f64; D]) -> bool + Sync),
    ) -> u64 {
        self.bonds.cut(body, kind, crosses, |_, _| true, &*self.law)
    }

    fn scale_bonds(
        &mut self,
        _: &Body<D>,
        _: &dyn Fn(usize, usize, [i32; D]) -> BondFactors<f64>,
    ) -> Result<(), BuildError> {
        Err(BuildError::unsupported(
            "bonds",
            "factors of bonds and corrections of surfaces multiply what a bond pulls by its own stretch and its ends' dilatation; the bonds of this body do more: they remember (work, stress or strain that they break by, plastic flow), expand, or answer to tensors",
        )
        .help("leave both out, or take a law with fused kernels (pmb, lps, lps_as_typed, eam_like) without expansion, which breaks by critical_stretch or energy"))
    }

    fn prepare(&mut self, body: &Body<D>) {
        self.check(body, &[]);
        self.bonds.prepared = true;
        self.bonds.look(body, &*self.law);
    }

    fn directed_bonds(&self) -> u64 {
        self.bonds.directed
    }

    fn family_size(&self, _: &Body<D>, slot: usize) -> usize {
        self.bonds.family_size(slot)
    }

    fn near_horizon(&self) -> u64 {
        self.bonds.near_horizon
    }

    fn in_family(&self, body: &Body<D>, i: usize, j: usize) -> bool {
        self.bonds.family.joins(body, i, j)
    }

    fn expand(&mut self, body: &Body<D>, strain: &[f64]) -> bool {
        self.check(body, &[]);
        assert_eq!(strain.len(), body.len, "a strain for each slot");
        self.bonds.expand(strain)
    }

    fn add_stress_across(&mut self, body: &Body<D>, u: FieldView<D>, trace: &mut [f64]) -> bool {
        self.check(body, &[u]);
        assert_eq!(trace.len(), body.len, "a number for each slot");
        self.bonds.held.is_empty() || self.add_across(body, u, trace)
    }

    fn warm(&mut self, body: &Body<D>, above: &[f64]) -> bool {
        self.check(body, &[]);
        assert_eq!(above.len(), body.len, "a temperature for each slot");
        self.bonds.warm(body, above)
    }

    fn read_warmth(&self, body: &Body<D>, above: &mut [f64]) {
        self.check(body, &[]);
        assert_eq!(above.len(), body.len, "a temperature for each slot");
        self.bonds.read_warmth(body, above);
    }

    fn last(&mut self, step: f64) {
        self.bonds.step = step;
    }

    fn wearing(&self, body: &Body<D>, u: FieldView<D>, load: &Cycles) -> Option<Vec<Wearing>> {
        self.check(body, &[u]);
        self.bonds.wearing(body, u, load)
    }

    fn wear(&mut self, bonds: &mut dyn Iterator<Item = Wearing>, cycles: f64) {
        self.bonds.wear(bonds, cycles);
    }

    fn columns(&self) -> Vec<Declaration> {
        self.bonds.declared()
    }

    fn read_column(&self, body: &Body<D>, u: FieldView<D>, name: &str, out: &mut Vec<f64>) -> bool {
        self.check(body, &[u]);
        self.bonds.read_named(body, name, &*self.law, out)
    }

    fn write_column(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        self.check(body, &[]);
        self.bonds.write_named(body, name, values, &*self.law)
    }

    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        self.bonds.archive(body, archive, &*self.law);
    }

    fn each_directed(
        &self,
        body: &Body<D>,
        _: &str,
        visit: &mut dyn FnMut(usize, usize, [f64; D]),
    ) {
        self.bonds.each_directed(body, visit);
    }

    fn memory(&self) -> (&[u8], &[f64]) {
        (&self.bonds.alive, &self.bonds.critical)
    }

    fn bytes(&self) -> usize {
        self.bonds.bytes()
    }
}
