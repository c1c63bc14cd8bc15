//! β of bonds that are done point by point.

use crate::gauss;
use crate::kernel::{Kernel, Shape, dot};
use crate::patch::Lanes;
use crate::segment::View;

/// What is done point by point: bonds that are points, cells, and Gaussians that are narrow beside their bonds.
pub(crate) struct Scalars<'a>(pub &'a Kernel);

impl Scalars<'_> {
    /// Of a bond of this length (units of the radius)?
    #[inline(always)]
    pub fn wanted(&self, length: f64) -> bool {
        let shape = self.0.shape();
        length < POINT
            || shape == Shape::Cell
            || (shape == Shape::Gaussian && length > gauss::LONGEST)
    }

    /// β at the points of a view, with its unit of length; from the place to k, and from k to j.
    #[inline(never)]
    pub fn beta(&self, view: &View, over: f64, [from, bond]: [[f64; 3]; 2], out: &mut Lanes) {
        for (k, out) in out.0.iter_mut().enumerate() {
            let d = std::array::from_fn(|a| view.d[a][k] / over - from[a]);
            *out = self.at_point(d, bond, over);
        }
    }

    /// At one point.
    pub fn at_point(&self, d: [f64; 3], bond: [f64; 3], over: f64) -> f64 {
        let kernel = self.0;
        if dot(bond, bond) < POINT * POINT / (over * over) {
            kernel.value(d)
        } else if kernel.shape() == Shape::Cell {
            kernel.cell_part(d, bond)
        } else {
            kernel.norm * kernel.gaussian_part(d, bond)
        }
    }
}

/// A bond that is shorter is a point: one along averaged axes (units of the radius of φ).
pub(crate) const POINT: f64 = 1e-12;
