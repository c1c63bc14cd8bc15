//! What a deck calls by name: sets of points, and what may be named beside what is built in.

use super::faces::Faces;
use crate::constitutive::Registry;
use crate::spec::LoadMap;

/// Names of a model.
pub(super) struct Names<const D: usize> {
    /// Named sets of point ids.
    pub sets: Vec<(String, Vec<u32>)>,
    /// Of a condensed body: where its loads act, and the named sets there.
    pub load_map: Option<LoadMap<D>>,
    pub loaded_sets: Vec<(String, Vec<u32>)>,
    /// On what area loads act.
    pub faces: Faces,
    /// Observables and forces by their names.
    pub registry: Registry,
}

impl<const D: usize> Names<D> {
    /// Points have these ids now, those that are left.
    pub fn renumber(&mut self, moved: &[Option<u32>]) {
        for (_, members) in &mut self.sets {
            *members = members
                .iter()
                .filter_map(|id| moved[*id as usize])
                .collect();
        }
    }
}
