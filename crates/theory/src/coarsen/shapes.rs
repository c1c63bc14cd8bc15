//! What retained points carry: shapes, and matrices of the body below in them.

use super::block::{Block, add, add_product, largest, scaled, transposed, unit, zero};
use rayon::prelude::*;

/// Shapes, by point of the body below: retained points (by number in the coarse body, ascending) and `S_pq`, `u_p = Σ_q S_pq u_q`.
#[derive(Clone)]
pub(super) struct Shapes<const D: usize> {
    pub rows: Vec<Vec<(u32, Block<D>)>>,
}

impl<const D: usize> Shapes<D> {
    /// `Sᵀ A S`, its own place in every row, column by column: `spread` adds the forces `A_jp S_pq` of the displacement `S_pq` of point p.
    pub fn galerkin(
        &self,
        retained: usize,
        spread: impl Fn(u32, &Block<D>, &mut Sparse<D>) + Sync,
    ) -> Vec<Vec<(u32, Block<D>)>> {
        let points = self.rows.len();
        let carriers = self.carriers(retained);
        (0..retained)
            .into_par_iter()
            .map_init(
                || (Sparse::new(points), Sparse::new(retained)),
                |(force, column), k| {
                    for &p in &carriers[k] {
                        let row = &self.rows[p as usize];
                        if let Ok(at) = row.binary_search_by_key(&(k as u32), |r| r.0) {
                            spread(p, &row[at].1, force);
                        }
                    }
                    force.drain(|p, f| {
                        for (q, s) in &self.rows[p as usize] {
                            add_product(column.at(*q), &transposed(s), &f);
                        }
                    });
                    let mut row = vec![];
                    column.drain(|q, f| row.push((q, transposed(&f))));
                    row.sort_unstable_by_key(|r: &(u32, _)| r.0);
                    row
                },
            )
            .collect()
    }

    /// Gives what a point's shapes lack of carrying it with a translation to the largest of them: mass is kept then.
    pub fn carry_translations(&mut self) {
        for row in &mut self.rows {
            let mut lack = unit();
            row.iter()
                .for_each(|(_, s)| add(&mut lack, &scaled(-1.0, s)));
            let most = row
                .iter_mut()
                .max_by(|a, b| largest(&a.1).total_cmp(&largest(&b.1)));
            if let Some((_, s)) = most {
                add(s, &lack);
            }
        }
    }

    /// Points that each shape reaches.
    fn carriers(&self, retained: usize) -> Vec<Vec<u32>> {
        let mut carriers = vec![vec![]; retained];
        for (p, row) in (0..).zip(&self.rows) {
            for (q, _) in row {
                carriers[*q as usize].push(p);
            }
        }
        carriers
    }
}

/// Few blocks of many.
pub(super) struct Sparse<const D: usize> {
    place: Vec<u32>,
    touched: Vec<u32>,
    value: Vec<Block<D>>,
}

impl<const D: usize> Sparse<D> {
    fn new(n: usize) -> Sparse<D> {
        Sparse {
            place: vec![u32::MAX; n],
            touched: vec![],
            value: vec![],
        }
    }

    pub fn at(&mut self, k: u32) -> &mut Block<D> {
        let place = &mut self.place[k as usize];
        if *place == u32::MAX {
            *place = self.touched.len() as u32;
            self.touched.push(k);
            self.value.push(zero());
        }
        &mut self.value[*place as usize]
    }

    /// Gives all blocks in the order in which they were touched, and forgets them.
    fn drain(&mut self, mut take: impl FnMut(u32, Block<D>)) {
        for (k, v) in self.touched.drain(..).zip(self.value.drain(..)) {
            self.place[k as usize] = u32::MAX;
            take(k, v);
        }
    }
}
