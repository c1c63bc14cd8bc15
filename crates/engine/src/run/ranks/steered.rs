//! The part of a model that one rank has, led step by step: what is told of points of all ranks is of those that are here.

use super::here::Here;
use super::model::RankModel;
use crate::condition::carried::Motion;
use crate::condition::driven::Drive;
use crate::condition::reaction::Reaction;
use crate::error::RunError;
use crate::run::{Prescription, Steered, Wall};

impl<const D: usize> RankModel<D> {
    /// Those of these points that are here: places in the list, and ids here.
    fn here(&self, ids: &[u32]) -> (Vec<usize>, Vec<u32>) {
        let own = self.ids();
        let place = |(n, id): (usize, &u32)| Some((n, own.binary_search(id).ok()? as u32));
        ids.iter().enumerate().filter_map(place).unzip()
    }

    /// As [`Steered::depart`], as what follows.
    pub(super) fn depart(&mut self, carried: &[Motion]) -> Result<f64, RunError> {
        let own = self.here.carried.iter().map(|n| carried[*n]);
        let own: Vec<Motion> = own.collect();
        self.model.depart(&own)
    }

    pub(super) fn reflect(&mut self, wall: &Wall, ids: Option<&[u32]>) {
        let own = ids.map(|ids| self.here(ids).1);
        self.model.reflect(wall, own.as_deref());
    }

    pub(super) fn prescribe(&mut self, way: Prescription, ids: &[u32]) {
        let (places, own) = self.here(ids);
        if way == Prescription::Carried {
            self.here.carried = places;
        }
        self.model.prescribe(way, &own);
    }

    pub(super) fn remove(&mut self, ids: &[u32]) {
        // driven and carried points are told anew afterwards
        self.here = Here::default();
        self.model.remove(ids);
    }

    pub(super) fn set_driven(&mut self, driven: &[(Drive, Option<Vec<u32>>)]) {
        let mut here = vec![];
        let own = driven.iter().map(|(drive, ids)| {
            let (places, own) = match ids {
                Some(ids) => {
                    let (places, own) = self.here(ids);
                    (places, Some(own))
                }
                None => (self.ids().iter().map(|id| *id as usize).collect(), None),
            };
            let own = (drive.pick(&places), own);
            here.push(places);
            own
        });
        let own: Vec<_> = own.collect();
        self.here.driven = here;
        self.model.set_driven(&own);
    }

    pub(super) fn drive(&mut self, index: usize, value: &Drive) -> bool {
        let places = self.here.driven.get(index);
        let own = places.map(|places| value.pick(places));
        own.is_some_and(|own| self.model.drive(index, &own))
    }

    pub(super) fn reaction(&mut self, index: usize) -> Option<Reaction> {
        self.model.reaction(index)
    }
}
