//! Crystals of several kinds of atoms: any cell with any basis, in a potential of their kinds.

use super::atoms::{Atom, Cell, Near, neighbours};
use super::error::CrystalError;
use super::lattice::{Bond, Crystal};
use peridyne::law::jet;
use peridyne::law::potential::Potential;
use peridyne::law::potential::mixture::Mixture;

impl<const D: usize> Crystal<D> {
    /// A periodic crystal whose cell has these rows (length) and atoms, and its energy per cell. As many branches of waves as the
    /// cell has atoms, times D; all but D of them are optical.
    ///
    /// # Errors
    /// A pair without cut-off or beyond what a potential describes; no neighbours; a mass that is none.
    pub fn of_mixture<P: Potential>(
        mixture: &Mixture<P>,
        cell: [[f64; D]; D],
        atoms: &[Atom<D>],
    ) -> Result<(Self, f64), CrystalError> {
        Crystal::of_cell(
            mixture,
            Cell {
                rows: cell,
                atoms,
                fixed: None,
            },
        )
    }

    pub(super) fn of_cell<P: Potential>(
        mixture: &Mixture<P>,
        cell: Cell<D>,
    ) -> Result<(Self, f64), CrystalError> {
        let atoms = cell.atoms;
        let cutoff = |a: usize, b: usize| mixture.cutoff(a, b);
        let near = match cell.fixed {
            Some(all) => {
                let within = |n: &&Near<D>| n.r < cutoff(atoms[n.from].kind, atoms[n.to].kind);
                all.iter().filter(within).copied().collect()
            }
            None => neighbours(&cell.rows, atoms, mixture.reach(), cutoff)?,
        };
        let of = |n: &Near<D>| mixture.of(atoms[n.from].kind, atoms[n.to].kind);
        let mut density = vec![0.0; atoms.len()];
        let mut energy = 0.0;
        for n in &near {
            if let Some(p) = of(n) {
                density[n.from] += jet::density::<1>(p, n.r)[0];
                energy += 0.5 * jet::pair::<1>(p, n.r)[0];
            }
        }
        let (mut slope, mut curvature) = (vec![0.0; atoms.len()], vec![0.0; atoms.len()]);
        for (s, atom) in atoms.iter().enumerate() {
            let Some(own) = mixture.own(atom.kind) else {
                continue;
            };
            let f = jet::embedding::<3>(own, density[s]);
            if f.iter().any(|x| !x.is_finite()) {
                let density = density[s];
                return Err(CrystalError::Density { density });
            }
            energy += f[0];
            (slope[s], curvature[s]) = (f[1], f[2]);
        }
        let mut bonds = vec![];
        for n in near {
            let kinds = [n.from, n.to].map(|s| atoms[s].kind);
            let (Some(p), Some(back)) = (
                mixture.of(kinds[0], kinds[1]),
                mixture.of(kinds[1], kinds[0]),
            ) else {
                continue;
            };
            let phi = jet::pair::<3>(p, n.r);
            // what each end gets from the other
            let [here, there] = [p, back].map(|p| jet::density::<3>(p, n.r));
            if phi
                .iter()
                .chain(&here)
                .chain(&there)
                .any(|x| !x.is_finite())
            {
                return Err(CrystalError::Distance { distance: n.r });
            }
            let both = |d: usize| phi[d] + slope[n.from] * here[d] + slope[n.to] * there[d];
            bonds.push(Bond {
                from: n.from,
                to: n.to,
                xi: n.xi,
                tension: both(1) / n.r,
                stiffness: both(2),
                share: here[1],
            });
        }
        let crystal = Crystal {
            cell: cell.rows,
            basis: atoms.iter().map(|a| a.place).collect(),
            mass: atoms.iter().map(|a| a.mass).collect(),
            bonds,
            curvature,
            couplings: vec![],
        };
        Ok((crystal, energy))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::law::number::Number;

    /// `½ K (r − a)²` up to one and a half a.
    #[derive(Clone)]
    struct Spring {
        k: f64,
        a: f64,
    }

    impl Potential for Spring {
        fn cutoff(&self) -> f64 {
            1.5 * self.a
        }
        fn pair<N: Number>(&self, q: N) -> N {
            q.sqrt().plus(-self.a).power(2).times(0.5 * self.k)
        }
    }

    /// `ω² = K (1/m + 1/M) ∓ K √((1/m + 1/M)² − 4 sin²(k a) / (m M))` (Born & von Kármán 1912).
    #[test]
    fn a_chain_of_two_masses_has_an_acoustic_and_an_optical_branch() {
        let (k, a, m, n) = (2.3, 1.1, 0.7, 2.9);
        let atom = |place, kind, mass| Atom {
            place: [place],
            kind,
            mass,
        };
        let mixture = Mixture::new(2, |i, j| (i != j).then_some(Spring { k, a }));
        let atoms = [atom(0.2, 0, m), atom(0.2 + a, 1, n)];
        let (crystal, energy) = Crystal::<1>::of_mixture(&mixture, [[2.0 * a]], &atoms).unwrap();
        assert!(energy.abs() < 1e-15 && crystal.residual() < 1e-14);
        assert_eq!(crystal.bonds.len(), 4);
        let sum = 1.0 / m + 1.0 / n;
        for step in 0..=20 {
            let wave = std::f64::consts::FRAC_PI_2 / a * f64::from(step) / 20.0;
            let root = (sum * sum - 4.0 * (wave * a).sin().powi(2) / (m * n)).sqrt();
            let found = crystal.squares([wave]);
            for (found, exact) in found.iter().zip([k * (sum - root), k * (sum + root)]) {
                assert!(
                    (found - exact).abs() < 1e-13 * k * sum,
                    "{wave}: {found} {exact}"
                );
            }
        }
        // long waves run at the speed of the mean mass
        let small = 1e-3 / a;
        let speed = crystal.squares([small])[0].sqrt() / small;
        let exact = (k * a * 2.0 * a / (m + n)).sqrt();
        assert!((speed / exact - 1.0).abs() < 1e-6, "{speed} {exact}");
    }

    #[test]
    fn what_has_no_crystal() {
        let spring = Spring { k: 1.0, a: 1.0 };
        let atom = Atom {
            place: [0.0],
            kind: 0,
            mass: 1.0,
        };
        let alone = Crystal::<1>::of_mixture(&Mixture::one(spring), [[5.0]], &[atom]);
        assert!(matches!(alone, Err(CrystalError::NoNeighbours { .. })));
    }
}
