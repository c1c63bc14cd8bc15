//! Velocity Verlet: `v += ½Δt f/ρ; u += Δt v; forces; v += ½Δt f/ρ`.
//!
//! The last half kick of a step waits for the first one of the next and both run in one pass, added one after the
//! other, so that asking for velocities in between changes no bit.

use crate::body::{Body, Field, Values};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::{Kernel, Simd};
use crate::execute::{Shared, for_each_block};

/// Slots per block of work.
const BLOCK: usize = 1024;

/// How far the fastest point went in one pass: squared length, and not a number if any point's is.
pub type Fastest = f64;

pub struct Verlet {
    simd: Simd,
    fastest: Vec<Fastest>,
}

impl Verlet {
    pub fn new<const D: usize>(simd: Simd, body: &Body<D>) -> Self {
        Verlet {
            simd,
            fastest: vec![0.0; body.len().div_ceil(BLOCK)],
        }
    }

    /// Kick (twice if `pending`) and drift. Points whose step is not below `limit` (length) stay where they are.
    /// Returns the largest step of a point, squared; not a number or ≥ `limit²` if the pass refused a point.
    #[allow(clippy::too_many_arguments)] // the state, and how to step it
    pub fn advance<const D: usize>(
        &mut self,
        body: &Body<D>,
        u: &mut Field<D>,
        v: &mut Field<D>,
        f: &Field<D>,
        dt: f64,
        pending: bool,
        limit: f64,
    ) -> Fastest {
        let kernel = Advance {
            u: crate::array::from_fn(|a| Shared(u[a].as_mut_ptr())),
            v: crate::array::from_fn(|a| Shared(v[a].as_mut_ptr())),
            f,
            density: body.density(),
            len: body.len(),
            dt,
            pending,
            limit: limit * limit,
        };
        for_each_block(self.simd, &kernel, &mut self.fastest);
        // what is not a number stays, whatever the blocks after it say
        self.fastest
            .iter()
            .fold(0.0, |m, x| if m.is_nan() || *x <= m { m } else { *x })
    }

    /// The waiting half kick.
    pub fn kick<const D: usize>(
        &mut self,
        body: &Body<D>,
        v: &mut Field<D>,
        f: &Field<D>,
        dt: f64,
    ) {
        for a in 0..D {
            for i in 0..body.len() {
                v[a][i] = (0.5 * dt / body.density().at(i)).mul_add(f[a][i], v[a][i]);
            }
        }
    }

    /// Undo the last [`Verlet::advance`] up to round-off, for a step that was refused.
    pub fn retreat<const D: usize>(
        &self,
        body: &Body<D>,
        u: &mut Field<D>,
        v: &mut Field<D>,
        f: &Field<D>,
        dt: f64,
        limit: f64,
    ) {
        for &s in body.slots() {
            let i = s as usize;
            let step: [f64; D] = crate::array::from_fn(|a| dt * v[a][i]);
            if step.iter().map(|d| d * d).sum::<f64>() < limit * limit {
                for a in 0..D {
                    u[a][i] -= step[a];
                }
            }
            for a in 0..D {
                let back = 0.5 * dt / body.density().at(i) * f[a][i];
                v[a][i] = if v[a][i].is_finite() && back.is_finite() {
                    v[a][i] - back
                } else {
                    0.0
                };
            }
        }
    }
}

struct Advance<'a, const D: usize> {
    u: [Shared; D],
    v: [Shared; D],
    f: &'a Field<D>,
    density: &'a Values,
    len: usize,
    dt: f64,
    pending: bool,
    limit: f64,
}

impl<const D: usize> Kernel for Advance<'_, D> {
    type Out = Fastest;
    type Home = Self;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Fastest {
        let end = ((block + 1) * BLOCK).min(self.len);
        let (mut fastest, mut refused) = (L::splat(0.0), false);
        let mut i = block * BLOCK;
        debug_assert!(self.len.is_multiple_of(TILE));
        while i < end {
            // SAFETY: i + 8 ≤ len, a multiple of the tile; blocks are disjoint
            unsafe {
                let h = match self.density {
                    Values::Uniform(rho) => L::splat(0.5 * self.dt / rho),
                    Values::PerSlot(rho) => {
                        L::splat(0.5 * self.dt).div(L::load(rho.as_ptr().add(i)))
                    }
                };
                let dt = L::splat(self.dt);
                let mut squared = L::splat(0.0);
                let mut v = [L::splat(0.0); D];
                let mut u = v;
                for a in 0..D {
                    u[a] = L::load(self.u[a].at(i));
                    let f = L::load(self.f[a].as_ptr().add(i));
                    v[a] = L::load(self.v[a].at(i));
                    if self.pending {
                        v[a] = h.fma(f, v[a]);
                    }
                    v[a] = h.fma(f, v[a]);
                    v[a].store(self.v[a].at(i));
                    let step = dt * v[a];
                    squared = step.fma(step, squared);
                    // a displacement that is not a number has no step either
                    squared = u[a].fma(L::splat(0.0), squared);
                }
                let fine = squared.lt(L::splat(self.limit));
                for a in 0..D {
                    L::select(fine, dt.fma(v[a], u[a]), u[a]).store(self.u[a].at(i));
                }
                // keeps what is not a number: `min` of negatives would not
                fastest = L::select(squared.lt(fastest), fastest, squared);
                // the others go on: what is undone is undone of all points
                refused |= L::bits(fine) != (1u32 << TILE) - 1;
            }
            i += TILE;
        }
        match refused {
            true => f64::NAN,
            false => fastest.to_array().iter().copied().fold(0.0, f64::max),
        }
    }
}
