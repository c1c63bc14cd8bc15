//! Energies over time.

use crate::state::words;

/// Energies (energy; volume-weighted sums) whose balance
/// `kinetic + strain + contact + released − made + dissipated + numerical − work = const` closes up to the error of the time step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Ledger {
    pub kinetic: f64,
    pub strain: f64,
    pub contact: f64,
    /// Energy stored in bonds at the moment they broke, summed since the start.
    pub released: f64,
    /// Energy that points hold more without the bonds that broke than with them, at that moment, summed since the start: breaking by a limit of
    /// stretch makes it where a law asks for sums of a family, as its dilatation.
    pub made: f64,
    /// Work done by damping on its surroundings.
    pub dissipated: f64,
    /// Taken by an implicit method: the work of all forces by the trapezoidal rule less the kinetic energy that points gained. 0 of Newmark's
    /// with β = ¼ and γ = ½, and of explicit steps, which take none by themselves.
    pub numerical: f64,
    /// Work done on the body by body forces, tractions and prescribed motion since the start.
    pub work_boundary_conditions: f64,
    /// Work done on the body by rigid_bodies since the start.
    pub work_rigid_bodies: f64,
    /// Energy at the start.
    pub initial: f64,
}

words!([] Ledger {
    kinetic: f64,
    strain: f64,
    contact: f64,
    released: f64,
    made: f64,
    dissipated: f64,
    numerical: f64,
    work_boundary_conditions: f64,
    work_rigid_bodies: f64,
    initial: f64,
});

impl Ledger {
    /// All that the body has and has given away, whatever it came from.
    pub fn held(&self) -> f64 {
        self.kinetic + self.strain + self.contact + self.released + self.dissipated + self.numerical
    }

    /// What of the balance must stay as it is.
    pub fn base(&self) -> f64 {
        self.held() - self.made - self.work_boundary_conditions - self.work_rigid_bodies
    }

    /// What the balance misses: 0 in exact time.
    pub fn residual(&self) -> f64 {
        self.base() - self.initial
    }
}
