//! What is to be done, checked before anything is read or written.

use super::words::Words;
use crate::failure::Failure;
use peridyne::spec::BondedSpec;
use peridyne_fields::molecules::Molecules;
use peridyne_fields::{Cell, FieldsError, Kernel, Method, PairForce, Partition, Shape, Targets};
use peridyne_io::continuum::potential::{ModelError, Words as PotentialWords};
use peridyne_io::continuum::{Masses, Model, Units, model};
use peridyne_io::read::molecules::molecules;
use peridyne_io::write::continuum::Table;
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
    /// What is bonded whatever moves.
    bonded: Option<BondedSpec>,
    pub each: bool,
    pub skip: usize,
    pub every: usize,
    pub residuals: usize,
}

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
        let Some(units) = &words.units else {
            return Err(missing(
                "units",
                &format!("frames do not say theirs; {}", Units::NAMES),
            ));
        };
        let Some(units) = Units::named(units) else {
            return Err(Failure::input(format!(
                "--units {units}: expected {}",
                Units::NAMES
            )));
        };
        let targets = targets(words)?;
        let kernel = kernel(words)?;
        let averaged = averaged(words)?;
        if words.every == 0 {
            return Err(Failure::input(
                "--every 0: at least every frame is taken, 1",
            ));
        }
        let Some(name) = words.potential.clone() else {
            return Err(missing(
                "potential",
                "stress and heat flux need it; `peridyne laws` lists them",
            ));
        };
        let model = model(
            &PotentialWords {
                name,
                with: words.with.clone(),
                file: words.file.clone(),
                element: words.element.clone(),
            },
            units,
        );
        let model = model.map_err(|e| match e {
            ModelError::Deck(e) => Failure::Input((*e).into()),
            ModelError::Words(words) => Failure::input(format!("--potential: {words}")),
        })?;
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
            bonded: bonded(words)?,
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
            let extents = cell.extents(self.averaged)?;
            let kernel = Kernel::averaged(self.kernel.shape(), self.kernel.width(), extents)?;
            Ok(Method {
                partition: self.partition.clone(),
                pair_force: self.pair_force,
                by_part: self.parts,
                boltzmann: self.units.boltzmann(),
                ..Method::new(kernel)
            })
        };
        made().map_err(|e| e.to_string())
    }

    /// As it is described.
    pub fn last_method(&self, table: &Table) -> Option<Method> {
        match &table.grid {
            Some((_, cell)) => self.method(cell).ok(),
            None => Some(Method {
                partition: self.partition.clone(),
                pair_force: self.pair_force,
                by_part: self.parts,
                boltzmann: self.units.boltzmann(),
                ..Method::new(self.kernel.clone())
            }),
        }
    }
}

fn targets(words: &Words) -> Result<Targets, Failure> {
    match (&words.grid, &words.points) {
        (Some(_), Some(_)) => Err(Failure::input("--grid and --points: give one of them")),
        (None, None) => Err(missing(
            "grid",
            "NX,NY,NZ, or points of a file, --points FILE",
        )),
        (Some(text), None) => {
            let n: Option<Vec<usize>> = text.split(',').map(|w| w.trim().parse().ok()).collect();
            match n.as_deref() {
                Some(&[x, y, z]) if x * y * z > 0 => Ok(Targets::Grid([x, y, z])),
                _ => Err(Failure::input(format!(
                    "--grid {text}: expected three positive numbers, e.g. 32,32,1"
                ))),
            }
        }
        (None, Some(path)) => points(path).map(Targets::Points),
    }
}

/// x y z in each row; a first row of words names the columns, `#` begins a comment.
fn points(path: &Path) -> Result<Vec<[f64; 3]>, Failure> {
    let name = path.display();
    let text = std::fs::read_to_string(path)
        .map_err(|e| Failure::input(format!("{name}: cannot read it: {e}")))?;
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
        let numbers: Option<Vec<f64>> = words.iter().map(|w| w.parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x, y, z]) if x.is_finite() && y.is_finite() && z.is_finite() => {
                all.push([x, y, z]);
            }
            None if all.is_empty() && words[..].starts_with(&["x", "y", "z"]) => {}
            _ => {
                return Err(Failure::input(format!(
                    "{name}:{}: expected x y z, three finite numbers, found `{line}`",
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
        return Ok(None);
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
