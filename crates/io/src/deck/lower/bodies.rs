//! Several bodies: `[[body]]` more than once, or points without bonds.

use super::body;
use super::context::{Context, Result};
use super::family::{horizon, influence, surface_factors};
use super::pieces::within;
use super::sets;
use super::{Files, points};
use crate::deck::document::{Body, Document, FamilyName, SurfaceName};
use crate::deck::error::nearest;
use crate::deck::value::At;
use peridyne::run::materials_of_bodies;
use peridyne::spec::{
    AnyLinearBody, BodySpec, Cloud, FamilyChoice, Horizon, MaterialSpec, Members, PieceSpec,
    SetSpec, Spec,
};

/// All bodies of a deck, the first included.
pub(super) fn written(document: &Document) -> impl Iterator<Item = &At<Body>> {
    std::iter::once(&document.body).chain(&document.more_bodies)
}

/// Is there more than one body, or one without bonds? Such decks have a [`BodySpec::Several`].
pub(super) fn several(document: &Document) -> bool {
    !document.more_bodies.is_empty() || document.body.value.bonded == Some(false)
}

/// The bodies of a deck; settles the dimension of `context`.
pub(super) fn bodies(
    context: &mut Context,
    document: &Document,
    files: &Files,
) -> Result<BodySpec> {
    let mut pieces: Vec<PieceSpec> = Vec::new();
    for (n, at) in written(document).enumerate() {
        let written = &at.value;
        let before = context.dimension;
        let spec = body::body(context, document, at, files)?;
        if n > 0 && context.dimension != before {
            let message = format!(
                "this body is {}-D, the first is {before}-D",
                context.dimension
            );
            return Err(context.error(&at.span, message));
        }
        if !several(document) {
            return Ok(spec);
        }
        let span = written.file.as_ref().map_or(&at.span, |f| &f.span);
        if context.atoms.is_some() {
            return Err(context.error(
                span,
                "how atoms act on each other is what their potential says: neither a stiffness of contact nor one of bonds with a continuum follows from it, and several bodies meet by these alone",
            ));
        }
        let linear = context.micromoduli.take();
        if let Some(why) = linear.as_ref().and_then(|l| stands_alone(l, &spec)) {
            return Err(context.error(span, why));
        }
        points::lie_together(context, &pieces, &spec, written.file.as_ref())?;
        let name = match &written.name {
            Some(name) if name.value == "all" || name.value.is_empty() => {
                let message = "a body needs another name: \"all\" is the set of all points";
                return Err(context.error(&name.span, message));
            }
            Some(name) => name.value.clone(),
            None => format!("body {}", n + 1),
        };
        if pieces.iter().any(|p| p.name == name) {
            let span = written.name.as_ref().map_or(&at.span, |n| &n.span);
            return Err(context.error(span, format!("two bodies are called \"{name}\"")));
        }
        let linear = linear.map(|linear| (name.clone(), linear));
        context.linear_bodies.extend(linear);
        pieces.push(PieceSpec {
            bonded: written.bonded.unwrap_or(true),
            ..PieceSpec::new(name, spec)
        });
    }
    Ok(BodySpec::Several(pieces))
}

/// Why a linear body cannot be one of several.
fn stands_alone(linear: &AnyLinearBody, body: &BodySpec) -> Option<&'static str> {
    if linear.is_coupled() {
        return Some(
            "places of loads, and masses that couple points, are those of all points of a deck: condense it without loads, with lumped masses",
        );
    }
    if linear.period().iter().any(Option::is_some) {
        return Some("periods of a linear body are those of a whole deck");
    }
    let unlike = |cloud: &Cloud| cloud.density.windows(2).any(|d| d[0] != d[1]);
    matches!(body, BodySpec::Cloud(cloud) if unlike(cloud)).then_some(
        "the points of this linear body differ in density, and those of one of several bodies have that of their material",
    )
}

/// A set for every body, of its name, and `BODY.NAME` for each named mark of its file.
pub(super) fn sets(context: &Context, document: &Document, all: &BodySpec) -> Result<Vec<SetSpec>> {
    let BodySpec::Several(pieces) = all else {
        return Ok(vec![]);
    };
    let mut sets = Vec::new();
    for piece in pieces {
        if let Some(set) = document.sets.get(&piece.name) {
            let message = format!(
                "\"{}\" is a body, and so a set: choose another name",
                piece.name
            );
            return Err(context.error(&set.span, message));
        }
        let set = |name: String, members: Members| SetSpec {
            name,
            members: within(&piece.name, members),
        };
        sets.push(set(piece.name.clone(), Members::All));
        if let BodySpec::Cloud(cloud) = &piece.body {
            for name in sets::named(cloud) {
                if let Some(members) = sets::of_file(cloud, name) {
                    sets.push(set(format!("{}.{name}", piece.name), members));
                }
            }
        }
    }
    Ok(sets)
}

/// Names of the bodies that are made of a material.
pub(super) fn made_of<'a>(
    document: &'a Document,
    body: &'a BodySpec,
    material: &'a str,
) -> impl Iterator<Item = &'a str> {
    let all = body.pieces().iter().zip(written(document));
    all.filter(move |(_, at)| {
        at.value
            .material
            .as_ref()
            .is_some_and(|m| m.value == material)
    })
    .map(|(p, _)| p.name.as_str())
}

/// Gives each of several bodies its own horizon, influence function and family; the horizon of the first.
pub(super) fn own(
    context: &Context,
    document: &Document,
    all: &mut BodySpec,
    materials: &[MaterialSpec],
    sets: &[SetSpec],
) -> Result<Option<Horizon>> {
    let BodySpec::Several(pieces) = all else {
        return Ok(None);
    };
    for (piece, at) in pieces.iter_mut().zip(written(document)) {
        let linear = context.linear_bodies.get(&piece.name);
        let given = at.value.horizon.as_ref().or(document.horizon.as_ref());
        if let (Some(linear), None) = (linear, &at.value.horizon) {
            piece.horizon = Some(Horizon::Length(linear.range() * (1.0 + 1e-9)));
        } else if let Some(given) = given {
            piece.horizon = Some(horizon(context, given, &piece.body)?);
        } else {
            return Err(context.error_with(
                &at.span,
                format!("the body \"{}\" has no horizon", piece.name),
                "write horizon = { m_ratio = 3 }, or a length, in it or for all bodies above them",
            ));
        }
        // customary is that of its law
        let of_body = |m: &&MaterialSpec| {
            m.set == piece.name
                || sets.iter().any(|s| {
                    s.name == m.set
                        && matches!(&s.members, Members::Within { body, .. } if *body == piece.name)
                })
        };
        let material = materials.iter().find(of_body).or(materials.first());
        piece.influence = Some(influence(
            context,
            at.value.influence.as_ref().or(document.influence.as_ref()),
            material.map_or(&[], std::slice::from_ref),
        )?);
        if let Some(own) = &at.value.variable_horizon {
            piece.variable_horizon = Some(context.expression(own)?);
        }
        piece.family = match &at.value.family {
            None => None,
            Some(family) => Some(match family.value {
                FamilyName::Auto => FamilyChoice::Auto,
                FamilyName::Stencil => FamilyChoice::Stencil,
                FamilyName::List => FamilyChoice::List,
                FamilyName::Neighbours | FamilyName::Reference => {
                    return Err(context.error(
                        &family.span,
                        "this family belongs to atoms, which are a body of their own",
                    ));
                }
            }),
        };
    }
    Ok(pieces.first().and_then(|p| p.horizon))
}

/// Gives each of several bodies that have bonds its factors near the surface, or the only one.
pub(super) fn surfaces(context: &Context, document: &Document, spec: &mut Spec) -> Result<()> {
    if spec.body.pieces().is_empty() {
        if let Some(surface) = &document.surface {
            spec.bonds.surface = surface_factors(context, surface, spec)?;
        }
        return Ok(());
    }
    let named: Vec<Option<&At<SurfaceName>>> = written(document)
        .map(|at| at.value.surface.as_ref().or(document.surface.as_ref()))
        .collect();
    if named.iter().flatten().all(|s| s.value == SurfaceName::None) {
        return Ok(());
    }
    // who has no material is told when the model is made
    let Ok(materials) = materials_of_bodies(spec) else {
        return Ok(());
    };
    for (n, surface) in named.into_iter().enumerate() {
        let piece = &spec.body.pieces()[n];
        let Some(surface) = surface.filter(|_| piece.bonded) else {
            continue;
        };
        let mut own = spec.alone(piece);
        let of = |m: &usize| spec.materials[*m].clone();
        own.materials = materials[n].iter().map(of).collect();
        let factors = surface_factors(context, surface, &own)?;
        if let BodySpec::Several(pieces) = &mut spec.body {
            pieces[n].surface = factors;
        }
    }
    Ok(())
}

/// Keys of a body that only have a meaning where there are several, and materials that do not exist.
pub(super) fn check(context: &Context, document: &Document) -> Result<()> {
    for at in written(document) {
        let own = [
            ("horizon", at.value.horizon.as_ref().map(|h| &h.span)),
            ("influence", at.value.influence.as_ref().map(|i| &i.span)),
            ("family", at.value.family.as_ref().map(|f| &f.span)),
            (
                "variable_horizon",
                at.value.variable_horizon.as_ref().map(|e| &e.span),
            ),
            ("surface", at.value.surface.as_ref().map(|s| &s.span)),
        ];
        if let Some((key, span)) = own.iter().find_map(|(key, span)| Some((key, (*span)?)))
            && !several(document)
        {
            return Err(context.error_with(
                span,
                format!("a single body has the {key} of the deck"),
                format!("write {key} above [body]; with several [[body]] each may have its own"),
            ));
        }
        let Some(material) = &at.value.material else {
            continue;
        };
        if !several(document) {
            return Err(context.error_with(
                &material.span,
                "a single body has the materials of [material]",
                "leave it out; with several [[body]] each may name its own",
            ));
        }
        if !document.material.contains_key(&material.value) {
            let known = document.material.keys().map(String::as_str);
            let help = match nearest(&material.value, known) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!("write [material.{}]", material.value),
            };
            let message = format!("there is no material \"{}\"", material.value);
            return Err(context.error_with(&material.span, message, help));
        }
    }
    Ok(())
}
