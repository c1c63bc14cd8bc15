//! Steps in time: strong-stability-preserving Runge–Kutta of order 3 (Shu and Osher 1988), the classical one of order 4, and a step that
//! takes diffusion implicitly: (2,3,2) of Ascher, Ruuth and Spiteri (1997, section 2.5), of order 2, L-stable in what is implicit.

use crate::flux::Flux;
use crate::measure;
use crate::operator::Operator;
use crate::threads::{PIECE, pieces, pieces_of_two};
use peridyne::quantity::rounded;

/// How a step is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    Ssprk3,
    Rk4,
    /// Transport explicit, diffusion implicit.
    Imex,
}

impl Method {
    /// Where `|R(z)| ≤ 1` ends on the imaginary and on the negative real axis; 1 + z + z²/2 + z³/6 for the first and the explicit part of the
    /// last, with z⁴/24 besides for the second. Diffusion that is implicit has no limit.
    fn limits(self) -> [f64; 2] {
        match self {
            Method::Ssprk3 => [3f64.sqrt(), 2.512_745_326_618_333],
            Method::Rk4 => [2.0 * 2f64.sqrt(), 2.785_293_563_405_282],
            Method::Imex => [3f64.sqrt(), f64::INFINITY],
        }
    }
}

/// What can go wrong in a run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RunError {
    #[error("u is {value} at x = {x:?} at t = {}: it has no finite value any more", rounded(*.time, 6))]
    NotFinite { value: f64, x: Vec<f64>, time: f64 },
    #[error(
        "the step {} is unstable at t = {}: with |u| as it is now, steps up to {} are stable (write a smaller time_step, or leave it out)", rounded(*.step, 6), rounded(*.time, 6), rounded(*.stable, 6)
    )]
    Unstable { step: f64, stable: f64, time: f64 },
    #[error(
        "the implicit step at t = {} was not solved: its residual is {} of the right side", rounded(*.time, 6), rounded(*.residual, 3)
    )]
    NotSolved { residual: f64, time: f64 },
}

/// Longest step that is stable for waves of all lengths on the state u and the collars at time t, coefficients frozen: `1/(c ρ_a/I + ε ρ_s/R)`, c the largest `|f′|`, ρ the largest
/// eigenvalues of both sums, I and R the ends of the stability region on both axes (the straight line between them lies in the region).
pub fn stable_step(operator: &Operator, method: Method, u: &[f64], t: f64) -> f64 {
    let [waves, decay] = operator.spectrum();
    let [low, high] = operator.extremes(u, t);
    let flux = operator.law().advection.as_ref().map(|a| &a.flux);
    let speed = flux.map_or(0.0, |f: &Flux| f.fastest(low, high));
    let [imaginary, real] = method.limits();
    1.0 / (speed * waves / imaginary + decay / real)
}

/// A method with its memory.
#[derive(Debug)]
pub struct Stepper {
    pub method: Method,
    rates: [Vec<f64>; 5],
    stage: Vec<f64>,
}

impl Stepper {
    pub fn new(method: Method) -> Stepper {
        Stepper {
            method,
            rates: Default::default(),
            stage: vec![],
        }
    }

    /// From t to t + dt.
    ///
    /// # Errors
    /// u that is not finite afterwards, an implicit step that is not solved; u is then as it was.
    pub fn step(
        &mut self,
        operator: &mut Operator,
        u: &mut [f64],
        t: f64,
        dt: f64,
    ) -> Result<(), RunError> {
        self.rates.iter_mut().for_each(|r| r.resize(u.len(), 0.0));
        self.stage.clear();
        self.stage.extend_from_slice(u);
        match self.method {
            Method::Ssprk3 => self.ssprk3(operator, u, t, dt),
            Method::Rk4 => self.rk4(operator, u, t, dt),
            Method::Imex => self.imex(operator, u, t, dt)?,
        }
        match self.stage.iter().position(|v| !v.is_finite()) {
            None => {
                u.copy_from_slice(&self.stage);
                Ok(())
            }
            Some(n) => {
                let grid = &operator.law().grid;
                Err(RunError::NotFinite {
                    value: self.stage[n],
                    x: grid.place(n)[..grid.dimension].to_vec(),
                    time: t + dt,
                })
            }
        }
    }

    fn ssprk3(&mut self, operator: &mut Operator, u: &[f64], t: f64, dt: f64) {
        // of the old state, of what the last stage gives, and when that is
        for (old, own, time) in [
            (0.0, 1.0, 0.0),
            (0.75, 0.25, 1.0),
            (1.0 / 3.0, 2.0 / 3.0, 0.5),
        ] {
            operator.rate(&self.stage, t + time * dt, &mut self.rates[0]);
            let rate = &self.rates[0];
            pieces(&mut self.stage, PIECE, 4, |first, stage| {
                let (rate, u) = (&rate[first..], &u[first..]);
                for ((s, r), u) in stage.iter_mut().zip(rate).zip(u) {
                    *s = old * u + own * (*s + dt * r);
                }
            });
        }
    }

    fn rk4(&mut self, operator: &mut Operator, u: &[f64], t: f64, dt: f64) {
        let [rate, sum, ..] = &mut self.rates;
        sum.fill(0.0);
        for (weight, next, time) in [
            (1.0, 0.5, 0.0),
            (2.0, 0.5, 0.5),
            (2.0, 1.0, 0.5),
            (1.0, 0.0, 1.0),
        ] {
            operator.rate(&self.stage, t + time * dt, rate);
            pieces_of_two(sum, &mut self.stage, 4, |first, sum, stage| {
                let (rate, u) = (&rate[first..], &u[first..]);
                for (((sum, s), r), u) in sum.iter_mut().zip(stage).zip(rate).zip(u) {
                    *sum += weight * r;
                    *s = u + next * dt * r;
                }
            });
        }
        pieces(&mut self.stage, PIECE, 2, |first, stage| {
            let (sum, u) = (&sum[first..], &u[first..]);
            for ((s, r), u) in stage.iter_mut().zip(sum).zip(u) {
                *s = u + dt / 6.0 * r;
            }
        });
    }

    fn imex(
        &mut self,
        operator: &mut Operator,
        u: &[f64],
        t: f64,
        dt: f64,
    ) -> Result<(), RunError> {
        let g = 1.0 - 0.5f64.sqrt();
        let d = -2.0 * 2f64.sqrt() / 3.0;
        let [e0, e1, e2, i1, i2] = &mut self.rates;
        let rates = |operator: &mut Operator,
                     u: &[f64],
                     t: f64,
                     carried: &mut Vec<f64>,
                     spread: Option<&mut Vec<f64>>| {
            carried.fill(0.0);
            operator.carry(u, t, carried);
            if let Some(spread) = spread {
                spread.fill(0.0);
                operator.spread(u, t, spread);
            }
        };
        let solve = |operator: &mut Operator, stage: &mut Vec<f64>, time: f64| {
            operator
                .solve(g * dt, time, stage)
                .map_err(|residual| RunError::NotSolved { residual, time })
        };
        rates(operator, u, t, e0, None);
        pieces(&mut self.stage, PIECE, 2, |first, stage| {
            for (k, s) in stage.iter_mut().enumerate() {
                let n = first + k;
                *s = u[n] + dt * g * e0[n];
            }
        });
        solve(operator, &mut self.stage, t + g * dt)?;
        rates(operator, &self.stage, t + g * dt, e1, Some(i1));
        pieces(&mut self.stage, PIECE, 6, |first, stage| {
            for (k, s) in stage.iter_mut().enumerate() {
                let n = first + k;
                *s = u[n] + dt * (d * e0[n] + (1.0 - d) * e1[n] + (1.0 - g) * i1[n]);
            }
        });
        solve(operator, &mut self.stage, t + dt)?;
        rates(operator, &self.stage, t + dt, e2, Some(i2));
        pieces(&mut self.stage, PIECE, 6, |first, stage| {
            for (k, s) in stage.iter_mut().enumerate() {
                let n = first + k;
                *s = u[n] + dt * ((1.0 - g) * (e1[n] + i1[n]) + g * (e2[n] + i2[n]));
            }
        });
        Ok(())
    }
}

/// How long steps are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepSize {
    /// A part of what is stable, of the state as it is.
    Part(f64),
    /// The same always; unstable ones are refused unless forced.
    Fixed { step: f64, force_unstable: bool },
}

/// A state on its way.
#[derive(Debug)]
pub struct Evolution {
    pub operator: Operator,
    pub u: Vec<f64>,
    pub time: f64,
    /// Steps done.
    pub steps: u64,
    size: StepSize,
    stepper: Stepper,
}

impl Evolution {
    pub fn new(operator: Operator, u: Vec<f64>, method: Method, size: StepSize) -> Evolution {
        Evolution {
            operator,
            u,
            time: 0.0,
            steps: 0,
            size,
            stepper: Stepper::new(method),
        }
    }

    pub fn method(&self) -> Method {
        self.stepper.method
    }

    /// Longest stable step of the state as it is.
    pub fn stable_step(&self) -> f64 {
        self.stable_until(0.0)
    }

    /// The same, with collars as they will be too: at the middle and the end of a step of that length.
    fn stable_until(&self, step: f64) -> f64 {
        let at = |later: f64| {
            let t = self.time + later;
            stable_step(&self.operator, self.stepper.method, &self.u, t)
        };
        let now = at(0.0);
        match step > 0.0 && !self.operator.law().periodic() {
            true => now.min(at(0.5 * step)).min(at(step)),
            false => now,
        }
    }

    /// The next step on the way to a time: whole ones until there.
    ///
    /// # Errors
    /// A fixed step that is unstable.
    pub fn next_step(&self, end: f64) -> Result<f64, RunError> {
        let left = end - self.time;
        let step = match self.size {
            StepSize::Part(part) => {
                // a collar that rises from nothing would leave the whole time for a step
                let first = left.min(part * self.stable_step());
                first.min(part * self.stable_until(first))
            }
            StepSize::Fixed {
                step,
                force_unstable,
            } => {
                let stable = self.stable_until(step.min(left));
                if !force_unstable && step > stable * (1.0 + 1e-9) {
                    return Err(RunError::Unstable {
                        step,
                        stable,
                        time: self.time,
                    });
                }
                step
            }
        };
        Ok(left / (left / step - 1e-9).ceil().max(1.0))
    }

    /// A step of that length.
    ///
    /// # Errors
    /// See [`Stepper::step`].
    pub fn step(&mut self, dt: f64) -> Result<(), RunError> {
        self.stepper
            .step(&mut self.operator, &mut self.u, self.time, dt)?;
        self.time += dt;
        self.steps += 1;
        Ok(())
    }

    /// To a time, in as many steps as it takes.
    ///
    /// # Errors
    /// See [`Evolution::next_step`] and [`Stepper::step`].
    pub fn run_to(&mut self, end: f64) -> Result<(), RunError> {
        while self.time < end * (1.0 - 1e-12) {
            let dt = self.next_step(end)?;
            self.step(dt)?;
        }
        Ok(())
    }

    /// How fast `∫u²/2` changes now, as the steps make it: from two trial steps of `dt`, which leave no trace, by
    /// `(−3E₀ + 4E₁ − E₂)/2dt`, of order 2.
    ///
    /// # Errors
    /// See [`Stepper::step`].
    pub fn energy_slope(&mut self, dt: f64) -> Result<f64, RunError> {
        let cell = self.operator.law().grid.cell();
        let energy = |u: &[f64]| measure::energy(u, cell);
        let mut trial = self.u.clone();
        let before = energy(&trial);
        self.stepper
            .step(&mut self.operator, &mut trial, self.time, dt)?;
        let first = energy(&trial);
        self.stepper
            .step(&mut self.operator, &mut trial, self.time + dt, dt)?;
        Ok((4.0 * (first - before) - (energy(&trial) - before)) / (2.0 * dt))
    }
}
