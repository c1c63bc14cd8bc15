//! What cannot be built.

use crate::quantity::Message;

/// What a program can tell apart of the ways in which a specification cannot be built.
#[derive(Debug, Clone, PartialEq)]
pub enum BuildErrorKind {
    /// A value that can never be: beyond its bounds, not finite, not of the shape that is needed.
    Invalid,
    /// What must be said is not.
    Missing,
    /// Nothing is called so.
    Unknown { name: String },
    /// Entries that could each be, and not together.
    Conflict,
    /// What has a meaning, and the engine does not have: laws, families, integrators, conditions that do not go together, or what this machine
    /// lacks.
    Unsupported,
    /// Nothing is left: no points, no bonds.
    Empty,
    /// More than can be counted.
    TooMany,
    /// More bytes of memory, or on the disk, than are left (`None`: the system does not say).
    TooLarge { needed: f64, left: Option<f64> },
    /// Mechanics without an answer: a body that nothing holds, or whose energy has no meaning.
    IllPosed,
    /// Another rank says what is wrong.
    Elsewhere,
}

/// A specification that cannot be built: `kind`, `path` and `help` for programs, `message` for readers.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct BuildError {
    pub kind: BuildErrorKind,
    /// Dotted path of the offending entry in the spec (`"body.region"`), empty when it is not one entry.
    pub path: String,
    /// What is wrong and what was expected.
    pub message: Message,
    /// What to write instead, if there is something useful to say.
    pub help: Option<Message>,
}

/// One constructor for each kind.
impl BuildError {
    fn of(kind: BuildErrorKind, path: impl Into<String>, message: impl Into<Message>) -> Self {
        BuildError {
            kind,
            path: path.into(),
            message: message.into(),
            help: None,
        }
    }
    pub fn invalid(path: impl Into<String>, message: impl Into<Message>) -> Self {
        Self::of(BuildErrorKind::Invalid, path, message)
    }
    pub fn missing(path: impl Into<String>, message: impl Into<Message>) -> Self {
        Self::of(BuildErrorKind::Missing, path, message)
    }
    /// Nothing is called `name`.
    pub fn unknown(
        path: impl Into<String>,
        name: impl Into<String>,
        message: impl Into<Message>,
    ) -> Self {
        Self::of(BuildErrorKind::Unknown { name: name.into() }, path, message)
    }
    pub fn conflict(path: impl Into<String>, message: impl Into<Message>) -> Self {
        Self::of(BuildErrorKind::Conflict, path, message)
    }
    pub fn unsupported(path: impl Into<String>, message: impl Into<Message>) -> Self {
        Self::of(BuildErrorKind::Unsupported, path, message)
    }
    pub fn empty(path: impl Into<String>, message: impl Into<Message>) -> Self {
        Self::of(BuildErrorKind::Empty, path, message)
    }
    pub fn too_many(path: impl Into<String>, message: impl Into<Message>) -> Self {
        Self::of(BuildErrorKind::TooMany, path, message)
    }
    pub fn too_large(
        path: impl Into<String>,
        (needed, left): (f64, Option<f64>),
        message: impl Into<Message>,
    ) -> Self {
        Self::of(BuildErrorKind::TooLarge { needed, left }, path, message)
    }
    /// Rank `rank` says what is wrong.
    pub fn elsewhere(rank: usize) -> Self {
        let message = format!("rank {rank} found a mistake");
        Self::of(BuildErrorKind::Elsewhere, "", message)
    }
    pub fn ill_posed(path: impl Into<String>, message: impl Into<Message>) -> Self {
        Self::of(BuildErrorKind::IllPosed, path, message)
    }
    pub fn help(mut self, help: impl Into<Message>) -> Self {
        self.help = Some(help.into());
        self
    }
    /// The same of what is called so within `whole`.
    pub fn within(mut self, whole: &str) -> Self {
        self.path = match self.path.is_empty() {
            true => whole.to_string(),
            false => format!("{whole}.{}", self.path),
        };
        self
    }
    /// The same of another entry.
    pub fn at(mut self, path: impl Into<String>) -> Self {
        self.path = path.into();
        self
    }
}
