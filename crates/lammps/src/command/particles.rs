//! `create_box`, `read_data`, `read_dump`.

use std::path::PathBuf;

use super::Args;
use crate::domain::{Face, SimBox, corners};
use crate::error::{Problem, Result};
use crate::host::Quantity;
use crate::input;
use crate::read_dump::read_frame;
use crate::region::Shape;
use crate::session::Session;

impl Session<'_> {
    fn no_box_yet(&self) -> Result<()> {
        if !self.space.atom_style {
            return Err(Problem::new("`atom_style peri` must come before the atoms"));
        }
        if self.space.domain.is_some() {
            return Err(Problem::new(
                "there is a simulation box already; only one can be made",
            ));
        }
        if self.space.dimension == 2 && self.space.faces[2][0] != Face::Periodic {
            return Err(Problem::new("`dimension 2` needs a periodic z axis")
                .help("write `boundary f f p`"));
        }
        Ok(())
    }

    pub(super) fn create_box(&mut self, args: &mut Args) -> Result<()> {
        let types = args.count("the number of atom types", 1)?;
        let word = args.next("a region ID")?;
        args.finish()?;
        self.no_box_yet()?;
        let region = self.region(word.as_str()).map_err(|p| p.or_at(word.span))?;
        if let Shape::Prism { tilt, .. } = region.shape
            && tilt != [0.0; 3]
        {
            return Err(Problem::at(word.span, "tilted boxes are not supported")
                .help("use a block, cylinder or sphere with finite sides"));
        }
        let Some((low, high)) = region.bounds() else {
            return Err(Problem::at(
                word.span,
                format!(
                    "region `{}` is not bounded, so it cannot be the box",
                    word.as_str()
                ),
            )
            .help("use a block, cylinder or sphere with finite sides"));
        };
        if let Some(a) = (0..3).find(|&a| low[a] >= high[a]) {
            let axis = ["x", "y", "z"][a];
            return Err(Problem::at(
                word.span,
                format!("the box has no extent along {axis}"),
            ));
        }
        let domain = SimBox::new(low, high, self.space.faces);
        self.console
            .print(&format!("Created orthogonal box = {}", corners(low, high)));
        self.space.domain = Some(domain);
        self.population.take_types(types as usize)?;
        Ok(())
    }

    pub(super) fn read_data(&mut self, args: &mut Args) -> Result<()> {
        let word = args.next("a file name")?;
        args.finish()?;
        self.no_box_yet()?;
        let reader = input::open(&self.input_path(word.as_str()), word.as_str())
            .map_err(|p| p.or_at(word.span))?;
        self.console.print("Reading data file ...");
        let file = peridyne_io::read::lammps::read_data(reader, word.as_str())?;
        let n = file.atoms.len();
        self.console.print(&format!(
            "  orthogonal box = {}",
            corners(file.low, file.high)
        ));
        self.take_data(file, word.as_str())?;
        self.console
            .print(&format!("  reading atoms ...\n  {n} atoms"));
        Ok(())
    }

    /// Path of an input file: as given, or beside the script.
    pub fn input_path(&self, name: &str) -> PathBuf {
        let plain = PathBuf::from(name);
        if plain.exists() {
            return plain;
        }
        let folder = std::path::Path::new(&self.title).parent();
        folder
            .map(|f| f.join(name))
            .filter(|p| p.exists())
            .unwrap_or(plain)
    }

    pub(super) fn read_dump(&mut self, args: &mut Args) -> Result<()> {
        let word = args.next("a file name")?;
        let step = args.count("a step", 0)?;
        let fields: Vec<&str> = std::iter::from_fn(|| {
            let field = args
                .peek()
                .filter(|w| ["x", "y", "z", "vx", "vy", "vz"].contains(w))?;
            args.optional();
            Some(field)
        })
        .collect();
        let mut take_box = true;
        while let Some(option) = args.optional() {
            let unsupported = |help: &str| {
                Err(Problem::at(option.span, "this value is not supported").help(help.to_string()))
            };
            match option.as_str() {
                "box" => take_box = args.yes("box")?,
                "replace" if !args.yes("replace")? => return unsupported("replace yes"),
                "purge" | "trim" | "scaled" if args.yes("this option")? => {
                    return unsupported("write no");
                }
                "wrapped" if !args.yes("wrapped")? => return unsupported("wrapped yes"),
                "add" if args.next("`no`")?.as_str() != "no" => return unsupported("add no"),
                "format" if args.next("`native`")?.as_str() != "native" => {
                    return unsupported("format native");
                }
                "replace" | "purge" | "trim" | "scaled" | "wrapped" | "add" | "format" => {}
                _ => {
                    let known = [
                        "x", "y", "z", "vx", "vy", "vz", "box", "replace", "purge", "trim", "add",
                        "scaled", "wrapped", "format",
                    ];
                    return Err(args.unknown(option, "the field or option", known));
                }
            }
        }
        if fields.is_empty() {
            return Err(Problem::new("`read_dump` needs at least one field").help("x y z vx vy vz"));
        }
        let wanted: Vec<Vec<String>> = fields
            .iter()
            .map(|f| {
                let alternatives: &[&str] = if f.starts_with('v') {
                    &[""]
                } else {
                    &["", "u", "s"]
                };
                alternatives.iter().map(|s| format!("{f}{s}")).collect()
            })
            .collect();
        let reader = input::open(&self.input_path(word.as_str()), word.as_str())
            .map_err(|p| p.or_at(word.span))?;
        let (frame, choices) = read_frame(reader, word.as_str(), step, &wanted)?;
        let indices = frame
            .ids
            .iter()
            .map(|id| self.population.ids.find(*id))
            .collect::<Vec<_>>();
        let replaced = indices.iter().flatten().count();
        for ((field, choice), column) in fields.iter().zip(choices).zip(&frame.columns) {
            let axis = usize::from(field.as_bytes()[field.len() - 1] - b'x');
            let quantity = if field.starts_with('v') {
                Quantity::Velocity(axis)
            } else {
                Quantity::Position(axis)
            };
            let (low, edge) = (frame.low[axis], frame.high[axis] - frame.low[axis]);
            let mut values = vec![0.0; self.population.count()];
            self.population
                .store
                .particles()
                .read(quantity, 0, &mut values)?;
            for (index, x) in indices.iter().zip(column) {
                if let Some(slot) = index.and_then(|i| values.get_mut(i)) {
                    *slot = if choice == 2 { low + x * edge } else { *x };
                }
            }
            self.population
                .store
                .particles_mut()
                .write(quantity, 0, &values)?;
        }
        if take_box {
            let mut domain = *self.space.domain()?;
            for a in 0..3 {
                if domain.periodic(a)
                    && (domain.low[a], domain.high[a]) != (frame.low[a], frame.high[a])
                {
                    return Err(Problem::new(
                        "the periodic box of the dump differs from the box of the script",
                    )
                    .help("add `box no`"));
                }
                (domain.low[a], domain.high[a]) = (frame.low[a], frame.high[a]);
            }
            self.space.domain = Some(domain);
        }
        self.progress.step = step;
        self.progress.begin = step;
        self.progress.end = step;
        self.progress.time_base = (step, step as f64 * self.progress.time_step);
        self.console
            .print(&format!("Reading snapshot from dump file ... {step}"));
        self.console.print(&format!(
            "  {} atoms in snapshot\n  {replaced} atoms replaced",
            frame.ids.len()
        ));
        Ok(())
    }
}
