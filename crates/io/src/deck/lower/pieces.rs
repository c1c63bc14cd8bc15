//! One of several bodies, by its name.

use super::context::{Context, Result};
use crate::deck::error::nearest;
use crate::deck::value::At;
use peridyne::spec::{BodySpec, Members, PieceSpec};

/// Members of a body.
pub(super) fn within(body: &str, members: Members) -> Members {
    Members::Within {
        body: body.to_string(),
        members: Box::new(members),
    }
}

/// The body that a key names.
pub(super) fn named<'a>(
    context: &Context,
    name: &At<String>,
    body: &'a BodySpec,
) -> Result<&'a PieceSpec> {
    let pieces: &[PieceSpec] = match body {
        BodySpec::Several(pieces) => pieces,
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } | BodySpec::Cloud(_) => &[],
    };
    pieces.iter().find(|p| p.name == name.value).ok_or_else(|| {
        let message = format!("there is no body \"{}\"", name.value);
        let help = match nearest(&name.value, pieces.iter().map(|p| p.name.as_str())) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => "bodies have their names by name = \"NAME\" under [[body]]".into(),
        };
        context.error_with(&name.span, message, help)
    })
}
