//! Points of several bodies, on all ranks, that are near points of others.

use crate::body::Body;

/// A point: its id among all, its body, and its place.
pub(super) type Placed<const D: usize> = (u32, usize, [f64; D]);

/// Points of some of several bodies: those of this rank in the order of ids, how many these are, and after them those of other ranks that may be within `reach`
/// (length) of points of other bodies that this rank has: within it of the boxes that its points of each body lie in. All ranks ask at once.
pub(super) fn points_near<const D: usize>(
    body: &Body<D>,
    reach: f64,
    of: impl Fn(usize) -> bool,
) -> (Vec<Placed<D>>, usize) {
    let own = body.slots().iter().enumerate().map(|(id, s)| {
        let (s, x) = (*s as usize, body.position(*s as usize));
        let place = crate::array::from_fn(|a| x[a]);
        (body.id_of_all(id) as u32, body.piece_of(s), place)
    });
    let mut points: Vec<Placed<D>> = own.filter(|point| of(point.1)).collect();
    let own = points.len();
    points.extend(others_near(body, &points, reach));
    (points, own)
}

fn others_near<const D: usize>(body: &Body<D>, own: &[Placed<D>], reach: f64) -> Vec<Placed<D>> {
    let Some(of) = body.subdomain() else {
        return vec![];
    };
    let mut boxes = vec![[[f64::INFINITY; D], [f64::NEG_INFINITY; D]]; body.pieces().len()];
    for (_, n, x) in own {
        let [low, high] = &mut boxes[*n];
        for a in 0..D {
            (low[a], high[a]) = (low[a].min(x[a]), high[a].max(x[a]));
        }
    }
    let ends: Vec<f64> = boxes.iter().flatten().flatten().copied().collect();
    let period = body.period();
    let is_near = |x: &[f64; D], (low, high): &(&[f64], &[f64])| {
        (0..D).all(|a| {
            let mut off = x[a] - 0.5 * (low[a] + high[a]);
            if let Some(p) = period[a] {
                off -= (off / p).round() * p;
            }
            // round-off leaves nobody out
            off.abs() <= 0.5 * (high[a] - low[a]) + 1.001 * reach
        })
    };
    let told = { body.all_of(&ends).into_iter().enumerate() }.map(|(rank, ends)| {
        if rank == of.comm().rank() {
            return vec![];
        }
        let each = ends.chunks_exact(2 * D).map(|ends| ends.split_at(D));
        let boxes: Vec<_> = { each.enumerate() }
            .filter(|(_, (low, high))| low[0] <= high[0])
            .collect();
        let wanted = own.iter().filter(|(_, n, x)| {
            let mut others = boxes.iter().filter(|(m, _)| m != n);
            others.any(|(_, ends)| is_near(x, ends))
        });
        let words = wanted.flat_map(|(id, n, x)| [f64::from(*id), *n as f64].into_iter().chain(*x));
        words.flat_map(f64::to_le_bytes).collect()
    });
    let told = of.comm().to_each(told.collect());
    let told = told.unwrap_or_else(|failure| of.comm().end(failure));
    let told = told.concat();
    let words = told.as_chunks::<8>().0.iter();
    let words: Vec<f64> = words.map(|bytes| f64::from_le_bytes(*bytes)).collect();
    let each = words.chunks_exact(2 + D);
    let point = |of: &[f64]| {
        let place = crate::array::from_fn(|a| of[2 + a]);
        (of[0] as u32, of[1] as usize, place)
    };
    each.map(point).collect()
}
