//! Where the files of a run go: inside the folder of the results, and in the place of none that the run has read.

use std::io;
use std::path::Path;

use super::plan::Plan;
use crate::read::source;
use crate::write::WriteError;
use crate::write::folder::{is_inside, is_own, plain};

impl Plan {
    /// Files that the deck names.
    fn named(&self) -> impl Iterator<Item = &Path> {
        let atoms = self.atoms.iter().flat_map(|a| {
            let trajectories = a.trajectories.iter().map(|(path, _)| path);
            trajectories.chain(&a.data)
        });
        let points = self.series.dump.iter().map(|(name, _)| name);
        let exodus = self.exodus.iter().map(|e| &e.path);
        let named = atoms.chain(points).chain(exodus).chain(&self.output.vtkhdf);
        named.map(|p| &**p)
    }

    /// Folders of files in that of the results.
    fn folders(&self) -> impl Iterator<Item = &Path> {
        let fields = self.continuum.iter().flat_map(|c| &c.asked);
        let modes = (self.modes > 0).then_some(Path::new("modes"));
        fields.map(|f| Path::new(&f.name)).chain(modes)
    }

    /// Do the files that the deck names, and folders of its fields, lie inside the folder of the results, links included, or
    /// may they be anywhere?
    pub(super) fn stays_inside(&self) -> Result<(), WriteError> {
        let within = self.folders().map(|f| f.join("file"));
        let named = self.named().map(Path::to_path_buf);
        for name in named.chain(within) {
            if !self.allow_outside && !is_inside(&self.dir, &name) {
                let path = self.dir.join(name);
                let error = io::Error::other("it is outside the folder of the results");
                return Err(WriteError::at("write", &path)(error));
            }
        }
        Ok(())
    }

    /// Would any file of this run take the place of one that was read?
    ///
    /// # Errors
    /// The first that would.
    pub fn replaces_nothing(&self) -> Result<(), WriteError> {
        let all = source::read_inside(&self.dir);
        let replaced = all.iter().find(|name| {
            let named = || self.named().any(|n| plain(n) == **name);
            let within = || self.folders().any(|f| name.starts_with(plain(f)));
            is_own(name) || named() || within()
        });
        let told = replaced.map(|name| self.dir.join(name));
        // links and other names of a file
        let other = self.named().map(|n| self.dir.join(n));
        match told.or_else(|| other.into_iter().find(|path| source::was_read(path))) {
            None => Ok(()),
            Some(path) => Err(WriteError::at("write", &path)(source::kept())),
        }
    }
}
