//! A number of a fix, or a variable that has it.

/// A number, or a variable evaluated at every step.
#[derive(Debug, Clone, PartialEq)]
pub enum Input {
    Number(f64),
    Variable(String),
}

impl Input {
    /// LAMMPS scales numbers of `units lattice` only, not what variables give.
    pub fn scaled(self, unit: f64) -> Input {
        match self {
            Input::Number(x) => Input::Number(unit * x),
            Input::Variable(name) => Input::Variable(name),
        }
    }
}
