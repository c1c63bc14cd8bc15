//! `report.html`: a run in one file that needs no network. Made of the files of a folder of results alone, so that `peridyne report`
//! and the end of a run give the same.

mod head;
pub mod history;
mod law;
mod pack;
mod page;
mod quantise;
mod scene;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::atomic::{WriteError, write_file};
use super::run_json::{self, Setting};
use crate::read::{ReadError, source, text_of};
use page::{Counted, Texts};
use scene::Scene;

/// Bytes of a report, about: what people send and what telephones open.
const MOST: usize = 5_000_000;
/// Bytes of the pictures in it.
const PICTURES: u64 = 1_500_000;
/// The least that is left to the points, however long texts are.
const LEAST: usize = 1_000_000;

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    #[error("{} is no folder of results: it has no run.json", .0.display())]
    NoRun(PathBuf),
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// A report that was written.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    pub path: PathBuf,
    pub bytes: usize,
    /// What is not as in the files, in sentences.
    pub notes: Vec<String>,
}

/// The name of the report in its folder.
pub const NAME: &str = "report.html";

/// Writes `report.html` into a folder of results.
///
/// # Errors
/// No `run.json`, a file that is damaged, or the operating system's.
pub fn write(dir: &Path) -> Result<Made, ReportError> {
    let path = dir.join("run.json");
    let (text, _) = text_of(&path).map_err(|_| ReportError::NoRun(dir.into()))?;
    let mut run: Value =
        serde_json::from_str(&text).map_err(|e| ReadError::file(&path, e.to_string()))?;
    run_json::today(&mut run);
    let setting = run.as_object_mut().and_then(|r| r.remove("setting"));
    let setting = match setting {
        Some(value) => {
            serde_json::from_value(value).map_err(|e| ReadError::file(&path, e.to_string()))?
        }
        None => Setting {
            files: usual(dir),
            ..Setting::default()
        },
    };
    Report::gather(dir, run, setting)?.write(dir)
}

/// What a folder may hold whose run was ended from outside and still gets a report: about a second of reading.
const SOON: u64 = 200_000_000;

/// The report of a run that has just ended. Who ended it from outside does not wait long: with more than 200 MB of results there is none,
/// nor one of an earlier run.
///
/// # Errors
/// As [`write()`].
pub fn of_run(dir: &Path, ended: bool) -> Result<Option<Made>, ReportError> {
    if ended && held(dir) > SOON {
        let old = dir.join(NAME);
        if old.is_file() {
            std::fs::remove_file(&old).map_err(WriteError::at("remove", &old))?;
        }
        return Ok(None);
    }
    write(dir).map(Some)
}

/// Bytes of the files of a folder.
fn held(dir: &Path) -> u64 {
    let entries = std::fs::read_dir(dir).into_iter().flatten();
    let sizes = entries.filter_map(|e| Some(e.ok()?.metadata().ok()?.len()));
    sizes.sum()
}

/// What a folder of an older version may have.
fn usual(dir: &Path) -> Vec<String> {
    let names = ["history.csv", "points.pvd", "frames.npz", "damage.png"];
    let there = names.iter().filter(|n| dir.join(n).is_file());
    there.map(|n| (*n).to_string()).collect()
}

/// What a report is made of.
struct Report {
    run: Value,
    setting: Setting,
    history: Vec<history::Column>,
    /// With their labels and titles.
    scenes: Vec<(Scene, &'static str, &'static str)>,
    /// Names and bytes.
    pictures: Vec<(String, Vec<u8>)>,
    notes: Vec<String>,
}

impl Report {
    fn gather(dir: &Path, run: Value, setting: Setting) -> Result<Report, ReportError> {
        let has = |name: &str| setting.files.iter().any(|f| f == name) && dir.join(name).is_file();
        let mut history = match has("history.csv") {
            true => history::read(&dir.join("history.csv"))?,
            false => vec![],
        };
        let mut scenes = vec![];
        let ends = |ends: &[&str]| {
            let mut all = setting.files.iter();
            all.find(|f| ends.iter().any(|e| f.ends_with(e)) && dir.join(f).is_file())
        };
        let mut notes = vec![];
        let clock = history::clock(&history);
        match scene::of_dumps(dir, &setting, &clock) {
            Ok(scene) => scenes.extend(scene.map(|s| (s, "Frames of the dumps", "Points"))),
            Err(mut e) => {
                // by its name in the folder: a report is the same wherever that stands
                if let Ok(own) = Path::new(&e.file).strip_prefix(dir) {
                    e.file = own.display().to_string();
                }
                notes.push(format!("Frames of dumps are not drawn: {e}"));
            }
        }
        if has("points.pvd") {
            let label = match scenes.is_empty() {
                true => "Frames of the run",
                false => "The last state",
            };
            let scene = scene::of_collection(dir, "points.pvd", "run", &setting)?;
            scenes.extend(scene.map(|s| (s, label, "Body")));
        } else if has("frames.npz") {
            let scene = law::read(&dir.join("frames.npz"), &setting)?;
            scenes.extend(scene.map(|s| (s, "Frames of the run", "Solution")));
        } else if let Some(name) = ends(&[".extxyz", ".xyz"]).or(ends(&[".lammpstrj", ".dump"]))
            && setting.atoms
        {
            let scene = scene::of_trajectory(&dir.join(name), &setting)?;
            scenes.extend(scene.map(|s| (s, "Frames of the run", "Atoms")));
        }
        if has("modes/points.pvd") {
            let scene = scene::of_collection(dir, "modes/points.pvd", "modes", &setting)?;
            scenes.extend(scene.map(|s| (s, "Modes of vibration", "Body")));
        }
        for (scene, ..) in &mut scenes {
            let same = scene.fields.iter().filter_map(|f| Some((f, f.constant()?)));
            let same: Vec<String> = same
                .map(|(f, v)| format!("{} = {v}", f.name.replace('_', " ")))
                .collect();
            scene.fields.retain(|f| f.constant().is_none());
            if !same.is_empty() {
                let text = format!("The same in all points and frames: {}.", same.join(", "));
                scene.notes.push(text);
            }
        }
        // an equilibrium is not at a time
        if setting.statics
            && let Some(time) = history.iter_mut().find(|c| c.name == "time")
        {
            time.name = history::LOAD.into();
            time.unit = String::new();
        }
        let mut pictures = vec![];
        let mut room = PICTURES;
        let drawn = scenes.is_empty() || run["kind"] == "conservation_law";
        let own = { setting.files.iter() }.filter(|f| drawn && f.ends_with(".png"));
        // films move, which who reads did not ask for
        let still = setting.slices.iter().filter(|f| !f.contains("_film."));
        for name in own.chain(still) {
            let path = dir.join(name);
            let Ok(bytes) = source::bytes(&path) else {
                continue;
            };
            match room.checked_sub(bytes.len() as u64) {
                Some(left) => {
                    room = left;
                    pictures.push((name.clone(), bytes));
                }
                None => notes.push(format!("The picture {name} is too large for the report.")),
            }
        }
        if has("bonds.pvd") {
            notes.push("Bonds as lines are in bonds.pvd only.".into());
        }
        Ok(Report {
            run,
            setting,
            history,
            scenes,
            pictures,
            notes,
        })
    }

    fn write(self, dir: &Path) -> Result<Made, ReportError> {
        let path = dir.join(NAME);
        let title = self.run["title"].as_str().unwrap_or("");
        let title = if title.is_empty() {
            "A run of peridyne"
        } else {
            title
        };
        let mut notes = self.notes.clone();
        let (history, note) = match self.history.is_empty() {
            true => (Value::Null, None),
            false => history::shown(&self.history),
        };
        notes.extend(note);
        let mut blocks: Vec<Vec<u8>> = vec![];
        let pictures = self.pictures.into_iter().map(|(name, bytes)| {
            blocks.push(bytes);
            json!({"at": blocks.len() - 1, "name": name, "says": format!("Picture of the run: {name}")})
        });
        let pictures: Vec<Value> = pictures.collect();
        let mut meta = json!({
            "run": self.run, "history": history, "pictures": pictures, "units": self.setting.units, "scenes": [],
            "facts": head::facts(&self.run, &self.setting, &self.history),
            "subtitle": head::subtitle(&self.run), "command": self.setting.command, "deck": self.setting.deck_text,
            "sources": self.setting.sources, "cite": head::cite(&self.run), "files": head::files(dir, &self.setting), "notes": [],
        });
        let texts = |meta: &str| {
            let texts = Texts {
                title,
                understood: &self.setting.understood,
                deck: &self.setting.deck_text,
                meta,
            };
            page::length(&texts)
        };
        let written = |blocks: &[Vec<u8>]| -> usize {
            let each = blocks.iter();
            each.map(|b| b.len().div_ceil(3) * 4).sum()
        };
        let taken = texts(&meta.to_string()) + written(&blocks);
        let mut room = MOST.saturating_sub(taken + 20_000).max(LEAST);
        let many = self.scenes.len();
        let mut scenes = vec![];
        for (n, (scene, label, title)) in self.scenes.iter().enumerate() {
            // modes are few, and come second
            let part = if n + 1 < many { room / 4 * 3 } else { room };
            let told = json!({
                "label": label, "title": title, "first": head::first(scene, &self.run, &self.setting),
                "statics": self.setting.statics, "length": self.setting.units.length,
                "balls": if scene.kind == "run" { &self.setting.rigid_bodies[..] } else { &[] },
                "marks": if scene.kind == "run" { json!(self.setting.marks) } else { Value::Null },
                "axis": match (scene.kind, scene.stepped) { ("modes", _) => "frequency", (_, true) => "step", (_, false) => "time" },
                "unit": match (scene.kind, &*self.setting.units.time) {
                    (_, _) if scene.stepped => String::new(),
                    ("modes", "s") => "Hz".to_string(),
                    ("modes", "") => String::new(),
                    ("modes", time) => format!("1/{time}"),
                    (_, time) => time.to_string(),
                },
            });
            let packed = pack::pack(scene, part, blocks.len(), told)
                .map_err(WriteError::at("write", &path))?;
            for note in packed.scene["notes"].as_array().into_iter().flatten() {
                let note = note.as_str().unwrap_or("").to_string();
                if !notes.contains(&note) {
                    notes.push(note);
                }
            }
            scenes.push(packed.scene);
            room = room.saturating_sub(written(&packed.blocks));
            blocks.extend(packed.blocks);
        }
        meta["scenes"] = scenes.into();
        meta["notes"] = notes.clone().into();
        let meta = meta.to_string();
        let texts = Texts {
            title,
            understood: &self.setting.understood,
            deck: &self.setting.deck_text,
            meta: &meta,
        };
        let mut bytes = 0;
        write_file(&path, |w| {
            let mut out = Counted::new(w);
            page::page(&mut out, &texts, &blocks)?;
            bytes = out.bytes;
            Ok(())
        })?;
        Ok(Made { path, bytes, notes })
    }
}

/// A number in seven digits; what is no number is `null`.
fn short(value: f64) -> Value {
    match format!("{value:.6e}").parse::<f64>() {
        Ok(v) if v.is_finite() => v.into(),
        _ => Value::Null,
    }
}

#[cfg(test)]
mod tests;
