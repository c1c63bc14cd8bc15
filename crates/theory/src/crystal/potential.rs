//! Crystals of an interatomic potential: second derivatives by Taylor arithmetic.

use super::cells::{Link, links, primitive};
use super::error::{CrystalError, positive};
use super::lattice::{Bond, Crystal};
use peridyne::law::jet;
use peridyne::law::potential::Potential;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::Horizon;

/// Which neighbours count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reach {
    /// All within the potential's own cut-off.
    Cutoff,
    /// All within a horizon of the reference.
    Horizon(Horizon),
    /// This many shells of equal distance.
    Shells(u32),
}

/// Most shells that can be asked for.
const SHELLS: u32 = 64;

/// What the reference state is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// Energy per atom.
    pub energy: f64,
    /// Pressure (energy / volume of D dimensions); 0 in equilibrium.
    pub pressure: f64,
    /// Density ρ_h at an atom; 0 for pair potentials.
    pub density: f64,
    /// Neighbours of an atom.
    pub neighbours: usize,
}

impl<const D: usize> Crystal<D> {
    /// A lattice of like atoms. `spacing` as in [`LatticeKind`]; `mass` per atom.
    pub fn of_potential(
        potential: &impl Potential,
        kind: LatticeKind,
        spacing: f64,
        mass: f64,
        reach: Reach,
    ) -> Result<(Self, Reference), CrystalError> {
        positive("the lattice spacing", spacing)?;
        positive("the mass", mass)?;
        let (cell, sites) = primitive::<D>(kind)?;
        let links = neighbours::<D>(potential, kind, spacing, reach)?;
        let distance = |l: &Link<D>| spacing * (l.squared as f64).sqrt() / 4.0;
        // sites are equivalent: the first one speaks for all
        let own: Vec<f64> = links.iter().filter(|l| l.from == 0).map(distance).collect();
        let rho: f64 = own
            .iter()
            .map(|r| jet::density::<1>(potential, *r)[0])
            .sum();
        let [f, slope, curvature] = jet::embedding::<3>(potential, rho);
        if [f, slope, curvature].iter().any(|x| !x.is_finite()) {
            return Err(CrystalError::Density { density: rho });
        }
        let pair: f64 = own.iter().map(|r| jet::pair::<1>(potential, *r)[0]).sum();
        let mut bonds = vec![];
        for link in &links {
            let r = distance(link);
            let phi = jet::pair::<3>(potential, r);
            let density = jet::density::<3>(potential, r);
            if phi.iter().chain(&density).any(|x| !x.is_finite()) {
                return Err(CrystalError::Distance { distance: r });
            }
            bonds.push(Bond {
                from: link.from,
                to: link.to,
                xi: link.offset.map(|x| x * spacing),
                tension: (phi[1] + 2.0 * slope * density[1]) / r,
                stiffness: phi[2] + 2.0 * slope * density[2],
                share: density[1],
            });
        }
        let crystal = Crystal {
            cell: cell.map(|row| row.map(|x| x * spacing)),
            mass: vec![mass; sites.len()],
            couplings: vec![],
            curvature: vec![curvature; sites.len()],
            basis: sites.iter().map(|s| s.map(|x| x * spacing)).collect(),
            bonds,
        };
        let reference = Reference {
            energy: f + 0.5 * pair,
            pressure: crystal.pressure(),
            density: rho,
            neighbours: own.len(),
        };
        Ok((crystal, reference))
    }
}

/// The spacing at which the lattice has no pressure, between `low` and `high` and to round-off; `None` if the pressure
/// has one sign at both, or there is no crystal.
pub fn equilibrium<const D: usize>(
    potential: &impl Potential,
    kind: LatticeKind,
    reach: Reach,
    range: [f64; 2],
) -> Option<f64> {
    rest(range, |a| {
        let (_, reference) = Crystal::<D>::of_potential(potential, kind, a, 1.0, reach).ok()?;
        Some(reference.pressure)
    })
}

/// Where a pressure vanishes between `low` and `high`, to round-off; `None` if it has one sign at both, or no value.
pub fn rest([mut low, mut high]: [f64; 2], pressure: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let (first, last) = (pressure(low)?, pressure(high)?);
    if first * last > 0.0 {
        return None;
    }
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return Some(middle);
        }
        if pressure(middle)? * first > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
}

fn neighbours<const D: usize>(
    potential: &impl Potential,
    kind: LatticeKind,
    spacing: f64,
    reach: Reach,
) -> Result<Vec<Link<D>>, CrystalError> {
    let within = |h| links::<D>(kind, spacing, h);
    let distance = |l: &Link<D>| spacing * (l.squared as f64).sqrt() / 4.0;
    let (mut found, reach) = match reach {
        Reach::Cutoff if potential.cutoff().is_finite() => {
            let cutoff = potential.cutoff();
            (within(Horizon::Length(cutoff))?, cutoff)
        }
        Reach::Cutoff => return Err(CrystalError::NoCutoff),
        Reach::Horizon(Horizon::Length(d)) => (within(Horizon::Length(d))?, d),
        Reach::Horizon(h @ Horizon::Ratio(m)) => (within(h)?, m as f64 * spacing),
        Reach::Shells(n) => (shells(kind, spacing, n)?, f64::INFINITY),
    };
    // beyond its cut-off a potential says nothing
    found.retain(|l| distance(l) <= potential.cutoff());
    if found.is_empty() {
        return Err(CrystalError::NoNeighbours {
            reach: reach.min(potential.cutoff()),
            nearest: kind.nearest() * spacing,
        });
    }
    Ok(found)
}

/// The nearest `n` shells.
fn shells<const D: usize>(
    kind: LatticeKind,
    spacing: f64,
    n: u32,
) -> Result<Vec<Link<D>>, CrystalError> {
    if n == 0 || n > SHELLS {
        return Err(CrystalError::TooManyShells {
            requested: n,
            most: SHELLS,
        });
    }
    let mut m = 0;
    loop {
        m += 1;
        let mut found = links::<D>(kind, spacing, Horizon::Ratio(m))?;
        let mut squares: Vec<i64> = found.iter().map(|l| l.squared).collect();
        squares.sort_unstable();
        squares.dedup();
        if let Some(last) = squares.get(n as usize - 1) {
            found.retain(|l| l.squared <= *last);
            return Ok(found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::law::number::Number;
    use peridyne::law::potential::lennard_jones::LennardJones;

    /// Johnson-like embedded atom: f = e^{−βr}, F = −√ρ + 0.1 ρ, φ = A e^{−αr}.
    #[derive(Clone)]
    struct Metal;
    impl Potential for Metal {
        const EMBEDDED: bool = true;
        fn cutoff(&self) -> f64 {
            2.05
        }
        fn pair<N: Number>(&self, q: N) -> N {
            q.sqrt().times(-4.0).exp().times(3.0)
        }
        fn density<N: Number>(&self, q: N) -> N {
            q.sqrt().times(-1.7).exp()
        }
        fn embedding<N: Number>(&self, density: N) -> N {
            density.times(0.1) - density.sqrt()
        }
    }

    #[test]
    fn pressure_is_the_slope_of_the_energy() {
        let energy = |a: f64| {
            Crystal::<3>::of_potential(
                &Metal,
                LatticeKind::Fcc,
                a,
                1.0,
                Reach::Horizon(Horizon::Ratio(1)),
            )
            .unwrap()
        };
        let (a, h) = (1.4, 1e-4);
        let slope = (energy(a + h).1.energy - energy(a - h).1.energy) / (2.0 * h);
        let (crystal, reference) = energy(a);
        let expected = -slope / (3.0 * a * a / 4.0);
        assert!((reference.pressure / expected - 1.0).abs() < 1e-6);
        assert_eq!(reference.neighbours, 18);
        assert!(crystal.residual() < 1e-15);
        assert!((crystal.density() * a * a * a / 4.0 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn chains_of_lennard_jones_rest_where_the_sums_say() {
        // σ = a (Z(6)/(2 Z(12)))^(1/6), not a/2^(1/6)
        use crate::exact::zeta;
        let lj = LennardJones {
            epsilon: 1.0,
            sigma: 1.0,
        };
        for n in [1, 4] {
            let reach = Reach::Shells(n);
            let a = equilibrium::<1>(&lj, LatticeKind::Chain, reach, [0.9, 1.5]).unwrap();
            let z = |p| zeta::<f64>(n as usize, p);
            let sigma = a * (z(6) / (2.0 * z(12))).powf(1.0 / 6.0);
            assert!((sigma - 1.0).abs() < 1e-14, "{n}: {a}");
        }
        assert_eq!(
            equilibrium::<1>(&lj, LatticeKind::Chain, Reach::Shells(1), [1.2, 1.5]),
            None
        );
    }

    #[test]
    fn beyond_its_cutoff_a_potential_says_nothing() {
        let of = |reach| Crystal::<3>::of_potential(&Metal, LatticeKind::Fcc, 1.4, 1.0, reach);
        let wide = of(Reach::Horizon(Horizon::Ratio(2))).unwrap();
        assert_eq!(wide, of(Reach::Cutoff).unwrap());
        assert_eq!(wide, of(Reach::Shells(6)).unwrap());
        // shells at 0.99, 1.4, 1.71, 1.98; the next is at 2.21
        assert_eq!(wide.1.neighbours, 54);
    }

    #[test]
    fn shells_are_counted_by_distance() {
        let lj = LennardJones {
            epsilon: 1.0,
            sigma: 1.0,
        };
        let count = |kind, n| {
            let reach = Reach::Shells(n);
            Crystal::<3>::of_potential(&lj, kind, 1.5, 1.0, reach)
                .unwrap()
                .1
                .neighbours
        };
        assert_eq!(
            [1, 2, 3, 4].map(|n| count(LatticeKind::Fcc, n)),
            [12, 18, 42, 54]
        );
        assert_eq!([1, 2, 3].map(|n| count(LatticeKind::Bcc, n)), [8, 14, 26]);
        assert_eq!(
            [1, 2, 3].map(|n| count(LatticeKind::Diamond, n)),
            [4, 16, 28]
        );
    }

    #[test]
    fn what_cannot_be_said() {
        let lj = LennardJones {
            epsilon: 1.0,
            sigma: 1.0,
        };
        let of = |reach, a| {
            Crystal::<3>::of_potential(&lj, LatticeKind::Fcc, a, 1.0, reach).unwrap_err()
        };
        assert_eq!(of(Reach::Cutoff, 1.5), CrystalError::NoCutoff);
        let short = of(Reach::Horizon(Horizon::Length(1.0)), 1.5);
        assert!(
            short
                .to_string()
                .starts_with("no neighbour within the reach of 1")
        );
        assert!(matches!(
            of(Reach::Shells(0), 1.5),
            CrystalError::TooManyShells { .. }
        ));
        assert!(matches!(
            of(Reach::Shells(1), -1.0),
            CrystalError::NotPositive { .. }
        ));
    }
}
