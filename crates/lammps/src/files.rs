//! Where a script may write: inside its output folder or beside itself, unless it is told that it may write anywhere. A
//! script that is only checked writes nothing at all.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::error::{Problem, Result};

/// The folder that relative names start from, and what is allowed.
#[derive(Debug, Clone, Default)]
pub struct Folder {
    /// The current one if empty.
    pub output: PathBuf,
    /// Where the script lies; the current one if empty.
    pub script: PathBuf,
    /// Anywhere else, too.
    pub outside: bool,
    /// Nothing is written.
    pub dry: bool,
}

/// A text file that is being written.
pub struct Sink {
    path: PathBuf,
    /// `None`: nothing is written.
    out: Option<BufWriter<File>>,
}

impl std::fmt::Debug for Sink {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "Sink({})", self.path.display())
    }
}

fn failed(path: &Path, error: &std::io::Error) -> Box<Problem> {
    Problem::new(format!("cannot write {}: {error}", path.display()))
}

impl Sink {
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, text: &str) -> Result<()> {
        self.write_bytes(text.as_bytes())
    }

    /// # Errors
    /// The file cannot be written.
    pub fn write_bytes(&mut self, bytes: &[u8]) -> Result<()> {
        match &mut self.out {
            Some(out) => out.write_all(bytes).map_err(|e| failed(&self.path, &e)),
            None => Ok(()),
        }
    }

    /// A line.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn line(&mut self, text: &str) -> Result<()> {
        self.write(text)?;
        self.write("\n")
    }

    /// # Errors
    /// The file cannot be written.
    pub fn flush(&mut self) -> Result<()> {
        match &mut self.out {
            Some(out) => out.flush().map_err(|e| failed(&self.path, &e)),
            None => Ok(()),
        }
    }
}

impl Folder {
    /// The path of a file that the script names, if it may be written.
    ///
    /// # Errors
    /// It lies outside.
    pub fn path(&self, name: &str) -> Result<PathBuf> {
        let path = self.output.join(name);
        if self.outside || self.dry || path == Path::new("/dev/null") {
            return Ok(path);
        }
        let plain = |p: &Path| {
            let p = if p.as_os_str().is_empty() {
                Path::new(".")
            } else {
                p
            };
            p.canonicalize()
        };
        let roots = [&self.output, &self.script].map(|r| plain(r).ok());
        // a link leads where it leads
        let real = match path.symlink_metadata() {
            Ok(m) if m.file_type().is_symlink() => path.canonicalize(),
            _ => plain(path.parent().unwrap_or(Path::new("."))).map(|p| {
                let last = path.file_name();
                last.map_or(p.clone(), |name| p.join(name))
            }),
        };
        let real = real.map_err(|e| failed(&path, &e))?;
        if path.file_name().is_none() {
            return Err(Problem::new(format!("`{name}` is not the name of a file")));
        }
        if roots.iter().flatten().any(|root| real.starts_with(root)) {
            return Ok(path);
        }
        let shown = |p: &Path| {
            let p = plain(p).unwrap_or_else(|_| p.to_path_buf());
            p.display().to_string()
        };
        Err(Problem::new(format!(
            "`{name}` lies outside the output folder {}",
            shown(&self.output)
        ))
        .help("write a name inside it, choose the folder with --out, or let the script write anywhere with --allow-outside"))
    }

    /// Does a file that is to be read lie beside the script or in the output folder?
    ///
    /// # Errors
    /// It does not.
    pub fn inside(&self, path: &Path) -> Result<()> {
        let real = |p: &Path| {
            let p = if p.as_os_str().is_empty() {
                Path::new(".")
            } else {
                p
            };
            p.canonicalize().ok()
        };
        let roots = [real(&self.output), real(&self.script)];
        // what is not there is an error of whoever reads it
        match real(path) {
            Some(real) if !self.outside && !roots.iter().flatten().any(|r| real.starts_with(r)) => {
                Err(
                    Problem::new(format!("{} does not lie beside the script", path.display()))
                        .help("copy it there, or run the script with --allow-outside"),
                )
            }
            _ => Ok(()),
        }
    }

    /// Opens a file for writing, or for writing at its end.
    ///
    /// # Errors
    /// It lies outside, or cannot be opened.
    pub fn open(&self, name: &str, append: bool) -> Result<Sink> {
        let path = self.path(name)?;
        if self.dry {
            return Ok(Sink { path, out: None });
        }
        let file = File::options()
            .create(true)
            .write(true)
            .append(append)
            .truncate(!append)
            .open(&path)
            .map_err(|e| failed(&path, &e))?;
        Ok(Sink {
            path,
            out: Some(BufWriter::new(file)),
        })
    }

    /// Opens a file that takes its name when it is whole, with [`Folder::whole`].
    ///
    /// # Errors
    /// It lies outside, or cannot be opened.
    pub fn open_part(&self, name: &str) -> Result<Sink> {
        self.path(name)?;
        self.open(&format!("{name}.part"), false)
    }

    /// Gives a file of [`Folder::open_part`] its name.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn whole(&self, name: &str, mut sink: Sink) -> Result<()> {
        sink.flush()?;
        if self.dry {
            return Ok(());
        }
        let path = self.path(name)?;
        std::fs::rename(&sink.path, &path).map_err(|e| failed(&path, &e))
    }
}
