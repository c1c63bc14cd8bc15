//! Steps: how many, how long, and what moves the state.

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Schedule {
    pub steps: u64,
    pub time_step: TimeStep,
    /// Run even if the step is above the stability limit.
    pub force_unstable: bool,
    pub stepper: Stepper,
}

impl Schedule {
    /// `None`: motion in time.
    pub fn statics(&self) -> Option<Statics> {
        self.stepper.statics()
    }
}

/// What moves the state from step to step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Stepper {
    /// Motion in time by velocity Verlet: explicit, stable below a limit of the step.
    #[default]
    Verlet,
    /// Motion in time by Newmark's method, or that of Hilber, Hughes and Taylor: implicit, stable at any step.
    Newmark(Newmark),
    /// Points stand where they are in time; what spreads through bonds goes on.
    Still,
    /// Every step is an increment of load that ends in equilibrium; `time_step` is what t grows by.
    Statics(Statics),
}

/// An integrator of motion by its name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integrator {
    /// Lower case with underscores, as in decks.
    pub name: &'static str,
    pub doc: &'static str,
    /// With its customary options.
    pub stepper: Stepper,
}

impl Stepper {
    /// All integrators of motion.
    pub fn integrators() -> [Integrator; 4] {
        let of = |name, doc, stepper| Integrator { name, doc, stepper };
        [
            of(
                "verlet",
                "Velocity Verlet: explicit, stable below a limit of the step.",
                Stepper::Verlet,
            ),
            of(
                "newmark",
                "Newmark's method: implicit, stable at any step.",
                Stepper::Newmark(Newmark::default()),
            ),
            of(
                "hht",
                "The method of Hilber, Hughes and Taylor: implicit, and damps what is fast beside the step.",
                Stepper::Newmark(Newmark::hht(-0.1)),
            ),
            of(
                "none",
                "Points stand where they are; heat and species go on.",
                Stepper::Still,
            ),
        ]
    }

    /// Its name among the [integrators](Stepper::integrators); `None`: its steps are no steps in time.
    pub fn name(self) -> Option<&'static str> {
        match self {
            Stepper::Verlet => Some("verlet"),
            Stepper::Newmark(n) if n.alpha != 0.0 => Some("hht"),
            Stepper::Newmark(_) => Some("newmark"),
            Stepper::Still => Some("none"),
            Stepper::Statics(_) => None,
        }
    }

    /// How equilibria are found, where every step ends in one.
    pub fn statics(self) -> Option<Statics> {
        match self {
            Stepper::Statics(statics) => Some(statics),
            Stepper::Verlet | Stepper::Newmark(_) | Stepper::Still => None,
        }
    }

    /// Do forces accelerate points?
    pub fn has_inertia(self) -> bool {
        match self {
            Stepper::Verlet | Stepper::Newmark(_) => true,
            Stepper::Still | Stepper::Statics(_) => false,
        }
    }

    /// Is the end of every step the solution of equations?
    pub fn solves(self) -> bool {
        match self {
            Stepper::Newmark(_) | Stepper::Statics(_) => true,
            Stepper::Verlet | Stepper::Still => false,
        }
    }

    /// Does no step move points?
    pub fn rests(self) -> bool {
        !self.has_inertia() && !self.solves()
    }
}

/// Newmark's method (Newmark 1959): `u₁ = u₀ + Δt v₀ + Δt² ((½ − β) a₀ + β a₁)`, `v₁ = v₀ + Δt ((1 − γ) a₀ + γ a₁)`, with
/// `a₁` from the forces at the end of the step; with α below 0 from those before it, too (Hilber, Hughes & Taylor 1977):
/// `ρ a₁ = (1 + α) f₁ − α f₀`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Newmark {
    pub beta: f64,
    pub gamma: f64,
    /// 0, or from −1/3 on, with the β and γ of [`Newmark::hht`].
    pub alpha: f64,
    /// How the linear equations of Newton's method are solved.
    pub solver: Solver,
    /// Residual force over loads, reactions, inertia `m a` and `m v/Δt`.
    pub tolerance: f64,
    /// Of conjugate gradients, per solution.
    pub most_iterations: usize,
}

impl Newmark {
    /// The method of H. M. Hilber, T. J. R. Hughes and R. L. Taylor (1977, Improved numerical dissipation for time integration algorithms
    /// in structural dynamics, Earthquake Eng. Struct. Dyn. 5, 283–292): `β = (1 − α)²/4`, `γ = ½ − α`. Of second order for
    /// `−1/3 ≤ α ≤ 0`; what is fast beside the step it damps, by `(1 + α)/(1 − α)` a step in the limit (α = 0: not at all), and what is
    /// slow nearly not.
    pub fn hht(alpha: f64) -> Self {
        Newmark {
            beta: 0.25 * (1.0 - alpha).powi(2),
            gamma: 0.5 - alpha,
            alpha,
            ..Newmark::default()
        }
    }
}

impl Default for Newmark {
    /// The trapezoidal rule, β = ¼ and γ = ½: second order, and no energy is lost.
    fn default() -> Self {
        Newmark {
            beta: 0.25,
            gamma: 0.5,
            alpha: 0.0,
            solver: Solver::Auto,
            tolerance: 1e-10,
            most_iterations: 100_000,
        }
    }
}

/// How equilibrium is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statics {
    pub method: Method,
    pub control: Control,
    pub solver: Solver,
    /// Residual force over loads and reactions.
    pub tolerance: f64,
    /// Of conjugate gradients or relaxation, per solution.
    pub most_iterations: usize,
    /// t is a time, of which every increment takes its part; false: it is the factor of the load.
    pub timed: bool,
    /// Increments are cycles of load; `None`: they are increments of load.
    pub cycles: Option<Cycles>,
}

/// Cycles of a load whose greatest is what the conditions say, and whose least is R times that. An increment is as many cycles as it takes
/// until some bonds are worn out (Silling & Askari 2014).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycles {
    /// R.
    pub load_ratio: f64,
    /// So many bonds are worn out in an increment, and those that last no longer.
    pub bonds: usize,
    /// Number of cycles at which all ends; ∞: never.
    pub most: f64,
}

impl Default for Statics {
    /// The linear solution to 1e-10.
    fn default() -> Self {
        Statics {
            method: Method::Linear,
            control: Control::Load,
            solver: Solver::Auto,
            tolerance: 1e-10,
            most_iterations: 100_000,
            timed: false,
            cycles: None,
        }
    }
}

/// How an equilibrium is found. What others ask of a method stands here alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The equations linear about the reference.
    Linear,
    /// Newton's method: large deformation.
    Newton,
    /// Adaptive dynamic relaxation: contact, and what Newton's method does not find.
    Relaxation,
    /// The fast inertial relaxation engine: as relaxation, from states far from equilibrium, too.
    Fire,
}

impl Method {
    pub const ALL: [Method; 4] = [
        Method::Linear,
        Method::Newton,
        Method::Relaxation,
        Method::Fire,
    ];

    /// Lower case with underscores, as in decks; and in a few words.
    fn told(self) -> [&'static str; 2] {
        match self {
            Method::Linear => ["linear", "linear equations about the reference"],
            Method::Newton => ["newton", "Newton's method"],
            Method::Relaxation => ["relaxation", "adaptive dynamic relaxation"],
            Method::Fire => ["fire", "FIRE (fast inertial relaxation engine)"],
        }
    }

    pub fn name(self) -> &'static str {
        self.told()[0]
    }

    /// In a few words.
    pub fn words(self) -> &'static str {
        self.told()[1]
    }

    /// The customary tolerance: residual force over loads and reactions.
    pub fn tolerance(self) -> f64 {
        match self {
            Method::Linear => 1e-10,
            Method::Newton => 1e-8,
            Method::Relaxation | Method::Fire => 1e-6,
        }
    }

    /// Does it go downhill by forces alone, without equations? Contact, friction and rigid bodies need no tangent then, and the energy must have a
    /// meaning.
    pub fn minimizes(self) -> bool {
        match self {
            Method::Linear | Method::Newton => false,
            Method::Relaxation | Method::Fire => true,
        }
    }
}

/// What says how far an increment goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// t, of which loads are functions.
    Load,
    /// The next bond: an increment ends where it is at its critical stretch, and the next one begins without it. t is the factor of
    /// loads that are proportional to it, and may fall.
    SequentiallyLinear,
    /// So much growth of the stretch of the bonds that open fastest (number); t is the factor of loads that are proportional to it, and may fall.
    IndirectDisplacement(f64),
    /// So far points go, the root of the mean square of all (length); t as above.
    ArcLength(f64),
}

impl Control {
    /// Is the load an unknown of its own?
    pub fn follows_a_path(self) -> bool {
        match self {
            Control::IndirectDisplacement(_) | Control::ArcLength(_) => true,
            Control::Load | Control::SequentiallyLinear => false,
        }
    }
}

/// How linear equations are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// Factors where they are small, else conjugate gradients.
    Auto,
    Direct,
    ConjugateGradients,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum TimeStep {
    Fixed(f64),
    /// Fraction of the estimated stability limit.
    Fraction(f64),
    /// The engine chooses: 80 % of the limit for peridynamic points; for atoms a tenth of it (a thirtieth of the shortest
    /// period), and less where they are fast.
    #[default]
    Auto,
}
