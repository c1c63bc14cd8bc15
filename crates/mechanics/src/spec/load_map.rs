//! Points of the body that a coarse one was condensed from: loads act on them, and the condensation passes their forces on.

use super::rows::{add_alike, rows};

/// `F_q = Σ_p T_qp F_p`: forces on points q of the body from those on the points p that carry loads. The condensed load of an
/// exact elimination is the Schur complement's, `T = −K_qe K_ee⁻¹`: the transposed resolvent of silling2010 (6) where action is
/// reaction.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadMap<const D: usize> {
    /// `[M]` reference positions of all points of the finest body (length).
    pub position: Vec<[f64; D]>,
    /// `[M]` their volumes (length^D times the section).
    pub volume: Vec<f64>,
    /// Their spacing (length).
    pub spacing: f64,
    /// `[M + 1]`: where the points begin that each passes its force on to; a point without any was not condensed.
    pub start: Vec<usize>,
    /// Points of the body, ascending.
    pub target: Vec<u32>,
    /// `T_qp` (–) per target.
    pub block: Vec<[[f64; D]; D]>,
}

impl<const D: usize> LoadMap<D> {
    /// The points of a body itself, of which some (`[N]`) are to carry loads.
    pub fn of(
        position: Vec<[f64; D]>,
        volume: Vec<f64>,
        spacing: f64,
        loaded: &[bool],
    ) -> LoadMap<D> {
        let unit =
            crate::array::from_fn(|a| crate::array::from_fn(|b| f64::from(u8::from(a == b))));
        let mut start = vec![0];
        let mut target = vec![];
        for (p, loaded) in (0u32..).zip(loaded) {
            if *loaded {
                target.push(p);
            }
            start.push(target.len());
        }
        LoadMap {
            position,
            volume,
            spacing,
            block: vec![unit; target.len()],
            start,
            target,
        }
    }

    pub fn points(&self) -> usize {
        self.position.len()
    }

    /// Do the lists belong to each other, and to a body of so many points?
    ///
    /// # Errors
    /// What does not fit.
    pub fn check(&self, points: usize) -> Result<(), String> {
        let n = self.points();
        if self.volume.len() != n {
            return Err(format!("{} volumes of {n} carriers", self.volume.len()));
        }
        rows(&self.start, n, &self.target, points)?;
        if self.target.len() != self.block.len() {
            let (blocks, targets) = (self.block.len(), self.target.len());
            return Err(format!("{blocks} blocks of {targets} targets"));
        }
        Ok(())
    }

    /// Targets of a point and their blocks.
    pub fn row(&self, p: usize) -> (&[u32], &[[[f64; D]; D]]) {
        let row = self.start[p]..self.start[p + 1];
        (&self.target[row.clone()], &self.block[row])
    }

    /// Was this point condensed?
    pub fn carries(&self, p: usize) -> bool {
        self.start[p] < self.start[p + 1]
    }

    /// Points of the body that forces reach, `[N]`.
    pub fn reached(&self, points: usize) -> Vec<bool> {
        let mut reached = vec![false; points];
        for q in &self.target {
            reached[*q as usize] = true;
        }
        reached
    }

    /// The same points for a body made of this one, whose forces `pass` passes on: per point of this body the points of the new
    /// one and their blocks.
    pub fn passed(self, pass: &[Vec<(u32, [[f64; D]; D])>]) -> LoadMap<D> {
        let mut start = vec![0];
        let (mut target, mut block) = (vec![], vec![]);
        for p in 0..self.points() {
            let mut row: Vec<(u32, [[f64; D]; D])> = vec![];
            let (targets, blocks) = self.row(p);
            for (q, t) in targets.iter().zip(blocks) {
                for (k, r) in &pass[*q as usize] {
                    let mut product = [[0.0; D]; D];
                    for a in 0..D {
                        for b in 0..D {
                            product[a][b] = (0..D).map(|c| r[a][c] * t[c][b]).sum();
                        }
                    }
                    row.push((*k, product));
                }
            }
            add_alike(&mut row);
            for (k, t) in row {
                target.push(k);
                block.push(t);
            }
            start.push(target.len());
        }
        LoadMap {
            start,
            target,
            block,
            ..self
        }
    }

    /// Largest `|Σ_q T_qp − 1|` of any point that was condensed: the part of a force that is lost on the way.
    pub fn loss(&self) -> f64 {
        let mut loss = 0.0f64;
        for p in (0..self.points()).filter(|p| self.carries(*p)) {
            for a in 0..D {
                for b in 0..D {
                    let sum: f64 = self.row(p).1.iter().map(|t| t[a][b]).sum();
                    loss = loss.max((sum - f64::from(u8::from(a == b))).abs());
                }
            }
        }
        loss
    }

    pub fn bytes(&self) -> usize {
        8 * (D + 1) * self.points() + 8 * self.start.len() + (4 + 8 * D * D) * self.target.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_passed_on_twice() {
        let position = vec![[0.0], [1.0], [2.0], [3.0]];
        let all = LoadMap::of(position, vec![1.0; 4], 1.0, &[false, true, true, false]);
        assert!(!all.carries(0) && all.carries(1) && all.loss() == 0.0);
        // 0 and 3 are retained: a force at 1 is shared 2:1, then all goes to one point
        let share = |x: f64, y: f64| vec![(0, [[x]]), (1, [[y]])];
        let once = all.passed(&[
            share(1.0, 0.0),
            share(0.75, 0.25),
            share(0.25, 0.75),
            share(0.0, 1.0),
        ]);
        assert_eq!(once.row(1), (&[0, 1][..], &[[[0.75]], [[0.25]]][..]));
        let twice = once.passed(&[vec![(0, [[1.0]])], vec![(0, [[1.0]])]]);
        assert_eq!(twice.row(2), (&[0][..], &[[[1.0]]][..]));
        assert_eq!(twice.reached(1), [true]);
    }
}
