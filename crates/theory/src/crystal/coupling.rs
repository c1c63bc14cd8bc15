//! Extensions that answer to one another, as those of the bonds of a fan do.

use crate::dispersion::hermitian::Matrix;
use crate::voigt::{axes, components};
use num_complex::Complex64;

/// Two sites, one of which may be the centre of a fan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span<const D: usize> {
    /// Sites of the cell that its ends are, or are images of.
    pub sites: [usize; 2],
    /// From the centre to its ends (length).
    pub at: [[f64; D]; 2],
}

impl<const D: usize> Span<D> {
    /// From the first end to the second (length).
    pub fn vector(&self) -> [f64; D] {
        std::array::from_fn(|a| self.at[1][a] - self.at[0][a])
    }

    /// `∂(d²/2)/∂E` by Voigt's components of the strain (length²).
    pub(crate) fn by_strain(&self) -> [f64; 6] {
        let y = self.vector();
        let mut by = [0.0; 6];
        for (i, x) in by.iter_mut().enumerate().take(components(D)) {
            let (a, b) = axes(D, i);
            *x = y[a] * y[b];
        }
        by
    }
}

/// `½ Σ_pq k_pq (y_p·η_p)(y_q·η_q)` of the spans of one centre, y their vectors, η what their ends move apart: the second derivatives
/// of an energy by ξ = d²/2 of its spans.
#[derive(Debug, Clone, PartialEq)]
pub struct Coupling<const D: usize> {
    pub spans: Vec<Span<D>>,
    /// `[p · spans + q]`, symmetric (energy / length⁴).
    pub k: Vec<f64>,
}

/// `y·η` of a span as a row over the displacements of all sites.
type Row = Vec<(usize, Complex64)>;

impl<const D: usize> Coupling<D> {
    fn of(&self, p: usize) -> &[f64] {
        let n = self.spans.len();
        &self.k[p * n..(p + 1) * n]
    }

    /// Rows of all spans where what is at `x` from the centre moves by `wave(x)` of its site.
    pub(crate) fn rows(&self, wave: impl Fn(&[f64; D]) -> Complex64) -> Vec<Row> {
        let row = |span: &Span<D>| {
            let y = span.vector();
            let end = |n: usize, sign: f64| {
                let factor = wave(&span.at[n]) * sign;
                (0..D).map(move |a| (span.sites[n] * D + a, factor * y[a]))
            };
            end(0, -1.0).chain(end(1, 1.0)).collect()
        };
        self.spans.iter().map(row).collect()
    }

    /// `Σ_pq k_pq left_p† right_q` into a matrix.
    pub(crate) fn add(&self, left: &[Row], right: &[Row], to: &mut Matrix) {
        let mut pulled = vec![Complex64::ZERO; to.size()];
        for (p, left) in left.iter().enumerate() {
            pulled.fill(Complex64::ZERO);
            for (k, right) in self.of(p).iter().zip(right) {
                for (j, x) in right {
                    pulled[*j] += x * *k;
                }
            }
            for (i, x) in left {
                for (j, pull) in pulled.iter().enumerate() {
                    to.add(*i, j, x.conj() * pull);
                }
            }
        }
    }

    /// For every span, `Σ_q k_pq ∂ξ_q/∂E`: what pulls at it per strain.
    pub(crate) fn pulls(&self) -> Vec<[f64; 6]> {
        let by: Vec<[f64; 6]> = self.spans.iter().map(Span::by_strain).collect();
        let pull = |p: usize| {
            let mut sum = [0.0; 6];
            for (k, by) in self.of(p).iter().zip(&by) {
                sum.iter_mut().zip(by).for_each(|(s, x)| *s += k * x);
            }
            sum
        };
        (0..self.spans.len()).map(pull).collect()
    }

    /// Springs along the spans (force / length) that are at least as stiff, by Gershgorin's circles.
    pub(crate) fn springs(&self) -> impl Iterator<Item = (&Span<D>, f64)> {
        let length = |s: &Span<D>| s.vector().iter().map(|x| x * x).sum::<f64>().sqrt();
        let lengths: Vec<f64> = self.spans.iter().map(length).collect();
        self.spans.iter().enumerate().map(move |(p, span)| {
            let row = self.of(p).iter().zip(&lengths);
            (span, row.map(|(k, y)| k.abs() * y * lengths[p]).sum())
        })
    }

    /// Turned by `turn`.
    pub(crate) fn turned(&self, turn: impl Fn([f64; D]) -> [f64; D]) -> Self {
        let spans = self.spans.iter().map(|s| Span {
            at: s.at.map(&turn),
            ..*s
        });
        Coupling {
            spans: spans.collect(),
            k: self.k.clone(),
        }
    }
}
