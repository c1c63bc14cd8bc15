//! The face of a body that a set of its lattice sites stands for.

use super::lattice::LatticeKind;
use std::collections::HashMap;

/// A site in quarters of the cell's edges.
pub type Site = [i32; 3];

/// How many times larger one side of a set must be than any other to be the one that is meant.
const CLEAR: f64 = 2.0;

/// Why a set stands for no face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoFace {
    /// There is no body behind it along any axis, or the same on both sides.
    NoSide,
    /// As much of the body lies beside it as behind it.
    Corner,
    /// Points of the body lie before it.
    Covered,
    /// Its outer points lie in no plane across an axis.
    Uneven,
}

impl NoFace {
    pub fn reason(self) -> &'static str {
        match self {
            NoFace::NoSide => "the body lies behind it on no side, or on opposite ones",
            NoFace::Corner => "it lies at an edge or a corner, and may stand for either face",
            NoFace::Covered => "points of the body lie in front of it",
            NoFace::Uneven => "its outer points do not lie in one plane across an axis",
        }
    }
}

/// Sites of a body near a set.
pub struct Sites<'a> {
    pub kind: LatticeKind,
    /// Length.
    pub spacing: f64,
    /// Volumes of the points of the body (length^D times the section).
    pub body: &'a HashMap<Site, f64>,
    /// Periods in quarters.
    pub period: [Option<i32>; 3],
    /// The body ends at its outer points, which hold half a cell across a face.
    pub ends_at_points: bool,
}

impl Sites<'_> {
    fn edge(&self, axis: usize) -> f64 {
        self.spacing * self.kind.edges()[axis]
    }

    /// The site so many quarters along each axis.
    fn moved(&self, q: Site, by: Site) -> Site {
        let low = |a: usize| self.period[a].map(|p| (q[a] + by[a]).rem_euclid(p));
        crate::array::from_fn(|a| low(a).unwrap_or(q[a] + by[a]))
    }

    fn along(&self, q: Site, axis: usize, cells: i32) -> Site {
        let mut by = [0; 3];
        by[axis] = 4 * cells;
        self.moved(q, by)
    }

    /// Share of the loaded face that each site of a set has (area): `A V_i / Σ V` of the face A of each connected part.
    ///
    /// A part is loaded from the side that the body does not lie on. A is the sum over its outer points of `V / (m d)`: V the
    /// volume of a point that reaches through the face, d the distance of the lattice's planes across the axis, m how many
    /// planes the outer points lie in (of bcc and fcc the corner and the centre sites).
    ///
    /// # Errors
    /// Some part stands for no flat face across an axis.
    pub fn shares(&self, set: &[Site]) -> Result<Vec<f64>, NoFace> {
        let wrap = |q: &Site| self.moved(*q, [0; 3]);
        let place: HashMap<Site, usize> =
            set.iter().enumerate().map(|(n, q)| (wrap(q), n)).collect();
        let mut shares = vec![0.0; set.len()];
        for part in self.parts(&place, set.len()) {
            let volume = |q: &Site| self.body.get(&wrap(q)).copied().unwrap_or(0.0);
            let own: f64 = part.iter().map(|n| volume(&set[*n])).sum();
            let area = self.area(&part, set, &place)?;
            for n in part {
                shares[n] = area * volume(&set[n]) / own;
            }
        }
        Ok(shares)
    }

    /// Sites that hang together.
    fn parts(&self, place: &HashMap<Site, usize>, count: usize) -> Vec<Vec<usize>> {
        let dimension = self.kind.dimension();
        let reach = |a: usize| if a < dimension { -1..=1 } else { 0..=0 };
        let basis = self.kind.basis();
        let mut part = vec![usize::MAX; count];
        let mut parts: Vec<Vec<usize>> = vec![];
        let mut order: Vec<(&Site, &usize)> = place.iter().collect();
        order.sort_unstable_by_key(|(_, n)| **n);
        for (first, n) in order {
            if part[*n] != usize::MAX {
                continue;
            }
            let number = parts.len();
            let (mut found, mut waiting) = (vec![], vec![(*first, *n)]);
            part[*n] = number;
            while let Some((q, n)) = waiting.pop() {
                found.push(n);
                let cell = q.map(|c| c - c.rem_euclid(4));
                for (i, j, k) in reach(0)
                    .flat_map(|i| reach(1).flat_map(move |j| reach(2).map(move |k| (i, j, k))))
                {
                    for b in basis {
                        let by = [4 * i + b[0], 4 * j + b[1], 4 * k + b[2]];
                        let other = self.moved(cell, by);
                        if let Some(m) = place.get(&other)
                            && part[*m] == usize::MAX
                        {
                            part[*m] = number;
                            waiting.push((other, *m));
                        }
                    }
                }
            }
            found.sort_unstable();
            parts.push(found);
        }
        parts
    }

    /// The axis across the face of a part, and the side that its face looks to.
    fn side(
        &self,
        part: &[usize],
        set: &[Site],
        place: &HashMap<Site, usize>,
    ) -> Result<(usize, i32), NoFace> {
        let beside = |q: Site, a: usize, way: i32| {
            let other = self.along(q, a, way);
            self.body.contains_key(&other) && !place.contains_key(&other)
        };
        // how much more of the body lies below it than above, as an area
        let mut behind: Vec<(f64, usize, i32)> = vec![];
        for a in (0..self.kind.dimension()).filter(|a| self.period[*a].is_none()) {
            let count = |way: i32| part.iter().filter(|n| beside(set[**n], a, way)).count() as f64;
            let more = count(-1) - count(1);
            let way = if more > 0.0 { 1 } else { -1 };
            behind.push((more.abs() / self.kind.edges()[a], a, way));
        }
        behind.sort_by(|a, b| b.0.total_cmp(&a.0));
        match behind[..] {
            [(most, ..), (next, ..), ..] if most > 0.0 && most < CLEAR * next => {
                Err(NoFace::Corner)
            }
            [(most, axis, way), ..] if most > 0.0 => Ok((axis, way)),
            _ => Err(NoFace::NoSide),
        }
    }

    fn area(
        &self,
        part: &[usize],
        set: &[Site],
        place: &HashMap<Site, usize>,
    ) -> Result<f64, NoFace> {
        let (axis, way) = self.side(part, set, place)?;
        let outer = |n: &&usize| !place.contains_key(&self.along(set[**n], axis, way));
        let outer: Vec<Site> = part.iter().filter(outer).map(|n| set[*n]).collect();
        if outer
            .iter()
            .any(|q| self.body.contains_key(&self.along(*q, axis, way)))
        {
            return Err(NoFace::Covered);
        }
        let mut planes: Vec<i32> = outer.iter().map(|q| way * q[axis]).collect();
        planes.sort_unstable();
        planes.dedup();
        if planes.iter().any(|p| planes[planes.len() - 1] - p >= 4) {
            return Err(NoFace::Uneven);
        }
        let distance = self.edge(axis) / f64::from(self.kind.planes(axis));
        let volume = |q: Site| self.body.get(&q).copied().unwrap_or(0.0);
        let through = |q: &Site| match self.ends_at_points {
            true => 2.0 * volume(self.moved(*q, [0; 3])),
            // a point that holds part of its cell lies at the face
            false => volume(self.moved(*q, [0; 3])).max(volume(self.along(*q, axis, -way))),
        };
        let all: f64 = match (&outer[..], outer.iter().map(through)) {
            ([], _) => 0.0,
            ([first, ..], mut each) => {
                let one = through(first);
                // as many times as there are points, where they are alike
                match outer.iter().all(|q| through(q) == one) {
                    true => one * outer.len() as f64,
                    false => each.by_ref().sum(),
                }
            }
        };
        Ok(all / (planes.len() as f64 * distance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sites of a block of so many cells and the area of those of them that `chosen` holds for.
    fn area(
        kind: LatticeKind,
        cells: [i32; 3],
        chosen: impl Fn(&Site) -> bool,
    ) -> Result<f64, NoFace> {
        let d = kind.dimension();
        let mut body = HashMap::new();
        let volume = kind.site_volume();
        let end = |a: usize| if a < d { 0..cells[a] } else { 0..1 };
        for (i, j, k) in
            end(0).flat_map(|i| end(1).flat_map(move |j| end(2).map(move |k| (i, j, k))))
        {
            for b in kind.basis() {
                body.insert([4 * i + b[0], 4 * j + b[1], 4 * k + b[2]], volume);
            }
        }
        let mut set: Vec<Site> = body.keys().copied().filter(chosen).collect();
        set.sort_unstable();
        let sites = Sites {
            kind,
            spacing: 1.0,
            body: &body,
            period: [None; 3],
            ends_at_points: false,
        };
        sites.shares(&set).map(|s| s.iter().sum())
    }

    #[test]
    fn a_face_of_any_lattice_has_the_area_of_its_cells() {
        let root3 = 3.0f64.sqrt();
        for (kind, axis, wanted) in [
            (LatticeKind::Chain, 0, 1.0),
            (LatticeKind::Square, 0, 6.0),
            (LatticeKind::Square, 1, 5.0),
            (LatticeKind::Triangular, 0, 6.0 * root3),
            (LatticeKind::Triangular, 1, 5.0),
            (LatticeKind::Cubic, 2, 30.0),
            (LatticeKind::Bcc, 2, 30.0),
            (LatticeKind::Fcc, 1, 35.0),
            (LatticeKind::Diamond, 0, 42.0),
        ] {
            let cells = [5, 6, 7];
            let most = 4 * cells[axis] - 1;
            // from the thinnest layer that holds any site to several cells
            for depth in 1..=12 {
                let found = area(kind, cells, |q| q[axis] > most - depth);
                let found = found.unwrap();
                if depth < 4 && found == 0.0 {
                    continue;
                }
                assert!(
                    (found / wanted - 1.0).abs() < 1e-12,
                    "{kind:?} {axis} {depth}: {found}"
                );
                let low = area(kind, cells, |q| q[axis] < 4).unwrap();
                assert!((low / wanted - 1.0).abs() < 1e-12, "{kind:?} {axis}: {low}");
            }
        }
    }

    #[test]
    fn both_ends_and_patches() {
        let cubic = |chosen: fn(&Site) -> bool| area(LatticeKind::Cubic, [8, 8, 8], chosen);
        let near = |found: Result<f64, NoFace>, wanted: f64| {
            assert!((found.unwrap() / wanted - 1.0).abs() < 1e-12);
        };
        near(cubic(|q| q[2] < 4 || q[2] > 24), 128.0);
        // a patch of 4 × 4 columns, two layers deep, at an edge of the top
        near(
            cubic(|q| q[2] > 20 && q[0] < 16 && (8..24).contains(&q[1])),
            16.0,
        );
        assert_eq!(cubic(|q| q[2] > 24 && q[0] > 24), Err(NoFace::Corner));
        assert_eq!(cubic(|_| true), Err(NoFace::NoSide));
        assert_eq!(cubic(|q| (8..16).contains(&q[2])), Err(NoFace::NoSide));
        // a strip of the side, two rows high; a step; under others
        near(cubic(|q| q[2] >= 16 && q[2] < 24 && q[0] < 4), 16.0);
        assert_eq!(cubic(|q| q[2] >= 24 && q[0] >= 8 || q[2] == 0), Ok(112.0));
        let step = |q: &Site| q[2] == 28 && q[0] < 16 || q[2] < 28 && q[2] >= 20 && q[0] >= 16;
        assert_eq!(cubic(step), Err(NoFace::Covered));
    }
}
