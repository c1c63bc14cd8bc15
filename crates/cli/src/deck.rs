//! Reading decks for the verbs.

use crate::Input;
use crate::failure::{Failure, note};
use crate::numbers::{memory, whole};
use crate::ranks::agreed;
use peridyne::error::{BuildError, BuildErrorKind};
use peridyne::execute::simd::Simd;
use peridyne::observe::observables::USUAL;
use peridyne::run::initial::InitialState;
use peridyne::run::ranks::build_from;
use peridyne::run::{DiffusionInfo, Info, Options, Simulation, build};
use peridyne::spec::{DiffusionMethod, Spec};
use peridyne_comm::{Comm, launcher};
use peridyne_io::deck::{Deck, Dim, UnitSystem, each_once, rounded};
use peridyne_io::drive::{default_dir, take_state};
use peridyne_io::read::{encoding, source};
use peridyne_io::write::checkpoint::{Asked, Checkpoint};
use peridyne_io::write::shares::write_share;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// What a deck from standard input is called in messages.
pub const STDIN: &str = "<stdin>";
/// Its text, which comes once: several ranks of one process read it, and more than one look.
static PIPED: Mutex<Option<String>> = Mutex::new(None);

/// Is this the deck from standard input?
pub fn is_piped(file: &Path) -> bool {
    file == Path::new("-")
}

impl Input {
    /// What its file is called in messages.
    pub fn name(&self) -> String {
        match is_piped(&self.file) {
            true => STDIN.into(),
            false => self.file.to_string_lossy().into_owned(),
        }
    }

    /// What results are called after: the file without its ending.
    pub fn stem(&self) -> String {
        match is_piped(&self.file) {
            true => "stdin".into(),
            false => self
                .file
                .file_stem()
                .map_or("deck".into(), |stem| stem.to_string_lossy().into_owned()),
        }
    }

    /// Where its results go if nobody says it.
    pub fn default_dir(&self) -> PathBuf {
        match is_piped(&self.file) {
            true => default_dir(Path::new("stdin")),
            false => default_dir(&self.file),
        }
    }
}

/// The deck of a run that is resumed, in the place of standard input; `None`: another command reads its own.
pub fn pipe(text: Option<&str>) {
    let mut piped = PIPED.lock().unwrap_or_else(PoisonError::into_inner);
    *piped = text.map(str::to_string);
}

/// The deck from standard input.
fn piped() -> Result<String, Failure> {
    let mut piped = PIPED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(text) = &*piped {
        return Ok(text.clone());
    }
    if let Some(launched) = launcher::launched() {
        return Err(Failure::input(format!(
            "-: standard input goes to one process, and {launched}: write the deck to a file"
        )));
    }
    if std::io::stdin().is_terminal() {
        note("reading a deck from standard input; Ctrl-D ends it");
    }
    let bytes = source::within(std::io::stdin().lock(), LARGEST);
    let bytes = bytes.map_err(|e| Failure::input(format!("{STDIN}: {e}")))?;
    refuse_others(STDIN, &bytes)?;
    let text = decoded(STDIN, bytes)?;
    *piped = Some(text.clone());
    Ok(text)
}

/// The text that bytes are.
fn decoded(name: &str, bytes: Vec<u8>) -> Result<String, Failure> {
    encoding::text(bytes, 0).map_err(|e| {
        let place = e.line.map_or(String::new(), |l| format!(":{l}"));
        Failure::input(format!("{name}{place}: {}", e.message))
    })
}

/// Is this file a deck, as opposed to a LAMMPS script?
pub fn is_deck(input: &Input) -> bool {
    if is_piped(&input.file) {
        return true;
    }
    input
        .file
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("toml"))
}

/// Bytes of a deck or a script.
const LARGEST: u64 = 16 << 20;

/// Files that are no decks and no scripts, by how they begin: what they are, and whether a body can be made of them.
const OTHERS: [(&[u8], &str, bool); 11] = [
    (b"$MeshFormat", "a mesh of gmsh", true),
    (b"*HEADING", "a mesh of Abaqus", true),
    (b"*NODE", "a mesh of Abaqus", true),
    (b"ITEM: ", "a LAMMPS dump", true),
    (b"CDF\x01", "an Exodus mesh", true),
    (b"CDF\x02", "an Exodus mesh", true),
    (b"CDF\x05", "an Exodus mesh", true),
    (b"\x89HDF", "a file of HDF5, perhaps an Exodus mesh", true),
    (b"PK\x03\x04", "an archive of arrays", true),
    (b"\x89PNG", "a picture", false),
    (b"<?xml", "an XML file", false),
];

fn refuse_others(name: &str, bytes: &[u8]) -> Result<(), Failure> {
    let begin = bytes[..bytes.len().min(4096)].to_ascii_uppercase();
    let begin = begin.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&begin);
    let begin = begin.trim_ascii_start();
    let Some((_, what, body)) = OTHERS
        .iter()
        .find(|(start, ..)| begin.starts_with(&start.to_ascii_uppercase()))
    else {
        return Ok(());
    };
    let help = match body {
        true => {
            let file = std::path::Path::new(name).file_name();
            let file = file.map_or(name.into(), |f| f.to_string_lossy());
            format!(
                "write a deck (.toml) beside it, with body = {{ file = \"{file}\" }}, horizon, material and run"
            )
        }
        false => "give a deck (.toml) or a LAMMPS input script".into(),
    };
    Err(Failure::input(format!(
        "{name}: this is {what}, not a deck or script; {help}"
    )))
}

pub fn text(input: &Input) -> Result<String, Failure> {
    if is_piped(&input.file) {
        return piped();
    }
    let name = input.file.display();
    let bytes = source::open_given(&input.file)
        .and_then(|file| source::within(file, LARGEST))
        .map_err(|e| Failure::input(format!("{name}: {e}")))?;
    refuse_others(&name.to_string(), &bytes)?;
    let table =
        |line: &[u8]| [&b"[body]"[..], b"[material]", b"[run]"].contains(&line.trim_ascii());
    if !is_deck(input) && bytes.split(|b| *b == b'\n').any(table) {
        return Err(Failure::input(format!(
            "{name}: this looks like a deck, and is read as a LAMMPS script because of its name: name it .toml"
        )));
    }
    decoded(&name.to_string(), bytes)
}

/// Variables are those of scripts.
pub fn no_variables(input: &Input) -> Result<(), Failure> {
    match input.var.first() {
        None => Ok(()),
        Some((name, _)) => Err(Failure::input(format!(
            "--var {name}: variables belong to LAMMPS scripts; a deck takes --set key=value"
        ))),
    }
}

pub fn read(input: &Input) -> Result<Deck, Failure> {
    let text = text(input)?;
    no_variables(input)?;
    let name = input.name();
    Deck::parse(&text, &name, &input.set).map_err(|e| Failure::Input(e.into()))
}

/// What makes the same run again: the command with what it overrides.
pub fn command(input: &Input) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-./=:+,".contains(c);
    let word = |text: &str| match !text.is_empty() && text.chars().all(plain) {
        true => text.to_string(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    };
    let sets = input.set.iter();
    let sets = sets.map(|(key, value)| format!(" --set {}", word(&format!("{key}={value}"))));
    let vars = input.var.iter();
    let vars = vars.map(|(name, value)| format!(" --var {}", word(&format!("{name}={value}"))));
    let file = word(&input.file.to_string_lossy());
    format!(
        "peridyne run {file}{}",
        sets.chain(vars).collect::<String>()
    )
}

pub fn simd(input: &Input) -> Result<Option<Simd>, Failure> {
    let Some(name) = &input.simd else {
        return Ok(None);
    };
    let all = Simd::available();
    let names: Vec<&str> = all.iter().map(|s| s.name()).collect();
    match all.iter().find(|s| s.name() == name) {
        Some(s) => Ok(Some(*s)),
        None => Err(Failure::input(format!(
            "--simd {name}: this machine has {}",
            names.join(", ")
        ))),
    }
}

pub fn model(deck: &Deck, input: &Input) -> Result<Box<dyn Simulation>, Failure> {
    model_of(deck, &deck.spec, input)
}

/// Of the spec of a deck with more probes.
pub fn model_of(deck: &Deck, spec: &Spec, input: &Input) -> Result<Box<dyn Simulation>, Failure> {
    let options = Options {
        simd: simd(input)?,
        ..Options::default()
    };
    build(spec, options).map_err(|e| Failure::Input(deck.explain(&e).into()))
}

/// The same, of which ranks have parts, in the state of an earlier run if there is one. The first has the model; others have followed it to its end, and
/// have none.
pub fn model_among(
    (deck, state): (&Deck, Option<Checkpoint>),
    spec: &Spec,
    input: &Input,
    comm: &Arc<Comm>,
) -> Result<Option<Box<dyn Simulation>>, Failure> {
    let wrong = |e: BuildError| match e.kind {
        BuildErrorKind::Elsewhere => Failure::Elsewhere,
        _ => Failure::Input(deck.explain(&e).into()),
    };
    let earlier = state.map(|state| {
        let Asked {
            deck, text, set, ..
        } = &state.asked;
        let earlier = Deck::parse(text, &deck.to_string_lossy(), set);
        let earlier = earlier.map_err(|e| Failure::Input(e.into()))?;
        Ok((state, earlier))
    });
    let mut earlier = agreed(comm, earlier.transpose())?;
    let bring = |sim: &mut dyn Simulation, state: &mut Checkpoint| {
        let taken = take_state(sim, state);
        taken.map_err(|e| BuildError::invalid("", e.to_string()))
    };
    if comm.ranks() == 1 {
        let state = match &mut earlier {
            Some((state, earlier)) => {
                let mut before = model_of(earlier, &earlier.spec, input)?;
                bring(before.as_mut(), state).map_err(wrong)?;
                Some(InitialState::of(before.as_mut()))
            }
            None => None,
        };
        let mut sim = model_of(deck, spec, input)?;
        if let Some(state) = state {
            state.give(sim.as_mut()).map_err(wrong)?;
        }
        return Ok(Some(sim));
    }
    let options = Options {
        simd: agreed(comm, simd(input))?,
        ..Options::default()
    };
    let made = match &mut earlier {
        Some((state, earlier)) => {
            let mut bring = |sim: &mut dyn Simulation| bring(sim, state);
            let before = (&earlier.spec, &mut bring as _);
            build_from(Some(before), spec, options, comm, write_share)
        }
        None => build_from(None, spec, options, comm, write_share),
    };
    made.map_err(wrong)
}

/// Columns of a frame.
pub fn fields(deck: &Deck) -> Vec<String> {
    let usual = || USUAL.map(String::from).to_vec();
    let spread = deck
        .spec
        .interactions
        .diffusions
        .iter()
        .map(|t| t.quantity.column());
    let spread = || spread.map(str::to_string).chain(usual()).collect();
    deck.spec.run.fields.clone().unwrap_or_else(spread)
}

/// What looks wrong in a deck of which this was built.
pub fn warnings(deck: &Deck, info: &Info) -> Vec<String> {
    let first = deck.warnings.iter().cloned();
    first.chain(deck.lints(info)).collect()
}

/// What a deck passed over and what looks wrong in it, in lines.
pub fn remarks(notes: &[String], warnings: &[String]) -> String {
    let notes = notes.iter().map(|n| format!("\nnote: {n}"));
    let warnings = warnings.iter().map(|w| format!("\nwarning: {w}"));
    notes.chain(warnings).collect()
}

/// Decks of two stages, and points with horizons of their own, which `verb` does not know.
pub fn is_plain(deck: &Deck, verb: &str) -> Result<(), Failure> {
    let (spec, mut pieces) = (&deck.spec, deck.spec.body.pieces().iter());
    let own = spec.bonds.variable_horizon.is_some() || pieces.any(|p| p.variable_horizon.is_some());
    let what = match (&spec.run.preload, own) {
        (Some(_), _) => "a deck of [run] or of [statics], and this one has both",
        (_, true) => "one horizon, and the points of this deck have their own (variable_horizon)",
        (None, false) => return Ok(()),
    };
    Err(Failure::input(format!(
        "{}: {verb} takes {what}",
        deck.file()
    )))
}

/// How fast something spreads, and what its steps are beside those of the run.
fn spreads(t: &DiffusionInfo, step: f64, units: UnitSystem) -> String {
    let all = t.diffusivity.iter();
    let all: Vec<String> = all.map(|d| units.show(*d, Dim::DIFFUSIVITY)).collect();
    let time = |x: f64| units.show(x, Dim::TIME);
    let mut text = format!(
        "{:<10}diffusivity {}, over the body in about {}, explicit steps up to {}",
        t.quantity.name(),
        all.join(" and "),
        time(t.spread),
        time(t.stable_step),
    );
    if let DiffusionMethod::Explicit { safety } = t.method {
        let parts = (step / (safety * t.stable_step)).ceil().max(1.0);
        if parts > 1.0 {
            text += &format!(" ({} parts of a step)", whole(parts as u64));
        }
    }
    text
}

/// What was built, in a few lines, with numbers for people.
pub fn headline(sim: &dyn Simulation, units: UnitSystem) -> String {
    let i = sim.info();
    let bytes = i.bytes as f64;
    let mut text = format!(
        "points    {} in {}-D, spacing {}, mass {}\nbonds     {}, {} to {} per point (mean {}), {}\nhorizon   {}{}\nmemory    {}, {:.0} bytes per point\nSIMD      {}",
        whole(i.points),
        i.dimension,
        units.show(i.spacing, Dim::LENGTH),
        units.show(i.mass, Dim::MASS),
        whole(each_once(i.directed_bonds)),
        i.family.0,
        i.family.2,
        rounded(i.family.1, 4),
        i.family_kind,
        units.show(i.horizon, Dim::LENGTH),
        step(i, units),
        memory(bytes),
        bytes / i.points.max(1) as f64,
        i.simd,
    );
    text.extend(
        i.diffusions
            .iter()
            .map(|t| format!("\n{}", spreads(t, i.time_step, units))),
    );
    for s in i.critical_stretch.iter().filter(|s| s.is_finite()) {
        text += &format!(
            "\nbreaks    beyond a stretch of {} %",
            rounded(100.0 * s, 4)
        );
    }
    for c in &i.micromodulus {
        text += &format!("\nmicromodulus {}", units.show(*c, Dim::MICROMODULUS));
    }
    if i.cut > 0 {
        text += &format!("\npre-cracks cut {} bonds", whole(each_once(i.cut)));
    }
    for w in &i.warnings {
        text += &format!("\nwarning: {}", units.tell(w));
    }
    text
}

/// How long a step is, and how long it may be.
fn step(info: &Info, units: UnitSystem) -> String {
    let [step, stable] = [info.time_step, info.stable_step].map(|t| units.show(t, Dim::TIME));
    match info.stepper {
        _ if info.stepper.statics().is_some() => String::new(),
        stepper if stepper.rests() => format!("\nstep      {step}, no point moves"),
        stepper if stepper.solves() => {
            format!("\nstep      {step}, implicit (explicit ones are stable up to {stable})")
        }
        _ => format!("\nstep      {step}, stable up to {stable}"),
    }
}
