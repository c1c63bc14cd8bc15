//! Runs experiments and writes what they found: `OUT/PAPER/FIGURE/report.json` and `page.md`, and `OUT/index.md`.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Instant;

use peridyne_io::write::atomic::{create_directory, write_file};
use peridyne_io::write::run_json::deck_hash;
use serde::{Deserialize, Serialize};

use crate::claim::{self, Claim, Value};
use crate::experiment::{Context, Experiment, Failure, Measurement, Takes};
use crate::page;

/// How to run.
pub struct Options<'a> {
    pub out: PathBuf,
    /// The variants for tests: seconds each.
    pub small: bool,
    /// Runs finished figures again.
    pub force: bool,
    pub threads: usize,
    pub progress: &'a (dyn Fn(&str) + Sync),
}

/// `report.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    pub paper: String,
    pub figure: String,
    pub title: String,
    pub version: String,
    pub small: bool,
    /// Hash of the program, the variant, the claims and the sources.
    pub inputs: String,
    pub seconds: f64,
    /// All claims pass.
    pub pass: bool,
    pub claims: Vec<Claim>,
    /// What was measured and is no claim.
    #[serde(default)]
    pub measurements: Vec<Measurement>,
    /// Relative to the folder of the figure.
    pub files: Vec<String>,
}

/// The selection of all papers.
pub const EVERYTHING: &str = "all";

/// What became of a figure.
#[derive(Debug)]
pub enum Outcome {
    Ran(Report),
    /// It was finished before, with the same inputs.
    Kept(Report),
    Failed {
        paper: String,
        figure: String,
        failure: Failure,
    },
}

impl Outcome {
    /// All claims pass.
    pub fn pass(&self) -> bool {
        match self {
            Outcome::Ran(report) | Outcome::Kept(report) => report.pass,
            Outcome::Failed { .. } => false,
        }
    }
}

/// Experiments of a selection: `all` (or none), `seleson2009`, or `seleson2009/figure-4-3`.
///
/// # Errors
/// There is none of this name: names the closest, and all.
pub fn select<'e>(
    all: &[&'e dyn Experiment],
    selection: Option<&str>,
) -> Result<Vec<&'e dyn Experiment>, Failure> {
    let Some(wanted) = selection else {
        return Ok(all.to_vec());
    };
    let wanted = wanted.trim_matches('/');
    if wanted == EVERYTHING {
        return Ok(all.to_vec());
    }
    let chosen: Vec<&dyn Experiment> = all
        .iter()
        .filter(|e| e.key() == wanted || name(**e) == wanted)
        .copied()
        .collect();
    if !chosen.is_empty() {
        return Ok(chosen);
    }
    let mut names: Vec<String> = Vec::new();
    for e in all {
        if !names.iter().any(|n| n == e.key()) {
            names.push(e.key().to_string());
        }
        names.push(name(*e));
    }
    let mut ranked: Vec<(f64, &String)> = names
        .iter()
        .map(|n| (strsim::jaro_winkler(n, wanted), n))
        .filter(|(likeness, _)| *likeness > 0.75)
        .collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    let near: Vec<&str> = ranked.iter().take(3).map(|(_, n)| n.as_str()).collect();
    let advice = if near.is_empty() {
        String::new()
    } else {
        format!(" did you mean {}?", near.join(" or "))
    };
    Err(Failure::new(format!(
        "there is no experiment `{wanted}`:{advice} There are {}",
        names.join(", ")
    )))
}

/// The papers, a line each.
pub fn papers() -> String {
    let mut text = String::new();
    for paper in crate::papers() {
        let figures = paper.figures.len();
        text += &format!("{:<13}{figures:>3} figures  {}\n", paper.key, paper.title);
    }
    text
}

/// The experiments of a selection: what each is, how many claims it has and what its full variant takes.
///
/// # Errors
/// As [`select`]; those of the claims.
pub fn list(selection: Option<&str>) -> Result<String, Failure> {
    let chosen = select(&crate::all(), selection)?;
    let names: Vec<String> = chosen.iter().map(|e| name(*e)).collect();
    let wide = names.iter().map(String::len).max().unwrap_or(0);
    let mut text = String::new();
    for (e, name) in chosen.iter().zip(names) {
        let claims = claim::parse(e.claims())?.len();
        text += &format!(
            "{name:<wide$}  {claims:>3} claims  {:<8} {}\n",
            e.takes(),
            e.title()
        );
    }
    Ok(text)
}

fn name(e: &dyn Experiment) -> String {
    format!("{}/{}", e.key(), e.figure())
}

/// Runs the selected experiments of [`crate::all`], each after the other; one that fails does not stop the others.
///
/// # Errors
/// Nothing has this name; `index.md` cannot be written.
pub fn reproduce(selection: Option<&str>, options: &Options) -> Result<Vec<Outcome>, Failure> {
    reproduce_of(&crate::all(), selection, options)
}

/// The same with other experiments.
///
/// # Errors
/// As [`reproduce`].
pub fn reproduce_of(
    all: &[&dyn Experiment],
    selection: Option<&str>,
    options: &Options,
) -> Result<Vec<Outcome>, Failure> {
    let mut chosen = select(all, selection)?;
    let whole_name = selection.map(|s| s.trim_matches('/'));
    let hours = |e: &dyn Experiment| e.takes() == Takes::Hours;
    chosen.retain(|e| options.small || !hours(*e) || whole_name == Some(&name(*e)));
    let mut outcomes = Vec::new();
    for e in chosen {
        (options.progress)(&format!("{}: {}", name(e), e.title()));
        outcomes.push(one(e, options).unwrap_or_else(|failure| Outcome::Failed {
            paper: e.key().into(),
            figure: e.figure().into(),
            failure,
        }));
    }
    // the index also lists what earlier calls left
    let reports: Vec<Report> = all
        .iter()
        .filter_map(|e| read(&folder(options, *e)))
        .collect();
    let text = page::index(&reports, &outcomes);
    let path = options.out.join("index.md");
    create_directory(&options.out)?;
    write_file(&path, |w| std::io::Write::write_all(w, text.as_bytes()))?;
    Ok(outcomes)
}

fn folder(options: &Options, e: &dyn Experiment) -> PathBuf {
    options.out.join(e.key()).join(e.figure())
}

fn read(folder: &Path) -> Option<Report> {
    let bytes = std::fs::read(folder.join("report.json")).ok()?;
    serde_json::from_slice(&bytes).ok()
}

/// Hash of what the result depends on.
fn inputs(e: &dyn Experiment, small: bool) -> String {
    let mut all = vec![program(), if small { "small" } else { "full" }];
    all.extend([e.key(), e.figure(), e.claims(), e.readme()]);
    all.extend(e.sources());
    // lengths keep texts apart
    let parts: Vec<String> = all.iter().map(|t| format!("{}:{t}", t.len())).collect();
    deck_hash(parts.concat().as_bytes())
}

/// Hash of the running program: whatever is compiled into it may change a result.
fn program() -> &'static str {
    static HASH: OnceLock<String> = OnceLock::new();
    HASH.get_or_init(|| {
        // the file that runs, also where another has taken its name
        let own = Path::new("/proc/self/exe");
        let read = match own.exists() {
            true => std::fs::read(own),
            false => std::env::current_exe().and_then(std::fs::read),
        };
        match read {
            Ok(bytes) => deck_hash(&bytes),
            // unknown: like no other, so that nothing is kept
            Err(_) => format!("{:?} {}", std::time::SystemTime::now(), std::process::id()),
        }
    })
}

/// Every measurement once, and as a number that JSON has.
fn measured(all: Vec<Measurement>) -> Result<Vec<Measurement>, Failure> {
    for (k, m) in all.iter().enumerate() {
        let wrong = |what| Err(Failure::new(format!("the measurement `{}` {what}", m.key)));
        if all[..k].iter().any(|other| other.key == m.key) {
            return wrong("is there twice");
        }
        if matches!(m.value, Value::Number(x) if !x.is_finite()) {
            return wrong("is not a finite number");
        }
    }
    Ok(all)
}

fn one(e: &dyn Experiment, options: &Options) -> Result<Outcome, Failure> {
    let out = folder(options, e);
    let inputs = inputs(e, options.small);
    let published = claim::parse(e.claims())?;
    let same = |r: &Report| r.inputs == inputs && r.files.iter().all(|f| out.join(f).exists());
    if let Some(report) = read(&out).filter(|r| same(r) && !options.force) {
        return Ok(Outcome::Kept(report));
    }
    create_directory(&out)?;
    // a run that is cut off must not look finished
    let path = out.join("report.json");
    if path.exists() {
        std::fs::remove_file(&path)
            .map_err(|e| Failure::new(format!("cannot remove the old {}: {e}", path.display())))?;
    }
    if options.force {
        let parts = out.join(".parts");
        if parts.exists() {
            std::fs::remove_dir_all(&parts)
                .map_err(|e| Failure::new(format!("cannot remove {}: {e}", parts.display())))?;
        }
    }
    let context = Context {
        out: out.clone(),
        small: options.small,
        threads: options.threads,
        inputs: inputs.clone(),
        progress: options.progress,
    };
    let start = Instant::now();
    let findings = e.run(&context)?;
    let seconds = start.elapsed().as_secs_f64();
    let claims = claim::compare(&published, &findings.values, options.small)?;
    let measurements = measured(findings.measurements)?;
    let mut files = Vec::new();
    for file in &findings.files {
        let inside = file.strip_prefix(&out).ok().filter(|_| file.exists());
        let inside = inside.ok_or_else(|| {
            Failure::new(format!(
                "{} was not written into {}",
                file.display(),
                out.display()
            ))
        })?;
        files.push(inside.to_string_lossy().replace('\\', "/"));
    }
    let report = Report {
        paper: e.key().into(),
        figure: e.figure().into(),
        title: e.title().into(),
        version: env!("CARGO_PKG_VERSION").into(),
        small: options.small,
        inputs,
        seconds,
        pass: claims.iter().all(|c| c.pass),
        claims,
        measurements,
        files,
    };
    let text = page::page(&report, e.readme());
    write_file(&out.join("page.md"), |w| {
        std::io::Write::write_all(w, text.as_bytes())
    })?;
    write_file(&path, |w| {
        serde_json::to_writer_pretty(&mut *w, &report)?;
        std::io::Write::write_all(w, b"\n")
    })?;
    Ok(Outcome::Ran(report))
}
