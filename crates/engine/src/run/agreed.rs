//! Mistakes that only one rank may find.

use crate::body::Body;
use crate::error::{BuildError, BuildErrorKind};
use peridyne_comm::Comm;

/// What this rank made; where one could not, all know. All ranks come here at once.
///
/// # Errors
/// The mistake, on the first rank that found one; that another rank has, on the others.
pub(super) fn agreed<const D: usize, T>(
    body: &Body<D>,
    made: Result<T, BuildError>,
) -> Result<T, BuildError> {
    match body.subdomain() {
        Some(of) => agreed_among(of.comm(), made),
        None => made,
    }
}

/// The same of ranks without a body.
///
/// # Errors
/// The same.
pub(super) fn agreed_among<T>(comm: &Comm, made: Result<T, BuildError>) -> Result<T, BuildError> {
    let own = { made.as_ref().err() }.is_some_and(|e| e.kind != BuildErrorKind::Elsewhere);
    let all = comm.all_as_long(&[u8::from(own)]);
    let all = all.unwrap_or_else(|failure| comm.end(failure));
    match all.iter().position(|failed| *failed == 1) {
        Some(first) if first != comm.rank() => Err(BuildError::elsewhere(first)),
        Some(_) | None => made,
    }
}
