//! The part of a model that one rank has, led step by step: what is told of points of all ranks is of those that are here.

use super::here::{Here, Listed};
use super::model::RankModel;
use crate::boundary_condition::driven::Drive;
use crate::boundary_condition::kinematic::Motion;
use crate::boundary_condition::reaction::Reaction;
use crate::error::RunError;
use crate::run::{CoSimulation, Prescription, Wall};

impl<const D: usize> RankModel<D> {
    /// As [`CoSimulation::depart`], as what follows.
    pub(super) fn depart(&mut self, kinematic: &[Motion]) -> Result<f64, RunError> {
        let own = self.here.kinematic.places.iter().map(|n| kinematic[*n]);
        let own: Vec<Motion> = own.collect();
        self.model.depart(&own)
    }

    pub(super) fn reflect(&mut self, wall: &Wall, ids: Option<&[u32]>) {
        let listed = Listed::new(ids.map(<[u32]>::to_vec), self.ids());
        let own = listed.here(self.ids());
        self.model.reflect(wall, own.as_deref());
    }

    pub(super) fn prescribe(&mut self, way: Prescription, ids: &[u32]) {
        let listed = Listed::new(Some(ids.to_vec()), self.ids());
        let own = listed.here(self.ids()).unwrap_or_default();
        if way == Prescription::KinematicPoints {
            self.here.kinematic = listed;
        }
        self.model.prescribe(way, &own);
    }

    pub(super) fn remove(&mut self, ids: &[u32]) {
        let mut gone = ids.to_vec();
        gone.sort_unstable();
        gone.dedup();
        self.model.remove(&gone);
        let left = |listed: &Listed| listed.without(&gone, self.ids());
        self.here = Here {
            kinematic: left(&self.here.kinematic),
            driven: self.here.driven.iter().map(left).collect(),
        };
    }

    pub(super) fn set_driven(&mut self, driven: &[(Drive, Option<Vec<u32>>)]) {
        let lists = driven
            .iter()
            .map(|(_, ids)| Listed::new(ids.clone(), self.ids()));
        let lists: Vec<Listed> = lists.collect();
        let own = driven.iter().zip(&lists).map(|((drive, _), listed)| {
            let own = listed.here(self.ids());
            (drive.pick(&listed.places), own)
        });
        let own: Vec<_> = own.collect();
        self.here.driven = lists;
        self.model.set_driven(&own);
    }

    pub(super) fn drive(&mut self, index: usize, value: &Drive) -> bool {
        let listed = self.here.driven.get(index);
        let own = listed.map(|listed| value.pick(&listed.places));
        own.is_some_and(|own| self.model.drive(index, &own))
    }

    pub(super) fn reaction(&mut self, index: usize) -> Option<Reaction> {
        self.model.reaction(index)
    }
}
