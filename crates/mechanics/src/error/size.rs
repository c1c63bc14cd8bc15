//! Sizes for people.

/// Bytes for readers.
pub fn size(bytes: f64) -> String {
    match bytes {
        b if b >= 1e12 => format!("{:.3} TB", b / 1e12),
        b if b >= 1e9 => format!("{:.1} GB", b / 1e9),
        b => format!("{:.0} MB", b / 1e6),
    }
}
