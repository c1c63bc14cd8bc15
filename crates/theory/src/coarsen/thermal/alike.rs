//! Which atoms have the same surroundings, and which bonds are therefore the same.

use super::super::near::Near;
use std::collections::HashMap;

/// Vectors nearer to each other than this part of the shortest bond are one.
const SAME: f64 = 1e-3;

/// Bonds from an atom of one class to an atom of another, all along one vector.
pub(super) struct Kind<const D: usize> {
    pub from: u32,
    pub xi: [f64; D],
    /// The kind of the same bonds seen from their other ends.
    pub opposite: u32,
}

/// Atoms by their surroundings within a radius, and all bonds that short.
pub(super) struct Alike<const D: usize> {
    /// `[N]`
    pub class: Vec<u32>,
    /// Atoms of each class.
    pub members: Vec<Vec<u32>>,
    /// `[N + 1]`: where the bonds of each atom begin.
    pub start: Vec<usize>,
    pub partner: Vec<u32>,
    /// Of each bond.
    pub kind: Vec<u32>,
    pub kinds: Vec<Kind<D>>,
    pub vectors: Vectors<D>,
}

/// Vectors with numbers, found again though they are off by round-off.
pub(super) struct Vectors<const D: usize> {
    size: f64,
    cells: HashMap<[i64; D], Vec<u32>>,
    pub all: Vec<[f64; D]>,
}

impl<const D: usize> Vectors<D> {
    fn new(size: f64) -> Vectors<D> {
        Vectors {
            size,
            cells: HashMap::new(),
            all: vec![],
        }
    }

    fn cell(&self, x: &[f64; D]) -> [i64; D] {
        x.map(|c| (c / self.size).floor() as i64)
    }

    pub fn find(&self, x: &[f64; D]) -> Option<u32> {
        let home = self.cell(x);
        let near = |v: &&u32| {
            let v = &self.all[**v as usize];
            (0..D).map(|a| (v[a] - x[a]).powi(2)).sum::<f64>() < self.size * self.size
        };
        (0..3usize.pow(D as u32)).find_map(|n| {
            let cell = std::array::from_fn(|a| home[a] + (n / 3usize.pow(a as u32) % 3) as i64 - 1);
            self.cells.get(&cell)?.iter().find(near).copied()
        })
    }

    fn number(&mut self, x: &[f64; D]) -> u32 {
        self.find(x).unwrap_or_else(|| {
            let new = self.all.len() as u32;
            self.all.push(*x);
            self.cells.entry(self.cell(x)).or_default().push(new);
            new
        })
    }

    /// How far two vectors may be apart that are one (length).
    pub fn size(&self) -> f64 {
        self.size
    }
}

impl<const D: usize> Alike<D> {
    /// Of atoms at their sites, each of a kind; `None`: no two are within the radius, or a bond has no other end.
    pub fn new(
        sites: &[[f64; D]],
        kind: &[u32],
        period: [Option<f64>; D],
        radius: f64,
    ) -> Option<Alike<D>> {
        let near = Near::of(sites.iter().copied(), radius, period);
        let bonds: Vec<Vec<(u32, [f64; D])>> = (sites.iter().enumerate())
            .map(|(i, x)| {
                let mut found = near.within(*x, radius);
                found.retain(|(j, _)| *j as usize != i);
                found
            })
            .collect();
        let squared = |xi: &[f64; D]| xi.iter().map(|c| c * c).sum::<f64>();
        let each = bonds.iter().flatten().map(|(_, xi)| squared(xi));
        let shortest = each.fold(f64::INFINITY, f64::min).sqrt();
        if !(shortest.is_finite() && shortest > 0.0) {
            return None;
        }
        let mut vectors = Vectors::new(SAME * shortest);
        let along: Vec<Vec<u32>> = (bonds.iter())
            .map(|row| row.iter().map(|(_, xi)| vectors.number(xi)).collect())
            .collect();
        let mut known: HashMap<(u32, Vec<(u32, u32)>), u32> = HashMap::new();
        let mut members: Vec<Vec<u32>> = vec![];
        let mut class = vec![];
        for (i, (row, along)) in bonds.iter().zip(&along).enumerate() {
            let around = along.iter().zip(row);
            let mut around: Vec<(u32, u32)> =
                around.map(|(v, (j, _))| (*v, kind[*j as usize])).collect();
            around.sort_unstable();
            let next = known.len() as u32;
            let c = *known.entry((kind[i], around)).or_insert(next);
            if c == next {
                members.push(vec![]);
            }
            members[c as usize].push(i as u32);
            class.push(c);
        }
        let mut numbers: HashMap<(u32, u32, u32), u32> = HashMap::new();
        let mut ends = vec![];
        let (mut start, mut partner, mut of) = (vec![0], vec![], vec![]);
        for (i, (row, along)) in bonds.iter().zip(&along).enumerate() {
            for ((j, _), v) in row.iter().zip(along) {
                let key = (class[i], class[*j as usize], *v);
                let next = numbers.len() as u32;
                let number = *numbers.entry(key).or_insert(next);
                if number == next {
                    ends.push(key);
                }
                partner.push(*j);
                of.push(number);
            }
            start.push(partner.len());
        }
        let kinds: Option<Vec<Kind<D>>> = (ends.iter())
            .map(|(from, to, v)| {
                let xi = vectors.all[*v as usize];
                let back = vectors.find(&xi.map(|c| -c))?;
                let opposite = *numbers.get(&(*to, *from, back))?;
                Some(Kind {
                    from: *from,
                    xi,
                    opposite,
                })
            })
            .collect();
        Some(Alike {
            class,
            members,
            start,
            partner,
            kind: of,
            kinds: kinds?,
            vectors,
        })
    }

    pub fn atoms(&self) -> usize {
        self.class.len()
    }

    /// Partners of an atom, and the kinds of its bonds.
    pub fn bonds(&self, i: usize) -> impl Iterator<Item = (usize, usize)> {
        let row = self.start[i]..self.start[i + 1];
        let partners = self.partner[row.clone()].iter();
        let each = partners.zip(&self.kind[row]);
        each.map(|(j, k)| (*j as usize, *k as usize))
    }
}
