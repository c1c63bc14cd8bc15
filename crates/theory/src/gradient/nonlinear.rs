//! The nonlinear gradient equation of a chain with a law, at a stretch y′: `ρ ÿ = Σ_p P_p(y″, y‴, …)` with
//! the numbers that the law has there in place of the symbols of the universal equation.

use super::Expansion;
use super::law_sum::{LawSum, Symbol};
use super::universal;
use crate::crystal::cells::links;
use crate::crystal::{CrystalError, Reach};
use crate::exact::Field;
use crate::exact::polynomial::JetPolynomial;
use crate::gradient::linear::LinearChain;
use crate::gradient::power_law::PowerLawChain;
use crate::upscale::{self, UpscaleError};
use peridyne::law::jet::Jet;
use peridyne::law::potential::{Potential, Visitor};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::Spec;

/// A chain of like points, whatever binds them.
pub trait Chain<F: Field> {
    /// Δx (length).
    fn spacing(&self) -> F;
    /// Bonds of a point on one side, where neighbours are `stretch` Δx apart.
    fn neighbours(&self, stretch: &F) -> Result<usize, CrystalError>;
    /// Has a point an energy of its own, F(ρ)?
    fn embedded(&self) -> bool {
        false
    }
    /// φ of the bond to the j-th neighbour at the length r and its derivatives, `count` numbers.
    fn pair(&self, j: usize, r: &F, count: usize) -> Vec<F>;
    /// What that bond adds to ρ, likewise.
    fn density(&self, _j: usize, _r: &F, count: usize) -> Vec<F> {
        vec![F::zero(); count]
    }
    /// F at the density ρ, likewise.
    fn embedding(&self, _rho: &F, count: usize) -> Vec<F> {
        vec![F::zero(); count]
    }
}

/// Highest derivative of a law that its Taylor arithmetic carries, and the terms that it is enough for.
const DERIVATIVES: usize = 64;
pub const MOST_TERMS: usize = (DERIVATIVES - 2) / 2;

/// Gradient orders 2, 4, …, 2 `terms` at the stretch y′; coefficients are those of y″, y‴, ….
///
/// # Errors
/// Why the chain has no such state: no neighbours, no value of the law there, more terms than [`MOST_TERMS`].
pub fn expansion<F: Field>(
    chain: &impl Chain<F>,
    stretch: &F,
    terms: usize,
) -> Result<Expansion<F>, CrystalError> {
    if terms > MOST_TERMS {
        return Err(CrystalError::TooManyTerms {
            requested: terms,
            most: MOST_TERMS,
        });
    }
    put_in(
        &universal::expansion(terms, chain.embedded()),
        chain,
        stretch,
    )
}

/// The chain's law put into a universal equation: for many stretches that is made only once.
///
/// # Errors
/// As [`expansion`].
pub fn put_in<F: Field>(
    equation: &Expansion<LawSum<F>>,
    chain: &impl Chain<F>,
    stretch: &F,
) -> Result<Expansion<F>, CrystalError> {
    let numbers = Numbers::new(chain, stretch, 2 * equation.orders.len() + 1)?;
    let a = chain.spacing();
    let order = |(p, order): (usize, &JetPolynomial<LawSum<F>>)| {
        let length = a.to(2 * p as i32);
        order.map(|c| length.clone() * c.at(|symbol| numbers.value(symbol)))
    };
    Ok(Expansion {
        orders: equation.orders.iter().enumerate().map(order).collect(),
    })
}

/// The sums P, R, F of one law at one stretch, with lengths in units of Δx: powers of atomic distances in metres would
/// leave the range of numbers. In gradient order 2p + 2 all terms lack the same Δx^{2p}.
struct Numbers<F> {
    /// `[m][n]`
    pair: Vec<Vec<F>>,
    density: Vec<Vec<F>>,
    embedding: Vec<F>,
}

impl<F: Field> Numbers<F> {
    /// With derivatives below `count` and powers of the length below twice that.
    fn new(chain: &impl Chain<F>, stretch: &F, count: usize) -> Result<Self, CrystalError> {
        let value = stretch.value();
        if !(value > 0.0 && value.is_finite()) {
            return Err(CrystalError::NotPositive {
                what: "the stretch",
                value,
            });
        }
        let a = chain.spacing();
        let mut pair = vec![vec![F::zero(); 2 * count]; count];
        let mut density = pair.clone();
        for j in 1..=chain.neighbours(stretch)? {
            let number = F::whole(j as i64);
            let r = number.clone() * a.clone() * stretch.clone();
            let reduced = |derivatives: Vec<F>| -> Vec<F> {
                let powers = derivatives.into_iter().enumerate();
                powers.map(|(m, x)| x * a.to(m as i32)).collect()
            };
            let bond = reduced(chain.pair(j, &r, count));
            let share = reduced(chain.density(j, &r, count));
            if bond.iter().chain(&share).any(|x| !x.value().is_finite()) {
                return Err(CrystalError::Distance {
                    distance: r.value(),
                });
            }
            let mut power = F::one();
            for n in 0..2 * count {
                for m in 0..count {
                    let add = |sum: &mut F, x: F| *sum = sum.clone() + x * power.clone();
                    add(&mut pair[m][n], bond[m].clone() / a.clone());
                    add(&mut density[m][n], F::whole(2) * share[m].clone());
                }
                power = power * number.clone();
            }
        }
        let rho = density[0][0].clone();
        let embedding = chain.embedding(&rho, count);
        if embedding.iter().any(|x| !x.value().is_finite()) {
            return Err(CrystalError::Density {
                density: rho.value(),
            });
        }
        Ok(Numbers {
            pair,
            density,
            embedding: embedding.into_iter().map(|x| x / a.clone()).collect(),
        })
    }

    fn value(&self, symbol: Symbol) -> F {
        match symbol {
            Symbol::Pair(m, n) => self.pair[m][n].clone(),
            Symbol::Density(m, n) => self.density[m][n].clone(),
            Symbol::Embedding(k) => self.embedding[k].clone(),
        }
    }
}

/// `0, …, 0` after the first few.
fn padded<F: Field>(mut first: Vec<F>, count: usize) -> Vec<F> {
    first.resize(count, F::zero());
    first
}

impl<F: Field> Chain<F> for PowerLawChain<F> {
    fn spacing(&self) -> F {
        self.spacing.clone()
    }
    fn neighbours(&self, _: &F) -> Result<usize, CrystalError> {
        Ok(self.neighbours)
    }
    fn pair(&self, _: usize, r: &F, count: usize) -> Vec<F> {
        let mut sum = vec![F::zero(); count];
        for (n, amplitude) in &self.amplitudes {
            let mut value = amplitude.clone() * self.spacing.clone() * r.to(-n);
            for (m, s) in sum.iter_mut().enumerate() {
                *s = s.clone() + value.clone();
                value = value * F::whole(-i64::from(*n) - m as i64) / r.clone();
            }
        }
        sum
    }
}

/// Springs, structured embedded atoms, bond- and state-based bars: a bond answers to its extension linearly, and so does
/// the whole chain at any stretch.
impl<F: Field> Chain<F> for LinearChain<F> {
    fn spacing(&self) -> F {
        self.spacing.clone()
    }
    fn neighbours(&self, _: &F) -> Result<usize, CrystalError> {
        Ok(self.stiffness.len().max(self.share.len()))
    }
    fn embedded(&self) -> bool {
        !self.share.is_empty()
    }
    fn pair(&self, j: usize, r: &F, count: usize) -> Vec<F> {
        let k = self.stiffness.get(j - 1).cloned().unwrap_or_else(F::zero);
        let e = r.clone() - F::whole(j as i64) * self.spacing.clone();
        let half = F::ratio(1, 2);
        let force = k.clone() * e.clone();
        padded(vec![half * force.clone() * e, force, k], count)
    }
    fn density(&self, j: usize, r: &F, count: usize) -> Vec<F> {
        let f = self.share.get(j - 1).cloned().unwrap_or_else(F::zero);
        let e = r.clone() - F::whole(j as i64) * self.spacing.clone();
        padded(vec![f.clone() * e, f], count)
    }
    fn embedding(&self, rho: &F, count: usize) -> Vec<F> {
        let slope = self.curvature.clone() * rho.clone();
        let energy = F::ratio(1, 2) * slope.clone() * rho.clone();
        padded(vec![energy, slope, self.curvature.clone()], count)
    }
}

/// A chain of atoms with an interatomic potential.
#[derive(Debug, Clone, PartialEq)]
pub struct PotentialChain<P> {
    potential: P,
    spacing: f64,
    /// `None`: all within the cut-off.
    neighbours: Option<usize>,
}

impl<P: Potential> PotentialChain<P> {
    /// `spacing` (length) is that of the reference, where the reach is counted unless it is the cut-off.
    ///
    /// # Errors
    /// No cut-off where that is the reach, too many shells.
    pub fn new(potential: P, spacing: f64, reach: Reach) -> Result<Self, CrystalError> {
        let neighbours = match reach {
            Reach::Cutoff if potential.cutoff().is_finite() => None,
            Reach::Cutoff => return Err(CrystalError::NoCutoff),
            Reach::Horizon(h) => Some(links::<1>(LatticeKind::Chain, spacing, h)?.len() / 2),
            Reach::Shells(n) => Some(n as usize),
        };
        Ok(PotentialChain {
            potential,
            spacing,
            neighbours,
        })
    }

    /// Derivatives of a function at x by Taylor arithmetic.
    fn derivatives(
        x: f64,
        count: usize,
        short: impl Fn(Jet<8>) -> Jet<8>,
        long: impl Fn(Jet<DERIVATIVES>) -> Jet<DERIVATIVES>,
    ) -> Vec<f64> {
        match count {
            0..=8 => short(Jet::variable(x)).derivatives()[..count].to_vec(),
            _ => long(Jet::variable(x)).derivatives()[..count].to_vec(),
        }
    }
}

impl<P: Potential> Chain<f64> for PotentialChain<P> {
    fn spacing(&self) -> f64 {
        self.spacing
    }
    fn neighbours(&self, stretch: &f64) -> Result<usize, CrystalError> {
        let nearest = self.spacing * stretch;
        let within = (self.potential.cutoff() / nearest).floor();
        let count = match self.neighbours {
            // beyond its cut-off a potential says nothing
            Some(n) => within.min(n as f64),
            None => within,
        };
        if count < 1.0 {
            return Err(CrystalError::NoNeighbours {
                reach: self.potential.cutoff(),
                nearest,
            });
        }
        Ok(count as usize)
    }
    fn embedded(&self) -> bool {
        P::EMBEDDED
    }
    fn pair(&self, _: usize, r: &f64, count: usize) -> Vec<f64> {
        let p = &self.potential;
        Self::derivatives(*r, count, |r| p.pair(r * r), |r| p.pair(r * r))
    }
    fn density(&self, _: usize, r: &f64, count: usize) -> Vec<f64> {
        let p = &self.potential;
        Self::derivatives(*r, count, |r| p.density(r * r), |r| p.density(r * r))
    }
    fn embedding(&self, rho: &f64, count: usize) -> Vec<f64> {
        let p = &self.potential;
        Self::derivatives(*rho, count, |x| p.embedding(x), |x| p.embedding(x))
    }
}

/// The equation of a chain of atoms at those of the stretches at which its law has a value, per volume of the
/// three-dimensional body. Springs and solids answer linearly, [`LinearChain`] says all about them. None of a chain of several kinds, or with
/// several potentials: the equation is that of one.
///
/// # Errors
/// Not a chain of atoms on a lattice.
pub fn of_spec(
    spec: &Spec,
    stretches: &[f64],
    terms: usize,
) -> Result<Vec<(f64, Expansion<f64>)>, UpscaleError> {
    struct OfPotential<'a> {
        spec: &'a Spec,
        spacing: f64,
        stretches: &'a [f64],
        terms: usize,
    }
    impl Visitor for OfPotential<'_> {
        type Out = Result<Vec<(f64, Expansion<f64>)>, UpscaleError>;
        fn visit<P: Potential>(self, potential: P) -> Self::Out {
            let reach = upscale::reach(self.spec);
            let chain = PotentialChain::new(potential, self.spacing, reach)?;
            let equation = universal::expansion(self.terms, chain.embedded());
            let per_section = 1.0 / self.spec.space.section;
            let at = |stretch: &f64| {
                let e = put_in(&equation, &chain, stretch).ok()?;
                let orders = e.orders.iter().map(|p| p.scale(&per_section)).collect();
                Some((*stretch, Expansion { orders }))
            };
            Ok(self.stretches.iter().filter_map(at).collect())
        }
    }
    if upscale::has_basis_or_many_body(spec) {
        return Ok(vec![]);
    }
    let (kind, spacing) = upscale::lattice(spec)?;
    match (spec.potential(), kind) {
        (Some(potential), LatticeKind::Chain) => {
            let of = OfPotential {
                spec,
                spacing,
                stretches,
                terms,
            };
            potential.apply(of).map_err(CrystalError::Potential)?
        }
        _ => Err(UpscaleError::NoChain),
    }
}

#[cfg(test)]
mod tests;
