//! The part of a model that one rank has.

use super::here::Here;
use crate::body::{Body, RunsOfIds, Subdomain};
use crate::columns::{Declaration, On};
use crate::error::{BuildError, RunError};
use crate::fracture::fragments::Fragments;
use crate::observe::{Column, Observed, PointForce, Snapshot, StateHash, Values};
use crate::run::build::made_among;
use crate::run::state_hash::hashed;
use crate::run::{
    CoSimulation, Examined, Model, Options, Registry, Seen, Simulation, Summary, Watched,
};
use crate::spec::Spec;
use peridyne_comm::{Comm, Traffic, Work};
use std::sync::Arc;
use std::time::Instant;

/// Which points of all a frame has of those of a rank: so many from a first id on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Share {
    pub first: usize,
    /// Of all ranks.
    pub points: usize,
}

/// Writes a rank's share of a frame as it was asked for, and answers what the first rank should know of it.
pub type WriteShare = fn(&str, &Snapshot, Share) -> Vec<u8>;

/// The part of a model that one rank has. What is asked of all ranks at once is told there.
pub struct RankModel<const D: usize> {
    pub(super) model: Model<D>,
    pub(super) here: Here,
    /// Steps so far, and how long they took without waits (time of the clock).
    steps: u64,
    seconds: f64,
}

impl<const D: usize> RankModel<D> {
    /// All ranks come here at once, with the same spec.
    ///
    /// # Errors
    /// As of [`build`](super::build). One rank says what it is, the others that it
    /// [does](crate::error::BuildErrorKind::Elsewhere).
    pub fn new(
        spec: &Spec,
        options: Options,
        registry: &Registry,
        comm: &Arc<Comm>,
    ) -> Result<RankModel<D>, BuildError> {
        let model = made_among(spec, options, registry, Some(comm))?;
        let here = Here::default();
        Ok(RankModel {
            model,
            here,
            steps: 0,
            seconds: 0.0,
        })
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
        let waited = |own: &Self| 1e-9 * own.subdomain().comm().traffic().waited as f64;
        let (begun, before) = (Instant::now(), waited(self));
        let made = self.model.step();
        self.seconds += begun.elapsed().as_secs_f64() - (waited(self) - before);
        self.steps += 1;
        made
    }

    /// As [`Simulation::summary`], of all ranks.
    pub(super) fn summary(&self) -> Summary {
        let own = self.seconds / self.steps.max(1) as f64;
        let all = self.body().all_of(&[self.ids().len() as f64, own]);
        let work = all.iter().map(|of| Work {
            points: of[0] as usize,
            seconds: of[1],
        });
        Summary {
            work: work.collect(),
            ..self.model.summary()
        }
    }

    /// Columns of points of the model of all ranks.
    pub(super) fn columns(&mut self) -> Vec<Declaration> {
        let mut all = self.model.columns();
        all.retain(|c| c.on == On::Points);
        all
    }

    /// Number of pieces of the body of all ranks.
    pub(super) fn fragments(&self) -> u64 {
        Fragments::of(self.body(), self.model.system.interaction.as_ref()).count() as u64
    }

    /// Of the model of all ranks, on the first.
    pub(super) fn state_hash(&mut self) -> Option<StateHash> {
        self.model.finish();
        let hash = hashed(&mut self.model.system);
        self.body().is_first().then_some(hash)
    }

    /// A column of the points of all ranks, by their ids, on the first rank.
    pub(super) fn column(&mut self, name: &str) -> Option<Column> {
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

    /// Has this rank's share of a frame written, points whose ids are in a row; what each says of it, in the order of ids, on the first.
    pub(super) fn shares(
        &mut self,
        fields: &[&str],
        (write, asked): (WriteShare, &str),
    ) -> Option<Vec<Vec<u8>>> {
        let own = self.model.record(fields, false);
        let runs = self.body().runs_of_ids(1);
        let columns = own.columns.into_iter().map(|column| Column {
            values: share_of_values(&runs, column.values),
            ..column
        });
        let frame = Snapshot {
            columns: columns.collect(),
            reference: runs.of(1, own.reference),
            ..own
        };
        let share = Share {
            first: runs.first(),
            points: self.points(),
        };
        let said = write(asked, &frame, share);
        let comm = self.subdomain().comm();
        comm.first(said).unwrap_or_else(|failure| comm.end(failure))
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

    /// As [`CoSimulation::watched`], of points of all ranks, on the first.
    pub(super) fn watched(&mut self, what: Watched) -> Option<Seen> {
        let own = self.model.watched(what);
        // all ranks watched, or none
        Some(match own? {
            Seen::Virial(of_all) => Seen::Virial(of_all),
            Seen::Virials(points) => Seen::Virials(self.body().whole(1, points)?),
            Seen::Energies(own) => Seen::Energies(self.whole_observed(own)?),
        })
    }

    fn whole_observed(&self, own: Observed) -> Option<Observed> {
        let body = self.body();
        let whole = |values: Vec<f64>| match body.exchange().any(!values.is_empty()) {
            true => body.whole(1, values),
            false => Some(vec![]),
        };
        let all = [own.strain, own.repulsion, own.dilatation, own.whole].map(whole);
        let [strain, repulsion, dilatation, whole] = all;
        Some(Observed {
            strain: strain?,
            repulsion: repulsion?,
            dilatation: dilatation?,
            whole: whole?,
        })
    }

    /// As [`Examined::observed`], of points of all ranks, on the first.
    pub(super) fn observed(&mut self) -> Option<Observed> {
        let own = self.model.observed();
        self.whole_observed(own)
    }

    /// Every force of a pair as [`Examined::each_force`] visits them, of points of all ranks, on the first; `None` there: a law has none.
    pub(super) fn forces(&mut self) -> Option<Vec<PointForce>> {
        let ids = self.ids().to_vec();
        let order: Vec<u64> = {
            let body = self.body();
            body.by_id(|slot| body.order(slot))
        };
        let mut own: Vec<[u64; 13]> = vec![];
        let known = self.model.each_force(&mut |bond| {
            let state = bond.own.unwrap_or([0.0; 3]);
            let numbers = [bond.y, bond.force, state].concat();
            let mut said = [0; 13];
            said[..4].copy_from_slice(&[
                order[bond.id],
                u64::from(ids[bond.id]),
                bond.partner as u64,
                u64::from(bond.own.is_some()),
            ]);
            let words = numbers.iter().map(|x| x.to_bits());
            said[4..].iter_mut().zip(words).for_each(|(to, x)| *to = x);
            own.push(said);
        });
        // contact comes after all bonds, also of those of other ranks
        let mut touching = 0;
        let system = &mut self.model.system;
        let linear = system.is_linear();
        if let Some(contact) = system.contact.as_mut().filter(|_| !linear) {
            let bonds = system.interaction.as_ref();
            contact.each_force(bonds, &system.body, &system.u, &mut |_| touching += 1);
        }
        let bonds = own.len() - touching;
        let own: Vec<[u64; 14]> = { own.iter().enumerate() }
            .map(|(n, said)| {
                let mut tagged = [u64::from(n >= bonds); 14];
                tagged[1..].copy_from_slice(said);
                tagged
            })
            .collect();
        let unknown = self.body().exchange().any(!known);
        let mut all = self.body().joined(own)?;
        if unknown {
            return None;
        }
        // of one point in the order in which its rank has them
        all.sort_by_key(|said| [said[0], said[1]]);
        let force = |said: &[u64; 14]| {
            let said = &said[1..];
            let vector = |n: usize| [0, 1, 2].map(|a| f64::from_bits(said[4 + 3 * n + a]));
            PointForce {
                id: said[1] as usize,
                partner: said[2] as usize,
                y: vector(0),
                force: vector(1),
                own: (said[3] == 1).then(|| vector(2)),
            }
        };
        Some(all.iter().map(force).collect())
    }

    /// What is on its way while it works, of a step: messages to a neighbour, and bytes for each copy.
    pub fn meanwhile(&self) -> [usize; 2] {
        self.model.system.interaction.meanwhile()
    }

    /// What this rank has sent so far, and copies that it has of others' points.
    pub fn halo(&self) -> (Traffic, usize) {
        let sent = self.subdomain().comm().traffic();
        (sent, self.model.system.body.exchange().received_slots())
    }
}

/// This rank's share of a column.
fn share_of_values(runs: &RunsOfIds<'_>, own: Values) -> Values {
    match own {
        Values::Scalars(v) => Values::Scalars(runs.of(1, v)),
        Values::Vectors(v) => Values::Vectors(runs.of(1, v)),
        Values::Symmetric(v) => Values::Symmetric(runs.of(1, v)),
        Values::Tensors(v) => Values::Tensors(runs.of(1, v)),
        Values::Integers(v) => Values::Integers(runs.of(1, v)),
        Values::Counts(v) => Values::Counts(runs.of(1, v)),
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
