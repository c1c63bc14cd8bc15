//! The running model: its state, and what may be asked of it.

use super::accounts::state::Accounts;
use super::clock::Clock;
use super::constitutive::{ConstitutiveModels, Shelf};
use super::equilibrium::state::StaticState;
use super::faces::Faces;
use super::healing::state::Healing;
use super::implicit::state::Implicit;
use super::inertia::state::Inertia;
use super::preload::state::Preload;
use super::probes::state::Probe;
use super::transfers::state::Transfers;
use super::{Info, Simulation};
use crate::body::{Body, Field};
use crate::columns::Declaration;
use crate::condition::applied::AppliedForces;
use crate::condition::prescribed_motion::PrescribedMotion;
use crate::condition::toughness::ToughnessField;
use crate::dynamics::verlet::Verlet;
use crate::error::{BuildError, RunError};
use crate::fracture::fragments::Fragments;
use crate::interaction::{ContactForces, Fault, Interaction, PointEnergies};
use crate::observe::{Column, Ledger, Observed, ProbeColumn, Snapshot, StateHash};
use crate::space::Point;
use crate::spec::{Carriers, Quantity, Release};
use crate::statics::Solved;
use crate::transfer::{Transfer, TransferAccount};

/// A model in D dimensions.
pub struct Model<const D: usize> {
    pub(super) info: Info,
    pub(super) body: Body<D>,
    pub(super) interaction: Box<dyn Interaction<D>>,
    /// Between points that are not in each other's family.
    pub(super) contact: Option<ContactForces<D>>,
    /// `None`: that of the materials.
    pub(super) toughness: Option<ToughnessField>,
    /// `None`: what is broken stays so.
    pub(super) healing: Option<Healing>,
    pub(super) u: Field<D>,
    pub(super) v: Field<D>,
    pub(super) f: Field<D>,
    pub(super) verlet: Verlet,
    /// Where masses couple points.
    pub(super) inertia: Option<Inertia<D>>,
    pub(super) prescribed: PrescribedMotion<D>,
    pub(super) applied: AppliedForces<D>,
    /// Bound on the path of any point in the last drift (length).
    pub(super) fastest: f64,
    /// Shall the next force evaluation be watched, and what the last watched one saw.
    pub(super) watch: bool,
    pub(super) watched: Option<PointEnergies>,
    /// The same for the virial.
    pub(super) watch_virial: bool,
    pub(super) virial: Option<[f64; 6]>,
    /// The same for the virial of each slot.
    pub(super) watch_virials: bool,
    pub(super) virials: Option<Vec<[f64; 6]>>,
    /// Boltzmann's constant (energy / temperature).
    pub(super) boltzmann: f64,
    /// Laws and constants, for what is computed pair by pair.
    pub(super) constitutive: ConstitutiveModels,
    /// Observables and forces by their names.
    pub(super) shelf: Shelf,
    pub(super) probes: Vec<Probe>,
    /// Named sets of point ids.
    pub(super) sets: Vec<(String, Vec<u32>)>,
    /// Of a condensed body: where its loads act, and the named sets there.
    pub(super) carriers: Option<Carriers<D>>,
    pub(super) carrier_sets: Vec<(String, Vec<u32>)>,
    /// On what area loads act.
    pub(super) faces: Faces,
    pub(super) clock: Clock,
    /// Part of its stable step at which a body runs whose bonds become stiffer as they become shorter; `None`: its step stays as it is.
    pub(super) fraction: Option<f64>,
    /// Does `v` wait for the last half kick?
    pub(super) pending: bool,
    /// Were columns written since the forces were found?
    pub(super) stale: bool,
    /// When a bond past its critical stretch lets go.
    pub(super) release: Release,
    /// Has somebody had enough of a search for an equilibrium?
    pub(super) stop: fn() -> bool,
    pub(super) accounts: Accounts,
    /// The last forces mean nothing.
    pub(super) fault: Option<Fault>,
    /// Steps are increments of load.
    pub(super) statics: Option<StaticState<D>>,
    /// What waits for the motion, while steps are increments of the load before it.
    pub(super) preload: Option<Preload<D>>,
    /// Of the last increment before motion, where there was one.
    pub(super) loaded: Option<Solved>,
    /// Steps are implicit.
    pub(super) implicit: Option<Implicit<D>>,
    /// No step moves points.
    pub(super) stands: bool,
    /// What spreads through the bonds.
    pub(super) transfers: Transfers,
}

impl<const D: usize> Model<D> {
    /// Bytes held: body, bonds, and the state of nine numbers per slot in 3-D.
    pub(super) fn bytes(&self) -> usize {
        self.body.bytes()
            + self.interaction.bytes()
            + self.contact.as_ref().map_or(0, ContactForces::bytes)
            + self.inertia.as_ref().map_or(0, |i| i.masses.bytes())
            + 3 * D * 8 * self.body.len
            + self
                .transfers
                .all
                .iter()
                .map(Transfer::bytes)
                .sum::<usize>()
    }

    pub(super) fn refresh_images(&mut self) {
        if !self.body.images.is_empty() {
            for c in &mut self.u {
                self.body.fill_images(c);
            }
        }
    }

    pub(super) fn by_id<T>(&self, value: impl Fn(usize) -> T) -> Vec<T> {
        self.body.slots.iter().map(|&s| value(s as usize)).collect()
    }

    pub(super) fn observed_of(&self, energies: &PointEnergies) -> Observed {
        let field = |f: &[f64]| self.by_id(|i| f.get(i).copied().unwrap_or(0.0));
        Observed {
            strain: field(&energies.strain),
            repulsion: field(&energies.repulsion),
            dilatation: field(&energies.dilatation),
            whole: field(&energies.whole),
        }
    }

    pub(super) fn vectors(&self, field: &Field<D>) -> Vec<Point> {
        self.by_id(|i| std::array::from_fn(|a| if a < D { field[a][i] } else { 0.0 }))
    }

    pub(super) fn scatter(body: &Body<D>, field: &mut Field<D>, values: &[Point]) {
        for (x, &s) in values.iter().zip(&body.slots) {
            for a in 0..D {
                field[a][s as usize] = x[a];
            }
        }
    }

    /// Slots and reference positions of a set.
    pub(super) fn slots_of(
        &self,
        set: &str,
        sets: &[(String, Vec<u32>)],
    ) -> Result<(Vec<u32>, Vec<Point>), BuildError> {
        let slots: Vec<u32> = if set == "all" {
            self.body.slots.clone()
        } else {
            let Some((_, ids)) = sets.iter().find(|(n, _)| n == set) else {
                return Err(BuildError::unknown(
                    "",
                    set,
                    format!("there is no set `{set}`"),
                ));
            };
            ids.iter().map(|id| self.body.slots[*id as usize]).collect()
        };
        let points = slots
            .iter()
            .map(|s| self.body.position(*s as usize))
            .collect();
        Ok((slots, points))
    }
}

impl<const D: usize> Simulation for Model<D> {
    fn info(&self) -> &Info {
        &self.info
    }

    fn start(&mut self, bonds: bool) {
        if self.statics.is_some() {
            return self.unloaded();
        }
        self.begin(bonds);
    }

    fn step(&mut self) -> Result<(), RunError> {
        if self.clock.is_loaded() {
            self.set_in_motion()?;
        }
        self.refresh();
        if self.statics.is_some() {
            return self.increment();
        }
        if self.implicit.is_some() {
            return self.implicit_step();
        }
        if self.stands {
            return self.stand();
        }
        self.advance()
    }

    fn stop_when(&mut self, stop: fn() -> bool) {
        self.stop = stop;
    }

    fn step_number(&self) -> u64 {
        self.clock.step()
    }

    fn time(&self) -> f64 {
        self.clock.time()
    }

    fn clock(&self) -> f64 {
        self.clock.shown()
    }

    fn ledger(&mut self) -> Result<Ledger, RunError> {
        self.balance()
    }

    fn columns(&mut self) -> Vec<Declaration> {
        self.declared()
    }

    fn column(&mut self, name: &str) -> Option<Column> {
        self.columns_of([name].into_iter()).pop()
    }

    fn state_hash(&mut self) -> StateHash {
        self.hashed()
    }

    fn set_column(&mut self, name: &str, values: &[f64]) -> bool {
        self.store(name, values)
    }

    fn probe_columns(&self) -> Vec<ProbeColumn> {
        Model::probe_columns(self)
    }

    fn measure(&mut self) -> Vec<f64> {
        Model::measure(self)
    }

    fn snapshot(&mut self, fields: &[&str], bonds: bool) -> Snapshot {
        self.record(fields, bonds)
    }

    fn broken(&self) -> u64 {
        self.accounts.broken
    }

    fn fragments(&self) -> u64 {
        Fragments::of(&self.body, self.interaction.as_ref()).count() as u64
    }

    fn set_displacements(&mut self, u: &[Point]) {
        self.finish();
        self.virial = None;
        self.virials = None;
        Self::scatter(&self.body, &mut self.u, u);
        self.refresh_images();
        self.look_again();
    }

    fn set_velocities(&mut self, v: &[Point]) {
        self.finish();
        Self::scatter(&self.body, &mut self.v, v);
    }

    fn members(&self, set: &str) -> Option<Vec<u32>> {
        if set == "all" {
            return Some((0..self.body.points() as u32).collect());
        }
        let named = self.sets.iter().find(|(name, _)| name == set);
        named.map(|(_, ids)| ids.clone())
    }

    fn indenters(&self) -> Vec<Point> {
        self.applied.rigid.iter().map(|i| i.rigid.center).collect()
    }

    fn transfers(&self) -> Vec<(Quantity, TransferAccount)> {
        self.transfer_accounts()
    }

    fn cycles(&self) -> Option<f64> {
        let options = self.statics.as_ref().map(|s| s.options);
        options.and_then(|o| o.cycles).map(|_| self.accounts.cycles)
    }

    fn solved(&self) -> Option<Solved> {
        let implicit = self.implicit.as_ref().map(|i| &i.equations);
        let now = self.statics.as_ref().or(implicit).map(|s| s.solved);
        now.or(self.loaded)
    }
}
