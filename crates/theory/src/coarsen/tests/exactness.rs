use super::super::exact::{Network, modulus};
use super::super::{Options, Radius, Scheme, Selection, Volume, coarsen, schur};
use super::bodies::{apart, chain, equilibrium, lattice, random, tent, unlike};
use crate::exact::{Field, Q, q};
use peridyne::spec::LinearBody;

fn with(scheme: Scheme, radius: f64) -> Options {
    Options {
        scheme,
        radius: Radius::Fixed(radius),
        ..Options::default()
    }
}

fn every<const D: usize>(body: &LinearBody<D>, k: u32) -> Vec<u32> {
    Selection::every(k).choose(body).unwrap()
}

#[test]
fn springs_in_series_give_one_half() {
    let two = chain(3, &[1.0]);
    for scheme in [Scheme::Rows, Scheme::Energy, Scheme::Schur] {
        let options = Options {
            volume: Volume::Kept,
            ..with(scheme, 2.0)
        };
        let (coarse, report) = coarsen(&two, &[0, 2], &options).unwrap();
        assert!(
            (coarse.block[0][0][0] - 0.5).abs() < 1e-15,
            "{scheme:?}: {:?}",
            coarse.block
        );
        assert_eq!((coarse.points(), report.range), (2, 2.0));
    }
}

#[test]
fn rows_are_the_fractions() {
    // example 1, both levels: 4 × and then 2 ×, r1 = 40 v, r2 = 80 v, volumes kept
    let fine = tent(201);
    let keep = every(&fine, 4);
    let options = |radius| Options {
        volume: Volume::Kept,
        symmetrise: false,
        ..with(Scheme::Rows, radius)
    };
    let (one, report) = coarsen(&fine, &keep, &options(40.0)).unwrap();
    let springs: Vec<Q> = (1..10).map(|j| q(10 - j, 10)).collect();
    let network = Network::chain(201, &springs);
    let retained: Vec<usize> = keep.iter().map(|k| *k as usize).collect();
    // the middle, near an end, the end
    for at in [25, 3, 0] {
        let exact = network.ball_row(retained[at], 40, &retained).unwrap();
        let (partners, blocks) = one.row(at);
        assert_eq!(partners.len(), exact.len());
        for (((q, c), j), block) in exact.iter().zip(partners).zip(blocks) {
            assert_eq!(*q, retained[*j as usize]);
            assert!((c.value() - block[0][0]).abs() < 1e-14, "{at} {q}");
        }
    }
    let exact = network.ball_row(100, 40, &retained).unwrap();
    let ratio = modulus(100, &exact) / q(4 * 165, 2);
    assert!((ratio.value() - 0.991644).abs() < 1e-6, "{}", ratio.value());
    // one ball for the interior, one for each place whose ball holds a point with a clipped family
    assert_eq!(report.work.solved, 13 + 1 + 13);
    assert!(report.work.row_sum < 1e-14 && report.asymmetry > 1e-4);
    let (two, _) = coarsen(&one, &every(&one, 2), &options(80.0)).unwrap();
    assert_eq!(two.points(), 26);
}

/// Forces instead of their densities: volumes are lumped level by level.
fn forces<const D: usize>(mut body: LinearBody<D>) -> LinearBody<D> {
    for i in 0..body.points() {
        for k in body.start[i]..body.start[i + 1] {
            body.block[k] = body.block[k].map(|r| r.map(|x| x * body.volume[i]));
        }
    }
    body
}

#[test]
fn two_steps_are_one_step() {
    let fine = tent(97);
    let (one, _) = schur(&fine, &every(&fine, 12)).unwrap();
    let (half, _) = schur(&fine, &every(&fine, 4)).unwrap();
    let (two, report) = schur(&half, &every(&half, 3)).unwrap();
    let off = unlike(&forces(two), &forces(one));
    assert!(off < 1e-12, "{off}");
    assert!(report.soundness.asymmetry < 1e-13 && report.definite);

    let fine = random([13, 13], false, 10.0);
    let (one, _) = schur(&fine, &every(&fine, 4)).unwrap();
    let (half, _) = schur(&fine, &every(&fine, 2)).unwrap();
    let (two, report) = schur(&half, &every(&half, 2)).unwrap();
    let off = unlike(&forces(two), &forces(one));
    assert!(off < 1e-12, "{off}");
    assert!(report.soundness.rotation < 1e-13);
}

#[test]
fn balls_that_span_the_body_are_the_schur_complement() {
    let fine = random([11, 9], false, 20.0);
    let keep = Selection::BlueNoise {
        spacing: 2.5,
        seed: 3,
    }
    .choose(&fine)
    .unwrap();
    let (exact, _) = schur(&fine, &keep).unwrap();
    for scheme in [Scheme::Rows, Scheme::Energy] {
        let (coarse, report) = coarsen(&fine, &keep, &with(scheme, 20.0)).unwrap();
        assert!(
            unlike(&coarse, &exact) < 1e-12,
            "{scheme:?}: {}",
            unlike(&coarse, &exact)
        );
        assert!(report.soundness.rotation < 1e-13);
    }
}

#[test]
fn retained_points_move_as_in_the_whole_body() {
    let fine = random([16, 10], false, 10.0);
    let keep = every(&fine, 3);
    let (coarse, _) = schur(&fine, &keep).unwrap();
    let u = |x: f64| [0.01 * (x + 1.0), -0.02 * x];
    let held: Vec<(usize, [f64; 2])> = (0..keep.len())
        .filter(|k| [0.0, 15.0].contains(&coarse.position[*k][0]))
        .map(|k| (k, u(coarse.position[k][0])))
        .collect();
    // one loaded point: the same force at both levels
    let mut load = vec![[0.0; 2]; coarse.points()];
    let at = (0..coarse.points())
        .find(|k| coarse.position[*k] == [6.0, 3.0])
        .unwrap();
    load[at] = [0.3 / coarse.volume[at], 0.1 / coarse.volume[at]];
    let found = equilibrium(&coarse, &held, &load);
    let held: Vec<_> = held.iter().map(|(k, u)| (keep[*k] as usize, *u)).collect();
    let mut load = vec![[0.0; 2]; fine.points()];
    load[keep[at] as usize] = [0.3, 0.1];
    let full = equilibrium(&fine, &held, &load);
    let full: Vec<[f64; 2]> = keep.iter().map(|k| full[*k as usize]).collect();
    assert!(apart(&found, &full) < 1e-12, "{}", apart(&found, &full));
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let fine = random([14, 12], false, 2.0);
    let keep = every(&fine, 2);
    for scheme in [Scheme::Rows, Scheme::Energy, Scheme::Schur] {
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            // rows of small balls turn against rotations once they are symmetric
            let options = Options {
                rotation: 1.0,
                ..with(scheme, 9.0)
            };
            let (body, _) = pool.install(|| coarsen(&fine, &keep, &options)).unwrap();
            body.block
                .as_flattened()
                .as_flattened()
                .iter()
                .map(|x| x.to_bits())
                .collect::<Vec<_>>()
        };
        let one = run(1);
        assert!(one == run(2) && one == run(3), "{scheme:?}");
    }
}

#[test]
fn a_homogeneous_lattice_has_one_ball() {
    let plane = lattice([24, 24], 2.5, true, |_, _| 1.0);
    let cube = lattice([12, 12, 12], 1.5, true, |_, _| 1.0);
    let (_, report) = coarsen(&plane, &every(&plane, 3), &with(Scheme::Energy, 6.0)).unwrap();
    assert_eq!(report.work.solved, 1);
    let (coarse, report) = coarsen(&cube, &every(&cube, 2), &with(Scheme::Energy, 2.9)).unwrap();
    assert_eq!((report.work.solved, coarse.points()), (1, 216));
    // one odd bond: only balls that see it differ
    let odd = lattice([24, 24], 2.5, true, |x, y| match [x, y] {
        [[12, 12], [13, 12]] | [[13, 12], [12, 12]] => 0.5,
        _ => 1.0,
    });
    let (_, report) = coarsen(&odd, &every(&odd, 3), &with(Scheme::Energy, 6.0)).unwrap();
    assert!(
        (2..30).contains(&report.work.solved),
        "{}",
        report.work.solved
    );
}
