//! Opens what a script reads, by the door of all files.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use peridyne_io::read::source;

use crate::error::{Problem, Result};
use peridyne_io::read::encoding;

/// Bytes of a script, or of a file of values.
const LARGEST_TEXT: u64 = 16 << 20;

/// Opens a text file. Devices and pipes may have no end: they are refused.
pub(crate) fn open(path: &Path, shown: &str) -> Result<BufReader<File>> {
    let file = source::open(path);
    file.map(BufReader::new)
        .map_err(|e| Problem::new(format!("cannot open {shown}: {e}")))
}

/// The text of a whole file.
pub(crate) fn text(path: &Path, shown: &str) -> Result<String> {
    let bytes = source::within(open(path, shown)?, LARGEST_TEXT)
        .map_err(|e| Problem::new(format!("cannot read {shown}: {e}")))?;
    encoding::text(bytes, 0).map_err(|e| Problem::new(format!("{shown}: {e}")))
}
