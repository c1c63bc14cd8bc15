//! Convolutions on periodic grids by the fast Fourier transform: the cost does not know the horizon.

use crate::kernel::Parity;
use crate::threads::{PIECE, pieces, pieces_with};
use crate::weights::Stencil;
use realfft::num_complex::Complex;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};
use std::fmt;
use std::sync::Arc;

type C = Complex<f64>;

/// Lines that are taken together, so that whole lines of memory are read.
const TOGETHER: usize = 8;

/// Additions for a number of a transform, about.
const WORK: usize = 16;

/// Transforms of a grid, real along x and complex along y. Lines of a plane are shared out to threads; a line alone is transformed on one.
/// A spectrum of a plane stands column by column.
pub struct Transform {
    cells: [usize; 2],
    /// Waves along x.
    half: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    columns: Option<[Arc<dyn Fft<f64>>; 2]>,
    /// Of a plane: spectra of its rows.
    rows: Vec<C>,
    real: Vec<f64>,
    scratch: [Vec<C>; 2],
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
        let half = cells[0] / 2 + 1;
        let columns = (cells[1] > 1).then(|| {
            let mut planner = FftPlanner::new();
            [
                planner.plan_fft_forward(cells[1]),
                planner.plan_fft_inverse(cells[1]),
            ]
        });
        let of_plane = if cells[1] > 1 { half * cells[1] } else { 0 };
        Transform {
            half,
            real: vec![0.0; cells[0]],
            scratch: [forward.make_scratch_vec(), inverse.make_scratch_vec()],
            rows: vec![C::default(); of_plane],
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
        let ([n, rows], half, forward) = (self.cells, self.half, &self.forward);
        // lengths are those of the plan
        let Some([column, _]) = &self.columns else {
            self.real.copy_from_slice(u);
            let done = forward.process_with_scratch(&mut self.real, spectrum, &mut self.scratch[0]);
            debug_assert!(done.is_ok());
            return;
        };
        let room = || (vec![0.0; n], forward.make_scratch_vec());
        let of_row = |(real, scratch): &mut (Vec<f64>, Vec<C>), first: usize, out: &mut [C]| {
            for (k, row) in out.chunks_exact_mut(half).enumerate() {
                real.copy_from_slice(&u[(first / half + k) * n..][..n]);
                let done = forward.process_with_scratch(real, row, scratch);
                debug_assert!(done.is_ok());
            }
        };
        pieces_with(&mut self.rows, TOGETHER * half, WORK, room, of_row);
        let from = &self.rows;
        let room = || vec![C::default(); column.get_inplace_scratch_len()];
        let of_columns = |scratch: &mut Vec<C>, first: usize, out: &mut [C]| {
            let first = first / rows;
            for j in 0..rows {
                for k in 0..out.len() / rows {
                    out[k * rows + j] = from[j * half + first + k];
                }
            }
            column.process_with_scratch(out, scratch);
        };
        pieces_with(spectrum, TOGETHER * rows, WORK, room, of_columns);
    }

    /// Without the factor 1/N; `spectrum` is used up.
    pub fn to_values(&mut self, spectrum: &mut [C], u: &mut [f64]) {
        let ([n, rows], half, inverse) = (self.cells, self.half, &self.inverse);
        let real_row = |row: &mut [C], u: &mut [f64], scratch: &mut [C]| {
            // what a real row cannot have
            row[0].im = 0.0;
            if n.is_multiple_of(2) {
                row[half - 1].im = 0.0;
            }
            let done = inverse.process_with_scratch(row, u, scratch);
            debug_assert!(done.is_ok());
        };
        let Some([_, column]) = &self.columns else {
            return real_row(spectrum, u, &mut self.scratch[1]);
        };
        let room = || vec![C::default(); column.get_inplace_scratch_len()];
        let of_columns = |scratch: &mut Vec<C>, _: usize, out: &mut [C]| {
            column.process_with_scratch(out, scratch)
        };
        pieces_with(spectrum, TOGETHER * rows, WORK, room, of_columns);
        let from = &*spectrum;
        let room = || {
            (
                vec![C::default(); TOGETHER * half],
                inverse.make_scratch_vec(),
            )
        };
        let of_rows = |(block, scratch): &mut (Vec<C>, Vec<C>), first: usize, u: &mut [f64]| {
            let first = first / n;
            let count = u.len() / n;
            for k in 0..half {
                for j in 0..count {
                    block[j * half + k] = from[k * rows + first + j];
                }
            }
            let lines = block.chunks_exact_mut(half).zip(u.chunks_exact_mut(n));
            lines.for_each(|(row, u)| real_row(row, u, scratch));
        };
        pieces_with(u, TOGETHER * n, WORK, room, of_rows);
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
        let symbol = &self.symbols[kernel];
        pieces(&mut self.spectrum, PIECE, 2, |first, piece| {
            let each = piece.iter_mut().zip(&symbol[first..]);
            each.for_each(|(a, s)| *a *= s);
        });
        self.transform.to_values(&mut self.spectrum, out);
    }

    /// Solves `(1 − factor S) u = u` in place, S an even kernel.
    pub fn solve(&mut self, kernel: usize, factor: f64, u: &mut [f64]) {
        let n = u.len() as f64;
        self.transform.to_spectrum(u, &mut self.spectrum);
        let symbol = &self.symbols[kernel];
        pieces(&mut self.spectrum, PIECE, 8, |first, piece| {
            let each = piece.iter_mut().zip(&symbol[first..]);
            each.for_each(|(a, s)| *a /= n * (1.0 - factor * n * s.re));
        });
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
