//! The constitutive model of a body, apart from its points: laws with their constants, weights of bonds, toughness.

mod constants;
pub mod criteria;
mod interaction;
mod pairs;
pub(crate) mod registry;
mod sweeps;
mod toughness;

use crate::body::Body;
use crate::boundary_condition::toughness::Resistance;
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::family::stencil::Stencil;
use crate::family::volume_fraction;
use crate::interaction::criterion::{Criteria, Measure};
use crate::interaction::pairs::BondTable;
use crate::interaction::{PairTable, Repulsion, Toughness};
use crate::law::influence::{InfluenceFunction, mean_influence};
use crate::law::material::Partner;
use crate::law::micromodulus::Moments;
use crate::spec::{BondMixing, Calibration, FamilyChoice, Horizon, Influence, Plane, Spec};
pub use constants::Laws;
use constants::{Constants, constants};
pub use pairs::contact_stiffness;
pub use registry::Registry;
pub use registry::{AnyPotentials, Softens, Stiffness};
use std::sync::Arc;
pub use sweeps::Sweeps;
pub use toughness::toughness;

/// A full family.
#[derive(Debug, Clone)]
pub struct Bulk {
    pub moments: Moments,
    /// Its bonds, where points lie on a lattice; else empty.
    pub family: Vec<Partner<3>>,
}

/// Of one body.
pub struct ConstitutiveModel {
    pub laws: Laws,
    pub toughness: Vec<Toughness>,
    /// What bonds break by beside that.
    pub criteria: Criteria,
    pub repulsion: Option<Repulsion>,
    /// `[slots]`: what critical stretches of points are of those of their materials, where horizons of their own and fracture energies make that another;
    /// else empty.
    pub strength: Vec<f64>,
    /// Stiffness of contact between points of a material, from its law (force / volume² / length).
    pub contact: Vec<f64>,
    pub stencil: Option<Stencil>,
    pub horizon: f64,
    /// Distance over which the horizon cuts cells.
    pub spacing: f64,
    pub influence: Influence,
    pub scaling: bool,
    /// Was the horizon given in spacings?
    pub ratio: bool,
    /// Do atoms keep the neighbours of the reference?
    pub held: bool,
    /// Do bonds break, or are some cut?
    pub breaks: bool,
    pub rule: BondMixing,
    /// Is the body in plane strain?
    pub slice: bool,
    /// Constants of pairs of materials, where they do not follow from the two.
    pub pairs: Option<Arc<BondTable>>,
    /// `None`: springs, micromoduli and atoms have others.
    pub sweeps: Option<Sweeps>,
    /// The law of the registry by which all materials are swept in general; `None`: `laws` says all.
    pub named: Option<registry::Chosen>,
    pub simd: Simd,
}

/// The constitutive models of all bodies.
pub struct ConstitutiveModels {
    /// First slot, places of the materials in the spec, model.
    of: Vec<(usize, Vec<usize>, ConstitutiveModel)>,
    /// Laws of interfaces that are on the registry.
    between: Vec<registry::Chosen>,
}

/// Do bonds break, or are some cut? Where the spec says so.
pub fn breaking(spec: &Spec) -> Option<String> {
    let material = { spec.materials.iter() }.position(|m| m.fracture.is_some());
    let crack = (!spec.damage.precracks.is_empty()).then(|| "precracks[0]".to_string());
    material
        .map(|n| format!("materials[{n}].fracture"))
        .or(crack)
}

/// Do bonds break, or are some cut?
pub fn breaks(spec: &Spec) -> bool {
    breaking(spec).is_some()
}

impl ConstitutiveModels {
    /// Of a single body.
    pub fn one(model: ConstitutiveModel) -> ConstitutiveModels {
        ConstitutiveModels {
            of: vec![(0, (0..model.contact.len()).collect(), model)],
            between: vec![],
        }
    }

    /// `(first slot, places of its materials in the spec, model)` of each body, in order; and laws of the interfaces `between` them.
    pub fn several(
        of: Vec<(usize, Vec<usize>, ConstitutiveModel)>,
        between: Vec<registry::Chosen>,
    ) -> ConstitutiveModels {
        ConstitutiveModels { of, between }
    }

    /// Laws of the registry, of bodies and of interfaces.
    pub fn named(&self) -> impl Iterator<Item = &registry::Chosen> {
        let own = self.all().filter_map(|m| m.named.as_ref());
        own.chain(&self.between)
    }

    pub fn first(&self) -> &ConstitutiveModel {
        &self.of[0].2
    }

    pub fn all(&self) -> impl Iterator<Item = &ConstitutiveModel> {
        self.of.iter().map(|(_, _, m)| m)
    }

    /// The model of the body that the point in a slot belongs to.
    pub fn at<const D: usize>(&self, body: &Body<D>, slot: usize) -> &ConstitutiveModel {
        &self.of[body.piece_of(slot)].2
    }

    pub fn forget_stencils(&mut self) {
        self.of.iter_mut().for_each(|(_, _, m)| m.stencil = None);
    }

    /// A number per material of the spec, from the first body that is made of it.
    fn per_material<T: Clone>(
        &self,
        count: usize,
        of: impl Fn(&ConstitutiveModel) -> Vec<T>,
    ) -> Vec<T> {
        let mut all = vec![None; count];
        for (_, materials, model) in &self.of {
            for (m, x) in materials.iter().zip(of(model)) {
                all[*m].get_or_insert(x);
            }
        }
        all.into_iter().flatten().collect()
    }

    /// Micromoduli of bond-based materials.
    pub fn micromoduli(&self, count: usize) -> Vec<f64> {
        self.per_material(count, |r| match &r.laws {
            Laws::Bond(c) => c.clone(),
            Laws::Solid(_) | Laws::Springs(_) | Laws::Atoms(_) | Laws::Micromoduli(_) => vec![],
        })
    }

    /// Horizons (length) and influence functions.
    pub fn families(&self, count: usize) -> Vec<(f64, Influence)> {
        self.per_material(count, |r| vec![(r.horizon, r.influence); r.toughness.len()])
    }

    /// What a material bears in the body of a slot: a critical stretch, or the root of a critical work (energy / volume²).
    pub fn resistance(&self, slot: usize, material: usize) -> (Resistance, f64) {
        let n = self.of.partition_point(|(first, _, _)| *first <= slot) - 1;
        let (first, materials, model) = &self.of[n];
        let own = materials.iter().position(|m| *m == material).unwrap_or(0);
        let by = model.strength.get(slot - first).copied().unwrap_or(1.0);
        match &model.criteria.measure {
            Measure::Work(limits) => (Resistance::Work, limits[own].sqrt()),
            Measure::Stretch | Measure::VonMises(_) | Measure::PlasticStrain(_) => {
                (Resistance::Stretch, by * model.toughness[own].s00)
            }
        }
    }

    /// What the laws of materials soften by.
    pub fn softens(&self, count: usize) -> Vec<Softens> {
        self.per_material(count, |r| match &r.named {
            Some(law) => law.softens(),
            None => vec![Softens::default(); r.contact.len()],
        })
    }

    pub fn critical_stretches(&self, count: usize) -> Vec<f64> {
        self.per_material(count, |r| r.toughness.iter().map(|t| t.s00).collect())
    }
}

impl ConstitutiveModel {
    /// Constants from a spec; `bulk` is a bulk family of this body.
    pub fn new<const D: usize>(
        spec: &Spec,
        stencil: Option<Stencil>,
        horizon: f64,
        spacing: f64,
        bulk: Bulk,
        registry: &Registry,
        simd: Simd,
    ) -> Result<ConstitutiveModel, BuildError> {
        let continuum = |kind| Moments::continuum(D, horizon, spec.space.section, kind);
        let moments = match spec.bonds.calibration {
            Calibration::Continuum => continuum(spec.bonds.influence),
            Calibration::Discrete => bulk.moments,
        };
        let alike = continuum(Influence::Constant);
        let Constants { laws, contact } = constants::<D>(spec, horizon, moments, alike, registry)?;
        let toughness = spec
            .materials
            .iter()
            .enumerate()
            .map(|(n, m)| {
                let path = format!("materials[{n}].fracture");
                toughness::<D>(spec, m, horizon, moments, registry, &path)
            })
            .collect::<Result<Vec<_>, _>>()?;
        let criteria = criteria::criteria::<D>(spec, moments)?;
        let repulsion = match &spec.interactions.contact {
            Some(contact_spec) => Some(Repulsion {
                stiffness: contact_stiffness(&contact_spec.stiffness, &contact)?,
                bonded: contact_spec.bonded,
                range: PairTable::uniform(contact_spec.free * spacing),
                own: vec![],
            }),
            None => None,
        };
        let pairs = pairs::bond_table(spec, &laws, horizon, spacing)?.map(Arc::new);
        let sweeps = Sweeps::of(spec);
        let named = match &sweeps {
            Some(sweeps) if !sweeps.fused => {
                let full = (horizon, moments, bulk.family);
                registry::chosen::<D>(spec, registry, full, &toughness)?
            }
            Some(_) | None => None,
        };
        Ok(ConstitutiveModel {
            laws,
            toughness,
            criteria,
            repulsion,
            strength: vec![],
            contact,
            stencil,
            horizon,
            spacing,
            influence: spec.bonds.influence,
            scaling: spec.bonds.partial_volume_correction,
            ratio: matches!(spec.bonds.horizon, Horizon::Ratio(_)),
            held: spec.bonds.family == FamilyChoice::Reference,
            breaks: breaks(spec),
            rule: spec.interactions.interface,
            slice: D == 2 && spec.space.plane == Plane::Strain,
            pairs,
            sweeps,
            named,
            simd,
        })
    }

    /// Are there constants that differ from place to place?
    pub fn varies(&self) -> bool {
        self.named.as_ref().is_some_and(registry::Chosen::varies)
    }

    /// `ω ν` of a bond ξ of length r0, the mean of both ends.
    pub fn weight(&self, xi: &[f64], r0: f64) -> f64 {
        self.weight_within(self.horizon, xi, r0)
    }

    /// The same of points with another horizon (length): 0 beyond it.
    pub fn weight_within(&self, horizon: f64, xi: &[f64], r0: f64) -> f64 {
        let nu = if self.scaling {
            volume_fraction(r0, horizon, self.spacing).max(0.0)
        } else {
            1.0
        };
        let full: [f64; 3] = crate::array::from_fn(|a| xi.get(a).copied().unwrap_or(0.0));
        let omega = match horizon == self.horizon {
            true => mean_influence(self.influence, &full, r0, horizon),
            false => {
                let function = InfluenceFunction::new(self.influence, horizon).mean();
                function.within(&full, r0, 1.0 / r0, horizon)
            }
        };
        nu * omega
    }
}
