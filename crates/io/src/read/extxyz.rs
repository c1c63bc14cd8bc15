//! Extended XYZ: number of atoms; a line of `key=value`; one line per atom with the columns of `Properties`.
//!
//! Read are `Lattice` (orthogonal), `Origin`, `pbc`, `step`, `time`, and the columns species, pos, velo (or vel, velocities; in
//! the deck's units), else momenta with masses (as ASE writes them: Å, eV, g/mol), forces (or force), energies (or local_energy),
//! masses. Others are passed over.
//! Format: libAtoms extended XYZ specification and ASE's documentation of it.

use super::atoms::{Atoms, Frame, Names, Tilted};
use super::error::ReadError;
use super::stream::Stream;
use std::io::BufRead;
use std::path::Path;

/// Reads one frame of a file.
///
/// # Errors
/// File and line: truncated, columns that do not fit, something else than finite numbers, a lattice that is not
/// orthogonal, no such frame.
pub fn extxyz(path: &Path, which: Frame) -> Result<Atoms, ReadError> {
    let index = match which {
        Frame::Last => count(Stream::open(path)?)?.saturating_sub(1),
        Frame::Index(index) => index,
        Frame::Step(_) => usize::MAX,
    };
    parse(Stream::open(path)?, which, index)
}

/// The same from a text; `name` is for messages.
pub fn parse_extxyz(text: &str, name: &str, which: Frame) -> Result<Atoms, ReadError> {
    let stream = || Stream::new(text.as_bytes(), name);
    let index = match which {
        Frame::Last => count(stream())?.saturating_sub(1),
        Frame::Index(index) => index,
        Frame::Step(_) => usize::MAX,
    };
    parse(stream(), which, index)
}

/// Number of frames of a file.
pub fn frames(path: &Path) -> Result<usize, ReadError> {
    count(Stream::open(path)?)
}

/// Number of atoms of the next frame; `None` at the end of the file.
pub(super) fn next_frame<R: BufRead>(stream: &mut Stream<R>) -> Result<Option<usize>, ReadError> {
    loop {
        match stream.next()? {
            None => return Ok(None),
            Some(line) if line.trim().is_empty() => {}
            Some(_) => {
                return stream
                    .count(stream.current(), "the number of atoms")
                    .map(Some);
            }
        }
    }
}

fn skip<R: BufRead>(stream: &mut Stream<R>, lines: usize, count: usize) -> Result<(), ReadError> {
    for k in 0..lines {
        stream.expect(|| {
            format!("its last frame has {k} of {lines} lines after the number of atoms, {count}")
        })?;
    }
    Ok(())
}

fn count<R: BufRead>(mut stream: Stream<R>) -> Result<usize, ReadError> {
    let mut frames = 0;
    while let Some(atoms) = next_frame(&mut stream)? {
        skip(&mut stream, atoms + 1, atoms)?;
        frames += 1;
    }
    Ok(frames)
}

fn parse<R: BufRead>(
    mut stream: Stream<R>,
    which: Frame,
    index: usize,
) -> Result<Atoms, ReadError> {
    let mut seen = 0;
    while let Some(atoms) = next_frame(&mut stream)? {
        stream.expect(|| "the line with Lattice and Properties is missing".into())?;
        let wanted = match which {
            Frame::Step(step) => Head::read(&stream, Tilted::Refused)?.step == Some(step),
            Frame::Index(_) | Frame::Last => seen == index,
        };
        if wanted {
            let head = Head::read(&stream, Tilted::Refused)?;
            return frame(&mut stream, atoms, head);
        }
        skip(&mut stream, atoms, atoms)?;
        seen += 1;
    }
    Err(stream.whole(match which {
        _ if seen == 0 => "the file has no frames".to_string(),
        Frame::Step(step) => format!("none of its {seen} frames says step={step}"),
        Frame::Index(_) | Frame::Last => format!(
            "there is no frame {index}: it has {seen}, the last is {}",
            seen - 1
        ),
    }))
}

/// What a column is for us.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Role {
    Species,
    Position,
    Velocity,
    Momentum,
    Force,
    Energy,
    Mass,
}

const ROLES: [(&str, Role, char, usize); 15] = [
    ("species", Role::Species, 'S', 1),
    ("pos", Role::Position, 'R', 3),
    ("velo", Role::Velocity, 'R', 3),
    ("vel", Role::Velocity, 'R', 3),
    ("velocity", Role::Velocity, 'R', 3),
    ("velocities", Role::Velocity, 'R', 3),
    ("momenta", Role::Momentum, 'R', 3),
    ("forces", Role::Force, 'R', 3),
    ("force", Role::Force, 'R', 3),
    ("energies", Role::Energy, 'R', 1),
    ("local_energy", Role::Energy, 'R', 1),
    ("energy", Role::Energy, 'R', 1),
    ("masses", Role::Mass, 'R', 1),
    ("mass", Role::Mass, 'R', 1),
    ("element", Role::Species, 'S', 1),
];

/// The line of keys.
pub(super) struct Head {
    /// Corner and lengths; a length of 0: as far as the atoms go.
    lattice: Option<[f64; 3]>,
    /// Of a lattice that is not orthogonal.
    edges: Option<[[f64; 3]; 3]>,
    origin: [f64; 3],
    periodic: [bool; 3],
    step: Option<u64>,
    time: Option<f64>,
    /// First column of each role.
    roles: Vec<(Role, usize)>,
    columns: usize,
}

impl Head {
    pub(super) fn read<R: BufRead>(stream: &Stream<R>, tilted: Tilted) -> Result<Head, ReadError> {
        let pairs = pairs(stream.current()).map_err(|e| stream.error(e))?;
        let find = |key: &str| {
            let found = pairs.iter().find(|(k, _)| k.eq_ignore_ascii_case(key));
            found.map(|(_, v)| v.as_str())
        };
        let numbers = |key: &str, count: usize| -> Result<Option<Vec<f64>>, ReadError> {
            let Some(text) = find(key) else {
                return Ok(None);
            };
            let words = text.split_whitespace();
            let values: Vec<f64> = words
                .map(|w| stream.finite(w, &format!("a number of {key}")))
                .collect::<Result<_, _>>()?;
            if values.len() == count {
                Ok(Some(values))
            } else {
                Err(stream.error(format!("{key} has {count} numbers, found {}", values.len())))
            }
        };
        let mut edges = None;
        let lattice = match numbers("Lattice", 9)? {
            None => None,
            Some(rows) => {
                let off = (0..9).any(|k| k % 4 != 0 && rows[k] != 0.0);
                let lengths = [rows[0], rows[4], rows[8]];
                let turned = off || lengths.iter().any(|l| *l < 0.0);
                if turned && tilted == Tilted::Taken {
                    edges = Some(std::array::from_fn(|a| {
                        std::array::from_fn(|c| rows[3 * a + c])
                    }));
                } else if turned {
                    return Err(stream.error(
                        "the lattice is not orthogonal: only Lattice=\"Lx 0 0 0 Ly 0 0 0 Lz\" is read; make an orthogonal supercell",
                    ));
                }
                Some(lengths)
            }
        };
        let periodic = match find("pbc") {
            // without pbc a lattice means that all axes are periodic
            None => [lattice.is_some(); 3],
            Some(text) => flags(text)
                .ok_or_else(|| stream.error(format!("expected pbc=\"T T F\", found `{text}`")))?,
        };
        if let Some(a) = (0..3).find(|a| {
            let short = lattice.is_none_or(|l| l[*a] <= 0.0);
            periodic[*a] && edges.is_none() && short
        }) {
            let axis = ["x", "y", "z"][a];
            return Err(stream.error(format!(
                "{axis} is periodic (pbc), but Lattice gives it no length"
            )));
        }
        let (roles, columns) = roles(find("Properties").unwrap_or("species:S:1:pos:R:3"))
            .map_err(|e| stream.error(e))?;
        Ok(Head {
            lattice,
            edges,
            origin: numbers("Origin", 3)?.map_or([0.0; 3], |v| [v[0], v[1], v[2]]),
            periodic,
            step: find("step")
                .or(find("Timestep"))
                .and_then(|t| t.parse().ok()),
            time: find("time").and_then(|t| t.parse().ok()),
            roles,
            columns,
        })
    }
}

fn flags(text: &str) -> Option<[bool; 3]> {
    let flags: Vec<bool> = text
        .split_whitespace()
        .map(|w| match w {
            "T" | "True" | "true" | "1" => Some(true),
            "F" | "False" | "false" | "0" => Some(false),
            _ => None,
        })
        .collect::<Option<_>>()?;
    flags.try_into().ok()
}

/// First column of each role, and the number of columns.
fn roles(properties: &str) -> Result<(Vec<(Role, usize)>, usize), String> {
    let parts: Vec<&str> = properties.split(':').collect();
    let (mut roles, mut column) = (Vec::new(), 0);
    for part in parts.chunks(3) {
        let [name, kind, width] = part else {
            return Err(format!(
                "Properties is name:type:columns:…, found `{properties}`"
            ));
        };
        let width: usize = width
            .parse()
            .ok()
            .filter(|w| (1..=1000).contains(w))
            .ok_or_else(|| format!("`{width}` is no number of columns of {name}"))?;
        if let Some((_, role, wanted, columns)) = ROLES.iter().find(|r| r.0 == *name) {
            if !kind.starts_with(*wanted) || width != *columns {
                return Err(format!(
                    "Properties: expected {name}:{wanted}:{columns}, found {name}:{kind}:{width}"
                ));
            }
            if !roles.iter().any(|(r, _)| r == role) {
                roles.push((*role, column));
            }
        }
        column += width;
    }
    for (role, name) in [(Role::Species, "species:S:1"), (Role::Position, "pos:R:3")] {
        if !roles.iter().any(|(r, _)| *r == role) {
            return Err(format!(
                "Properties has no {name}: write Properties=species:S:1:pos:R:3"
            ));
        }
    }
    let has = |role| roles.iter().any(|(r, _)| *r == role);
    if has(Role::Momentum) && !has(Role::Velocity) && !has(Role::Mass) {
        return Err(
            "the column momenta needs the column masses: write both, or velocities as velo:R:3"
                .into(),
        );
    }
    Ok((roles, column))
}

/// `key=value`, `key="a b"`, `key='a b'`, `key={a b}`, bare `key`.
fn pairs(line: &str) -> Result<Vec<(String, String)>, String> {
    let mut pairs = Vec::new();
    let mut rest = line.trim_start();
    while !rest.is_empty() {
        let end = rest
            .find(|c: char| c == '=' || c.is_whitespace())
            .unwrap_or(rest.len());
        let key = rest[..end].trim_matches('"').to_string();
        rest = rest[end..].trim_start();
        let Some(after) = rest.strip_prefix('=') else {
            pairs.push((key, "T".into()));
            continue;
        };
        let after = after.trim_start();
        let close = match after.chars().next() {
            Some(q @ ('"' | '\'')) => Some(q),
            Some('{') => Some('}'),
            Some('[') => Some(']'),
            _ => None,
        };
        let (value, next) = match close {
            Some(close) => {
                let inner = &after[1..];
                let end = inner
                    .find(close)
                    .ok_or_else(|| format!("the value of {key} has no closing {close}"))?;
                (&inner[..end], &inner[end + 1..])
            }
            None => after.split_at(after.find(char::is_whitespace).unwrap_or(after.len())),
        };
        pairs.push((key, value.replace(',', " ").trim().to_string()));
        rest = next.trim_start();
    }
    Ok(pairs)
}

pub(super) fn frame<R: BufRead>(
    stream: &mut Stream<R>,
    count: usize,
    head: Head,
) -> Result<Atoms, ReadError> {
    let column = |role: Role| head.roles.iter().find(|(r, _)| *r == role).map(|(_, c)| *c);
    let (Some(species), Some(position)) = (column(Role::Species), column(Role::Position)) else {
        return Err(stream.error("Properties has no species and pos"));
    };
    let (velocity, momentum) = (column(Role::Velocity), column(Role::Momentum));
    let (force, energy, mass) = (
        column(Role::Force),
        column(Role::Energy),
        column(Role::Mass),
    );
    let mut names = Names::default();
    let mut masses = vec![];
    let mut atoms = Atoms {
        velocity: velocity.or(momentum).map(|_| Vec::new()),
        force: force.map(|_| Vec::new()),
        energy: energy.map(|_| Vec::new()),
        from_momenta: velocity.is_none() && momentum.is_some(),
        periodic: head.periodic,
        edges: head.edges,
        step: head.step,
        time: head.time,
        ..Atoms::default()
    };
    stream.room(count, head.columns)?;
    for k in 0..count {
        stream.expect(|| format!("{k} of {count} atoms are there"))?;
        let words: Vec<&str> = stream.current().split_whitespace().collect();
        if words.len() != head.columns {
            return Err(stream.error(format!(
                "atom {} of {count} has {} columns, Properties says {}",
                k + 1,
                words.len(),
                head.columns
            )));
        }
        let vector = |first: usize, what: &str| -> Result<[f64; 3], ReadError> {
            let mut v = [0.0; 3];
            for (a, c) in v.iter_mut().enumerate() {
                *c = stream.finite(words[first + a], what)?;
            }
            Ok(v)
        };
        atoms.position.push(vector(position, "a position")?);
        let kind = names.place(words[species]);
        atoms.kind.push(kind);
        let own = match mass {
            None => None,
            Some(c) => {
                let value = stream.finite(words[c], "the mass")?;
                if value <= 0.0 {
                    return Err(stream.error(format!(
                        "the mass of atom {} is {value}: it must be positive",
                        k + 1
                    )));
                }
                masses.push(value);
                Some(value)
            }
        };
        if let Some(all) = &mut atoms.velocity {
            all.push(match (velocity, momentum, own) {
                (Some(c), ..) => vector(c, "a velocity")?,
                (None, Some(c), Some(m)) => vector(c, "a momentum")?.map(|p| p / m),
                _ => [0.0; 3],
            });
        }
        if let (Some(all), Some(c)) = (&mut atoms.force, force) {
            all.push(vector(c, "a force")?);
        }
        if let (Some(all), Some(c)) = (&mut atoms.energy, energy) {
            all.push(stream.finite(words[c], "an energy")?);
        }
    }
    atoms.species = names.species;
    if mass.is_some() {
        atoms.take_masses(masses);
    }
    if let Some(edges) = head.edges {
        atoms.low = head.origin;
        atoms.high =
            std::array::from_fn(|c| head.origin[c] + (0..3).map(|a| edges[a][c]).sum::<f64>());
        return Ok(atoms);
    }
    let [low, high] = Atoms::bounds(&atoms.position);
    for a in 0..3 {
        let length = head.lattice.map_or(0.0, |l| l[a]);
        [atoms.low[a], atoms.high[a]] = if length > 0.0 {
            [head.origin[a], head.origin[a] + length]
        } else {
            [low[a], high[a]]
        };
    }
    Ok(atoms)
}
