//! Which variables the expressions of a law are given, and what happens where they name others.

use crate::deck::lower::context::{Context, Result};
use crate::deck::value::{At, Number, Written};
use peridyne::expression::Expression;
use peridyne_transport::Grid;

/// Coordinates of a grid.
pub(super) fn places(grid: &Grid) -> &'static [&'static str] {
    match grid.dimension {
        1 => &["x"],
        _ => &["x", "y"],
    }
}

/// What expressions of a deck may name; no constant hides them.
const PLACE_AND_TIME: [&str; 4] = ["x", "y", "z", "t"];

/// Words of an expression with their places.
fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let letter = |c: char| c.is_alphanumeric() || c == '_';
    let mut at = 0;
    std::iter::from_fn(move || {
        let start = at + text[at..].find(letter)?;
        let rest = &text[start..];
        let end = rest.find(|c: char| !letter(c)).unwrap_or(rest.len());
        at = start + end;
        Some((start, &rest[..end]))
    })
}

/// Refuses what is given no value: coordinates and a time that `what` is no function of.
pub(super) fn only_names(
    context: &Context,
    written: &Number,
    given: &[&str],
    what: &str,
) -> Result<()> {
    let Written::Text(text) = &written.value else {
        return Ok(());
    };
    let given_up = |w: &str| PLACE_AND_TIME.contains(&w) && !given.contains(&w);
    match words(text).find(|(_, w)| given_up(w)) {
        None => Ok(()),
        Some((_, word)) => {
            let names = given.join(", ");
            Err(context.error_with(
                &written.span,
                format!("{what} is a function of {names} alone, and names {word}"),
                format!("write it with {names} and constants"),
            ))
        }
    }
}

/// An expression of one variable, which stands in the place of the coordinate `slot`: both have one letter, so that places in the text stay. With the text as it is then.
pub(super) fn of_one_variable(
    context: &Context,
    written: &At<String>,
    variable: &str,
    slot: char,
    more: &[(&str, f64)],
) -> Result<(Expression, String)> {
    let constants = context.plain_constants();
    let hidden = |name: &str, value: Option<f64>| {
        let found = constants.iter().find(|(n, _)| *n == name);
        found.is_some_and(|(_, v)| value != Some(*v))
    };
    if hidden(variable, None) {
        return Err(context.error_with(
            &written.span,
            format!("{variable} is what this is a function of, and a constant of the deck"),
            "give the constant another name",
        ));
    }
    if let Some((name, value)) = more.iter().find(|(n, v)| hidden(n, Some(*v))) {
        return Err(context.error_with(
            &written.span,
            format!("{name} is {value} here, and another number among the constants of the deck"),
            "give the constant another name",
        ));
    }
    let mut text = String::new();
    let mut last = 0;
    for (at, word) in words(&written.value) {
        if PLACE_AND_TIME.contains(&word) && word != variable {
            return Err(context.error_with(
                &written.span,
                format!("this is a function of {variable} alone, and names {word}"),
                format!("write it with {variable} and constants"),
            ));
        }
        text += &written.value[last..at];
        match word == variable {
            true => text.push(slot),
            false => text += word,
        }
        last = at + word.len();
    }
    text += &written.value[last..];
    let expression = context.plain_expression(&text, &written.span, more)?;
    Ok((expression, text))
}
