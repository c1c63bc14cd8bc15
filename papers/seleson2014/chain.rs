//! The one-dimensional wave of section 3.2, from the deck of Fig. 1.

use std::time::Instant;

use peridyne_io::deck::Deck;

use super::{deck, model};
use crate::Failure;

pub const DECK: &str = include_str!("figure-1/chain.toml");

/// Who talks to whom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Whoever is within r_c now: molecular dynamics, (2.3).
    Now,
    /// Five neighbours on each side in the chain, of which those beyond r_c say nothing: the upscaled model, (3.4).
    Chain,
}

pub fn parsed(h: f64, family: Family) -> Result<Deck, Failure> {
    let family = match family {
        Family::Now => "neighbours",
        Family::Chain => "stencil",
    };
    let set = [
        ("constants.h", h.to_string()),
        ("family", family.to_string()),
    ];
    deck(DECK, "chain.toml", &set)
}

/// A finished run.
pub struct Wave {
    pub h: f64,
    /// Reference positions.
    pub x: Vec<f64>,
    pub time: Vec<f64>,
    /// Displacements after each step, from the initial ones on.
    pub u: Vec<Vec<f64>>,
    pub kinetic: Vec<f64>,
    pub strain: Vec<f64>,
    /// Strain energy of the chain before it is displaced.
    pub at_rest: f64,
}

impl Wave {
    pub fn run(h: f64, family: Family) -> Result<Wave, Failure> {
        let deck = parsed(h, family)?;
        let mut sim = model(&deck, true)?;
        let x: Vec<f64> = sim.vectors("reference").iter().map(|x| x[0]).collect();
        let volume = sim.scalars("volume");
        let initial = sim.displacements();
        sim.set_displacements(&vec![[0.0; 3]; x.len()]);
        let at_rest = sim
            .scalars("energy_density")
            .iter()
            .zip(&volume)
            .map(|(e, v)| e * v)
            .sum();
        sim.set_displacements(&initial);
        let mut wave = Wave {
            h,
            x,
            time: vec![],
            u: vec![],
            kinetic: vec![],
            strain: vec![],
            at_rest,
        };
        sim.start(true);
        let steps = deck.steps(sim.info().time_step);
        for step in 0..=steps {
            if step > 0 {
                sim.step().map_err(|e| Failure::new(e.to_string()))?;
            }
            let ledger = sim.ledger().map_err(|e| Failure::new(e.to_string()))?;
            wave.time.push(sim.time());
            wave.kinetic.push(ledger.kinetic);
            wave.strain.push(ledger.strain);
            wave.u
                .push(sim.displacements().iter().map(|u| u[0]).collect());
        }
        Ok(wave)
    }

    pub fn steps(&self) -> usize {
        self.time.len() - 1
    }

    /// Displacements at the end.
    pub fn last(&self) -> &[f64] {
        self.u.last().map_or(&[], Vec::as_slice)
    }

    /// Total energy after each step, without that of the chain at rest.
    pub fn total(&self) -> Vec<f64> {
        let energies = self.kinetic.iter().zip(&self.strain);
        energies.map(|(k, s)| k + s - self.at_rest).collect()
    }

    /// `(x_{j+1} − x_{j−1})/(y_{j+1} − y_{j−1})` of all points but the two ends, after a step.
    pub fn density(&self, step: usize) -> Vec<f64> {
        let u = &self.u[step];
        (1..self.x.len() - 1)
            .map(|j| {
                let reference = self.x[j + 1] - self.x[j - 1];
                reference / (reference + u[j + 1] - u[j - 1])
            })
            .collect()
    }
}

/// Time of all steps alone, without looking at anything: the shortest of so many runs.
pub fn seconds(h: f64, family: Family, runs: usize) -> Result<f64, Failure> {
    let deck = parsed(h, family)?;
    let mut best = f64::INFINITY;
    for _ in 0..runs {
        let mut sim = model(&deck, false)?;
        sim.start(true);
        let begin = Instant::now();
        for _ in 0..deck.spec.run.schedule.steps {
            sim.step().map_err(|e| Failure::new(e.to_string()))?;
        }
        best = best.min(begin.elapsed().as_secs_f64());
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::pulse;

    #[test]
    fn the_deck_begins_with_the_profile() {
        let deck = parsed(1.0, Family::Chain).unwrap();
        let u = deck.spec.loading.initial[0].displacement[0]
            .as_ref()
            .unwrap();
        for x in 0..=1000 {
            let x = f64::from(x);
            let exact = pulse(x, 500.0, 200.0, 7.0);
            assert!(
                (u.eval(&[x, 0.0, 0.0], 0.0) - exact).abs() < 1e-13,
                "{x}: {exact}"
            );
        }
    }
}
