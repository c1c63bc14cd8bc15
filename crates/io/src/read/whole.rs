//! Small text files, read at once.

use super::ReadError;
use std::path::Path;

/// Text and name of a file; old comments may be in Latin-1.
pub(crate) fn text_of(path: &Path) -> Result<(String, String), ReadError> {
    let name = path.display().to_string();
    let bytes = super::source::bytes(path).map_err(|e| ReadError {
        file: name.clone(),
        line: None,
        message: format!("cannot read it: {e}"),
    })?;
    match String::from_utf8(bytes) {
        Ok(text) => Ok((text, name)),
        Err(e) => Ok((
            e.into_bytes().iter().map(|b| char::from(*b)).collect(),
            name,
        )),
    }
}
