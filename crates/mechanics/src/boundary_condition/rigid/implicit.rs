//! Bodies with mass in implicit steps, whose ends are sought.

use super::{Kept, Motion, NewmarkStep, Path, Rigid, Wrench, wrench};
use crate::space::{Point, length};

impl<const D: usize> Rigid<D> {
    /// The end of an implicit step from `start`, with `(m a, dL/dt)` at its two ends: places and momenta as Newmark's method has those of points, and
    /// turned by its own flow with the angular momentum `L + Δt ((½ − β) dL₀/dt + β dL₁/dt)`, which β = 0 makes that of explicit steps.
    pub fn step_implicitly(
        &mut self,
        start: &Kept,
        [before, after]: [&Wrench; 2],
        by: NewmarkStep,
    ) -> Path {
        let Motion::Free(free) = &mut self.motion else {
            return Path {
                way: 0.0,
                angle: 0.0,
            };
        };
        let NewmarkStep { beta, gamma, step } = by;
        let part =
            |k: usize, late: f64, all: f64| step * ((all - late) * before[k] + late * after[k]);
        let (center, axes) = (self.center, self.axes);
        for a in 0..D {
            let mean = start.velocity[a] + part(a, beta, 0.5) / free.mass;
            self.center[a] = start.center[a] + step * mean;
            self.velocity[a] = start.velocity[a] + part(a, gamma, 1.0) / free.mass;
        }
        free.turned = start.turned;
        if free.moments.iter().any(|i| i.is_finite()) {
            let spun = |late: f64, all: f64| -> Point {
                crate::array::from_fn(|a| start.spin[a] + part(3 + a, late, all))
            };
            free.spin = spun(beta, 0.5);
            free.turn(step);
            free.spin = spun(gamma, 1.0);
        }
        self.look();
        let way = length(&crate::array::from_fn(|a| self.center[a] - center[a]));
        let both = self.axes.as_flattened().iter().zip(axes.as_flattened());
        let square: f64 = both.map(|(x, y)| (x - y) * (x - y)).sum();
        // 2√2 sin(θ/2) is what axes differ by
        let angle = 2.0 * libm::asin((square / 8.0).sqrt().min(1.0));
        Path { way, angle }
    }

    /// `∂(m a, dL/dt)/∂(place, turn)` of an implicit step, `acceleration` = 1/(βΔt²): of a free body.
    pub fn inertia(&self, acceleration: f64) -> [[f64; 6]; 6] {
        let mut out = [[0.0; 6]; 6];
        let Motion::Free(free) = &self.motion else {
            return out;
        };
        let axes = free.turned.axes();
        for a in 0..3 {
            out[a][a] = acceleration * free.mass;
            for b in 0..3 {
                let each = (0..3).filter(|k| free.moments[*k].is_finite());
                let sum: f64 = each
                    .map(|k| axes[a][k] * free.moments[k] * axes[b][k])
                    .sum();
                out[3 + a][3 + b] = acceleration * sum;
            }
        }
        out
    }

    /// The least radius of gyration of a free body (length).
    pub fn gyration(&self) -> f64 {
        let Motion::Free(free) = &self.motion else {
            return 1.0;
        };
        let least = free.moments.iter().copied().fold(f64::INFINITY, f64::min);
        match least.is_finite() {
            true => (least / free.mass).sqrt(),
            false => 1.0,
        }
    }

    /// What acts on a free body at the last evaluation.
    pub fn wrench(&self) -> Wrench {
        match &self.motion {
            Motion::Free(free) => wrench(&free.force, &free.torque),
            Motion::Kinematic { .. } | Motion::Driven(_) => [0.0; 6],
        }
    }
}
