//! Implicit steps and steady values: Newton's method with conjugate gradients.

use super::{Diffusion, Places, Rows, Touching};
use crate::body::Body;
use crate::error::SolveError;
use crate::statics::{Goal, LinearOperator, Sums, Support, cg};

/// Rounds of Newton's method; radiation alone needs more than one.
const ROUNDS: usize = 50;
/// Of conjugate gradients, per round.
const ITERATIONS: usize = 100_000;
/// Residual over what its terms are made of that is round-off.
const ROUND_OFF: f64 = 1e-15;

/// `diag(own) − g`: what values take to be changed.
struct Operator<'a, const D: usize> {
    of: (&'a Body<D>, &'a Places),
    sums: &'a Sums,
    rows: &'a Rows,
    touching: Option<&'a Touching>,
    /// On the diagonal beside the bonds.
    own: &'a [f64],
    /// Part of the bonds.
    theta: f64,
    /// Of all places, and of those that are here.
    values: Vec<f64>,
    room: Vec<f64>,
}

impl<const D: usize> LinearOperator<1> for Operator<'_, D> {
    fn points(&self) -> usize {
        self.own.len()
    }

    fn sums(&self) -> &Sums {
        self.sums
    }

    fn apply(&mut self, x: &[[f64; 1]], y: &mut [[f64; 1]]) {
        let (body, places) = self.of;
        self.values[..x.len()].copy_from_slice(x.as_flattened());
        places.fill(body, &mut self.values);
        let values = &self.values;
        self.rows.flow(|i| values[i], &mut self.room);
        if let Some(touching) = self.touching {
            touching.flow(body, |i| values[i], &mut self.room);
        }
        for (i, y) in y.iter_mut().enumerate() {
            y[0] = self.own[i] * x[i][0] - self.theta * self.room[i];
        }
    }

    fn diagonal(&mut self) -> Vec<[[f64; 1]; 1]> {
        let mut total = self.rows.totals().to_vec();
        if let Some(touching) = self.touching {
            touching.add_totals(&mut total);
        }
        let each = self.own.iter().zip(&total);
        each.map(|(own, g)| [[own + self.theta * g]]).collect()
    }
}

impl Diffusion {
    /// `C (T₁ − T₀) = Δt (θ P(T₁, t₁) + (1 − θ) P(T₀, t₀))`.
    pub(super) fn implicit<const D: usize>(
        &mut self,
        of: (&Body<D>, &Places),
        (t, dt): (f64, f64),
        theta: f64,
        tolerance: f64,
    ) -> Result<(), SolveError> {
        self.powers(of.0, t, (1.0 - theta) * dt);
        let past: Vec<f64> = self.flow.iter().map(|p| (1.0 - theta) * p).collect();
        let old = self.value.clone();
        let inertia: Vec<f64> = self.capacity.iter().map(|c| c / dt).collect();
        self.solve(of, (t + dt, theta), tolerance, &inertia, |i, value| {
            past[i] - inertia[i] * (value - old[i])
        })?;
        self.powers(of.0, t + dt, theta * dt);
        for i in &self.held_places {
            let i = *i as usize;
            let given = dt * (theta * self.flow[i] + past[i]);
            let gained = self.capacity[i] * (self.value[i] - old[i]);
            self.gained.held.add(gained - given);
        }
        Ok(())
    }

    /// Values at which nothing flows into free points at time `t`. What a body gained on the way has no time: it counts as held.
    pub(super) fn steady<const D: usize>(
        &mut self,
        of: (&Body<D>, &Places),
        t: f64,
        tolerance: f64,
    ) -> Result<(), SolveError> {
        let before = self.value.clone();
        let none = vec![0.0; self.capacity.len()];
        self.solve(of, (t, 1.0), tolerance, &none, |_, _| 0.0)?;
        for (i, c) in self.capacity.iter().enumerate() {
            self.gained.held.add(c * (self.value[i] - before[i]));
        }
        Ok(())
    }

    /// `θ P(T, t) + more(T) = 0` at the free points, `inertia = −∂more/∂T`.
    fn solve<const D: usize>(
        &mut self,
        (body, places): (&Body<D>, &Places),
        (t, theta): (f64, f64),
        tolerance: f64,
        inertia: &[f64],
        more: impl Fn(usize, f64) -> f64,
    ) -> Result<(), SolveError> {
        self.place(body, places, t);
        let sums = Sums::of(body, places.here());
        let support = Support {
            free: self.held.iter().map(|held| [!held]).collect(),
        };
        let mut first = None;
        let mut residual = f64::INFINITY;
        for _ in 0..ROUNDS {
            self.powers(body, t, 0.0);
            let mut own = self.slopes(t);
            for (own, c) in own.iter_mut().zip(inertia) {
                *own = theta * *own + c;
            }
            let terms = { own.iter().zip(self.rows.totals()).zip(&self.value) }
                .map(|((own, g), value)| [(own + theta * g) * value]);
            let floor = ROUND_OFF * sums.norm(&terms.collect::<Vec<_>>());
            let each = self.flow.iter().zip(&self.value).enumerate();
            let mut left: Vec<[f64; 1]> = each
                .map(|(i, (p, value))| [theta * p + more(i, *value)])
                .collect();
            support.mask(&mut left);
            residual = sums.norm(&left);
            if !residual.is_finite() {
                return Err(SolveError::NotFinite);
            }
            let start = *first.get_or_insert(residual);
            let goal = (tolerance * start).max(floor);
            if residual <= goal {
                return Ok(());
            }
            let mut operator = Operator {
                of: (body, places),
                sums: &sums,
                rows: &self.rows,
                touching: self.touching.as_ref(),
                own: &own,
                theta,
                values: vec![0.0; places.count()],
                room: vec![0.0; own.len()],
            };
            let mut change = vec![[0.0]; own.len()];
            let goal = Goal {
                tolerance: (0.5 * goal / residual).max(1e-14),
                most_iterations: ITERATIONS,
                stop: || false,
            };
            cg::solve(&mut operator, &support, &left, &mut change, goal)?;
            for (value, change) in self.value.iter_mut().zip(&change) {
                *value += change[0];
            }
            places.fill(body, &mut self.value);
        }
        Err(SolveError::NotConverged {
            iterations: ROUNDS,
            residual: residual / first.unwrap_or(1.0),
            tolerance,
        })
    }
}
