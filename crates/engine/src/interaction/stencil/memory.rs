//! What the bonds of a stencil remember: which are whole, which were cut, and from which stretch they break.

use super::StencilInteraction;
use crate::body::{Body, FieldView};
use crate::execute::lane::TILE;
use crate::interaction::history::{self, Crosses};
use crate::law::Law;
use crate::spec::CrackKind;
use crate::state::Archive;

impl<const D: usize, W: Law> StencilInteraction<D, W> {
    pub(super) fn damages(&self, body: &Body<D>, out: &mut [f64]) {
        let grid = body.grid();
        for (n, &t) in self.tiles.iter().enumerate() {
            let slot = grid.tile_slot(t as usize);
            if self.state[n] != 0 {
                out[slot..slot + TILE].fill(0.0);
                continue;
            }
            let mut whole = [0u32; TILE];
            for b in self.row(n) {
                for (l, w) in whole.iter_mut().enumerate() {
                    *w += (b >> l & 1) as u32;
                }
            }
            for l in 0..TILE {
                let family = self.family[n * TILE + l];
                out[slot + l] = history::damage(whole[l] as f64, family as f64);
            }
        }
    }

    pub(super) fn cut_where(
        &mut self,
        body: &Body<D>,
        kind: CrackKind,
        crosses: &Crosses<D>,
    ) -> u64 {
        let grid = body.grid();
        let original = body.originals();
        let at = |slot: usize| -> [f64; D] {
            let x = grid.position(slot);
            std::array::from_fn(|a| x[a])
        };
        let mut cut = vec![];
        for p in self.places(grid) {
            let from = at(p.slot);
            let bonds = self.bonds[p.sublattice].iter().zip(self.row(p.n));
            for (k, (b, bits)) in bonds.enumerate() {
                if bits >> p.lane & 1 == 0 {
                    continue;
                }
                let end = b.to(p.slot);
                let image = original(end) != end;
                let to = image.then(|| at(original(end)));
                if history::crossed(crosses, from, b.back.map(|x| -x), to) {
                    cut.push((p.n, k, p.lane));
                }
            }
        }
        for &(n, k, l) in &cut {
            history::set(&mut self.alive[n * self.width + k], l, false);
            if kind == CrackKind::Absent {
                self.family[n * TILE + l] -= 1;
            }
        }
        if kind == CrackKind::Absent {
            self.directed -= cut.len() as u64;
        }
        self.look(grid);
        cut.len() as u64
    }

    /// [`mend`](crate::interaction::Interaction::mend).
    pub(super) fn mend_where(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        heals: &dyn Fn(usize, usize, f64) -> bool,
    ) -> u64 {
        let grid = body.grid();
        let original = body.originals();
        let mut mended = vec![];
        for p in self.torn_places(grid) {
            let partners = &self.partners[p.sublattice];
            let bonds = self.bonds[p.sublattice].iter().zip(partners);
            for (k, ((b, to), bits)) in bonds.zip(self.row(p.n)).enumerate() {
                let whole = bits >> p.lane & 1 == 1;
                if whole || grid.neighbour(p.slot, to.cell, to.to).is_none() {
                    continue;
                }
                let (i, j) = (p.slot, b.to(p.slot));
                let eta = std::array::from_fn(|a| u[a][j] - u[a][i]);
                if heals(i, original(j), history::relative(&b.back.map(|x| -x), eta)) {
                    mended.push((p.n, k, p.lane));
                }
            }
        }
        for &(n, k, l) in &mended {
            history::set(&mut self.alive[n * self.width + k], l, true);
        }
        self.look(grid);
        mended.len() as u64
    }

    pub(super) fn read_named(&self, body: &Body<D>, name: &str, out: &mut Vec<f64>) -> bool {
        match name {
            history::WHOLE => {
                out.clear();
                let bit = |(at, l): (usize, usize)| f64::from(self.alive[at] >> l & 1);
                out.extend(self.bits(body).map(bit));
                true
            }
            _ => history::read_critical(body, &self.critical, name, out),
        }
    }

    /// [`archive`](crate::interaction::Interaction::archive).
    pub(super) fn archive_memory(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        archive.all("whole", &mut self.alive);
        archive.all("critical", &mut self.critical);
        if !archive.loads() {
            return;
        }
        let mut there = vec![0; self.alive.len()];
        for (at, l) in self.bits(body) {
            history::set(&mut there[at], l, true);
        }
        // kernels follow every bit
        self.alive.iter_mut().zip(there).for_each(|(a, t)| *a &= t);
        self.look_critical(body);
        self.look(body.grid());
    }

    /// What follows from critical stretches.
    fn look_critical(&mut self, body: &Body<D>) {
        if !self.critical.is_empty() {
            body.fill_images(&mut self.critical);
        }
        let known = body.slots.iter().map(|s| self.critical.get(*s as usize));
        let known = known.flatten().copied();
        self.least_critical = known.fold(f64::INFINITY, f64::min);
        self.settled = false;
    }

    pub(super) fn write_named(&mut self, body: &Body<D>, name: &str, values: &[f64]) -> bool {
        if name != history::WHOLE {
            if !history::write_critical(body, &mut self.critical, name, values) {
                return false;
            }
            self.look_critical(body);
            return true;
        }
        let bits: Vec<_> = self.bits(body).collect();
        if bits.len() != values.len() {
            return false;
        }
        for ((at, l), value) in bits.into_iter().zip(values) {
            history::set(&mut self.alive[at], l, *value != 0.0);
        }
        self.settled = false;
        self.look(body.grid());
        true
    }
}
