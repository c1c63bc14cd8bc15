//! Steps: how many, how long, and whether each ends in equilibrium.

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    pub steps: u64,
    pub time_step: TimeStep,
    /// Run even if the step is above the stability limit.
    pub force_unstable: bool,
    /// Every step is an increment of load that ends in equilibrium; `time_step` is what t grows by.
    pub statics: Option<Statics>,
}

/// How equilibrium is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statics {
    pub method: Method,
    pub solver: Solver,
    /// Residual force over loads and reactions.
    pub tolerance: f64,
    /// Of conjugate gradients or relaxation, per solution.
    pub most_iterations: usize,
}

impl Default for Statics {
    /// The linear solution to 1e-10.
    fn default() -> Self {
        Statics {
            method: Method::Linear,
            solver: Solver::Auto,
            tolerance: 1e-10,
            most_iterations: 100_000,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The equations linear about the reference.
    Linear,
    /// Newton's method: large deformation.
    Newton,
    /// Adaptive dynamic relaxation: contact, and what Newton's method does not find.
    Relaxation,
}

/// How linear equations are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// Factors where they are small, else conjugate gradients.
    Auto,
    Direct,
    ConjugateGradients,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeStep {
    Fixed(f64),
    /// Fraction of the estimated stability limit.
    Fraction(f64),
    /// The engine chooses: 80 % of the limit for peridynamic points; for atoms a tenth of it (a thirtieth of the shortest
    /// period), and less where they are fast.
    Auto,
}
