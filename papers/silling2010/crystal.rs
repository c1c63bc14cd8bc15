//! Crystals of decks: linear bodies about the state in which their atoms rest.

use peridyne::law::potential::{Potential, Visitor};
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{BodySpec, LinearBody, Stepper};
use peridyne_io::deck::Deck;
use peridyne_theory::coarsen::Selection;
use peridyne_theory::crystal::Reach;
use peridyne_theory::crystal::potential::equilibrium;

use super::compare::failed;
use crate::Failure;

/// Residual forces over those at the lattice sites.
const RELAXED: f64 = 1e-10;

pub fn deck(text: &str, set: &[(&str, String)]) -> Result<Deck, Failure> {
    let set: Vec<_> = (set.iter())
        .map(|(key, value)| (key.to_string(), value.clone()))
        .collect();
    Deck::parse(text, "crystal.toml", &set).map_err(failed)
}

/// A crystal of a deck.
pub struct Crystal<const D: usize> {
    /// About the relaxed state, atoms where they are then.
    pub body: LinearBody<D>,
    /// `[N]` lattice sites (length).
    pub sites: Vec<[f64; D]>,
    /// Cell edge (length).
    pub spacing: f64,
    /// Largest displacement of the relaxation (spacings).
    pub moved: f64,
    /// Atoms of the deck's sets `left` and `right`.
    pub ends: [Vec<u32>; 2],
}

impl<const D: usize> Crystal<D> {
    pub fn of(deck: &Deck) -> Result<Self, Failure> {
        let mut spec = deck.spec.clone();
        spec.loading.conditions.clear();
        spec.run.schedule.stepper = Stepper::Verlet;
        let options = Options {
            trust_time_step: true,
            ..Options::default()
        };
        let mut sim = build(&spec, options).map_err(failed)?;
        sim.relax(RELAXED).map_err(failed)?;
        let body = sim.linear_body().of::<D>();
        let mut body =
            body.ok_or_else(|| Failure::new(format!("the deck is not {D}-dimensional")))?;
        let sites = body.position.clone();
        let spacing =
            (spec.body.spacing()).ok_or_else(|| Failure::new("the deck has no lattice"))?;
        let mut far = 0.0f64;
        for (x, u) in body.position.iter_mut().zip(sim.displacements()) {
            far = far.max(u.iter().map(|c| c * c).sum());
            for a in 0..D {
                x[a] += u[a];
            }
        }
        let end = |name| {
            sim.members(name)
                .ok_or_else(|| Failure::new(format!("the deck has no set `{name}`")))
        };
        Ok(Crystal {
            body,
            sites,
            spacing,
            moved: far.sqrt() / spacing,
            ends: [end("left")?, end("right")?],
        })
    }

    /// Of some atoms those on the lattice of twice their spacing, by places in the list.
    pub fn half(&self, atoms: &[usize]) -> Result<Vec<u32>, Failure> {
        let body = LinearBody {
            position: atoms.iter().map(|k| self.sites[*k]).collect(),
            ..LinearBody::nothing()
        };
        let selection = Selection::Sublattice {
            every: 2,
            through: 0,
        };
        selection.choose(&body).map_err(failed)
    }

    /// The site of an atom, as whole numbers.
    pub fn key(&self, atom: usize) -> [i64; D] {
        self.sites[atom].map(|x| (x / (0.01 * self.spacing)).round() as i64)
    }
}

/// The spacing at which the lattice of a deck has no pressure, sought within 10 % of the deck's.
pub fn spacing_without_pressure<const D: usize>(deck: &Deck) -> Result<(f64, f64), Failure> {
    struct Spacing<const D: usize>(LatticeKind, f64);
    impl<const D: usize> Visitor for Spacing<D> {
        type Out = Option<f64>;
        fn visit<P: Potential>(self, potential: P) -> Option<f64> {
            let range = [0.9 * self.1, 1.1 * self.1];
            equilibrium::<D>(&potential, self.0, Reach::Cutoff, range)
        }
    }
    let BodySpec::Lattice { kind, spacing, .. } = &deck.spec.body else {
        return Err(Failure::new("the deck has no lattice"));
    };
    let found = deck
        .spec
        .potential()
        .and_then(|p| p.apply(Spacing::<D>(*kind, *spacing)).ok().flatten());
    let found = found.ok_or_else(|| Failure::new("no spacing without pressure"))?;
    Ok((*spacing, found))
}
