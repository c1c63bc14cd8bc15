//! `peridyne new`: a commented deck to begin with.

use crate::failure::{Failure, say};
use std::fmt::Write;
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct NewArguments {
    /// What the deck is about; without it all kinds are listed.
    pub kind: Option<Kind>,
    /// Deck to write; KIND.toml in the working folder if not given. A file that exists is left alone.
    pub file: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum Kind {
    /// A crack branches in a pulled plate of glass.
    Crack,
    /// A pulse runs along a bar of two materials.
    Wave,
    /// A rigid ball hits a brittle disk.
    Impact,
    /// Equilibrium of a plate with a hole, and its reaction.
    Statics,
    /// Molecular dynamics of liquid argon.
    Atoms,
    /// A crystal to be turned into peridynamic points.
    Upscale,
    /// A plate with fibres to be coarsened.
    Coarsen,
    /// Stress around a vacancy as a continuum field.
    Fields,
    /// Burgers' equation over a horizon.
    ConservationLaw,
}

impl Kind {
    pub const ALL: [Kind; 9] = [
        Kind::Crack,
        Kind::Wave,
        Kind::Impact,
        Kind::Statics,
        Kind::Atoms,
        Kind::Upscale,
        Kind::Coarsen,
        Kind::Fields,
        Kind::ConservationLaw,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Kind::Crack => "crack",
            Kind::Wave => "wave",
            Kind::Impact => "impact",
            Kind::Statics => "statics",
            Kind::Atoms => "atoms",
            Kind::Upscale => "upscale",
            Kind::Coarsen => "coarsen",
            Kind::Fields => "fields",
            Kind::ConservationLaw => "conservation_law",
        }
    }

    pub fn text(self) -> &'static str {
        match self {
            Kind::Crack => include_str!("../templates/crack.toml"),
            Kind::Wave => include_str!("../templates/wave.toml"),
            Kind::Impact => include_str!("../templates/impact.toml"),
            Kind::Statics => include_str!("../templates/statics.toml"),
            Kind::Atoms => include_str!("../templates/atoms.toml"),
            Kind::Upscale => include_str!("../templates/upscale.toml"),
            Kind::Coarsen => include_str!("../templates/coarsen.toml"),
            Kind::Fields => include_str!("../templates/fields.toml"),
            Kind::ConservationLaw => include_str!("../templates/conservation_law.toml"),
        }
    }

    /// What to do with the deck beside `check` and `run`.
    fn verb(self) -> Option<&'static str> {
        match self {
            Kind::Upscale => Some("upscale --factor 2 --run"),
            Kind::Coarsen => Some("coarsen --every 3 --run"),
            Kind::Crack | Kind::Wave | Kind::Impact | Kind::Statics => None,
            Kind::Atoms | Kind::Fields | Kind::ConservationLaw => None,
        }
    }
}

pub fn new(arguments: &NewArguments) -> Result<(), Failure> {
    let Some(kind) = arguments.kind else {
        let mut text = String::from("peridyne new KIND [FILE] writes a commented deck; kinds:\n");
        for kind in Kind::ALL {
            let about = clap::ValueEnum::to_possible_value(&kind);
            let about = about.and_then(|v| v.get_help().map(ToString::to_string));
            let _ = writeln!(text, "  {:<18}{}", kind.name(), about.unwrap_or_default());
        }
        say(text.trim_end());
        return Ok(());
    };
    let named = arguments.file.clone();
    let file = named.unwrap_or_else(|| PathBuf::from(format!("{}.toml", kind.name())));
    let shown = file.display();
    let created = OpenOptions::new().write(true).create_new(true).open(&file);
    let mut open = created.map_err(|e| match e.kind() {
        ErrorKind::AlreadyExists => Failure::input(format!(
            "{shown} exists and is left alone: give another name, `peridyne new {} FILE.toml`",
            kind.name()
        )),
        _ => Failure::input(format!("{shown} cannot be written: {e}")),
    })?;
    if let Err(e) = open.write_all(kind.text().as_bytes()) {
        drop(open);
        // half a deck is worse than none; whether it can be taken away changes nothing about the error
        let _ = std::fs::remove_file(&file);
        return Err(Failure::Run(format!("{shown} cannot be written: {e}")));
    }
    let mut next = format!(
        "wrote {shown}; next:\n  peridyne check {shown}    what it would run\n  peridyne run {shown}      runs it, results in out/{}",
        file.file_stem().unwrap_or_default().display()
    );
    if let Some((verb, flags)) = kind.verb().and_then(|v| v.split_once(' ')) {
        let _ = write!(next, "\n  peridyne {verb} {shown} {flags}");
    }
    say(&next);
    Ok(())
}
