//! Why forces mean nothing, known to all ranks.

use crate::body::{Body, Field};
use crate::error::RunError;
use crate::interaction::Fault;
use crate::space::Point;

/// A state that a law has no answer to, with points by their numbers among those of all ranks.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct KnownFault {
    first: u64,
    /// Of two that went through each other; else 0, and the first has this density at this place.
    second: u64,
    position: Point,
    density: f64,
}

impl KnownFault {
    /// What this rank found at the displacements `u`.
    pub fn of<const D: usize>(fault: Fault, body: &Body<D>, u: &Field<D>) -> KnownFault {
        match fault {
            Fault::Crossing { i, j } => KnownFault {
                first: body.number(i),
                second: body.number(j),
                ..KnownFault::default()
            },
            Fault::Density { slot, density } => {
                let x = body.position(slot);
                let moved = |a: usize| if a < D { u[a][slot] } else { 0.0 };
                KnownFault {
                    first: body.number(slot),
                    position: crate::array::from_fn(|a| x[a] + moved(a)),
                    density,
                    ..KnownFault::default()
                }
            }
        }
    }

    /// The one with the lowest number of all ranks, which ask at once.
    pub fn of_all<const D: usize>(own: Option<Self>, body: &Body<D>) -> Option<KnownFault> {
        if !body.exchange().any(own.is_some()) {
            return None;
        }
        let all = body.all_of(&[own.unwrap_or_default().words()]).concat();
        let found = all.into_iter().filter(|words| words[0] > 0);
        let lowest = found.min_by_key(|words| words[0])?;
        let [first, second, x, y, z, density] = lowest;
        Some(KnownFault {
            first,
            second,
            position: [x, y, z].map(f64::from_bits),
            density: f64::from_bits(density),
        })
    }

    fn words(self) -> [u64; 6] {
        let [x, y, z] = self.position.map(f64::to_bits);
        [self.first, self.second, x, y, z, self.density.to_bits()]
    }

    /// In this step.
    pub fn explained(self, step: u64) -> RunError {
        match self.second {
            0 => RunError::Density {
                step,
                id: self.first,
                position: self.position,
                density: self.density,
            },
            j => RunError::Crossing {
                step,
                i: self.first,
                j,
            },
        }
    }
}
