//! `displace_atoms`, `delete_atoms`.

use super::Args;
use crate::atoms::{Ids, Members};
use crate::compute::ComputeKind;
use crate::error::{Problem, Result};
use crate::fix::{FixKind, Input};
use crate::host::Quantity;
use crate::park::Park;
use crate::session::{Session, Store};
use crate::vector::cross;

impl Session<'_> {
    pub(super) fn displace_atoms(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let word = args.next("a group ID")?;
        let members = self
            .population
            .group(word.as_str())
            .map_err(|p| p.or_at(word.span))?;
        let style = args.next("move, ramp, random or rotate")?;
        let n = self.population.count();
        let mut x = self.population.unwrapped()?;
        let boxed = self.positions()?;
        let mine: Vec<usize> = (0..n).filter(|i| members.contains(*i)).collect();
        match style.as_str() {
            "move" => {
                let way = [
                    args.input("dx dy dz")?,
                    args.input("dx dy dz")?,
                    args.input("dx dy dz")?,
                ];
                let unit = self.displace_unit(args)?;
                for (a, way) in way.iter().enumerate() {
                    // LAMMPS scales variables here, too
                    let way = match way {
                        Input::Number(d) => vec![unit * d; n],
                        Input::Variable(name) => {
                            let values = self.variable_values(name)?;
                            values.into_iter().map(|d| unit * d).collect()
                        }
                    };
                    mine.iter().for_each(|i| x[*i][a] += way[*i]);
                    // the next variable sees the atoms where they are by then
                    self.place(a, &x)?;
                }
            }
            "ramp" => {
                let axis = args.axis()?;
                let ways = [args.number("dlo")?, args.number("dhi")?];
                let along = args.axis()?;
                let ends = [args.number("clo")?, args.number("chi")?];
                let unit = self.displace_unit(args)?;
                let ([lo, hi], [from, to]) = (ways.map(|d| unit * d), ends.map(|c| unit * c));
                if from == to {
                    return Err(Problem::new(
                        "the ramp has no length: clo and chi are equal",
                    ));
                }
                for &i in &mine {
                    let fraction = ((boxed[i][along] - from) / (to - from)).clamp(0.0, 1.0);
                    x[i][axis] += lo + fraction * (hi - lo);
                }
            }
            "random" => {
                let most = [
                    args.number("dx dy dz")?,
                    args.number("dx dy dz")?,
                    args.number("dx dy dz")?,
                ];
                let seed = args.seed()?;
                let unit = self.displace_unit(args)?;
                for &i in &mine {
                    let mut park = Park::at(seed, boxed[i]);
                    for (x, most) in x[i].iter_mut().zip(most) {
                        *x += unit * most * 2.0 * (park.uniform() - 0.5);
                    }
                }
            }
            "rotate" => {
                let mut six = [0.0; 6];
                for (k, x) in six.iter_mut().enumerate() {
                    *x = args.number(if k < 3 {
                        "a point of the axis"
                    } else {
                        "the axis"
                    })?;
                }
                let angle = args.number("the angle in degrees")?.to_radians();
                let unit = self.displace_unit(args)?;
                let point = [six[0], six[1], six[2]].map(|p| unit * p);
                let axis = [six[3], six[4], six[5]];
                let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
                if length == 0.0 {
                    return Err(Problem::new("the axis of rotation has no length"));
                }
                if self.space.dimension == 2 && (axis[0] != 0.0 || axis[1] != 0.0) {
                    return Err(Problem::new("in two dimensions the axis of rotation is z"));
                }
                let axis = axis.map(|c| c / length);
                let (sin, cos) = libm::sincos(angle);
                for &i in &mine {
                    let d = [0, 1, 2].map(|a| x[i][a] - point[a]);
                    let along: f64 = (0..3).map(|a| d[a] * axis[a]).sum();
                    let arm = [0, 1, 2].map(|a| d[a] - along * axis[a]);
                    let side = cross(axis, arm);
                    for a in 0..self.space.dimension {
                        x[i][a] = point[a] + along * axis[a] + cos * arm[a] + sin * side[a];
                    }
                }
            }
            _ => {
                let known = ["move", "ramp", "random", "rotate"];
                return Err(args.unknown(style, "the style", known));
            }
        }
        self.console.print("Displacing atoms ...");
        (0..3).try_for_each(|a| self.place(a, &x))?;
        // faces that follow the atoms do so at once
        self.shrink_box()
    }

    /// Puts atoms to these places on one axis.
    fn place(&mut self, axis: usize, x: &[[f64; 3]]) -> Result<()> {
        let domain = *self.space.domain()?;
        // atoms that are not built yet lie in the box
        let place = |x: f64| match self.population.store {
            Store::Atoms(_) => domain.wrap(axis, x).0,
            Store::Engine(_) => x,
        };
        let values: Vec<f64> = x.iter().map(|x| place(x[axis])).collect();
        if let Some(i) = values.iter().position(|x| !x.is_finite()) {
            return Err(Problem::new(format!(
                "the position of the atom with id {} is not finite",
                self.population.ids.get(i)
            )));
        }
        let atoms = self.population.store.particles_mut();
        Ok(atoms.write(Quantity::Position(axis), 0, &values)?)
    }

    fn displace_unit(&self, args: &mut Args) -> Result<f64> {
        let mut lattice_units = true;
        while let Some(word) = args.optional() {
            match word.as_str() {
                "units" => lattice_units = args.units()?,
                _ => return Err(args.unknown(word, "the option", ["units"])),
            }
        }
        self.space.length_unit(lattice_units)
    }

    pub(super) fn delete_atoms(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let style = args.next("group or region")?;
        let word = args.next("an ID")?;
        let gone = match style.as_str() {
            "group" => {
                let members = self
                    .population
                    .group(word.as_str())
                    .map_err(|p| p.or_at(word.span))?;
                members.as_ref().clone()
            }
            "region" => {
                let region = self.region(word.as_str()).map_err(|p| p.or_at(word.span))?;
                let x = self.positions()?;
                Members::collect(x.len(), |i| region.contains(x[i]))
            }
            _ => return Err(args.unknown(style, "the style", ["group", "region"])),
        };
        let mut compress = true;
        while let Some(word) = args.optional() {
            match word.as_str() {
                "compress" => compress = args.yes("compress")?,
                // there are no molecules
                "bond" | "mol" => {
                    args.yes(word.as_str())?;
                }
                _ => return Err(args.unknown(word, "the option", ["compress"])),
            }
        }
        let n = self.population.count();
        if compress && matches!(self.population.store, Store::Engine(_)) {
            return Err(Problem::new(
                "`delete_atoms` after the first `run` would give the atoms new ids, by which bonds know them",
            )
            .help("add `compress no`, or move it before the first `run`"));
        }
        let ids: Vec<u32> = (0..n as u32)
            .filter(|i| gone.contains(*i as usize))
            .collect();
        if ids.len() == n && n > 0 && matches!(self.population.store, Store::Engine(_)) {
            return Err(Problem::new("`delete_atoms` would leave no atoms"));
        }
        match &mut self.population.store {
            Store::Atoms(atoms) if compress => {
                let keeps = |k: &ComputeKind| matches!(k, ComputeKind::Displace { .. });
                if self.watch.computes.iter().any(|c| keeps(&c.kind))
                    || self
                        .fixes
                        .all
                        .iter()
                        .any(|f| matches!(f.kind, FixKind::Move { .. }))
                {
                    return Err(Problem::new("`delete_atoms` gives the atoms new ids, by which `compute displace/atom` and `fix move` know them")
                        .help("move it before them, or add `compress no`"));
                }
                let places = filled(n, |i| gone.contains(i));
                self.population.ids = Ids::Count(places.len());
                atoms.pick(&places, self.population.ids.clone());
                self.forget(&places);
            }
            _ => self.remove(&ids)?,
        }
        self.console.print(&format!(
            "Deleted {} atoms, new total = {}",
            ids.len(),
            self.population.count()
        ));
        Ok(())
    }
}

/// Where each of the atoms that are left comes from: LAMMPS puts the last one into every hole.
fn filled(n: usize, gone: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut places: Vec<usize> = (0..n).collect();
    let mut at = 0;
    while at < places.len() {
        if gone(places[at]) {
            places.swap_remove(at);
        } else {
            at += 1;
        }
    }
    places
}
