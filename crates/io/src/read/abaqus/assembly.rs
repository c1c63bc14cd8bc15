//! Parts, and their instances in the assembly.

use super::super::error::ReadError;
use super::generate::shift;
use super::input::Block;
use super::keyword::Label;
use super::model::{Frame, ITEM, Model, Place, Scope};

fn label(block: &Block, option: &str) -> Result<Label, ReadError> {
    let label = Label::new(block.needed(option)?);
    match label.key.is_empty() {
        true => Err(block.error(format!("{} needs {option}=", block.keyword.shown))),
        false => Ok(label),
    }
}

fn outside(block: &Block, model: &Model) -> Result<(), ReadError> {
    if model.place == Place::Model {
        return Ok(());
    }
    let open = unended(model);
    Err(block.error(format!("{} stands inside {open}", block.keyword.shown)))
}

/// What has begun and not ended.
pub(super) fn unended(model: &Model) -> String {
    let (what, scope) = match model.place {
        Place::Model => return String::new(),
        Place::Part(p) => ("part", &model.parts[p]),
        Place::Instance(s) => ("instance", &model.scopes[s]),
    };
    let name = scope.label.as_ref().map_or("", |l| &l.shown);
    format!(
        "the {what} {name}, which has no *END {}",
        what.to_uppercase()
    )
}

pub(super) fn part(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&["NAME"])?;
    outside(block, model)?;
    let label = label(block, "NAME")?;
    let same = |s: &Scope| s.label.as_ref() == Some(&label);
    if model.parts.iter().any(same) {
        return Err(block.error(format!("there are two parts {}", label.shown)));
    }
    model.place = Place::Part(model.parts.len());
    model.parts.push(Scope {
        label: Some(label),
        ..Scope::default()
    });
    Ok(())
}

pub(super) fn assembly(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&["NAME"])?;
    outside(block, model)?;
    if model.assembly.is_some() {
        return Err(block.error("there are two *ASSEMBLY"));
    }
    model.assembly = Some(Label::new(
        block.keyword.value("NAME").unwrap_or("Assembly"),
    ));
    Ok(())
}

/// `*INSTANCE`: a copy of a part, shifted, then turned about an axis of the assembly.
pub(super) fn instance(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&["NAME", "PART"])?;
    outside(block, model)?;
    let (name, part) = (label(block, "NAME")?, label(block, "PART")?);
    if model.instance(&name.key).is_some() {
        return Err(block.error(format!("there are two instances {}", name.shown)));
    }
    let named = |s: &Scope| s.label.as_ref().is_some_and(|l| l.key == part.key);
    let Some(at) = model.parts.iter().position(named) else {
        return Err(block.error(format!("there is no part {} before this line", part.shown)));
    };
    let size = model.parts[at].nodes.len() + model.parts[at].elements.len();
    model.generate(&block.rows(), size, ITEM)?;
    let (along, turned) = shift(&mut block.rows(), 1.0)?;
    let turned = turned.unwrap_or(Frame::NONE);
    model.frame = Some(Frame {
        origin: turned.apply(&along),
        ..turned
    });
    model.used.insert(at);
    model.place = Place::Instance(model.scopes.len());
    model.scopes.push(Scope {
        label: Some(name),
        // coordinates of *SYSTEM are those of the part
        system: None,
        ..model.parts[at].clone()
    });
    Ok(())
}

/// `*END PART`, `*END INSTANCE`, `*END ASSEMBLY`.
pub(super) fn end(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&["NAME"])?;
    match (&*block.keyword.name, model.place) {
        ("ENDASSEMBLY", _) => return outside(block, model),
        ("ENDPART", Place::Part(_)) => {}
        ("ENDINSTANCE", Place::Instance(_)) => {
            let frame = model.frame.take().unwrap_or(Frame::NONE);
            for x in model.here().nodes.values_mut() {
                *x = frame.apply(x);
            }
        }
        _ => {
            let begin = block.keyword.shown.replacen("END ", "", 1);
            return Err(block.error(format!("{} without {begin}", block.keyword.shown)));
        }
    }
    model.place = Place::Model;
    Ok(())
}

/// What a file without an assembly has as its model: a part alone is one.
pub(super) fn close(model: &mut Model) -> Result<(), String> {
    if model.place != Place::Model {
        return Err(format!("the file ends within {}", unended(model)));
    }
    let name = |s: &Scope| s.label.as_ref().map_or(String::new(), |l| l.shown.clone());
    if model.scopes.len() > 1 {
        for (p, part) in model.parts.iter().enumerate() {
            if !model.used.contains(&p) {
                model.notes.push(format!(
                    "the part {} has no instance: it is no part of the body",
                    name(part)
                ));
            }
        }
        return Ok(());
    }
    if model.assembly.is_some() && !model.parts.is_empty() {
        return Err("the *ASSEMBLY has no *INSTANCE of a part".into());
    }
    match model.parts.len() {
        0 => Ok(()),
        1 => {
            model.scopes.append(&mut model.parts);
            Ok(())
        }
        _ => Err(format!(
            "the parts {} have no *INSTANCE: an *ASSEMBLY says which there are, and where",
            model.parts.iter().map(name).collect::<Vec<_>>().join(", ")
        )),
    }
}
