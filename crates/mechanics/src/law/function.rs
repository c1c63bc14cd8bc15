//! Functions that somebody wrote as expressions, over any [`Number`], with their slopes.

use crate::execute::lane::Piece;
use crate::expression::{Binary, Expression, Op, Ternary, Unary};
use crate::law::number::Number;

/// Most parts that wait for their operator.
const DEPTH: usize = 12;

/// What is done next with the topmost parts.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    Number(f64),
    Variable(usize),
    One(One),
    Two(Two),
    Choice,
}

/// An operation on one part.
#[derive(Debug, Clone, Copy, PartialEq)]
enum One {
    Negate,
    Exp,
    Log,
    Root,
    Magnitude,
    Not,
    /// To a whole power, positive or negative, and to any other.
    Whole(i32),
    Power(f64),
}

/// An operation on two parts.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Two {
    Add,
    Subtract,
    Multiply,
    Divide,
    /// To the power of a part.
    Raise,
    Least,
    Most,
    Below,
    AtMost,
    Above,
    AtLeast,
    And,
    Or,
}

/// A function of a few variables, ready to be evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Function {
    steps: Vec<Step>,
}

impl Function {
    /// # Errors
    /// An operation has no slope, or too many parts wait for theirs.
    pub fn new(expression: &Expression) -> Result<Function, String> {
        let mut steps: Vec<Step> = vec![];
        let (mut height, mut most) = (0, 0);
        for op in expression.program() {
            let last = steps.last().copied();
            let (step, taken) = match (*op, last) {
                (Op::Push(x), _) => (Step::Number(x), 0),
                (Op::Coordinate(k), _) => (Step::Variable(k), 0),
                (Op::Two(Binary::Power), Some(Step::Number(p))) => {
                    steps.pop();
                    (Step::One(power(p)), 2)
                }
                (Op::One(f), _) => (Step::One(one(f)?), 1),
                (Op::Two(f), _) => (Step::Two(two(f)?), 2),
                (Op::Three(Ternary::Select), _) => (Step::Choice, 3),
                (Op::Three(f), _) => return Err(unknown(&f)),
                (Op::Time, _) => return Err("it does not depend on time".into()),
            };
            height = height + 1 - taken;
            most = most.max(height);
            steps.push(step);
        }
        if most > DEPTH {
            return Err(format!(
                "{most} parts wait for their operator, expected at most {DEPTH}: write sums from left to right"
            ));
        }
        Ok(Function { steps })
    }

    /// The value, and the slope by variable `by`.
    #[inline(always)]
    pub fn at<N: Number, const V: usize>(&self, variables: [N; V], by: usize) -> [N; 2] {
        N::out_of_line(Evaluated {
            steps: &self.steps,
            variables,
            by,
        })
    }
}

fn power(p: f64) -> One {
    match p.fract() == 0.0 && p.abs() <= 64.0 {
        true => One::Whole(p as i32),
        false => One::Power(p),
    }
}

fn one(f: Unary) -> Result<One, String> {
    match f {
        Unary::Negate => Ok(One::Negate),
        Unary::Exp => Ok(One::Exp),
        Unary::Log => Ok(One::Log),
        Unary::Sqrt => Ok(One::Root),
        Unary::Abs => Ok(One::Magnitude),
        Unary::Not => Ok(One::Not),
        other => Err(unknown(&other)),
    }
}

fn two(f: Binary) -> Result<Two, String> {
    match f {
        Binary::Add => Ok(Two::Add),
        Binary::Subtract => Ok(Two::Subtract),
        Binary::Multiply => Ok(Two::Multiply),
        Binary::Divide => Ok(Two::Divide),
        Binary::Power => Ok(Two::Raise),
        Binary::Min => Ok(Two::Least),
        Binary::Max => Ok(Two::Most),
        Binary::Less => Ok(Two::Below),
        Binary::LessEqual => Ok(Two::AtMost),
        Binary::Greater => Ok(Two::Above),
        Binary::GreaterEqual => Ok(Two::AtLeast),
        Binary::And => Ok(Two::And),
        Binary::Or => Ok(Two::Or),
        other => Err(unknown(&other)),
    }
}

fn unknown(op: &impl std::fmt::Debug) -> String {
    let name = format!("{op:?}").to_lowercase();
    format!(
        "it is made of + − * / ^ exp ln sqrt abs min max, comparisons and choices, it has `{name}`"
    )
}

struct Evaluated<'a, N, const V: usize> {
    steps: &'a [Step],
    variables: [N; V],
    by: usize,
}

impl<N: Number, const V: usize> Piece for Evaluated<'_, N, V> {
    type Out = [N; 2];

    #[inline(always)]
    fn run(self) -> [N; 2] {
        let (zero, unit) = (N::constant(0.0), N::constant(1.0));
        let mut stack = [[zero; 2]; DEPTH];
        let mut n = 0;
        for step in self.steps {
            match *step {
                Step::Number(x) => {
                    stack[n] = [N::constant(x), zero];
                    n += 1;
                }
                Step::Variable(k) => {
                    let slope = if k == self.by { unit } else { zero };
                    stack[n] = [self.variables[k], slope];
                    n += 1;
                }
                Step::Choice => {
                    n -= 2;
                    let [c, _] = stack[n - 1];
                    let ([a, da], [b, db]) = (stack[n], stack[n + 1]);
                    let truth = c * c;
                    stack[n - 1] = [zero.choose(truth, a, b), zero.choose(truth, da, db)];
                }
                Step::One(of) => stack[n - 1] = of_one(of, stack[n - 1]),
                Step::Two(of) => {
                    n -= 1;
                    stack[n - 1] = of_two(of, stack[n - 1], stack[n]);
                }
            }
        }
        stack[0]
    }
}

#[inline(always)]
fn of_one<N: Number>(of: One, [a, slope]: [N; 2]) -> [N; 2] {
    let (zero, unit) = (N::constant(0.0), N::constant(1.0));
    match of {
        One::Negate => [zero - a, zero - slope],
        One::Exp => {
            let value = a.exp();
            [value, value * slope]
        }
        One::Log => [a.ln(), slope.div(a)],
        One::Root => {
            let value = a.sqrt();
            [value, slope.div(value + value)]
        }
        One::Magnitude => [
            a.choose(zero, zero - a, a),
            a.choose(zero, zero - slope, slope),
        ],
        One::Not => [zero.choose(a * a, zero, unit), zero],
        One::Whole(0) => [unit, zero],
        One::Whole(p) => {
            let below = a.power(p.unsigned_abs() - 1);
            let value = below * a;
            if p > 0 {
                return [value, (below * slope).times(f64::from(p))];
            }
            let value = value.recip();
            [value, (value * slope).times(f64::from(p)).div(a)]
        }
        One::Power(p) => {
            let value = a.ln().times(p).exp();
            [value, (value * slope).times(p).div(a)]
        }
    }
}

#[inline(always)]
fn of_two<N: Number>(of: Two, [a, da]: [N; 2], [b, db]: [N; 2]) -> [N; 2] {
    let (zero, unit) = (N::constant(0.0), N::constant(1.0));
    match of {
        Two::Add => [a + b, da + db],
        Two::Subtract => [a - b, da - db],
        Two::Multiply => [a * b, a.fma(db, b * da)],
        Two::Divide => {
            let value = a.div(b);
            [value, (da - value * db).div(b)]
        }
        Two::Raise => {
            let log = a.ln();
            let value = (b * log).exp();
            [value, value * log.fma(db, (b * da).div(a))]
        }
        Two::Least => [b.choose(a, b, a), b.choose(a, db, da)],
        Two::Most => [a.choose(b, b, a), a.choose(b, db, da)],
        Two::Below => [a.choose(b, unit, zero), zero],
        Two::AtMost => [b.choose(a, zero, unit), zero],
        Two::Above => [b.choose(a, unit, zero), zero],
        Two::AtLeast => [a.choose(b, zero, unit), zero],
        Two::And => [zero.choose(a * a * b * b, unit, zero), zero],
        Two::Or => [zero.choose(a * a + b * b, unit, zero), zero],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::number::Dual;

    const XY: &[&str] = &["x", "y"];

    /// Values are those of the expression, slopes those of differences, and the slopes of slopes by dual numbers likewise.
    #[test]
    fn values_and_slopes_are_those_of_the_expression() {
        for text in [
            "x^3*y - 2/x + x^-2",
            "exp(-x*y)*ln(x + y) + sqrt(x)",
            "x < 1.2 ? x^2 : 3 - y",
            "y > x && !(x > 2) ? x*y : x/y",
            "min(x, y)^2 + max(x*x, y) + abs(y - 3*x)",
            "x^1.7 + y^x + 2^y - (0 - x)^3",
            "(x <= 0.8 || y >= 2)*x",
        ] {
            let expression = Expression::of(XY, text, &[]).unwrap();
            let function = Function::new(&expression).unwrap();
            let value = |x: f64, y: f64| expression.of_variables(&[x, y]);
            for [x, y] in [[0.7, 1.9], [1.3, 0.4], [1.9, 2.6]] {
                for by in 0..2 {
                    let h = 1e-3;
                    let step = |s: f64| match by {
                        0 => [x + s, y],
                        _ => [x, y + s],
                    };
                    let ends = |s: f64, f: &dyn Fn([f64; 2]) -> f64| f(step(s)) - f(step(-s));
                    let slope = |f: &dyn Fn([f64; 2]) -> f64| {
                        (8.0 * ends(h, f) - ends(2.0 * h, f)) / (12.0 * h)
                    };
                    let [found, first] = function.at([x, y], by);
                    let exact = value(x, y);
                    assert!(
                        (found - exact).abs() < 1e-14 * (1.0 + exact.abs()),
                        "{text}"
                    );
                    let exact = slope(&|[x, y]| value(x, y));
                    assert!(
                        (first - exact).abs() < 1e-8 * (1.0 + exact.abs()),
                        "{text} {by}"
                    );
                    let dual = |k: usize, value: f64| Dual {
                        value,
                        slope: if k == by { 1.0 } else { 0.0 },
                    };
                    let [_, second] = function.at([dual(0, x), dual(1, y)], by);
                    assert!((second.value - first).abs() < 1e-14 * (1.0 + first.abs()));
                    let exact = slope(&|x| function.at(x, by)[1]);
                    let off = (second.slope - exact).abs();
                    assert!(off < 1e-8 * (1.0 + exact.abs()), "{text} {by}: {off:e}");
                }
            }
        }
    }

    #[test]
    fn what_has_no_slope_is_refused() {
        for text in ["sin(x)", "floor(x)", "x == y", "noise(x, y, 0)"] {
            let expression = Expression::of(XY, text, &[]).unwrap();
            let message = Function::new(&expression).unwrap_err();
            assert!(message.contains("it is made of"), "{text}: {message}");
        }
    }
}
