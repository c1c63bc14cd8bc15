//! Where a body is held, and whether that holds it.

use crate::error::Loose;
use peridyne_algebra::symmetric_eigen;

/// Which components of which points are free to move.
#[derive(Debug, Clone, PartialEq)]
pub struct Support<const D: usize> {
    pub free: Vec<[bool; D]>,
}

const TRANSLATIONS: [&str; 3] = [
    "translation along x",
    "translation along y",
    "translation along z",
];

impl<const D: usize> Support<D> {
    pub fn none(points: usize) -> Self {
        Support {
            free: vec![[true; D]; points],
        }
    }

    /// As few components held as hold every part, so that reactions to forces that balance are 0.
    pub fn just_enough(position: &[[f64; D]], part: &[u32], period: &[Option<f64>; D]) -> Self {
        let mut support = Support::none(position.len());
        for members in members(part).iter().filter(|m| !m.is_empty()) {
            let rigid = Rigid::of(position, members, period);
            let count = rigid.motions.len();
            // a basis of the motions that are left
            let mut left: Vec<Vec<f64>> = (0..count)
                .map(|k| (0..count).map(|m| f64::from(m == k)).collect())
                .collect();
            while !left.is_empty() {
                let felt = |i: usize, a: usize, motion: &[f64]| -> f64 {
                    let at = rigid.motions.iter().zip(motion);
                    at.map(|(m, w)| w * rigid.value(m.1, &position[i], a)).sum()
                };
                // the component that moves most is held; of equal ones the first
                let mut most = (0.0, (members[0], 0));
                for &i in members {
                    for a in (0..D).filter(|a| support.free[i][*a]) {
                        let moves: f64 = left.iter().map(|m| felt(i, a, m).powi(2)).sum();
                        if moves > most.0 * (1.0 + 1e-9) {
                            most = (moves, (i, a));
                        }
                    }
                }
                let (moves, (i, a)) = most;
                if moves < 1e-18 {
                    break;
                }
                support.free[i][a] = false;
                let felt: Vec<f64> = left.iter().map(|m| felt(i, a, m)).collect();
                let held = (0..felt.len())
                    .max_by(|p, q| felt[*p].abs().total_cmp(&felt[*q].abs()))
                    .unwrap_or(0);
                let gone = left.swap_remove(held);
                let mut others = felt.clone();
                others.swap_remove(held);
                for (m, f) in left.iter_mut().zip(others) {
                    for (m, g) in m.iter_mut().zip(&gone) {
                        *m -= f / felt[held] * g;
                    }
                }
            }
        }
        support
    }

    /// Number of free components.
    pub fn unknowns(&self) -> usize {
        self.free.iter().flatten().filter(|f| **f).count()
    }

    /// 0 on components that are held.
    pub fn mask(&self, x: &mut [[f64; D]]) {
        for (x, free) in x.iter_mut().zip(&self.free) {
            for a in 0..D {
                if !free[a] {
                    x[a] = 0.0;
                }
            }
        }
    }

    /// Rigid motions that the held components leave to connected parts; `part` labels each point's.
    pub fn loose(
        &self,
        position: &[[f64; D]],
        part: &[u32],
        period: &[Option<f64>; D],
    ) -> Vec<Loose> {
        members(part)
            .iter()
            .filter(|m| !m.is_empty())
            .flat_map(|m| self.loose_part(position, m, period))
            .collect()
    }

    fn loose_part(
        &self,
        position: &[[f64; D]],
        members: &[usize],
        period: &[Option<f64>; D],
    ) -> Vec<Loose> {
        let rigid = Rigid::of(position, members, period);
        let motions = &rigid.motions;
        let value = |axes, i: usize, a: usize| rigid.value(axes, &position[i], a);
        let count = motions.len();
        let mut gram = vec![0.0; count * count];
        for &i in members {
            for a in (0..D).filter(|a| !self.free[i][*a]) {
                for (p, (_, p_axes)) in motions.iter().enumerate() {
                    for (q, (_, q_axes)) in motions.iter().enumerate() {
                        gram[p * count + q] += value(*p_axes, i, a) * value(*q_axes, i, a);
                    }
                }
            }
        }
        let Some((values, vectors)) = symmetric_eigen(count, |p, q| gram[p * count + q]) else {
            return vec![];
        };
        let top = values.iter().copied().fold(1.0, f64::max);
        let null = (0..count).filter(|k| values[*k] < 1e-12 * top);
        let mut found: Vec<usize> = null
            .filter_map(|k| {
                (0..count).max_by(|p, q| vectors[k][*p].abs().total_cmp(&vectors[k][*q].abs()))
            })
            .collect();
        // translations first
        found.sort_unstable();
        found.dedup();
        let named = |n: usize| Loose {
            points: members.len(),
            point: members[0],
            motion: motions[n].0,
        };
        found.into_iter().map(named).collect()
    }
}

/// Points of each part.
fn members(part: &[u32]) -> Vec<Vec<usize>> {
    let parts = part.iter().max().map_or(0, |m| *m as usize + 1);
    let mut members = vec![vec![]; parts];
    for (i, p) in part.iter().enumerate() {
        members[*p as usize].push(i);
    }
    members
}

/// The rigid motions of some points, of size 1.
struct Rigid<const D: usize> {
    center: [f64; D],
    /// From the centre to the farthest point.
    size: f64,
    /// By axes: a translation along the first if both are the same, else a rotation from the first to the second.
    motions: Vec<(&'static str, [usize; 2])>,
}

impl<const D: usize> Rigid<D> {
    fn of(position: &[[f64; D]], members: &[usize], period: &[Option<f64>; D]) -> Self {
        let n = members.len() as f64;
        let center: [f64; D] =
            std::array::from_fn(|a| members.iter().map(|i| position[*i][a]).sum::<f64>() / n);
        let arm = |i: usize, a: usize| position[i][a] - center[a];
        let size = members
            .iter()
            .map(|i| (0..D).map(|a| arm(*i, a).powi(2)).sum::<f64>())
            .fold(0.0, f64::max)
            .sqrt();
        let mut motions: Vec<(&'static str, [usize; 2])> =
            (0..D).map(|a| (TRANSLATIONS[a], [a, a])).collect();
        let planes = [
            ("rotation about z", [0, 1]),
            ("rotation about x", [1, 2]),
            ("rotation about y", [2, 0]),
        ];
        for (name, [m, n]) in planes.into_iter().take(D * (D - 1) / 2) {
            // about the line through all points nothing turns: a bar in the plane still turns about its centre
            let turns = members
                .iter()
                .any(|i| arm(*i, m).abs().max(arm(*i, n).abs()) > 1e-9 * size);
            if size > 0.0 && turns && period[m].is_none() && period[n].is_none() {
                motions.push((name, [m, n]));
            }
        }
        Rigid {
            center,
            size,
            motions,
        }
    }

    /// Component `a` of a motion at `x`.
    fn value(&self, [m, n]: [usize; 2], x: &[f64; D], a: usize) -> f64 {
        let arm = |a: usize| (x[a] - self.center[a]) / self.size;
        match (m == n, a) {
            (true, a) => f64::from(a == m),
            (false, a) if a == m => -arm(n),
            (false, a) if a == n => arm(m),
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loose<const D: usize>(
        held: &[(usize, usize)],
        period: [Option<f64>; D],
    ) -> Vec<&'static str> {
        // corners of a cube (square, segment)
        let position: Vec<[f64; D]> = (0..1 << D)
            .map(|i| std::array::from_fn(|a| f64::from(i >> a & 1)))
            .collect();
        let mut support = Support::<D>::none(position.len());
        for (i, a) in held {
            support.free[*i][*a] = false;
        }
        let part = vec![0; position.len()];
        let found = support.loose(&position, &part, &period);
        found.iter().map(|l| l.motion).collect()
    }

    #[test]
    fn motions_that_nothing_holds_are_named() {
        assert_eq!(loose::<1>(&[], [None]), ["translation along x"]);
        assert!(loose::<1>(&[(1, 0)], [None]).is_empty());
        assert_eq!(
            loose::<2>(&[(0, 0), (0, 1)], [None; 2]),
            ["rotation about z"]
        );
        assert!(loose::<2>(&[(0, 0), (0, 1), (1, 1)], [None; 2]).is_empty());
        // rollers on one side
        assert_eq!(
            loose::<2>(&[(0, 0), (2, 0)], [None; 2]),
            ["translation along y"]
        );
        // nothing turns where an axis is periodic
        assert!(loose::<2>(&[(0, 0), (0, 1)], [Some(2.0), None]).is_empty());
        let pins = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2)];
        assert_eq!(loose::<3>(&pins, [None; 3]), ["rotation about x"]);
        assert!(loose::<3>(&[&pins[..], &[(2, 2)]].concat(), [None; 3]).is_empty());
        assert_eq!(loose::<3>(&[], [None; 3]).len(), 6);
    }

    #[test]
    fn each_part_must_be_held() {
        let position = [[0.0], [1.0], [5.0], [6.0]];
        let mut support = Support::<1>::none(4);
        support.free[0][0] = false;
        let found = support.loose(&position, &[0, 0, 1, 1], &[None]);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].point, found[0].points), (2, 2));
    }

    #[test]
    fn just_enough_is_held() {
        fn held<const D: usize>(parts: usize, period: [Option<f64>; D]) -> usize {
            let per = 1usize << D;
            let position: Vec<[f64; D]> = (0..parts * per)
                .map(|i| std::array::from_fn(|a| (i >> a & 1) as f64 + 3.0 * (i / per) as f64))
                .collect();
            let part: Vec<u32> = (0..parts * per).map(|i| (i / per) as u32).collect();
            let support = Support::just_enough(&position, &part, &period);
            assert!(support.loose(&position, &part, &period).is_empty());
            D * position.len() - support.unknowns()
        }
        assert_eq!(held::<1>(1, [None]), 1);
        assert_eq!(held::<2>(1, [None; 2]), 3);
        assert_eq!(held::<2>(1, [Some(2.0), None]), 2);
        assert_eq!(held::<3>(1, [None; 3]), 6);
        assert_eq!(held::<3>(2, [None; 3]), 12);
    }
}
