//! What decides that a bond breaks beside its stretch: the work done on it, a stress or strain of its points, how fast it is stretched,
//! and cycles of load.

use crate::spec::{Cycles, FatigueSpec, RateSpec};

/// Of all materials of a body; what is empty, nobody has.
#[derive(Debug, Clone, Default)]
pub struct Criteria {
    pub measure: Measure,
    /// Per material.
    pub rate: Vec<Option<RateSpec>>,
    /// Per material.
    pub fatigue: Vec<Option<FatigueSpec>>,
}

/// What a bond breaks by; limits are per material, ∞: its bonds never break.
#[derive(Debug, Clone, Default)]
pub enum Measure {
    /// Its stretch, by the critical stretch of its ends.
    #[default]
    Stretch,
    /// The work w that the force states of both its ends have done on it, `∫ (T_i − T_j)·dη` (energy / volume²), where it is longer than
    /// in the reference (Foster, Silling & Chen 2011).
    Work(Vec<f64>),
    /// Von Mises stress (pressure), the mean of both ends.
    VonMises(Vec<f64>),
    /// Equivalent plastic strain (–), the mean of both ends.
    PlasticStrain(Vec<f64>),
}

impl Criteria {
    /// Those of one material.
    pub fn only(&self, n: usize) -> Criteria {
        let one = |all: &[f64]| all.get(n).copied().into_iter().collect::<Vec<f64>>();
        Criteria {
            measure: match &self.measure {
                Measure::Stretch => Measure::Stretch,
                Measure::Work(limit) => Measure::Work(one(limit)),
                Measure::PlasticStrain(limit) => Measure::PlasticStrain(one(limit)),
                Measure::VonMises(limit) => Measure::VonMises(one(limit)),
            },
            rate: self.rate.get(n).copied().into_iter().collect(),
            fatigue: self.fatigue.get(n).copied().into_iter().collect(),
        }
    }
}

/// Fatigue of a bond: what is left of its life, and what a cycle takes of it.
#[derive(Debug, Clone, Copy)]
pub struct BondFatigue {
    /// 1 at first; 0: it is worn out.
    pub life: f64,
    /// Per cycle.
    pub rate: f64,
    /// Of those that ranks share one counts it; it has fatigue on the others, too.
    pub counts: bool,
}

impl BondFatigue {
    /// What a cycle with this range of stretch takes of a bond's life, near a crack or far from any.
    pub fn rate(of: &FatigueSpec, range: f64, near: bool) -> f64 {
        let (law, beyond) = match near {
            true => (of.growth, range),
            false => (of.nucleation, range - of.limit),
        };
        law.map_or(0.0, |[a, m]| a * libm::pow(beyond.max(0.0), m))
    }
}

/// Cycles after which the first of these directed bonds are worn out, as many as end an increment; in any order.
pub fn first_to_fail(bonds: &[BondFatigue], options: &Cycles) -> Vec<f64> {
    let last =
        |b: &BondFatigue| (b.counts && b.rate > 0.0 && b.life > 0.0).then(|| b.life / b.rate);
    let mut all: Vec<f64> = bonds.iter().filter_map(last).collect();
    // each bond is there from both ends
    let most = 2 * options.bonds.max(1);
    if all.len() > most {
        all.select_nth_unstable_by(most - 1, f64::total_cmp);
        all.truncate(most);
    }
    all
}

/// Cycles until so many of the bonds are worn out of which these are the first, or until no more are allowed.
pub fn cycles_to_failure(mut first: Vec<f64>, options: &Cycles, left: f64) -> f64 {
    let Some(last) = first.len().checked_sub(1) else {
        return if left.is_finite() { left } else { 0.0 };
    };
    let n = (2 * options.bonds.max(1) - 1).min(last);
    let (_, nth, _) = first.select_nth_unstable_by(n, f64::total_cmp);
    nth.min(left)
}

/// Up to here of a life is round-off: bonds that are alike end together.
pub(crate) const SPENT: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_increment_ends_with_the_nth_bond() {
        let of = |life: f64, rate: f64| BondFatigue {
            life,
            rate,
            counts: true,
        };
        let bonds = [
            of(1.0, 0.5),
            of(1.0, 0.5),
            of(1.0, 0.1),
            of(1.0, 0.1),
            of(1.0, 0.0),
        ];
        let options = |bonds: usize| Cycles {
            load_ratio: 0.0,
            bonds,
            most: f64::INFINITY,
        };
        let until = |bonds: &[BondFatigue], n: usize, left: f64| {
            let first = first_to_fail(bonds, &options(n));
            assert!(first.len() <= 2 * n);
            cycles_to_failure(first, &options(n), left)
        };
        assert_eq!(until(&bonds, 1, f64::INFINITY), 2.0);
        assert_eq!(until(&bonds, 2, f64::INFINITY), 10.0);
        assert_eq!(until(&bonds, 9, f64::INFINITY), 10.0);
        assert_eq!(until(&bonds, 2, 7.0), 7.0);
        assert_eq!(until(&bonds[4..], 1, f64::INFINITY), 0.0);
        assert_eq!(until(&bonds[4..], 1, 7.0), 7.0);
    }
}
