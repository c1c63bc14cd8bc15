//! What a patch test says of thin bodies, statics measures: bars are pulled and their force is read.

use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::LinearBody;
use peridyne::spec::*;
use peridyne::statics::{Direct, Support};
use peridyne_theory::patch_test::patch_test;

const YOUNG: f64 = 70.0;

/// A block of a cubic lattice of spacing 1 with a horizon of three.
fn block(size: [usize; 3], poisson: f64) -> Box<dyn Simulation> {
    let region = Region::Block {
        low: [0.0; 3],
        high: size.map(|n| n as f64 - 1.0),
    };
    let body = BodySpec::Lattice {
        kind: LatticeKind::Cubic,
        spacing: 1.0,
        origin: [0.0; 3],
        region,
        perturb: None,
    };
    let law = LawSpec::Lps(Moduli {
        young: YOUNG,
        poisson,
    });
    let mut spec = Spec::new(3, body, 1.0, law);
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.bonds.partial_volume_correction = true;
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    build(&spec, options).unwrap()
}

/// Force over cross-section and strain of a bar along x, its sides free: ends held along x, the strain taken from its middle half.
fn pulled(body: &LinearBody<3>, size: [usize; 3]) -> f64 {
    let long = size[0] as f64 - 1.0;
    let mut support = Support::none(body.points());
    let mut given = vec![[0.0; 3]; body.points()];
    for (i, x) in body.position.iter().enumerate() {
        if x[0] < 2.5 || x[0] > long - 2.5 {
            support.free[i][0] = false;
            given[i][0] = 1e-3 * x[0];
        }
        // no translation, no turning about x
        if *x == [0.0; 3] {
            support.free[i] = [false; 3];
        }
        if *x == [0.0, size[1] as f64 - 1.0, 0.0] {
            support.free[i][2] = false;
        }
    }
    let load: Vec<[f64; 3]> = (0..body.points())
        .map(|i| body.force(&given, i).map(|f| f * body.volume[i]))
        .collect();
    let mut u = Direct::new(body, &support, 0.0).unwrap().solve(&load);
    for (i, free) in support.free.iter().enumerate() {
        if !free[0] {
            u[i][0] = given[i][0];
        }
    }
    let far = |i: &usize| body.position[*i][0] > long - 2.5;
    let force: f64 = (0..body.points())
        .filter(far)
        .map(|i| -body.volume[i] * body.force(&u, i)[0])
        .sum();
    let mean = |at: f64| {
        let layer: Vec<f64> = (0..body.points())
            .filter(|i| body.position[*i][0] == at)
            .map(|i| u[i][0])
            .collect();
        layer.iter().sum::<f64>() / layer.len() as f64
    };
    let (a, b) = ((0.25 * long).round(), (0.75 * long).round());
    let strain = (mean(b) - mean(a)) / (b - a);
    force / (size[1] * size[2]) as f64 / strain
}

#[test]
fn thin_plates_are_as_stiff_in_their_plane_as_the_patch_test_says() {
    // bound before the result: the patch test knows no relaxation between layers
    const BOUND: f64 = 0.05;
    for (layers, poisson) in [(1, 0.25), (2, 0.25), (2, 0.35), (3, 0.25)] {
        let size = [29, 13, layers];
        let mut sim = block(size, poisson);
        let patch = patch_test(sim.as_mut(), None);
        let whole = patch.whole(0).unwrap().directional().unwrap();
        let Some(body) = sim.linear_body().of::<3>() else {
            panic!("the body has three dimensions")
        };
        let found = if layers == 1 {
            // nothing holds a sheet of one layer across its plane
            let flat = LinearBody::<3> {
                block: body
                    .block
                    .iter()
                    .map(|c| {
                        let mut c = *c;
                        c[2][2] += 1.0;
                        c
                    })
                    .collect(),
                ..body
            };
            pulled(&flat, size)
        } else {
            pulled(&body, size)
        };
        let off = whole.young[0] / found - 1.0;
        println!(
            "{layers} layers, ν = {poisson}: patch {:.2}, statics {found:.2} ({:+.1} % of asked), off {off:+.4}",
            whole.young[0],
            100.0 * (found / YOUNG - 1.0)
        );
        assert!(off.abs() < BOUND, "{layers} layers, ν = {poisson}: {off}");
        // the mean of all directions says nothing of it
        assert!(!patch.whole(0).unwrap().is_even());
    }
}
