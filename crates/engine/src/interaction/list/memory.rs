//! What the bonds of a list remember: which are whole, which were cut, and from which stretch they break.

use super::ListInteraction;
use crate::body::{Body, FieldView};
use crate::execute::lane::TILE;
use crate::interaction::history::{self, Crosses};
use crate::law::Law;
use crate::spec::CrackKind;

impl<const D: usize, W: Law> ListInteraction<D, W> {
    pub(super) fn damages(&self, body: &Body<D>, out: &mut [f64]) {
        for (row, &i) in self.list.rows.iter().enumerate() {
            let volume = |j| body.volume.at(j);
            let family = self.sum(row, &self.list.present, volume);
            let whole = self.sum(row, &self.alive, volume);
            out[i as usize] = history::damage(whole, family);
        }
    }

    pub(super) fn cut_where(
        &mut self,
        body: &Body<D>,
        kind: CrackKind,
        crosses: &Crosses<D>,
    ) -> u64 {
        let at = |slot: usize| -> [f64; D] {
            let x = body.position(slot);
            std::array::from_fn(|a| x[a])
        };
        let view = self.view(&self.moved);
        let mut cut = vec![];
        self.each_line(|row, line, [i, j]| {
            if !self.is_whole(row, line) {
                return;
            }
            let (xi, _) = view.constant(i, j);
            let to = self.is_periodic().then(|| at(j));
            if history::crossed(crosses, at(i), xi, to) {
                cut.push((line, row % TILE));
            }
        });
        for &(line, l) in &cut {
            history::set(&mut self.alive[line], l, false);
            if kind == CrackKind::Absent {
                history::set(&mut self.list.present[line], l, false);
            }
        }
        if kind == CrackKind::Absent {
            self.list.directed -= cut.len() as u64;
        }
        cut.len() as u64
    }

    /// [`mend`](crate::interaction::Interaction::mend).
    pub(super) fn mend_where(
        &mut self,
        u: FieldView<D>,
        heals: &dyn Fn(usize, usize, f64) -> bool,
    ) -> u64 {
        let view = self.view(&self.moved);
        let mut mended = vec![];
        self.each_line(|row, line, [i, j]| {
            if self.is_whole(row, line) {
                return;
            }
            let eta = std::array::from_fn(|a| u[a][j] - u[a][i]);
            if heals(i, j, history::relative(&view.constant(i, j).0, eta)) {
                mended.push((line, row % TILE));
            }
        });
        for &(line, l) in &mended {
            history::set(&mut self.alive[line], l, true);
        }
        mended.len() as u64
    }

    pub(super) fn read_named(&self, body: &Body<D>, name: &str, out: &mut Vec<f64>) -> bool {
        match name {
            history::WHOLE => {
                out.clear();
                self.each_line(|row, line, _| {
                    out.push(f64::from(u8::from(self.is_whole(row, line))))
                });
                true
            }
            _ => history::read_critical(body, &self.critical, name, out),
        }
    }

    pub(super) fn write_named(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        if name != history::WHOLE {
            let known = history::write_critical(body, &mut self.critical, name, values);
            self.spares = self.critical.contains(&history::NEVER);
            return known;
        }
        let mut bonds = vec![];
        self.each_line(|row, line, _| bonds.push((line, row % TILE)));
        if bonds.len() != values.len() {
            return false;
        }
        for ((line, l), value) in bonds.into_iter().zip(values) {
            let whole = *value != 0.0 && self.list.present[line] >> l & 1 == 1;
            history::set(&mut self.alive[line], l, whole);
        }
        true
    }
}
