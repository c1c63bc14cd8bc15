//! Which points a coarse body retains.

use super::error::CoarsenError;
use super::near::Near;
use super::sublattice::Sublattice;
use peridyne::spec::LinearBody;

/// A choice of points.
#[derive(Debug, Clone, PartialEq)]
pub enum Selection<const D: usize> {
    /// Points of a lattice whose `(n − offset)` is a multiple of `every` along all axes, n counted from the lowest point in
    /// steps of the lattice along that axis.
    Every { every: [u32; D], offset: [u32; D] },
    /// Points that whole steps of k times the Bravais lattice lead to, from point `through`: of the lattice on which the points lie,
    /// of which some may be missing. On a square or cubic lattice every k-th along all axes; on a triangular or centred one a
    /// lattice of the same kind, with one of k^D points.
    Sublattice { every: u32, through: u32 },
    /// These.
    Marked(Vec<u32>),
    /// No two nearer than `spacing`, none farther from all: in an order drawn from a seed (a Poisson disk).
    BlueNoise { spacing: f64, seed: u64 },
    /// So many, each the farthest from those before; the first is drawn from a seed.
    Farthest { count: usize, seed: u64 },
}

impl<const D: usize> Selection<D> {
    /// Every k-th point of a lattice along all axes, the first included.
    pub fn every(k: u32) -> Selection<D> {
        Selection::Every {
            every: [k; D],
            offset: [0; D],
        }
    }

    /// The retained points of a body, ascending.
    ///
    /// # Errors
    /// The body is no lattice, or the choice is empty or meaningless.
    pub fn choose(&self, body: &LinearBody<D>) -> Result<Vec<u32>, CoarsenError> {
        let mut retained = match self {
            Selection::Every { every, offset } => every_nth(body, *every, *offset)?,
            Selection::Sublattice { every, through } => sublattice(body, *every, *through)?,
            Selection::Marked(marked) => marked.clone(),
            Selection::BlueNoise { spacing, seed } => blue_noise(body, *spacing, *seed)?,
            Selection::Farthest { count, seed } => farthest(body, *count, *seed)?,
        };
        retained.sort_unstable();
        check(&retained, body.points())?;
        Ok(retained)
    }
}

/// Are ascending retained points a choice among so many?
pub(super) fn check(retained: &[u32], points: usize) -> Result<(), CoarsenError> {
    match retained.last() {
        None => return Err(CoarsenError::Empty),
        Some(&index) if index as usize >= points => {
            return Err(CoarsenError::OutOfRange { index, points });
        }
        Some(_) => {}
    }
    match retained.windows(2).find(|w| w[0] == w[1]) {
        Some(w) => Err(CoarsenError::Twice(w[0])),
        None => Ok(()),
    }
}

/// Steps of the lattice along an axis, counted from the lowest point.
fn steps<const D: usize>(body: &LinearBody<D>, axis: usize) -> Result<Vec<i64>, CoarsenError> {
    let x = body.position.iter().map(|x| x[axis]);
    let mut sorted: Vec<f64> = x.clone().collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else {
        return Err(CoarsenError::Empty);
    };
    // coordinates that differ by round-off only are the same
    let same = 1e-7 * (high - low);
    let gaps = sorted.windows(2).map(|w| w[1] - w[0]).filter(|d| *d > same);
    let spacing = gaps.fold(f64::INFINITY, f64::min);
    if !spacing.is_finite() {
        return Ok(vec![0; body.points()]);
    }
    // the widest row of points tells the spacing best
    let spacing = (high - low) / ((high - low) / spacing).round();
    x.enumerate()
        .map(|(point, x)| {
            let n = (x - low) / spacing;
            let off = (n - n.round()).abs();
            match off < 1e-4 {
                true => Ok(n.round() as i64),
                false => Err(CoarsenError::NotLattice { axis, point, off }),
            }
        })
        .collect()
}

fn every_nth<const D: usize>(
    body: &LinearBody<D>,
    every: [u32; D],
    offset: [u32; D],
) -> Result<Vec<u32>, CoarsenError> {
    let mut kept = vec![true; body.points()];
    for axis in 0..D {
        if every[axis] == 0 {
            return Err(CoarsenError::EveryZero { axis });
        }
        let (k, first) = (i64::from(every[axis]), i64::from(offset[axis]));
        for (kept, n) in kept.iter_mut().zip(steps(body, axis)?) {
            *kept &= (n - first).rem_euclid(k) == 0;
        }
    }
    Ok((0..).zip(kept).filter(|k| k.1).map(|k| k.0).collect())
}

fn sublattice<const D: usize>(
    body: &LinearBody<D>,
    every: u32,
    through: u32,
) -> Result<Vec<u32>, CoarsenError> {
    if every == 0 {
        return Err(CoarsenError::EveryZero { axis: 0 });
    }
    check(&[through], body.points())?;
    let mut place = vec![[0; D]; body.points()];
    for axis in 0..D {
        for (place, n) in place.iter_mut().zip(steps(body, axis)?) {
            place[axis] = n;
        }
    }
    let first = place[through as usize];
    for n in &mut place {
        for a in 0..D {
            n[a] -= first[a];
        }
    }
    let lattice = Sublattice::spanned(place.iter().copied());
    let kept = |n: &[i64; D]| lattice.has_multiple(*n, i64::from(every));
    Ok((0..)
        .zip(&place)
        .filter(|k| kept(k.1))
        .map(|k| k.0)
        .collect())
}

/// Well-mixed bits of a number (splitmix64).
pub(super) fn mixed(x: u64) -> u64 {
    let mut z = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

fn blue_noise<const D: usize>(
    body: &LinearBody<D>,
    spacing: f64,
    seed: u64,
) -> Result<Vec<u32>, CoarsenError> {
    if !(spacing > 0.0 && spacing.is_finite()) {
        return Err(CoarsenError::Spacing(spacing));
    }
    let mut order: Vec<u32> = (0..body.points() as u32).collect();
    order.sort_by_key(|k| (mixed(seed ^ mixed(u64::from(*k))), *k));
    let mut near = Near::new(spacing, body.period);
    // open: points exactly a spacing apart may both stay
    let open = spacing * (1.0 - 1e-8);
    order.retain(|&k| {
        let x = body.position[k as usize];
        let free = near.within(x, open).is_empty();
        if free {
            near.push(x);
        }
        free
    });
    Ok(order)
}

fn farthest<const D: usize>(
    body: &LinearBody<D>,
    count: usize,
    seed: u64,
) -> Result<Vec<u32>, CoarsenError> {
    let points = body.points();
    if count == 0 || count > points {
        return Err(CoarsenError::Count { count, points });
    }
    let mut far = vec![f64::INFINITY; points];
    let mut next = (mixed(seed) % points as u64) as usize;
    let mut chosen = Vec::with_capacity(count);
    for _ in 0..count {
        chosen.push(next as u32);
        // a chosen point is never chosen again, not even among points at one place
        far[next] = -1.0;
        let newest = next;
        let mut best = -1.0;
        for (k, far) in far.iter_mut().enumerate() {
            if *far >= 0.0 {
                let d = body.xi(newest, k).iter().map(|x| x * x).sum();
                *far = far.min(d);
                if *far > best {
                    (best, next) = (*far, k);
                }
            }
        }
    }
    Ok(chosen)
}
