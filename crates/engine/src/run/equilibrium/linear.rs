//! What breaks in a linear solution.

use super::problem::Problem;

impl<const D: usize> Problem<'_, D> {
    /// Breaks the bonds that a linear solution stretches too far: they release what the linear body loses. Forces are those of what is left.
    pub(super) fn tear_linear(&mut self) {
        let before = self.system.accounts.swept.clone();
        let held: f64 = self.system.quadratic_energy().iter().sum();
        self.system.forces(true, self.system.clock.trial());
        let swept = &mut self.system.accounts.swept;
        if self.sums.any(swept.broken > before.broken) {
            (swept.lost, swept.made) = (before.lost, before.made);
            self.system.stressed = None;
            let kept: f64 = self.system.quadratic_energy().iter().sum();
            self.system.accounts.released.book(held - kept);
        }
        self.system.linear_forces();
        self.system.other_forces(self.system.clock.trial());
    }
}
