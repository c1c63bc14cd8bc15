use super::super::{CoarsenError, Selection};
use super::bodies::lattice;

#[test]
fn every_nth_point_with_an_offset() {
    let mut plane = lattice([7, 5], 1.0, false, |_, _| 1.0);
    for x in &mut plane.position {
        *x = [0.1 * x[0] + 0.05, 0.2 * x[1] - 3.0];
    }
    let choice = Selection::Every {
        every: [3, 2],
        offset: [1, 0],
    };
    assert_eq!(choice.choose(&plane).unwrap(), [1, 4, 15, 18, 29, 32]);
    assert_eq!(Selection::every(4).choose(&plane).unwrap(), [0, 4, 28, 32]);
    let none = Selection::Every {
        every: [0, 2],
        offset: [0, 0],
    };
    assert_eq!(
        none.choose(&plane),
        Err(CoarsenError::EveryZero { axis: 0 })
    );
    plane.position[9][1] += 0.06;
    let said = Selection::every(2).choose(&plane).unwrap_err().to_string();
    assert!(
        said.contains("do not lie on a lattice along axis 1"),
        "{said}"
    );
    assert_eq!(
        Selection::Marked(vec![3, 1]).choose(&plane).unwrap(),
        [1, 3]
    );
    assert_eq!(
        Selection::Marked(vec![3, 99]).choose(&plane).unwrap_err(),
        CoarsenError::OutOfRange {
            index: 99,
            points: 35
        }
    );
}

#[test]
fn a_sublattice_of_a_crystal_with_a_vacancy() {
    let mut plane = lattice([8, 8], 1.0, false, |_, _| 1.0);
    let every = |k, through| Selection::Sublattice { every: k, through };
    assert_eq!(
        every(2, 0).choose(&plane).unwrap(),
        Selection::every(2).choose(&plane).unwrap()
    );
    // rows shifted by half a step and nearer to each other: a triangular lattice
    for x in &mut plane.position {
        *x = [x[0] + 0.5 * (x[1] % 2.0), 0.75f64.sqrt() * x[1]];
    }
    let kept = every(2, 0).choose(&plane).unwrap();
    assert_eq!(
        kept,
        [0, 2, 4, 6, 17, 19, 21, 23, 32, 34, 36, 38, 49, 51, 53, 55]
    );
    let through = every(2, 9).choose(&plane).unwrap();
    assert!(through.contains(&9) && !through.contains(&0), "{through:?}");
    // without a point the others are still the same
    let mut vacant = plane.clone();
    vacant.position.remove(17);
    vacant.volume.remove(17);
    vacant.density.remove(17);
    vacant.start.truncate(64);
    let kept = every(2, 0).choose(&vacant).unwrap();
    assert_eq!(
        kept,
        [0, 2, 4, 6, 18, 20, 22, 31, 33, 35, 37, 48, 50, 52, 54]
    );
    assert_eq!(
        every(0, 0).choose(&plane),
        Err(CoarsenError::EveryZero { axis: 0 })
    );
}

#[test]
fn blue_noise_fills_without_crowding() {
    let cube = lattice([9, 9, 9], 1.0, true, |_, _| 1.0);
    for selection in [
        Selection::BlueNoise {
            spacing: 2.5,
            seed: 4,
        },
        Selection::Farthest { count: 60, seed: 4 },
    ] {
        let chosen = selection.choose(&cube).unwrap();
        assert_eq!(chosen, selection.choose(&cube).unwrap());
        let distance = |i: usize, j: u32| {
            let xi = cube.xi(i, j as usize);
            xi.iter().map(|x| x * x).sum::<f64>().sqrt()
        };
        let nearest = |i: usize| {
            let others = chosen.iter().filter(|j| **j as usize != i);
            others
                .map(|j| distance(i, *j))
                .fold(f64::INFINITY, f64::min)
        };
        let crowd = chosen
            .iter()
            .map(|i| nearest(*i as usize))
            .fold(f64::INFINITY, f64::min);
        let gap = (0..cube.points())
            .filter(|i| !chosen.contains(&(*i as u32)))
            .map(nearest)
            .fold(0.0, f64::max);
        assert!(
            crowd >= gap && gap > 1.0,
            "{selection:?}: {} {crowd} {gap}",
            chosen.len()
        );
    }
    let other = Selection::BlueNoise {
        spacing: 2.5,
        seed: 5,
    }
    .choose(&cube)
    .unwrap();
    assert_ne!(
        other,
        Selection::BlueNoise {
            spacing: 2.5,
            seed: 4
        }
        .choose(&cube)
        .unwrap()
    );
    assert_eq!(
        Selection::BlueNoise {
            spacing: -1.0,
            seed: 0
        }
        .choose(&cube),
        Err(CoarsenError::Spacing(-1.0))
    );
    assert_eq!(
        Selection::Farthest { count: 0, seed: 0 }.choose(&cube),
        Err(CoarsenError::Count {
            count: 0,
            points: 729
        })
    );
    assert_eq!(
        Selection::Farthest {
            count: 729,
            seed: 0
        }
        .choose(&cube)
        .unwrap()
        .len(),
        729
    );
}
