//! Laws of `law/material` on a body.

use super::{Entry, Registry, Runs};
use crate::body::{Body, Layout};
use crate::constitutive::sweeps::general;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::family::horizon::HorizonList;
use crate::family::stencil::Stencil;
use crate::interaction::bonds::breaking::PLASTIC_STRAIN;
use crate::interaction::bonds::law::LawProperties;
use crate::interaction::bonds::state::BondParts;
use crate::interaction::bonds::{CloudFamily, LatticeFamily};
use crate::interaction::criterion::{Criteria, Measure};
use crate::interaction::material::{AnyLaw, MaterialInteraction, compiled};
use crate::interaction::weight::BondWeight;
use crate::interaction::{Interaction, Repulsion, Toughness};
use crate::law::descriptor::{Given, Key, Memory, Registered, Value};
use crate::law::material::{Material, Partner};
use crate::law::micromodulus::{Moments, micromodulus};
use crate::law::solid::eam_like::Solid;
use crate::message;
use crate::quantity::{self, Dimension};
use crate::spec::{
    BondMixing, Calibration, LawSpec, Parameter, Parameters, Plane, PmbStiffness, Spec,
};
use std::any::Any;
use std::sync::Arc;

/// Where a law is put on a body.
pub struct Place<'a, const D: usize> {
    pub body: &'a Body<D>,
    pub stencil: Option<&'a Stencil>,
    /// Length up to which pairs of a cloud are bonds.
    pub horizon: f64,
    /// Which of them; `None`: all.
    pub list: Option<HorizonList>,
    pub weight: BondWeight,
    pub toughness: Vec<Toughness>,
    pub criteria: Criteria,
    pub repulsion: Option<Repulsion>,
    pub simd: Simd,
    /// Everything is of this material.
    pub only: Option<usize>,
}

type Bound<const D: usize> = Result<Box<dyn Interaction<D>>, BuildError>;
type Binder<const D: usize> = fn(&Chosen, Place<D>) -> Bound<D>;

/// How a law of `law/material` is made and put on bodies.
pub(super) struct Materials {
    pub linear: fn(&Parameters) -> Result<LawSpec, String>,
    pub brittle_energy: fn(&Parameters, f64) -> f64,
    /// [`Registered::ISOTROPIC`]
    pub isotropic: bool,
    /// [`Registered::OWN_CRITICAL_STRETCH`]
    pub own_critical_stretch: bool,
    /// [`Registered::SOFTENS_TO_ZERO`]
    pub softens_to_zero: bool,
    /// [`Registered::TANGENTIAL_STIFFNESS`]
    pub tangential_stiffness: bool,
    /// [`Registered::BOND_CLASSES`]
    pub bond_classes: bool,
    /// [`Registered::PULLS_AT_REST`]
    pub pulls: bool,
    /// [`Material::ACROSS`]
    pub across: bool,
    stiffness: fn(&Parameters) -> Stiffness,
    binders: Binders,
    /// Another law, and whether it fits the parameters of a material.
    other: Option<(
        fn(&Parameters) -> bool,
        fn(&Parameters) -> Stiffness,
        Binders,
    )>,
}

/// What makes the stiffness of a law, which horizons of points change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stiffness {
    /// [`Material::OF_FAMILY`]
    Family,
    /// [`Material::OF_BONDS`]
    Bonds,
    /// Computed for one horizon, and why.
    Horizon(&'static str),
}

impl Stiffness {
    fn of<M: Registered + Material<2>>(parameters: &Parameters) -> Stiffness {
        match (M::of_one_horizon(parameters), M::OF_FAMILY, M::OF_BONDS) {
            (Some(why), ..) => Stiffness::Horizon(why),
            (None, true, _) => Stiffness::Family,
            (None, false, true) => Stiffness::Bonds,
            (None, false, false) => {
                Stiffness::Horizon("the stiffness of this law is computed for one horizon")
            }
        }
    }
}

/// [`Binder`]s of one, two and three dimensions.
type Binders = [Arc<dyn Any + Send + Sync>; 3];

impl Materials {
    pub fn of<M>() -> Materials
    where
        M: Registered + Material<1> + Material<2> + Material<3>,
    {
        let line = Arc::new(bind::<1, M> as Binder<1>);
        Materials::with::<M>(line)
    }

    /// The same with another where that fits.
    pub fn or(self, fits: fn(&Parameters) -> bool, other: Materials) -> Materials {
        let other = Some((fits, other.stiffness, other.binders));
        Materials { other, ..self }
    }

    /// What makes the stiffness of a material of these parameters.
    pub fn stiffness(&self, parameters: &Parameters) -> Stiffness {
        match self.other {
            Some((fits, other, _)) if fits(parameters) => other(parameters),
            Some(_) | None => (self.stiffness)(parameters),
        }
    }

    /// Of a law that means nothing on a line.
    pub fn of_solid<M>() -> Materials
    where
        M: Registered + Material<2> + Material<3>,
    {
        Materials::with::<M>(Arc::new(()))
    }

    fn with<M>(line: Arc<dyn Any + Send + Sync>) -> Materials
    where
        M: Registered + Material<2> + Material<3>,
    {
        Materials {
            linear: M::linear,
            brittle_energy: M::brittle_energy,
            isotropic: M::ISOTROPIC,
            own_critical_stretch: M::OWN_CRITICAL_STRETCH,
            softens_to_zero: M::SOFTENS_TO_ZERO,
            tangential_stiffness: M::TANGENTIAL_STIFFNESS,
            bond_classes: M::BOND_CLASSES,
            pulls: M::PULLS_AT_REST,
            across: <M as Material<2>>::ACROSS,
            stiffness: Stiffness::of::<M>,
            binders: [
                line,
                Arc::new(bind::<2, M> as Binder<2>),
                Arc::new(bind::<3, M> as Binder<3>),
            ],
            other: None,
        }
    }
}

/// The law that the materials of a body have.
#[derive(Clone)]
pub struct Chosen {
    entry: Arc<Entry>,
    materials: Vec<Made>,
    plane: Plane,
    rule: BondMixing,
    /// Of the full ball, where constants are those of the continuum.
    weighted_volume: Option<f64>,
    first_moment: f64,
    horizon: f64,
    family: Arc<[Partner<3>]>,
}

/// What the law of a material says of temperatures.
#[derive(Debug, Clone, Copy, Default)]
pub struct Softens {
    /// T_r.
    pub reference: Option<f64>,
    /// c, by which plastic work heats.
    pub capacity: Option<f64>,
    /// Is there an equation of state?
    pub pressed: bool,
}

#[derive(Clone)]
struct Made {
    parameters: Parameters,
    solid: Option<Solid>,
    micromodulus: Option<f64>,
    critical_stretch: f64,
    breaks: bool,
    density: f64,
    /// In plane strain ν and 2G of the linear solid, if it is isotropic.
    held: Option<[f64; 2]>,
}

/// ν and 2G in plane strain, of the solid that answers in the plane as this one does.
fn held(d: usize, solid: Option<Solid>, young: Option<f64>) -> Option<[f64; 2]> {
    match (solid, young) {
        (Some(s), _) => {
            let n = d as f64;
            let shear = s.beta / (n * (n + 2.0));
            let lame = s.kappa * (s.n / n).powi(2) + shear;
            Some([lame / (2.0 * (lame + shear)), 2.0 * shear])
        }
        // bonds have ν = ¼
        (None, Some(young)) => Some([0.25, young / 1.25]),
        (None, None) => None,
    }
}

/// The law of the registry that sweeps for all materials of a body; `None`: there is none.
///
/// # Errors
/// They have different ones.
pub(in crate::constitutive) fn chosen<const D: usize>(
    spec: &Spec,
    registry: &Registry,
    (horizon, moments, family): (f64, Moments, Vec<Partner<3>>),
    toughness: &[Toughness],
) -> Result<Option<Chosen>, BuildError> {
    let laws = || spec.materials.iter().map(|m| &m.law);
    let named = |law: &&LawSpec| matches!(law, LawSpec::Named(_));
    let Some(first) = laws().find(named).or(laws().next()).and_then(general) else {
        return Ok(None);
    };
    let mut materials = vec![];
    for (n, of) in laws().enumerate() {
        let written = registry.written(of).filter(|_| general(of) == Some(first));
        let Some((_, parameters)) = written else {
            return Err(BuildError::unsupported(
                format!("materials[{n}].law"),
                "different kinds of law in one body, such as bond-based and state-based",
            )
            .help("give all materials the same kind of law: bonds across need one"));
        };
        let solid = Solid::of_law(D, spec.space.plane, of.linear());
        let modulus = |stiffness| micromodulus(D, spec.space.plane, stiffness, moments);
        let micromodulus = match of.linear() {
            LawSpec::Pmb(stiffness) => Some(modulus(*stiffness)),
            _ => None,
        };
        let young = micromodulus.map(|c| c / modulus(PmbStiffness::Young(1.0)));
        materials.push(Made {
            parameters,
            held: match of {
                LawSpec::Named(law) if !law.isotropic => None,
                _ => held(D, solid, young),
            },
            solid,
            micromodulus,
            critical_stretch: toughness[n].s00,
            breaks: spec.materials[n].fracture.is_some(),
            density: spec.materials[n].density,
        });
    }
    let Some(entry) = registry.entry(first) else {
        return Err(BuildError::unknown(
            "materials[0].law",
            first,
            format!("the law {first} is not in the registry"),
        ));
    };
    let chosen = Chosen {
        entry: entry.clone(),
        materials,
        plane: spec.space.plane,
        rule: spec.interactions.interface,
        weighted_volume: match spec.bonds.calibration {
            // points with horizons of their own have balls of their own
            Calibration::Continuum if spec.bonds.variable_horizon.is_none() => Some(moments.second),
            Calibration::Continuum | Calibration::Discrete => None,
        },
        first_moment: moments.first,
        horizon,
        family: family.into(),
    };
    Ok(Some(chosen))
}

impl Chosen {
    /// What the law remembers, and its name. One whose materials were given a rate of reference answers to rates.
    pub fn memory(&self) -> (Memory, &str) {
        let of = &self.entry.descriptor;
        let is_rate =
            |k: &&Key| matches!(k.value, Value::Number(d, _) if d == Dimension::FREQUENCY);
        let given = |k: &Key| {
            let mut each = self.materials.iter();
            each.any(|m| m.parameters.number(k.name).is_some())
        };
        match of.memory {
            Memory::Path if of.keys.iter().filter(is_rate).any(given) => (Memory::Time, &of.name),
            memory => (memory, &of.name),
        }
    }

    /// Do its bonds soften to nothing, and pull along a line to where they began when they are let back?
    pub fn fades(&self) -> bool {
        matches!(&self.entry.runs, Runs::Material(material) if material.softens_to_zero)
    }

    /// May its bonds pull in the reference?
    pub fn pulls(&self) -> bool {
        matches!(&self.entry.runs, Runs::Material(material) if material.pulls)
    }

    /// What its materials soften by.
    pub fn softens(&self) -> Vec<Softens> {
        let of = |m: &Made| Softens {
            reference: m.parameters.number("reference_temperature"),
            capacity: m.parameters.number("heat_capacity"),
            pressed: { m.parameters.word("equation_of_state") }.is_some_and(|w| w != "elastic"),
        };
        self.materials.iter().map(of).collect()
    }

    /// Are constants of any of its materials those of a place?
    pub fn varies(&self) -> bool {
        let of_place = |p: &(String, Parameter)| matches!(p.1, Parameter::Direction(_));
        let mut each = self.materials.iter().flat_map(|m| &m.parameters.0);
        each.any(of_place)
    }

    /// The law on a body.
    pub fn bind<const D: usize>(&self, place: Place<D>) -> Bound<D> {
        let binder = match &self.entry.runs {
            Runs::Material(m) => {
                let all = |fits: fn(&Parameters) -> bool| {
                    self.materials.iter().all(|made| fits(&made.parameters))
                };
                let binders = match &m.other {
                    Some((fits, _, other)) if all(*fits) => other,
                    Some(_) | None => &m.binders,
                };
                binders.get(D - 1)
            }
            Runs::Linear { .. } | Runs::Atoms(_) => None,
        };
        match binder.and_then(|b| b.downcast_ref::<Binder<D>>()) {
            Some(binder) => binder(self, place),
            None => Err(BuildError::unsupported(
                "materials[0].law",
                format!(
                    "the law {} is for two and three dimensions, this body has {D}",
                    self.entry.descriptor.name
                ),
            )
            .help("on a line take a law such as pmb or lps")),
        }
    }
}

fn bind<const D: usize, M: Registered + Material<D>>(chosen: &Chosen, place: Place<D>) -> Bound<D> {
    let numbers = chosen.numbers(place.only);
    let law = M::make(D, chosen.plane, &chosen.given(&numbers)).map_err(|(n, message)| {
        let n = numbers.get(n).copied().unwrap_or(0);
        BuildError::invalid(format!("materials[{n}].law"), message)
    })?;
    chosen.put(&numbers, place, compiled(law.meeting(chosen.rule)))
}

impl Chosen {
    /// The materials that are meant.
    fn numbers(&self, only: Option<usize>) -> Vec<usize> {
        let picked = |n: &usize| only.is_none_or(|o| o == *n);
        (0..self.materials.len()).filter(picked).collect()
    }

    fn given(&self, numbers: &[usize]) -> Vec<Given<'_>> {
        let given = |n: &usize| {
            let made = &self.materials[*n];
            Given {
                parameters: &made.parameters,
                solid: made.solid,
                micromodulus: made.micromodulus,
                critical_stretch: made.critical_stretch,
                breaks: made.breaks,
                density: made.density,
                weighted_volume: self.weighted_volume,
                first_moment: self.first_moment,
                horizon: self.horizon,
                family: &self.family,
            }
        };
        numbers.iter().map(given).collect()
    }

    /// The law of these materials on the family of a body.
    fn put<const D: usize>(
        &self,
        numbers: &[usize],
        place: Place<D>,
        law: Arc<dyn AnyLaw<D>>,
    ) -> Bound<D> {
        let of = law.clone().properties();
        let Place {
            body,
            stencil,
            horizon,
            list,
            weight,
            toughness,
            criteria,
            repulsion,
            simd,
            ..
        } = place;
        // a bond that is not of its family's sums has one stiffness
        let weight = match law.of_family() {
            true => weight,
            false => weight.mean(),
        };
        able(&of, &criteria)?;
        let held = match D == 2 && self.plane == Plane::Strain {
            true => numbers.iter().map(|n| self.materials[*n].held).collect(),
            false => vec![],
        };
        let unfit = |wrong: Option<(usize, String)>| {
            let Some((slot, why)) = wrong else {
                return BuildError::elsewhere(0);
            };
            let n = match numbers[..] {
                [one] => one,
                _ => body.material_of(slot),
            };
            let place = quantity::place(&body.position(slot)[..D]);
            let message = message!["at ", place, ": ", why];
            BuildError::invalid(format!("materials[{n}].law"), message).help(
            "give this place another direction (`a ? b : c` chooses), another material, or leave it out of the body",
        )
        };
        match (&body.layout, stencil) {
            (Layout::Grid(grid), Some(stencil)) => {
                let of = |xi: &[f64; D], r: f64| {
                    let [own, back] = weight.influence(xi, r, 1.0 / r);
                    [own, back, weight.volume_fraction(r)]
                };
                let parts = BondParts {
                    body,
                    family: LatticeFamily::new(body, grid, stencil, &of),
                    kind: "stencil",
                    near_horizon: 0,
                    toughness,
                    criteria,
                    repulsion,
                    held,
                    simd,
                };
                let made = MaterialInteraction::new(parts, law, AnyLaw::on_lattice);
                Ok(Box::new(made.map_err(unfit)?))
            }
            _ => {
                let stiffnesses = weight.stiffnesses(body);
                let (list, weight) = match list {
                    Some(list) => (list, weight),
                    None if body.horizon.is_empty() => (HorizonList::new(body, horizon)?, weight),
                    None => variable_horizons(body, horizon, weight)?,
                };
                let remembers = of.memory > 0;
                let near_horizon = list.near_horizon;
                let family = CloudFamily::new(body, self.horizon, list, weight, remembers);
                let family = match law.of_bonds() {
                    true => family.of_bonds(stiffnesses, law.is_alike()),
                    false => family,
                };
                let parts = BondParts {
                    body,
                    family,
                    kind: "list",
                    near_horizon,
                    toughness,
                    criteria,
                    repulsion,
                    held,
                    simd,
                };
                let made = MaterialInteraction::new(parts, law, AnyLaw::on_cloud);
                Ok(Box::new(made.map_err(unfit)?))
            }
        }
    }
}

/// Bonds of points with horizons of their own, up to `horizon`; at these volumes fade by themselves.
fn variable_horizons<const D: usize>(
    body: &Body<D>,
    horizon: f64,
    weight: BondWeight,
) -> Result<(HorizonList, BondWeight), BuildError> {
    let half = weight.fringe(body.spacing);
    let own = |i: usize| body.horizon[i];
    let reach = |i: usize, j: usize| own(i).max(own(j)) + half;
    let list = HorizonList::within(body, horizon + half, reach)?;
    Ok((list, weight.whole()))
}

/// Has the law what its bonds shall break by?
fn able<const D: usize>(of: &LawProperties<D>, criteria: &Criteria) -> Result<(), BuildError> {
    let refused = |message: &str| Err(BuildError::unsupported("materials[0].fracture", message));
    let measured = match &criteria.measure {
        Measure::Stretch | Measure::Work(_) => return Ok(()),
        Measure::VonMises(_) => true,
        Measure::PlasticStrain(_) => {
            let past = &of.columns.past;
            past.iter().any(|c| c.name == PLASTIC_STRAIN)
        }
    };
    if !measured {
        return Err(BuildError::unsupported(
            "materials[0].fracture",
            "this law has no plastic strain to break by",
        )
        .help("take elastic_plastic or hypoelastic_plastic, or another criterion"));
    }
    match of.failure {
        Some(_) => {
            refused("the law has a damage of its own, by which its bonds break: give one of both")
        }
        None => Ok(()),
    }
}
