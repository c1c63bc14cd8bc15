//! Energies over time.

/// Energies (energy; volume-weighted sums) whose balance
/// `kinetic + strain + contact + released + dissipated + numerical − work = const` closes up to the error of the time step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Ledger {
    pub kinetic: f64,
    pub strain: f64,
    pub contact: f64,
    /// Energy stored in bonds at the moment they broke, summed since the start.
    pub released: f64,
    /// Work done by damping on its surroundings.
    pub dissipated: f64,
    /// Taken by an implicit method: the work of all forces by the trapezoidal rule less the kinetic energy that points gained. 0 of Newmark's
    /// with β = ¼ and γ = ½, and of explicit steps, which take none by themselves.
    pub numerical: f64,
    /// Work done on the body by body forces, tractions and prescribed motion since the start.
    pub work_conditions: f64,
    /// Work done on the body by indenters since the start.
    pub work_indenter: f64,
    /// Energy at the start.
    pub initial: f64,
}

impl Ledger {
    /// What the balance misses: 0 in exact time.
    pub fn residual(&self) -> f64 {
        self.kinetic + self.strain + self.contact + self.released + self.dissipated + self.numerical
            - self.work_conditions
            - self.work_indenter
            - self.initial
    }
}
