//! `set`, `velocity`.

use super::Args;
use crate::lammps::atoms::Members;
use crate::lammps::error::{Problem, Result};
use crate::lammps::fix::Input;
use crate::lammps::host::{BLOCK, Quantity};
use crate::lammps::session::Session;
use crate::lammps::variable::tree::Tree;

impl Session<'_> {
    pub(super) fn set_atoms(&mut self, args: &mut Args) -> Result<()> {
        self.domain()?;
        let style = args.next("`group`, `atom`, `type` or `region`")?;
        let word = args.next("an ID or range")?;
        let members = match style.as_str() {
            "group" => self
                .group(word.as_str())
                .map_err(|p| p.or_at(word.span))?
                .as_ref()
                .clone(),
            "region" => {
                let region = self
                    .region(word.as_str())
                    .map_err(|p| p.or_at(word.span))?
                    .clone();
                let x = self.positions()?;
                Members::collect(x.len(), |i| region.contains(x[i]))
            }
            "atom" => {
                let range = self.range(word, self.ids.get(self.count().saturating_sub(1)))?;
                Members::collect(self.count(), |i| range.contains(&self.ids.get(i)))
            }
            "type" => {
                let range = self.range(word, self.types as u64)?;
                self.with_type(|t| range.contains(&t))?
            }
            _ => return Err(args.unknown(style, "the style", ["group", "atom", "type", "region"])),
        };
        if args.left() == 0 {
            args.next("a property")?;
        }
        self.console.print("Setting atom values ...");
        while let Some(word) = args.optional() {
            let name = word.as_str();
            let quantity = match name {
                "density" | "mass" => Quantity::Density,
                "volume" => Quantity::Volume,
                "type" => Quantity::Type,
                "x" => Quantity::Position(0),
                "y" => Quantity::Position(1),
                "z" => Quantity::Position(2),
                "vx" => Quantity::Velocity(0),
                "vy" => Quantity::Velocity(1),
                "vz" => Quantity::Velocity(2),
                _ => {
                    let known = ["density", "volume", "type", "x", "y", "z", "vx", "vy", "vz"];
                    return Err(args.unknown(word, "the property", known));
                }
            };
            let value = args.input(name)?;
            let types = self.types as f64;
            let allowed = |x: f64| match quantity {
                Quantity::Density | Quantity::Volume => x > 0.0 && x.is_finite(),
                Quantity::Type => x >= 1.0 && x <= types && x.fract() == 0.0,
                Quantity::Position(_)
                | Quantity::Reference(_)
                | Quantity::Velocity(_)
                | Quantity::Force(_)
                | Quantity::Damage
                | Quantity::Dilatation
                | Quantity::CriticalStretch
                | Quantity::Energy => x.is_finite(),
            };
            let wrong = |x: f64, who: String| {
                let what = match quantity {
                    Quantity::Type => format!("be a whole number from 1 to {types}"),
                    Quantity::Density | Quantity::Volume => "be positive".to_string(),
                    Quantity::Position(_)
                    | Quantity::Reference(_)
                    | Quantity::Velocity(_)
                    | Quantity::Force(_)
                    | Quantity::Damage
                    | Quantity::Dilatation
                    | Quantity::CriticalStretch
                    | Quantity::Energy => "be finite".to_string(),
                };
                Problem::at(word.span, format!("{name} must {what}, found {x}{who}"))
            };
            let tree = match &value {
                Input::Number(x) => Tree::Number(*x),
                Input::Variable(v) => self.variable_tree(v)?,
            };
            if let (Tree::Number(x), Members::All) = (&tree, &members) {
                if !allowed(*x) {
                    return Err(wrong(*x, String::new()));
                }
                self.store.particles_mut().fill(quantity, *x)?;
            } else {
                let n = self.count();
                let mut old = vec![0.0; BLOCK];
                let mut new = vec![0.0; BLOCK];
                // all values first: a formula may use what is being set
                let mut all = vec![0.0; n];
                for first in (0..n).step_by(BLOCK) {
                    let m = BLOCK.min(n - first);
                    self.store
                        .particles()
                        .read(quantity, first, &mut old[..m])?;
                    tree.fill(&self.view()?, &self.clock(), first, &mut new[..m])?;
                    for k in 0..m {
                        let mine = members.contains(first + k);
                        if mine && !allowed(new[k]) {
                            return Err(wrong(
                                new[k],
                                format!(" for the atom with id {}", self.ids.get(first + k)),
                            ));
                        }
                        all[first + k] = if mine { new[k] } else { old[k] };
                    }
                }
                self.store.particles_mut().write(quantity, 0, &all)?;
            }
            self.console.print(&format!(
                "  {} settings made for {name}",
                members.count(self.count())
            ));
        }
        Ok(())
    }

    pub(super) fn set_velocity(&mut self, args: &mut Args) -> Result<()> {
        self.domain()?;
        let word = args.next("a group ID")?;
        let members = self.group(word.as_str()).map_err(|p| p.or_at(word.span))?;
        let style = args.next("`set`")?;
        if style.as_str() != "set" {
            return Err(args.unknown(style, "the style", ["set"]));
        }
        let mut values = [const { None }; 3];
        for v in &mut values {
            if !args.eat("NULL") {
                *v = Some(args.input("vx vy vz (NULL leaves one as it is)")?);
            }
        }
        let (mut sum, mut lattice_units) = (false, true);
        while let Some(word) = args.optional() {
            match word.as_str() {
                "sum" => sum = args.yes("sum")?,
                "units" => lattice_units = args.units()?,
                _ => return Err(args.unknown(word, "the option", ["sum", "units"])),
            }
        }
        let unit = self.length_unit(lattice_units)?;
        if self.dimension == 2
            && !matches!(
                values[2],
                None | Some(Input::Number(0.0) | Input::Variable(_))
            )
        {
            return Err(Problem::new("vz must be 0 in two dimensions"));
        }
        // evaluated together, before any of them is set
        let mut trees = Vec::new();
        for value in &values {
            trees.push(match value {
                None => None,
                Some(Input::Number(x)) => Some(Tree::Number(x * unit)),
                Some(Input::Variable(name)) => Some(self.variable_tree(name)?), // not scaled, as in LAMMPS
            });
        }
        let n = self.count();
        let mut new = vec![[0.0; BLOCK]; 3];
        let mut old = [0.0; BLOCK];
        for first in (0..n).step_by(BLOCK) {
            let m = BLOCK.min(n - first);
            for (tree, new) in trees.iter().zip(&mut new) {
                if let Some(tree) = tree {
                    tree.fill(&self.view()?, &self.clock(), first, &mut new[..m])?;
                }
            }
            for a in (0..3).filter(|a| trees[*a].is_some()) {
                self.store
                    .particles()
                    .read(Quantity::Velocity(a), first, &mut old[..m])?;
                for k in (0..m).filter(|k| members.contains(first + k)) {
                    old[k] = if sum { old[k] + new[a][k] } else { new[a][k] };
                    if !old[k].is_finite() {
                        return Err(Problem::new(format!(
                            "the velocity of atom {} is not finite",
                            self.ids.get(first + k)
                        )));
                    }
                }
                self.store
                    .particles_mut()
                    .write(Quantity::Velocity(a), first, &old[..m])?;
            }
        }
        Ok(())
    }
}
