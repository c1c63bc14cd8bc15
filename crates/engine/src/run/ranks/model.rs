//! The part of a model that one rank has.

use super::shared::{FRAGMENT, shared};
use crate::body::{Body, Subdomain};
use crate::columns::{Declaration, On};
use crate::error::{BuildError, RunError};
use crate::fracture::fragments::Fragments;
use crate::observe::{Column, Snapshot, StateHash, Values};
use crate::run::build::made_among;
use crate::run::state_hash::hashed;
use crate::run::{Model, Options, Shelf, Simulation};
use crate::spec::Spec;
use peridyne_comm::{Comm, Traffic};
use std::sync::Arc;

/// The part of a model that one rank has. What is asked of all ranks at once is told there.
pub struct RankModel<const D: usize> {
    pub(super) model: Model<D>,
}

impl<const D: usize> RankModel<D> {
    /// All ranks come here at once, with the same spec.
    ///
    /// # Errors
    /// As of [`build`](super::build), and what ranks do not share yet. One rank says what it is, the others that it
    /// [does](crate::error::BuildErrorKind::Elsewhere).
    pub fn new(
        spec: &Spec,
        options: Options,
        shelf: &Shelf,
        comm: &Arc<Comm>,
    ) -> Result<RankModel<D>, BuildError> {
        shared(spec)?;
        let model = made_among(spec, options, shelf, Some(comm))?;
        Ok(RankModel { model })
    }

    fn body(&self) -> &Body<D> {
        &self.model.system.body
    }

    pub(super) fn subdomain(&self) -> &Subdomain {
        self.body().subdomain().expect("made of a part of a body")
    }

    /// Ids among all points of those that are here, in the order of columns.
    pub fn ids(&self) -> &[u32] {
        self.subdomain().ids()
    }

    /// Points of all ranks.
    pub fn points(&self) -> usize {
        self.subdomain().points()
    }

    /// Forces of the state that the run begins from, and what breaks by them. All ranks at once, as below.
    pub fn start(&mut self) {
        self.model.start(true);
    }

    /// One step.
    ///
    /// # Errors
    /// As of [`Simulation::step`], the same on all ranks.
    pub fn step(&mut self) -> Result<(), RunError> {
        self.model.step()
    }

    /// Columns of points of the model of all ranks.
    pub(super) fn columns(&mut self) -> Vec<Declaration> {
        let mut all = self.model.columns();
        all.retain(|c| c.on == On::Points);
        all
    }

    /// Pieces of the body of all ranks, on the first; their masses are not known.
    pub(super) fn fragments(&self) -> Option<Fragments> {
        Fragments::of_all(self.body(), self.model.system.interaction.as_ref())
    }

    /// Of the model of all ranks, on the first.
    pub(super) fn state_hash(&mut self) -> Option<StateHash> {
        self.model.finish();
        let hash = hashed(&mut self.model.system);
        self.body().is_first().then_some(hash)
    }

    /// A column of the points of all ranks, by their ids, on the first rank.
    pub(super) fn column(&mut self, name: &str) -> Option<Column> {
        if name == FRAGMENT {
            let label = self.fragments()?.label;
            let observable = self.model.names.shelf.observable(name)?;
            return Some(Column {
                declaration: observable.declaration.clone(),
                values: Values::Counts(label),
            });
        }
        let own = self
            .model
            .column(name)
            .filter(|c| c.declaration.on == On::Points)?;
        let values = whole_values(self.body(), own.values)?;
        Some(Column { values, ..own })
    }

    /// A snapshot of the points of all ranks, on the first.
    pub(super) fn snapshot(&mut self, fields: &[&str], bonds: bool) -> Option<Snapshot> {
        let own = self.model.record(&[], bonds);
        let others = fields.iter().filter(|f| **f != "displacement");
        let names = ["displacement"].into_iter().chain(others.copied());
        let columns = names.filter_map(|name| self.column(name)).collect();
        let bonds = own.bonds.map(|bonds| {
            let ends = bonds.into_iter().map(<[u32; 2]>::from).collect();
            Some(
                self.body()
                    .joined(ends)?
                    .into_iter()
                    .map(<(u32, u32)>::from)
                    .collect(),
            )
        });
        let reference = self.body().whole(1, own.reference)?;
        Some(Snapshot {
            reference,
            columns,
            bonds: bonds.flatten(),
            ..own
        })
    }

    /// Ids of the points of a set among all, on the first rank; `None`: there is no such set.
    pub(super) fn members(&self, set: &str) -> Option<Vec<u32>> {
        let own = self.model.members_of(set)?;
        let ids = own.into_iter().map(|id| self.ids()[id as usize]);
        let mut all = self.body().joined(ids.collect())?;
        all.sort_unstable();
        Some(all)
    }

    /// A component of a column that can be read so, of the points of all ranks, on the first.
    pub(super) fn read(&mut self, name: &str, component: usize) -> Option<Vec<f64>> {
        let mut own = vec![0.0; self.ids().len()];
        if !self.model.read(name, component, 0, &mut own) {
            return None;
        }
        self.body().whole(1, own)
    }

    /// As [`Simulation::write`], of points of all ranks.
    pub(super) fn write(
        &mut self,
        name: &str,
        component: usize,
        first: usize,
        values: &[f64],
    ) -> bool {
        let given = |id: &u32| values.get((*id as usize).checked_sub(first)?).copied();
        let given: Vec<Option<f64>> = self.ids().iter().map(given).collect();
        let mut done = self.model.write(name, component, 0, &[]);
        for (id, value) in given.iter().enumerate() {
            if let Some(value) = value {
                done &= self.model.write(name, component, id, &[*value]);
            }
        }
        done
    }

    /// What this rank has sent so far, and copies that it has of others' points.
    pub fn halo(&self) -> (Traffic, usize) {
        let sent = self.subdomain().comm().traffic();
        (sent, self.model.system.body.exchange().received_slots())
    }
}

/// The values of a column of all ranks' points, on the first.
fn whole_values<const D: usize>(body: &Body<D>, own: Values) -> Option<Values> {
    Some(match own {
        Values::Scalars(v) => Values::Scalars(body.whole(1, v)?),
        Values::Vectors(v) => Values::Vectors(body.whole(1, v)?),
        Values::Symmetric(v) => Values::Symmetric(body.whole(1, v)?),
        Values::Tensors(v) => Values::Tensors(body.whole(1, v)?),
        Values::Integers(v) => Values::Integers(body.whole(1, v)?),
        Values::Counts(v) => Values::Counts(body.whole(1, v)?),
    })
}
