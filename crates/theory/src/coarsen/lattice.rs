//! Bodies of central bonds on a chain, square or cubic lattice, any stiffness per bond: composites, defects, chains.

use peridyne::spec::LinearBody;

/// The points of a block of a lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeBlock<const D: usize> {
    /// Points along each axis.
    pub size: [usize; D],
    /// Length of a step.
    pub spacing: f64,
    /// Place of the first point (length).
    pub first: [f64; D],
    /// Longest bond, in steps, closed.
    pub reach: f64,
    pub periodic: [bool; D],
}

impl<const D: usize> LatticeBlock<D> {
    /// With the first point at the origin, not periodic.
    pub fn new(size: [usize; D], spacing: f64, reach: f64) -> LatticeBlock<D> {
        LatticeBlock {
            size,
            spacing,
            first: [0.0; D],
            reach,
            periodic: [false; D],
        }
    }

    pub fn periodic(self) -> LatticeBlock<D> {
        LatticeBlock {
            periodic: [true; D],
            ..self
        }
    }

    /// The point at a place beyond a periodic face.
    pub fn wrapped(&self, at: [i64; D]) -> Option<[i64; D]> {
        let n = self.size.map(|n| n as i64);
        let wrapped = std::array::from_fn(|a| match self.periodic[a] {
            true => at[a].rem_euclid(n[a]),
            false => at[a],
        });
        (0..D)
            .all(|a| (0..n[a]).contains(&wrapped[a]))
            .then_some(wrapped)
    }

    /// A body of the points that are `present`, density 1 and `spacing^D` as volume, with
    /// `C_ij = spring(i, n) n⊗n/|n|²`, n the steps from i to j, of a bond (force density / length). Both take and `spring` gives
    /// the same for both ends, or action is not reaction. Places are counted in steps from the first point.
    pub fn body(
        &self,
        present: impl Fn([i64; D]) -> bool,
        spring: impl Fn([i64; D], [i64; D]) -> f64,
    ) -> LinearBody<D> {
        let at = |mut k: usize| -> [i64; D] {
            std::array::from_fn(|a| {
                let n = k % self.size[a];
                k /= self.size[a];
                n as i64
            })
        };
        let places: Vec<[i64; D]> = (0..self.size.iter().product())
            .map(at)
            .filter(|n| present(*n))
            .collect();
        let number = |n: [i64; D]| {
            let n = self.wrapped(n)?;
            let key = |n: &[i64; D]| n.iter().rev().copied().collect::<Vec<_>>();
            places.binary_search_by_key(&key(&n), key).ok()
        };
        let mut body = LinearBody {
            position: (places.iter())
                .map(|n| std::array::from_fn(|a| self.first[a] + self.spacing * n[a] as f64))
                .collect(),
            volume: vec![self.spacing.powi(D as i32); places.len()],
            density: vec![1.0; places.len()],
            period: std::array::from_fn(|a| {
                self.periodic[a].then_some(self.spacing * self.size[a] as f64)
            }),
            start: vec![0],
            partner: vec![],
            block: vec![],
            load_map: None,
            mass: None,
        };
        let offsets = offsets(self.reach);
        for i in &places {
            let mut row: Vec<(u32, [[f64; D]; D])> = (offsets.iter())
                .filter_map(|n| {
                    let j = number(std::array::from_fn(|a| i[a] + n[a]))?;
                    let square = n.iter().map(|n| n * n).sum::<i64>() as f64;
                    let c = spring(*i, *n) / square;
                    let block = n.map(|x| n.map(|y| c * (x * y) as f64));
                    Some((j as u32, block))
                })
                .collect();
            row.sort_unstable_by_key(|r| r.0);
            for (j, c) in row {
                body.partner.push(j);
                body.block.push(c);
            }
            body.start.push(body.partner.len());
        }
        body
    }
}

/// Steps to all points within reach but itself.
fn offsets<const D: usize>(reach: f64) -> Vec<[i64; D]> {
    let r = reach as i64;
    let wide = 2 * r + 1;
    let limit = (reach * reach * (1.0 + 1e-9)) as i64;
    (0..wide.pow(D as u32))
        .map(|mut k| {
            std::array::from_fn(|_| {
                let n = k % wide - r;
                k /= wide;
                n
            })
        })
        .filter(|n: &[i64; D]| {
            let square = n.iter().map(|n| n * n).sum();
            (1..=limit).contains(&square)
        })
        .collect()
}
