//! `velocity`.

use super::Args;
use crate::atoms::Members;
use crate::compute::Mode;
use crate::error::{Problem, Result};
use crate::fix::Input;
use crate::host::{BLOCK, Quantity};
use crate::park::Park;
use crate::particles::Field;
use crate::session::{Session, Store};
use crate::variable::tree::Tree;

/// Numbers that LAMMPS throws away before those of `loop local`.
const WARM_UP: usize = 100;

/// In which order atoms draw their numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    /// By id, from one sequence.
    All,
    /// As they are stored.
    Local,
    /// Each from its place.
    Geometry,
}

struct Options {
    sum: bool,
    momentum: bool,
    rotation: bool,
    gaussian: bool,
    order: Order,
    lattice_units: bool,
}

fn options(args: &mut Args) -> Result<Options> {
    let mut options = Options {
        sum: false,
        momentum: true,
        rotation: false,
        gaussian: false,
        order: Order::All,
        lattice_units: true,
    };
    while let Some(word) = args.optional() {
        match word.as_str() {
            "sum" => options.sum = args.yes("sum")?,
            "mom" => options.momentum = args.yes("mom")?,
            "rot" => options.rotation = args.yes("rot")?,
            "units" => options.lattice_units = args.units()?,
            "dist" => {
                let dist = args.next("uniform or gaussian")?;
                options.gaussian = match dist.as_str() {
                    "uniform" => false,
                    "gaussian" => true,
                    _ => {
                        let known = ["uniform", "gaussian"];
                        return Err(args.unknown(dist, "the distribution", known));
                    }
                };
            }
            "loop" => {
                let order = args.next("all, local or geom")?;
                options.order = match order.as_str() {
                    "all" => Order::All,
                    "local" => Order::Local,
                    "geom" => Order::Geometry,
                    _ => return Err(args.unknown(order, "the loop", ["all", "local", "geom"])),
                };
            }
            _ => {
                let known = ["sum", "mom", "rot", "dist", "loop", "units"];
                return Err(args.unknown(word, "the option", known));
            }
        }
    }
    Ok(options)
}

impl Session<'_> {
    pub(super) fn set_velocity(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let word = args.next("a group ID")?;
        let members = self
            .population
            .group(word.as_str())
            .map_err(|p| p.or_at(word.span))?;
        let style = args.next("set, create, ramp, scale or zero")?;
        match style.as_str() {
            "set" => self.velocity_set(args, &members),
            "create" => self.velocity_create(args, &members),
            "ramp" => self.velocity_ramp(args, &members),
            "scale" => {
                let wanted = args.number("the temperature")?;
                options(args)?;
                let now = self.temperature_of(&members, None)?;
                self.scale_to(&members, now, wanted)
            }
            "zero" => {
                let what = args.next("linear or angular")?;
                let angular = match what.as_str() {
                    "linear" => false,
                    "angular" => true,
                    _ => return Err(args.unknown(what, "the motion", ["linear", "angular"])),
                };
                options(args)?;
                if members.count(self.population.count()) == 0 {
                    return Err(Problem::new("the group has no atoms"));
                }
                self.take_motion(&members, [!angular; 3], angular)
            }
            _ => {
                let known = ["set", "create", "ramp", "scale", "zero"];
                Err(args.unknown(style, "the style", known))
            }
        }
    }

    /// Temperature of a group: `2 E / (k (D N − D))`, N as it was `counted` or is now.
    pub fn temperature_of(&self, members: &Members, counted: Option<usize>) -> Result<f64> {
        let kinetic = self.reduce(Mode::Sum, members, &Tree::Field(Field::Kinetic))?;
        let n = counted.unwrap_or_else(|| members.count(self.population.count()));
        let degrees = (self.space.dimension * n) as f64 - self.space.dimension as f64;
        Ok(if degrees > 0.0 {
            2.0 * kinetic / (degrees * self.space.units.boltzmann())
        } else {
            0.0
        })
    }

    fn scale_to(&mut self, members: &Members, now: f64, wanted: f64) -> Result<()> {
        if wanted < 0.0 {
            return Err(Problem::new(format!(
                "the temperature {wanted} is negative"
            )));
        }
        if now == 0.0 {
            return Err(Problem::new(
                "atoms at rest cannot be scaled to a temperature (two atoms at least must move)",
            ));
        }
        let factor = (wanted / now).sqrt();
        for a in 0..self.space.dimension {
            let mut v = self.population.raw(Quantity::Velocity(a))?;
            for i in (0..v.len()).filter(|i| members.contains(*i)) {
                v[i] *= factor;
            }
            self.put_velocity(a, &v)?;
        }
        Ok(())
    }

    fn put_velocity(&mut self, axis: usize, v: &[f64]) -> Result<()> {
        if let Some(i) = v.iter().position(|v| !v.is_finite()) {
            return Err(Problem::new(format!(
                "the velocity of the atom with id {} is not finite",
                self.population.ids.get(i)
            )));
        }
        let atoms = self.population.store.particles_mut();
        Ok(atoms.write(Quantity::Velocity(axis), 0, v)?)
    }

    /// `create T SEED`: random velocities at a temperature.
    fn velocity_create(&mut self, args: &mut Args, members: &Members) -> Result<()> {
        let wanted = args.number("the temperature")?;
        let seed = args.seed()?;
        let options = options(args)?;
        let n = self.population.count();
        let mass = self.population.raw(Quantity::Density)?;
        let x = self.positions()?;
        let mut park = Park::new(seed).ok_or_else(|| Problem::new("the seed must be positive"))?;
        match options.order {
            Order::All if !matches!(self.population.ids, crate::atoms::Ids::Count(_)) => {
                return Err(Problem::new(
                    "`velocity create` with `loop all` needs atom ids from 1 on without gaps",
                )
                .help("write `loop geom`"));
            }
            Order::Local => {
                park.skip(WARM_UP);
                if matches!(self.population.store, Store::Engine(_)) {
                    self.console.note("`velocity create ... loop local` takes the atoms in order of id; LAMMPS has sorted them in space since the first run: its numbers are the same, other atoms get them");
                }
            }
            Order::All | Order::Geometry => {}
        }
        let mut new = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        for i in 0..n {
            let mine = members.contains(i);
            if !mine && options.order != Order::All {
                continue;
            }
            if options.order == Order::Geometry {
                park = Park::at(seed, x[i]);
            }
            let draw = |p: &mut Park| match options.gaussian {
                true => p.normal(),
                false => p.uniform() - 0.5,
            };
            let three = [draw(&mut park), draw(&mut park), draw(&mut park)];
            if mine {
                let factor = 1.0 / mass[i].sqrt();
                for a in 0..self.space.dimension {
                    new[a][i] = three[a] * factor;
                }
            }
        }
        let mut before = [const { Vec::new() }; 3];
        for a in 0..3 {
            let old = self.population.raw(Quantity::Velocity(a))?;
            let pick = |i: usize| {
                if members.contains(i) {
                    new[a][i]
                } else {
                    old[i]
                }
            };
            self.put_velocity(a, &(0..n).map(pick).collect::<Vec<f64>>())?;
            before[a] = old;
        }
        if options.momentum {
            self.take_motion(members, [true; 3], false)?;
        }
        if options.rotation {
            self.take_motion(members, [false; 3], true)?;
        }
        let now = self.temperature_of(members, None)?;
        self.scale_to(members, now, wanted)?;
        if options.sum {
            for (a, before) in before.iter().enumerate() {
                let mut v = self.population.raw(Quantity::Velocity(a))?;
                for i in (0..n).filter(|i| members.contains(*i)) {
                    v[i] += before[i];
                }
                self.put_velocity(a, &v)?;
            }
        }
        Ok(())
    }

    /// `ramp VDIM VLO VHI DIM CLO CHI`: a velocity that depends on one coordinate.
    fn velocity_ramp(&mut self, args: &mut Args, members: &Members) -> Result<()> {
        let word = args.next("vx, vy or vz")?;
        let known = ["vx", "vy", "vz"];
        let axis = known.iter().position(|v| *v == word.as_str());
        let axis = axis.ok_or_else(|| args.unknown(word, "the velocity", known))?;
        if axis >= self.space.dimension {
            return Err(Problem::at(
                word.span,
                "in two dimensions nothing moves along z",
            ));
        }
        let speeds = [args.number("vlo")?, args.number("vhi")?];
        let along = args.axis()?;
        let ends = [args.number("clo")?, args.number("chi")?];
        let options = options(args)?;
        let unit = self.space.length_unit(options.lattice_units)?;
        let ([lo, hi], [from, to]) = (speeds.map(|v| unit * v), ends.map(|c| unit * c));
        if from == to {
            return Err(Problem::new(
                "the ramp has no length: clo and chi are equal",
            ));
        }
        let x = self.positions()?;
        let mut v = self.population.raw(Quantity::Velocity(axis))?;
        for i in (0..v.len()).filter(|i| members.contains(*i)) {
            let fraction = ((x[i][along] - from) / (to - from)).clamp(0.0, 1.0);
            let ramp = lo + fraction * (hi - lo);
            v[i] = if options.sum { v[i] + ramp } else { ramp };
        }
        self.put_velocity(axis, &v)
    }

    /// `set VX VY VZ`
    fn velocity_set(&mut self, args: &mut Args, members: &Members) -> Result<()> {
        let mut values = [const { None }; 3];
        for v in &mut values {
            if !args.eat("NULL") {
                *v = Some(args.input("vx vy vz (NULL leaves one as it is)")?);
            }
        }
        let Options {
            sum, lattice_units, ..
        } = options(args)?;
        let unit = self.space.length_unit(lattice_units)?;
        if self.space.dimension == 2
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
        let n = self.population.count();
        let mut new = vec![[0.0; BLOCK]; 3];
        let mut old = [0.0; BLOCK];
        for first in (0..n).step_by(BLOCK) {
            let m = BLOCK.min(n - first);
            for (tree, new) in trees.iter().zip(&mut new) {
                if let Some(tree) = tree {
                    tree.fill(&self.view()?, &self.progress.clock(), first, &mut new[..m])?;
                }
            }
            for a in (0..3).filter(|a| trees[*a].is_some()) {
                self.population.store.particles().read(
                    Quantity::Velocity(a),
                    first,
                    &mut old[..m],
                )?;
                for k in (0..m).filter(|k| members.contains(first + k)) {
                    old[k] = if sum { old[k] + new[a][k] } else { new[a][k] };
                    if !old[k].is_finite() {
                        return Err(Problem::new(format!(
                            "the velocity of atom {} is not finite",
                            self.population.ids.get(first + k)
                        )));
                    }
                }
                self.population.store.particles_mut().write(
                    Quantity::Velocity(a),
                    first,
                    &old[..m],
                )?;
            }
        }
        Ok(())
    }
}
