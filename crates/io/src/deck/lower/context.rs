//! From written numbers to numbers: units, constants, expressions, components.

use crate::deck::error::{DeckError, nearest};
use crate::deck::quantity::Measure;
use crate::deck::source::Source;
use crate::deck::units::{self, Dim, Dimensions, Kind, UnitSystem, Variables};
use crate::deck::value::{At, Number, Quantity, Written};
use crate::read::{AtomsFile, Cells};
use peridyne::expression::{Expression, ExpressionError};
use peridyne::law::descriptor::Bounds;
use peridyne::spec::AnyLinearBody;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

mod temperature;
mod vectors;

pub(in crate::deck) type Result<T> = std::result::Result<T, DeckError>;

pub(in crate::deck) struct Context<'a> {
    pub source: &'a Source,
    pub units: UnitSystem,
    pub dimension: usize,
    /// What the body's file says, if it is one of atoms; in the units of computation.
    pub atoms: Option<AtomsFile>,
    /// Of the body's file.
    pub micromoduli: Option<Arc<AnyLinearBody>>,
    /// The same of several bodies, by their names.
    pub linear_bodies: BTreeMap<String, Arc<AnyLinearBody>>,
    /// Lowest and highest coordinates of the cells of a mesh; of several bodies those of the last.
    pub ends: Option<[[f64; 2]; 3]>,
    /// Cells of all meshes.
    pub cells: Cells,
    /// What was passed over in files.
    pub notes: Vec<String>,
    /// What looks wrong in files, with the line that names them.
    pub lints: Vec<String>,
    /// Numbers in quotes that carry no unit: where, and what was taken.
    pub unitless: RefCell<Vec<(Range<usize>, String)>>,
    scales: temperature::Scales,
    /// What `t` is: a time, in statics a number.
    time: Dim,
    /// Dimension if units say it, and the value: as computed with a dimension, else a plain number of the deck.
    constants: BTreeMap<String, (f64, Option<Dim>)>,
}

impl<'a> Context<'a> {
    pub fn new(
        source: &'a Source,
        units: UnitSystem,
        time: Dim,
        constants: &BTreeMap<String, Number>,
    ) -> Result<Self> {
        let mut context = Context {
            source,
            units,
            time,
            dimension: 3,
            atoms: None,
            micromoduli: None,
            linear_bodies: BTreeMap::new(),
            ends: None,
            cells: Cells::default(),
            notes: Vec::new(),
            lints: Vec::new(),
            unitless: RefCell::default(),
            scales: temperature::Scales::default(),
            constants: BTreeMap::new(),
        };
        // constants may use each other in any order; each round settles at least one, or an error is real
        let mut open: Vec<(&String, &Number)> = constants.iter().collect();
        while !open.is_empty() {
            let mut failed = Vec::new();
            let mut next = Vec::new();
            for (name, number) in &open {
                match context.named_constant(name, number) {
                    Ok(value) => {
                        context.constants.insert((*name).clone(), value);
                    }
                    Err(error) => {
                        failed.push(error);
                        next.push((*name, *number));
                    }
                }
            }
            if !failed.is_empty() && next.len() == open.len() {
                // those that use others fail because of these
                let first = next.iter().position(|(_, number)| !uses(number, &next));
                return Err(failed.swap_remove(first.unwrap_or(0)));
            }
            open = next;
        }
        Ok(context)
    }

    fn named_constant(&self, name: &str, number: &Number) -> Result<(f64, Option<Dim>)> {
        if ["x", "y", "z", "t"].contains(&name) {
            return Err(self.error(
                &number.span,
                format!("the constant \"{name}\" would hide the coordinate {name}"),
            ));
        }
        let valid = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !valid {
            return Err(self.error(
                &number.span,
                format!(
                    "\"{name}\" cannot be used in expressions: letters, digits and _ make a name"
                ),
            ));
        }
        match &number.value {
            Written::Plain(value) => Ok((*value, None)),
            Written::Text(text) => {
                let (expression, kind) = self.compile(text, &number.span)?;
                let value = self.constant_value(expression, &number.span)?;
                if !value.is_finite() && text.trim().parse::<f64>().is_err() {
                    let message = format!("the constant \"{name}\" is {value}, no finite number");
                    return Err(self.error(&number.span, message));
                }
                let each = |v: f64| format!("{v} in the unit of each place that uses it");
                self.see_unitless(text, &number.span, each);
                Ok((value, kind.of_constant()))
            }
        }
    }

    /// Notes a number in quotes without a unit, which quotes are for.
    fn see_unitless(&self, text: &str, span: &Range<usize>, taken: impl Fn(f64) -> String) {
        if let Ok(value) = text.trim().parse::<f64>()
            && self.units.has_units()
            && value.is_finite()
            && value != 0.0
        {
            let found = (
                span.clone(),
                format!(
                    "\"{text}\" has no unit and is taken as {}: write the unit, or the number without quotes",
                    taken(value)
                ),
            );
            let mut all = self.unitless.borrow_mut();
            if !all.contains(&found) {
                all.push(found);
            }
        }
    }

    /// From here on `t` is that of another stage.
    pub fn set_time(&mut self, time: Dim) {
        self.time = time;
    }

    pub fn error(&self, span: &Range<usize>, message: impl Into<String>) -> DeckError {
        self.source.error(Some(span.clone()), message, None)
    }

    pub fn error_with(
        &self,
        span: &Range<usize>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> DeckError {
        self.source
            .error(Some(span.clone()), message, Some(help.into()))
    }

    /// A text as an expression in units of computation: a quantity, the name of a constant, or more.
    fn meaning(&self, text: &str, span: &Range<usize>, dim: Dim) -> Result<Expression> {
        self.meaning_of(text, span, dim, None)
    }

    /// The same of other variables in place of x, y, z and t.
    fn meaning_of(
        &self,
        text: &str,
        span: &Range<usize>,
        dim: Dim,
        variables: Option<Variables>,
    ) -> Result<Expression> {
        let (expression, kind) = self.compile_of(text, span, variables)?;
        let factor = self.units.plain_factor(dim);
        if dim != Dim::NUMBER {
            self.see_unitless(text, span, |v| self.units.show(v * factor, dim));
        }
        if kind.takes_any() || !kind.unit {
            return Ok(if factor == 1.0 {
                expression
            } else {
                expression.times(factor)
            });
        }
        if kind.can_be(dim) {
            return Ok(expression);
        }
        let found = kind.dim();
        let mut help = match units::factor_help(found, dim) {
            Some(help) if expression.as_constant().is_none() => help,
            _ => units::example(dim).map_or("write it in other units".into(), |e| {
                format!("write for example \"{e}\"")
            }),
        };
        if kind.has_bare_factor() {
            help += "; a number without unit beside a quantity is a pure number";
        }
        let mut words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
        let hides = |name: &&str| self.constants.contains_key(*name) && units::unit(name).is_ok();
        let mut message = format!("expected {dim}, \"{text}\" is {found}");
        // it would be right if the unit were one
        let unit = units::split(text).and_then(|(_, unit)| units::unit(unit).ok());
        if let Some(name) = words
            .find(hides)
            .filter(|_| unit.is_some_and(|unit| unit.dim == dim))
        {
            message += &format!(": `{name}` is a constant of this deck, not the unit {name}");
            help = "give the constant another name".into();
        }
        Err(self.error_with(span, message, help))
    }

    /// The expression, in units of computation where a unit is written in it, and what it measures.
    fn compile(&self, text: &str, span: &Range<usize>) -> Result<(Expression, Kind)> {
        self.compile_of(text, span, None)
    }

    fn compile_of(
        &self,
        text: &str,
        span: &Range<usize>,
        variables: Option<Variables>,
    ) -> Result<(Expression, Kind)> {
        // infinities, too
        if let Ok(value) = text.trim().parse::<f64>() {
            return Ok((Expression::constant(value), Kind::bare(value == 0.0)));
        }
        let constants: Vec<(&str, f64)> = self
            .constants
            .iter()
            .map(|(name, v)| (name.as_str(), v.0))
            .collect();
        let kinds: Vec<(&str, Option<Dim>)> = self
            .constants
            .iter()
            .map(|(name, v)| (name.as_str(), v.1))
            .collect();
        // a tonne, where nothing else stands
        if let Some((value, "t")) = units::split(text)
            && self.units.has_units()
            && let Ok(unit) = units::unit("t")
        {
            let factor = self.units.from_si(unit.dim) * self.units.plain_factor(unit.dim);
            let value = Expression::constant(unit.si(value) * factor);
            return Ok((value, Kind::quantity(unit.dim)));
        }
        let mut dimensions = Dimensions {
            units: self.units,
            time: self.time,
            constants: &kinds,
            strict: false,
            variables,
        };
        let read = |dimensions: &Dimensions| {
            Expression::measured(text, &constants, dimensions)
                .map_err(|error| self.expression_error(text, span, error))
        };
        let (expression, kind) = read(&dimensions)?;
        if !kind.unit {
            return Ok((expression, kind));
        }
        dimensions.strict = true;
        read(&dimensions)
    }

    /// Carries the place inside an expression over to the deck, if the text stands there as it is.
    fn expression_error(
        &self,
        text: &str,
        span: &Range<usize>,
        error: ExpressionError,
    ) -> DeckError {
        let inner = match self.source.slice(span).find(text) {
            Some(offset) => {
                let start = span.start + offset;
                let end = error.span.end.max(error.span.start + 1);
                start + error.span.start..start + end
            }
            None => span.clone(),
        };
        let name = text.get(error.span.clone()).unwrap_or("").trim();
        // a letter within a formula is a constant that was forgotten
        let alone = name.len() > 1 || name == text.trim();
        let unknown = error.message.starts_with("unknown name");
        let unit = unknown && alone && units::unit(name).is_ok();
        if unit && self.units.has_units() && temperature::of_roots(text).is_none() {
            let message = format!("the unit \"{name}\" has no number");
            let help = format!(
                "write the number before it: \"1 {name}\"; if a constant is meant, give it in [constants]"
            );
            return self.source.error(Some(inner), message, Some(help));
        }
        let help = temperature::of_roots(text).or(error.help);
        self.source.error(Some(inner), error.message, help)
    }

    /// An expression in plain numbers of the deck, with more constants besides the deck's.
    pub fn plain_expression(
        &self,
        text: &str,
        span: &Range<usize>,
        more: &[(&str, f64)],
    ) -> Result<Expression> {
        let own = self.plain_constants();
        let constants: Vec<(&str, f64)> = more.iter().copied().chain(own).collect();
        Expression::parse(text, &constants)
            .map_err(|error| self.expression_error(text, span, error))
    }

    /// The deck's constants with their values.
    pub fn plain_constants(&self) -> Vec<(&str, f64)> {
        let each = self.constants.iter();
        each.map(|(n, v)| (n.as_str(), v.0)).collect()
    }

    fn constant_value(&self, expression: Expression, span: &Range<usize>) -> Result<f64> {
        expression.as_constant().ok_or_else(|| {
            self.error_with(
                span,
                "this number may not depend on x, y, z or t",
                "use numbers and [constants] only",
            )
        })
    }

    /// A number of this dimension, as it is computed with; NaN is refused.
    pub fn number(&self, number: &Number, dim: Dim) -> Result<f64> {
        if let Some(kelvin) = self.celsius(number, dim)? {
            return Ok(kelvin);
        }
        let value = match &number.value {
            Written::Plain(value) => *value * self.units.plain_factor(dim),
            Written::Text(text) => {
                let expression = self.meaning(text, &number.span, dim)?;
                self.constant_value(expression, &number.span)?
            }
        };
        if value.is_nan() {
            return Err(self.error(&number.span, "this is not a number (NaN)"));
        }
        Ok(value)
    }

    pub fn finite(&self, number: &Number, dim: Dim) -> Result<f64> {
        let value = self.number(number, dim)?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.error(&number.span, "this number must be finite"))
        }
    }

    /// A number that lies where its measure allows.
    pub fn value<K: Measure>(&self, quantity: &Quantity<K>) -> Result<f64> {
        let value = self.finite(&quantity.number(), K::DIM)?;
        self.within::<K>(value, &quantity.span)?;
        Ok(value)
    }

    /// The same, or what stands for one that is left out.
    pub fn value_or<K: Measure>(&self, quantity: &Option<Quantity<K>>, or: f64) -> Result<f64> {
        quantity.as_ref().map_or(Ok(or), |q| self.value(q))
    }

    /// The same, where nothing stands for it.
    pub fn optional<K: Measure>(&self, quantity: &Option<Quantity<K>>) -> Result<Option<f64>> {
        quantity.as_ref().map(|q| self.value(q)).transpose()
    }

    /// A number that may be infinite.
    pub fn limit<K: Measure>(&self, quantity: &Quantity<K>) -> Result<f64> {
        self.number(&quantity.number(), K::DIM)
    }

    /// An expression of x, y, z, t of a measure; a number among its bounds.
    pub fn expression<K: Measure>(&self, quantity: &Quantity<K>) -> Result<Expression> {
        let expression = self.expression_of(&quantity.number(), K::DIM)?;
        if let Some(value) = expression.as_constant() {
            self.within::<K>(value, &quantity.span)?;
        }
        Ok(expression)
    }

    /// An expression that may be left out, and its place.
    pub fn said<K: Measure>(
        &self,
        quantity: &Option<Quantity<K>>,
    ) -> Result<Option<(Expression, Range<usize>)>> {
        let Some(quantity) = quantity else {
            return Ok(None);
        };
        Ok(Some((self.expression(quantity)?, quantity.span.clone())))
    }

    fn within<K: Measure>(&self, value: f64, span: &Range<usize>) -> Result<()> {
        if K::BOUNDS == Bounds::ANY || K::BOUNDS.hold(value) {
            return Ok(());
        }
        let key = (self.source.key(span.start)).map_or("this".into(), |key| format!("`{key}`"));
        let (must, is) = (K::BOUNDS.words(), self.units.write(value, K::DIM));
        Err(self.error(span, format!("{key} must be {must}, it is {is}")))
    }

    /// An expression of variables that are plain numbers, of this dimension.
    pub fn formula(
        &self,
        text: &At<String>,
        variables: &'static [&'static str],
        dim: Dim,
    ) -> Result<Expression> {
        self.meaning_of(&text.value, &text.span, dim, Some((variables, Dim::NUMBER)))
    }

    /// An expression that may measure anything.
    ///
    /// # Errors
    /// It is none, or names a constant of the deck that a variable hides.
    pub fn unmeasured(
        &self,
        text: &str,
        span: &Range<usize>,
        variables: Variables,
    ) -> Result<Expression> {
        let (expression, _) = self.compile_of(text, span, Some(variables))?;
        let mut each = variables.0.iter().enumerate();
        let hidden =
            |(n, v): &(usize, &&str)| expression.depends_on(*n) && self.constants.contains_key(**v);
        match each.find(hidden) {
            Some((_, v)) => Err(self.error_with(
                span,
                format!("`{v}` is a variable here, and the deck has a constant of this name"),
                "give the constant another name",
            )),
            None => Ok(expression),
        }
    }

    /// An expression of x, y, z, t of this dimension.
    pub fn expression_of(&self, number: &Number, dim: Dim) -> Result<Expression> {
        if let Some(kelvin) = self.celsius(number, dim)? {
            return Ok(Expression::constant(kelvin));
        }
        let Written::Text(text) = &number.value else {
            return Ok(Expression::constant(self.finite(number, dim)?));
        };
        self.meaning(text, &number.span, dim)
    }

    /// The index of the one entry that is given, an error if there is none or more.
    pub fn one_of(&self, span: &Range<usize>, what: &str, given: &[(&str, bool)]) -> Result<usize> {
        let found: Vec<usize> = (0..given.len()).filter(|i| given[*i].1).collect();
        match found[..] {
            [one] => Ok(one),
            [] => {
                let names: Vec<&str> = given.iter().map(|g| g.0).collect();
                Err(self.error(span, format!("{what} needs one of {}", names.join(", "))))
            }
            _ => {
                let names: Vec<&str> = found.iter().map(|i| given[*i].0).collect();
                Err(self.error(
                    span,
                    format!("{what} has {}: give one of them", names.join(" and ")),
                ))
            }
        }
    }

    /// Checks that a set exists.
    pub fn known_set(&self, name: &At<String>, sets: &[peridyne::spec::SetSpec]) -> Result<String> {
        if name.value == "all" || sets.iter().any(|set| set.name == name.value) {
            return Ok(name.value.clone());
        }
        let names: Vec<&str> = sets
            .iter()
            .map(|set| set.name.as_str())
            .chain(["all"])
            .collect();
        // sets of instances of Abaqus have the instance before their name
        let own = |set: &&&str| {
            let own = set.rsplit_once('.').map(|(_, own)| own);
            own.is_some_and(|own| own.eq_ignore_ascii_case(&name.value))
        };
        let owned: Vec<&str> = names.iter().filter(own).copied().collect();
        if owned.len() > 1 {
            return Err(self.error(
                &name.span,
                format!(
                    "\"{}\" is a set of several instances: write one of \"{}\"",
                    name.value,
                    owned.join("\", \"")
                ),
            ));
        }
        let help = match nearest(&name.value, names.iter().copied()) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("known sets: {}", names.join(", ")),
        };
        Err(self.error_with(
            &name.span,
            format!("there is no set \"{}\"", name.value),
            help,
        ))
    }
}

/// A lone number in the place of a vector has no place of its own.
fn placed<K>(number: &Quantity<K>, span: &Range<usize>) -> Quantity<K> {
    let span = if number.span.is_empty() {
        span.clone()
    } else {
        number.span.clone()
    };
    At {
        value: number.value.clone(),
        span,
    }
}

/// Does the text of a number name one of these constants?
fn uses(number: &Number, constants: &[(&String, &Number)]) -> bool {
    let Written::Text(text) = &number.value else {
        return false;
    };
    text.split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .any(|word| constants.iter().any(|(name, _)| *name == word))
}
