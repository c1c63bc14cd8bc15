//! Data files of `atom_style peri`, `atomic`, `molecular` and `full` without charges.

use super::super::source;
use super::lines::{Lines, Result, finite};
use std::io::BufRead;

/// Which columns an atom has; told by the comment `Atoms # STYLE`, else by their number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// `id type volume density x y z [ix iy iz]`
    Peri,
    /// `id type x y z [ix iy iz]`
    Atomic,
    /// `id molecule type x y z [ix iy iz]`
    Molecular,
    /// `id molecule type charge x y z [ix iy iz]`
    Full,
}

impl Style {
    /// Where an atom's type stands; of molecules the number comes before it.
    fn kind_at(self) -> usize {
        match self {
            Style::Peri | Style::Atomic => 1,
            Style::Molecular | Style::Full => 2,
        }
    }

    /// Can its atoms be bonded?
    fn bonds(self) -> bool {
        self.kind_at() == 2
    }

    /// Numbers of an atom without image flags.
    fn columns(self) -> usize {
        match self {
            Style::Peri => 7,
            Style::Atomic => 5,
            Style::Molecular => 6,
            Style::Full => 7,
        }
    }

    /// [`Style::Full`] has as many as [`Style::Peri`] and must be named.
    fn of(columns: usize) -> Option<Style> {
        let styles = [Style::Peri, Style::Atomic, Style::Molecular];
        styles
            .into_iter()
            .find(|s| [s.columns(), s.columns() + 3].contains(&columns))
    }
}

/// Mass and name (comment) of each type, where the file says it.
pub type Masses = Vec<Option<(f64, Option<String>)>>;

/// What a data file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct DataFile {
    pub style: Style,
    /// Does the file say its style (`Atoms # STYLE`)?
    pub named: bool,
    pub types: usize,
    /// Empty without the section `Masses`.
    pub masses: Masses,
    pub low: [f64; 3],
    pub high: [f64; 3],
    pub atoms: DataAtoms,
    /// Image flags other than 0 were present (and are dropped).
    pub had_images: bool,
    /// Are there bonds, angles, dihedrals or impropers?
    pub bonded: bool,
}

/// Atoms of a data file, in order of their ids.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DataAtoms {
    /// Rising.
    pub ids: Vec<u32>,
    /// From 1.
    pub types: Vec<u32>,
    /// 1 with [`Style::Atomic`].
    pub volume: Vec<f64>,
    /// 1 with [`Style::Atomic`].
    pub density: Vec<f64>,
    pub position: Vec<[f64; 3]>,
    /// Where the file has them.
    pub velocity: Option<Vec<[f64; 3]>>,
    /// The last line, where molecules and types may be types and charges as well.
    pub like_charges: Option<usize>,
}

impl DataAtoms {
    pub fn len(&self) -> usize {
        self.position.len()
    }

    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
}

const GUESSED: &str = "the file does not say its atom_style, which is guessed from the number of columns: write `Atoms # peri` (or atomic, molecular, full)";

/// Bytes of an atom: as a row, and in columns.
const OF_AN_ATOM: f64 = 150.0;

const SECTIONS: [&str; 3] = ["Masses", "Atoms", "Velocities"];
/// What bonds atoms.
const BONDED: [&str; 8] = [
    "Bonds",
    "Angles",
    "Dihedrals",
    "Impropers",
    "Bond Coeffs",
    "Angle Coeffs",
    "Dihedral Coeffs",
    "Improper Coeffs",
];

/// Reads a data file of `atom_style peri`, `atomic`, `molecular` or `full`; charges of the last must be 0.
///
/// # Errors
/// File and line of the first mistake.
pub fn read_data(reader: impl BufRead, path: &str) -> Result<DataFile> {
    let mut lines = Lines::new(reader, path);
    let Header {
        count,
        types,
        mut bonded,
        corners,
        mut section,
    } = header(&mut lines)?;
    let mut atoms: Option<DataAtoms> = None;
    let mut style = None;
    let mut named = false;
    let mut had_images = false;
    let mut masses = Vec::new();
    loop {
        match (section.as_str(), atoms.is_some()) {
            ("Atoms", false) => {
                style = told_style(&lines)?;
                named = style.is_some();
                let read = read_atoms(&mut lines, count, types, &mut style, &mut had_images);
                atoms = Some(read.map_err(|e| match named || e.help.is_some() {
                    true => e,
                    false => e.help(GUESSED),
                })?);
            }
            ("Masses", _) => masses = read_masses(&mut lines, types)?,
            (name, _) if BONDED.contains(&name) => {
                if style.is_some_and(|s| !s.bonds()) {
                    return Err(lines
                        .fail(format!("`{name}` is not supported in this atom_style"))
                        .help("write `Atoms # molecular` and id molecule type x y z, or `Atoms # full` and id molecule type charge x y z"));
                }
                // another reader looks at them
                bonded = true;
                section = match skip(&mut lines)? {
                    Some(name) => name,
                    None => break,
                };
                continue;
            }
            ("Velocities", true) => {
                read_velocities(&mut lines, &mut atoms)?;
            }
            ("Velocities", false) => {
                return Err(lines.fail("the section `Atoms` must come before `Velocities`"));
            }
            ("Atoms", true) => return Err(lines.fail("a second section `Atoms`")),
            _ if section.starts_with(|c: char| c.is_ascii_digit()) => {
                return Err(lines.fail(format!(
                    "more lines than the {count} atoms that the header says"
                )));
            }
            _ => {
                return Err(lines
                    .fail(format!("the section `{section}` is not supported"))
                    .help(format!("supported: {}", SECTIONS.join(", "))));
            }
        }
        match next_filled(&mut lines)? {
            Some(name) => section = name,
            None => break,
        }
    }
    let style = style.unwrap_or(Style::Peri);
    if bonded && !style.bonds() {
        return Err(lines
            .fail("bonds, angles, dihedrals and impropers belong to `atom_style molecular`")
            .help("write `Atoms # molecular` and id molecule type x y z, or `Atoms # full` and id molecule type charge x y z"));
    }
    let atoms = atoms.unwrap_or_default();
    if let (false, false, Style::Molecular, Some(line)) = (named, bonded, style, atoms.like_charges)
    {
        return Err(lines
            .fail_at(
                line,
                "",
                "these columns fit two styles: id molecule type x y z, and id type charge x y z",
            )
            .help(
                "write which: `Atoms # molecular`; charges are not read: there is no Coulomb law",
            ));
    }
    Ok(DataFile {
        style,
        named,
        types,
        masses,
        low: corners.map(|c| c[0]),
        high: corners.map(|c| c[1]),
        atoms,
        had_images,
        bonded,
    })
}

/// What stands before the sections.
struct Header {
    count: usize,
    types: usize,
    bonded: bool,
    /// Lower and upper end along each axis.
    corners: [[f64; 2]; 3],
    /// Name of the first section.
    section: String,
}

fn header<R: BufRead>(lines: &mut Lines<R>) -> Result<Header> {
    let (mut count, mut types, mut bonded) = (None, None, false);
    let mut bounds: [Option<[f64; 2]>; 3] = [None; 3];
    lines.advance()?; // the first line is a title
    let section = loop {
        let Some(line) = lines.advance()? else {
            return Err(
                lines.fail("the file ends within its header; the section `Atoms` is missing")
            );
        };
        let words: Vec<String> = line.split_whitespace().map(str::to_string).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        match words[..] {
            [] => {}
            [n, "atoms"] => count = Some(whole(lines, n)?),
            [n, "atom", "types"] => types = Some(whole(lines, n)?),
            [low, high, a @ ("xlo" | "ylo" | "zlo"), _] => {
                let pair = [low, high].map(finite);
                let [low, high] = pair.map(|x| x.map_err(|e| lines.fail(e)));
                let (low, high) = (low?, high?);
                if low >= high {
                    return Err(lines.fail(format!("the box is empty: {low} is not below {high}")));
                }
                bounds[usize::from(a.as_bytes()[0] - b'x')] = Some([low, high]);
            }
            [n, "bonds" | "angles" | "dihedrals" | "impropers"] => bonded |= n != "0",
            [_, "bond" | "angle" | "dihedral" | "improper", "types"] => {}
            [_, "extra", ..] => {}
            [name] if name.starts_with(|c: char| c.is_ascii_uppercase()) => break name.to_string(),
            _ => {
                return Err(lines
                    .fail("this header line is not supported")
                    .help("supported: N atoms; N atom types; LO HI xlo xhi (ylo yhi, zlo zhi); then the sections Atoms, Velocities"));
            }
        }
    };
    let count = count.ok_or_else(|| lines.fail("the header has no line `N atoms`"))?;
    let types = types.ok_or_else(|| lines.fail("the header has no line `N atom types`"))?;
    let mut corners = [[0.0; 2]; 3];
    for (a, b) in bounds.into_iter().enumerate() {
        let axis = ["x", "y", "z"][a];
        corners[a] = b.ok_or_else(|| {
            lines.fail(format!("the header has no line `LO HI {axis}lo {axis}hi`"))
        })?;
    }
    Ok(Header {
        count,
        types,
        bonded,
        corners,
        section,
    })
}

/// Style by the comment of the line `Atoms`.
fn told_style<R: BufRead>(lines: &Lines<R>) -> Result<Option<Style>> {
    let Some((_, comment)) = lines.text.split_once('#') else {
        return Ok(None);
    };
    match comment.trim() {
        "peri" => Ok(Some(Style::Peri)),
        "atomic" => Ok(Some(Style::Atomic)),
        "molecular" | "bond" | "angle" => Ok(Some(Style::Molecular)),
        "full" => Ok(Some(Style::Full)),
        "" => Ok(None),
        other => Err(lines
            .fail(format!("atom_style `{other}` is not supported"))
            .help("supported: peri, atomic, bond, angle, molecular, full")),
    }
}

fn read_masses<R: BufRead>(lines: &mut Lines<R>, types: usize) -> Result<Masses> {
    // the header is not trusted with memory
    let mut masses: Masses = Vec::new();
    for k in 0..types {
        let words = row(lines, "Masses", k, types)?;
        let [kind, mass] = &words[..] else {
            return Err(lines.fail(format!(
                "a mass has 2 numbers (type mass), found {}",
                words.len()
            )));
        };
        let kind = whole(lines, kind)?;
        if !(1..=types).contains(&kind) {
            return Err(lines.fail(format!("atom type {kind} is not between 1 and {types}")));
        }
        let mass = finite(mass).map_err(|e| lines.fail(e))?;
        if mass <= 0.0 {
            return Err(lines.fail(format!("the mass must be positive, found {mass}")));
        }
        let comment = lines
            .text
            .split_once('#')
            .map(|(_, c)| c.trim().to_string());
        if masses.len() < kind {
            masses.resize(kind, None);
        }
        let name = comment.filter(|c| !c.is_empty() && !c.contains(char::is_whitespace));
        if masses[kind - 1].replace((mass, name)).is_some() {
            return Err(lines.fail(format!("the mass of type {kind} is there twice")));
        }
    }
    Ok(masses)
}

fn whole<R: BufRead>(lines: &Lines<R>, word: &str) -> Result<usize> {
    match word.parse::<usize>() {
        Ok(n) if n <= u32::MAX as usize => Ok(n),
        _ => Err(lines.fail(format!("expected a whole number, found `{word}`"))),
    }
}

fn next_filled<R: BufRead>(lines: &mut Lines<R>) -> Result<Option<String>> {
    loop {
        match lines.advance()? {
            None => return Ok(None),
            Some("") => {}
            Some(line) => return Ok(Some(line.to_string())),
        }
    }
}

/// The head of the next section.
fn skip<R: BufRead>(lines: &mut Lines<R>) -> Result<Option<String>> {
    loop {
        match next_filled(lines)? {
            Some(line) if !line.starts_with(|c: char| c.is_ascii_uppercase()) => {}
            other => return Ok(other),
        }
    }
}

fn row<R: BufRead>(
    lines: &mut Lines<R>,
    section: &str,
    k: usize,
    count: usize,
) -> Result<Vec<String>> {
    match next_filled(lines)? {
        Some(line) => Ok(line.split_whitespace().map(str::to_string).collect()),
        None => Err(lines.fail(format!(
            "the file ends in section `{section}`: {k} of {count} lines are there"
        ))),
    }
}

fn read_atoms<R: BufRead>(
    lines: &mut Lines<R>,
    count: usize,
    types: usize,
    style: &mut Option<Style>,
    had_images: &mut bool,
) -> Result<DataAtoms> {
    // the header is not trusted with memory
    source::room(&format!("{count} atoms"), OF_AN_ATOM * count as f64)
        .map_err(|e| lines.fail(e.to_string()))?;
    let mut rows: Vec<(u32, u32, [f64; 5], usize)> = Vec::with_capacity(count.min(1 << 20));
    let mut like_charges = types > 1;
    for k in 0..count {
        let words = row(lines, "Atoms", k, count)?;
        if words[0].starts_with(|c: char| c.is_ascii_uppercase()) {
            return Err(lines.fail(format!(
                "the section `Atoms` ends after {k} lines, the header says {count} atoms"
            )));
        }
        let known = style.or(Style::of(words.len()));
        let told = *style.get_or_insert(known.unwrap_or(Style::Peri));
        let columns = told.columns();
        if words.len() != columns && words.len() != columns + 3 {
            return Err(lines
                .fail(format!(
                    "an atom has {columns} numbers (or {} with image flags), found {}",
                    columns + 3,
                    words.len()
                ))
                .help("atom_style peri: id type volume density x y z [ix iy iz]; atom_style atomic: id type x y z [ix iy iz]; atom_style molecular: id molecule type x y z [ix iy iz]; `Atoms # full`: id molecule type charge x y z [ix iy iz]"));
        }
        let id = whole(lines, &words[0])?;
        let mut kind_at = told.kind_at();
        let kind = whole(lines, &words[kind_at])?;
        if id == 0 {
            return Err(lines.fail("atom ids start at 1"));
        }
        if !(1..=types).contains(&kind) {
            return Err(lines.fail(format!("atom type {kind} is not between 1 and {types}")));
        }
        like_charges &= { words[1].parse() }.is_ok_and(|t| (1..=types).contains(&t));
        if told == Style::Full {
            kind_at += 1;
            let charge = finite(&words[kind_at]).map_err(|e| lines.fail(e))?;
            if charge != 0.0 {
                return Err(lines
                    .fail(format!(
                        "atom {id} has the charge {charge}, and there is no Coulomb law"
                    ))
                    .help("charges of `atom_style full` must be 0"));
            }
        }
        let mut v = [1.0; 5];
        let numbers = &words[kind_at + 1..columns];
        for (slot, word) in v[5 - numbers.len()..].iter_mut().zip(numbers) {
            *slot = finite(word).map_err(|e| lines.fail(e))?;
        }
        for (value, name) in v.iter().zip(["volume", "density"]) {
            if *value <= 0.0 {
                return Err(lines.fail(format!("the {name} must be positive, found {value}")));
            }
        }
        for flag in &words[columns..] {
            let flag: i64 = flag
                .parse()
                .map_err(|_| lines.fail(format!("image flag `{flag}` is not a whole number")))?;
            *had_images |= flag != 0;
        }
        rows.push((id as u32, kind as u32, v, lines.number));
    }
    rows.sort_by_key(|r| r.0);
    if let Some(w) = rows.windows(2).find(|w| w[0].0 == w[1].0) {
        return Err(lines.fail_at(w[1].3, "", format!("atom id {} occurs twice", w[1].0)));
    }
    Ok(DataAtoms {
        ids: rows.iter().map(|r| r.0).collect(),
        types: rows.iter().map(|r| r.1).collect(),
        volume: rows.iter().map(|r| r.2[0]).collect(),
        density: rows.iter().map(|r| r.2[1]).collect(),
        position: rows.iter().map(|r| [r.2[2], r.2[3], r.2[4]]).collect(),
        velocity: None,
        like_charges: Some(lines.number).filter(|_| like_charges && count > 0),
    })
}

fn read_velocities<R: BufRead>(lines: &mut Lines<R>, atoms: &mut Option<DataAtoms>) -> Result<()> {
    let Some(atoms) = atoms else { return Ok(()) };
    let count = atoms.len();
    let velocity = atoms.velocity.get_or_insert_with(|| vec![[0.0; 3]; count]);
    for k in 0..count {
        let words = row(lines, "Velocities", k, count)?;
        if words.len() != 4 {
            return Err(lines.fail(format!(
                "a velocity has 4 numbers (id vx vy vz), found {}",
                words.len()
            )));
        }
        let id = whole(lines, &words[0])?;
        let found = atoms.ids.binary_search(&(id as u32));
        let index = found.map_err(|_| lines.fail(format!("there is no atom with id {id}")))?;
        let mut v = [0.0; 3];
        for (slot, word) in v.iter_mut().zip(&words[1..]) {
            *slot = finite(word).map_err(|e| lines.fail(e))?;
        }
        velocity[index] = v;
    }
    Ok(())
}
