//! The TOML deck: text with units, expressions and overrides → [`Spec`].
//!
//! A mistake is a [`DeckError`] that names file, line and what to write instead. A [`BuildError`] of the engine
//! finds its way back to the deck through [`Deck::explain`].

pub mod coarsened;
pub mod conservation;
mod describe;
mod document;
mod error;
mod form;
mod lints;
mod locate;
mod lower;
mod quantity;
mod reader;
pub mod reference;
mod renamed;
mod schema;
mod source;
mod syntax;
mod units;
pub mod upscaled;
mod value;

#[cfg(test)]
mod tests;

pub use describe::{describe, sources};
pub use error::DeckError;
pub use lints::{Lint, lints};
pub use lower::{OutputSpec, PictureSpec, SpaceTimeSpec};
pub use renamed::renamed;
pub use schema::{law_schema, schema};
pub use source::Flag;
pub use units::{
    Constants, Dim, UnitSystem, clock_time, counted, each_once, example, known, named, rounded,
    split, unit, usual,
};

use crate::continuum::plan::FieldsSpec;
use crate::read::Cells;
use crate::read::source::during;
use document::Document;
use lower::{Entries, Files};
use peridyne::error::BuildError;
use peridyne::run::Info;
use peridyne::spec::Spec;
use source::Source;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A deck that was understood.
#[derive(Debug, Clone)]
pub struct Deck {
    pub spec: Spec,
    pub output: OutputSpec,
    /// Continuum fields to make.
    pub fields: Vec<FieldsSpec>,
    /// Names of the atoms of each material, where a file says it; none where they are no atoms.
    pub(crate) named: Vec<Option<String>>,
    /// Lower corner of the periods.
    pub corner: [f64; 3],
    pub units: UnitSystem,
    /// Threads asked for.
    pub threads: Option<usize>,
    /// Duration asked for where the step is estimated: `spec.run.schedule.steps` is then 0, and [`Deck::steps`] has it.
    pub duration: Option<f64>,
    /// Modes of vibration asked for.
    pub modes: usize,
    /// What looks wrong though it can be run, with its line.
    pub warnings: Vec<String>,
    /// What was passed over in files.
    pub notes: Vec<String>,
    /// Cells of its meshes.
    pub cells: Arc<Cells>,
    /// Entries of the deck that those of the spec come from.
    entries: Entries,
    source: Source,
    /// Where the files lie that were read for it.
    pub files: Vec<PathBuf>,
}

impl Deck {
    /// Reads a deck; files it names are relative to the folder of `file_name`. `overrides` are dotted keys and
    /// values, each value TOML or a bare word.
    ///
    /// # Errors
    /// The first mistake found, with its place in the deck or in the override.
    pub fn parse(
        source: &str,
        file_name: &str,
        overrides: &[(String, String)],
    ) -> Result<Deck, DeckError> {
        Self::of_source(Source::new(source, file_name, overrides))
    }

    /// The deck that a command line says, key by key; files are relative to the working folder.
    ///
    /// # Errors
    /// The first mistake found, with the flag that made it.
    pub fn of_flags(flags: &[Flag]) -> Result<Deck, DeckError> {
        Self::with_flags("", "the command line", flags)
    }

    /// A deck over which the keys of a command line are laid.
    ///
    /// # Errors
    /// The first mistake found, with its place in the deck or the flag that made it.
    pub fn with_flags(source: &str, file_name: &str, flags: &[Flag]) -> Result<Deck, DeckError> {
        Self::of_source(Source::with_flags(source, file_name, flags.iter().cloned()))
    }

    fn of_source(source: Source) -> Result<Deck, DeckError> {
        let (read, files) = during(|| Self::lowered(source));
        Ok(Deck { files, ..read? })
    }

    fn lowered(source: Source) -> Result<Deck, DeckError> {
        let (mut tree, renames) = source.tree_and_renames()?;
        form::names(&source, tree.get_ref())?;
        form::kind(&source, tree.get_ref())?;
        form::check(&source, tree.get_ref())?;
        locate::name_material(tree.get_mut());
        locate::first_body(tree.get_mut());
        let document: Document = reader::read(&source, &tree)?;
        let folder = Path::new(source.file()).parent().unwrap_or(Path::new(""));
        let units = lower::units(&document);
        let mut lowered = lower::lower(&source, &document, &Files { folder })?;
        lowered.output.dir = lowered.output.dir.map(|dir| folder.join(dir));
        Ok(Deck {
            spec: lowered.spec,
            output: lowered.output,
            fields: lowered.fields,
            named: lowered.species,
            corner: lowered.corner,
            units,
            threads: lowered.threads,
            duration: lowered.duration,
            modes: lowered.modes,
            warnings: lowered.warnings,
            notes: [source.notes(&renames), lowered.notes].concat(),
            cells: Arc::new(lowered.cells),
            entries: lowered.entries,
            source,
            files: vec![],
        })
    }

    /// Of each material of atoms their name, where a file does not say it that of the material (of a single one X), and their mass
    /// density.
    pub fn species(&self) -> Vec<(String, f64)> {
        let one = self.spec.materials.len() == 1;
        let each = self.spec.materials.iter().zip(&self.named);
        each.map(|(m, named)| {
            let own = if one { "X" } else { &m.name };
            (named.clone().unwrap_or_else(|| own.into()), m.density)
        })
        .collect()
    }

    /// Mass of an atom of each material, in units of computation; `None` where points have different volumes.
    pub fn masses(&self) -> Vec<Option<f64>> {
        let volume = lower::point_volume(&self.spec.body, self.spec.space.dimension);
        let each = self.spec.materials.iter();
        each.map(|m| volume.map(|v| m.density * v)).collect()
    }

    /// Do all names of files that the deck gives stay inside the folder of the results (`dir`: inside the folder it is
    /// relative to)? `dir` is not looked at where the caller has a folder of its own.
    ///
    /// # Errors
    /// The first name that leads out.
    pub fn stays_inside(&self, own_dir: bool) -> Result<(), DeckError> {
        let mut outside = self.output.outside.iter();
        match outside.find(|(key, _)| !(own_dir && *key == "dir")) {
            None => Ok(()),
            Some((key, name)) => Err(self.explain(
                &BuildError::invalid(
                    format!("output.{key}"),
                    format!("output.{key} = {name:?} leads out of the folder of the results"),
                )
                .help("give a name without `..` that does not begin with `/`; --allow-outside lets this deck write there"),
            )),
        }
    }

    /// Boltzmann's constant (energy per kelvin; 1 in reduced and no units, where temperatures are energies).
    pub fn boltzmann(&self) -> f64 {
        lower::boltzmann(self.units)
    }

    /// Steps of the run once the time step is known; increments of statics before motion are among them.
    pub fn steps(&self, time_step: f64) -> u64 {
        let steps = self
            .duration
            .map_or(self.spec.run.schedule.steps, |duration| {
                lower::steps(duration, time_step)
            });
        self.increments() + steps
    }

    /// Increments of statics before motion.
    pub fn increments(&self) -> u64 {
        self.spec.run.preload.as_ref().map_or(0, |p| p.increments)
    }

    /// Where an entry of the spec (`"materials[0].density"`, `"body.region"`) stands in the deck, in bytes; the
    /// nearest table around it if it was left out.
    pub fn locate(&self, path: &str) -> Option<Range<usize>> {
        // an entry that does several things is several conditions of the spec
        let entry = self.entries.path(path);
        locate::locate(&self.source, entry.as_deref().unwrap_or(path))
    }

    /// What looks wrong once the model is built, with lines where there are any.
    pub fn lints(&self, info: &Info) -> Vec<String> {
        let each = lints(&self.spec, info, self.units).into_iter();
        let told = each.map(|lint| {
            let text = self.units.tell(&lint.text);
            match self.locate(&lint.path) {
                Some(span) => self.source.remark(&span, &text),
                None => text,
            }
        });
        told.chain(self.long_run(info.time_step)).collect()
    }

    /// What to say about the length of a run whose time step is known.
    fn long_run(&self, time_step: f64) -> Option<String> {
        let steps = self.steps(time_step);
        (self.spec.run.schedule.statics().is_none() && steps > lower::MANY_STEPS).then(|| {
            let step = self.units.write(time_step, Dim::TIME);
            format!(
                "{steps} steps of {step}: check the unit of run.duration (\"50 us\") or run.time_step, or the number of steps"
            )
        })
    }

    /// An error of the engine as an error in the deck.
    pub fn explain(&self, error: &BuildError) -> DeckError {
        self.source.error(
            self.locate(&error.path),
            self.units.tell(&error.message),
            error.help.as_ref().map(|h| self.units.tell(h)),
        )
    }

    /// What was understood, in a few lines with units.
    pub fn describe(&self) -> String {
        describe(&self.spec, self.units)
    }

    /// Where the laws of its materials come from, each once.
    pub fn sources(&self) -> Vec<String> {
        sources(&self.spec)
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
