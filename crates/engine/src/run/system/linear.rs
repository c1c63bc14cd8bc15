//! The linear body: what a linear solution means, and whether the reference is without forces. Such a solution stands for the forces `−K u` and the
//! energy `½ uᵀK u` of the linear body about the reference, not for those of the nonlinear law at its displacements, in which it is no equilibrium.
//! Near incompressibility the two differ by much: the small rotations of a linear solution change volumes in second order.
//!
//! Where bonds pull in the reference, there are `f₀ − K u` and `E₀ − f₀·u + ½ uᵀK u`: what the law says to first and second order. Points and bonds one
//! by one have there what the law says at the displacements.

use super::System;
use super::stressed::Stressed;
use crate::body::{Field, view, view_mut, zeros};
use crate::constitutive::Laws;
use crate::interaction::{PointEnergies, Sweep};
use crate::law::descriptor::Memory;
use crate::run::equilibrium::whole::unknowns;
use crate::spec::{LinearBody, Solver, Statics};
use crate::statics::operator::SMALL;
use crate::statics::{self, Support};

/// Unknowns up to which the equations are factored, per dimension.
const DIRECT: [usize; 3] = [usize::MAX, 60_000, 12_000];

/// Of what was just looked for.
const FOUND: &str = "it was just found";

impl<const D: usize> System<D> {
    /// Does the state stand for the linear body about a reference without forces, point by point?
    pub fn is_linear(&self) -> bool {
        self.regime.linear && self.at_peace()
    }

    /// Do forces and energies of now stand for the linear body? Where bonds pull in the reference, law and linear body are one there, and the law's need
    /// no tangent.
    pub fn left_linearly(&self) -> bool {
        let moved = || self.u.iter().flat_map(|c| c.iter()).any(|u| *u != 0.0);
        self.regime.linear && (self.at_peace() || self.body.exchange().any(moved()))
    }

    /// Does the reference carry no force, so that sweeps at tiny displacements are its tangent?
    pub fn at_peace(&self) -> bool {
        let mut named = self.constitutive.named();
        let pulls = named.any(|n| n.pulls());
        !pulls && !matches!(self.constitutive.first().laws, Laws::Atoms(_)) && !self.expands()
    }

    /// Has no law forces at the reference, and another stiffness there than here, by what it remembers? What fades has none: it is let back to there.
    pub fn forgets(&self) -> bool {
        let mut named = self.constitutive.named();
        named.all(|n| n.memory().0 == Memory::Nothing || n.fades())
    }

    /// Are equations with these unknowns factored?
    pub fn factored(&self, options: Statics, support: &Support<D>) -> bool {
        if self.interaction.asymmetry() > statics::SYMMETRIC {
            return true;
        }
        match options.solver {
            Solver::Direct => true,
            Solver::ConjugateGradients => false,
            Solver::Auto => unknowns(&self.body, support) <= DIRECT[D - 1],
        }
    }

    /// The displacements of now made so small that laws without forces at rest are linear to the last digit, as in
    /// [`Swept`](crate::statics::Swept), and by which factor: a power of two, which rounds nothing.
    pub fn made_small(&self) -> (Field<D>, f64) {
        let slots = || self.body.slots().iter().map(|s| *s as usize);
        let peak = (0..D).flat_map(|a| slots().map(move |i| (a, i)));
        let peak = self
            .body
            .most(peak.fold(0.0f64, |m, (a, i)| m.max(self.u[a][i].abs())));
        let small = match peak > 0.0 {
            true => libm::exp2(libm::log2(SMALL * self.body.spacing() / peak).floor()),
            false => 1.0,
        };
        let mut u = self.body.at_rest();
        let made = |_, i: usize| crate::array::from_fn(|a| small * self.u[a][i]);
        self.body.set_vectors(&mut u, made);
        (u, small)
    }

    /// Energies and dilatation of all points now: of the linear body (quadratic, linear) where that is what the state stands for.
    pub fn seen_now(&self) -> PointEnergies {
        let mut seen = PointEnergies::default();
        match self.is_linear() {
            true => self.see_linear(&mut seen),
            false => self.interaction.observe(
                &self.body,
                view(&self.u),
                &mut seen.for_slots(self.body.len()),
            ),
        }
        seen
    }

    fn see_linear(&self, seen: &mut PointEnergies) {
        let (u, small) = self.made_small();
        self.interaction
            .observe(&self.body, view(&u), &mut seen.for_slots(self.body.len()));
        for energy in seen.strain.iter_mut().chain(&mut seen.repulsion) {
            *energy = *energy / small / small;
        }
        seen.dilatation.iter_mut().for_each(|x| *x /= small);
    }

    /// The linear body about a reference in which bonds pull, found once as long as no bond breaks.
    pub fn stressed(&mut self) -> &Stressed<D> {
        let found = self.stressed.take().unwrap_or_else(|| {
            let rest = self.body.at_rest();
            let mut forces = zeros(self.body.len());
            let out = view_mut(&mut forces);
            self.interaction
                .forces(&self.body, view(&rest), out, Sweep::Hold, None);
            Stressed {
                energy: self.interaction.energy(&self.body, view(&rest)),
                forces: self.body.values(&forces),
                tangent: statics::linear_body(&self.body, self.interaction.as_mut(), &rest),
            }
        });
        self.stressed.insert(found)
    }

    /// `E₀ − f₀·u + ½ uᵀK u` (energy); E₀ and f₀ are 0 where nothing pulls in the reference.
    pub fn quadratic_energy(&mut self) -> [f64; 2] {
        if !self.at_peace() {
            self.stressed();
            let stressed = self.stressed.as_ref().expect(FOUND);
            return stressed.energy_at(&self.body, &self.body.values(&self.u));
        }
        let (u, small) = self.made_small();
        let energy = self.interaction.energy(&self.body, view(&u));
        energy.map(|e| e / small / small)
    }

    /// Forces `−K u` of bonds in place of those of the law; no loads.
    pub fn linear_forces(&mut self) {
        if !self.at_peace() {
            self.stressed();
            let stressed = self.stressed.as_ref().expect(FOUND);
            let forces = stressed.forces_at(&self.body, &self.body.values(&self.u));
            for (f, &s) in forces.iter().zip(self.body.slots()) {
                for a in 0..D {
                    self.f[a][s as usize] = f[a];
                }
            }
            return;
        }
        let (u, small) = self.made_small();
        self.interaction.forces(
            &self.body,
            view(&u),
            view_mut(&mut self.f),
            Sweep::Hold,
            None,
        );
        for &s in self.body.slots() {
            for a in 0..D {
                self.f[a][s as usize] /= small;
            }
        }
        if let Some(mut seen) = self.watch.energies.take() {
            self.see_linear(&mut seen);
            self.watch.energies = Some(seen);
        }
    }

    /// The linear body about the displacements of now, on the first rank.
    pub fn linear_now(&mut self) -> Option<LinearBody<D>> {
        self.refresh_images();
        let made = statics::linear_body(&self.body, self.interaction.as_mut(), &self.u)?;
        let masses = self.inertia.as_ref().and_then(|i| i.masses.whole());
        Some(LinearBody {
            mass: masses.map(|masses| masses.matrix().clone()),
            ..made
        })
    }
}
