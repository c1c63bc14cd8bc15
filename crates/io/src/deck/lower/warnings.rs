//! What can be run and looks wrong.

use super::context::Context;
use crate::deck::document::Document;

/// With the line that each is about.
pub(super) fn warnings(context: &Context, document: &Document) -> Vec<String> {
    let mut all = Vec::new();
    let breaks = document
        .material
        .values()
        .any(|m| m.value.fracture.is_some());
    if let (Some(crack), Some(_), false) = (document.precrack.first(), &document.run, breaks) {
        let help = "give one fracture = { energy = \"10 J/m^2\" }";
        let text = format!("this crack never grows, as no material can break: {help}");
        all.push(context.source.remark(&crack.span, &text));
    }
    all.extend(context.lints.iter().cloned());
    all.extend(unitless(context));
    all.extend(context.kelvins());
    all
}

/// Numbers in quotes without a unit.
pub(in crate::deck) fn unitless(context: &Context) -> Vec<String> {
    let seen = context.unitless.borrow();
    let each = seen.iter();
    each.map(|(span, text)| context.source.remark(span, text))
        .collect()
}
