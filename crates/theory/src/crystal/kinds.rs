//! Crystals of all potentials of a body, by their names: sums of mixtures and fans.

use super::{Atom, Crystal, CrystalError};
use peridyne::law::descriptor::Wrong;
use peridyne::law::fan;
use peridyne::law::potential::mixture::{Given, mixture};
use peridyne::law::potential::{self, Described};

/// A crystal and its energy per cell.
type Made<const D: usize> = Result<(Crystal<D>, f64), CrystalError>;

/// The crystal of potentials that are added, by their names and constants: its cell has these rows (length) and atoms, the kinds of
/// which are those of the constants.
///
/// # Errors
/// The engine has none of a name, or there is no crystal ([`Crystal::of_mixture`], [`Crystal::of_fan`]).
pub fn crystal<const D: usize>(
    potentials: &[(String, Given)],
    cell: [[f64; D]; D],
    atoms: &[Atom<D>],
) -> Made<D> {
    let mut sum: Option<(Crystal<D>, f64)> = None;
    for (name, given) in potentials {
        let mut find = Find {
            name,
            given,
            cell,
            atoms,
            found: None,
        };
        potential::each(&mut find);
        fan::each(&mut find);
        let unknown = || CrystalError::Potential(format!("there is no potential named {name}"));
        let (crystal, energy) = find.found.ok_or_else(unknown)??;
        sum = Some(match sum {
            None => (crystal, energy),
            Some((before, e)) => (before.plus(crystal), e + energy),
        });
    }
    sum.ok_or_else(|| CrystalError::Potential("no potential acts between these atoms".into()))
}

struct Find<'a, const D: usize> {
    name: &'a str,
    given: &'a Given,
    cell: [[f64; D]; D],
    atoms: &'a [Atom<D>],
    found: Option<Made<D>>,
}

impl<const D: usize> Find<'_, D> {
    /// The atoms, as one that knows so many kinds counts them.
    fn atoms(&self, kinds: usize) -> Vec<Atom<D>> {
        let kind = |k: usize| if kinds == 1 { 0 } else { k };
        let atoms = self.atoms.iter();
        atoms
            .map(|a| Atom {
                kind: kind(a.kind),
                ..*a
            })
            .collect()
    }
}

fn wrong((key, message): Wrong) -> CrystalError {
    CrystalError::Potential(match key.is_empty() {
        true => message,
        false => format!("{key}: {message}"),
    })
}

impl<const D: usize> potential::Kinds for Find<'_, D> {
    fn kind<P: Described>(&mut self) {
        if P::NAME == self.name {
            self.found = Some(mixture::<P>(self.given).map_err(wrong).and_then(|made| {
                Crystal::of_mixture(&made, self.cell, &self.atoms(made.kinds()))
            }));
        }
    }
}

impl<const D: usize> fan::Kinds for Find<'_, D> {
    fn fan<F: fan::Described>(&mut self) {
        if F::NAME == self.name {
            let made = fan::of_kinds::<F>(self.given).map_err(wrong);
            self.found = Some(made.and_then(|made| {
                Crystal::of_fan(&made, self.cell, &self.atoms(made.table().kinds()))
            }));
        }
    }
}
