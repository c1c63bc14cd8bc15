//! Whether long work is to end.

use std::fmt;
use std::sync::Arc;

/// Asked within long sums: is the work to end? What it says once it says from then on.
#[derive(Clone)]
pub struct Stop(Arc<dyn Fn() -> bool + Send + Sync>);

impl Stop {
    pub fn new(asked: impl Fn() -> bool + Send + Sync + 'static) -> Stop {
        Stop(Arc::new(asked))
    }

    pub fn asked(&self) -> bool {
        (self.0)()
    }
}

impl Default for Stop {
    fn default() -> Stop {
        Stop::new(|| false)
    }
}

impl fmt::Debug for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Stop")
    }
}
