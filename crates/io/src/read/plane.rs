//! Bodies of fewer than three dimensions leave coordinates out: those are the same at all points.

const AXES: [&str; 3] = ["x", "y", "z"];
/// Part of the body's size that is round-off of its file.
const ROUND_OFF: f64 = 1e-6;

/// Lowest and highest coordinates.
pub(crate) fn bounds<'a>(places: impl Iterator<Item = &'a [f64; 3]>) -> [[f64; 2]; 3] {
    let mut all = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for x in places {
        for (bound, c) in all.iter_mut().zip(x) {
            *bound = [bound[0].min(*c), bound[1].max(*c)];
        }
    }
    all
}

/// Is a coordinate the same at all places?
pub(crate) fn is_same<'a>(places: impl Iterator<Item = &'a [f64; 3]>, axis: usize) -> bool {
    let spread = bounds(places).map(|[low, high]| high - low);
    spread[axis] <= ROUND_OFF * spread.into_iter().fold(0.0, f64::max)
}

/// Do these places lie in x (1) or in x and y (2)?
///
/// # Errors
/// Which coordinate changes from place to place, and what to do about it.
pub(crate) fn lies<'a>(
    places: impl Iterator<Item = &'a [f64; 3]>,
    dimension: usize,
) -> Result<(), String> {
    let bounds = bounds(places);
    let spread = bounds.map(|[low, high]| high - low);
    let size = spread.into_iter().fold(0.0, f64::max);
    let same = |a: usize| spread[a] <= ROUND_OFF * size;
    let Some(off) = (dimension..3).find(|a| !same(*a)) else {
        return Ok(());
    };
    let [low, high] = bounds[off];
    let wanted = AXES[..dimension].join(" and ");
    let found = format!(
        "{} is not the same everywhere: it runs from {low} to {high}",
        AXES[off]
    );
    let own: Vec<&str> = (0..3).filter(|a| !same(*a)).map(|a| AXES[a]).collect();
    Err(match own.len() == dimension {
        true => format!(
            "{found}. It lies in {}, and a body in {dimension}-D lies in {wanted}: exchange the coordinates",
            own.join(" and "),
        ),
        false => format!(
            "{found}. A body in {dimension}-D lies in {wanted}: turn a plane that is tilted, take plates at several {} one by one, and what is no plane (a shell) makes no body",
            AXES[off]
        ),
    })
}
