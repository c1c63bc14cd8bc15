//! `compute`, `uncompute`.

use std::rc::Rc;

use super::Args;
use crate::compute::{Compute, ComputeKind, Mode, STYLES, Source};
use crate::error::{Problem, Result, suggestion};
use crate::host::Quantity;
use crate::particles::Field;
use crate::session::Session;

impl Session<'_> {
    pub(super) fn add_compute(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let id = args.next("a compute ID")?;
        if self.watch.computes.iter().any(|c| c.id == id.as_str()) {
            return Err(Problem::at(
                id.span,
                format!("there is a compute `{}` already", id.as_str()),
            ));
        }
        let word = args.next("a group ID")?;
        let members = self
            .population
            .group(word.as_str())
            .map_err(|p| p.or_at(word.span))?;
        let style = args.next("a compute style")?;
        let raw = |q| ComputeKind::Atoms(vec![Field::Raw(q)]);
        let kind = match style.as_str() {
            "damage/atom" => raw(Quantity::Damage),
            "dilatation/atom" => raw(Quantity::Dilatation),
            "pe/atom" => raw(Quantity::Energy),
            "ke/atom" => ComputeKind::Atoms(vec![Field::Kinetic]),
            "ke" => ComputeKind::Kinetic,
            "pe" => ComputeKind::Potential,
            "temp" => ComputeKind::Temperature,
            "com" => ComputeKind::Center,
            "displace/atom" => ComputeKind::Displace {
                start: Rc::new(self.start_of_motion()?),
            },
            "stress/atom" => stress(args)?,
            "property/atom" => {
                let mut fields = Vec::new();
                while let Some(word) = args.optional() {
                    fields.push(match word.as_str() {
                        "s0" => Field::Raw(Quantity::CriticalStretch),
                        "vfrac" | "volume" => Field::Raw(Quantity::Volume),
                        "density" => Field::Raw(Quantity::Density),
                        name => Field::parse(name).ok_or_else(|| {
                            let known = [
                                "id", "type", "mass", "density", "vfrac", "s0", "x", "y", "z",
                                "xs", "xu", "ix", "vx", "vy", "vz", "fx", "fy", "fz",
                            ];
                            args.unknown(word, "the property", known)
                        })?,
                    });
                }
                if fields.is_empty() {
                    args.next("a property")?;
                }
                ComputeKind::Atoms(fields)
            }
            "reduce" | "reduce/region" => {
                let region = match style.as_str() {
                    "reduce" => None,
                    _ => {
                        let word = args.next("a region ID")?;
                        self.region(word.as_str()).map_err(|p| p.or_at(word.span))?;
                        Some(word.as_str().to_string())
                    }
                };
                let word = args.next("sum, min, max or ave")?;
                let mode = Mode::ALL
                    .iter()
                    .find(|(n, _)| *n == word.as_str())
                    .map(|(_, m)| *m);
                let mode =
                    mode.ok_or_else(|| args.unknown(word, "the mode", Mode::ALL.map(|(n, _)| n)))?;
                let mut inputs = Vec::new();
                while let Some(word) = args.optional() {
                    let input = Source::parse(word.as_str()).ok_or_else(|| {
                        args.unknown(
                            word,
                            "the input",
                            ["x", "vx", "fx", "c_ID", "c_ID[i]", "v_name"],
                        )
                    })?;
                    self.check_source(&input).map_err(|p| p.or_at(word.span))?;
                    inputs.push(input);
                }
                if inputs.is_empty() {
                    args.next("an input")?;
                }
                ComputeKind::Reduce {
                    mode,
                    inputs,
                    region,
                }
            }
            _ => return Err(args.unknown(style, "the compute style", STYLES)),
        };
        args.finish()?;
        self.watch.computes.push(Compute {
            id: id.as_str().to_string(),
            members,
            counted: None,
            kind,
        });
        Ok(())
    }

    /// Does a per-atom source exist?
    pub(super) fn check_source(&mut self, source: &Source) -> Result<()> {
        match source {
            Source::Variable(name) => self.variable_exists(name),
            Source::Compute(id, column) => self.check_columns(id, *column),
            Source::Field(_) => Ok(()),
        }
    }

    pub(super) fn remove_compute(&mut self, args: &mut Args) -> Result<()> {
        let id = args.next("a compute ID")?;
        args.finish()?;
        let before = self.watch.computes.len();
        self.watch.computes.retain(|c| c.id != id.as_str());
        if self.watch.computes.len() == before {
            return Err(
                Problem::at(id.span, format!("there is no compute `{}`", id.as_str())).help(
                    suggestion(
                        id.as_str(),
                        self.watch.computes.iter().map(|c| c.id.as_str()),
                    ),
                ),
            );
        }
        Ok(())
    }
}

/// `NULL [ke|pair|virial ...]`: which parts.
fn stress(args: &mut Args) -> Result<ComputeKind> {
    let temperature = args.next("NULL")?;
    if temperature.as_str() != "NULL" {
        return Err(Problem::at(
            temperature.span,
            "`compute stress/atom` with a temperature of its own is not supported",
        )
        .help("write NULL"));
    }
    if args.left() == 0 {
        return Ok(ComputeKind::Stress {
            kinetic: true,
            virial: true,
        });
    }
    let (mut kinetic, mut virial) = (false, false);
    while let Some(word) = args.optional() {
        match word.as_str() {
            "ke" => kinetic = true,
            "pair" | "virial" => virial = true,
            // there are none of these
            "bond" | "angle" | "dihedral" | "improper" | "kspace" | "fix" => {}
            _ => return Err(args.unknown(word, "the part", ["ke", "pair", "virial"])),
        }
    }
    Ok(ComputeKind::Stress { kinetic, virial })
}
