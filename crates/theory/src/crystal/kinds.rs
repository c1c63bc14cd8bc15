//! Crystals of all potentials of a body, by their names: sums of mixtures and many-body potentials.

use super::Atom;
use super::atoms::Cell;
use super::error::CrystalError;
use super::lattice::Crystal;
use peridyne::law::descriptor::Wrong;
use peridyne::law::many_body::{self, ManyBody};
use peridyne::law::potential::mixture::{Given, Mixture, mixture};
use peridyne::law::potential::{self, Described, Potential};

/// What is asked of each potential about a cell.
trait Ask<const D: usize> {
    type Out;

    fn mixture<P: Potential>(
        mixture: &Mixture<P>,
        cell: Cell<D>,
    ) -> Result<Self::Out, CrystalError>;

    fn many_body<F: ManyBody>(many_body: &F, cell: Cell<D>) -> Result<Self::Out, CrystalError>;
}

/// The crystal, and the energy per cell.
struct Whole;

impl<const D: usize> Ask<D> for Whole {
    type Out = (Crystal<D>, f64);

    fn mixture<P: Potential>(
        mixture: &Mixture<P>,
        cell: Cell<D>,
    ) -> Result<Self::Out, CrystalError> {
        Crystal::of_cell(mixture, cell)
    }

    fn many_body<F: ManyBody>(many_body: &F, cell: Cell<D>) -> Result<Self::Out, CrystalError> {
        Crystal::of_many_body(many_body, cell.rows, cell.atoms)
    }
}

/// Energy per cell and pressure.
struct State;

impl<const D: usize> Ask<D> for State {
    type Out = [f64; 2];

    fn mixture<P: Potential>(
        mixture: &Mixture<P>,
        cell: Cell<D>,
    ) -> Result<Self::Out, CrystalError> {
        let (crystal, energy) = Crystal::of_cell(mixture, cell)?;
        Ok([energy, crystal.pressure()])
    }

    fn many_body<F: ManyBody>(many_body: &F, cell: Cell<D>) -> Result<Self::Out, CrystalError> {
        super::many_body::state(many_body, cell.rows, cell.atoms)
    }
}

/// The crystal of potentials that are added, by their names and constants, and its energy per cell. The kinds of its atoms are those of
/// the constants.
///
/// # Errors
/// The engine has none of a name, or there is no crystal ([`Crystal::of_mixture`], [`Crystal::of_many_body`]).
pub(crate) fn crystal<const D: usize>(
    potentials: &[(String, Given)],
    cell: Cell<D>,
) -> Result<(Crystal<D>, f64), CrystalError> {
    let all = ask::<D, Whole>(potentials, cell)?.into_iter();
    let sum = all.reduce(|(a, e), (b, f)| (a.plus(b), e + f));
    sum.ok_or_else(nothing)
}

/// Energy per cell and pressure (energy / length^D) of the same, without second derivatives.
///
/// # Errors
/// As of [`crystal`].
pub(crate) fn state<const D: usize>(
    potentials: &[(String, Given)],
    cell: Cell<D>,
) -> Result<[f64; 2], CrystalError> {
    let all = ask::<D, State>(potentials, cell)?.into_iter();
    let sum = all.reduce(|[a, b], [c, d]| [a + c, b + d]);
    sum.ok_or_else(nothing)
}

fn nothing() -> CrystalError {
    CrystalError::Potential("no potential acts between these atoms".into())
}

fn ask<const D: usize, A: Ask<D>>(
    potentials: &[(String, Given)],
    cell: Cell<D>,
) -> Result<Vec<A::Out>, CrystalError> {
    let mut answers = vec![];
    for (name, given) in potentials {
        let mut find = Find::<D, A> {
            name,
            given,
            cell,
            found: None,
        };
        potential::each(&mut find);
        many_body::each(&mut find);
        let unknown = || CrystalError::Potential(format!("there is no potential named {name}"));
        answers.push(find.found.ok_or_else(unknown)??);
    }
    Ok(answers)
}

struct Find<'a, const D: usize, A: Ask<D>> {
    name: &'a str,
    given: &'a Given,
    cell: Cell<'a, D>,
    found: Option<Result<A::Out, CrystalError>>,
}

impl<const D: usize, A: Ask<D>> Find<'_, D, A> {
    /// The atoms, as one that knows so many kinds counts them.
    fn atoms(&self, kinds: usize) -> Vec<Atom<D>> {
        let kind = |k: usize| if kinds == 1 { 0 } else { k };
        let atoms = self.cell.atoms.iter();
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

impl<const D: usize, A: Ask<D>> potential::Kinds for Find<'_, D, A> {
    fn kind<P: Described>(&mut self) {
        if P::NAME == self.name {
            let made = mixture::<P>(self.given).map_err(wrong);
            self.found = Some(made.and_then(|made| {
                let atoms = &self.atoms(made.kinds());
                A::mixture(&made, Cell { atoms, ..self.cell })
            }));
        }
    }
}

impl<const D: usize, A: Ask<D>> many_body::Kinds for Find<'_, D, A> {
    fn many_body<F: many_body::Described>(&mut self) {
        if F::NAME == self.name {
            let made = many_body::of_kinds::<F>(self.given).map_err(wrong);
            self.found = Some(made.and_then(|made| {
                if self.cell.fixed.is_some() {
                    return Err(CrystalError::FixedNeighbours);
                }
                let atoms = &self.atoms(made.table().kinds());
                A::many_body(&made, Cell { atoms, ..self.cell })
            }));
        }
    }
}
