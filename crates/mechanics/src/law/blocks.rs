//! Second derivatives of an energy of distances, by pairs of its particles. With `H` the Hessian of a term that does not change when all
//! move alike, `δf_a = Σ_b C_ab (δx_b − δx_a)`, `C_ab = −H_ab`.

/// Two particles of a term.
#[derive(Debug, Clone, PartialEq)]
pub struct PairTangent<const D: usize> {
    pub a: u32,
    pub b: u32,
    /// From a to b (length).
    pub y: [f64; D],
    /// `G_ab` (energy / length²).
    pub pull: f64,
    /// `C_ab` (energy / length²); that of b and a is its transpose.
    pub block: [[f64; D]; D],
}

/// Derivatives by the ξ = d²/2 of all pairs of some particles.
pub struct Quadratic {
    pairs: usize,
    pub first: Vec<f64>,
    pub second: Vec<f64>,
}

/// Place of a pair: those of (1,0), (2,0), (2,1), (3,0), …
pub fn place(a: usize, b: usize) -> usize {
    let (high, low) = (a.max(b), a.min(b));
    high * (high - 1) / 2 + low
}

impl Quadratic {
    pub fn new(particles: usize) -> Quadratic {
        let pairs = particles * particles.saturating_sub(1) / 2;
        Quadratic {
            pairs,
            first: vec![0.0; pairs],
            second: vec![0.0; pairs * pairs],
        }
    }

    pub fn pairs(&self) -> usize {
        self.pairs
    }

    /// A function of some of them by its derivatives, times a factor.
    pub fn add(
        &mut self,
        of: &[usize],
        first: &[f64],
        second: impl Fn(usize, usize) -> f64,
        factor: f64,
    ) {
        for (m, p) in of.iter().enumerate() {
            self.first[*p] += factor * first[m];
            for (n, q) in of.iter().enumerate() {
                self.second[p * self.pairs + q] += factor * second(m, n);
            }
        }
    }

    /// Every pair of the particles, which are at `at`, once; a comes before b.
    pub fn visit<const D: usize>(&self, at: &[[f64; D]], visit: &mut dyn FnMut(PairTangent<D>)) {
        // the slope of ξ of a pair by the place of its first
        let from = |a: usize, b: usize| crate::array::from_fn::<f64, D, _>(|c| at[a][c] - at[b][c]);
        let others = |a: usize| (0..at.len()).filter(move |b| *b != a);
        for b in 1..at.len() {
            for a in 0..b {
                let pull = self.first[place(a, b)];
                let mut block = [[0.0; D]; D];
                for (c, row) in block.iter_mut().enumerate() {
                    row[c] += pull;
                }
                for c in others(a) {
                    let (p, x) = (place(a, c), from(a, c));
                    for d in others(b) {
                        let k = self.second[p * self.pairs + place(b, d)];
                        let y = from(b, d);
                        for (row, x) in block.iter_mut().zip(x) {
                            for (e, y) in row.iter_mut().zip(y) {
                                *e -= k * x * y;
                            }
                        }
                    }
                }
                visit(PairTangent {
                    a: a as u32,
                    b: b as u32,
                    y: from(b, a),
                    pull,
                    block,
                });
            }
        }
    }
}
