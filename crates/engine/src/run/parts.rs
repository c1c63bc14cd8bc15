//! The bodies of a spec on their way into a model: where their points are, their laws, their bonds.

use super::agreed::agreed;
use super::calibration::cloud_moments;
use super::interfaces;
use super::reference::{Reference, cell, countable, counted, current_neighbours, reference};
use super::variable_horizons::{own_stiffness, strengths};
use crate::body::cut::Counted;
use crate::body::{Body, Layout};
use crate::constitutive::{Bulk, ConstitutiveModel, Registry};
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

/// The bodies of a spec, and where their points are; of bodies that ranks can make part by part this rank's points.
pub(super) fn parts<'a, const D: usize>(
    spec: &'a Spec,
    ranks: Option<&Arc<Comm>>,
) -> Result<(Vec<Part<'a>>, Body<D>), BuildError> {
    let pieces = spec.body.pieces();
    let own = alone(spec)?;
    let named = |n: usize, e: BuildError| match pieces.get(n) {
        None => e,
        Some(piece) => BuildError {
            path: e.path.replacen("body", &format!("body[{n}]"), 1),
            message: message![format!("body `{}`: ", piece.name), e.message],
            ..e
        },
    };
    let shared = ranks.filter(|_| own.iter().all(|(own, _)| countable(own)));
    let (mut all, mut bodies) = (vec![], vec![]);
    match shared {
        None => {
            for (n, (own, bonded)) in own.into_iter().enumerate() {
                let made = reference::<D>(&own).map_err(|e| named(n, e))?;
                let (part, body) = part(own, bonded, made);
                all.push(part);
                bodies.push(body);
            }
        }
        Some(ranks) => {
            let mut whole = vec![];
            for (n, (own, bonded)) in own.into_iter().enumerate() {
                let made = counted::<D>(&own, ranks).map_err(|e| named(n, e))?;
                let (part, body) = part(own, bonded, made);
                all.push(part);
                whole.push(body);
            }
            let spacing = whole.iter().map(Counted::spacing);
            let spacing = spacing.fold(f64::INFINITY, f64::min);
            let halo = halo(spec, spacing, horizons(&all)[0], || 0.0);
            bodies = Counted::parts(&whole, ranks, halo);
        }
    }
    if pieces.is_empty() {
        return Ok((all, bodies.remove(0)));
    }
    let body = Body::several(bodies);
    if body.subdomain().is_none() {
        return Ok((all, body));
    }
    let ends = interfaces::ends(spec, &body)?;
    Ok((all, body.beside(&ends)))
}

/// What a spec says of each of its bodies alone, and whether it has bonds.
fn alone(spec: &Spec) -> Result<Vec<(Cow<'_, Spec>, bool)>, BuildError> {
    let BodySpec::Several(pieces) = &spec.body else {
        return Ok(vec![(Cow::Borrowed(spec), true)]);
    };
    several_can(pieces)?;
    let without = Spec {
        body: BodySpec::Several(vec![]),
        ..spec.clone()
    };
    let each = pieces.iter();
    Ok(each
        .map(|piece| (Cow::Owned(without.alone(piece)), piece.bonded))
        .collect())
}

/// What a reference says, but for its points.
fn part<B>(spec: Cow<'_, Spec>, bonded: bool, reference: Reference<B>) -> (Part<'_>, B) {
    let part = Part {
        materials: (0..spec.materials.len()).collect(),
        spec,
        bonded,
        stencil: reference.stencil,
        bulk: reference.bulk,
        family: reference.family,
        horizon: reference.horizon,
    };
    (part, reference.body)
}

/// The longest and the shortest horizon of bodies that have bonds (length).
pub(super) fn horizons(parts: &[Part]) -> [f64; 2] {
    let bonded = || parts.iter().filter(|p| p.bonded).map(|p| p.horizon);
    let longest = bonded().reduce(f64::max).unwrap_or(parts[0].horizon);
    [longest, bonded().fold(longest, f64::min)]
}

/// How far the points are of which a part of a body has copies (length), of the least spacing and the longest horizon, and of how far terms of atoms reach.
/// Atoms find who is near by themselves, but for those that they are bonded to.
pub(super) fn halo(spec: &Spec, spacing: f64, horizon: f64, term: impl FnOnce() -> f64) -> f64 {
    if let Some(smooth) = &spec.bonds.smooth {
        // nodes feel each other through two atoms of a family, each within reach of one of them
        return horizon + 2.0 * smooth.reach + spacing;
    }
    let given = spec.micromoduli().map_or(0.0, |l| 1.001 * l.longest());
    match current_neighbours(spec) {
        true => term().max(spacing),
        // volumes of partners fade over a spacing at the horizon
        false => given.max(horizon + spacing),
    }
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
        // of all ranks
        let mut used = of.clone();
        used.sort_unstable();
        used.dedup();
        let mut used = all.all_of(&used).concat();
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
        registry: &Registry,
        simd: Simd,
        warnings: &mut Warnings,
    ) -> Result<ConstitutiveModel, BuildError> {
        let spec: &Spec = &self.spec;
        let cell = cell(spec, body);
        let from_modulus = |m: &MaterialSpec| {
            use PmbStiffness::{Bulk, Young};
            let turns = |law: &LawSpec| matches!(law, LawSpec::Named(l) if registry.tangential_stiffness(&l.name));
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
            ConstitutiveModel::new::<D>(spec, stencil, horizon, cell, bulk, registry, simd)?;
        if let Some(repulsion) = &mut model.repulsion {
            repulsion.own = own_stiffness(spec, body, &model.contact, model.horizon);
        }
        model.strength = agreed(body, strengths(spec, body, model.horizon, registry))?;
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
