#![no_main]
//! Expressions: what parses can be evaluated.

use libfuzzer_sys::fuzz_target;
use peridyne::expression::Expression;

fuzz_target!(|text: &str| {
    match Expression::parse(text, &[("R", 0.005)]) {
        Ok(expression) => {
            expression.eval(&[1.0, -2.0, 0.5], 3.0);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
