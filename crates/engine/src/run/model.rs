//! The running model: a system, the stages that move it, and what may be asked of it.

use super::names::Names;
use super::probes::state::Probe;
use super::stages::Stages;
use super::state_hash::hashed;
use super::system::System;
use super::{Info, Now, Simulation, Summary};
use crate::columns::Declaration;
use crate::error::RunError;
use crate::fracture::fragments::Fragments;
use crate::observe::{Column, Ledger, ProbeColumn, Snapshot, StateHash};

/// A model in D dimensions.
pub struct Model<const D: usize> {
    pub(super) system: System<D>,
    pub(super) stages: Stages<D>,
    /// Were columns written since the forces were found?
    pub(super) stale: bool,
    pub(super) probes: Vec<Probe>,
    pub(super) names: Names<D>,
    /// Boltzmann's constant (energy / temperature).
    pub(super) boltzmann: f64,
}

impl<const D: usize> Model<D> {
    /// Bring velocities to the whole step.
    pub(super) fn finish(&mut self) {
        self.stages.now.finish(&mut self.system);
    }

    /// Ids of the points of a set.
    pub(super) fn members_of(&self, set: &str) -> Option<Vec<u32>> {
        if set == "all" {
            return Some((0..self.system.body.points() as u32).collect());
        }
        let named = self.names.sets.iter().find(|(name, _)| name == set);
        named.map(|(_, ids)| ids.clone())
    }
}

impl<const D: usize> Simulation for Model<D> {
    fn info(&self) -> &Info {
        &self.system.info
    }

    fn start(&mut self, bonds: bool) {
        self.stages.now.start(&mut self.system, bonds);
        self.stale = false;
    }

    fn step(&mut self) -> Result<(), RunError> {
        self.next_stage()?;
        if std::mem::take(&mut self.stale) {
            self.stages.now.changed(&mut self.system);
        }
        self.stages.now.step(&mut self.system)
    }

    fn stop_when(&mut self, stop: fn() -> bool) {
        self.system.stop = stop;
    }

    fn now(&self) -> Now {
        Now {
            step: self.system.clock.step(),
            time: self.system.clock.time(),
            clock: self.system.clock.shown(),
        }
    }

    fn ledger(&mut self) -> Result<Ledger, RunError> {
        self.finish();
        self.system.balance()
    }

    fn columns(&mut self) -> Vec<Declaration> {
        self.look().declared()
    }

    fn column(&mut self, name: &str) -> Option<Column> {
        self.columns_of([name].into_iter()).pop()
    }

    fn state_hash(&mut self) -> StateHash {
        self.finish();
        hashed(&mut self.system)
    }

    fn set_column(&mut self, name: &str, values: &[f64]) -> bool {
        self.store(name, values)
    }

    fn probe_columns(&self) -> Vec<ProbeColumn> {
        let each = self.probes.iter();
        each.flat_map(|p| p.columns().iter().cloned()).collect()
    }

    fn measure(&mut self) -> Vec<f64> {
        self.probed()
    }

    fn snapshot(&mut self, fields: &[&str], bonds: bool) -> Snapshot {
        self.record(fields, bonds)
    }

    fn read(&mut self, name: &str, component: usize, first: usize, out: &mut [f64]) -> bool {
        let vector = match name {
            "reference" => {
                self.system.body.coordinates(first, component, out);
                return true;
            }
            "displacement" => &self.system.u,
            "velocity" => {
                self.finish();
                &self.system.v
            }
            "force_density" => &self.system.f,
            "volume" | "density" => {
                let (volume, density) = (self.system.body.volume(), self.system.body.density());
                let values = if name == "volume" { volume } else { density };
                for (x, &s) in out.iter_mut().zip(&self.system.body.slots()[first..]) {
                    *x = values.at(s as usize);
                }
                return true;
            }
            _ => return false,
        };
        match vector.get(component) {
            Some(values) => {
                for (x, &s) in out.iter_mut().zip(&self.system.body.slots()[first..]) {
                    *x = values[s as usize];
                }
            }
            None => out.fill(0.0),
        }
        true
    }

    fn write(&mut self, name: &str, component: usize, first: usize, values: &[f64]) -> bool {
        self.finish();
        let vector = match name {
            "displacement" => {
                self.system.invalidate_neighbours();
                self.system.watch.forget_virials();
                &mut self.system.u
            }
            "velocity" => &mut self.system.v,
            _ => return false,
        };
        if let Some(component) = vector.get_mut(component) {
            for (value, &s) in values.iter().zip(&self.system.body.slots()[first..]) {
                component[s as usize] = *value;
            }
        }
        true
    }

    fn summary(&self) -> Summary {
        let accounts = &self.system.accounts;
        let rigid = self.system.applied.rigid.iter();
        Summary {
            broken: self.system.body.count(accounts.swept.broken),
            rigid_bodies: rigid.map(|i| i.rigid.center).collect(),
            diffusions: self.system.diffusion_accounts(),
            cycles: self.system.regime.cycles.then_some(accounts.cycles),
            solved: self.stages.solved(),
            work: vec![],
        }
    }

    fn fragments(&self) -> u64 {
        Fragments::of(&self.system.body, self.system.interaction.as_ref()).count() as u64
    }

    fn members(&self, set: &str) -> Option<Vec<u32>> {
        self.members_of(set)
    }
}
