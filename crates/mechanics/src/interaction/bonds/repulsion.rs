//! Repulsion inside the family: rare, so plainly, point by point.

use super::family::{Family, Moved, Slots};
use crate::body::Body;
use crate::execute::lane::{Lane, TILE};
use crate::interaction::Repulsion;
use crate::interaction::bond::relative_square_stretch;

/// What pairs of a family are pushed apart by.
#[derive(Clone, Copy)]
pub struct Pushed<'a, const D: usize> {
    pub repulsion: &'a Repulsion,
    pub body: &'a Body<D>,
}

/// A pair that is too close.
pub struct Push<const D: usize> {
    /// From i to j now (length).
    pub y: [f64; D],
    /// Coefficient of y in the force density on i: negative.
    pub pull: f64,
    /// Half of the pair's energy density.
    pub energy: f64,
}

impl<const D: usize> Pushed<'_, D> {
    /// No repulsion in a bond whose `e` is at least this.
    fn contact_e(&self) -> f64 {
        self.repulsion.bonded * self.repulsion.bonded - 1.0
    }

    /// Which of the eight bonds `k` may be too close.
    #[inline(always)]
    unsafe fn near<L: Lane, F: Family<D>>(
        &self,
        family: &F,
        moved: &Moved<D>,
        group: usize,
        k: usize,
    ) -> u32 {
        // SAFETY: a bond of the group
        unsafe {
            let (rows, ends) = (family.rows(group), family.ends(group, k));
            let place = family.place::<L>(rows);
            let none = L::splat(0.0).lt(L::splat(0.0));
            let r = family.reference::<L>(group, k, &place, ends, none);
            let (u, uj) = (
                F::displacement::<L>(moved, rows),
                F::displacement::<L>(moved, ends),
            );
            let mut eta = u;
            for a in 0..D {
                eta[a] = uj[a] - u[a];
            }
            let e = relative_square_stretch(eta, r.xi, r.two_by_square);
            L::bits(e.lt(L::splat(self.contact_e())))
        }
    }

    /// Of one bond, whole or not; `None`: it is not pushed.
    pub fn of<F: Family<D>>(
        &self,
        family: &F,
        moved: &Moved<D>,
        group: usize,
        k: usize,
        l: usize,
    ) -> Option<Push<D>> {
        let (rows, ends) = (family.rows(group), family.ends(group, k));
        if !family.is_point(group, l) || !family.is_bond(group, k, l) {
            return None;
        }
        let (i, j) = (rows.slot(l), ends.slot(l));
        let (xi, _) = family.bond(group, k, l);
        // SAFETY: slots of the family
        let (u, uj) = unsafe {
            (
                F::displacement::<f64>(moved, rows.from(l)),
                F::displacement::<f64>(moved, ends.from(l)),
            )
        };
        let eta: [f64; D] = crate::array::from_fn(|a| uj[a] - u[a]);
        let square: f64 = xi.iter().map(|x| x * x).sum();
        let e = relative_square_stretch(eta, xi, 2.0 / square);
        let materials = [i, j].map(|s| self.body.material_of(s));
        // the range is that of the body, whatever the materials
        let d = self.repulsion.distance(square.sqrt(), [0, 0]);
        let r = (square * (1.0 + e)).sqrt();
        if !(r < d) {
            return None;
        }
        let stiffness = self.repulsion.between(materials, [i, j]) * self.body.volume.at(j);
        Some(Push {
            y: crate::array::from_fn(|a| xi[a] + eta[a]),
            pull: stiffness * (r - d) / r,
            energy: 0.25 * stiffness * (r - d) * (r - d),
        })
    }

    /// Add the forces of a group's pairs.
    ///
    /// # Safety
    /// A group of the family.
    #[inline(always)]
    pub unsafe fn add<L: Lane, F: Family<D>>(
        &self,
        family: &F,
        moved: &Moved<D>,
        group: usize,
        acc: &mut [L; D],
    ) {
        for k in 0..family.bonds(group) {
            // SAFETY: the caller's promise
            let bits = unsafe { self.near::<L, F>(family, moved, group, k) };
            if bits == 0 {
                continue;
            }
            let mut sum = [[0.0; TILE]; D];
            for l in (0..TILE).filter(|l| bits >> l & 1 == 1) {
                if let Some(push) = self.of(family, moved, group, k, l) {
                    for a in 0..D {
                        sum[a][l] = push.pull * push.y[a];
                    }
                }
            }
            for a in 0..D {
                // SAFETY: a number per lane
                acc[a] = acc[a] + unsafe { L::load(sum[a].as_ptr()) };
            }
        }
    }

    /// Energy densities of a group's pairs, half of each.
    ///
    /// # Safety
    /// A group of the family.
    #[inline(always)]
    pub unsafe fn energy<L: Lane, F: Family<D>>(
        &self,
        family: &F,
        moved: &Moved<D>,
        group: usize,
    ) -> [f64; TILE] {
        let mut sum = [0.0; TILE];
        for k in 0..family.bonds(group) {
            // SAFETY: the caller's promise
            let bits = unsafe { self.near::<L, F>(family, moved, group, k) };
            for l in (0..TILE).filter(|l| bits >> l & 1 == 1) {
                if let Some(push) = self.of(family, moved, group, k, l) {
                    sum[l] += push.energy;
                }
            }
        }
        sum
    }
}
