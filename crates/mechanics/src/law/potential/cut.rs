//! Ends of pair potentials: cut, shifted to zero energy, shifted to zero energy and force, or switched off smoothly.

use super::Potential;
use super::constants::{Constants, MOST, Same};
use crate::columns::Dimension;
use crate::law::descriptor::{Bounds, Key, Need, Wrong, number, word};
use crate::law::number::{Dual, Number};
use crate::spec::{End, Mixing, Parameter, Parameters};

/// Keys of the end of a pair potential.
pub const KEYS: [Key; 3] = [
    number(
        "cutoff",
        Dimension::LENGTH,
        Bounds::POSITIVE,
        "Needed where neighbours are the current ones.",
    )
    .need(Need::Optional),
    word(
        "end",
        &[
            ("truncated", "Cut (by default)."),
            ("shifted", "No jump of the energy."),
            ("shifted_force", "No jump of the force either."),
            ("smooth", "Switched off smoothly."),
        ],
        "How a pair potential ends at its cut-off.",
    ),
    number(
        "smooth_from",
        Dimension::LENGTH,
        Bounds::POSITIVE,
        "Where a smooth end begins; 0.9 of the cut-off by default.",
    )
    .need(Need::Optional),
];

/// Where a potential ends (length; ∞: nowhere), and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ends {
    pub cutoff: f64,
    pub end: End,
}

impl Ends {
    pub const NONE: Ends = Ends {
        cutoff: f64::INFINITY,
        end: End::Truncated,
    };

    /// Of parameters; [`Ends::NONE`] where their law has no such keys.
    ///
    /// # Errors
    /// The key that is wrong, and why.
    pub fn of(parameters: &Parameters) -> Result<Ends, Wrong> {
        let Some(word) = parameters.word("end") else {
            return Ok(Ends::NONE);
        };
        let wrong = |key: &str, message: &str| Err((key.to_string(), message.to_string()));
        let from = parameters.number("smooth_from");
        let Some(cutoff) = parameters.number("cutoff") else {
            return match (from, word) {
                (Some(_), _) => wrong("smooth_from", "smooth_from needs a cutoff"),
                (None, "truncated") => Ok(Ends::NONE),
                (None, _) => wrong("end", "this end needs a cutoff"),
            };
        };
        if from.is_some() && word != "smooth" {
            return wrong(
                "smooth_from",
                "smooth_from belongs to a smooth end: write end = \"smooth\"",
            );
        }
        let end = match word {
            "shifted" => End::Shifted,
            "shifted_force" => End::ShiftedForce,
            "smooth" => End::Smooth(from.unwrap_or(0.9 * cutoff)),
            _ => End::Truncated,
        };
        match end {
            End::Smooth(near) if near >= cutoff => {
                wrong("cutoff", "the smooth end begins beyond the cut-off")
            }
            _ => Ok(Ends { cutoff, end }),
        }
    }

    /// Of a pair of unlike atoms, whose own these are.
    ///
    /// # Errors
    /// They end in different ways.
    pub fn mixed(self, other: Ends, rule: Mixing) -> Result<Ends, Wrong> {
        let length = |a: f64, b: f64| match a.is_finite() && b.is_finite() {
            true => rule.length(a, b),
            false => f64::INFINITY,
        };
        let end = match (self.end, other.end) {
            (End::Smooth(a), End::Smooth(b)) => End::Smooth(rule.length(a, b)),
            (a, b) if a == b => a,
            _ => {
                let message = "the two end in different ways, which no rule mixes";
                return Err(("end".into(), message.into()));
            }
        };
        Ok(Ends {
            cutoff: length(self.cutoff, other.cutoff),
            end,
        })
    }

    /// The other way round.
    pub fn put(&self, parameters: &mut Parameters) {
        let word = match self.end {
            End::Truncated => "truncated",
            End::Shifted => "shifted",
            End::ShiftedForce => "shifted_force",
            End::Smooth(_) => "smooth",
        };
        parameters.set("end", Parameter::Word(word.into()));
        if self.cutoff.is_finite() {
            parameters.set("cutoff", Parameter::Number(self.cutoff));
        }
        if let End::Smooth(near) = self.end {
            parameters.set("smooth_from", Parameter::Number(near));
        }
    }
}

/// Numbers of the keys in order.
///
/// # Errors
/// The first key that has none.
pub fn numbers<const N: usize>(p: &Parameters, keys: [&str; N]) -> Result<[f64; N], Wrong> {
    p.all(keys).map_err(|message| (String::new(), message))
}

/// `g` of seleson2014 (3.9): 1 below x = 0, 0 above x = 1, `g′ = −30 x² (1 − x)²` in between.
#[inline(always)]
pub fn switch<N: Number>(x: N) -> N {
    let one = N::constant(1.0);
    let rest = one - x;
    let inside = rest.power(3) * (one + x.times(3.0) + (x * x).times(6.0));
    x.below(0.0, one, x.below(1.0, inside, N::constant(0.0)))
}

/// A pair potential with an end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cut<P> {
    potential: P,
    cutoff: f64,
    end: End,
    /// What the end does: `φ + [0]`, less `[2] (r + [1])`; or φ times the switch of `[2] (r + [1])`.
    ending: [f64; ENDING],
}

const ENDING: usize = 3;

impl<P: Potential> Cut<P> {
    /// `potential`, ended.
    pub fn new(potential: P, Ends { cutoff, end }: Ends) -> Self {
        let last = || match cutoff.is_finite() {
            true => potential.pair(Dual::variable(cutoff * cutoff)),
            false => Dual::constant(0.0),
        };
        let ending = match end {
            End::Truncated => [0.0; ENDING],
            End::Shifted => [-last().value, 0.0, 0.0],
            // dφ/dr = 2 r dφ/dq
            End::ShiftedForce if cutoff.is_finite() => {
                [-last().value, -cutoff, 2.0 * cutoff * last().slope]
            }
            End::ShiftedForce => [0.0; ENDING],
            End::Smooth(near) => [0.0, -near, 1.0 / (cutoff - near)],
        };
        Cut {
            potential,
            cutoff,
            end,
            ending,
        }
    }
}

impl<P: Potential> Potential for Cut<P> {
    const EMBEDDED: bool = P::EMBEDDED;

    fn cutoff(&self) -> f64 {
        self.cutoff.min(self.potential.cutoff())
    }

    fn length(&self) -> f64 {
        self.potential.length()
    }

    fn made_for(&self) -> Option<f64> {
        self.potential.made_for()
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        self.pair_of(Same(&self.constants()), q)
    }

    const CONSTANTS: usize = match P::CONSTANTS {
        0 => 0,
        n => n + ENDING,
    };

    #[inline(always)]
    fn constants(&self) -> [f64; MOST] {
        let mut all = self.potential.constants();
        for (n, x) in self.ending.iter().enumerate() {
            all[P::CONSTANTS + n] = *x;
        }
        all
    }

    #[inline(always)]
    fn pair_of<N: Number>(&self, of: impl Constants<N>, q: N) -> N {
        let whole = self.potential.pair_of(of, q);
        let [level, start, factor] = [P::CONSTANTS, P::CONSTANTS + 1, P::CONSTANTS + 2];
        match self.end {
            End::Truncated => whole,
            End::Shifted => of.plus(whole, level),
            End::ShiftedForce => of.plus(whole, level) - of.times(of.plus(q.sqrt(), start), factor),
            End::Smooth(_) => whole * switch(of.times(of.plus(q.sqrt(), start), factor)),
        }
    }

    fn is_alike(&self, other: &Self) -> bool {
        let same = std::mem::discriminant(&self.end) == std::mem::discriminant(&other.end);
        same && self.potential.is_alike(&other.potential)
    }

    #[inline(always)]
    fn density<N: Number>(&self, q: N) -> N {
        self.potential.density(q)
    }

    #[inline(always)]
    fn given<N: Number>(&self, q: N) -> N {
        self.potential.given(q)
    }

    #[inline(always)]
    fn embedding<N: Number>(&self, density: N) -> N {
        self.potential.embedding(density)
    }

    fn least_density(&self) -> f64 {
        self.potential.least_density()
    }
}
