//! What can be run and looks wrong.

use super::context::Context;
use crate::deck::document::Document;
use std::ops::Range;

/// With the line that each is about.
pub(super) fn warnings(context: &Context, document: &Document) -> Vec<String> {
    let mut all = Vec::new();
    let mut warn = |span: &Range<usize>, text: String| {
        let place = context.error(span, "");
        let line = place.line.map_or(String::new(), |l| format!(":{l}"));
        all.push(format!("{}{line}: {text}", place.file));
    };
    let breaks = document
        .material
        .values()
        .any(|m| m.value.fracture.is_some());
    if let (Some(crack), Some(_), false) = (document.precrack.first(), &document.run, breaks) {
        let help = "give one fracture = { energy = \"10 J/m^2\" }";
        warn(
            &crack.span,
            format!("this crack never grows, as no material can break: {help}"),
        );
    }
    for (span, text) in context.unitless.borrow().iter() {
        warn(span, text.clone());
    }
    all
}
