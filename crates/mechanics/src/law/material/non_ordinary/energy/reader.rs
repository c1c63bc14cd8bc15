//! Reads an expression into steps, with every part at the reference.

use super::{AT_REST, At, HIGHEST, INVARIANTS, Step};
use crate::expression::{Binary, Expression, Op, Unary};

/// The steps of an energy, and all of it at the reference.
///
/// # Errors
/// A part has no slope at the reference, or the energy is none of the invariants.
pub(super) fn read(expression: &Expression) -> Result<(Vec<Step>, At), String> {
    let mut reader = Reader {
        steps: vec![],
        stack: vec![],
    };
    for op in expression.program() {
        match *op {
            Op::Push(x) => reader.number(x),
            Op::Coordinate(k) => {
                let mut slope = [0.0; 3];
                slope[k] = 1.0;
                let value = AT_REST[k];
                reader.push(Step::Variable, At { value, slope });
            }
            Op::Time => return Err("an energy does not depend on time".into()),
            Op::One(f) => reader.one(f)?,
            Op::Two(f) => reader.two(f)?,
            Op::Three(f) => return Err(unsmooth(&f)),
        }
    }
    match reader.pop() {
        Part::Varies(at) => Ok((reader.steps, at)),
        Part::Number(_) => Err(format!("it depends on none of {}", INVARIANTS.join(", "))),
    }
}

/// A part while an expression is read: numbers ask for no work later.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    Number(f64),
    Varies(At),
}

/// Reads a program.
struct Reader {
    steps: Vec<Step>,
    stack: Vec<Part>,
}

impl Reader {
    fn number(&mut self, value: f64) {
        self.stack.push(Part::Number(value));
    }

    fn push(&mut self, step: Step, at: At) {
        self.steps.push(step);
        self.stack.push(Part::Varies(at));
    }

    fn pop(&mut self) -> Part {
        self.stack.pop().unwrap_or(Part::Number(f64::NAN))
    }

    fn scaled(&mut self, at: At, factor: f64) {
        self.push(Step::Scale(factor), at.chain(factor * at.value, factor));
    }

    fn inverse(&mut self, at: At) -> Result<At, String> {
        if at.value == 0.0 {
            return Err("it divides by what is 0 in the reference".into());
        }
        let out = at.chain(at.value.recip(), -at.value.powi(-2));
        self.steps.push(Step::Inverse(at));
        Ok(out)
    }

    fn one(&mut self, f: Unary) -> Result<(), String> {
        let at = match self.pop() {
            Part::Number(x) => {
                self.number(f.apply(x));
                return Ok(());
            }
            Part::Varies(at) => at,
        };
        let a = at.value;
        let positive = |what: &str| match a > 0.0 {
            true => Ok(()),
            false => Err(format!(
                "it has {what} of {a} in the reference, expected a positive number"
            )),
        };
        match f {
            Unary::Negate => self.scaled(at, -1.0),
            Unary::Exp => self.push(Step::Exp(at), at.chain(libm::exp(a), libm::exp(a))),
            Unary::Log => {
                positive("the logarithm")?;
                self.push(Step::Log(at), at.chain(libm::log(a), a.recip()));
            }
            Unary::Sqrt => {
                positive("the root")?;
                self.push(Step::Root(at), at.chain(a.sqrt(), 0.5 / a.sqrt()));
            }
            other => return Err(unsmooth(&other)),
        }
        Ok(())
    }

    fn two(&mut self, f: Binary) -> Result<(), String> {
        let (b, a) = (self.pop(), self.pop());
        match (a, f, b) {
            (Part::Number(a), _, Part::Number(b)) => self.number(f.apply(a, b)),
            (Part::Varies(a), Binary::Add, Part::Varies(b)) => {
                self.push(Step::Add, a.plus(1.0, &b));
            }
            (Part::Varies(a), Binary::Subtract, Part::Varies(b)) => {
                self.push(Step::Subtract, a.plus(-1.0, &b));
            }
            // a number changes nothing of what is beyond
            (Part::Varies(at), Binary::Add, Part::Number(x))
            | (Part::Number(x), Binary::Add, Part::Varies(at)) => {
                let value = at.value + x;
                self.stack.push(Part::Varies(At { value, ..at }));
            }
            (Part::Varies(at), Binary::Subtract, Part::Number(x)) => {
                let value = at.value - x;
                self.stack.push(Part::Varies(At { value, ..at }));
            }
            (Part::Number(x), Binary::Subtract, Part::Varies(at)) => {
                let at = at.chain(x - at.value, -1.0);
                self.push(Step::Scale(-1.0), at);
            }
            (Part::Varies(a), Binary::Multiply, Part::Varies(b)) => {
                self.push(Step::Multiply(a, b), a.times(&b));
            }
            (Part::Varies(at), Binary::Multiply, Part::Number(x))
            | (Part::Number(x), Binary::Multiply, Part::Varies(at)) => self.scaled(at, x),
            (Part::Varies(a), Binary::Divide, Part::Varies(b)) => {
                let b = self.inverse(b)?;
                self.push(Step::Multiply(a, b), a.times(&b));
            }
            (Part::Varies(at), Binary::Divide, Part::Number(x)) => self.scaled(at, x.recip()),
            (Part::Number(x), Binary::Divide, Part::Varies(at)) => {
                let inverse = self.inverse(at)?;
                self.scaled(inverse, x);
            }
            (Part::Varies(at), Binary::Power, Part::Number(p)) => self.power(at, p)?,
            (Part::Number(base), Binary::Power, Part::Varies(at)) if base > 0.0 => {
                let ln = libm::log(base);
                let at = At {
                    value: ln * at.value,
                    slope: at.slope.map(|g| ln * g),
                };
                self.steps.push(Step::Scale(ln));
                let value = libm::exp(at.value);
                self.push(Step::Exp(at), at.chain(value, value));
            }
            (_, Binary::Power, _) => {
                return Err("the exponent of a power is a number, not an invariant".into());
            }
            (_, other, _) => return Err(unsmooth(&other)),
        }
        Ok(())
    }

    fn power(&mut self, at: At, p: f64) -> Result<(), String> {
        let a = at.value;
        let whole = p.fract() == 0.0 && (0.0..=HIGHEST as f64).contains(&p);
        if p == 0.0 || p == 1.0 {
            // of a 0 the part is forgotten later by a factor of 0
            match p == 0.0 {
                true => self.push(Step::Scale(0.0), at.chain(1.0, 0.0)),
                false => self.stack.push(Part::Varies(at)),
            }
            return Ok(());
        }
        if !whole && !(a > 0.0) {
            return Err(format!(
                "it takes {a} to the power of {p} in the reference, expected a positive number or a power that is a whole number from 0 to {HIGHEST}"
            ));
        }
        let out = at.chain(libm::pow(a, p), p * libm::pow(a, p - 1.0));
        if !whole {
            self.push(Step::Power(at, p), out);
            return Ok(());
        }
        // binomials times a^(n − k)
        let n = p as usize;
        let mut coefficients = [0.0; HIGHEST + 1];
        let mut binomial = 1.0;
        for (k, c) in coefficients.iter_mut().enumerate().take(n + 1) {
            *c = binomial * a.powi((n - k) as i32);
            binomial = binomial * (n - k) as f64 / (k + 1) as f64;
        }
        self.push(Step::Polynomial(at, coefficients), out);
        Ok(())
    }
}

fn unsmooth(op: &impl std::fmt::Debug) -> String {
    let name = format!("{op:?}").to_lowercase();
    format!("an energy is a smooth function of + − * / ^ exp ln sqrt, it has `{name}`")
}
