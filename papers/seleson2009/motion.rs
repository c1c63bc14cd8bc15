//! Runs of chains, recorded: space–time densities, profiles at chosen steps, energies.

use peridyne::error::RunError;
use peridyne::run::Simulation;
use peridyne::spec::Horizon;
use peridyne_io::deck::SpaceTimeSpec;
use peridyne_io::write::plot::Map;
use peridyne_io::write::space_time::{DENSITY, Line, SpaceTime};
use serde::{Deserialize, Serialize};

use super::chain::Chain;
use super::{deck, modes};
use crate::measure::{change, stepper_energy};
use crate::{Context, Failure};

/// What to keep of a run.
#[derive(Debug, Clone, Default)]
pub struct Wanted {
    /// The pictures over space and time that the deck asks for.
    pub images: bool,
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
    /// Those of the deck's `output.space_time`, in order.
    pub images: Vec<Density>,
}

/// Ends of the colours where a deck gives none.
const REST: [f64; 2] = [0.0, 2.0];

/// The density over space and time, and the ends of its colours.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Density {
    image: SpaceTime,
    range: [f64; 2],
}

impl Density {
    /// The picture, time downwards, white where the chain is as at rest.
    pub fn map(&self, title: &str) -> Map {
        self.image.map(title, DENSITY, [""; 3], self.range)
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
        let steps = deck.spec.run.schedule.steps;
        let Horizon::Ratio(neighbours) = deck.spec.bonds.horizon else {
            return Err(Failure::new(format!(
                "{name}: write the horizon as m_ratio"
            )));
        };
        let wanted = wanted(steps, sim.info().time_step);
        let asked: &[SpaceTimeSpec] = match wanted.images {
            true => &deck.output.space_time,
            false => &[],
        };
        let motion = record(neighbours, sim, steps, &wanted, asked)
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
    asked: &[SpaceTimeSpec],
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
        images: vec![],
    };
    let line = Line::new(&sim.vectors("reference"), None, None);
    for one in asked {
        let found = SpaceTime::new(&line, &one.window, false);
        motion.images.extend(found.map(|image| Density {
            range: one.range.unwrap_or(REST),
            image,
        }));
    }
    let every = |number: u64| steps.div_ceil(number.max(1)).max(1);
    for step in 0..=steps {
        let time = step as f64 * dt;
        let due = |one: &SpaceTimeSpec| one.window.is_row(step, steps, dt);
        let profile = wanted.profiles.contains(&step);
        if profile || asked.iter().any(due) {
            let u: Vec<f64> = sim.displacements().iter().map(|u| u[0]).collect();
            let both = motion.images.iter_mut().zip(asked);
            for (density, _) in both.filter(|(_, one)| due(one)) {
                let density_now = line.density(&line.along(&u));
                density.image.record(time, &density_now);
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
