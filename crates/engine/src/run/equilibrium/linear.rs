//! What a linear solution means: the forces `−K u` and the energy `½ uᵀK u` of the linear body about the reference, not those
//! of the nonlinear law at its displacements, in which it is no equilibrium. Near incompressibility the two differ by much: the
//! small rotations of a linear solution change volumes in second order.

use crate::body::Field;
use crate::interaction::{PointEnergies, Sweep};
use crate::run::model::Model;
use crate::spec::Method;
use crate::statics::operator::SMALL;

use super::state::StaticState;

impl<const D: usize> Model<D> {
    /// Does the state stand for the linear body about the reference? Laws that pull at rest (atoms) keep their own energy.
    pub(in crate::run) fn is_linear(&self) -> bool {
        let linear = |s: &StaticState<D>| s.options.method == Method::Linear;
        self.statics.as_ref().is_some_and(linear) && self.at_peace()
    }

    /// The displacements of now made so small that laws without forces at rest are linear to the last digit, as in
    /// [`Swept`](crate::statics::Swept), and by which factor: a power of two, which rounds nothing.
    pub(in crate::run) fn made_small(&self) -> (Field<D>, f64) {
        let slots = || self.body.slots.iter().map(|s| *s as usize);
        let peak = (0..D).flat_map(|a| slots().map(move |i| (a, i)));
        let peak = peak.fold(0.0f64, |m, (a, i)| m.max(self.u[a][i].abs()));
        let small = match peak > 0.0 {
            true => (SMALL * self.body.spacing / peak).log2().floor().exp2(),
            false => 1.0,
        };
        let mut u = self.body.at_rest();
        for i in slots() {
            for a in 0..D {
                u[a][i] = small * self.u[a][i];
            }
        }
        for c in &mut u {
            self.body.fill_images(c);
        }
        (u, small)
    }

    /// Energies and dilatation of all points now: of the linear body (quadratic, linear) where that is what the state stands for.
    pub(in crate::run) fn seen_now(&self) -> PointEnergies {
        let mut seen = PointEnergies::default();
        match self.is_linear() {
            true => self.see_linear(&mut seen),
            false => self.interaction.observe(&self.body, &self.u, &mut seen),
        }
        seen
    }

    fn see_linear(&self, seen: &mut PointEnergies) {
        let (u, small) = self.made_small();
        self.interaction.observe(&self.body, &u, seen);
        for energy in seen.strain.iter_mut().chain(&mut seen.repulsion) {
            *energy = *energy / small / small;
        }
        seen.dilatation.iter_mut().for_each(|x| *x /= small);
    }

    /// `½ uᵀK u` (energy).
    pub(in crate::run) fn quadratic_energy(&mut self) -> [f64; 2] {
        let (u, small) = self.made_small();
        let energy = self.interaction.energy(&self.body, &u);
        energy.map(|e| e / small / small)
    }

    /// Forces `−K u` of bonds in place of those of the law; no loads.
    pub(super) fn linear_forces(&mut self) {
        let (u, small) = self.made_small();
        self.interaction
            .forces(&self.body, &u, &mut self.f, Sweep::Hold, None);
        for &s in &self.body.slots {
            for a in 0..D {
                self.f[a][s as usize] /= small;
            }
        }
        if let Some(mut seen) = self.watched.take() {
            self.see_linear(&mut seen);
            self.watched = Some(seen);
        }
    }

    /// Breaks the bonds that a linear solution stretches too far: they release what the linear body loses. Forces are those of what is left.
    pub(super) fn tear_linear(&mut self) {
        let (broken, released) = (self.accounts.broken, self.accounts.released);
        let held: f64 = self.quadratic_energy().iter().sum();
        self.forces(true, self.clock.trial());
        if self.accounts.broken > broken {
            let kept: f64 = self.quadratic_energy().iter().sum();
            self.accounts.released = released;
            self.accounts.released.book(held - kept);
        }
        self.linear_forces();
        self.other_forces(self.clock.trial());
    }
}
