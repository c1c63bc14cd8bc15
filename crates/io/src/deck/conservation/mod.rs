//! Decks with `kind = "conservation_law"`: nonlocal conservation laws in place of bodies.

mod document;
mod lower;
mod variables;

pub(super) use document::LawDocument;

use super::error::DeckError;
use super::source::Source;
use super::units::UnitSystem;
use super::{Dim, form, locate, reader};
use crate::write::folder::stays;
use peridyne::error::BuildError;
use peridyne_transport::exact::Reference;
use peridyne_transport::{Evolution, Grid};
use std::path::{Path, PathBuf};
use toml::de::DeValue;

/// Word of `kind`.
const KIND: &str = "conservation_law";

/// A deck of a conservation law that was understood and built.
#[derive(Debug)]
pub struct LawDeck {
    pub title: String,
    pub units: UnitSystem,
    /// What u measures.
    pub dimension: Dim,
    /// At t = 0.
    pub evolution: Evolution,
    /// Horizons of transport and diffusion.
    pub horizons: [Option<f64>; 2],
    pub duration: f64,
    /// Frames after the first.
    pub frames: u64,
    /// Rows of the history after the first.
    pub rows: u64,
    /// What the run compares itself with.
    pub reference: Option<Reference>,
    /// Noll's flux in the frames.
    pub flux: bool,
    pub pictures: bool,
    /// `report.html` at the end.
    pub report: bool,
    /// Folder; `None`: chosen by the caller.
    pub dir: Option<PathBuf>,
    /// What looks wrong though it can be run, with its line.
    pub warnings: Vec<String>,
    source: Source,
}

impl LawDeck {
    /// Is it a deck of this kind, as far as its text or an override says?
    pub fn is_one(text: &str, overrides: &[(String, String)]) -> bool {
        let said = |value: &DeValue| value.as_str() == Some(KIND);
        let source = Source::new(text, "", overrides);
        let found = source.tree().ok().and_then(|tree| {
            let kind = tree.get_ref().get("kind")?;
            Some(said(kind.get_ref()))
        });
        found == Some(true)
    }

    /// Reads a deck and makes what it says. `overrides` are dotted keys and values.
    ///
    /// # Errors
    /// The first mistake found, with its place in the deck or in the override.
    pub fn parse(
        text: &str,
        file_name: &str,
        overrides: &[(String, String)],
    ) -> Result<LawDeck, DeckError> {
        let source = Source::new(text, file_name, overrides);
        let tree = source.tree()?;
        form::names(&source, tree.get_ref())?;
        let document: LawDocument = reader::read(&source, &tree)?;
        let lowered = lower::lower(&source, &document)?;
        let folder = Path::new(file_name).parent().unwrap_or(Path::new(""));
        Ok(LawDeck {
            dir: document.output.dir.as_ref().map(|dir| folder.join(dir)),
            title: document.title.unwrap_or_default(),
            pictures: document.output.pictures.unwrap_or(true),
            report: document.output.report.unwrap_or(true),
            source,
            ..lowered
        })
    }

    /// Does the folder that the deck names stay inside the one that it is relative to?
    ///
    /// # Errors
    /// It leads out.
    pub fn stays_inside(&self) -> Result<(), DeckError> {
        match &self.dir {
            Some(dir) if !stays(dir.strip_prefix(self.folder()).unwrap_or(dir)) => Err(explain(
                &self.source,
                &BuildError::invalid("output.dir", format!("output.dir leads out of the folder of the deck: {}", dir.display()))
                    .help("give a name without `..` that does not begin with `/`; --allow-outside lets this deck write there"),
            )),
            _ => Ok(()),
        }
    }

    fn folder(&self) -> &Path {
        Path::new(self.source.file())
            .parent()
            .unwrap_or(Path::new(""))
    }

    pub fn grid(&self) -> &Grid {
        &self.evolution.operator.law().grid
    }

    /// The text of the deck.
    pub fn text(&self) -> &str {
        self.source.text()
    }

    /// The name of the deck's file.
    pub fn file(&self) -> &str {
        self.source.file()
    }
}

/// An error of the law at its key.
fn explain(source: &Source, error: &BuildError) -> DeckError {
    let place = locate::locate(source, &error.path);
    let help = error.help.as_ref().map(ToString::to_string);
    source.error(place, error.message.to_string(), help)
}
