//! A crack that is followed: its tip, its length, its branches; how far its faces are apart, and what it cuts off.
//!
//! A crack is the damaged points of a set that are connected, by steps of at most a horizon in the reference, with the place where it starts.
//! A point in the row beside a straight crack of the square lattice has lost 33, 39, 42 % of its bonds (horizons of 2, 3, 4 spacings), one in the
//! next row 8, 21, 27 %: a threshold between the two sees a row on either side.

use std::collections::HashMap;

use crate::body::Body;
use crate::execute::exact::Exact;
use crate::fracture::fragments::Fragments;
use crate::run::system::System;
use crate::space::Point;
use crate::spec::CrackTipSpec;

/// So many horizons behind its tip the speed of a crack is taken: it comes along by one point at a time.
pub(super) const SPEED_OVER: f64 = 3.0;

/// Where a crack ends (length), how far that is along its direction (length), and how many branches it has at most side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tip {
    pub place: Point,
    pub length: f64,
    pub branches: f64,
}

/// A damaged point: its place in the reference, and its id among those of all ranks.
type Damaged = [f64; 4];

/// The tip of a crack through these points (ids) with their damage; all ranks ask at once.
pub(super) fn tip<const D: usize>(
    body: &Body<D>,
    spec: &CrackTipSpec,
    horizon: f64,
    points: impl Iterator<Item = (u32, f64)>,
) -> Tip {
    let damaged = points.filter(|(_, damage)| *damage >= spec.damage);
    let own = damaged.map(|(id, _)| {
        let [x, y, z] = body.position(body.slots()[id as usize] as usize);
        [x, y, z, body.id_of_all(id as usize) as f64]
    });
    let all = body.joined(own.collect::<Vec<Damaged>>());
    let found = all.map(|all| {
        let Tip {
            place: [x, y, z],
            length,
            branches,
        } = of(&all, spec, horizon);
        [x, y, z, length, branches]
    });
    let [x, y, z, length, branches] = body.told(found);
    Tip {
        place: [x, y, z],
        length,
        branches,
    }
}

fn of(damaged: &[Damaged], spec: &CrackTipSpec, horizon: f64) -> Tip {
    let ahead = |p: &Damaged| -> f64 {
        let each = (0..3).map(|a| (p[a] - spec.from[a]) * spec.direction[a]);
        each.sum()
    };
    let mut crack = Near::new(damaged, horizon);
    let [x, y, z] = spec.from;
    let crack = crack.group(&[x, y, z, 0.0]);
    let grown = crack.into_iter().filter(|p| ahead(p) > 0.0);
    let grown: Vec<Damaged> = grown.collect();
    let far =
        |a: &&Damaged, b: &&Damaged| ahead(a).total_cmp(&ahead(b)).then(b[3].total_cmp(&a[3]));
    let Some(end) = grown.iter().max_by(far) else {
        return Tip {
            place: spec.from,
            length: 0.0,
            branches: 0.0,
        };
    };
    let mut slices: HashMap<u64, Vec<Damaged>> = HashMap::new();
    for p in &grown {
        slices
            .entry((ahead(p) / horizon) as u64)
            .or_default()
            .push(*p);
    }
    let branches = slices
        .values()
        .map(|slice| Near::new(slice, horizon).groups());
    Tip {
        place: [end[0], end[1], end[2]],
        length: ahead(end),
        branches: branches.max().unwrap_or(0) as f64,
    }
}

/// How much farther the second of two points is from the first one than in the reference (length), and how far it has moved from it
/// along each axis.
pub(super) fn opening<const D: usize>(system: &System<D>, ends: &[Vec<u32>; 2]) -> Vec<f64> {
    // one rank knows each
    let [from, to] = ends.each_ref().map(|end| {
        let slots = { end.iter() }.map(|id| system.body.slots()[*id as usize] as usize);
        let x = |a: usize| slots.clone().map(|s| system.body.position(s)[a]).collect();
        let u = |a: usize| slots.clone().map(|s| system.u[a][s]).collect();
        let sums: [[Exact; D]; 2] = [crate::array::from_fn(x), crate::array::from_fn(u)];
        sums.map(|sums| system.body.sums(sums))
    });
    let apart = |n: usize| -> [f64; D] { crate::array::from_fn(|a| to[n][a] - from[n][a]) };
    let (xi, eta) = (apart(0), apart(1));
    // |ξ + η| − |ξ| without cancellation
    let size = |v: &dyn Fn(usize) -> f64| (0..D).map(|a| v(a).powi(2)).sum::<f64>().sqrt();
    let (before, now) = (size(&|a| xi[a]), size(&|a| xi[a] + eta[a]));
    let along: f64 = (0..D).map(|a| eta[a] * (2.0 * xi[a] + eta[a])).sum();
    let longer = along / (before + now);
    [longer].into_iter().chain(eta).collect()
}

/// How many pieces of so many points there are, the mass of the one with the most points, and that of all others (mass).
pub(super) fn pieces<const D: usize>(system: &System<D>, points: u32) -> [f64; 3] {
    let pieces = Fragments::of(&system.body, system.interaction.as_ref());
    let count = pieces.size.iter().filter(|size| **size >= points).count();
    let of = |largest: bool| {
        let each = pieces.label.iter().zip(system.body.slots());
        let own = each.filter(|(label, _)| (**label == 0) == largest);
        let mass = |s: usize| system.body.volume().at(s) * system.body.density().at(s);
        system.body.sum(own.map(|(_, slot)| mass(*slot as usize)))
    };
    [count as f64, of(true), of(false)]
}

/// Points in cells as wide as the horizon, which are taken out when they are found.
struct Near {
    horizon: f64,
    cells: HashMap<[i64; 3], Vec<Damaged>>,
}

impl Near {
    fn new(points: &[Damaged], horizon: f64) -> Near {
        let cells = HashMap::with_capacity(points.len());
        let mut near = Near { horizon, cells };
        for p in points {
            near.cells.entry(near.cell(p)).or_default().push(*p);
        }
        near
    }

    fn cell(&self, p: &Damaged) -> [i64; 3] {
        std::array::from_fn(|a| (p[a] / self.horizon).floor() as i64)
    }

    /// Takes those that hang together with a place.
    fn group(&mut self, place: &Damaged) -> Vec<Damaged> {
        // nothing but rounding divides points a horizon apart
        let reach = self.horizon * (1.0 + 1e-9);
        let (mut found, mut next) = (vec![], vec![*place]);
        while let Some(p) = next.pop() {
            let [i, j, k] = self.cell(&p);
            for n in 0..27 {
                let cell = [i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1];
                let Some(points) = self.cells.get_mut(&cell) else {
                    continue;
                };
                let is_near = |q: &mut Damaged| {
                    let square: f64 = (0..3).map(|a| (p[a] - q[a]).powi(2)).sum();
                    square <= reach * reach
                };
                let first = found.len();
                found.extend(points.extract_if(.., is_near));
                next.extend_from_slice(&found[first..]);
            }
        }
        found
    }

    /// How many groups hang together.
    fn groups(mut self) -> usize {
        let mut groups = 0;
        while let Some(p) = self
            .cells
            .values()
            .find_map(|points| points.first().copied())
        {
            self.group(&p);
            self.cells.retain(|_, points| !points.is_empty());
            groups += 1;
        }
        groups
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEC: CrackTipSpec = CrackTipSpec {
        from: [0.0; 3],
        direction: [1.0, 0.0, 0.0],
        damage: 0.35,
    };

    fn found(points: &[[f64; 2]]) -> Tip {
        let each = points.iter().enumerate();
        let all: Vec<Damaged> = each.map(|(n, [x, y])| [*x, *y, 0.0, n as f64]).collect();
        of(&all, &SPEC, 3.0)
    }

    #[test]
    fn a_crack_is_what_hangs_together_with_its_start() {
        let line = |low: i32, high: i32, y: f64| (low..=high).map(move |x| [f64::from(x), y]);
        let straight: Vec<[f64; 2]> = line(-5, 10, 0.5).collect();
        let tip = found(&straight);
        assert_eq!(
            (tip.place, tip.length, tip.branches),
            ([10.0, 0.5, 0.0], 10.0, 1.0)
        );
        // damage of its own farther on, and none at the start
        let apart: Vec<[f64; 2]> = straight.iter().copied().chain(line(14, 20, 0.5)).collect();
        assert_eq!(found(&apart), tip);
        let elsewhere: Vec<[f64; 2]> = line(14, 20, 0.5).collect();
        assert_eq!(
            (found(&elsewhere).length, found(&elsewhere).branches),
            (0.0, 0.0)
        );
        assert_eq!(found(&[]).place, [0.0; 3]);
    }

    #[test]
    fn branches_are_side_by_side_farther_apart_than_a_horizon() {
        let fork = |open: f64| -> Vec<[f64; 2]> {
            let stem = (0..=10).map(|x| [f64::from(x), 0.0]);
            let arms = (11..=30).flat_map(move |x| {
                let x = f64::from(x);
                [1.0, -1.0].map(|side| [x, side * open * (x - 10.0)])
            });
            stem.chain(arms).collect()
        };
        assert_eq!(found(&fork(0.5)).branches, 2.0);
        // 2 · 0.07 · 20 < 3
        assert_eq!(found(&fork(0.07)).branches, 1.0);
        // of two tips that are as far the first point counts
        assert_eq!(found(&fork(0.5)).place, [30.0, 10.0, 0.0]);
        let mut three = fork(0.5);
        three.extend((11..=30).map(|x| [f64::from(x), 0.0]));
        assert_eq!(found(&three).branches, 3.0);
    }
}
