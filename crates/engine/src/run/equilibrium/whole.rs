//! What is brought together of all ranks' points on the first, and what that one finds there.

use crate::body::Body;
use crate::error::SolveError;
use crate::statics::Support;

/// What the first rank found; where it found nothing the others know.
pub(in crate::run) fn told<const D: usize, T>(
    body: &Body<D>,
    found: Result<Option<T>, SolveError>,
) -> Result<Option<T>, SolveError> {
    let failed = body.is_first().then_some(u8::from(found.is_err()));
    match body.told(failed) == 1 {
        true => found.and(Err(SolveError::Elsewhere)),
        false => found,
    }
}

/// What holds the points of all ranks, on the first.
pub(in crate::run) fn whole_support<const D: usize>(
    body: &Body<D>,
    support: &Support<D>,
) -> Option<Support<D>> {
    let free = support.free.as_flattened().iter().copied();
    let free = body.whole(D, free.map(u8::from).collect())?;
    let free = free.as_chunks().0.iter();
    Some(Support {
        free: free.map(|of: &[u8; D]| of.map(|free| free == 1)).collect(),
    })
}

/// Vectors of all ranks' points, on the first.
pub(in crate::run) fn whole_vectors<const D: usize>(
    body: &Body<D>,
    own: &[[f64; D]],
) -> Option<Vec<[f64; D]>> {
    let whole = body.whole(D, own.as_flattened().to_vec())?;
    Some(whole.as_chunks().0.to_vec())
}

/// Those of the points that are here, of what the first rank has of all.
pub(in crate::run) fn part_of_vectors<const D: usize>(
    body: &Body<D>,
    whole: Option<Vec<[f64; D]>>,
) -> Vec<[f64; D]> {
    let part = body.part_of(D, whole.map(Vec::into_flattened));
    part.as_chunks().0.to_vec()
}

/// Components of all ranks' points that are free.
pub(in crate::run) fn unknowns<const D: usize>(body: &Body<D>, support: &Support<D>) -> usize {
    body.count(support.unknowns() as u64) as usize
}
