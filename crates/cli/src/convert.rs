//! `peridyne convert`.

use crate::failure::{Failure, note, say};
use peridyne_io::convert;
use peridyne_io::deck::{Deck, counted};
use peridyne_io::excerpt::one_line;
use peridyne_io::write::atomic::write_file;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct ConvertArguments {
    /// Deck of Peridigm (YAML or XML) or PeriLab (YAML), beside its mesh and node sets.
    pub file: PathBuf,
    /// The new deck (`.toml`); its points become an Exodus mesh of the same name (`.g`) beside it.
    #[arg(short, long)]
    pub out: PathBuf,
    /// Write nothing, with exit code 2, if anything has no counterpart.
    #[arg(long)]
    pub strict: bool,
}

pub fn convert(arguments: &ConvertArguments) -> Result<(), Failure> {
    let out = &arguments.out;
    if out.extension().is_none_or(|e| e != "toml") {
        return Err(Failure::input(format!(
            "--out {}: a deck is called .toml",
            out.display()
        )));
    }
    let mesh = out.with_extension("g");
    let mesh_name = mesh
        .file_name()
        .map_or(String::new(), |n| n.to_string_lossy().into_owned());
    let converted =
        convert::convert(&arguments.file, &mesh_name).map_err(|e| Failure::input(e.to_string()))?;
    let file = arguments.file.display();
    for u in &converted.unmapped {
        note(&format!(
            "{file}:{}: not mapped: {}: {}",
            u.line,
            one_line(&u.entry),
            one_line(&u.why)
        ));
    }
    for remark in &converted.remarks {
        note(&format!("{file}: note: {remark}"));
    }
    let left = converted.unmapped.len();
    if arguments.strict && left > 0 {
        return Err(Failure::input(format!(
            "{file}: {left} entries are not mapped, and --strict asks for all: nothing was written"
        )));
    }
    let failed = |e: peridyne_io::write::WriteError| Failure::Run(e.to_string());
    converted.write_mesh(&mesh).map_err(failed)?;
    write_file(out, |w| w.write_all(converted.text.as_bytes())).map_err(failed)?;
    say(&format!(
        "{}: {} in {}, {left} {} not mapped",
        out.display(),
        counted(converted.points() as u64, "point"),
        mesh.display(),
        if left == 1 { "entry" } else { "entries" },
    ));
    // what is missing now is for the user to add
    if let Err(error) = Deck::parse(&converted.text, &out.to_string_lossy(), &[]) {
        note(&format!("the new deck is not complete: {error}"));
    }
    say(&format!(
        "see what it would run: peridyne check {}",
        out.display()
    ));
    Ok(())
}
