//! Opens what a script reads.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use crate::error::{Problem, Result};
use peridyne_io::read::encoding;

/// Bytes of a script, or of a file of values.
const LARGEST_TEXT: u64 = 16 << 20;

/// Opens a text file. Devices and pipes may have no end: they are refused.
pub(crate) fn open(path: &Path, shown: &str) -> Result<BufReader<File>> {
    let cannot = |e| Problem::new(format!("cannot open {shown}: {e}"));
    let file = std::fs::metadata(path).map_err(cannot)?;
    if !file.is_file() {
        return Err(Problem::new(format!("{shown} is not a file"))
            .help("a folder, device or pipe cannot be read: write the name of a file"));
    }
    File::open(path).map(BufReader::new).map_err(cannot)
}

/// The text of a whole file.
pub(crate) fn text(path: &Path, shown: &str) -> Result<String> {
    let mut bytes = Vec::new();
    let read = open(path, shown)?
        .take(LARGEST_TEXT + 1)
        .read_to_end(&mut bytes);
    read.map_err(|e| Problem::new(format!("cannot read {shown}: {e}")))?;
    if bytes.len() as u64 > LARGEST_TEXT {
        return Err(Problem::new(format!(
            "{shown} is larger than {} MiB, which no script is",
            LARGEST_TEXT >> 20
        )));
    }
    encoding::text(bytes, 0).map_err(|e| Problem::new(format!("{shown}: {e}")))
}
