//! Stillinger–Weber: `U_i = ½ Σ_j φ₂(r_ij) + Σ_{j<k} φ₃(r_ij, r_ik, θ_jik)` (Stillinger & Weber 1985, constants as LAMMPS's `sw` has them).
//!
//! `φ₂ = A ε [B (σ/r)ᵖ − (σ/r)^q] exp(σ/(r − aσ))`, `φ₃ = λ ε (cos θ − cos θ₀)² exp(γσ/(r_ij − aσ)) exp(γσ/(r_ik − aσ))`.

use super::described::{Described, Entries, alike, constant};
use super::table::{Row, Table};
use super::{Arm, ManyBody};
use crate::columns::Dimension;
use crate::execute::lane::Lane;
use crate::law::descriptor::{Descriptor, Key, Wrong};
use crate::law::number::{Dual, Over};
use crate::law::slopes::Slopes;
use crate::spec::Parameters;

/// As a line of a `.sw` file has them.
pub const COLUMNS: [Key; 11] = [
    constant("epsilon", Dimension::ENERGY, "Depth ε."),
    constant("sigma", Dimension::LENGTH, "Length σ."),
    constant("a", Dimension::NUMBER, "Cut-off over σ."),
    constant("lambda", Dimension::NUMBER, "Strength λ of triples."),
    constant("gamma", Dimension::NUMBER, "Decay γ of triples."),
    constant("cos_theta0", Dimension::NUMBER, "Cosine of the best angle."),
    constant("A", Dimension::NUMBER, "Strength A of pairs."),
    constant("B", Dimension::NUMBER, "Part B of repulsion."),
    constant("p", Dimension::NUMBER, "Power p of repulsion."),
    constant("q", Dimension::NUMBER, "Power q of attraction."),
    constant(
        "tolerance",
        Dimension::NUMBER,
        "0: nothing is cut before a σ.",
    )
    .or(0.0),
];

/// Places of [`COLUMNS`].
const EPSILON: usize = 0;
const SIGMA: usize = 1;
const A: usize = 2;
const LAMBDA: usize = 3;
const GAMMA: usize = 4;
const COSINE: usize = 5;
const BIG_A: usize = 6;
const BIG_B: usize = 7;
const P: usize = 8;
const Q: usize = 9;
const TOLERANCE: usize = 10;

/// Places in the table: aσ, and below it how near to it exp(σ/(r − aσ)) is 0; γσ, σ; λε, cos θ₀; ½AεBσᵖ, ½Aεσ^q, p, q.
const EDGE: usize = 0;
const MARGIN: usize = 1;
const REACH: usize = 2;
const LENGTH: usize = 3;
const BEND: usize = 4;
const BEST: usize = 5;
const REPULSION: usize = 6;
const ATTRACTION: usize = 7;
const POWERS: [usize; 2] = [8, 9];

#[derive(Debug, Clone, PartialEq)]
pub struct StillingerWeber {
    table: Table,
    cutoff: f64,
    /// p and q, where they are whole and all the same.
    whole: Option<[u32; 2]>,
}

impl StillingerWeber {
    /// `1/r` to the powers p and q.
    #[inline(always)]
    fn powers<L: Lane, N: Over<L>>(&self, inverse: N, of: impl Row) -> [N; 2] {
        match self.whole {
            Some([p, q]) => [inverse.power(p), inverse.power(q)],
            None => {
                let log = inverse.ln();
                let [p, q] = POWERS;
                [
                    (of.get::<L, N>(p) * log).exp(),
                    (of.get::<L, N>(q) * log).exp(),
                ]
            }
        }
    }
}

/// `exp(s/(r − aσ))`, 0 from aσ on.
#[inline(always)]
fn decay<L: Lane, N: Over<L>>(length: N, s: N, of: impl Row) -> N {
    let below = length - of.get::<L, N>(EDGE);
    s.div(below.least(of.get::<L, N>(MARGIN))).exp()
}

impl ManyBody for StillingerWeber {
    const TRIPLES: Option<f64> = Some(0.5);

    fn table(&self) -> &Table {
        &self.table
    }

    fn cutoff(&self) -> f64 {
        self.cutoff
    }

    #[inline(always)]
    fn arm<L: Lane, N: Over<L>>(&self, xi: N, of: impl Row) -> Arm<N> {
        let mut arm = Arm::new(xi);
        arm.weight = decay::<L, N>(arm.length, of.get::<L, N>(REACH), of);
        arm
    }

    #[inline(always)]
    fn share<L: Lane, N: Over<L>>(&self, ij: &Arm<N>, ik: &Arm<N>, closing: N, of: impl Row) -> N {
        let bend = ij.cosine(ik, closing) - of.get::<L, N>(BEST);
        bend * bend * (of.get::<L, N>(BEND) * (ij.weight * ik.weight))
    }

    /// With `u = cos θ − cos θ₀`, `∂cos θ/∂ξ_jk = −1/(r_ij r_ik)` and `∂cos θ/∂ξ_ij = 1/(r_ij r_ik) − cos θ/r_ij²`.
    #[inline(always)]
    fn share_slopes<L: Lane>(
        &self,
        ij: &Arm<Dual<L>>,
        ik: &Arm<Dual<L>>,
        closing: L,
        of: impl Row,
    ) -> Slopes<L, 3> {
        let inverse = ij.inverse.value * ik.inverse.value;
        let cosine = (ij.xi.value + ik.xi.value - closing) * inverse;
        let bend = cosine - of.get::<L, L>(BEST);
        let turn = bend * of.get::<L, L>(BEND);
        let square = bend * turn;
        let weight = ij.weight.value * ik.weight.value;
        let across = (turn + turn) * weight;
        // no closures over lanes: they would not compile for the lanes' instruction set
        let j = inverse - cosine * (ij.inverse.value * ij.inverse.value);
        let k = inverse - cosine * (ik.inverse.value * ik.inverse.value);
        Slopes {
            value: square * weight,
            slope: [
                square.fma(ij.weight.slope * ik.weight.value, across * j),
                square.fma(ij.weight.value * ik.weight.slope, across * k),
                L::splat(0.0) - across * inverse,
            ],
        }
    }

    #[inline(always)]
    fn bond<L: Lane, N: Over<L>>(&self, ij: &Arm<N>, zeta: N, of: impl Row) -> N {
        let [p, q] = self.powers::<L, N>(ij.inverse, of);
        let pair = of.get::<L, N>(REPULSION) * p - of.get::<L, N>(ATTRACTION) * q;
        let decay = decay::<L, N>(ij.length, of.get::<L, N>(LENGTH), of);
        pair * decay + zeta.times(0.5)
    }
}

impl Described for StillingerWeber {
    const NAME: &'static str = "stillinger_weber";

    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "Atoms: pairs A ε [B (σ/r)ᵖ − (σ/r)^q] exp(σ/(r − aσ)) and angles λ ε (cos θ − cos θ₀)² with exp(γσ/(r − aσ)) of both sides. In 3-D, on current neighbours or those of the reference.",
        )
        .source("Stillinger & Weber 1985")
        .example("{ file = \"Si.sw\" }")
        .keys(&super::described::keys(&COLUMNS))
    }

    fn read(parameters: &Parameters) -> Result<Self, Wrong> {
        let entries = Entries::of(parameters, &COLUMNS)?;
        let kinds = entries.kinds();
        for [i, j, k] in entries.all() {
            let row = entries.row([i, j, k])?;
            if row[TOLERANCE] != 0.0 {
                let message = "a tolerance cuts the functions off before aσ, with a jump: write 0";
                return Err(entries.wrong([i, j, k], message));
            }
            alike(&entries, [[i, j, k], [i, k, j]], &[EPSILON, LAMBDA, COSINE])?;
            if j != k {
                continue;
            }
            for (n, what) in [(SIGMA, "sigma"), (A, "a"), (GAMMA, "gamma")] {
                if !(row[n] > 0.0 && row[n].is_finite()) {
                    let message = format!("{what} is {}, expected a positive number", row[n]);
                    return Err(entries.wrong([i, j, k], &message));
                }
            }
            let pair = [EPSILON, SIGMA, A, BIG_A, BIG_B, P, Q];
            alike(&entries, [[i, j, j], [j, i, i]], &pair)?;
        }
        let row = |n| entries.row(n).unwrap_or(&[0.0; COLUMNS.len()]);
        let table = Table::new(kinds, |i, j, k| {
            let (pair, triple) = (row([i, j, j]), row([i, j, k]));
            let (sigma, strength) = (pair[SIGMA], 0.5 * pair[BIG_A] * pair[EPSILON]);
            vec![
                pair[A] * sigma,
                // e^−1000 is 0
                -1e-3 * sigma * pair[GAMMA].min(1.0),
                pair[GAMMA] * sigma,
                sigma,
                triple[LAMBDA] * triple[EPSILON],
                triple[COSINE],
                strength * pair[BIG_B] * libm::pow(sigma, pair[P]),
                strength * libm::pow(sigma, pair[Q]),
                pair[P],
                pair[Q],
            ]
        });
        let powers = [P, Q].map(|n| row([0; 3])[n]);
        let small = |x: f64| (0.0..=64.0).contains(&x) && x.fract() == 0.0;
        let same = entries.all().all(|n| [P, Q].map(|c| row(n)[c]) == powers);
        let whole = same && powers.iter().all(|x| small(*x));
        Ok(StillingerWeber {
            cutoff: table.column(EDGE).fold(0.0, f64::max),
            whole: whole.then(|| powers.map(|x| x as u32)),
            table,
        })
    }
}
