//! A written law as a law: its keys by its descriptor.

use super::context::{Context, Result};
use crate::deck::document::{Force, Given, Law, Listed, OfShelf};
use crate::deck::error::DeckError;
use crate::deck::value::{At, Number};
use peridyne::columns::Dimension;
use peridyne::error::BuildError;
use peridyne::law::descriptor::{Key, Value};
use peridyne::run::Registry;
use peridyne::spec::{ForceSpec, LawSpec, NamedLaw, Parameter, Parameters};
use std::ops::Range;

/// A law whose keys were read.
pub(super) struct ReadLaw<'a> {
    written: &'a At<Law>,
    pub law: NamedLaw,
    registry: Registry,
}

/// Reads the keys of a law; `file` reads what a key takes from a file.
pub(super) fn read<'a>(
    context: &Context,
    written: &'a At<Law>,
    file: impl Fn(&At<String>, &Key) -> Result<Parameter>,
) -> Result<ReadLaw<'a>> {
    let law = NamedLaw {
        name: written.value.name.clone(),
        parameters: constants(context, written, file)?,
        linear: None,
        isotropic: true,
    };
    Ok(ReadLaw {
        written,
        law,
        registry: Registry::standard(),
    })
}

/// Reads the keys of what a deck names of the registry.
fn constants<L: Listed>(
    context: &Context,
    written: &At<OfShelf<L>>,
    file: impl Fn(&At<String>, &Key) -> Result<Parameter>,
) -> Result<Parameters> {
    let (registry, what) = (Registry::standard(), L::WHAT);
    let name = &written.value.name;
    let Some(descriptor) = OfShelf::<L>::descriptor(&registry, name) else {
        return Err(context.error(&written.span, format!("there is no {what} named {name}")));
    };
    let mut parameters = Parameters::default();
    for (name, given) in &written.value.given {
        let Some(key) = descriptor.key(name) else {
            let message = format!("the {what} has no key `{name}`");
            return Err(context.error(&written.span, message));
        };
        let value = match (given, key.value) {
            (Given::Number(number), Value::Number(dimension, _)) => {
                Parameter::Number(context.finite(number, dimension)?)
            }
            (Given::List(list), Value::List(_, dimension, _)) => {
                let each = list.value.iter().map(|x| context.finite(x, dimension));
                Parameter::List(each.collect::<Result<_>>()?)
            }
            (Given::List(list), Value::Direction) => context.direction(name, list)?,
            (Given::Rows(rows), Value::Rows(columns)) => {
                let rows = rows
                    .value
                    .iter()
                    .map(|row| of_row(context, key, rows, row, columns));
                Parameter::Rows(rows.collect::<Result<_>>()?)
            }
            (Given::Word(name), Value::Table | Value::Entries(_)) => file(name, key)?,
            (Given::Word(text), Value::Formula(variables, dimension)) => {
                Parameter::Formula(match dimension {
                    Some(dimension) => context.formula(text, variables, dimension)?,
                    None => context.unmeasured(
                        &text.value,
                        &text.span,
                        (variables, Dimension::NUMBER),
                    )?,
                })
            }
            (Given::Word(word), _) => Parameter::Word(word.value.clone()),
            (Given::Number(_) | Given::List(_) | Given::Rows(_), _) => {
                let message = format!("`{name}` has another form");
                return Err(context.error(&written.span, message));
            }
        };
        parameters.set(name, value);
    }
    Ok(parameters)
}

/// A force on points, whose constants were looked at.
pub(super) fn force(context: &Context, written: &At<Force>) -> Result<ForceSpec> {
    let none =
        |file: &At<String>, _: &Key| Err(context.error(&file.span, "a force reads no files"));
    let mut force = ForceSpec {
        name: written.value.name.clone(),
        parameters: constants(context, written, none)?,
    };
    let registry = Registry::standard();
    let checked = registry.check_force(&mut force);
    checked.map_err(|e| refused(context, written, &registry, &e))?;
    Ok(force)
}

type Column = (&'static str, Dimension, peridyne::law::descriptor::Bounds);

fn of_row(
    context: &Context,
    key: &Key,
    rows: &At<Vec<Vec<Number>>>,
    row: &[Number],
    columns: &[Column],
) -> Result<Vec<f64>> {
    if row.len() != columns.len() {
        let names: Vec<&str> = columns.iter().map(|c| c.0).collect();
        let message = format!(
            "a row of `{}` has {} numbers, expected [{}]",
            key.name,
            row.len(),
            names.join(", ")
        );
        return Err(context.error(&rows.span, message));
    }
    let each = row.iter().zip(columns);
    each.map(|(x, c)| context.finite(x, c.1)).collect()
}

impl Given {
    fn span(&self) -> &Range<usize> {
        match self {
            Given::Number(x) => &x.span,
            Given::List(list) => &list.span,
            Given::Rows(rows) => &rows.span,
            Given::Word(word) => &word.span,
        }
    }
}

impl ReadLaw<'_> {
    /// The law, checked and with its defaults.
    pub fn look_up(self, context: &Context) -> Result<LawSpec> {
        let mut law = LawSpec::Named(self.law);
        let looked = self.registry.look_up(&mut law);
        looked.map_err(|e| refused(context, self.written, &self.registry, &e))?;
        Ok(law)
    }
}

/// What is wrong with a key of a law, or with all of them.
fn refused<L: Listed>(
    context: &Context,
    written: &At<OfShelf<L>>,
    registry: &Registry,
    error: &BuildError,
) -> DeckError {
    let law = &written.value;
    let given = law.given.iter().find(|(name, _)| *name == error.path);
    let message = &*error.message;
    let span = given.map_or(&written.span, |(_, given)| given.span());
    match OfShelf::<L>::descriptor(registry, &law.name).filter(|d| !d.example.is_empty()) {
        Some(d) => {
            let what = L::WHAT;
            let help = format!(
                "write for example {what} = {{ {} = {} }}",
                d.name, d.example
            );
            context.error_with(span, message, help)
        }
        None => context.error(span, message),
    }
}

/// The law of a material that is no potential.
pub(super) fn solid(context: &Context, written: &At<Law>) -> Result<LawSpec> {
    read(context, written, |file, _| {
        Err(context.error(&file.span, "a law of atoms is not known here"))
    })?
    .look_up(context)
}
