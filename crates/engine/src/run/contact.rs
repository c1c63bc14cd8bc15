//! Contact of a model: how points of every body and material repel, and what step that allows.

use super::parts::Part;
use super::reference::cell;
use crate::body::Body;
use crate::constitutive::{ConstitutiveModel, ConstitutiveModels, contact_stiffness};
use crate::dynamics::contact_step::{ContactLimit, Grain, contact_limit};
use crate::error::BuildError;
use crate::interaction::cohesion::{Adhesion, Cohesion, Faces, RANGES};
use crate::interaction::contact::Contact;
use crate::interaction::coulomb::TANGENTIAL;
use crate::interaction::friction::Friction;
use crate::interaction::nearness::Nearness;
use crate::interaction::{PairTable, Repulsion, in_series};
use crate::message;
use crate::quantity::Dimension;
use crate::space::AXES;
use crate::spec::{CohesionSpec, ContactStiffness, FrictionSpec, Spec};

/// Points of one material in one body.
struct Kind {
    body: usize,
    /// Place in the spec.
    material: usize,
    /// Distance of points (length).
    spacing: f64,
    /// From the law (force / volume² / length).
    stiffness: f64,
}

/// How all points repel.
pub(super) struct Rules {
    kinds: Vec<Kind>,
    repulsion: Repulsion,
    /// Does contact conduct, so that it must know who touches?
    conducts: bool,
    rubs: bool,
    /// `[kinds][kinds]`, empty: bodies do not attract each other.
    adhesion: Vec<Adhesion>,
    section: f64,
}

/// The rules of all pairs; `None`: no contact. Points of unlike spacing repel from the mean of both on.
pub(super) fn repulsion<const D: usize>(
    spec: &Spec,
    parts: &[Part],
    constitutive: &ConstitutiveModels,
    body: &Body<D>,
) -> Result<Option<Rules>, BuildError> {
    let Some(contact) = &spec.interactions.contact else {
        return Ok(None);
    };
    let mut kinds = vec![];
    for (n, (part, model)) in parts.iter().zip(constitutive.all()).enumerate() {
        let own = body.pieces().get(n).map_or(body, |p| &p.body);
        let spacing = cell(&part.spec, own);
        for (material, stiffness) in part.materials.iter().zip(&model.contact) {
            kinds.push(Kind {
                body: n,
                material: *material,
                spacing,
                stiffness: *stiffness,
            });
        }
    }
    let stiffness = match &contact.stiffness {
        ContactStiffness::Pairs(_) => {
            let of_materials =
                contact_stiffness(&contact.stiffness, &vec![0.0; spec.materials.len()])?;
            PairTable::new(kinds.len(), |a, b| {
                of_materials.at(kinds[a].material, kinds[b].material)
            })
        }
        ContactStiffness::Laws | ContactStiffness::Same(_) => {
            let own: Vec<f64> = kinds.iter().map(|k| k.stiffness).collect();
            contact_stiffness(&contact.stiffness, &own)?
        }
    };
    let range = PairTable::new(kinds.len(), |a, b| {
        contact.free * 0.5 * (kinds[a].spacing + kinds[b].spacing)
    });
    let own = own_of_all(constitutive, body);
    let conducts = contact.conductance.is_some();
    let longest = match conducts {
        true => nearness(&kinds, 0.0).longest(&range).max(range.highest()),
        false => range.highest(),
    };
    if !body.pieces().is_empty() {
        for (a, period) in body.period().iter().enumerate() {
            if let Some(p) = period.filter(|p| *p <= 3.0 * longest) {
                return Err(BuildError::conflict(
                    "periodic",
                    message![
                        format!("the period along {} is ", AXES[a]),
                        Dimension::LENGTH.of(p),
                        ", not more than three ranges of contact of ",
                        Dimension::LENGTH.of(longest),
                        ": a point would meet its own image",
                    ],
                ));
            }
        }
    }
    let mut adhesion = vec![];
    if let Some(cohesion) = &contact.cohesion {
        if body.pieces().is_empty() {
            let message = "cohesion is between bodies, and there is one";
            return Err(BuildError::conflict("contact.cohesion", message)
                .help("write each as a [[body]] of its own"));
        }
        for a in 0..kinds.len() {
            for b in 0..kinds.len() {
                let faces = faces(&kinds, &range, spec.space.section, a, b);
                adhesion.push(sticks::<D>(cohesion, faces)?);
            }
        }
        let longest = adhesion.iter().map(|a| a.range).fold(0.0, f64::max);
        for (a, period) in body.period().iter().enumerate() {
            if let Some(p) = period.filter(|p| *p <= 2.5 * longest) {
                return Err(BuildError::conflict(
                    "periodic",
                    message![
                        format!("the period along {} is ", AXES[a]),
                        Dimension::LENGTH.of(p),
                        ", not more than 2.5 ranges of cohesion of ",
                        Dimension::LENGTH.of(longest),
                        ": a point would attract two images of another",
                    ],
                )
                .help("write a greater strength, or a longer period"));
            }
        }
    }
    Ok(Some(Rules {
        section: spec.space.section,
        adhesion,
        kinds,
        repulsion: Repulsion {
            stiffness,
            bonded: contact.bonded,
            range,
            own,
        },
        conducts,
        rubs: contact.friction.is_some(),
    }))
}

/// [`own_stiffness`](super::variable_horizons::own_stiffness) of all bodies, where any has one: in the others all points have that of their material.
fn own_of_all<const D: usize>(constitutive: &ConstitutiveModels, body: &Body<D>) -> Vec<f64> {
    let of = |m: &ConstitutiveModel| m.repulsion.as_ref().map_or(vec![], |r| r.own.clone());
    let all: Vec<Vec<f64>> = constitutive.all().map(of).collect();
    if body.pieces().is_empty() || all.iter().all(Vec::is_empty) {
        return all.into_iter().next().unwrap_or_default();
    }
    let mut own = vec![0.0; body.len()];
    for ((p, model), given) in body.pieces().iter().zip(constitutive.all()).zip(all) {
        for &s in p.body.slots() {
            let s = s as usize;
            let of_material = || model.contact[p.body.material_of(s)];
            own[p.first + s] = given.get(s).copied().unwrap_or_else(of_material);
        }
    }
    body.exchange().fill(&mut own);
    own
}

/// Rows of two kinds that touch.
fn faces(kinds: &[Kind], range: &PairTable, section: f64, a: usize, b: usize) -> Faces {
    Faces {
        spacing: [a, b].map(|k| kinds[k].spacing),
        apart: range.at(a, b),
        section,
    }
}

/// What such rows attract each other by.
fn sticks<const D: usize>(cohesion: &CohesionSpec, faces: Faces) -> Result<Adhesion, BuildError> {
    let &CohesionSpec { energy, strength } = cohesion;
    if let Some(adhesion) = Adhesion::of_strength::<D>(energy, strength, faces) {
        return Ok(adhesion);
    }
    let [most, least] =
        RANGES.map(|x| Adhesion::new::<D>(energy, x * faces.apart, faces).traction::<D>(faces));
    let why = match strength > least {
        true => " would end within the second row of points".to_string(),
        false => format!(
            " would reach further than {} times the distance of contact",
            RANGES[1]
        ),
    };
    Err(BuildError::conflict(
        "contact.cohesion",
        message![
            "a traction of ",
            Dimension::PRESSURE.of(strength),
            " that takes ",
            Dimension::FRACTURE_ENERGY.of(energy),
            format!(" per area{why}, of points that touch at a distance of "),
            Dimension::LENGTH.of(faces.apart),
        ],
    )
    .help(message![
        "write a strength from ",
        Dimension::PRESSURE.of(least),
        " to ",
        Dimension::PRESSURE.of(most),
        ", or another spacing",
    ]))
}

/// Who can touch, of points that are this near in one body and belong together (length).
fn nearness(kinds: &[Kind], horizon: f64) -> Nearness {
    Nearness {
        spacing: kinds.iter().map(|k| k.spacing).collect(),
        horizon,
    }
}

impl Rules {
    /// Of points of a material among themselves (force / volume² / length), per material of the spec that a body is made of, as the first
    /// body has it.
    pub fn stiffness(&self) -> Vec<f64> {
        let mut of: Vec<(usize, f64)> = vec![];
        for (n, kind) in self.kinds.iter().enumerate() {
            if of.iter().all(|(material, _)| *material != kind.material) {
                of.push((kind.material, self.repulsion.stiffness.at(n, n)));
            }
        }
        of.sort_by_key(|(material, _)| *material);
        of.into_iter().map(|(_, stiffness)| stiffness).collect()
    }

    /// Name of the material of a kind.
    pub fn name<'a>(&self, spec: &'a Spec, kind: usize) -> &'a str {
        let material = self.kinds.get(kind).map_or(0, |k| k.material);
        spec.materials.get(material).map_or("", |m| &m.name)
    }

    /// The longest distance below which points of two bodies repel (length).
    pub fn range(&self, a: usize, b: usize) -> f64 {
        let of = |n: usize| {
            let all = self.kinds.iter().enumerate();
            all.filter(move |(_, k)| k.body == n).map(|(k, _)| k)
        };
        let pairs = of(a).flat_map(|k| of(b).map(move |l| (k, l)));
        pairs
            .map(|(k, l)| self.repulsion.range.at(k, l))
            .fold(0.0, f64::max)
    }

    /// The pair of kinds that asks for the shortest step; `bonds` is the largest eigenvalue of the bonds.
    pub fn limit<const D: usize>(
        &self,
        parts: &[Part],
        body: &Body<D>,
        bonds: f64,
    ) -> Option<ContactLimit> {
        let kind = self.kind_of(body);
        // the extreme of what points of each kind have
        let most = |of: &dyn Fn(usize) -> f64| {
            let mut most = vec![f64::NEG_INFINITY; self.kinds.len()];
            for &s in body.slots() {
                let most = &mut most[kind(s as usize)];
                *most = most.max(of(s as usize));
            }
            most.into_iter().map(|own| body.most(own)).collect()
        };
        let volumes: Vec<f64> = most(&|s| body.volume().at(s));
        let densities: Vec<f64> = most(&|s| -body.density().at(s));
        let grains = { volumes.into_iter().zip(densities) }.map(|(volume, density)| Grain {
            volume: volume.max(0.0),
            density: -density,
        });
        let grains: Vec<Grain> = grains.collect();
        let mut repulsion = self.repulsion.clone();
        if !repulsion.own.is_empty() {
            // the stiffest point of each kind
            let most: Vec<f64> = most(&|s| repulsion.own[s].max(0.0));
            let of = |a: usize, b: usize| in_series(most[a].max(0.0), most[b].max(0.0));
            repulsion.stiffness = PairTable::new(most.len(), of);
        }
        let mut near = 0.0f64;
        for (n, part) in parts.iter().enumerate() {
            let own = body.pieces().get(n).map_or(body, |p| &p.body);
            let range = self.kinds.iter().enumerate().filter(|(_, k)| k.body == n);
            let range = range.map(|(k, _)| self.repulsion.range.at(k, k));
            near = near.max(part.neighbours(own, range.fold(0.0, f64::max)));
        }
        let along = if self.rubs { TANGENTIAL } else { 0.0 };
        let per_axis = near * (1.0 + (D - 1) as f64 * along) / D as f64;
        let pulls = |a: usize, b: usize| match self.adhesion.get(a * self.kinds.len() + b) {
            None => 0.0,
            Some(adhesion) => {
                let faces = faces(&self.kinds, &self.repulsion.range, self.section, a, b);
                adhesion.stiffness::<D>(faces)
            }
        };
        contact_limit(&repulsion, &grains, per_axis, bonds, pulls)
    }

    /// The kind of a slot.
    fn kind_of<const D: usize>(&self, body: &Body<D>) -> impl Fn(usize) -> usize {
        let first: Vec<usize> = (0..body.pieces().len())
            .map(|n| self.kinds.iter().position(|k| k.body == n).unwrap_or(0))
            .collect();
        move |slot| match body.pieces() {
            [] => body.material_of(slot),
            pieces => {
                let n = body.piece_of(slot);
                first[n] + pieces[n].body.material_of(slot - pieces[n].first)
            }
        }
    }

    /// Contact of all points that are in no common family.
    pub fn contact<const D: usize>(
        self,
        parts: &[Part],
        body: &Body<D>,
        horizon: f64,
    ) -> Contact<D> {
        let bonded: Vec<bool> = parts.iter().map(|p| p.bonded).collect();
        let mut kind = vec![];
        if !body.pieces().is_empty() {
            let of = self.kind_of(body);
            kind = vec![0; body.len()];
            for &s in body.slots() {
                kind[s as usize] = of(s as usize) as u16;
            }
            body.exchange().fill(&mut kind);
        }
        let near = self.conducts.then(|| nearness(&self.kinds, horizon));
        let kinds = self.kinds.len();
        let cohesion = (!self.adhesion.is_empty()).then(|| {
            Cohesion::new(body, kinds, kind.clone(), |a, b| {
                self.adhesion[a * kinds + b]
            })
        });
        Contact::with_nearness(self.repulsion, near, body, horizon, &bonded)
            .kinds(kind)
            .cohesive(cohesion)
    }
}

/// Friction of contact; `None`: points slide freely.
pub(super) fn friction<const D: usize>(
    spec: &Spec,
    body: &Body<D>,
) -> Result<Option<Friction<D>>, BuildError> {
    let Some(law) = spec
        .interactions
        .contact
        .as_ref()
        .and_then(|c| c.friction.as_ref())
    else {
        return Ok(None);
    };
    check_friction::<D>(law, "contact.friction")?;
    Ok(Some(Friction::new(law.clone(), body)))
}

/// Coefficients that depend on t alone and do not begin below 0, of a body that moves and has something to rub along.
pub(super) fn check_friction<const D: usize>(
    law: &FrictionSpec,
    path: &str,
) -> Result<(), BuildError> {
    let mut all = vec![&law.kinetic];
    all.extend(law.at_rest.iter().map(|r| &r.coefficient));
    for coefficient in all {
        if coefficient.depends_on_position() {
            let message =
                "the friction coefficient depends on the place, expected an expression of t";
            return Err(BuildError::unsupported(path, message).help("0.3 is usual"));
        }
        let first = coefficient.eval(&[0.0; 3], 0.0);
        if !(first >= 0.0 && first.is_finite()) {
            let message =
                format!("the friction coefficient is {first}, expected a number from 0 on");
            return Err(BuildError::invalid(path, message).help("0.3 is usual"));
        }
    }
    if let Some(rest) = &law.at_rest
        && !(rest.speed > 0.0 && rest.speed.is_finite())
    {
        let message = format!(
            "the speed over which friction falls is {}, expected a positive number",
            rest.speed
        );
        return Err(BuildError::invalid(path, message));
    }
    if D == 1 {
        let message = "points on a line have nothing to rub along";
        return Err(BuildError::unsupported(path, message).help("leave friction out"));
    }
    Ok(())
}
