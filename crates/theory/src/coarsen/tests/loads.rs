//! Loads that act on removed points, and bodies without symmetry.

use super::super::{LinearBody, Options, Radius, Scheme, Selection, Stability, coarsen};
use super::bodies::{apart, equilibrium, random, state_based};
use peridyne::spec::LoadMap;

fn with(scheme: Scheme, radius: f64) -> Options {
    Options {
        scheme,
        radius: Radius::Fixed(radius),
        rotation: 1.0,
        ..Options::default()
    }
}

/// Every k-th point and all that are held at x = 0.
fn kept(body: &LinearBody<2>, k: u32) -> Vec<u32> {
    let mut keep = Selection::every(k).choose(body).unwrap();
    keep.extend((0..body.points() as u32).filter(|i| body.position[*i as usize][0] == 0.0));
    keep.sort_unstable();
    keep.dedup();
    keep
}

/// A body of which the points at x ≥ `from` carry loads.
fn carrying(mut body: LinearBody<2>, from: f64) -> LinearBody<2> {
    let loaded: Vec<bool> = body.position.iter().map(|x| x[0] >= from).collect();
    let (position, volume) = (body.position.clone(), body.volume.clone());
    body.load_map = Some(LoadMap::of(position, volume, 1.0, &loaded));
    body
}

/// A force density that is different everywhere.
fn density(x: &[f64; 2]) -> [f64; 2] {
    [0.01 + 0.002 * x[1], 0.003 * x[0] - 0.001 * x[1]]
}

/// Displacements, held at x = 0, under the loads that reach the points of a body.
fn loaded(body: &LinearBody<2>) -> Vec<[f64; 2]> {
    let load_map = body.load_map.as_ref().unwrap();
    let mut force = vec![[0.0; 2]; body.points()];
    for p in 0..load_map.points() {
        let f = density(&load_map.position[p]).map(|f| f * load_map.volume[p]);
        let (targets, blocks) = load_map.row(p);
        for (q, t) in targets.iter().zip(blocks) {
            for a in 0..2 {
                force[*q as usize][a] += t[a][0] * f[0] + t[a][1] * f[1];
            }
        }
    }
    let density: Vec<[f64; 2]> = (force.iter().zip(&body.volume))
        .map(|(f, v)| f.map(|f| f / v))
        .collect();
    let held: Vec<(usize, [f64; 2])> = (0..body.points())
        .filter(|i| body.position[*i][0] == 0.0)
        .map(|i| (i, [0.0; 2]))
        .collect();
    equilibrium(body, &held, &density)
}

fn at(u: &[[f64; 2]], points: &[u32]) -> Vec<[f64; 2]> {
    points.iter().map(|k| u[*k as usize]).collect()
}

#[test]
fn the_exact_elimination_condenses_loads_exactly() {
    for fine in [random([14, 9], false, 10.0), state_based([14, 9], 0.8)] {
        let fine = carrying(fine, 10.0);
        let full = loaded(&fine);
        let keep = kept(&fine, 2);
        let (one, report) = coarsen(&fine, &keep, &with(Scheme::Schur, 1.0)).unwrap();
        assert!(report.loss.unwrap() < 1e-12, "{report:?}");
        let off = apart(&loaded(&one), &at(&full, &keep));
        assert!(off < 1e-11, "{off}");
        // and again
        let again: Vec<u32> = (0..one.points() as u32)
            .filter(|i| {
                let x = one.position[*i as usize];
                x[0] == 0.0 || (x[0] % 4.0 == 0.0 && x[1] % 4.0 == 0.0)
            })
            .collect();
        let (two, _) = coarsen(&one, &again, &with(Scheme::Schur, 1.0)).unwrap();
        let off = apart(&loaded(&two), &at(&at(&full, &keep), &again));
        assert!(off < 1e-11, "{off}");
    }
}

#[test]
fn balls_that_span_the_body_condense_loads_exactly() {
    let fine = carrying(random([9, 7], false, 10.0), 6.0);
    let keep = kept(&fine, 2);
    let full = at(&loaded(&fine), &keep);
    for scheme in [Scheme::Energy, Scheme::Rows] {
        let (coarse, _) = coarsen(&fine, &keep, &with(scheme, 30.0)).unwrap();
        let off = apart(&loaded(&coarse), &full);
        assert!(off < 1e-11, "{scheme:?}: {off}");
    }
}

#[test]
fn no_load_is_lost_in_balls() {
    let fine = carrying(random([14, 9], false, 10.0), 10.0);
    let keep = kept(&fine, 2);
    let full = at(&loaded(&fine), &keep);
    for scheme in [Scheme::Energy, Scheme::Rows] {
        let mut before = f64::INFINITY;
        for radius in [4.0, 7.0, 10.0] {
            let (coarse, report) = coarsen(&fine, &keep, &with(scheme, radius)).unwrap();
            assert!(report.loss.unwrap() < 1e-12, "{scheme:?} {report:?}");
            let off = apart(&loaded(&coarse), &full);
            assert!(off < before, "{scheme:?} {radius}: {off}");
            before = off;
        }
    }
}

#[test]
fn an_exact_elimination_needs_no_symmetry() {
    // one bond that pulls harder on one of its ends
    let mut fine = carrying(random([12, 7], false, 10.0), 8.0);
    let k = fine.start[30];
    fine.block[k] = fine.block[k].map(|r| r.map(|c| 1.7 * c));
    let keep = kept(&fine, 2);
    let (coarse, report) = coarsen(&fine, &keep, &with(Scheme::Schur, 1.0)).unwrap();
    let off = apart(&loaded(&coarse), &at(&loaded(&fine), &keep));
    assert!(off < 1e-11, "{off}");
    assert!(report.asymmetry > 1e-3 && coarse.soundness().asymmetry == report.asymmetry);
    assert!(matches!(report.stability, Stability::Stable { .. }));
    // what acts on one point does not all arrive
    assert!(report.loss.unwrap() > 1e-6);
}

#[test]
fn published_rows_of_central_bonds_turn_freely_and_are_stable() {
    for radius in [4.0, 6.0] {
        let fine = random([13, 10], false, 10.0);
        let keep = Selection::every(3).choose(&fine).unwrap();
        let options = Options {
            scheme: Scheme::Rows,
            radius: Radius::Fixed(radius),
            ..Options::default()
        };
        let (coarse, report) = coarsen(&fine, &keep, &options).unwrap();
        assert!(report.soundness.rotation < 1e-13, "{report:?}");
        assert!(report.asymmetry > 1e-4 && !report.definite);
        assert!(
            matches!(report.stability, Stability::Stable { .. }),
            "{report:?}"
        );
        assert_eq!(coarse.soundness().asymmetry, report.asymmetry);
        // symmetrised they do not
        let options = Options {
            symmetrise: true,
            ..options
        };
        let refused = coarsen(&fine, &keep, &options).unwrap_err().to_string();
        assert!(
            refused.contains("rotation") || refused.contains("unstable"),
            "{refused}"
        );
    }
    let fine = random([7, 6, 5], false, 5.0);
    let keep = Selection::every(2).choose(&fine).unwrap();
    let options = Options {
        scheme: Scheme::Rows,
        radius: Radius::Fixed(3.0),
        ..Options::default()
    };
    let (_, report) = coarsen(&fine, &keep, &options).unwrap();
    assert!(report.soundness.rotation < 1e-13, "{report:?}");
}

#[test]
fn what_repels_itself_is_named_though_its_rows_are_not_symmetric() {
    use super::bodies::chain;
    // a bond that pushes more on one end than on the other, between retained points
    let mut bar = chain(9, &[1.0]);
    for (i, c) in [(4, -3.0), (3, -2.0)] {
        let k = (bar.start[i]..bar.start[i + 1])
            .find(|k| bar.partner[*k] as usize == 7 - i)
            .unwrap();
        bar.block[k][0][0] = c;
    }
    let refused = coarsen(&bar, &[0, 3, 4, 8], &with(Scheme::Rows, 4.0)).unwrap_err();
    assert!(
        refused
            .to_string()
            .contains("not symmetric, has unstable modes"),
        "{refused}"
    );
}
