//! Bodies of a spec, before they have bonds.

use crate::body::Body;
use crate::constitutive::{AnyPotentials, Registry};
use crate::error::BuildError;
use crate::family::nodes::Nodes;
use crate::interaction::longest_term;
use crate::quantity::Warnings;
use crate::run::agreed::agreed;
use crate::run::faces::Faces;
use crate::run::names::Names;
use crate::run::parts::{Part, halo, horizons, parts};
use crate::run::reference::{cell, current_neighbours};
use crate::run::sanity::enough_memory;
use crate::run::sets::{assign_materials, sets};
use crate::run::{atoms, clouds, gaps, interfaces, lints, surface, traits, variable_horizons};
use crate::spec::{BodySpec, FamilyChoice, Horizon, PieceSpec, Spec};
use peridyne_comm::Comm;
use std::sync::Arc;

/// Points with materials and masses, and what they are called.
pub(super) struct Bodies<'a, const D: usize> {
    pub parts: Vec<Part<'a>>,
    pub body: Body<D>,
    /// The atoms, and what nodes take of them; `None`: points are what has bonds.
    pub smoothed: Option<(Body<D>, Nodes)>,
    /// All nodes that carry atoms, where ranks share them.
    pub whole_nodes: Option<Body<D>>,
    pub names: Names<D>,
    /// The longest of all bodies that have bonds (length).
    pub horizon: f64,
    /// Within a body all pairs nearer than this are a family (length).
    pub least_horizon: f64,
    /// Bonds of stencils that end within round-off of a horizon that is a length.
    pub ends: u64,
    /// Are all points atoms?
    pub atoms: bool,
    /// The shortest distances (length) between bodies that are nearer than the horizon or the range of contact.
    pub nearest: Vec<([usize; 2], f64)>,
}

impl<'a, const D: usize> Bodies<'a, D> {
    pub fn new(
        spec: &'a Spec,
        registry: &Registry,
        potentials: Option<&AnyPotentials>,
        ranks: Option<&Arc<Comm>>,
        warnings: &mut Warnings,
    ) -> Result<Self, BuildError> {
        let (mut parts, mut body) = parts::<D>(spec, ranks)?;
        match (potentials, spec.bonds.family) {
            (Some(potentials), _) if current_neighbours(spec) => {
                atoms::check_box(potentials, &body.period())?;
                parts[0].horizon = potentials.reach;
            }
            (Some(_), FamilyChoice::Reference) => {
                atoms::check_periods("horizon", "horizon", parts[0].horizon, &body.period())?;
            }
            _ => {}
        }
        let [horizon, mut least_horizon] = horizons(&parts);
        if ranks.is_none() {
            enough(spec, &parts, &body)?;
        }
        let smoothed = match &spec.bonds.smooth {
            None => None,
            Some(smooth) => {
                let (nodes, kinematic) = Nodes::new(&body, smooth)?;
                let mut atoms = std::mem::replace(&mut body, nodes);
                atoms.set_density(spec.materials[0].density);
                clouds::own_densities(spec, &mut atoms);
                Some((atoms, kinematic))
            }
        };
        let load_map = match spec.micromoduli() {
            Some(linear) => (**linear).clone().of::<D>().and_then(|l| l.load_map),
            None => None,
        };
        let (sets, loaded_sets) = sets(spec, &body, load_map.as_ref())?;
        assign_materials(spec, &mut body, &sets)?;
        match &smoothed {
            None => clouds::own_densities(spec, &mut body),
            Some((atoms, kinematic)) => kinematic.give_masses(atoms, &mut body),
        }
        complete(&mut parts, &mut body, spec.body.pieces(), registry)?;
        if !body.horizons().is_empty() {
            let own = body.slots().iter().map(|s| body.horizons()[*s as usize]);
            least_horizon = body.least(own.fold(least_horizon, f64::min));
        }
        let by_length = |p: &&Part| matches!(p.spec.bonds.horizon, Horizon::Length(_));
        let ends = parts.iter().filter(by_length).flat_map(|p| &p.stencil);
        let ends = ends.map(|s| s.near_horizon() as u64).sum();
        if let (Some(potentials), BodySpec::Lattice { kind, spacing, .. }) =
            (potentials, &spec.body)
        {
            warnings.extend(atoms::crystal(spec, potentials, *kind, *spacing)?);
        }
        let mut names = Names {
            sets,
            load_map,
            loaded_sets,
            faces: Faces::new(spec),
            registry: registry.clone(),
        };
        let mut whole_nodes = None;
        let nearest = gaps::between(&body, reach(spec, &parts, &body, horizon));
        if let Some(ranks) = ranks {
            let ended = surface::ended(spec, &body);
            let whole = ended.as_ref().unwrap_or(&body);
            warnings.extend(lints::all(spec, whole, &names.sets)?);
            names.faces.find(spec, whole, &names.sets)?;
            if body.subdomain().is_none() {
                // all ranks know all points until here, and find the same mistakes
                whole_nodes = smoothed.is_some().then(|| body.clone());
                let beside = interfaces::ends(spec, &body)?;
                let bonded = spec.interactions.bonded.as_ref();
                let term = || bonded.map_or(0.0, |bonded| longest_term(&body, bonded));
                let halo = halo(spec, body.spacing(), horizon, term);
                body = body.subdomain_beside(ranks, halo, &beside);
                cut(&mut names, &body);
            }
            agreed(&body, enough(spec, &parts, &body))?;
        }
        Ok(Bodies {
            parts,
            body,
            smoothed,
            whole_nodes,
            names,
            horizon,
            least_horizon,
            ends,
            atoms: potentials.is_some(),
            nearest,
        })
    }
}

/// How far points may be to feel each other (length).
fn reach<const D: usize>(spec: &Spec, parts: &[Part], body: &Body<D>, horizon: f64) -> f64 {
    let free = { spec.interactions.contact.as_ref() }.map_or(0.0, |c| c.free);
    let own = parts.iter().zip(body.pieces());
    let ranges = own.map(|(part, p)| free * cell(&part.spec, &p.body));
    ranges.fold(horizon, f64::max)
}

/// What is left of the names in this part of a body.
fn cut<const D: usize>(names: &mut Names<D>, part: &Body<D>) {
    let Some(of) = part.subdomain() else { return };
    let mut here = vec![None; of.points()];
    (0..)
        .zip(of.ids())
        .for_each(|(id, old)| here[*old as usize] = Some(id));
    names.faces.keep(&names.sets, &here);
    names.renumber(&here);
}

/// Is there room for these bodies and their bonds?
fn enough<const D: usize>(spec: &Spec, parts: &[Part], body: &Body<D>) -> Result<(), BuildError> {
    for (n, part) in parts.iter().enumerate().filter(|(_, p)| p.bonded) {
        let own = body.pieces().get(n).map_or(body, |p| &p.body);
        let atoms = current_neighbours(spec);
        enough_memory(own, part.stencil.as_ref(), part.horizon, atoms)?;
    }
    Ok(())
}

/// Gives each of several bodies its materials, and points their horizons.
fn complete<const D: usize>(
    parts: &mut [Part],
    body: &mut Body<D>,
    named: &[PieceSpec],
    registry: &Registry,
) -> Result<(), BuildError> {
    if named.is_empty() {
        let part = &parts[0];
        return variable_horizons::give(&part.spec, body, part.horizon);
    }
    for (n, part) in parts.iter_mut().enumerate() {
        let mut own = body.pieces()[n].body.clone();
        part.choose(body, n, &mut own);
        let made = traits::agree(&part.spec, registry)
            .and_then(|()| variable_horizons::give(&part.spec, &mut own, part.horizon));
        made.map_err(|e| {
            let own = named[n].variable_horizon.is_some() && e.path == "variable_horizon";
            let e = part.named(&named[n], e);
            match own {
                true => e.at(format!("body[{n}].variable_horizon")),
                false => e,
            }
        })?;
        body.change_piece(n, |body| *body = own);
    }
    body.join_horizons(&parts.iter().map(|p| p.horizon).collect::<Vec<_>>());
    Ok(())
}
