//! Steps in time: strong-stability-preserving Runge–Kutta of order 3 (Shu and Osher 1988), the classical one of order 4, and a step that
//! takes diffusion implicitly: (2,3,2) of Ascher, Ruuth and Spiteri (1997, section 2.5), of order 2, L-stable in what is implicit.

use crate::flux::Flux;
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

    /// Evaluations of a step; implicit ones are solved besides.
    pub fn stages(self) -> u8 {
        match self {
            Method::Ssprk3 | Method::Imex => 3,
            Method::Rk4 => 4,
        }
    }

    /// Power of the step with which errors fall.
    pub fn order(self) -> u8 {
        match self {
            Method::Ssprk3 => 3,
            Method::Rk4 => 4,
            Method::Imex => 2,
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
    #[error(
        "no step is stable at t = {}: the flux changes too fast with u somewhere between its least and its largest value (the longest stable step is {stable})", rounded(*.time, 6)
    )]
    NoStep { stable: f64, time: f64 },
    #[error("it was told to end at t = {}", rounded(*.time, 6))]
    Ended { time: f64 },
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
    /// u that is not finite afterwards, an implicit step that is not solved, a stop that was asked for; u is then as it was.
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
        let made = match self.method {
            Method::Ssprk3 => {
                self.ssprk3(operator, u, t, dt);
                Ok(())
            }
            Method::Rk4 => {
                self.rk4(operator, u, t, dt);
                Ok(())
            }
            Method::Imex => self.imex(operator, u, t, dt),
        };
        if operator.stopped() {
            return Err(RunError::Ended { time: t });
        }
        made?;
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
