//! Which program a deck is of.

/// Which program a deck is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Program {
    Peridigm,
    PeriLab,
}
