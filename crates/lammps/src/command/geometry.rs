//! `lattice`.

use super::Args;
use crate::error::{Problem, Result};
use crate::lattice::Lattice;
use crate::printf::general;
use crate::session::Session;
use crate::units::Units;

impl Session<'_> {
    pub(super) fn set_lattice(&mut self, args: &mut Args) -> Result<()> {
        let style = args.next("a lattice style")?;
        let dimension = match style.as_str() {
            "none" => self.space.dimension,
            "sc" => 3,
            "sq" => 2,
            _ => return Err(args.unknown(style, "the lattice", ["sc", "sq", "none"])),
        };
        if dimension != self.space.dimension {
            return Err(Problem::at(
                style.span,
                format!(
                    "lattice `{}` does not fit dimension {}",
                    style.as_str(),
                    self.space.dimension
                ),
            )
            .help("use `sc` in 3 and `sq` in 2 dimensions"));
        }
        let mut constant = args.positive("the lattice constant")?;
        let sites = style.as_str() != "none";
        if self.space.units == Units::Lj && sites {
            constant = libm::pow(1.0 / constant, 1.0 / dimension as f64); // a reduced density
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
        self.space.lattice = Some(Lattice {
            constant,
            origin,
            sites,
        });
        let c = general(constant, 7, false);
        self.console
            .print(&format!("Lattice spacing in x,y,z = {c} {c} {c}"));
        Ok(())
    }
}
