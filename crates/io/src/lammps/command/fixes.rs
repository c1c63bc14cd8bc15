//! `fix`, `unfix`.

use std::rc::Rc;

use super::Args;
use crate::lammps::error::{Problem, Result, suggestion};
use crate::lammps::fix::{Fix, FixKind, Input, STYLES};
use crate::lammps::session::Session;

const INDENT: &str = "fix ID GROUP indent K sphere X Y Z R [units box|lattice]";

impl Session<'_> {
    pub(super) fn add_fix(&mut self, args: &mut Args) -> Result<()> {
        self.domain()?;
        let id = args.next("a fix ID")?.as_str().to_string();
        let word = args.next("a group ID")?;
        let members = self.group(word.as_str()).map_err(|p| p.or_at(word.span))?;
        let style = args.next("a fix style")?;
        let kind = match style.as_str() {
            "nve" => FixKind::Nve,
            "indent" => self.indent(args)?,
            "setforce" => {
                let mut force = [const { None }; 3];
                for f in &mut force {
                    if !args.eat("NULL") {
                        *f = Some(self.one_number(args, "fx fy fz (NULL leaves one as it is)")?);
                    }
                }
                FixKind::SetForce(force)
            }
            "addforce" => {
                let what = "fx fy fz";
                FixKind::AddForce([
                    self.one_number(args, what)?,
                    self.one_number(args, what)?,
                    self.one_number(args, what)?,
                ])
            }
            "enforce2d" if self.dimension != 2 => {
                return Err(Problem::new("`fix enforce2d` needs `dimension 2`"));
            }
            "enforce2d" => FixKind::Enforce2d,
            _ => return Err(args.unknown(style, "the fix style", STYLES)),
        };
        args.finish()?;
        let fix = Fix { id, members, kind };
        match self.fixes.iter_mut().find(|f| f.id == fix.id) {
            Some(old) if std::mem::discriminant(&old.kind) == std::mem::discriminant(&fix.kind) => {
                *old = Rc::new(fix)
            }
            Some(_) => {
                return Err(
                    Problem::new(format!("there is a fix `{}` of another style", fix.id))
                        .help("use another ID, or `unfix` it before"),
                );
            }
            None => self.fixes.push(Rc::new(fix)),
        }
        Ok(())
    }

    /// A number, or a variable that gives one.
    fn one_number(&mut self, args: &mut Args, what: &str) -> Result<Input> {
        let input = args.input(what)?;
        if let Input::Variable(name) = &input {
            if let Some(crate::lammps::variable::Kind::Atom(_)) = self.variables.get(name) {
                return Err(Problem::new(format!(
                    "variable `{name}` is atom-style; this fix takes one number"
                ))
                .help("use an equal-style variable"));
            }
            self.variable_exists(name)?;
        }
        Ok(input)
    }

    pub(super) fn variable_exists(&self, name: &str) -> Result<()> {
        match self.variables.get(name) {
            Some(_) => Ok(()),
            None => Err(Problem::new(format!("there is no variable `{name}`"))
                .help(suggestion(name, self.variables.names()))),
        }
    }

    fn indent(&mut self, args: &mut Args) -> Result<FixKind> {
        let stiffness = args.number("the stiffness K")?;
        let mut shape = None;
        let mut lattice_units = true;
        while let Some(word) = args.optional() {
            match word.as_str() {
                "sphere" => {
                    let center = [
                        self.one_number(args, "the centre")?,
                        self.one_number(args, "the centre")?,
                        self.one_number(args, "the centre")?,
                    ];
                    shape = Some((center, self.one_number(args, "the radius")?));
                }
                "units" => lattice_units = args.units()?,
                "side" if args.next("`out`")?.as_str() == "out" => {}
                _ => {
                    let text = word.as_str();
                    return Err(Problem::at(
                        word.span,
                        format!("`fix indent` with `{text}` is not supported"),
                    )
                    .help(format!(
                        "supported: a sphere that pushes outwards: {INDENT}"
                    )));
                }
            }
        }
        let Some((center, radius)) = shape else {
            return Err(Problem::new("`fix indent` needs a sphere").help(INDENT));
        };
        Ok(FixKind::Indent {
            stiffness,
            center,
            radius,
            unit: self.length_unit(lattice_units)?,
        })
    }

    pub(super) fn remove_fix(&mut self, args: &mut Args) -> Result<()> {
        let id = args.next("a fix ID")?;
        args.finish()?;
        let before = self.fixes.len();
        self.fixes.retain(|f| f.id != id.as_str());
        if self.fixes.len() == before {
            return Err(
                Problem::at(id.span, format!("there is no fix `{}`", id.as_str())).help(
                    suggestion(id.as_str(), self.fixes.iter().map(|f| f.id.as_str())),
                ),
            );
        }
        Ok(())
    }
}
