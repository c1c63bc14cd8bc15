//! Potentials by their names, on a body.

use super::{Entry, Registry, Runs};
use crate::body::Body;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::family::links::Links;
use crate::family::stencil::Stencil;
use crate::interaction::Interaction;
use crate::interaction::atoms::bonded::PairEnergy;
use crate::interaction::atoms::breaking::{Breaking, Breaks, Held};
use crate::interaction::atoms::current::CurrentAtoms;
use crate::interaction::atoms::fixed::FixedAtoms;
use crate::interaction::atoms::many_body::ManyBodyAtoms;
use crate::interaction::atoms::sum::SumOfPotentials;
use crate::interaction::criterion::Measure;
use crate::law::descriptor::Wrong;
use crate::law::jet::Jet;
use crate::law::many_body::{self, sites::ManyBodySites};
use crate::law::potential::bulk::{Bulk, bulk};
use crate::law::potential::mixture::{Between, Given, mixture};
use crate::law::potential::{Described, Potential, Unlike, look_up};
use crate::law::terms::{self, Sites};
use crate::space::lattice::LatticeKind;
use crate::spec::{Acting, Parameters, PotentialSpec, Spec};
use std::any::Any;
use std::sync::Arc;

type Bound<const D: usize> = Result<Box<dyn Interaction<D>>, Wrong>;
type Binder<const D: usize> = fn(&Given, &Body<D>, Neighbours<D>, Simd) -> Bound<D>;
/// On families of the reference within this horizon (length).
type Holder<const D: usize> = fn(&Given, &Body<D>, f64, Simd) -> Result<Box<dyn Held<D>>, Wrong>;

/// Who feels whom.
#[derive(Clone)]
pub enum Neighbours<const D: usize> {
    /// Those of a lattice, for ever.
    Linked(Links<D>),
    /// Those within this horizon in the reference (length), for ever or until bonds break.
    Reference {
        horizon: f64,
        breaks: Option<Breaks>,
    },
    /// Those that are near now.
    Current,
}

/// What the engine does with a kind of potential.
pub(super) struct Atoms {
    pub look_up: fn(Parameters) -> Result<PotentialSpec, Wrong>,
    pub on_lattice: fn(&mut Parameters, LatticeKind, f64),
    pub unlike: Unlike,
    pub of_pairs: bool,
    pub embedded: bool,
    bulk: fn(&Given, &Stencil, f64, f64) -> Result<Option<Bulk>, Wrong>,
    closest: fn(&Given, f64, f64) -> Result<Option<f64>, Wrong>,
    reach: fn(&Given) -> Result<f64, Wrong>,
    pair: fn(&Given) -> Result<Box<PairEnergy>, Wrong>,
    sites: fn(&Given) -> Result<Box<dyn Sites>, Wrong>,
    /// [`Binder`]s and [`Holder`]s of one, two and three dimensions.
    binders: [Arc<dyn Any + Send + Sync>; 3],
    holders: [Arc<dyn Any + Send + Sync>; 3],
}

impl Atoms {
    pub fn of_many_body<F: many_body::Described>() -> Atoms {
        Atoms {
            look_up: many_body::look_up::<F>,
            on_lattice: |_, _, _| {},
            unlike: Unlike::Whole,
            of_pairs: false,
            embedded: false,
            bulk: |given, stencil, spacing, volume| {
                let many_body = many_body::of_kinds::<F>(given)?;
                Ok(Some(many_body::bulk(&many_body, stencil, spacing, volume)))
            },
            closest: |given, from, energy| {
                let many_body = many_body::of_kinds::<F>(given)?;
                Ok(closest(|r| many_body::pair(&many_body, r), from, energy))
            },
            reach: |given| Ok(many_body::of_kinds::<F>(given)?.cutoff()),
            sites: |given| Ok(Box::new(ManyBodySites(many_body::of_kinds::<F>(given)?))),
            pair: |_| Err(not_of_pairs(F::NAME)),
            binders: [
                Arc::new(flat::<1, F> as Binder<1>),
                Arc::new(flat::<2, F> as Binder<2>),
                Arc::new(bind_many_body::<F> as Binder<3>),
            ],
            holders: [
                Arc::new(()),
                Arc::new(()),
                Arc::new(hold_many_body::<F> as Holder<3>),
            ],
        }
    }

    pub fn of<P: Described>() -> Atoms {
        Atoms {
            look_up: look_up::<P>,
            on_lattice: P::on_lattice,
            unlike: P::UNLIKE,
            of_pairs: !P::Made::EMBEDDED,
            embedded: P::Made::EMBEDDED,
            bulk: |given, stencil, spacing, volume| {
                let made = mixture::<P>(given)?;
                let one = made.own(0).filter(|_| made.kinds() == 1);
                Ok(one.map(|p| bulk(p, stencil, spacing, volume)))
            },
            closest: |given, from, energy| {
                let made = mixture::<P>(given)?;
                let each = made
                    .each()
                    .filter_map(|p| closest(|r| p.pair(r * r), from, energy));
                Ok(each.reduce(f64::min))
            },
            reach: |given| Ok(mixture::<P>(given)?.reach()),
            sites: |given| Ok(Box::new(mixture::<P>(given)?)),
            pair: |given| match P::Made::EMBEDDED {
                true => Err(not_of_pairs(P::NAME)),
                false => {
                    let made = mixture::<P>(given)?;
                    Ok(Box::new(move |[i, j], q| {
                        let place = |kind| if made.kinds() == 1 { 0 } else { kind };
                        let pair = made.of(place(i), place(j));
                        let within = pair.filter(|p| q < p.cutoff() * p.cutoff())?;
                        Some(within.pair(Jet::<3>::variable(q)).derivatives())
                    }))
                }
            },
            binders: [
                Arc::new(bind::<1, P> as Binder<1>),
                Arc::new(bind::<2, P> as Binder<2>),
                Arc::new(bind::<3, P> as Binder<3>),
            ],
            holders: [
                Arc::new(hold::<1, P> as Holder<1>),
                Arc::new(hold::<2, P> as Holder<2>),
                Arc::new(hold::<3, P> as Holder<3>),
            ],
        }
    }
}

fn bind<const D: usize, P: Described>(
    given: &Given,
    body: &Body<D>,
    neighbours: Neighbours<D>,
    simd: Simd,
) -> Bound<D> {
    let potential = mixture::<P>(given)?;
    Ok(match neighbours {
        Neighbours::Linked(links) => Box::new(FixedAtoms::new(body, links, potential, simd)),
        Neighbours::Reference { horizon, breaks } => breaking(
            body,
            hold::<D, P>(given, body, horizon, simd)?,
            breaks,
            simd,
        ),
        Neighbours::Current => Box::new(CurrentAtoms::new(body, potential, simd)),
    })
}

fn hold<const D: usize, P: Described>(
    given: &Given,
    body: &Body<D>,
    horizon: f64,
    simd: Simd,
) -> Result<Box<dyn Held<D>>, Wrong> {
    let potential = mixture::<P>(given)?;
    Ok(Box::new(CurrentAtoms::of_reference(
        body, potential, horizon, simd,
    )))
}

/// A held potential, with bonds that break if any do.
fn breaking<const D: usize>(
    body: &Body<D>,
    held: Box<dyn Held<D>>,
    breaks: Option<Breaks>,
    simd: Simd,
) -> Box<dyn Interaction<D>> {
    match breaks {
        None => held,
        Some(breaks) => Box::new(Breaking::new(body, held, breaks, simd)),
    }
}

fn not_of_pairs(name: &str) -> Wrong {
    let message = format!("{name} is no sum of pairs, and molecules leave pairs out");
    (String::new(), message)
}

fn bind_many_body<F: many_body::Described>(
    given: &Given,
    body: &Body<3>,
    neighbours: Neighbours<3>,
    simd: Simd,
) -> Bound<3> {
    let many_body = many_body_of::<F>(given, body)?;
    Ok(match neighbours {
        Neighbours::Linked(_) => {
            let message = format!(
                "{} has no stencil: its terms have pairs that no bond of one atom is; write family = \"reference\"",
                F::NAME
            );
            return Err((String::new(), message));
        }
        Neighbours::Reference { horizon, breaks } => breaking(
            body,
            hold_many_body::<F>(given, body, horizon, simd)?,
            breaks,
            simd,
        ),
        Neighbours::Current => Box::new(ManyBodyAtoms::new(body, many_body, simd)),
    })
}

fn hold_many_body<F: many_body::Described>(
    given: &Given,
    body: &Body<3>,
    horizon: f64,
    simd: Simd,
) -> Result<Box<dyn Held<3>>, Wrong> {
    let many_body = many_body_of::<F>(given, body)?;
    Ok(Box::new(ManyBodyAtoms::of_reference(
        body, many_body, horizon, simd,
    )))
}

/// One that knows all kinds of the body.
fn many_body_of<F: many_body::Described>(given: &Given, body: &Body<3>) -> Result<F, Wrong> {
    let many_body = many_body::of_kinds::<F>(given)?;
    let known = many_body.table().kinds();
    let kinds = body.slots.iter().map(|s| body.material_of(*s as usize));
    let found = kinds.max().map_or(0, |k| k + 1);
    let found = body.most(found as f64) as usize;
    if found > known {
        let message = format!(
            "{} knows {known} kinds of atom, the body has {found}",
            F::NAME
        );
        return Err((String::new(), message));
    }
    Ok(many_body)
}

/// Angles between bonds need space.
fn flat<const D: usize, F: many_body::Described>(
    _: &Given,
    _: &Body<D>,
    _: Neighbours<D>,
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

/// A potential with the constants of all kinds of atoms.
#[derive(Clone)]
struct AnyPotential {
    entry: Arc<Entry>,
    given: Given,
}

/// All potentials between the atoms of a body: their energies are added.
#[derive(Clone)]
pub struct AnyPotentials {
    parts: Vec<AnyPotential>,
    /// The greatest distance at which one of them says something (length).
    pub reach: f64,
}

impl std::fmt::Debug for AnyPotentials {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let parts = self.parts.iter();
        f.debug_list()
            .entries(parts.map(|p| (&p.entry.descriptor.name, &p.given)))
            .finish()
    }
}

impl Registry {
    /// The potentials between the atoms of a spec; `None`: its materials are no atoms.
    pub fn potentials(&self, spec: &Spec) -> Result<Option<AnyPotentials>, BuildError> {
        let laws = spec.materials.iter().map(|m| m.law.potential());
        let Some(own) = laws.collect::<Option<Vec<_>>>().filter(|o| !o.is_empty()) else {
            return match spec.interactions.potentials.is_empty() {
                true => Ok(None),
                false => Err(BuildError::conflict(
                    "potentials",
                    "potentials act between atoms, and these materials are none",
                )
                .help("give the materials potentials as laws")),
            };
        };
        let mut made = AnyPotentials {
            parts: vec![],
            reach: 0.0,
        };
        if spec.interactions.potentials.is_empty() && own.iter().all(|p| *p == own[0]) {
            let given = Given::one(own[0].parameters.clone());
            made.push(self.named(own[0], 0)?, given)?;
            return Ok(Some(made));
        }
        for (entry, given) in self.sum(spec, &own)? {
            made.push(entry, given)?;
        }
        match made.parts.is_empty() {
            true => Err(BuildError::missing(
                "materials",
                "no potential acts between these atoms",
            )),
            false => Ok(Some(made)),
        }
    }

    /// Potentials of several kinds of atoms by their names, whose own are given.
    fn sum(
        &self,
        spec: &Spec,
        own: &[&PotentialSpec],
    ) -> Result<Vec<(Arc<Entry>, Given)>, BuildError> {
        let kinds = own.len();
        let mut parts: Vec<(Arc<Entry>, Given)> = vec![];
        let mut put = |entry: Arc<Entry>, [i, j]: [usize; 2], between: Between| {
            let free = |(e, given): &&mut (Arc<Entry>, Given)| {
                e.descriptor.name == entry.descriptor.name && *given.at(i, j) == Between::Nothing
            };
            match parts.iter_mut().find(free) {
                Some((_, given)) => given.set(i, j, between),
                None => {
                    let mut given = Given::nothing(kinds, spec.interactions.mixing);
                    given.set(i, j, between);
                    parts.push((entry, given));
                }
            }
        };
        for (n, potential) in own.iter().enumerate() {
            let between = Between::Given(potential.parameters.clone());
            let entry = self.named(potential, n)?;
            if potential.reach > 0.0 {
                put(entry, [n, n], between);
            }
        }
        let mut named = vec![false; kinds * kinds];
        for (n, acting) in spec.interactions.potentials.iter().enumerate() {
            let Acting::Between([i, j]) = acting.on;
            let path = || format!("potentials[{n}]");
            if i >= kinds || j >= kinds {
                let message = format!("it names material {}, there are {kinds}", i.max(j));
                return Err(BuildError::invalid(path(), message));
            }
            let entry = self.named(&acting.potential, i)?;
            if entry.atoms().is_some_and(|a| !a.of_pairs) {
                let message = format!("{} is no sum over pairs", acting.potential.name);
                return Err(BuildError::unsupported(path(), message).help(
                    "make it the law of the materials: what they have with each other follows",
                ));
            }
            let between = Between::Given(acting.potential.parameters.clone());
            if acting.potential.reach > 0.0 {
                put(entry, [i, j], between);
            }
            (named[i * kinds + j], named[j * kinds + i]) = (true, true);
        }
        for i in 0..kinds {
            for j in 0..i {
                let entry = self.named(own[i], i)?;
                let alike = own[i].name == own[j].name;
                let unlike = entry.atoms().map_or(Unlike::Given, |a| a.unlike);
                let mixed = match unlike {
                    Unlike::Whole => alike,
                    _ if named[i * kinds + j] => continue,
                    Unlike::Mixed => alike && spec.interactions.mixing.is_some(),
                    Unlike::Given => false,
                };
                if mixed {
                    put(entry, [i, j], Between::Mixed);
                } else if !named[i * kinds + j] {
                    return Err(unsaid(spec, [i, j], alike && unlike == Unlike::Mixed));
                }
            }
        }
        let embedded = |(e, _): &&(Arc<Entry>, Given)| e.atoms().is_some_and(|a| a.embedded);
        if parts.iter().filter(embedded).count() > 1 {
            return Err(BuildError::unsupported(
                "materials",
                "two embedded-atom potentials in one body: densities of one mean nothing to the other",
            )
            .help("take both elements from one file"));
        }
        Ok(parts)
    }

    /// The potentials between the atoms of a spec, whose kinds are its materials: their names, and the constants of all kinds. A sum,
    /// if there are several.
    ///
    /// # Errors
    /// Its materials are no atoms, or two of them have no potential.
    pub fn given(&self, spec: &Spec) -> Result<Vec<(String, Given)>, BuildError> {
        let mut spec = spec.clone();
        self.resolve(&mut spec)?;
        let all = self.potentials(&spec)?.ok_or_else(no_atoms)?;
        let parts = all.parts.into_iter();
        Ok(parts
            .map(|p| (p.entry.descriptor.name.to_string(), p.given))
            .collect())
    }

    /// What stands on the registry for the potential of a material.
    fn named(&self, spec: &PotentialSpec, material: usize) -> Result<Arc<Entry>, BuildError> {
        let entry = self.entry(&spec.name).filter(|e| e.atoms().is_some());
        entry.cloned().ok_or_else(|| {
            BuildError::unknown(
                format!("materials[{material}].law"),
                spec.name.clone(),
                format!("there is no potential named {}", spec.name),
            )
        })
    }

    /// A potential of one kind of atom as terms of sites ([`crate::law::terms`]).
    ///
    /// # Errors
    /// No potential of this registry has the name, or the constants do not fit it.
    pub fn sites(&self, spec: &PotentialSpec) -> Result<Box<dyn Sites>, BuildError> {
        let potential = AnyPotential {
            entry: self.named(spec, 0)?,
            given: Given::one(spec.parameters.clone()),
        };
        potential.with(|a| (a.sites)(&potential.given))
    }

    /// All potentials of a spec as terms of sites, kinds of which are its materials.
    ///
    /// # Errors
    /// Its materials are no atoms, or two of them have no potential, or constants do not fit theirs.
    pub fn sites_of(&self, spec: &Spec) -> Result<Box<dyn Sites>, BuildError> {
        let mut spec = spec.clone();
        self.resolve(&mut spec)?;
        match self.potentials(&spec)? {
            None => Err(no_atoms()),
            Some(all) => Ok(Box::new(terms::SumOfSites(all.sites()?))),
        }
    }
}

fn no_atoms() -> BuildError {
    BuildError::unsupported("materials", "these materials are no atoms")
}

/// Two materials of which nobody says what their atoms have.
fn unsaid(spec: &Spec, [i, j]: [usize; 2], mixes: bool) -> BuildError {
    let [a, b] = [i, j].map(|n| &spec.materials[n].name);
    let message = format!("no potential is given between atoms of `{b}` and of `{a}`");
    let help = match mixes {
        true => format!(
            "write [[pair]] between = [\"{b}\", \"{a}\"] with its law, or a rule: mixing = \"arithmetic\""
        ),
        false => format!(
            "write [[pair]] between = [\"{b}\", \"{a}\"] with its law; law = \"no_potential\" if they do not interact"
        ),
    };
    BuildError::missing(format!("materials[{i}].law"), message).help(help)
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
        let name = &self.entry.descriptor.name;
        let none = || (String::new(), format!("{name} is no potential"));
        let found = self.entry.atoms().ok_or_else(none).and_then(of);
        found.map_err(|(_, message)| BuildError::invalid("materials[0].law", message))
    }

    fn bind<const D: usize>(
        &self,
        body: &Body<D>,
        neighbours: Neighbours<D>,
        simd: Simd,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        self.with(|a| {
            let binder = a.binders.get(D - 1);
            match binder.and_then(|b| b.downcast_ref::<Binder<D>>()) {
                Some(binder) => binder(&self.given, body, neighbours, simd),
                None => Err((String::new(), format!("there are no {D} dimensions"))),
            }
        })
    }

    fn hold<const D: usize>(
        &self,
        body: &Body<D>,
        horizon: f64,
        simd: Simd,
    ) -> Result<Box<dyn Held<D>>, BuildError> {
        self.with(|a| {
            let holder = a.holders.get(D - 1);
            match holder.and_then(|h| h.downcast_ref::<Holder<D>>()) {
                Some(holder) => holder(&self.given, body, horizon, simd),
                None => {
                    let name = &self.entry.descriptor.name;
                    let message =
                        format!("{name} is a potential in three dimensions, the body has {D}");
                    Err((String::new(), message))
                }
            }
        })
    }
}

impl AnyPotentials {
    fn push(&mut self, entry: Arc<Entry>, given: Given) -> Result<(), BuildError> {
        let part = AnyPotential { entry, given };
        let reach = part.with(|a| (a.reach)(&part.given))?;
        self.reach = self.reach.max(reach);
        self.parts.push(part);
        Ok(())
    }

    /// An atom of a perfect crystal of one kind.
    pub fn bulk(
        &self,
        stencil: &Stencil,
        spacing: f64,
        volume: f64,
    ) -> Result<Option<Bulk>, BuildError> {
        let [part] = &self.parts[..] else {
            return Ok(None);
        };
        part.with(|a| (a.bulk)(&part.given, stencil, spacing, volume))
    }

    /// The distance at which a pair energy has reached `energy`, from `from` inwards (length), if one ever does: the shortest of all
    /// pairs of kinds.
    pub fn closest(&self, from: f64, energy: f64) -> Result<Option<f64>, BuildError> {
        let mut least: Option<f64> = None;
        for part in &self.parts {
            let found = part.with(|a| (a.closest)(&part.given, from, energy))?;
            least = least.into_iter().chain(found).reduce(f64::min);
        }
        Ok(least)
    }

    fn sites(&self) -> Result<Vec<Box<dyn Sites>>, BuildError> {
        let parts = self.parts.iter();
        parts.map(|p| p.with(|a| (a.sites)(&p.given))).collect()
    }

    /// The energy of two atoms.
    pub fn pair(&self) -> Result<Box<PairEnergy>, BuildError> {
        let each = self.parts.iter().map(|p| p.with(|a| (a.pair)(&p.given)));
        let parts = each.collect::<Result<Vec<_>, _>>()?;
        Ok(Box::new(move |kinds, q| {
            let said = parts.iter().filter_map(|p| p(kinds, q));
            said.reduce(|a, b| crate::array::from_fn(|n| a[n] + b[n]))
        }))
    }

    /// Is it one potential of pairs and densities, which stencils know?
    pub fn has_stencil(&self) -> bool {
        let [one] = &self.parts[..] else {
            return false;
        };
        one.entry.atoms().is_some_and(|a| a.of_pairs || a.embedded)
    }

    pub fn bind<const D: usize>(
        &self,
        body: &Body<D>,
        neighbours: Neighbours<D>,
        simd: Simd,
    ) -> Result<Box<dyn Interaction<D>>, BuildError> {
        if let [one] = &self.parts[..] {
            return one.bind(body, neighbours, simd);
        }
        let each = self.parts.iter();
        if let Neighbours::Reference {
            horizon,
            breaks: Some(breaks),
        } = &neighbours
            && matches!(breaks.measure, Measure::Work(_))
        {
            let parts = each.map(|p| p.hold(body, *horizon, simd));
            let parts = parts.collect::<Result<Vec<_>, _>>()?;
            let sum = SumOfPotentials::of_reference(body, parts, *horizon, simd);
            let made = Breaking::new(body, Box::new(sum), breaks.clone(), simd);
            return Ok(Box::new(made));
        }
        let parts = each.map(|p| p.bind(body, neighbours.clone(), simd));
        let parts = parts.collect::<Result<Vec<_>, _>>()?;
        Ok(Box::new(SumOfPotentials::new(body, parts)))
    }
}
