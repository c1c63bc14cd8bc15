//! Small text files, read at once.

use super::error::ReadError;

use super::{encoding, source};
use std::path::Path;

/// Text and name of a file.
///
/// # Errors
/// It cannot be read, or is no text ([`encoding::text`]).
pub fn text_of(path: &Path) -> Result<(String, String), ReadError> {
    titled(path, 0)
}

/// The same of a file whose first lines may say anything.
pub(super) fn titled(path: &Path, titles: usize) -> Result<(String, String), ReadError> {
    let bytes = source::bytes(path);
    let bytes = bytes.map_err(|e| ReadError::file(path, format!("cannot read it: {e}")))?;
    let name = path.display().to_string();
    Ok((text(bytes, &name, titles)?, name))
}

/// The text of these bytes of a file.
pub(super) fn text(bytes: Vec<u8>, name: &str, titles: usize) -> Result<String, ReadError> {
    encoding::text(bytes, titles).map_err(|wrong| ReadError {
        file: name.into(),
        line: wrong.line,
        message: wrong.message,
    })
}
