//! Toughness that depends on place and time: critical values of points, by factors of what their materials bear.

use crate::body::Body;
use crate::expression::Expression;
use crate::interaction::history;
use crate::spec::ToughnessFactor;

/// Critical stretches of points.
pub struct ToughnessField {
    /// `[slots]`: s00 of the material; ∞ never breaks.
    base: Vec<f64>,
    /// Slots, and what they have.
    factors: Vec<(Vec<u32>, ToughnessFactor)>,
    /// `[slots]`: critical values of `e`.
    values: Vec<f64>,
}

/// A factor that is not positive.
#[derive(Debug, Clone, Copy)]
pub struct Unfit {
    /// Which one, and where.
    pub number: usize,
    pub slot: usize,
    pub value: f64,
}

fn expression(factor: &ToughnessFactor) -> Option<&Expression> {
    match factor {
        ToughnessFactor::Stretch(e) | ToughnessFactor::Energy(e) => Some(e),
        ToughnessFactor::NoFailure => None,
    }
}

impl ToughnessField {
    /// Of critical stretches of slots, and factors of sets of them; [`set`](Self::set) gives values.
    pub fn new(base: Vec<f64>, factors: Vec<(Vec<u32>, ToughnessFactor)>) -> Self {
        ToughnessField {
            values: vec![f64::INFINITY; base.len()],
            base,
            factors,
        }
    }

    /// Do values differ from time to time?
    pub fn changes(&self) -> bool {
        let mut all = self.factors.iter().filter_map(|(_, f)| expression(f));
        all.any(Expression::depends_on_time)
    }

    /// Critical values of `e`, by slot.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Values of a time.
    ///
    /// # Errors
    /// A factor that is not positive; nothing is changed.
    pub fn set<const D: usize>(&mut self, body: &Body<D>, t: f64) -> Result<(), Unfit> {
        let mut stretch = self.base.clone();
        for (number, (slots, factor)) in self.factors.iter().enumerate() {
            let Some(expression) = expression(factor) else {
                continue;
            };
            for &s in slots {
                let slot = s as usize;
                let x = body.position(slot);
                let value = expression.eval(&x, t);
                if !(value > 0.0) {
                    return Err(Unfit {
                        number,
                        slot,
                        value,
                    });
                }
                stretch[slot] *= match factor {
                    ToughnessFactor::Energy(_) => value.sqrt(),
                    ToughnessFactor::Stretch(_) | ToughnessFactor::NoFailure => value,
                };
            }
        }
        for &s in &body.slots {
            let s0 = stretch[s as usize];
            self.values[s as usize] = s0 * (2.0 + s0);
        }
        let spared = self.factors.iter().filter(|f| expression(&f.1).is_none());
        for &s in spared.flat_map(|f| &f.0) {
            self.values[s as usize] = history::NEVER;
        }
        Ok(())
    }
}
