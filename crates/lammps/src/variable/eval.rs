//! Values of formulas and variables in a session.

use std::cell::RefCell;
use std::rc::Rc;

use super::ast::Expr;
use super::parse::parse;
use super::tree::Tree;
use super::{Formula, Kind, functions};
use crate::error::{Problem, Result, suggestion};
use crate::host::Quantity;
use crate::particles::Field;
use crate::printf::{Value, fifteen, round_to_fifteen};
use crate::random::Ranmar;
use crate::session::Session;

/// Field of a name in [`super::ast::ATOM_VALUES`].
fn field(name: &str) -> Field {
    match name {
        "mass" => Field::Raw(Quantity::Density),
        _ => Field::parse(name).unwrap_or(Field::Id),
    }
}

impl Session<'_> {
    /// Text of a variable, as `${name}` gives it.
    ///
    /// # Errors
    /// No such variable, or one with a value per atom.
    pub fn variable_text(&mut self, name: &str) -> Result<String> {
        let kind = self.variable(name)?.clone();
        if let Some(text) = kind.text() {
            return Ok(text);
        }
        match kind {
            Kind::Equal(formula) => Ok(fifteen(self.guarded(name, |s| s.formula(&formula))?)),
            Kind::Format { of, format } => {
                let x = self.guarded(name, |s| s.variable_number(&of))?;
                Ok(format.print(Value::Float(x)))
            }
            _ => Err(Problem::new(format!(
                "variable `{name}` has a value for each atom, one number is needed here"
            ))),
        }
    }

    /// Value of a variable as one number, with all digits.
    ///
    /// # Errors
    /// No such variable, or no number.
    pub fn variable_number(&mut self, name: &str) -> Result<f64> {
        match self.variable(name)? {
            Kind::Equal(formula) => {
                let formula = formula.clone();
                return self.guarded(name, |s| s.formula(&formula));
            }
            kind => {
                if let Some(x) = kind.number().filter(|x| x.is_finite()) {
                    return Ok(x);
                }
            }
        }
        let text = self.variable_text(name)?;
        match text.trim().parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(x),
            _ => Err(Problem::new(format!(
                "variable `{name}` is `{text}`, a number is needed here"
            ))),
        }
    }

    fn variable(&self, name: &str) -> Result<&Kind> {
        self.formulas.variables.get(name).ok_or_else(|| {
            let p = Problem::new(format!("there is no variable `{name}`"));
            p.help(match self.formulas.variables.names().next() {
                Some(_) => suggestion(name, self.formulas.variables.names()),
                None => format!(
                    "define it before: variable {name} equal ..., or give --var {name}=VALUE"
                ),
            })
        })
    }

    /// Runs `with` unless variable `name` is being evaluated already.
    fn guarded<T>(&mut self, name: &str, with: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        let place = self.formulas.variables.find(name).unwrap_or(usize::MAX);
        if self.formulas.variables.evaluating.contains(&place) {
            return Err(Problem::new(format!(
                "variable `{name}` needs its own value"
            )));
        }
        if self.formulas.variables.evaluating.len() > 50 {
            return Err(Problem::new(
                "variables refer to each other in more than 50 levels",
            ));
        }
        self.formulas.variables.evaluating.push(place);
        let result = with(self);
        self.formulas.variables.evaluating.pop();
        result
    }

    fn formula(&mut self, formula: &Formula) -> Result<f64> {
        self.scalar(&formula.expr).map_err(|mut p| {
            if !p.message.contains("formula `") {
                p.message = format!("{} (in the formula `{}`)", p.message, formula.text);
            }
            p
        })
    }

    /// Value of the text of a formula.
    ///
    /// # Errors
    /// It cannot be read or evaluated; the message holds the formula.
    pub fn immediate(&mut self, text: &str) -> Result<f64> {
        let expr = parse(text).map_err(|e| {
            let p = Problem::new(format!(
                "{} (in the formula `{text}`, character {})",
                e.message,
                e.at + 1
            ));
            match e.help {
                Some(h) => p.help(h),
                None => p,
            }
        })?;
        self.formula(&Formula {
            text: text.to_string(),
            expr,
        })
    }

    /// One number.
    ///
    /// # Errors
    /// A part has no value, or a value per atom.
    pub fn scalar(&mut self, expr: &Expr) -> Result<f64> {
        Ok(match expr {
            Expr::Number(x) => *x,
            Expr::Prefix(prefix, inner) => prefix.apply(self.scalar(inner)?),
            Expr::Chain(first, chain) => {
                let mut value = self.scalar(first)?;
                for (op, right) in chain {
                    let right = self.scalar(right)?;
                    value = op.apply(value, right).map_err(Problem::new)?;
                }
                value
            }
            Expr::Call(name, arguments) => {
                let mut values = [0.0; functions::MOST_ARGUMENTS];
                for (value, a) in values.iter_mut().zip(arguments) {
                    *value = self.scalar(a)?;
                }
                let given = &values[..arguments.len().min(values.len())];
                functions::apply(name, given, &self.progress.clock()).map_err(Problem::new)?
            }
            Expr::Random { normal, arguments } => {
                let [a, b, seed] = [&arguments[0], &arguments[1], &arguments[2]];
                let (a, b, seed) = (self.scalar(a)?, self.scalar(b)?, self.scalar(seed)?);
                let generator = self.generator(0, seed)?;
                let mut generator = generator.borrow_mut();
                if *normal {
                    a + b * generator.normal()
                } else {
                    generator.uniform() * (b - a) + a
                }
            }
            Expr::Group(name, arguments) => self.group_function(name, arguments)?,
            Expr::IsDefined(category, id) => f64::from(u8::from(self.is_defined(category, id)?)),
            Expr::Keyword(name) => self.thermo_value(name)?,
            Expr::Variable(name, None) => {
                match self.variable(name)? {
                    Kind::Equal(formula) => {
                        let formula = formula.clone();
                        let x = self.guarded(name, |s| s.formula(&formula))?;
                        return Ok(round_to_fifteen(x));
                    }
                    kind => {
                        if let Some(x) = kind.number() {
                            return Ok(x);
                        }
                    }
                }
                // LAMMPS passes numbers between formulas as text with 15 digits
                let text = self.variable_text(name)?;
                match text.trim().parse::<f64>() {
                    Ok(x) => x,
                    Err(_) => {
                        return Err(Problem::new(format!(
                            "variable `{name}` is `{text}`, a number is needed here"
                        )));
                    }
                }
            }
            Expr::Variable(name, Some(id)) => {
                let tree = self.variable_tree(name)?;
                self.at_atom(&tree, id)?
            }
            Expr::AtomAt(name, id) => self.at_atom(&Tree::Field(field(name)), id)?,
            Expr::Atom(name) => {
                return Err(Problem::new(format!(
                    "`{name}` has a value for each atom, one number is needed here"
                ))
                .help(format!(
                    "write {name}[1] for the atom with id 1, or make it an atom-style variable"
                )));
            }
            Expr::Compute(id, index) => {
                let values = self.indices(index)?;
                self.compute_scalar(id, &values[..index.len().min(values.len())])?
            }
            Expr::Fix(id, index) => {
                let values = self.indices(index)?;
                self.fix_value(id, &values[..index.len().min(values.len())])?
            }
        })
    }

    /// Values of up to three indices; nothing has more than two.
    fn indices(&mut self, index: &[Expr]) -> Result<[f64; 3]> {
        let mut values = [0.0; 3];
        for (value, i) in values.iter_mut().zip(index) {
            *value = self.scalar(i)?;
        }
        Ok(values)
    }

    /// Value of a tree at the atom whose id is `id`.
    fn at_atom(&mut self, tree: &Tree, id: &Expr) -> Result<f64> {
        let id = self.scalar(id)?;
        self.tree_at(tree, id)
    }

    /// Value of a tree at the atom with this id.
    ///
    /// # Errors
    /// There is no such atom.
    pub fn tree_at(&self, tree: &Tree, id: f64) -> Result<f64> {
        let found = if id >= 1.0 {
            self.population.ids.find(id as u64)
        } else {
            None
        };
        let Some(index) = found else {
            return Err(Problem::new(format!("there is no atom with id {id}")));
        };
        let mut value = [0.0];
        tree.fill(&self.view()?, &self.progress.clock(), index, &mut value)?;
        Ok(value[0])
    }

    /// The generator for single numbers (0) or per-atom numbers (1): the first seed counts.
    fn generator(&mut self, which: usize, seed: f64) -> Result<Rc<RefCell<Ranmar>>> {
        if let Some(g) = &self.formulas.random[which] {
            return Ok(g.clone());
        }
        let g = Ranmar::new(seed as i64).ok_or_else(|| {
            Problem::new(format!(
                "the seed {seed} is not a whole number from 1 to 900000000"
            ))
        })?;
        Ok(self.formulas.random[which]
            .insert(Rc::new(RefCell::new(g)))
            .clone())
    }

    /// A variable as per-atom values.
    ///
    /// # Errors
    /// No such variable, a part has no value.
    pub fn variable_tree(&mut self, name: &str) -> Result<Tree> {
        match self.variable(name)?.clone() {
            Kind::Atom(formula) => self.guarded(name, |s| s.tree(&formula.expr)),
            _ => Ok(Tree::Number(self.variable_number(name)?)),
        }
    }

    /// Evaluates what is one number and leaves the rest for each atom.
    ///
    /// # Errors
    /// A part has no value.
    pub fn tree(&mut self, expr: &Expr) -> Result<Tree> {
        Ok(match expr {
            Expr::Prefix(prefix, inner) => match self.tree(inner)? {
                Tree::Number(x) => Tree::Number(prefix.apply(x)),
                tree => Tree::Prefix(*prefix, Box::new(tree)),
            },
            Expr::Chain(first, chain) => {
                let mut left = self.tree(first)?;
                for (op, right) in chain {
                    left = match (left, self.tree(right)?) {
                        (Tree::Number(a), Tree::Number(b)) => {
                            Tree::Number(op.apply(a, b).map_err(Problem::new)?)
                        }
                        (Tree::Chain(first, mut chain), right) => {
                            chain.push((*op, right));
                            Tree::Chain(first, chain)
                        }
                        (left, right) => Tree::Chain(Box::new(left), vec![(*op, right)]),
                    };
                }
                left
            }
            Expr::Call(name, arguments) => Tree::Call(
                name,
                arguments
                    .iter()
                    .map(|a| self.tree(a))
                    .collect::<Result<_>>()?,
            ),
            Expr::Random { normal, arguments } => {
                let seed = self.scalar(&arguments[2])?;
                Tree::Random {
                    normal: *normal,
                    a: Box::new(self.tree(&arguments[0])?),
                    b: Box::new(self.tree(&arguments[1])?),
                    generator: self.generator(1, seed)?,
                }
            }
            Expr::Atom(name) => Tree::Field(field(name)),
            Expr::Variable(name, None) => match self.variable(name)? {
                Kind::Atom(_) => self.variable_tree(name)?,
                _ => Tree::Number(self.scalar(expr)?),
            },
            Expr::Compute(id, index) => match self.compute_tree(id, index)? {
                Some(tree) => tree,
                None => Tree::Number(self.scalar(expr)?),
            },
            _ => Tree::Number(self.scalar(expr)?),
        })
    }
}
