//! The bonds of a list one by one, in order of rows: for whatever is not a kernel.

use super::ListInteraction;
use crate::body::{Body, FieldView, view_mut, zeros};
use crate::interaction::bonds::family::{Family, Slots};
use crate::interaction::{BondForce, BondTangent, Interaction, Sweep};
use crate::law::{BondFactors, Law};

impl<const D: usize, W: Law> ListInteraction<D, W> {
    /// Every directed bond of the list: place, in order of rows; is it whole; slots.
    pub(super) fn each_line(&self, mut visit: impl FnMut(usize, bool, [usize; 2])) {
        let family = &self.bonds.family;
        for (group, k, l) in self.bonds.pairs() {
            let ends = [family.rows(group), family.ends(group, k)].map(|s| s.slot(l));
            let whole = self.bonds.is_whole(group, k, l);
            visit(family.own(group, k, 0, 1) + l, whole, ends);
        }
    }

    fn field(&self, slot: usize) -> [f64; 2] {
        [0, 1].map(|n| self.fields.get(2 * slot + n).copied().unwrap_or(0.0))
    }

    pub(super) fn each_tangent(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        visit: &mut dyn FnMut(BondTangent<D>),
    ) {
        if W::SHARES {
            // the pressures of this state
            self.forces(body, u, view_mut(&mut zeros(body.len)), Sweep::Hold, None);
        }
        let view = self.view(self.moved());
        self.each_line(|place, whole, [i, j]| {
            if !whole {
                return;
            }
            let (xi, share) = view.constant(i, j);
            let mut k = share / xi.iter().map(|x| x * x).sum::<f64>();
            let mut fields = [i, j].map(|s| self.field(s));
            let length = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            k = self.law.between_ends(k, &xi, length, fields[0], fields[1]);
            k *= self.factor(place);
            if view.paired {
                let pair = self.pairs.get(body.material_of(i), body.material_of(j));
                k *= pair.stiffness;
                fields.iter_mut().for_each(|f| f[0] *= pair.ratio());
            }
            let mut tangent = BondTangent::of_law(
                self.law,
                [i, j],
                k,
                BondFactors::ONE,
                xi,
                crate::array::from_fn(|a| u[a][j] - u[a][i]),
                fields,
            );
            if view.paired && W::SHARES {
                // the scalar is that of unit constants
                let pair = self.pairs.get(body.material_of(i), body.material_of(j));
                tangent.share = tangent.share.map(|x| x / pair.stiffness);
                tangent.pull = tangent.pull.map(|p| p.map(|x| x * pair.ratio()));
            }
            visit(tangent);
        });
    }

    pub(super) fn each_pull(&mut self, u: FieldView<D>, visit: &mut dyn FnMut(BondForce<D>)) {
        self.pack_now(u);
        if W::SHARES {
            self.share();
        }
        let view = self.view(self.moved());
        self.each_line(|place, whole, [i, j]| {
            let (pull, y) = view.pull_of(i, j, whole.then(|| self.factor(place)));
            if pull[0] != 0.0 {
                visit(BondForce::central([i, j], y, pull));
            }
        });
    }
}
