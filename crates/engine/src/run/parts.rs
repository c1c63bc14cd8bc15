//! The bodies of a spec on their way into a model: where their points are, their laws, their bonds.

use super::agreed::agreed;
use super::calibration::cloud_moments;
use super::own_horizons::{own_stiffness, strengths};
use super::reference::{Reference, cell, reference};
use crate::body::{Body, Layout};
use crate::constitutive::{Bulk, ConstitutiveModel, Shelf};
use crate::error::BuildError;
use crate::execute::simd::Simd;
use crate::family::stencil::Stencil;
use crate::interaction::Interaction;
use crate::law::material::Partner;
use crate::law::micromodulus::Moments;
use crate::message;
use crate::quantity::Warnings;
use crate::space::ball_volume;
use crate::spec::{
    BodySpec, Calibration, ContactStiffness, Horizon, LawSpec, MaterialSpec, PieceSpec,
    PmbStiffness, Spec,
};
use peridyne_comm::Comm;
use std::borrow::Cow;
use std::sync::Arc;

/// One body.
pub(super) struct Part<'a> {
    /// Of this body alone: its points, and the materials that it is made of.
    pub spec: Cow<'a, Spec>,
    /// Places of these materials in the spec of all.
    pub materials: Vec<usize>,
    pub bonded: bool,
    pub stencil: Option<Stencil>,
    pub bulk: Option<Moments>,
    /// [`Reference::family`]
    pub family: Vec<Partner<3>>,
    /// Length.
    pub horizon: f64,
}

/// The bodies of a spec, and where their points are; of one that ranks can make part by part this rank's points.
pub(super) fn parts<'a, const D: usize>(
    spec: &'a Spec,
    ranks: Option<&Arc<Comm>>,
) -> Result<(Vec<Part<'a>>, Body<D>), BuildError> {
    let part = |spec: Cow<'a, Spec>,
                bonded: bool,
                ranks: Option<&Arc<Comm>>|
     -> Result<(Part<'a>, Body<D>), BuildError> {
        let Reference {
            body,
            stencil,
            bulk,
            family,
            horizon,
        } = reference::<D>(&spec, ranks)?;
        let part = Part {
            materials: (0..spec.materials.len()).collect(),
            spec,
            bonded,
            stencil,
            bulk,
            family,
            horizon,
        };
        Ok((part, body))
    };
    let pieces = match &spec.body {
        BodySpec::Several(pieces) => pieces,
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => {
            let (part, body) = part(Cow::Borrowed(spec), true, ranks)?;
            return Ok((vec![part], body));
        }
    };
    several_can(pieces)?;
    let without = Spec {
        body: BodySpec::Several(vec![]),
        ..spec.clone()
    };
    let (mut all, mut bodies) = (vec![], vec![]);
    for (n, piece) in pieces.iter().enumerate() {
        let own = without.alone(piece);
        let (part, body) = part(Cow::Owned(own), piece.bonded, None).map_err(|e| BuildError {
            path: e.path.replacen("body", &format!("body[{n}]"), 1),
            message: message![format!("body `{}`: ", piece.name), e.message],
            ..e
        })?;
        all.push(part);
        bodies.push(body);
    }
    Ok((all, Body::several(bodies)))
}

/// Are there bodies, and has each a name of its own?
fn several_can(pieces: &[PieceSpec]) -> Result<(), BuildError> {
    if pieces.is_empty() {
        return Err(BuildError::missing("body", "there are no bodies").help("give one"));
    }
    for (n, piece) in pieces.iter().enumerate() {
        if pieces[..n].iter().any(|p| p.name == piece.name) {
            return Err(BuildError::conflict(
                format!("body[{n}].name"),
                format!("two bodies are called `{}`", piece.name),
            ));
        }
    }
    Ok(())
}

impl Part<'_> {
    /// An error of one of several bodies, which knows its own materials.
    pub fn named(&self, piece: &PieceSpec, e: BuildError) -> BuildError {
        let of = |n: &usize| format!("materials[{n}]");
        let mut of_all = self.materials.iter().enumerate();
        let path = of_all.find_map(|(n, all)| Some(of(all) + e.path.strip_prefix(&of(&n))?));
        BuildError {
            path: path.unwrap_or(e.path),
            message: message![format!("body `{}`: ", piece.name), e.message],
            ..e
        }
    }

    /// Choose the materials of all that this body, made of several, has; its points know them by their place among
    /// these.
    pub fn choose<const D: usize>(&mut self, all: &Body<D>, n: usize, body: &mut Body<D>) {
        let piece = &all.pieces()[n];
        let slots = piece.body.slots().iter();
        let of: Vec<usize> = slots
            .map(|s| all.material_of(piece.first + *s as usize))
            .collect();
        let mut used = of.clone();
        used.sort_unstable();
        used.dedup();
        let density = body.slots().iter();
        let density: Vec<f64> = density
            .map(|s| all.density().at(piece.first + *s as usize))
            .collect();
        body.set_densities(&density);
        if used.len() > 1 {
            let place = |m| used.binary_search(m).unwrap_or(0) as u8;
            body.give_materials(of.iter().map(place));
        }
        let spec = self.spec.to_mut();
        let (materials, pairs) = (spec.materials.len(), &mut spec.interactions.pairs);
        if pairs.len() == materials * materials {
            let rows = used.iter().map(|a| a * materials);
            let own = rows.flat_map(|row| used.iter().map(move |b| row + b));
            *pairs = own.map(|n| pairs[n].clone()).collect();
        }
        spec.materials = used.iter().map(|m| spec.materials[*m].clone()).collect();
        if let Some(contact) = &mut spec.interactions.contact
            && let ContactStiffness::Pairs(rows) = &mut contact.stiffness
            && rows.iter().all(|r| r.len() == rows.len())
        {
            let row = |a: &usize| used.iter().map(|b| rows[*a][*b]).collect();
            *rows = used.iter().map(row).collect();
        }
        self.materials = used;
    }

    /// Its laws with their constants.
    pub fn constitutive<const D: usize>(
        &mut self,
        body: &Body<D>,
        shelf: &Shelf,
        simd: Simd,
        warnings: &mut Warnings,
    ) -> Result<ConstitutiveModel, BuildError> {
        let spec: &Spec = &self.spec;
        let cell = cell(spec, body);
        let from_modulus = |m: &MaterialSpec| {
            use PmbStiffness::{Bulk, Young};
            let turns = |law: &LawSpec| matches!(law, LawSpec::Named(l) if shelf.turns(&l.name));
            matches!(m.law.linear(), LawSpec::Pmb(Bulk(_) | Young(_))) || turns(&m.law)
        };
        let mut bulk = self.bulk;
        if bulk.is_none()
            && self.bonded
            && spec.bonds.calibration == Calibration::Discrete
            && spec.materials.iter().any(from_modulus)
        {
            bulk = cloud_moments(spec, body, self.horizon, cell)?;
            if bulk.is_none() {
                warnings.push(
                    "no point of this cloud has a full family to calibrate to, all are closer to the surface than the horizon: the constants are those of the continuum",
                );
            }
        }
        let continuum =
            || Moments::continuum(D, self.horizon, spec.space.section, spec.bonds.influence);
        let bulk = Bulk {
            moments: bulk.unwrap_or_else(continuum),
            family: std::mem::take(&mut self.family),
        };
        let (stencil, horizon) = (self.stencil.take(), self.horizon);
        let mut model =
            ConstitutiveModel::new::<D>(spec, stencil, horizon, cell, bulk, shelf, simd)?;
        if let Some(repulsion) = &mut model.repulsion {
            repulsion.own = own_stiffness(spec, body, &model.contact, model.horizon);
        }
        model.strength = agreed(body, strengths(spec, body, model.horizon, shelf))?;
        Ok(model)
    }

    /// Its bonds; `None`: loose points.
    pub fn bonds<const D: usize>(
        &self,
        model: &ConstitutiveModel,
        body: &Body<D>,
    ) -> Result<Option<Box<dyn Interaction<D>>>, BuildError> {
        match self.bonded {
            true => model.interaction(body, None).map(Some),
            false => Ok(None),
        }
    }

    /// Neighbours of a free point of this body within `range` (length), about: of the lattice, or of a cloud of that
    /// density of points.
    pub fn neighbours<const D: usize>(&self, body: &Body<D>, range: f64) -> f64 {
        if let Layout::Grid(grid) = body.layout() {
            let near = Stencil::new(
                grid.lattice().kind,
                grid.lattice().spacing,
                Horizon::Length(range),
            );
            return near.bonds() as f64;
        }
        (ball_volume(D, range / body.spacing()) - 1.0).max(0.0)
    }
}
