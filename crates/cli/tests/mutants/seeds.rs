//! Good files, a folder for each format; `command` says what runs, and on which of the files.

use std::path::Path;

/// What is changed, and what then runs.
pub struct Seed {
    pub format: String,
    /// Names in the folder, and what is in them.
    pub files: Vec<(String, Vec<u8>)>,
    /// Those of them that are changed.
    pub changed: Vec<usize>,
    pub arguments: Vec<String>,
}

/// `run` runs a command in a folder.
pub fn seeds(run: impl Fn(&[String], &Path)) -> Vec<Seed> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/mutants/seeds");
    let mut all: Vec<_> = { std::fs::read_dir(&folder).unwrap() }
        .map(|entry| entry.unwrap().path())
        .collect();
    all.sort();
    all.iter().map(|folder| seed(folder, &run)).collect()
}

fn seed(folder: &Path, run: impl Fn(&[String], &Path)) -> Seed {
    let dir = tempfile::tempdir().unwrap();
    for (name, bytes) in files(folder, "") {
        std::fs::write(dir.path().join(name), bytes).unwrap();
    }
    let text = std::fs::read_to_string(folder.join("command")).unwrap();
    let mut lines: Vec<Vec<String>> = { text.lines() }
        .map(|l| l.split(' ').map(String::from).collect())
        .collect();
    let arguments = lines.pop().unwrap();
    let mut of = None;
    for line in lines {
        match line[0] == "of" {
            true => of = Some(line[1..].to_vec()),
            false => run(&line, dir.path()),
        }
    }
    let files: Vec<_> = { files(dir.path(), "").into_iter() }
        .filter(|(name, _)| name != "command")
        .collect();
    let is = |name: &str| {
        of.as_ref()
            .is_none_or(|all| all.iter().any(|end| name.ends_with(end)))
    };
    let changed = (0..files.len()).filter(|n| is(&files[*n].0)).collect();
    Seed {
        format: folder.file_name().unwrap().to_string_lossy().into_owned(),
        files,
        changed,
        arguments,
    }
}

/// All files of a folder and of those in it.
fn files(folder: &Path, before: &str) -> Vec<(String, Vec<u8>)> {
    let mut all = vec![];
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = format!("{before}{}", path.file_name().unwrap().to_string_lossy());
        match path.is_dir() {
            true => all.extend(files(&path, &format!("{name}/"))),
            false => all.push((name, std::fs::read(&path).unwrap())),
        }
    }
    all.sort();
    all
}

impl Seed {
    /// All of it in a folder.
    pub fn write(&self, folder: &Path) {
        for (name, bytes) in &self.files {
            let path = folder.join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, bytes).unwrap();
        }
    }
}
