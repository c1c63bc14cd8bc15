//! Files that a deck names.

use super::context::{Context, Result};
use crate::deck::document::Body;
use crate::deck::quantity::{Length, Positive};
use crate::deck::units::Dim;
use crate::deck::value::{At, Quantity};
use crate::read::Cells;
use crate::read::eam::{self, EamFile};
use crate::read::entries::Entry;
use crate::read::{Frame, Points};
use peridyne::law::descriptor::Key;
use peridyne::space::triangles::Triangles;
use peridyne::spec::{BondedSpec, Cloud};
use std::path::Path;

/// How files named in a deck are read.
pub(in crate::deck) struct Files<'a> {
    /// Folder of the deck.
    pub folder: &'a Path,
}

impl Files<'_> {
    /// The points of `body.file`.
    pub(super) fn read(&self, context: &Context, body: &Body) -> Result<Points> {
        let Some(file) = &body.file else {
            return Ok(Points {
                cloud: Cloud::default(),
                dimension: None,
                ends: None,
                cells: Cells::default(),
                atoms: None,
                micromoduli: None,
                notes: Vec::new(),
            });
        };
        let path = self.folder.join(&file.value);
        let (frame, span) = match &body.file_step {
            Some(step) => (Frame::Step(step.value), &step.span),
            None => (Frame::Last, &file.span),
        };
        crate::read::points(&path, frame).map_err(|e| context.error(span, e.to_string()))
    }

    /// Is this file of an embedded-atom model one of those that have an element each?
    pub(super) fn is_funcfl(name: &str) -> bool {
        Path::new(name).extension().is_some_and(|e| e == "eam")
    }

    /// The table of an embedded-atom model.
    pub(super) fn eam(&self, context: &Context, file: &At<String>) -> Result<EamFile> {
        let path = self.folder.join(&file.value);
        let read = match path.extension().and_then(|e| e.to_str()) {
            Some("eam") => eam::funcfl(&[&path]),
            Some("fs") => eam::fs(&path),
            _ => eam::setfl(&path),
        };
        read.map_err(|e| context.error(&file.span, e.to_string()))
    }

    /// What bonds the atoms of the file of a body.
    pub(super) fn molecules(
        &self,
        context: &Context,
        file: &At<String>,
        special: [f64; 3],
        (length, energy): (f64, f64),
    ) -> Result<BondedSpec> {
        let path = self.folder.join(&file.value);
        crate::read::molecules::molecules(&path, special, length, energy)
            .map_err(|e| context.error(&file.span, e.to_string()))
    }

    /// Constants of triples of elements.
    pub(super) fn entries(
        &self,
        context: &Context,
        file: &At<String>,
        columns: &[Key],
    ) -> Result<Vec<Entry>> {
        let names: Vec<&str> = columns.iter().map(|c| c.name).collect();
        let read = crate::read::entries::entries(&self.folder.join(&file.value), &names);
        read.map_err(|e| context.error(&file.span, e.to_string()))
    }

    /// The units that a file of such constants says it is in.
    pub(super) fn units_of_entries(
        &self,
        context: &Context,
        file: &At<String>,
    ) -> Result<Option<String>> {
        crate::read::tag::of_entries(&self.folder.join(&file.value))
            .map_err(|e| context.error(&file.span, e.to_string()))
    }

    /// Triangles of a surface.
    pub(super) fn stl(
        &self,
        context: &Context,
        file: &At<String>,
        unit: &Option<Quantity<Positive<Length>>>,
    ) -> Result<Triangles> {
        let unit = context.value_or(unit, context.units.plain_factor(Dim::LENGTH))?;
        crate::read::stl::stl(&self.folder.join(&file.value), unit)
            .map_err(|e| context.error(&file.span, e.to_string()))
    }

    /// Tables of several elements, a file each, as one model.
    pub(super) fn funcfl(&self, context: &Context, files: &[&At<String>]) -> Result<EamFile> {
        let paths = files.iter().map(|f| self.folder.join(&f.value));
        let paths: Vec<_> = paths.collect();
        eam::funcfl(&paths).map_err(|e| context.error(&files[0].span, e.to_string()))
    }
}
