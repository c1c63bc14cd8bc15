//! What a stepper says of the states that it leads through: the one place where others ask.

/// What states mean.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::run) struct Regime {
    /// Every state is an equilibrium, and nothing has inertia.
    pub equilibrium: bool,
    /// It stands for the linear body about the reference, as far as that is without forces.
    pub linear: bool,
    /// A step is solved for with the forces at its end: none is kicked, and the trapezoidal rule counts the work.
    pub implicit: bool,
    /// t is a factor of the load that may fall.
    pub load_may_fall: bool,
    /// Steps are cycles of load.
    pub cycles: bool,
}
