//! Convolutions on periodic grids by the fast Fourier transform: the cost does not know the horizon.

use crate::kernel::Parity;
use crate::weights::Stencil;
use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};
use std::fmt;
use std::sync::Arc;

type C = Complex<f64>;

/// Columns that are transformed together, so that whole lines of memory are read.
const TOGETHER: usize = 8;

/// Transforms of a grid, real along x and complex along y.
pub struct Transform {
    cells: [usize; 2],
    /// Numbers of a row of the spectrum.
    half: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    columns: Option<[Arc<dyn Fft<f64>>; 2]>,
    real: Vec<f64>,
    scratch: [Vec<C>; 3],
    gathered: Vec<C>,
}

impl fmt::Debug for Transform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Transform({:?})", self.cells)
    }
}

impl Transform {
    pub fn new(cells: [usize; 2]) -> Transform {
        let mut planner = RealFftPlanner::new();
        let (forward, inverse) = (
            planner.plan_fft_forward(cells[0]),
            planner.plan_fft_inverse(cells[0]),
        );
        let columns = (cells[1] > 1).then(|| {
            let mut planner = FftPlanner::new();
            [
                planner.plan_fft_forward(cells[1]),
                planner.plan_fft_inverse(cells[1]),
            ]
        });
        let most = columns
            .iter()
            .flatten()
            .map(|c| c.get_inplace_scratch_len())
            .max();
        Transform {
            half: cells[0] / 2 + 1,
            real: vec![0.0; cells[0]],
            scratch: [
                forward.make_scratch_vec(),
                inverse.make_scratch_vec(),
                vec![C::default(); most.unwrap_or(0)],
            ],
            gathered: vec![C::default(); TOGETHER * cells[1]],
            cells,
            forward,
            inverse,
            columns,
        }
    }

    pub fn spectrum(&self) -> Vec<C> {
        vec![C::default(); self.half * self.cells[1]]
    }

    pub fn to_spectrum(&mut self, u: &[f64], spectrum: &mut [C]) {
        let rows = u
            .chunks_exact(self.cells[0])
            .zip(spectrum.chunks_exact_mut(self.half));
        for (u, row) in rows {
            self.real.copy_from_slice(u);
            // lengths are those of the plan
            let done = self
                .forward
                .process_with_scratch(&mut self.real, row, &mut self.scratch[0]);
            debug_assert!(done.is_ok());
        }
        self.along_columns(spectrum, 0);
    }

    /// Without the factor 1/N; `spectrum` is used up.
    pub fn to_values(&mut self, spectrum: &mut [C], u: &mut [f64]) {
        self.along_columns(spectrum, 1);
        let rows = u
            .chunks_exact_mut(self.cells[0])
            .zip(spectrum.chunks_exact_mut(self.half));
        for (u, row) in rows {
            // what a real row cannot have
            row[0].im = 0.0;
            if self.cells[0].is_multiple_of(2) {
                row[self.half - 1].im = 0.0;
            }
            let done = self
                .inverse
                .process_with_scratch(row, u, &mut self.scratch[1]);
            debug_assert!(done.is_ok());
        }
    }

    fn along_columns(&mut self, spectrum: &mut [C], way: usize) {
        let Some(plans) = &self.columns else {
            return;
        };
        let rows = self.cells[1];
        for first in (0..self.half).step_by(TOGETHER) {
            let together = TOGETHER.min(self.half - first);
            let gathered = &mut self.gathered[..together * rows];
            for j in 0..rows {
                for k in 0..together {
                    gathered[k * rows + j] = spectrum[j * self.half + first + k];
                }
            }
            plans[way].process_with_scratch(gathered, &mut self.scratch[2]);
            for j in 0..rows {
                for k in 0..together {
                    spectrum[j * self.half + first + k] = gathered[k * rows + j];
                }
            }
        }
    }

    /// `Σ_m w_m e^{ik·m}` (of an even kernel `Σ_m w_m (e^{ik·m} − 1)`) of the weights of an axis at all wave vectors of the grid.
    pub fn symbol(&mut self, stencil: &Stencil, axis: usize) -> Vec<C> {
        let mut wrapped = vec![0.0; self.cells[0] * self.cells[1]];
        let mut put = |m: [isize; 2], w: f64| {
            let [i, j] = [0, 1].map(|a| m[a].rem_euclid(self.cells[a] as isize) as usize);
            wrapped[j * self.cells[0] + i] += w;
        };
        for (m, w) in stencil.steps.iter().zip(&stencil.weights) {
            let (ahead, behind, own) = match stencil.parity {
                Parity::Odd => (w[axis], -w[axis], 0.0),
                Parity::Even => (w[axis], w[axis], -2.0 * w[axis]),
            };
            // a value m ahead is a shift by −m
            put([-m[0], -m[1]], ahead);
            put(*m, behind);
            put([0, 0], own);
        }
        let mut symbol = self.spectrum();
        self.to_spectrum(&wrapped, &mut symbol);
        symbol
    }
}

/// A kernel's convolution.
#[derive(Debug)]
pub struct Fourier {
    transform: Transform,
    spectrum: Vec<C>,
    /// Divided by the number of points.
    symbols: Vec<Vec<C>>,
}

impl Fourier {
    pub fn new(cells: [usize; 2]) -> Fourier {
        let transform = Transform::new(cells);
        Fourier {
            spectrum: transform.spectrum(),
            transform,
            symbols: vec![],
        }
    }

    /// Adds a kernel: gives its number.
    pub fn add(&mut self, stencil: &Stencil, axis: usize) -> usize {
        let n = (self.transform.cells[0] * self.transform.cells[1]) as f64;
        let symbol = self.transform.symbol(stencil, axis);
        self.symbols
            .push(symbol.into_iter().map(|s| s / n).collect());
        self.symbols.len() - 1
    }

    pub fn convolve(&mut self, kernel: usize, v: &[f64], out: &mut [f64]) {
        self.transform.to_spectrum(v, &mut self.spectrum);
        for (a, s) in self.spectrum.iter_mut().zip(&self.symbols[kernel]) {
            *a *= s;
        }
        self.transform.to_values(&mut self.spectrum, out);
    }

    /// Solves `(1 − factor S) u = u` in place, S an even kernel.
    pub fn solve(&mut self, kernel: usize, factor: f64, u: &mut [f64]) {
        let n = u.len() as f64;
        self.transform.to_spectrum(u, &mut self.spectrum);
        for (a, s) in self.spectrum.iter_mut().zip(&self.symbols[kernel]) {
            *a /= n * (1.0 - factor * n * s.re);
        }
        self.transform.to_values(&mut self.spectrum, u);
    }
}

/// The largest of `|Σ_m w_m e^{ik·m}|` over wave vectors of a grid eight times as fine as the longest bond asks for, both axes together.
pub fn largest(stencil: &Stencil, dimension: usize) -> f64 {
    let n = (8 * stencil.reach() + 8).next_power_of_two();
    let mut transform = Transform::new([n, if dimension == 1 { 1 } else { n }]);
    let symbols: Vec<Vec<C>> = (0..dimension)
        .map(|a| transform.symbol(stencil, a))
        .collect();
    let at = |k: usize| symbols.iter().map(|s| s[k].norm_sqr()).sum::<f64>();
    (0..symbols[0].len()).map(at).fold(0.0, f64::max).sqrt()
}
