//! Operators on displacements: `A u`, the forces that hold a body at u (force per point).

use super::support::Support;
use super::vectors::{ALONE, Block, Sums};
use crate::body::{Body, Field, view, view_mut, zeros};
use crate::interaction::{Interaction, Sweep};
use crate::spec::LinearBody;
use rayon::prelude::*;

/// Points per piece of work.
const CHUNK: usize = 1024;

/// `A = −V ∂f/∂u` on D numbers per point.
pub trait LinearOperator<const D: usize> {
    fn points(&self) -> usize;
    /// `y = A x` (force), x in lengths.
    fn apply(&mut self, x: &[[f64; D]], y: &mut [[f64; D]]);
    /// Blocks of A on the diagonal, or of an operator near to it.
    fn diagonal(&mut self) -> Vec<[[f64; D]; D]>;
    /// Over its points.
    fn sums(&self) -> &Sums {
        &ALONE
    }
}

/// How far an operator is from symmetric on the free components: `|x·Ay − y·Ax|` over `|x||Ay|` for two fixed vectors in which
/// every component moves. 0 but for round-off if it is; an asymmetry of a few of many points shows, too.
pub fn asymmetry<const D: usize>(
    operator: &mut dyn LinearOperator<D>,
    support: &Support<D>,
) -> f64 {
    let n = operator.points();
    let vector = |step: f64, sums: &Sums| {
        let number = |i: usize, a: usize| (sums.id(i) * D + a + 1) as f64;
        let at = |i: usize| crate::array::from_fn(|a| (number(i, a) * step).fract() - 0.5);
        let mut x: Vec<[f64; D]> = (0..n).map(at).collect();
        support.mask(&mut x);
        x
    };
    // of the golden and the silver ratio: no lattice is in step with both
    let sums = operator.sums().clone();
    let (x, y) = (
        vector(0.618_033_988_749_894_9, &sums),
        vector(0.414_213_562_373_095_1, &sums),
    );
    let mut product = vec![[0.0; D]; n];
    operator.apply(&y, &mut product);
    support.mask(&mut product);
    let (there, size) = (sums.dot(&x, &product), sums.norm(&x) * sums.norm(&product));
    operator.apply(&x, &mut product);
    let back = sums.dot(&y, &product);
    if size > 0.0 {
        (there - back).abs() / size
    } else {
        0.0
    }
}

/// A linear body as an operator.
pub struct Assembled<'a, const D: usize>(pub &'a LinearBody<D>);

impl<const D: usize> LinearOperator<D> for Assembled<'_, D> {
    fn points(&self) -> usize {
        self.0.points()
    }

    fn apply(&mut self, x: &[[f64; D]], y: &mut [[f64; D]]) {
        let body = self.0;
        y.par_chunks_mut(CHUNK).enumerate().for_each(|(c, y)| {
            for (n, y) in y.iter_mut().enumerate() {
                let i = c * CHUNK + n;
                *y = body.force(x, i).map(|f| -body.volume[i] * f);
            }
        });
    }

    fn diagonal(&mut self) -> Vec<[[f64; D]; D]> {
        let body = self.0;
        let of = |i: usize| {
            let mut sum = [[0.0; D]; D];
            for c in body.row(i).1 {
                for a in 0..D {
                    for b in 0..D {
                        sum[a][b] += body.volume[i] * c[a][b];
                    }
                }
            }
            sum
        };
        (0..body.points()).map(of).collect()
    }
}

/// An operator and a stiffness of every point against its own place: what inertia and damping add within a step in time.
pub struct Shifted<'a, const D: usize> {
    pub operator: &'a mut dyn LinearOperator<D>,
    /// `[N]` (force / length); empty: nothing.
    pub added: &'a [Block<D>],
}

impl<const D: usize> LinearOperator<D> for Shifted<'_, D> {
    fn points(&self) -> usize {
        self.operator.points()
    }

    fn sums(&self) -> &Sums {
        self.operator.sums()
    }

    fn apply(&mut self, x: &[[f64; D]], y: &mut [[f64; D]]) {
        self.operator.apply(x, y);
        for ((y, x), block) in y.iter_mut().zip(x).zip(self.added) {
            for a in 0..D {
                for b in 0..D {
                    y[a] = block[a][b].mul_add(x[b], y[a]);
                }
            }
        }
    }

    fn diagonal(&mut self) -> Vec<[[f64; D]; D]> {
        let mut diagonal = self.operator.diagonal();
        for (block, added) in diagonal.iter_mut().zip(self.added) {
            for a in 0..D {
                for b in 0..D {
                    block[a][b] += added[a][b];
                }
            }
        }
        diagonal
    }
}

/// Displacements so small (in spacings) that the square of a strain is beyond round-off.
pub const SMALL: f64 = 1e-60;

/// The tangent at the reference of a law that has no forces there, without a matrix: force sweeps at displacements so small
/// that the law is linear to the last digit, because stretches are computed without cancellation.
pub struct Swept<'a, const D: usize> {
    body: &'a Body<D>,
    interaction: &'a mut dyn Interaction<D>,
    sums: &'a Sums,
    u: Field<D>,
    f: Field<D>,
}

impl<'a, const D: usize> Swept<'a, D> {
    /// With sums over the points of the body, in order of ids.
    pub fn new(body: &'a Body<D>, interaction: &'a mut dyn Interaction<D>, sums: &'a Sums) -> Self {
        Swept {
            sums,
            u: body.at_rest(),
            f: zeros(body.len()),
            body,
            interaction,
        }
    }
}

impl<const D: usize> LinearOperator<D> for Swept<'_, D> {
    fn points(&self) -> usize {
        self.body.points()
    }

    fn sums(&self) -> &Sums {
        self.sums
    }

    fn apply(&mut self, x: &[[f64; D]], y: &mut [[f64; D]]) {
        let body = self.body;
        let peak = self.sums.largest(x);
        if peak == 0.0 {
            y.fill([0.0; D]);
            return;
        }
        let small = SMALL * body.spacing() / peak;
        body.set_vectors(&mut self.u, |id, _| x[id].map(|c| small * c));
        self.interaction.forces(
            body,
            view(&self.u),
            view_mut(&mut self.f),
            Sweep::Hold,
            None,
        );
        for (y, &s) in y.iter_mut().zip(body.slots()) {
            let s = s as usize;
            let scale = -body.volume().at(s) / small;
            *y = crate::array::from_fn(|a| scale * self.f[a][s]);
        }
    }

    /// Of the direct bonds; what goes through scalars is left out.
    fn diagonal(&mut self) -> Vec<[[f64; D]; D]> {
        let body = self.body;
        let mut sum = vec![[[0.0; D]; D]; body.len()];
        self.interaction
            .tangents(body, view(&body.at_rest()), &mut |bond| {
                for a in 0..D {
                    for b in 0..D {
                        sum[bond.i][a][b] += body.volume().at(bond.i) * bond.stiffness[a][b];
                    }
                }
            });
        body.slots().iter().map(|s| sum[*s as usize]).collect()
    }
}
