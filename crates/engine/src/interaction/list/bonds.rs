//! The bonds of a list one by one, in order of rows: for whatever is not a kernel.

use super::ListInteraction;
use crate::body::{Body, FieldView, view_mut, zeros};
use crate::execute::lane::TILE;
use crate::interaction::{BondForce, BondStatus, BondTangent, Interaction, Sweep};
use crate::law::{BondFactors, Law};

impl<const D: usize, W: Law> ListInteraction<D, W> {
    /// Every directed bond of the list: row, line, slots.
    pub(super) fn each_line(&self, mut visit: impl FnMut(usize, usize, [usize; 2])) {
        for (row, &i) in self.list.rows.iter().enumerate() {
            for (line, j) in self.list.partners(row) {
                visit(row, line, [i as usize, j]);
            }
        }
    }

    pub(super) fn is_whole(&self, row: usize, line: usize) -> bool {
        self.alive[line] >> (row % TILE) & 1 == 1
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
        let view = self.view(&self.moved);
        self.each_line(|row, line, [i, j]| {
            if !self.is_whole(row, line) {
                return;
            }
            let (xi, share) = view.constant(i, j);
            let mut k = share / xi.iter().map(|x| x * x).sum::<f64>();
            let mut fields = [i, j].map(|s| self.field(s));
            let length = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
            k = self.law.between_ends(k, &xi, length, fields[0], fields[1]);
            k *= self.factor(row, line);
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
                std::array::from_fn(|a| u[a][j] - u[a][i]),
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
        let view = self.view(&self.moved);
        self.each_line(|row, line, [i, j]| {
            let whole = self.is_whole(row, line);
            let (pull, y) = view.pull_of(i, j, whole.then(|| self.factor(row, line)));
            if pull[0] != 0.0 {
                visit(BondForce::central([i, j], y, pull));
            }
        });
    }

    /// Every undirected bond of the reference family.
    pub(super) fn each_of_family(&self, visit: &mut dyn FnMut(usize, usize, [f64; D], BondStatus)) {
        let view = self.view(&self.moved);
        self.each_line(|row, line, [i, j]| {
            if i <= j {
                let state = BondStatus::of(self.is_whole(row, line));
                visit(i, j, view.constant(i, j).0, state);
            }
        });
    }

    /// Every undirected bond that is broken.
    pub(super) fn each_torn(&self, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        let view = self.view(&self.moved);
        for (slice, rows) in self.list.rows.chunks(TILE).enumerate() {
            let lines = self.list.lines(TILE * slice);
            for line in lines.filter(|line| self.alive[*line] != 0xff) {
                for (l, &i) in rows.iter().enumerate() {
                    // a row's own slot: there is no bond
                    let j = self.list.partner[TILE * line + l];
                    if i < j && self.alive[line] >> l & 1 == 0 {
                        let (i, j) = (i as usize, j as usize);
                        visit(i, j, view.constant(i, j).0);
                    }
                }
            }
        }
    }
}
