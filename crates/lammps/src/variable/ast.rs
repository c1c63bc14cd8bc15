//! Formulas as trees.

/// Operators in LAMMPS's order of precedence; all binary ones group to the left, also `^`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Op {
    Or,
    Xor,
    And,
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    Add,
    Sub,
    Mul,
    Div,
    Rem,
    Pow,
}

impl Op {
    /// Longest spelling first.
    pub const SPELLING: [(&'static str, Op); 15] = [
        ("||", Op::Or),
        ("|^", Op::Xor),
        ("&&", Op::And),
        ("==", Op::Eq),
        ("!=", Op::Ne),
        ("<=", Op::Le),
        (">=", Op::Ge),
        ("<", Op::Lt),
        (">", Op::Gt),
        ("+", Op::Add),
        ("-", Op::Sub),
        ("*", Op::Mul),
        ("/", Op::Div),
        ("%", Op::Rem),
        ("^", Op::Pow),
    ];

    pub fn precedence(self) -> u8 {
        match self {
            Op::Or | Op::Xor => 1,
            Op::And => 2,
            Op::Eq | Op::Ne => 3,
            Op::Lt | Op::Le | Op::Gt | Op::Ge => 4,
            Op::Add | Op::Sub => 5,
            Op::Mul | Op::Div | Op::Rem => 6,
            Op::Pow => 7,
        }
    }

    /// Value; comparisons give 1 or 0.
    ///
    /// # Errors
    /// Division by zero, zero to a negative power.
    pub fn apply(self, a: f64, b: f64) -> Result<f64, &'static str> {
        let truth = |t: bool| f64::from(u8::from(t));
        Ok(match self {
            Op::Or => truth(a != 0.0 || b != 0.0),
            Op::Xor => truth((a != 0.0) != (b != 0.0)),
            Op::And => truth(a != 0.0 && b != 0.0),
            Op::Eq => truth(a == b),
            Op::Ne => truth(a != b),
            Op::Lt => truth(a < b),
            Op::Le => truth(a <= b),
            Op::Gt => truth(a > b),
            Op::Ge => truth(a >= b),
            Op::Add => a + b,
            Op::Sub => a - b,
            Op::Mul => a * b,
            Op::Div | Op::Rem if b == 0.0 => return Err("division by 0"),
            Op::Div => a / b,
            Op::Rem => a % b,
            Op::Pow if a == 0.0 && b < 0.0 => return Err("0 to a negative power"),
            Op::Pow => libm::pow(a, b),
        })
    }
}

/// `-x` and `!x`; they bind tighter than `^`: `-2^2` is 4.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prefix {
    Minus,
    Not,
}

impl Prefix {
    pub fn apply(self, a: f64) -> f64 {
        match self {
            Prefix::Minus => -a,
            Prefix::Not => f64::from(u8::from(a == 0.0)),
        }
    }
}

/// Per-atom values that formulas know by name.
pub const ATOM_VALUES: [&str; 12] = [
    "id", "mass", "type", "x", "y", "z", "vx", "vy", "vz", "fx", "fy", "fz",
];

#[derive(Debug, Clone, PartialEq)]
pub enum Expr {
    Number(f64),
    Prefix(Prefix, Box<Expr>),
    /// A first value, and what is done with it from left to right: as long as it likes, without nesting.
    Chain(Box<Expr>, Vec<(Op, Expr)>),
    /// A function of [`super::functions::NAMES`].
    Call(&'static str, Vec<Expr>),
    /// `random(lo,hi,seed)`, `normal(mean,sigma,seed)`.
    Random {
        normal: bool,
        arguments: Box<[Expr; 3]>,
    },
    /// A group function and its plain-word arguments.
    Group(&'static str, Vec<String>),
    /// `is_defined(category,id)`
    IsDefined(String, String),
    /// One of [`ATOM_VALUES`] for every atom.
    Atom(&'static str),
    /// One of [`ATOM_VALUES`] of the atom with this id.
    AtomAt(&'static str, Box<Expr>),
    /// A thermo keyword.
    Keyword(&'static str),
    /// `v_name`, `v_name[id]`
    Variable(String, Option<Box<Expr>>),
    /// `c_ID`, `c_ID[i]`, `c_ID[i][j]`
    Compute(String, Vec<Expr>),
    /// `f_ID`, `f_ID[i]`
    Fix(String, Vec<Expr>),
}
