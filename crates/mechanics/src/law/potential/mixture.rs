//! Potentials of several kinds of atoms: what every pair of kinds has, for `E = Σ_i F_i(ρ_i) + ½ Σ_ij φ_ij(r)`,
//! `ρ_i = Σ_j f_ij(r)`. φ_ij = φ_ji; f_ij is what an atom of kind j adds at one of kind i (Finnis & Sinclair's; where only j
//! matters: Daw & Baskes's).

use super::cut::Ends;
use super::{Described, Potential, make};
use crate::law::descriptor::Wrong;
use crate::spec::{Mixing, Parameters};

/// Kinds whose pairs are evaluated side by side.
pub const FEW: usize = 4;

/// A potential of several kinds of atoms, or of one.
#[derive(Debug, Clone)]
pub struct Mixture<P> {
    kinds: usize,
    /// `[i][j]`: that of an atom of kind i with one of kind j; `None`: nothing.
    of: Vec<Option<P>>,
}

impl<P: Potential> Mixture<P> {
    /// Of one kind.
    pub fn one(potential: P) -> Mixture<P> {
        Mixture {
            kinds: 1,
            of: vec![Some(potential)],
        }
    }

    /// Of kinds 0 to `kinds` − 1.
    pub fn new(kinds: usize, of: impl Fn(usize, usize) -> Option<P>) -> Mixture<P> {
        let pairs = (0..kinds * kinds).map(|n| of(n / kinds, n % kinds));
        Mixture {
            kinds,
            of: pairs.collect(),
        }
    }

    pub fn kinds(&self) -> usize {
        self.kinds
    }

    /// That of an atom of kind i with one of kind j.
    #[inline(always)]
    pub fn of(&self, i: usize, j: usize) -> Option<&P> {
        self.of.get(i * self.kinds + j)?.as_ref()
    }

    /// That of an atom of this kind with its own, of which its embedding energy is.
    #[inline(always)]
    pub fn own(&self, kind: usize) -> Option<&P> {
        self.of(kind, kind)
    }

    /// Distance beyond which the two say nothing (length); 0: they never say anything.
    pub fn cutoff(&self, i: usize, j: usize) -> f64 {
        self.of(i, j).map_or(0.0, Potential::cutoff)
    }

    /// Squares of the cut-offs, `[i][j]`, of none more than that of `most` (length).
    pub fn limits(&self, most: f64) -> Vec<f64> {
        let pairs = (0..self.kinds * self.kinds).map(|n| (n / self.kinds, n % self.kinds));
        let cutoffs = pairs.map(|(i, j)| self.cutoff(i, j).min(most));
        cutoffs.map(|c| c * c).collect()
    }

    /// The greatest of them.
    pub fn reach(&self) -> f64 {
        let all = self.of.iter().flatten().map(Potential::cutoff);
        all.fold(0.0, f64::max)
    }

    /// Can pairs of several kinds be evaluated side by side? They differ in constants alone, and are of a few kinds.
    pub fn is_side_by_side(&self) -> bool {
        let mut each = self.each();
        let few = (2..=FEW).contains(&self.kinds);
        few && each.next().is_some_and(|first| {
            P::CONSTANTS > 0 && first.is_alike(first) && each.all(|p| p.is_alike(first))
        })
    }

    /// What all pairs have.
    pub fn each(&self) -> impl Iterator<Item = &P> {
        self.of.iter().flatten()
    }
}

/// What a pair of kinds of atoms has of a potential.
#[derive(Debug, Clone, PartialEq)]
pub enum Between {
    Nothing,
    /// With these constants.
    Given(Parameters),
    /// What follows from the constants that each has with its own.
    Mixed,
}

/// The constants of a potential of several kinds of atoms.
#[derive(Debug, Clone, PartialEq)]
pub struct Given {
    pub kinds: usize,
    /// `[i][j]`
    pub of: Vec<Between>,
    pub rule: Option<Mixing>,
}

impl Given {
    pub fn one(parameters: Parameters) -> Given {
        Given {
            kinds: 1,
            of: vec![Between::Given(parameters)],
            rule: None,
        }
    }

    /// Nobody has anything.
    pub fn nothing(kinds: usize, rule: Option<Mixing>) -> Given {
        Given {
            kinds,
            of: vec![Between::Nothing; kinds * kinds],
            rule,
        }
    }

    pub fn at(&self, i: usize, j: usize) -> &Between {
        &self.of[i * self.kinds + j]
    }

    /// Of both kinds with each other.
    pub fn set(&mut self, i: usize, j: usize, between: Between) {
        self.of[j * self.kinds + i] = between.clone();
        self.of[i * self.kinds + j] = between;
    }

    /// The constants of a kind with its own.
    fn own<P: Described>(&self, kind: usize) -> Result<(P, Ends), Wrong> {
        match self.at(kind, kind) {
            Between::Given(given) => {
                let mut given = given.clone();
                P::descriptor().check(&mut given)?;
                Ok((P::read(&given)?, Ends::of(&given)?))
            }
            Between::Nothing | Between::Mixed => {
                let message = format!("an atom without {} of its own has none to mix", P::NAME);
                Err((String::new(), message))
            }
        }
    }
}

/// What constants make.
///
/// # Errors
/// The key that is wrong, and why.
pub fn mixture<P: Described>(given: &Given) -> Result<Mixture<P::Made>, Wrong> {
    let mut of = vec![];
    for (n, between) in given.of.iter().enumerate() {
        let (i, j) = (n / given.kinds, n % given.kinds);
        of.push(match between {
            Between::Nothing => None,
            Between::Given(parameters) => Some(make::<P>(parameters)?),
            Between::Mixed => Some(P::mixed([given.own(i)?, given.own(j)?], given.rule)?),
        });
    }
    Ok(Mixture {
        kinds: given.kinds,
        of,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::potential::lennard_jones::LennardJones;
    use crate::spec::{End, PotentialSpec};

    fn argon(epsilon: f64, sigma: f64, cutoff: f64) -> Parameters {
        let spec = PotentialSpec::of(LennardJones { epsilon, sigma });
        spec.ended(cutoff, End::Truncated).parameters
    }

    #[test]
    fn constants_of_unlike_atoms_are_those_of_the_rules() {
        let (a, b) = ((1.0, 1.0, 2.5), (0.25, 2.0, 4.0));
        for (rule, epsilon, sigma, cutoff) in [
            (Mixing::Arithmetic, 0.5, 1.5, 3.25),
            (Mixing::Geometric, 0.5, 2f64.sqrt(), 10f64.sqrt()),
            (
                Mixing::SixthPower,
                2.0 * 0.5 * 8.0 / 65.0,
                32.5f64.powf(1.0 / 6.0),
                (0.5 * (2.5f64.powi(6) + 4096.0)).powf(1.0 / 6.0),
            ),
        ] {
            let mut given = Given::nothing(2, Some(rule));
            given.set(0, 0, Between::Given(argon(a.0, a.1, a.2)));
            given.set(1, 1, Between::Given(argon(b.0, b.1, b.2)));
            given.set(0, 1, Between::Mixed);
            let made = mixture::<LennardJones>(&given).unwrap();
            let exact = LennardJones { epsilon, sigma };
            for (i, j) in [(0, 1), (1, 0)] {
                let pair = made.of(i, j).unwrap();
                assert!((pair.cutoff() - cutoff).abs() < 1e-14 * cutoff, "{rule:?}");
                for q in [1.0, 2.3, 5.0] {
                    let (found, exact) = (pair.pair(q), exact.pair(q));
                    assert!((found - exact).abs() < 1e-13 * exact.abs(), "{rule:?} {q}");
                }
            }
            assert_eq!(made.of(0, 0).unwrap().pair(1.3), {
                let own = LennardJones {
                    epsilon: 1.0,
                    sigma: 1.0,
                };
                own.pair(1.3)
            });
        }
    }

    #[test]
    fn without_a_rule_nothing_is_mixed() {
        let mut given = Given::nothing(2, None);
        given.set(0, 0, Between::Given(argon(1.0, 1.0, 2.5)));
        given.set(1, 1, Between::Given(argon(1.0, 1.0, 2.5)));
        given.set(0, 1, Between::Mixed);
        let (_, why) = mixture::<LennardJones>(&given).unwrap_err();
        assert!(why.contains("no rule of mixing"), "{why}");
    }
}
