//! What is not unique: which atoms a term's energy belongs to, and which pair forces add up to the forces.

use peridyne::law::terms::Term;
use std::fmt;
use std::sync::Arc;

/// Parts of a term's energy for the atoms that it depends on, in the order of [`Term::particles`]; they add up to 1.
pub type Weights = Arc<dyn Fn(&Term, &mut Vec<f64>) + Send + Sync>;

/// Parts `U^(j)` of the energy (4.0.53): a term's energy times a weight for each of its atoms.
#[derive(Clone, Default)]
pub enum Partition {
    /// All of a term to its centre; a pair's energy in halves to its ends. Two-body potentials and embedded atoms do not churn then.
    #[default]
    Site,
    /// 1/K of a term to each of its K atoms (4.0.126).
    Equal,
    /// So much of a term to its centre, the rest in equal parts to the others: 1 is [`Partition::Site`].
    Centre(f64),
    /// Any weights.
    Weights(Weights),
}

impl fmt::Debug for Partition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())
    }
}

impl Partition {
    pub fn name(&self) -> String {
        match self {
            Partition::Site => "site".into(),
            Partition::Equal => "equal".into(),
            Partition::Centre(w) => format!("centre:{w}"),
            Partition::Weights(_) => "custom".into(),
        }
    }

    /// Weights of a term.
    pub fn weights(&self, term: &Term, out: &mut Vec<f64>) {
        let n = term.particles.len();
        out.clear();
        let mut centre = |w: f64| {
            let rest = if n > 1 {
                (1.0 - w) / (n - 1) as f64
            } else {
                0.0
            };
            out.resize(n, rest);
            if let Some(first) = out.first_mut() {
                *first = if n > 1 { w } else { 1.0 };
            }
        };
        match self {
            Partition::Site => centre(1.0),
            Partition::Equal => out.resize(n, 1.0 / n as f64),
            Partition::Centre(w) => centre(*w),
            Partition::Weights(weights) => weights(term, out),
        }
    }
}

/// Which pair forces: all add up to the forces on the atoms, and stress depends on the choice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PairForce {
    /// `f_jk = −x_jk ∂U/∂ξ_jk` (4.0.39): along the line of the pair, so that stress is symmetric.
    #[default]
    Distances,
    /// `f_k0 = −∂U/∂x_k` of a term as a function of its differences from the centre (4.0.26), from the centre's star: bonds between atoms
    /// that are not the centre carry nothing; stress need not be symmetric. With [`Partition::Site`] nothing churns.
    Differences,
}

impl PairForce {
    pub fn name(self) -> &'static str {
        match self {
            PairForce::Distances => "distances",
            PairForce::Differences => "differences",
        }
    }
}
