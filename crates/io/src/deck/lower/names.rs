//! Names of the files that a deck asks for: each has its own, and none is that of a file of the results.

use super::context::{Context, Result};
use crate::deck::document::{Fields, Output};
use crate::deck::value::At;
use crate::write::folder::{collide, is_own};
use std::ops::Range;
use std::path::Path;

type Named<'a> = (&'static str, &'a str, &'a Range<usize>);

/// Files that keys of `[output]` name.
fn named(written: &Output) -> impl Iterator<Item = Named<'_>> {
    let names = [
        ("exodus", &written.exodus),
        ("vtkhdf", &written.vtkhdf),
        ("trajectory", &written.trajectory),
        ("dump", &written.dump),
        ("data", &written.data),
    ];
    let given = names.map(|(key, name)| name.as_ref().map(|n| (key, &*n.value, &n.span)));
    given.into_iter().flatten()
}

/// # Errors
/// Two are one file, or one is a file of the results.
pub(super) fn distinct(context: &Context, written: &Output) -> Result<()> {
    let all: Vec<Named> = named(written).collect();
    for (k, (key, name, span)) in all.iter().enumerate() {
        let path = Path::new(name);
        if is_own(path) || name.ends_with(".png") {
            return Err(context.error_with(
                span,
                format!("{name:?} is the name of a file of the results"),
                format!("give the {key} another name"),
            ));
        }
        let one = |(_, other, _): &&Named| collide(path, Path::new(other));
        if let Some((other, ..)) = all[..k].iter().find(one) {
            return Err(context.error_with(
                span,
                format!("the {key} and the {other} are one file"),
                "drop one of them, or give them different names",
            ));
        }
    }
    Ok(())
}

/// # Errors
/// The folder of a field is a file, or has one in it.
pub(super) fn folders(context: &Context, written: &Output, fields: &[At<Fields>]) -> Result<()> {
    for at in fields {
        let (name, span) = match &at.value.name {
            Some(name) => (&*name.value, &name.span),
            None => ("fields", &at.span),
        };
        let path = Path::new(name);
        let one = |(_, other, _): &Named| collide(path, Path::new(other));
        let file = named(written).find(one).map(|(key, ..)| key);
        let file = file.or_else(|| is_own(path).then_some("file of the results"));
        if let Some(other) = file {
            return Err(context.error_with(
                span,
                format!("the folder {name:?} of [[fields]] and the {other} are in one place"),
                "give the fields another name",
            ));
        }
    }
    Ok(())
}
