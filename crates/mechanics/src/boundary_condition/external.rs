//! Values that somebody outside the engine answers whenever a condition asks: a function of a program that uses it.

/// Values of a list of points. Conditions ask for times around the step that they are at, one ahead among them, so these are values of
/// place and time alone, and the same whenever they are asked for.
pub trait ExternalValues: std::fmt::Debug + Send + Sync {
    /// On an axis, of a place in the list, at a time.
    fn at(&self, axis: usize, k: usize, t: f64) -> f64;
}
