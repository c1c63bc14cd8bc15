//! Means over frames, with their standard errors: what is kept does not grow with the number of frames.

use crate::fields::{Fields, NO_VELOCITIES, Quantity};
use peridyne::state::{Archive, Owner};

/// Means of all fields at points.
#[derive(Debug, Clone, Default)]
pub struct Average {
    frames: usize,
    /// For each quantity, number by number: how many frames had a value, mean, and sum of squares about it.
    columns: Vec<Vec<[f64; 3]>>,
    /// Why the last frame did not have a quantity.
    why_not: Vec<&'static str>,
}

impl Owner for Average {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.one("frames", &mut self.frames);
        archive.lists("columns", &mut self.columns);
        let mut why: Vec<String> = self.why_not.iter().map(|w| w.to_string()).collect();
        archive.items("why_not", &mut why, String::new, |text, archive| {
            archive.text("text", text);
        });
        if archive.loads() {
            // a few sentences, once
            self.why_not = why.into_iter().map(|w| &*w.leak()).collect();
        }
    }
}

impl Average {
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Take a frame of the same points as those before it. What is undefined in it counts for nothing.
    pub fn add(&mut self, fields: &Fields) {
        self.frames += 1;
        self.columns.resize(Quantity::ALL.len(), vec![]);
        self.why_not = Quantity::ALL.map(|q| fields.why_not(q)).to_vec();
        for (column, quantity) in self.columns.iter_mut().zip(Quantity::ALL) {
            let Some(values) = fields.get(quantity) else {
                continue;
            };
            column.resize(values.len(), [0.0; 3]);
            for (own, value) in column.iter_mut().zip(values) {
                if value.is_finite() {
                    // Welford's
                    own[0] += 1.0;
                    let off = value - own[1];
                    own[1] += off / own[0];
                    own[2] += off * (value - own[1]);
                }
            }
        }
    }

    /// Mean, not a number where no frame had a value; `None`: no frame allowed it.
    pub fn mean(&self, quantity: Quantity) -> Option<Vec<f64>> {
        self.column(
            quantity,
            |[n, mean, _]| if n > 0.0 { mean } else { f64::NAN },
        )
    }

    /// Why there is no mean of a quantity, if there is none.
    pub fn why_not(&self, quantity: Quantity) -> &'static str {
        let place = Quantity::ALL.iter().position(|q| *q == quantity);
        let own = place.and_then(|p| self.why_not.get(p));
        own.copied().unwrap_or(NO_VELOCITIES)
    }

    /// Standard error of the mean, as if frames were independent: `√(Σ(x − x̄)²/(n (n − 1)))`. Frames that follow each other closely
    /// are not, and the error is larger.
    pub fn error(&self, quantity: Quantity) -> Option<Vec<f64>> {
        self.column(quantity, |[n, _, squares]| match n > 1.0 {
            true => (squares / (n * (n - 1.0))).sqrt(),
            false => f64::NAN,
        })
    }

    fn column(&self, quantity: Quantity, of: impl Fn([f64; 3]) -> f64) -> Option<Vec<f64>> {
        let place = Quantity::ALL.iter().position(|q| *q == quantity)?;
        let column = self.columns.get(place).filter(|c| !c.is_empty())?;
        Some(column.iter().map(|own| of(*own)).collect())
    }
}
