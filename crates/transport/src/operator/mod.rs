//! The right-hand side `−∫ F(u(x), u(y)) φ_a dy + ε ∫ (u(y) − u(x)) φ_s dy` (sandia2010 (2.0.5), (2.0.14)) on a grid.
//!
//! With a polynomial flux, `S_p(v) = Σ_q A_pq v^q` and the direction d at points, `φ_a(y, x) = α(y − x)·(d(x) + d(y))/2`:
//! `∫ F φ_a dy = Σ_p u^p Σ_c ½ (d_c (α_c * S_p) + α_c * (S_p d_c))`, where α_c * is a convolution, summed directly or by Fourier transforms.

mod direct;
mod fourier;
mod gradients;

pub use fourier::Transform;

use crate::flux::Flux;
use crate::grid::{Boundary, Padded};
use crate::law::{Direction, Law};
use crate::measure;
use crate::stop::Stop;
use crate::threads::{PIECE, pieces};
use crate::weights::Stencil;
use fourier::Fourier;
use gradients::conjugate_gradients;
use peridyne::error::BuildError;
use peridyne::quantity::rounded;

/// How sums over bonds are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Evaluation {
    Direct,
    Fourier,
}

/// From this many bonds of a point on, the mean of all convolutions, Fourier transforms are faster on one thread (`cargo run --release --example cost`).
pub const FOURIER_FROM: usize = 80;

impl Evaluation {
    /// The faster one on one thread, so that results do not depend on threads.
    pub fn choose(law: &Law) -> Evaluation {
        let each = law.bonds().into_iter().zip(law.convolutions());
        let (bonds, number) = each.fold((0, 0), |sum, (b, n)| (sum.0 + n * b, sum.1 + n));
        match law.is_convolution() && bonds >= FOURIER_FROM * number {
            true => Evaluation::Fourier,
            false => Evaluation::Direct,
        }
    }
}

/// Sums over the bonds of a law.
#[derive(Debug)]
pub struct Operator {
    law: Law,
    stop: Stop,
    padded: Padded,
    /// Of a field of directions, on the padded grid, for each axis.
    direction: Vec<Vec<f64>>,
    /// Kernels that carry: one for each axis, or that along a constant direction; and the one that spreads.
    carrying: Vec<Stencil>,
    fourier: Option<Fourier>,
    /// Of waves of unit speed, and ε times that of diffusion (1/time).
    spectrum: [f64; 2],
    values: Vec<f64>,
    source: Vec<f64>,
    sums: Vec<f64>,
}

impl Operator {
    /// # Errors
    /// Fourier transforms where they cannot be; a direction that is not finite; a diffusion that sharpens waves.
    pub fn new(law: Law, evaluation: Evaluation) -> Result<Operator, BuildError> {
        if evaluation == Evaluation::Fourier && !law.is_convolution() {
            return Err(BuildError::unsupported(
                "evaluation",
                "Fourier transforms need a periodic grid and a flux that is a polynomial",
            )
            .help("write evaluation = \"direct\""));
        }
        let reach = match evaluation {
            Evaluation::Direct => law.reach(),
            Evaluation::Fourier => 0,
        };
        let padded = Padded::new(law.grid, reach);
        let direction = law.direction(&padded);
        let constant = match law.advection.as_ref().map(|a| &a.direction) {
            Some(Direction::Constant(d)) => *d,
            Some(Direction::Field(_)) | None => [0.0; 2],
        };
        let mut all = direction.iter().flatten().chain(&constant);
        if all.any(|d| !d.is_finite()) {
            return Err(BuildError::invalid(
                "advection.direction",
                "the direction is not finite everywhere",
            ));
        }
        let carrying: Vec<Stencil> = match &law.advection {
            None => vec![],
            Some(a) => match a.direction {
                Direction::Constant(d) => {
                    let weights = a
                        .stencil
                        .weights
                        .iter()
                        .map(|w| [w[0] * d[0] + w[1] * d[1], 0.0]);
                    vec![Stencil {
                        weights: weights.collect(),
                        ..a.stencil.clone()
                    }]
                }
                Direction::Field(_) => vec![a.stencil.clone()],
            },
        };
        let dimension = law.grid.dimension;
        let longest = (0..direction.first().map_or(0, Vec::len))
            .map(|p| direction.iter().map(|d| d[p] * d[p]).sum::<f64>())
            .fold(0.0, f64::max)
            .sqrt()
            .max(
                constant[..dimension]
                    .iter()
                    .map(|d| d * d)
                    .sum::<f64>()
                    .sqrt(),
            );
        let spectrum = [
            law.advection.as_ref().map_or(0.0, |a| {
                0.5 * longest * fourier::largest(&a.stencil, dimension)
            }),
            law.diffusion.as_ref().map_or(0.0, |d| {
                d.viscosity * fourier::largest(&d.stencil, dimension)
            }),
        ];
        let fourier = (evaluation == Evaluation::Fourier).then(|| {
            let mut fourier = Fourier::new(law.grid.cells);
            // numbered: axes of transport, then diffusion
            for (stencil, axis) in of_axes(&carrying, &law) {
                fourier.add(stencil, axis);
            }
            if let Some(d) = &law.diffusion {
                fourier.add(&d.stencil, 0);
            }
            fourier
        });
        let operator = Operator {
            sums: vec![0.0; law.grid.points()],
            values: vec![],
            source: vec![],
            stop: Stop::default(),
            law,
            padded,
            direction,
            carrying,
            fourier,
            spectrum,
        };
        operator.spreads()?;
        operator.collars_say()?;
        Ok(operator)
    }

    /// Is u finite in all of the collars, and can the flux be evaluated there, at t = 0?
    fn collars_say(&self) -> Result<(), BuildError> {
        let Boundary::Collars(given) = &self.law.boundary else {
            return Ok(());
        };
        for x in self.padded.ghosts() {
            let u = given(&x, 0.0);
            if !u.is_finite() {
                let place = &x[..self.law.grid.dimension];
                let what = format!("u in the collar is {u} at {place:?}");
                return Err(BuildError::invalid("boundary", what));
            }
        }
        match &self.law.advection {
            Some(a) => {
                let [low, high] = self.extremes(&[], 0.0);
                let told = a.flux.evaluable(low, high, "advection.flux");
                told.map_err(|mut e| {
                    e.message.add(" in the collars");
                    e
                })
            }
            None => Ok(()),
        }
    }

    /// Smallest and largest value that bonds meet at time t: of u, and of collars.
    pub fn extremes(&self, u: &[f64], t: f64) -> [f64; 2] {
        let own = measure::extremes(u);
        match &self.law.boundary {
            Boundary::Periodic => own,
            Boundary::Collars(given) => self.padded.ghosts().fold(own, |[low, high], x| {
                let u = given(&x, t);
                [low.min(u), high.max(u)]
            }),
        }
    }

    /// Does diffusion damp all waves?
    fn spreads(&self) -> Result<(), BuildError> {
        let Some(d) = self.law.diffusion.as_ref().filter(|d| d.viscosity > 0.0) else {
            return Ok(());
        };
        if d.stencil.weights.iter().all(|w| w[0] >= 0.0) {
            return Ok(());
        }
        let n = (8 * d.stencil.reach() + 8).next_power_of_two();
        let mut transform = Transform::new([n, if self.law.grid.dimension == 1 { 1 } else { n }]);
        let symbol = transform.symbol(&d.stencil, 0);
        let most = symbol
            .iter()
            .map(|s| s.re)
            .fold(f64::NEG_INFINITY, f64::max);
        let least = symbol.iter().map(|s| s.re).fold(0.0, f64::min);
        match most > -1e-9 * least {
            false => Ok(()),
            true => Err(BuildError::ill_posed(
                "diffusion.kernel",
                format!("this kernel makes waves grow, by exp({} t) at the worst: its Fourier transform is above its value at 0", rounded(d.viscosity * most, 4)),
            )
            .help("use a kernel that is not negative, such as kernel = { bump = \"smooth\" }")),
        }
    }

    pub fn law(&self) -> &Law {
        &self.law
    }

    /// From now on sums end early when `stop` says so; what they give is then of no use ([`Operator::stopped`]).
    pub fn stop_when(&mut self, stop: Stop) {
        self.stop = stop;
    }

    /// Was the last sum possibly left before its end?
    pub fn stopped(&self) -> bool {
        self.stop.asked()
    }

    pub fn evaluation(&self) -> Evaluation {
        match self.fourier {
            Some(_) => Evaluation::Fourier,
            None => Evaluation::Direct,
        }
    }

    /// Additions and products of an evaluation, about.
    pub fn operations(&self) -> f64 {
        let law = &self.law;
        let points = law.grid.points() as f64;
        let function = law
            .advection
            .as_ref()
            .is_some_and(|a| matches!(a.flux, Flux::Function(_)));
        // two transforms; a difference, a product and a sum of each pair of bonds
        let transforms = 2.0 * 2.5 * libm::log2(points).max(1.0);
        let each = law.bonds().into_iter().zip(law.convolutions());
        let convolutions = each.enumerate().map(|(n, (bonds, number))| {
            let of_pair = if function && n == 0 { 16.0 } else { 3.0 };
            let once = match self.fourier {
                Some(_) => transforms,
                None => of_pair * bonds as f64 / 2.0,
            };
            number as f64 * once
        });
        points * convolutions.sum::<f64>()
    }

    /// Largest frequency of waves for a speed of 1 (half of each two-point flux is the partner's), and largest rate of decay by diffusion (1/length, 1/time).
    pub fn spectrum(&self) -> [f64; 2] {
        self.spectrum
    }

    /// Subtracts `∫ F φ_a dy` at time t from `out`, for all points of the grid.
    pub fn carry(&mut self, u: &[f64], t: f64, out: &mut [f64]) {
        let Some(advection) = self.law.advection.as_ref().filter(|_| !self.stop.asked()) else {
            return;
        };
        let values = match &self.fourier {
            Some(_) => u,
            None => {
                self.padded.fill(u, &self.law.boundary, t, &mut self.values);
                &self.values
            }
        };
        let a = match &advection.flux {
            Flux::Polynomial(a) => a,
            Flux::Function(psi) => {
                let (padded, direction) = (&self.padded, &self.direction);
                let room = (&mut self.source, &self.stop);
                direct::carry(&self.law, &**psi, padded, direction, values, room, out);
                return;
            }
        };
        let constant = matches!(advection.direction, Direction::Constant(_));
        for (p, row) in a.iter().enumerate() {
            // what does not depend on the partner carries nothing, unless the direction does
            if row.iter().skip(usize::from(constant)).all(|c| *c == 0.0) {
                continue;
            }
            for (number, (stencil, axis)) in of_axes(&self.carrying, &self.law).enumerate() {
                self.source.resize(values.len(), 0.0);
                pieces(&mut self.source, PIECE, 4, |first, piece| {
                    let v = &values[first..][..piece.len()];
                    evaluate(row, v, piece);
                });
                let mut convolve = |source: &[f64], sums: &mut [f64]| match &mut self.fourier {
                    _ if self.stop.asked() => {}
                    Some(fourier) => fourier.convolve(number, source, sums),
                    None => direct::convolve(stencil, axis, &self.padded, source, sums, &self.stop),
                };
                convolve(&self.source, &mut self.sums);
                if constant {
                    add(out, u, &self.sums, p as i32, None);
                    continue;
                }
                let d = &self.direction[axis];
                let n = self.law.grid.cells[0];
                let padded = &self.padded;
                let own = |k: usize| d[padded.row(k / n) + k % n];
                add(out, u, &self.sums, p as i32, Some(&own));
                pieces(&mut self.source, PIECE, 1, |first, piece| {
                    let each = piece.iter_mut().zip(&d[first..]);
                    each.for_each(|(s, d)| *s *= d);
                });
                convolve(&self.source, &mut self.sums);
                add(out, u, &self.sums, p as i32, Some(&|_| 1.0));
            }
        }
    }

    /// Adds `ε ∫ (u(y) − u(x)) φ_s dy` at time t.
    pub fn spread(&mut self, u: &[f64], t: f64, out: &mut [f64]) {
        let Some(diffusion) = self.law.diffusion.as_ref().filter(|_| !self.stop.asked()) else {
            return;
        };
        match &mut self.fourier {
            Some(fourier) => {
                let number = of_axes(&self.carrying, &self.law).count();
                fourier.convolve(number, u, &mut self.sums);
            }
            None => {
                self.padded.fill(u, &self.law.boundary, t, &mut self.values);
                let (padded, values) = (&self.padded, &self.values);
                let (stencil, sums) = (&diffusion.stencil, &mut self.sums);
                direct::convolve(stencil, 0, padded, values, sums, &self.stop);
            }
        }
        let sums = &self.sums;
        pieces(out, PIECE, 2, |first, piece| {
            let each = piece.iter_mut().zip(&sums[first..]);
            each.for_each(|(out, s)| *out += diffusion.viscosity * s);
        });
    }

    /// `u_t`
    pub fn rate(&mut self, u: &[f64], t: f64, out: &mut [f64]) {
        out.fill(0.0);
        self.carry(u, t, out);
        self.spread(u, t, out);
    }

    /// Solves `(1 − factor ε S) u = u` in place, with the collars of time t: in Fourier space, or by conjugate gradients.
    ///
    /// # Errors
    /// The residual that conjugate gradients end with above 1e-13 of the right side.
    pub fn solve(&mut self, factor: f64, t: f64, u: &mut [f64]) -> Result<(), f64> {
        let Some(diffusion) = self.law.diffusion.as_ref().filter(|_| !self.stop.asked()) else {
            return Ok(());
        };
        let factor = factor * diffusion.viscosity;
        if let Some(fourier) = &mut self.fourier {
            let number = of_axes(&self.carrying, &self.law).count();
            fourier.solve(number, factor, u);
            return Ok(());
        }
        let (stencil, padded) = (&diffusion.stencil, &self.padded);
        let mut around = self.law.boundary.clone();
        if let Boundary::Collars(_) = around {
            // what the collars give is known
            let zero = vec![0.0; u.len()];
            padded.fill(&zero, &around, t, &mut self.values);
            let (values, sums) = (&self.values, &mut self.sums);
            direct::convolve(stencil, 0, padded, values, sums, &self.stop);
            u.iter_mut()
                .zip(&self.sums)
                .for_each(|(u, s)| *u += factor * s);
            around = Boundary::Collars(std::sync::Arc::new(|_, _| 0.0));
        }
        let (values, sums, stop) = (&mut self.values, &mut self.sums, &self.stop);
        conjugate_gradients(u, stop, |p, out| {
            padded.fill(p, &around, t, values);
            direct::convolve(stencil, 0, padded, values, sums, stop);
            for ((out, p), s) in out.iter_mut().zip(p).zip(sums.iter()) {
                *out = p - factor * s;
            }
        })
    }

    /// The exact law of `d/dt ∫u²/2 = ∫ u u_t`. It is the sum over pairs that a bond joins, of `w F(u, v)(v − u)` and `−ε w (v − u)²`, since the
    /// weights of ±m are ∓ each other and F is symmetric; a partner in a collar keeps its value, and only the point's part counts.
    pub fn energy_rate(&mut self, u: &[f64], t: f64) -> f64 {
        let mut rate = vec![0.0; u.len()];
        self.rate(u, t, &mut rate);
        measure::product(u, &rate, self.law.grid.cell())
    }
}

/// The kernels of transport with the axes that their weights are of.
fn of_axes<'a>(carrying: &'a [Stencil], law: &Law) -> impl Iterator<Item = (&'a Stencil, usize)> {
    let field = law
        .advection
        .as_ref()
        .is_some_and(|a| matches!(a.direction, Direction::Field(_)));
    let axes = if field { law.grid.dimension } else { 1 };
    carrying
        .iter()
        .flat_map(move |s| (0..axes).map(move |a| (s, a)))
}

/// `Σ c_q v^q`
fn evaluate(c: &[f64], v: &[f64], out: &mut [f64]) {
    // a power alone, as Burgers' are, without what is 0
    match c {
        [0.0, c] => v.iter().zip(out).for_each(|(v, out)| *out = c * v),
        [0.0, 0.0, c] => v.iter().zip(out).for_each(|(v, out)| *out = c * v * v),
        _ => {
            let (last, lower) = c.split_last().unwrap_or((&0.0, &[]));
            out.fill(*last);
            for c in lower.iter().rev() {
                v.iter()
                    .zip(&mut *out)
                    .for_each(|(v, out)| *out = *out * v + c);
            }
        }
    }
}

/// Subtracts `u^p sums`, or half of it times a factor of the point.
fn add(
    out: &mut [f64],
    u: &[f64],
    sums: &[f64],
    p: i32,
    factor: Option<&(dyn Fn(usize) -> f64 + Sync)>,
) {
    pieces(out, PIECE, 4, |first, out| {
        let (u, sums) = (&u[first..], &sums[first..]);
        let terms = out.iter_mut().zip(u).zip(sums);
        match (p, factor) {
            (0, None) => terms.for_each(|((out, _), s)| *out -= s),
            (1, None) => terms.for_each(|((out, u), s)| *out -= u * s),
            (2, None) => terms.for_each(|((out, u), s)| *out -= u * u * s),
            (p, None) => terms.for_each(|((out, u), s)| *out -= u.powi(p) * s),
            (p, Some(factor)) => {
                let each = terms.enumerate();
                each.for_each(|(k, ((out, u), s))| {
                    *out -= 0.5 * factor(first + k) * u.powi(p) * s;
                });
            }
        }
    });
}
