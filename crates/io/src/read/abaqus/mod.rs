//! Abaqus input, and CalculiX's: nodes, elements, sets and surfaces; parts and their instances.
//!
//! What changes the mesh is read, or refused by its name. What says nothing of it (`silent`) is passed over; a keyword that is
//! neither is refused, for it may change the mesh. Names are those of their part, instance or assembly: a set of a part is one
//! of each instance, `INSTANCE.SET`, and `SET` alone where no other has that name.
//!
//! The mark of an element is the number (from 1; instances in their order, then the assembly) of the smallest element set that
//! holds it.

mod assembly;
mod element;
mod generate;
mod input;
mod keyword;
mod mesh;
mod model;
mod node;
mod set;
mod silent;

use super::body::Sourced;
use super::error::ReadError;
use super::lines::Lines;
use super::text_of;
use input::{Block, Deck};
use model::{Model, Of};
use std::path::Path;

/// A file, with those that it includes.
pub(super) fn read(path: &Path) -> Result<Sourced, ReadError> {
    let (text, name) = text_of(path)?;
    parse(&text, &name, path.parent())
}

/// The same from a text; `folder` is where files that it includes are.
pub(super) fn parse(text: &str, name: &str, folder: Option<&Path>) -> Result<Sourced, ReadError> {
    let deck = Deck::new(text, name, folder)?;
    let mut model = Model::new();
    deck.blocks(|block| keyword(block, &mut model))?;
    let lines = Lines::binary(name);
    assembly::close(&mut model).map_err(|message| lines.error(message))?;
    let made = mesh::mesh(&deck, &mut model)?;
    if made.mesh.nodes.is_empty() {
        return Err(lines.error("the file has no *NODE block"));
    }
    let dimension = made.mesh.cells.iter().map(|c| c.kind.dimension()).max();
    if let (Some(kind), Some(2)) = (made.shells, dimension) {
        return Err(lines.error(format!(
            "the elements {kind} are shells or membranes: a body is made of C3D, CPS or CPE elements"
        )));
    }
    let points = made.mesh.points(&lines);
    let mut points = points.map_err(|error| deck.located(error))?;
    for line in &mut points.lines {
        *line = line.checked_sub(1).map_or(0, |line| deck.number(line));
    }
    for (name, whole) in made.aliases {
        let cloud = &mut points.cloud;
        if cloud.sets.iter().any(|(known, _)| *known == whole) {
            continue;
        }
        let set = cloud.sets.iter().find(|(known, _)| *known == name);
        let set = set.map(|(_, ids)| ids.clone());
        let faces = cloud.faces.iter().find(|(known, _)| *known == name);
        let faces = faces.map(|(_, areas)| areas.clone());
        cloud.sets.extend(set.map(|ids| (whole.clone(), ids)));
        cloud.faces.extend(faces.map(|areas| (whole, areas)));
    }
    points.notes.splice(0..0, model.notes);
    Ok(points)
}

fn keyword(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    match &*block.keyword.name {
        "NODE" => node::nodes(block, model),
        "SYSTEM" => node::system(block, model),
        "NGEN" => generate::ngen(block, model),
        "NFILL" => generate::nfill(block, model),
        "NCOPY" => generate::ncopy(block, model),
        "ELEMENT" => element::elements(block, model),
        "ELGEN" => element::elgen(block, model),
        "ELCOPY" => element::elcopy(block, model),
        "NSET" => set::set(block, model, Of::Nodes),
        "ELSET" => set::set(block, model, Of::Elements),
        "SURFACE" => set::surface(block, model),
        "PART" => assembly::part(block, model),
        "ASSEMBLY" => assembly::assembly(block, model),
        "INSTANCE" => assembly::instance(block, model),
        "ENDPART" | "ENDINSTANCE" | "ENDASSEMBLY" => assembly::end(block, model),
        other => match silent::refusal(other) {
            None => Ok(()),
            Some(why) => {
                let shown = input::short(&block.keyword.shown);
                Err(block.error(format!("{shown} {why}")))
            }
        },
    }
}

#[cfg(test)]
mod tests;
