//! The shelf: laws by their names, each a file of its own and a line here. A program may put its own beside them.

use crate::body::{Body, Layout};
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::family::horizon::HorizonList;
use crate::family::stencil::Stencil;
use crate::interaction::material::{
    CloudFamily, LatticeFamily, MaterialInteraction, MaterialParts,
};
use crate::interaction::weight::BondWeight;
use crate::interaction::{Interaction, Repulsion, Toughness};
use crate::law::descriptor::{Descriptor, Given, Memory, Shelved};
use crate::law::material::correspondence::Correspondence;
use crate::law::material::elastic_plastic::ElasticPlastic;
use crate::law::material::softening::Softening;
use crate::law::material::viscoelastic::Viscoelastic;
use crate::law::material::{Material, Numbers};
use crate::law::micromodulus::{Moments, micromodulus};
use crate::law::solid::eam_like::Solid;
use crate::spec::{Calibration, LawSpec, NamedLaw, Parameters, Plane, Spec};
use std::any::Any;
use std::sync::Arc;

/// Where a law is put on a body.
pub(crate) struct Place<'a, const D: usize> {
    pub body: &'a Body<D>,
    pub stencil: Option<&'a Stencil>,
    /// Length up to which pairs of a cloud are bonds.
    pub horizon: f64,
    pub weight: BondWeight,
    pub toughness: Vec<Toughness>,
    pub repulsion: Option<Repulsion>,
    pub simd: Simd,
    /// Everything is of this material.
    pub only: Option<usize>,
}

type Bound<const D: usize> = Result<Box<dyn Interaction<D>>, BuildError>;
type Binder<const D: usize> = fn(&Chosen, Place<D>) -> Bound<D>;

/// A law on the shelf.
#[derive(Clone)]
struct Entry {
    descriptor: Descriptor,
    linear: fn(&Parameters) -> Result<LawSpec, String>,
    brittle_energy: fn(&Parameters, f64) -> f64,
    /// [`Binder`]s of one, two and three dimensions.
    binders: [Arc<dyn Any + Send + Sync>; 3],
}

/// Laws that a spec can name.
#[derive(Clone)]
pub struct Shelf {
    entries: Vec<Arc<Entry>>,
}

impl Default for Shelf {
    fn default() -> Shelf {
        Shelf::standard()
    }
}

impl Shelf {
    /// The laws that come with the engine.
    pub fn standard() -> Shelf {
        Shelf { entries: vec![] }
            .with_solid::<ElasticPlastic>()
            .with::<Viscoelastic>()
            .with_solid::<Correspondence>()
            .with::<Softening>()
    }

    /// And one more; it takes the place of one of the same name.
    pub fn with<M>(self) -> Shelf
    where
        M: Shelved + Material<1> + Material<2> + Material<3>,
    {
        let line: Arc<dyn Any + Send + Sync> = Arc::new(bind::<1, M> as Binder<1>);
        self.put::<M>(line)
    }

    /// The same of a law that means nothing on a line.
    pub fn with_solid<M>(self) -> Shelf
    where
        M: Shelved + Material<2> + Material<3>,
    {
        self.put::<M>(Arc::new(()))
    }

    fn put<M>(mut self, line: Arc<dyn Any + Send + Sync>) -> Shelf
    where
        M: Shelved + Material<2> + Material<3>,
    {
        let descriptor = M::descriptor();
        self.entries
            .retain(|e| e.descriptor.name != descriptor.name);
        self.entries.push(Arc::new(Entry {
            descriptor,
            linear: M::linear,
            brittle_energy: M::brittle_energy,
            binders: [
                line,
                Arc::new(bind::<2, M> as Binder<2>),
                Arc::new(bind::<3, M> as Binder<3>),
            ],
        }));
        self
    }

    pub fn descriptors(&self) -> impl Iterator<Item = &Descriptor> {
        self.entries.iter().map(|e| &e.descriptor)
    }

    /// What a law says of itself.
    pub fn descriptor(&self, name: &str) -> Option<&Descriptor> {
        self.entry(name).map(|e| &e.descriptor)
    }

    fn entry(&self, name: &str) -> Option<&Arc<Entry>> {
        self.entries.iter().find(|e| e.descriptor.name == name)
    }

    /// Look up the laws that materials name: their parameters with defaults, and the linear laws of the same elasticity.
    ///
    /// # Errors
    /// No such law, or parameters that do not fit it.
    pub fn resolve(&self, spec: &mut Spec) -> Result<(), BuildError> {
        for (n, m) in spec.materials.iter_mut().enumerate() {
            self.look_up(&mut m.law)
                .map_err(|e| e.at(format!("materials[{n}].law")))?;
        }
        Ok(())
    }

    /// Look up the law of one material; laws that need none are left alone.
    ///
    /// # Errors
    /// As of [`Shelf::resolve`].
    pub fn look_up(&self, law: &mut LawSpec) -> Result<(), BuildError> {
        let LawSpec::Named(law) = law else {
            return Ok(());
        };
        let Some(entry) = self.entry(&law.name) else {
            let known: Vec<&str> = self.descriptors().map(|d| d.name.as_ref()).collect();
            let message = format!(
                "there is no law named {}; the shelf has {}",
                law.name,
                known.join(", ")
            );
            return Err(BuildError::unknown("law", law.name.clone(), message));
        };
        let invalid = |message: String| BuildError::invalid("law", message);
        let checked = entry.descriptor.check(&mut law.parameters);
        checked.map_err(|(_, message)| invalid(message))?;
        let linear = (entry.linear)(&law.parameters).map_err(invalid)?;
        law.linear = Some(Box::new(linear));
        Ok(())
    }

    /// The fracture energy of a brittle bond with the critical stretch of this law's (see [`Shelved::brittle_energy`]).
    pub(crate) fn brittle_energy(&self, law: &LawSpec, energy: f64) -> f64 {
        match law {
            LawSpec::Named(law) => match self.entry(&law.name) {
                Some(entry) => (entry.brittle_energy)(&law.parameters, energy),
                None => energy,
            },
            _ => energy,
        }
    }
}

/// The law that the materials of a body have.
#[derive(Clone)]
pub(crate) struct Chosen {
    entry: Arc<Entry>,
    materials: Vec<Made>,
    plane: Plane,
    /// Of the full ball, where constants are those of the continuum.
    weighted_volume: Option<f64>,
}

#[derive(Clone)]
struct Made {
    parameters: Parameters,
    solid: Option<Solid>,
    micromodulus: Option<f64>,
    critical_stretch: f64,
}

/// The law of the shelf that a body's materials name; `None`: they name none.
///
/// # Errors
/// They name different ones.
pub(super) fn chosen<const D: usize>(
    spec: &Spec,
    shelf: &Shelf,
    moments: Moments,
    toughness: &[Toughness],
) -> Result<Option<Chosen>, BuildError> {
    let named = |law: &LawSpec| match law {
        LawSpec::Named(law) => Some(law.clone()),
        _ => None,
    };
    let laws: Vec<Option<NamedLaw>> = spec.materials.iter().map(|m| named(&m.law)).collect();
    let Some(first) = laws.iter().flatten().next() else {
        return Ok(None);
    };
    let mut materials = vec![];
    for (n, law) in laws.iter().enumerate() {
        let Some(law) = law.as_ref().filter(|l| l.name == first.name) else {
            return Err(BuildError::unsupported(
                format!("materials[{n}].law"),
                "different kinds of law in one body, such as bond-based and state-based",
            )
            .help("give all materials the same kind of law: bonds across need one"));
        };
        let of = &spec.materials[n].law;
        materials.push(Made {
            parameters: law.parameters.clone(),
            solid: Solid::of_law(D, spec.plane, of.linear()),
            micromodulus: match of.linear() {
                LawSpec::Pmb(stiffness) => Some(micromodulus(D, spec.plane, *stiffness, moments)),
                _ => None,
            },
            critical_stretch: toughness[n].s00,
        });
    }
    let Some(entry) = shelf.entry(&first.name) else {
        return Err(BuildError::unknown(
            "materials[0].law",
            first.name.clone(),
            format!("the law {} is on no shelf", first.name),
        ));
    };
    let chosen = Chosen {
        entry: entry.clone(),
        materials,
        plane: spec.plane,
        weighted_volume: match spec.calibration {
            Calibration::Continuum => Some(moments.second),
            Calibration::Discrete => None,
        },
    };
    Ok(Some(chosen))
}

impl Chosen {
    /// What the law remembers, and its name.
    pub fn memory(&self) -> (Memory, &str) {
        let of = &self.entry.descriptor;
        (of.memory, &of.name)
    }

    /// The law on a body.
    pub fn bind<const D: usize>(&self, place: Place<D>) -> Bound<D> {
        let binder = self.entry.binders.get(D - 1);
        match binder.and_then(|b| b.downcast_ref::<Binder<D>>()) {
            Some(binder) => binder(self, place),
            None => Err(BuildError::unsupported(
                "materials[0].law",
                format!(
                    "the law {} is for two and three dimensions, this body has {D}",
                    self.entry.descriptor.name
                ),
            )
            .help("on a line take pmb, lps or viscoelastic")),
        }
    }
}

fn bind<const D: usize, M: Shelved + Material<D>>(chosen: &Chosen, place: Place<D>) -> Bound<D> {
    let picked = |n: &usize| place.only.is_none_or(|o| o == *n);
    let numbers: Vec<usize> = (0..chosen.materials.len()).filter(picked).collect();
    let given: Vec<Given> = numbers
        .iter()
        .map(|n| {
            let made = &chosen.materials[*n];
            Given {
                parameters: &made.parameters,
                solid: made.solid,
                micromodulus: made.micromodulus,
                critical_stretch: made.critical_stretch,
                weighted_volume: chosen.weighted_volume,
            }
        })
        .collect();
    let law = M::make(D, chosen.plane, &given).map_err(|(n, message)| {
        let n = numbers.get(n).copied().unwrap_or(0);
        BuildError::invalid(format!("materials[{n}].law"), message)
    })?;
    let Place {
        body,
        stencil,
        horizon,
        weight,
        toughness,
        repulsion,
        simd,
        ..
    } = place;
    match (&body.layout, stencil) {
        (Layout::Grid(grid), Some(stencil)) => {
            let of = |r: f64| [weight.influence(r, 1.0 / r), weight.volume_fraction(r)];
            Ok(Box::new(MaterialInteraction::new(MaterialParts {
                body,
                family: LatticeFamily::new(body, grid, stencil, &of),
                law,
                kind: "stencil",
                near_horizon: 0,
                toughness,
                repulsion,
                simd,
            })))
        }
        _ => {
            let list = HorizonList::new(body, horizon)?;
            let remembers = <M::Memory<f64> as Numbers<f64>>::COUNT > 0;
            let near_horizon = list.near_horizon;
            Ok(Box::new(MaterialInteraction::new(MaterialParts {
                body,
                family: CloudFamily::new(body, list, weight, remembers),
                law,
                kind: "list",
                near_horizon,
                toughness,
                repulsion,
                simd,
            })))
        }
    }
}
