//! The linear equations of a step of Newton's method: factored, assembled, or by sweeps.

use super::problem::Problem;
use super::state::StaticState;
use super::system::Equations;
use super::tried::{Inertia, Onward};
use super::whole::{told, whole_support};
use crate::boundary_condition::load::Load;
use crate::boundary_condition::rigid::Wrench;
use crate::error::SolveError;
use crate::spec::LinearBody;
use crate::statics::{
    self, Assembled, Block, Direct, Goal, LinearOperator, Shifted, Solved, Support, Swept,
};

impl<const D: usize> Problem<'_, D> {
    /// The linear body about the displacements of now, points that touch too; on the first rank.
    pub(super) fn tangent_now(&mut self) -> Option<LinearBody<D>> {
        let system = &mut *self.system;
        system.refresh_images();
        let (bonds, contact) = (system.interaction.as_mut(), system.contact.as_ref());
        statics::linear_body_touching(&system.body, bonds, contact, &system.u)
    }

    /// What rigid_bodies and forces on points resist with at points.
    fn pushed(&self) -> Vec<Block<D>> {
        let system = &*self.system;
        let mut sum = vec![[[0.0; D]; D]; system.body.len()];
        for rigid_body in &system.applied.rigid {
            rigid_body.each_tangent(&system.body, &system.u, |slot, _, block| {
                for a in 0..D {
                    for b in 0..D {
                        sum[slot][a][b] += block[a][b];
                    }
                }
            });
        }
        system.applied.each_stiffness(|slot, block| {
            for a in 0..D {
                for b in 0..D {
                    sum[slot][a][b] += system.body.volume().at(slot) * block[a][b];
                }
            }
        });
        system.body.by_id(|i| sum[i])
    }

    /// The equations of a step of Newton's method.
    pub(super) fn equations(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
        inertia: Option<&Inertia<D>>,
    ) -> Result<Equations<D>, SolveError> {
        let border = |model: &Self| match inertia {
            Some(inertia) if !inertia.bodies.is_empty() => Some(model.border(inertia)),
            Some(_) | None => None,
        };
        let acceleration = inertia.map_or(0.0, |m| m.acceleration);
        let factored = self.system.factored(state.options, support);
        let kept = state.step.take();
        if let Some(kept) = kept.filter(|k| factored && k.acceleration == acceleration) {
            return Ok(Equations { old: true, ..kept });
        }
        let reference = self.system.at_peace() && self.system.forgets();
        let coupled = inertia.and_then(|m| m.coupled.as_ref());
        let swept = !factored && reference && self.system.contact.is_none() && coupled.is_none();
        let added = self.added(inertia);
        let mut made = Equations {
            swept,
            border: border(self),
            acceleration,
            added,
            ..Equations::none()
        };
        if swept {
            return Ok(made);
        }
        let of_blocks = self.sums.any(!made.added.is_empty());
        let blocks = made.added.as_flattened().as_flattened().to_vec();
        let added = self.system.body.whole(D * D, blocks);
        let support = whole_support(&self.system.body, support);
        let tangent = self.tangent_now();
        let found = added
            .zip(support)
            .zip(tangent)
            .map(|((added, support), body)| {
                if of_blocks {
                    made.added = { added.as_chunks::<D>().0.chunks_exact(D) }
                        .map(|rows| crate::array::from_fn(|a| rows[a]))
                        .collect();
                }
                self.assemble(&mut made, body, &support, inertia, factored)
            });
        told(&self.system.body, found.transpose())?;
        made.unstable = self.sums.any(made.unstable);
        made.factored = self.sums.any(made.factors.is_some());
        Ok(made)
    }

    /// The matrix of the points of all ranks, and its factors.
    fn assemble(
        &self,
        made: &mut Equations<D>,
        body: LinearBody<D>,
        support: &Support<D>,
        inertia: Option<&Inertia<D>>,
        factored: bool,
    ) -> Result<(), SolveError> {
        // conjugate gradients seek the step in the symmetric part of a tangent that has another: forces decide where it ends
        let skew = !factored && body.soundness().asymmetry > statics::SYMMETRIC;
        let mut body = if skew { body.symmetric() } else { body };
        let coupled = inertia.and_then(|m| m.coupled.as_ref()?.whole());
        if let (Some(masses), Some(inertia)) = (coupled, inertia) {
            let (sum, own) = masses.with(&body, inertia.weight * inertia.acceleration);
            body = sum;
            for (added, own) in made.added.iter_mut().zip(own) {
                for a in 0..D {
                    for b in 0..D {
                        added[a][b] += own[a][b];
                    }
                }
            }
        }
        // nothing but inertia resists what has lost all that held it
        let resisted = match inertia {
            None => Some(support.resisted(&body)),
            Some(_) => None,
        };
        let any = resisted.as_ref().is_none_or(|s| s.unknowns() > 0);
        if factored && any {
            let support = resisted.as_ref().unwrap_or(support);
            let factors = match made.added.is_empty() {
                false => Direct::against(&body, support, &made.added),
                true => Direct::new(&body, support, 0.0),
            };
            made.factors = Some(match factors {
                Err(SolveError::Indefinite { .. })
                    if !self.system.at_peace() && inertia.is_none() =>
                {
                    made.unstable = true;
                    downhill(&body, support)?
                }
                factors => factors?,
            });
        }
        (made.body, made.resisted) = (Some(body), resisted);
        Ok(())
    }

    /// The step that leaves nothing of residuals of points and bodies, and iterations that it took.
    pub(super) fn step_of(
        &mut self,
        equations: &Equations<D>,
        support: &Support<D>,
        r: &[[f64; D]],
        rest: &[Wrench],
        goal: Goal,
    ) -> Result<(Onward<D>, usize), SolveError> {
        let (mut x, mut iterations) = (vec![[0.0; D]; r.len()], 0);
        let mut solve = |b: &[[f64; D]], x: &mut [[f64; D]]| {
            // conjugate gradients need something to seek
            let solved = match equations.swept {
                true if self.sums.norm(b) == 0.0 => Solved::default(),
                true => {
                    let system = &mut *self.system;
                    let bonds = system.interaction.as_mut();
                    let operator = &mut Swept::new(&system.body, bonds, &self.sums);
                    let added = &equations.added;
                    statics::cg::solve(&mut Shifted { operator, added }, support, b, x, goal)?
                }
                false => self.solve_whole((support, b), x, |support, b, x| {
                    equations.solve(support, b, x, goal)
                })?,
            };
            iterations += solved.iterations;
            Ok::<(), SolveError>(())
        };
        solve(r, &mut x)?;
        let (mut bodies, mut far) = (vec![], 0.0);
        if let Some(border) = &equations.border {
            let mut z = vec![];
            for column in &border.columns {
                let mut masked = column.clone();
                support.mask(&mut masked);
                let mut x = vec![[0.0; D]; r.len()];
                solve(&masked, &mut x)?;
                z.push(x);
            }
            (bodies, far) = border.solve((&mut x, &self.sums), &z, rest)?;
        }
        Ok((Onward { x, bodies, far }, iterations))
    }

    /// What inertia and rigid_bodies add to the stiffness at points; empty: nothing.
    fn added(&self, inertia: Option<&Inertia<D>>) -> Vec<Block<D>> {
        let Some(inertia) = inertia else {
            // rigid_bodies have no place in equilibrium by tangents
            let any = self.system.applied.loads.iter().any(Load::has_stiffness);
            return if any { self.pushed() } else { vec![] };
        };
        let both = inertia.added.iter().zip(self.pushed());
        both.map(|(mass, mut block)| {
            for a in 0..D {
                block[a][a] += mass;
            }
            block
        })
        .collect()
    }
}

/// Factors of a tangent that is not positive definite with enough of the masses added that steps lower the energy.
fn downhill<const D: usize>(
    body: &LinearBody<D>,
    support: &Support<D>,
) -> Result<Direct<D>, SolveError> {
    let stiff = Assembled(body).diagonal();
    let stiff: f64 = stiff
        .iter()
        .map(|k| (0..D).map(|a| k[a][a]).sum::<f64>())
        .sum();
    let mass: f64 = body
        .volume
        .iter()
        .zip(&body.density)
        .map(|(v, rho)| v * rho)
        .sum();
    let typical = stiff / (D as f64 * mass);
    let mut shift = 1e-2 * typical;
    loop {
        match Direct::new(body, support, shift) {
            Err(SolveError::Indefinite { .. }) if shift < 10.0 * typical => shift *= 4.0,
            made => return made,
        }
    }
}
