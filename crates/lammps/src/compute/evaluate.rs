//! Values of computes.

use super::{Compute, ComputeKind, Mode, Source};
use crate::atoms::Members;
use crate::error::{Problem, Result, suggestion};
use crate::fix::{FixKind, Start};
use crate::host::{BLOCK, Quantity};
use crate::particles::Field;
use crate::rigid::Rigid;
use crate::session::Session;
use crate::thermo::BUILT_IN;
use crate::thermo::columns::Column;
use crate::variable::ast::Expr;
use crate::variable::tree::Tree;
use std::rc::Rc;
use std::sync::Arc;

impl Session<'_> {
    /// The compute with this ID.
    ///
    /// # Errors
    /// There is none.
    pub fn compute(&self, id: &str) -> Result<&Compute> {
        self.watch
            .computes
            .iter()
            .find(|c| c.id == id)
            .ok_or_else(|| {
                Problem::new(format!("there is no compute `{id}`")).help(suggestion(
                    id,
                    self.watch.computes.iter().map(|c| c.id.as_str()),
                ))
            })
    }

    /// Per-atom values of `source`.
    ///
    /// # Errors
    /// It does not exist or is one number.
    pub fn source_tree(&mut self, source: &Source) -> Result<Tree> {
        match source {
            Source::Field(f) => Ok(Tree::Field(*f)),
            Source::Variable(name) => self.variable_tree(name),
            Source::Compute(id, column) => self.compute_column(id, *column)?.ok_or_else(|| {
                Problem::new(format!(
                    "compute `{id}` gives one number, values for each atom are needed here"
                ))
            }),
        }
    }

    /// A per-atom column (from 1) of a compute; `None` if it has one value for all.
    fn compute_column(&self, id: &str, column: Option<usize>) -> Result<Option<Tree>> {
        let compute = self.compute(id)?;
        let Some(columns) = compute.kind.columns() else {
            return Ok(None);
        };
        let place = match (column, columns) {
            (None, 1) => 0,
            (None, n) => {
                return Err(Problem::new(format!(
                    "compute `{id}` has {n} columns: write c_{id}[1] to c_{id}[{n}]"
                )));
            }
            (Some(_), 1) => {
                return Err(Problem::new(format!(
                    "compute `{id}` has one value for each atom: write c_{id}"
                )));
            }
            (Some(k), n) if (1..=n).contains(&k) => k - 1,
            (Some(k), n) => {
                return Err(Problem::new(format!(
                    "compute `{id}` has columns 1 to {n}, not {k}"
                )));
            }
        };
        let tree = match &compute.kind {
            ComputeKind::Atoms(fields) => Tree::Field(fields[place]),
            ComputeKind::Displace { start } => {
                Tree::Values(Rc::new(self.displacements(start, place)?))
            }
            ComputeKind::Stress { kinetic, virial } => {
                Tree::Values(Rc::new(self.stress(place, *kinetic, *virial)?))
            }
            ComputeKind::Kinetic
            | ComputeKind::Potential
            | ComputeKind::Temperature
            | ComputeKind::Center
            | ComputeKind::Reduce { .. } => return Ok(None),
        };
        Ok(Some(match compute.members.as_ref() {
            Members::All => tree,
            Members::Some(_) => Tree::Masked(Box::new(tree), compute.members.clone()),
        }))
    }

    /// Has a compute this column?
    ///
    /// # Errors
    /// It has not.
    pub fn check_columns(&self, id: &str, column: Option<usize>) -> Result<()> {
        let wrong = |what: String| Err(Problem::new(format!("compute `{id}` {what}")));
        match (self.compute(id)?.kind.columns(), column) {
            (None, _) => wrong("gives one number, values for each atom are needed here".into()),
            (Some(1), None) => Ok(()),
            (Some(1), Some(_)) => wrong(format!("has one value for each atom: write c_{id}")),
            (Some(n), None) => wrong(format!("has {n} columns: write c_{id}[1] to c_{id}[{n}]")),
            (Some(n), Some(k)) if (1..=n).contains(&k) => Ok(()),
            (Some(n), Some(k)) => wrong(format!("has columns 1 to {n}, not {k}")),
        }
    }

    /// Component `axis` of the way of each atom from where it was, or the length of the way (axis 3).
    fn displacements(&self, start: &Start, axis: usize) -> Result<Vec<f64>> {
        let now = self.population.unwrapped()?;
        let way = |(i, x): (usize, &[f64; 3])| {
            let from = start.ids.binary_search(&self.population.ids.get(i)).ok();
            let from = from.map_or(*x, |k| start.places[k]);
            let d = [0, 1, 2].map(|a| x[a] - from[a]);
            match d.get(axis) {
                Some(d) => *d,
                None => (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt(),
            }
        };
        Ok(now.iter().enumerate().map(way).collect())
    }

    /// Component of `−(ρ v v + virial)` of each atom, in pressure · volume as LAMMPS has it.
    fn stress(&self, place: usize, kinetic: bool, virial: bool) -> Result<Vec<f64>> {
        const AXES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        let (a, b) = AXES[place];
        let factor = self.space.units.pressure();
        let mut stress = vec![0.0; self.population.count()];
        if virial {
            stress = self.population.raw(Quantity::Virial(place))?;
        }
        if kinetic {
            let rho = self.population.raw(Quantity::Density)?;
            let (v, w) = (
                self.population.raw(Quantity::Velocity(a))?,
                self.population.raw(Quantity::Velocity(b))?,
            );
            for (i, s) in stress.iter_mut().enumerate() {
                *s += self.space.units.kinetic() * rho[i] * v[i] * w[i];
            }
        }
        stress.iter_mut().for_each(|s| *s *= -factor);
        Ok(stress)
    }

    /// May output ask for the virials of atoms?
    pub fn stress_wanted(&self) -> bool {
        let asks = |c: &Compute| matches!(c.kind, ComputeKind::Stress { virial: true, .. });
        self.watch.computes.iter().any(asks)
    }

    /// A list of numbers: `c_ID` or `f_ID`.
    ///
    /// # Errors
    /// There is no such list.
    pub fn column_vector(&mut self, column: &Column) -> Result<Vec<f64>> {
        let no_list = |what: &str| Problem::new(format!("`{what}` is no list of numbers"));
        match column {
            Column::Compute(text, id, None) => {
                let length = match &self.compute(id)?.kind {
                    ComputeKind::Center => 3,
                    ComputeKind::Reduce { inputs, .. } if inputs.len() > 1 => inputs.len(),
                    _ => return Err(no_list(text)),
                };
                let mut values = Vec::new();
                for k in 1..=length {
                    values.push(self.compute_scalar(id, &[k as f64])?);
                }
                Ok(values)
            }
            Column::Fix(text, id, None) => {
                let fix = self.fixes.all.iter().find(|f| f.id == *id).cloned();
                match fix.as_ref().map(|f| &f.kind) {
                    Some(FixKind::Average(a)) if a.borrow().vector => {
                        Ok(a.borrow().result.iter().map(|r| r[0]).collect())
                    }
                    Some(
                        FixKind::Indent { .. }
                        | FixKind::SetForce { .. }
                        | FixKind::AddForce { .. },
                    ) => {
                        let mut values = Vec::new();
                        for k in 1..=3 {
                            values.push(self.fix_value(id, &[f64::from(k)])?);
                        }
                        Ok(values)
                    }
                    _ => Err(no_list(text)),
                }
            }
            other => Err(no_list(&other.heading())),
        }
    }

    /// `c_ID` or `c_ID[i]` of a per-atom formula; `None` if it is one number.
    ///
    /// # Errors
    /// It does not exist.
    pub fn compute_tree(&mut self, id: &str, index: &[Expr]) -> Result<Option<Tree>> {
        if BUILT_IN.contains(&id) {
            return Ok(None);
        }
        if self.compute(id)?.kind.columns().is_none() {
            return Ok(None);
        }
        let column = match index {
            [] => None,
            [i] => Some(self.scalar(i)? as usize),
            _ => return Ok(None),
        };
        self.compute_column(id, column)
    }

    /// `c_ID`, `c_ID[i]`, `c_ID[i][j]` as one number.
    ///
    /// # Errors
    /// It does not exist or has a value for each atom.
    pub fn compute_scalar(&mut self, id: &str, index: &[f64]) -> Result<f64> {
        if let Some(value) = self.built_in(id, index)? {
            return Ok(value);
        }
        let compute = self.compute(id)?.clone();
        match (&compute.kind, index) {
            (kind, [atom, rest @ ..])
                if kind
                    .columns()
                    .is_some_and(|n| rest.len() == usize::from(n > 1)) =>
            {
                let column = rest.first().map(|c| *c as usize);
                match self.compute_column(id, column)? {
                    Some(tree) => self.tree_at(&tree, *atom),
                    None => Ok(0.0),
                }
            }
            (kind, _) if kind.columns().is_some() => Err(Problem::new(format!(
                "compute `{id}` has values for each atom, one number is needed here"
            ))
            .help(format!("reduce it: compute NAME all reduce sum c_{id}"))),
            (ComputeKind::Kinetic, []) => {
                self.reduce(Mode::Sum, &compute.members, &Tree::Field(Field::Kinetic))
            }
            (ComputeKind::Potential, []) => Ok(self.population.engine()?.energies()?.potential),
            (ComputeKind::Temperature, []) => {
                self.temperature_of(&compute.members, compute.counted)
            }
            (ComputeKind::Center, [k]) if [1.0, 2.0, 3.0].contains(k) => {
                Ok(self.rigid(&compute.members)?.center[*k as usize - 1])
            }
            (ComputeKind::Center, _) => Err(Problem::new(format!(
                "compute `{id}` has 3 numbers: write c_{id}[1] to c_{id}[3]"
            ))),
            (
                ComputeKind::Reduce {
                    mode,
                    inputs,
                    region,
                },
                _,
            ) => {
                let input = match (index, inputs.len()) {
                    ([], 1) => &inputs[0],
                    ([k], n) if n > 1 && *k >= 1.0 && *k <= n as f64 => &inputs[*k as usize - 1],
                    (_, 1) => {
                        return Err(Problem::new(format!(
                            "compute `{id}` is one number: write c_{id}"
                        )));
                    }
                    (_, n) => {
                        return Err(Problem::new(format!(
                            "compute `{id}` has {n} numbers: write c_{id}[1] to c_{id}[{n}]"
                        )));
                    }
                };
                let tree = self.source_tree(input)?;
                let mut members = compute.members.clone();
                if let Some(region) = region {
                    members = self.inside(&members, region)?;
                }
                self.reduce(*mode, &members, &tree)
            }
            _ => Err(Problem::new(format!(
                "compute `{id}` is one number: write c_{id}"
            ))),
        }
    }

    /// One number of per-atom values, in order of id.
    ///
    /// # Errors
    /// The values do not exist (yet).
    pub fn reduce(&self, mode: Mode, members: &Members, tree: &Tree) -> Result<f64> {
        let (view, clock) = (self.view()?, self.progress.clock());
        let n = self.population.count();
        let mut total = mode.start();
        let mut buffer = [0.0; BLOCK];
        for first in (0..n).step_by(BLOCK) {
            let block = &mut buffer[..BLOCK.min(n - first)];
            tree.fill(&view, &clock, first, block)?;
            for (k, x) in block.iter().enumerate() {
                if members.contains(first + k) {
                    total = mode.add(total, *x);
                }
            }
        }
        let count = members.count(n);
        Ok(if mode.is_mean() && count > 0 {
            total / count as f64
        } else {
            total
        })
    }

    /// The members that are in a region now.
    ///
    /// # Errors
    /// There is no such region.
    pub fn inside(&mut self, members: &Members, region: &str) -> Result<Arc<Members>> {
        let region = self.region(region)?;
        let x = self.positions()?;
        let inside = |i: usize| members.contains(i) && region.contains(x[i]);
        Ok(Arc::new(Members::collect(x.len(), inside)))
    }

    /// A group function of a formula.
    ///
    /// # Errors
    /// Wrong arguments.
    pub fn group_function(&mut self, name: &str, arguments: &[String]) -> Result<f64> {
        let wrong = || {
            Problem::new(format!(
                "{name}({}) has wrong arguments",
                arguments.join(",")
            ))
        };
        let plain = match name {
            "count" | "mass" | "ke" | "gyration" => 1,
            _ => 2,
        };
        let group = arguments.first().ok_or_else(wrong)?;
        let mut members = self.population.group(group)?;
        match arguments.len().checked_sub(plain) {
            Some(0) => {}
            Some(1) => members = self.inside(&members, &arguments[plain])?,
            _ => return Err(wrong()),
        }
        let axis = |text: &str| {
            ["x", "y", "z"]
                .iter()
                .position(|a| *a == text)
                .ok_or_else(wrong)
        };
        let density = Tree::Field(Field::Raw(Quantity::Density));
        let of = |s: &Self, what: fn(&Rigid) -> [f64; 3]| -> Result<f64> {
            Ok(what(&s.rigid(&members)?)[axis(&arguments[1])?])
        };
        match name {
            "count" => Ok(members.count(self.population.count()) as f64),
            "mass" => self.reduce(Mode::Sum, &members, &density),
            "ke" => self.reduce(Mode::Sum, &members, &Tree::Field(Field::Kinetic)),
            "gyration" => Ok(self.rigid(&members)?.gyration),
            "xcm" => of(self, |r| r.center),
            "vcm" => of(self, |r| r.velocity),
            "fcm" => of(self, |r| r.force),
            "angmom" => of(self, |r| r.momentum),
            "torque" => of(self, |r| r.torque),
            "omega" => of(self, Rigid::rotation),
            "inertia" => {
                let (a, b) = arguments[1].split_at_checked(1).ok_or_else(wrong)?;
                Ok(self.rigid(&members)?.inertia[axis(a)?][axis(b)?])
            }
            _ => {
                let side = &arguments[1];
                let (letter, mode) = match (side.strip_suffix("min"), side.strip_suffix("max")) {
                    (Some(l), _) => (l, Mode::Min),
                    (_, Some(l)) => (l, Mode::Max),
                    _ => return Err(wrong()),
                };
                self.reduce(mode, &members, &Tree::Field(Field::Wrapped(axis(letter)?)))
            }
        }
    }

    /// `is_defined(category,id)` of a formula.
    ///
    /// # Errors
    /// Unknown category.
    pub fn is_defined(&self, category: &str, id: &str) -> Result<bool> {
        Ok(match category {
            "compute" => self.watch.computes.iter().any(|c| c.id == id),
            "fix" => self.fixes.all.iter().any(|f| f.id == id),
            "dump" => self.watch.dumps.iter().any(|d| d.id == id),
            "group" => self.population.groups.iter().any(|(n, _)| n == id),
            "region" => self.space.regions.iter().any(|(n, _)| n == id),
            "variable" => self.formulas.variables.get(id).is_some(),
            _ => {
                let known = ["compute", "fix", "dump", "group", "region", "variable"];
                return Err(
                    Problem::new(format!("is_defined() does not know `{category}`"))
                        .help(suggestion(category, known)),
                );
            }
        })
    }
}
