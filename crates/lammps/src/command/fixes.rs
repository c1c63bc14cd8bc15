//! `fix`, `unfix`.

use std::cell::RefCell;
use std::rc::Rc;

use super::Args;
use crate::error::{Problem, Result, suggestion};
use crate::fix::{Fix, FixKind, Input, Path, STYLES, WallFace};
use crate::host::{Form, Push};
use crate::session::Session;
use crate::variable::Kind;

const INDENT: &str = "fix ID GROUP indent K sphere X Y Z R | cylinder DIM C1 C2 R | plane DIM POS lo|hi [side in|out] [units box|lattice]";

impl Session<'_> {
    pub(super) fn add_fix(&mut self, args: &mut Args) -> Result<()> {
        self.space.domain()?;
        let id = args.next("a fix ID")?.as_str().to_string();
        let word = args.next("a group ID")?;
        let members = self
            .population
            .group(word.as_str())
            .map_err(|p| p.or_at(word.span))?;
        let style = args.next("a fix style")?;
        let kind = match style.as_str() {
            "nve" => FixKind::Nve,
            "indent" => self.indent(args)?,
            "setforce" => {
                let mut force = [const { None }; 3];
                for f in &mut force {
                    if !args.eat("NULL") {
                        *f = Some(self.force(args, "fx fy fz (NULL leaves one as it is)")?);
                    }
                }
                let (_, region) = self.force_options(args, &["region"])?;
                FixKind::SetForce { force, region }
            }
            "addforce" => {
                let what = "fx fy fz";
                let force = [
                    self.force(args, what)?,
                    self.force(args, what)?,
                    self.force(args, what)?,
                ];
                let (every, region) = self.force_options(args, &["region", "every"])?;
                FixKind::AddForce {
                    force,
                    every,
                    region,
                }
            }
            "viscous" => self.viscous(args)?,
            "enforce2d" if self.space.dimension != 2 => {
                return Err(Problem::new("`fix enforce2d` needs `dimension 2`"));
            }
            "enforce2d" => FixKind::Enforce2d,
            "move" => FixKind::Move {
                path: self.path(args)?,
                start: Rc::new(self.start_of_motion()?),
            },
            "wall/reflect" => self.walls(args)?,
            "momentum" => self.momentum(args)?,
            "print" => self.fix_print(args, &id)?,
            "ave/time" => FixKind::Average(Rc::new(RefCell::new(self.average(args, &id)?))),
            _ => return Err(args.unknown(style, "the fix style", STYLES)),
        };
        args.finish()?;
        let fix = Fix { id, members, kind };
        match self.fixes.all.iter_mut().find(|f| f.id == fix.id) {
            Some(old) if std::mem::discriminant(&old.kind) == std::mem::discriminant(&fix.kind) => {
                *old = Rc::new(fix)
            }
            Some(_) => {
                return Err(
                    Problem::new(format!("there is a fix `{}` of another style", fix.id))
                        .help("use another ID, or `unfix` it before"),
                );
            }
            None => self.fixes.all.push(Rc::new(fix)),
        }
        Ok(())
    }

    /// A number, or a variable that gives one.
    fn one_number(&mut self, args: &mut Args, what: &str) -> Result<Input> {
        let input = args.input(what)?;
        if let Input::Variable(name) = &input {
            if let Some(Kind::Atom(_)) = self.formulas.variables.get(name) {
                return Err(Problem::new(format!(
                    "variable `{name}` is atom-style; this takes one number"
                ))
                .help("use an equal-style variable"));
            }
            self.variable_exists(name)?;
        }
        Ok(input)
    }

    /// A number, or a variable of any style.
    fn force(&mut self, args: &mut Args, what: &str) -> Result<Input> {
        let input = args.input(what)?;
        if let Input::Variable(name) = &input {
            self.variable_exists(name)?;
        }
        Ok(input)
    }

    pub(super) fn variable_exists(&self, name: &str) -> Result<()> {
        match self.formulas.variables.get(name) {
            Some(_) => Ok(()),
            None => Err(Problem::new(format!("there is no variable `{name}`"))
                .help(suggestion(name, self.formulas.variables.names()))),
        }
    }

    /// `[every N] [region ID]`
    fn force_options(&mut self, args: &mut Args, known: &[&str]) -> Result<(u64, Option<String>)> {
        let (mut every, mut region) = (1, None);
        while let Some(word) = args.optional() {
            match word.as_str() {
                "region" => {
                    let name = args.next("a region ID")?;
                    self.region(name.as_str()).map_err(|p| p.or_at(name.span))?;
                    region = Some(name.as_str().to_string());
                }
                "every" if known.contains(&"every") => {
                    every = args.count("the number of steps", 1)?;
                }
                _ => return Err(args.unknown(word, "the option", known.iter().copied())),
            }
        }
        Ok((every, region))
    }

    fn viscous(&mut self, args: &mut Args) -> Result<FixKind> {
        let gamma = args.number("the drag coefficient γ")?;
        let mut each = vec![gamma; self.population.types];
        while let Some(word) = args.optional() {
            if word.as_str() != "scale" {
                return Err(args.unknown(word, "the option", ["scale"]));
            }
            let kind = args.count("an atom type", 1)? as usize;
            let ratio = args.number("the ratio")?;
            match each.get_mut(kind - 1) {
                Some(slot) => *slot = gamma * ratio,
                None => {
                    return Err(Problem::new(format!(
                        "atom type {kind} is not between 1 and {}",
                        self.population.types
                    )));
                }
            }
        }
        Ok(FixKind::Viscous(each))
    }

    fn indent(&mut self, args: &mut Args) -> Result<FixKind> {
        let stiffness = args.number("the stiffness K")?;
        let zero = || Input::Number(0.0);
        let mut shape = None;
        let mut push = Push::Out;
        let mut lattice_units = true;
        while let Some(word) = args.optional() {
            match word.as_str() {
                "sphere" => {
                    let what = "the centre";
                    let center = [
                        self.one_number(args, what)?,
                        self.one_number(args, what)?,
                        self.one_number(args, what)?,
                    ];
                    shape = Some((Form::Sphere, center, self.one_number(args, "the radius")?));
                }
                "cylinder" => {
                    let axis = args.axis()?;
                    let mut center = [zero(), zero(), zero()];
                    for a in (0..3).filter(|a| *a != axis) {
                        center[a] = self.one_number(args, "the centre across the axis")?;
                    }
                    let radius = self.one_number(args, "the radius")?;
                    shape = Some((Form::Cylinder(axis), center, radius));
                }
                "plane" => {
                    let axis = args.axis()?;
                    let mut center = [zero(), zero(), zero()];
                    center[axis] = self.one_number(args, "the position")?;
                    let side = args.next("lo or hi")?;
                    push = match side.as_str() {
                        "lo" => Push::Out,
                        "hi" => Push::In,
                        _ => return Err(args.unknown(side, "the side", ["lo", "hi"])),
                    };
                    shape = Some((Form::Plane(axis), center, zero()));
                }
                "units" => lattice_units = args.units()?,
                "side" => {
                    let side = args.next("`in` or `out`")?;
                    push = match side.as_str() {
                        "out" => Push::Out,
                        "in" => Push::In,
                        _ => return Err(args.unknown(side, "the side", ["in", "out"])),
                    };
                    if let Some((Form::Plane(_), ..)) = shape {
                        return Err(Problem::at(
                            side.span,
                            "a plane has the sides lo and hi only",
                        ));
                    }
                }
                _ => {
                    let text = word.as_str();
                    return Err(Problem::at(
                        word.span,
                        format!("`fix indent` with `{text}` is not supported"),
                    )
                    .help(format!("supported: {INDENT}")));
                }
            }
        }
        let Some((form, center, radius)) = shape else {
            return Err(
                Problem::new("`fix indent` needs a sphere, cylinder or plane").help(INDENT),
            );
        };
        let unit = self.space.length_unit(lattice_units)?;
        Ok(FixKind::Indent {
            stiffness,
            form,
            push,
            // variables are in box units
            center: center.map(|c| c.scaled(unit)),
            radius: radius.scaled(unit),
        })
    }

    fn path(&mut self, args: &mut Args) -> Result<Path> {
        let style = args.next("linear, wiggle, rotate or variable")?;
        let three = |args: &mut Args, what: &str| -> Result<[Option<f64>; 3]> {
            let mut values = [None; 3];
            for v in &mut values {
                if !args.eat("NULL") {
                    *v = Some(args.number(what)?);
                }
            }
            Ok(values)
        };
        const OPEN: &str = "(NULL leaves an axis to the forces)";
        let mut path = match style.as_str() {
            "linear" => Path::Linear(three(args, &format!("the velocity {OPEN}"))?),
            "wiggle" => {
                let amplitude = three(args, &format!("the amplitude {OPEN}"))?;
                Path::Wiggle(amplitude, args.positive("the period")?)
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
                let n = [six[3], six[4], six[5]];
                let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
                if length == 0.0 {
                    return Err(Problem::new("the axis of rotation has no length"));
                }
                if self.space.dimension == 2 && (n[0] != 0.0 || n[1] != 0.0) {
                    return Err(Problem::new("in two dimensions the axis of rotation is z"));
                }
                Path::Rotate {
                    point: [six[0], six[1], six[2]],
                    axis: n.map(|c| c / length),
                    period: args.positive("the period")?,
                }
            }
            "variable" => {
                let mut six = [const { None }; 6];
                for v in &mut six {
                    if args.eat("NULL") {
                        continue;
                    }
                    let word = args.next("v_dx v_dy v_dz v_vx v_vy v_vz (or NULL)")?;
                    let Some(name) = word.as_str().strip_prefix("v_") else {
                        return Err(Problem::at(word.span, "expected a variable v_name or NULL"));
                    };
                    self.variable_exists(name).map_err(|p| p.or_at(word.span))?;
                    *v = Some(Input::Variable(name.to_string()));
                }
                let [a, b, c, d, e, f] = six;
                Path::Variable([a, b, c], [d, e, f])
            }
            _ => {
                let known = ["linear", "wiggle", "rotate", "variable"];
                return Err(args.unknown(style, "the motion", known));
            }
        };
        let mut lattice_units = true;
        while let Some(word) = args.optional() {
            match word.as_str() {
                "units" => lattice_units = args.units()?,
                _ => return Err(args.unknown(word, "the option", ["units"])),
            }
        }
        match &mut path {
            Path::Linear(values) | Path::Wiggle(values, _) => {
                let unit = self.space.length_unit(lattice_units)?;
                values.iter_mut().flatten().for_each(|x| *x *= unit);
            }
            Path::Rotate { point, .. } => {
                let unit = self.space.length_unit(lattice_units)?;
                *point = point.map(|x| unit * x);
            }
            // variables are in box units
            Path::Variable(..) => {}
        }
        if self.space.dimension == 2 {
            let leaves = match &path {
                Path::Linear(v) | Path::Wiggle(v, _) => v[2].is_some_and(|z| z != 0.0),
                Path::Variable(x, v) => x[2].is_some() || v[2].is_some(),
                Path::Rotate { .. } => false,
            };
            if leaves {
                return Err(Problem::new("in two dimensions nothing moves along z")
                    .help("write NULL for z"));
            }
        }
        Ok(path)
    }

    fn walls(&mut self, args: &mut Args) -> Result<FixKind> {
        const FACES: [&str; 6] = ["xlo", "xhi", "ylo", "yhi", "zlo", "zhi"];
        // the position in units, or in the box
        let mut faces: Vec<(usize, bool, std::result::Result<Input, f64>)> = Vec::new();
        let mut lattice_units = true;
        while let Some(word) = args.optional() {
            if word.as_str() == "units" {
                lattice_units = args.units()?;
                continue;
            }
            let Some(face) = FACES.iter().position(|f| *f == word.as_str()) else {
                return Err(args.unknown(
                    word,
                    "the face or option",
                    FACES.into_iter().chain(["units"]),
                ));
            };
            let (axis, above) = (face / 2, face % 2 == 1);
            let domain = self.space.domain()?;
            if domain.periodic(axis) {
                return Err(Problem::at(
                    word.span,
                    "a wall cannot stand on a periodic axis",
                ));
            }
            if faces.iter().any(|(a, b, _)| (*a, *b) == (axis, above)) {
                return Err(Problem::at(word.span, "this wall is there twice"));
            }
            let place = if args.eat("EDGE") {
                // where the side of the box is now, as in LAMMPS
                let sides = if above { &domain.high } else { &domain.low };
                Err(sides[axis])
            } else {
                Ok(self.one_number(args, "the position of the wall")?)
            };
            faces.push((axis, above, place));
        }
        if faces.is_empty() {
            args.next("a face: xlo, xhi, ylo, yhi, zlo or zhi")?;
        }
        let unit = match faces.iter().any(|(_, _, place)| place.is_ok()) {
            true => self.space.length_unit(lattice_units)?,
            false => 1.0,
        };
        let faces = faces.into_iter().map(|(axis, above, place)| WallFace {
            axis,
            above,
            place: place.map_or_else(Input::Number, |p| p.scaled(unit)),
            unit,
        });
        Ok(FixKind::Reflect(faces.collect()))
    }

    fn momentum(&mut self, args: &mut Args) -> Result<FixKind> {
        let every = args.count("the number of steps", 1)?;
        let (mut linear, mut angular, mut rescale) = ([false; 3], false, false);
        while let Some(word) = args.optional() {
            match word.as_str() {
                "linear" => {
                    for l in &mut linear {
                        *l = args.count("three of 0 or 1", 0)? > 0;
                    }
                }
                "angular" => angular = true,
                "rescale" => rescale = true,
                _ => {
                    let known = ["linear", "angular", "rescale"];
                    return Err(args.unknown(word, "the option", known));
                }
            }
        }
        if linear == [false; 3] && !angular {
            return Err(Problem::new("`fix momentum` must take something away")
                .help("fix ID GROUP momentum N linear 1 1 1 [angular] [rescale]"));
        }
        Ok(FixKind::Momentum {
            every,
            linear,
            angular,
            rescale,
        })
    }

    pub(super) fn remove_fix(&mut self, args: &mut Args) -> Result<()> {
        let id = args.next("a fix ID")?;
        args.finish()?;
        let before = self.fixes.all.len();
        self.fixes.all.retain(|f| f.id != id.as_str());
        if self.fixes.all.len() == before {
            return Err(
                Problem::at(id.span, format!("there is no fix `{}`", id.as_str())).help(
                    suggestion(id.as_str(), self.fixes.all.iter().map(|f| f.id.as_str())),
                ),
            );
        }
        Ok(())
    }
}
