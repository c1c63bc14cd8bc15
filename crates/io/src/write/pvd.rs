//! ParaView collection (`.pvd`): which file shows which time.
//!
//! Rewritten whole and atomically after each new file, so the collection of a killed run opens and lists
//! exactly the snapshots that are complete.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::atomic::{WriteError, write_file};
use super::grown::Seal;
use peridyne::state::{Archive, Owner};

/// A collection file and what it lists.
#[derive(Debug, Clone)]
pub struct Pvd {
    path: PathBuf,
    /// Time, name and what is in the file.
    entries: Vec<(f64, String, Seal)>,
}

impl Pvd {
    /// An empty collection; nothing is written before the first [`Pvd::push`].
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Pvd {
            path: path.into(),
            entries: Vec::new(),
        }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Names of the files that it lists.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|(_, file, _)| &**file)
    }

    /// Adds a file (relative to the collection) at a time and rewrites the collection. A file that is listed
    /// already gets the new time.
    pub fn push(&mut self, time: f64, file: &str, seal: Seal) -> Result<(), WriteError> {
        self.entries.retain(|(_, listed, _)| listed != file);
        self.entries.push((time, file.to_string(), seal));
        self.write()
    }

    /// Are the files that it lists as they were when they were pushed?
    ///
    /// # Errors
    /// The first that is not.
    pub fn holds(&self) -> Result<(), WriteError> {
        let mut entries = self.entries.iter();
        entries.try_for_each(|(_, file, seal)| seal.holds(&self.path.with_file_name(file)))
    }

    /// Writes what it lists.
    pub fn write(&self) -> Result<(), WriteError> {
        write_file(&self.path, |w| {
            writeln!(w, r#"<?xml version="1.0"?>"#)?;
            writeln!(
                w,
                r#"<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">"#
            )?;
            writeln!(w, "<Collection>")?;
            for (time, file, _) in &self.entries {
                let file = escape(file);
                writeln!(
                    w,
                    r#"<DataSet timestep="{time:?}" group="" part="0" file="{file}"/>"#
                )?;
            }
            writeln!(w, "</Collection>\n</VTKFile>")
        })
    }
}

impl Owner for Pvd {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let none = || (0.0, String::new(), Seal::default());
        archive.items("files", &mut self.entries, none, |entry, archive| {
            let (time, file, seal) = entry;
            archive.one("time", time);
            archive.text("name", file);
            archive.part("file", seal);
        });
    }
}

/// Text inside an XML attribute.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_collection_is_whole_after_every_push() {
        let dir = tempfile::tempdir().unwrap();
        let mut pvd = Pvd::new(dir.path().join("points.pvd"));
        for (time, file, listed) in [
            (0.0, "a.vtu", 1),
            (1e-7, "b<&\".vtu", 2),
            (2e-7, "a.vtu", 2),
        ] {
            pvd.push(time, file, Seal::default()).unwrap();
            let text = std::fs::read_to_string(pvd.path()).unwrap();
            assert!(text.ends_with("</Collection>\n</VTKFile>\n"));
            assert_eq!(text.matches("<DataSet").count(), listed);
            assert!(text.contains(&format!(r#"timestep="{time:?}""#)));
        }
        let text = std::fs::read_to_string(pvd.path()).unwrap();
        assert!(text.contains(r#"file="b&lt;&amp;&quot;.vtu""#));
        assert!(!text.contains(r#"timestep="0.0""#));
    }
}
