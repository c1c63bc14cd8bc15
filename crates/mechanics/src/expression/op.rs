//! Operations of the stack machine.

use super::error::STACK;

use super::{Rule, random};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Op {
    Push(f64),
    /// x, y or z, or another variable of the expression
    Coordinate(usize),
    Time,
    One(Unary),
    Two(Binary),
    Three(Ternary),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Unary {
    Negate,
    Not,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Log,
    Log10,
    Sqrt,
    Abs,
    Floor,
    Ceil,
    Sign,
    Step,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
    Atan2,
    Hypot,
    Min,
    Max,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Ternary {
    Select,
    Clamp,
    Random,
    Noise,
}

/// What a function name stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Function {
    One(Unary),
    Two(Binary),
    Three(Ternary),
    /// Two or more arguments, folded pairwise.
    Fold(Binary),
}

pub(super) const FUNCTIONS: &[(&str, Function)] = &[
    ("sin", Function::One(Unary::Sin)),
    ("cos", Function::One(Unary::Cos)),
    ("tan", Function::One(Unary::Tan)),
    ("asin", Function::One(Unary::Asin)),
    ("acos", Function::One(Unary::Acos)),
    ("atan", Function::One(Unary::Atan)),
    ("atan2", Function::Two(Binary::Atan2)),
    ("sinh", Function::One(Unary::Sinh)),
    ("cosh", Function::One(Unary::Cosh)),
    ("tanh", Function::One(Unary::Tanh)),
    ("exp", Function::One(Unary::Exp)),
    ("log", Function::One(Unary::Log)),
    ("ln", Function::One(Unary::Log)),
    ("log10", Function::One(Unary::Log10)),
    ("sqrt", Function::One(Unary::Sqrt)),
    ("abs", Function::One(Unary::Abs)),
    ("min", Function::Fold(Binary::Min)),
    ("max", Function::Fold(Binary::Max)),
    ("floor", Function::One(Unary::Floor)),
    ("ceil", Function::One(Unary::Ceil)),
    ("sign", Function::One(Unary::Sign)),
    ("step", Function::One(Unary::Step)),
    ("clamp", Function::Three(Ternary::Clamp)),
    ("hypot", Function::Two(Binary::Hypot)),
    ("if", Function::Three(Ternary::Select)),
    ("random", Function::Three(Ternary::Random)),
    ("noise", Function::Three(Ternary::Noise)),
];

fn truth(condition: bool) -> f64 {
    if condition { 1.0 } else { 0.0 }
}

impl Op {
    /// Arguments it takes, and what it asks of them; `None` of what takes none.
    pub(super) fn rule(self) -> Option<(usize, Rule)> {
        match self {
            Op::Push(_) | Op::Coordinate(_) | Op::Time => None,
            Op::One(f) => Some((1, f.rule())),
            Op::Two(f) => Some((2, f.rule())),
            Op::Three(f) => Some((3, f.rule())),
        }
    }
}

impl Unary {
    fn rule(self) -> Rule {
        match self {
            Unary::Negate | Unary::Abs => Rule::Alike,
            Unary::Not | Unary::Sign | Unary::Step => Rule::Any,
            Unary::Sqrt => Rule::Root,
            Unary::Sin
            | Unary::Cos
            | Unary::Tan
            | Unary::Asin
            | Unary::Acos
            | Unary::Atan
            | Unary::Sinh
            | Unary::Cosh
            | Unary::Tanh
            | Unary::Exp
            | Unary::Log
            | Unary::Log10
            | Unary::Floor
            | Unary::Ceil => Rule::Numbers,
        }
    }

    pub(crate) fn apply(self, a: f64) -> f64 {
        match self {
            Unary::Negate => -a,
            Unary::Not => truth(a == 0.0),
            Unary::Sin => libm::sin(a),
            Unary::Cos => libm::cos(a),
            Unary::Tan => libm::tan(a),
            Unary::Asin => libm::asin(a),
            Unary::Acos => libm::acos(a),
            Unary::Atan => libm::atan(a),
            Unary::Sinh => libm::sinh(a),
            Unary::Cosh => libm::cosh(a),
            Unary::Tanh => libm::tanh(a),
            Unary::Exp => libm::exp(a),
            Unary::Log => libm::log(a),
            Unary::Log10 => libm::log10(a),
            Unary::Sqrt => a.sqrt(),
            Unary::Abs => a.abs(),
            Unary::Floor => a.floor(),
            Unary::Ceil => a.ceil(),
            // f64::signum(0) is 1
            Unary::Sign if a == 0.0 => 0.0,
            Unary::Sign => a.signum(),
            Unary::Step => truth(a >= 0.0),
        }
    }
}

impl Binary {
    fn rule(self) -> Rule {
        match self {
            Binary::Add | Binary::Subtract | Binary::Hypot | Binary::Min | Binary::Max => {
                Rule::Alike
            }
            Binary::Multiply => Rule::Product,
            Binary::Divide => Rule::Quotient,
            Binary::Power => Rule::Power,
            Binary::Less
            | Binary::LessEqual
            | Binary::Greater
            | Binary::GreaterEqual
            | Binary::Equal
            | Binary::NotEqual
            | Binary::Atan2 => Rule::Compare,
            Binary::And | Binary::Or => Rule::Any,
        }
    }

    pub(crate) fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            Binary::Add => a + b,
            Binary::Subtract => a - b,
            Binary::Multiply => a * b,
            Binary::Divide => a / b,
            Binary::Power => libm::pow(a, b),
            Binary::Less => truth(a < b),
            Binary::LessEqual => truth(a <= b),
            Binary::Greater => truth(a > b),
            Binary::GreaterEqual => truth(a >= b),
            Binary::Equal => truth(a == b),
            Binary::NotEqual => truth(a != b),
            Binary::And => truth(a != 0.0 && b != 0.0),
            Binary::Or => truth(a != 0.0 || b != 0.0),
            Binary::Atan2 => libm::atan2(a, b),
            Binary::Hypot => libm::hypot(a, b),
            Binary::Min => a.min(b),
            Binary::Max => a.max(b),
        }
    }
}

impl Ternary {
    fn rule(self) -> Rule {
        match self {
            Ternary::Select => Rule::Choice,
            Ternary::Clamp => Rule::Alike,
            Ternary::Random | Ternary::Noise => Rule::Numbers,
        }
    }

    pub(super) fn apply(self, a: f64, b: f64, c: f64) -> f64 {
        match self {
            Ternary::Select => {
                if a != 0.0 {
                    b
                } else {
                    c
                }
            }
            // f64::clamp panics where low > high
            Ternary::Clamp => a.max(b).min(c),
            Ternary::Random => random::random([a, b, c]),
            Ternary::Noise => random::noise([a, b, c]),
        }
    }
}

/// Runs a program that the parser has checked: it leaves one number and never needs more than [`STACK`].
pub(super) fn run(program: &[Op], x: &[f64], t: f64) -> f64 {
    if let [Op::Push(value)] = program {
        return *value;
    }
    let mut stack = [0.0f64; STACK];
    let mut n = 0;
    for op in program {
        match *op {
            Op::Push(value) => {
                stack[n] = value;
                n += 1;
            }
            Op::Coordinate(axis) => {
                stack[n] = x[axis];
                n += 1;
            }
            Op::Time => {
                stack[n] = t;
                n += 1;
            }
            Op::One(f) => stack[n - 1] = f.apply(stack[n - 1]),
            Op::Two(f) => {
                n -= 1;
                stack[n - 1] = f.apply(stack[n - 1], stack[n]);
            }
            Op::Three(f) => {
                n -= 2;
                stack[n - 1] = f.apply(stack[n - 1], stack[n], stack[n + 1]);
            }
        }
    }
    stack[0]
}
