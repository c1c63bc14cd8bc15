//! Vectors of points, and sums over them that neither the number of threads nor that of ranks changes.

use crate::body::Body;
use crate::execute::exact::Exact;
use peridyne_comm::Comm;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// What a point resists with against its own place (force / length).
pub type Block<const D: usize> = [[f64; D]; D];

/// The same number along every axis.
pub fn diagonal<const D: usize>(x: f64) -> Block<D> {
    crate::array::from_fn(|a| crate::array::from_fn(|b| if a == b { x } else { 0.0 }))
}

/// Points per partial sum, where nobody shares them.
const CHUNK: usize = 4096;
/// Blocks that a thread takes at a time.
const BLOCKS: usize = 16;

/// Sums over the points of all ranks, each of which has some: a rank adds up whole blocks, and their sums are added without rounding.
#[derive(Debug, Clone)]
pub struct Sums {
    /// Numbers of values in the order of blocks; empty: they are in it.
    order: Vec<u32>,
    /// Where each block ends; empty: all are as long.
    ends: Vec<u32>,
    /// Those who have the other points, and the id of each value's among all.
    ranks: Option<(Arc<Comm>, Vec<u32>)>,
}

/// Of values that one process has.
pub static ALONE: Sums = Sums {
    order: vec![],
    ends: vec![],
    ranks: None,
};

impl Sums {
    /// Of values that points in these slots have.
    pub fn of<const D: usize>(body: &Body<D>, slots: &[u32]) -> Sums {
        let block = |n: u32| body.block(slots[n as usize] as usize);
        let mut order: Vec<u32> = (0..slots.len() as u32).collect();
        order.sort_by_key(|n| slots[*n as usize]);
        let mut ends = vec![];
        for (n, pair) in order.windows(2).enumerate() {
            if block(pair[0]) != block(pair[1]) {
                ends.push(n as u32 + 1);
            }
        }
        ends.push(slots.len() as u32);
        if order.is_sorted() {
            order = vec![];
        }
        let ranks = body.subdomain().map(|of| {
            let ids = body.ids_of_all();
            let ids = slots.iter().map(|s| ids[*s as usize]);
            (of.comm().clone(), ids.collect())
        });
        Sums { order, ends, ranks }
    }

    fn block(&self, block: usize, values: usize) -> Range<usize> {
        match self.ends.get(block) {
            None => block * CHUNK..((block + 1) * CHUNK).min(values),
            Some(end) => {
                let begin = block.checked_sub(1).map_or(0, |before| self.ends[before]);
                begin as usize..*end as usize
            }
        }
    }

    /// Of numbers that each of so many values here gives.
    pub fn each<const N: usize>(
        &self,
        values: usize,
        of: impl Fn(usize) -> [f64; N] + Sync,
    ) -> [f64; N] {
        let blocks = match self.ends.len() {
            0 => values.div_ceil(CHUNK),
            blocks => blocks,
        };
        let of_block = |block: usize| {
            let mut sum = [0.0; N];
            for n in self.block(block, values) {
                let value = of(self.order.get(n).map_or(n, |n| *n as usize));
                sum.iter_mut().zip(value).for_each(|(sum, x)| *sum += x);
            }
            sum
        };
        let each = (0..blocks).into_par_iter().with_min_len(BLOCKS);
        let each: Vec<[f64; N]> = each.map(of_block).collect();
        let mut sums: [Exact; N] = std::array::from_fn(|n| each.iter().map(|x| x[n]).collect());
        if let Some((comm, _)) = &self.ranks {
            Exact::of_all(&mut sums, comm);
        }
        sums.map(|sum| sum.value())
    }

    /// `x · y`
    pub fn dot<const D: usize>(&self, x: &[[f64; D]], y: &[[f64; D]]) -> f64 {
        let each = |i: usize| [(0..D).map(|a| x[i][a] * y[i][a]).sum::<f64>()];
        self.each(x.len(), each)[0]
    }

    /// `√(x · x)`
    pub fn norm<const D: usize>(&self, x: &[[f64; D]]) -> f64 {
        self.dot(x, x).sqrt()
    }

    /// What each rank says.
    fn all<const N: usize>(&self, own: [u8; N]) -> Vec<[u8; N]> {
        let Some((comm, _)) = &self.ranks else {
            return vec![own];
        };
        let all = comm.all_as_long(&own);
        let all = all.unwrap_or_else(|failure| comm.end(failure));
        all.as_chunks().0.to_vec()
    }

    /// Do other ranks have points, too?
    pub fn are_shared(&self) -> bool {
        self.ranks.is_some()
    }

    /// The largest of all ranks' numbers.
    pub fn most(&self, own: f64) -> f64 {
        let all = self.all(own.to_le_bytes()).into_iter();
        all.map(f64::from_le_bytes).fold(own, f64::max)
    }

    /// The largest size of a number.
    pub fn largest<const D: usize>(&self, x: &[[f64; D]]) -> f64 {
        let all = x.as_flattened().iter();
        self.most(all.fold(0.0f64, |m, x| m.max(x.abs())))
    }

    /// Is it so on any rank?
    pub fn any(&self, here: bool) -> bool {
        self.all([u8::from(here)]).contains(&[1])
    }

    /// Id of a value's point among all.
    pub fn id(&self, value: usize) -> usize {
        match &self.ranks {
            None => value,
            Some((_, ids)) => ids[value] as usize,
        }
    }

    /// The first id at which something was found, of values of all ranks.
    pub fn first(&self, found: Option<usize>) -> Option<usize> {
        const NONE: u64 = u64::MAX;
        let own = found.map_or(NONE, |value| self.id(value) as u64);
        let all = self.all(own.to_le_bytes()).into_iter();
        let least = all.map(u64::from_le_bytes).min().unwrap_or(NONE);
        (least != NONE).then_some(least as usize)
    }
}

/// `x · y` of values that one process has.
pub fn dot<const D: usize>(x: &[[f64; D]], y: &[[f64; D]]) -> f64 {
    ALONE.dot(x, y)
}

/// `y += s x`
pub fn add<const D: usize>(y: &mut [[f64; D]], s: f64, x: &[[f64; D]]) {
    y.par_chunks_mut(CHUNK)
        .zip(x.par_chunks(CHUNK))
        .for_each(|(y, x)| {
            for (y, x) in y.iter_mut().zip(x) {
                for a in 0..D {
                    y[a] = s.mul_add(x[a], y[a]);
                }
            }
        });
}

/// `y = x + s y`
pub fn add_to_multiple<const D: usize>(y: &mut [[f64; D]], s: f64, x: &[[f64; D]]) {
    y.par_chunks_mut(CHUNK)
        .zip(x.par_chunks(CHUNK))
        .for_each(|(y, x)| {
            for (y, x) in y.iter_mut().zip(x) {
                for a in 0..D {
                    y[a] = s.mul_add(y[a], x[a]);
                }
            }
        });
}

/// `√(x · x)` of values that one process has.
pub fn norm<const D: usize>(x: &[[f64; D]]) -> f64 {
    ALONE.norm(x)
}
