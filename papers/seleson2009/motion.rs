//! Runs of chains, recorded: space–time densities, profiles at chosen steps, energies.

use peridyne::error::RunError;
use peridyne::run::Simulation;
use peridyne::spec::Horizon;
use peridyne_io::write::plot::Map;
use serde::{Deserialize, Serialize};

use super::chain::Chain;
use super::{deck, modes};
use crate::measure::{change, stepper_energy};
use crate::{Context, Failure};

/// What to keep of a run.
#[derive(Debug, Clone, Default)]
pub struct Wanted {
    /// Columns of the space–time image; 0: no image.
    pub columns: usize,
    /// Rows of the image, at most.
    pub rows: u64,
    /// Steps whose displacements are kept, rising.
    pub profiles: Vec<u64>,
    /// Numbers of energies kept over the run, at most; 0: none.
    pub energies: u64,
}

/// Displacements of all points at a step.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Profile {
    pub step: u64,
    pub time: f64,
    pub u: Vec<f64>,
}

/// Energies at a step.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Energies {
    pub time: f64,
    pub kinetic: f64,
    pub potential: f64,
    /// That of [`stepper_energy`].
    pub scheme: f64,
}

impl Energies {
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential
    }
    /// What the linear scheme conserves exactly.
    pub fn invariant(&self) -> f64 {
        self.total() - self.scheme
    }
}

/// A run.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Motion {
    pub points: usize,
    /// Neighbours on each side.
    pub neighbours: u32,
    pub spacing: f64,
    pub time_step: f64,
    pub steps: u64,
    pub profiles: Vec<Profile>,
    pub energies: Vec<Energies>,
    pub image: Image,
}

/// Densities `(x_{j+1} − x_{j−1})/(y_{j+1} − y_{j−1})` over points and time; the two end points have none and are left out.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Image {
    pub columns: usize,
    /// Outer edges in x.
    pub x: [f64; 2],
    /// Time of every row.
    pub times: Vec<f64>,
    /// Rows one after another, each value the mean of the points in its column.
    pub values: Vec<f32>,
}

impl Image {
    fn record(&mut self, time: f64, u: &[f64], spacing: f64) {
        let n = u.len() - 2;
        self.times.push(time);
        for c in 0..self.columns {
            let points = c * n / self.columns..(c + 1) * n / self.columns;
            let count = points.len() as f64;
            let sum: f64 = points
                .map(|j| 2.0 * spacing / (2.0 * spacing + u[j + 2] - u[j]))
                .sum();
            self.values.push((sum / count) as f32);
        }
    }

    /// The picture, time downwards, white where the chain is as at rest.
    pub fn map(&self, title: &str, contrast: f64) -> Map {
        self.zoom(title, contrast, self.x, 0.0)
    }

    /// The part between two x, from a time on.
    pub fn zoom(&self, title: &str, contrast: f64, x: [f64; 2], from: f64) -> Map {
        let width = (self.x[1] - self.x[0]) / self.columns as f64;
        let column = |x: f64| ((x - self.x[0]) / width).round().max(0.0) as usize;
        let (low, high) = (column(x[0]), column(x[1]).min(self.columns));
        let first = self.times.iter().position(|t| *t >= from).unwrap_or(0);
        let values: Vec<f64> = (first..self.times.len())
            .flat_map(|r| &self.values[r * self.columns + low..r * self.columns + high])
            .map(|v| f64::from(*v))
            .collect();
        let last = self.times.last().copied().unwrap_or(1.0);
        let edge = |c: usize| self.x[0] + c as f64 * width;
        Map::new(title)
            .x("x (reference)", "", [edge(low), edge(high)])
            .y("t", "", [self.times[first], last])
            .y_down()
            .value("density", "")
            .colors(peridyne_io::write::plot::ColorMap::Diverging)
            .between(1.0 - contrast, 1.0 + contrast)
            .grid(high - low, &values)
    }
}

/// Does a run that a deck lists, as a part of the work that is kept.
///
/// # Errors
/// Those of the deck, of the model and of the run.
pub fn run(
    context: &Context,
    text: &str,
    name: &str,
    part: &str,
    changes: &[(&str, String)],
    wanted: impl FnOnce(u64, f64) -> Wanted,
) -> Result<Motion, Failure> {
    context.part(part, || {
        let deck = deck::deck(text, name, changes)?;
        let sim = deck::model(&deck)?;
        let steps = deck.spec.schedule.steps;
        let Horizon::Ratio(neighbours) = deck.spec.horizon else {
            return Err(Failure::new(format!(
                "{name}: write the horizon as m_ratio"
            )));
        };
        let wanted = wanted(steps, sim.info().time_step);
        let motion = record(neighbours, sim, steps, &wanted)
            .map_err(|e| Failure::new(format!("{name}: {e}")))?;
        context.say(&format!("{part}: {}", motion.described()));
        Ok(motion)
    })
}

/// Runs `steps` steps and records.
///
/// # Errors
/// Those of the run: crossing, instability.
pub fn record(
    neighbours: u32,
    mut sim: Box<dyn Simulation>,
    steps: u64,
    wanted: &Wanted,
) -> Result<Motion, RunError> {
    let info = sim.info().clone();
    let (points, spacing, dt) = (info.points as usize, info.spacing, info.time_step);
    sim.start(true);
    let mut motion = Motion {
        points,
        neighbours,
        spacing,
        time_step: dt,
        steps,
        profiles: vec![],
        energies: vec![],
        image: Image {
            columns: wanted.columns.min(points - 2),
            // a cell around every point but the ends
            x: [0.5 * spacing, (points as f64 - 1.5) * spacing],
            ..Image::default()
        },
    };
    let every = |number: u64| steps.div_ceil(number.max(1)).max(1);
    for step in 0..=steps {
        let time = step as f64 * dt;
        let picture = wanted.columns > 0 && (step % every(wanted.rows) == 0 || step == steps);
        let profile = wanted.profiles.contains(&step);
        if picture || profile {
            let u: Vec<f64> = sim.displacements().iter().map(|u| u[0]).collect();
            if picture {
                motion.image.record(time, &u, spacing);
            }
            if profile {
                motion.profiles.push(Profile { step, time, u });
            }
        }
        if wanted.energies > 0 && (step % every(wanted.energies) == 0 || step == steps) {
            let ledger = sim.ledger()?;
            motion.energies.push(Energies {
                time,
                kinetic: ledger.kinetic,
                potential: ledger.strain,
                scheme: stepper_energy(sim.as_mut()),
            });
        }
        if step < steps {
            sim.step()?;
        }
    }
    Ok(motion)
}

impl Motion {
    /// The chain of springs that this was.
    pub fn chain(&self) -> Chain {
        Chain {
            points: self.points as u32,
            neighbours: self.neighbours,
            spacing: self.spacing,
            density: 1.0,
            k1: 1.0,
        }
    }

    /// N Δx
    pub fn horizon(&self) -> f64 {
        f64::from(self.neighbours) * self.spacing
    }

    /// The step nearest to a time.
    pub fn nearest(&self, time: f64) -> u64 {
        (time / self.time_step).round() as u64
    }

    /// Largest difference of a recorded step from the closed form.
    ///
    /// # Errors
    /// The step or the beginning was not recorded.
    pub fn off_closed_form(&self, step: u64) -> Result<f64, Failure> {
        let [u0, u] = [&self.profile(0)?.u, &self.profile(step)?.u];
        Ok(modes::difference(
            &self.chain(),
            self.time_step,
            step,
            u0,
            u,
        ))
    }

    /// Displacements at a recorded step.
    ///
    /// # Errors
    /// It was not recorded.
    pub fn profile(&self, step: u64) -> Result<&Profile, Failure> {
        let found = self.profiles.iter().find(|p| p.step == step);
        found.ok_or_else(|| Failure::new(format!("step {step} was not recorded")))
    }

    /// Reference positions.
    pub fn x(&self) -> Vec<f64> {
        (0..self.points).map(|j| j as f64 * self.spacing).collect()
    }

    /// Largest relative change of an energy since the start.
    pub fn drift(&self, of: impl Fn(&Energies) -> f64) -> f64 {
        change(self.energies.iter().map(of))
    }

    /// A title of pictures.
    pub fn titled(&self, label: &str) -> String {
        format!("{label}: {} points, N = {}", self.points, self.neighbours)
    }

    /// What is said of the run in a line.
    pub fn described(&self) -> String {
        format!(
            "{} points, {} steps of {:.6}",
            self.points, self.steps, self.time_step
        )
    }
}

/// The pulse that runs to the right: displacements with x > 500.
pub struct RightPulse {
    pub height: f64,
    /// Where it is highest, by a parabola through the three highest points.
    pub crest: f64,
    /// (∫u²)²/∫u⁴: a rectangle has its length, and what spreads grows.
    pub width: f64,
}

impl RightPulse {
    pub fn of(u: &[f64], spacing: f64) -> RightPulse {
        let middle = u.len() / 2;
        let top = (middle + 1..u.len() - 1)
            .max_by(|a, b| u[*a].total_cmp(&u[*b]))
            .unwrap_or(middle);
        let (left, here, right) = (u[top - 1], u[top], u[top + 1]);
        let bend = left - 2.0 * here + right;
        let shift = if bend < 0.0 {
            0.5 * (left - right) / bend
        } else {
            0.0
        };
        let moment = |p: i32| u[middle..].iter().map(|u| u.powi(p)).sum::<f64>() * spacing;
        RightPulse {
            height: here - 0.25 * (left - right) * shift,
            crest: (top as f64 + shift) * spacing,
            width: moment(2).powi(2) / moment(4),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_density_of_a_stretched_chain() {
        let u: Vec<f64> = (0..6).map(|j| 0.25 * f64::from(j)).collect();
        let mut image = Image {
            columns: 2,
            x: [0.25, 2.25],
            ..Image::default()
        };
        image.record(0.0, &u, 0.5);
        // spacing 0.5 becomes 0.75
        assert_eq!(image.values, [2.0 / 3.0; 2].map(|v: f64| v as f32));
        assert_eq!(image.times, [0.0]);
    }

    #[test]
    fn a_pulse_is_measured() {
        let u: Vec<f64> = (0..1001)
            .map(|j| 0.5 * (1.0 - ((f64::from(j) - 700.3) / 20.0).powi(2)).max(0.0))
            .collect();
        let p = RightPulse::of(&u, 1.0);
        assert!((p.height - 0.5).abs() < 1e-12 && (p.crest - 700.3).abs() < 1e-9);
        // a parabola of half width 20: ((16/15)²/(256/315)) · 20
        let exact = (16.0f64 / 15.0).powi(2) / (256.0 / 315.0) * 20.0;
        assert!((p.width / exact - 1.0).abs() < 1e-3, "{}", p.width);
    }
}
