//! LAMMPS text dumps of atoms: `id`, `type` or `element`, positions (`x`, `xu` or scaled `xs`), velocities, forces.

use super::atoms::{Atoms, Frame, Names, Tilted};
use super::error::ReadError;
use super::number;
use super::stream::Stream;
use std::io::BufRead;
use std::path::Path;

/// Reads one frame of a dump, in order of the ids.
///
/// # Errors
/// File and line: truncated, missing columns, something else than finite numbers, a tilted box, no such frame.
pub fn dump(path: &Path, which: Frame) -> Result<Atoms, ReadError> {
    let last = match which {
        Frame::Last => count(Stream::open(path)?)?.saturating_sub(1),
        Frame::Index(_) | Frame::Step(_) => 0,
    };
    parse(Stream::open(path)?, which, last)
}

/// The same from a text; `name` is for messages.
pub fn parse_dump(text: &str, name: &str, which: Frame) -> Result<Atoms, ReadError> {
    let stream = || Stream::new(text.as_bytes(), name);
    let last = match which {
        Frame::Last => count(stream())?.saturating_sub(1),
        Frame::Index(_) | Frame::Step(_) => 0,
    };
    parse(stream(), which, last)
}

/// Number of frames of a file.
pub fn frames(path: &Path) -> Result<usize, ReadError> {
    count(Stream::open(path)?)
}

/// What stands before the atoms of a frame.
pub(super) struct Head {
    step: u64,
    time: Option<f64>,
    count: usize,
    low: [f64; 3],
    high: [f64; 3],
    periodic: [bool; 3],
    edges: Option<[[f64; 3]; 3]>,
    columns: Vec<String>,
    /// What `ITEM: UNITS` says.
    units: Option<String>,
}

/// How the box is written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum BoxLines {
    Bounds,
    /// `xlo_bound xhi_bound xy`, …: bounds of the tilted box.
    Tilted,
    /// `ax ay az origin_x`, …: any three edges.
    General,
}

impl BoxLines {
    fn width(self) -> usize {
        match self {
            BoxLines::Bounds => 2,
            BoxLines::Tilted => 3,
            BoxLines::General => 4,
        }
    }
}

impl Head {
    /// From the lines after `BOX BOUNDS`.
    fn take_box(&mut self, lines: BoxLines, rows: &[Vec<f64>]) {
        match lines {
            BoxLines::Bounds => {
                self.low = std::array::from_fn(|a| rows[a][0]);
                self.high = std::array::from_fn(|a| rows[a][1]);
            }
            BoxLines::Tilted => {
                let [xy, xz, yz] = [rows[0][2], rows[1][2], rows[2][2]];
                let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
                for a in 0..3 {
                    (low[a], high[a]) = (rows[a][0], rows[a][1]);
                }
                // LAMMPS manual, Howto triclinic: what the bounds are wider than the box
                let sums = [0.0, xy, xz, xy + xz];
                low[0] -= sums.into_iter().fold(f64::INFINITY, f64::min);
                high[0] -= sums.into_iter().fold(f64::NEG_INFINITY, f64::max);
                low[1] -= yz.min(0.0);
                high[1] -= yz.max(0.0);
                (self.low, self.high) = (low, high);
                let length: [f64; 3] = std::array::from_fn(|a| high[a] - low[a]);
                if [xy, xz, yz] != [0.0; 3] {
                    self.edges = Some([
                        [length[0], 0.0, 0.0],
                        [xy, length[1], 0.0],
                        [xz, yz, length[2]],
                    ]);
                }
            }
            BoxLines::General => {
                self.low = std::array::from_fn(|a| rows[a][3]);
                let edges: [[f64; 3]; 3] =
                    std::array::from_fn(|a| std::array::from_fn(|c| rows[a][c]));
                self.high =
                    std::array::from_fn(|c| self.low[c] + (0..3).map(|a| edges[a][c]).sum::<f64>());
                self.edges = Some(edges);
            }
        }
    }

    /// The point at scaled coordinates.
    fn scaled(&self, s: [f64; 3]) -> [f64; 3] {
        let edges = self.edges.unwrap_or_else(|| {
            std::array::from_fn(|a| {
                std::array::from_fn(|c| {
                    if a == c {
                        self.high[a] - self.low[a]
                    } else {
                        0.0
                    }
                })
            })
        });
        std::array::from_fn(|c| self.low[c] + (0..3).map(|a| s[a] * edges[a][c]).sum::<f64>())
    }
}

/// The line after an item.
fn value<R: BufRead>(stream: &mut Stream<R>, item: &str) -> Result<String, ReadError> {
    let line = stream.expect(|| format!("a line after {item} is missing"))?;
    Ok(line.trim().to_string())
}

/// `None` at the end of the file.
pub(super) fn head<R: BufRead>(
    stream: &mut Stream<R>,
    tilted: Tilted,
) -> Result<Option<Head>, ReadError> {
    let mut frame = Head {
        step: 0,
        time: None,
        count: 0,
        low: [0.0; 3],
        high: [0.0; 3],
        periodic: [false; 3],
        edges: None,
        units: None,
        columns: Vec::new(),
    };
    let (mut begun, mut boxed) = (false, false);
    while let Some(line) = stream.next()? {
        let line = line.trim().to_string();
        let Some(item) = line.strip_prefix("ITEM: ") else {
            if line.is_empty() {
                continue;
            }
            return Err(stream.error(format!(
                "expected `ITEM: …`, found `{line}`: is this a LAMMPS text dump?"
            )));
        };
        if let Some(columns) = item.strip_prefix("ATOMS") {
            if !boxed {
                return Err(stream.error("a frame has no `ITEM: BOX BOUNDS`"));
            }
            frame.columns = columns.split_whitespace().map(str::to_string).collect();
            return Ok(Some(frame));
        }
        begun = true;
        if let Some(flags) = item.strip_prefix("BOX BOUNDS") {
            let mut flags: Vec<&str> = flags.split_whitespace().collect();
            let lines = match flags[..] {
                ["xy", "xz", "yz", ..] => BoxLines::Tilted,
                ["abc", "origin", ..] => BoxLines::General,
                _ => BoxLines::Bounds,
            };
            if tilted == Tilted::Refused && lines != BoxLines::Bounds {
                return Err(stream.error("tilted boxes are not read: use an orthogonal box"));
            }
            flags.retain(|f| !["xy", "xz", "yz", "abc", "origin"].contains(f));
            frame.periodic =
                std::array::from_fn(|a| flags.get(a).is_some_and(|f| f.starts_with('p')));
            let mut rows = vec![];
            for _ in 0..3 {
                let line = value(stream, "BOX BOUNDS")?;
                let words: Vec<&str> = line.split_whitespace().collect();
                if words.len() != lines.width() {
                    return Err(stream.error(match lines {
                        BoxLines::Bounds => format!("expected two bounds, found `{line}`"),
                        BoxLines::Tilted => {
                            format!("expected two bounds and a tilt, found `{line}`")
                        }
                        BoxLines::General => {
                            format!("expected an edge and a number of the origin, found `{line}`")
                        }
                    }));
                }
                let row: Result<Vec<f64>, _> =
                    words.iter().map(|w| stream.finite(w, "a bound")).collect();
                rows.push(row?);
            }
            frame.take_box(lines, &rows);
            boxed = true;
            continue;
        }
        let text = value(stream, item)?;
        match item {
            "TIMESTEP" => {
                frame.step = text
                    .parse()
                    .map_err(|_| stream.error(format!("expected a time step, found `{text}`")))?;
            }
            "NUMBER OF ATOMS" => frame.count = stream.count(&text, "the number of atoms")?,
            "UNITS" => frame.units = Some(text),
            "TIME" => frame.time = Some(stream.finite(&text, "the time")?),
            _ => {}
        }
    }
    if begun {
        return Err(stream.error("the file ends within the head of a frame"));
    }
    Ok(None)
}

fn skip<R: BufRead>(stream: &mut Stream<R>, head: &Head) -> Result<(), ReadError> {
    for k in 0..head.count {
        stream.expect(|| {
            format!(
                "{k} of {} atoms of step {} are there",
                head.count, head.step
            )
        })?;
    }
    Ok(())
}

fn count<R: BufRead>(mut stream: Stream<R>) -> Result<usize, ReadError> {
    let mut frames = 0;
    // what is only counted may have any box
    while let Some(head) = head(&mut stream, Tilted::Taken)? {
        skip(&mut stream, &head)?;
        frames += 1;
    }
    Ok(frames)
}

fn parse<R: BufRead>(mut stream: Stream<R>, which: Frame, last: usize) -> Result<Atoms, ReadError> {
    let mut steps = Vec::new();
    while let Some(head) = head(&mut stream, Tilted::Refused)? {
        let wanted = match which {
            Frame::Step(step) => head.step == step,
            Frame::Index(index) => steps.len() == index,
            Frame::Last => steps.len() == last,
        };
        if wanted {
            return frame(&mut stream, head);
        }
        skip(&mut stream, &head)?;
        steps.push(head.step);
    }
    let known: Vec<String> = steps
        .iter()
        .rev()
        .take(10)
        .rev()
        .map(u64::to_string)
        .collect();
    let known = format!(
        "it has {} frames, the last of steps {}",
        steps.len(),
        known.join(", ")
    );
    Err(stream.whole(match which {
        _ if steps.is_empty() => "the file has no frames".to_string(),
        Frame::Step(step) => format!("there is no frame of step {step}: {known}"),
        Frame::Index(index) => format!("there is no frame {index}: {known}"),
        Frame::Last => known,
    }))
}

/// Columns of the three components of a quantity, by their names.
fn triple(columns: &[String], names: [&str; 3]) -> Option<[usize; 3]> {
    let find = |name: &str| columns.iter().position(|c| c == name);
    Some([find(names[0])?, find(names[1])?, find(names[2])?])
}

/// Columns that say where an atom is, a second time.
const OWN: [&str; 15] = [
    "x", "y", "z", "xu", "yu", "zu", "xs", "ys", "zs", "xsu", "ysu", "zsu", "ix", "iy", "iz",
];

/// Columns in which a dump has what is known of atoms.
struct Found {
    id: usize,
    number: Option<usize>,
    /// The element, or the number of the type.
    kind: usize,
    plain: Option<[usize; 3]>,
    scaled: Option<[usize; 3]>,
    /// One of both.
    place: [usize; 3],
    velocity: Option<[usize; 3]>,
    force: Option<[usize; 3]>,
    energy: Option<usize>,
    mass: Option<usize>,
}

/// An atom.
struct Row {
    id: usize,
    species: u32,
    position: [f64; 3],
    velocity: Option<[f64; 3]>,
    force: Option<[f64; 3]>,
    energy: Option<f64>,
    mass: Option<f64>,
}

impl Found {
    fn of<R: BufRead>(stream: &Stream<R>, columns: &[String]) -> Result<Found, ReadError> {
        let find = |name: &str| columns.iter().position(|c| c == name);
        let missing = |what: &str| {
            stream.error(format!(
                "the dump has no column {what}; it has {}",
                columns.join(" ")
            ))
        };
        let id = find("id").ok_or_else(|| missing("`id`"))?;
        let number = find("type");
        let kind = find("element").or(number);
        let plain = triple(columns, ["x", "y", "z"]).or(triple(columns, ["xu", "yu", "zu"]));
        let scaled = triple(columns, ["xs", "ys", "zs"]).or(triple(columns, ["xsu", "ysu", "zsu"]));
        Ok(Found {
            id,
            number,
            kind: kind.ok_or_else(|| missing("`type` or `element`"))?,
            plain,
            scaled,
            place: plain
                .or(scaled)
                .ok_or_else(|| missing("`x y z`, `xu yu zu` or `xs ys zs`"))?,
            velocity: triple(columns, ["vx", "vy", "vz"]),
            force: triple(columns, ["fx", "fy", "fz"]),
            energy: find("c_pe"),
            mass: find("mass"),
        })
    }

    /// All other columns.
    fn more(&self, columns: &[String]) -> Vec<usize> {
        let known = |c: usize| {
            let vectors = [self.plain, self.scaled, self.velocity, self.force];
            vectors.into_iter().flatten().flatten().any(|k| k == c)
                || [
                    Some(self.id),
                    Some(self.kind),
                    self.number,
                    self.energy,
                    self.mass,
                ]
                .contains(&Some(c))
                || OWN.contains(&&*columns[c])
        };
        (0..columns.len()).filter(|c| !known(*c)).collect()
    }

    /// The atom of the stream's line, which has these words.
    fn row<R: BufRead>(
        &self,
        stream: &Stream<R>,
        head: &Head,
        words: &[&str],
        species: u32,
    ) -> Result<Row, ReadError> {
        let vector = |at: [usize; 3]| -> Result<[f64; 3], ReadError> {
            let mut v = [0.0; 3];
            for (c, column) in v.iter_mut().zip(at) {
                *c = stream.finite(words[column], &head.columns[column])?;
            }
            Ok(v)
        };
        let mut position = vector(self.place)?;
        if self.plain.is_none() {
            position = head.scaled(position);
        }
        Ok(Row {
            id: stream.count(words[self.id], "the id")?,
            species,
            position,
            velocity: self.velocity.map(vector).transpose()?,
            force: self.force.map(vector).transpose()?,
            energy: { self.energy }
                .map(|c| stream.finite(words[c], "c_pe"))
                .transpose()?,
            mass: match { self.mass }
                .map(|c| stream.finite(words[c], "the mass"))
                .transpose()?
            {
                Some(m) if m <= 0.0 => {
                    return Err(stream.error(format!("the mass is {m}: it must be positive")));
                }
                own => own,
            },
        })
    }
}

/// Rows of a frame in order of their ids.
///
/// # Errors
/// Two have one id.
fn sorted<R: BufRead>(stream: &Stream<R>, head: &Head, rows: &mut [Row]) -> Result<(), ReadError> {
    rows.sort_by_key(|r| r.id);
    if let Some(w) = rows.windows(2).find(|w| w[0].id == w[1].id) {
        return Err(stream.error(format!(
            "the id {} occurs twice in the frame of step {}",
            w[0].id, head.step
        )));
    }
    Ok(())
}

pub(super) fn frame<R: BufRead>(stream: &mut Stream<R>, head: Head) -> Result<Atoms, ReadError> {
    let columns = &head.columns;
    let found = Found::of(stream, columns)?;
    let more = found.more(columns);
    let mut others: Vec<(String, Vec<f64>)> = { more.iter() }
        .map(|c| (columns[*c].clone(), vec![]))
        .collect();
    let mut names = Names::default();
    // the number of the type, of each species
    let mut numbers: Vec<u32> = vec![];
    stream.room(head.count, columns.len())?;
    let mut rows: Vec<Row> = Vec::with_capacity(head.count.min(1 << 20));
    for k in 0..head.count {
        stream.expect(|| {
            format!(
                "{k} of {} atoms of step {} are there",
                head.count, head.step
            )
        })?;
        let words: Vec<&str> = stream.current().split_whitespace().collect();
        if words.len() != columns.len() {
            let got = words.len();
            return Err(stream.error(format!(
                "expected the {} columns {}, found {got}",
                columns.len(),
                columns.join(" ")
            )));
        }
        let species = names.place(words[found.kind]);
        if numbers.len() < names.species.len() {
            let written = found.number.map_or(words[found.kind], |c| words[c]);
            numbers.push(written.parse().unwrap_or(u32::MAX));
        }
        for (c, (_, values)) in more.iter().zip(&mut others) {
            values.push(number::number(words[*c]).unwrap_or(f64::NAN));
        }
        rows.push(found.row(stream, &head, &words, species)?);
    }
    let mut places: Vec<usize> = (0..rows.len()).collect();
    places.sort_by_key(|k| rows[*k].id);
    for (_, values) in &mut others {
        *values = places.iter().map(|k| values[*k]).collect();
    }
    // words are no numbers
    others.retain(|(_, values)| values.iter().any(|v| v.is_finite()));
    sorted(stream, &head, &mut rows)?;
    // type 1 is the first species whatever atom comes first
    let mut order: Vec<u32> = (0..names.species.len() as u32).collect();
    order.sort_by_key(|k| (numbers[*k as usize], *k));
    let mut new = vec![0; order.len()];
    for (place, old) in order.iter().enumerate() {
        new[*old as usize] = place as u32;
    }
    let mut atoms = Atoms {
        bonded: false,
        mass: None,
        units: head.units,
        species: order
            .iter()
            .map(|k| names.species[*k as usize].clone())
            .collect(),
        kind: rows.iter().map(|r| new[r.species as usize]).collect(),
        position: rows.iter().map(|r| r.position).collect(),
        velocity: found
            .velocity
            .map(|_| rows.iter().filter_map(|r| r.velocity).collect()),
        force: found
            .force
            .map(|_| rows.iter().filter_map(|r| r.force).collect()),
        energy: found
            .energy
            .map(|_| rows.iter().filter_map(|r| r.energy).collect()),
        low: head.low,
        high: head.high,
        periodic: head.periodic,
        edges: head.edges,
        step: Some(head.step),
        time: head.time,
        from_momenta: false,
        columns: others,
    };
    if found.mass.is_some() {
        atoms.take_masses(rows.iter().filter_map(|r| r.mass).collect());
    }
    Ok(atoms)
}
