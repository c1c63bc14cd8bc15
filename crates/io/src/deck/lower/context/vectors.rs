//! Lists and vectors of numbers and expressions.

use super::{Context, Result, placed};
use crate::deck::quantity::Measure;
use crate::deck::units::{Dim, Kind};
use crate::deck::value::{At, Components, ComponentsWritten, Number, Quantity, Vector, Written};
use peridyne::expression::Expression;
use peridyne::spec::Parameter;
use std::ops::Range;

impl Context<'_> {
    /// Where to: three components, expressions of x, y, z that measure the same, whatever it is. Numbers where none asks for the place.
    pub fn direction(&self, name: &str, list: &At<Vec<Number>>) -> Result<Parameter> {
        let mut all = vec![];
        let mut measured = None;
        for number in &list.value {
            let (expression, kind) = match &number.value {
                Written::Plain(x) => (Expression::constant(*x), Kind::bare(*x == 0.0)),
                Written::Text(text) => self.compile(text, &number.span)?,
            };
            if kind.unit && !kind.takes_any() {
                measured.get_or_insert(kind.dim());
            }
            all.push((expression, kind, &number.span));
        }
        let dim = measured.unwrap_or(Dim::NUMBER);
        for (expression, kind, span) in &all {
            // a number beside a length is none, but 0
            let stray = dim != Dim::NUMBER
                && !kind.unit
                && expression.as_constant().is_some_and(|x| x != 0.0);
            if measured.is_some() && (stray || !kind.can_be(dim)) {
                let message =
                    format!("the components of `{name}` measure the same, and another is {dim}");
                let help = "write lengths, as -y and x, or numbers, as -y/hypot(x, y)";
                return Err(self.error_with(span, message, help));
            }
        }
        let constants: Option<Vec<f64>> = all.iter().map(|(e, ..)| e.as_constant()).collect();
        if let Some(numbers) = constants {
            return match numbers.iter().all(|x| x.is_finite()) {
                true => Ok(Parameter::List(numbers)),
                false => Err(self.error(&list.span, "these components must be finite")),
            };
        }
        let components: Vec<Expression> = all.into_iter().map(|(e, ..)| e).collect();
        match <[Expression; 3]>::try_from(components) {
            Ok(components) => Ok(Parameter::Direction(components)),
            Err(found) => Err(self.error(
                &list.span,
                format!("`{name}` has {} components, expected 3", found.len()),
            )),
        }
    }

    fn list<'v, K>(
        &self,
        numbers: &'v [Quantity<K>],
        span: &Range<usize>,
    ) -> Result<&'v [Quantity<K>]> {
        if numbers.len() == self.dimension {
            return Ok(numbers);
        }
        let message = match (numbers.len(), self.dimension) {
            (given, 1) => format!("expected one component in 1-D, found {given}"),
            (given, dimension) => {
                format!("expected {dimension} components in {dimension}-D, found {given}")
            }
        };
        Err(self.error(span, message))
    }

    /// A vector, `fill` on the unused axes.
    pub fn vector<K: Measure>(&self, vector: &Vector<K>, fill: f64) -> Result<[f64; 3]> {
        let mut out = [fill; 3];
        for (a, number) in self.list(&vector.value.0, &vector.span)?.iter().enumerate() {
            out[a] = self.limit(&placed(number, &vector.span))?;
        }
        Ok(out)
    }

    pub fn finite_vector<K: Measure>(&self, vector: &Vector<K>) -> Result<[f64; 3]> {
        let value = self.vector(vector, 0.0)?;
        if value.iter().all(|c| c.is_finite()) {
            Ok(value)
        } else {
            Err(self.error(&vector.span, "these components must be finite"))
        }
    }

    /// Expressions of a vector, 0 on the unused axes.
    pub fn expressions<K: Measure>(&self, vector: &Vector<K>) -> Result<[Expression; 3]> {
        let mut out = [const { None }; 3];
        for (a, number) in self.list(&vector.value.0, &vector.span)?.iter().enumerate() {
            out[a] = Some(self.expression(&placed(number, &vector.span))?);
        }
        Ok(out.map(|e| e.unwrap_or_else(|| Expression::constant(0.0))))
    }

    /// Those of what may be left out.
    pub fn components_or_none<K: Measure>(
        &self,
        components: &Option<Components<K>>,
    ) -> Result<[Option<Expression>; 3]> {
        let none = || Ok([const { None }; 3]);
        components
            .as_ref()
            .map_or_else(none, |c| self.components(c))
    }

    /// Components that may be left free.
    pub fn components<K: Measure>(
        &self,
        components: &Components<K>,
    ) -> Result<[Option<Expression>; 3]> {
        let mut out = [const { None }; 3];
        match &components.value {
            ComponentsWritten::List(numbers) => {
                for (a, number) in self.list(numbers, &components.span)?.iter().enumerate() {
                    if !matches!(&number.value.written, Written::Text(text) if text.trim() == "free")
                    {
                        out[a] = Some(self.expression(number)?);
                    }
                }
            }
            ComponentsWritten::Axes(axes) => {
                for (a, number) in axes.iter().enumerate() {
                    let Some(number) = number else { continue };
                    if a >= self.dimension {
                        let message =
                            format!("there is no {} in {}-D", ["x", "y", "z"][a], self.dimension);
                        return Err(self.error(&number.span, message));
                    }
                    out[a] = Some(self.expression(number)?);
                }
            }
        }
        Ok(out)
    }
}
