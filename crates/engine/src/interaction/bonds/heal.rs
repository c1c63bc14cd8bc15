//! Broken bonds that become whole again.

use super::family::{Family, Slots};
use super::law::PointLaw;
use super::state::BondState;
use crate::body::{Body, FieldView};
use crate::interaction::history;

impl<const D: usize, F: Family<D>> BondState<D, F> {
    /// [`mend`](crate::interaction::Interaction::mend): those that damage counts, never what an absent crack took away.
    pub fn mend(
        &mut self,
        body: &Body<D>,
        u: FieldView<D>,
        heals: &dyn Fn(usize, usize, f64) -> bool,
        law: &dyn PointLaw<D>,
    ) -> u64 {
        let mut mended = vec![];
        for (group, k, l) in self
            .lost(|_| true)
            .filter(|b| self.is_counted(b.0, b.1, b.2))
        {
            let i = self.family.rows(group).slot(l);
            let end = self.family.ends(group, k).slot(l);
            let eta = crate::array::from_fn(|a| u[a][end] - u[a][i]);
            let xi = self.family.bond(group, k, l).0;
            if heals(i, body.exchange.original(end), history::relative(&xi, eta)) {
                mended.push((self.family.byte(group, k), l));
            }
        }
        for &(byte, l) in &mended {
            history::set(&mut self.alive[byte], l, true);
        }
        if self.prepared {
            self.look(body, law);
        }
        mended.len() as u64
    }
}
