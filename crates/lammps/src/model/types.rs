//! Coefficients of several atom types as materials of the engine and a table of their pairs.
//!
//! What LAMMPS does, observed: c (PMB), horizon, s00 and α are those of the pair of types; a point's s0 is the greatest
//! s00 − α·stretch over its unbroken bonds. Forces of LPS on a point have the K and G of the point's own type for both
//! ends of the bond, so those of unlike types are not opposite. Contact is 15 c/δ of the pair; for LPS c = 18 K/(πδ⁴) with
//! the K of whichever point stands first in a neighbour list, for which the mean of both is taken here.

use peridyne::spec::{ContactStiffness, LawSpec, PairSpec, Parameter, Parameters, PmbStiffness};

use crate::atoms::{Atoms, Column};
use crate::host::{
    EpsCoefficients, HostError, LpsCoefficients, Pair, PmbCoefficients, Style, VesCoefficients,
};

/// What a pair of types has.
#[derive(Debug, Clone, PartialEq)]
pub struct Coefficients {
    pub law: LawSpec,
    pub horizon: f64,
    pub critical_stretch: f64,
    pub alpha: f64,
}

impl From<PmbCoefficients> for Coefficients {
    fn from(c: PmbCoefficients) -> Self {
        Coefficients {
            law: LawSpec::Pmb(PmbStiffness::Micromodulus(c.micromodulus)),
            horizon: c.horizon,
            critical_stretch: c.critical_stretch,
            alpha: c.alpha,
        }
    }
}

impl From<LpsCoefficients> for Coefficients {
    fn from(c: LpsCoefficients) -> Self {
        Coefficients {
            law: LawSpec::Lps3d {
                bulk: c.bulk,
                shear: c.shear,
            },
            horizon: c.horizon,
            critical_stretch: c.critical_stretch,
            alpha: c.alpha,
        }
    }
}

impl LpsCoefficients {
    /// The same with a law of the registry, which has these moduli and more.
    fn named(self, name: &str, more: (&str, Parameter)) -> Coefficients {
        let moduli = Parameters::numbers(&[("bulk", self.bulk), ("shear", self.shear)]);
        Coefficients {
            law: LawSpec::named(name, moduli.with(more.0, more.1)),
            ..self.into()
        }
    }
}

impl From<VesCoefficients> for Coefficients {
    fn from(c: VesCoefficients) -> Self {
        // nothing relaxes: the elastic solid
        if c.part == 0.0 {
            return c.solid.into();
        }
        let branches = Parameter::Rows(vec![vec![c.part, c.time]]);
        c.solid.named("viscoelastic", ("branches", branches))
    }
}

impl From<EpsCoefficients> for Coefficients {
    fn from(c: EpsCoefficients) -> Self {
        let stress = Parameter::Number(c.yield_stress);
        c.solid.named("elastic_plastic", ("yield_stress", stress))
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
    /// There are too many types.
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
        if types.pairs().all(|(i, j)| types.get(i, j) == own) {
            types.materials.truncate(1);
        }
        let style = pair.style();
        if types.materials.len() > 1 && matches!(style, Style::Ves | Style::Eps) {
            let unlike = types.pairs().find(|(i, j)| types.get(*i, *j) != own);
            let (i, j) = unlike.unwrap_or((first, first));
            return Err(HostError::new(format!(
                "atom types with unlike coefficients of `{}`: types {i} and {j} have others than {first} and {first}",
                style.name()
            ))
            .help("give all types the same with `pair_coeff * * ...`; types of their own have `peri/pmb` and `peri/lps`"));
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
            Pair::Ves(table) => table.get(i, j).into(),
            Pair::Eps(table) => table.get(i, j).into(),
        }
    }

    /// The longest of all pairs.
    pub fn horizon(&self) -> f64 {
        let all = self.pairs().map(|(i, j)| self.get(i, j).horizon);
        all.fold(0.0, f64::max)
    }

    /// All pairs i <= j of types that atoms have.
    fn pairs(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let of = |i: usize| self.present.iter().map(move |j| (i, *j));
        self.present
            .iter()
            .flat_map(move |i| of(*i))
            .filter(|(i, j)| i <= j)
    }

    /// What the engine needs to know of every pair of materials, `[of][with]`; nothing where there is one material.
    pub fn table(&self) -> Vec<PairSpec> {
        if self.materials.len() == 1 {
            return vec![];
        }
        let all = |i: usize| self.materials.iter().map(move |j| (i, *j));
        let pairs = self.materials.iter().flat_map(|i| all(*i));
        pairs
            .map(|(i, j)| {
                let c = self.get(i, j);
                // moduli are those of the point's own type
                let law = match c.law {
                    LawSpec::Lps3d { .. } => self.get(i, i).law,
                    law => law,
                };
                PairSpec {
                    horizon: c.horizon,
                    law,
                    critical_stretch: c.critical_stretch,
                    alpha: c.alpha,
                }
            })
            .collect()
    }

    /// Stiffness of contact.
    pub fn contact(&self) -> ContactStiffness {
        match (self.pair.style(), &self.materials[..]) {
            (Style::Pmb | Style::Lps, [_]) => ContactStiffness::Laws,
            (_, [only]) => ContactStiffness::Same(self.repulsion(*only, *only)),
            (_, all) => {
                let row = |i: &usize| all.iter().map(|j| self.repulsion(*i, *j)).collect();
                ContactStiffness::Pairs(all.iter().map(row).collect())
            }
        }
    }

    /// 15 c/δ (force / volume² / length).
    fn repulsion(&self, i: usize, j: usize) -> f64 {
        let c = self.get(i, j);
        if c.horizon == 0.0 {
            return f64::INFINITY;
        }
        let micromodulus = match self.pair {
            Pair::Pmb(table) => table.get(i, j).micromodulus,
            Pair::Lps(_) | Pair::Ves(_) | Pair::Eps(_) => {
                let bulk = |i: usize| self.solid(i).map_or(0.0, |s| s.bulk);
                let bulk = 0.5 * (bulk(i) + bulk(j));
                18.0 * bulk / (std::f64::consts::PI * c.horizon.powi(4))
            }
        };
        15.0 * micromodulus / c.horizon
    }

    /// Pairs of types that nothing bonds: their contact is without bounds.
    pub fn unbonded(&self) -> Vec<(usize, usize)> {
        let all = self.pairs();
        all.filter(|(i, j)| self.get(*i, *j).horizon == 0.0)
            .collect()
    }

    /// Moduli of a type.
    fn solid(&self, i: usize) -> Option<LpsCoefficients> {
        match self.pair {
            Pair::Pmb(_) => None,
            Pair::Lps(table) => Some(table.get(i, i)),
            Pair::Ves(table) => Some(table.get(i, i).solid),
            Pair::Eps(table) => Some(table.get(i, i).solid),
        }
    }

    /// Bulk and shear modulus of each material; nothing of PMB.
    pub fn moduli(&self) -> Vec<[f64; 2]> {
        let own = self.materials.iter().filter_map(|i| self.solid(*i));
        own.map(|s| [s.bulk, s.shear]).collect()
    }

    /// Which material a type is of.
    pub fn material_of(&self, kind: usize) -> usize {
        self.materials.iter().position(|m| *m == kind).unwrap_or(0)
    }

    /// Do LPS types differ in K or G?
    pub fn unlike_moduli(&self) -> bool {
        let moduli = self.moduli();
        moduli.iter().any(|m| *m != moduli[0])
    }
}
