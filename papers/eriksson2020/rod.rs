//! Figs. 6 to 8: the bar fixed at one end, stretched and let go.

use peridyne_theory::homogenize::bar::Ends;
use peridyne_theory::homogenize::bar::vibration::{Rod, Vibration};

use super::{STRAIN, bar};
use crate::{Context, Failure};

/// L = 1 m, E = 200 GPa, ρ = 7850 kg/m³.
pub const ROD: Rod = Rod {
    length: 1.0,
    young: 2e11,
    density: 7850.0,
};

/// Which of its points span the bar's metre.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Length {
    /// Δ = L/N: every point counts a spacing, also the fixed one.
    Counted,
    /// Δ = L/(N−½): from the fixed point to where the last point's matter ends.
    Effective,
}

impl Length {
    fn spacings(self, points: usize) -> f64 {
        match self {
            Length::Counted => points as f64,
            Length::Effective => points as f64 - 0.5,
        }
    }
}

/// Points and steps of the example of Madenci and Oterkus, or a tenth.
pub fn sizes(context: &Context) -> [usize; 2] {
    if context.small {
        [100, 2600]
    } else {
        [1000, 26_000]
    }
}

pub fn vibration(
    m: usize,
    points: usize,
    homogenized: bool,
    length: Length,
) -> Result<Vibration, Failure> {
    let bar = bar(m, points, Ends::Full, homogenized)?;
    let spacing = ROD.length / length.spacings(points);
    Vibration::new(&bar, ROD.young, ROD.density, spacing).map_err(|e| Failure::new(e.to_string()))
}

/// The point in the middle.
pub struct Motion {
    pub time_step: f64,
    pub times: Vec<f64>,
    pub classical: Vec<f64>,
    /// Not homogenized, homogenized.
    pub u: [Vec<f64>; 2],
}

impl Motion {
    /// Both bars by the leapfrog with the paper's step, and (73).
    pub fn new(m: usize, [points, steps]: [usize; 2], length: Length) -> Result<Motion, Failure> {
        let bars = [
            vibration(m, points, false, length)?,
            vibration(m, points, true, length)?,
        ];
        let time_step = bars[0].paper_step();
        let point = points / 2;
        let x = point as f64 * bars[0].spacing;
        let times: Vec<f64> = (0..=steps).map(|n| n as f64 * time_step).collect();
        Ok(Motion {
            time_step,
            classical: times
                .iter()
                .map(|t| ROD.displacement(STRAIN, x, *t))
                .collect(),
            u: bars.map(|b| b.run(STRAIN, time_step, steps, point)),
            times,
        })
    }

    /// Root of the mean square of the difference from (73) over that of (73).
    pub fn error(&self, k: usize) -> f64 {
        let pairs = self.u[k].iter().zip(&self.classical);
        let difference: f64 = pairs.map(|(a, b)| (a - b).powi(2)).sum();
        let size: f64 = self.classical.iter().map(|b| b * b).sum();
        (difference / size).sqrt()
    }
}

/// Relative error of frequency k = 0, 1, … of a bar.
pub fn frequency_error(vibration: &Vibration, k: usize) -> f64 {
    vibration.frequency(k) / ROD.frequency(k) - 1.0
}
