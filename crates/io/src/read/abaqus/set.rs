//! `*NSET`, `*ELSET` and `*SURFACE`.

use super::super::error::ReadError;
use super::input::{Block, Rows};
use super::keyword::Label;
use super::model::{MEMBER, Model, Of, Place, Surface, of_scope};

/// `*NSET` and `*ELSET`: numbers, names of other sets, ranges, or the nodes of a set of elements.
pub(super) fn set(block: &Block, model: &mut Model, of: Of) -> Result<(), ReadError> {
    let own = match of {
        Of::Nodes => "NSET",
        Of::Elements => "ELSET",
    };
    let elements = if of == Of::Nodes { "ELSET" } else { own };
    block.only(&[
        own, elements, "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED",
    ])?;
    let Some(label) = block.label(own) else {
        return Err(block.error(format!("{} needs {own}=", block.keyword.shown)));
    };
    let instance = instance(block, model)?;
    let members = match block.keyword.value("ELSET").filter(|_| of == Of::Nodes) {
        Some(elements) => nodes_of(block, model, elements, instance)?,
        None => members(block, model, of, instance)?,
    };
    let unsorted = block.keyword.has("UNSORTED");
    let set = model.here().add(of, label, members, unsorted);
    set.internal |= block.keyword.has("INTERNAL");
    Ok(())
}

fn instance(block: &Block, model: &Model) -> Result<Option<usize>, ReadError> {
    let Some(label) = block.label("INSTANCE") else {
        return Ok(None);
    };
    if model.place != Place::Model {
        return Err(block.error("INSTANCE= stands in the assembly, not in a part or instance"));
    }
    // the assembly may stand before it
    let name = label.key.rsplit('.').next().unwrap_or("");
    let found = model.instance(&label.key).or_else(|| model.instance(name));
    match found {
        Some(scope) => Ok(Some(scope)),
        None => Err(block.error(format!("there is no instance {}", label.shown))),
    }
}

fn members(
    block: &Block,
    model: &mut Model,
    of: Of,
    instance: Option<usize>,
) -> Result<Vec<u64>, ReadError> {
    let mut members = Vec::new();
    let mut rows = block.rows();
    while rows.next() {
        if block.keyword.has("GENERATE") {
            let range = range(&rows, of)?;
            model.generate(&rows, range.len(), MEMBER)?;
            members.extend(range.map(|m| of_scope(instance.unwrap_or(0), m)));
            continue;
        }
        for k in 0..rows.fields.len() {
            let Some(text) = rows.field(k) else { continue };
            let found = model.named(text, of, instance);
            let found = found.map_err(|message| rows.error(message))?;
            if found.len() > 1 {
                model.generate(&rows, found.len(), MEMBER)?;
            }
            members.extend(found);
        }
    }
    Ok(members)
}

fn range(rows: &Rows, of: Of) -> Result<impl ExactSizeIterator<Item = u64> + use<>, ReadError> {
    let what = match of {
        Of::Nodes => "node",
        Of::Elements => "element",
    };
    let first = rows.number(0, &format!("the first {what}"))?;
    let last = rows.number(1, &format!("the last {what}"))?;
    let step = rows.whole(2, "the step")?.unwrap_or(1usize);
    if rows.any(3..rows.fields.len()) || step == 0 || last < first || last - first > 1 << 24 {
        return Err(rows.error("expected first, last, step with first ≤ last, a step above 0 and at most 16 million members"));
    }
    let count = (last - first) as usize / step + 1;
    Ok((0..count).map(move |k| first + (k * step) as u64))
}

fn nodes_of(
    block: &Block,
    model: &Model,
    elements: &str,
    instance: Option<usize>,
) -> Result<Vec<u64>, ReadError> {
    let found = model.named(elements, Of::Elements, instance);
    let mut nodes = Vec::new();
    for number in found.map_err(|message| block.error(message))? {
        let Some((scope, element)) = model.element(number) else {
            return Err(block.error(format!(
                "an element of {} is not defined before this line: put *NSET after its elements",
                super::input::short(elements)
            )));
        };
        nodes.extend(element.nodes.iter().map(|n| of_scope(scope, *n)));
    }
    Ok(nodes)
}

/// `*SURFACE`: sides of elements, or nodes. What is looked up is looked up when the file is read: sets may follow.
pub(super) fn surface(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    let Some(label) = block.label("NAME") else {
        return Err(block.error("*SURFACE needs NAME="));
    };
    let kind = block.keyword.value("TYPE").map(str::to_uppercase);
    let of = match kind.as_deref() {
        Some("NODE") => Of::Nodes,
        _ => Of::Elements,
    };
    let mut unread = block.keyword.other(&["NAME", "TYPE", "INTERNAL"]);
    if !matches!(kind.as_deref(), None | Some("NODE" | "ELEMENT")) {
        unread = kind.as_deref();
    }
    let mut surface = Surface {
        label,
        of,
        rows: Vec::new(),
        unread: unread.map(str::to_string),
    };
    let mut rows = block.rows();
    while surface.unread.is_none() && rows.next() {
        let field = |k: usize| rows.field(k).unwrap_or("").to_string();
        surface
            .rows
            .push((field(0), Label::new(&field(1)).key, rows.at));
    }
    let here = model.here();
    match here
        .surfaces
        .iter_mut()
        .find(|s| s.label.key == surface.label.key)
    {
        Some(known) if known.of == of => known.rows.append(&mut surface.rows),
        _ => here.surfaces.push(surface),
    }
    Ok(())
}
