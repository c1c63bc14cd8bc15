//! Mistakes are told.

use crate::sample::odd;
use peridyne_transport::weights::Stencil;
use peridyne_transport::{
    Boundary, Bump, Direction, Evaluation, Flux, Grid, Kernel, Law, Operator, Parity, Profile,
};
use std::sync::Arc;

fn kernel(
    parity: Parity,
    f: impl Fn(f64) -> f64 + Send + Sync + 'static,
    normalise: bool,
) -> Result<Kernel, String> {
    Kernel::new(
        parity,
        Profile::Function(Arc::new(f)),
        0.5,
        1,
        normalise,
        "k",
    )
    .map_err(|e| format!("{e}; {}", e.help.clone().unwrap_or_default()))
}

#[test]
fn moments_and_parities_are_asked_for() {
    // ∫ z·12z = 12·2·δ³/3 = 1: sandia2010's −δ′ is half of what the limit needs
    let told = kernel(Parity::Odd, |z| 12.0 * z, false).unwrap_err();
    assert!(
        told.contains("is 1.000000000, not 2")
            && told.contains("0.5")
            && told.contains("multiply it by 2.0"),
        "{told}"
    );
    assert!((kernel(Parity::Odd, |z| 12.0 * z, true).unwrap().moment() - 2.0).abs() < 1e-12);
    assert!(kernel(Parity::Odd, |z| 24.0 * z, false).is_ok());
    let told = kernel(Parity::Odd, |z| 24.0 * z + 0.1, false).unwrap_err();
    assert!(told.contains("not antisymmetric"), "{told}");
    let told = kernel(Parity::Even, |z| 24.0 + z, false).unwrap_err();
    assert!(told.contains("not symmetric"), "{told}");
    // (2.0.15) as printed sharpens
    let told = kernel(Parity::Even, |_| -24.0, false).unwrap_err();
    assert!(
        told.contains("is -2.000000000, not 2") && told.contains("multiply it by -1.0"),
        "{told}"
    );
    let told = kernel(Parity::Odd, |z| 1.0 / (z - 0.25).max(0.0), false).unwrap_err();
    assert!(told.contains("inf"), "{told}");
    let table = Profile::Table(vec![[0.0, 1.0], [0.3, 0.0]]);
    let told = Kernel::new(Parity::Odd, table, 0.5, 1, true, "k").unwrap_err();
    assert!(told.message.contains("the table goes from"), "{told}");
    let told = Kernel::new(
        Parity::Even,
        Profile::Curvature(Bump::Hat),
        0.5,
        1,
        true,
        "k",
    )
    .unwrap_err();
    assert!(told.message.contains("no second derivative"), "{told}");
}

/// A moment that is round-off of its parts has no factor, and a negative one none that leaves the kernel its sign.
#[test]
fn moments_that_cancel_are_refused() {
    // ∫ z²(1 − (5/3)(z/δ)²) = 0; ∫ z²(1 − (5/3)(z/δ)²) of an even kernel too
    let zero = |z: f64| z * (1.0 - 5.0 / 3.0 * (z / 0.5).powi(2));
    let even = |z: f64| 1.0 - 5.0 / 3.0 * (z / 0.5).powi(2);
    for normalise in [true, false] {
        let told = kernel(Parity::Odd, zero, normalise).unwrap_err();
        assert!(told.contains("0 but for round-off"), "{told}");
        let told = kernel(Parity::Even, even, normalise).unwrap_err();
        assert!(told.contains("0 but for round-off"), "{told}");
    }
    // in a plane ∫ r² φ dr is 0 for another one, and of the first it is not
    let plane = |f: fn(f64) -> f64| {
        let profile = Profile::Function(Arc::new(f));
        Kernel::new(Parity::Odd, profile, 0.5, 2, true, "k").map(|_| ())
    };
    assert!(plane(|z| z * (1.0 - 1.5 * (z / 0.5).powi(2))).is_err());
    assert!(plane(|z| z * (1.0 - 1.2 * (z / 0.5).powi(2))).is_ok());
    // a table whose lines cancel: φ from 3 down to −1 on [0, δ], ∫ zφ = δ²(3/2 − 4/3) is not 0, from 2 down to −1 it is
    let table = |top: f64| {
        let profile = Profile::Table(vec![[0.0, top], [0.5, -1.0]]);
        Kernel::new(Parity::Odd, profile, 0.5, 1, true, "k").map(|_| ())
    };
    assert!(table(3.0).is_ok());
    assert!(
        table(2.0)
            .unwrap_err()
            .message
            .contains("0 but for round-off")
    );
    let told = kernel(Parity::Odd, |z| -z, true).unwrap_err();
    assert!(told.contains("other sign"), "{told}");
    let told = kernel(Parity::Even, |_| -1.0, true).unwrap_err();
    assert!(told.contains("spread the other way"), "{told}");
}

/// A kernel between whose parts the points of the grid fall, or whose sum has another sign, is not brought to the moment 2 by what is left of it.
#[test]
fn kernels_that_a_grid_does_not_see_are_refused() {
    let grid = Grid::line(0.0, 1.0, 100).unwrap();
    let told = |profile: Profile, parity: Parity| {
        let k = Kernel::new(parity, profile, 0.03, 1, true, "k").unwrap();
        Stencil::new(&k, &grid, "k")
            .map(|_| ())
            .map_err(|e| e.message.to_string())
    };
    // all of it between the first and the second neighbour
    let spike = vec![
        [0.0, 0.0],
        [0.012, 0.0],
        [0.015, 1.0],
        [0.018, 0.0],
        [0.03, 0.0],
    ];
    let said = told(Profile::Table(spike), Parity::Odd).unwrap_err();
    assert!(said.contains("does not resolve the kernel"), "{said}");
    // three spacings see b″ of this bump with the wrong sign
    let said = told(Profile::Curvature(Bump::Smooth), Parity::Even).unwrap_err();
    assert!(said.contains("does not resolve the kernel"), "{said}");
    // one bond alone carries all of it: its moment is 2, not what round-off makes of two equations
    let one = vec![
        [0.0, 0.0],
        [0.011, 0.0],
        [0.02, 1.0],
        [0.029, 0.0],
        [0.03, 0.0],
    ];
    let k = Kernel::new(Parity::Odd, Profile::Table(one), 0.03, 1, true, "k").unwrap();
    let s = Stencil::new(&k, &grid, "k").unwrap();
    let moment: f64 = { s.steps.iter().zip(&s.weights) }
        .map(|(m, w)| 2.0 * w[0] * m[0] as f64 * grid.spacing)
        .sum();
    assert!((moment - 2.0).abs() < 1e-12, "{moment}");
}

#[test]
fn a_table_is_its_lines() {
    // 24 z on both sides, and on one
    let lines = [
        vec![[-0.5, -12.0], [0.5, 12.0]],
        vec![[0.0, 0.0], [0.2, 4.8], [0.5, 12.0]],
    ];
    for table in lines {
        let k = Kernel::new(Parity::Odd, Profile::Table(table), 0.5, 1, false, "k").unwrap();
        assert!((k.value(0.31) - 24.0 * 0.31).abs() < 1e-12 && k.value(0.51) == 0.0);
    }
}

#[test]
fn horizons_are_resolved() {
    let grid = Grid::line(0.0, 1.0, 10).unwrap();
    let told = Stencil::new(&odd(Bump::Cosine, 0.15, 1), &grid, "k").unwrap_err();
    assert!(
        told.message.contains("under-resolved") && told.message.contains("1.500 spacings"),
        "{told}"
    );
    assert!(Stencil::new(&odd(Bump::Cosine, 0.3, 1), &grid, "k").is_ok());
}

#[test]
fn second_derivatives_of_bumps_damp_where_they_can_and_others_are_refused() {
    let grid = Grid::line(0.0, 1.0, 60).unwrap();
    let law = |profile: Profile| {
        let s = Kernel::new(Parity::Even, profile, 0.2, 1, true, "diffusion.kernel").unwrap();
        let law = Law::new(grid, Boundary::Periodic, None, Some((0.1, &s))).unwrap();
        Operator::new(law, Evaluation::Direct)
    };
    assert!(law(Profile::SlopeOverDistance(Bump::Cosine)).is_ok());
    // the symbol of b″ is −k² b̂, and b̂ of a compact bump changes its sign
    let told = law(Profile::Curvature(Bump::Cosine)).unwrap_err();
    assert!(told.message.contains("makes waves grow"), "{told}");
}

#[test]
fn laws_say_what_they_need() {
    let grid = Grid::line(0.0, 1.0, 60).unwrap();
    assert!(Law::new(grid, Boundary::Periodic, None, None).is_err());
    let a = odd(Bump::Cosine, 0.2, 1);
    let flux = (
        Flux::Function(Arc::new(f64::exp)),
        Direction::Constant([1.0, 0.0]),
        &a,
    );
    let law = Law::new(grid, Boundary::Periodic, Some(flux), None).unwrap();
    let told = Operator::new(law, Evaluation::Fourier).unwrap_err();
    assert!(told.message.contains("polynomial"), "{told}");
    assert!(Grid::line(1.0, 0.0, 10).is_err() && Grid::plane([0.0; 2], [1.0, 0.55], 10).is_err());
}

/// All of a collar is looked at, with the flux; tables say what is at 0; horizons of a plane have an end.
#[test]
fn collars_tables_and_long_horizons_are_looked_at() {
    let a = odd(Bump::Cosine, 0.2, 1);
    let grid = Grid::line(0.0, 1.0, 60).unwrap();
    let told = |flux: Flux, given: fn(f64) -> f64| {
        let boundary = Boundary::Collars(Arc::new(move |x, _| given(x[0])));
        let flux = (flux, Direction::Constant([1.0, 0.0]), &a);
        let law = Law::new(grid, boundary, Some(flux), None).unwrap();
        Operator::new(law, Evaluation::Direct).unwrap_err().message
    };
    // finite in the domain, not beside it
    let text = told(Flux::burgers(), f64::sqrt);
    assert!(text.contains("u in the collar is NaN at [-"), "{text}");
    let root = Flux::Function(Arc::new(f64::sqrt));
    let text = told(root, |x| x);
    assert!(
        text.contains("the flux is NaN at u = -") && text.contains("collars"),
        "{text}"
    );
    let table = Profile::Table(vec![[0.1, 1.0], [0.5, 0.0]]);
    let text = Kernel::new(Parity::Odd, table, 0.5, 1, true, "k").unwrap_err();
    assert!(text.message.contains("begins at z = 0.1"), "{text}");
    let plane = Grid::plane([0.0; 2], [1.0; 2], 1000).unwrap();
    let text = Stencil::new(&odd(Bump::Cosine, 0.6, 2), &plane, "k").unwrap_err();
    assert!(text.message.contains("has 600 spacings"), "{text}");
}
