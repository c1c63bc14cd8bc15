//! Named sets of points.

use super::context::{Context, Result};
use super::region::region;
use crate::deck::document::{Block, Set};
use crate::deck::error::nearest;
use crate::deck::value::At;
use peridyne::spec::{BodySpec, Cloud, Members, SetSpec};
use std::collections::BTreeMap;

/// The named sets, and one for each named mark of the file that the deck does not name itself.
pub(super) fn sets(
    context: &Context,
    written: &BTreeMap<String, At<Set>>,
    body: &BodySpec,
) -> Result<Vec<SetSpec>> {
    let mut sets = Vec::new();
    for (name, set) in written {
        if name == "all" {
            return Err(context.error(
                &set.span,
                "the set \"all\" exists already: choose another name",
            ));
        }
        let given = [
            ("region", set.value.region.is_some()),
            ("block", set.value.block.is_some()),
            ("where", set.value.r#where.is_some()),
            ("basis", set.value.basis.is_some()),
            ("random", set.value.random.is_some()),
        ];
        context.one_of(&set.span, &format!("the set \"{name}\""), &given)?;
        let piece = match &set.value.body {
            Some(name) => Some(super::pieces::named(context, name, body)?),
            None => None,
        };
        let of = piece.map_or(body, |p| &p.body);
        if piece.is_some() && given.iter().all(|(_, given)| !given) {
            let help = "add region, block or where; the body itself is a set of its name";
            return Err(context.error_with(&set.span, "all points of a body", help));
        }
        let members = match (&set.value.region, &set.value.block, &set.value.r#where) {
            _ if let Some(sites) = &set.value.basis => sublattice(context, sites, of)?,
            _ if let Some(drawn) = &set.value.random => {
                if let Some(piece) = &set.value.body {
                    let message = "points are drawn from all bodies: leave `body` out";
                    return Err(context.error(&piece.span, message));
                }
                Members::Random {
                    part: context.value(&drawn.value.part)?,
                    seed: drawn.value.seed,
                }
            }
            (Some(shape), _, _) => Members::Region(region(context, shape)?),
            (_, Some(mark), _) => marked(context, mark, of)?,
            (_, _, Some(text)) => Members::Where(context.expression(text)?),
            (None, None, None) => Members::All,
        };
        sets.push(SetSpec {
            name: name.clone(),
            members: match piece {
                Some(piece) => super::pieces::within(&piece.name, members),
                None => members,
            },
        });
    }
    if let BodySpec::Cloud(cloud) = body {
        for name in named(cloud) {
            if name != "all"
                && !written.contains_key(name)
                && let Some(members) = of_file(cloud, name)
            {
                sets.push(SetSpec {
                    name: name.to_string(),
                    members,
                });
            }
        }
    }
    Ok(sets)
}

/// Names of the file's sets and marks.
pub(super) fn named(cloud: &Cloud) -> Vec<&str> {
    let sets = cloud.sets.iter().map(|(name, _)| name.as_str());
    let mut names: Vec<&str> = sets.collect();
    for (_, name) in &cloud.names {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names
}

/// The points that the file gives a name: a set knows all of them, a mark only those that have no other.
pub(super) fn of_file(cloud: &Cloud, name: &str) -> Option<Members> {
    let set = cloud.sets.iter().find(|(known, _)| known == name);
    let mark = || cloud.names.iter().find(|(_, known)| known == name);
    set.map(|(_, ids)| Members::Points(ids.clone()))
        .or_else(|| mark().map(|(mark, _)| Members::Mark(*mark)))
}

/// Points on sites of the cell of a lattice.
fn sublattice(context: &Context, sites: &At<Vec<At<usize>>>, body: &BodySpec) -> Result<Members> {
    let kind = match body {
        BodySpec::Lattice {
            kind,
            perturb: None,
            ..
        }
        | BodySpec::Sites { kind, .. } => *kind,
        BodySpec::Lattice { .. } | BodySpec::Cloud(_) | BodySpec::Several(_) => {
            return Err(context.error_with(
                &sites.span,
                "basis is for a lattice that is not perturbed: other points lie on no sites of a cell",
                "say region, where or block instead",
            ));
        }
    };
    let count = kind.basis().len();
    if let Some(wrong) = sites.value.iter().find(|n| !(1..=count).contains(&n.value)) {
        let message = format!(
            "the cell of a {} lattice has {count} site{}, there is no site {}",
            kind.name(),
            if count == 1 { "" } else { "s" },
            wrong.value
        );
        let help = "sites are counted from 1; what repeats in larger cells is an expression, such as \
                    where = \"floor(x/a + 0.5) - 2*floor(0.5*floor(x/a + 0.5)) > 0.5\"";
        return Err(context.error_with(&wrong.span, message, help));
    }
    if sites.value.is_empty() {
        return Err(context.error(&sites.span, "no sites, no points"));
    }
    Ok(Members::Basis(
        sites.value.iter().map(|n| n.value - 1).collect(),
    ))
}

fn marked(context: &Context, mark: &At<Block>, body: &BodySpec) -> Result<Members> {
    let cloud = match body {
        BodySpec::Cloud(cloud) => cloud,
        BodySpec::Several(_) => {
            return Err(context.error_with(
                &mark.span,
                "each of several bodies has blocks of its own",
                "say whose: body = \"NAME\"",
            ));
        }
        BodySpec::Lattice { .. } | BodySpec::Sites { .. } => {
            return Err(context.error(&mark.span, "a lattice has no blocks: say region instead"));
        }
    };
    match &mark.value {
        Block::Number(number) => Ok(Members::Mark(*number)),
        Block::Name(name) => of_file(cloud, name).ok_or_else(|| {
            let known = named(cloud);
            let help = match nearest(name, known.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!(
                    "the file names: {}",
                    if known.is_empty() {
                        "none".into()
                    } else {
                        known.join(", ")
                    }
                ),
            };
            context.error_with(
                &mark.span,
                format!("the file has no block \"{name}\""),
                help,
            )
        }),
    }
}
