//! What fields will take, judged before anything is made: a φ that reaches over many periods meets every image of every bond, and a fine
//! grid needs memory for each of its points.

use crate::FieldsError;
use crate::frame::Frame;
use crate::method::Method;
use crate::quantity::Quantity;
use crate::targets::Targets;
use peridyne::execute::memory::afford;

/// Estimates, of the mean density of bonds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Values of β or φ that are computed.
    pub values: f64,
    /// Of all threads (seconds).
    pub seconds: f64,
    /// Kept at once (bytes).
    pub bytes: f64,
    /// Images of the cell within φ.
    pub periods: f64,
}

/// What one value takes on a thread, about (seconds).
const VALUE: f64 = 2e-9;
/// What listing a bond takes (seconds, bytes).
const BOND: f64 = 1e-7;
const LISTED: f64 = 250.0;
/// The longest that a frame may take (seconds).
const LONGEST: f64 = 86_400.0;
/// A piece of a frame that is summed at once has about this part of its extents.
const PIECE: f64 = 0.25;
/// Bytes of a point: its place three times, and where it is in bins and bricks.
const PLACE: f64 = 120.0;
/// Bytes of a brick of eight points that a place sees.
const SEEN: f64 = 32.0;

impl Effort {
    /// Of a frame with so many bonds, no longer than `reach`.
    pub fn of(frame: &Frame, bonds: f64, reach: f64, targets: &Targets, method: &Method) -> Effort {
        let (kernel, cell) = (&method.kernel, &frame.cell);
        let counts = kernel.averaged_axes().map(|a| a.is_none());
        let (points, radius) = (targets.len() as f64, kernel.radius());
        let (mut near, mut periods, mut piece, mut axes) = (1.0, 1.0, 1.0, 0);
        for a in (0..3).filter(|a| counts[*a]) {
            let part = 2.0 * radius / cell.height(a);
            let repeats = cell.periodic[a];
            near *= if repeats { part } else { part.min(1.0) };
            periods *= if repeats { part + 1.0 } else { 1.0 };
            piece *= (PIECE + part + 2.0 * reach / cell.height(a)).min(1.0);
            axes += usize::from(repeats || part < 1.0);
        }
        // a ball in its box
        let ball = [
            1.0,
            1.0,
            std::f64::consts::FRAC_PI_4,
            std::f64::consts::FRAC_PI_6,
        ][axes];
        let count = frame.len() as f64;
        let values = (bonds + count) * points * near * ball;
        let threads = rayon::current_num_threads() as f64;
        // sums of bonds and of particles, as whole as they may be
        let moments = if method.coordinate { 15.0 } else { 0.0 };
        let sums = 8.0 * (21.0 * parts(method) + 20.0 + 40.0 + moments);
        // a block of centres lists all its bonds at once
        let centres = (count / 64.0).clamp(32.0, 4096.0).min(count);
        let listed = threads * centres * 2.0 * bonds / count * LISTED;
        let fields = Quantity::numbers(method.coordinate);
        let kept = PLACE + sums + 8.0 * fields as f64;
        let bricks = points / 8.0 * piece;
        Effort {
            values,
            seconds: (VALUE * values + BOND * bonds) / threads,
            bytes: listed
                + points * (kept + 2.0 * threads * piece * sums)
                + threads * SEEN * bricks * periods * ball,
            periods,
        }
    }

    /// Can it be done: does it fit into memory, and end within a day?
    ///
    /// # Errors
    /// What there would be, in numbers, and what to ask for instead.
    pub fn check(&self, targets: &Targets, method: &Method) -> Result<(), FieldsError> {
        let width = method.kernel.width();
        let many = self.periods > 100.0;
        let help = match many {
            true => "take a narrower φ: over many periods a field is the mean of the cell",
            false => "take fewer points, or a narrower φ",
        };
        if self.seconds > LONGEST {
            let over = match many {
                true => format!(" over about {:.1e} images of the cell", self.periods),
                false => String::new(),
            };
            return Err(FieldsError(format!(
                "φ of width {width} at {} points{over}: about {:.1e} values of it, {:.1e} days on {} threads, for one frame; {help}",
                targets.len(),
                self.values,
                self.seconds / 86_400.0,
                rayon::current_num_threads()
            )));
        }
        let what = format!("fields at {} points with φ of width {width}", targets.len());
        afford("fields", &what, self.bytes, help)
            .map_err(|e| FieldsError(format!("{}; {help}", e.message)))
    }
}

/// Parts of the potential that are kept apart, about.
fn parts(method: &Method) -> f64 {
    if method.by_part { 3.0 } else { 1.0 }
}

/// Bonds of a frame within a reach, about: those of its mean density.
pub fn bonds_within(frame: &Frame, reach: f64) -> f64 {
    let cell = &frame.cell;
    let mut volume = 1.0;
    let mut around = 1.0;
    for a in 0..3 {
        let height = cell.height(a);
        let extent = match cell.periodic[a] {
            true => height,
            false => {
                let all = frame.position.iter().map(|x| cell.fraction(*x)[a]);
                let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| {
                    (l.min(s), h.max(s))
                });
                ((high - low) * height).max(1e-9 * height)
            }
        };
        volume *= extent;
        around *= match cell.periodic[a] {
            true => 2.0 * reach,
            false => (2.0 * reach).min(extent),
        };
    }
    let count = frame.len() as f64;
    0.5 * count * (count * around / volume * std::f64::consts::FRAC_PI_6).max(1.0)
}
