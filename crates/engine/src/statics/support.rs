//! Where a body is held, and whether that holds it.

use crate::error::{Loose, SolveError};
use crate::spec::LinearBody;
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
        Support::none(position.len()).completed(position, part, period)
    }

    /// These components, and as few others as hold every part with them.
    pub fn completed(
        &self,
        position: &[[f64; D]],
        part: &[u32],
        period: &[Option<f64>; D],
    ) -> Self {
        let mut support = self.clone();
        for members in members(part).iter().filter(|m| !m.is_empty()) {
            let rigid = Rigid::of(position, members, period);
            let count = rigid.motions.len();
            // a basis of the motions that are left
            let mut left: Vec<Vec<f64>> = (0..count)
                .map(|k| (0..count).map(|m| f64::from(m == k)).collect())
                .collect();
            // what is held takes its part of them first
            for free in [false, true] {
                while let Some((i, a)) = self.most_moved(&rigid, position, members, &left, free) {
                    support.free[i][a] = false;
                    let felt = left.iter().map(|m| rigid.felt(m, &position[i], a));
                    let felt = felt.collect();
                    hold(&mut left, felt);
                }
            }
        }
        support
    }

    /// The component (free or held here) that these motions move most; of equal ones the first, and none that they do not move.
    fn most_moved(
        &self,
        rigid: &Rigid<D>,
        position: &[[f64; D]],
        members: &[usize],
        left: &[Vec<f64>],
        free: bool,
    ) -> Option<(usize, usize)> {
        let mut most = (0.0, None);
        for &i in members {
            for a in (0..D).filter(|a| self.free[i][*a] == free) {
                let felt = left.iter().map(|m| rigid.felt(m, &position[i], a).powi(2));
                let moves: f64 = felt.sum();
                if moves > most.0 * (1.0 + 1e-9) {
                    most = (moves, Some((i, a)));
                }
            }
        }
        most.1.filter(|_| most.0 >= 1e-18)
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

    /// Points that nothing resists at all (whose bonds have broken, or span no space) held besides: they rest where they are.
    pub fn resisted(&self, body: &LinearBody<D>) -> Support<D> {
        let mut support = self.clone();
        for (i, free) in support.free.iter_mut().enumerate() {
            let mut numbers = body.row(i).1.iter().flatten().flatten();
            if numbers.all(|c| *c == 0.0) {
                *free = [false; D];
            }
        }
        support
    }

    /// Does no force (per point) act where only `resisted` holds a point?
    ///
    /// # Errors
    /// One does, and nothing holds that point.
    pub fn rests(&self, resisted: &Support<D>, force: &[[f64; D]]) -> Result<(), SolveError> {
        for (i, force) in force.iter().enumerate() {
            let loose = |a: usize| self.free[i][a] && !resisted.free[i][a] && force[a] != 0.0;
            if (0..D).any(loose) {
                return Err(SolveError::Unheld {
                    points: 1,
                    point: i,
                });
            }
        }
        Ok(())
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

/// What is left of the motions where a component that feels so much of each is held.
fn hold(left: &mut Vec<Vec<f64>>, felt: Vec<f64>) {
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
            crate::array::from_fn(|a| members.iter().map(|i| position[*i][a]).sum::<f64>() / n);
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

    /// Component `a` at `x` of a sum of motions.
    fn felt(&self, motion: &[f64], x: &[f64; D], a: usize) -> f64 {
        let at = self.motions.iter().zip(motion);
        at.map(|(m, w)| w * self.value(m.1, x, a)).sum()
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
            .map(|i| crate::array::from_fn(|a| f64::from(i >> a & 1)))
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
    fn what_is_held_is_completed() {
        let position: Vec<[f64; 2]> = (0..4)
            .map(|i| [f64::from(i % 2), f64::from(i / 2)])
            .collect();
        let part = [0; 4];
        // a roller, a pin, and two rollers across each other's way
        for (held, more) in [
            (&[(0, 1)][..], 2),
            (&[(3, 0), (3, 1)][..], 1),
            (&[(0, 0), (2, 0)][..], 1),
            (&[(0, 0), (0, 1), (1, 1)][..], 0),
        ] {
            let mut given = Support::<2>::none(4);
            for (i, a) in held {
                given.free[*i][*a] = false;
            }
            let all = given.completed(&position, &part, &[None; 2]);
            assert!(
                all.loose(&position, &part, &[None; 2]).is_empty(),
                "{held:?}"
            );
            assert_eq!(given.unknowns() - all.unknowns(), more, "{held:?}");
            assert!(held.iter().all(|(i, a)| !all.free[*i][*a]), "{held:?}");
        }
        // a point by itself
        let mut roller = Support::<2>::none(1);
        roller.free[0][0] = false;
        let all = roller.completed(&[[3.0, 4.0]], &[0], &[None; 2]);
        assert_eq!(all.unknowns(), 0);
    }

    #[test]
    fn points_that_nothing_resists_rest() {
        // a spring from 0 to 1, and a point that has lost its own
        let body = LinearBody::<1> {
            position: vec![[0.0], [1.0], [2.0]],
            volume: vec![1.0; 3],
            density: vec![1.0; 3],
            period: [None],
            start: vec![0, 1, 3, 4],
            partner: vec![1, 0, 2, 1],
            block: [2.0, 2.0, 0.0, 0.0].map(|c| [[c]]).to_vec(),
            load_map: None,
            mass: None,
        };
        let mut support = Support::none(3);
        support.free[0][0] = false;
        let resisted = support.resisted(&body);
        assert_eq!(resisted.free, [[false], [true], [false]]);
        assert!(support.rests(&resisted, &[[5.0], [3.0], [0.0]]).is_ok());
        let said = support
            .rests(&resisted, &[[0.0], [0.0], [1e-9]])
            .unwrap_err();
        assert!(
            said.to_string()
                .contains("nothing holds point 2, and a load acts on it")
        );
    }

    #[test]
    fn just_enough_is_held() {
        fn held<const D: usize>(parts: usize, period: [Option<f64>; D]) -> usize {
            let per = 1usize << D;
            let position: Vec<[f64; D]> = (0..parts * per)
                .map(|i| crate::array::from_fn(|a| (i >> a & 1) as f64 + 3.0 * (i / per) as f64))
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
