//! What a metal flows at: `σ_y = g(ε̄) r(ε̄̇) (1 − T*ᵐ)`, hardening by equivalent plastic strain ε̄, by its rate, and softening by heat,
//! `T* = (T − T_r)/(T_m − T_r)` (Johnson & Cook 1983). The words are written out in the keys.

use crate::columns::Dimension;
use crate::law::descriptor::{self, Bounds, Given, Key, Need, Value};
use crate::law::number::Number;
use crate::spec::Parameters;

/// g(ε̄).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strain {
    Linear,
    Ludwik,
    Swift,
    Voce,
    Table,
}

/// r(ε̄̇).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rate {
    None,
    JohnsonCook,
    Power,
}

/// Which of them all materials of a body have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kind {
    pub strain: Strain,
    pub rate: Rate,
    pub heats: bool,
}

/// Most rows of a table.
const ROWS: usize = 16;
/// Numbers of a material.
pub const COUNT: usize = 9 + 2 * ROWS;
pub type Constants<N> = [N; COUNT];

/// g(0).
const YIELD: usize = 0;
/// H, B, or Q.
const MODULUS: usize = 1;
/// n.
const EXPONENT: usize = 2;
/// One by ε₀ or ε_s.
const PER_STRAIN: usize = 3;
/// One by ε₁².
const SOFTENING: usize = 4;
/// C or m of the rate.
const SENSITIVITY: usize = 5;
/// One by the rate of reference and the step; 0: no time passes.
const PER_RATE: usize = 6;
/// One by T_m − T_r.
const PER_MELTING: usize = 7;
const THERMAL: usize = 8;
/// Strains at which the slope of a table changes, then by how much.
const KNOTS: usize = 9;

const STRAIN_WORDS: &[(&str, &str)] = &[
    (
        "linear",
        "g = σ_y + H ε̄; H = `hardening`, 0 is perfect plasticity",
    ),
    (
        "ludwik",
        "g = σ_y + B ε̄ⁿ; B = `hardening`, n = `exponent` (Ludwik 1909; Johnson & Cook 1983)",
    ),
    (
        "swift",
        "g = σ_y (1 + ε̄/ε₀)ⁿ, over 1 + (ε̄/ε₁)² with a `softening_strain` ε₁; ε₀ = `reference_strain` (Swift 1952; Needleman 1972)",
    ),
    (
        "voce",
        "g = σ_y + Q (1 − exp(−ε̄/ε₀)); Q = `hardening`, ε₀ = `reference_strain` (Voce 1948)",
    ),
    (
        "table",
        "straight lines between the rows of `table`, level beyond",
    ),
];

const RATE_WORDS: &[(&str, &str)] = &[
    ("none", "r = 1"),
    (
        "johnson_cook",
        "r = 1 + C ln(ε̄̇/ε̇₀) above ε̇₀, else 1; C = `rate_sensitivity`, ε̇₀ = `reference_rate` (Johnson & Cook 1983)",
    ),
    (
        "power",
        "r = (ε̄̇/ε̇₀)ᵐ; m = `rate_sensitivity`. Flow begins where the stress is σ_y (Needleman)",
    ),
];

/// A positive number that may be left out.
const fn optional(name: &'static str, dimension: Dimension, doc: &'static str) -> Key {
    descriptor::number(name, dimension, Bounds::POSITIVE, doc).need(Need::Optional)
}

/// All that they are made of.
pub const KEYS: [Key; 13] = [
    descriptor::word(
        "hardening_law",
        STRAIN_WORDS,
        "How the yield stress grows with the equivalent plastic strain, g(ε̄).",
    ),
    optional(
        "yield_stress",
        Dimension::PRESSURE,
        "Yield stress σ_y in tension (von Mises); a table has its own.",
    ),
    descriptor::number(
        "hardening",
        Dimension::PRESSURE,
        Bounds::NOT_NEGATIVE,
        "H, B or Q of the `hardening_law`.",
    )
    .or(0.0),
    optional(
        "exponent",
        Dimension::NUMBER,
        "Hardening exponent n of `ludwik` and `swift`.",
    ),
    optional(
        "reference_strain",
        Dimension::NUMBER,
        "ε₀ of `swift` and `voce`.",
    ),
    optional(
        "softening_strain",
        Dimension::NUMBER,
        "ε₁ of `swift`, beyond which it softens (Needleman); no softening by default.",
    ),
    Key {
        name: "table",
        value: Value::Rows(&[
            ("plastic_strain", Dimension::NUMBER, Bounds::NOT_NEGATIVE),
            ("yield_stress", Dimension::PRESSURE, Bounds::POSITIVE),
        ]),
        need: Need::Optional,
        doc: "Rows of equivalent plastic strain, from 0 on, and yield stress of a `table`, 2 to 16.",
    },
    descriptor::word(
        "rate_law",
        RATE_WORDS,
        "How the yield stress grows with the rate of equivalent plastic strain, r(ε̄̇).",
    ),
    optional(
        "rate_sensitivity",
        Dimension::NUMBER,
        "C or m of the `rate_law`.",
    ),
    optional(
        "reference_rate",
        Dimension::FREQUENCY,
        "ε̇₀ of the `rate_law`.",
    ),
    optional(
        "melting_temperature",
        Dimension::TEMPERATURE,
        "T_m, where nothing is left of the yield stress; no thermal softening by default.",
    ),
    optional(
        "reference_temperature",
        Dimension::TEMPERATURE,
        "T_r of T* = (T − T_r)/(T_m − T_r), where the body is at first; beside [heat] T is that of the body.",
    ),
    descriptor::number(
        "thermal_exponent",
        Dimension::NUMBER,
        Bounds::POSITIVE,
        "m of the softening 1 − T*ᵐ.",
    )
    .or(1.0),
];

/// Of one material, in the order of the numbers; what a step adds is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hardening {
    numbers: Constants<f64>,
    /// ε̇₀.
    reference_rate: f64,
}

/// The words of a material.
pub fn kind(parameters: &Parameters) -> Result<Kind, String> {
    let word = |key| parameters.word(key).unwrap_or_default();
    let strain = match word("hardening_law") {
        "linear" => Strain::Linear,
        "ludwik" => Strain::Ludwik,
        "swift" => Strain::Swift,
        "voce" => Strain::Voce,
        "table" => Strain::Table,
        other => return Err(format!("there is no hardening_law \"{other}\"")),
    };
    let rate = match word("rate_law") {
        "none" => Rate::None,
        "johnson_cook" => Rate::JohnsonCook,
        "power" => Rate::Power,
        other => return Err(format!("there is no rate_law \"{other}\"")),
    };
    Ok(Kind {
        strain,
        rate,
        heats: parameters.number("melting_temperature").is_some(),
    })
}

impl Hardening {
    /// # Errors
    /// A key that its words need is not there, one that they do not know is, or a table does not rise.
    pub fn of(material: &Given, kind: Kind) -> Result<Hardening, String> {
        let parameters = material.parameters;
        let number = |key| parameters.number(key);
        let word = |key| parameters.word(key).unwrap_or_default();
        let (law, rate) = (word("hardening_law"), word("rate_law"));
        // (key, is it known to the words, must it be given)
        let by_strain = |all: &[Strain]| all.contains(&kind.strain);
        let table = kind.strain == Strain::Table;
        let rates = kind.rate != Rate::None;
        let (exponent, reference) = (
            by_strain(&[Strain::Ludwik, Strain::Swift]),
            by_strain(&[Strain::Swift, Strain::Voce]),
        );
        let wanted = [
            ("yield_stress", !table, true, law),
            ("exponent", exponent, true, law),
            ("reference_strain", reference, true, law),
            ("softening_strain", kind.strain == Strain::Swift, false, law),
            ("rate_sensitivity", rates, true, rate),
            (
                "reference_temperature",
                kind.heats,
                true,
                "melting_temperature",
            ),
        ];
        for (key, known, must, who) in wanted {
            match (number(key), known) {
                (Some(_), false) => return Err(format!("`{key}` says nothing where {who} stands")),
                (None, true) if must => return Err(format!("{who} needs `{key}`")),
                (Some(_) | None, _) => {}
            }
        }
        let damaged = parameters.list("damage").is_some();
        match number("reference_rate") {
            None if rates => return Err(format!("{rate} needs `reference_rate`")),
            Some(_) if !rates && !damaged => {
                return Err("`reference_rate` says nothing without a rate_law or damage".into());
            }
            Some(_) | None => {}
        }
        let hardens = by_strain(&[Strain::Linear, Strain::Ludwik, Strain::Voce]);
        if !hardens && number("hardening").is_some_and(|h| h != 0.0) {
            return Err(format!("`hardening` says nothing where {law} stands"));
        }
        let of = |key| number(key).unwrap_or(0.0);
        let inverse = |key| number(key).map_or(0.0, f64::recip);
        let mut numbers = [0.0; COUNT];
        numbers[YIELD] = of("yield_stress");
        numbers[MODULUS] = of("hardening");
        numbers[EXPONENT] = of("exponent");
        numbers[PER_STRAIN] = inverse("reference_strain");
        numbers[SOFTENING] = inverse("softening_strain").powi(2);
        numbers[SENSITIVITY] = of("rate_sensitivity");
        numbers[THERMAL] = of("thermal_exponent");
        if kind.heats {
            let span = of("melting_temperature") - of("reference_temperature");
            if span <= 0.0 {
                return Err("the melting temperature is not above that of reference".into());
            }
            numbers[PER_MELTING] = span.recip();
        }
        match (parameters.rows("table"), table) {
            (Some(rows), true) => lines(rows, &mut numbers)?,
            (None, true) => return Err("table needs the rows of `table`".into()),
            (Some(_), false) => {
                return Err(format!("`table` says nothing where {law} stands"));
            }
            (None, false) => {}
        }
        Ok(Hardening {
            numbers,
            reference_rate: of("reference_rate"),
        })
    }

    /// For a step of length `dt`.
    pub fn constants(&self, dt: f64) -> Constants<f64> {
        let mut numbers = self.numbers;
        if dt > 0.0 && self.reference_rate > 0.0 {
            numbers[PER_RATE] = (dt * self.reference_rate).recip();
        }
        numbers
    }
}

/// Rows of a table as a first value and changes of slope.
fn lines(rows: &[Vec<f64>], numbers: &mut Constants<f64>) -> Result<(), String> {
    if rows.len() < 2 || rows.len() > ROWS {
        return Err(format!(
            "`table` has {} rows, expected 2 to {ROWS}",
            rows.len()
        ));
    }
    if rows[0][0] != 0.0 {
        return Err(format!(
            "`table` begins at a plastic strain of {}, expected 0",
            rows[0][0]
        ));
    }
    numbers[YIELD] = rows[0][1];
    let mut before = 0.0;
    for (k, row) in rows.iter().enumerate() {
        let slope = match rows.get(k + 1) {
            None => 0.0,
            Some(next) if next[0] <= row[0] => {
                return Err(format!(
                    "strains of `table` do not rise: {} follows {}",
                    next[0], row[0]
                ));
            }
            Some(next) if next[1] < row[1] => {
                return Err(format!(
                    "`table` softens: a yield stress of {} follows {}; softening has no length of its own, take fracture or damage for it",
                    next[1], row[1]
                ));
            }
            Some(next) => (next[1] - row[1]) / (next[0] - row[0]),
        };
        numbers[KNOTS + k] = row[0];
        numbers[KNOTS + ROWS + k] = slope - before;
        before = slope;
    }
    Ok(())
}

/// xⁿ, 0 of 0.
#[inline(always)]
fn power<N: Number>(x: N, n: N) -> N {
    let zero = N::constant(0.0);
    zero.choose(x, (n * x.ln()).exp(), zero)
}

impl Kind {
    /// g and its slope.
    #[inline(always)]
    fn hardened<N: Number>(self, c: &Constants<N>, strain: N) -> [N; 2] {
        let (zero, one) = (N::constant(0.0), N::constant(1.0));
        match self.strain {
            Strain::Linear => [c[MODULUS].fma(strain, c[YIELD]), c[MODULUS]],
            Strain::Ludwik => {
                let more = c[MODULUS] * power(strain, c[EXPONENT]);
                [c[YIELD] + more, c[EXPONENT] * more.div(strain)]
            }
            Strain::Swift => {
                let base = c[PER_STRAIN].fma(strain, one);
                let hard = c[YIELD] * power(base, c[EXPONENT]);
                let soft = (c[SOFTENING] * strain).fma(strain, one).recip();
                let slope = hard * (c[EXPONENT] * c[PER_STRAIN]).div(base);
                let two = N::constant(2.0);
                let falls = two * c[SOFTENING] * strain * soft;
                [hard * soft, soft * (slope - hard * falls)]
            }
            Strain::Voce => {
                let rest = c[MODULUS] * (zero - c[PER_STRAIN] * strain).exp();
                [c[YIELD] + (c[MODULUS] - rest), c[PER_STRAIN] * rest]
            }
            Strain::Table => {
                let (mut value, mut slope) = (c[YIELD], zero);
                for k in 0..ROWS {
                    let bend = c[KNOTS + ROWS + k];
                    let beyond = strain - c[KNOTS + k];
                    value = zero.choose(beyond, bend.fma(beyond, value), value);
                    slope = zero.choose(beyond, slope + bend, slope);
                }
                [value, slope]
            }
        }
    }

    /// 1 − T*ᵐ of a rise of the temperature.
    #[inline(always)]
    pub fn softened<N: Number>(self, c: &Constants<N>, rise: N) -> N {
        let one = N::constant(1.0);
        if !self.heats {
            return one;
        }
        let part = homologous(c, rise);
        part.choose(one, one - power(part, c[THERMAL]), N::constant(0.0))
    }

    /// Where flow begins: the yield stress without a rate.
    #[inline(always)]
    pub fn begins<N: Number>(self, c: &Constants<N>, strain: N, soft: N) -> N {
        match self.rate {
            Rate::None | Rate::JohnsonCook => soft * self.hardened(c, strain)[0],
            Rate::Power => soft * c[YIELD],
        }
    }

    /// Above 0 where the step has a length that the rate can be told by.
    #[inline(always)]
    pub fn flows<N: Number>(self, c: &Constants<N>) -> N {
        match self.rate {
            Rate::None => N::constant(1.0),
            Rate::JohnsonCook | Rate::Power => c[PER_RATE],
        }
    }

    /// σ_y at the end of a step in which the plastic strain grows by `more`, and its slope in that.
    #[inline(always)]
    pub fn yields<N: Number>(self, c: &Constants<N>, strain: N, more: N, soft: N) -> [N; 2] {
        let [g, slope] = self.hardened(c, strain + more);
        let (g, slope) = (soft * g, soft * slope);
        let one = N::constant(1.0);
        match self.rate {
            Rate::None => [g, slope],
            Rate::JohnsonCook => {
                let rate = more * c[PER_RATE];
                let r = one.choose(rate, c[SENSITIVITY].fma(rate.ln(), one), one);
                let rises = one.choose(rate, c[SENSITIVITY].div(more), N::constant(0.0));
                [g * r, slope.fma(r, g * rises)]
            }
            Rate::Power => {
                let r = power(more * c[PER_RATE], c[SENSITIVITY]);
                let rises = r * c[SENSITIVITY].div(more);
                [g * r, slope.fma(r, g * rises)]
            }
        }
    }
}

/// T*, from 0 on.
#[inline(always)]
pub fn homologous<N: Number>(c: &Constants<N>, rise: N) -> N {
    (c[PER_MELTING] * rise).most(N::constant(0.0))
}

/// ln of the rate of a growth over that of reference, from 0 on.
#[inline(always)]
pub fn rate<N: Number>(c: &Constants<N>, more: N) -> N {
    (more * c[PER_RATE]).most(N::constant(1.0)).ln()
}
