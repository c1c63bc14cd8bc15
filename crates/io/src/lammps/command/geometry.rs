//! `lattice`, `region`.

use super::Args;
use crate::lammps::error::{Problem, Result};
use crate::lammps::lattice::Lattice;
use crate::lammps::printf::general;
use crate::lammps::region::{INF, Region, Shape};
use crate::lammps::session::Session;
use crate::lammps::units::Units;

const REGIONS: [&str; 5] = ["block", "cylinder", "sphere", "union", "intersect"];

impl Session<'_> {
    pub(super) fn set_lattice(&mut self, args: &mut Args) -> Result<()> {
        let style = args.next("a lattice style")?;
        let dimension = match style.as_str() {
            "none" => self.dimension,
            "sc" => 3,
            "sq" => 2,
            _ => return Err(args.unknown(style, "the lattice", ["sc", "sq", "none"])),
        };
        if dimension != self.dimension {
            return Err(Problem::at(
                style.span,
                format!(
                    "lattice `{}` does not fit dimension {}",
                    style.as_str(),
                    self.dimension
                ),
            )
            .help("use `sc` in 3 and `sq` in 2 dimensions"));
        }
        let mut constant = args.positive("the lattice constant")?;
        let sites = style.as_str() != "none";
        if self.units == Units::Lj && sites {
            constant = (1.0 / constant).powf(1.0 / dimension as f64); // a reduced density
        }
        let mut origin = [0.0; 3];
        while let Some(word) = args.optional() {
            match word.as_str() {
                "origin" => {
                    for o in &mut origin {
                        *o = args.number("the origin as a fraction of the cell")?;
                        if !(0.0..1.0).contains(o) {
                            return Err(Problem::at(
                                word.span,
                                "the origin must be from 0 to below 1 on each axis",
                            ));
                        }
                    }
                }
                "orient" | "spacing" | "a1" | "a2" | "a3" | "basis" => {
                    return Err(Problem::at(
                        word.span,
                        format!(
                            "`lattice {} ... {}` is not supported",
                            style.as_str(),
                            word.as_str()
                        ),
                    )
                    .help("supported: lattice sc|sq CONSTANT [origin X Y Z], along the axes"));
                }
                _ => return Err(args.unknown(word, "the option", ["origin"])),
            }
        }
        self.lattice = Some(Lattice {
            constant,
            origin,
            sites,
        });
        let c = general(constant, 7, false);
        self.console
            .print(&format!("Lattice spacing in x,y,z = {c} {c} {c}"));
        Ok(())
    }

    pub(super) fn add_region(&mut self, args: &mut Args) -> Result<()> {
        let id = args.next("a region ID")?.as_str().to_string();
        let style = args.next("a region style")?;
        if style.as_str() == "delete" {
            self.region(&id)?;
            self.regions.retain(|(n, _)| *n != id);
            return args.finish();
        }
        if self.regions.iter().any(|(n, _)| *n == id) {
            return Err(Problem::new(format!("there is a region `{id}` already")));
        }
        let mut raw: Vec<(Option<f64>, Axis)> = Vec::new(); // None: to the side of the box
        let mut axis = 0;
        let mut parts = Vec::new();
        match style.as_str() {
            "block" => {
                for k in 0..6 {
                    raw.push(limit(args, "xlo xhi ylo yhi zlo zhi", k / 2, k % 2)?);
                }
            }
            "cylinder" => {
                let word = args.next("the axis")?;
                axis = ["x", "y", "z"]
                    .iter()
                    .position(|a| *a == word.as_str())
                    .ok_or_else(|| args.unknown(word, "the axis", ["x", "y", "z"]))?;
                for what in ["the centre", "the centre", "the radius"] {
                    raw.push((Some(args.number(what)?), (0, 0)));
                }
                for side in 0..2 {
                    raw.push(limit(args, "the ends of the cylinder", axis, side)?);
                }
            }
            "sphere" => {
                for what in ["the centre", "the centre", "the centre", "the radius"] {
                    raw.push((Some(args.number(what)?), (0, 0)));
                }
            }
            "union" | "intersect" => {
                for _ in 0..args.count("the number of regions", 2)? {
                    let word = args.next("a region ID")?;
                    parts.push(
                        self.region(word.as_str())
                            .map_err(|p| p.or_at(word.span))?
                            .clone(),
                    );
                }
            }
            _ => return Err(args.unknown(style, "the region style", REGIONS)),
        }
        let (mut lattice_units, mut outside) = (true, false);
        while let Some(word) = args.optional() {
            match word.as_str() {
                "units" => lattice_units = args.units()?,
                "side" => {
                    let side = args.next("`in` or `out`")?;
                    outside = match side.as_str() {
                        "in" => false,
                        "out" => true,
                        _ => return Err(args.unknown(side, "the side", ["in", "out"])),
                    };
                }
                _ => return Err(args.unknown(word, "the option", ["units", "side"])),
            }
        }
        let unit = if parts.is_empty() {
            self.length_unit(lattice_units)?
        } else {
            1.0
        };
        let mut v = Vec::new();
        for (value, (axis, side)) in raw {
            v.push(match value {
                Some(x) if x.abs() >= INF => x,
                Some(x) => unit * x,
                None => {
                    let domain = self.domain()?;
                    if side == 0 {
                        domain.low[axis]
                    } else {
                        domain.high[axis]
                    }
                }
            });
        }
        let shape = match style.as_str() {
            "block" => {
                let (low, high) = ([v[0], v[2], v[4]], [v[1], v[3], v[5]]);
                if let Some(a) = (0..3).find(|&a| low[a] > high[a]) {
                    let (l, h) = (low[a], high[a]);
                    let a = ["x", "y", "z"][a];
                    return Err(Problem::new(format!(
                        "region `{id}` is empty: {a}lo = {l} is above {a}hi = {h}"
                    )));
                }
                Shape::Block { low, high }
            }
            "cylinder" => Shape::Cylinder {
                axis,
                center: [v[0], v[1]],
                radius: v[2],
                low: v[3],
                high: v[4],
            },
            "sphere" => Shape::Sphere {
                center: [v[0], v[1], v[2]],
                radius: v[3],
            },
            "union" => Shape::Union(parts),
            _ => Shape::Intersect(parts),
        };
        match shape {
            Shape::Cylinder { radius, .. } | Shape::Sphere { radius, .. } if radius < 0.0 => {
                return Err(Problem::new(format!(
                    "region `{id}` has the negative radius {radius}"
                )));
            }
            Shape::Cylinder { low, high, .. } if low > high => {
                return Err(Problem::new(format!(
                    "region `{id}` is empty: {low} is above {high}"
                )));
            }
            _ => {}
        }
        self.regions.push((id, Region { shape, outside }));
        Ok(())
    }
}

/// Axis and side (0 low, 1 high) that `EDGE` means.
type Axis = (usize, usize);

/// A number, `INF` or `EDGE` (`None`).
fn limit(args: &mut Args, what: &str, axis: usize, side: usize) -> Result<(Option<f64>, Axis)> {
    if args.eat("INF") {
        return Ok((Some(if side == 0 { -INF } else { INF }), (axis, side)));
    }
    if args.eat("EDGE") {
        return Ok((None, (axis, side)));
    }
    Ok((Some(args.number(what)?), (axis, side)))
}
