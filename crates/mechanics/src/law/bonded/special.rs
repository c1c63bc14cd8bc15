//! Pairs of points that are a few bonds apart.

use crate::spec::BondedSpec;
use std::collections::BTreeMap;

/// All pairs that are one, two or three bonds apart, by the shortest way, in order of their points.
pub fn special_pairs(spec: &BondedSpec) -> Vec<([u32; 2], usize)> {
    let mut near: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for term in &spec.terms {
        if spec.forms[term.form as usize].particles() == 2 {
            let [a, b, ..] = term.points;
            near.entry(a).or_default().push(b);
            near.entry(b).or_default().push(a);
        }
    }
    let mut found = vec![];
    for start in near.keys() {
        let mut apart = BTreeMap::from([(*start, 0)]);
        let mut shell = vec![*start];
        for distance in 1..=3 {
            let mut next = vec![];
            for point in shell.iter().flat_map(|p| &near[p]) {
                if !apart.contains_key(point) {
                    apart.insert(*point, distance);
                    next.push(*point);
                }
            }
            shell = next;
        }
        let after = apart.into_iter().filter(|(p, _)| p > start);
        found.extend(after.map(|(p, distance)| ([*start, p], distance)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{BondedTerm, Form};

    /// A ring of five with a tail: no way around is longer than two.
    #[test]
    fn the_shortest_way_counts() {
        let bond = |a, b| BondedTerm {
            form: 0,
            points: [a, b, 0, 0],
        };
        let spec = BondedSpec {
            forms: vec![Form::HarmonicBond {
                stiffness: 1.0,
                length: 1.0,
            }],
            terms: vec![
                bond(0, 1),
                bond(1, 2),
                bond(2, 3),
                bond(3, 4),
                bond(4, 0),
                bond(5, 0),
            ],
            special: [0.0; 3],
        };
        let pairs = special_pairs(&spec);
        let of = |distance| pairs.iter().filter(|p| p.1 == distance).count();
        assert_eq!([of(1), of(2), of(3)], [6, 7, 2]);
        assert!(pairs.contains(&([2, 5], 3)) && pairs.contains(&([3, 5], 3)));
    }
}
