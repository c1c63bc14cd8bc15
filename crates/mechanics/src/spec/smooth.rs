//! Smoothing: nodes that carry atoms along.

use std::sync::Arc;

/// A localization function of the vector from a point to a node, up to a factor.
#[derive(Clone)]
pub struct Window(Arc<dyn Fn([f64; 3]) -> f64 + Send + Sync>);

impl Window {
    pub fn new(of: impl Fn([f64; 3]) -> f64 + Send + Sync + 'static) -> Window {
        Window(Arc::new(of))
    }

    pub fn at(&self, d: [f64; 3]) -> f64 {
        (self.0)(d)
    }
}

impl std::fmt::Debug for Window {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Window")
    }
}

/// The atoms of a body are carried along by nodes.
#[derive(Debug, Clone)]
pub struct SmoothSpec {
    pub window: Window,
    /// What its width is called (length).
    pub width: f64,
    /// Where it is 0 (length).
    pub reach: f64,
    /// Of the nodes, on a square or cubic lattice (length); `None`: they are at the places of the atoms.
    pub spacing: Option<f64>,
}
