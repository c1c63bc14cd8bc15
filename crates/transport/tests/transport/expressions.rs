//! Fluxes by expression: polynomials are found where they are, and nowhere else; the rest is evaluated many at a time.

use crate::sample::{odd, operator};
use peridyne_transport::flux::Psi;
use peridyne_transport::weights::Stencil;
use peridyne_transport::{
    Boundary, Bump, Direction, Evaluation, Flux, Formula, Grid, Law, measure,
};
use proptest::prelude::*;
use std::sync::Arc;

fn formula(text: &str) -> Formula {
    Formula::new(text, &[("k", 0.75)]).unwrap()
}

#[test]
fn polynomials_are_found() {
    let third = 1.0 / 3.0;
    let cases: [(&str, &[f64]); 14] = [
        ("x^2/2", &[0.0, 0.0, 0.5]),
        ("-(x - 1)^3", &[1.0, -3.0, 3.0, -1.0]),
        ("k*x + (1 - x)*(1 + x)", &[1.0, 0.75, -1.0]),
        ("sin(0.5)*x", &[0.0, 0.5f64.sin()]),
        ("x*x*x*x/3", &[0.0, 0.0, 0.0, 0.0, third]),
        (
            "pi*x^2/e",
            &[0.0, 0.0, std::f64::consts::PI / std::f64::consts::E],
        ),
        ("x^8*x - x*x^8 + x", &[0.0, 1.0]),
        ("min(2, 3)*x", &[0.0, 2.0]),
        ("k > 0.5 ? x^2 : abs(x)", &[0.0, 0.0, 1.0]),
        ("if(k > 1, 1/x, x)", &[0.0, 1.0]),
        ("2", &[2.0]),
        ("x^0 + x^1", &[1.0, 1.0]),
        ("0*x^3", &[0.0]),
        ("x^(10 - 2)", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]),
    ];
    for (text, coefficients) in cases {
        assert_eq!(formula(text).polynomial(), Some(coefficients), "{text}");
    }
}

/// Some of these are polynomials on a range, or to nine digits, or have the values of one.
#[test]
fn what_is_no_polynomial_is_not_taken_for_one() {
    let none = [
        "abs(x)",
        "sin(x)*1e-9 + x^2",
        "x > 5 ? x : x^2",
        "x < 1e9 ? x^2 : 0",
        "max(x^2, -1)",
        "clamp(x, -9, 9)",
        "x/x",
        "x^2/(1 + 1e-12*x)",
        "x^0.5*x^1.5",
        "x^2.0000000001",
        "sqrt(x^4)",
        "2^x",
        "x^x",
        "1/x",
        "x^-1",
        "floor(x)",
        "x^2 + 0*log(x)",
        "x^9",
        "sign(x)*x",
        "step(x + 100)*x",
        "hypot(x, 0)",
        "(x == 0.123456) + x",
        "!x",
        "x && 1",
        "noise(x, 0, 0)*1e-12 + x",
        "x + 1/0",
        "exp(log(x))",
        "1e300*x*1e300",
    ];
    for text in none {
        let f = formula(text);
        assert_eq!(f.polynomial(), None, "{text}");
        assert!(matches!(Flux::of_formula(f, -1.0, 1.0), Flux::Function(_)));
    }
}

/// Where the sum of powers would lose the digits that the expression has, it is not multiplied out.
#[test]
fn digits_are_not_lost() {
    let f = formula("(x - 1)^6");
    assert!(f.polynomial().is_some());
    assert!(f.expanded(0.9, 1.1).is_none() && f.expanded(-1.0, 1.0).is_some());
    assert!(formula("(x - 1000)^2").expanded(999.0, 1001.0).is_none());
}

/// Values of many at a time are those of one at a time, to the last digits of powers.
#[test]
fn arrays_give_the_values_of_the_interpreter() {
    let texts = [
        "x^2/(x^2 + 0.5*(1 - x)^2)",
        "abs(x)*x/2",
        "sin(2*x) + cos(x)^3",
        "x > 0.2 && x < 0.9 ? x^2 : -x",
        "sqrt(x)",
        "1/x",
        "min(x, x^2, 0.3)",
        "clamp(x, -0.5, 0.5)*exp(-x)",
        "atan2(x, k)",
        "k",
        "2^x",
        "-x^5 + 3",
        "noise(3*x, 0, 0)",
        "tan(x) + atan(x)",
        "sinh(x)*cosh(x)",
        "tanh(3*x) - asin(x)",
        "log(x) + ln(2 + x)",
        "log10(x) + acos(x)",
        "x^1.7 + max(x, 1 - x)",
        "(x < 0.1) + 2*(x <= 0) + 4*(x > -0.3) + 8*(x >= 1)",
        "if(x, x, 1)",
        "(x == 0) + (x != 0)",
        "!x || x && 1",
        "floor(3*x) + ceil(x)",
        "sign(x) + step(x - 0.2)",
        "hypot(x, 2)",
        "random(9*x, 1, 2)",
        "(x - 0.3)^7",
    ];
    for text in texts {
        let f = formula(text);
        // more than one portion, and a part of one
        let u: Vec<f64> = (0..300).map(|i| (f64::from(i) * 0.7).sin() * 1.5).collect();
        let mut many = u.clone();
        f.values(&mut many);
        for (u, many) in u.iter().zip(&many) {
            let one = f.value(*u);
            let same = one.is_nan() && many.is_nan() || one == *many;
            assert!(
                same || (one - many).abs() <= 8.0 * f64::EPSILON * one.abs().max(1.0),
                "{text} at {u}: {one} {many}"
            );
        }
    }
}

proptest! {
    /// A random polynomial as a random text: convolutions and Fourier transforms give what the interpreter gives bond by bond.
    #[test]
    fn random_polynomials_carry_like_the_interpreter(
        c in prop::collection::vec(-2.0f64..2.0, 5),
        root in -1.5f64..1.5,
        form in 0usize..4,
        collars in any::<bool>(),
    ) {
        let text = match form {
            0 => format!("{} + {}*x + {}*x^2 + {}*x^3 + {}*x^4", c[0], c[1], c[2], c[3], c[4]),
            1 => format!("{} + x*({} + x*({} + x*({} + x*{})))", c[0], c[1], c[2], c[3], c[4]),
            2 => format!("({}*x + {})*(x - {root})^2 - ({} - x)*x/3", c[1], c[0], c[2]),
            _ => format!("-(x + {root})^4/{} + ({}*x)^3", 2.0 + c[0].abs(), c[2]),
        };
        let f = formula(&text);
        let (n, horizon) = (60, 0.55);
        let u: Vec<f64> = (0..n).map(|i| ((i * i) as f64 * 0.37).sin() + 0.3).collect();
        let flux = Flux::of_formula(f.clone(), -1.3, 1.3);
        prop_assert!(matches!(flux, Flux::Polynomial(_)), "{text}");
        let kernel = odd(Bump::Cosine, horizon, 1);
        let grid = Grid::line(0.0, 3.0, n).unwrap();
        let boundary = match collars {
            true => Boundary::Collars(Arc::new(|x, _| x[0].cos())),
            false => Boundary::Periodic,
        };
        let rate = |flux: Flux, way| {
            let flux = Some((flux, Direction::Constant([1.0, 0.0]), &kernel));
            let law = Law::new(grid, boundary.clone(), flux, None).unwrap();
            let mut rate = vec![0.0; n];
            operator(&law, way).rate(&u, 0.0, &mut rate);
            rate
        };
        let interpreter = {
            let f = f.clone();
            rate(Flux::Function(Arc::new(move |u: f64| Psi::value(&f, u))), Evaluation::Direct)
        };
        // round-off: of each bond that of the sum of all terms
        let terms = f.polynomial().unwrap().iter().rev().fold(0.0, |sum, c| sum * 1.3 + c.abs());
        let stencil = Stencil::new(&kernel, &grid, "k").unwrap();
        let weights: f64 = stencil.weights.iter().map(|w| 2.0 * w[0].abs()).sum();
        let bonds = 2.0 * stencil.steps.len() as f64;
        let bound = (bonds + 16.0) * f64::EPSILON * terms * weights;
        let arrays = rate(Flux::Function(Arc::new(f)), Evaluation::Direct);
        prop_assert!(measure::distance(&arrays, &interpreter) <= bound, "{text}");
        let direct = rate(flux.clone(), Evaluation::Direct);
        prop_assert!(measure::distance(&direct, &interpreter) <= bound, "{text}");
        if !collars {
            let fourier = rate(flux, Evaluation::Fourier);
            prop_assert!(measure::distance(&fourier, &interpreter) <= bound, "{text}");
        }
    }
}
