//! What fields cannot be had for.

/// Why fields cannot be had.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct FieldsError(pub String);
