//! What is to be done, checked before anything is read or written.

use super::words::Words;
use crate::failure::Failure;
use peridyne::spec::BondedSpec;
use peridyne_fields::molecules::Molecules;
use peridyne_fields::targets::affordable;
use peridyne_fields::{Cell, FieldsError, Kernel, Method, PairForce, Partition, Shape, Targets};
use peridyne_io::continuum::potential::{ModelError, Words as PotentialWords};
use peridyne_io::continuum::{Masses, Model, Units, model, of_deck};
use peridyne_io::read::molecules::molecules;
use peridyne_io::read::number::{decimal_commas, number};
use peridyne_io::read::text_of;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub struct Request {
    pub frames: PathBuf,
    pub out: PathBuf,
    pub units: Units,
    pub masses: Masses,
    pub model: Model,
    pub targets: Targets,
    /// In three dimensions.
    pub kernel: Kernel,
    averaged: [bool; 3],
    partition: Partition,
    pair_force: PairForce,
    pub parts: bool,
    pub pressure: bool,
    pub coordinate: bool,
    /// What is bonded whatever moves.
    bonded: Option<BondedSpec>,
    pub each: bool,
    pub skip: usize,
    pub every: usize,
    pub residuals: usize,
}

/// Points at most.
const MANY: usize = 200_000_000;

fn missing(flag: &str, why: &str) -> Failure {
    Failure::input(format!("--{flag} is missing: {why}"))
}

impl Request {
    pub fn new(words: &Words) -> Result<Request, Failure> {
        let Some(frames) = words.frames.clone() else {
            return Err(missing(
                "frames",
                "a file of extended XYZ (.extxyz), a LAMMPS dump (.lammpstrj) or data file (.data)",
            ));
        };
        let Some(out) = words.out.clone() else {
            return Err(missing("out", "a folder for the results"));
        };
        let targets = targets(words)?;
        let kernel = kernel(words)?;
        let averaged = averaged(words)?;
        if words.every == 0 {
            return Err(Failure::input(
                "--every 0: at least every frame is taken, 1",
            ));
        }
        let (model, units) = model_of(words)?;
        let mut masses = Masses::new();
        for (name, mass) in &words.mass {
            let value = mass
                .parse::<f64>()
                .ok()
                .filter(|m| *m > 0.0 && m.is_finite());
            let Some(value) = value else {
                return Err(Failure::input(format!(
                    "--mass {name}={mass}: expected a positive number"
                )));
            };
            masses.insert(name.clone(), value);
        }
        let of_model = model.bonded.as_deref().cloned();
        Ok(Request {
            frames,
            out,
            units,
            masses,
            model,
            targets,
            kernel,
            averaged,
            partition: partition(words)?,
            pair_force: pair_force(words)?,
            parts: words.parts,
            pressure: words.pressure,
            coordinate: words.coordinate,
            bonded: bonded(words)?.or(of_model),
            each: words.each,
            skip: words.skip,
            every: words.every,
            residuals: words.residuals,
        })
    }

    /// The same with what is bonded among so many atoms.
    pub fn whole_method(&self, cell: &Cell, atoms: usize) -> Result<Method, String> {
        let molecules = self.bonded.clone().map(|spec| Molecules::new(spec, atoms));
        let molecules = molecules.transpose().map_err(|e| e.to_string())?;
        Ok(Method {
            molecules: molecules.map(Arc::new),
            ..self.method(cell)?
        })
    }

    pub fn knows_bonds(&self) -> bool {
        self.bonded.is_some()
    }

    /// For a frame in this cell.
    pub fn method(&self, cell: &Cell) -> Result<Method, String> {
        let made = || -> Result<Method, FieldsError> {
            let mut extents = cell.extents(self.averaged)?;
            // a plane is as thick as the deck of the model says, whatever box the frames have
            extents[self.model.dimension..].fill(Some(self.model.beyond()));
            let kernel = Kernel::averaged(self.kernel.shape(), self.kernel.width(), extents)?;
            Ok(Method {
                partition: self.partition.clone(),
                pair_force: self.pair_force,
                by_part: self.parts,
                coordinate: self.coordinate,
                boltzmann: self.units.boltzmann(),
                ..Method::new(kernel)
            })
        };
        made().map_err(|e| e.to_string())
    }
}

/// The potential and the units, of flags or of a deck.
fn model_of(words: &Words) -> Result<(Model, Units), Failure> {
    let wrong = |flag: &'static str| {
        move |e: ModelError| match e {
            ModelError::Deck(e) => Failure::Input((*e).into()),
            ModelError::Words(words) => Failure::input(format!("--{flag}: {words}")),
        }
    };
    let units = match &words.units {
        None => None,
        Some(name) => match Units::named(name) {
            Some(units) => Some(units),
            None => {
                let message = format!("--units {name}: expected {}", Units::NAMES);
                return Err(Failure::input(message));
            }
        },
    };
    if let Some(path) = &words.model {
        if words.potential.is_some() {
            return Err(Failure::input("--model and --potential: give one of them"));
        }
        let others = [
            ("with", words.with.is_empty()),
            ("file", words.files.is_empty()),
            ("element", words.elements.is_empty()),
        ];
        if let Some((flag, _)) = others.iter().find(|(_, left_out)| !left_out) {
            return Err(Failure::input(format!(
                "--{flag}: the deck of --model says all of its potentials; leave the flag out, or change the deck"
            )));
        }
        let (model, own) = of_deck(path).map_err(wrong("model"))?;
        return match units {
            Some(units) if units.name() != own.name() => Err(Failure::input(format!(
                "--units {}: {} is in {}; leave the flag out",
                units.name(),
                path.display(),
                own.name()
            ))),
            _ => Ok((model, own)),
        };
    }
    let Some(units) = units else {
        let why = format!("frames do not say theirs; {}", Units::NAMES);
        return Err(missing("units", &why));
    };
    let Some(name) = words.potential.clone() else {
        return Err(missing(
            "potential",
            "stress and heat flux need it; `peridyne laws` lists them; several kinds of atoms stand in a deck, --model DECK",
        ));
    };
    let of = PotentialWords {
        name,
        with: words.with.clone(),
        files: words.files.clone(),
        elements: words.elements.clone(),
    };
    Ok((model(&of, units).map_err(wrong("potential"))?, units))
}

/// Numbers by commas.
fn numbers<T: std::str::FromStr, const N: usize>(text: &str) -> Option<[T; N]> {
    let all: Option<Vec<T>> = text.split(',').map(|w| w.trim().parse().ok()).collect();
    all?.try_into().ok()
}

/// A place or an edge.
fn vector(flag: &str, text: &str) -> Result<[f64; 3], Failure> {
    let found = numbers::<f64, 3>(text).filter(|x| x.iter().all(|c| c.is_finite()));
    found.ok_or_else(|| {
        Failure::input(format!(
            "--{flag}: expected x,y,z, three finite numbers, found `{text}`"
        ))
    })
}

fn targets(words: &Words) -> Result<Targets, Failure> {
    let given = [
        ("--grid", words.grid.is_some()),
        ("--points", words.points.is_some()),
        ("--line", words.line.is_some()),
        ("--plane", words.plane.is_some()),
    ];
    let given: Vec<&str> = given.iter().filter(|g| g.1).map(|g| g.0).collect();
    if given.len() > 1 {
        let message = format!("{}: give one of them", given.join(" and "));
        return Err(Failure::input(message));
    }
    if let Some(path) = &words.points {
        return points(path).map(Targets::Points);
    }
    if let Some(line) = &words.line {
        let [from, to, count] = &line[..] else {
            return Err(Failure::input("--line: expected A B N"));
        };
        let found = count.parse().ok().filter(|n| (2..=MANY).contains(n));
        let count = found.ok_or_else(|| {
            Failure::input(format!(
                "--line: expected a number of points from 2 to {MANY}, found `{count}`"
            ))
        })?;
        room_for("line", count as f64)?;
        return Ok(Targets::line(
            vector("line", from)?,
            vector("line", to)?,
            count,
        ));
    }
    if let Some(plane) = &words.plane {
        let [corner, e, f, counts] = &plane[..] else {
            return Err(Failure::input("--plane: expected A E F N,M"));
        };
        let fits = |n: &[usize; 2]| n.iter().all(|n| (2..=MANY).contains(n)) && n[0] * n[1] <= MANY;
        let found = numbers::<usize, 2>(counts).filter(fits);
        let counts = found.ok_or_else(|| {
            Failure::input(format!(
                "--plane: expected N,M, from 2 points along each edge to {MANY} in all, found `{counts}`"
            ))
        })?;
        room_for("plane", counts[0] as f64 * counts[1] as f64)?;
        let edges = [vector("plane", e)?, vector("plane", f)?];
        return Ok(Targets::plane(vector("plane", corner)?, edges, counts));
    }
    let Some(text) = &words.grid else {
        return Err(missing(
            "grid",
            "NX,NY,NZ, or points of a file, --points FILE, or --line, --plane",
        ));
    };
    match numbers::<usize, 3>(text) {
        Some(n) if !n.contains(&0) => Ok(Targets::Grid(n)),
        _ => Err(Failure::input(format!(
            "--grid {text}: expected three positive numbers, e.g. 32,32,1"
        ))),
    }
}

/// Points that are made here, before anything else is known.
fn room_for(flag: &str, points: f64) -> Result<(), Failure> {
    affordable(points).map_err(|e| Failure::input(format!("--{flag}: {e}")))
}

/// x y z in each row; a first row of words names the columns, `#` begins a comment.
fn points(path: &Path) -> Result<Vec<[f64; 3]>, Failure> {
    let (text, name) = text_of(path).map_err(|e| Failure::input(e.to_string()))?;
    let mut all = vec![];
    for (n, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or("").trim();
        let words: Vec<&str> = line
            .split(|c: char| c == ',' || c == ';' || c.is_whitespace())
            .filter(|w| !w.is_empty())
            .collect();
        if words.is_empty() {
            continue;
        }
        let numbers: Option<Vec<f64>> = words.iter().map(|w| number(w)).collect();
        let numbers = numbers.filter(|_| !decimal_commas(line));
        match numbers.as_deref() {
            Some(&[x, y, z]) if x.is_finite() && y.is_finite() && z.is_finite() => {
                all.push([x, y, z]);
            }
            None if all.is_empty() && words[..].starts_with(&["x", "y", "z"]) => {}
            _ => {
                let hint = match decimal_commas(line) {
                    true => "; are these decimal commas? Numbers have a point: 1.5, not 1,5",
                    false => "",
                };
                return Err(Failure::input(format!(
                    "{name}:{}: expected x y z, three finite numbers, found `{line}`{hint}",
                    n + 1
                )));
            }
        }
    }
    match all.is_empty() {
        true => Err(Failure::input(format!("{name}: the file has no points"))),
        false => Ok(all),
    }
}

/// Topology and coefficients of a data file.
fn bonded(words: &Words) -> Result<Option<BondedSpec>, Failure> {
    let Some(path) = &words.molecules else {
        return match words.special {
            Some(_) => Err(missing("molecules", "--special is of atoms that it bonds")),
            None => Ok(None),
        };
    };
    let Some(text) = &words.special else {
        return Err(missing(
            "special",
            "what is left of the potential between atoms that are one, two and three bonds apart, e.g. 0,0,0",
        ));
    };
    let parts: Option<Vec<f64>> = text.split(',').map(|w| w.trim().parse().ok()).collect();
    let Some(&[a, b, c]) = parts.as_deref() else {
        return Err(Failure::input(format!(
            "--special {text}: expected three numbers, e.g. 0,0,0.5"
        )));
    };
    molecules(path, [a, b, c], 1.0, 1.0)
        .map(Some)
        .map_err(|e| Failure::input(e.to_string()))
}

const KERNELS: &str = "polynomial, bspline, quartic, gaussian, step or cell";

fn kernel(words: &Words) -> Result<Kernel, Failure> {
    let Some(name) = &words.kernel else {
        return Err(missing("kernel", KERNELS));
    };
    let shape = match name.as_str() {
        "polynomial" => Shape::Polynomial(words.smoothness.unwrap_or(3)),
        "bspline" | "cubic" => Shape::CubicSpline,
        "quartic" => Shape::QuarticSpline,
        "gaussian" => Shape::Gaussian,
        "step" => Shape::Polynomial(0),
        "cell" => Shape::Cell,
        other => {
            return Err(Failure::input(format!(
                "--kernel {other}: expected {KERNELS}"
            )));
        }
    };
    if words.smoothness.is_some() && name != "polynomial" {
        return Err(Failure::input(format!(
            "--smoothness is for polynomials, not for {name}"
        )));
    }
    let Some(width) = words.width else {
        return Err(missing("width", "S of the localization function, a length"));
    };
    Kernel::new(shape, width).map_err(|e| Failure::input(format!("--width: {e}")))
}

fn averaged(words: &Words) -> Result<[bool; 3], Failure> {
    let text = words.average.as_deref().unwrap_or("");
    let mut axes = [false; 3];
    for c in text.chars() {
        match "xyz".find(c) {
            Some(a) if !axes[a] => axes[a] = true,
            _ => {
                return Err(Failure::input(format!(
                    "--average {text}: expected one or two of x, y, z, e.g. yz"
                )));
            }
        }
    }
    match axes == [true; 3] {
        true => Err(Failure::input("--average xyz: one axis must be left")),
        false => Ok(axes),
    }
}

fn partition(words: &Words) -> Result<Partition, Failure> {
    let text = words.partition.as_deref().unwrap_or("site");
    let centre = text.strip_prefix("centre:").and_then(|w| w.parse().ok());
    match (text, centre) {
        ("site", _) => Ok(Partition::Site),
        ("equal", _) => Ok(Partition::Equal),
        (_, Some(w)) if f64::is_finite(w) => Ok(Partition::Centre(w)),
        _ => Err(Failure::input(format!(
            "--partition {text}: expected site, equal or centre:W"
        ))),
    }
}

fn pair_force(words: &Words) -> Result<PairForce, Failure> {
    match words.pair_force.as_deref().unwrap_or("distances") {
        "distances" => Ok(PairForce::Distances),
        "differences" => Ok(PairForce::Differences),
        other => Err(Failure::input(format!(
            "--pair-force {other}: expected distances or differences"
        ))),
    }
}
