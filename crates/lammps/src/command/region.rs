//! `region`.

use std::rc::Rc;

use super::Args;
use crate::error::{Problem, Result, suggestion};
use crate::fix::Input;
use crate::region::{Definition, INF, Kind, Region};
use crate::session::Session;
use crate::text::Word;

const REGIONS: [&str; 9] = [
    "block",
    "cone",
    "cylinder",
    "ellipsoid",
    "plane",
    "prism",
    "sphere",
    "union",
    "intersect",
];

/// Parts of parts, all told.
const MOST_LEAVES: usize = 10_000;

/// What a value of a region is.
enum Value {
    /// In units of the lattice or the box.
    Length(Input),
    /// In units of the box: a side of it, or infinity.
    Place(f64),
}

const CENTER: &str = "the centre";

/// As many lengths as words say what they are.
fn lengths(args: &mut Args, what: &[&str], raw: &mut Vec<Value>) -> Result<()> {
    for what in what {
        raw.push(Value::Length(args.input(what)?));
    }
    Ok(())
}

impl Session<'_> {
    pub(super) fn add_region(&mut self, args: &mut Args) -> Result<()> {
        let id = args.next("a region ID")?.as_str().to_string();
        let style = args.next("a region style")?;
        if style.as_str() == "delete" {
            self.region(&id)?;
            self.space.regions.retain(|(n, _)| *n != id);
            return args.finish();
        }
        if self.space.regions.iter().any(|(n, _)| *n == id) {
            return Err(Problem::new(format!("there is a region `{id}` already")));
        }
        let mut raw: Vec<Value> = Vec::new();
        let mut parts = Vec::new();
        let kind = self.kind(args, style, &mut raw, &mut parts)?;
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
            self.space.length_unit(lattice_units)?
        } else {
            1.0
        };
        let scaled = |value: Value| match value {
            Value::Length(Input::Number(x)) if x.abs() >= INF => Input::Number(x),
            Value::Length(input) => input.scaled(unit),
            Value::Place(x) => Input::Number(x),
        };
        let leaves = parts.iter().map(|p: &Rc<Definition>| p.leaves).sum();
        if leaves > MOST_LEAVES {
            return Err(Problem::new(format!(
                "region `{id}` is made of {leaves} regions, more than {MOST_LEAVES}"
            )));
        }
        let definition = Definition {
            kind,
            values: raw.into_iter().map(scaled).collect(),
            unit,
            outside,
            leaves: if parts.is_empty() { 1 } else { leaves },
            parts,
            flat: self.space.dimension == 2,
        };
        for input in &definition.values {
            if let Input::Variable(name) = input {
                self.variable_exists(name)?;
            }
        }
        // what can be wrong now is said now
        self.resolve(&id, &definition)?;
        self.space.regions.push((id, Rc::new(definition)));
        Ok(())
    }

    /// The kind of a region; its numbers go to `raw`, the regions that it is made of to `parts`.
    fn kind(
        &self,
        args: &mut Args,
        style: &Word,
        raw: &mut Vec<Value>,
        parts: &mut Vec<Rc<Definition>>,
    ) -> Result<Kind> {
        Ok(match style.as_str() {
            "block" | "prism" => {
                for k in 0..6 {
                    raw.push(self.limit(args, "xlo xhi ylo yhi zlo zhi", k / 2, k % 2)?);
                }
                if style.as_str() == "prism" {
                    lengths(args, &["xy xz yz"; 3], raw)?;
                    Kind::Prism
                } else {
                    Kind::Block
                }
            }
            "cylinder" | "cone" => {
                let axis = args.axis()?;
                let kind = if style.as_str() == "cone" {
                    lengths(args, &[CENTER, CENTER, "the radius", "the radius"], raw)?;
                    Kind::Cone(axis)
                } else {
                    lengths(args, &[CENTER, CENTER, "the radius"], raw)?;
                    Kind::Cylinder(axis)
                };
                for side in 0..2 {
                    raw.push(self.limit(args, "its ends along the axis", axis, side)?);
                }
                kind
            }
            "sphere" => {
                lengths(args, &[CENTER, CENTER, CENTER, "the radius"], raw)?;
                Kind::Sphere
            }
            "ellipsoid" => {
                lengths(args, &[CENTER, CENTER, CENTER], raw)?;
                lengths(args, &["the semi-axes a b c"; 3], raw)?;
                Kind::Ellipsoid
            }
            "plane" => {
                lengths(args, &["a point of the plane"; 3], raw)?;
                lengths(args, &["the normal"; 3], raw)?;
                Kind::Plane
            }
            "union" | "intersect" => {
                for _ in 0..args.count("the number of regions", 2)? {
                    let word = args.next("a region ID")?;
                    let known = self.definition(word.as_str());
                    parts.push(known.map_err(|p| p.or_at(word.span))?);
                }
                if style.as_str() == "union" {
                    Kind::Union
                } else {
                    Kind::Intersect
                }
            }
            _ => return Err(args.unknown(style, "the region style", REGIONS)),
        })
    }

    /// A number, a variable, `INF` or `EDGE`.
    fn limit(&self, args: &mut Args, what: &str, axis: usize, side: usize) -> Result<Value> {
        if args.eat("INF") {
            return Ok(Value::Place(if side == 0 { -INF } else { INF }));
        }
        if args.eat("EDGE") {
            let domain = self.space.domain()?;
            let sides = if side == 0 { &domain.low } else { &domain.high };
            return Ok(Value::Place(sides[axis]));
        }
        args.input(what).map(Value::Length)
    }

    fn definition(&self, name: &str) -> Result<Rc<Definition>> {
        let found = self.space.regions.iter().find(|(n, _)| n == name);
        found.map(|(_, r)| r.clone()).ok_or_else(|| {
            Problem::new(format!("there is no region `{name}`")).help(suggestion(
                name,
                self.space.regions.iter().map(|(n, _)| n.as_str()),
            ))
        })
    }

    /// A region as it is now.
    ///
    /// # Errors
    /// There is none; a variable has no value.
    pub fn region(&mut self, name: &str) -> Result<Region> {
        let definition = self.definition(name)?;
        self.resolve(name, &definition)
    }

    fn resolve(&mut self, name: &str, definition: &Definition) -> Result<Region> {
        let mut values = Vec::with_capacity(definition.values.len());
        for input in &definition.values {
            values.push(match input {
                Input::Number(x) => *x,
                // LAMMPS scales variables of regions, too
                Input::Variable(v) => definition.unit * self.variable_number(v)?,
            });
        }
        let mut parts = Vec::with_capacity(definition.parts.len());
        for part in &definition.parts {
            parts.push(self.resolve(name, part)?);
        }
        definition
            .shape(&values, parts)
            .map_err(|what| Problem::new(format!("region `{name}` {what}")))
    }
}
