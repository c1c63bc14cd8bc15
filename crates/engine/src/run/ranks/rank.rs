//! One of the ranks that share a model, in as many dimensions as the model has.

use super::all::AllRanks;
use super::model::{RankModel, WriteShare};
use crate::error::{BuildError, RunError};
use crate::run::agreed::agreed_among;
use crate::run::sanity::possible;
use crate::run::{Options, Registry, Simulation};
use crate::spec::Spec;
use peridyne_comm::{Comm, Traffic};
use std::sync::Arc;

/// One of the ranks that share a model: its part, which it moves together with the others, or as the first one asks.
pub trait Rank {
    /// Forces of the state that the run begins from, and what breaks by them. All ranks at once, as below.
    fn start(&mut self);

    /// One step.
    ///
    /// # Errors
    /// As of [`Simulation::step`], the same on all ranks.
    fn step(&mut self) -> Result<(), RunError>;

    /// What this rank has sent so far, and copies that it has of others' points.
    fn halo(&self) -> (Traffic, usize);

    /// The model of all ranks, on the first. The others [follow](Rank::follow) until it is dropped.
    ///
    /// # Panics
    /// This is not the first rank.
    fn lead(self: Box<Self>, write: WriteShare) -> Box<dyn Simulation>;

    /// Does what the first rank asks of all, until that drops the model.
    ///
    /// # Panics
    /// This is the first rank, or the first one is another program.
    fn follow(self: Box<Self>, write: WriteShare);
}

impl<const D: usize> Rank for RankModel<D> {
    fn start(&mut self) {
        RankModel::start(self);
    }

    fn step(&mut self) -> Result<(), RunError> {
        RankModel::step(self)
    }

    fn halo(&self) -> (Traffic, usize) {
        RankModel::halo(self)
    }

    fn lead(self: Box<Self>, write: WriteShare) -> Box<dyn Simulation> {
        Box::new(AllRanks::new(*self, write))
    }

    fn follow(self: Box<Self>, write: WriteShare) {
        RankModel::follow(*self, write);
    }
}

/// This rank's part of the model of a spec. All ranks come here at once, with the same spec.
///
/// # Errors
/// As of [`build_with`](crate::run::build_with). One rank says what it is, the others that it [does](crate::error::BuildErrorKind::Elsewhere).
pub fn join(
    spec: &Spec,
    options: Options,
    registry: &Registry,
    comm: &Arc<Comm>,
) -> Result<Box<dyn Rank>, BuildError> {
    agreed_among(comm, possible(spec, options.simd))?;
    Ok(match spec.space.dimension {
        1 => Box::new(RankModel::<1>::new(spec, options, registry, comm)?),
        2 => Box::new(RankModel::<2>::new(spec, options, registry, comm)?),
        _ => Box::new(RankModel::<3>::new(spec, options, registry, comm)?),
    })
}
