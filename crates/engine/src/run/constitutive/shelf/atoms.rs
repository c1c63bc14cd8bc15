//! Potentials by their names, on a body.

use super::{Entry, Runs, Shelf};
use crate::body::Body;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::family::links::Links;
use crate::family::stencil::Stencil;
use crate::interaction::Interaction;
use crate::interaction::atoms::bonded::PairEnergy;
use crate::interaction::atoms::current::CurrentAtoms;
use crate::interaction::atoms::fan::FanAtoms;
use crate::interaction::atoms::fixed::FixedAtoms;
use crate::law::descriptor::Wrong;
use crate::law::fan::{self, sites::FanSites};
use crate::law::jet::Jet;
use crate::law::potential::bulk::{Bulk, bulk};
use crate::law::potential::{Described, Potential, look_up, make};
use crate::law::terms::{OfSites, Sites};
use crate::space::lattice::LatticeKind;
use crate::spec::{Parameters, PotentialSpec};
use std::any::Any;
use std::sync::Arc;

type Bound<const D: usize> = Result<Box<dyn Interaction<D>>, Wrong>;
/// Fixed neighbours where there are links.
type Binder<const D: usize> = fn(&Parameters, &Body<D>, Option<Links<D>>, Simd) -> Bound<D>;

/// What the engine does with a kind of potential.
pub(super) struct Atoms {
    pub look_up: fn(Parameters) -> Result<PotentialSpec, Wrong>,
    pub on_lattice: fn(&mut Parameters, LatticeKind, f64),
    bulk: fn(&Parameters, &Stencil, f64, f64) -> Result<Bulk, Wrong>,
    closest: fn(&Parameters, f64, f64) -> Result<Option<f64>, Wrong>,
    sites: fn(&Parameters) -> Result<Box<dyn Sites>, Wrong>,
    pair: fn(&Parameters) -> Result<Box<PairEnergy>, Wrong>,
    /// [`Binder`]s of one, two and three dimensions.
    binders: [Arc<dyn Any + Send + Sync>; 3],
}

impl Atoms {
    pub fn of_fan<F: fan::Described>() -> Atoms {
        Atoms {
            look_up: fan::look_up::<F>,
            on_lattice: |_, _, _| {},
            bulk: |p, stencil, spacing, volume| {
                Ok(fan::bulk(&fan::make::<F>(p)?, stencil, spacing, volume))
            },
            closest: |p, from, energy| {
                let fan = fan::make::<F>(p)?;
                Ok(closest(|r| fan::pair(&fan, r), from, energy))
            },
            sites: |p| Ok(Box::new(FanSites(fan::make::<F>(p)?))),
            pair: |_| Err(not_of_pairs(F::NAME)),
            binders: [
                Arc::new(flat::<1, F> as Binder<1>),
                Arc::new(flat::<2, F> as Binder<2>),
                Arc::new(bind_fan::<F> as Binder<3>),
            ],
        }
    }

    pub fn of<P: Described>() -> Atoms {
        Atoms {
            look_up: look_up::<P>,
            on_lattice: P::on_lattice,
            bulk: |p, stencil, spacing, volume| Ok(bulk(&make::<P>(p)?, stencil, spacing, volume)),
            closest: |p, from, energy| {
                let potential = make::<P>(p)?;
                Ok(closest(|r| potential.pair(r * r), from, energy))
            },
            sites: |p| Ok(Box::new(OfSites(make::<P>(p)?))),
            pair: |p| match P::Made::EMBEDDED {
                true => Err(not_of_pairs(P::NAME)),
                false => {
                    let potential = make::<P>(p)?;
                    Ok(Box::new(move |q| {
                        potential.pair(Jet::<3>::variable(q)).derivatives()
                    }))
                }
            },
            binders: [
                Arc::new(bind::<1, P> as Binder<1>),
                Arc::new(bind::<2, P> as Binder<2>),
                Arc::new(bind::<3, P> as Binder<3>),
            ],
        }
    }
}

fn bind<const D: usize, P: Described>(
    parameters: &Parameters,
    body: &Body<D>,
    links: Option<Links<D>>,
    simd: Simd,
) -> Bound<D> {
    let potential = make::<P>(parameters)?;
    Ok(match links {
        Some(links) => Box::new(FixedAtoms::new(body, links, potential, simd)),
        None => Box::new(CurrentAtoms::new(body, potential, simd)),
    })
}

fn not_of_pairs(name: &str) -> Wrong {
    let message = format!("{name} is no sum of pairs, and molecules leave pairs out");
    (String::new(), message)
}

fn bind_fan<F: fan::Described>(
    parameters: &Parameters,
    body: &Body<3>,
    links: Option<Links<3>>,
    simd: Simd,
) -> Bound<3> {
    let fan = fan::make::<F>(parameters)?;
    if links.is_some() {
        let message = format!(
            "{} lives on current neighbours: remove family = \"stencil\"",
            F::NAME
        );
        return Err((String::new(), message));
    }
    let known = fan.table().kinds();
    let kinds = body.slots.iter().map(|s| body.material_of(*s as usize));
    let found = kinds.max().map_or(0, |k| k + 1);
    if found > known {
        let message = format!(
            "{} knows {known} kinds of atom, the body has {found}",
            F::NAME
        );
        return Err((String::new(), message));
    }
    Ok(Box::new(FanAtoms::new(body, fan, simd)))
}

/// Angles between bonds need space.
fn flat<const D: usize, F: fan::Described>(
    _: &Parameters,
    _: &Body<D>,
    _: Option<Links<D>>,
    _: Simd,
) -> Bound<D> {
    let message = format!(
        "{} is a potential in three dimensions, the body has {D}",
        F::NAME
    );
    Err((String::new(), message))
}

/// The distance at which the pair energy has reached `energy`, from `from` inwards (length), if it ever does.
fn closest(pair: impl Fn(f64) -> f64, from: f64, energy: f64) -> Option<f64> {
    let steps = (0..300).map(|n| from * 0.99f64.powi(n));
    steps
        .map(|r| (r, pair(r)))
        .take_while(|(_, e)| e.is_finite())
        .find(|(_, e)| *e >= energy)
        .map(|(r, _)| r)
}

/// A potential with its constants.
#[derive(Clone)]
pub(crate) struct AnyPotential {
    entry: Arc<Entry>,
    pub spec: PotentialSpec,
}

impl std::fmt::Debug for AnyPotential {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.spec.fmt(f)
    }
}

impl Shelf {
    /// The potential that a spec names.
    pub(crate) fn potential(&self, spec: &PotentialSpec) -> Result<AnyPotential, BuildError> {
        let entry = self.entry(&spec.name).filter(|e| e.atoms().is_some());
        match entry {
            Some(entry) => Ok(AnyPotential {
                entry: entry.clone(),
                spec: spec.clone(),
            }),
            None => Err(BuildError::unknown(
                "materials[0].law",
                spec.name.clone(),
                format!("there is no potential named {}", spec.name),
            )),
        }
    }
}

impl Shelf {
    /// A potential as terms of sites ([`crate::law::terms`]).
    ///
    /// # Errors
    /// No potential of this shelf has the name, or the constants do not fit it.
    pub fn sites(&self, spec: &PotentialSpec) -> Result<Box<dyn Sites>, BuildError> {
        let potential = self.potential(spec)?;
        potential.with(|a| (a.sites)(&potential.spec.parameters))
    }
}

impl Entry {
    pub(super) fn atoms(&self) -> Option<&Atoms> {
        match &self.runs {
            Runs::Atoms(atoms) => Some(atoms),
            Runs::Linear { .. } | Runs::Material(_) => None,
        }
    }
}

impl AnyPotential {
    fn with<T>(&self, of: impl FnOnce(&Atoms) -> Result<T, Wrong>) -> Result<T, BuildError> {
        let none = || (String::new(), format!("{} is no potential", self.spec.name));
        let found = self.entry.atoms().ok_or_else(none).and_then(of);
        found.map_err(|(_, message)| BuildError::invalid("materials[0].law", message))
    }

    /// An atom of a perfect crystal.
    pub fn bulk(&self, stencil: &Stencil, spacing: f64, volume: f64) -> Result<Bulk, BuildError> {
        self.with(|a| (a.bulk)(&self.spec.parameters, stencil, spacing, volume))
    }

    /// The distance at which the pair energy has reached `energy`, from `from` inwards (length), if it ever does.
    pub fn closest(&self, from: f64, energy: f64) -> Result<Option<f64>, BuildError> {
        self.with(|a| (a.closest)(&self.spec.parameters, from, energy))
    }

    /// The energy of two atoms.
    pub fn pair(&self) -> Result<Box<PairEnergy>, BuildError> {
        self.with(|a| (a.pair)(&self.spec.parameters))
    }

    /// On fixed neighbours where there are links, else on current ones.
    pub fn bind<const D: usize>(
        &self,
        body: &Body<D>,
        links: Option<Links<D>>,
        simd: Simd,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        self.with(|a| {
            let binder = a.binders.get(D - 1);
            match binder.and_then(|b| b.downcast_ref::<Binder<D>>()) {
                Some(binder) => binder(&self.spec.parameters, body, links, simd),
                None => Err((String::new(), format!("there are no {D} dimensions"))),
            }
        })
    }
}
