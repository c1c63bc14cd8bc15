//! What an experiment is given, and what it gives back.

use std::path::{Path, PathBuf};

use peridyne_io::write::atomic::write_file;
use peridyne_io::write::{WriteError, atomic};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::claim::Value;

/// Why an experiment has no result.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error("{0}")]
    Other(String),
}

impl Failure {
    pub fn new(message: impl Into<String>) -> Failure {
        Failure::Other(message.into())
    }
}

/// How long a full variant runs on two cores.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    /// Less than a minute.
    Seconds,
    /// Less than an hour.
    Minutes,
    /// It runs only when it is asked for by its whole name.
    Hours,
}

impl std::fmt::Display for Takes {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.pad(match self {
            Takes::Seconds => "seconds",
            Takes::Minutes => "minutes",
            Takes::Hours => "hours",
        })
    }
}

/// A figure, table or set of equations of a paper.
pub trait Experiment: Sync {
    /// The paper: `seleson2009`.
    fn key(&self) -> &'static str;
    /// The folder: `figure-4-3`.
    fn figure(&self) -> &'static str;
    fn title(&self) -> &'static str;
    /// The text of `claims.toml`.
    fn claims(&self) -> &'static str;
    /// The text of `README.md`: what the paper leaves unsaid and what was chosen.
    fn readme(&self) -> &'static str;
    /// Texts that the result depends on: `include_str!("mod.rs")`, decks. A finished figure is run again when one changes.
    fn sources(&self) -> &'static [&'static str];
    fn takes(&self) -> Takes {
        Takes::Seconds
    }
    /// Computes, and writes data and pictures into [`Context::out`].
    ///
    /// # Errors
    /// What went wrong.
    fn run(&self, context: &Context) -> Result<Findings, Failure>;
}

/// A folder as an [`Experiment`] of the paper in whose module it is: `experiment!(Figure4, "figure-4", "Title",
/// ["../shared.rs", "deck.toml"])` beside a `fn run(context: &Context) -> Result<Findings, Failure>`. The list has the files
/// that the result depends on beside `mod.rs`. A last `, Minutes` or `, Hours` is what the full variant takes.
macro_rules! experiment {
    ($name:ident, $figure:literal, $title:literal, [$($source:literal),* $(,)?] $(, $takes:ident)? $(,)?) => {
        pub struct $name;

        impl $crate::Experiment for $name {
            fn key(&self) -> &'static str {
                $crate::experiment::paper(module_path!())
            }
            fn figure(&self) -> &'static str {
                $figure
            }
            fn title(&self) -> &'static str {
                $title
            }
            fn claims(&self) -> &'static str {
                include_str!("claims.toml")
            }
            fn readme(&self) -> &'static str {
                include_str!("README.md")
            }
            fn sources(&self) -> &'static [&'static str] {
                &[include_str!("mod.rs") $(, include_str!($source))*]
            }
            $(fn takes(&self) -> $crate::Takes {
                $crate::Takes::$takes
            })?
            fn run(&self, context: &$crate::Context) -> Result<$crate::Findings, $crate::Failure> {
                run(context)
            }
        }
    };
}

/// The paper that a module of this crate belongs to: `seleson2009` of `peridyne_papers::seleson2009::figure_4_3`.
pub(crate) fn paper(module: &'static str) -> &'static str {
    module.split("::").nth(1).unwrap_or(module)
}

/// What a run is given.
pub struct Context<'a> {
    /// Folder of this figure's results; it exists.
    pub out: PathBuf,
    /// The variant for tests: seconds.
    pub small: bool,
    pub threads: usize,
    /// Hash of all that the result depends on.
    pub inputs: String,
    /// Takes lines about what is being done.
    pub progress: &'a (dyn Fn(&str) + Sync),
}

#[derive(Serialize, Deserialize)]
struct Part<T> {
    inputs: String,
    value: T,
}

impl Context<'_> {
    pub fn say(&self, line: &str) {
        (self.progress)(line);
    }

    /// The result of a named part of the work: from an earlier run with the same inputs that was cut off, or computed now
    /// and kept. Numbers must be finite.
    ///
    /// # Errors
    /// Those of `compute`; a name that is no file name; the result cannot be kept.
    pub fn part<T: Serialize + DeserializeOwned>(
        &self,
        name: &str,
        compute: impl FnOnce() -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_.=".contains(c);
        if name.is_empty() || name.starts_with('.') || !name.chars().all(plain) {
            return Err(Failure::new(format!(
                "`{name}` cannot be the name of a part: use letters, digits, - and _"
            )));
        }
        let folder = self.out.join(".parts");
        let path = folder.join(format!("{name}.json"));
        // a part that cannot be read is computed again
        let kept = std::fs::read(&path).ok();
        let kept = kept.and_then(|bytes| serde_json::from_slice::<Part<T>>(&bytes).ok());
        if let Some(part) = kept.filter(|part| part.inputs == self.inputs) {
            self.say(&format!("{name}: kept from before"));
            return Ok(part.value);
        }
        let value = compute()?;
        let part = Part {
            inputs: self.inputs.clone(),
            value,
        };
        atomic::create_directory(&folder)?;
        write_file(&path, |w| Ok(serde_json::to_writer(w, &part)?))?;
        Ok(part.value)
    }
}

/// A value found for a claim.
#[derive(Debug, Clone, PartialEq)]
pub enum Computed {
    Number(f64),
    Text(String),
    /// What was seen, and whether the statement holds.
    Holds(String, bool),
}

/// A number or words that no claim is about: what a run took here, what a reading of the paper changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    pub key: String,
    pub value: Value,
    pub unit: String,
}

/// What an experiment found.
#[derive(Debug, Clone, Default)]
pub struct Findings {
    pub(crate) values: Vec<(String, Computed)>,
    pub(crate) measurements: Vec<Measurement>,
    pub(crate) files: Vec<PathBuf>,
}

impl Findings {
    pub fn new() -> Findings {
        Findings::default()
    }

    pub fn number(&mut self, key: &str, value: f64) {
        self.values.push((key.to_string(), Computed::Number(value)));
    }

    /// Words that must be those published: a fraction, a formula.
    pub fn text(&mut self, key: &str, value: impl Into<String>) {
        self.values
            .push((key.to_string(), Computed::Text(value.into())));
    }

    /// What was seen, for a claim in words.
    pub fn holds(&mut self, key: &str, seen: impl Into<String>, holds: bool) {
        self.values
            .push((key.to_string(), Computed::Holds(seen.into(), holds)));
    }

    /// A number or words to be shown, without a verdict; the key says in words what it is of.
    pub fn measured(&mut self, key: &str, value: impl Into<Value>, unit: &str) {
        self.measurements.push(Measurement {
            key: key.to_string(),
            value: value.into(),
            unit: unit.to_string(),
        });
    }

    /// A file that was written.
    pub fn file(&mut self, path: impl AsRef<Path>) {
        self.files.push(path.as_ref().to_path_buf());
    }

    /// PNG and SVG, as the plots give them.
    pub fn picture(&mut self, paths: [PathBuf; 2]) {
        self.files.extend(paths);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    fn context(out: &Path, inputs: &str) -> Context<'static> {
        Context {
            out: out.to_path_buf(),
            small: true,
            threads: 1,
            inputs: inputs.into(),
            progress: &|_| {},
        }
    }

    #[test]
    fn parts_are_computed_once_for_the_same_inputs() {
        let dir = tempfile::tempdir().unwrap();
        let runs = Cell::new(0);
        let value = vec![1.0 / 3.0, 5e-324, 0.1 + 0.2, 1.7976931348623157e308];
        let part = |inputs: &str| {
            context(dir.path(), inputs).part("run-1", || {
                runs.set(runs.get() + 1);
                Ok(value.clone())
            })
        };
        assert_eq!(part("a").unwrap(), value);
        assert_eq!(part("a").unwrap(), value);
        assert_eq!(runs.get(), 1);
        assert_eq!(part("b").unwrap(), value);
        assert_eq!(runs.get(), 2);
        std::fs::write(dir.path().join(".parts/run-1.json"), "{\"inp").unwrap();
        assert_eq!(part("b").unwrap(), value);
        assert_eq!(runs.get(), 3);
    }

    #[test]
    fn a_part_that_fails_is_not_kept() {
        let dir = tempfile::tempdir().unwrap();
        let context = context(dir.path(), "a");
        let failed: Result<f64, _> = context.part("p", || Err(Failure::new("crossed")));
        assert_eq!(failed.unwrap_err().to_string(), "crossed");
        assert_eq!(context.part("p", || Ok(2.0)).unwrap(), 2.0);
        let bad = context.part("../p", || Ok(2.0)).unwrap_err().to_string();
        assert!(bad.contains("`../p` cannot be the name of a part"), "{bad}");
    }
}
