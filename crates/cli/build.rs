//! The version of `peridyne --version`: with the commit where the sources are a clone of the repository and git is there, alone in a
//! published crate, an archive or a container.

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let version = std::env::var("CARGO_PKG_VERSION").unwrap_or_default();
    let shown = match commit() {
        Some(commit) => format!("{version} ({commit})"),
        None => version,
    };
    println!("cargo:rustc-env=PERIDYNE_VERSION={shown}");
}

/// `abc1234, 2026-11-30`.
fn commit() -> Option<String> {
    let here = std::env::var("CARGO_MANIFEST_DIR").ok()?;
    let here = Path::new(&here);
    // not the commit of whoever has this crate among his sources
    let root = here.parent()?.parent()?;
    if !here.ends_with("crates/cli") || !root.join(".git").exists() {
        return None;
    }
    let git = |words: &[&str]| {
        let said = Command::new("git").args(words).current_dir(root).output();
        let said = said.ok().filter(|s| s.status.success())?;
        let text = String::from_utf8(said.stdout).ok()?;
        Some(text.trim().to_string()).filter(|text| !text.is_empty())
    };
    let path = |name: &str| git(&["rev-parse", "--git-path", name]).map(|path| root.join(path));
    let watch = |name: &str| {
        // what is not there would run this at every build
        let there = path(name).filter(|path| path.exists());
        if let Some(path) = &there {
            println!("cargo:rerun-if-changed={}", path.display());
        }
        there.is_some()
    };
    watch("HEAD");
    // of a branch the file that names its commit; packed ones have none until the next
    if let Some(branch) = git(&["symbolic-ref", "--quiet", "HEAD"])
        && !watch(&branch)
    {
        watch("packed-refs");
        watch("refs/heads");
    }
    git(&[
        "show",
        "--no-patch",
        "--format=%h, %cs",
        "--abbrev=7",
        "HEAD",
    ])
}
