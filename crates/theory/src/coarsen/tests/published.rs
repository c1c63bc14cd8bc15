//! The published equations in plain loops on dense matrices, against what the product makes of them.

use super::super::balls::Task;
use super::super::rows::rows;
use super::super::{
    CoarsenError, LinearBody, Options, Radius, Report, Scheme, Selection, Stability, coarsen,
};
use super::bodies::{random, state_based};

/// `A X = B` by Gaussian elimination with pivots; the columns of `b` become those of X.
fn eliminate(mut a: Vec<Vec<f64>>, mut b: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = a.len();
    for k in 0..n {
        let pivot = (k..n)
            .max_by(|p, q| a[*p][k].abs().total_cmp(&a[*q][k].abs()))
            .unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in (0..n).filter(|i| *i != k) {
            let factor = a[i][k] / a[k][k];
            if factor != 0.0 {
                for j in k..n {
                    a[i][j] -= factor * a[k][j];
                }
                for j in 0..b[i].len() {
                    b[i][j] -= factor * b[k][j];
                }
            }
        }
    }
    for i in 0..n {
        let pivot = a[i][i];
        b[i].iter_mut().for_each(|x| *x /= pivot);
    }
    b
}

/// Coarse micromoduli of retained point `i` and every other retained point of its closed ball, by section 4 of silling2010 with v
/// once (erratum 1) and P within the ball (erratum 2).
pub fn dense_row<const D: usize>(
    body: &LinearBody<D>,
    retained: &[u32],
    i: usize,
    radius: f64,
) -> Vec<(usize, [[f64; D]; D])> {
    let distance = |p: usize| {
        let xi = body.xi(i, p);
        xi.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    let inside: Vec<usize> = (0..body.points())
        .filter(|p| distance(*p) <= radius + 1e-9)
        .collect();
    let kept = |p: usize| retained.contains(&(p as u32));
    let rim: Vec<usize> = inside.iter().copied().filter(|p| kept(*p)).collect();
    let c = |z: usize, p: usize| body.micromodulus(z, p).copied().unwrap_or([[0.0; D]; D]);
    let n = D * inside.len();
    let mut a = vec![vec![0.0; n]; n];
    let mut b = vec![vec![0.0; D * rim.len()]; n];
    for (m, &z) in inside.iter().enumerate() {
        for s in 0..D {
            if kept(z) {
                a[D * m + s][D * m + s] = 1.0;
                let q = rim.iter().position(|q| *q == z).unwrap();
                b[D * m + s][D * q + s] = 1.0;
                continue;
            }
            for (k, &p) in inside.iter().enumerate().filter(|(_, p)| **p != z) {
                for t in 0..D {
                    a[D * m + s][D * k + t] += c(z, p)[s][t];
                    a[D * m + s][D * m + t] -= c(z, p)[s][t];
                }
            }
        }
    }
    let resolvent = eliminate(a, b);
    (rim.iter().enumerate())
        .filter(|(_, q)| **q != i)
        .map(|(j, &q)| {
            let mut row = [[0.0; D]; D];
            for (k, &p) in inside.iter().enumerate().filter(|(_, p)| **p != i) {
                for s in 0..D {
                    for t in 0..D {
                        for m in 0..D {
                            row[s][t] += c(i, p)[s][m] * resolvent[D * k + m][D * j + t];
                        }
                    }
                }
            }
            (q, row)
        })
        .collect()
}

/// Largest difference of all rows of balls from the dense ones, over the largest; and how many balls were solved by LU. What would
/// be refused as a body is compared, too.
fn apart<const D: usize>(body: &LinearBody<D>, every: u32, radius: f64) -> (f64, usize) {
    let keep = Selection::every(every).choose(body).unwrap();
    let marked: Vec<bool> = (0..body.points() as u32)
        .map(|i| keep.contains(&i))
        .collect();
    let task = Task {
        body,
        retained: &keep,
        marked: &marked,
        range: body.range(),
        asymmetry: body.soundness().asymmetry,
        loaded: &vec![false; body.points()],
        shaped: false,
    };
    let made = rows(&task, radius).unwrap();
    let (mut off, mut most) = (0.0f64, 0.0f64);
    for (k, &i) in keep.iter().enumerate() {
        for (q, dense) in dense_row(body, &keep, i as usize, radius) {
            let at = keep.binary_search(&(q as u32)).unwrap() as u32;
            let found = made.coupling.rows[k].iter().find(|r| r.0 == at);
            let found = found.map_or([[0.0; D]; D], |r| r.1);
            for s in 0..D {
                for t in 0..D {
                    let dense = body.volume[i as usize] * dense[s][t];
                    off = off.max((found[s][t] - dense).abs());
                    most = most.max(dense.abs());
                }
            }
        }
    }
    (off / most, made.work.direct)
}

#[test]
fn rows_of_state_based_bodies_are_those_of_the_dense_equations() {
    for bulk in [0.05, 0.3, 1.0] {
        let plate = state_based([9, 8], bulk);
        for radius in [4.0, 5.0] {
            let (off, direct) = apart(&plate, 2, radius);
            assert!(off < 1e-10, "bulk {bulk}, radius {radius}: {off}");
            // free balls cut families: their matrices are not symmetric
            assert!(direct > 0);
        }
    }
}

#[test]
fn rows_of_central_bonds_are_those_of_the_dense_equations() {
    let (off, direct) = apart(&random([9, 8], false, 10.0), 3, 4.0);
    assert!(off < 1e-10 && direct == 0, "{off} {direct}");
    let (off, direct) = apart(&random([5, 4, 4], false, 10.0), 2, 2.5);
    assert!(off < 1e-10 && direct == 0, "{off} {direct}");
}

/// What the product says of the rows of a state-based plate.
fn told(bulk: f64, radius: f64) -> Result<Report, CoarsenError> {
    let plate = state_based([9, 8], bulk);
    let keep = Selection::every(2).choose(&plate).unwrap();
    let options = Options {
        scheme: Scheme::Rows,
        radius: Radius::Fixed(radius),
        rotation: 1.0,
        ..Options::default()
    };
    coarsen(&plate, &keep, &options).map(|c| c.1)
}

#[test]
fn what_rows_do_to_state_based_bodies_is_diagnosed() {
    // a ball of the whole body is the Schur complement
    for bulk in [0.05, 0.3, 1.0] {
        let whole = told(bulk, 20.0).unwrap();
        assert!(
            whole.definite && whole.soundness.rotation < 1e-13,
            "{whole:?}"
        );
    }
    // stable, but rotations meet forces (erratum 8)
    let turned = told(0.05, 5.0).unwrap();
    assert!(
        matches!(turned.stability, Stability::Stable { .. }),
        "{turned:?}"
    );
    assert!(turned.soundness.rotation > 1e-3, "{turned:?}");
    // removed points of a sound body have an equilibrium in every ball; what is unstable is the coarse body
    for (bulk, radius) in [(0.1, 4.0), (0.1, 5.0), (0.3, 4.0), (0.3, 5.0), (1.0, 4.0)] {
        let refused = told(bulk, radius).unwrap_err();
        assert!(
            matches!(
                refused,
                CoarsenError::Repelled { .. } | CoarsenError::Rotation { .. }
            ),
            "{bulk} {radius}: {refused}"
        );
    }
}
