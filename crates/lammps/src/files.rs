//! Where a script may write: inside its output folder or beside itself, unless it is told that it may write anywhere. A
//! script that is only checked writes nothing at all. No file takes the place of one that was read, of one that is being
//! written, or, where there is no output folder, of one that the script has not made before.

use std::cell::RefCell;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use peridyne::state::{Archive, Owner};
use peridyne_io::write::folder::is_own;
use peridyne_io::write::{Seal, Summed};

use peridyne_io::read::source;

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
    /// Are results of the program's own in the folder, too?
    pub shared: bool,
    /// Files that the script has made, whole paths: no other that is there is replaced. `None`: any is.
    pub made: Option<Rc<RefCell<Vec<PathBuf>>>>,
    /// Files that are being written.
    pub open: Rc<RefCell<Vec<PathBuf>>>,
    /// Files that were written, and what is in them.
    pub closed: Rc<RefCell<Vec<(PathBuf, Seal)>>>,
}

/// A text file that is being written. What was [flushed](Sink::flush) is whole; of what does not fit nothing is kept.
pub struct Sink {
    path: PathBuf,
    /// `None`: nothing is written.
    out: Option<BufWriter<Summed<File>>>,
    /// What is whole.
    whole: Seal,
    /// Where relative names start from.
    home: PathBuf,
    open: Rc<RefCell<Vec<PathBuf>>>,
    closed: Rc<RefCell<Vec<(PathBuf, Seal)>>>,
}

/// The path of a file as it is called from `home`, which may be called otherwise when a script goes on.
pub fn archive_path(archive: &mut Archive<'_>, home: &Path, path: &mut PathBuf) {
    let inside = path.strip_prefix(home).unwrap_or(path);
    let mut name = inside.to_string_lossy().into_owned();
    archive.text("path", &mut name);
    *path = home.join(name);
}

impl Drop for Sink {
    fn drop(&mut self) {
        // who asks for errors has flushed it
        if self.out.is_some() && self.flush().is_ok() {
            let mut closed = self.closed.borrow_mut();
            closed.retain(|(path, _)| *path != self.path);
            closed.push((self.path.clone(), self.whole));
        }
        let mut open = self.open.borrow_mut();
        if let Some(k) = open.iter().position(|p| *p == self.path) {
            open.swap_remove(k);
        }
    }
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
        let written = match &mut self.out {
            Some(out) => out.write_all(bytes),
            None => Ok(()),
        };
        written.map_err(|e| self.cut(&e))
    }

    /// Cuts off what did not get in whole; nothing more is written.
    fn cut(&mut self, error: &std::io::Error) -> Box<Problem> {
        if let Some(out) = self.out.take() {
            // what is buffered must not follow
            let (file, _) = out.into_parts();
            // if cutting fails too, the error tells more
            let _ = file.inner().set_len(self.whole.length);
        }
        Box::new(Problem {
            while_running: true,
            ..*failed(&self.path, error)
        })
    }

    /// A line.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn line(&mut self, text: &str) -> Result<()> {
        self.write(text)?;
        self.write("\n")
    }

    /// A record ends here.
    ///
    /// # Errors
    /// The file cannot be written; it then ends with the record before.
    pub fn flush(&mut self) -> Result<()> {
        let flushed = match &mut self.out {
            Some(out) => out.flush(),
            None => Ok(()),
        };
        flushed.map_err(|e| self.cut(&e))?;
        if let Some(out) = &self.out {
            self.whole = out.get_ref().seal();
        }
        Ok(())
    }

    /// Goes on behind what the state says of it.
    ///
    /// # Errors
    /// The file is not as it was.
    pub fn go_on(&mut self) -> Result<()> {
        // a device holds nothing
        let file = match self.path.metadata().is_ok_and(|m| !m.is_file()) {
            true => File::options()
                .append(true)
                .open(&self.path)
                .map_err(|e| failed(&self.path, &e))?,
            false => self
                .whole
                .cut_back(&self.path)
                .map_err(|e| Problem::new(e.to_string()))?,
        };
        source::made(&file);
        self.out = Some(BufWriter::new(Summed::after(file, self.whole)));
        self.open.borrow_mut().push(self.path.clone());
        Ok(())
    }
}

/// What is in it and where; one that was read [goes on](Sink::go_on) when it is told to.
impl Owner for Sink {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        // an error shows at the next line
        let _ = self.flush();
        archive_path(archive, &self.home, &mut self.path);
        archive.part("whole", &mut self.whole);
    }
}

/// What was written and closed.
impl Owner for Folder {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let mut closed = self.closed.borrow_mut();
        let none = || (PathBuf::new(), Seal::default());
        archive.items("closed", &mut closed, none, |(path, seal), archive| {
            archive_path(archive, &self.output, path);
            archive.part("whole", seal);
        });
    }
}

impl Folder {
    /// The path of a file that the script names, if it may be written.
    ///
    /// # Errors
    /// It lies outside.
    pub fn path(&self, name: &str) -> Result<PathBuf> {
        let path = self.output.join(name);
        if self.shared && is_own(Path::new(name)) {
            return Err(
                Problem::new(format!("`{name}` is the name of a file of the results"))
                    .help("write another name"),
            );
        }
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
        let (open, closed) = (self.open.clone(), self.closed.clone());
        if open.borrow().contains(&path) {
            let wrong = format!("`{name}` is being written by another command");
            return Err(Problem::new(wrong).help("give each its own file"));
        }
        let sink = |path, out, whole| Sink {
            path,
            out,
            whole,
            home: self.output.clone(),
            open,
            closed,
        };
        if self.dry {
            return Ok(sink(path, None, Seal::default()));
        }
        self.replaceable(&path)?;
        let there = match append {
            true => self.there(&path)?,
            false => Seal::default(),
        };
        let file = File::options()
            .create(true)
            .write(true)
            .append(append)
            .truncate(!append)
            .open(&path)
            .map_err(|e| failed(&path, &e))?;
        self.has_made(&path, &file);
        // what is in it is the new one's to say
        self.closed.borrow_mut().retain(|(p, _)| *p != path);
        self.open.borrow_mut().push(path.clone());
        let file = BufWriter::new(Summed::after(file, there));
        Ok(sink(path, Some(file), there))
    }

    /// A file that nothing is written to before a state says which it is.
    pub fn waiting(&self) -> Sink {
        Sink {
            path: PathBuf::new(),
            out: None,
            whole: Seal::default(),
            home: self.output.clone(),
            open: self.open.clone(),
            closed: self.closed.clone(),
        }
    }

    /// What is in a file that is appended to.
    fn there(&self, path: &Path) -> Result<Seal> {
        let found = path.metadata().ok().filter(std::fs::Metadata::is_file);
        let Some(length) = found.map(|m| m.len()) else {
            return Ok(Seal::default());
        };
        let closed = self.closed.borrow();
        let known = { closed.iter() }
            .find(|(p, seal)| p == path && seal.length == length)
            .map(|(_, seal)| *seal);
        match known {
            Some(seal) => Ok(seal),
            None => File::open(path)
                .and_then(|mut file| Seal::of(&mut file, length))
                .map_err(|e| failed(path, &e)),
        }
    }

    /// Cuts files back that were written, closed and then appended to; what is another file now is written anew.
    pub fn cut_back(&self) {
        for (path, seal) in self.closed.borrow().iter() {
            if path
                .metadata()
                .is_ok_and(|m| m.is_file() && m.len() > seal.length)
            {
                // not as it was: a command writes it anew
                let _ = seal.cut_back(path);
            }
        }
    }

    /// May a file take this place?
    fn replaceable(&self, path: &Path) -> Result<()> {
        source::replaceable(path).map_err(|e| failed(path, &e))?;
        let Some(made) = &self.made else {
            return Ok(());
        };
        let theirs = |real: PathBuf| real.is_file() && !made.borrow().contains(&real);
        match path.canonicalize().is_ok_and(theirs) {
            false => Ok(()),
            true => Err(Problem::new(format!(
                "{} is there already, and this script has not made it",
                path.display()
            ))
            .help("choose a folder with --out, move the file away, or let the script replace it with --allow-outside")),
        }
    }

    /// A file that is there now is the script's.
    fn has_made(&self, path: &Path, file: &File) {
        source::made(file);
        if let (Some(made), Ok(real)) = (&self.made, path.canonicalize()) {
            let mut made = made.borrow_mut();
            if !made.contains(&real) {
                made.push(real);
            }
        }
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
        self.replaceable(&path)?;
        std::fs::rename(&sink.path, &path).map_err(|e| failed(&path, &e))?;
        if let Some(out) = &sink.out {
            self.has_made(&path, out.get_ref().inner());
        }
        Ok(())
    }
}
