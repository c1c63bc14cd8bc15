//! The `peri` pair styles and their coefficients.

/// `pair_style`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    Pmb,
    Lps,
    Ves,
    Eps,
}

impl Style {
    pub const ALL: [Style; 4] = [Style::Pmb, Style::Lps, Style::Ves, Style::Eps];

    /// As scripts have it.
    pub const fn name(self) -> &'static str {
        match self {
            Style::Pmb => "peri/pmb",
            Style::Lps => "peri/lps",
            Style::Ves => "peri/ves",
            Style::Eps => "peri/eps",
        }
    }

    /// Coefficients after the two types: their names, and in short.
    pub const fn coefficients(self) -> (&'static [&'static str], &'static str) {
        match self {
            Style::Pmb => (
                &["the micromodulus c", HORIZON, STRETCH, "alpha"],
                "c horizon s00 alpha",
            ),
            Style::Lps => (
                &[BULK, SHEAR, HORIZON, STRETCH, "alpha"],
                "K G horizon s00 alpha",
            ),
            Style::Ves => (
                &[
                    BULK,
                    SHEAR,
                    HORIZON,
                    STRETCH,
                    "alpha",
                    "the part m_lambdai of the shear modulus that relaxes",
                    "the relaxation time m_taui",
                ],
                "K G horizon s00 alpha m_lambdai m_taui",
            ),
            Style::Eps => (
                &[
                    BULK,
                    SHEAR,
                    HORIZON,
                    STRETCH,
                    "alpha",
                    "the yield stress m_yield_stress",
                ],
                "K G horizon s00 alpha m_yield_stress",
            ),
        }
    }

    /// All pairs of types, from the numbers of each in the order of [`Style::coefficients`]; `None` if a pair has none.
    pub fn pair(self, types: usize, values: &[Option<Vec<f64>>]) -> Option<Pair> {
        let lps = |v: &[f64]| LpsCoefficients {
            bulk: v[0],
            shear: v[1],
            horizon: v[2],
            critical_stretch: v[3],
            alpha: v[4],
        };
        Some(match self {
            Style::Pmb => Pair::Pmb(PairTable::complete(types, values, |v| PmbCoefficients {
                micromodulus: v[0],
                horizon: v[1],
                critical_stretch: v[2],
                alpha: v[3],
            })?),
            Style::Lps => Pair::Lps(PairTable::complete(types, values, lps)?),
            Style::Ves => Pair::Ves(PairTable::complete(types, values, |v| VesCoefficients {
                solid: lps(v),
                part: v[5],
                time: v[6],
            })?),
            Style::Eps => Pair::Eps(PairTable::complete(types, values, |v| EpsCoefficients {
                solid: lps(v),
                yield_stress: v[5],
            })?),
        })
    }
}

pub const HORIZON: &str = "the horizon";
const BULK: &str = "the bulk modulus K";
const SHEAR: &str = "the shear modulus G";
const STRETCH: &str = "the critical stretch s00";

/// `pair_style` and `pair_coeff`.
#[derive(Debug, Clone, PartialEq)]
pub enum Pair {
    Pmb(PairTable<PmbCoefficients>),
    Lps(PairTable<LpsCoefficients>),
    Ves(PairTable<VesCoefficients>),
    Eps(PairTable<EpsCoefficients>),
}

impl Pair {
    /// Number of atom types.
    pub fn types(&self) -> usize {
        match self {
            Pair::Pmb(table) => table.types(),
            Pair::Lps(table) => table.types(),
            Pair::Ves(table) => table.types(),
            Pair::Eps(table) => table.types(),
        }
    }

    pub fn style(&self) -> Style {
        match self {
            Pair::Pmb(_) => Style::Pmb,
            Pair::Lps(_) => Style::Lps,
            Pair::Ves(_) => Style::Ves,
            Pair::Eps(_) => Style::Eps,
        }
    }
}

/// Coefficients for every pair of atom types; symmetric, complete.
#[derive(Debug, Clone, PartialEq)]
pub struct PairTable<T> {
    types: usize,
    values: Vec<T>,
}

impl<T: Copy> PairTable<T> {
    /// `None` if a pair has no coefficients. `values[(i−1)·types + (j−1)]` for types `i`, `j` from 1.
    fn complete(
        types: usize,
        values: &[Option<Vec<f64>>],
        of: impl Fn(&[f64]) -> T,
    ) -> Option<Self> {
        let all = values.iter().map(|v| v.as_deref().map(&of));
        let values = all.collect::<Option<Vec<T>>>()?;
        (values.len() == types * types).then_some(PairTable { types, values })
    }
    /// Number of atom types.
    pub fn types(&self) -> usize {
        self.types
    }
    /// For atom types `i` and `j`, from 1 to [`PairTable::types`].
    pub fn get(&self, i: usize, j: usize) -> T {
        self.values[(i - 1) * self.types + (j - 1)]
    }
}

/// `pair_coeff I J c δ s00 α` of `peri/pmb`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PmbCoefficients {
    /// Micromodulus c as typed.
    pub micromodulus: f64,
    /// Horizon δ as typed (bonds have `r² ≤ δ²`).
    pub horizon: f64,
    pub critical_stretch: f64,
    pub alpha: f64,
}

/// `pair_coeff I J K G δ s00 α` of `peri/lps`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LpsCoefficients {
    pub bulk: f64,
    pub shear: f64,
    /// Horizon δ as typed.
    pub horizon: f64,
    pub critical_stretch: f64,
    pub alpha: f64,
}

/// `pair_coeff I J K G δ s00 α λ τ` of `peri/ves`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VesCoefficients {
    pub solid: LpsCoefficients,
    /// Part λ of the shear modulus that relaxes.
    pub part: f64,
    /// Relaxation time τ.
    pub time: f64,
}

/// `pair_coeff I J K G δ s00 α σ_y` of `peri/eps`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EpsCoefficients {
    pub solid: LpsCoefficients,
    /// Yield stress σ_y.
    pub yield_stress: f64,
}
