//! β of the Gaussian. With the middle m and the half length h of what lies within the end of φ, in widths,
//! `∫ e^(−t²/2) dt = 2h e^(−m²/2) Σ_j He_2j(m) h^2j/(2j + 1)!`, for `e^(−mt − t²/2)` generates Hermite's polynomials. A term is below
//! `h^2j √((2j)!)/(2j + 1)!` of the peak, so that as many are taken as the bond's length asks for, the same for all points. Bonds of more than
//! two widths have error functions.

use crate::kernel::GAUSSIAN_END;
use crate::patch::{EIGHT, Lanes};
use crate::segment::{Segment, View};
use peridyne::execute::lane::elementary::exp;

/// Terms of a series at most: of bonds of two widths.
const TERMS: usize = 15;

/// A bond that is longer has error functions (units of the radius of φ).
pub(crate) const LONGEST: f64 = 2.0 / GAUSSIAN_END;

/// How many terms a bond of half length h (widths) has.
fn terms(h: f64) -> usize {
    let mut size = 1.0;
    for j in 1..TERMS {
        // √((2j)!)/(2j + 1)! from that before
        let (a, b) = ((2 * j - 1) as f64, (2 * j) as f64);
        size *= h * h * (a * b).sqrt() / ((b + 1.0) * b);
        if size < 1e-17 {
            return j;
        }
    }
    TERMS
}

#[inline(always)]
pub(crate) fn bonds(all: &[Segment], view: &View, list: &[u32], out: &mut [Lanes]) {
    for (n, out) in list.iter().zip(out) {
        let of = all[*n as usize];
        if of.length > LONGEST {
            continue;
        }
        let mut pieces = [[0.0; 3]; EIGHT];
        if of.is_here() {
            for k in 0..EIGHT {
                pieces[k] = piece(of.foot::<true>(view, k), of.length);
            }
        } else {
            for k in 0..EIGHT {
                pieces[k] = piece(of.foot::<false>(view, k), of.length);
            }
        }
        let (mut peak, mut middle, mut half) = (Lanes::ZERO, Lanes::ZERO, Lanes::ZERO);
        for k in 0..EIGHT {
            [peak[k], middle[k], half[k]] = pieces[k];
        }
        let (mut sum, mut term, mut before) = (Lanes::ONE, Lanes::ONE, Lanes::ZERO);
        for j in 0..terms(0.5 * GAUSSIAN_END * of.length) {
            let next = Next::new(j);
            for k in 0..EIGHT {
                let found = next.of([term[k], before[k]], middle[k], half[k]);
                (before[k], term[k]) = (term[k], found);
                sum[k] += found;
            }
        }
        for k in 0..EIGHT {
            out[k] = peak[k] * sum[k];
        }
    }
}

/// The same of one point.
pub(crate) fn at_point(foot: [f64; 2], length: f64) -> f64 {
    let [peak, middle, half] = piece(foot, length);
    let (mut sum, mut term, mut before) = (1.0, 1.0, 0.0);
    for j in 0..terms(0.5 * GAUSSIAN_END * length) {
        let found = Next::new(j).of([term, before], middle, half);
        (before, term) = (term, found);
        sum += found;
    }
    peak * sum
}

/// `2h e^(−m²/2)` times what the line's distance leaves (units of the radius); m² and h² (widths²).
#[inline(always)]
fn piece([foot, rest]: [f64; 2], length: f64) -> [f64; 3] {
    let rest = if rest > 0.0 { rest } else { 0.0 };
    let half = rest.sqrt();
    let low = if foot < half { foot } else { half };
    let high = length - foot;
    let high = if high < half { high } else { half };
    let span = high + low;
    let span = if span > 0.0 { span } else { 0.0 };
    let m = 0.5 * GAUSSIAN_END * (high - low);
    let h = 0.5 * GAUSSIAN_END * span;
    let far = m.mul_add(m, GAUSSIAN_END * GAUSSIAN_END * (1.0 - rest));
    [span * exp(-0.5 * far), m * m, h * h]
}

/// From terms j and j − 1 to the next: `He_k+2 = (m² − 2k − 1) He_k − k (k − 1) He_k−2`, k = 2j.
struct Next {
    less: f64,
    back: f64,
    over: f64,
}

impl Next {
    #[inline(always)]
    fn new(j: usize) -> Next {
        let k = (2 * j) as f64;
        Next {
            less: 2.0 * k + 1.0,
            back: (k - 1.0) / (k + 1.0),
            over: 1.0 / ((k + 2.0) * (k + 3.0)),
        }
    }

    #[inline(always)]
    fn of(&self, [term, before]: [f64; 2], middle: f64, half: f64) -> f64 {
        let own = (middle - self.less) * term;
        (half * self.over) * (-self.back * half).mul_add(before, own)
    }
}
