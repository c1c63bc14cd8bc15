//! What an earlier run left in the folder: a folder tells of one run, and frames of two of them, with other times, would be taken for one
//! series by whatever opens `points_*.vtu`.

use std::fs;
use std::io;
use std::path::Path;

use serde_json::Value;

use super::atomic::WriteError;
use super::folder::SPACE_TIME;
use crate::read::vtu::collected;

/// Names that are told in a warning.
const TOLD: usize = 3;

/// Is it `points_00000012.vtu`, a frame of this kind?
fn is_frame(name: &str, kind: &str) -> bool {
    let rest = name.strip_prefix(kind).and_then(|n| n.strip_prefix('_'));
    let number = rest.and_then(|n| n.strip_suffix(".vtu"));
    number.is_some_and(|n| n.len() >= 8 && n.bytes().all(|b| b.is_ascii_digit()))
}

fn remove(dir: &Path, name: &str) -> Result<(), WriteError> {
    let path = dir.join(name);
    match fs::remove_file(&path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => {
            Err(WriteError::at("remove the earlier run's", &path)(e))
        }
        _ => Ok(()),
    }
}

/// Removes the frames of a kind that a collection of an earlier run lists, and the collection, but for those that are kept; gives names of
/// frames that are there and stand in none, which stay.
///
/// # Errors
/// The operating system's.
pub fn sweep_frames(dir: &Path, kind: &str, keep: &[&str]) -> Result<Vec<String>, WriteError> {
    let index = format!("{kind}.pvd");
    // one that cannot be read lists nothing; this run has not read it, and writes its own in its place
    let text = fs::read_to_string(dir.join(&index)).unwrap_or_default();
    let listed = collected(&text).unwrap_or_default();
    let goes = |name: &str| is_frame(name, kind) && !keep.contains(&name);
    for (_, name) in listed.iter().filter(|(_, name)| goes(name)) {
        remove(dir, name)?;
    }
    if !listed.is_empty() {
        remove(dir, &index)?;
    }
    let entries = fs::read_dir(dir).map_err(WriteError::at("look into", dir))?;
    let names = entries.filter_map(|e| e.ok()?.file_name().into_string().ok());
    let mut left: Vec<String> = names.filter(|n| is_frame(n, kind)).collect();
    left.sort();
    Ok(left)
}

/// What to say about frames that stay.
pub fn told(dir: &Path, left: &[String]) -> Option<String> {
    let first = left.iter().take(TOLD).map(String::as_str);
    let first: Vec<&str> = first.collect();
    let more = if left.len() > TOLD { ", …" } else { "" };
    (!left.is_empty()).then(|| {
        let noun = if left.len() == 1 { "frame" } else { "frames" };
        format!(
            "{} {noun} of another run left in {}: {}{more}",
            left.len(),
            dir.display(),
            first.join(", ")
        )
    })
}

/// Removes the pictures and films that the `run.json` of an earlier run lists.
///
/// # Errors
/// The operating system's.
pub fn sweep_pictures(dir: &Path) -> Result<(), WriteError> {
    let Ok(text) = fs::read_to_string(dir.join("run.json")) else {
        return Ok(());
    };
    let run: Value = serde_json::from_str(&text).unwrap_or(Value::Null);
    let names = run["pictures"].as_array().into_iter().flatten();
    for name in names.filter_map(Value::as_str) {
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if name
            .strip_suffix(".png")
            .is_some_and(|stem| !stem.is_empty() && stem.chars().all(plain))
        {
            remove(dir, name)?;
            // what is beside a field over place and time
            for end in ["svg", "npz"]
                .iter()
                .filter(|_| name.starts_with(SPACE_TIME))
            {
                remove(dir, &name.replace(".png", &format!(".{end}")))?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_earlier_run_lists_goes_and_all_else_stays() {
        let dir = tempfile::tempdir().unwrap();
        let there = |name: &str| dir.path().join(name).exists();
        let list = |names: &[&str]| {
            let each = names.iter();
            each.map(|n| format!("<DataSet timestep=\"0\" file=\"{n}\"/>"))
                .collect::<String>()
        };
        let outside = dir.path().join("../points_00000001.vtu");
        let names = [
            "points_00000001.vtu",
            "points_00000002.vtu",
            "notes.vtu",
            "bonds_00000001.vtu",
            "damage.png",
            "mine.png",
        ];
        for name in names {
            fs::write(dir.path().join(name), "x").unwrap();
        }
        let index = list(&["points_00000001.vtu", "notes.vtu", "../points_00000001.vtu"]);
        fs::write(dir.path().join("points.pvd"), index).unwrap();
        let run = r#"{"pictures": ["damage.png", "stress.png", "../mine.png", "run.json"]}"#;
        fs::write(dir.path().join("run.json"), run).unwrap();
        assert_eq!(
            sweep_frames(dir.path(), "points", &[]).unwrap(),
            ["points_00000002.vtu"]
        );
        sweep_pictures(dir.path()).unwrap();
        let left: Vec<&str> = names.into_iter().filter(|n| there(n)).collect();
        assert_eq!(
            left,
            [
                "points_00000002.vtu",
                "notes.vtu",
                "bonds_00000001.vtu",
                "mine.png"
            ]
        );
        assert!(!there("points.pvd") && there("run.json") && !outside.exists());
        let text = told(dir.path(), &["points_00000002.vtu".into()]).unwrap();
        assert!(
            text.starts_with("1 frame of another run left in ")
                && text.ends_with(": points_00000002.vtu"),
            "{text}"
        );
        assert_eq!(told(dir.path(), &[]), None);
    }
}
