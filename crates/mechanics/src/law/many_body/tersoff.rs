//! Tersoff: `U_i = ½ Σ_j f_C(r_ij) [A e^(−λ₁ r_ij) − b_ij B e^(−λ₂ r_ij)]` (Tersoff 1988, 1989, constants as LAMMPS's `tersoff` has them).
//!
//! `b = (1 + (β ζ)ⁿ)^(−1/2n)`, `ζ_ij = Σ_k f_C(r_ik) g(θ_jik) exp[(λ₃ (r_ij − r_ik))^m]`,
//! `g = γ [1 + c²/d² − c²/(d² + (cos θ − cos θ₀)²)]`, `f_C` falls from 1 at R − D to 0 at R + D as ½ − ½ sin(½π (r − R)/D).

use super::described::{Described, Entries, alike, constant};
use super::table::{Row, Table};
use super::{Arm, ManyBody};
use crate::columns::Dimension;
use crate::execute::lane::Lane;
use crate::law::descriptor::{Descriptor, Key, Wrong};
use crate::law::number::{Number, Over};
use crate::spec::Parameters;

/// As a line of a `.tersoff` file has them.
pub const COLUMNS: [Key; 14] = [
    constant("m", Dimension::NUMBER, "Power m, 1 or 3."),
    constant("gamma", Dimension::NUMBER, "Factor γ of g."),
    constant("lambda3", Dimension::INVERSE_LENGTH, "λ₃."),
    constant("c", Dimension::NUMBER, "Strength c of g."),
    constant("d", Dimension::NUMBER, "Width d of g."),
    constant(
        "cos_theta0",
        Dimension::NUMBER,
        "Cosine at which g is least.",
    ),
    constant("n", Dimension::NUMBER, "Power n of b."),
    constant("beta", Dimension::NUMBER, "Factor β of b."),
    constant(
        "lambda2",
        Dimension::INVERSE_LENGTH,
        "Decay λ₂ of attraction.",
    ),
    constant("B", Dimension::ENERGY, "Strength B of attraction."),
    constant("R", Dimension::LENGTH, "Middle R of the cut-off."),
    constant("D", Dimension::LENGTH, "Half width D of the cut-off."),
    constant(
        "lambda1",
        Dimension::INVERSE_LENGTH,
        "Decay λ₁ of repulsion.",
    ),
    constant("A", Dimension::ENERGY, "Strength A of repulsion."),
];

/// Places of [`COLUMNS`].
const M: usize = 0;
const GAMMA: usize = 1;
const LAMBDA3: usize = 2;
const C: usize = 3;
const D: usize = 4;
const COSINE: usize = 5;
const N_: usize = 6;
const BETA: usize = 7;
const LAMBDA2: usize = 8;
const BIG_B: usize = 9;
const MIDDLE: usize = 10;
const HALF: usize = 11;
const LAMBDA1: usize = 12;
const BIG_A: usize = 13;

/// Places in the table. Of pairs: R, 1/D, ½A, −λ₁, ½B, −λ₂, β, n, −1/2n, the βζ below which b is 1 to rounding.
const MIDDLE_OF: usize = 0;
const OVER_HALF: usize = 1;
const REPULSION: usize = 2;
const REPULSION_DECAY: usize = 3;
const ATTRACTION: usize = 4;
const ATTRACTION_DECAY: usize = 5;
const SCALE: usize = 6;
const POWER: usize = 7;
const ROOT: usize = 8;
const LEAST: usize = 9;
/// Of triples: γ, γc²/d², d², cos θ₀, λ₃, m; R and 1/D of their own.
const FACTOR: usize = 10;
const STRENGTH: usize = 11;
const WIDTH: usize = 12;
const BEST: usize = 13;
const STRETCH: usize = 14;
const STRETCH_POWER: usize = 15;
const OWN_MIDDLE: usize = 16;
const OWN_HALF: usize = 17;

/// Exponents of ζ are at most this; LAMMPS's 1e30.
const MOST: f64 = 69.0776;

#[derive(Debug, Clone, PartialEq)]
pub struct Tersoff {
    table: Table,
    cutoff: f64,
    /// Has any triple a λ₃?
    stretched: bool,
    /// Is the cut-off of i–k in every triple that of the pair?
    alike: bool,
}

/// `sin(½πx)/x` in x² (Taylor; the rest is below 1e-19 for |x| ≤ 1).
const SINE: [f64; 12] = {
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut all = [quarter; 12];
    let mut k = 1;
    while k < 12 {
        let n = (2 * k) as f64;
        all[k] = -all[k - 1] * quarter * quarter / (n * (n + 1.0));
        k += 1;
    }
    all
};

/// f_C.
#[inline(always)]
fn cut<N: Number>(length: N, middle: N, over_half: N) -> N {
    let (zero, one) = (N::constant(0.0), N::constant(1.0));
    let x = (length - middle) * over_half;
    let square = x * x;
    let mut sine = N::constant(SINE[11]);
    let mut k = 11;
    while k > 0 {
        k -= 1;
        sine = sine.fma(square, N::constant(SINE[k]));
    }
    let inside = (sine * x).times(-0.5).plus(0.5);
    x.below(-1.0, one, x.below(1.0, inside, zero))
}

#[cfg(test)]
impl Tersoff {
    /// The same in a list of neighbours that reaches so far.
    pub(super) fn reaching(self, cutoff: f64) -> Tersoff {
        Tersoff { cutoff, ..self }
    }
}

impl ManyBody for Tersoff {
    const TRIPLES: Option<f64> = None;

    fn table(&self) -> &Table {
        &self.table
    }

    fn cutoff(&self) -> f64 {
        self.cutoff
    }

    #[inline(always)]
    fn arm<L: Lane, N: Over<L>>(&self, xi: N, of: impl Row) -> Arm<N> {
        let mut arm = Arm::new(xi);
        let [middle, half] = [of.get::<L, N>(MIDDLE_OF), of.get::<L, N>(OVER_HALF)];
        // far away its powers would be no numbers
        let length = arm.length.least(middle.times(4.0));
        arm.weight = cut(length, middle, half);
        arm
    }

    #[inline(always)]
    fn share<L: Lane, N: Over<L>>(&self, ij: &Arm<N>, ik: &Arm<N>, closing: N, of: impl Row) -> N {
        let off = of.get::<L, N>(BEST) - ij.cosine(ik, closing);
        let square = off * off;
        let g = square.div(square + of.get::<L, N>(WIDTH));
        let g = of.get::<L, N>(STRENGTH).fma(g, of.get::<L, N>(FACTOR));
        let weight = match self.alike {
            true => ik.weight,
            false => {
                let [middle, half] = [of.get::<L, N>(OWN_MIDDLE), of.get::<L, N>(OWN_HALF)];
                cut(ik.length.least(middle.times(4.0)), middle, half)
            }
        };
        if !self.stretched {
            return weight * g;
        }
        let longer = of.get::<L, N>(STRETCH) * (ij.length - ik.length);
        let power = of.get::<L, N>(STRETCH_POWER);
        let exponent = power.below(2.0, longer, longer * longer * longer);
        weight * g * exponent.least(N::constant(MOST)).exp()
    }

    #[inline(always)]
    fn bond<L: Lane, N: Over<L>>(&self, ij: &Arm<N>, zeta: N, of: impl Row) -> N {
        // b by ln(1 + eᵘ), u = n ln βζ, which neither overflows nor loses what is small
        let scaled = of.get::<L, N>(SCALE) * zeta;
        let u = of.get::<L, N>(POWER) * scaled.most(of.get::<L, N>(LEAST)).ln();
        let (zero, down) = (N::constant(0.0), u.times(-1.0));
        let small = u.below(0.0, u, down).exp();
        let log = small.plus(1.0).ln() + u.below(0.0, zero, u);
        let b = (of.get::<L, N>(ROOT) * log).exp();
        let repulsion = (of.get::<L, N>(REPULSION_DECAY) * ij.length).exp();
        let attraction = (of.get::<L, N>(ATTRACTION_DECAY) * ij.length).exp();
        let inside =
            of.get::<L, N>(REPULSION) * repulsion - of.get::<L, N>(ATTRACTION) * (b * attraction);
        ij.weight * inside
    }
}

impl Described for Tersoff {
    const NAME: &'static str = "tersoff";

    fn descriptor() -> Descriptor {
        Descriptor::new(
            Self::NAME,
            "Atoms: f_C(r) [A e^(−λ₁ r) − b B e^(−λ₂ r)], where b falls with the number and the angles of other bonds. In 3-D, on current neighbours or those of the reference.",
        )
        .source("Tersoff 1988, 1989")
        .example("{ file = \"Si.tersoff\" }")
        .keys(&super::described::keys(&COLUMNS))
    }

    fn read(parameters: &Parameters) -> Result<Self, Wrong> {
        let entries = Entries::of(parameters, &COLUMNS)?;
        let kinds = entries.kinds();
        for at in entries.all() {
            let (row, [i, j, k]) = (entries.row(at)?, at);
            if row[M] != 1.0 && row[M] != 3.0 {
                let message = format!("m is {}, expected 1 or 3", row[M]);
                return Err(entries.wrong(at, &message));
            }
            let positive: &[(usize, &str)] = match j == k {
                true => &[(D, "d"), (N_, "n"), (MIDDLE, "R"), (HALF, "D")],
                false => &[(D, "d"), (MIDDLE, "R"), (HALF, "D")],
            };
            for (n, what) in positive {
                if !(row[*n] > 0.0 && row[*n].is_finite()) {
                    let message = format!("{what} is {}, expected a positive number", row[*n]);
                    return Err(entries.wrong(at, &message));
                }
            }
            if row[BETA] < 0.0 || row[GAMMA] < 0.0 {
                return Err(entries.wrong(at, "beta and gamma are 0 or more"));
            }
            if j == k {
                let pair = [LAMBDA1, BIG_A, MIDDLE, HALF];
                alike(&entries, [[i, j, j], [j, i, i]], &pair)?;
            }
        }
        let row = |n| entries.row(n).unwrap_or(&[0.0; COLUMNS.len()]);
        let table = Table::new(kinds, |i, j, k| {
            let (p, t) = (row([i, j, j]), row([i, j, k]));
            let ratio = t[C] * t[C] / (t[D] * t[D]);
            vec![
                p[MIDDLE],
                1.0 / p[HALF],
                0.5 * p[BIG_A],
                -p[LAMBDA1],
                0.5 * p[BIG_B],
                -p[LAMBDA2],
                p[BETA],
                p[N_],
                -0.5 / p[N_],
                libm::pow(2e-16 * p[N_], 1.0 / p[N_]),
                t[GAMMA],
                t[GAMMA] * ratio,
                t[D] * t[D],
                t[COSINE],
                t[LAMBDA3],
                t[M],
                t[MIDDLE],
                1.0 / t[HALF],
            ]
        });
        let ends = |n| [MIDDLE, HALF].map(|c| row(n)[c]);
        let own = |[i, j, k]: [usize; 3]| ends([i, j, k]) == ends([i, k, k]);
        let alike = entries.all().all(own);
        let reach = |n| ends(n).iter().sum::<f64>();
        let cutoff = entries.all().map(reach).fold(0.0, f64::max);
        let stretched = table.column(STRETCH).any(|x| x != 0.0);
        Ok(Tersoff {
            cutoff,
            stretched,
            alike,
            table,
        })
    }
}
