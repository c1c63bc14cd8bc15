//! Coefficients of several atom types as materials of the engine.
//!
//! LAMMPS gives every pair of types its own coefficients, and a point's s0 is the greatest s00 − α·stretch over its
//! unbroken bonds, each with its own s00 and α (LAMMPS's observed behaviour). The engine has one horizon, materials with
//! a law, s00 and α, and a rule for the stiffness of bonds across. Where both say the same the run is LAMMPS's; all
//! else is refused.

use peridyne::spec::{InterfaceRule, LawSpec, PmbStiffness};

use crate::lammps::atoms::{Atoms, Column};
use crate::lammps::host::{HostError, LpsCoefficients, Pair, PmbCoefficients};

/// Bonds across of a micromodulus within this (relative) of a rule's obey it: a formula prints 15 digits.
const SAME: f64 = 1e-13;

const RULES: [InterfaceRule; 3] = [
    InterfaceRule::Series,
    InterfaceRule::Minimum,
    InterfaceRule::Parallel,
];

/// What a pair of types has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    pub law: LawSpec,
    /// c or K: the repulsion is proportional to it.
    pub stiffness: f64,
    pub horizon: f64,
    pub critical_stretch: f64,
    pub alpha: f64,
}

impl From<PmbCoefficients> for Coefficients {
    fn from(c: PmbCoefficients) -> Self {
        Coefficients {
            law: LawSpec::Pmb(PmbStiffness::Micromodulus(c.micromodulus)),
            stiffness: c.micromodulus,
            horizon: c.horizon,
            critical_stretch: c.critical_stretch,
            alpha: c.alpha,
        }
    }
}

impl From<LpsCoefficients> for Coefficients {
    fn from(c: LpsCoefficients) -> Self {
        Coefficients {
            law: LawSpec::LpsAsTyped {
                bulk: c.bulk,
                shear: c.shear,
            },
            stiffness: c.bulk,
            horizon: c.horizon,
            critical_stretch: c.critical_stretch,
            alpha: c.alpha,
        }
    }
}

/// The types that atoms have, and the coefficients of their pairs.
pub struct Types<'a> {
    pair: &'a Pair,
    /// One for each material; the least of all types where they have the same coefficients.
    materials: Vec<usize>,
    present: Vec<usize>,
}

impl<'a> Types<'a> {
    /// # Errors
    /// The horizons of two pairs differ.
    pub fn new(pair: &'a Pair, atoms: &Atoms) -> Result<Self, HostError> {
        let mut present: Vec<usize> = match &atoms.types {
            Column::Uniform(kind) => vec![*kind as usize],
            Column::Each(kinds) => kinds.iter().map(|k| *k as usize).collect(),
        };
        present.sort_unstable();
        present.dedup();
        let mut types = Types {
            pair,
            materials: present.clone(),
            present,
        };
        let first = types.materials[0];
        let own = types.get(first, first);
        for (i, j) in types.pairs() {
            let other = types.get(i, j).horizon;
            if other != own.horizon {
                return Err(HostError::new(format!(
                    "`pair_coeff {i} {j}` has the horizon {other:e}, `pair_coeff {first} {first}` has {:e}",
                    own.horizon
                ))
                .of_pair(i, j)
                .help("all pairs of types need the same horizon"));
            }
        }
        if types.pairs().all(|(i, j)| types.get(i, j) == own) {
            types.materials.truncate(1);
        }
        if types.materials.len() > 255 {
            return Err(HostError::new(format!(
                "{} atom types with coefficients of their own; at most 255 are supported",
                types.materials.len()
            )));
        }
        Ok(types)
    }

    pub fn materials(&self) -> &[usize] {
        &self.materials
    }

    pub fn get(&self, i: usize, j: usize) -> Coefficients {
        match self.pair {
            Pair::Pmb(table) => table.get(i, j).into(),
            Pair::Lps(table) => table.get(i, j).into(),
        }
    }

    pub fn horizon(&self) -> f64 {
        self.get(self.present[0], self.present[0]).horizon
    }

    /// All pairs i <= j of types that atoms have.
    fn pairs(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let of = |i: usize| self.present.iter().map(move |j| (i, *j));
        self.present
            .iter()
            .flat_map(move |i| of(*i))
            .filter(|(i, j)| i <= j)
    }

    /// Do all pairs repel with the same stiffness? The engine has one.
    pub fn repel_alike(&self) -> bool {
        let first = self.present[0];
        let own = self.get(first, first).stiffness;
        self.pairs().all(|(i, j)| self.get(i, j).stiffness == own)
    }

    /// The rule that gives the bonds between those types for which `bonded` holds what LAMMPS gives them.
    ///
    /// # Errors
    /// There is none.
    pub fn rule(&self, bonded: impl Fn(usize, usize) -> bool) -> Result<InterfaceRule, HostError> {
        let across: Vec<(usize, usize)> = self
            .pairs()
            .filter(|(i, j)| i < j && bonded(*i, *j))
            .collect();
        for (i, j) in &across {
            self.breaks_alike(*i, *j)?;
        }
        let fits = |rule: &InterfaceRule| across.iter().all(|(i, j)| self.obeys(*rule, *i, *j));
        if let Some(rule) = RULES.iter().find(|r| fits(r)) {
            return Ok(*rule);
        }
        let alone = |(i, j): &(usize, usize)| RULES.iter().any(|r| self.obeys(*r, *i, *j));
        let Some((i, j)) = across.iter().find(|p| !alone(p)) else {
            let (i, j) = across[across.len() - 1];
            return Err(HostError::new(
                "bonds between unlike types follow different rules in different pairs",
            )
            .of_pair(i, j)
            .help(
                "give all pairs I J the smaller, the harmonic or the arithmetic mean of the two c",
            ));
        };
        let (a, b) = (self.get(*i, *i), self.get(*j, *j));
        let error = match (a.law, b.law) {
            (LawSpec::Pmb(_), _) => {
                let means = RULES.map(|r| format!("{:.15e}", mean(r, a.stiffness, b.stiffness)));
                HostError::new(format!(
                    "`pair_coeff {i} {j}` has c = {:e}, which is no mean of {:e} and {:e} that bonds between the types can have",
                    self.get(*i, *j).stiffness, a.stiffness, b.stiffness
                ))
                .help(format!(
                    "write the harmonic mean {}, the smaller {} or the arithmetic mean {}; or keep the types further apart than the horizon",
                    means[0], means[1], means[2]
                ))
            }
            _ => HostError::new(format!(
                "atoms of types {i} and {j} are bonded, and their K or G differ: LAMMPS's `peri/lps` takes those of `pair_coeff {i} {j}` for both ends of such a bond, which is not supported"
            ))
            .help("give both types the same K and G, or keep them further apart than the horizon; in a deck (TOML) each end has the moduli of its own material"),
        };
        Err(error.of_pair(*i, *j))
    }

    fn obeys(&self, rule: InterfaceRule, i: usize, j: usize) -> bool {
        let (a, b, across) = (self.get(i, i), self.get(j, j), self.get(i, j));
        match across.law {
            LawSpec::Pmb(_) => {
                let expected = mean(rule, a.stiffness, b.stiffness);
                (across.stiffness - expected).abs() <= SAME * expected
            }
            law => a.law == law && b.law == law,
        }
    }

    /// With α = 0 and s00 of the pair the smaller of the two, no bond's s0 depends on which other bonds are whole.
    fn breaks_alike(&self, i: usize, j: usize) -> Result<(), HostError> {
        let (a, b, across) = (self.get(i, i), self.get(j, j), self.get(i, j));
        let toughness = |c: &Coefficients| (c.critical_stretch, c.alpha);
        let smaller = a.critical_stretch.min(b.critical_stretch);
        let same = toughness(&a) == toughness(&across) && toughness(&b) == toughness(&across);
        let constant = [a, b, across].iter().all(|c| c.alpha == 0.0);
        if same || (constant && across.critical_stretch == smaller) {
            return Ok(());
        }
        let (message, help) = if constant {
            (
                format!(
                    "`pair_coeff {i} {j}` has s00 = {}: between bonded types it must be the smaller of {} and {}",
                    across.critical_stretch, a.critical_stretch, b.critical_stretch
                ),
                format!("write {smaller}; or keep the types further apart than the horizon"),
            )
        } else {
            (
                format!(
                    "atoms of types {i} and {j} are bonded, have different s00 or alpha, and alpha is not 0: their critical stretches are not supported"
                ),
                "give both types and their pair the same s00 and alpha, or alpha = 0 to all and the smaller s00 to the pair; or keep the types further apart than the horizon".to_string(),
            )
        };
        Err(HostError::new(message).of_pair(i, j).help(help))
    }
}

fn mean(rule: InterfaceRule, a: f64, b: f64) -> f64 {
    match rule {
        InterfaceRule::Series => 2.0 * a * b / (a + b),
        InterfaceRule::Parallel => 0.5 * (a + b),
        InterfaceRule::Minimum => a.min(b),
    }
}
