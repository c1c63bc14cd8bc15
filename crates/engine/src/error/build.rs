//! What cannot be built.

/// A specification that cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct BuildError {
    /// Dotted path of the offending entry in the spec (`"body.region"`), empty when it is not one entry.
    pub path: String,
    /// What is wrong and what was expected.
    pub message: String,
    /// What to write instead, if there is something useful to say.
    pub help: Option<String>,
}

impl BuildError {
    pub fn new(path: impl Into<String>, message: impl Into<String>) -> Self {
        BuildError {
            path: path.into(),
            message: message.into(),
            help: None,
        }
    }
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}
