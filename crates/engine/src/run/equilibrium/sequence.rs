//! Equilibria in the order in which bonds break: the load is what the next bond bears, however little that is (sequentially linear
//! analysis: E. Schlangen and J. G. M. van Mier 1992, Simple lattice model for numerical simulation of fracture of concrete materials
//! and structures, Mater. Struct. 25, 534–542; J. G. Rots 2001, Sequentially linear continuum model for concrete fracture).
//!
//! The body is linear about the reference and all that loads it is proportional to one factor λ, which is t: `u = λ u¹`. A bond whose
//! stretch is `s¹` under the load 1 reaches its critical one at `λ = s_c/s¹`. The lowest of these factors is the next equilibrium;
//! its bonds are cut, and the next factor may be lower, with both load and displacement (snap-back).
//!
//! A bond that breaks by the stress of its ends has no critical stretch, but `σ = λ σ¹` is as linear: it lets go at `λ = σ_c/σ¹` and the stretch
//! that it has there. One that breaks by the work on it, `½ (T_i − T_j)·η = λ² w¹` from the reference, lets go at `λ = √(w_c/w¹)`. (Of a bond that knows its own
//! stretch alone that is its work whatever broke before; of others it is that of the load on the body as it is now.)
//!
//! What the loads do between two such equilibria: while the bond lets go slowly at its critical stretch, displacements and forces are
//! linear in the force that is left in it (the equations are), from `λ u¹` to `λ' u'¹` of the body without it, `λ' = s_c/s'¹` at its
//! two ends; then the body is elastic. So the trapezoidal rule over both parts is exact, and the energy that is released is that which the
//! bond held.

use super::held::Held;
use super::problem::Problem;
use super::state::{Critical, Sequence, StaticState};
use crate::body::{Field, view};
use crate::error::{BuildError, SolveError};
use crate::interaction::critical_stretch;
use crate::interaction::{BondStatus, history};
use crate::run::system::System;
use crate::run::traits;
use crate::spec::CrackKind;
use crate::statics::Solved;

/// Factors that differ by this part are of bonds that break together.
const TOGETHER: f64 = 1e-9;
/// Bonds whose critical stretch is beyond the largest one of the body by this factor do not count: their points are at rest.
const AT_REST: f64 = 1e-12;
/// Deviation from proportional loads that is round-off.
const ROUND_OFF: f64 = 1e-9;

/// Linear stretch of a bond.
fn stretch<const D: usize>(i: usize, j: usize, xi: &[f64; D], u: &Field<D>) -> f64 {
    let square: f64 = xi.iter().map(|c| c * c).sum();
    let longer: f64 = (0..D).map(|a| (u[a][j] - u[a][i]) * xi[a]).sum();
    longer / square
}

impl<const D: usize> System<D> {
    /// Can bonds be broken one after the other?
    pub(in crate::run) fn check_sequence(&mut self) -> Result<(), BuildError> {
        self.check_factor()?;
        self.learn_strength();
        let between = self.interaction.criticals_between();
        let mut all = [self.criticals()].into_iter().chain(between).flatten();
        let breaks = all.any(|e| e > 0.0 && e < history::NEVER);
        let rest = self.body.at_rest();
        let stress = self.interaction.stress_borne(&self.body, view(&rest));
        let works = (self.interaction).work_borne(&self.body, view(&rest), &mut |_, _, _, _| {});
        let breaks = breaks || works || stress.is_some();
        if !self.body.exchange().any(breaks) {
            return Err(BuildError::missing(
                "materials[0].fracture",
                "no bond of this body breaks: nothing says how far the load goes",
            )
            .help("give a material a fracture, or leave control out"));
        }
        Ok(())
    }

    /// Has the load a factor that is sought, in a body that begins without forces?
    pub(super) fn check_factor(&mut self) -> Result<(), BuildError> {
        let proportional = self.loads_are_proportional();
        traits::of_control(self, proportional)
    }

    /// Critical values of `e` by slot, of copies too; none where bonds do not break.
    pub(super) fn criticals(&self) -> Vec<f64> {
        let mut out = vec![];
        let bonds = &self.interaction;
        if bonds.read_column(&self.body, view(&self.u), history::ELONGATION, &mut out) {
            self.body.exchange().fill(&mut out);
        }
        out
    }

    fn loads_are_proportional(&mut self) -> bool {
        let trial = self.clock.trial();
        let mut at = |t: f64| {
            let mut u = self.body.at_rest();
            self.prescribed.place(&mut u, t);
            let f = self.applied.external(&self.body, &u, t, trial);
            [u, f]
        };
        let [none, half, whole] = [0.0, 0.5, 1.0].map(&mut at);
        let mut deviates = false;
        for (of, a) in (0..2).flat_map(|of| (0..D).map(move |a| (of, a))) {
            // absent sites are far away
            let all = self.body.slots().iter().map(|s| whole[of][a][*s as usize]);
            let most = self.body.most(all.fold(0.0f64, |m, x| m.max(x.abs())));
            deviates |= self.body.slots().iter().any(|s| {
                let [x, y, z] = [&none, &half, &whole].map(|w| w[of][a][*s as usize]);
                !(x.abs() <= ROUND_OFF * most && (y - 0.5 * z).abs() <= ROUND_OFF * most)
            });
        }
        !self.body.exchange().any(deviates)
    }
}

impl<const D: usize> Problem<'_, D> {
    /// Bonds that broke are cut; then on to the equilibrium in which the next ones are at their critical stretch.
    pub(in crate::run) fn settle_sequence(
        &mut self,
        state: &mut StaticState<D>,
    ) -> Result<Solved, SolveError> {
        self.system.tell_toughness();
        let accounts = self.system.accounts.clone();
        let last = state.sequence.take();
        let mut whole = vec![];
        if let Some(last) = &last {
            self.system.interaction.read_column(
                &self.system.body,
                view(&self.system.u),
                history::WHOLE,
                &mut whole,
            );
            self.break_bonds_of(&last.next);
            state.forget();
        }
        let found = self.next_equilibrium(state, last.as_ref());
        if found.is_err() {
            if last.is_some() {
                self.system
                    .interaction
                    .write_column(&self.system.body, history::WHOLE, &whole);
            }
            self.system.accounts = accounts;
            state.sequence = last;
            state.forget();
        }
        found
    }

    fn break_bonds_of(&mut self, bonds: &[Critical<D>]) {
        let system = &mut *self.system;
        let held: f64 = system.quadratic_energy().iter().sum();
        let near = 1e-6 * system.body.spacing();
        let at = |slot: usize| -> [f64; D] {
            let x = system.body.home(slot);
            crate::array::from_fn(|a| x[a])
        };
        // from either end, through a periodic face as well
        let along =
            |x: [f64; D], xi: [f64; D], by: f64| crate::array::from_fn(|a| x[a] + by * xi[a]);
        let from = |slot: usize, xi: [f64; D], by: f64| [at(slot), along(at(slot), xi, by)];
        let own = bonds.iter();
        let own: Vec<[[f64; D]; 2]> = own
            .flat_map(|b| [from(b.i, b.xi, 1.0), from(b.j, b.xi, -1.0)])
            .collect();
        // those of all ranks: a bond across a border is told by one of them
        let ends = system
            .body
            .all_of(own.as_flattened().as_flattened())
            .concat();
        let ends = ends.as_chunks::<D>().0;
        let same = |x: &[f64; D], y: &[f64; D]| (0..D).all(|a| (x[a] - y[a]).abs() < near);
        let is = |from: [f64; D], to: [f64; D]| {
            { ends.chunks_exact(2) }.any(|e| {
                (same(&e[0], &from) && same(&e[1], &to)) || (same(&e[1], &from) && same(&e[0], &to))
            })
        };
        system.accounts.swept.broken +=
            system.interaction.cut(&system.body, CrackKind::Broken, &is);
        let kept: f64 = system.quadratic_energy().iter().sum();
        system.accounts.released.book(held - kept);
    }

    fn next_equilibrium(
        &mut self,
        state: &mut StaticState<D>,
        last: Option<&Sequence<D>>,
    ) -> Result<Solved, SolveError> {
        let before = self.system.u.clone();
        // under the load 1
        self.system.clock.set(1.0);
        let Held { support, resting } = self.support_now(state.options)?;
        self.system.prescribed.place(&mut self.system.u, 1.0);
        let load = self.system.external();
        let b = self.system.body.per_point(&load);
        let mut x = self.system.body.values(&self.system.u);
        let solved = self.solve_about_reference(state, &support, &b, &mut x)?;
        self.system.set_values(&x);
        self.system.linear_forces();
        let (factor, next) = self.weakest()?;
        self.account_sequence(&before, last, factor);
        let f: Field<D> = crate::array::from_fn(|a| {
            let mut column = self.system.f[a].clone();
            column.iter_mut().for_each(|f| *f *= factor);
            column
        });
        for a in 0..D {
            for &s in self.system.body.slots() {
                self.system.u[a][s as usize] *= factor;
            }
        }
        // what nothing holds has no part in the load
        for n in resting {
            for a in 0..D {
                self.system.u[a][self.system.body.slots()[n] as usize] = x[n][a];
            }
        }
        self.system.refresh_images();
        self.system.f = f.clone();
        self.system.clock.set(factor);
        self.system.prescribed.place(&mut self.system.u, factor);
        self.system.other_forces(self.system.clock.trial());
        state.sequence = Some(Sequence { next, f, factor });
        Ok(solved)
    }

    /// The lowest factor of the load of now at which bonds are at their critical stretch, and which.
    fn weakest(&mut self) -> Result<(f64, Vec<Critical<D>>), SolveError> {
        let system = &mut *self.system;
        // linear to the last digit
        let (u, small) = system.made_small();
        let stress = system.interaction.stress_borne(&system.body, view(&u));
        let stress = stress.unwrap_or_default();
        let mut by_work = vec![];
        (system.interaction).work_borne(&system.body, view(&u), &mut |i, j, xi, part| {
            by_work.push((i, j, xi, part));
        });
        let system = &*self.system;
        let critical = system.criticals();
        let between = system.interaction.criticals_between();
        let limits = |i: usize, j: usize| -> [f64; 2] {
            if system.body.piece_of(i) == system.body.piece_of(j) {
                // bodies whose bonds never break have no such column
                // 0: a body beside others, without critical stretches of its own
                let own = |s: usize| critical.get(s).copied().filter(|e| *e != 0.0);
                let of = |s: usize| own(s).unwrap_or(history::NEVER);
                return [of(i), of(j)];
            }
            let ends = between.iter().map(|of| [of[i], of[j]]);
            ends.into_iter()
                .find(|ends| !ends.iter().any(|e| e.is_nan()))
                .unwrap_or([history::NEVER; 2])
        };
        let mut all = vec![];
        let mut most = 0.0f64;
        // bodies whose bonds break by work
        let mut work = vec![false; system.body.pieces().len().max(1)];
        for (i, j, xi, part) in by_work {
            if system.body.piece_of(i) == system.body.piece_of(j) {
                work[system.body.piece_of(i)] = true;
            }
            let s = stretch(i, j, &xi, &system.u);
            most = most.max(s.abs());
            if s > 0.0 && part > 0.0 {
                let factor = small / part.sqrt();
                let stretch = factor * s;
                all.push((factor, Critical { i, j, xi, stretch }));
            }
        }
        let work: Vec<bool> = work.into_iter().map(|own| self.sums.any(own)).collect();
        let forced = self.sums.any(!stress.is_empty()) || work.contains(&true);
        system
            .interaction
            .each_bond(&system.body, &mut |i, j, xi, state| {
                if state != BondStatus::Whole {
                    return;
                }
                let whole_body = system.body.piece_of(i) == system.body.piece_of(j);
                if whole_body && work[system.body.piece_of(i)] {
                    return;
                }
                let [a, b] = [i, j].map(|s| stress.get(s).copied().unwrap_or(f64::NAN));
                if whole_body && !(a + b).is_nan() {
                    let s = stretch(i, j, &xi, &system.u);
                    most = most.max(s.abs());
                    let spared = |s: usize| critical.get(s) == Some(&history::NEVER);
                    if a + b > 0.0 && !spared(i) && !spared(j) {
                        let factor = 2.0 * small / (a + b);
                        let stretch = factor * s;
                        let bond = Critical { i, j, xi, stretch };
                        all.push((factor, bond));
                    }
                    return;
                }
                let limit = system.interaction.bond_limit([i, j], &xi, limits(i, j));
                if !limit.is_finite() {
                    return;
                }
                let s = stretch(i, j, &xi, &system.u);
                most = most.max(s.abs());
                if s > 0.0 {
                    let bond = Critical {
                        i,
                        j,
                        xi,
                        stretch: critical_stretch(limit),
                    };
                    all.push((bond.stretch / s, bond));
                }
            });
        let least = all.iter().map(|(factor, _)| *factor);
        let least = -self.sums.most(-least.fold(f64::INFINITY, f64::min));
        let largest = all.iter().map(|(_, b)| b.stretch).fold(0.0, f64::max);
        let [largest, most] = [largest, most].map(|own| self.sums.most(own));
        // where stress or work is all that there is of a body that moves as a whole it is round-off
        let peak = { system.body.slots().iter() }
            .flat_map(|s| system.u.iter().map(|c| c[*s as usize].abs()))
            .fold(0.0f64, f64::max);
        let peak = self.sums.most(peak);
        let rests = forced && !(most * system.body.spacing() > AT_REST * peak);
        if rests || !(least.is_finite() && least * most > AT_REST * largest) {
            return Err(SolveError::NothingBreaks);
        }
        let together = all
            .into_iter()
            .filter(|(f, _)| *f <= least * (1.0 + TOGETHER));
        Ok((least, together.map(|(_, bond)| bond).collect()))
    }

    /// Work of loads and reactions from the last equilibrium to that at `factor`; displacements and forces are those under the load 1.
    fn account_sequence(&mut self, u: &Field<D>, last: Option<&Sequence<D>>, factor: f64) {
        let system = &mut *self.system;
        type At<'a> = &'a (dyn Fn(usize, usize) -> f64 + Sync);
        let dot = |f: At<'_>, x: At<'_>| {
            let slots = system.body.slots();
            let each = |n: usize| {
                let i = slots[n] as usize;
                let along: f64 = (0..D).map(|a| f(a, i) * x(a, i)).sum();
                [system.body.volume().at(i) * along]
            };
            self.sums.each(slots.len(), each)[0]
        };
        // what acts from outside is what bonds pull against
        let stiffness = -dot(&|a, i| system.f[a][i], &|a, i| system.u[a][i]);
        let mut work = 0.0;
        let mut from = 0.0;
        if let Some(last) = last {
            let each = last
                .next
                .iter()
                .map(|b| b.stretch / stretch(b.i, b.j, &b.xi, &system.u));
            let mean = system.body.sum(each) / system.body.count(last.next.len() as u64) as f64;
            // where the ends of a bond come nearer to each other under the load without it, it lets go at the load that it had
            from = match mean > 0.0 && mean.is_finite() {
                true => mean,
                false => last.factor,
            };
            work -= 0.5
                * dot(&|a, i| last.f[a][i] + from * system.f[a][i], &|a, i| {
                    from * system.u[a][i] - u[a][i]
                });
        }
        work += 0.5 * (factor * factor - from * from) * stiffness;
        system.accounts.past.conditions += work;
    }
}
