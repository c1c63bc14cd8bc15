//! ψ(u) from an expression: the polynomial that it is, or its values for many u at once.
//!
//! The parser of the engine tells its parts to a [`Measure`] in the order in which they are computed. This one computes with coefficients instead of units, and notes
//! the operations: an expression is a polynomial if it is made of u and numbers by `+ − *`, whole powers, division by numbers and choices that a number decides.
//! Nothing is concluded from values, so what only looks like a polynomial somewhere is none.

use crate::psi::{HIGHEST, Psi};
use peridyne::expression::{Expression, ExpressionError, Measure, Misfit, Rule};
use std::cell::RefCell;
use std::ops::Range;

/// Numbers that go through an operation together; what waits for its operator stays in the first cache.
const TOGETHER: usize = 128;

/// An expression of `x` alone, which stands for u.
#[derive(Debug, Clone)]
pub struct Formula {
    expression: Expression,
    polynomial: Option<Vec<f64>>,
    steps: Vec<Step>,
    /// Most numbers that wait.
    depth: usize,
}

/// Numbers of as many u.
type Lanes = [f64; TOGETHER];

/// Operations on a stack of arrays; the first argument becomes the result.
#[derive(Debug, Clone)]
enum Step {
    Number(f64),
    Variable,
    One(fn(&mut Lanes)),
    Two(fn(&mut Lanes, &Lanes)),
    Three(fn(&mut Lanes, &Lanes, &Lanes)),
    /// From 2 on, by multiplications.
    Power(usize),
    /// Any other, value by value: an expression of x, y, z and how many of them.
    Other(Box<Expression>, usize),
}

fn one(a: &mut Lanes, f: impl Fn(f64) -> f64) {
    a.iter_mut().for_each(|a| *a = f(*a));
}

fn two(a: &mut Lanes, b: &Lanes, f: impl Fn(f64, f64) -> f64) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a = f(*a, *b));
}

fn truth(is: bool) -> f64 {
    f64::from(u8::from(is))
}

/// Of the engine's operations those that are made for arrays; the tests hold them against the interpreter.
const ONE: &[(&str, fn(&mut Lanes))] = &[
    ("-", |a| one(a, |a| -a)),
    ("abs", |a| one(a, f64::abs)),
    ("sqrt", |a| one(a, f64::sqrt)),
    ("sin", |a| one(a, libm::sin)),
    ("cos", |a| one(a, libm::cos)),
    ("tan", |a| one(a, libm::tan)),
    ("atan", |a| one(a, libm::atan)),
    ("sinh", |a| one(a, libm::sinh)),
    ("cosh", |a| one(a, libm::cosh)),
    ("tanh", |a| one(a, libm::tanh)),
    ("exp", |a| one(a, libm::exp)),
    ("log", |a| one(a, libm::log)),
    ("ln", |a| one(a, libm::log)),
];
const TWO: &[(&str, fn(&mut Lanes, &Lanes))] = &[
    ("+", |a, b| two(a, b, |a, b| a + b)),
    ("-", |a, b| two(a, b, |a, b| a - b)),
    ("*", |a, b| two(a, b, |a, b| a * b)),
    ("/", |a, b| two(a, b, |a, b| a / b)),
    ("^", |a, b| two(a, b, libm::pow)),
    ("min", |a, b| two(a, b, f64::min)),
    ("max", |a, b| two(a, b, f64::max)),
    ("<", |a, b| two(a, b, |a, b| truth(a < b))),
    ("<=", |a, b| two(a, b, |a, b| truth(a <= b))),
    (">", |a, b| two(a, b, |a, b| truth(a > b))),
    (">=", |a, b| two(a, b, |a, b| truth(a >= b))),
];
const CHOICE: fn(&mut Lanes, &Lanes, &Lanes) = |a, b, c| {
    for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
        *a = if *a != 0.0 { *b } else { *c };
    }
};

impl Formula {
    /// # Errors
    /// What the parser says.
    pub fn new(text: &str, constants: &[(&str, f64)]) -> Result<Formula, ExpressionError> {
        // as constants they have values here
        let own = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];
        let constants: Vec<(&str, f64)> = constants.iter().copied().chain(own).collect();
        let reader = Reader {
            constants: constants.iter().map(|c| c.1).collect(),
            steps: RefCell::new(vec![]),
        };
        let (expression, part) = Expression::measured(text, &constants, &reader)?;
        let mut steps = reader.steps.into_inner();
        if let Some(value) = expression.as_constant() {
            steps = vec![Step::Number(value)];
        }
        let (mut height, mut depth) = (0, 0);
        for step in &steps {
            match step {
                Step::Number(_) | Step::Variable => height += 1,
                Step::One(_) | Step::Power(_) => {}
                Step::Two(_) => height -= 1,
                Step::Three(_) => height -= 2,
                Step::Other(_, count) => height -= count - 1,
            }
            depth = depth.max(height);
        }
        Ok(Formula {
            expression,
            polynomial: part.polynomial.filter(|p| p.len() <= HIGHEST + 1),
            steps,
            depth,
        })
    }

    /// Coefficients from the constant one on, if it is a polynomial of a power of 8 at most.
    pub fn polynomial(&self) -> Option<&[f64]> {
        self.polynomial.as_deref()
    }

    /// The same where the sum of its terms keeps the digits of the expression as written for u from `low` to `high`: `(u − 1)^4` near 1 does not, multiplied out.
    pub fn expanded(&self, low: f64, high: f64) -> Option<&[f64]> {
        /// of the largest value
        const LOST: f64 = 64.0;
        let coefficients = self.polynomial()?;
        let far = low.abs().max(high.abs());
        let terms = coefficients
            .iter()
            .rev()
            .fold(0.0, |sum, c| sum * far + c.abs());
        let value = |k: usize| self.value(low + (high - low) * k as f64 / 16.0).abs();
        let largest = (0..=16).map(value).fold(0.0, f64::max);
        (terms <= LOST * largest).then_some(coefficients)
    }
}

impl Psi for Formula {
    fn value(&self, u: f64) -> f64 {
        self.expression.eval(&[u, 0.0, 0.0], 0.0)
    }

    fn values(&self, u: &mut [f64]) {
        let mut stack = vec![[0.0; TOGETHER]; self.depth.max(1)];
        for part in u.chunks_mut(TOGETHER) {
            let mut n = 0;
            for step in &self.steps {
                match step {
                    Step::Number(value) => {
                        stack[n] = [*value; TOGETHER];
                        n += 1;
                    }
                    Step::Variable => {
                        stack[n][..part.len()].copy_from_slice(part);
                        n += 1;
                    }
                    Step::One(f) => f(&mut stack[n - 1]),
                    Step::Two(f) => {
                        n -= 1;
                        if let [.., a, b] = &mut stack[..=n] {
                            f(a, b);
                        }
                    }
                    Step::Three(f) => {
                        n -= 2;
                        if let [.., a, b, c] = &mut stack[..=n + 1] {
                            f(a, b, c);
                        }
                    }
                    Step::Power(power) => {
                        let base = stack[n - 1];
                        for _ in 1..*power {
                            stack[n - 1]
                                .iter_mut()
                                .zip(&base)
                                .for_each(|(a, b)| *a *= b);
                        }
                    }
                    Step::Other(f, count) => {
                        n -= count - 1;
                        for k in 0..part.len() {
                            let mut of = [0.0; 3];
                            for (a, of) in of.iter_mut().take(*count).enumerate() {
                                *of = stack[n - 1 + a][k];
                            }
                            stack[n - 1][k] = f.eval(&of, 0.0);
                        }
                    }
                }
            }
            part.copy_from_slice(&stack[0][..part.len()]);
        }
    }
}

/// What is known of a part of an expression.
#[derive(Debug, Clone)]
struct Part {
    /// Where its operations begin.
    start: usize,
    /// Finite coefficients, the last of which is not 0 unless it is the only one.
    polynomial: Option<Vec<f64>>,
    /// Its value where it is a number.
    number: Option<f64>,
}

struct Reader {
    constants: Vec<f64>,
    steps: RefCell<Vec<Step>>,
}

impl Reader {
    fn part(&self, start: usize, number: Option<f64>, polynomial: Option<Vec<f64>>) -> Part {
        let polynomial = polynomial.filter(|p| p.iter().all(|c| c.is_finite()));
        let polynomial = polynomial.map(|mut p| {
            while p.len() > 1 && p.last() == Some(&0.0) {
                p.pop();
            }
            p
        });
        Part {
            start,
            polynomial,
            number,
        }
    }

    fn leaf(&self, step: Step, number: Option<f64>, polynomial: Vec<f64>) -> Part {
        let mut steps = self.steps.borrow_mut();
        steps.push(step);
        self.part(steps.len() - 1, number, Some(polynomial))
    }
}

impl Measure for Reader {
    type Kind = Part;

    fn number(&self, value: f64) -> Part {
        self.leaf(Step::Number(value), Some(value), vec![value])
    }

    /// Of `pi` and `e`, which are among the constants.
    fn pure(&self) -> Part {
        self.leaf(Step::Number(f64::NAN), None, vec![f64::NAN])
    }

    fn coordinate(&self) -> Part {
        self.leaf(Step::Variable, None, vec![0.0, 1.0])
    }

    /// As every caller evaluates at t = 0.
    fn time(&self) -> Part {
        self.number(0.0)
    }

    fn constant(&self, index: usize) -> Part {
        self.number(self.constants[index])
    }

    fn quantity(
        &self,
        _: f64,
        _: &str,
    ) -> Result<Option<(usize, f64, Part)>, (Range<usize>, Misfit)> {
        Ok(None)
    }

    fn combine(&self, name: &str, _: Rule, of: &[Part], _: Option<f64>) -> Result<Part, Misfit> {
        let name = name.trim();
        let start = of.first().map_or(0, |p| p.start);
        let operation = Box::new(single(name, of.len())?);
        let mut steps = self.steps.borrow_mut();
        let numbers: Option<Vec<f64>> = of.iter().map(|p| p.number).collect();
        if let Some(numbers) = numbers {
            let mut at = [0.0; 3];
            at.iter_mut().zip(&numbers).for_each(|(a, n)| *a = *n);
            let value = operation.eval(&at, 0.0);
            steps.truncate(start);
            steps.push(Step::Number(value));
            return Ok(self.part(start, Some(value), Some(vec![value])));
        }
        let known = |n: usize| of[n].polynomial.as_ref();
        let whole = of
            .get(1)
            .and_then(|p| p.number)
            .filter(|e| e.fract() == 0.0 && (0.0..=HIGHEST as f64).contains(e));
        let both = |f: fn(&[f64], &[f64]) -> Vec<f64>| Some(f(known(0)?, known(1)?));
        let polynomial = match (name, of.len()) {
            ("-", 1) => known(0).map(|a| scaled(a, -1.0)),
            ("+", 2) => both(|a, b| sum(a, b, 1.0)),
            ("-", 2) => both(|a, b| sum(a, b, -1.0)),
            ("*", 2) => both(product),
            ("/", 2) => of[1]
                .number
                .and_then(|d| Some(known(0)?.iter().map(|c| c / d).collect())),
            ("^", 2) => whole.and_then(|power| {
                let base = known(0)?;
                Some((0..power as usize).fold(vec![1.0], |p, _| product(&p, base)))
            }),
            ("?" | "if", 3) => {
                let chosen = of[0]
                    .number
                    .and_then(|c| known(if c != 0.0 { 1 } else { 2 }));
                chosen.cloned()
            }
            _ => None,
        };
        let step = match (name, of.len(), whole) {
            ("^", 2, Some(power)) if power >= 2.0 => {
                // the exponent is not asked any more
                steps.pop();
                Step::Power(power as usize)
            }
            ("?" | "if", 3, _) => Step::Three(CHOICE),
            (_, 1, _) => named(ONE, name).map_or(Step::Other(operation, 1), Step::One),
            (_, 2, _) => named(TWO, name).map_or(Step::Other(operation, 2), Step::Two),
            (_, count, _) => Step::Other(operation, count),
        };
        steps.push(step);
        Ok(self.part(start, None, polynomial))
    }
}

fn named<T: Copy>(list: &[(&str, T)], name: &str) -> Option<T> {
    list.iter().find(|(n, _)| *n == name).map(|(_, f)| *f)
}

/// One operation as an expression of x, y, z, so that it means what it means everywhere.
fn single(name: &str, count: usize) -> Result<Expression, Misfit> {
    let word = name.starts_with(|c: char| c.is_ascii_alphabetic());
    let text = match (word, count) {
        (false, 1) => format!("{name}x"),
        (false, 2) => format!("x {name} y"),
        (false, _) => "x ? y : z".into(),
        (true, 1) => format!("{name}(x)"),
        (true, 2) => format!("{name}(x, y)"),
        (true, _) => format!("{name}(x, y, z)"),
    };
    Expression::parse(&text, &[]).map_err(|e| Misfit {
        message: e.message,
        help: e.help,
    })
}

fn scaled(a: &[f64], factor: f64) -> Vec<f64> {
    a.iter().map(|c| factor * c).collect()
}

fn sum(a: &[f64], b: &[f64], sign: f64) -> Vec<f64> {
    let of = |p: &[f64], n: usize| p.get(n).copied().unwrap_or(0.0);
    let each = 0..a.len().max(b.len());
    each.map(|n| of(a, n) + sign * of(b, n)).collect()
}

/// Of powers far beyond the highest NaN, which makes it none.
fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    if a.len() + b.len() > 8 * HIGHEST {
        return vec![f64::NAN];
    }
    let mut out = vec![0.0; a.len() + b.len() - 1];
    for (i, a) in a.iter().enumerate() {
        for (j, b) in b.iter().enumerate() {
            out[i + j] += a * b;
        }
    }
    out
}
