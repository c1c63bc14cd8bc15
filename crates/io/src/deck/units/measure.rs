//! Dimensions of expressions: what `"12 MPa * t / 10 us"` is, and whether its parts fit together.
//!
//! A number without a unit is *bare*. It is in the deck's units and takes the dimension that its place wants: beside `+`, `<`
//! or in `min` that of the other side; as the divisor of x, y, z or t (`t / 1e-5`) theirs, where the result wants it so; and a
//! bare number times a number (`0.1*sin(2*pi*x/L)`) is what the key wants. Beside a quantity, as a factor, it is a pure number.
//! Expressions without any unit are plain numbers, and not checked.

use super::Dim;
use super::dimension::{example, place};
use super::parse::prefix;
use super::system::UnitSystem;
use peridyne::expression::{Measure, Misfit, Rule};
use std::ops::Range;

/// What a part of an expression measures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kind {
    /// Its dimension, if bare factors are pure numbers.
    dim: Dim,
    /// The part of `dim` that x, y, z and t brought.
    natural: Dim,
    /// A unit is written in it.
    pub unit: bool,
    /// A bare number is a factor of it.
    bare: bool,
    /// A bare number may be of the dimension `natural`, so that this may be without.
    loose: bool,
    /// The number 0, which is of every kind.
    zero: bool,
}

const PURE: Kind = Kind {
    dim: Dim::NUMBER,
    natural: Dim::NUMBER,
    unit: false,
    bare: false,
    loose: false,
    zero: false,
};

impl Kind {
    /// A number as it stands.
    pub fn bare(zero: bool) -> Kind {
        Kind {
            bare: true,
            zero,
            ..PURE
        }
    }

    fn variable(dim: Dim) -> Kind {
        Kind {
            dim,
            natural: dim,
            ..PURE
        }
    }

    pub fn quantity(dim: Dim) -> Kind {
        Kind {
            dim,
            unit: true,
            ..PURE
        }
    }

    pub fn dim(self) -> Dim {
        self.dim
    }

    pub fn has_bare_factor(self) -> bool {
        self.bare
    }

    /// The dimensions it can have by itself.
    fn dims(self) -> [Option<Dim>; 2] {
        let without = self
            .loose
            .then(|| self.dim.times(self.natural, -1))
            .flatten();
        [Some(self.dim), without]
    }

    pub fn can_be(self, dim: Dim) -> bool {
        self.takes_any() || self.dims().contains(&Some(dim))
    }

    /// A bare number takes the dimension that is wanted.
    pub fn takes_any(self) -> bool {
        self.zero || self.bare && (!self.unit || self.dims().contains(&Some(Dim::NUMBER)))
    }

    /// Its dimension as a constant: `None` takes any.
    pub fn of_constant(self) -> Option<Dim> {
        (self.unit && !self.takes_any()).then_some(self.dim)
    }

    fn power(self, exponent: f64) -> Option<Kind> {
        let power = |dim: Dim| {
            let mut out = [0; 4];
            for (o, d) in out.iter_mut().zip(dim.0) {
                let e = f64::from(d) * exponent;
                if e.fract() != 0.0 || e.abs() > 100.0 {
                    return None;
                }
                *o = e as i8;
            }
            Some(Dim(out))
        };
        Some(Kind {
            dim: power(self.dim)?,
            natural: power(self.natural)?,
            zero: false,
            ..self
        })
    }
}

/// Units, variables and constants of one expression.
pub struct Dimensions<'a> {
    pub units: UnitSystem,
    /// Of `t`: a time, and in statics a number from 0 to 1.
    pub time: Dim,
    /// Names of the constants, and their dimensions where units say them.
    pub constants: &'a [(&'a str, Option<Dim>)],
    /// Refuse what does not fit.
    pub strict: bool,
    /// What stands in place of x, y, z and t, and what it measures.
    pub variables: Option<Variables>,
}

/// Names of variables, and their dimension.
pub type Variables = (&'static [&'static str], Dim);

/// What expressions are of where nothing else is said.
const PLACE: &[&str] = &["x", "y", "z"];

fn misfit(message: String, help: impl Into<String>) -> Misfit {
    Misfit {
        message,
        help: Some(help.into()),
    }
}

impl Dimensions<'_> {
    fn taken(&self, name: &str) -> bool {
        self.variables().contains(&name)
            || ["pi", "e"].contains(&name)
            || self.variables.is_none() && name == "t"
            || self.constants.iter().any(|(known, _)| *known == name)
    }

    /// Both sides are of one kind.
    fn alike(&self, name: &str, a: Kind, b: Kind) -> Result<Kind, Misfit> {
        let unit = a.unit || b.unit;
        if a.takes_any() || b.takes_any() {
            let (any, other) = if a.takes_any() { (a, b) } else { (b, a) };
            if other.takes_any() {
                let kind = if any.zero { other } else { any };
                let zero = a.zero && b.zero;
                return Ok(Kind { unit, zero, ..kind });
            }
            // plain numbers of these are in other units than those of computation
            if self.strict && !any.zero && self.units.plain_factor(other.dim) != 1.0 {
                return Err(misfit(
                    format!("`{name}` has {} and a number without unit", other.dim),
                    format!("write its unit, too: {}", example(other.dim).unwrap_or("")),
                ));
            }
            return Ok(Kind { unit, ..other });
        }
        let common = a.dims().into_iter().flatten().find(|d| b.can_be(*d));
        match common {
            Some(dim) => {
                let natural = [a, b]
                    .into_iter()
                    .find(|k| k.dim == dim && k.natural != Dim::NUMBER);
                Ok(Kind {
                    dim,
                    natural: natural.map_or(Dim::NUMBER, |k| k.natural),
                    unit,
                    ..PURE
                })
            }
            None if self.strict => Err(misfit(
                format!(
                    "`{name}` takes two of a kind, here are {} and {}",
                    a.dim, b.dim
                ),
                factor_help(a.dim, b.dim).unwrap_or("write the unit of each number".into()),
            )),
            None => Ok(Kind { unit, ..a }),
        }
    }

    fn number_only(&self, name: &str, of: &[Kind]) -> Result<Kind, Misfit> {
        match of.iter().find(|k| !k.can_be(Dim::NUMBER)) {
            Some(wrong) if self.strict => Err(misfit(
                format!("`{name}` takes a plain number, this is {}", wrong.dim),
                factor_help(wrong.dim, Dim::NUMBER).unwrap_or_default(),
            )),
            _ => Ok(pure(of)),
        }
    }
}

/// A number made of these.
fn pure(of: &[Kind]) -> Kind {
    Kind {
        unit: of.iter().any(|k| k.unit),
        ..PURE
    }
}

/// What to do with `found` to get `wanted`, if it is simple.
pub fn factor_help(found: Dim, wanted: Dim) -> Option<String> {
    let below = found.times(wanted, -1)?;
    let factor = wanted.times(found, -1)?;
    if below == Dim::NUMBER {
        return None;
    }
    // the more usual of both: a length rather than an inverse length
    match (place(below), place(factor)) {
        (Some(b), f) if f.is_none_or(|f| b < f) => {
            let example = example(below)?;
            Some(format!("divide by {below}, for example `/ ({example})`"))
        }
        (_, Some(_)) => {
            let example = example(factor)?;
            Some(format!("multiply by {factor}, for example `* {example}`"))
        }
        _ => None,
    }
}

impl Measure for Dimensions<'_> {
    type Kind = Kind;

    fn number(&self, value: f64) -> Kind {
        Kind::bare(value == 0.0)
    }
    fn pure(&self) -> Kind {
        PURE
    }
    fn variables(&self) -> &'static [&'static str] {
        self.variables.map_or(PLACE, |(names, _)| names)
    }
    fn coordinate(&self) -> Kind {
        match self.variables {
            Some((_, dim)) if dim == Dim::NUMBER => PURE,
            Some((_, dim)) => Kind::variable(dim),
            None => Kind::variable(Dim::LENGTH),
        }
    }
    fn time(&self) -> Kind {
        Kind::variable(self.time)
    }
    fn constant(&self, index: usize) -> Kind {
        self.constants[index]
            .1
            .map_or(Kind::bare(false), Kind::quantity)
    }

    fn quantity(
        &self,
        value: f64,
        rest: &str,
    ) -> Result<Option<(usize, f64, Kind)>, (Range<usize>, Misfit)> {
        let Some((length, unit)) = prefix(rest, &|name| self.taken(name))? else {
            return Ok(None);
        };
        if !self.units.has_units() {
            let blanks = rest.len() - rest.trim_start().len();
            let message = format!(
                "numbers carry no units in the unit system {}: `{}`",
                self.units.name(),
                rest[..length].trim()
            );
            let help = "write plain numbers, or units = \"si\"";
            return Err((blanks..length, misfit(message, help)));
        }
        let value =
            unit.si(value) * self.units.from_si(unit.dim) * self.units.plain_factor(unit.dim);
        Ok(Some((length, value, Kind::quantity(unit.dim))))
    }

    fn combine(
        &self,
        name: &str,
        rule: Rule,
        of: &[Kind],
        exponent: Option<f64>,
    ) -> Result<Kind, Misfit> {
        let too_large = || {
            misfit(
                format!("the powers of `{name}` are too large"),
                "write it with fewer factors",
            )
        };
        match (rule, of) {
            (Rule::Alike, [a]) => Ok(*a),
            (Rule::Alike, [first, others @ ..]) => others
                .iter()
                .try_fold(*first, |a, b| self.alike(name, a, *b)),
            (Rule::Compare, [a, b]) => Ok(pure(&[self.alike(name, *a, *b)?])),
            (Rule::Choice, [condition, a, b]) => {
                let kind = self.alike(name, *a, *b)?;
                Ok(Kind {
                    unit: kind.unit || condition.unit,
                    ..kind
                })
            }
            (Rule::Product | Rule::Quotient, [a, b]) => {
                let sign = if rule == Rule::Product { 1 } else { -1 };
                // a plain part with a bare factor beside a quantity: 12 MPa * (1e5*t)
                let open = |k: &Kind| !k.unit && k.bare && k.natural != Dim::NUMBER;
                let divides =
                    rule == Rule::Quotient && b.bare && !b.unit && b.natural == Dim::NUMBER;
                Ok(Kind {
                    dim: a.dim.times(b.dim, sign).ok_or_else(too_large)?,
                    natural: a.natural.times(b.natural, sign).ok_or_else(too_large)?,
                    unit: a.unit || b.unit,
                    bare: a.bare || b.bare,
                    loose: a.loose
                        || b.loose
                        || open(a)
                        || open(b)
                        || divides && a.natural != Dim::NUMBER,
                    zero: a.zero || b.zero && rule == Rule::Product,
                })
            }
            (Rule::Power, [a, b]) => {
                let whole = exponent.filter(|_| b.can_be(Dim::NUMBER));
                match whole.and_then(|e| a.power(e)) {
                    Some(kind) => Ok(Kind {
                        unit: kind.unit || b.unit,
                        ..kind
                    }),
                    None => self.number_only(name, of),
                }
            }
            (Rule::Root, [a]) => match a.power(0.5) {
                Some(kind) => Ok(kind),
                None => self.number_only(name, of),
            },
            (Rule::Numbers, _) => self.number_only(name, of),
            // no operation has other arguments
            (Rule::Any | Rule::Alike | Rule::Compare | Rule::Choice, _)
            | (Rule::Product | Rule::Quotient | Rule::Power | Rule::Root, _) => Ok(pure(of)),
        }
    }
}
