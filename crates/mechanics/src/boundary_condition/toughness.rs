//! Toughness that depends on place, time and temperature: critical values of points, by factors of what their materials bear.

use crate::body::Body;
use crate::expression::Expression;
use crate::interaction::history;
use crate::spec::ToughnessFactor;
use crate::state::Archive;
use std::borrow::Cow;

/// Critical values of points.
pub struct SpatialToughness {
    /// `[slots]`: what bonds of a point break by, those of one body alike.
    resistance: Vec<Resistance>,
    /// `[slots]`: s00 of the material, or the root of its critical work; ∞ never breaks.
    base: Vec<f64>,
    /// Slots, and what they have.
    factors: Vec<(Vec<u32>, ToughnessFactor)>,
    /// `[slots]`: critical values of `e`, or critical works.
    values: Vec<f64>,
}

/// What bonds break by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resistance {
    Stretch,
    Work,
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
        ToughnessFactor::Temperature(_) | ToughnessFactor::NoFailure => None,
    }
}

impl Resistance {
    /// The column that has critical values of it, and whether these count in the first evaluation of a run: critical stretches are known after it.
    pub fn column(self) -> (&'static str, bool) {
        match self {
            Resistance::Stretch => (history::ELONGATION, false),
            Resistance::Work => (history::WORK, true),
        }
    }
}

impl SpatialToughness {
    /// Of critical stretches of slots, or roots of their critical works, and factors of sets of them; [`set`](Self::set) gives values.
    pub fn new(base: Vec<(Resistance, f64)>, factors: Vec<(Vec<u32>, ToughnessFactor)>) -> Self {
        let (resistance, base): (Vec<_>, Vec<_>) = base.into_iter().unzip();
        SpatialToughness {
            resistance,
            values: vec![f64::INFINITY; base.len()],
            base,
            factors,
        }
    }

    /// Passes critical values through an archive.
    pub fn archive<const D: usize>(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        body.archive_points(archive, "values", (&mut self.values, 1), |slot, _| slot);
    }

    /// Do values differ from time to time?
    pub fn changes(&self) -> bool {
        let timely = |f: &ToughnessFactor| expression(f).is_some_and(Expression::depends_on_time);
        self.factors.iter().any(|(_, f)| timely(f)) || self.feels_heat()
    }

    /// Do they differ from temperature to temperature?
    pub fn feels_heat(&self) -> bool {
        let heat = |f: &ToughnessFactor| matches!(f, ToughnessFactor::Temperature(_));
        self.factors.iter().any(|(_, f)| heat(f))
    }

    /// Critical values of `e` or critical works, by slot; `None`: no point has such. Of points that have the others they are infinite.
    pub fn values(&self, of: Resistance) -> Option<Cow<'_, [f64]>> {
        let count = self.resistance.iter().filter(|b| **b == of).count();
        let each = || self.resistance.iter().zip(&self.values);
        let own = |(b, value): (&Resistance, &f64)| match *b == of {
            true => *value,
            false => history::NEVER,
        };
        match count {
            0 => None,
            all if all == self.values.len() => Some(Cow::Borrowed(&self.values)),
            _ => Some(Cow::Owned(each().map(own).collect())),
        }
    }

    /// Values of a time, and of a temperature for each slot where anybody feels it.
    ///
    /// # Errors
    /// A factor that is not positive; nothing is changed.
    pub fn set<const D: usize>(
        &mut self,
        body: &Body<D>,
        t: f64,
        temperature: impl Fn(usize) -> f64,
    ) -> Result<(), Unfit> {
        let mut stretch = self.base.clone();
        for (number, (slots, factor)) in self.factors.iter().enumerate() {
            if let ToughnessFactor::Temperature(rows) = factor {
                for &s in slots {
                    stretch[s as usize] *= between(rows, temperature(s as usize));
                }
            }
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
                    ToughnessFactor::Stretch(_)
                    | ToughnessFactor::Temperature(_)
                    | ToughnessFactor::NoFailure => value,
                };
            }
        }
        for &s in &body.slots {
            let s0 = stretch[s as usize];
            self.values[s as usize] = match self.resistance[s as usize] {
                Resistance::Stretch => s0 * (2.0 + s0),
                Resistance::Work => s0 * s0,
            };
        }
        let never = |f: &ToughnessFactor| matches!(f, ToughnessFactor::NoFailure);
        let spared = self.factors.iter().filter(|f| never(&f.1));
        for &s in spared.flat_map(|f| &f.0) {
            self.values[s as usize] = history::NEVER;
        }
        Ok(())
    }
}

/// Lines between rows `[x, y]`, the outer values beyond.
fn between(rows: &[[f64; 2]], x: f64) -> f64 {
    let above = rows.partition_point(|r| r[0] <= x);
    match (above.checked_sub(1).map(|n| rows[n]), rows.get(above)) {
        (Some([x0, y0]), Some([x1, y1])) => y0 + (x - x0) / (x1 - x0) * (y1 - y0),
        (Some([_, y]), None) => y,
        (None, Some([_, y])) => *y,
        (None, None) => 1.0,
    }
}
