//! Where the points of a snapshot are, and which of them say nothing about the body.

use peridyne::observe::{Snapshot, Values};

/// Debris farther from the reference body than this part of its longest extent is not drawn.
pub const REACH: f64 = 0.3;
/// A point without bonds that has moved by so many spacings has flown away, if it is one of less than this part of all.
const LOOSE: f64 = 3.0;
const FEW: f64 = 0.05;

/// Bounds of the reference positions per axis, `[0, 0]` without points.
pub fn bounds(s: &Snapshot) -> [[f64; 2]; 3] {
    bounds_of(s.reference.iter())
}

/// Bounds of places per axis.
pub fn bounds_of<'a>(places: impl Iterator<Item = &'a [f64; 3]>) -> [[f64; 2]; 3] {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for x in places.filter(|x| x.iter().all(|c| c.is_finite())) {
        for (b, c) in bounds.iter_mut().zip(x) {
            *b = [b[0].min(*c), b[1].max(*c)];
        }
    }
    bounds.map(|b| if b[0] <= b[1] { b } else { [0.0; 2] })
}

/// Axes along which a body is thinnest, longest, and the third.
pub fn principal(bounds: &[[f64; 2]; 3]) -> [usize; 3] {
    let extent = bounds.map(|[low, high]| high - low);
    // equal extents differ by round-off and half cells: prefer z up and x to the right
    let tie = 1.02;
    let thin = [2, 1, 0].into_iter().reduce(|best, a| {
        if extent[a] * tie < extent[best] {
            a
        } else {
            best
        }
    });
    let thin = thin.unwrap_or(2);
    let long = (0..3).filter(|&a| a != thin);
    let long = long
        .reduce(|best, a| {
            if extent[a] > tie * extent[best] {
                a
            } else {
                best
            }
        })
        .unwrap_or(0);
    [thin, long, 3 - thin - long]
}

pub fn longest(bounds: &[[f64; 2]; 3]) -> f64 {
    bounds
        .iter()
        .map(|[low, high]| high - low)
        .fold(0.0, f64::max)
}

/// Positions with displacements so many times as large.
pub fn moved(s: &Snapshot, scale: f64) -> impl Iterator<Item = [f64; 3]> + Clone + '_ {
    let both = s.reference.iter().zip(s.displacement());
    both.map(move |(x, u)| std::array::from_fn(|a| x[a] + scale * u[a]))
}

/// Points that have flown away, and say nothing about the body: those farther from it than debris is drawn; and single points without
/// bonds that have moved more than a few spacings, as long as they are few.
pub fn strays(s: &Snapshot) -> Vec<bool> {
    let bounds = bounds(s);
    let reach = REACH * longest(&bounds) + s.spacing;
    let far = |x: &[f64; 3]| {
        (0..3).any(|a| !(x[a] >= bounds[a][0] - reach && x[a] <= bounds[a][1] + reach))
    };
    let mut strays: Vec<bool> = moved(s, 1.0).map(|x| far(&x)).collect();
    let damage = s.column("damage").and_then(|c| match &c.values {
        Values::Scalars(d) if d.len() == strays.len() => Some(d),
        _ => None,
    });
    let Some(damage) = damage else { return strays };
    let loose: Vec<usize> = { moved(s, 1.0).zip(&s.reference).enumerate() }
        .filter(|(i, (x, from))| {
            let square: f64 = (0..3).map(|a| (x[a] - from[a]).powi(2)).sum();
            damage[*i] >= 1.0 && square > (LOOSE * s.spacing).powi(2)
        })
        .map(|(i, _)| i)
        .collect();
    if (loose.len() as f64) < FEW * strays.len() as f64 {
        loose.into_iter().for_each(|i| strays[i] = true);
    }
    strays
}
